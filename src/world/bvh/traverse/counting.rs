//! The traversal that tells of each node, for those who measure trees; by operations that every machine has and that round as the widest
//! instructions do, so that all count alike.

use super::entry::Entry;
use super::fetch::nowhere;
use super::wide::meets_fused;
use super::{Met, walk, walk_any};
use crate::world::bvh::{Node, Tree};
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
        let Some(t_max) = self.offer_loose(t_max, &mut leaf) else { return 0 };
        self.counted([origin, direction], t_max, |entry, meets| {
            walk(self, entry, t_max, (|limit| limit, meets), (&mut leaf, nowhere(&self.nodes)))
        })
    }

    /// As [`Tree::traverse_any`]; gives how many nodes were visited.
    pub fn traverse_any_counting(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        mut leaf: impl FnMut(Range<usize>) -> bool,
    ) -> u64 {
        let mut loose = |range, t_max| if leaf(range) { t_max } else { -1.0 };
        let Some(t_max) = self.offer_loose(t_max, &mut loose) else { return 0 };
        self.counted([origin, direction], t_max, |entry, meets| {
            walk_any(self, entry, t_max, (|limit| limit, meets), (&mut leaf, nowhere(&self.nodes)));
        })
    }

    /// How many nodes a walk tests.
    fn counted(
        &self,
        ray: [DVec3; 2],
        t_max: f64,
        walk: impl FnOnce(Entry, &dyn Fn(&Node, f32) -> Met),
    ) -> u64 {
        let visits = Cell::new(0);
        if let Some((entry, narrow)) = Entry::entered(self, ray.each_ref(), t_max) {
            walk(entry, &|node, limit| {
                visits.set(visits.get() + 1);
                meets_fused(&narrow, node, limit)
            });
        }
        visits.get()
    }
}
