//! Building: the surface-area heuristic over bins, top down, [`WIDTH`] children to a node.
//!
//! Wald, *On fast construction of SAH-based bounding volume hierarchies*, 2007; MacDonald & Booth 1990 for the heuristic.
//! Subtrees are built in parallel and joined in a fixed order: the tree does not depend on the number of threads.
//!
//! There are no spatial splits (Stich, Friedrich & Dietrich, *Spatial splits in bounding volume hierarchies*, 2009), which cut items at a
//! plane and name them on both sides. Tried on three evenly tessellated meshes of 82 thousand to 1.3 million triangles they gained
//! nothing; on long beams across the axes they spared 18 % of the tests for twice the references.

mod bottom_up;
mod boxes;
mod cells;
mod children;
mod grid;
mod median;
mod split;
mod subtree;

use super::frame::Frame;
use super::survey::{BY_ONE_THREAD, is_usable, survey};
use super::{Child, Node, Pricing, Tree};
use crate::math::Aabb;
use crate::world::roomy::{settled, with_room};
use boxes::{Box32, Boxed, Item};
use rayon::prelude::*;
use split::{Bins, Part};

/// About how many items there are to a node at the least, for the first guess at memory.
const ITEMS_PER_NODE: usize = 8;

/// What is built over.
struct Prepared {
    bounds: Aabb,
    unbounded: Vec<u32>,
    frame: Frame,
    items: Vec<Item>,
}

fn prepare(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync)) -> Prepared {
    let (bounds, unbounded) = survey(count, bounds_of);
    let frame = Frame::around(bounds);
    Prepared { bounds, unbounded, frame, items: narrow(count, bounds_of, &frame) }
}

/// Enters a child and its box.
fn put(node: &mut Node, slot: usize, bounds: &Box32, child: Child) {
    node.children[slot] = child;
    for a in 0..3 {
        node.planes[a][slot] = bounds.lower(a);
        node.planes[a + 3][slot] = bounds.upper(a);
    }
}

/// The tree of nodes over items in their order; those without a finite box follow it.
fn finish(ready: Prepared, mut nodes: Vec<Node>, order: Vec<u32>, at_once: usize) -> Tree {
    nodes = settled(nodes);
    let spread = (!nodes.is_empty() && at_once > 1).then(|| aligned(&mut nodes, &order, at_once));
    // Beyond what a leaf can name every item is offered to every ray: slow, but whole.
    if spread.as_ref().unwrap_or(&order).len() > Child::MOST {
        nodes = Vec::new();
    }
    let has_leaves = !nodes.is_empty();
    let mut order = spread.filter(|_| has_leaves).unwrap_or(order);
    let bounded = if has_leaves { order.len() } else { 0 };
    let unbounded = !ready.unbounded.is_empty();
    order.extend(ready.unbounded);
    Tree { frame: ready.frame, bounds: ready.bounds, unbounded, nodes, order, bounded }
}

/// The order in which every leaf begins at a multiple of a number, its last item repeated up to the next.
fn aligned(nodes: &mut [Node], order: &[u32], at_once: usize) -> Vec<u32> {
    // A leaf has some places to spare.
    let mut all = with_room(order.len() + order.len() / 3);
    for node in nodes {
        for child in &mut node.children {
            let Some(items) = child.items() else { continue };
            let last = order[items.end - 1];
            *child = Child::leaf(all.len(), items.len());
            all.extend_from_slice(&order[items]);
            all.resize(all.len().next_multiple_of(at_once), last);
        }
    }
    all
}

pub(super) fn build(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync, pricing: Pricing) -> Tree {
    let mut ready = prepare(count, &bounds_of);
    let items = &mut ready.items;
    let mut order = vec![0; items.len()];
    let mut nodes = Vec::with_capacity(items.len() / ITEMS_PER_NODE);
    // One box would only repeat the bounds. The root is a node even where everything fits a leaf.
    if items.len() > 1 {
        let whole = Part::whole(items);
        subtree::grow(items, whole, &mut order, &mut nodes, &mut Bins::new(pricing));
    } else {
        order = items.iter().map(Item::number).collect();
    }
    finish(ready, nodes, order, pricing.at_once)
}

/// The items with a finite box, in order. Made in place: for a million of them a second copy would be felt.
fn narrow(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync), frame: &Frame) -> Vec<Item> {
    const NONE: u32 = u32::MAX;
    let item = |i: usize| {
        let b = bounds_of(i);
        Item::new(Box32::around(&b, frame), if is_usable(&b) { i as u32 } else { NONE })
    };
    let mut items = Vec::new();
    if count <= BY_ONE_THREAD {
        items.extend((0..count).map(item));
    } else {
        (0..count).into_par_iter().with_min_len(BY_ONE_THREAD).map(item).collect_into_vec(&mut items);
    }
    items.retain(|item| item.number() != NONE);
    items
}
