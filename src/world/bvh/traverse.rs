//! The one traversal: nearest boxes first, for closest hits and for any hit, ray by ray, or for rays from one point together (`packet`).

mod counting;
mod entry;
mod fetch;
mod packet;
mod wide;

pub(in crate::world) use fetch::fetch_entry;
use fetch::{fetch, nowhere};
pub(in crate::world) use packet::Limits;

use super::{Child, Node, Tree, WIDTH};
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::world::stack::{Held, Stack};
use entry::Entry;
use glam::DVec3;
use std::ops::Range;

/// 1 + 2γ₃: what the far side of a slab is widened by, so that its three roundings never lose a ray that grazes the box
/// (Ize, *Robust BVH ray traversal*, 2013).
const WIDEN_64: f64 = 1.0 + 2.0 * gamma(3);

/// How far beyond the best hit boxes are still opened, relative to its distance: hides the rounding of both distances and keeps
/// ties, and costs nothing measurable (2⁻²⁰ of a ray's length).
const SLACK: f64 = 1.0 + 1.0 / (1u64 << 20) as f64;

/// Roundings between a ray's own numbers and a test inside a box, relative to the distances between them: the frame's subtraction
/// and product, and those of the exact test (translation, shear, dot products).
const MARGIN: f64 = gamma(16);

/// A bound on coordinates in a tree's frame.
const FRAME_SIZE: f64 = 2.0;

/// Entries of the stack that need no allocation; deeper ones spill.
const STACK: usize = 32;

/// Where a ray enters and leaves a box, at or after 0 and at or before `t_max`; none where it misses. Conservative: far sides are
/// widened. All comparisons let a NaN (0·∞, a ray in the plane of a side) pass.
pub fn clip(bounds: &Aabb, origin: DVec3, direction: DVec3, t_max: f64) -> Option<(f64, f64)> {
    clip_by(bounds, origin, direction.recip(), t_max)
}

/// The same by 1 over each coordinate of the direction.
fn clip_by(bounds: &Aabb, origin: DVec3, inverse: DVec3, t_max: f64) -> Option<(f64, f64)> {
    let (mut near, mut far) = (0.0, t_max);
    for a in 0..3 {
        let inverse = inverse[a];
        let sides = if inverse.is_sign_negative() {
            (bounds.max[a], bounds.min[a])
        } else {
            (bounds.min[a], bounds.max[a])
        };
        let enter = (sides.0 - origin[a]) * inverse;
        let leave = (sides.1 - origin[a]) * inverse * WIDEN_64;
        if enter > near {
            near = enter;
        }
        if leave < far {
            far = leave;
        }
    }
    (near <= far).then_some((near, far))
}

/// Which children of a node a ray meets, as bits, and where it enters each.
type Met = (u32, [f32; WIDTH]);

/// A child that is still to be visited, after where it is entered: numbers that order children, near ones first.
type Pending = u64;

#[inline(always)]
fn pending(near: f32, child: Child) -> Pending {
    u64::from(near.to_bits()) << 32 | u64::from(child.0)
}

#[inline(always)]
fn child_of(entry: Pending) -> Child {
    Child(entry as u32)
}

/// The children that are still to be visited.
type Waiting<'s> = Stack<'s, Pending, STACK>;

/// The last that begins at such a distance, and all before it.
#[inline(always)]
fn last_within(limit: f32) -> Pending {
    // Of a negative one, all; before which nothing is met.
    u64::from(limit.to_bits()) << 32 | u64::from(u32::MAX)
}

/// The first of some slots, which are bits.
#[inline(always)]
fn take(slots: &mut u32) -> usize {
    let slot = slots.trailing_zeros() as usize & (WIDTH - 1);
    *slots &= *slots - 1;
    slot
}

/// Pushes the children that the ray meets, of which there are some, but the nearest, farther ones first; gives the nearest.
#[inline(always)]
fn enter(node: &Node, fetch: impl Fn(Child), stack: &mut Waiting, (mut met, near): Met) -> Child {
    // Most often there is one, which is found before its distance is.
    let first = take(&mut met);
    if met == 0 {
        return node.children[first];
    }
    // All that are met are fetched, as which is the nearest is known only some time later.
    let key = |slot: usize| {
        let child = node.children[slot];
        fetch(child);
        pending(near[slot], child)
    };
    let first = key(first);
    let second = key(take(&mut met));
    let mut nearest = first.min(second);
    let bottom = stack.len();
    stack.push(first.max(second));
    while met != 0 {
        let next = key(take(&mut met));
        // Where some spilled, their order is lost, which costs time only.
        stack.push_above(bottom, nearest.max(next));
        nearest = nearest.min(next);
    }
    child_of(nearest)
}

