//! `ogee eval`: the value of an expression.

use crate::args::Eval;
use crate::speech::{Ended, Exit, data, show};
use ogee::diag::Severity;

/// Prints the value, or says why there is none.
pub fn run(args: &Eval) -> Ended {
    let mut session = super::session(&args.evaluation);
    if let Some(file) = &args.file {
        super::try_to_read(file)?;
    }
    let (value, diagnostics) = session.evaluate_expression(&args.expression, args.file.as_deref());
    show(&diagnostics, &session.sources);
    if let Some(value) = value {
        data(format!("{}\n", value.text(args.digits.map(usize::from))))?;
    }
    let failed = diagnostics.iter().any(|d| d.severity == Severity::Error);
    Ok(if failed { Exit::Scene } else { Exit::Done })
}
