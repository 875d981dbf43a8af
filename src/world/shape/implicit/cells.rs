//! The parts of a box that may hold zeros of a function: an octree, each of whose cells has the tape that is left of the function there, and
//! the plane that it is near, where that is known. How it is made is the matter of [`super::grow`].

use super::plane::Plane;
use crate::math::Aabb;
use crate::math::field::Field;
use glam::DVec3;

/// What is in a part of the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cell {
    /// No zero; whether f is negative.
    Empty(bool),
    /// Perhaps zeros: the leaf of this number.
    Leaf(u32),
    /// Eight parts, each half as large: this place in the list.
    Parts(u32),
}

/// What is known of f in a cell that may hold zeros.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    /// Number of the tape that gives f's bits there.
    pub tape: u32,
    /// None where f may jump or be undefined.
    pub plane: Option<Plane>,
}

/// A cell on a ray's way.
pub(super) enum Visited<'c> {
    /// No zero; whether f is negative.
    Empty(bool),
    /// Perhaps zeros.
    Leaf(&'c Leaf),
}

/// The octree.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    pub root: Cell,
    /// By bits: 1 the upper x, 2 the upper y, 4 the upper z.
    pub parts: Vec<[Cell; 8]>,
    pub leaves: Vec<Leaf>,
    pub tapes: Vec<Field>,
}

impl Cells {
    /// The tape of a cell.
    pub fn tape(&self, leaf: &Leaf) -> &Field {
        &self.tapes[leaf.tape as usize]
    }

    /// The middles of all cells that may hold zeros.
    pub fn middles(&self, bounds: Aabb) -> impl Iterator<Item = DVec3> {
        let mut rest = vec![(self.root, bounds)];
        std::iter::from_fn(move || {
            while let Some((cell, bounds)) = rest.pop() {
                match cell {
                    Cell::Empty(_) => {}
                    Cell::Leaf(_) => return Some(bounds.center()),
                    Cell::Parts(place) => {
                        let parts = &self.parts[place as usize];
                        rest.extend((0..8).map(|i| (parts[i], octant(bounds, i))));
                    }
                }
            }
            None
        })
    }

    /// Offers to `visit` the pieces of a ray between two distances, cell by cell in order, until it says false. Pieces in neighbouring
    /// cells end and begin at the same bits.
    pub fn along(
        &self,
        bounds: Aabb,
        origin: DVec3,
        direction: DVec3,
        between: (f64, f64),
        visit: &mut impl FnMut(f64, f64, Visited<'_>) -> bool,
    ) {
        let walk = Walk { cells: self, origin, direction };
        walk.visit(self.root, bounds, between, visit);
    }
}

/// An eighth of a box.
pub(super) fn octant(bounds: Aabb, part: usize) -> Aabb {
    let middle = bounds.center();
    let upper = glam::BVec3::new(part & 1 != 0, part & 2 != 0, part & 4 != 0);
    Aabb { min: DVec3::select(upper, middle, bounds.min), max: DVec3::select(upper, bounds.max, middle) }
}

/// A ray on its way through the octree.
struct Walk<'c> {
    cells: &'c Cells,
    origin: DVec3,
    direction: DVec3,
}

impl Walk<'_> {
    fn visit(
        &self,
        cell: Cell,
        bounds: Aabb,
        (from, to): (f64, f64),
        visit: &mut impl FnMut(f64, f64, Visited<'_>) -> bool,
    ) -> bool {
        let place = match cell {
            Cell::Empty(negative) => return visit(from, to, Visited::Empty(negative)),
            Cell::Leaf(leaf) => return visit(from, to, Visited::Leaf(&self.cells.leaves[leaf as usize])),
            Cell::Parts(place) => place,
        };
        let middle = bounds.center();
        let cuts: [f64; 3] = std::array::from_fn(|axis| self.cut(axis, middle[axis]));
        let mut ends = [cuts[0], cuts[1], cuts[2], to];
        ends.sort_by(f64::total_cmp);
        let mut at = from;
        for end in ends {
            let end = end.min(to);
            if !(end > at) {
                continue;
            }
            let part = (0..3).fold(0, |bits, axis| {
                let beyond = at >= cuts[axis];
                let upper = beyond != self.direction[axis].is_sign_negative();
                bits | (usize::from(upper) << axis)
            });
            let inside = self.cells.parts[place as usize][part];
            if !self.visit(inside, octant(bounds, part), (at, end), visit) {
                return false;
            }
            at = end;
        }
        true
    }

    /// Where the ray crosses the plane between lower and upper half; for a ray along it before or after everything, by its side.
    fn cut(&self, axis: usize, plane: f64) -> f64 {
        let (o, d) = (self.origin[axis], self.direction[axis]);
        if d != 0.0 {
            return (plane - o) / d;
        }
        let is_upper = o >= plane;
        if is_upper == d.is_sign_positive() { f64::NEG_INFINITY } else { f64::INFINITY }
    }
}
