//! The kind `pose`: a skeleton with angles that are given by its joints' names, taken from motion capture, or found by reaching.

use super::{range, reach};
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::skeleton::{Skeleton, Turning};
use crate::lang::coerce::number;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Role, Type};
use crate::lang::value::{Given, Value};
use crate::lang::{check, coerce};
use crate::scene::{Pose, Stance};
use std::sync::Arc;

/// A pose.
pub static POSE: Kind = Kind {
    name: "pose",
    doc: "A skeleton with angles for its joints, given by their names, taken from motion capture, or found by inverse kinematics, in this order: \
          a reach starts from what is given. A hinge and a slide take a number, a universal joint a 2-vector, a ball a 3-vector; a free joint \
          its angles, or its shift and its angles.",
    example: "skeleton arm { joint shoulder { hinge z  joint elbow { offset <5, 0, 0>  hinge z  tip hand { offset <4, 0, 0> } } } }\n\
              pose bent { of arm  shoulder -30  elbow 90 }\n\
              pose touch { of arm  reach hand, <6, 3, 0>  method dls }",
    role: Role::Value,
    own: &[
        Property::new(
            "of",
            &[&[Type::Skeleton], &[Type::Pose]],
            "",
            "the skeleton; or a pose, from whose angles this one starts",
        )
        .required(),
        Property::new(
            "at",
            &[&[Type::NUMBER]],
            "",
            "the moment of motion capture, in seconds; it stands still before its first and after its last frame. Without it, at rest",
        ),
        Property::new(
            "reach",
            &[&[Type::Label, Type::Vector3]],
            "",
            "a tip, and the point where it should be. In an animation it goes on from where it ended in the frame before, but for angles that are \
             given otherwise there; with `at`, from its moment",
        )
        .repeats(),
        Property::new(
            "weight",
            &[&[Type::NON_NEGATIVE]],
            "1",
            "of the target before it, where not all can be reached: of its squared distance",
        )
        .repeats(),
        Property::new(
            "toward",
            &[&[Type::Direction]],
            "",
            "where the tip before it should point; a degree off counts as much as the \
                      longest chain's length turned by it",
        )
        .repeats(),
        Property::new(
            "method",
            &[&[Type::Word(&["jacobian_transpose", "pseudo_inverse", "dls", "ccd"])]],
            "dls",
            "how the angles are found: down the gradient, by the pseudo-inverse, by damped least squares, or joint by joint",
        ),
        Property::new(
            "iterations",
            &[&[Type::Integer { min: 1 }]],
            "200",
            "most steps of one descent; 100000 are the most that are made",
        ),
        Property::new(
            "tolerance",
            &[&[Type::Positive]],
            "1e-9",
            "distance from a target that is good enough, in scene units; of `toward`, in radians",
        ),
    ],
    children: false,
    open: true,
    build: Some(pose),
};

fn pose(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let from = match block.value("of") {
        Some(Value::Skeleton(rig)) => Stance::Rest(rig.clone()),
        Some(Value::Pose(pose)) => Stance::Posed(pose.clone()),
        _ => unreachable!("checked to be a skeleton or a pose"),
    };
    let mut coordinates = captured(ctx, block, &from)?;
    let joints = given_joints(ctx, block, &from.rig().skeleton, &mut coordinates);
    let asked = reach::asked(ctx, block, &from.rig().skeleton);
    joints?;
    let reached = match asked? {
        Some(asked) => Some(reach::reach(ctx, &asked, block, &from.rig().skeleton, &mut coordinates)?),
        None => None,
    };
    Ok(Value::Pose(Arc::new(Pose::new(from.rig().clone(), coordinates, reached, block.span))))
}

/// The coordinates to start from: a moment of motion capture, or those of what the pose is of.
fn captured(ctx: &mut dyn Context, block: &Block, from: &Stance) -> Outcome<Vec<f64>> {
    let (seconds, motion) = (block.number("at"), &from.rig().motion);
    match (seconds, motion) {
        (Some(seconds), Some(motion)) => Ok(motion.at(seconds)),
        (None, _) => Ok(from.coordinates().to_vec()),
        (Some(_), None) => {
            Err(block.fault(ctx, Code::BadProperty, "at", "this skeleton has no motion", MOVING))
        }
    }
}

