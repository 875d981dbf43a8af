//! Building: the surface-area heuristic over bins, top down, [`WIDTH`] children to a node.
//!
//! Wald, *On fast construction of SAH-based bounding volume hierarchies*, 2007; MacDonald & Booth 1990 for the heuristic.
//! Subtrees are built in parallel and joined in a fixed order: the tree does not depend on the number of threads.

mod boxes;
mod cells;
mod children;
mod grid;
mod split;
mod subtree;

use super::frame::Frame;
use super::survey::{BY_ONE_THREAD, is_usable, survey};
use super::{Tree, WIDTH};
use crate::math::Aabb;
use boxes::{Box32, Boxed, Item};
use rayon::prelude::*;
use split::{Bins, Part};

/// About how many items there are to a node at the least, for the first guess at memory.
const ITEMS_PER_NODE: usize = 8;

pub(super) fn build(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
    let (bounds, unbounded) = survey(count, &bounds_of);
    let frame = Frame::around(bounds);
    let mut items = narrow(count, &bounds_of, &frame);
    let mut order = vec![0; items.len()];
    let mut nodes = Vec::with_capacity(items.len() / ITEMS_PER_NODE);
    // One box would only repeat the bounds. The root is a node even where everything fits a leaf.
    if items.len() > 1 {
        let whole = Part::whole(&items);
        subtree::grow(&mut items, whole, &mut order, &mut nodes, &mut Bins::new());
    } else {
        order = items.iter().map(Item::number).collect();
    }
    nodes.shrink_to_fit();
    let bounded = if nodes.is_empty() { 0 } else { items.len() };
    let any_unbounded = !unbounded.is_empty();
    order.extend(unbounded);
    Tree { frame, bounds, unbounded: any_unbounded, nodes, order, bounded }
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
