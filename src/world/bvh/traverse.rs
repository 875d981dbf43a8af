//! The one traversal: nearest boxes first, for closest hits and for any hit.

mod counting;
mod entry;
mod wide;

use super::{Node, Tree, WIDTH};
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::world::stack::Stack;
use entry::{Entry, Narrow};
use glam::DVec3;
use std::ops::Range;

/// 1 + 2γ₃ in f32: what the far side of a slab is widened by, so that its three roundings never lose a ray that grazes the box
/// (Ize, *Robust BVH ray traversal*, 2013).
const WIDEN: f32 = 1.0 + 6.0 * (f32::EPSILON / 2.0) * 1.000_001;

/// The same in f64.
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

/// Which children of a node a ray meets, as bits, and by child the bits of where it enters, of which the last three are the
/// child's slot: numbers that order children, near ones first.
type Met = (u32, [u32; WIDTH]);

/// The bits of a distance that name a slot.
const SLOT: u32 = WIDTH as u32 - 1;

/// A child that is still to be visited: its distance and slot, and its node.
type Pending = u64;

/// The children that are still to be visited.
type Waiting = Stack<Pending, STACK>;

/// The last child that begins before the limit.
#[inline(always)]
fn next(stack: &mut Waiting, limit: f32) -> Option<Pending> {
    stack.next(|entry| f32::from_bits((entry >> 32) as u32 & !SLOT) <= limit)
}

/// Pushes the children that the ray meets but the nearest, farther ones first; gives the nearest.
#[inline(always)]
fn enter(stack: &mut Waiting, node: u32, (mut mask, keys): Met) -> Option<Pending> {
    if mask == 0 {
        return None;
    }
    let mut take = || {
        let key = keys[(mask.trailing_zeros() & SLOT) as usize];
        mask &= mask - 1;
        (u64::from(key) << 32 | u64::from(node), mask == 0)
    };
    let (first, is_last) = take();
    if is_last {
        return Some(first);
    }
    let (second, is_last) = take();
    let (mut nearest, other) = (first.min(second), first.max(second));
    let bottom = stack.len();
    stack.push(other);
    if is_last {
        return Some(nearest);
    }
    loop {
        let (next, is_last) = take();
        stack.push(nearest.max(next));
        nearest = nearest.min(next);
        if is_last {
            break;
        }
    }
    // Where some spilled, their order is lost, which costs time only.
    sort_far_first(stack.above(bottom));
    Some(nearest)
}

impl Tree {
    /// Offers to `leaf` every range of [`Tree::order`] that the ray may meet before `t_max`, near ones first. `leaf` gives the
    /// distance beyond which nothing matters any more (so far); a negative one ends the traversal. No coordinate of the direction reaches 2.
    #[inline]
    pub fn traverse(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        mut leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) {
        if let Some(t_max) = self.offer_loose(t_max, &mut leaf) {
            wide::walk(self, origin, direction, t_max, leaf);
        }
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
    origin: DVec3,
    direction: DVec3,
    mut t_max: f64,
    meets: impl Fn(&Narrow, &Node, f32) -> Met,
    mut leaf: impl FnMut(Range<usize>, f64) -> f64,
) {
    let Some(entry) = Entry::new(tree, origin, direction, t_max) else { return };
    let (ray, nodes) = (Narrow::new(&entry), &tree.nodes);
    let mut limit = entry.limit(t_max);
    let mut stack = Waiting::new();
    let mut at = 0;
    loop {
        let mut waiting = enter(&mut stack, at, meets(&ray, &nodes[at as usize], limit))
            .or_else(|| next(&mut stack, limit));
        loop {
            let Some(pending) = waiting else { return };
            let (node, slot) = (&nodes[pending as u32 as usize], (pending >> 32) as u32 & SLOT);
            let (child, count) = (node.child(slot as usize), node.count(slot as usize));
            if count == 0 {
                // A ray of which a number is infinite or NaN meets absent children too, which name the first node.
                if child != 0 {
                    at = child;
                    break;
                }
            } else {
                let first = child as usize;
                let found = leaf(first..first + count as usize, t_max);
                if found < 0.0 {
                    return;
                }
                if found < t_max {
                    t_max = found;
                    limit = entry.limit(t_max);
                }
            }
            waiting = next(&mut stack, limit);
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
