//! A ray against the plane n·p = offset. Input: origin, direction, normal, offset. Truth: double-double.

use super::SEED;
use super::spheres::{compare, line, meet};
use crate::math::Dd;
use crate::math::elementary::exp2;
use crate::math::random::Random;
use crate::report::naive::shapes as naive;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use crate::world::shape::{Plane, Shape};
use glam::DVec3;

type Input = [f64; 10];

/// Trials of ray and plane.
pub fn rows(plan: &Plan) -> Vec<Row> {
    [("any", 2.0, any as fn(&mut Random) -> Input), ("grazing", 2.0, grazing)]
        .into_iter()
        .flat_map(|(case, bar, draw)| trial(plan, case, bar, draw))
        .collect()
}

fn trial(plan: &Plan, case: &'static str, bar: f64, draw: fn(&mut Random) -> Input) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs: Vec<Input> = (0..plan.inputs).map(|_| draw(&mut random)).collect();
    let subject = Subject { component: "ray and plane", case, unit: "ulp of t", work: "", bar: Some(bar) };
    let mut trial = Trial::new(plan, subject, inputs, |i: &Input, t: &Option<f64>| judge(i, *t))
        .in_chains(|t| t.unwrap_or(0.0));
    trial.run(variant("plain"), |i| naive::plane(&line(i), normal(i), i[9]));
    let why = "plain arithmetic loses half the digits of grazing rays";
    trial.run(default("certain sign, then precise").note(why), |i| {
        meet(&Shape::Plane(Plane { normal: normal(i), offset: i[9] }), &line(i))
    });
    trial.finish()
}

fn normal(input: &Input) -> DVec3 {
    DVec3::new(input[6], input[7], input[8])
}

fn judge(input: &Input, found: Option<f64>) -> Verdict {
    let dot = |at: usize| {
        let product = |k: usize| Dd::from(input[at + k]).times(Dd::from(input[6 + k]));
        product(0) + product(1) + product(2)
    };
    let t = (Dd::from(input[9]) - dot(0)).over(dot(3)).value();
    compare(found, (t > 0.0 && t.is_finite()).then_some(t))
}

fn vector(r: &mut Random, reach: f64) -> DVec3 {
    DVec3::new(r.between(-reach, reach), r.between(-reach, reach), r.between(-reach, reach))
}

fn input(o: DVec3, d: DVec3, n: DVec3, offset: f64) -> Input {
    [o.x, o.y, o.z, d.x, d.y, d.z, n.x, n.y, n.z, offset]
}

fn any(r: &mut Random) -> Input {
    input(vector(r, 10.0), vector(r, 1.0).normalize(), vector(r, 1.0).normalize(), r.between(-5.0, 5.0))
}

/// n·d between 10⁻⁶ and 10⁻¹².
fn grazing(r: &mut Random) -> Input {
    let n = vector(r, 1.0).normalize();
    let along = n.any_orthonormal_vector();
    let d = along + n * (r.sign() * exp2(r.between(-40.0, -20.0)));
    input(vector(r, 10.0), d, n, r.between(-5.0, 5.0))
}
