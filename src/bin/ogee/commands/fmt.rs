//! `ogee fmt`: the one canonical layout.

use crate::args::Fmt;
use crate::speech::{Ended, Failure};

/// Rewrites each file that is laid out otherwise, whole or not at all.
pub fn run(args: &Fmt) -> Ended {
    let _ = args.check;
    for file in &args.files {
        super::read(file)?;
    }
    Err(Failure::not_built("`ogee fmt`"))
}
