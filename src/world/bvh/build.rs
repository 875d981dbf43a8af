//! Building: the surface-area heuristic over bins, top down, four children to a node.
//!
//! Wald, *On fast construction of SAH-based bounding volume hierarchies*, 2007; MacDonald & Booth 1990 for the heuristic.
//! Subtrees are built in parallel and joined in a fixed order: the tree does not depend on the number of threads.

use super::frame::{Frame, round_down, round_up};
use super::{Node, Tree, WIDTH};
use crate::math::Aabb;
use rayon::prelude::*;

/// Bins per axis.
const BINS: usize = 32;
/// Most items that a leaf may have; the heuristic usually stops earlier.
const MAX_LEAF: usize = 8;
/// What a node of its own costs, in item tests: below this gain a part is a leaf. Measured with the next: from 0.6 to 2 the speed of
/// triangles and spheres stays within the noise, while the tree halves in size.
const NODE_COST: f32 = 2.0;
/// What splitting a part costs where its node has a child to spare: next to nothing, as four boxes are tested at once.
const LANE_COST: f32 = 0.5;
/// About how many items there are to a node, for the first guess at memory.
const ITEMS_PER_NODE: usize = 4;
/// Subtrees larger than this are built on their own, perhaps on another thread.
const PARALLEL_ITEMS: usize = 1 << 13;
/// Binary splits after which halves are taken, so that no input makes a deep tree (a fan of needles would).
const MAX_SAH_DEPTH: u32 = 40;

/// A box of three axes in the tree's frame.
#[derive(Clone, Copy, Debug)]
struct Box32 {
    min: [f32; 3],
    max: [f32; 3],
}

impl Box32 {
    const EMPTY: Box32 = Box32 { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    fn grow(&mut self, other: &Box32) {
        for a in 0..3 {
            self.min[a] = if other.min[a] < self.min[a] { other.min[a] } else { self.min[a] };
            self.max[a] = if other.max[a] > self.max[a] { other.max[a] } else { self.max[a] };
        }
    }

    /// Half the area; 0 for the empty box.
    fn area(&self) -> f32 {
        let d = [self.max[0] - self.min[0], self.max[1] - self.min[1], self.max[2] - self.min[2]];
        if d[0] < 0.0 { 0.0 } else { d[0] * d[1] + d[1] * d[2] + d[2] * d[0] }
    }

    /// Twice the middle along an axis.
    fn middle(&self, axis: usize) -> f32 {
        self.min[axis] + self.max[axis]
    }
}

#[derive(Clone, Copy)]
struct Item {
    bounds: Box32,
    index: u32,
}

pub(super) fn build(count: usize, bounds_of: impl Fn(usize) -> Aabb + Sync) -> Tree {
    let (bounds, unbounded) = survey(count, &bounds_of);
    let frame = Frame::around(bounds);
    let mut items = narrow(count, &bounds_of, &frame);
    let mut nodes = Vec::with_capacity(items.len() / ITEMS_PER_NODE);
    // One box would only repeat the bounds.
    if items.len() > 1 {
        let whole = bounds_of_items(&items);
        root(&mut items, &whole, &mut nodes);
    }
    nodes.shrink_to_fit();
    let bounded = if nodes.is_empty() { 0 } else { items.len() };
    let any_unbounded = !unbounded.is_empty();
    let mut order: Vec<u32> = items.iter().map(|item| item.index).collect();
    order.extend(unbounded);
    Tree { frame, bounds, unbounded: any_unbounded, nodes, order, bounded }
}

/// The box around the finite boxes, and the items without one.
pub(super) fn survey(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync)) -> (Aabb, Vec<u32>) {
    (0..count)
        .into_par_iter()
        .with_min_len(1 << 12)
        .fold(
            || (Aabb::EMPTY, Vec::new()),
            |(bounds, mut unbounded), i| {
                let b = bounds_of(i);
                if is_unbounded(&b) {
                    unbounded.push(i as u32);
                    return (bounds, unbounded);
                }
                (if b.is_empty() { bounds } else { bounds.union(b) }, unbounded)
            },
        )
        .reduce(
            || (Aabb::EMPTY, Vec::new()),
            |(a, mut x), (b, y)| {
                x.extend(y);
                (a.union(b), x)
            },
        )
}

/// Infinite in any direction, NaN, or so large that its size overflows. The empty box is not.
fn is_unbounded(b: &Aabb) -> bool {
    let nothing = b.is_empty() && !b.min.is_nan() && !b.max.is_nan();
    !nothing && !(b.min.is_finite() && b.max.is_finite() && b.size().is_finite())
}

/// The items with a finite box, in order. Made in place: for a million of them a second copy would be felt.
fn narrow(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync), frame: &Frame) -> Vec<Item> {
    const NONE: u32 = u32::MAX;
    let item = |i: usize| {
        let b = bounds_of(i);
        let (min, max) = (frame.point(b.min), frame.point(b.max));
        let bounds = Box32 { min: min.to_array().map(round_down), max: max.to_array().map(round_up) };
        let usable = !b.is_empty() && !is_unbounded(&b);
        Item { bounds, index: if usable { i as u32 } else { NONE } }
    };
    let mut items = Vec::new();
    (0..count).into_par_iter().with_min_len(1 << 12).map(item).collect_into_vec(&mut items);
    items.retain(|item| item.index != NONE);
    items
}

