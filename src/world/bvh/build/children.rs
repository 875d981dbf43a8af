//! Which parts a node's children are.

use super::WIDTH;
use super::boxes::Boxed;
use super::split::{Bins, MAX_LEAF, Part, Price};

/// What a node of its own costs, in item tests: below this gain a part is a leaf. Measured with the next on a million triangles: at 3
/// the tree has 40 % fewer nodes and rays take 8 % longer, which is about what building it saves.
const NODE_COST: Price = Price::Node(2.0);
/// What visiting a child costs, in item tests.
const LANE_COST: Price = Price::Lane(1.0);

/// What a node is made of: a part, or the halves of one that was found worth a node by splitting it.
#[derive(Clone, Copy)]
pub(super) enum Start {
    Whole(Part),
    Halves([Part; 2]),
}

/// What becomes of a part.
#[derive(Clone, Copy)]
pub(super) enum Child {
    /// Not decided.
    Open(Part),
    /// A leaf.
    Leaf(Part),
    /// A node over its halves.
    Node(Part, [Part; 2]),
}

impl Child {
    /// The part.
    pub fn part(&self) -> &Part {
        match self {
            Child::Open(part) | Child::Leaf(part) | Child::Node(part, _) => part,
        }
    }
}

/// Up to [`WIDTH`] children, in the order of their runs.
pub(super) struct Children {
    all: [Child; WIDTH],
    n: usize,
}

impl Children {
    /// Splits the largest part that can be until there are [`WIDTH`], or only leaves.
    pub fn of<T: Boxed>(run: &mut [T], start: Start, bins: &mut Bins) -> Children {
        let mut children = match start {
            Start::Whole(part) => Children { all: [Child::Open(part); WIDTH], n: 1 },
            Start::Halves([left, right]) => {
                let mut children = Children { all: [Child::Open(left); WIDTH], n: 2 };
                children.all[1] = Child::Open(right);
                children
            }
        };
        while children.n < WIDTH {
            let Some((i, part)) = children.largest() else { break };
            let start: usize = children.all[..i].iter().map(|child| child.part().len).sum();
            match part.split(&mut run[start..start + part.len], LANE_COST, bins) {
                Some(halves) => children.replace(i, halves),
                None => children.all[i] = Child::Leaf(part),
            }
        }
        children
    }

    /// Decides those that are open: a node where a leaf would cost more. A small part is split to find out, and its halves are kept.
    pub fn decide<T: Boxed>(&mut self, mut run: &mut [T], bins: &mut Bins) {
        for child in &mut self.all[..self.n] {
            let (own, rest) = std::mem::take(&mut run).split_at_mut(child.part().len);
            run = rest;
            if let Child::Open(part) = *child
                && part.n_items <= MAX_LEAF
            {
                *child = part
                    .split(own, NODE_COST, bins)
                    .map_or(Child::Leaf(part), |halves| Child::Node(part, halves));
            }
        }
    }

    /// In the order of their runs.
    pub fn all(&self) -> &[Child] {
        &self.all[..self.n]
    }

    fn replace(&mut self, i: usize, [left, right]: [Part; 2]) {
        self.all.copy_within(i + 1..self.n, i + 2);
        self.all[i] = Child::Open(left);
        self.all[i + 1] = Child::Open(right);
        self.n += 1;
    }

    /// The largest part that may be split; the first of equals.
    fn largest(&self) -> Option<(usize, Part)> {
        let mut best: Option<(usize, Part)> = None;
        for (i, child) in self.all().iter().enumerate() {
            if let Child::Open(part) = child
                && best.is_none_or(|(_, largest)| part.bounds.area() > largest.bounds.area())
            {
                best = Some((i, *part));
            }
        }
        best
    }
}
