//! `ogee docs`: the reference, derived from the tables of the language.

use crate::args::Docs;
use crate::speech::{Ended, Failure};

/// Prints a page, or all of them.
pub fn run(args: &Docs) -> Ended {
    let _ = &args.name;
    Err(Failure::not_built("`ogee docs`"))
}