fn bounds_of_items(items: &[Item]) -> Box32 {
    items.iter().fold(Box32::EMPTY, |mut b, item| {
        b.grow(&item.bounds);
        b
    })
}

/// The root is a node even where everything fits a leaf.
fn root(items: &mut [Item], whole: &Box32, nodes: &mut Vec<Node>) {
    let part = Part { first: 0, count: items.len(), bounds: *whole, depth: 0, splittable: true };
    node(items, part, nodes);
}

/// A run of items on the way to becoming a child.
#[derive(Clone, Copy)]
struct Part {
    /// Offset from the start of all items.
    first: usize,
    count: usize,
    bounds: Box32,
    depth: u32,
    /// False once the heuristic has chosen a leaf.
    splittable: bool,
}

/// Appends the node over `items` (those of `part`) and all below it; gives its index.
fn node(items: &mut [Item], part: Part, nodes: &mut Vec<Node>) -> u32 {
    let parts = children(items, part);
    let index = nodes.len();
    nodes.push(Node::EMPTY);
    let mut runs = Vec::with_capacity(WIDTH);
    let mut rest = items;
    for child in &parts {
        let (run, after) = rest.split_at_mut(child.count);
        runs.push((run, *child));
        rest = after;
    }
    let below = if part.count > PARALLEL_ITEMS { apart(runs, nodes) } else { in_line(runs, nodes) };
    for (slot, (child, below)) in parts.iter().zip(below).enumerate() {
        let node = &mut nodes[index];
        for a in 0..3 {
            node.rows[a][slot] = child.bounds.min[a];
            node.rows[a + 3][slot] = child.bounds.max[a];
        }
        match below {
            Some(index) => node.set_child(slot, index, 0),
            None => node.set_child(slot, child.first as u32, child.count as u32),
        }
    }
    index as u32
}

/// Builds each child after the other; gives the node of those that are not leaves.
fn in_line(runs: Vec<(&mut [Item], Part)>, nodes: &mut Vec<Node>) -> Vec<Option<u32>> {
    runs.into_iter().map(|(run, part)| part.splittable.then(|| node(run, part, nodes))).collect()
}

/// Builds the children side by side, then appends them in order.
fn apart(runs: Vec<(&mut [Item], Part)>, nodes: &mut Vec<Node>) -> Vec<Option<u32>> {
    let built: Vec<Option<Vec<Node>>> = runs
        .into_par_iter()
        .map(|(run, part)| {
            part.splittable.then(|| {
                let mut below = Vec::new();
                node(run, part, &mut below);
                below
            })
        })
        .collect();
    built.into_iter().map(|below| below.map(|below| append(below, nodes))).collect()
}

/// Appends nodes that count from 0; gives the index of the first.
fn append(below: Vec<Node>, nodes: &mut Vec<Node>) -> u32 {
    let base = nodes.len() as u32;
    nodes.extend(below.into_iter().map(|mut node| {
        for slot in 0..WIDTH {
            if node.count(slot) == 0 {
                node.set_child(slot, node.child(slot) + base, 0);
            }
        }
        node
    }));
    base
}

/// Splits the largest splittable part until there are four, or only leaves.
fn children(items: &mut [Item], part: Part) -> Vec<Part> {
    let base = part.first;
    let mut parts = vec![part];
    while parts.len() < WIDTH {
        let largest = (0..parts.len())
            .filter(|&i| parts[i].splittable)
            .max_by(|&i, &j| parts[i].bounds.area().total_cmp(&parts[j].bounds.area()).then(j.cmp(&i)));
        let Some(i) = largest else { break };
        let run = &mut items[parts[i].first - base..][..parts[i].count];
        match split(run, &parts[i], LANE_COST) {
            Some((left, right)) => {
                parts[i] = left;
                parts.insert(i + 1, right);
            }
            None => parts[i].splittable = false,
        }
    }
    for part in &mut parts {
        let run = &mut items[part.first - base..][..part.count];
        part.splittable &= run.len() > MAX_LEAF || split(run, part, NODE_COST).is_some();
    }
    parts
}

