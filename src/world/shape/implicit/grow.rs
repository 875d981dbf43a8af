//! Making the octree: cells are tried level by level, thrown away where linear forms or intervals prove that f has no zero there, left as they are
//! where f is flat, and halved otherwise.

use super::FAR;
use super::bowl::{Bowl, Shape};
use super::cells::{Cell, Cells, Leaf, Place};
use super::directions;
use super::plane::Plane;
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::math::field::{Choice, Enclosed, Encloser, Field, Fold, Linear, Linearizer, Quadratic};
use crate::math::interval::Interval;
use glam::DVec3;
use std::collections::HashMap;

/// No more cells are tried than this: about a twentieth of a second for a function of twenty operations.
const MOST_TRIED: usize = 60_000;

/// So many turns of a function's loops take about as long as a cell of one that has none.
const TURNS_OF_A_CELL: usize = 8;

/// No cell is halved more often than this.
const DEEPEST: u32 = 7;

/// A cell on its way.
struct Trial {
    place: Place,
    tape: u32,
    /// Which of the parts of which eight it is; none for all of the box.
    slot: Option<(u32, usize)>,
}

/// What a trial says.
enum Verdict {
    /// No zero; whether f is negative.
    Empty(bool),
    /// Perhaps zeros, of the tape of this number; whether halving would tell more.
    Unclear { tape: u32, plane: Option<Plane>, halve: bool },
}

/// The octree of a function in a box.
pub(super) fn grow(field: &Field, bounds: Aabb) -> Cells {
    let size = DVec3::splat(bounds.size().max_element());
    let mut growing = Growing {
        cells: Cells {
            root: Cell::Empty(false),
            parts: Vec::new(),
            leaves: Vec::new(),
            tapes: vec![field.clone()],
        },
        shorter: HashMap::new(),
        reach: bounds.center().abs() + size * (FAR + 1.0),
        forms: Vec::new(),
        quadratics: Vec::new(),
        folds: HashMap::new(),
        n_tried: 0,
        turns: 0,
    };
    let mut level: Vec<Trial> =
        growing.tried(Trial { place: Place::of(bounds), tape: 0, slot: None }).into_iter().collect();
    if !level.is_empty() && is_endless(field, bounds) {
        level.clear();
    }
    for _ in 0..DEEPEST {
        if growing.cost_with(8 * level.len()) > MOST_TRIED {
            break;
        }
        level = level.into_iter().flat_map(|cell| growing.halved(&cell)).collect();
    }
    if field.is_bowed() {
        growing.bend(growing.cells.root, Place::of(bounds));
    }
    growing.cells
}

/// Whether f is undefined all over the box, since it runs too long: each cell would take as long as the guard lets it, and tell nothing.
fn is_endless(field: &Field, bounds: Aabb) -> bool {
    let side = |i: usize| Interval::new(bounds.min[i], bounds.max[i]);
    !field.is_straight() && Encloser::new(field).is_endless(&directions::<0>(std::array::from_fn(side), []))
}

/// An octree in the making.
struct Growing {
    cells: Cells,
    /// Tapes by what they came from and how it chose.
    shorter: HashMap<(u32, Vec<Choice>), u32>,
    /// The greatest coordinates of where a ray may start: points on it are off by their rounding.
    reach: DVec3,
    forms: Vec<Linear<3>>,
    quadratics: Vec<Quadratic>,
    /// By their tapes.
    folds: HashMap<u32, Option<Fold>>,
    n_tried: usize,
    /// How many turns the loops of f have taken.
    turns: usize,
}

impl Growing {
    /// What all costs, in cells of a function without loops, after so many more.
    fn cost_with(&self, more: usize) -> usize {
        let n = self.n_tried + more;
        n + self.turns / TURNS_OF_A_CELL * n / self.n_tried
    }

    /// Puts a cell in its place; gives it back with its tape where it should be halved.
    fn tried(&mut self, trial: Trial) -> Option<Trial> {
        let (cell, again) = match self.verdict(&trial) {
            Verdict::Empty(negative) => (Cell::Empty(negative), None),
            Verdict::Unclear { tape, plane, halve } => {
                self.cells.leaves.push(Leaf { tape, plane, shape: None });
                let leaf = Cell::Leaf(self.cells.leaves.len() as u32 - 1);
                (leaf, halve.then_some(tape))
            }
        };
        self.set(&trial, cell);
        again.map(|tape| Trial { tape, ..trial })
    }

    fn set(&mut self, trial: &Trial, cell: Cell) {
        match trial.slot {
            None => self.cells.root = cell,
            Some((parts, i)) => self.cells.parts[parts as usize][i] = cell,
        }
    }

    /// Those of the eight parts of a cell that should be halved again.
    fn halved(&mut self, cell: &Trial) -> Vec<Trial> {
        let parts = self.cells.parts.len() as u32;
        self.cells.parts.push([Cell::Empty(false); 8]);
        self.set(cell, Cell::Parts(parts));
        let part = |i| Trial { place: cell.place.octant(i), tape: cell.tape, slot: Some((parts, i)) };
        (0..8).filter_map(|i| self.tried(part(i))).collect()
    }

