//! A bounding-volume hierarchy over boxes. It never sees what is inside them: its builder takes boxes, its one traversal
//! hands ranges of items to a closure.
//!
//! Boxes are f32 in the tree's own [`Frame`] (the tree's middle at 0, its size about 1), so that a small thing far from the
//! origin, and a scene at any scale, has boxes as tight as any other. They are rounded outward, rays are rounded so that they
//! meet more rather than less, and so a box never hides what an exact test inside it would find.

mod build;
mod frame;
#[cfg(test)]
mod tests;
mod traverse;

pub use traverse::clip;

use crate::math::Aabb;
use frame::Frame;

/// Children of a node.
const WIDTH: usize = 4;

/// Up to four children, as arrays over the children so that one instruction tests all of them.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Node {
    /// Lower x, y, z and upper x, y, z of each child, in the tree's frame. An absent child is empty (+∞ … −∞).
    planes: [[f32; WIDTH]; 6],
    /// The child's node, or its first item.
    child: [u32; WIDTH],
    /// How many items a leaf has; 0 for a node.
    count: [u8; WIDTH],
}

/// The hierarchy.
#[derive(Clone, Debug)]
pub struct Tree {
    frame: Frame,
    /// Around everything with a finite box.
    bounds: Aabb,
    /// True where some item has no finite box.
    unbounded: bool,
    nodes: Vec<Node>,
    /// Items, leaf by leaf; those that hang under no node at the end.
    order: Vec<u32>,
    /// How many items hang under nodes; the rest is offered to every ray.
    bounded: usize,
}

impl Default for Tree {
    fn default() -> Self {
        Tree::list(0, |_| Aabb::EMPTY)
    }
}

impl Tree {
    /// A tree over `count` items, each with its box. Items whose box is empty are never met; those whose box is infinite or NaN
    /// are offered to every ray. Deterministic, whatever the number of threads.
    pub fn build(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
        build::build(count, bounds_of)
    }

    /// No tree: every item is offered to every ray, in order.
    pub fn list(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
        let (bounds, unbounded) = build::survey(count, &bounds_of);
        Tree {
            frame: Frame::default(),
            bounds,
            unbounded: !unbounded.is_empty(),
            nodes: Vec::new(),
            order: (0..count as u32).collect(),
            bounded: 0,
        }
    }

    /// The items in the order in which leaves name them.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Around everything with a finite box.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// True where some item has no finite box.
    pub fn is_unbounded(&self) -> bool {
        self.unbounded
    }

    /// How many nodes it has.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }
}
