//! `ogee test`: the asserts of scenes, and their parse and picture against the snapshots beside them.

use crate::args::Test;
use crate::speech::{Ended, Failure};

/// Tests each scene of the paths.
pub fn run(args: &Test) -> Ended {
    let _ = (&args.paths, args.bless, &args.evaluation);
    Err(Failure::not_built("`ogee test`"))
}
