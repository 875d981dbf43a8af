//! The sum that inverse kinematics makes least, with its derivatives: ½Σ|r|², r = √w·(tip − point)/L for each goal and
//! √w·(direction − wanted) for each direction, L the length of the longest chain. Unknowns are radians of turns and moves over L, so that
//! nothing depends on the scene's unit.

use super::Goal;
use crate::geometry::mesh::unit;
use crate::geometry::skeleton::{Limits, Placement, Skeleton, Turning};
use crate::math::elementary::atan2;
use crate::math::matrix::Matrix;
use glam::DVec3;

/// The problem; see the head of this module.
pub struct Problem<'a> {
    pub skeleton: &'a Skeleton,
    /// Those coordinates that move a goal, outer before inner.
    pub variables: Vec<Variable>,
    pub terms: Vec<Term>,
    /// L, scene units.
    pub length: f64,
}

/// One unknown.
pub struct Variable {
    /// Which of the skeleton's motions.
    pub motion: usize,
    /// Which of the skeleton's coordinates.
    pub coordinate: usize,
    pub turning: Turning,
    /// Author's units per unit of the unknown: 180/π or L.
    pub unit: f64,
    pub limits: Limits,
}

/// One vector that should be another.
pub struct Term {
    pub joint: usize,
    /// In the joint's frame: a point over L, or a unit direction.
    pub local: DVec3,
    pub is_point: bool,
    /// In the world, in the same unit.
    pub target: DVec3,
    /// √w.
    pub weight: f64,
    /// For each variable, whether it moves this.
    pub moved: Vec<bool>,
}

/// Coordinates with what is computed there.
#[derive(Clone)]
pub struct State {
    /// All of the skeleton's, author's units.
    pub coordinates: Vec<f64>,
    pub placement: Placement,
    /// For each term its vector in the world.
    pub values: Vec<DVec3>,
    /// For each term √w·(value − target).
    pub residuals: Vec<DVec3>,
    /// ½Σ|r|².
    pub sum: f64,
}

impl Variable {
    /// Its value after a change of the unknown, within the limits.
    pub fn moved(&self, value: f64, change: f64) -> f64 {
        (value + change * self.unit).clamp(self.limits.low, self.limits.high)
    }

    /// How far the unknown may change, down and up.
    pub fn room(&self, coordinates: &[f64]) -> (f64, f64) {
        let value = coordinates[self.coordinate];
        ((self.limits.low - value) / self.unit, (self.limits.high - value) / self.unit)
    }

    /// Whether a limit holds it against this gradient.
    pub fn binds(&self, coordinates: &[f64], gradient: f64) -> bool {
        let value = coordinates[self.coordinate];
        (value <= self.limits.low && gradient > 0.0) || (value >= self.limits.high && gradient < 0.0)
    }
}

