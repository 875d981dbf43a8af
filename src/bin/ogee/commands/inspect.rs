//! `ogee inspect`: what a scene evaluates to.

use crate::args::{DataFormat, Inspect};
use crate::speech::{Ended, Exit, data, show};
use ogee::session::inspect;

/// Prints the hierarchy of what could be made of the scene, and says its faults.
pub fn run(args: &Inspect) -> Ended {
    let mut session = super::session(&args.evaluation);
    let evaluated = super::evaluate(&mut session, &args.file)?;
    show(&evaluated.diagnostics, &session.sources);
    data(match args.format {
        DataFormat::Text => inspect::text(&evaluated.scene, &session.sources),
        DataFormat::Json => inspect::json(&evaluated.scene, &session.sources),
    })?;
    Ok(if evaluated.has_errors() { Exit::Scene } else { Exit::Done })
}
