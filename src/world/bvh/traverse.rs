//! The one traversal: nearest boxes first, for closest hits and for any hit.

mod counting;
mod wide;

use super::frame::{round_down, round_up};
use super::{Node, Tree, WIDTH};
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::math::exact::{exponent, power_of_two};
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

/// A ray in a tree's frame, narrowed so that it meets more boxes rather than fewer.
struct Narrow {
    /// Where the planes that the ray enters through are measured from, and those it leaves through.
    near_origin: [f32; 3],
    far_origin: [f32; 3],
    /// Of the direction; widened for the far planes.
    near_inverse: [f32; 3],
    far_inverse: [f32; 3],
    /// Rows of [`Node`].
    near_row: [usize; 3],
    far_row: [usize; 3],
    /// s = (t − start)·per_t.
    start: f64,
    per_t: f64,
}

impl Narrow {
    /// `start` is where the ray enters the tree's bounds, `inverse` 1 over each coordinate of its direction.
    fn new(tree: &Tree, origin: DVec3, direction: DVec3, inverse: DVec3, start: f64) -> Narrow {
        let unit = power_of_two(exponent(direction.abs().max_element()));
        let from_center = origin - tree.frame.center;
        let entry = (from_center + direction * start) * tree.frame.scale;
        let travelled = from_center.abs().max_element() + direction.abs().max_element() * start;
        let margin = MARGIN * (travelled * tree.frame.scale + FRAME_SIZE);
        let mut ray = Narrow {
            near_origin: [0.0; 3],
            far_origin: [0.0; 3],
            near_inverse: [0.0; 3],
            far_inverse: [0.0; 3],
            near_row: [0, 1, 2],
            far_row: [3, 4, 5],
            start,
            per_t: unit * tree.frame.scale,
        };
        for a in 0..3 {
            let inverse = inverse[a] * unit;
            let (below, above) = (round_down(entry[a] - margin), round_up(entry[a] + margin));
            let negative = inverse.is_sign_negative();
            (ray.near_origin[a], ray.far_origin[a]) = if negative { (below, above) } else { (above, below) };
            if negative {
                (ray.near_row[a], ray.far_row[a]) = (a + 3, a);
            }
            ray.near_inverse[a] = inverse as f32;
            ray.far_inverse[a] = inverse as f32 * WIDEN;
        }
        ray
    }

    /// A float at or beyond the distance t in the tree's frame.
    #[inline(always)]
    fn limit(&self, t: f64) -> f32 {
        round_up(((t - self.start) * SLACK + t * MARGIN) * self.per_t * f64::from(WIDEN))
    }
}

/// Which children of a node a ray meets, as bits, and where it enters each.
type Met = (u32, [f32; WIDTH]);

/// A child that is still to be visited.
#[derive(Clone, Copy, Default)]
struct Entry {
    near: f32,
    child: u32,
    count: u32,
}

/// A stack that spills.
struct Stack {
    entries: [Entry; STACK],
    len: usize,
    spilled: Vec<Entry>,
}

impl Stack {
    #[inline(always)]
    fn new() -> Stack {
        Stack { entries: [Entry::default(); STACK], len: 0, spilled: Vec::new() }
    }

    #[inline(always)]
    fn push(&mut self, entry: Entry) {
        if self.len < STACK {
            self.entries[self.len] = entry;
            self.len += 1;
        } else {
            self.spilled.push(entry);
        }
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<Entry> {
        if self.len == STACK
            && let Some(entry) = self.spilled.pop()
        {
            return Some(entry);
        }
        self.len = self.len.checked_sub(1)?;
        Some(self.entries[self.len])
    }

    /// The last entry that begins before the limit.
    #[inline(always)]
    fn next(&mut self, limit: f32) -> Option<Entry> {
        loop {
            let entry = self.pop()?;
            if entry.near <= limit {
                return Some(entry);
            }
        }
    }

    /// Pushes the children that the ray meets but the nearest, farther ones first; gives the nearest.
    #[inline(always)]
    fn enter(&mut self, node: &Node, (mut mask, near): Met) -> Option<Entry> {
        if mask == 0 {
            return None;
        }
        let entry = |i: usize| Entry { near: near[i], child: node.child(i), count: node.count(i) };
        let mut nearest = entry(mask.trailing_zeros() as usize & (WIDTH - 1));
        mask &= mask - 1;
        if mask == 0 {
            return Some(nearest);
        }
        let bottom = self.len;
        loop {
            let mut other = entry(mask.trailing_zeros() as usize & (WIDTH - 1));
            mask &= mask - 1;
            if other.near < nearest.near {
                std::mem::swap(&mut other, &mut nearest);
            }
            self.push(other);
            if mask == 0 {
                break;
            }
        }
        if self.len == bottom + 1 {
            return Some(nearest);
        }
        // Where some spilled, their order is lost, which costs time only.
        sort_far_first(&mut self.entries[bottom..self.len]);
        Some(nearest)
    }
}

impl Tree {
    /// Offers to `leaf` every range of [`Tree::order`] that the ray may meet before `t_max`, near ones first. `leaf` gives the
    /// distance beyond which nothing matters any more (so far); a negative one ends the traversal.
    #[inline]
    pub fn traverse(
        &self,
        origin: DVec3,
        direction: DVec3,
        mut t_max: f64,
        mut leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) {
        if self.bounded < self.order.len() {
            t_max = leaf(self.bounded..self.order.len(), t_max);
        }
        if self.nodes.is_empty() || t_max < 0.0 {
            return;
        }
        let inverse = direction.recip();
        if let Some((start, _)) = clip_by(&self.bounds, origin, inverse, t_max) {
            let ray = Narrow::new(self, origin, direction, inverse, start);
            wide::walk(&self.nodes, &ray, t_max, leaf);
        }
    }
}

/// The traversal from the first node down. `meets` tests a node's children against a limit.
#[inline(always)]
fn walk(
    nodes: &[Node],
    ray: &Narrow,
    mut t_max: f64,
    meets: impl Fn(&Node, f32) -> Met,
    mut leaf: impl FnMut(Range<usize>, f64) -> f64,
) {
    let mut limit = ray.limit(t_max);
    let mut stack = Stack::new();
    let mut current = Entry::default();
    let mut is_first = true;
    loop {
        // A ray of which a number is infinite or NaN meets absent children too, which name the first node.
        let is_absent = current.count == 0 && current.child == 0 && !is_first;
        is_first = false;
        let nearest = if is_absent {
            None
        } else if current.count == 0 {
            let node = &nodes[current.child as usize];
            stack.enter(node, meets(node, limit))
        } else {
            let first = current.child as usize;
            let found = leaf(first..first + current.count as usize, t_max);
            if found < 0.0 {
                return;
            }
            if found < t_max {
                t_max = found;
                limit = ray.limit(t_max);
            }
            None
        };
        match nearest.or_else(|| stack.next(limit)) {
            Some(next) => current = next,
            None => return,
        }
    }
}

/// Insertion sort of a few; ties keep the first child on top.
#[inline(always)]
fn sort_far_first(entries: &mut [Entry]) {
    for i in 1..entries.len() {
        let mut j = i;
        while j > 0 && entries[j].near >= entries[j - 1].near {
            entries.swap(j, j - 1);
            j -= 1;
        }
    }
}
