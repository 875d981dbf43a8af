//! The members of curves. The kernels of [`crate::geometry`] compute; here are names, documentation and the wording of faults.

mod faults;
mod numeric;
mod parts;

use super::{Ask, Family, Form, Member};
use crate::geometry::any_curve::AnyCurve;
use crate::lang::table::Parameter;
use crate::lang::value::Value;
pub use numeric::point_at;
use numeric::{numeric, sampled};

const T: &[Parameter] = &[Parameter::new("t", "a number")];
const S: &[Parameter] = &[Parameter::new("s", "a number")];
const I: &[Parameter] = &[Parameter::new("i", "a whole number")];

/// Curves.
pub static FAMILY: Family = Family {
    name: "curve",
    doc: "What `spline` and `curve(t => …, a, b)` give: a function of its parameter, with what geometry knows of it. Outside its domain, by \
          more than rounding, it is undefined.",
    holds: |value| matches!(value, Value::Curve(_)),
    scene: "let path = spline { bezier <0, 0, 0>, <1, 0, 0>, <2, 0, 0>, <3, 0, 0>, <3, 1, 0>, <3, 2, 0>, <3, 3, 0> }\n\
            let arch = spline { bezier <0, 0, 0>, <0, 1, 0>, <2, 1, 0>, <2, 0, 0> }",
    members: MEMBERS,
    named: None,
};

