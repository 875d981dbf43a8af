//! The one traversal: nearest boxes first, for closest hits and for any hit.

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
const STACK: usize = 64;

/// Where a ray enters and leaves a box, at or after 0 and at or before `t_max`; none where it misses. Conservative: far sides are
/// widened. All comparisons let a NaN (0·∞, a ray in the plane of a side) pass.
pub fn clip(bounds: &Aabb, origin: DVec3, direction: DVec3, t_max: f64) -> Option<(f64, f64)> {
    let (mut near, mut far) = (0.0, t_max);
    for a in 0..3 {
        let inverse = 1.0 / direction[a];
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
    /// `start` is where the ray enters the tree's bounds.
    fn new(tree: &Tree, origin: DVec3, direction: DVec3, start: f64) -> Narrow {
        let e = exponent(direction.abs().max_element());
        let (unit, reach) = (power_of_two(-e), power_of_two(e) * tree.frame.scale);
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
            per_t: reach,
        };
        for a in 0..3 {
            let inverse = 1.0 / (direction[a] * unit);
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
    fn limit(&self, t: f64) -> f32 {
        round_up(((t - self.start) * SLACK + t * MARGIN) * self.per_t * f64::from(WIDEN))
    }

    /// Which children the ray meets before `limit`, as bits, and where it enters each.
    #[inline(always)]
    fn meets(&self, node: &Node, limit: f32) -> (u32, [f32; WIDTH]) {
        let (mut near, mut far) = ([0.0f32; WIDTH], [limit; WIDTH]);
        for a in 0..3 {
            let (enter, leave) = (&node.rows[self.near_row[a] & 7], &node.rows[self.far_row[a] & 7]);
            for i in 0..WIDTH {
                let x = (enter[i] - self.near_origin[a]) * self.near_inverse[a];
                near[i] = if x > near[i] { x } else { near[i] };
                let y = (leave[i] - self.far_origin[a]) * self.far_inverse[a];
                far[i] = if y < far[i] { y } else { far[i] };
            }
        }
        let mut mask = 0;
        for i in 0..WIDTH {
            mask |= u32::from(near[i] <= far[i]) << i;
        }
        (mask, near)
    }
}

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
        let Some((start, _)) = clip(&self.bounds, origin, direction, t_max) else { return };
        let ray = Narrow::new(self, origin, direction, start);
        let mut limit = ray.limit(t_max);
        let mut stack = Stack::new();
        let mut current = Entry::default();
        loop {
            if current.count > 0 {
                let first = current.child as usize;
                let found = leaf(first..first + current.count as usize, t_max);
                if found < 0.0 {
                    return;
                }
                if found < t_max {
                    t_max = found;
                    limit = ray.limit(t_max);
                }
            } else {
                push_children(&self.nodes[current.child as usize], &ray, limit, &mut stack);
            }
            loop {
                match stack.pop() {
                    None => return,
                    Some(entry) if entry.near <= limit => {
                        current = entry;
                        break;
                    }
                    Some(_) => {}
                }
            }
        }
    }
}

/// Pushes the children that the ray meets, the nearest last.
#[inline(always)]
fn push_children(node: &Node, ray: &Narrow, limit: f32, stack: &mut Stack) {
    let (mut mask, near) = ray.meets(node, limit);
    let bottom = stack.len;
    let spilled = !stack.spilled.is_empty();
    while mask != 0 {
        let i = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        stack.push(Entry { near: near[i], child: node.child(i), count: node.count(i) });
    }
    if !spilled && stack.spilled.is_empty() {
        sort_far_first(&mut stack.entries[bottom..stack.len]);
    }
}

/// Insertion sort of at most four; ties keep the first child on top.
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
