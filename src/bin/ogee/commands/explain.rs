//! `ogee explain`: what a code means, with a broken and a mended scene.

use crate::args::Explain;
use crate::speech::{Ended, Exit, Failure, data};
use ogee::diag::{Code, nearest};

/// Prints the page of a code, or the list of all codes.
pub fn run(args: &Explain) -> Ended {
    let Some(text) = &args.code else {
        data(list())?;
        return Ok(Exit::Done);
    };
    let code = Code::from_text(text.trim()).ok_or_else(|| unknown(text))?;
    data(format!("# {}: {}\n\n{}\n", code.text(), code.title(), code.explanation().trim()))?;
    Ok(Exit::Done)
}

fn list() -> String {
    Code::ALL.iter().map(|code| format!("{}  {}\n", code.text(), code.title())).collect()
}

fn unknown(text: &str) -> Failure {
    let near = nearest(text, Code::ALL.iter().map(|code| code.text()));
    let hint = near.map_or(String::new(), |near| format!("did you mean {near}? "));
    Failure::usage(format!("there is no code `{text}`\n{hint}`ogee explain` alone lists them all"))
}
