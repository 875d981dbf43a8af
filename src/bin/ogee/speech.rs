//! What the command says and to whom: data to standard output, everything else to standard error; and how it ends.
//!
//! A reader that goes away (`ogee ast big.scene | head`) is no fault: what it does not want is dropped in silence.

use ogee::diag::render::{Counts, Style, human};
use ogee::diag::{Diagnostic, SourceMap};
use std::io::{ErrorKind, IsTerminal, Write};
use std::process::ExitCode;

/// How the command ended, as a number for scripts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done.
    Done = 0,
    /// The scene is at fault, or a comparison failed.
    Scene = 1,
    /// The command line is at fault.
    Usage = 2,
    /// The machine is at fault, or Ogee itself.
    Machine = 3,
    /// A person stopped it.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}

/// Why a command could not go on, in a sentence, and whose fault that is.
#[derive(Debug)]
pub struct Failure {
    /// Whose fault.
    pub exit: Exit,
    /// A sentence without a full stop; its further lines are advice.
    pub message: String,
}

/// How a command ends.
pub type Ended = Result<Exit, Failure>;

impl Failure {
    /// The command line is at fault.
    pub fn usage(message: impl Into<String>) -> Self {
        Failure { exit: Exit::Usage, message: message.into() }
    }

    /// The machine is at fault: "cannot write a.png: permission denied".
    pub fn machine(what: impl std::fmt::Display, error: impl std::fmt::Display) -> Self {
        Failure { exit: Exit::Machine, message: format!("{what}: {error}") }
    }
}

/// Writes data to standard output.
pub fn data(bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes.as_ref()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::machine("cannot write to standard output", reason(&error)))
        }
        _ => Ok(()),
    }
}

/// Says a line to a person. Where nobody can hear it, nothing can be done.
pub fn tell(line: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Says what a failure was.
pub fn tell_failure(failure: &Failure) {
    let (red, plain) = if is_coloured() { ("\u{1b}[1;31m", "\u{1b}[0m") } else { ("", "") };
    tell(format!("{red}error:{plain} {}", failure.message));
}

/// Shows diagnostics to a person, with a line that counts them. Says nothing where nothing is wrong.
pub fn show(diagnostics: &[Diagnostic], sources: &SourceMap) {
    if !diagnostics.is_empty() {
        let text = human(diagnostics, sources, style());
        let _ = writeln!(std::io::stderr().lock(), "{text}{}", Counts::of(diagnostics));
    }
}

/// The same without the line that counts them.
pub fn show_uncounted(diagnostics: &[Diagnostic], sources: &SourceMap) {
    if !diagnostics.is_empty() {
        let _ = writeln!(std::io::stderr().lock(), "{}", human(diagnostics, sources, style()).trim_end());
    }
}

/// An error of the system in its own words, without Rust's "(os error 13)".
pub fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    let words = text.split(" (os error").next().unwrap_or(&text);
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
}

fn style() -> Style {
    let size = terminal_size::terminal_size_of(std::io::stderr());
    Style { colour: is_coloured(), width: size.map_or(100, |(width, _)| usize::from(width.0)) }
}

/// Standard error is a terminal that shows colours, and nobody asked for none (<https://no-color.org>).
fn is_coloured() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let is_dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    !is_set("NO_COLOR") && !is_dumb && std::io::stderr().is_terminal()
}
