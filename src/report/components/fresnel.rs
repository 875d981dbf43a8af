//! The share of light that a smooth boundary reflects. Input: the cosine, and the index beyond over the index before. Truth: Fresnel's
//! equations in double-double.

use super::SEED;
use super::spheres::square_root;
use crate::math::Dd;
use crate::math::random::Random;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use crate::world::bsdf::fresnel::{dielectric, dielectric_schlick};

type Input = [f64; 2];

/// Trials of Fresnel's equations.
pub fn rows(plan: &Plan) -> Vec<Row> {
    let cases = [
        ("into glass, 1.5", 1.5),
        ("into 1.1", 1.1),
        ("into diamond, 2.42", 2.42),
        ("out of glass", 1.0 / 1.5),
    ];
    cases.into_iter().flat_map(|(case, eta)| trial(plan, case, eta)).collect()
}

fn trial(plan: &Plan, case: &'static str, eta: f64) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs = (0..plan.inputs).map(|_| [random.unit(), eta]).collect();
    let subject = Subject { component: "fresnel", case, unit: "absolute", work: "", bar: Some(1e-14) };
    let judge = |i: &Input, share: &f64| Verdict::error((share - truth(i)).abs());
    let mut trial = Trial::new(plan, subject, inputs, judge).in_chains(|share| *share);
    trial.run(variant("schlick, one side"), |i| one_sided(i[0], i[1]));
    trial.run(variant("schlick, both sides"), |i| dielectric_schlick(i[0], i[1]));
    trial.run(default("exact").note("schlick is off by up to 0.2"), |i| dielectric(i[0], i[1]));
    trial.finish()
}

/// Schlick as it is mostly written: with the angle before the boundary, whichever side that is.
fn one_sided(cos: f64, eta: f64) -> f64 {
    let r0 = ((1.0 - eta) / (1.0 + eta)) * ((1.0 - eta) / (1.0 + eta));
    let m = 1.0 - cos;
    r0 + (1.0 - r0) * (m * m * m * m * m)
}

fn truth(&[cos, eta]: &Input) -> f64 {
    let (c, n, one) = (Dd::from(cos), Dd::from(eta), Dd::from(1.0));
    let rest = one - (one - c.times(c)).over(n.times(n));
    if rest.value() <= 0.0 {
        return 1.0;
    }
    let beyond = square_root(rest);
    let ratio = |a: Dd, b: Dd| (a - b).over(a + b);
    let (s, p) = (ratio(c, n.times(beyond)), ratio(n.times(c), beyond));
    (s.times(s) + p.times(p)).value() / 2.0
}
