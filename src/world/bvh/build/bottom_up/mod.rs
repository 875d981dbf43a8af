//! Bottom up: items in the order of a curve through space, neighbours joined pair by pair until one tree is left, which is then cut into
//! nodes of eight children.
//!
//! Meister & Bittner, *Parallel locally-ordered clustering for bounding volume hierarchy construction*, 2018; the cutting as Ylitie, Karras
//! & Laine, *Efficient incoherent ray traversal on GPUs through compressed wide BVHs*, 2017. Two things are ours: of equal areas that pair is
//! taken whose places differ in the lowest bits, so that heaps of equal boxes halve in a round; and a round that joins few is made again with
//! neighbours as they stand, so that rounds are few whatever the boxes are. Every step has one outcome on any number of threads.
//!
//! No scene asks for it; it is what splits by area are measured against. On one thread it takes 0.85 of their CPU time on 82 and 203 thousand
//! triangles, 5 and 13 ms less, but 1.22 of it on 1.3 million; rays take 2 to 14 % longer, shadow rays as long. A frame of an animation asks
//! more rays than pay for that.

mod curve;
mod cut;
mod rounds;

use super::boxes::{Box32, Boxed, Item};
use super::{finish, prepare};
use crate::math::Aabb;
use crate::world::bvh::{Pricing, Tree};
use cut::Ways;

/// The binary tree: items are numbered by their place in the row, nodes after them in the order in which they were made, so that halves
/// have smaller numbers than what they are halves of.
struct Binary {
    /// Of the items.
    bounds: Vec<Box32>,
    inner: Vec<Inner>,
}

/// Two joined.
#[derive(Clone, Copy, Default)]
struct Inner {
    halves: [u32; 2],
    n_items: u32,
    ways: Ways,
}

impl Binary {
    fn inner(&self, id: u32) -> Option<&Inner> {
        self.inner.get((id as usize).checked_sub(self.bounds.len())?)
    }
}

impl Tree {
    /// As [`Tree::build_of_triangles`], but from the triangles up.
    pub fn build_bottom_up(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
        let mut ready = prepare(count, &bounds_of);
        let mut nodes = Vec::new();
        curve::sort(&mut ready.items);
        let mut order: Vec<u32> = ready.items.iter().map(Item::number).collect();
        if ready.items.len() > 1 {
            let bounds = ready.items.iter().map(Item::bare).collect();
            cut::cut(&rounds::join(bounds), &mut order, &mut nodes);
        }
        finish(ready, nodes, order, Pricing::OF_TRIANGLES.at_once)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use crate::world::bvh::Child;
    use glam::DVec3;

    fn depth(tree: &Tree, node: usize) -> usize {
        let children = tree.nodes[node].children.iter();
        let below = children.filter(|child| child.count() == 0 && **child != Child::NONE);
        1 + below.map(|child| depth(tree, child.place())).max().unwrap_or(0)
    }

    fn built(boxes: &[Aabb]) -> Tree {
        let tree = Tree::build_bottom_up(boxes.len(), |i| boxes[i]);
        let mut order = tree.order().to_vec();
        order.sort_unstable();
        order.dedup();
        assert!(order.iter().copied().eq(0..boxes.len() as u32), "every item has one place");
        tree
    }

    #[test]
    fn equal_boxes_and_boxes_that_grow_make_no_deep_tree() {
        let cube = |at: f64, size: f64| Aabb { min: DVec3::splat(at), max: DVec3::splat(at + size) };
        let equal = vec![cube(3.0, 1.0); 3000];
        assert!(depth(&built(&equal), 0) <= 8);
        // Each is nearest to the one before, so that a round joins one pair.
        let growing: Vec<Aabb> = (0..3000).map(|i| 1.002f64.powi(i)).map(|at| cube(at, 0.001 * at)).collect();
        assert!(depth(&built(&growing), 0) <= 16);
    }

    #[test]
    fn it_costs_a_third_more_than_splits_by_area_at_the_most() {
        let mut random = Random::new(4);
        let boxes: Vec<Aabb> = (0..4000)
            .map(|i| {
                let size = if i % 16 > 0 { 1.0 } else { 100.0 };
                let at = DVec3::from_array(std::array::from_fn(|_| random.unit() * size));
                Aabb { min: at, max: at + DVec3::splat(0.02 * size) }
            })
            .collect();
        let total = |tree: &Tree| {
            let [nodes, tests] = tree.cost();
            4.0 * nodes + tests
        };
        let (up, down) = (built(&boxes), Tree::build_of_triangles(boxes.len(), |i| boxes[i]));
        assert!(total(&up) <= 4.0 / 3.0 * total(&down), "{} against {}", total(&up), total(&down));
    }
}
