//! The one traversal: cells in the order of the ray, for closest hits and for any hit.
//!
//! A cell is visited where the ray enters none of its sides after it leaves another: the slab test of the cell's box, plane by plane on the way
//! down. Planes that it enters through are measured from an origin that is moved against the ray by what may be wrong with it, those that it leaves
//! through from one moved along it, and the latter are widened by what the three roundings of a distance may lose (Ize, *Robust BVH ray
//! traversal*, 2013). All comparisons let a NaN (0·∞, a ray in a plane) pass.
//!
//! A hit ends the traversal only once the cells that follow begin beyond it: an item reaches into cells that the ray comes to later, and
//! is tested as a whole, so its hit may lie behind that of another which only the next cell knows.

use super::Tree;
use crate::math::error::gamma;
use crate::math::exact::{exponent, power_of_two};
use crate::world::stack::{Held, Stack};
use glam::DVec3;
use std::ops::Range;

/// 1 + 2γ₃: what distances to planes that a ray leaves through are widened by.
const WIDEN: f64 = 1.0 + 2.0 * gamma(3);

/// How far beyond the best hit cells are still opened, relative to its distance: hides the rounding of both and keeps ties.
const SLACK: f64 = 1.0 + 1.0 / (1u64 << 20) as f64;

/// The same as a share of how far the tree reaches from the ray's origin. Distances to slivers are that much off, and unlike a box around all of
/// one, a cell may begin close to where it is met.
const REACH_SLACK: f64 = 1.0 / (1u64 << 21) as f64;

/// Roundings between a ray's own numbers and a test inside a cell, relative to the distances between them: the frame's subtraction
/// and product, and those of the exact test (translation, shear, dot products).
const MARGIN: f64 = gamma(16);

/// A bound on coordinates in a tree's frame.
const FRAME_SIZE: f64 = 2.0;

/// Entries of the stack that need no allocation; deeper ones spill.
const STACK: usize = 24;

/// Items of many cells that a ray remembers to have been offered.
const MAILBOXES: usize = 8;

/// A ray in a tree's frame, along which s = t · `per_t`.
struct Framed {
    /// Where the planes that the ray enters through are measured from, and those it leaves through.
    near_origin: [f64; 3],
    far_origin: [f64; 3],
    /// Of the direction; widened for planes that it leaves through.
    near_inverse: [f64; 3],
    far_inverse: [f64; 3],
    /// True where it goes down an axis.
    down: [bool; 3],
    per_t: f64,
    slack: f64,
}

impl Framed {
    fn new(tree: &Tree, origin: DVec3, direction: DVec3) -> Framed {
        let unit = power_of_two(exponent(direction.abs().max_element()));
        let origin = tree.frame.point(origin);
        let inverse = direction.recip() * unit;
        // Up to the far end of the tree a ray travels as far as its origin is away and the tree is large.
        let reach = origin.abs().max_element() + FRAME_SIZE;
        let margin = 2.0 * MARGIN * reach;
        let down = std::array::from_fn(|a| inverse[a].is_sign_negative());
        let against = |a: usize| if down[a] { -margin } else { margin };
        Framed {
            near_origin: std::array::from_fn(|a| origin[a] + against(a)),
            far_origin: std::array::from_fn(|a| origin[a] - against(a)),
            near_inverse: inverse.to_array(),
            far_inverse: (inverse * WIDEN).to_array(),
            down,
            per_t: unit * tree.frame.scale,
            slack: REACH_SLACK * reach,
        }
    }

    /// Where the ray comes through a plane to its far side, or earlier.
    #[inline(always)]
    fn enters(&self, axis: usize, plane: f64) -> f64 {
        (plane - self.near_origin[axis]) * self.near_inverse[axis]
    }

    /// Where the ray leaves the near side of a plane, or later.
    #[inline(always)]
    fn leaves(&self, axis: usize, plane: f64) -> f64 {
        (plane - self.far_origin[axis]) * self.far_inverse[axis]
    }

