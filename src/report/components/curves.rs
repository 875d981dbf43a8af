//! A cubic from its Bézier points, on the six families that pull the methods apart, in f64, and some in f32 with the
//! conversions it takes. Input: t and four points. Truth: double-double.

use super::{SEED, ulp};
use crate::geometry::curve::evaluate::{batch, double_double, magnitude};
use crate::geometry::curve::{Method, Piece};
use crate::math::Dd;
use crate::math::elementary::exp2;
use crate::math::error::UNIT_ROUNDOFF;
use crate::math::random::Random;
use crate::report::naive::curves as single;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use std::hint::black_box;

/// t, then four Bézier points.
type Input = [f64; 5];

struct Case {
    name: &'static str,
    unit: &'static str,
    bar: f64,
    draw: fn(&mut Random) -> Input,
    /// What an error is divided by; 0 where it must be 0.
    scale: fn(&Input) -> f64,
}

const CASES: [Case; 6] = [
    Case { name: "inside", unit: "ulp of max |P|", bar: 0.51, draw: inside, scale: |i| ulp(largest(i)) },
    Case { name: "end points", unit: "ulp of the end", bar: 0.0, draw: ends, scale: |i| ulp(value(i)) },
    Case { name: "near a triple root", unit: "u, relative", bar: 4.0, draw: triple, scale: relative },
    Case { name: "tiny tail", unit: "u, relative", bar: 4.0, draw: tail, scale: relative },
    Case {
        name: "large offset",
        unit: "ulp of the offset",
        bar: 0.51,
        draw: offset,
        scale: |i| ulp(largest(i)),
    },
    Case {
        name: "outside",
        unit: "u Σ|P||B|",
        bar: 8.0,
        draw: outside,
        scale: |i| UNIT_ROUNDOFF * magnitude(&points(i), i[0]),
    },
];

/// Trials of curve evaluation.
pub fn rows(plan: &Plan) -> Vec<Row> {
    CASES.iter().flat_map(|case| trial(plan, case)).collect()
}

fn trial(plan: &Plan, case: &Case) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs: Vec<Input> = (0..plan.inputs).map(|_| (case.draw)(&mut random)).collect();
    let subject = Subject {
        component: "cubic evaluation",
        case: case.name,
        unit: case.unit,
        work: "",
        bar: Some(case.bar),
    };
    let scale = case.scale;
    let judge = move |input: &Input, value: &f64| {
        let error = (Dd::from(*value) - double_double(&points(input), input[0])).value().abs();
        Verdict::error(error / scale(input))
    };
    let ts: Vec<f64> = inputs.iter().map(|i| i[0]).collect();
    let one = inputs.first().map_or([0.0; 4], points);
    let mut trial = Trial::new(plan, subject, inputs, judge);
    let mut methods = Methods { trial: &mut trial, ts: &ts, one };
    methods.run("horner", |p, t| Method::Horner.evaluate(p, t));
    methods.run("horner, f32", single::horner);
    methods.run("lerps a+t(b−a)", lerps);
    methods.run("bernstein", |p, t| Method::Bernstein.evaluate(p, t));
    methods.run("bernstein, f32", single::bernstein);
    methods.run("volk schumaker", |p, t| Method::VolkSchumaker.evaluate(p, t));
    methods.run("de casteljau", |p, t| Method::DeCasteljau.evaluate(p, t));
    methods.run("de casteljau, f32", single::de_casteljau);
    methods.run("offset", |p, t| Method::Offset.evaluate(p, t));
    methods.run("compensated", |p, t| Method::Compensated.evaluate(p, t));
    let (batch_ts, mut out) = (ts.clone(), vec![0.0; ts.len()]);
    let batched = move || {
        batch(black_box(&one), &batch_ts, &mut out);
        out.last().copied().unwrap_or(0.0)
    };
    trial.run_timed(variant("batched"), plan.inputs, |i| batch_of_one(&points(i), i[0]), batched);
    from_ends(&mut trial, &ts, one);
    trial.finish()
}

/// The default, whose coefficients a piece of curve makes once.
fn from_ends(trial: &mut Trial<'_, 5, f64>, ts: &[f64], one: [f64; 4]) {
    let why = "with compensated, it is the only one within the bars of all six sets";
    let label = default("from ends").note(why);
    let piece = Piece::new(0.0, 1.0, one.map(Dd::from));
    let all = ts.to_vec();
    let many = move || all.iter().map(|t| black_box(&piece).at(*t)).sum();
    trial.run_timed(label, ts.len(), |i| Method::DEFAULT.evaluate(&points(i), i[0]), many);
    trial.chain(label, ts.len(), chained(ts, move |t| black_box(&piece).at(t)));
}

