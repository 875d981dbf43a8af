//! Lengths of cusps, near cusps, lines run back and forth, loops and parabolas against 40 digits, as they are and turned, scaled
//! and moved; and total variations, whose truth is closed.

use super::ArcLength;
use crate::geometry::curve::Curve;
use crate::math::elementary::exp2;
use crate::math::hex::parse_hex_list;
use crate::math::random::Random;
use glam::{DMat2, DVec2, DVec3};

/// Family, curve and length, for each line of the goldens.
fn goldens() -> impl Iterator<Item = (&'static str, Vec<DVec2>, f64)> {
    include_str!("../../../tests/golden-numbers/lengths.txt").lines().map(|line| {
        let (family, numbers) = line.split_once(' ').unwrap();
        let n = parse_hex_list(numbers).unwrap();
        (family, (0..4).map(|i| DVec2::new(n[2 * i], n[2 * i + 1])).collect(), n[8])
    })
}

/// Holds one curve's length and its inverse to the bar; its points may be rounded by `rounding`.
fn hold(name: &str, curve: &Curve<DVec2>, truth: f64, rounding: f64) {
    let length = ArcLength::of(curve);
    let total = length.total();
    let bar = 1e-12 * truth.max(1.0);
    assert!((total.value - truth).abs() <= bar, "{name}: {} is not {truth}", total.value);
    assert!((total.value - truth).abs() <= total.error + rounding, "{name}: {total:?} {truth}");
    assert!(length.evaluations() <= 2000, "{name}: {} evaluations", length.evaluations());
    let mut before = f64::NEG_INFINITY;
    for i in 0..=200 {
        let s = total.value * f64::from(i) / 200.0;
        let t = length.parameter_at(curve, s).unwrap();
        assert!(t > before, "{name} at {s}: {t} after {before}");
        assert!((length.up_to(curve, t) - s).abs() <= bar, "{name} at {s}");
        before = t;
    }
}

#[test]
fn lengths_are_right_to_a_trillionth_and_so_are_their_inverses() {
    for (i, (family, p, truth)) in goldens().enumerate() {
        if truth > 0.0 {
            hold(&format!("{family} {i}"), &Curve::bezier(&p, None, false).unwrap(), truth, 0.0);
        }
    }
}

#[test]
fn turning_scaling_and_other_knots_change_no_length() {
    let mut random = Random::new(30);
    for (i, (family, p, truth)) in goldens().enumerate().filter(|(_, (_, _, truth))| *truth > 0.0) {
        for k in 0..4 {
            let scale = exp2(random.between(-20.0, 3.0));
            let turn = DMat2::from_angle(random.between(0.0, 6.3)) * scale;
            let shift = DVec2::new(random.between(-4.0, 4.0), random.between(-4.0, 4.0)) * scale;
            let q: Vec<DVec2> = p.iter().map(|p| turn * *p + shift).collect();
            let start = random.between(-3.0, 3.0);
            let knots = [start, start + exp2(random.between(-8.0, 8.0))];
            let curve = Curve::bezier(&q, Some(&knots), false).unwrap();
            let size = q.iter().fold(0.0, |m: f64, q| m.max(q.abs().max_element()));
            hold(&format!("{family} {i}.{k}"), &curve, truth * scale, 16.0 * f64::EPSILON * size);
        }
    }
}

/// γ′ = 6k(t − a)(t − b) along a vector of length 7: Bézier points and length, exact.
fn back_and_forth(k: f64, a: f64, b: f64) -> (Vec<DVec3>, f64) {
    let at = |r: f64, s: f64, t: f64| {
        k * (2.0 * r * s * t - (a + b) * (r * s + s * t + t * r) + 2.0 * a * b * (r + s + t))
    };
    let x = |t: f64| at(t, t, t);
    let p = [at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0), at(0.0, 1.0, 1.0), at(1.0, 1.0, 1.0)];
    let mut stops = [0.0, a.clamp(0.0, 1.0), b.clamp(0.0, 1.0), 1.0];
    stops.sort_by(f64::total_cmp);
    let variation: f64 = stops.windows(2).map(|w| (x(w[1]) - x(w[0])).abs()).sum();
    (p.map(|x| DVec3::new(2.0, 3.0, 6.0) * x).to_vec(), 7.0 * variation)
}

#[test]
fn a_line_run_back_and_forth_is_as_long_as_its_parts() {
    let mut random = Random::new(31);
    for case in 0..1000 {
        let [a, b] = [(); 2].map(|()| (random.between(-0.5, 1.5) * 64.0).floor() / 64.0);
        let (p, truth) = back_and_forth(0.125, a, if case % 5 == 0 { a } else { b });
        let curve = Curve::bezier(&p, None, false).unwrap();
        let length = ArcLength::of(&curve);
        let total = length.total().value;
        assert!((total - truth).abs() <= 1e-12, "case {case}: {total} is not {truth}");
        assert!(length.evaluations() <= 2000);
        let s = total * random.unit();
        let t = length.parameter_at(&curve, s).unwrap();
        assert!((length.up_to(&curve, t) - s).abs() <= 1e-12, "case {case}");
    }
}
