//! Making the octree: cells are tried level by level, thrown away where linear forms or intervals prove that f has no zero there, left as they are
//! where f is flat, and halved otherwise.

use super::FAR;
use super::cells::{Cell, Cells, Leaf, octant};
use super::directions;
use super::plane::Plane;
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::math::field::{Choice, Enclosed, Encloser, Field, Linear, Linearizer};
use crate::math::interval::Interval;
use glam::DVec3;
use std::collections::HashMap;

/// No more cells are tried than this: about a twentieth of a second for a function of twenty operations.
const MOST_TRIED: usize = 60_000;

/// No cell is halved more often than this.
const DEEPEST: u32 = 7;

/// A cell on its way.
struct Trial {
    bounds: Aabb,
    tape: u32,
    /// Which of the parts of which place it is; none for all of the box.
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
    };
    let mut level: Vec<Trial> = growing.tried(Trial { bounds, tape: 0, slot: None }).into_iter().collect();
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

/// An octree in the making.
struct Growing {
    cells: Cells,
    /// Tapes by what they came from and how it chose.
    shorter: HashMap<(u32, Vec<Choice>), u32>,
    /// The greatest coordinates of where a ray may start: points on it are off by their rounding.
    reach: DVec3,
    forms: Vec<Linear<3>>,
}

impl Growing {
    /// Puts a cell in its place; gives it back with its tape where it should be halved.
    fn tried(&mut self, trial: Trial) -> Option<Trial> {
        let (cell, again) = match self.verdict(&trial) {
            Verdict::Empty(negative) => (Cell::Empty(negative), None),
            Verdict::Unclear { tape, plane, halve } => {
                self.cells.leaves.push(Leaf { tape, plane });
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
            Some((place, i)) => self.cells.parts[place as usize][i] = cell,
        }
    }

    /// Those of the eight parts of a cell that should be halved again.
    fn halved(&mut self, cell: &Trial) -> Vec<Trial> {
        let place = self.cells.parts.len() as u32;
        self.cells.parts.push([Cell::Empty(false); 8]);
        self.set(cell, Cell::Parts(place));
        let part = |i| Trial { bounds: octant(cell.bounds, i), tape: cell.tape, slot: Some((place, i)) };
        (0..8).filter_map(|i| self.tried(part(i))).collect()
    }

    fn verdict(&mut self, trial: &Trial) -> Verdict {
        let slack = self.reach * gamma(8);
        let around = Aabb { min: trial.bounds.min - slack, max: trial.bounds.max + slack };
        let middle = around.center();
        let half = ((around.max - middle).max(middle - around.min)).map(f64::next_up);
        let inputs = std::array::from_fn::<_, 3, _>(|i| {
            let mut x = Linear::constant(middle[i]);
            x.slope[i] = half[i];
            x
        });
        let field = &self.cells.tapes[trial.tape as usize];
        let mut linearizer = Linearizer::reuse(field, std::mem::take(&mut self.forms));
        let known = linearizer.run_choosing(&inputs).map(|(form, choices)| (form, choices.to_vec()));
        self.forms = linearizer.into_memory();
        let Some((form, choices)) = known else { return self.by_intervals(trial, around) };
        if let Some(negative) = form.sign() {
            return Verdict::Empty(negative);
        }
        // Where a form is mostly rest, intervals may be the narrower.
        if form.rest > form.slope.iter().map(|g| g.abs()).sum()
            && let Verdict::Empty(negative) = self.by_intervals(trial, around)
        {
            return Verdict::Empty(negative);
        }
        let plane = Plane::new(&form, middle, half, self.reach);
        let tape = self.shorter_tape(trial.tape, choices);
        Verdict::Unclear { tape, plane, halve: plane.is_none() || !Plane::is_flat(&form) }
    }

    fn by_intervals(&mut self, trial: &Trial, around: Aabb) -> Verdict {
        let (min, max) = (around.min.to_array(), around.max.to_array());
        let box_of = std::array::from_fn(|i| Interval::new(min[i], max[i]));
        let field = &self.cells.tapes[trial.tape as usize];
        let mut encloser = Encloser::new(field);
        let (all, choices) = encloser.run_choosing(&directions(box_of, [DVec3::X, DVec3::Y, DVec3::Z]));
        let unclear = |tape| Verdict::Unclear { tape, plane: None, halve: true };
        if all.value.partial {
            return unclear(trial.tape);
        }
        let values = match all.value.contains(0.0) {
            true => all.value.intersect(mean_value(field, box_of, &all)),
            false => all.value,
        };
        if !values.contains(0.0) {
            return Verdict::Empty(values.hi < 0.0);
        }
        let choices = choices.to_vec();
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

/// f(c) + ∇f·(x − c) over the box.
fn mean_value(field: &Field, at: [Interval; 3], all: &Enclosed<3>) -> Interval {
    let middle = at.map(Interval::middle);
    let value = Encloser::new(field).run(&middle.map(Enclosed::<0>::constant)).value;
    (0..3).fold(value, |sum, i| sum + all.slope[i] * (at[i] - Interval::point(middle[i])))
}
