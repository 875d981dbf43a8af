//! The first zero of a function along a ray. Input: origin, direction, and the distance of the first hit, NaN for none. Truth: closed
//! forms, or the quartic along the ray. What the renderer does is the default: the cells of its octree are made once for a surface, and only what
//! a ray asks of the function is counted.

use super::SEED;
use super::spheres::line;
use super::tapes::{self, AlongTape, Squares, Tape};
use crate::math::Dd;
use crate::math::field::Field;
use crate::math::interval::Interval;
use crate::math::isolate::{Bounded, Zeros};
use crate::math::random::Random;
use crate::math::solve::roots_of;
use crate::report::naive::implicits::{halve_bounded, march};
use crate::report::naive::shapes::Line;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use crate::scene::SampledFunction;
use crate::world::shape::{Implicit, LocalRay};
use glam::DVec3;
use std::rc::Rc;
use std::sync::Arc;

type Input = [f64; 7];

/// How far rays are followed.
const FAR: f64 = 12.0;
/// Evaluations that the search for zeros may take.
const BUDGET: usize = 20_000;
/// Half the side of the box around each surface.
const BOX: f64 = 3.0;
/// Pieces narrower than this end the halving of naive intervals.
const NARROW: f64 = 1e-13;
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

const SURFACES: [Surface; 5] = [
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
        first: |line| first_root(line, &tangle_along(line), tangle_near),
    },
    Surface {
        case: "torus",
        bar: 1e-12,
        value: torus,
        bounds: torus_bounds,
        tape: tapes::torus,
        first: |line| first_root(line, &torus_along(line), torus_near),
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
    let mut trial = Trial::new(plan, subject, inputs, judge).in_chains(|(t, _)| t.unwrap_or(0.0));
    for (name, step) in [("steps of 0.1", 0.1), ("steps of 0.01", 0.01)] {
        trial.run(variant(name), move |i| {
            let line = line(i);
            march(|t| (surface.value)((line.origin + line.direction * t).to_array()), FAR, step)
        });
    }
    let naive = Rc::new((surface.tape)(Squares::Products));
    trial.run(variant("intervals halved, x·x"), move |i| {
        let along = AlongTape::by_intervals(&naive, surface.value, line(i));
        halve_bounded(|t| along.bounds(t).0, FAR, NARROW, BUDGET)
    });
    trial.run(variant("intervals and slopes, by hand"), move |i| {
        first_zero(&Along { line: line(i), surface })
    });
    let field = Rc::new((surface.tape)(Squares::Known));
    let shared = Rc::clone(&field);
    trial.run(variant("intervals and slopes"), move |i| {
        first_zero(&AlongTape::by_intervals(&shared, surface.value, line(i)))
    });
    let shared = Rc::clone(&field);
    trial.run(variant("linear forms"), move |i| {
        first_zero(&AlongTape::by_forms(&shared, surface.value, line(i)))
    });
    let function = Arc::new(SampledFunction::of_point(Field::clone(&field)));
    let shape = Rc::new(Implicit::new(function, DVec3::splat(-BOX), DVec3::splat(BOX), None));
    let why = "the fastest that misses nothing; its cells, made once for a surface, are not counted";
    trial.run(default("cells, then forms").note(why), move |i| as_drawn(&shape, &line(i)));
    trial.finish()
}

/// The first zero, and how often the function was evaluated or bounded.
fn first_zero(along: &impl Bounded) -> (Option<f64>, usize) {
    let mut zeros = Zeros::new(along, 0.0, FAR, BUDGET);
    let first = zeros.next().map(|zero| zero.t);
    (first, zeros.evaluations())
}

/// As the renderer finds it.
fn as_drawn(shape: &Implicit, line: &Line) -> (Option<f64>, usize) {
    let Some((ray, scale)) = LocalRay::new(line.origin, line.direction) else { return (None, 0) };
    let (meet, evaluations) = shape.meet_counting(&ray, f64::MAX);
    (meet.map(|meet| meet.t / scale), evaluations as usize)
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
    loop {
        let mut vector = || DVec3::new(r.between(-1.0, 1.0), r.between(-1.0, 1.0), r.between(-1.0, 1.0));
        let origin = vector().normalize() * 5.0;
        let toward = (vector() * 0.5 - origin).normalize();
        let line = Line { origin, direction: toward };
        let t = (surface.first)(&line).unwrap_or(f64::NAN);
        if surface.case != "torus" || !is_grazing(&line, t) {
            return [origin.x, origin.y, origin.z, toward.x, toward.y, toward.z, t];
        }
    }
}

