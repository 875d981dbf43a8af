//! `ogee ast`: how a scene was read.

use crate::args::Ast;
use crate::speech::{Ended, Failure};

/// Prints the syntax tree, also that of a scene with faults, and says the faults.
pub fn run(args: &Ast) -> Ended {
    super::read(&args.file)?;
    Err(Failure::not_built("`ogee ast`"))
}