impl Tree {
    /// Offers to `leaf` every range of [`Tree::order`] that the ray may meet before `t_max`, near ones first. `leaf` gives the
    /// distance beyond which nothing matters any more (so far); a negative one ends the traversal. The largest
    /// coordinate of the direction is at least ½ and does not reach 2.
    #[inline(always)]
    pub fn traverse(
        &self,
        origin: &DVec3,
        direction: &DVec3,
        t_max: f64,
        mut leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) {
        if let Some(t_max) = self.offer_loose(t_max, &mut leaf) {
            wide::walk(self, [origin, direction], t_max, (&mut leaf, nowhere(&self.nodes)));
        }
    }

    /// The same in no order, until `leaf` gives false.
    #[inline(always)]
    pub fn traverse_any(
        &self,
        origin: &DVec3,
        direction: &DVec3,
        t_max: f64,
        mut leaf: impl FnMut(Range<usize>) -> bool,
    ) {
        let mut loose = |range, t_max| if leaf(range) { t_max } else { -1.0 };
        if let Some(t_max) = self.offer_loose(t_max, &mut loose) {
            wide::walk_any(self, [origin, direction], t_max, (&mut leaf, nowhere(&self.nodes)));
        }
    }

    /// True where there are nodes and every item hangs under one: none has a box that is not finite.
    #[inline]
    pub fn is_whole(&self) -> bool {
        !self.nodes.is_empty() && self.bounded == self.order.len()
    }

    /// Offers what hangs under no node; gives what limits the rest, none where that does not matter.
    #[inline(always)]
    fn offer_loose(&self, mut t_max: f64, leaf: &mut impl FnMut(Range<usize>, f64) -> f64) -> Option<f64> {
        if self.bounded < self.order.len() {
            t_max = leaf(self.bounded..self.order.len(), t_max);
        }
        (!self.nodes.is_empty() && t_max >= 0.0).then_some(t_max)
    }
}

/// The traversal from where the ray enters. `meets` tests a node's children against a limit, as `limit_of` makes it ready; `ahead` says where the items from a
/// position on lie, for those that are visited later.
#[inline(always)]
fn walk<L: Copy>(
    tree: &Tree,
    entry: Entry,
    mut t_max: f64,
    (limit_of, meets): (impl Fn(f32) -> L, impl Fn(&Node, L) -> Met),
    (leaf, ahead): (&mut impl FnMut(Range<usize>, f64) -> f64, impl Fn(usize) -> *const i8),
) {
    let nodes = &tree.nodes[..];
    let fetch = |child: Child| fetch(nodes, child, &ahead);
    let limits = |t: f64| {
        let limit = entry.limit(t);
        (limit_of(limit), last_within(limit))
    };
    let (mut limit, mut last) = limits(t_max);
    let (mut held, mut spilled) = (Held::<_, STACK>::new(), Vec::new());
    let mut stack = Waiting::on(&mut held, &mut spilled);
    let mut node = &nodes[0];
    loop {
        let met = meets(node, limit);
        let mut child = if met.0 != 0 {
            enter(node, fetch, &mut stack, met)
        } else if let Some(entry) = stack.next(|entry| *entry <= last) {
            child_of(entry)
        } else {
            return;
        };
        while let Some(items) = child.items() {
            let found = leaf(items, t_max);
            if found < t_max {
                if found < 0.0 {
                    return;
                }
                t_max = found;
                (limit, last) = limits(t_max);
            }
            let Some(entry) = stack.next(|entry| *entry <= last) else { return };
            child = child_of(entry);
        }
        node = child.node_of(nodes);
    }
}

/// The traversal in no order until `leaf` gives false.
#[inline(always)]
fn walk_any<L: Copy>(
    tree: &Tree,
    entry: Entry,
    t_max: f64,
    (limit_of, meets): (impl Fn(f32) -> L, impl Fn(&Node, L) -> Met),
    (leaf, ahead): (&mut impl FnMut(Range<usize>) -> bool, impl Fn(usize) -> *const i8),
) {
    let nodes = &tree.nodes[..];
    let limit = limit_of(entry.limit(t_max));
    let (mut held, mut spilled) = (Held::<_, STACK>::new(), Vec::new());
    let mut stack = Stack::on(&mut held, &mut spilled);
    let mut node = &nodes[0];
    loop {
        let (mut met, _) = meets(node, limit);
        let mut child;
        if met != 0 {
            child = node.children[take(&mut met)];
            while met != 0 {
                let waiting = node.children[take(&mut met)];
                fetch(nodes, waiting, &ahead);
                stack.push(waiting);
            }
        } else {
            let Some(waiting) = stack.pop() else { return };
            child = waiting;
        }
        while let Some(items) = child.items() {
            if !leaf(items) {
                return;
            }
            let Some(waiting) = stack.pop() else { return };
            child = waiting;
        }
        node = child.node_of(nodes);
    }
}
