//! The kind `skeleton`: a tree of parts, or a file of motion capture.

use super::joints::{JOINTS, parts};
use super::part::{Part, Sort};
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::skeleton::Skeleton;
use crate::lang::kinds::objects::existing_file;
use crate::lang::kinds::shapes::conflict;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Role, Type};
use crate::lang::value::Value;
use crate::scene::Rig;
use crate::scene::assets::mocap;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// A skeleton.
pub static SKELETON: Kind = Kind {
    name: "skeleton",
    doc: "A tree of joints with names, or one from a file of motion capture. Its values are those of a pose: the rest pose.",
    example: "skeleton arm { joint shoulder { hinge z  joint elbow { offset <5, 0, 0>  hinge z  tip hand { offset <4, 0, 0> } } } }",
    role: Role::Value,
    own: &[
        JOINTS,
        Property::new(
            "file",
            &[&[Type::Text]],
            "",
            "a .bvh file of motion capture, instead of joints: at rest all its channels are 0; an end is a tip `…_end`",
        ),
    ],
    children: false,
    open: false,
    build: Some(skeleton),
};

/// Bytes of a file that count as one element against the guard of lists: what its numbers take once read.
const BYTES_AN_ELEMENT: usize = 8;

fn skeleton(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let rig = match (block.has("file"), block.has("joint")) {
        (true, true) => return Err(conflict(ctx, block, "file", "joint")),
        (true, false) => captured(ctx, block)?,
        (false, true) => Arc::new(Rig::new(assembled(ctx, block)?, None, block.span)),
        (false, false) => {
            let said = Diagnostic::new(Code::MissingProperty, block.kind_span, "a `skeleton` needs a joint")
                .hint("write `skeleton arm { joint shoulder { hinge z } }`, or `skeleton man { file \"walk.bvh\" }`");
            return Err(ctx.fail(said));
        }
    };
    Ok(Value::Skeleton(rig))
}

/// A skeleton from its parts; every name that is there twice is said.
fn assembled(ctx: &mut dyn Context, block: &Block) -> Outcome<Skeleton> {
    let mut skeleton = Skeleton::default();
    let mut names: HashMap<Rc<str>, Span> = HashMap::new();
    let mut outcome = Ok(());
    let mut waiting: Vec<(Option<usize>, Rc<Part>)> =
        parts(block).into_iter().rev().map(|part| (None, part)).collect();
    while let Some((parent, part)) = waiting.pop() {
        ctx.reserve(1, block.kind_span)?;
        if let Some(first) = names.insert(part.name.clone(), part.name_span) {
            outcome = Err(ctx.fail(twice(&part, first)));
        }
        match (&part.sort, parent) {
            (Sort::Tip, Some(joint)) => {
                skeleton.add_tip(&part.name, joint, part.offset);
            }
            (Sort::Tip, None) => unreachable!("a skeleton takes joints alone"),
            (Sort::Joint { freedom, rest, limits, parts, .. }, parent) => {
                let joint =
                    skeleton.add_joint(&part.name, parent, part.offset, freedom.clone(), rest, limits);
                waiting.extend(parts.iter().rev().map(|part| (Some(joint), part.clone())));
            }
        }
    }
    outcome.map(|()| skeleton)
}

fn twice(part: &Part, first: Span) -> Diagnostic {
    let message = format!("two parts of this skeleton are called `{}`", part.name);
    let said = Diagnostic::new(Code::DuplicateName, part.name_span, message).label("again here");
    let said = if first == part.name_span { said } else { said.also(first, "first here") };
    said.hint("a pose speaks of joints by their names: give each its own")
}

/// The skeleton of a file, with its motion.
fn captured(ctx: &mut dyn Context, block: &Block) -> Outcome<Arc<Rig>> {
    let (written, span) = (block.text("file").unwrap_or_default(), block.place("file"));
    let path = existing_file(ctx, written, span)?;
    if let Some(known) = ctx.skeleton_read(&path, block.span) {
        return Ok(known);
    }
    let bytes = match ctx.loader().read(&path) {
        Ok(bytes) => bytes,
        Err(why) => {
            let message = format!("the motion capture file `{written}` cannot be read: {why}");
            return Err(ctx.fail(Diagnostic::new(Code::FileNotFound, span, message)));
        }
    };
    ctx.reserve(bytes.len() / BYTES_AN_ELEMENT, span)?;
    match mocap::read(bytes, super::is_reserved) {
        Ok((skeleton, motion)) => {
            let rig = Arc::new(Rig::new(skeleton, Some(motion), block.span));
            ctx.keep_skeleton(&path, &rig);
            Ok(rig)
        }
        Err(error) => {
            let message = format!("the motion capture file `{written}` cannot be used: {error}");
            let hint = "a .bvh file holds `HIERARCHY` with `ROOT` and `JOINT`s, then `MOTION` with a line of numbers a frame";
            Err(ctx.fail(Diagnostic::new(Code::BadMotion, span, message).hint(hint)))
        }
    }
}
