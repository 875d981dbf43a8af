//! Which parts a node's children are.

use super::boxes::Boxed;
use super::split::{Bins, MAX_LEAF, Part, Price};
use crate::world::bvh::WIDTH;

/// What visiting a child costs, in item tests.
const LANE_COST: Price = Price::Lane(1.0);

/// What a node is made of: a part, or the halves of one that was found worth a node by splitting it.
#[derive(Clone, Copy)]
pub(super) enum Start {
    Whole(Part),
    Halves([Part; 2]),
}

/// The area of a part that shall not be split.
const CLOSED: f32 = f32::NEG_INFINITY;

/// Up to [`WIDTH`] children, in the order of their runs.
pub(super) struct Children {
    parts: [Part; WIDTH],
    /// Of those that may be split, else [`CLOSED`].
    area: [f32; WIDTH],
    n: usize,
}

impl Children {
    /// Splits the largest part that can be until there are [`WIDTH`], or only leaves.
    pub fn of<T: Boxed>(run: &mut [T], start: Start, bins: &mut Bins) -> Children {
        let mut children = Children::new(start);
        while children.n < WIDTH {
            let Some(i) = children.largest() else { break };
            let part = children.parts[i];
            match part.split(&mut run[part.start..part.start + part.len], LANE_COST, bins) {
                Some(halves) => children.replace(i, halves),
                None => children.area[i] = CLOSED,
            }
        }
        children
    }

    fn new(start: Start) -> Children {
        match start {
            Start::Whole(part) => {
                let mut children = Children { parts: [part.at(0); WIDTH], area: [CLOSED; WIDTH], n: 1 };
                children.area[0] = part.bounds.area();
                children
            }
            Start::Halves([left, right]) => {
                let mut children = Children { parts: [left.at(0); WIDTH], area: [CLOSED; WIDTH], n: 1 };
                children.replace(0, [left.at(0), right.at(left.len)]);
                children
            }
        }
    }

    /// In the order of their runs.
    pub fn parts(&self) -> &[Part] {
        &self.parts[..self.n]
    }

    /// What the node over a child's run is made of; none where a leaf costs less. A small part is split to find out, and its halves are kept.
    pub fn below<T: Boxed>(&self, i: usize, run: &mut [T], bins: &mut Bins) -> Option<Start> {
        let part = self.parts[i];
        if self.area[i] == CLOSED {
            None
        } else if part.n_items > MAX_LEAF {
            Some(Start::Whole(part))
        } else {
            part.split(run, Price::Node(bins.pricing.node), bins).map(Start::Halves)
        }
    }

    fn replace(&mut self, i: usize, halves: [Part; 2]) {
        for j in (i + 1..self.n).rev() {
            self.parts[j + 1] = self.parts[j];
            self.area[j + 1] = self.area[j];
        }
        for (j, half) in halves.into_iter().enumerate() {
            self.parts[i + j] = half;
            self.area[i + j] = half.bounds.area();
        }
        self.n += 1;
    }

    /// The largest part that may be split; the first of equals.
    fn largest(&self) -> Option<usize> {
        let (mut best, mut area) = (0, self.area[0]);
        for i in 1..WIDTH {
            let is_larger = self.area[i] > area;
            best = if is_larger { i } else { best };
            area = if is_larger { self.area[i] } else { area };
        }
        (area > CLOSED).then_some(best)
    }
}
