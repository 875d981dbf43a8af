//! `ogee fmt`: the one canonical layout.

use crate::args::Fmt;
use crate::place::Place;
use crate::speech::{Ended, Exit, Failure, data, show, tell, tell_failure};
use ogee::diag::has_errors;
use ogee::syntax::format::format_source;
use std::path::Path;

/// Rewrites each file that is laid out otherwise, whole or not at all. A file that cannot be read, as text or as a scene,
/// is left alone and does not keep the others from being laid out.
pub fn run(args: &Fmt) -> Ended {
    let mut worst = Exit::Done;
    for file in &args.files {
        let exit = lay_out(file, args.check).unwrap_or_else(|failure| {
            tell_failure(&failure);
            failure.exit
        });
        worst = if exit as u8 > worst as u8 { exit } else { worst };
    }
    Ok(worst)
}

fn lay_out(file: &Path, only_check: bool) -> Ended {
    let parsed = super::parsed(file, ogee::session::Limits::default())?;
    if has_errors(&parsed.diagnostics) {
        show(&parsed.diagnostics, &parsed.sources);
        tell(format!("{} is left as it is", file.display()));
        return Ok(Exit::Scene);
    }
    let before = parsed.sources.text(parsed.id);
    let after = match format_source(parsed.id, before, parsed.limits) {
        Ok(after) => after,
        Err(diagnostics) => {
            show(&diagnostics, &parsed.sources);
            return Ok(Exit::Scene);
        }
    };
    let is_same = **before == *after;
    if only_check {
        if !is_same {
            tell(format!("{} is laid out otherwise", file.display()));
        }
        return Ok(if is_same { Exit::Done } else { Exit::Scene });
    }
    write(file, is_same, &after)
}

fn write(file: &Path, is_same: bool, text: &str) -> Result<Exit, Failure> {
    if file == Path::new("-") {
        data(text)?;
    } else if !is_same {
        Place::try_at(file)?.write(text.as_bytes())?;
    }
    Ok(Exit::Done)
}
