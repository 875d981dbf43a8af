//! Ctrl-C: while a picture is rendered or a line of the REPL is evaluated the first press asks for an end, and the picture
//! so far is saved; before and after, and at the second press, the command ends at once.

use crate::speech::Exit;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// True once a person has asked for an end.
pub static CANCEL: AtomicBool = AtomicBool::new(false);
/// True while there is a picture to save.
static IS_RENDERING: AtomicBool = AtomicBool::new(false);
/// True while a line is evaluated.
static IS_EVALUATING: AtomicBool = AtomicBool::new(false);
/// Saves the picture so far while it is being rendered. Who takes it out ends the command.
static RESCUE: Mutex<Option<Rescue>> = Mutex::new(None);

type Rescue = Box<dyn FnOnce() + Send>;

/// How long rendering may take to heed an end. A single ray may take any time, where its scene is made so.
const PATIENCE: Duration = Duration::from_millis(400);

/// Listens from now on. Where the system does not let us, Ctrl-C ends the command as it always did.
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        let is_second = CANCEL.swap(true, Ordering::SeqCst);
        let is_rendering = IS_RENDERING.load(Ordering::SeqCst);
        if is_second || !(is_rendering || IS_EVALUATING.load(Ordering::SeqCst)) {
            leave();
        }
        if is_rendering {
            crate::speech::tell("\ninterrupted: saving what is done (press again to leave at once)");
            std::thread::spawn(rescue);
        }
    });
}

fn leave() -> ! {
    crate::place::forget_unfinished();
    std::process::exit(Exit::Interrupted as i32)
}

/// Where rendering does not come back, what is done is saved without it.
fn rescue() {
    std::thread::sleep(PATIENCE);
    if let Some(save) = taken() {
        save();
        leave();
    }
}

fn taken() -> Option<Rescue> {
    RESCUE.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take()
}

/// Renders what can be cancelled. `save` is what is left to do where the work does not heed that.
pub fn while_rendering<T>(save: impl FnOnce() + Send + 'static, work: impl FnOnce() -> T) -> T {
    *RESCUE.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(Box::new(save));
    IS_RENDERING.store(true, Ordering::SeqCst);
    let result = work();
    while taken().is_none() {
        // The other thread has it, and will end the command.
        std::thread::park();
    }
    result
}

/// Evaluates what can be cancelled, and goes on after it.
pub fn while_evaluating<T>(work: impl FnOnce() -> T) -> T {
    IS_EVALUATING.store(true, Ordering::SeqCst);
    let result = work();
    IS_EVALUATING.store(false, Ordering::SeqCst);
    CANCEL.store(false, Ordering::SeqCst);
    result
}
