//! Ctrl-C: while a picture is rendered the first press asks for an end, and the picture so far is saved; before and after,
//! and at the second press, the command ends at once.

use crate::speech::Exit;
use std::sync::atomic::{AtomicBool, Ordering};

/// True once a person has asked for an end.
pub static CANCEL: AtomicBool = AtomicBool::new(false);
/// True while there is a picture to save.
static IS_RENDERING: AtomicBool = AtomicBool::new(false);

/// Listens from now on. Where the system does not let us, Ctrl-C ends the command as it always did.
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        let is_second = CANCEL.swap(true, Ordering::SeqCst);
        if is_second || !IS_RENDERING.load(Ordering::SeqCst) {
            crate::place::forget_unfinished();
            std::process::exit(Exit::Interrupted as i32);
        }
        crate::speech::tell("\ninterrupted: saving what is done (press again to leave at once)");
    });
}

/// Does what can be cancelled.
pub fn while_rendering<T>(work: impl FnOnce() -> T) -> T {
    IS_RENDERING.store(true, Ordering::SeqCst);
    work()
}
