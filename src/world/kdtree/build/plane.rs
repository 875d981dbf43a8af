//! The plane to cut a cell by: the cheapest by the surface-area heuristic, or none where a leaf is cheaper.

use super::Piece;
use crate::world::kdtree::cell::Cell;

/// What a ray pays for a plane, in tests of items. Of 0.5, 1 and 1.5, measured on two scanned models of 69 and 346 thousand triangles and on
/// triangles at random, half leaves half as many nodes again for rays that are hardly faster, and one and a half slows them.
const STEP: f64 = 1.0;
/// What planes that cut off nothing but space cost over others, so that they are made rather. Wald & Havran §4.
const EMPTY_SIDE: f64 = 0.8;
/// Up to so many pieces every side of every box is tried, above it evenly spaced planes. Rays do not feel whether 32 or 256.
const EXACT: usize = 64;
/// So many cells between evenly spaced planes. 64 leave as many tests to a ray.
const BINS: usize = 32;

/// A plane, and how many pieces reach into either side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub axis: usize,
    pub at: f32,
    pub n: [usize; 2],
}

impl Plane {
    pub fn n_pieces(&self) -> usize {
        self.n[0] + self.n[1]
    }

    /// The cheapest one through the inside of a cell.
    pub fn cheapest(pieces: &[Piece], cell: &Cell) -> Option<Plane> {
        let mut search = Search { cell, best: None, limit: cell.area() * pieces.len() as f64 };
        for axis in 0..3 {
            if pieces.len() <= EXACT {
                search.every_side(pieces, axis);
            } else {
                search.evenly(pieces, axis);
            }
        }
        search.best
    }
}

struct Search<'a> {
    cell: &'a Cell,
    best: Option<Plane>,
    /// Areas times tests of items, to be undercut: first those of a leaf.
    limit: f64,
}

impl Search<'_> {
    #[inline(always)]
    fn offer(&mut self, axis: usize, at: f32, n: [usize; 2]) {
        if !(self.cell.lower[axis] < at && at < self.cell.upper[axis]) {
            return;
        }
        let [below, above] = self.cell.halves(axis, at);
        let tests = below.area() * n[0] as f64 + above.area() * n[1] as f64;
        let factor = if n[0] == 0 || n[1] == 0 { EMPTY_SIDE } else { 1.0 };
        let cost = factor * (STEP * self.cell.area() + tests);
        if cost < self.limit {
            self.limit = cost;
            self.best = Some(Plane { axis, at, n });
        }
    }

    /// At each side of each piece.
    fn every_side(&mut self, pieces: &[Piece], axis: usize) {
        let sorted = |of: &dyn Fn(&Piece) -> Option<f32>| {
            let mut all: Vec<f32> = pieces.iter().filter_map(of).collect();
            all.sort_unstable_by(f32::total_cmp);
            all
        };
        let lower = sorted(&|piece| Some(piece.bounds.lower[axis]));
        let upper = sorted(&|piece| Some(piece.bounds.upper[axis]));
        let (mut begun, mut ended) = (0, 0);
        // Boxes without thickness in the plane belong below.
        let mut flat = 0;
        let flats = sorted(&|piece| {
            let bounds = &piece.bounds;
            (bounds.lower[axis] == bounds.upper[axis]).then_some(bounds.lower[axis])
        });
        while begun < lower.len() || ended < upper.len() {
            let next = |all: &[f32], i: usize| all.get(i).copied().unwrap_or(f32::INFINITY);
            let at = next(&lower, begun).min(next(&upper, ended));
            let count = |all: &[f32], from: usize| all[from..].iter().take_while(|x| **x <= at).count();
            ended += count(&upper, ended);
            let n_flat = count(&flats, flat);
            self.offer(axis, at, [begun + n_flat, upper.len() - ended]);
            begun += count(&lower, begun);
            flat += n_flat;
        }
    }

    /// At evenly spaced planes.
    fn evenly(&mut self, pieces: &[Piece], axis: usize) {
        let (from, to) = (self.cell.lower[axis], self.cell.upper[axis]);
        let per_bin = BINS as f32 / (to - from);
        if !per_bin.is_finite() {
            return;
        }
        // A cast brings what rounding puts beyond an end back.
        let bin = |x: f32| (((x - from) * per_bin) as usize).min(BINS - 1);
        let (mut begin, mut end) = ([0usize; BINS], [0usize; BINS]);
        for piece in pieces {
            begin[bin(piece.bounds.lower[axis])] += 1;
            end[bin(piece.bounds.upper[axis])] += 1;
        }
        let (mut below, mut above) = (0, pieces.len());
        for i in 1..BINS {
            below += begin[i - 1];
            above -= end[i - 1];
            self.offer(axis, from + i as f32 / per_bin, [below, above]);
        }
    }
}
