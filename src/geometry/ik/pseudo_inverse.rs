//! Gauss and Newton's step −J⁺r, J⁺ from the singular values of J, what limits hold left out. At a
//! target out of reach it turns across the gradient; [`super::descent`] then goes down the gradient instead.

use super::problem::{Problem, State, gradient_of};
use crate::math::matrix::{Matrix, singular};

/// Singular values below this share of the largest count as 0: what is left of a rank that rounding has made, with room for a chain
/// that is straight to a few digits less than all.
const RANK: f64 = 1e-12;

/// The change of each unknown.
pub fn change(problem: &Problem<'_>, state: &State) -> Vec<f64> {
    let derivatives = problem.derivatives(state);
    let gradient = gradient_of(&derivatives, state);
    let binds: Vec<bool> =
        problem.variables.iter().zip(&gradient).map(|(v, g)| v.binds(&state.coordinates, *g)).collect();
    let entry = |i: usize, j: usize| if binds[j] { 0.0 } else { derivatives[j][i / 3][i % 3] };
    let jacobian = Matrix::from_fn(3 * problem.terms.len(), problem.variables.len(), entry);
    let parts = singular(&jacobian);
    let residual: Vec<f64> = state.residuals.iter().flat_map(|r| r.to_array()).collect();
    let along = parts.u.transpose_times(&residual);
    let least = RANK * parts.values.first().copied().unwrap_or(0.0);
    let scaled: Vec<f64> =
        along.iter().zip(&parts.values).map(|(a, s)| if *s > least { -a / s } else { 0.0 }).collect();
    parts.v.times(&scaled)
}
