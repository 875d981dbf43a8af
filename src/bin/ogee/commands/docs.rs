//! `ogee docs`: the reference, derived from the tables of the language.

use crate::args::Docs;
use crate::speech::{Ended, Exit, Failure, data};
use ogee::diag::nearest;
use ogee::lang::reference;

/// Prints the page of a name, or the whole reference as Markdown.
pub fn run(args: &Docs) -> Ended {
    data(match &args.name {
        None => reference::whole(),
        Some(name) => page(name)?,
    })?;
    Ok(Exit::Done)
}

/// The page of a name.
pub fn page(name: &str) -> Result<String, Failure> {
    reference::page(name).ok_or_else(|| unknown(name))
}

fn unknown(name: &str) -> Failure {
    let near = nearest(name, reference::names());
    let hint = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
    Failure::usage(format!(
        "there is no page on `{name}`\n{hint}`ogee docs` alone prints the whole reference"
    ))
}
