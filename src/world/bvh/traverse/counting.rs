//! The traversal that tells of each node, for those who measure trees; by plain operations, which take the same way as the widest
//! instructions.

use super::wide::meets;
use super::{Entry, Narrow, walk};
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
        mut t_max: f64,
        mut leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) -> u64 {
        if self.bounded < self.order.len() {
            t_max = leaf(self.bounded..self.order.len(), t_max);
        }
        if self.nodes.is_empty() || !(t_max >= 0.0) {
            return 0;
        }
        let Some(entry) = Entry::new(&self.frame, &self.bounds, origin, direction, t_max) else { return 0 };
        let ray = Narrow::new(&entry);
        let visits = Cell::new(0);
        let count = |node: &_, limit| {
            visits.set(visits.get() + 1);
            meets(&ray, node, limit)
        };
        walk(&self.nodes, &entry, t_max, count, leaf);
        visits.get()
    }
}
