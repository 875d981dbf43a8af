//! The one traversal: nearest boxes first, for closest hits and for any hit.
//!
//! Rays go one by one. Camera rays in packets would save a part of the walk alone, which is a fifth of the time of a picture without second
//! rays of 82 thousand triangles (the tests of triangles are a seventh), and less of every other picture.

mod counting;
mod entry;
mod wide;

use super::{Node, Tree, WIDTH};
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::world::stack::Stack;
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

/// Nodes that no cache near the processor holds: from then on those that wait are fetched ahead.
const MANY: usize = 1 << 14;

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

/// The bits of a distance that name a slot.
const SLOT: u32 = WIDTH as u32 - 1;

/// A child by its node and slot.
type Child = (u32, u32);

/// A child that is still to be visited: where it is entered, of which the last three bits are its slot, and its node. Numbers that
/// order children, near ones first.
type Pending = u64;

#[inline(always)]
fn pending(near: f32, (node, slot): Child) -> Pending {
    u64::from(near.to_bits() & !SLOT | slot) << 32 | u64::from(node)
}

#[inline(always)]
fn child_of(entry: Pending) -> Child {
    (entry as u32, (entry >> 32) as u32 & SLOT)
}

/// The children that are still to be visited.
type Waiting<'s> = Stack<'s, Pending, STACK>;

/// The last that begins at such a distance, and all before it.
#[inline(always)]
fn last_within(limit: f32) -> Pending {
    // Of a negative one, all; before which nothing is met.
    u64::from(limit.to_bits() | SLOT) << 32 | u64::from(u32::MAX)
}

/// Pushes the children that the ray meets but the nearest, farther ones first; gives the nearest.
#[inline(always)]
fn enter(nodes: &[Node], stack: &mut Waiting, node: u32, (mut mask, near): Met) -> Option<Child> {
    if mask == 0 {
        return None;
    }
    let mut take = || {
        let slot = mask.trailing_zeros() & SLOT;
        mask &= mask - 1;
        (slot, mask == 0)
    };
    // Most often there is one, which is found before its distance is.
    let (slot, is_last) = take();
    if is_last {
        return Some((node, slot));
    }
    let is_large = nodes.len() >= MANY;
    let key = |slot: u32| {
        if is_large {
            wide::fetch(nodes, nodes[node as usize].child(slot as usize));
        }
        pending(near[slot as usize], (node, slot))
    };
    let first = key(slot);
    let (slot, mut is_last) = take();
    let second = key(slot);
    let mut nearest = first.min(second);
    // And then two, of which one waits.
    let bottom = stack.len();
    stack.push(first.max(second));
    if !is_last {
        while !is_last {
            let slot;
            (slot, is_last) = take();
            let next = key(slot);
            stack.push(nearest.max(next));
            nearest = nearest.min(next);
        }
        // Where some spilled, their order is lost, which costs time only.
        sort_far_first(stack.above(bottom));
    }
    Some(child_of(nearest))
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
            wide::walk(self, [origin, direction], t_max, &mut leaf);
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
            wide::walk_any(self, [origin, direction], t_max, &mut leaf);
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

/// The traversal from where the ray enters. `meets` tests a node's children against a limit.
#[inline(always)]
fn walk(
    tree: &Tree,
    entry: Entry,
    mut t_max: f64,
    meets: impl Fn(&Node, f32) -> Met,
    leaf: &mut impl FnMut(Range<usize>, f64) -> f64,
) {
    let nodes = &tree.nodes[..];
    let mut limit = entry.limit(t_max);
    let mut last = last_within(limit);
    let (mut held, mut spilled) = ([0; STACK], Vec::new());
    let mut stack = Waiting::new(&mut held, &mut spilled);
    let mut at = 0;
    loop {
        let met = meets(&nodes[at as usize], limit);
        let mut waiting = enter(nodes, &mut stack, at, met);
        if waiting.is_none() {
            waiting = stack.next(|entry| *entry <= last).map(child_of);
        }
        loop {
            let Some((node, slot)) = waiting else { return };
            let node = &nodes[node as usize];
            let (child, count) = (node.child(slot as usize), node.count(slot as usize));
            if count == 0 {
                at = child;
                break;
            } else {
                let first = child as usize;
                let found = leaf(first..first + count as usize, t_max);
                if found < t_max {
                    if found < 0.0 {
                        return;
                    }
                    t_max = found;
                    limit = entry.limit(t_max);
                    last = last_within(limit);
                }
            }
            waiting = stack.next(|entry| *entry <= last).map(child_of);
        }
    }
}

/// The traversal in no order until `leaf` gives false: what waits are nodes, each with the children that are left of it.
#[inline(always)]
fn walk_any(
    tree: &Tree,
    entry: Entry,
    t_max: f64,
    meets: impl Fn(&Node, f32) -> Met,
    leaf: &mut impl FnMut(Range<usize>) -> bool,
) {
    let nodes = &tree.nodes[..];
    let limit = entry.limit(t_max);
    let (mut held, mut spilled) = ([(0u32, 0u32); STACK], Vec::new());
    let mut stack = Stack::new(&mut held, &mut spilled);
    let mut at = 0;
    loop {
        let (mut left, _) = meets(&nodes[at as usize], limit);
        loop {
            if left == 0 {
                let Some(waiting) = stack.pop() else { return };
                (at, left) = waiting;
            }
            let node = &nodes[at as usize];
            let slot = (left.trailing_zeros() & SLOT) as usize;
            left &= left - 1;
            let (child, count) = (node.child(slot), node.count(slot));
            if count == 0 {
                if left != 0 {
                    if nodes.len() >= MANY {
                        wide::fetch(nodes, node.child((left.trailing_zeros() & SLOT) as usize));
                    }
                    stack.push((at, left));
                }
                at = child;
                break;
            }
            let first = child as usize;
            if !leaf(first..first + count as usize) {
                return;
            }
        }
    }
}

/// Insertion sort of a few.
#[inline(always)]
fn sort_far_first(entries: &mut [Pending]) {
    for i in 1..entries.len() {
        let mut j = i;
        while j > 0 && entries[j] > entries[j - 1] {
            entries.swap(j, j - 1);
            j -= 1;
        }
    }
}
