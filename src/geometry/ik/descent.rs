//! One descent: steps of a method until the goals are reached, the sum is at a minimum, or the steps run out.

use super::problem::{Problem, State};
use super::{Method, Settings, ccd, levenberg, pseudo_inverse, saddle, transpose};

/// Where a descent ended.
pub struct Run {
    pub state: State,
    pub iterations: usize,
    pub largest_step: f64,
    pub end: End,
}

/// Why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Within the tolerance.
    Reached,
    /// At a minimum, or as near as rounding allows.
    Minimum,
    /// The steps ran out.
    Spent,
}

/// No unknown changes by more in one step: a radian, or the chain's length.
pub const LONGEST_STEP: f64 = 1.0;

/// A slope below this is rounding: the sum's terms are of the order of 1, and some tens of them are added. Where residuals are small, so
/// are slopes, and the tolerance decides.
const FLAT: f64 = 1e-14;

/// How often a step is halved before the method has nothing to offer: below, it is lost in rounding.
const HALVINGS: usize = 50;

enum Stepper {
    Transpose,
    PseudoInverse,
    Levenberg(levenberg::Damping),
    Cyclic,
}

impl Stepper {
    /// A state with a smaller sum, or none.
    fn step(&mut self, problem: &Problem<'_>, state: &State) -> Option<State> {
        match self {
            Stepper::Transpose => shortened(problem, state, &transpose::change(problem, state)),
            Stepper::PseudoInverse => {
                let changes = [pseudo_inverse::change(problem, state), transpose::change(problem, state)];
                let steps = changes.iter().filter_map(|change| shortened(problem, state, change));
                steps.min_by(|a, b| a.sum.total_cmp(&b.sum))
            }
            Stepper::Levenberg(damping) => damping.step(problem, state),
            Stepper::Cyclic => Some(ccd::sweep(problem, state)).filter(|next| next.sum < state.sum),
        }
    }
}

/// Goes down from a state.
pub fn descend(problem: &Problem<'_>, start: State, settings: &Settings) -> Run {
    let mut stepper = match settings.method {
        Method::Transpose => Stepper::Transpose,
        Method::PseudoInverse => Stepper::PseudoInverse,
        Method::DampedLeastSquares => Stepper::Levenberg(levenberg::Damping::new(&start)),
        Method::CyclicDescent => Stepper::Cyclic,
    };
    let mut run = Run { state: start, iterations: 0, largest_step: 0.0, end: End::Spent };
    while run.iterations < settings.iterations {
        let (distance, turn) = problem.distances(&run.state);
        if distance <= settings.tolerance && turn <= settings.tolerance {
            return Run { end: End::Reached, ..run };
        }
        let slope = problem.slope(&run.state, &problem.gradient(&run.state));
        let moving = (slope > FLAT).then(|| stepper.step(problem, &run.state)).flatten();
        let Some(next) = moving.or_else(|| saddle::leave(problem, &run.state)) else {
            return Run { end: End::Minimum, ..run };
        };
        run.largest_step = run.largest_step.max(largest_change(problem, &run.state, &next));
        run.state = next;
        run.iterations += 1;
    }
    run
}

fn largest_change(problem: &Problem<'_>, from: &State, to: &State) -> f64 {
    let change = |c: usize, unit: f64| (to.coordinates[c] - from.coordinates[c]).abs() / unit;
    problem.variables.iter().map(|v| change(v.coordinate, v.unit)).fold(0.0, f64::max)
}

/// A change scaled so that no unknown goes beyond [`LONGEST_STEP`].
pub fn capped(change: &[f64]) -> Vec<f64> {
    let largest = change.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let scale = if largest > LONGEST_STEP { LONGEST_STEP / largest } else { 1.0 };
    change.iter().map(|c| c * scale).collect()
}

/// The state after a change, or after the largest half, quarter, … of it that makes the sum smaller; none where none does.
pub fn shortened(problem: &Problem<'_>, state: &State, change: &[f64]) -> Option<State> {
    let mut change = capped(change);
    for _ in 0..HALVINGS {
        let next = problem.step(state, &change);
        if next.sum < state.sum {
            return Some(next);
        }
        change.iter_mut().for_each(|c| *c *= 0.5);
    }
    None
}
