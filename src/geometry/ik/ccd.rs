//! Cyclic coordinate descent: from the innermost unknown outward, each goes to where the sum is least with all others held. For a turn by
//! θ the sum is a constant − A·cos θ − B·sin θ, for a move a parabola: no step length, no derivative (Wang & Chen 1991).

use super::descent::LONGEST_STEP;
use super::problem::{Problem, State, Variable};
use crate::geometry::skeleton::Turning;
use crate::math::elementary::{atan2, sin_cos};
use std::f64::consts::TAU;

/// One round over all unknowns.
pub fn sweep(problem: &Problem<'_>, state: &State) -> State {
    let mut state = state.clone();
    for (k, v) in problem.variables.iter().enumerate().rev() {
        let change = best_change(problem, &state, k, v);
        let mut coordinates = state.coordinates.clone();
        coordinates[v.coordinate] = v.moved(coordinates[v.coordinate], change);
        let next = problem.state(coordinates);
        if next.sum < state.sum {
            state = next;
        }
    }
    state
}

/// The change of one unknown, within its limits and the longest step.
fn best_change(problem: &Problem<'_>, state: &State, k: usize, v: &Variable) -> f64 {
    let (down, up) = v.room(&state.coordinates);
    let (down, up) = (down.clamp(-LONGEST_STEP, 0.0), up.clamp(0.0, LONGEST_STEP));
    match v.turning {
        Turning::Move => slide(problem, state, k, v).clamp(down, up),
        Turning::Turn => {
            let (cosine, sine) = swing(problem, state, k, v);
            let gain = |angle: f64| {
                let (s, c) = sin_cos(angle);
                cosine * c + sine * s
            };
            let best = if cosine == 0.0 && sine == 0.0 { 0.0 } else { atan2(sine, cosine) };
            let inside = [best - TAU, best, best + TAU].into_iter().find(|angle| (down..=up).contains(angle));
            inside.unwrap_or(if gain(down) > gain(up) { down } else { up })
        }
    }
}

/// A and B of a turn.
fn swing(problem: &Problem<'_>, state: &State, k: usize, v: &Variable) -> (f64, f64) {
    let screw = state.placement.screws[v.motion];
    let mut sums = (0.0, 0.0);
    for (term, value) in problem.terms.iter().zip(&state.values).filter(|(term, _)| term.moved[k]) {
        let pivot = if term.is_point { screw.pivot / problem.length } else { glam::DVec3::ZERO };
        let (from, to) = (*value - pivot, term.target - pivot);
        let across = |v: glam::DVec3| v - screw.axis * screw.axis.dot(v);
        let weight = term.weight * term.weight;
        sums.0 += weight * across(from).dot(across(to));
        sums.1 += weight * screw.axis.dot(from.cross(to));
    }
    sums
}

/// The weighted mean of what is missing along a move.
fn slide(problem: &Problem<'_>, state: &State, k: usize, v: &Variable) -> f64 {
    let axis = state.placement.screws[v.motion].axis;
    let moved = || problem.terms.iter().zip(&state.values).filter(|(term, _)| term.moved[k]);
    let weights: f64 = moved().map(|(term, _)| term.weight * term.weight).sum();
    let missing = |(term, value): (&super::problem::Term, &glam::DVec3)| {
        term.weight * term.weight * axis.dot(term.target - *value)
    };
    if weights > 0.0 { moved().map(missing).sum::<f64>() / weights } else { 0.0 }
}
