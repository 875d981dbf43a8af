//! The first zero of a function along a ray. Input: origin, direction, and the distance of the first hit, NaN for none. Truth: closed
//! forms, or the quartic along the ray.

use super::SEED;
use super::spheres::line;
use super::tapes::{self, AlongTape, Squares, Tape};
use crate::math::Dd;
use crate::math::interval::Interval;
use crate::math::isolate::{Bounded, Zeros};
use crate::math::random::Random;
use crate::math::solve::roots_of;
use crate::report::naive::implicits::march;
use crate::report::naive::shapes::Line;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use glam::DVec3;
use std::rc::Rc;

type Input = [f64; 7];

/// How far rays are followed.
const FAR: f64 = 12.0;
/// Evaluations that the search for zeros may take.
const BUDGET: usize = 20_000;
/// A hit farther from the truth is another hit.
const ANOTHER: f64 = 1e-2;

/// A function of space by its value and, over intervals, its value and gradient.
#[derive(Clone, Copy)]
struct Surface {
    case: &'static str,
    bar: f64,
    value: fn([f64; 3]) -> f64,
    bounds: fn([Interval; 3]) -> (Interval, [Interval; 3]),
    tape: Tape,
    first: fn(&Line) -> Option<f64>,
}

const SURFACES: [Surface; 4] = [
    Surface {
        case: "sphere",
        bar: 1e-12,
        value: sphere,
        bounds: sphere_bounds,
        tape: tapes::sphere,
        first: |l| first_of_radius(l, 1.0),
    },
    Surface {
        case: "squared sphere",
        bar: 1e-6,
        value: squared,
        bounds: squared_bounds,
        tape: |squares| tapes::shell(squares, 0.0),
        first: |l| first_of_radius(l, 1.0),
    },
    Surface {
        case: "thin shell",
        bar: 1e-11,
        value: shell,
        bounds: shell_bounds,
        tape: |squares| tapes::shell(squares, THICKNESS),
        first: |l| first_of_radius(l, 1.0 + THICKNESS),
    },
    Surface {
        case: "tanglecube",
        bar: 1e-12,
        value: tangle,
        bounds: tangle_bounds,
        tape: tapes::tangle,
        first: first_of_tangle,
    },
];

/// Trials of implicit surfaces.
pub fn rows(plan: &Plan) -> Vec<Row> {
    SURFACES.iter().flat_map(|surface| trial(plan, *surface)).collect()
}

fn trial(plan: &Plan, surface: Surface) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs = (0..plan.inputs.min(2000)).map(|_| draw(&mut random, &surface)).collect();
    let subject = Subject {
        component: "implicit surface",
        case: surface.case,
        unit: "absolute",
        work: "evaluations",
        bar: Some(surface.bar),
    };
    let mut trial = Trial::new(plan, subject, inputs, judge);
    for (name, step) in [("steps of 0.1", 0.1), ("steps of 0.01", 0.01)] {
        trial.run(variant(name), move |i| {
            let line = line(i);
            march(|t| (surface.value)((line.origin + line.direction * t).to_array()), FAR, step)
        });
    }
    trial.run(default("intervals").note("steps miss what is thin or touches"), move |i| {
        first_zero(&Along { line: line(i), surface })
    });
    for (name, squares) in [("intervals, as written", Squares::Known), ("intervals, x·x", Squares::Products)]
    {
        let field = Rc::new((surface.tape)(squares));
        trial.run(variant(name), move |i| {
            first_zero(&AlongTape::by_intervals(&field, surface.value, line(i)))
        });
    }
    let field = Rc::new((surface.tape)(Squares::Known));
    trial.run(variant("linear forms, as written"), move |i| {
        first_zero(&AlongTape::by_forms(&field, surface.value, line(i)))
    });
    trial.finish()
}

/// The first zero, and how often the function was evaluated or bounded.
fn first_zero(along: &impl Bounded) -> (Option<f64>, usize) {
    let mut zeros = Zeros::new(along, 0.0, FAR, BUDGET);
    let first = zeros.next().map(|zero| zero.t);
    (first, zeros.evaluations())
}

fn judge(i: &Input, (found, evaluations): &(Option<f64>, usize)) -> Verdict {
    let truth = i[6];
    let verdict = match found {
        None => Verdict { missed: usize::from(!truth.is_nan()), ..Verdict::default() },
        Some(t) if !((t - truth).abs() <= ANOTHER) => Verdict { spurious: 1, ..Verdict::default() },
        Some(t) => Verdict::error((t - truth).abs()),
    };
    Verdict { work: *evaluations as f64, ..verdict }
}

