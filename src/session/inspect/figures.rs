//! Skeletons and poses as entries: the tree of joints with angles, limits and places in the world.

use super::{Entry, vector};
use crate::geometry::skeleton::{Freedom, Turning};
use crate::scene::{Figure, Stance};
use serde_json::{Value as Json, json};

/// A skeleton or pose with its joints inside one another.
pub(super) fn figure(figure: &Figure) -> Entry {
    let stance = &figure.stance;
    let mut properties = vec![("label", json!(figure.name))];
    if let Some(reach) = stance.reach() {
        properties.push(("residual", json!(reach.residual)));
        properties.push(("iterations", json!(reach.iterations)));
        properties.push(("converged", json!(reach.converged)));
    }
    if let (Stance::Rest(_), Some(motion)) = (stance, &stance.rig().motion) {
        properties.push(("frames", json!(motion.frames.len())));
        properties.push(("duration", json!(motion.duration())));
    }
    let kind = match stance {
        Stance::Rest(_) => "skeleton",
        Stance::Posed(_) => "pose",
    };
    Entry { kind, span: Some(stance.span()), properties, children: hanging(stance, None) }
}

/// What hangs on a joint, or the roots.
fn hanging(stance: &Stance, parent: Option<usize>) -> Vec<Entry> {
    let skeleton = &stance.rig().skeleton;
    let joints = (0..skeleton.joints().len()).filter(|&joint| skeleton.joints()[joint].parent == parent);
    let tips = (0..skeleton.tips().len()).filter(|&tip| Some(skeleton.tips()[tip].joint) == parent);
    joints.map(|joint| joint_entry(stance, joint)).chain(tips.map(|tip| tip_entry(stance, tip))).collect()
}

fn joint_entry(stance: &Stance, index: usize) -> Entry {
    let joint = &stance.rig().skeleton.joints()[index];
    let mut properties = vec![("label", json!(joint.name)), ("freedom", freedom(&joint.freedom))];
    for (name, turning) in [("shift", Turning::Move), ("angles", Turning::Turn)] {
        properties.extend(coordinates(stance, index, turning).map(|values| (name, values)));
    }
    properties.extend(limits(stance, index).map(|limits| ("limits", limits)));
    properties.push(("position", vector(stance.placement().joint(index))));
    Entry { kind: "joint", span: None, properties, children: hanging(stance, Some(index)) }
}

fn tip_entry(stance: &Stance, tip: usize) -> Entry {
    let skeleton = &stance.rig().skeleton;
    let position = stance.placement().tip(skeleton, tip);
    let properties = vec![("label", json!(skeleton.tips()[tip].name)), ("position", vector(position))];
    Entry { kind: "tip", span: None, properties, children: vec![] }
}

fn freedom(freedom: &Freedom) -> Json {
    json!(match freedom {
        Freedom::Fixed => "fixed",
        Freedom::Hinge(_) => "hinge",
        Freedom::Universal(..) => "universal",
        Freedom::Ball => "ball",
        Freedom::Slide(_) => "slide",
        Freedom::Free => "free",
        Freedom::Channels(_) => "channels",
    })
}

/// Degrees of a joint's turns or scene units of its moves; a number where there is one.
fn coordinates(stance: &Stance, joint: usize, turning: Turning) -> Option<Json> {
    let places = stance.rig().skeleton.coordinates_of(joint, turning);
    let values: Vec<f64> = places.into_iter().map(|place| stance.coordinates()[place]).collect();
    match &values[..] {
        [] => None,
        [only] => Some(json!(only)),
        several => Some(json!(several)),
    }
}

/// Least and most of each coordinate that has limits.
fn limits(stance: &Stance, joint: usize) -> Option<Json> {
    let skeleton = &stance.rig().skeleton;
    let places = [Turning::Move, Turning::Turn].map(|turning| skeleton.coordinates_of(joint, turning));
    let limits = places.concat().into_iter().map(|place| skeleton.limits()[place]);
    let held: Vec<[f64; 2]> = limits.filter(|l| l.low.is_finite()).map(|l| [l.low, l.high]).collect();
    match &held[..] {
        [] => None,
        [only] => Some(json!(only)),
        several => Some(json!(several)),
    }
}
