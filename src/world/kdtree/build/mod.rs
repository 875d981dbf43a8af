//! Building: planes by the surface-area heuristic, top down, items cut to the cells they straddle ("perfect splits").
//!
//! Wald & Havran, *On building fast kd-trees for ray tracing, and on doing that in O(N log N)*, 2006; Havran & Bittner 2002 for the cut.
//! Large cells are judged at evenly spaced planes, small ones at every side of every box, so that a level costs its number of pieces.
//! Subtrees are built in parallel and joined in a fixed order: the tree does not depend on the number of threads.

mod plane;

use super::cell::Cell;
use super::{Node, Tree};
use crate::math::Aabb;
use crate::world::bvh::frame::Frame;
use crate::world::bvh::survey::{BY_ONE_THREAD, is_usable, survey};
use plane::Plane;
use rayon::prelude::*;

/// Pieces to an item at the most, over the whole tree: a subtree gets the share of its pieces and makes a leaf rather than pass it, so that no
/// input makes a tree that memory does not hold. Meshes come to two to five.
pub(super) const MOST_PIECES: usize = 32;

/// Fewer pieces than this are no work for another thread.
const APART: usize = 1 << 12;

/// What lies of an item in a cell.
#[derive(Clone, Copy)]
struct Piece {
    bounds: Cell,
    item: u32,
}

/// Where a subtree stands.
#[derive(Clone, Copy)]
struct Part {
    cell: Cell,
    /// Planes that may still follow one another.
    depth: u32,
    /// Pieces that its leaves may hold together.
    budget: usize,
}

/// What was built of a tree, numbered from 0.
#[derive(Default)]
struct Grown {
    nodes: Vec<Node>,
    /// Items, leaf by leaf.
    references: Vec<u32>,
}

pub(super) fn build(
    count: usize,
    bounds_of: &(impl Fn(usize) -> Aabb + Sync),
    clip: &(impl Fn(usize, &Aabb) -> Aabb + Sync),
) -> Tree {
    let (bounds, unbounded) = survey(count, bounds_of);
    let frame = Frame::around(bounds);
    let pieces = pieces(count, bounds_of, &frame);
    let root = pieces.iter().fold(Cell::EMPTY, |all, piece| all.union(&piece.bounds));
    let mut grown = Grown::default();
    if !pieces.is_empty() {
        let budget = pieces.len() * MOST_PIECES;
        let part = Part { cell: root, depth: most_planes(pieces.len()), budget };
        Builder { frame, clip }.grow(pieces, part, &mut grown);
    }
    let Grown { mut nodes, mut references } = grown;
    nodes.shrink_to_fit();
    references.shrink_to_fit();
    let mut order = number(&nodes, &mut references, count);
    let bounded = order.len();
    let any_unbounded = !unbounded.is_empty();
    order.extend(unbounded);
    Tree { frame, bounds, root, unbounded: any_unbounded, nodes, references, order, bounded }
}

/// 8 + 1.3 log₂ n, as Havran found it.
pub(super) fn most_planes(n: usize) -> u32 {
    8 + n.ilog2() * 13 / 10
}

/// The items with a finite box, in order.
fn pieces(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync), frame: &Frame) -> Vec<Piece> {
    let piece = |i: usize| {
        let b = bounds_of(i);
        is_usable(&b).then(|| Piece { bounds: Cell::around(&b, frame), item: i as u32 })
    };
    if count <= BY_ONE_THREAD {
        return (0..count).filter_map(piece).collect();
    }
    (0..count).into_par_iter().with_min_len(BY_ONE_THREAD).filter_map(piece).collect()
}

/// Turns the items that leaves name into places in an order, which it gives: that in which they are first named.
fn number(nodes: &[Node], references: &mut [u32], count: usize) -> Vec<u32> {
    const NOWHERE: u32 = u32::MAX;
    let mut place = vec![NOWHERE; count];
    let mut order = Vec::with_capacity(count);
    for item in references.iter_mut() {
        let own = &mut place[*item as usize];
        if *own == NOWHERE {
            *own = order.len() as u32;
            order.push(*item);
        }
        *item = *own;
    }
    for leaf in nodes.iter().filter(|node| node.is_leaf()) {
        references[leaf.first()..leaf.first() + leaf.upper()].sort_unstable();
    }
    order
}

