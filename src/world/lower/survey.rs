//! Which groups of a scene are worth an aggregate of their own: those placed more than once that are not tiny.

use crate::scene::{LightSource, Node, Shape};
use std::collections::HashMap;
use std::sync::Arc;

/// Groups smaller than this are copied into what they are placed in: a placement costs a ray about as much as this many boxes.
const MIN_SHAPES: u64 = 8;

#[derive(Clone, Copy, Default)]
struct Count {
    placements: u32,
    /// Shapes inside, those of groups inside included each time they are placed.
    shapes: u64,
}

/// How often each group is placed, by the address of its first node.
pub(super) struct Survey {
    groups: HashMap<*const Node, Count>,
}

impl Survey {
    /// Walks every group once, with a stack of its own, since scenes may nest deeply.
    pub fn of(nodes: &[Node]) -> Survey {
        let mut groups: HashMap<*const Node, Count> = HashMap::new();
        let mut stack = vec![(nodes.iter(), std::ptr::null(), 0u64)];
        while let Some((rest, group, shapes)) = stack.last_mut() {
            let Some(node) = rest.next() else {
                let (group, shapes) = (*group, *shapes);
                groups.entry(group).or_default().shapes = shapes;
                stack.pop();
                if let Some((_, _, around)) = stack.last_mut() {
                    *around = around.saturating_add(shapes);
                }
                continue;
            };
            let Some(inside) = group_of(node) else {
                *shapes = shapes.saturating_add(1);
                continue;
            };
            let count = groups.entry(inside.as_ptr()).or_default();
            count.placements += 1;
            if count.placements > 1 {
                *shapes = shapes.saturating_add(count.shapes);
            } else {
                stack.push((inside.iter(), inside.as_ptr(), 0));
            }
        }
        Survey { groups }
    }

    /// Whether a group is to have an aggregate of its own.
    pub fn is_shared(&self, group: &Arc<[Node]>) -> bool {
        let count = self.groups.get(&group.as_ptr()).copied().unwrap_or_default();
        count.placements > 1 && count.shapes >= MIN_SHAPES
    }
}

fn group_of(node: &Node) -> Option<&Arc<[Node]>> {
    let object = match node {
        Node::Object(object) => object,
        Node::Light(light) => match &light.source {
            LightSource::Area { object, .. } => object,
            _ => return None,
        },
    };
    match &object.shape {
        Shape::Group(nodes) => Some(nodes),
        _ => None,
    }
}
