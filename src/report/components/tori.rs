//! A ray against a torus around z. Input: origin, direction, the two radii, and the true distance. Truth: Newton's steps in
//! double-double from the point that the ray was aimed at.

use super::SEED;
use super::spheres::{compare, line, meet};
use crate::math::Dd;
use crate::math::elementary::{exp2, sin_cos};
use crate::math::random::Random;
use crate::report::naive::shapes as naive;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, default, variant};
use crate::scene;
use crate::world::shape::{Shape, Torus};
use glam::DVec3;

type Input = [f64; 9];

/// Trials of ray and torus.
pub fn rows(plan: &Plan) -> Vec<Row> {
    let cases = [("near", 1.0, 4.0), ("from 10³", 9e2, 1.1e3), ("from 10⁵", 9e4, 1.1e5)];
    cases.into_iter().flat_map(|(case, from, to)| trial(plan, case, from, to)).collect()
}

fn trial(plan: &Plan, case: &'static str, from: f64, to: f64) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs = (0..plan.inputs).map(|_| draw(&mut random, from, to)).collect();
    let subject = Subject { component: "ray and torus", case, unit: "ulp of t", work: "", bar: Some(16.0) };
    let mut trial = Trial::new(plan, subject, inputs, |i: &Input, t: &Option<f64>| compare(*t, Some(i[8])))
        .in_chains(|t| t.unwrap_or(0.0));
    trial.run(variant("ferrari at the eye"), |i| naive::torus_ferrari(&line(i), i[6], i[7]));
    trial.run(variant("intervals at the eye"), |i| naive::torus_origin(&line(i), i[6], i[7]));
    trial.run(default("intervals at the nearest point").note("it alone sees a torus from afar"), |i| {
        let torus = scene::Torus { center: DVec3::ZERO, axis: DVec3::Z, radii: [i[6], i[7]] };
        meet(&Shape::Torus(Box::new(Torus::new(torus))), &line(i))
    });
    trial.finish()
}

/// A ray from outside toward a point of the surface whose normal faces it, so that what it was aimed at is the first it meets: the
/// outer half of the tube.
fn draw(r: &mut Random, from: f64, to: f64) -> Input {
    let (major, minor) = (1.0, r.between(0.1, 0.9));
    let ((sa, ca), (so, co)) =
        (sin_cos(r.between(0.0, std::f64::consts::TAU)), sin_cos(r.between(-1.2, 1.2)));
    let out = DVec3::new(ca * co, sa * co, so);
    let target = DVec3::new(ca, sa, 0.0) * major + out * minor;
    let away = (out + DVec3::new(r.unit(), r.unit(), r.unit()) * 0.2).normalize();
    let o = target + away * r.between(from, to);
    let d = (target - o).normalize();
    let t = refined(o, d, [major, minor], (target - o).length());
    [o.x, o.y, o.z, d.x, d.y, d.z, major, minor, t]
}

/// The root of F = (p² + R² − r²)² − 4R²(x² + y²) along the ray, nearest to a guess.
fn refined(o: DVec3, d: DVec3, [major, minor]: [f64; 2], guess: f64) -> f64 {
    let mut t = Dd::from(guess);
    let square = |x: Dd| x.times(x);
    let (rr, ss) = (square(Dd::from(major)), square(Dd::from(minor)));
    for _ in 0..6 {
        let p: [Dd; 3] = std::array::from_fn(|i| Dd::from(o[i]) + t.scaled(d[i]));
        let flat = square(p[0]) + square(p[1]);
        let k = flat + square(p[2]) + rr - ss;
        let f = square(k) - flat.times(rr).scaled(4.0);
        let along = p[0].scaled(d.x) + p[1].scaled(d.y) + p[2].scaled(d.z);
        let flat_along = p[0].scaled(d.x) + p[1].scaled(d.y);
        let slope = k.times(along).scaled(4.0) - flat_along.times(rr).scaled(8.0);
        t = t - Dd::from(f.value() / slope.value());
    }
    debug_assert!((t.value() - guess).abs() < exp2(-20.0) * guess.max(1.0));
    t.value()
}
