//! Families of hard cubics, thousands of each: where the default method must keep every digit and which plain method loses them.
//! Truth is double-double arithmetic, itself held to exact rationals first.

use super::evaluate::{double_double, magnitude};
use super::*;
use crate::math::Dd;
use crate::math::elementary::exp2;
use crate::math::error::UNIT_ROUNDOFF;
use crate::math::hex::parse_hex_list;
use crate::math::random::Random;
use glam::DVec2;

fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

/// What a method is off by, in f64.
fn off(method: Method, p: &[f64; 4], t: f64) -> f64 {
    (Dd::from(method.evaluate(p, t)) - double_double(p, t)).value().abs()
}

/// The largest of a measure over `n` seeded cases.
fn worst(n: u32, seed: u64, mut measure: impl FnMut(&mut Random) -> f64) -> f64 {
    let mut random = Random::new(seed);
    (0..n).map(|_| measure(&mut random)).fold(0.0, f64::max)
}

/// How many of `n` seeded cases a method fails.
fn failures(n: u32, seed: u64, mut fails: impl FnMut(&mut Random) -> bool) -> u32 {
    let mut random = Random::new(seed);
    (0..n).map(|_| u32::from(fails(&mut random))).sum()
}

fn largest(p: &[f64; 4]) -> f64 {
    p.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

#[test]
fn double_doubles_agree_with_exact_rationals() {
    for line in include_str!("../../../tests/golden-numbers/cubics.txt").lines() {
        let (_, numbers) = line.split_once(' ').unwrap();
        let n = parse_hex_list(numbers).unwrap();
        let (t, p, size) = (n[0], [n[1], n[2], n[3], n[4]], n[7]);
        let error = (double_double(&p, t) - Dd { hi: n[5], lo: n[6] }).value().abs();
        // The low half of the golden number is itself rounded to 53 bits.
        assert!(error <= size * exp2(-100.0) + n[6].abs() * UNIT_ROUNDOFF, "{line}: {error:e}");
        assert!((magnitude(&p, t) - size).abs() <= 8.0 * UNIT_ROUNDOFF * size, "{line}");
    }
}

#[test]
fn inside_every_method_is_within_two_ulp_of_the_largest_point() {
    let row = [0.0, 1.0, -1.0, 2.0];
    for method in Method::ALL {
        let ulps = worst(100_000, 1, |r| off(method, &row, r.unit()) / ulp(2.0));
        assert!(ulps <= 2.0, "{method:?}: {ulps}");
    }
    let any = |method: Method| {
        worst(20_000, 2, |r| {
            let p = [(); 4].map(|()| r.between(-1.0, 1.0) * exp2(r.between(-20.0, 20.0)));
            off(method, &p, r.unit()) / ulp(largest(&p))
        })
    };
    assert!(any(Method::DEFAULT) <= 0.51);
    // The monomial coefficients are up to eight times as large as the points, and each has a rounding of its own.
    let horner = any(Method::Horner);
    assert!(horner > 1.0 && horner <= 12.0, "{horner}");
}

#[test]
fn ends_are_exact_whatever_lies_between() {
    let case = |r: &mut Random| [(); 4].map(|()| r.sign() * exp2(r.between(-300.0, 300.0)));
    let misses = |method: Method| {
        failures(5000, 3, |r| {
            let p = case(r);
            method.evaluate(&p, 0.0) != p[0] || method.evaluate(&p, 1.0) != p[3]
        })
    };
    assert_eq!(misses(Method::DEFAULT), 0);
    assert!(misses(Method::Horner) > 1000);
    let curves_miss = failures(2000, 4, |r| {
        let p = case(r).map(|x| DVec2::new(x, 1.0 / x));
        let start = r.between(-10.0, 10.0);
        let curve = Curve::bezier(&p, Some(&[start, start + exp2(r.between(-40.0, 40.0))]), false).unwrap();
        let (a, b) = curve.domain();
        curve.at(a) != Ok(p[0]) || curve.at(b) != Ok(p[3])
    });
    assert_eq!(curves_miss, 0);
}

/// Bézier points of s·(t − k/16)³, exact, and a parameter near the root with its distance from it.
fn near_triple(r: &mut Random) -> ([f64; 4], f64, f64) {
    let root = (1.0 + r.unit() * 15.0).floor() / 16.0;
    let (a, b) = (root, 1.0 - root);
    let scale = r.sign() * exp2(r.between(-30.0, 30.0).floor());
    let p = [-a * a * a, a * a * b, -a * b * b, b * b * b].map(|x| x * scale);
    let t = root + r.sign() * exp2(r.between(-16.6, -4.0));
    (p, t, scale * (t - root) * (t - root) * (t - root))
}

#[test]
fn near_a_triple_root_the_default_keeps_all_digits_and_de_casteljau_most() {
    let relative = |method: Method| {
        worst(20_000, 5, |r| {
            let (p, t, truth) = near_triple(r);
            (method.evaluate(&p, t) / truth - 1.0).abs()
        })
    };
    assert!(relative(Method::DEFAULT) <= 4.0 * UNIT_ROUNDOFF, "{:e}", relative(Method::DEFAULT));
    assert!(relative(Method::Bernstein) > 1e-4 && relative(Method::Horner) > 1e-4);
    // De Casteljau's first level is exact for a root halfway: what is left is one rounding of t − ½ at each later one.
    let p = [-0.125, 0.125, -0.125, 0.125];
    let halfway = |e: f64| {
        let t = 0.5 + e;
        let u = t - 0.5;
        (Method::DeCasteljau.evaluate(&p, t) / (u * u * u) - 1.0).abs()
    };
    assert!(halfway(1e-5) <= 1e-11);
    let roundings = worst(20_000, 6, |r| {
        let e = r.sign() * exp2(r.between(-30.0, -4.0));
        halfway(e) * e.abs() / UNIT_ROUNDOFF
    });
    assert!(roundings <= 3.0, "{roundings}");
}

#[test]
fn tiny_tails_survive_in_every_bernstein_form() {
    let relative = |method: Method| {
        worst(10_000, 7, |r| {
            let tail = r.sign() * exp2(r.between(-120.0, -20.0));
            let step = exp2(r.between(-45.0, -5.0).floor());
            let (p, t) = if r.unit() < 0.5 {
                ([1.0, 0.0, 0.0, tail], 1.0 - step)
            } else {
                ([tail, 0.0, 0.0, r.between(1.0, 9.0)], step)
            };
            off(method, &p, t) / double_double(&p, t).value().abs()
        })
    };
    assert!(relative(Method::DEFAULT) <= 4.0 * UNIT_ROUNDOFF);
    for method in [Method::Bernstein, Method::DeCasteljau] {
        // Terms of opposite sign may cancel here, by a factor that the seed bounds.
        assert!(relative(method) <= 1e-12, "{method:?}: {:e}", relative(method));
    }
    assert!(relative(Method::Horner) >= 1.0);
}

#[test]
fn far_from_the_origin_half_an_ulp_of_the_offset_is_kept() {
    let ulps = |method: Method, whole: bool| {
        worst(20_000, 8, |r| {
            let offset = r.sign() * exp2(r.between(10.0, 50.0));
            let offset = if whole { offset.floor() } else { offset };
            let p = [(); 4].map(|()| {
                let gap = r.between(0.0, 4.0);
                offset + if whole { gap.floor() } else { gap }
            });
            off(method, &p, r.unit()) / ulp(largest(&p))
        })
    };
    for whole in [false, true] {
        assert!(ulps(Method::DEFAULT, whole) <= 0.51, "{whole}: {}", ulps(Method::DEFAULT, whole));
        assert!(ulps(Method::Offset, whole) <= 0.51 + 0.5, "{whole}: {}", ulps(Method::Offset, whole));
        assert!(ulps(Method::DeCasteljau, whole) > 1.0, "{whole}: {}", ulps(Method::DeCasteljau, whole));
    }
}

#[test]
fn outside_the_unit_interval_errors_stay_within_the_sum_of_magnitudes() {
    let roundings = |method: Method, reach: f64| {
        worst(20_000, 9, |r| {
            let p = [(); 4].map(|()| r.between(-3.0, 3.0));
            let t = r.between(-reach, reach);
            off(method, &p, t) / magnitude(&p, t) / UNIT_ROUNDOFF
        })
    };
    for reach in [10.0, 1e6] {
        for method in [Method::DEFAULT, Method::Bernstein, Method::DeCasteljau, Method::VolkSchumaker] {
            assert!(roundings(method, reach) <= 8.0, "{method:?}: {}", roundings(method, reach));
        }
    }
    let p = [0.0, 1.0, -1.0, 2.0];
    let in_ulp = worst(20_000, 10, |r| off(Method::Horner, &p, r.between(-10.0, 10.0)) / ulp(2.0));
    assert!(in_ulp > 500.0, "extrapolation is ill-conditioned: {in_ulp}");
    // Nothing is clamped in silence: a curve refuses, a piece goes on.
    let curve = Curve::bezier(&p, None, false).unwrap();
    assert!(curve.at(1.5).is_err());
    assert_eq!(curve.pieces()[0].at(-10.0), double_double(&p, -10.0).value());
}

#[test]
fn batches_meet_the_bar_of_the_plain_methods() {
    let mut random = Random::new(11);
    let ts: Vec<f64> = (0..1000).map(|i| if i == 0 { 0.0 } else { random.unit() }).chain([1.0]).collect();
    let mut out = vec![0.0; ts.len()];
    for _ in 0..50 {
        let p = [(); 4].map(|()| random.between(-3.0, 3.0));
        evaluate::batch(&p, &ts, &mut out);
        assert_eq!((out[0], out[1000]), (p[0], p[3]));
        for (t, value) in ts.iter().zip(&out) {
            let error = (Dd::from(*value) - double_double(&p, *t)).value().abs();
            assert!(error <= 2.0 * ulp(largest(&p)), "{t} {p:?}");
        }
    }
}
