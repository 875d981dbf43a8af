//! A skeleton as an object: a cone for each bone, thin where it leads, and a ball at each joint and tip.

use crate::diag::Span;
use crate::scene::{Cone, Node, Object, Shape, Stance};
use glam::DVec3;
use std::sync::Arc;

/// Radius of a bone where it begins and of a joint's ball, and where it ends, by its length.
const THICK: f64 = 0.08;
const THIN: f64 = 0.025;

/// The bones of a skeleton in its pose.
pub fn drawn(stance: &Stance, span: Span) -> Shape {
    let bones = stance.placement().bones(&stance.rig().skeleton);
    let lengths: Vec<f64> = bones.iter().map(|bone| bone.start.distance(bone.end)).collect();
    let mean =
        lengths.iter().sum::<f64>() / lengths.iter().filter(|length| **length > 0.0).count().max(1) as f64;
    let ball = |center: DVec3, length: f64| Shape::Sphere { center, radius: THICK * length };
    let mut shapes = Vec::new();
    for (bone, length) in bones.iter().zip(lengths) {
        if length > 0.0 {
            let radii = [THICK * length, THIN * length];
            shapes.push(Shape::Cone(Box::new(Cone { from: bone.start, to: bone.end, radii })));
            shapes.push(ball(bone.start, length));
            shapes.push(Shape::Sphere { center: bone.end, radius: THIN * length });
        } else if mean > 0.0 {
            shapes.push(ball(bone.start, 0.5 * mean));
        }
    }
    let nodes: Vec<Node> =
        shapes.into_iter().map(|shape| Node::Object(Arc::new(Object::new(shape, span)))).collect();
    Shape::Group(nodes.into())
}