/// Whether a line all but touches the torus where it meets it, or comes near without meeting it.
fn is_grazing(line: &Line, t: f64) -> bool {
    let at = |t: f64| torus((line.origin + line.direction * t).to_array());
    if t.is_nan() {
        return (0..=240).any(|k| at(f64::from(k) * 0.05) < 0.05);
    }
    let (before, after) = (at(t - 1e-4), at(t + 1e-4));
    before - after < 1e-4
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

/// R² − r² of the torus of [`tapes::torus`].
const TORUS: f64 = 1.0 - 0.4 * 0.4;

fn torus([x, y, z]: [f64; 3]) -> f64 {
    let inner = (x * x + y * y + z * z) + TORUS;
    inner * inner - 4.0 * (x * x + y * y)
}

fn torus_bounds(p: [Interval; 3]) -> (Interval, [Interval; 3]) {
    let [x, y, z] = p.map(Interval::square);
    let inner = x + y + z + number(TORUS);
    let value = inner.square() - number(4.0) * (x + y);
    let steep = |i: usize| if i < 2 { inner - number(2.0) } else { inner };
    (value, std::array::from_fn(|i| number(4.0) * p[i] * steep(i)))
}

/// A function near a place on a line in double-double, and its slope there.
type Near = fn([Dd<f64>; 3], [f64; 3]) -> (Dd<f64>, f64);

/// The first root of a quartic along a ray, by Newton's steps in double-double: its coefficients were rounded.
fn first_root(line: &Line, quartic: &[f64; 5], near: Near) -> Option<f64> {
    let guess = roots_of(quartic).iter().copied().find(|t| (0.0..FAR).contains(t))?;
    let (o, d) = (line.origin.to_array(), line.direction.to_array());
    let mut t = Dd::from(guess);
    for _ in 0..3 {
        let (value, slope) = near([0, 1, 2].map(|i| Dd::from(o[i]) + t.scaled(d[i])), d);
        t = t - Dd::from(value.value() / slope);
    }
    Some(t.value())
}

fn tangle_near(p: [Dd<f64>; 3], d: [f64; 3]) -> (Dd<f64>, f64) {
    let mut value = Dd::from(11.8);
    let mut slope = 0.0;
    for i in 0..3 {
        let square = p[i].times(p[i]);
        value = value + square.times(square - Dd::from(5.0));
        slope += d[i] * p[i].value() * (4.0 * square.value() - 10.0);
    }
    (value, slope)
}

fn torus_near(p: [Dd<f64>; 3], d: [f64; 3]) -> (Dd<f64>, f64) {
    let [x, y, z] = p.map(|x| x.times(x));
    let inner = x + y + z + Dd::from(TORUS);
    let value = inner.times(inner) - (x + y).scaled(4.0);
    let at = |i: usize| d[i] * p[i].value();
    let slope = 4.0 * inner.value() * (at(0) + at(1) + at(2)) - 8.0 * (at(0) + at(1));
    (value, slope)
}

fn tangle_along(line: &Line) -> [f64; 5] {
    let mut c = [11.8, 0.0, 0.0, 0.0, 0.0];
    for i in 0..3 {
        let (o, d) = (line.origin[i], line.direction[i]);
        let (oo, dd) = (o * o, d * d);
        let quartic = [oo * oo, 4.0 * oo * o * d, 6.0 * oo * dd, 4.0 * o * d * dd, dd * dd];
        let square = [oo, 2.0 * o * d, dd, 0.0, 0.0];
        (0..5).for_each(|k| c[k] += quartic[k] - 5.0 * square[k]);
    }
    c
}

fn torus_along(line: &Line) -> [f64; 5] {
    let square = |o: DVec3, d: DVec3| [o.dot(o), 2.0 * o.dot(d), d.dot(d)];
    let flat = DVec3::new(1.0, 1.0, 0.0);
    let ([c, b, a], around) =
        (square(line.origin, line.direction), square(line.origin * flat, line.direction * flat));
    let c = c + TORUS;
    let squared = [c * c, 2.0 * b * c, b * b + 2.0 * a * c, 2.0 * a * b, a * a];
    std::array::from_fn(|k| squared[k] - 4.0 * around.get(k).copied().unwrap_or(0.0))
}
