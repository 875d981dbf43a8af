//! The parts of a box that may hold zeros of a function: an octree whose cells are thrown away where intervals prove that there is none,
//! each with the tape that is left of the function there.

use super::directions;
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::math::field::{Choice, Enclosed, Encloser, Field};
use crate::math::interval::Interval;
use glam::DVec3;
use std::collections::HashMap;

/// No more cells are tried than this: about a tenth of a second for a function of twenty operations.
const MOST_TRIED: usize = 60_000;

/// No cell is halved more often than this.
const DEEPEST: u32 = 7;

/// What is in a part of the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cell {
    /// No zero.
    Empty,
    /// Perhaps zeros, of the tape of this number.
    Leaf(u32),
    /// Eight parts, each half as large: this place in the list.
    Parts(u32),
}

/// The octree.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    root: Cell,
    /// By bits: 1 the upper x, 2 the upper y, 4 the upper z.
    parts: Vec<[Cell; 8]>,
    tapes: Vec<Field>,
}

/// A cell on its way.
struct Trial {
    bounds: Aabb,
    tape: u32,
    /// Which of the parts of which place it is; none for all of the box.
    slot: Option<(u32, usize)>,
}

impl Cells {
    /// Of a function in a box.
    pub fn new(field: &Field, bounds: Aabb) -> Cells {
        let mut growing = Growing {
            cells: Cells { root: Cell::Empty, parts: Vec::new(), tapes: vec![field.clone()] },
            shorter: HashMap::new(),
            reach: bounds.min.abs().max(bounds.max.abs()),
        };
        let mut level: Vec<Trial> =
            growing.tried(Trial { bounds, tape: 0, slot: None }).into_iter().collect();
        let mut tried = 1;
        for _ in 0..DEEPEST {
            tried += 8 * level.len();
            if tried > MOST_TRIED {
                break;
            }
            level = level.into_iter().flat_map(|cell| growing.halved(&cell)).collect();
        }
        growing.cells
    }

    /// The tape of a cell.
    pub fn tape(&self, number: u32) -> &Field {
        &self.tapes[number as usize]
    }

    /// The middles of all cells that may hold zeros.
    pub fn middles(&self, bounds: Aabb) -> impl Iterator<Item = DVec3> {
        let mut rest = vec![(self.root, bounds)];
        std::iter::from_fn(move || {
            while let Some((cell, bounds)) = rest.pop() {
                match cell {
                    Cell::Empty => {}
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

    /// Offers to `leaf` the pieces of a ray between two distances that lie in cells that may hold zeros, in order, with the number of
    /// the tape, until it says false. Pieces in neighbouring cells end and begin at the same bits.
    pub fn along(
        &self,
        bounds: Aabb,
        origin: DVec3,
        direction: DVec3,
        between: (f64, f64),
        leaf: &mut impl FnMut(f64, f64, u32) -> bool,
    ) {
        let walk = Walk { cells: self, origin, direction };
        walk.visit(self.root, bounds, between, leaf);
    }
}

/// An octree in the making.
struct Growing {
    cells: Cells,
    /// Tapes by what they came from and how it chose.
    shorter: HashMap<(u32, Vec<Choice>), u32>,
    /// The greatest coordinates: points on a ray are off by their rounding.
    reach: DVec3,
}

impl Growing {
    /// Puts a cell in its place; gives it back with its tape where it may hold zeros.
    fn tried(&mut self, trial: Trial) -> Option<Trial> {
        let (may_hold, tape) = self.may_hold_zeros(&trial);
        let cell = if may_hold { Cell::Leaf(tape) } else { Cell::Empty };
        self.set(&trial, cell);
        may_hold.then_some(Trial { tape, ..trial })
    }

    fn set(&mut self, trial: &Trial, cell: Cell) {
        match trial.slot {
            None => self.cells.root = cell,
            Some((place, i)) => self.cells.parts[place as usize][i] = cell,
        }
    }

    /// Those of the eight parts of a cell that may hold zeros.
    fn halved(&mut self, cell: &Trial) -> Vec<Trial> {
        let place = self.cells.parts.len() as u32;
        self.cells.parts.push([Cell::Empty; 8]);
        self.set(cell, Cell::Parts(place));
        let part = |i| Trial { bounds: octant(cell.bounds, i), tape: cell.tape, slot: Some((place, i)) };
        (0..8).filter_map(|i| self.tried(part(i))).collect()
    }

    fn may_hold_zeros(&mut self, trial: &Trial) -> (bool, u32) {
        let slack = self.reach * gamma(8);
        let (min, max) = ((trial.bounds.min - slack).to_array(), (trial.bounds.max + slack).to_array());
        let box_of = std::array::from_fn(|i| Interval::new(min[i], max[i]));
        let field = &self.cells.tapes[trial.tape as usize];
        let mut encloser = Encloser::new(field);
        let (all, choices) = encloser.run_choosing(&directions(box_of, [DVec3::X, DVec3::Y, DVec3::Z]));
        if all.value.partial {
            return (true, trial.tape);
        }
        let around = match all.value.contains(0.0) {
            true => all.value.intersect(mean_value(field, box_of, &all)),
            false => all.value,
        };
        if !around.contains(0.0) {
            return (false, trial.tape);
        }
        if choices.iter().all(|c| *c == Choice::Both) {
            return (true, trial.tape);
        }
        let choices = choices.to_vec();
        (true, self.shorter_tape(trial.tape, choices))
    }

    fn shorter_tape(&mut self, tape: u32, choices: Vec<Choice>) -> u32 {
        let tapes = &mut self.cells.tapes;
        *self.shorter.entry((tape, choices)).or_insert_with_key(|(_, choices)| {
            match tapes[tape as usize].simplified(choices) {
                None => tape,
                Some(field) => {
                    tapes.push(field);
                    tapes.len() as u32 - 1
                }
            }
        })
    }
}

/// f(c) + ∇f·(x − c) over the box.
fn mean_value(field: &Field, at: [Interval; 3], all: &Enclosed<3>) -> Interval {
    let middle = at.map(Interval::middle);
    let value = Encloser::new(field).run(&middle.map(Enclosed::<0>::constant)).value;
    (0..3).fold(value, |sum, i| sum + all.slope[i] * (at[i] - Interval::point(middle[i])))
}

/// An eighth of a box.
fn octant(bounds: Aabb, part: usize) -> Aabb {
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
        leaf: &mut impl FnMut(f64, f64, u32) -> bool,
    ) -> bool {
        let place = match cell {
            Cell::Empty => return true,
            Cell::Leaf(tape) => return leaf(from, to, tape),
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
            if inside != Cell::Empty && !self.visit(inside, octant(bounds, part), (at, end), leaf) {
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
