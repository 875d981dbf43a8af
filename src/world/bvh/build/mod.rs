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
use glam::DVec3;
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

/// So many boxes are surveyed by one thread: no more than one is woken for fewer, and a scene of few starts no threads at all.
const BY_ONE_THREAD: usize = 1 << 12;

/// The box around the finite boxes, and the items without one.
pub(super) fn survey(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync)) -> (Aabb, Vec<u32>) {
    let nothing = || (Aabb::EMPTY, Vec::new());
    let with = |(bounds, mut unbounded): (Aabb, Vec<u32>), i: usize| {
        let b = bounds_of(i);
        if is_usable(&b) {
            return (bounds.union(b), unbounded);
        }
        if !is_nothing(&b) {
            unbounded.push(i as u32);
        }
        (bounds, unbounded)
    };
    if count <= BY_ONE_THREAD {
        return (0..count).fold(nothing(), with);
    }
    (0..count).into_par_iter().with_min_len(BY_ONE_THREAD).fold(nothing, with).reduce(
        nothing,
        |(a, mut x), (b, y)| {
            x.extend(y);
            (a.union(b), x)
        },
    )
}

/// Neither empty nor infinite in any direction, nor NaN, nor so large that its size overflows.
fn is_usable(b: &Aabb) -> bool {
    let size = b.size();
    (size.cmpge(DVec3::ZERO) & size.cmple(DVec3::MAX)).all()
}

/// The empty box: what has it is never met. All others that are not usable are offered to every ray.
fn is_nothing(b: &Aabb) -> bool {
    b.is_empty() && !b.min.is_nan() && !b.max.is_nan()
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