struct Builder<'a, C> {
    frame: Frame,
    clip: &'a C,
}

impl<C: Fn(usize, &Aabb) -> Aabb + Sync> Builder<'_, C> {
    /// Appends the nodes over some pieces, the topmost first.
    fn grow(&self, pieces: Vec<Piece>, part: Part, out: &mut Grown) {
        let plane = if part.depth == 0 { None } else { Plane::cheapest(&pieces, &part.cell) };
        let Some(plane) = plane.filter(|plane| plane.n_pieces() <= part.budget) else {
            return out.leaf(&pieces);
        };
        let halves = self.divide(pieces, &plane);
        let parts = part.halves(&plane, [halves[0].len(), halves[1].len()]);
        let index = out.nodes.len();
        out.nodes.push(Node::leaf(0, 0));
        let is_large = halves[0].len().min(halves[1].len()) >= APART;
        let [below, above] = halves;
        let beyond = if is_large && rayon::current_num_threads() > 1 {
            let apart = |pieces, part| {
                let mut grown = Grown::default();
                self.grow(pieces, part, &mut grown);
                grown
            };
            let (below, above) = rayon::join(|| apart(below, parts[0]), || apart(above, parts[1]));
            out.append(below);
            let beyond = out.nodes.len();
            out.append(above);
            beyond
        } else {
            self.grow(below, parts[0], out);
            let beyond = out.nodes.len();
            self.grow(above, parts[1], out);
            beyond
        };
        out.nodes[index] = Node::inner(plane.axis, plane.at, beyond);
    }

    /// The pieces on either side. One that only touches the plane stays on its own side, one within it goes below.
    fn divide(&self, pieces: Vec<Piece>, plane: &Plane) -> [Vec<Piece>; 2] {
        let Plane { axis, at, .. } = *plane;
        let mut halves = [Vec::with_capacity(plane.n[0]), Vec::with_capacity(plane.n[1])];
        for piece in pieces {
            let (lower, upper) = (piece.bounds.lower[axis], piece.bounds.upper[axis]);
            if upper <= at {
                halves[0].push(piece);
            } else if lower >= at {
                halves[1].push(piece);
            } else {
                let uncut = piece.bounds.halves(axis, at);
                let cut = uncut.map(|bounds| self.cut(piece.item, &bounds));
                // What lies in no half came of broken numbers; it stays.
                let is_lost = cut.iter().all(Cell::is_empty);
                for (half, bounds) in halves.iter_mut().zip(if is_lost { uncut } else { cut }) {
                    if !bounds.is_empty() {
                        half.push(Piece { bounds, item: piece.item });
                    }
                }
            }
        }
        halves
    }

    /// Around what lies of an item in a part of its box.
    fn cut(&self, item: u32, part: &Cell) -> Cell {
        let inside = (self.clip)(item as usize, &part.in_world(&self.frame));
        part.common(&Cell::around(&inside, &self.frame))
    }
}

impl Part {
    /// Those of both halves; what is left of the budget goes by the number of pieces.
    fn halves(&self, plane: &Plane, n: [usize; 2]) -> [Part; 2] {
        let spare = self.budget.saturating_sub(n[0] + n[1]);
        let below = (spare as u128 * n[0] as u128 / (n[0] + n[1]).max(1) as u128) as usize;
        let budgets = [n[0] + below, n[1] + spare - below];
        let [below, above] = self.cell.halves(plane.axis, plane.at);
        let depth = self.depth - 1;
        [Part { cell: below, depth, budget: budgets[0] }, Part { cell: above, depth, budget: budgets[1] }]
    }
}

impl Grown {
    fn leaf(&mut self, pieces: &[Piece]) {
        self.nodes.push(Node::leaf(self.references.len(), pieces.len()));
        self.references.extend(pieces.iter().map(|piece| piece.item));
    }

    /// Appends what counts from 0.
    fn append(&mut self, other: Grown) {
        let (n_nodes, n_references) = (self.nodes.len(), self.references.len());
        self.nodes.extend(other.nodes.iter().map(|node| match node.is_leaf() {
            true => Node::leaf(node.first() + n_references, node.upper()),
            false => Node::inner(node.axis(), node.plane, node.upper() + n_nodes),
        }));
        self.references.extend(other.references);
    }
}