/// Two halves of a part, its items partitioned; none where a leaf is cheaper. `cost` is that of the split itself.
fn split(items: &mut [Item], part: &Part, cost: f32) -> Option<(Part, Part)> {
    if items.len() < 2 {
        return None;
    }
    let middles = middles_of(items);
    let found = if part.depth < MAX_SAH_DEPTH { best_split(items, &middles) } else { None };
    let (left_count, [left, right]) = match found {
        Some(best) => {
            let leaf_cost = items.len() as f32 * part.bounds.area();
            if items.len() <= MAX_LEAF && leaf_cost <= cost * part.bounds.area() + best.cost {
                return None;
            }
            let is_left = |item: &Item| best.bins.of(item.bounds.middle(best.axis)) < best.bin;
            (partition(items, is_left), best.bounds)
        }
        None if items.len() <= MAX_LEAF => return None,
        None => {
            let half = halve(items, &middles);
            (half, [bounds_of_items(&items[..half]), bounds_of_items(&items[half..])])
        }
    };
    let half = |first: usize, count: usize, bounds: Box32| Part {
        first,
        count,
        bounds,
        depth: part.depth + 1,
        splittable: true,
    };
    let right_count = items.len() - left_count;
    Some((half(part.first, left_count, left), half(part.first + left_count, right_count, right)))
}

/// The box around the items' (doubled) middles.
fn middles_of(items: &[Item]) -> Box32 {
    items.iter().fold(Box32::EMPTY, |mut b, item| {
        let m = [item.bounds.middle(0), item.bounds.middle(1), item.bounds.middle(2)];
        b.grow(&Box32 { min: m, max: m });
        b
    })
}

/// Equal intervals along one axis.
#[derive(Clone, Copy)]
struct Bins {
    start: f32,
    per_length: f32,
    last: usize,
}

impl Bins {
    /// None where the middles do not spread.
    fn along(middles: &Box32, axis: usize, count: usize) -> Option<Bins> {
        let extent = middles.max[axis] - middles.min[axis];
        let per_length = count as f32 / extent;
        let usable = extent > 0.0 && per_length.is_finite();
        usable.then_some(Bins { start: middles.min[axis], per_length, last: count - 1 })
    }

    #[inline(always)]
    fn of(&self, middle: f32) -> usize {
        (((middle - self.start) * self.per_length) as usize).min(self.last)
    }
}

/// What is in a bin.
#[derive(Clone, Copy)]
struct Content {
    bounds: Box32,
    count: u32,
}

impl Content {
    const NONE: Content = Content { bounds: Box32::EMPTY, count: 0 };

    fn add(&mut self, other: &Content) {
        self.bounds.grow(&other.bounds);
        self.count += other.count;
    }
}

struct Best {
    axis: usize,
    bins: Bins,
    /// First bin of the right half.
    bin: usize,
    /// Area times count, summed over both halves.
    cost: f32,
    /// Of the halves.
    bounds: [Box32; 2],
}

/// The cheapest split between bins over all axes; none where the middles do not spread. Few items take few bins.
fn best_split(items: &[Item], middles: &Box32) -> Option<Best> {
    let count = (2 * items.len()).clamp(4, BINS);
    let axes: [Option<Bins>; 3] = std::array::from_fn(|axis| Bins::along(middles, axis, count));
    let mut content = [[Content::NONE; BINS]; 3];
    for item in items {
        for (axis, bins) in axes.iter().enumerate() {
            if let Some(bins) = bins {
                let bin = bins.of(item.bounds.middle(axis));
                content[axis][bin].add(&Content { bounds: item.bounds, count: 1 });
            }
        }
    }
    let along = |axis: usize| best_along(&content[axis][..count], axis, axes[axis]?);
    (0..3).filter_map(along).min_by(|a, b| a.cost.total_cmp(&b.cost))
}

fn best_along(content: &[Content], axis: usize, bins: Bins) -> Option<Best> {
    let mut right = [Content::NONE; BINS];
    let mut sum = Content::NONE;
    for bin in (1..content.len()).rev() {
        sum.add(&content[bin]);
        right[bin] = sum;
    }
    let mut left = Content::NONE;
    let mut best: Option<Best> = None;
    for bin in 1..content.len() {
        left.add(&content[bin - 1]);
        let right = &right[bin];
        let cost = left.bounds.area() * left.count as f32 + right.bounds.area() * right.count as f32;
        let both = left.count > 0 && right.count > 0;
        if both && cost.is_finite() && best.as_ref().is_none_or(|b| cost < b.cost) {
            best = Some(Best { axis, bins, bin, cost, bounds: [left.bounds, right.bounds] });
        }
    }
    best
}

/// Moves the items of the left half to the front; gives how many there are.
fn partition(items: &mut [Item], is_left: impl Fn(&Item) -> bool) -> usize {
    let (mut i, mut j) = (0, items.len());
    loop {
        while i < j && is_left(&items[i]) {
            i += 1;
        }
        while i < j && !is_left(&items[j - 1]) {
            j -= 1;
        }
        if i >= j {
            return i;
        }
        items.swap(i, j - 1);
    }
}

/// Halves by number along the axis where the middles spread most.
fn halve(items: &mut [Item], middles: &Box32) -> usize {
    let spread = |a: usize| middles.max[a] - middles.min[a];
    let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
    let half = items.len() / 2;
    let key = |item: &Item| (item.bounds.middle(axis), item.index);
    items.select_nth_unstable_by(half, |a, b| {
        let (a, b) = (key(a), key(b));
        a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
    });
    half
}
