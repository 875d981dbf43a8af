//! Other starts, for where a descent ends short of its goals: limits make minima that are not the least. The end of the first descent is
//! kept unless another is clearly better, so that a motion does not jump between poses that are equally near.

use super::Settings;
use super::descent::{End, Run, descend};
use super::problem::{Problem, State, Term, Variable};
use crate::geometry::skeleton::{Limits, Turning};
use crate::math::random::Random;

/// How many other starts: the rest pose, the middle of the limits, and some at random. Of 300 random limited chains with a target they
/// can reach, one descent leaves 37 short of it, 4 more starts 3, and these none.
const STARTS: usize = 12;

/// Another end is better when its sum is below this share of the first's.
const CLEARLY: f64 = 1.0 - 1e-6;

/// So many other starts that come to the same end, of a chain without limits, are taken to say that there is no better one. (The first two
/// may be one start: a rest pose of angles 0.)
const AGREED: usize = 3;

/// The best of this descent and of others from elsewhere.
pub fn better(problem: &Problem<'_>, first: Run, settings: &Settings) -> Run {
    if first.end != End::Minimum || first.state.sum <= bound(problem, &first.state) {
        return first;
    }
    let mut best = first;
    let mut random = Random::new(0);
    let mut agreed = 0;
    for k in 0..STARTS {
        let start = problem.state(start(problem, &best.state, k, &mut random));
        let run = descend(problem, start, settings);
        let iterations = best.iterations + run.iterations;
        let largest_step = best.largest_step.max(run.largest_step);
        let wins = run.state.sum < CLEARLY * best.state.sum;
        let agrees = !wins && CLEARLY * run.state.sum <= best.state.sum;
        agreed = if wins { 0 } else { agreed + usize::from(agrees) };
        best = Run { iterations, largest_step, ..if wins { run } else { best } };
        if best.end == End::Reached || (agreed >= AGREED && is_free(problem)) {
            break;
        }
    }
    best
}

/// Whether nothing has limits: those make minima that are not the least, and many starts may end there.
fn is_free(problem: &Problem<'_>) -> bool {
    problem.variables.iter().all(|v| v.limits == Limits::NONE)
}

fn start(problem: &Problem<'_>, state: &State, k: usize, random: &mut Random) -> Vec<f64> {
    let mut coordinates = state.coordinates.clone();
    for v in &problem.variables {
        let value = match k {
            0 => problem.skeleton.rest()[v.coordinate],
            1 => middle(v),
            _ => anywhere(v, random),
        };
        coordinates[v.coordinate] = value.clamp(v.limits.low, v.limits.high);
    }
    coordinates
}

fn middle(v: &Variable) -> f64 {
    let middle = 0.5 * (v.limits.low + v.limits.high);
    if middle.is_finite() { middle } else { 0.0 }
}

fn anywhere(v: &Variable, random: &mut Random) -> f64 {
    let most = match v.turning {
        Turning::Turn => 180.0,
        Turning::Move => v.unit,
    };
    random.between(v.limits.low.max(-most), v.limits.high.min(most))
}

/// A sum that no pose is below, for one goal of a chain whose base is fixed: the distance beyond the stretched chain, or within the hole that
/// a link longer than all others leaves. 0 where this says nothing. A slack in the last digits lets such a chain be at its bound.
fn bound(problem: &Problem<'_>, state: &State) -> f64 {
    let ([term], Some(first)) = (&*problem.terms, problem.variables.first()) else { return 0.0 };
    if problem.variables.iter().any(|v| v.turning == Turning::Move) {
        return 0.0;
    }
    let base = state.placement.screws[first.motion].pivot / problem.length;
    let distance = (term.target - base).length();
    let links = links(problem, term);
    let (sum, longest) = (links.iter().sum::<f64>(), links.iter().copied().fold(0.0, f64::max));
    let beyond = (distance - sum).max((2.0 * longest - sum) - distance);
    if beyond > 0.0 { 0.5 * square(term.weight * beyond * (1.0 + 1e-9)) } else { 0.0 }
}

fn square(x: f64) -> f64 {
    x * x
}

/// The lengths from the first joint that turns to the next, and so on to the tip, over L.
fn links(problem: &Problem<'_>, term: &Term) -> Vec<f64> {
    let joints = problem.skeleton.joints();
    let chain = problem.skeleton.chain(term.joint);
    let turning = chain.iter().position(|&joint| !joints[joint].coordinates().is_empty());
    let inner = chain.iter().skip(turning.map_or(chain.len(), |first| first + 1));
    inner.map(|&joint| joints[joint].offset.length() / problem.length).chain([term.local.length()]).collect()
}
