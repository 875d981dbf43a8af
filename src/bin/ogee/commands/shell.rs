//! `ogee completions` and `ogee man`: what shells and `man` want to know, from the command's own definition.

use crate::args::{Completions, Man, Ogee};
use crate::speech::{Ended, Exit, Failure, data, reason};
use clap::CommandFactory;

/// Prints a completion script.
pub fn completions(args: &Completions) -> Ended {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Ogee::command(), "ogee", &mut script);
    data(script)?;
    Ok(Exit::Done)
}

/// Prints the page of the whole command, or writes a page for each command into a folder.
pub fn man(args: &Man) -> Ended {
    let Some(folder) = &args.folder else {
        let mut page = Vec::new();
        let written = clap_mangen::Man::new(Ogee::command()).render(&mut page);
        written.expect("a page in memory can be written");
        data(page)?;
        return Ok(Exit::Done);
    };
    let written = std::fs::create_dir_all(folder)
        .and_then(|()| clap_mangen::generate_to(Ogee::command().disable_help_subcommand(true), folder));
    written.map_err(|error| {
        Failure::machine(format!("cannot write man pages into {}", folder.display()), reason(&error))
    })?;
    Ok(Exit::Done)
}
