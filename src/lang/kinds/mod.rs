//! The table of kinds: every block of the language with its properties and, where it is built, what it becomes.
//!
//! The evaluator uses [`find`] to look a kind up, [`make`] to turn a block into a value, and [`with::apply`] for
//! `e with { … }`. A new kind is one entry here and its word in the grammar.

pub mod common;
mod energy;
mod lights;
mod materials;
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
mod unbuilt;
pub mod with;

pub use objects::existing_file;
pub use rigs::{Part, unknown_tip};

use super::check;
use super::table::{Block, Context, Kind, Outcome, Reported, Role};
use super::value::Value;
use crate::diag::{Code, Diagnostic, Span};
use crate::scene::{Object, Shape};
use std::sync::Arc;

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
    &unbuilt::MODEL,
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

/// Checks a block against the table and makes its value. An object of a kind that is not built yet is an empty group;
/// any other such value is a warning and then silence.
pub fn make(ctx: &mut dyn Context, mut block: Block) -> Outcome {
    let unbuilt = block.kind.build.is_none();
    if unbuilt {
        ctx.report(not_built(block.kind, block.kind_span));
    }
    let poisoned = !block.poisoned.is_empty();
    let checked = check::check_block(ctx, &mut block);
    match block.kind.build {
        Some(build) => {
            checked?;
            build(ctx, block)
        }
        None if block.kind.role == Role::Object && (checked.is_ok() || poisoned) => {
            Ok(empty_group(block.span))
        }
        None => Err(Reported),
    }
}

fn empty_group(span: Span) -> Value {
    Value::Object(Arc::new(Object::new(Shape::Group(Arc::new([])), span)))
}

fn not_built(kind: &Kind, span: Span) -> Diagnostic {
    let said = Diagnostic::new(Code::NotBuilt, span, format!("`{}` is not built yet", kind.name));
    match kind.role {
        Role::Object => said.label("left out of the picture"),
        _ => said.label("what uses it is left out"),
    }
}
