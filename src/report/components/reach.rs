//! Inverse kinematics of plane chains. Input: the target, then the first three angles, degrees (of the long chain all others are 10).
//! Truth: a chain reaches every distance from its longest link less the others, or 0, to the sum of all.

use super::SEED;
use crate::geometry::ik::{Goal, Method, Settings, solve};
use crate::geometry::skeleton::{Freedom, Limits, Skeleton};
use crate::math::elementary::sin_cos;
use crate::math::random::Random;
use crate::report::naive::reach::damped;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use glam::DVec3;
use std::f64::consts::TAU;

type Input = [f64; 5];

/// The distance left, and the steps made.
type Reached = (f64, usize);

/// A chain that ends farther from the best than this share of its length has stalled.
const STALLED: f64 = 1e-3;

struct Case {
    name: &'static str,
    lengths: &'static [f64],
    draw: fn(&mut Random) -> Input,
}

const CASES: [Case; 6] = [
    Case { name: "within reach", lengths: &[5.0, 4.0, 2.0], draw: |r| anywhere(r, 0.5, 10.5) },
    Case { name: "out of reach", lengths: &[1.0, 1.0], draw: |r| anywhere(r, 2.01, 6.0) },
    Case { name: "at the end of its reach", lengths: &[1.0, 1.0], draw: at_the_end },
    Case {
        name: "stretched toward it",
        lengths: &[1.0, 1.0, 0.5],
        draw: |r| [r.between(-2.0, 2.0), 0.0, 0.0, 0.0, 0.0],
    },
    Case { name: "folded", lengths: &[3.0, 1.0], draw: |r| anywhere(r, 0.1, 1.9) },
    Case { name: "twenty joints", lengths: &[1.0; 20], draw: |r| anywhere(r, 0.0, 19.5) },
];

/// Trials of reaching.
pub fn rows(plan: &Plan) -> Vec<Row> {
    CASES.iter().flat_map(|case| trial(plan, case)).collect()
}

fn anywhere(r: &mut Random, least: f64, most: f64) -> Input {
    let (s, c) = sin_cos(r.between(0.0, TAU));
    let distance = r.between(least, most);
    let mut angle = || r.between(-150.0, 150.0);
    [distance * c, distance * s, angle(), angle(), angle()]
}

/// On the circle that two links of length 1 just reach, or up to 10⁻¹² … 10⁻⁴ inside it.
fn at_the_end(r: &mut Random) -> Input {
    let inside = [0.0, 1e-12, 1e-9, 1e-6, 1e-4][r.below(5)];
    anywhere(r, 2.0 - inside, 2.0 - inside)
}

fn chain(lengths: &[f64]) -> Skeleton {
    let mut chain = Skeleton::default();
    let (mut parent, mut offset) = (None, 0.0);
    for length in lengths {
        let hinge = Freedom::Hinge(DVec3::Z);
        parent = Some(chain.add_joint("", parent, DVec3::X * offset, hinge, &[0.0], &[Limits::NONE]));
        offset = *length;
    }
    chain.add_tip("", lengths.len() - 1, DVec3::X * offset);
    chain
}

fn target(input: &Input) -> DVec3 {
    DVec3::new(input[0], input[1], 0.0)
}

fn start(input: &Input, n: usize) -> Vec<f64> {
    (0..n).map(|k| input.get(2 + k).copied().unwrap_or(10.0)).collect()
}

/// The distance that is left at best.
fn best(lengths: &[f64], input: &Input) -> f64 {
    let (sum, longest) = (lengths.iter().sum::<f64>(), lengths.iter().copied().fold(0.0, f64::max));
    let distance = target(input).length();
    (distance - sum).max((2.0 * longest - sum) - distance).max(0.0)
}

fn trial(plan: &Plan, case: &'static Case) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs = (0..plan.inputs.min(500)).map(|_| (case.draw)(&mut random)).collect();
    let subject = Subject {
        component: "reach",
        case: case.name,
        unit: "of the length",
        work: "steps",
        bar: Some(1e-9),
    };
    let length: f64 = case.lengths.iter().sum();
    let judge = move |input: &Input, (left, steps): &Reached| {
        let error = ((left - best(case.lengths, input)) / length).max(0.0);
        let stalled = usize::from(!(error <= STALLED));
        Verdict { missed: stalled, work: *steps as f64, ..Verdict::error(error) }
    };
    let mut trial = Trial::new(plan, subject, inputs, judge);
    let n = case.lengths.len();
    for (name, damping) in [("plain pseudo-inverse", 0.0), ("damping 0.1", 0.1)] {
        let chain = chain(case.lengths);
        trial.run(variant(name), move |i| damped(&chain, &start(i, n), target(i), damping));
    }
    for (label, method) in [
        (variant("transpose"), Method::Transpose),
        (variant("pseudo-inverse"), Method::PseudoInverse),
        (variant("cyclic descent"), Method::CyclicDescent),
        (
            default("damped, exact curvature").note("no other one arrives on all sets"),
            Method::DampedLeastSquares,
        ),
    ] {
        let chain = chain(case.lengths);
        trial.run(label, move |i| reached(&chain, &start(i, n), target(i), method));
    }
    trial.finish()
}

fn reached(chain: &Skeleton, start: &[f64], point: DVec3, method: Method) -> Reached {
    let goal = Goal { tip: 0, point, weight: 1.0, toward: None };
    let found = solve(chain, &[goal], start, &Settings { method, tolerance: 1e-12, ..Settings::default() });
    (found.residual, found.iterations)
}
