//! The members of poses and of skeletons, which are their own rest pose. Joints and tips are members by the names that their author
//! gave them.

use super::{Ask, Family, Member, Named};
use crate::diag::{Code, Diagnostic};
use crate::geometry::skeleton::Turning;
use crate::geometry::skeleton::jacobian::{Rows, of_tip};
use crate::lang::table::{Context, Outcome, Parameter};
use crate::lang::value::{Record, Value, vector};
use crate::scene::{Reach, Stance};
use std::rc::Rc;

const JACOBIAN: &[Parameter] =
    &[Parameter::new("tip", "a tip's name").bare(), Parameter::new("rows", "3, or 6 with turns").or("3")];

/// Poses and skeletons.
pub static FAMILY: Family = Family {
    name: "pose",
    doc: "A skeleton has the same, of its rest pose. The name of a tip gives the point where it is. The name of a joint gives the joint: \
          `.position`, the point where it is, `.frame`, the transform from its frame to the world, and its `.angle` in degrees (of a slide in \
          scene units), its `.angles` or its `.shift`.",
    holds: |value| matches!(value, Value::Skeleton(_) | Value::Pose(_)),
    scene: "skeleton arm {\n  joint shoulder { offset <0, 6, 0>  hinge z\n    joint elbow { offset <5, 0, 0>  hinge z  angle 90  tip hand { offset <4, 0, 0> } } }\n}\n\
            pose down { of arm  shoulder -90 }\n\
            pose touch { of arm  reach hand, <6, 3, 0> }",
    members: MEMBERS,
    named: Some(&Named { what: "joint, tip or value", find, names }),
};

static MEMBERS: &[Member] = &[
    Member::method(
        "jacobian",
        JACOBIAN,
        "How a tip moves with each coordinate of the skeleton, joint by joint: a list of 3 rows (x, y, z), a number for each coordinate, per \
         radian of a turn and per scene unit of a move. With 6 rows also how its frame turns, in radians about x, y and z.",
        ("arm.jacobian(hand)[1]", "[5, 0]"),
        jacobian,
    ),
    Member::field(
        "residual",
        "The largest distance from a tip to its target, in scene units; 0 where nothing is reached for.",
        ("touch.residual < 1e-9", "true"),
        |_, ask| Ok(Value::Number(reach(ask).map_or(0.0, |reach| reach.residual))),
    ),
    Member::field("iterations", "How many steps the reach took.", ("down.iterations", "0"), |_, ask| {
        Ok(Value::Number(reach(ask).map_or(0.0, |reach| reach.iterations as f64)))
    }),
    Member::field(
        "converged",
        "Whether all targets are reached within the tolerance.",
        ("touch.converged", "true"),
        |_, ask| Ok(Value::Bool(reach(ask).is_none_or(|reach| reach.converged))),
    ),
    Member::field(
        "joints",
        "The list of its joints' names, each behind that of the joint it hangs on.",
        ("arm.joints", "[\"shoulder\", \"elbow\"]"),
        joints,
    ),
    Member::field(
        "bones",
        "The list of its straight parts, from each joint to what hangs on it: pairs of points.",
        ("arm.bones[0]", "[<0, 6, 0>, <5, 6, 0>]"),
        bones,
    ),
    Member::field(
        "duration",
        "The length of its motion capture, in seconds; 0 where it has none.",
        ("arm.duration", "0"),
        |_, ask| Ok(Value::Number(stance(ask.value).rig().motion.as_ref().map_or(0.0, |m| m.duration()))),
    ),
];

fn stance(value: &Value) -> Stance {
    match value {
        Value::Skeleton(rig) => Stance::Rest(rig.clone()),
        Value::Pose(pose) => Stance::Posed(pose.clone()),
        _ => unreachable!("a member of poses is asked of poses"),
    }
}

fn reach(ask: &Ask<'_>) -> Option<Reach> {
    stance(ask.value).reach().cloned()
}

/// The joint or tip of a name.
fn find(value: &Value, name: &str) -> Option<Value> {
    let stance = stance(value);
    let (skeleton, placement) = (&stance.rig().skeleton, stance.placement());
    if let Some(tip) = skeleton.tip(name) {
        return Some(Value::Vector3(placement.tip(skeleton, tip)));
    }
    skeleton.joint(name).map(|joint| joint_value(&stance, joint))
}

fn joint_value(stance: &Stance, joint: usize) -> Value {
    let skeleton = &stance.rig().skeleton;
    let given = |turning| -> Vec<f64> {
        let places = skeleton.coordinates_of(joint, turning);
        places.into_iter().map(|place| stance.coordinates()[place]).collect()
    };
    let (shift, angles) = (given(Turning::Move), given(Turning::Turn));
    let mut parts = Vec::new();
    match (&shift[..], &angles[..]) {
        ([], [only]) | ([only], []) => parts.push(("angle", Value::Number(*only))),
        _ => {
            parts.extend((!shift.is_empty()).then(|| ("shift", vector(&shift))));
            parts.extend((!angles.is_empty()).then(|| ("angles", vector(&angles))));
        }
    }
    let frame = stance.placement().frames[joint];
    parts.push(("position", Value::Vector3(frame.origin)));
    parts.push(("frame", Value::Transform(Rc::new(frame.affine()))));
    Value::Record(Rc::new(Record { name: "a joint", parts }))
}

fn names(value: &Value) -> Vec<String> {
    let stance = stance(value);
    let skeleton = &stance.rig().skeleton;
    let joints = skeleton.joints().iter().map(|joint| joint.name.clone());
    joints.chain(skeleton.tips().iter().map(|tip| tip.name.clone())).collect()
}

fn jacobian(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let stance = stance(ask.value);
    let skeleton = &stance.rig().skeleton;
    let name = match ask.arguments.values.first() {
        Some(Value::Word(name) | Value::Text(name)) => name.clone(),
        _ => return Err(ask.wrong(ctx, 0)),
    };
    let Some(tip) = skeleton.tip(&name) else {
        return Err(ctx.fail(crate::lang::kinds::unknown_tip(skeleton, &name, ask.place(0))));
    };
    let rows = match ask.number(ctx, 1)? {
        3.0 => Rows::Position,
        6.0 => Rows::PositionAndTurn,
        _ => {
            let said =
                Diagnostic::new(Code::Undefined, ask.place(1), "a Jacobian has 3 rows, or 6 with turns");
            return Err(ctx.fail(said));
        }
    };
    let matrix = of_tip(skeleton, stance.placement(), tip, rows);
    ctx.reserve(matrix.rows() * matrix.columns(), ask.arguments.span)?;
    let row = |i: usize| Value::list((0..matrix.columns()).map(|j| Value::Number(matrix[(i, j)])).collect());
    Ok(Value::list((0..matrix.rows()).map(row).collect()))
}

fn joints(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let stance = stance(ask.value);
    let joints = stance.rig().skeleton.joints();
    ctx.reserve(joints.len(), ask.arguments.span)?;
    Ok(Value::list(joints.iter().map(|joint| Value::text(&joint.name)).collect()))
}

fn bones(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let stance = stance(ask.value);
    let bones = stance.placement().bones(&stance.rig().skeleton);
    ctx.reserve(3 * bones.len(), ask.arguments.span)?;
    let pair = |bone: &crate::geometry::skeleton::Bone| {
        Value::list(vec![Value::Vector3(bone.start), Value::Vector3(bone.end)])
    };
    Ok(Value::list(bones.iter().map(pair).collect()))
}