/// Methods that start from points alone, timed on many curves, and in a chain on one.
struct Methods<'t, 'a> {
    trial: &'t mut Trial<'a, 5, f64>,
    ts: &'t [f64],
    one: [f64; 4],
}

impl<'a> Methods<'_, 'a> {
    fn run(&mut self, name: &'static str, method: impl Fn(&[f64; 4], f64) -> f64 + Copy + 'a) {
        let one = self.one;
        self.trial.run(variant(name), move |i| method(&points(i), i[0]));
        let chain = chained(self.ts, move |t| method(black_box(&one), t));
        self.trial.chain(variant(name), self.ts.len(), chain);
    }
}

/// Evaluations one after the other: each parameter waits for the value before it, of which it takes 0 times.
fn chained<F: Fn(f64) -> f64>(ts: &[f64], evaluate: F) -> impl FnMut() -> f64 + use<F> {
    let ts = ts.to_vec();
    move || ts.iter().fold(0.0, |before, t| evaluate(t + 0.0 * before))
}

fn points(input: &Input) -> [f64; 4] {
    [input[1], input[2], input[3], input[4]]
}

fn largest(input: &Input) -> f64 {
    input[1..].iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

fn value(input: &Input) -> f64 {
    double_double(&points(input), input[0]).value()
}

fn relative(input: &Input) -> f64 {
    UNIT_ROUNDOFF * value(input).abs()
}

fn batch_of_one(p: &[f64; 4], t: f64) -> f64 {
    let mut out = [0.0];
    batch(p, &[t], &mut out);
    out[0]
}

/// Repeated a + t(b − a): the last point is missed by what b − a loses.
fn lerps(p: &[f64; 4], t: f64) -> f64 {
    let lerp = |a: f64, b: f64| a + t * (b - a);
    let [a, b, c] = [lerp(p[0], p[1]), lerp(p[1], p[2]), lerp(p[2], p[3])];
    lerp(lerp(a, b), lerp(b, c))
}

fn inside(r: &mut Random) -> Input {
    let row = [0.0, 1.0, -1.0, 2.0];
    let p = if r.unit() < 0.5 { row } else { [(); 4].map(|()| r.between(-3.0, 3.0)) };
    [r.unit(), p[0], p[1], p[2], p[3]]
}

fn ends(r: &mut Random) -> Input {
    let mut big = || r.sign() * exp2(r.between(-60.0, 60.0));
    let p = [big(), big(), big(), big()];
    [if r.unit() < 0.25 { 0.0 } else { 1.0 }, p[0], p[1], p[2], p[3]]
}

/// s (t − k/16)³, at distances from the root between 10⁻⁵ and 1/16.
fn triple(r: &mut Random) -> Input {
    let root = (1.0 + 15.0 * r.unit()).floor() / 16.0;
    let (a, b, s) = (root, 1.0 - root, r.sign());
    let t = root + r.sign() * exp2(r.between(-16.6, -4.0));
    [t, -a * a * a * s, a * a * b * s, -a * b * b * s, b * b * b * s]
}

fn tail(r: &mut Random) -> Input {
    let tail = exp2(r.between(-120.0, -20.0));
    let step = exp2(r.between(-45.0, -5.0).floor());
    if r.unit() < 0.5 { [1.0 - step, 1.0, 0.0, 0.0, tail] } else { [step, tail, 0.0, 0.0, 1.0 + r.unit()] }
}

/// Gaps that are whole numbers, or not: which method is better turns with that.
fn offset(r: &mut Random) -> Input {
    let whole = r.unit() < 0.5;
    let origin = exp2(r.between(20.0, 40.0)).floor();
    let mut point = || {
        let gap = r.between(0.0, 4.0);
        origin + if whole { gap.floor() } else { gap }
    };
    let p = [point(), point(), point(), point()];
    [r.unit(), p[0], p[1], p[2], p[3]]
}

fn outside(r: &mut Random) -> Input {
    let mut point = || r.between(-3.0, 3.0);
    let p = [point(), point(), point(), point()];
    [r.between(-10.0, 10.0), p[0], p[1], p[2], p[3]]
}
