//! A bounding-volume hierarchy over boxes. It never sees what is inside them: its builder takes boxes, its one traversal
//! hands ranges of items to a closure.
//!
//! Boxes are f32 in the tree's own `Frame` (the tree's middle at 0, its size about 1), so that a small thing far from the
//! origin, and a scene at any scale, has boxes as tight as any other. They are rounded outward, rays are rounded so that they
//! meet more rather than less, and so a box never hides what an exact test inside it would find.
//!
//! One of the rooms with unsafe code: what builders see to, that rows and children are there, is asked nowhere again.

mod build;
mod cost;
pub(super) mod frame;
pub(super) mod survey;
#[cfg(test)]
mod tests;
mod traverse;

pub use traverse::clip;
pub(in crate::world) use traverse::{Limits, fetch_entry};

use crate::math::Aabb;
use frame::Frame;
use glam::Vec4;
use std::ops::Range;

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

/// Up to eight children, as arrays over the children so that one instruction tests all of them.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Node {
    /// Lower x, y, z and upper x, y, z of each child, in the tree's frame; an absent child is empty (+∞ … −∞).
    planes: [[f32; WIDTH]; 6],
    children: [Child; WIDTH],
}

impl Node {
    /// Without children.
    const EMPTY: Node = {
        const BEYOND: [f32; WIDTH] = [f32::INFINITY; WIDTH];
        const BEFORE: [f32; WIDTH] = [f32::NEG_INFINITY; WIDTH];
        Node { planes: [BEYOND, BEYOND, BEYOND, BEFORE, BEFORE, BEFORE], children: [Child::NONE; WIDTH] }
    };

    /// Eight planes.
    #[inline(always)]
    fn row(&self, row: Row) -> &[f32; WIDTH] {
        let planes = self.planes.as_flattened();
        // SAFETY: of every `Row` eight planes follow the number that it is. Compilers do not always find that, and then near half of a node's
        // test is for asking.
        #[allow(unsafe_code, reason = "there is no safe way to say what is known of an enum")]
        unsafe {
            planes.get_unchecked(row as usize..).first_chunk().unwrap_unchecked()
        }
    }
}

/// A row of planes, by how many numbers stand before it.
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
enum Row {
    LowerX = 0,
    LowerY = 8,
    LowerZ = 16,
    UpperX = 24,
    UpperY = 32,
    UpperZ = 40,
}

/// A child of a node: another, or a leaf with its first item and how many it has. One number, so that it waits beside its distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Child(u32);

impl Child {
    /// Bits of how many items a leaf has; 0 for a node.
    const COUNT_BITS: u32 = 4;
    /// The most items of a leaf.
    const MOST_OF_LEAF: usize = (1 << Child::COUNT_BITS) - 1;
    /// The most places in the order of items; there are fewer nodes.
    const MOST: usize = 1 << (u32::BITS - Child::COUNT_BITS);

    /// Node 0 is nobody's child: where it stands there is none.
    const NONE: Child = Child(0);

    fn node(index: usize) -> Child {
        Child((index as u32) << Child::COUNT_BITS)
    }

    fn leaf(first: usize, count: usize) -> Child {
        debug_assert!((1..=Child::MOST_OF_LEAF).contains(&count), "{count} items of a leaf");
        Child((first as u32) << Child::COUNT_BITS | count as u32)
    }

    /// The node, or where the first item stands.
    #[inline(always)]
    fn place(self) -> usize {
        (self.0 >> Child::COUNT_BITS) as usize
    }

    /// The node that it is, among those of its tree.
    #[inline(always)]
    fn node_of(self, nodes: &[Node]) -> &Node {
        debug_assert!(
            self.count() == 0 && self.place() < nodes.len(),
            "{self:?} is none of {} nodes",
            nodes.len()
        );
        // SAFETY: builders name nodes that there are, and who asks has seen that it is one. Where the next node stands is what a ray waits for, and so it is
        // found by a shift and a sum.
        #[allow(unsafe_code, reason = "asking whether it is there takes longer than finding it")]
        unsafe {
            &*self.start_of(nodes)
        }
    }

    /// Where a node stands; of a leaf anywhere.
    #[inline(always)]
    fn start_of(self, nodes: &[Node]) -> *const Node {
        // The count of a node is 0.
        nodes.as_ptr().wrapping_byte_add(self.0 as usize * (size_of::<Node>() >> Child::COUNT_BITS))
    }

    /// How many items a leaf has; 0 for a node.
    #[inline(always)]
    fn count(self) -> usize {
        self.0 as usize & Child::MOST_OF_LEAF
    }

    /// Where the items of a leaf stand; none for a node.
    #[inline(always)]
    fn items(self) -> Option<Range<usize>> {
        (self.count() > 0).then(|| self.place()..self.place() + self.count())
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
