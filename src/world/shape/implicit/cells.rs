//! The parts of a box that may hold zeros of a function: an octree, each of whose cells has the tape that is left of the function there, and
//! the plane that it is near, where that is known. How it is made is the matter of [`super::grow`].

use super::bowl::Shape;
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
    /// Where the plane leaves much open, and more is known.
    pub shape: Option<Shape>,
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
        let mut rest = vec![(self.root, Place::of(bounds))];
        std::iter::from_fn(move || {
            while let Some((cell, place)) = rest.pop() {
                match cell {
                    Cell::Empty(_) => {}
                    Cell::Leaf(_) => return Some(place.middle),
                    Cell::Parts(parts) => {
                        let parts = &self.parts[parts as usize];
                        rest.extend((0..8).map(|i| (parts[i], place.octant(i))));
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
        let backward = direction.is_negative_bitmask() as usize;
        let never = DVec3::NEG_INFINITY.copysign(-direction);
        let walk = Walk { cells: self, origin, inverse: direction.recip(), never, backward };
        match self.root {
            Cell::Parts(parts) => {
                walk.divide(&self.parts[parts as usize], Place::of(bounds), between, visit);
            }
            whole => {
                walk.enter(whole, &Place::of(bounds), 0, between, visit);
            }
        }
    }
}

/// Where a cell is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub middle: DVec3,
    /// Half of its sides.
    pub half: DVec3,
}

impl Place {
    /// A box.
    pub fn of(bounds: Aabb) -> Place {
        Place { middle: bounds.center(), half: (bounds.max - bounds.min) / 2.0 }
    }

    /// An eighth of it.
    #[inline(always)]
    pub fn octant(&self, part: usize) -> Place {
        let half = self.half / 2.0;
        let upper = glam::BVec3::new(part & 1 != 0, part & 2 != 0, part & 4 != 0);
        Place { middle: self.middle + DVec3::select(upper, half, -half), half }
    }
}

/// A ray on its way through the octree.
struct Walk<'c> {
    cells: &'c Cells,
    origin: DVec3,
    /// 1 over each coordinate of its direction.
    inverse: DVec3,
    /// Where it crosses a plane in which it runs: before or after everything, as that is of the upper half.
    never: DVec3,
    /// The axes along which it goes down, by bits.
    backward: usize,
}

impl Walk<'_> {
    /// Goes into a part of a place.
    #[inline(always)]
    fn enter(
        &self,
        cell: Cell,
        place: &Place,
        part: usize,
        (from, to): (f64, f64),
        visit: &mut impl FnMut(f64, f64, Visited<'_>) -> bool,
    ) -> bool {
        match cell {
            Cell::Empty(negative) => visit(from, to, Visited::Empty(negative)),
            Cell::Leaf(leaf) => visit(from, to, Visited::Leaf(&self.cells.leaves[leaf as usize])),
            Cell::Parts(parts) => {
                self.divide(&self.cells.parts[parts as usize], place.octant(part), (from, to), visit)
            }
        }
    }

    fn divide(
        &self,
        parts: &[Cell; 8],
        place: Place,
        (from, to): (f64, f64),
        visit: &mut impl FnMut(f64, f64, Visited<'_>) -> bool,
    ) -> bool {
        let mut cuts = self.cuts(place.middle);
        let (mut at, mut beyond) = (from, 0);
        loop {
            let mut end = to;
            for (axis, cut) in cuts.iter_mut().enumerate() {
                // A plane is passed once; then it is nowhere ahead.
                let is_passed = at >= *cut;
                beyond |= usize::from(is_passed) << axis;
                *cut = if is_passed { f64::INFINITY } else { *cut };
                end = if *cut < end { *cut } else { end };
            }
            let part = beyond ^ self.backward;
            if !self.enter(parts[part], &place, part, (at, end), visit) {
                return false;
            }
            if !(end < to) {
                return true;
            }
            at = end;
        }
    }

    /// Where the ray crosses the planes between lower and upper halves.
    #[inline(always)]
    fn cuts(&self, middle: DVec3) -> [f64; 3] {
        let cuts = (middle - self.origin) * self.inverse;
        // 0 · ∞: in the plane itself.
        let cut = |cut: f64, never: f64| if cut.is_nan() { never } else { cut };
        [cut(cuts.x, self.never.x), cut(cuts.y, self.never.y), cut(cuts.z, self.never.z)]
    }
}
