//! The command line of `ogee bench rays`.

use super::threads;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// `ogee bench rays`.
#[derive(Args)]
pub struct Rays {
    /// The mesh, an .obj file
    #[arg(value_name = "MESH", value_hint = ValueHint::FilePath)]
    pub mesh: PathBuf,
    /// The tree, as the report of trees names it
    #[arg(long, value_name = "NAME", default_value = "bvh")]
    pub tree: String,
    /// Threads that build
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = threads)]
    pub threads: usize,
}