impl<'a> Problem<'a> {
    pub fn new(skeleton: &'a Skeleton, goals: &[Goal], start: &[f64]) -> Problem<'a> {
        let goals: Vec<&Goal> = goals.iter().filter(|goal| goal.weight > 0.0).collect();
        let lengths = goals.iter().map(|goal| chain_length(skeleton, goal.tip, start));
        let length = lengths.fold(0.0, f64::max);
        let length = if length > 0.0 { length } else { 1.0 };
        let mut problem = Problem { skeleton, variables: Vec::new(), terms: Vec::new(), length };
        let chains: Vec<Vec<usize>> =
            goals.iter().map(|goal| skeleton.chain(skeleton.tips()[goal.tip].joint)).collect();
        problem.variables = (0..skeleton.motions().len())
            .filter(|&k| chains.iter().any(|chain| chain.contains(&skeleton.motions()[k].joint)))
            .map(|k| problem.variable(k))
            .collect();
        for (goal, chain) in goals.iter().zip(&chains) {
            problem.add(goal, chain);
        }
        problem
    }

    fn variable(&self, k: usize) -> Variable {
        let motion = self.skeleton.motions()[k];
        let unit = match motion.turning {
            Turning::Turn => 1f64.to_degrees(),
            Turning::Move => self.length,
        };
        let limits = self.skeleton.limits()[motion.coordinate];
        Variable { motion: k, coordinate: motion.coordinate, turning: motion.turning, unit, limits }
    }

    fn add(&mut self, goal: &Goal, chain: &[usize]) {
        let tip = &self.skeleton.tips()[goal.tip];
        let joint_of = |v: &Variable| self.skeleton.motions()[v.motion].joint;
        let on_chain = |v: &Variable| chain.contains(&joint_of(v));
        let point = Term {
            joint: tip.joint,
            local: tip.offset / self.length,
            is_point: true,
            target: goal.point / self.length,
            weight: goal.weight.sqrt(),
            moved: self.variables.iter().map(on_chain).collect(),
        };
        let turns = |v: &Variable| on_chain(v) && v.turning == Turning::Turn;
        let direction = goal.toward.and_then(unit).map(|target| Term {
            local: self.skeleton.pointing(goal.tip),
            is_point: false,
            target,
            moved: self.variables.iter().map(turns).collect(),
            ..point
        });
        self.terms.extend(std::iter::once(point).chain(direction));
    }

    /// Coordinates brought within the limits.
    pub fn clamped(&self, coordinates: &[f64]) -> Vec<f64> {
        let mut clamped = coordinates.to_vec();
        for v in &self.variables {
            clamped[v.coordinate] = v.moved(clamped[v.coordinate], 0.0);
        }
        clamped
    }

    /// Everything at these coordinates.
    pub fn state(&self, coordinates: Vec<f64>) -> State {
        let placement = Placement::new(self.skeleton, &coordinates);
        let value = |term: &Term| {
            let frame = placement.frames[term.joint];
            let turned = frame.turn * term.local;
            if term.is_point { turned + frame.origin / self.length } else { turned }
        };
        let values: Vec<DVec3> = self.terms.iter().map(value).collect();
        let residual = |(term, value): (&Term, &DVec3)| term.weight * (*value - term.target);
        let residuals: Vec<DVec3> = self.terms.iter().zip(&values).map(residual).collect();
        let sum = 0.5 * residuals.iter().map(|r| r.length_squared()).sum::<f64>();
        State { coordinates, placement, values, residuals, sum }
    }

    /// The state after a change of the unknowns, clamped to the limits.
    pub fn step(&self, state: &State, change: &[f64]) -> State {
        let mut coordinates = state.coordinates.clone();
        for (v, change) in self.variables.iter().zip(change) {
            coordinates[v.coordinate] = v.moved(coordinates[v.coordinate], *change);
        }
        self.state(coordinates)
    }

    /// ∂(√w·value)/∂unknown for each term; a row of terms for each variable.
    pub fn derivatives(&self, state: &State) -> Vec<Vec<DVec3>> {
        let one = |k: usize, v: &Variable, t: usize, term: &Term| {
            let screw = state.placement.screws[v.motion];
            match (term.moved[k], v.turning) {
                (false, _) => DVec3::ZERO,
                (true, Turning::Move) => term.weight * screw.axis,
                (true, Turning::Turn) => {
                    let pivot = if term.is_point { screw.pivot / self.length } else { DVec3::ZERO };
                    term.weight * screw.axis.cross(state.values[t] - pivot)
                }
            }
        };
        let row = |(k, v): (usize, &Variable)| {
            self.terms.iter().enumerate().map(|(t, term)| one(k, v, t, term)).collect()
        };
        self.variables.iter().enumerate().map(row).collect()
    }

    /// The gradient of the sum: Jᵀr.
    pub fn gradient(&self, state: &State) -> Vec<f64> {
        gradient_of(&self.derivatives(state), state)
    }

    /// The Hessian of the sum: JᵀJ and the residuals' own curvature. An outer turn about a, an inner unknown with derivative d:
    /// r·(a × d) = (r × a)·d. Symmetric; both triangles are filled.
    pub fn hessian(&self, state: &State, derivatives: &[Vec<DVec3>]) -> Matrix {
        let n = self.variables.len();
        let mut hessian = Matrix::zeros(n, n);
        for (i, outer) in self.variables.iter().enumerate() {
            let axis = match outer.turning {
                Turning::Turn => state.placement.screws[outer.motion].axis,
                Turning::Move => DVec3::ZERO,
            };
            let lever: Vec<DVec3> = (0..self.terms.len())
                .map(|t| {
                    let turn =
                        if self.terms[t].moved[i] { state.residuals[t].cross(axis) } else { DVec3::ZERO };
                    derivatives[i][t] + turn
                })
                .collect();
            for j in i..n {
                let entry = lever.iter().zip(&derivatives[j]).map(|(l, d)| l.dot(*d)).sum();
                hessian[(i, j)] = entry;
                hessian[(j, i)] = entry;
            }
        }
        hessian
    }

    /// The largest change of an unknown that the negative gradient asks for and the limits allow, at most the gradient itself.
    pub fn slope(&self, state: &State, gradient: &[f64]) -> f64 {
        let one = |(v, g): (&Variable, &f64)| {
            let (down, up) = v.room(&state.coordinates);
            (-g).clamp(down.min(0.0), up.max(0.0)).abs()
        };
        self.variables.iter().zip(gradient).map(one).fold(0.0, f64::max)
    }

    /// The largest distance of a point, in scene units, and the largest angle of a direction, in radians.
    pub fn distances(&self, state: &State) -> (f64, f64) {
        let mut largest: (f64, f64) = (0.0, 0.0);
        for (term, value) in self.terms.iter().zip(&state.values) {
            if term.is_point {
                largest.0 = largest.0.max((*value - term.target).length() * self.length);
            } else {
                let (across, along) = (value.cross(term.target).length(), value.dot(term.target));
                largest.1 = largest.1.max(atan2(across, along));
            }
        }
        largest
    }
}

/// Jᵀr from the rows of J.
pub fn gradient_of(derivatives: &[Vec<DVec3>], state: &State) -> Vec<f64> {
    let entry = |row: &Vec<DVec3>| row.iter().zip(&state.residuals).map(|(d, r)| d.dot(*r)).sum();
    derivatives.iter().map(entry).collect()
}

/// The lengths from the first joint that moves to the tip, slides at their start included.
fn chain_length(skeleton: &Skeleton, tip: usize, start: &[f64]) -> f64 {
    let tip = &skeleton.tips()[tip];
    let chain = skeleton.chain(tip.joint);
    let moves = chain.iter().position(|&joint| !skeleton.joints()[joint].coordinates().is_empty());
    let inner = &chain[moves.map_or(chain.len(), |first| first + 1)..];
    let offsets: f64 = inner.iter().map(|&joint| skeleton.joints()[joint].offset.length()).sum();
    let motions = chain.iter().flat_map(|&joint| &skeleton.motions()[skeleton.joints()[joint].motions()]);
    let slides = motions.filter(|motion| motion.turning == Turning::Move);
    offsets + tip.offset.length() + slides.map(|motion| start[motion.coordinate].abs()).sum::<f64>()
}
