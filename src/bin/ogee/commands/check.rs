//! `ogee check`: everything that is wrong with scenes, and no picture.

use crate::args::{Check, DiagnosticFormat};
use crate::speech::{Ended, Exit, data, show, tell, tell_failure};
use ogee::diag::render::{Counts, json, short};
use ogee::session::whole;

/// Checks each file in turn; a file that cannot be read does not keep the others from being checked.
pub fn run(args: &Check) -> Ended {
    let mut session = super::session(&args.evaluation);
    let mut diagnostics = Vec::new();
    let mut unreadable = None;
    for file in &args.files {
        match super::evaluate(&mut session, file) {
            Ok(evaluated) => {
                // A scene in part lacks what its faults took away; only of a sound one can be told what it lacks.
                let lacks =
                    if evaluated.has_errors() { Vec::new() } else { whole::faults(&evaluated.scene, false) };
                diagnostics.extend(evaluated.diagnostics.into_iter().chain(lacks));
            }
            Err(failure) => {
                tell_failure(&failure);
                unreadable.get_or_insert(failure.exit);
            }
        }
    }
    let counts = Counts::of(&diagnostics);
    match args.format {
        DiagnosticFormat::Human => show(&diagnostics, &session.sources),
        DiagnosticFormat::Json => data(json(&diagnostics, &session.sources))?,
        DiagnosticFormat::Short => {
            eprint(&short(&diagnostics, &session.sources));
            if !diagnostics.is_empty() {
                tell(counts);
            }
        }
    }
    Ok(unreadable.unwrap_or(if counts.errors > 0 { Exit::Scene } else { Exit::Done }))
}

fn eprint(text: &str) {
    text.lines().for_each(tell);
}
