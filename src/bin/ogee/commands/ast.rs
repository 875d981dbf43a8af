//! `ogee ast`: how a scene was read.

use crate::args::{Ast, DataFormat};
use crate::speech::{Ended, Exit, data, show};
use ogee::session::Limits;
use ogee::syntax::print::{print, print_json};

/// Prints the syntax tree, also that of a scene with faults, and says the faults.
pub fn run(args: &Ast) -> Ended {
    let parsed = super::parsed(&args.file, Limits::default())?;
    show(&parsed.diagnostics, &parsed.sources);
    data(match args.format {
        DataFormat::Text => print(&parsed.tree),
        DataFormat::Json => format!("{}\n", print_json(&parsed.tree)),
    })?;
    Ok(if parsed.diagnostics.is_empty() { Exit::Done } else { Exit::Scene })
}
