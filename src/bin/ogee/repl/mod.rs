//! `ogee repl`: lines are read, evaluated in one scope that stays, and answered. What a line does is the library's
//! ([`ogee::session::dialogue`]); this only reads, shows and obeys the orders that begin with `:`.

mod editor;
mod orders;
mod pipe;
mod plot;

use crate::args::Repl;
use crate::interrupt::{self, CANCEL};
use crate::reply::{Count, show_reply};
use crate::speech::{Ended, Exit, Failure, show_uncounted, tell};
use ogee::diag::{Code, Diagnostic};
use ogee::session::dialogue::{Dialogue, Reply};
use ogee::syntax::unfinished::is_unfinished;
use std::io::IsTerminal;

/// What comes next from the person or the pipe.
enum Next {
    /// A line, or several that belong together.
    Text(String),
    /// A line was given up.
    Cancelled,
    /// So many lines of which the last is no text, and why.
    Garbled(usize, Box<Diagnostic>),
    /// Nothing more.
    End,
}

/// Where lines come from.
trait Lines {
    /// Reads until a text is finished.
    fn next(&mut self, talk: &Talk<'_, '_>) -> Result<Next, Failure>;
}

/// A dialogue, and how it goes.
struct Talk<'t, 's> {
    dialogue: &'t mut Dialogue<'s>,
    digits: Option<usize>,
    /// Lines that were read.
    n_lines: usize,
    /// A person is at the other end.
    is_terminal: bool,
    failed: bool,
}

/// What an order does to the dialogue.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Flow {
    On,
    Quit,
}

/// Reads lines until there are no more. Exits 1 where lines came from a pipe and one of them failed.
pub fn run(args: &Repl) -> Ended {
    if let Some(file) = &args.file {
        crate::commands::try_to_read(file)?;
    } else if !args.evaluation.set.is_empty() {
        return Err(Failure::usage("`--set` replaces a `let` of a FILE, and there is none"));
    }
    let is_terminal = std::io::stdin().is_terminal();
    if is_terminal {
        interrupt::listen();
    }
    let mut session = crate::commands::session(&args.evaluation);
    session.dialogue(Some(&CANCEL), |dialogue| {
        let digits = args.digits.map(usize::from);
        let mut talk = Talk { dialogue, digits, n_lines: 0, is_terminal, failed: false };
        if let Some(file) = &args.file {
            talk.answer(|dialogue| dialogue.file(file))?;
        }
        match is_terminal {
            true => talk.go_on(&mut editor::Editor::open()?)?,
            false => talk.go_on(&mut pipe::Pipe)?,
        }
        Ok(if talk.failed && !is_terminal { Exit::Scene } else { Exit::Done })
    })
}

impl Talk<'_, '_> {
    fn go_on(&mut self, lines: &mut dyn Lines) -> Result<(), Failure> {
        loop {
            match lines.next(self)? {
                Next::Text(text) => {
                    let first_line = self.n_lines;
                    self.n_lines += text.lines().count().max(1);
                    if self.line(&text, first_line)? == Flow::Quit {
                        return Ok(());
                    }
                }
                Next::Cancelled => {}
                Next::Garbled(n_lines, why) => {
                    self.n_lines += n_lines;
                    self.failed = true;
                    show_uncounted(&[*why], self.dialogue.sources());
                }
                Next::End => return Ok(()),
            }
        }
    }

    fn line(&mut self, text: &str, first_line: usize) -> Result<Flow, Failure> {
        let trimmed = text.trim();
        if trimmed.starts_with(':') {
            return orders::obey(self, text, first_line);
        }
        match orders::meant(trimmed) {
            Some(order) if !self.dialogue.names().contains(&trimmed) => {
                tell(format!("orders begin with a colon: `:{order}`"));
                self.failed = true;
            }
            _ if trimmed.is_empty() => {}
            _ => self.answer(|dialogue| dialogue.line(text, first_line))?,
        }
        Ok(Flow::On)
    }

    /// Evaluates and says what comes of it.
    fn answer(&mut self, evaluate: impl FnOnce(&mut Dialogue<'_>) -> Reply) -> Result<(), Failure> {
        let reply = match self.is_terminal {
            true => interrupt::while_evaluating(|| evaluate(self.dialogue)),
            false => evaluate(self.dialogue),
        };
        self.failed |= reply.failed;
        if reply.interrupted {
            tell("interrupted: nothing has changed");
        }
        show_reply(&reply, self.dialogue.sources(), self.digits, Count::Never)
    }
}

/// Whether more lines belong to a text. An order is one line.
fn goes_on(text: &str) -> bool {
    !text.trim_start().starts_with(':') && is_unfinished(text)
}

/// What is said of bytes that are no text.
fn garbled(message: String) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(Code::NotUtf8, None, message))
}
