//! The Jacobian's transpose: down the gradient, what limits hold left out, by the length that makes the linear model least (Wolovich &
//! Elliott 1984).

use super::problem::{Problem, State, gradient_of};
use glam::DVec3;

/// The change of each unknown; 0 where the gradient is.
pub fn change(problem: &Problem<'_>, state: &State) -> Vec<f64> {
    let derivatives = problem.derivatives(state);
    let mut gradient = gradient_of(&derivatives, state);
    for (v, g) in problem.variables.iter().zip(&mut gradient) {
        if v.binds(&state.coordinates, *g) {
            *g = 0.0;
        }
    }
    let square: f64 = gradient.iter().map(|g| g * g).sum();
    let image = |t: usize| -> DVec3 { derivatives.iter().zip(&gradient).map(|(row, g)| row[t] * *g).sum() };
    let curvature: f64 = (0..problem.terms.len()).map(|t| image(t).length_squared()).sum();
    let length = if curvature > 0.0 { square / curvature } else { 0.0 };
    gradient.iter().map(|g| -g * length).collect()
}