/// From 5 away toward a point within 1.1 of the middle, and never nearly tangent, where a closed form would be as much in doubt.
fn draw(r: &mut Random, surface: &Surface) -> Input {
    let mut vector = || DVec3::new(r.between(-1.0, 1.0), r.between(-1.0, 1.0), r.between(-1.0, 1.0));
    let origin = vector().normalize() * 5.0;
    let toward = (vector() * 0.5 - origin).normalize();
    let t = (surface.first)(&Line { origin, direction: toward }).unwrap_or(f64::NAN);
    [origin.x, origin.y, origin.z, toward.x, toward.y, toward.z, t]
}

/// A surface along a ray.
struct Along {
    line: Line,
    surface: Surface,
}

impl Bounded for Along {
    fn value(&self, t: f64) -> f64 {
        (self.surface.value)((self.line.origin + self.line.direction * t).to_array())
    }

    fn bounds(&self, t: Interval) -> (Interval, Interval) {
        let (o, d) = (self.line.origin.to_array(), self.line.direction.to_array());
        let p = std::array::from_fn(|i| Interval::point(o[i]) + Interval::point(d[i]) * t);
        let (value, gradient) = (self.surface.bounds)(p);
        let along = |i: usize| Interval::point(d[i]) * gradient[i];
        (value, along(0) + along(1) + along(2))
    }
}

/// |p|² = 1 ± this are the sides of the shell.
const THICKNESS: f64 = 1e-4;

fn sphere([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z) - 1.0
}

fn squared(p: [f64; 3]) -> f64 {
    sphere(p) * sphere(p)
}

fn shell(p: [f64; 3]) -> f64 {
    squared(p) - THICKNESS * THICKNESS
}

fn tangle(p: [f64; 3]) -> f64 {
    p.iter().map(|x| (x * x) * (x * x - 5.0)).sum::<f64>() + 11.8
}

fn number(x: f64) -> Interval {
    Interval::point(x)
}

fn sphere_bounds(p: [Interval; 3]) -> (Interval, [Interval; 3]) {
    let value = p[0].square() + p[1].square() + p[2].square() - number(1.0);
    (value, p.map(|x| number(2.0) * x))
}

fn squared_bounds(p: [Interval; 3]) -> (Interval, [Interval; 3]) {
    let (f, gradient) = sphere_bounds(p);
    (f.square(), gradient.map(|g| number(2.0) * f * g))
}

fn shell_bounds(p: [Interval; 3]) -> (Interval, [Interval; 3]) {
    let (f, gradient) = squared_bounds(p);
    (f - number(THICKNESS * THICKNESS), gradient)
}

fn tangle_bounds(p: [Interval; 3]) -> (Interval, [Interval; 3]) {
    // x⁴ − 5x² = (x² − 5/2)² − 25/4, each variable once.
    let term = |x: Interval| (x.square() - number(2.5)).square() - number(6.25);
    let value = term(p[0]) + term(p[1]) + term(p[2]) + number(11.8);
    (value, p.map(|x| x * (number(4.0) * x.square() - number(10.0))))
}

/// |o + td|² = square, unit d.
fn first_of_radius(line: &Line, square: f64) -> Option<f64> {
    let Line { origin: o, direction: d } = line;
    let a = d.length_squared();
    let foot = -o.dot(*d) / a;
    let room = square - (*o + *d * foot).length_squared();
    (room > 0.0).then(|| foot - (room / a).sqrt())
}

/// A root of the tanglecube along a ray by Newton's steps in double-double: the coefficients of the quartic were rounded.
fn refined(line: &Line, guess: f64) -> f64 {
    let (o, d) = (line.origin.to_array(), line.direction.to_array());
    let mut t = Dd::from(guess);
    for _ in 0..3 {
        let mut value = Dd::from(11.8);
        let mut slope = 0.0;
        for i in 0..3 {
            let x = Dd::from(o[i]) + t.scaled(d[i]);
            let square = x.times(x);
            value = value + square.times(square - Dd::from(5.0));
            slope += d[i] * x.value() * (4.0 * square.value() - 10.0);
        }
        t = t - Dd::from(value.value() / slope);
    }
    t.value()
}

fn first_of_tangle(line: &Line) -> Option<f64> {
    let mut c = [11.8, 0.0, 0.0, 0.0, 0.0];
    for i in 0..3 {
        let (o, d) = (line.origin[i], line.direction[i]);
        let (oo, dd) = (o * o, d * d);
        let quartic = [oo * oo, 4.0 * oo * o * d, 6.0 * oo * dd, 4.0 * o * d * dd, dd * dd];
        let square = [oo, 2.0 * o * d, dd, 0.0, 0.0];
        (0..5).for_each(|k| c[k] += quartic[k] - 5.0 * square[k]);
    }
    roots_of(&c).iter().copied().find(|t| (0.0..FAR).contains(t)).map(|t| refined(line, t))
}
