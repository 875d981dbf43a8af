//! Leaves a place where the slope is 0 though the sum is not least: a stretched arm whose target is on its own line. The direction is the
//! eigenvector of the Hessian's most negative eigenvalue, the same on every machine.

use super::descent::shortened;
use super::problem::{Problem, State};
use crate::math::matrix::{Matrix, dot, singular};

/// How far the first trial goes along the direction, in unknowns: enough to be out of the flat part of the saddle.
const REACH: f64 = 0.5;

/// Curvature counts as negative below this share of the largest there may be: what rounding makes of 0 is far less.
const CURVED: f64 = 1e-10;

/// A slope that is as good as 0: a limit that holds against no more than this may be left.
const WEAK: f64 = 1e-9;

/// A state with a smaller sum on the way down from a saddle; none where the sum curves upward in all directions that the limits leave.
pub fn leave(problem: &Problem<'_>, state: &State) -> Option<State> {
    let derivatives = problem.derivatives(state);
    let gradient = super::problem::gradient_of(&derivatives, state);
    let holds =
        |k: usize| problem.variables[k].binds(&state.coordinates, gradient[k]) && gradient[k].abs() > WEAK;
    let free: Vec<usize> = (0..problem.variables.len()).filter(|&k| !holds(k)).collect();
    let whole = problem.hessian(state, &derivatives);
    let hessian = Matrix::from_fn(free.len(), free.len(), |i, j| whole[(free[i], free[j])]);
    let direction = most_negative(&hessian)?;
    let ways = [1.0, -1.0].map(|sign| allowed(problem, state, &free, &direction, sign));
    let curvature = |way: &Vec<f64>| dot(way, &whole.times(way));
    let mut ways: Vec<Vec<f64>> = ways.into_iter().filter(|way| curvature(way) < 0.0).collect();
    ways.sort_by(|a, b| curvature(a).total_cmp(&curvature(b)));
    ways.iter().find_map(|way| shortened(problem, state, way))
}

/// The unit eigenvector of the least eigenvalue, its largest component positive; none where that is not negative. H + ‖H‖·I has no
/// negative eigenvalue, so that its singular vectors are its eigenvectors.
fn most_negative(hessian: &Matrix) -> Option<Vec<f64>> {
    let n = hessian.columns();
    let size = (0..n).map(|j| dot(hessian.column(j), hessian.column(j))).sum::<f64>().sqrt();
    let shifted = Matrix::from_fn(n, n, |i, j| hessian[(i, j)] + if i == j { size } else { 0.0 });
    let parts = singular(&shifted);
    let direction = parts.v.column(n.checked_sub(1)?);
    let curvature = dot(direction, &hessian.times(direction));
    let largest =
        direction.iter().copied().fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most });
    (curvature < -CURVED * size).then(|| direction.iter().map(|x| x * largest.signum()).collect())
}

/// The direction one way or the other, of length [`REACH`], without what limits do not allow.
fn allowed(problem: &Problem<'_>, state: &State, free: &[usize], direction: &[f64], sign: f64) -> Vec<f64> {
    let mut way = vec![0.0; problem.variables.len()];
    for (&k, d) in free.iter().zip(direction) {
        let (down, up) = problem.variables[k].room(&state.coordinates);
        way[k] = (sign * REACH * d).clamp(down.min(0.0), up.max(0.0));
    }
    way
}
