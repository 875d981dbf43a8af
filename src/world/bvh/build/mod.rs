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

/// The box around the finite boxes, and the items without one.
pub(super) fn survey(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync)) -> (Aabb, Vec<u32>) {
    (0..count)
        .into_par_iter()
        .with_min_len(1 << 12)
        .fold(
            || (Aabb::EMPTY, Vec::new()),
            |(bounds, mut unbounded), i| {
                let b = bounds_of(i);
                if is_unbounded(&b) {
                    unbounded.push(i as u32);
                    return (bounds, unbounded);
                }
                (if b.is_empty() { bounds } else { bounds.union(b) }, unbounded)
            },
        )
        .reduce(
            || (Aabb::EMPTY, Vec::new()),
            |(a, mut x), (b, y)| {
                x.extend(y);
                (a.union(b), x)
            },
        )
}

/// Infinite in any direction, NaN, or so large that its size overflows. The empty box is not.
fn is_unbounded(b: &Aabb) -> bool {
    let nothing = b.is_empty() && !b.min.is_nan() && !b.max.is_nan();
    !nothing && !(b.min.is_finite() && b.max.is_finite() && b.size().is_finite())
}

/// The items with a finite box, in order. Made in place: for a million of them a second copy would be felt.
fn narrow(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync), frame: &Frame) -> Vec<Item> {
    const NONE: u32 = u32::MAX;
    let item = |i: usize| {
        let b = bounds_of(i);
        let usable = !b.is_empty() && !is_unbounded(&b);
        Item::new(Box32::around(&b, frame), if usable { i as u32 } else { NONE })
    };
    let mut items = Vec::new();
    (0..count).into_par_iter().with_min_len(1 << 12).map(item).collect_into_vec(&mut items);
    items.retain(|item| item.number() != NONE);
    items
}
