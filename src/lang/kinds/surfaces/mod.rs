//! Curved surfaces: patches, and surfaces along curves.

mod patches;
mod swept;

pub use patches::PATCH;
pub use swept::{EXTRUDE, LATHE, TUBE};
