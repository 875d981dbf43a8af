//! Damped least squares: the step that makes r·Jδ + ½δᵀ(H + μI)δ least within the limits, H with the residuals' own curvature, so that it
//! converges quadratically at targets out of reach as well. μ grows until the matrix is positive and the step is no longer than a radian,
//! and shrinks as the model proves right (Levenberg 1944; Nielsen 1999 for the law of its change).

use super::descent::LONGEST_STEP;
use super::problem::{Problem, State, gradient_of};
use crate::math::error::UNIT_ROUNDOFF;
use crate::math::matrix::{Matrix, dot, solve_positive};

/// Most trials of μ in one step; each is four times the one before, so that these span all of f64's digits.
const TRIALS: usize = 60;

/// μ, and how it grows.
pub struct Damping {
    mu: f64,
}

/// A model of the sum around a state.
struct Model {
    gradient: Vec<f64>,
    hessian: Matrix,
    /// How far each unknown may change.
    room: Vec<(f64, f64)>,
    /// Held by a limit from the start.
    held: Vec<bool>,
}

impl Damping {
    /// μ = ½|r|² (Sugihara 2011): of the size of the curvature that the linear model leaves out.
    pub fn new(start: &State) -> Damping {
        Damping { mu: start.sum }
    }

    /// The next state: the sum is smaller, or the same to rounding with a smaller slope. None where no damping gives one.
    pub fn step(&mut self, problem: &Problem<'_>, state: &State) -> Option<State> {
        let model = Model::new(problem, state);
        let slope = problem.slope(state, &model.gradient);
        self.mu = self.mu.max(model.floor());
        for _ in 0..TRIALS {
            if let Some(change) = model.least(self.mu).filter(|change| is_short(change)) {
                let next = problem.step(state, &change);
                let hoped = model.decrease(&change);
                let gained = state.sum - next.sum;
                if gained > 0.0 && gained >= 1e-4 * hoped {
                    self.mu *= factor(gained / hoped);
                    return Some(next);
                }
                if is_rounding(gained, state.sum)
                    && problem.slope(&next, &problem.gradient(&next)) < 0.5 * slope
                {
                    self.mu *= 0.1;
                    return Some(next);
                }
            }
            self.mu *= 4.0;
        }
        None
    }
}

fn is_short(change: &[f64]) -> bool {
    change.iter().all(|c| c.abs() <= LONGEST_STEP)
}

/// Whether a change of the sum is no more than what its computation may be off by.
fn is_rounding(gained: f64, sum: f64) -> bool {
    gained.abs() <= 64.0 * UNIT_ROUNDOFF * sum
}

/// By what μ changes after a step that gained this share of what the model promised.
fn factor(ratio: f64) -> f64 {
    match ratio {
        r if r > 0.9 => 0.1,
        r if r > 0.5 => 0.4,
        r if r > 0.25 => 1.0,
        _ => 2.0,
    }
}

impl Model {
    fn new(problem: &Problem<'_>, state: &State) -> Model {
        let derivatives = problem.derivatives(state);
        let gradient = gradient_of(&derivatives, state);
        let hessian = problem.hessian(state, &derivatives);
        let room = problem.variables.iter().map(|v| v.room(&state.coordinates)).collect();
        let held =
            problem.variables.iter().zip(&gradient).map(|(v, g)| v.binds(&state.coordinates, *g)).collect();
        Model { gradient, hessian, room, held }
    }

    /// The least μ that means anything: the rounding of the matrix's entries.
    fn floor(&self) -> f64 {
        let n = self.gradient.len();
        let trace: f64 = (0..n).map(|i| self.hessian[(i, i)].abs()).sum();
        4.0 * n as f64 * UNIT_ROUNDOFF * trace + f64::MIN_POSITIVE
    }

    /// The change that makes the damped model least within the limits, found by holding those unknowns at their limits that a solution
    /// without would carry beyond. None where H + μI is not positive among the free ones.
    fn least(&self, mu: f64) -> Option<Vec<f64>> {
        let n = self.gradient.len();
        let mut change = vec![0.0; n];
        let mut held = self.held.clone();
        for _ in 0..=n {
            let free: Vec<usize> = (0..n).filter(|&i| !held[i]).collect();
            let pull = |i: usize| -> f64 {
                let others = (0..n).filter(|&j| held[j]).map(|j| self.hessian[(i, j)] * change[j]);
                -(self.gradient[i] + others.sum::<f64>())
            };
            let entry = |i: usize, j: usize| self.hessian[(free[i], free[j])] + if i == j { mu } else { 0.0 };
            let matrix = Matrix::from_fn(free.len(), free.len(), entry);
            let right: Vec<f64> = free.iter().map(|&i| pull(i)).collect();
            let solved = solve_positive(&matrix, &right)?;
            let mut beyond = false;
            for (&i, &c) in free.iter().zip(&solved) {
                let (down, up) = self.room[i];
                change[i] = c.clamp(down, up);
                held[i] = change[i] != c;
                beyond |= held[i];
            }
            if !beyond {
                return Some(change);
            }
        }
        Some(change)
    }

    /// By how much the undamped model promises that a change lowers the sum.
    fn decrease(&self, change: &[f64]) -> f64 {
        -(dot(&self.gradient, change) + 0.5 * dot(change, &self.hessian.times(change)))
    }
}
