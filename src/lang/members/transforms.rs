//! The members of transforms: what `path.frame(t)` gives, taken apart.

use super::{Ask, Family, Form, Member};
use crate::lang::table::{Context, Outcome, Parameter};
use crate::lang::value::Value;
use crate::math::Affine;
use glam::DVec3;
use std::rc::Rc;

/// Transforms.
pub static FAMILY: Family = Family {
    name: "transform",
    doc: "What `path.frame(t)` gives: a motion, scale or shear of space, for the property `matrix`. It is a function of a point.",
    holds: |value| matches!(value, Value::Transform(_)),
    scene: "spline path { bezier <1, 0, 0>, <1, 0, 1>, <1, 0, 2>, <1, 0, 3> }\nlet frame = path.frame(0)",
    members: &[
        Member {
            name: "",
            form: Form::Call,
            parameters: &[Parameter::new("p", "a 3-vector")],
            doc: "Where the point p goes.",
            example: ("frame(<0, 0, 2>)", "<1, 0, 2>"),
            body: |ctx, ask| Ok(Value::Vector3(transform(ask).point(ask.vector(ctx, 0)?))),
            sampled: None,
        },
        Member::field("origin", "Where <0, 0, 0> goes.", ("frame.origin", "<1, 0, 0>"), |_, ask| {
            vector(transform(ask).translation)
        }),
        Member::field(
            "x",
            "Where the direction x goes.",
            ("distance(frame.x, x) < 1e-15", "true"),
            |_, ask| vector(transform(ask).linear.x_axis),
        ),
        Member::field(
            "y",
            "Where the direction y goes.",
            ("distance(frame.y, y) < 1e-15", "true"),
            |_, ask| vector(transform(ask).linear.y_axis),
        ),
        Member::field("z", "Where the direction z goes.", ("frame.z", "<0, 0, 1>"), |_, ask| {
            vector(transform(ask).linear.z_axis)
        }),
        Member::field(
            "inverse",
            "The transform back.",
            ("distance(frame.inverse(<1, 2, 0>), <0, 2, 0>) < 1e-15", "true"),
            inverse,
        ),
    ],
    named: None,
};

fn transform<'a>(ask: &'a Ask<'_>) -> &'a Affine {
    match ask.value {
        Value::Transform(transform) => transform,
        _ => unreachable!("a member of transforms is asked of transforms"),
    }
}

fn vector(v: DVec3) -> Outcome {
    Ok(Value::Vector3(v))
}

fn inverse(_: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    Ok(Value::Transform(Rc::new(transform(ask).inverse())))
}