static MEMBERS: &[Member] = &[
    Member {
        name: "",
        form: Form::Call,
        parameters: T,
        doc: "The point at t. Exact to half a unit in the last place.",
        example: ("path(0.25)", "<1.5, 0, 0>"),
        body: numeric::at,
        sampled: Some(sampled::<numeric::At>),
    },
    numeric::<numeric::Velocity>(
        "velocity",
        T,
        "The derivative at t, per unit of the parameter; where two pieces meet, that of the one after.",
        ("path.velocity(0.25)", "<6, 0, 0>"),
    ),
    numeric::<numeric::Acceleration>(
        "acceleration",
        T,
        "The second derivative at t.",
        ("arch.acceleration(0)", "<12, -6, 0>"),
    ),
    numeric::<numeric::Tangent>(
        "tangent",
        T,
        "The unit vector along the curve at t; where it stands still, the direction in which it goes on.",
        ("path.tangent(0.25)", "<1, 0, 0>"),
    ),
    numeric::<numeric::Normal>(
        "normal",
        T,
        "The unit vector at right angles to the tangent, toward the centre of curvature; on a straight stretch some vector across.",
        ("arch.normal(0.5)", "<0, -1, 0>"),
    ),
    numeric::<numeric::Binormal>(
        "binormal",
        T,
        "Tangent × normal, of a curve of 3-vectors.",
        ("arch.binormal(0.5)", "<0, 0, -1>"),
    ),
    numeric::<numeric::Curvature>(
        "curvature",
        T,
        "1 / radius of the circle that fits best at t, per scene unit; 0 where the curve is straight or stands still.",
        ("arch.curvature(0.5)", "0.6666666666666666"),
    ),
    numeric::<numeric::Torsion>(
        "torsion",
        T,
        "How fast a curve of 3-vectors leaves its plane at t, per scene unit; 0 where it has no curvature.",
        ("arch.torsion(0.5)", "0"),
    ),
    Member::method(
        "frame",
        &[Parameter::new("t", "a number"), Parameter::new("up", "a 3-vector").or("y")],
        "The rotation-minimising frame at t as a transform, for `matrix`: x to the side, z along the tangent, y as near to `up` at the start \
         as it can be. Along a closed curve it closes up.",
        ("path.frame(0)", "a transform"),
        parts::frame,
    ),
    Member::field(
        "length",
        "The length of the whole curve, scene units.",
        ("path.length", "6"),
        parts::length,
    ),
    Member::method(
        "length",
        &[Parameter::new("a", "a number"), Parameter::new("b", "a number")],
        "The length from parameter a to b; negative where b is before a.",
        ("path.length(0.5, 1)", "3"),
        parts::length_between,
    ),
    numeric::<numeric::AtLength>(
        "at_length",
        S,
        "The point at a length from the start.",
        ("path.at_length(1.5)", "<1.5, 0, 0>"),
    ),
    numeric::<numeric::ParameterAt>(
        "parameter_at",
        S,
        "The parameter at a length from the start.",
        ("path.parameter_at(4.5)", "0.75"),
    ),
    numeric::<numeric::Closest>(
        "closest",
        &[Parameter::new("p", "a point like those of the curve")],
        "The nearest place to a point: `.t` is its parameter, `.point` the point of the curve, `.distance` how far it is; of several the \
         one with the least t.",
        ("path.closest(<1.5, 1, 0>).point", "<1.5, 0, 0>"),
    ),
    Member::field(
        "bounds",
        "The corners of the smallest box around it: [least, greatest].",
        ("arch.bounds", "[<0, 0, 0>, <2, 0.7500000000000001, 0>]"),
        parts::bounds,
    ),
    Member::field(
        "domain",
        "The first and the last parameter: [a, b].",
        ("path.domain", "[0, 1]"),
        parts::domain,
    ),
    Member::field(
        "closed",
        "Whether the end runs on into the start.",
        ("path.closed", "false"),
        parts::closed,
    ),
    Member::field(
        "knots",
        "The parameters at which pieces meet, with both ends.",
        ("path.knots", "[0, 0.5, 1]"),
        parts::knots,
    ),
    Member::field(
        "pieces",
        "The list of its pieces, each a curve over its own part of the parameter.",
        ("len(path.pieces)", "2"),
        parts::pieces,
    ),
    Member::method(
        "piece",
        I,
        "Piece i, from 0, as a curve over its own part of the parameter; −1 is the last.",
        ("path.piece(1).domain", "[0.5, 1]"),
        parts::piece,
    ),
    Member::field(
        "points",
        "The control points that it was given, or that the change to another basis gave.",
        ("path.piece(1).points", "[<3, 0, 0>, <3, 1, 0>, <3, 2, 0>, <3, 3, 0>]"),
        parts::points,
    ),
    Member::method(
        "split",
        T,
        "The parts before and after t, each over its part of the parameter: [before, after].",
        ("path.split(0.25)[1].domain", "[0.25, 1]"),
        parts::split,
    ),
    Member::field(
        "reverse",
        "The same way backwards, over the same domain.",
        ("path.reverse(0)", "<3, 3, 0>"),
        parts::reverse,
    ),
    Member::method(
        "blossom",
        &[Parameter::new("a", "a number"), Parameter::new("b", "a number"), Parameter::new("c", "a number")],
        "The blossom of a curve of one piece: symmetric, affine in each argument, `path(t)` where all three are t.",
        ("arch.blossom(0, 0, 1)", "<0, 1, 0>"),
        parts::blossom,
    ),
    Member::method(
        "to",
        &[Parameter::new("basis", "\"bezier\", \"bspline\", \"hermite\", \"catmull_rom\" or \"monomial\"")],
        "The same curve with the control points of another basis. Where pieces do not share points there, each has four of its own; those \
         of \"monomial\" and \"hermite\" belong to a parameter from 0 to 1 along each piece.",
        ("arch.to(\"monomial\").points[1]", "<0, 3, 0>"),
        parts::to,
    ),
    Member::field(
        "continuity",
        "How smoothly it runs through each seam: a list of \"C2\", \"C1\", \"G1\", \"C0\" and the like; of a closed curve the last is where it \
         closes. C is of derivatives, G of direction and curvature.",
        ("path.continuity", "[\"C0\"]"),
        parts::continuity,
    ),
];

/// The curve that is asked.
fn curve<'a>(ask: &'a Ask<'_>) -> &'a AnyCurve {
    match ask.value {
        Value::Curve(curve) => curve,
        _ => unreachable!("a member of curves is asked of curves"),
    }
}