    /// At or beyond the distance t.
    #[inline(always)]
    fn limit(&self, t: f64) -> f64 {
        t * (SLACK + MARGIN) * self.per_t * WIDEN + self.slack
    }

    /// Where the ray is in the tree, before a limit.
    fn within(&self, tree: &Tree, limit: f64) -> (f64, f64) {
        let (mut near, mut far) = (0.0, limit);
        for a in 0..3 {
            let (lower, upper) = (f64::from(tree.root.lower[a]), f64::from(tree.root.upper[a]));
            let sides = if self.down[a] { (upper, lower) } else { (lower, upper) };
            near = later(self.enters(a, sides.0), near);
            far = earlier(self.leaves(a, sides.1), far);
        }
        (near, far)
    }
}

/// The second where the first is NaN.
#[inline(always)]
fn later(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// The second where the first is NaN.
#[inline(always)]
fn earlier(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

/// A cell that is still to be visited, and where the ray is in it.
#[derive(Clone, Copy, Default)]
struct Entry {
    node: usize,
    near: f64,
    far: f64,
}

impl Tree {
    /// Offers to `leaf` every range of [`Tree::order`] that the ray may meet before `t_max`, near ones first, some items perhaps more than once.
    /// `leaf` gives the distance beyond which nothing matters any more (so far); a negative one ends the traversal.
    #[inline]
    pub fn traverse(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) {
        self.traverse_counting(origin, direction, t_max, || (), leaf);
    }

    /// The same, and calls `visit` for each node and each leaf; as a part of the caller, by the instructions that it is compiled for.
    #[inline(always)]
    pub fn traverse_counting(
        &self,
        origin: DVec3,
        direction: DVec3,
        mut t_max: f64,
        visit: impl FnMut(),
        mut leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) {
        if self.bounded < self.order.len() {
            t_max = leaf(self.bounded..self.order.len(), t_max);
        }
        if !self.nodes.is_empty() && t_max >= 0.0 {
            self.walk(&Framed::new(self, origin, direction), t_max, visit, leaf);
        }
    }

    #[inline(always)]
    fn walk(
        &self,
        ray: &Framed,
        mut t_max: f64,
        mut visit: impl FnMut(),
        mut leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) {
        let mut limit = ray.limit(t_max);
        let (mut near, mut far) = ray.within(self, limit);
        if near > far {
            return;
        }
        let (mut held, mut spilled) = (Held::<_, STACK>::new(), Vec::new());
        let mut stack = Stack::on(&mut held, &mut spilled);
        let mut offered = [u32::MAX; MAILBOXES];
        let mut at = 0;
        loop {
            let node = self.nodes[at];
            visit();
            if !node.is_leaf() {
                let (axis, plane) = (node.axis(), f64::from(node.plane));
                let (enter, leave) = (ray.enters(axis, plane), ray.leaves(axis, plane));
                let (first, second) =
                    if ray.down[axis] { (node.upper(), at + 1) } else { (at + 1, node.upper()) };
                if leave < near {
                    at = second;
                } else {
                    at = first;
                    if enter > far {
                        continue;
                    }
                    stack.push(Entry { node: second, near: later(enter, near), far });
                    far = earlier(leave, far);
                }
                continue;
            }
            let names = &self.references[node.first()..node.first() + node.upper()];
            let mut i = 0;
            while i < names.len() {
                let first = names[i];
                let mut end = first + 1;
                i += 1;
                while i < names.len() && names[i] == end {
                    end += 1;
                    i += 1;
                }
                if end == first + 1 {
                    let mailbox = &mut offered[first as usize % MAILBOXES];
                    if *mailbox == first {
                        continue;
                    }
                    *mailbox = first;
                }
                let found = leaf(first as usize..end as usize, t_max);
                if found < 0.0 {
                    return;
                }
                if found < t_max {
                    t_max = found;
                    limit = ray.limit(t_max);
                }
            }
            // The last that begins before the limit, NaN included.
            let Some(next) = stack.next(|entry| !(entry.near > limit)) else { return };
            (at, near, far) = (next.node, next.near, earlier(next.far, limit));
        }
    }
}
