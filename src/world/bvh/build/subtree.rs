//! Nodes over parts: over items one by one, and above that over cells of items.

use super::boxes::{Boxed, Item};
use super::cells::{Cell, Cells};
use super::children::{Children, Start};
use super::put;
use super::split::{Bins, MAX_LEAF, Part};
use crate::world::bvh::{Child, Node, Pricing, WIDTH};
use rayon::prelude::*;

/// More items than this are first sorted into cells, fewer are split one by one. Measured on a million triangles and on as many
/// spheres: from 2¹¹ to 2¹⁴ neither building nor tracing changes beyond the noise, without cells building takes a third longer.
const ONE_BY_ONE: usize = 1 << 13;

/// Appends the nodes over the items of a part, the topmost first; gives its index. The items' numbers go to `order`, leaf by leaf.
pub(super) fn grow(
    items: &mut [Item],
    part: Part,
    order: &mut [u32],
    nodes: &mut Vec<Node>,
    bins: &mut Bins,
) -> usize {
    if items.len() > ONE_BY_ONE {
        let (sorted, mut cells) = Cells::of(items);
        // All in one cell lie at one point.
        if cells.len() > 1 {
            return over_cells(&sorted, &mut cells, part, order, nodes, bins);
        }
    }
    let index = over_items(items, Start::Whole(part), nodes, bins);
    for (number, item) in order.iter_mut().zip(items) {
        *number = item.number();
    }
    index
}

/// The node over items one by one, and all below it.
fn over_items(items: &mut [Item], start: Start, nodes: &mut Vec<Node>, bins: &mut Bins) -> usize {
    let children = Children::of(items, start, bins);
    let index = nodes.len();
    nodes.push(Node::EMPTY);
    for (slot, part) in children.parts().iter().enumerate() {
        let own = &mut items[part.start..part.start + part.len];
        let below = children.below(slot, own, bins).map(|start| over_items(own, start, nodes, bins));
        fill(&mut nodes[index], slot, part, below);
    }
    index
}

/// The node over cells, and all below it.
fn over_cells(
    sorted: &Cells<'_>,
    cells: &mut [Cell],
    part: Part,
    order: &mut [u32],
    nodes: &mut Vec<Node>,
    bins: &mut Bins,
) -> usize {
    if cells.len() == 1 || part.n_items <= ONE_BY_ONE {
        return grow(&mut sorted.gather(cells), part.as_run(part.n_items), order, nodes, bins);
    }
    let children = Children::of(cells, Start::Whole(part.as_run(cells.len())), bins);
    let index = nodes.len();
    nodes.push(Node::EMPTY);
    let mut runs = Vec::with_capacity(WIDTH);
    let (mut cells, mut order) = (cells, order);
    for part in children.parts() {
        let (own, after) = cells.split_at_mut(part.len);
        let (own_order, order_after) = order.split_at_mut(part.n_items);
        runs.push((own, *part, own_order));
        (cells, order) = (after, order_after);
    }
    let below = if rayon::current_num_threads() > 1 {
        apart(sorted, runs, nodes, bins.pricing)
    } else {
        // The detour by parts would give the same nodes.
        runs.into_iter()
            .map(|(cells, part, order)| child_of_cells(sorted, cells, part, order, nodes, bins))
            .collect()
    };
    for (slot, (part, below)) in children.parts().iter().zip(below).enumerate() {
        fill(&mut nodes[index], slot, part, below);
    }
    index
}

/// The node over a part in cells; none for a leaf.
fn child_of_cells(
    sorted: &Cells<'_>,
    cells: &mut [Cell],
    part: Part,
    order: &mut [u32],
    nodes: &mut Vec<Node>,
    bins: &mut Bins,
) -> Option<usize> {
    if part.n_items > MAX_LEAF {
        return Some(over_cells(sorted, cells, part, order, nodes, bins));
    }
    for (number, item) in order.iter_mut().zip(sorted.gather(cells)) {
        *number = item.number();
    }
    None
}

/// Builds the children side by side, then appends them in order.
fn apart(
    sorted: &Cells<'_>,
    runs: Vec<(&mut [Cell], Part, &mut [u32])>,
    nodes: &mut Vec<Node>,
    pricing: Pricing,
) -> Vec<Option<usize>> {
    let build = |(cells, part, order): (&mut [Cell], Part, &mut [u32])| {
        let mut below = Vec::new();
        let bins = &mut Bins::new(pricing);
        child_of_cells(sorted, cells, part, order, &mut below, bins).map(|_| below)
    };
    let built: Vec<Option<Vec<Node>>> = runs.into_par_iter().map(build).collect();
    built.into_iter().map(|below| below.map(|below| append(below, nodes))).collect()
}

/// Appends nodes that count from 0; gives the index of the first.
pub(super) fn append(below: Vec<Node>, nodes: &mut Vec<Node>) -> usize {
    let base = nodes.len();
    nodes.extend(below.into_iter().map(|mut node| {
        for child in &mut node.children {
            if child.count() == 0 && *child != Child::NONE {
                *child = Child::node(child.place() + base);
            }
        }
        node
    }));
    base
}

fn fill(node: &mut Node, slot: usize, part: &Part, below: Option<usize>) {
    let leaf = || Child::leaf(part.first, part.n_items);
    put(node, slot, &part.bounds, below.map_or_else(leaf, Child::node));
}