    fn verdict(&mut self, trial: &Trial) -> Verdict {
        self.n_tried += 1;
        let (middle, half) = self.sides(&trial.place);
        let inputs = inputs(middle, half);
        let field = &self.cells.tapes[trial.tape as usize];
        let mut linearizer = Linearizer::reuse(field, std::mem::take(&mut self.forms));
        let known = linearizer.run_choosing(&inputs).map(|(form, choices)| (form, choices.to_vec()));
        self.forms = linearizer.into_memory();
        let Some((form, choices)) = known else { return self.by_intervals(trial, middle, half) };
        if let Some(negative) = form.sign() {
            return Verdict::Empty(negative);
        }
        // Where a form is mostly rest, intervals may be the narrower.
        if form.rest > form.slope.iter().map(|g| g.abs()).sum()
            && let Verdict::Empty(negative) = self.by_intervals(trial, middle, half)
        {
            return Verdict::Empty(negative);
        }
        let plane = Plane::new(&form, middle, half, self.reach);
        let tape = self.shorter_tape(trial.tape, choices);
        Verdict::Unclear { tape, plane, halve: plane.is_none() || !Plane::is_flat(&form) }
    }

    /// The middle of a cell and half of its sides, with room for the rounding of points on rays.
    fn sides(&self, place: &Place) -> (DVec3, DVec3) {
        (place.middle, (place.half + self.reach * gamma(8)).map(f64::next_up))
    }

    /// Finds bowls for the leaves of a cell.
    fn bend(&mut self, cell: Cell, place: Place) {
        match cell {
            Cell::Empty(_) => {}
            Cell::Leaf(leaf) => self.cells.leaves[leaf as usize].shape = self.shape(leaf, &place),
            Cell::Parts(parts) => {
                for part in 0..8 {
                    self.bend(self.cells.parts[parts as usize][part], place.octant(part));
                }
            }
        }
    }

    fn shape(&mut self, leaf: u32, place: &Place) -> Option<Shape> {
        let tape = self.cells.leaves[leaf as usize].tape;
        self.cells.leaves[leaf as usize].plane?;
        let (linear, bowl, open) = self.bowl(&self.cells.tapes[tape as usize].clone(), place)?;
        if Plane::is_flat(&linear) {
            return None;
        }
        if !open {
            return bowl.filter(|bowl| bowl.rest() < 0.5 * linear.rest).map(Shape::Bowl);
        }
        let tapes = &self.cells.tapes;
        let fold = self.folds.entry(tape).or_insert_with(|| tapes[tape as usize].folded()).clone()?;
        let sides =
            [&fold.sides[0], &fold.sides[1]].map(|side| self.bowl(side, place).and_then(|(_, bowl, _)| bowl));
        let [Some(a), Some(b)] = sides else { return None };
        Some(Shape::Fold(Box::new([a, b]), fold.greater))
    }

    /// A tape's linear form in a cell, its bowl, and whether a choice of it is open there. None where it is not known.
    fn bowl(&mut self, field: &Field, place: &Place) -> Option<(Linear<3>, Option<Bowl>, bool)> {
        let (middle, half) = self.sides(place);
        let inputs = inputs(middle, half);
        let mut linearizer = Linearizer::reuse(field, std::mem::take(&mut self.forms));
        let known = linearizer.run_choosing(&inputs).map(|(form, choices)| (form, field.is_open(choices)));
        let bowl = known
            .and_then(|_| linearizer.quadratic(&inputs.map(|x| Quadratic::of(&x)), &mut self.quadratics));
        self.forms = linearizer.into_memory();
        let (linear, open) = known?;
        Some((linear, bowl.and_then(|form| Bowl::new(&form, middle, half, self.reach)), open))
    }

    fn by_intervals(&mut self, trial: &Trial, middle: DVec3, half: DVec3) -> Verdict {
        let (min, max) = (middle - half, middle + half);
        let box_of = std::array::from_fn(|i| Interval::new(min[i].next_down(), max[i].next_up()));
        let field = &self.cells.tapes[trial.tape as usize];
        let mut encloser = Encloser::new(field);
        let all = encloser.run_choosing(&directions(box_of, [DVec3::X, DVec3::Y, DVec3::Z]));
        self.turns += encloser.turns() as usize;
        let unclear = |tape| Verdict::Unclear { tape, plane: None, halve: true };
        if all.value.gaps.are_undefined() {
            return unclear(trial.tape);
        }
        let jumps = all.value.gaps.are_there();
        let values = match all.value.contains(0.0) && !jumps {
            true => all.value.intersect(mean_value(field, box_of, &all)),
            false => all.value,
        };
        if !values.contains(0.0) {
            return Verdict::Empty(values.hi < 0.0);
        }
        if jumps {
            return unclear(trial.tape);
        }
        let choices = encloser.choices().to_vec();
        unclear(self.shorter_tape(trial.tape, choices))
    }

    fn shorter_tape(&mut self, tape: u32, choices: Vec<Choice>) -> u32 {
        if choices.iter().all(|c| *c == Choice::Both) {
            return tape;
        }
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

/// The coordinates of a cell.
fn inputs(middle: DVec3, half: DVec3) -> [Linear<3>; 3] {
    std::array::from_fn(|i| {
        let mut slope = [0.0; 3];
        slope[i] = half[i];
        Linear::new(middle[i], slope, 0.0)
    })
}

/// f(c) + ∇f·(x − c) over the box.
fn mean_value(field: &Field, at: [Interval; 3], all: &Enclosed<3>) -> Interval {
    let middle = at.map(Interval::middle);
    let value = Encloser::new(field).run(&middle.map(Enclosed::<0>::constant)).value;
    (0..3).fold(value, |sum, i| sum + all.slope[i] * (at[i] - Interval::point(middle[i])))
}
