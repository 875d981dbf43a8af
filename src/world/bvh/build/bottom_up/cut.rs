//! Cutting a binary tree into wide nodes: where it costs least, by the surface-area heuristic.

use super::super::split::MAX_LEAF;
use super::super::{put, subtree::append};
use super::{Binary, Inner};
use crate::world::bvh::build::boxes::Box32;
use crate::world::bvh::{Child, Node, Pricing, WIDTH};
use rayon::prelude::*;
use smallvec::SmallVec;

/// Subtrees over more items are cut by threads of their own.
const BY_ONE_THREAD: usize = 1 << 13;

/// What visiting a child costs, in item tests.
const LANE_COST: f32 = 1.0;

/// What a ray that meets the root pays under a subtree that takes at most 1, 2, … slots of a node, times the root's area.
#[derive(Clone, Copy)]
pub(super) struct Costs([f32; WIDTH]);

/// How a subtree takes slots so that it costs least. For each number of slots three bits: how many the left half takes, 0 where fewer do
/// as well; then how many of a node of its own; then one that is set where it is a leaf if it takes one.
#[derive(Clone, Copy, Default)]
pub(super) struct Ways(u32);

/// As a leaf.
fn leaf_cost(area: f32, n_items: usize) -> f32 {
    if n_items <= MAX_LEAF { area * (LANE_COST + n_items as f32) } else { f32::INFINITY }
}

impl Costs {
    pub const NONE: Costs = Costs([0.0; WIDTH]);

    /// Of an item alone.
    pub fn of_item(area: f32) -> Costs {
        Costs([leaf_cost(area, 1); WIDTH])
    }

    /// Of two joined.
    pub fn of_two(left: &Costs, right: &Costs, area: f32, n_items: usize) -> (Costs, Ways) {
        // Of each number of slots the best way to share them, of equal ones the first. More than there are items gain nothing.
        let most = WIDTH.min(n_items);
        let mut shared = [(f32::INFINITY, 0); WIDTH];
        for slots in 2..=most {
            for own in 1..slots {
                let cost = left.0[own - 1] + right.0[slots - own - 1];
                if cost < shared[slots - 1].0 {
                    shared[slots - 1] = (cost, own as u32);
                }
            }
        }
        let (as_leaf, (below, own)) = (leaf_cost(area, n_items), shared[most - 1]);
        let as_node = area * (LANE_COST + Pricing::OF_TRIANGLES.node) + below;
        let mut least = as_leaf.min(as_node);
        let mut ways = own << Ways::OF_NODE | u32::from(as_leaf <= as_node) << Ways::IS_LEAF;
        let mut costs = [least; WIDTH];
        for slots in 2..=WIDTH {
            // Infinite beyond the most.
            let (cost, own) = shared[slots - 1];
            if cost < least {
                least = cost;
                ways |= own << Ways::of(slots);
            }
            costs[slots - 1] = least;
        }
        (Costs(costs), Ways(ways))
    }
}

impl Ways {
    const OF_NODE: usize = Ways::of(WIDTH + 1);
    const IS_LEAF: usize = Ways::of(WIDTH + 2);

    const fn of(slots: usize) -> usize {
        3 * (slots - 2)
    }

    fn at(self, bit: usize) -> usize {
        (self.0 >> bit) as usize & (WIDTH - 1)
    }

    fn is_leaf(self) -> bool {
        self.0 >> Ways::IS_LEAF & 1 == 1
    }

    /// How many of at most so many slots are taken, and how many of them by the left half; none where one is.
    fn within(self, slots: usize) -> Option<(usize, usize)> {
        let taken = (2..=slots).rev().find(|slots| self.at(Ways::of(*slots)) > 0)?;
        Some((taken, self.at(Ways::of(taken))))
    }
}

