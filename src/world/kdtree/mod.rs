//! A kd-tree over boxes: space cut by planes into cells, near ones first along any ray. It never sees what is inside the boxes: its
//! builder takes boxes, and perhaps a way to cut an item to a cell; its one traversal hands ranges of items to a closure, as that of
//! the hierarchy of boxes does ([`super::bvh`]).
//!
//! An item that straddles a plane is named in both cells, so it may be offered to one ray more than once. Planes are f32 in the tree's own
//! `Frame`, where they are exact; boxes are rounded outward into it, and rays are widened by what may be wrong with their numbers, so
//! that a cell never hides what an exact test inside it would find.

mod build;
mod cell;
#[cfg(test)]
mod tests;
mod traverse;

use super::bvh::frame::Frame;
use crate::math::Aabb;
use cell::Cell;

/// A plane with a half-space on either side, or a leaf. The node below the plane is the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    /// The plane's place along its axis, or the bits of a leaf's first reference.
    plane: f32,
    /// In the lower two bits the axis, or 3 for a leaf; above them the node beyond the plane, or how many references.
    rest: u32,
}

impl Node {
    /// In place of an axis.
    const LEAF: u32 = 3;

    fn inner(axis: usize, plane: f32, beyond: usize) -> Node {
        Node { plane, rest: (beyond as u32) << 2 | axis as u32 }
    }

    fn leaf(first: usize, count: usize) -> Node {
        Node { plane: f32::from_bits(first as u32), rest: (count as u32) << 2 | Node::LEAF }
    }

    fn is_leaf(&self) -> bool {
        self.rest & Node::LEAF == Node::LEAF
    }

    fn axis(&self) -> usize {
        (self.rest & Node::LEAF) as usize
    }

    /// The node beyond the plane, or the count of references.
    fn upper(&self) -> usize {
        (self.rest >> 2) as usize
    }

    /// The first reference of a leaf.
    fn first(&self) -> usize {
        self.plane.to_bits() as usize
    }
}

/// The tree.
#[derive(Clone, Debug)]
pub struct Tree {
    frame: Frame,
    /// Around everything with a finite box.
    bounds: Aabb,
    /// The same in the frame.
    root: Cell,
    /// True where some item has no finite box.
    unbounded: bool,
    nodes: Vec<Node>,
    /// What is in the leaves, leaf by leaf, rising in each: places in `order`.
    references: Vec<u32>,
    /// Items in the order in which leaves first name them; those that hang under no node at the end.
    order: Vec<u32>,
    /// How many items hang under nodes; the rest is offered to every ray.
    bounded: usize,
}

impl Tree {
    /// A tree over `count` items, each with its box. Items whose box is empty are never met; those whose box is infinite or NaN
    /// are offered to every ray. Deterministic, whatever the number of threads.
    pub fn build(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
        Tree::build_clipped(count, bounds_of, |_, cell| *cell)
    }

    /// The same where `clip` gives a box around what lies of an item in a box: conservative by its own rounding and by a few ulps of the
    /// box's coordinates; empty where nothing does.
    pub fn build_clipped(
        count: usize,
        bounds_of: impl Fn(usize) -> Aabb + Sync,
        clip: impl Fn(usize, &Aabb) -> Aabb + Sync,
    ) -> Tree {
        build::build(count, &bounds_of, &clip)
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

    /// How many nodes it has, leaves among them.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// How often leaves name items.
    pub fn reference_count(&self) -> usize {
        self.references.len()
    }

    /// Memory of the nodes, and of what leaves name and in which order, in bytes.
    pub fn bytes(&self) -> [usize; 2] {
        let leaves = size_of_val(&*self.references) + size_of_val(&*self.order);
        [size_of_val(&*self.nodes), leaves]
    }
}