/// What has a moment to ask for.
const MOVING: &str = "only motion capture moves a skeleton, as in `skeleton man { file \"walk.bvh\" }`; for a clip of a model write \
                      `let man = model { file \"man.glb\"  clip \"walk\"  at 0.6 }`, and pose `man.skeleton`";

/// Puts the angles that are given by joints' names into the coordinates. Every fault is reported.
fn given_joints(
    ctx: &mut dyn Context,
    block: &mut Block,
    skeleton: &Skeleton,
    coordinates: &mut [f64],
) -> Outcome<()> {
    let mut outcome = Ok(());
    let mut seen: Vec<(usize, Span)> = Vec::new();
    for given in block.given.iter_mut().filter(|given| POSE.property(&given.name).is_none()) {
        let set = given_joint(ctx, given, skeleton, coordinates, &seen);
        seen.extend(skeleton.joint(&given.name).map(|joint| (joint, given.name_span)));
        outcome = outcome.and(set);
    }
    outcome
}

fn given_joint(
    ctx: &mut dyn Context,
    given: &mut Given,
    skeleton: &Skeleton,
    coordinates: &mut [f64],
    seen: &[(usize, Span)],
) -> Outcome<()> {
    let Some(joint) = skeleton.joint(&given.name) else {
        let said = unknown_joint(skeleton, &given.name, given.name_span);
        return Err(ctx.fail(said));
    };
    if let Some((_, first)) = seen.iter().find(|(other, _)| *other == joint) {
        let message = format!("`{}` is given twice", given.name);
        let said = Diagnostic::new(Code::DuplicateProperty, given.name_span, message)
            .also(*first, "first here")
            .hint("keep one of the two");
        return Err(ctx.fail(said));
    }
    for (turning, value, span) in values(ctx, given, skeleton, joint)? {
        for (place, x) in skeleton.coordinates_of(joint, turning).into_iter().zip(value) {
            coordinates[place] = x;
            check_limits(ctx, skeleton, (&given.name, place), x, span)?;
        }
    }
    Ok(())
}

/// What a joint is given: its shift, its angles, or both.
fn values(
    ctx: &mut dyn Context,
    given: &mut Given,
    skeleton: &Skeleton,
    joint: usize,
) -> Outcome<Vec<(Turning, Vec<f64>, Span)>> {
    let count = |turning| skeleton.coordinates_of(joint, turning).len();
    let (n_moves, n_turns) = (count(Turning::Move), count(Turning::Turn));
    let sorts: &[(Turning, usize)] = match (n_moves, n_turns, given.values.len()) {
        (0, 0, _) => return Err(ctx.fail(fixed(given))),
        (0, n, 1) => &[(Turning::Turn, n)],
        (n, 0, 1) => &[(Turning::Move, n)],
        (_, n, 1) => &[(Turning::Turn, n)],
        (m, n, 2) if m > 0 && n > 0 => &[(Turning::Move, m), (Turning::Turn, n)],
        _ => return Err(ctx.fail(wrong_count(given, n_moves, n_turns))),
    };
    let mut values = Vec::with_capacity(sorts.len());
    for ((turning, n), (value, span)) in sorts.iter().zip(&mut given.values) {
        let kind = [Type::NUMBER, Type::Vector2, Type::Vector3][n.clamp(&1, &3) - 1];
        check::coerce_or_report(ctx, &given.name, &[kind], value, *span)?;
        values.push((*turning, numbers(value), *span));
    }
    Ok(values)
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Number(x) => vec![*x],
        Value::Vector2(v) => v.to_array().to_vec(),
        Value::Vector3(v) => v.to_array().to_vec(),
        _ => unreachable!("checked to be a number or vector"),
    }
}

