//! The command `ogee`: parses its arguments, calls the library, prints, and exits. Printing and exit codes live here alone.

mod args;
mod commands;
mod interrupt;
mod place;
mod repl;
mod reply;
mod speech;

use args::{Command, Ogee};
use clap::Parser;
use speech::{Ended, Exit, Failure};
use std::process::ExitCode;

/// Set to anything, keeps to instructions that every processor of the kind has.
const BASELINE: &str = "OGEE_BASELINE";

fn main() -> ExitCode {
    if std::env::var_os(BASELINE).is_some() {
        ogee::session::keep_to_baseline();
    }
    let ogee = match Ogee::try_parse() {
        Ok(ogee) => ogee,
        Err(error) => return usage(&error),
    };
    answer_for_panics();
    let exit = match run(ogee.command) {
        Ok(exit) => exit,
        Err(failure) => {
            speech::tell_failure(&failure);
            failure.exit
        }
    };
    exit.into()
}

fn run(command: Command) -> Ended {
    match command {
        Command::Render(args) => commands::render::run(&args),
        Command::Check(args) => commands::check::run(&args),
        Command::Eval(args) => commands::eval::run(&args),
        Command::Ast(args) => commands::ast::run(&args),
        Command::Inspect(args) => commands::inspect::run(&args),
        Command::Fmt(args) => commands::fmt::run(&args),
        Command::Test(args) => commands::test::run(&args),
        Command::Compare(args) => commands::compare::run(&args),
        Command::Bench(args) => commands::bench::run(&args),
        Command::Docs(args) => commands::docs::run(&args),
        Command::Explain(args) => commands::explain::run(&args),
        Command::Completions(args) => commands::shell::completions(&args),
        Command::Man(args) => commands::shell::man(&args),
        Command::Repl(args) => repl::run(&args),
    }
}

/// Help and versions go to standard output and are no fault; the rest is said, and exits 2.
fn usage(error: &clap::Error) -> ExitCode {
    // A reader that went away needs no help.
    let _ = error.print();
    if error.use_stderr() { Exit::Usage.into() } else { Exit::Done.into() }
}

/// A panic is a fault of Ogee: it is said so in a sentence instead of a stack of frames, and ends the process wherever it happens.
/// Nothing is unwound, so what was being written stays beside its place under a name of its own.
fn answer_for_panics() {
    std::panic::set_hook(Box::new(|panic| {
        let payload = panic.payload();
        let what = payload.downcast_ref::<&str>().copied();
        let what = what.or(payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
        let place = panic.location().map_or(String::new(), |at| format!(" ({}:{})", at.file(), at.line()));
        speech::tell_failure(&Failure {
            exit: Exit::Machine,
            message: format!(
                "Ogee itself is at fault, not your scene: {what}{place}\n\
                 Please report it, with the scene and the command, to those who make Ogee {}.",
                env!("CARGO_PKG_VERSION")
            ),
        });
        std::process::exit(Exit::Machine as i32);
    }));
}
