//! Length of a plane cubic and the parameter at a length. Input: eight coordinates, then the length as high + low, or the share of it
//! that is asked for. Truth: mpmath at 40 digits; for the inverse the adaptive length itself, which that holds to 10⁻¹³.

use crate::geometry::arc_length::ArcLength;
use crate::geometry::curve::Curve;
use crate::math::hex::parse_hex_list;
use crate::report::naive::lengths as naive;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use glam::DVec2;

const FAMILIES: [&str; 5] = ["cusp", "near-cusp", "backtrack", "loop", "parabola"];

/// Trials of length and its inverse.
pub fn rows(plan: &Plan) -> Vec<Row> {
    FAMILIES.iter().flat_map(|family| [length(plan, family), inverse(plan, family)]).flatten().collect()
}

/// The goldens of a family: coordinates, then the length.
fn goldens(family: &str) -> Vec<[f64; 10]> {
    let lines = include_str!("../../../tests/golden-numbers/lengths.txt").lines();
    let own = lines.filter_map(|line| line.split_once(' ')).filter(|(name, _)| *name == family);
    let numbers = own.filter_map(|(_, numbers)| parse_hex_list(numbers)?.try_into().ok());
    numbers.filter(|n: &[f64; 10]| n[8] > 0.0).collect()
}

fn points(input: &[f64]) -> [DVec2; 4] {
    std::array::from_fn(|i| DVec2::new(input[2 * i], input[2 * i + 1]))
}

fn curve(p: &[DVec2; 4]) -> Curve<DVec2> {
    Curve::bezier(p, None, false).expect("four finite points make a curve")
}

fn subject(component: &'static str, case: &'static str) -> Subject {
    Subject { component, case, unit: "absolute", work: "speeds", bar: Some(1e-12) }
}

fn length(plan: &Plan, family: &'static str) -> Vec<Row> {
    let judge = |input: &[f64; 10], (length, evaluations): &(f64, usize)| Verdict {
        work: *evaluations as f64,
        ..Verdict::error(((length - input[8]) - input[9]).abs())
    };
    let mut trial = Trial::new(plan, subject("arc length", family), goldens(family), judge);
    for (name, n) in [("gauss 16", 16), ("gauss 24", 24), ("gauss 64", 64)] {
        let rule = naive::gauss_legendre(n);
        trial.run(variant(name), move |i| (naive::fixed(&rule, &points(i), 1.0), n));
    }
    trial.run(variant("1000 chords"), |i| (chords(&points(i)), 1000));
    let why = "no fixed rule keeps its error on all five sets";
    trial.run(default("cut, adaptive").note(why), |i| {
        let length = ArcLength::of(&curve(&points(i)));
        (length.total().value, length.evaluations())
    });
    trial.finish()
}

fn chords(p: &[DVec2; 4]) -> f64 {
    let at = |k: u32| crate::geometry::curve::evaluate::bernstein(p, f64::from(k) / 1000.0);
    (0..1000).map(|k| at(k).distance(at(k + 1))).sum()
}

/// Coordinates, then the share of the length.
fn inverse(plan: &Plan, family: &'static str) -> Vec<Row> {
    let shares = |golden: [f64; 10]| {
        (1..16).map(move |k| {
            let mut input = [0.0; 9];
            input[..8].copy_from_slice(&golden[..8]);
            input[8] = f64::from(k) / 16.0;
            input
        })
    };
    let inputs = goldens(family).into_iter().flat_map(shares).collect();
    let judge = |input: &[f64; 9], (t, evaluations): &(f64, usize)| {
        let curve = curve(&points(input));
        let length = ArcLength::of(&curve);
        let outside = !(0.0..=1.0).contains(t);
        let off = length.up_to(&curve, t.clamp(0.0, 1.0)) - input[8] * length.total().value;
        Verdict {
            missed: usize::from(outside),
            error: (!outside).then_some(off.abs()),
            work: *evaluations as f64,
            spurious: 0,
        }
    };
    let mut trial = Trial::new(plan, subject("parameter at a length", family), inputs, judge);
    let rule = naive::gauss_legendre(24);
    let whole = rule.clone();
    trial.run(variant("newton, gauss 24"), move |i| {
        let p = points(i);
        naive::newton(&rule, &p, i[8] * naive::fixed(&whole, &p, 1.0))
    });
    trial.run(default("cut, bracketed").note("Newton alone leaves the curve at cusps"), |i| {
        let curve = curve(&points(i));
        let length = ArcLength::of(&curve);
        let t = length.parameter_at(&curve, i[8] * length.total().value);
        (t.unwrap_or(f64::NAN), length.evaluations())
    });
    trial.finish()
}
