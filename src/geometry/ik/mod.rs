//! Inverse kinematics: coordinates of a skeleton for which tips are at given points, or as near as its joints and their limits allow.
//! Knows nothing of scenes.
//!
//! Least Σ w·|tip − point|² over the box of the limits. `problem` is that sum with its first and second derivatives, the methods are
//! `levenberg` (the default), `pseudo_inverse`, `transpose` and `ccd`, and `descent` is what they share: no coordinate moves by
//! more than a radian in a step, the sum never grows, limits hold to the last bit, and a place where all of them stand still though it
//! is no minimum (an arm stretched along the line to its target) is left along the direction of most negative curvature. Where a limit
//! stands in the way, other starts are tried and the best end is kept.

mod ccd;
mod descent;
mod levenberg;
mod problem;
mod pseudo_inverse;
mod restart;
mod saddle;
#[cfg(test)]
mod tests;
mod transpose;

use super::skeleton::Skeleton;
use glam::DVec3;
use problem::{Problem, State};

/// Where a tip should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Which tip.
    pub tip: usize,
    /// Where, in the world.
    pub point: DVec3,
    /// Of its squared distance in the sum; at least 0.
    pub weight: f64,
    /// Where the tip should point ([`Skeleton::pointing`]); need not be unit, but not 0.
    pub toward: Option<DVec3>,
}

/// How the coordinates are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Down the gradient Jᵀe, by the length that is best for the linear model. Simple and slow.
    Transpose,
    /// By the pseudo-inverse of J from its singular values: Gauss and Newton's steps.
    PseudoInverse,
    /// Damped least squares: Levenberg's steps with second derivatives, damping that adapts, and an active set for the limits.
    DampedLeastSquares,
    /// Cyclic coordinate descent: joint by joint from the tip inward, each to its best.
    CyclicDescent,
}

impl Method {
    /// All of them, the default first.
    pub const ALL: [Method; 4] =
        [Method::DampedLeastSquares, Method::PseudoInverse, Method::Transpose, Method::CyclicDescent];
}

/// When to stop, and how to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How.
    pub method: Method,
    /// Most steps of one descent.
    pub iterations: usize,
    /// Distance of each tip from its point that is good enough, in scene units; for directions, in radians.
    pub tolerance: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { method: Method::DampedLeastSquares, iterations: 200, tolerance: 1e-9 }
    }
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// In the author's units, within the limits.
    pub coordinates: Vec<f64>,
    /// The largest distance of a tip from its point, in scene units. Goals of weight 0 do not count.
    pub residual: f64,
    /// The largest angle between a tip and where it should point, in radians; 0 where none is asked.
    pub turn: f64,
    /// Steps made, of all descents.
    pub iterations: usize,
    /// Whether both are within the tolerance.
    pub converged: bool,
    /// The coordinates that are held by a limit and would come nearer without it.
    pub binding: Vec<usize>,
    /// Largest slope of the sum that the limits leave, in units of the chain's length squared: 0 at a minimum (Karush, Kuhn and
    /// Tucker's condition).
    pub slope: f64,
    /// The largest change of a coordinate in a step, in radians, or chain lengths of a slide.
    pub largest_step: f64,
}

/// The coordinates nearest to the goals, from `start` on, which is clamped to the limits first. With no goals, the start. Goals and start
/// must be finite.
pub fn solve(skeleton: &Skeleton, goals: &[Goal], start: &[f64], settings: &Settings) -> Solution {
    let problem = Problem::new(skeleton, goals, start);
    let first = descent::descend(&problem, problem.state(problem.clamped(start)), settings);
    let best = restart::better(&problem, first, settings);
    solution(&problem, best, settings)
}

fn solution(problem: &Problem<'_>, run: descent::Run, settings: &Settings) -> Solution {
    let State { coordinates, .. } = &run.state;
    let gradient = problem.gradient(&run.state);
    let (residual, turn) = problem.distances(&run.state);
    let binding = problem.variables.iter().zip(&gradient).filter(|(v, g)| v.binds(coordinates, **g));
    Solution {
        binding: binding.map(|(variable, _)| variable.coordinate).collect(),
        slope: problem.slope(&run.state, &gradient),
        converged: residual <= settings.tolerance && turn <= settings.tolerance,
        residual,
        turn,
        iterations: run.iterations,
        largest_step: run.largest_step,
        coordinates: run.state.coordinates,
    }
}
