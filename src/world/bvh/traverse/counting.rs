//! The traversal that tells of each node, for those who measure trees; by plain operations, which take the same way as the widest
//! instructions.

use super::walk;
use super::wide::meets;
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
            meets(ray, node, limit)
        };
        if let Some(t_max) = self.offer_loose(t_max, &mut leaf) {
            walk(self, origin, direction, t_max, count, leaf);
        }
        visits.get()
    }
}
