//! A ray against a sphere around 0. Input: origin, direction, radius. Truth: the foot of the perpendicular and the chord in
//! double-double.

use super::{SEED, ulp};
use crate::math::elementary::exp2;
use crate::math::random::Random;
use crate::math::{Dd, Point};
use crate::report::naive::shapes::{self as naive, Line};
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use crate::world::shape::{LocalRay, Shape, Sphere};
use glam::DVec3;

type Input = [f64; 7];
type Draw = fn(&mut Random) -> Input;

/// Name, bar in ulp of t, and how to draw an input.
const CASES: [(&str, f64, Draw); 5] = [
    ("near", 64.0, near),
    ("from 10⁸ radii", 1.0, far),
    ("grazing", 4.0, grazing),
    // 2·10⁻⁹ of t: what the rounding of c = |f|² − r² may cost.
    ("above a planet", 9e6, planet),
    ("direction of any length", 64.0, any_length),
];

/// Trials of ray and sphere.
pub fn rows(plan: &Plan) -> Vec<Row> {
    CASES.iter().flat_map(|(case, bar, draw)| trial(plan, case, *bar, *draw)).collect()
}

fn trial(plan: &Plan, case: &'static str, bar: f64, draw: fn(&mut Random) -> Input) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs: Vec<Input> = (0..plan.inputs).map(|_| draw(&mut random)).collect();
    let subject = Subject { component: "ray and sphere", case, unit: "ulp of t", work: "", bar: Some(bar) };
    let mut trial = Trial::new(plan, subject, inputs, judge).in_chains(|t| t.unwrap_or(0.0));
    trial.run(variant("b²−4ac"), |i| naive::sphere_quadratic(&line(i), i[6]));
    trial.run(variant("foot and chord"), |i| naive::sphere_geometric(&line(i), i[6]));
    trial.run(variant("haines"), |i| naive::sphere_haines(&line(i), i[6]));
    let why = "it alone is within the bars of all sets";
    trial.run(default("factored, precise afar").note(why), ours);
    trial.finish()
}

/// The ray of the first six numbers of an input.
pub fn line(input: &[f64]) -> Line {
    let v = |i: usize| DVec3::new(input[i], input[i + 1], input[i + 2]);
    Line { origin: v(0), direction: v(3) }
}

fn ours(input: &Input) -> Option<f64> {
    meet(&Shape::Sphere(Sphere { center: DVec3::ZERO, radius: input[6] }), &line(input))
}

/// The distance at which the renderer's own shape is met, in units of the line's direction.
pub fn meet(shape: &Shape, line: &Line) -> Option<f64> {
    let (ray, scale) = LocalRay::new(line.origin, line.direction)?;
    shape.meet(&ray, f64::INFINITY).map(|meet| meet.t / scale)
}

/// How a distance compares with the true one, in units in the last place of t.
pub fn compare(found: Option<f64>, truth: Option<f64>) -> Verdict {
    match (found, truth) {
        (Some(t), Some(truth)) => Verdict::error((t - truth).abs() / ulp(truth)),
        (None, Some(_)) => Verdict { missed: 1, ..Verdict::default() },
        (Some(_), None) => Verdict { spurious: 1, ..Verdict::default() },
        (None, None) => Verdict::error(0.0),
    }
}

fn judge(input: &Input, found: &Option<f64>) -> Verdict {
    compare(*found, truth(input))
}

/// The nearest distance ahead. The direction is taken to a size near 1 first, so that nothing overflows.
fn truth(input: &Input) -> Option<f64> {
    let Line { origin, direction } = line(input);
    let size = crate::math::exact::exponent(Point::max_abs(direction));
    let d = direction * exp2(-f64::from(size));
    let dot = |a: [Dd; 3], b: [Dd; 3]| a[0].times(b[0]) + a[1].times(b[1]) + a[2].times(b[2]);
    let (o, d) = (origin.to_array().map(Dd::from), d.to_array().map(Dd::from));
    let a = dot(d, d);
    let foot = -dot(o, d).over(a);
    let nearest: [Dd; 3] = std::array::from_fn(|i| o[i] + d[i].times(foot));
    let r = Dd::from(input[6]);
    let room = (r.times(r) - dot(nearest, nearest)).over(a);
    if room.value() < 0.0 {
        return None;
    }
    let half = square_root(room);
    let (near, far) = ((foot - half).value(), (foot + half).value());
    let t = if near > 0.0 { near } else { far };
    (t > 0.0).then(|| t * exp2(-f64::from(size)))
}

/// √x to about 2⁻¹⁰⁰ of it.
pub fn square_root(x: Dd) -> Dd {
    let root = x.value().sqrt();
    if root == 0.0 {
        return Dd::from(0.0);
    }
    let rest = x - Dd::from(root).times(Dd::from(root));
    Dd::from(root) + Dd::from(rest.value() / (2.0 * root))
}

fn vector(r: &mut Random) -> DVec3 {
    DVec3::new(r.between(-1.0, 1.0), r.between(-1.0, 1.0), r.between(-1.0, 1.0))
}

fn unit(r: &mut Random) -> DVec3 {
    loop {
        let v = vector(r);
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

fn input(origin: DVec3, direction: DVec3, radius: f64) -> Input {
    let (o, d) = (origin, direction);
    [o.x, o.y, o.z, d.x, d.y, d.z, radius]
}

/// From a few radii away toward a point within 1.2 of them.
fn near(r: &mut Random) -> Input {
    let origin = unit(r) * r.between(2.0, 10.0);
    input(origin, (vector(r) * 1.2 - origin).normalize(), 1.0)
}

/// From 10⁸ radii, across ±1.1.
fn far(r: &mut Random) -> Input {
    let along = unit(r);
    let origin = -along * 1e8;
    let target = along.any_orthonormal_vector() * r.between(-1.1, 1.1);
    input(origin, (target - origin).normalize(), 1.0)
}

/// Past the centre at 1 − 10⁻ᵏ of the radius.
fn grazing(r: &mut Random) -> Input {
    let k = r.between(1.0, 14.0);
    let pass = 1.0 - exp2(-k * std::f64::consts::LOG2_10);
    input(DVec3::new(-r.between(2.0, 8.0), pass, 0.0), DVec3::X, 1.0)
}

/// An eye 1.7 m above a planet of 6371 km, looking down to just below the horizon.
fn planet(r: &mut Random) -> Input {
    let down = -exp2(r.between(-10.0, 0.0));
    let direction = DVec3::new(1.0, down, 0.3 * r.unit()).normalize();
    input(DVec3::new(0.0, 6_371_001.7, 0.0), direction, 6.371e6)
}

fn any_length(r: &mut Random) -> Input {
    let origin = unit(r) * 5.0;
    let toward = (vector(r) * 0.9 - origin).normalize();
    input(origin, toward * exp2(r.between(-530.0, 530.0)), 1.0)
}
