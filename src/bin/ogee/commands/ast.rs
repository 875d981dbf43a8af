//! `ogee ast`: how a scene was read.

use crate::args::{Ast, DataFormat};
use crate::speech::{Ended, Exit, Failure, data, show};
use ogee::session::Limits;
use ogee::syntax::ast::File;
use ogee::syntax::print::print;

/// Prints the syntax tree, also that of a scene with faults, and says the faults.
pub fn run(args: &Ast) -> Ended {
    let parsed = super::parsed(&args.file, Limits::default())?;
    show(&parsed.diagnostics, &parsed.sources);
    data(match args.format {
        DataFormat::Text => print(&parsed.tree),
        DataFormat::Json => format!("{}\n", json(&parsed.tree)?),
    })?;
    Ok(if parsed.diagnostics.is_empty() { Exit::Done } else { Exit::Scene })
}

fn json(tree: &File) -> Result<String, Failure> {
    serde_json::to_string(tree).map_err(|error| Failure::machine("cannot write the tree", error))
}
