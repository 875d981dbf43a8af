//! `ogee inspect`: what a scene evaluates to.

use crate::args::Inspect;
use crate::speech::{Ended, Exit, Failure, show};

/// Prints the hierarchy of what could be made of the scene, and says its faults.
pub fn run(args: &Inspect) -> Ended {
    let mut session = super::session(&args.evaluation);
    let evaluated = super::evaluate(&mut session, &args.file)?;
    show(&evaluated.diagnostics, &session.sources);
    if evaluated.has_errors() {
        return Ok(Exit::Scene);
    }
    Err(Failure::not_built("`ogee inspect`"))
}