fn fixed(given: &Given) -> Diagnostic {
    let message = format!("`{}` is fixed: it takes no angle", given.name);
    Diagnostic::new(Code::BadProperty, given.name_span, message)
        .hint("give it a freedom where it is defined: `hinge z`")
}

fn wrong_count(given: &Given, n_moves: usize, n_turns: usize) -> Diagnostic {
    let name = &given.name;
    let form = match (n_moves, n_turns) {
        (0 | 1, 0 | 1) if n_moves + n_turns == 1 => format!("{name} 30"),
        (0, 2) => format!("{name} <30, 0>"),
        (0, _) | (_, 0) => format!("{name} <30, 0, 0>"),
        _ => format!("{name} <0, 1, 0>, <30, 0, 0>` for shift and angles, or `{name} <30, 0, 0>"),
    };
    let message = format!("`{name}` is given {} values", given.values.len());
    let place = given.values.last().map_or(given.name_span, |_| given.span());
    Diagnostic::new(Code::BadProperty, place, message).hint(format!("write it like `{form}`"))
}

fn check_limits(
    ctx: &mut dyn Context,
    skeleton: &Skeleton,
    (name, place): (&str, usize),
    x: f64,
    span: Span,
) -> Outcome<()> {
    let limits = skeleton.limits()[place];
    if limits.hold(x) {
        return Ok(());
    }
    let is_angle = skeleton.motions().iter().any(|m| m.coordinate == place && m.turning == Turning::Turn);
    let unit = if is_angle { "°" } else { "" };
    let held = range(limits.low, limits.high, is_angle);
    let message = format!("`{name}` goes from {held}, and this is {}{unit}", number(x));
    let said = Diagnostic::new(Code::OutsideLimits, span, message)
        .hint(format!("the nearest is {}", number(x.clamp(limits.low, limits.high))));
    Err(ctx.fail(said))
}

/// "this skeleton has no joint `elbw`", with the nearest.
fn unknown_joint(skeleton: &Skeleton, name: &str, span: Span) -> Diagnostic {
    if skeleton.tip(name).is_some() {
        let message = format!("`{name}` is a tip: it has no angle of its own");
        return Diagnostic::new(Code::UnknownJoint, span, message)
            .hint(format!("a tip reaches for a point: `reach {name}, <6, 3, 0>`"));
    }
    let said = Diagnostic::new(Code::UnknownJoint, span, format!("this skeleton has no joint `{name}`"));
    if name == "clip" {
        return said.hint(MOVING);
    }
    let joints = skeleton.joints().iter().map(|joint| &*joint.name);
    let said = said.did_you_mean(name, joints.chain(POSE.own.iter().map(|property| property.name)));
    if said.hints.is_empty() {
        said.hint(format!("it has {}", names(skeleton.joints().iter().map(|j| &*j.name))))
    } else {
        said
    }
}

/// "no tip `hnd`", with the nearest.
pub fn unknown_tip(skeleton: &Skeleton, name: &str, span: Span) -> Diagnostic {
    if skeleton.joint(name).is_some() {
        let message = format!("`{name}` is a joint, and only tips reach");
        return Diagnostic::new(Code::UnknownJoint, span, message)
            .hint("put a tip on the joint: `tip hand { offset <1, 0, 0> }`");
    }
    let said = Diagnostic::new(Code::UnknownJoint, span, format!("this skeleton has no tip `{name}`"));
    let said = said.did_you_mean(name, skeleton.tips().iter().map(|tip| &*tip.name));
    match (said.hints.is_empty(), skeleton.tips().is_empty()) {
        (true, true) => said.hint("put a tip on a joint: `tip hand { offset <1, 0, 0> }`"),
        (true, false) => said.hint(format!("it has {}", names(skeleton.tips().iter().map(|t| &*t.name)))),
        _ => said,
    }
}

/// Most names that a hint lists.
const LISTED: usize = 12;

fn names<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let mut listed: Vec<String> = names.take(LISTED + 1).map(|name| format!("`{name}`")).collect();
    if listed.len() > LISTED {
        listed[LISTED] = "others".into();
    }
    coerce::listed(&listed, "and")
}
