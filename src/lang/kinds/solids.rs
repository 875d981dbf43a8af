//! Solids put together: union, intersection, difference.

use super::shapes::finish;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Role, Type};
use crate::lang::value::{Given, Value};
use crate::scene::{Csg, CsgOp, Node, Shape, solid_fault};
use std::sync::Arc;

const INVERSE: &[Property] =
    &[Property::new("inverse", &[&[], &[Type::Bool]], "off", "the outside becomes the inside")];

const fn put_together(
    name: &'static str,
    doc: &'static str,
    example: &'static str,
    build: crate::lang::table::Build,
) -> Kind {
    Kind {
        name,
        doc,
        example,
        role: Role::Object,
        own: INVERSE,
        children: true,
        open: false,
        build: Some(build),
    }
}

/// What is in any.
pub static UNION: Kind = put_together(
    "union",
    "What is inside any of its solids: walls between them are gone.",
    "union { sphere { radius 1 }  box { min <0, 0, 0>  max <1, 1, 1> } }",
    |ctx, block| build(ctx, block, CsgOp::Union),
);

/// What is in all.
pub static INTERSECTION: Kind = put_together(
    "intersection",
    "What is inside all of its solids.",
    "intersection { sphere { radius 1 }  box { min <0, 0, 0>  max <1, 1, 1> } }",
    |ctx, block| build(ctx, block, CsgOp::Intersection),
);

/// What is in the first alone.
pub static DIFFERENCE: Kind = put_together(
    "difference",
    "What is inside the first of its solids and outside all others.",
    "difference { sphere { radius 1 }  box { min <0, 0, 0>  max <1, 1, 1> } }",
    |ctx, block| build(ctx, block, CsgOp::Difference),
);

/// The kind of an operation.
pub fn kind_of(op: CsgOp) -> &'static Kind {
    match op {
        CsgOp::Union => &UNION,
        CsgOp::Intersection => &INTERSECTION,
        CsgOp::Difference => &DIFFERENCE,
    }
}

fn build(ctx: &mut dyn Context, mut block: Block, op: CsgOp) -> Outcome {
    let children = std::mem::take(&mut block.children);
    check_solids(ctx, &children)?;
    let inverse = block.flag("inverse").unwrap_or(false);
    finish(ctx, &block, Shape::Csg(Arc::new(Csg { op, inverse, children: children.into() })))
}

/// Reports all that are no solids, those inside groups too.
pub fn check_solids(ctx: &mut dyn Context, nodes: &[Node]) -> Outcome<()> {
    let mut outcome = Ok(());
    let mut rest: Vec<&Node> = nodes.iter().rev().collect();
    while let Some(node) = rest.pop() {
        if let Some(fault) = solid_fault(node) {
            outcome = Err(ctx.fail(fault));
        }
        if let Node::Object(object) = node
            && let Shape::Group(nodes) = &object.shape
        {
            rest.extend(nodes.iter().rev());
        }
    }
    outcome
}

/// A copy with more solids.
pub fn with_more(ctx: &mut dyn Context, shape: &Shape, more: Vec<Node>) -> Outcome<Shape> {
    let Shape::Csg(csg) = shape else { return Ok(shape.clone()) };
    check_solids(ctx, &more)?;
    let children = csg.children.iter().cloned().chain(more).collect();
    Ok(Shape::Csg(Arc::new(Csg { op: csg.op, inverse: csg.inverse, children })))
}

/// A copy with inside and outside exchanged or not, as a checked property says.
pub fn with_inverse(shape: &Shape, given: &Given) -> Shape {
    let Shape::Csg(csg) = shape else { return shape.clone() };
    let inverse = !matches!(given.values.first(), Some((Value::Bool(false), _)));
    let csg = Csg { op: csg.op, inverse, children: Arc::clone(&csg.children) };
    Shape::Csg(Arc::new(csg))
}
