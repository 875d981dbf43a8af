//! The table of kinds: every block of the language with its properties and, where it is built, what it becomes.
//!
//! The evaluator uses [`find`] to look a kind up, [`make`] to turn a block into a value, and [`with::apply`] for
//! `e with { … }`. A new kind is one entry here and its word in the grammar.

pub mod common;
mod energy;
mod lights;
mod materials;
pub mod models;
mod objects;
mod read;
mod rigs;
mod settings;
mod shapes;
mod skins;
mod solids;
pub mod splines;
mod surfaces;
#[cfg(test)]
mod tests;
pub mod with;

pub use objects::existing_file;
pub use rigs::{Part, unknown_tip};

use super::check;
use super::table::{Block, Context, Kind, Outcome};

/// Every kind, in the order of the reference.
pub static ALL: &[&Kind] = &[
    &settings::CAMERA,
    &settings::RENDER,
    &lights::LIGHT,
    &materials::MATERIAL,
    &shapes::SPHERE,
    &shapes::PLANE,
    &shapes::DISC,
    &shapes::RECT,
    &shapes::BOX,
    &shapes::CYLINDER,
    &shapes::CONE,
    &shapes::TORUS,
    &shapes::TRIANGLE,
    &objects::MESH,
    &objects::GROUP,
    &splines::SPLINE,
    &surfaces::PATCH,
    &surfaces::TUBE,
    &surfaces::LATHE,
    &surfaces::EXTRUDE,
    &solids::IMPLICIT,
    &solids::UNION,
    &solids::INTERSECTION,
    &solids::DIFFERENCE,
    &skins::SKIN,
    &models::MODEL,
    &rigs::SKELETON,
    &rigs::JOINT,
    &rigs::TIP,
    &rigs::POSE,
];

/// The kind of this word.
pub fn find(name: &str) -> Option<&'static Kind> {
    ALL.iter().copied().find(|kind| kind.name == name)
}

/// Whether some kind has a property of this name that takes this word bare: in a body whose block is not known yet,
/// such a word stands for itself.
pub fn is_word_of(property: &str, word: &str) -> bool {
    ALL.iter().filter_map(|kind| kind.property(property)).any(|p| p.words().any(|w| w == word))
}

/// The kind that a function's body becomes when it places objects.
pub fn group() -> &'static Kind {
    &objects::GROUP
}

/// Checks a block against the table and makes its value.
pub fn make(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    check::check_block(ctx, block)?;
    let build = block.kind.build.expect("every kind of the table is built");
    build(ctx, block)
}
