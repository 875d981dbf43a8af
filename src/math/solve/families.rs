//! Families of polynomials whose coefficients are known to the last bit: how many roots, and each to the digits that the
//! coefficients determine; near double roots, the residual's own rounding decides.

use super::*;
use crate::math::bernstein;
use crate::math::elementary::exp2;
use crate::math::hex::parse_hex_list;
use crate::math::random::Random;

struct Golden {
    family: &'static str,
    coefficients: Vec<f64>,
    /// As high + low.
    roots: Vec<(f64, f64)>,
}

fn goldens() -> impl Iterator<Item = Golden> {
    include_str!("../../../tests/golden-numbers/roots.txt").lines().map(|line| {
        let mut words = line.splitn(3, ' ');
        let (family, degree) = (words.next().unwrap(), words.next().unwrap().parse::<usize>().unwrap());
        let n = parse_hex_list(words.next().unwrap()).unwrap();
        let roots = n[degree + 1..].chunks(2).map(|r| (r[0], r[1])).collect();
        Golden { family, coefficients: n[..=degree].to_vec(), roots }
    })
}

/// p(x), Σ|cᵢxⁱ| and x·p′(x), all over the largest of the terms' powers of two; the first in twice the working precision.
fn scaled(c: &[f64], x: f64) -> (f64, f64, f64) {
    let e = if x == 0.0 { 0 } else { exponent(x) };
    let y = Double::new(scale_by(x, -e));
    let size = |i: usize| exponent(c[i]) + e * i as i32;
    let largest = (0..c.len()).filter(|i| c[*i] != 0.0).map(size).max().unwrap();
    let (mut p, mut sum, mut slope) = (Double::new(0.0), 0.0, 0.0);
    let mut power = Double::new(1.0);
    for (i, c) in c.iter().enumerate() {
        let term = Double::new(scale_by(*c, e * i as i32 - largest)) * power;
        p = p + term;
        sum += term.value().abs();
        slope += i as f64 * term.value();
        power = power * y;
    }
    (p.value(), sum, slope)
}

#[test]
fn no_root_is_missed_or_made_up_and_each_has_the_digits_its_coefficients_determine() {
    for (line, g) in goldens().enumerate().filter(|(_, g)| !g.family.starts_with("touch")) {
        let found = roots_of(&g.coefficients);
        assert_eq!(found.len(), g.roots.len(), "line {}: {found:?} for {:?}", line + 1, g.roots);
        for (x, (high, low)) in found.iter().zip(&g.roots) {
            let (_, sum, slope) = scaled(&g.coefficients, *high);
            let relative = ((x - high - low) / high).abs();
            let bar = 4.0 * UNIT_ROUNDOFF * sum / slope.abs();
            assert!(relative <= bar, "line {}: {x} is not {high}: {relative:e} > {bar:e}", line + 1);
            if g.family.starts_with("quadratic") {
                assert!(relative <= 4.0 * f64::EPSILON, "line {}: {x} {high} {relative:e}", line + 1);
            }
        }
    }
}

#[test]
fn near_double_roots_have_residuals_of_rounding_and_none_is_lost() {
    for (line, g) in goldens().enumerate().filter(|(_, g)| g.family.starts_with("touch")) {
        let found = roots_of(&g.coefficients);
        let residual = |x: f64| {
            let (p, sum, _) = scaled(&g.coefficients, x);
            p.abs() / sum / UNIT_ROUNDOFF
        };
        for x in found.iter() {
            assert!(residual(*x) <= 8.0, "line {}: {x} of {found:?}: {}", line + 1, residual(*x));
        }
        for (high, _) in &g.roots {
            // The found root that stands for this one: between the two the polynomial is zero up to rounding.
            let stands =
                |x: &&f64| (0..=8).all(|k| residual(**x + (high - **x) * f64::from(k) / 8.0) <= 32.0);
            assert!(found.iter().any(|x| stands(&x)), "line {}: {high} lost from {found:?}", line + 1);
        }
    }
}

/// Coefficients of (x − r)²(x − s), rounded once each, moved up by `lift` roundings of their size at r.
fn lifted(r: f64, s: f64, lift: f64) -> [f64; 4] {
    let d = |x: f64| Double::new(x);
    let rr = Double::product(r, r);
    let mut c = [
        (-(rr * d(s))).value(),
        (rr + d(2.0) * Double::product(r, s)).value(),
        (d(-2.0 * r) - d(s)).value(),
        1.0,
    ];
    let size = c.iter().rev().fold(0.0, |v, c| v * r.abs() + c.abs());
    c[0] += lift * UNIT_ROUNDOFF * size;
    c
}

#[test]
fn a_touching_root_is_told_iff_the_turn_is_zero_up_to_rounding() {
    let mut random = Random::new(41);
    for case in 0..2000 {
        let (r, s) = (random.between(0.1, 0.9), random.between(-3.0, -1.0));
        let near = |lift: f64| {
            let roots = roots_of(&lifted(r, s, lift));
            roots.iter().filter(|x| (*x - r).abs() < 1e-3).count()
        };
        // The rounding of the coefficients itself moves the turn by up to 2 of these units.
        assert_eq!(near(0.0), 1, "case {case}: {r} {s}");
        assert_eq!(near(4.0), 1, "case {case}: {r} {s}");
        assert_eq!(near(40.0), 0, "case {case}: {r} {s}");
        assert_eq!(near(-40.0), 2, "case {case}: {r} {s}");
    }
}

#[test]
fn bernstein_roots_touch_by_the_same_law() {
    let mut random = Random::new(42);
    for case in 0..2000 {
        let r = random.between(0.1, 0.9);
        let near = |lift: f64| {
            // (t − r)² in Bernstein form, lifted.
            let c = [r * r, -r * (1.0 - r), (1.0 - r) * (1.0 - r)];
            let (_, size) = bernstein::value_and_bound(&c, r);
            bernstein::roots(&c.map(|c| c + lift * UNIT_ROUNDOFF * size)).len()
        };
        assert_eq!((near(0.0), near(4.0), near(40.0), near(-40.0)), (1, 1, 0, 2), "case {case}: {r}");
    }
}

#[test]
fn planted_cubics_with_a_vanishing_lead_keep_both_roots_in_bernstein_form_too() {
    let mut random = Random::new(43);
    for case in 0..2000 {
        let [a, b] = [random.between(0.0, 0.45), random.between(0.55, 1.0)];
        let lead = random.sign() * exp2(random.between(-80.0, -30.0));
        // (t − a)(t − b) raised to a cubic, and lead · t³.
        let (c0, c1, c2) = (a * b, a * b - (a + b) / 2.0, (1.0 - a) * (1.0 - b));
        let c = [c0, (c0 + 2.0 * c1) / 3.0, (2.0 * c1 + c2) / 3.0, c2 + lead];
        let roots = bernstein::roots(&c);
        assert_eq!(roots.len(), 2, "case {case}: {a} {b} {lead:e}");
        for (x, planted) in roots.iter().zip([a, b]) {
            let (_, size) = bernstein::value_and_bound(&c, *x);
            let slope = (b - a).abs();
            let bar = 8.0 * UNIT_ROUNDOFF * size / slope + lead.abs() / slope + f64::EPSILON;
            assert!((x - planted).abs() <= bar, "case {case}: {x} {planted} {bar:e}");
        }
    }
}
