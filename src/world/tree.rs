//! The tree that a scene asks for: a hierarchy of boxes, a kd-tree, or a list. What is under it knows only ranges of items.

#[cfg(test)]
pub(super) mod tests;

use super::bvh::{self, Limits};
use super::kdtree;
use super::packet::{Members, Packet, RAYS};
use crate::math::Aabb;
use crate::scene::Accelerator;
use glam::DVec3;
use std::ops::Range;

/// Items under a tree.
#[derive(Clone, Debug)]
pub enum Tree {
    /// A hierarchy of boxes, or the list of all items.
    Bvh(bvh::Tree),
    /// Cells of space.
    KdTree(kdtree::Tree),
}

impl Default for Tree {
    fn default() -> Self {
        Tree::Bvh(bvh::Tree::default())
    }
}

impl Tree {
    /// A tree over `count` items, each with its box; see [`bvh::Tree::build`].
    pub fn build(accelerator: Accelerator, count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
        match accelerator {
            Accelerator::Bvh => Tree::Bvh(bvh::Tree::build(count, bounds_of)),
            Accelerator::KdTree => Tree::KdTree(kdtree::Tree::build(count, bounds_of)),
            Accelerator::None => Tree::Bvh(bvh::Tree::list(count, bounds_of)),
        }
    }

    /// The same over triangles, where `clip` gives a box around what lies of one in a box; see [`bvh::Tree::build_of_triangles`] and
    /// [`kdtree::Tree::build_clipped`].
    pub fn build_of_triangles(
        accelerator: Accelerator,
        count: usize,
        bounds_of: impl Fn(usize) -> Aabb + Sync,
        clip: impl Fn(usize, &Aabb) -> Aabb + Sync,
    ) -> Tree {
        match accelerator {
            Accelerator::Bvh => Tree::Bvh(bvh::Tree::build_of_triangles(count, bounds_of)),
            Accelerator::KdTree => Tree::KdTree(kdtree::Tree::build_clipped(count, bounds_of, clip)),
            Accelerator::None => Tree::Bvh(bvh::Tree::list(count, bounds_of)),
        }
    }

    /// The items in the order in which leaves name them; see [`bvh::Tree::order`].
    #[inline]
    pub fn order(&self) -> &[u32] {
        match self {
            Tree::Bvh(tree) => tree.order(),
            Tree::KdTree(tree) => tree.order(),
        }
    }

    /// Around everything with a finite box.
    pub fn bounds(&self) -> Aabb {
        match self {
            Tree::Bvh(tree) => tree.bounds(),
            Tree::KdTree(tree) => tree.bounds(),
        }
    }

    /// True where some item has no finite box.
    pub fn is_unbounded(&self) -> bool {
        match self {
            Tree::Bvh(tree) => tree.is_unbounded(),
            Tree::KdTree(tree) => tree.is_unbounded(),
        }
    }

    /// How many nodes it has.
    pub fn node_count(&self) -> usize {
        match self {
            Tree::Bvh(tree) => tree.node_count(),
            Tree::KdTree(tree) => tree.node_count(),
        }
    }

    /// Offers to `leaf` every range of [`Tree::order`] that the ray may meet before `t_max`, near ones first, some items perhaps more than once.
    /// `leaf` gives the distance beyond which nothing matters any more (so far); a negative one ends the traversal.
    #[inline(always)]
    pub fn traverse(
        &self,
        origin: &DVec3,
        direction: &DVec3,
        t_max: f64,
        leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) {
        match self {
            Tree::Bvh(tree) => tree.traverse(origin, direction, t_max, leaf),
            Tree::KdTree(tree) => tree.traverse(*origin, *direction, t_max, leaf),
        }
    }

    /// As [`Tree::traverse`] for rays from one point and a limit for each, negative for those that are no members: `leaf` is told for which of them a
    /// range is, and lowers their limits. None where each must go alone; then nothing was offered.
    #[inline(always)]
    pub(super) fn traverse_each(
        &self,
        rays: (&Packet, Members),
        limits: &[f64; RAYS],
        leaf: impl FnMut(Range<usize>, Members, &mut Limits),
    ) -> Option<()> {
        match self {
            Tree::Bvh(tree) => tree.traverse_each(rays, limits, leaf),
            Tree::KdTree(_) => None,
        }
    }

    /// As [`Tree::traverse`] in no order, until `leaf` gives false.
    #[inline(always)]
    pub fn traverse_any(
        &self,
        origin: &DVec3,
        direction: &DVec3,
        t_max: f64,
        mut leaf: impl FnMut(Range<usize>) -> bool,
    ) {
        match self {
            Tree::Bvh(tree) => tree.traverse_any(origin, direction, t_max, leaf),
            Tree::KdTree(tree) => tree
                .traverse(*origin, *direction, t_max, |range, t_max| if leaf(range) { t_max } else { -1.0 }),
        }
    }

    /// Offers every item that the ray may meet, each once and in no order, for those who gather all meetings. `leaf` says whether
    /// to go on.
    pub fn traverse_all(&self, origin: DVec3, direction: DVec3, mut leaf: impl FnMut(Range<usize>) -> bool) {
        match self {
            Tree::Bvh(tree) => tree.traverse_any(&origin, &direction, f64::MAX, leaf),
            Tree::KdTree(tree) => {
                let mut all = Vec::new();
                tree.traverse(origin, direction, f64::MAX, |range, t_max| {
                    all.extend(range);
                    t_max
                });
                all.sort_unstable();
                all.dedup();
                // Stops where it has enough.
                let _ = all.into_iter().all(|place| leaf(place..place + 1));
            }
        }
    }
}
