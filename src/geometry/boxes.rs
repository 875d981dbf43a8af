//! A small tree of f64 boxes over the parts of one surface, for rays that are then tested against the parts exactly. Knows nothing of what
//! the parts are; the trees over whole scenes are the world's.

use super::curve::any_across;
use super::nearest_first::{self, Branch};
use crate::math::error::gamma;
use crate::math::{Aabb, Point};
use glam::DVec3;
use std::ops::Range;

/// A ray with a unit direction.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes: a unit vector.
    pub direction: DVec3,
    /// Length of the direction as it was given: one of its distances is so many of this line's.
    pub length: f64,
    inverse: DVec3,
}

impl Line {
    /// None for a direction of length 0, or one that is not finite.
    pub fn new(origin: DVec3, direction: DVec3) -> Option<Line> {
        let unit = Point::unit(direction)?;
        Some(Line { origin, direction: unit, length: Point::length(direction), inverse: unit.recip() })
    }

    /// Unit vectors at right angles to the line and to each other; with the direction they are right-handed.
    pub fn across(&self) -> [DVec3; 2] {
        let first = any_across(self.direction);
        [first, self.direction.cross(first)]
    }

    /// The point at a distance.
    pub fn at(&self, s: f64) -> DVec3 {
        self.origin + self.direction * s
    }

    /// Where the line enters a box, if it does between `near` and `far`. Comparisons drop the NaN of 0 · ∞, and the far side is widened
    /// by the rounding of its three operations.
    pub fn entry(&self, b: &Aabb, near: f64, far: f64) -> Option<f64> {
        let (mut enter, mut leave) = (near, far);
        for axis in 0..3 {
            let backwards = self.inverse[axis] < 0.0;
            let (first, second) =
                if backwards { (b.max[axis], b.min[axis]) } else { (b.min[axis], b.max[axis]) };
            let t0 = (first - self.origin[axis]) * self.inverse[axis];
            let t1 = (second - self.origin[axis]) * self.inverse[axis];
            let t1 = t1 + t1.abs() * (2.0 * gamma(3));
            if t0 > enter {
                enter = t0;
            }
            if t1 < leave {
                leave = t1;
            }
        }
        (enter <= leave).then_some(enter)
    }
}

/// The tree. Empty for no parts.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// Of a leaf: its first part. Of an inner node: its second child; the first follows it.
    index: u32,
    /// Of a leaf: how many parts. Of an inner node: 0.
    count: u32,
}

impl BoxTree {
    /// Lays out the tree, with at most `leaf` parts in a leaf, and puts the parts in its order.
    pub fn build<T>(parts: &mut [T], leaf: usize, bounds: impl Fn(&T) -> Aabb) -> BoxTree {
        let mut tree = BoxTree { nodes: Vec::with_capacity(parts.len()) };
        if !parts.is_empty() {
            let n = parts.len();
            tree.divide(parts, 0..n, leaf.max(1), &bounds);
        }
        tree
    }

    /// Halves the parts in the middle of the longest side of their centres.
    fn divide<T>(
        &mut self,
        parts: &mut [T],
        range: Range<usize>,
        leaf: usize,
        bounds: &impl Fn(&T) -> Aabb,
    ) -> u32 {
        let own = self.nodes.len();
        let here = &mut parts[range.clone()];
        let around = here.iter().fold(Aabb::EMPTY, |sum, part| sum.union(bounds(part)));
        self.nodes.push(Node { bounds: around, index: range.start as u32, count: range.len() as u32 });
        if range.len() > leaf {
            let centers = Aabb::of(here.iter().map(|part| bounds(part).center()));
            let axis = (0..3).max_by(|a, b| centers.size()[*a].total_cmp(&centers.size()[*b])).unwrap_or(0);
            let half = range.len() / 2;
            here.select_nth_unstable_by(half, |a, b| {
                bounds(a).center()[axis].total_cmp(&bounds(b).center()[axis])
            });
            let middle = range.start + half;
            self.divide(parts, range.start..middle, leaf, bounds);
            let second = self.divide(parts, middle..range.end, leaf, bounds);
            self.nodes[own] = Node { bounds: around, index: second, count: 0 };
        }
        own as u32
    }

    /// The box around all parts; empty where there are none.
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |node| node.bounds)
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }

    /// Visits ranges of parts whose boxes the line meets between `near` and `far`, near ones first. `visit` is given the far end and returns
    /// the new one.
    pub fn walk(&self, line: &Line, near: f64, far: f64, visit: impl FnMut(Range<usize>, f64) -> f64) {
        if self.nodes.is_empty() {
            return;
        }
        let entry = |index: u32, far: f64| line.entry(&self.nodes[index as usize].bounds, near, far);
        let branch = |index: u32| match &self.nodes[index as usize] {
            Node { index: second, count: 0, .. } => Branch::Fork(index + 1, *second),
            Node { index: first, count, .. } => Branch::Leaf(*first as usize..(*first + *count) as usize),
        };
        nearest_first::walk(far, entry, branch, visit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_box_on_the_way_is_visited() {
        let cell = |i: &usize| {
            let corner = DVec3::new((i % 10) as f64, (i / 10 % 10) as f64, (i / 100) as f64);
            Aabb { min: corner, max: corner + 0.9 }
        };
        let mut parts: Vec<usize> = (0..1000).collect();
        let tree = BoxTree::build(&mut parts, 2, cell);
        for k in 0..50 {
            let (x, y) = (f64::from(k % 10) + 0.3, f64::from(k / 10) * 1.7 + 0.2);
            let line = Line::new(DVec3::new(x, y, -3.0), DVec3::new(0.02, 0.01, 2.0)).unwrap();
            let mut seen = Vec::new();
            tree.walk(&line, 0.0, f64::INFINITY, |range, far| {
                seen.extend_from_slice(&parts[range]);
                far
            });
            for i in 0..1000 {
                let is_met = line.entry(&cell(&i), 0.0, f64::INFINITY).is_some();
                assert!(!is_met || seen.contains(&i), "{k}: {i}");
            }
        }
        BoxTree::default().walk(&Line::new(DVec3::ZERO, DVec3::X).unwrap(), 0.0, 1.0, |_, _| {
            unreachable!("there is nothing")
        });
    }
}
