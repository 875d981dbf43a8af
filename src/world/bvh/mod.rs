//! A bounding-volume hierarchy over boxes. It never sees what is inside them: its builder takes boxes, its one traversal
//! hands ranges of items to a closure.
//!
//! Boxes are f32 in the tree's own `Frame` (the tree's middle at 0, its size about 1), so that a small thing far from the
//! origin, and a scene at any scale, has boxes as tight as any other. They are rounded outward, rays are rounded so that they
//! meet more rather than less, and so a box never hides what an exact test inside it would find.

mod build;
mod cost;
pub(super) mod frame;
pub(super) mod survey;
#[cfg(test)]
mod tests;
mod traverse;

pub use traverse::clip;

use crate::math::Aabb;
use frame::Frame;
use glam::Vec4;

/// Children of a node.
const WIDTH: usize = 8;

/// What rays pay for what they meet of a tree, by which it is built.
#[derive(Clone, Copy)]
struct Pricing {
    /// What a node of its own costs, in tests of items: where splitting a part gains less it is a leaf.
    node: f32,
    /// Items that are tested together, as cheaply as one: leaves begin at multiples of it.
    at_once: usize,
}

impl Pricing {
    const OF_ITEMS: Pricing = Pricing { node: 2.0, at_once: 1 };

    /// Measured on meshes of 82 and 200 thousand: at 6, a node and a half to a test of four, rays are as fast as at 2 and 4 or up to a tenth
    /// faster, and of the four 3.4 are there.
    const OF_TRIANGLES: Pricing = Pricing { node: 6.0, at_once: 4 };

    /// How many tests some items cost: as many, up to the next multiple of [`Pricing::at_once`].
    #[inline(always)]
    fn tests(self, items: f32) -> f32 {
        self.tests_4(Vec4::splat(items)).x
    }

    /// The same of four numbers.
    #[inline(always)]
    fn tests_4(self, items: Vec4) -> Vec4 {
        // A float so large has steps of that size, and sums are rounded to the nearest.
        let step = self.at_once as f32;
        let large = Vec4::splat(1.5 * (1 << 23) as f32 * step);
        (items + (0.5 * step - 0.5) + large) - large
    }
}

/// Up to eight children, as arrays over the children so that one instruction tests all of them. Four cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Node {
    /// Lower x, y, z and upper x, y, z of each child, in the tree's frame; an absent child is empty (+∞ … −∞). Then the bits of the
    /// child's node or first item, and of how many items a leaf has, 0 for a node. Eight rows, so that three bits name one.
    rows: [[f32; WIDTH]; 8],
}

impl Node {
    const CHILD: usize = 6;
    const COUNT: usize = 7;

    /// Without children.
    const EMPTY: Node = {
        const BEYOND: [f32; WIDTH] = [f32::INFINITY; WIDTH];
        const BEFORE: [f32; WIDTH] = [f32::NEG_INFINITY; WIDTH];
        const NONE: [f32; WIDTH] = [0.0; WIDTH];
        Node { rows: [BEYOND, BEYOND, BEYOND, BEFORE, BEFORE, BEFORE, NONE, NONE] }
    };

    /// The child's node, or its first item.
    fn child(&self, slot: usize) -> u32 {
        self.rows[Node::CHILD][slot].to_bits()
    }

    /// How many items a leaf has; 0 for a node.
    fn count(&self, slot: usize) -> u32 {
        self.rows[Node::COUNT][slot].to_bits()
    }

    /// Eight planes by where they begin, a multiple of eight.
    #[inline(always)]
    fn row_from(&self, first: usize) -> &[f32; WIDTH] {
        // Within the node, whatever the number.
        let first = first & (7 * WIDTH);
        self.rows.as_flattened()[first..].first_chunk().expect("eight rows of eight")
    }

    fn set_child(&mut self, slot: usize, child: u32, count: u32) {
        self.rows[Node::CHILD][slot] = f32::from_bits(child);
        self.rows[Node::COUNT][slot] = f32::from_bits(count);
    }
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
        build::build(count, bounds_of, Pricing::OF_ITEMS)
    }

    /// The same over items that cost so little that a node is rarely worth sparing some: triangles.
    pub fn build_of_triangles(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
        build::build(count, bounds_of, Pricing::OF_TRIANGLES)
    }

    /// No tree: every item is offered to every ray, in order.
    pub fn list(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
        let (bounds, unbounded) = survey::survey(count, &bounds_of);
        Tree {
            frame: Frame::default(),
            bounds,
            unbounded: !unbounded.is_empty(),
            nodes: Vec::new(),
            order: (0..count as u32).collect(),
            bounded: 0,
        }
    }

    /// The items in the order in which leaves name them; of triangles, some more than once, where no leaf names them.
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