/// Appends the nodes of a binary tree, the topmost first; `order` has the items' numbers by place, and then leaf by leaf.
pub(super) fn cut(binary: &Binary, order: &mut [u32], nodes: &mut Vec<Node>) {
    let numbers = order.to_vec();
    let root = (binary.bounds.len() + binary.inner.len() - 1) as u32;
    Cutter { binary, numbers: &numbers }.grow(root, 0, order, nodes);
}

struct Cutter<'b> {
    binary: &'b Binary,
    /// Of the items, by place.
    numbers: &'b [u32],
}

/// A child on the way: its number in the binary tree, the place of its first item, and its part of the order.
type Part<'o> = (u32, usize, &'o mut [u32]);

impl Cutter<'_> {
    /// The node over an inner one, and all below it: its index and box. `first` is the place of its first item.
    fn grow(&self, id: u32, first: usize, order: &mut [u32], nodes: &mut Vec<Node>) -> (usize, Box32) {
        let (index, n_items) = (nodes.len(), order.len());
        nodes.push(Node::EMPTY);
        let (mut first, mut order) = (first, order);
        let mut parts: SmallVec<[Part<'_>; WIDTH]> = SmallVec::new();
        self.share(id, WIDTH, self.inner(id).ways.at(Ways::OF_NODE), &mut |child| {
            let n_items = self.binary.inner(child).map_or(1, |inner| inner.n_items as usize);
            let own = order.split_off_mut(..n_items).expect("as many as the tree has");
            parts.push((child, first, own));
            first += n_items;
        });
        let mut bounds = Box32::EMPTY;
        let mut enter = |nodes: &mut Vec<Node>, slot: usize, (child, own): (Child, Box32)| {
            put(&mut nodes[index], slot, &own, child);
            bounds.grow(&own);
        };
        if n_items > BY_ONE_THREAD && rayon::current_num_threads() > 1 {
            let apart = |part: Part<'_>| {
                let mut below = Vec::new();
                (self.child(part, &mut below), below)
            };
            let built: Vec<_> = parts.into_vec().into_par_iter().map(apart).collect();
            for (slot, (mut child, below)) in built.into_iter().enumerate() {
                if !below.is_empty() {
                    child.0 = Child::node(append(below, nodes));
                }
                enter(nodes, slot, child);
            }
        } else {
            // The detour by parts would give the same nodes.
            for (slot, part) in parts.into_iter().enumerate() {
                let child = self.child(part, nodes);
                enter(nodes, slot, child);
            }
        }
        (index, bounds)
    }

    /// A child, its nodes appended, and its box.
    fn child(&self, (id, first, order): Part<'_>, nodes: &mut Vec<Node>) -> (Child, Box32) {
        if self.binary.inner(id).is_some_and(|inner| !inner.ways.is_leaf()) {
            let (index, bounds) = self.grow(id, first, order, nodes);
            return (Child::node(index), bounds);
        }
        let (count, mut bounds, mut order) = (order.len(), Box32::EMPTY, order.iter_mut());
        self.each_item(id, &mut |place| {
            bounds.grow(&self.binary.bounds[place]);
            *order.next().expect("a place for each item") = self.numbers[place];
        });
        (Child::leaf(first, count), bounds)
    }

    fn inner(&self, id: u32) -> &Inner {
        self.binary.inner(id).expect("an item has no halves")
    }

    /// The items under a node, in order.
    fn each_item(&self, id: u32, take: &mut impl FnMut(usize)) {
        match self.binary.inner(id) {
            None => take(id as usize),
            Some(inner) => inner.halves.iter().for_each(|half| self.each_item(*half, take)),
        }
    }

    /// The children that two halves become, of which the left one takes so many slots.
    fn share(&self, id: u32, slots: usize, own: usize, take: &mut impl FnMut(u32)) {
        let [left, right] = self.inner(id).halves;
        for (half, slots) in [(left, own), (right, slots - own)] {
            match self.binary.inner(half).and_then(|inner| inner.ways.within(slots)) {
                None => take(half),
                Some((slots, own)) => self.share(half, slots, own, take),
            }
        }
    }
}
