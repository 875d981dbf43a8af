//! A tree of balls over the parts of a chain, for rays: where parts are much thicker than they are long their boxes all overlap, but a ball says
//! to within a part's length where a ray comes to it. Knows nothing of what the parts are.

use super::boxes::Line;
use super::nearest_first::{self, Branch};
use crate::math::Aabb;
use crate::math::error::gamma;
use glam::DVec3;
use std::ops::Range;

/// All points no farther than `reach` from `center`.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// Its middle.
    pub center: DVec3,
    /// Its radius.
    pub reach: f64,
}

/// Roundings of where a line comes to a ball, in u of its distance: of the unit direction, a product, a difference, and as many again.
const ROUNDINGS: f64 = gamma(32);

impl Ball {
    /// Around balls about points.
    pub fn around(balls: impl Iterator<Item = (DVec3, f64)> + Clone) -> Ball {
        let center = Aabb::of(balls.clone().map(|(p, _)| p)).center();
        let reach = balls.fold(0.0, |most: f64, (p, r)| most.max(p.distance(center) + r));
        Ball { center, reach: reach * (1.0 + ROUNDINGS) }
    }

    /// Where a line comes to it, if it does between `near` and `far`; perhaps earlier by roundings.
    #[inline]
    pub fn entry(&self, line: &Line, near: f64, far: f64) -> Option<f64> {
        let to = self.center - line.origin;
        let s = to.dot(line.direction);
        let slack = s.abs() * ROUNDINGS;
        let reach = self.reach + slack;
        let left = reach * reach - (to - line.direction * s).length_squared() * (1.0 - ROUNDINGS);
        if !(left >= 0.0) {
            return None;
        }
        let half = left.sqrt() + slack;
        (s - half <= far && s + half >= near).then_some(s - half)
    }
}

/// The tree. Empty for no parts.
#[derive(Clone, Debug, Default)]
pub struct BallTree {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    ball: Ball,
    /// Of an inner node: its second child; the first follows it. Of a leaf: 0.
    second: u32,
    /// Of a leaf: its part.
    part: u32,
}

impl BallTree {
    /// Over `n` parts; `ball` is around a range of them.
    pub fn build(n: usize, ball: impl Fn(Range<usize>) -> Ball) -> BallTree {
        let mut tree = BallTree { nodes: Vec::with_capacity(2 * n) };
        if n > 0 {
            tree.divide(0..n, &ball);
        }
        tree
    }

    fn divide(&mut self, parts: Range<usize>, ball: &impl Fn(Range<usize>) -> Ball) {
        let own = self.nodes.len();
        self.nodes.push(Node { ball: ball(parts.clone()), second: 0, part: parts.start as u32 });
        if parts.len() > 1 {
            let middle = parts.start + parts.len() / 2;
            self.divide(parts.start..middle, ball);
            self.nodes[own].second = self.nodes.len() as u32;
            self.divide(middle..parts.end, ball);
        }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }

    /// Visits the parts whose balls the line meets between `near` and `far`, near ones first. `visit` is given the far end and returns the new
    /// one.
    pub fn walk(&self, line: &Line, near: f64, far: f64, visit: impl FnMut(usize, f64) -> f64) {
        if self.nodes.is_empty() {
            return;
        }
        let entry = |index: u32, far: f64| self.nodes[index as usize].ball.entry(line, near, far);
        let branch = |index: u32| match &self.nodes[index as usize] {
            Node { second: 0, part, .. } => Branch::Leaf(*part as usize),
            Node { second, .. } => Branch::Fork(index + 1, *second),
        };
        nearest_first::walk(far, entry, branch, visit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ball_on_the_way_is_visited_and_none_before_its_place() {
        let at = |i: usize| {
            let t = i as f64 * 0.01;
            (DVec3::new(2.0 * t.cos(), t * 0.3, 2.0 * t.sin()), 0.3 + 0.1 * (5.0 * t).sin())
        };
        let tree = BallTree::build(1000, |range| Ball::around(range.map(at)));
        let mut nearest = 0;
        for k in 0..200 {
            let origin = DVec3::new(-9.0, f64::from(k) * 0.02 - 0.5, f64::from(k % 7) - 3.0);
            for scale in [1.0, 1e6] {
                let line = Line::new(origin * scale, DVec3::new(1.0, 0.02, 0.01)).unwrap();
                let mut seen = vec![];
                tree.walk(&line, 0.0, f64::INFINITY, |part, far| {
                    seen.push(part);
                    far
                });
                for i in 0..1000 {
                    let (center, reach) = at(i);
                    let to = center - line.origin;
                    let s = to.dot(line.direction);
                    let is_met = (to - line.direction * s).length() < reach;
                    assert!(!is_met || seen.contains(&i), "{k}: {i}");
                }
            }
            let line = Line::new(origin, DVec3::X).unwrap();
            let mut n = 0;
            let first = |i: usize| Ball { center: at(i).0, reach: at(i).1 }.entry(&line, 0.0, f64::INFINITY);
            let mut best = f64::INFINITY;
            tree.walk(&line, 0.0, f64::INFINITY, |part, far| {
                n += 1;
                best = first(part).map_or(best, |t| best.min(t));
                far.min(best)
            });
            let true_one = (0..1000).filter_map(first).fold(f64::INFINITY, f64::min);
            assert!((best - true_one).abs() < 1e-12 || best == true_one, "{k}: {best} for {true_one}");
            nearest += n;
        }
        assert!(nearest < 200 * 4, "{nearest}");
    }
}
