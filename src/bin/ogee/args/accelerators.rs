//! The command line of `ogee bench accelerators`.

use clap::{Args, ValueHint};
use std::path::PathBuf;

/// `ogee bench accelerators`.
#[derive(Args)]
pub struct Accelerators {
    /// Meshes in .obj files, besides those that are made
    #[arg(value_name = "MESH", value_hint = ValueHint::FilePath)]
    pub meshes: Vec<PathBuf>,
    /// Within a minute
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// Up to ten million triangles and sixteen million pixels, for the record
    #[arg(long)]
    pub full: bool,
    /// Folder for index.md, plots and results
    #[arg(long, value_name = "DIR", default_value = "report-accelerators", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
}
