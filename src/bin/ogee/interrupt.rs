//! Ctrl-C: while a picture is rendered or a line of the REPL is evaluated the first press asks for an end, and the picture
//! so far is saved; before and after, and at the second press, the command ends at once.

use crate::speech::Exit;
use std::sync::atomic::{AtomicBool, Ordering};

/// True once a person has asked for an end.
pub static CANCEL: AtomicBool = AtomicBool::new(false);
/// True while there is a picture to save.
static IS_RENDERING: AtomicBool = AtomicBool::new(false);
/// True while a line is evaluated.
static IS_EVALUATING: AtomicBool = AtomicBool::new(false);

/// Listens from now on. Where the system does not let us, Ctrl-C ends the command as it always did.
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        let is_second = CANCEL.swap(true, Ordering::SeqCst);
        let is_rendering = IS_RENDERING.load(Ordering::SeqCst);
        if is_second || !(is_rendering || IS_EVALUATING.load(Ordering::SeqCst)) {
            crate::place::forget_unfinished();
            std::process::exit(Exit::Interrupted as i32);
        }
        if is_rendering {
            crate::speech::tell("\ninterrupted: saving what is done (press again to leave at once)");
        }
    });
}

/// Does what can be cancelled.
pub fn while_rendering<T>(work: impl FnOnce() -> T) -> T {
    IS_RENDERING.store(true, Ordering::SeqCst);
    work()
}

/// Evaluates what can be cancelled, and goes on after it.
pub fn while_evaluating<T>(work: impl FnOnce() -> T) -> T {
    IS_EVALUATING.store(true, Ordering::SeqCst);
    let result = work();
    IS_EVALUATING.store(false, Ordering::SeqCst);
    CANCEL.store(false, Ordering::SeqCst);
    result
}
