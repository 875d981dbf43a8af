//! Halves by number, as a textbook splits: what the heuristic of areas is measured against. No scene asks for it.

use super::boxes::{Boxed, Item, bounds_of};
use super::split::halve;
use super::{finish, prepare, put};
use crate::math::Aabb;
use crate::world::bvh::{Child, Node, Pricing, Tree, WIDTH};

/// Items of a leaf at the most.
const LEAF: usize = 4;

impl Tree {
    /// As [`Tree::build`], but every run is halved by number along the axis where its middles spread most.
    pub fn build_median(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
        let mut ready = prepare(count, &bounds_of);
        let mut nodes = Vec::new();
        if ready.items.len() > 1 {
            grow(&mut ready.items, 0, &mut nodes);
        }
        let order = ready.items.iter().map(Item::number).collect();
        finish(ready, nodes, order, Pricing::OF_TRIANGLES.at_once)
    }
}

/// Appends the nodes over a run, the topmost first; `first` is the run's place among all items.
fn grow(run: &mut [Item], first: usize, nodes: &mut Vec<Node>) -> usize {
    let mut cuts = vec![0, run.len()];
    while cuts.len() <= WIDTH / 2 + 1 {
        let halves: Vec<usize> = cuts
            .windows(2)
            .filter(|ends| ends[1] - ends[0] > LEAF)
            .map(|ends| ends[0] + halve(&mut run[ends[0]..ends[1]]).0)
            .collect();
        if halves.is_empty() {
            break;
        }
        cuts.extend(halves);
        cuts.sort_unstable();
    }
    let index = nodes.len();
    nodes.push(Node::EMPTY);
    for (slot, ends) in cuts.windows(2).enumerate() {
        let own = &mut run[ends[0]..ends[1]];
        let bounds = bounds_of(&*own);
        let child = match own.len() {
            n @ 0..=LEAF => Child::leaf(first + ends[0], n),
            _ => Child::node(grow(own, first + ends[0], nodes)),
        };
        put(&mut nodes[index], slot, &bounds, child);
    }
    index
}
