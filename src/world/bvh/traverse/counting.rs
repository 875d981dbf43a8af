//! The traversal that tells of each node, for those who measure trees; by operations that every machine has and that round as the widest
//! instructions do, so that all count alike.

use super::wide::meets_fused;
use super::{walk, walk_any};
use crate::world::bvh::Tree;
use glam::DVec3;
use std::cell::Cell;
use std::ops::Range;

impl Tree {
    /// As [`Tree::traverse`]; gives how many nodes were visited.
    pub fn traverse_counting(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        mut leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) -> u64 {
        let visits = Cell::new(0);
        let count = |ray: &_, node: &_, limit| {
            visits.set(visits.get() + 1);
            meets_fused(ray, node, limit)
        };
        if let Some(t_max) = self.offer_loose(t_max, &mut leaf) {
            walk(self, [&origin, &direction], t_max, count, &mut leaf);
        }
        visits.get()
    }

    /// As [`Tree::traverse_any`]; gives how many nodes were visited.
    pub fn traverse_any_counting(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        mut leaf: impl FnMut(Range<usize>) -> bool,
    ) -> u64 {
        let visits = Cell::new(0);
        let count = |ray: &_, node: &_, limit| {
            visits.set(visits.get() + 1);
            meets_fused(ray, node, limit)
        };
        let mut loose = |range, t_max| if leaf(range) { t_max } else { -1.0 };
        if let Some(t_max) = self.offer_loose(t_max, &mut loose) {
            walk_any(self, [&origin, &direction], t_max, count, &mut leaf);
        }
        visits.get()
    }
}
