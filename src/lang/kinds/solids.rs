//! Solids put together: union, intersection, difference.

use super::shapes::finish;
use crate::diag::Code;
use crate::lang::table::{Block, Context, Gives, Kind, Outcome, Property, Role, Type};
use crate::lang::value::{Given, Value};
use crate::scene::{Csg, CsgOp, Implicit, Node, SampleInput, Shape, solid_fault};
use std::collections::HashSet;
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

/// An implicit surface.
pub static IMPLICIT: Kind = Kind {
    name: "implicit",
    doc: "The surface where a function of the point is 0, solid where it is negative. The box cuts it, with a face where it cuts through the \
          solid. No root is missed, whatever the function: it is followed by interval arithmetic.",
    example: "implicit { f p => length(p) - 1  within <-1, -1, -1>, <1, 1, 1> }",
    role: Role::Object,
    own: &[
        Property::new(
            "f",
            &[&[Type::Function]],
            "",
            "the function of the point, negative inside; it runs while rendering",
        )
        .required(),
        Property::new(
            "within",
            &[&[Type::Vector3, Type::Vector3]],
            "",
            "`min, max`: the corners of least and of greatest coordinates of the box in which it is looked for",
        )
        .required(),
        Property::new(
            "gradient",
            &[&[Type::Positive]],
            "",
            "a promise that the length of f's gradient in the box does not exceed this: skips empty space sooner. It is checked at \
             many points, and never needed",
        ),
    ],
    children: false,
    open: false,
    build: Some(implicit),
};

fn implicit(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let corners = block.vectors("within").expect("checked to be there");
    let within = (corners[0], corners[1]);
    let size = within.1 - within.0;
    let mut outcome = Ok(());
    if !(size.min_element() > 0.0 && size.is_finite()) {
        let message = "the first corner of `within` must be less than the second in each coordinate";
        let hint = "write the least corner, then the greatest: `within <-1, -1, -1>, <1, 1, 1>`";
        outcome = Err(block.fault(ctx, Code::BadGeometry, "within", message, hint));
    }
    let f = block.value("f").expect("checked to be there").clone();
    let function = ctx.sampled(&f, SampleInput::Point, Gives::Components(&[1]), block.place("f"))?;
    outcome?;
    let gradient = block.number("gradient").map(|bound| (bound, block.place("gradient")));
    finish(ctx, block, Shape::Implicit(Arc::new(Implicit { function, within, gradient })))
}

/// The kind of an operation.
pub fn kind_of(op: CsgOp) -> &'static Kind {
    match op {
        CsgOp::Union => &UNION,
        CsgOp::Intersection => &INTERSECTION,
        CsgOp::Difference => &DIFFERENCE,
    }
}

fn build(ctx: &mut dyn Context, block: &mut Block, op: CsgOp) -> Outcome {
    let children = std::mem::take(&mut block.children);
    check_solids(ctx, &children)?;
    let inverse = block.flag("inverse").unwrap_or(false);
    finish(ctx, block, Shape::Csg(Arc::new(Csg { op, inverse, children: children.into() })))
}

/// Reports all that are no solids, those inside groups too.
pub fn check_solids(ctx: &mut dyn Context, nodes: &[Node]) -> Outcome<()> {
    let mut outcome = Ok(());
    let mut seen = HashSet::new();
    let mut rest: Vec<&Node> = nodes.iter().rev().collect();
    while let Some(node) = rest.pop() {
        if let Some(fault) = solid_fault(node) {
            outcome = Err(ctx.fail(fault));
        }
        if let Node::Object(object) = node
            && let Shape::Group(nodes) = &object.shape
            && seen.insert(nodes.as_ptr())
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
