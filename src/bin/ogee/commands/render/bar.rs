//! A bar with the time left on a terminal; nothing anywhere else.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use ogee::render::tiles::Progress;
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};

/// Steps of the bar for a picture.
const STEPS: u64 = 1000;

/// Over all pictures that are to be made.
pub struct Bar {
    bar: ProgressBar,
    done: AtomicU64,
}

impl Bar {
    /// For so many pictures.
    pub fn over(pictures: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(pictures * STEPS), ProgressDrawTarget::hidden());
        if std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(10));
            let style = ProgressStyle::with_template(
                "{bar:40} {percent:>3} %  {msg}{prefix}{elapsed} gone, {eta} left",
            );
            bar.set_style(style.expect("the template is well formed"));
        }
        Bar { bar, done: AtomicU64::new(0) }
    }

    /// Names the picture that is being made.
    pub fn name(&self, picture: impl std::fmt::Display) {
        self.bar.set_message(format!("{picture}  "));
    }

    /// A picture is made.
    pub fn made(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Takes the bar away while something is said.
    pub fn aside<T>(&self, say: impl FnOnce() -> T) -> T {
        self.bar.suspend(say)
    }

    /// Takes the bar away.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Bar {
    fn phase(&self, name: &'static str) {
        self.bar.set_prefix(if name.is_empty() { String::new() } else { format!("{name}  ") });
    }

    fn tiles(&self, done: usize, total: usize) {
        if !self.bar.is_hidden() {
            let here = STEPS * done as u64 / (total as u64).max(1);
            self.bar.set_position(self.done.load(Ordering::Relaxed) * STEPS + here);
        }
    }
}
