//! Values against exact rationals, and the laws that every form of spline must keep.

use super::*;
use crate::geometry::basis::Basis;
use crate::math::error::UNIT_ROUNDOFF;
use crate::math::hex::parse_hex;
use glam::{DVec2, DVec3};

struct Golden {
    family: &'static str,
    t: f64,
    points: [f64; 4],
    high: f64,
    low: f64,
    size: f64,
}

fn goldens() -> Vec<Golden> {
    include_str!("../../../tests/golden-numbers/cubics.txt")
        .lines()
        .map(|line| {
            let mut words = line.split(' ');
            let family = words.next().unwrap();
            let n: Vec<f64> = words.map(|w| parse_hex(w).unwrap()).collect();
            Golden { family, t: n[0], points: [n[1], n[2], n[3], n[4]], high: n[5], low: n[6], size: n[7] }
        })
        .collect()
}

fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

/// Largest of some measure of error over a family.
fn worst(method: Method, family: &str, measure: impl Fn(f64, &Golden) -> f64) -> f64 {
    let cases = goldens().into_iter().filter(|g| g.family == family);
    cases.map(|g| measure((method.evaluate(&g.points, g.t) - g.high) - g.low, &g).abs()).fold(0.0, f64::max)
}

fn of_largest(error: f64, g: &Golden) -> f64 {
    error / ulp(g.points.iter().fold(0.0, |m: f64, p| m.max(p.abs())))
}

fn of_value(error: f64, g: &Golden) -> f64 {
    error / g.high / UNIT_ROUNDOFF
}

#[test]
fn the_default_method_meets_every_bar() {
    let m = Method::DEFAULT;
    assert!(worst(m, "inside", of_largest) <= 0.51);
    assert!(worst(m, "offset", |e, g| e / ulp(g.points[0])) <= 0.51);
    assert!(worst(m, "triple", of_value) <= 4.0);
    assert!(worst(m, "tail", of_value) <= 4.0);
    assert!(worst(m, "outside", |e, g| e / g.size / UNIT_ROUNDOFF) <= 8.0);
    assert_eq!(worst(m, "ends", |e, _| e), 0.0);
}

#[test]
fn plain_methods_stay_within_a_few_ulp_inside() {
    for m in Method::ALL {
        // Horner's coefficients are up to 8 times as large as the points.
        let bar = match m {
            Method::Horner => 6.0,
            Method::VolkSchumaker => 3.0,
            Method::Bernstein
            | Method::DeCasteljau
            | Method::Offset
            | Method::Compensated
            | Method::FromEnds => 2.0,
        };
        let ulps = worst(m, "inside", of_largest);
        assert!(ulps <= bar, "{m:?}: {ulps}");
    }
}

#[test]
fn de_casteljau_keeps_the_digits_near_a_triple_root_that_others_lose() {
    let p = [-0.125, 0.125, -0.125, 0.125];
    let off = |m: Method, e: f64| {
        let t = 0.5 + e;
        let u = t - 0.5;
        (m.evaluate(&p, t) / (u * u * u) - 1.0).abs()
    };
    for e in [1e-5, -3e-5, 7e-6, 1e-4] {
        assert!(off(Method::DeCasteljau, e) <= 1e-11, "{e}");
        assert!(off(Method::Compensated, e) <= 8.0 * UNIT_ROUNDOFF, "{e}");
    }
    assert!(off(Method::Bernstein, 1e-5) > 1e-4);
}

#[test]
fn the_ends_are_the_end_points_in_all_but_horners_form() {
    for m in Method::ALL.into_iter().filter(|m| *m != Method::Horner) {
        for p in [[0.1, 0.7, 1e17, 0.3], [1.0, -2e9, 3e-9, 0.7]] {
            assert_eq!((m.evaluate(&p, 0.0), m.evaluate(&p, 1.0)), (p[0], p[3]), "{m:?}");
        }
    }
}

#[test]
fn batches_stay_within_an_ulp_of_the_largest_point() {
    for g in goldens().iter().filter(|g| g.family == "inside" || g.family == "offset") {
        let mut out = [0.0; 3];
        evaluate::batch(&g.points, &[0.0, g.t, 1.0], &mut out);
        assert_eq!((out[0], out[2]), (g.points[0], g.points[3]));
        let ulps = of_largest((out[1] - g.high) - g.low, g).abs();
        assert!(ulps <= 2.0, "{ulps} at {}", g.t);
    }
}

#[test]
fn numbers_too_large_to_split_still_have_values() {
    let p = [1e308, -1e308, 1e308, 1e308];
    assert!(Method::DEFAULT.evaluate(&p, 0.3).is_finite());
    let too_large = CurveError::NotFinite { what: "point", index: 0 };
    assert_eq!(Curve::bezier(&p, None, false), Err(too_large));
}

/// A curve of each form through (or near) the same points, open and closed, over equal and unequal intervals.
fn zoo() -> Vec<(&'static str, Curve<DVec3>)> {
    let p = [
        (0.0, 0.0, 0.0),
        (1.0, 1.5, 0.0),
        (2.5, 1.2, 1.0),
        (4.0, -0.5, 0.0),
        (5.5, 0.8, -1.0),
        (7.0, 1.5, 0.0),
        (8.0, 0.0, 0.0),
    ]
    .map(|(x, y, z)| DVec3::new(x, y, z));
    let slopes = p.map(|p| DVec3::new(p.y, 1.0, -p.x));
    let [k4, k6, k7]: [Vec<f64>; 3] = [4, 6, 7].map(|n| {
        let at = |i: i32| f64::from(i) + 0.3 * f64::from(i % 3);
        (0..=n).map(at).collect()
    });
    let loose = CatmullRom { tension: 0.25, alpha: 1.0 };
    vec![
        ("bezier", Curve::bezier(&p, None, false)),
        ("closed bezier", Curve::bezier(&p[..6], None, true)),
        ("bspline", Curve::bspline(&p, Ends::Open, None)),
        ("knotted bspline", Curve::bspline(&p, Ends::Open, Some(&k4))),
        ("clamped bspline", Curve::bspline(&p, Ends::Clamped, None)),
        ("clamped knotted bspline", Curve::bspline(&p, Ends::Clamped, Some(&k4))),
        ("closed bspline", Curve::bspline(&p, Ends::Closed, None)),
        ("closed knotted bspline", Curve::bspline(&p, Ends::Closed, Some(&k7))),
        ("hermite", Curve::hermite(&p, &slopes, None, false)),
        ("knotted hermite", Curve::hermite(&p, &slopes, Some(&k6), false)),
        ("closed hermite", Curve::hermite(&p, &slopes, None, true)),
        ("catmull_rom", Curve::catmull_rom(&p, CatmullRom::default(), None, false)),
        ("tense catmull_rom", Curve::catmull_rom(&p, loose, Some(&k6), false)),
        ("closed catmull_rom", Curve::catmull_rom(&p, CatmullRom::default(), None, true)),
        ("natural", Curve::natural(&p, None, false)),
        ("knotted natural", Curve::natural(&p, Some(&k6), false)),
        ("closed natural", Curve::natural(&p, Some(&k7), true)),
        ("monomial", Curve::monomial(&p[..4], Some(&[-1.0, 2.5]))),
        ("chain", Curve::chain(&p, Basis::CatmullRom, None, None, false)),
    ]
    .into_iter()
    .map(|(name, curve)| (name, curve.unwrap()))
    .collect()
}

fn samples(curve: &Curve<DVec3>, n: usize) -> Vec<f64> {
    let (a, b) = curve.domain();
    (0..=n).map(|i| a + (b - a) * i as f64 / n as f64).collect()
}

#[test]
fn every_form_is_as_smooth_as_it_promises() {
    for (name, curve) in zoo() {
        let least = if name.contains("spline") || name.contains("natural") {
            2
        } else if name.contains("bezier") {
            0
        } else {
            1
        };
        for seam in curve.continuity() {
            assert!(seam.parametric >= Some(least), "{name}: {}", seam.name());
        }
        assert!(curve.connected(), "{name}");
    }
}

#[test]
fn interpolating_forms_pass_through_their_points_at_their_knots() {
    for (name, curve) in zoo() {
        if !["hermite", "natural"].iter().any(|n| name.contains(n)) && !name.ends_with("catmull_rom") {
            continue;
        }
        for (t, p) in curve.knots().iter().zip(curve.points()) {
            assert_eq!(curve.at(*t).unwrap(), *p, "{name} at {t}");
        }
    }
}

#[test]
fn hermite_slopes_are_derivatives_by_the_curves_own_parameter() {
    for (name, curve) in zoo().into_iter().filter(|(name, _)| name.contains("hermite")) {
        for (t, m) in curve.knots().iter().zip(&curve.form().slopes) {
            assert!(curve.velocity(*t).unwrap().distance(*m) < 1e-14, "{name}");
        }
    }
}

#[test]
fn natural_ends_are_without_curvature() {
    for (name, curve) in
        zoo().into_iter().filter(|(name, _)| name.ends_with("natural") && !name.contains("closed"))
    {
        let (a, b) = curve.domain();
        let bend = curve.acceleration(a).unwrap().length().max(curve.acceleration(b).unwrap().length());
        assert!(bend < 1e-12, "{name}: {bend}");
    }
}

#[test]
fn a_uniform_bspline_is_twice_differentiable_and_jumps_in_the_third_derivative_by_the_formula() {
    let p = [0.3, -1.7, 2.2, 0.9, 4.1];
    let curve = Curve::bspline(&p, Ends::Open, Some(&[0.0, 1.0, 2.0])).unwrap();
    let [_, a, j] = curve.derivatives(1.0, Side::Before).unwrap();
    let [_, b, k] = curve.derivatives(1.0, Side::After).unwrap();
    assert!((a - b).abs() <= 4.0 * ulp(4.1));
    assert!((k - j - (p[4] - 4.0 * p[3] + 6.0 * p[2] - 4.0 * p[1] + p[0])).abs() < 1e-14);
    assert_eq!(curve.continuity()[0], Seam { parametric: Some(2), geometric: None });
}

#[test]
fn a_bspline_of_whole_numbers_is_linear() {
    let p: Vec<f64> = (0..9).map(f64::from).collect();
    for ends in [Ends::Open, Ends::Closed] {
        let curve = Curve::bspline(&p, ends, None).unwrap();
        let n = curve.pieces().len() as f64;
        for i in 0..=20 {
            let t = f64::from(i) / 20.0 * 6.0 / n;
            assert!((curve.at(t).unwrap() - (1.0 + t * n)).abs() < 1e-14);
        }
    }
}

#[test]
fn doubled_end_points_fall_short_tripled_stop_and_mirrored_ones_pass() {
    let [p0, p1, p2, p3] = [(0.0, 0.0), (1.0, 2.0), (3.0, 3.0), (4.0, 0.0)].map(|(x, y)| DVec2::new(x, y));
    let start = |q: [DVec2; 4]| Curve::bspline(&q, Ends::Open, None).unwrap();
    let doubled = start([p0, p0, p2, p3]).at(0.0).unwrap();
    assert!(doubled.distance(p0 * (5.0 / 6.0) + p2 / 6.0) < 1e-15 && doubled != p0);
    let tripled = start([p0, p0, p0, p3]);
    assert_eq!(tripled.at(0.0).unwrap(), p0);
    assert_eq!(tripled.velocity(0.0).unwrap(), DVec2::ZERO);
    assert!(tripled.tangent(0.0).unwrap().distance((p3 - p0).normalize()) < 1e-15);
    let mirrored = start([2.0 * p0 - p1, p0, p1, p2]);
    assert_eq!(mirrored.at(0.0).unwrap(), p0);
    assert!(mirrored.acceleration(0.0).unwrap().length() < 1e-15);
}

#[test]
fn clamped_ends_are_reached() {
    for (name, curve) in zoo().into_iter().filter(|(name, _)| name.starts_with("clamped")) {
        let (a, b) = curve.domain();
        let points = curve.points();
        assert_eq!(curve.at(a).unwrap(), points[0], "{name}");
        assert_eq!(curve.at(b).unwrap(), points[points.len() - 1], "{name}");
    }
}

#[test]
fn closed_curves_end_where_they_start() {
    for (name, curve) in zoo().into_iter().filter(|(_, c)| c.closed()) {
        let (a, b) = curve.domain();
        assert_eq!(curve.at(a).unwrap(), curve.at(b).unwrap(), "{name}");
    }
}

#[test]
fn blossoms_are_symmetric_affine_and_have_the_curve_on_their_diagonal() {
    for (name, curve) in zoo() {
        for piece in curve.pieces() {
            let (a, b) = (piece.start(), piece.end());
            let [r, s, t] = [a - 0.7, a + 0.31 * (b - a), b + 1.9];
            let f = piece.blossom(r, s, t);
            for (x, y, z) in [(r, t, s), (s, r, t), (s, t, r), (t, r, s), (t, s, r)] {
                assert_eq!(piece.blossom(x, y, z), f, "{name}");
            }
            for alpha in [-3.0, 0.5, 7.0] {
                // Chosen so that the mixed argument is exact.
                let (u, v) = (0.25, 0.75);
                let mixed = piece.blossom(alpha * u + (1.0 - alpha) * v, s, t);
                let (fu, fv) = (piece.blossom(u, s, t), piece.blossom(v, s, t));
                let size = fu.max_abs() * alpha.abs() + fv.max_abs() * (1.0 - alpha).abs();
                let off = (mixed - (fu * alpha + fv * (1.0 - alpha))).max_abs();
                assert!(off <= 4.0 * UNIT_ROUNDOFF * size, "{name} {alpha}: {off}");
            }
            for t in [a, s, b, r] {
                assert_eq!(piece.blossom(t, t, t), piece.at(t), "{name}");
            }
        }
    }
}

#[test]
fn the_blossom_of_a_known_polynomial() {
    let c = Curve::monomial(&[1.0, -1.0, 0.0, 3.0], None).unwrap();
    let f = |a, b, c_| c.blossom(a, b, c_).unwrap();
    assert_eq!(f(0.0, 0.0, 0.0), 1.0);
    assert!((f(0.0, 0.0, 1.0) - 2.0 / 3.0).abs() <= UNIT_ROUNDOFF);
    assert!((f(0.0, 1.0, 1.0) - 1.0 / 3.0).abs() <= UNIT_ROUNDOFF);
    assert_eq!(f(1.0, 1.0, 1.0), 3.0);
    assert_eq!(c.at(0.5).unwrap(), 0.875);
}

#[test]
fn halves_rejoin_and_keep_the_parents_parameter() {
    for (name, curve) in zoo() {
        let (a, b) = curve.domain();
        for share in [0.123, 0.5, 0.9, 0.25] {
            let t = a + share * (b - a);
            let (left, right) = curve.split(t).unwrap();
            assert_eq!(left.domain(), (a, t));
            assert_eq!(right.domain(), (t, b));
            assert_eq!(left.at(t).unwrap(), right.at(t).unwrap(), "{name}");
            assert_eq!(left.at(t).unwrap(), curve.at(t).unwrap(), "{name}");
            for s in samples(&curve, 40) {
                let half = if s < t { &left } else { &right };
                let off = half.at(s).unwrap().distance(curve.at(s).unwrap());
                assert!(off <= 4.0 * UNIT_ROUNDOFF * 8.0, "{name} at {s}: {off}");
            }
        }
        assert_eq!(curve.split(a), Err(CurveError::SplitAtEnd { t: a }));
    }
}

#[test]
fn pieces_give_the_bits_of_their_parent() {
    for (name, curve) in zoo() {
        for (i, piece) in curve.pieces().iter().enumerate() {
            let own = curve.piece(i).unwrap();
            let t = piece.start() + 0.37 * (piece.end() - piece.start());
            assert_eq!(own.at(t), curve.at(t), "{name}");
            assert_eq!(own.domain(), (piece.start(), piece.end()));
        }
    }
    let (_, curve) = &zoo()[0];
    assert_eq!(curve.piece(2).unwrap_err(), CurveError::NoPiece { index: 2, n_pieces: 2 });
}

#[test]
fn reversed_curves_run_backwards() {
    for (name, curve) in zoo() {
        let (a, b) = curve.domain();
        let back = curve.reverse();
        assert_eq!(back.domain(), (a, b));
        for t in samples(&curve, 16) {
            assert!(back.at(a + b - t).unwrap().distance(curve.at(t).unwrap()) < 1e-13, "{name}");
        }
    }
}

#[test]
fn a_change_of_basis_keeps_the_curve_and_its_points_come_back() {
    for (name, curve) in zoo() {
        for basis in [Basis::Bezier, Basis::BSpline, Basis::Hermite, Basis::CatmullRom, Basis::Monomial] {
            let other = curve.to(&basis).unwrap();
            for t in samples(&curve, 7) {
                assert_eq!(other.at(t), curve.at(t), "{name} {basis:?}");
            }
            // Points on their own, without the pieces they came from, make the same curve.
            let FormKind::Chain { stride, .. } = other.form().kind else { panic!("{name}") };
            let knots = curve.knots();
            let again =
                Curve::chain(other.points(), basis, Some(stride), Some(&knots), curve.closed()).unwrap();
            for t in samples(&curve, 7) {
                let off = again.at(t).unwrap().distance(curve.at(t).unwrap());
                assert!(off < 1e-13, "{name} {basis:?}: {off}");
            }
        }
    }
    let p = [0.1, 1.7, 3.3, 2.9, -4.0, 0.2].map(|x| x + 1e8);
    let there_and_back =
        Curve::bspline(&p, Ends::Open, None).unwrap().to(&Basis::Bezier).unwrap().to(&Basis::BSpline);
    assert_eq!(there_and_back.unwrap().points(), p);
}

#[test]
fn derivatives_agree_with_differences() {
    for (name, curve) in zoo() {
        for piece in curve.pieces() {
            let width = piece.end() - piece.start();
            let (t, h) = (piece.start() + 0.4 * width, 1e-4 * width);
            let [v, a, j] = piece.derivatives(t);
            let velocity = (piece.at(t + h) - piece.at(t - h)) / (2.0 * h);
            let acceleration = (piece.velocity(t + h) - piece.velocity(t - h)) / (2.0 * h);
            let jerk = (piece.derivatives(t + h)[1] - piece.derivatives(t - h)[1]) / (2.0 * h);
            assert!((velocity - v).length() < 1e-6 * v.length().max(1.0), "{name}");
            assert!((acceleration - a).length() < 1e-6 * a.length().max(1.0), "{name}");
            assert!((jerk - j).length() < 1e-6 * j.length().max(1.0), "{name}");
            assert!(piece.fast_velocity(t).distance(v) < 1e-13 * v.length().max(1.0), "{name}");
        }
    }
}

#[test]
fn the_parabola_at_double_speed_is_curvature_continuous_but_not_c1() {
    // (t, t²), then (1 + 2s, (1 + 2s)²) over the same width.
    let first = [(0.0, 0.0), (1.0 / 3.0, 0.0), (2.0 / 3.0, 1.0 / 3.0), (1.0, 1.0)];
    let second = [(5.0 / 3.0, 7.0 / 3.0), (7.0 / 3.0, 5.0), (3.0, 9.0)];
    let p: Vec<DVec2> = first.iter().chain(&second).map(|(x, y)| DVec2::new(*x, *y)).collect();
    let seam = Curve::bezier(&p, None, false).unwrap().continuity()[0];
    assert_eq!(seam, Seam { parametric: Some(0), geometric: Some(2) });
    assert_eq!(seam.name(), "G2");
    // At its own speed it is one parabola.
    let at_speed = Curve::bezier(&p, Some(&[0.0, 1.0, 3.0]), false).unwrap();
    assert_eq!(at_speed.continuity()[0], Seam { parametric: Some(3), geometric: Some(2) });
}

#[test]
fn a_cusp_is_smooth_as_a_function_and_has_no_tangent_as_a_curve() {
    let whole = Curve::monomial(
        &[(0.0, 0.0), (0.0, 0.0), (0.0, 1.0), (1.0, 0.0)].map(|(x, y)| DVec2::new(x, y)),
        Some(&[-1.0, 1.0]),
    )
    .unwrap();
    let (left, right) = whole.split(0.0).unwrap();
    let bezier: Vec<DVec2> = left.points().iter().chain(&right.points()[1..]).copied().collect();
    let seam = Curve::bezier(&bezier, None, false).unwrap().continuity()[0];
    assert_eq!(seam, Seam { parametric: Some(3), geometric: Some(0) });
    assert_eq!(seam.name(), "C2 cusp");
    assert_eq!(whole.tangent_from(0.0, Side::Before).unwrap(), -DVec2::Y);
    assert_eq!(whole.tangent_from(0.0, Side::After).unwrap(), DVec2::Y);
}

#[test]
fn seams_of_each_lesser_class() {
    let seam = |q: [(f64, f64); 3]| {
        let p = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 1.0)].into_iter().chain(q);
        let p: Vec<DVec2> = p.map(|(x, y)| DVec2::new(x, y)).collect();
        Curve::bezier(&p, None, false).unwrap().continuity()[0].name()
    };
    assert_eq!(seam([(4.0, 2.0), (5.0, 5.0), (9.0, 0.0)]), "C1");
    assert_eq!(seam([(5.0, 3.0), (5.0, 9.0), (9.0, 0.0)]), "G1");
    assert_eq!(seam([(2.0, 0.0), (5.0, 5.0), (9.0, 0.0)]), "C0");
    // Same velocity, same curvature, more acceleration along the tangent.
    assert_eq!(seam([(4.0, 2.0), (7.0, 6.0), (9.0, 0.0)]), "C1 G2");
    // A midpoint that rounding moved is still a midpoint.
    let p = [0.1, 0.3, 0.7, 0.7 + (1.9 - 0.7) / 2.0, 1.9, 2.0, 3.0].map(|x| DVec2::new(x + 1e5, 0.1 * x * x));
    let mut p = p.to_vec();
    p[3] = (p[2] + p[4]) / 2.0;
    assert_eq!(Curve::bezier(&p, None, false).unwrap().continuity()[0].parametric, Some(1));
    let gap =
        Curve::chain(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], Basis::Bezier, Some(4), None, false).unwrap();
    assert_eq!(gap.continuity()[0].name(), "gap");
}

#[test]
fn a_hundred_uniform_pieces_are_still_c2_although_their_knots_are_rounded() {
    let p: Vec<DVec2> = (0..110).map(|i| DVec2::new(f64::from(i * i % 17), f64::from(i * 7 % 13))).collect();
    for curve in [Curve::bspline(&p, Ends::Open, None).unwrap(), Curve::natural(&p, None, true).unwrap()] {
        assert!(curve.continuity().iter().all(|s| s.parametric >= Some(2)));
    }
}

#[test]
fn frenet_quantities_of_a_twisted_cubic_and_a_near_circle() {
    // γ = (t, t², t³): κ = 2√(9t⁴+9t²+1)/(9t⁴+4t²+1)^1.5, τ = 3/(9t⁴+9t²+1).
    let c = Curve::monomial(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], Some(&[-2.0, 2.0])).unwrap();
    for t in [-1.7, -0.5, 0.0, 0.3, 1.0, 2.0f64] {
        let (q, w) = (9.0 * t * t * t * t + 9.0 * t * t + 1.0, 9.0 * t * t * t * t + 4.0 * t * t + 1.0);
        assert!((c.curvature(t).unwrap() - 2.0 * q.sqrt() / (w * w.sqrt())).abs() < 1e-14);
        assert!((c.torsion(t).unwrap() - 3.0 / q).abs() < 1e-14);
        let (u, n, b) = (c.tangent(t).unwrap(), c.normal(t).unwrap(), c.binormal(t).unwrap());
        assert!(u.dot(n).abs() < 1e-15 && (u.cross(n) - b).length() < 1e-15);
        assert!((b.length() - 1.0).abs() < 1e-15);
    }
    let k = 4.0 * (2f64.sqrt() - 1.0) / 3.0;
    let quarter = [(1.0, 0.0), (1.0, k), (k, 1.0), (0.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
    let arc = Curve::bezier(&quarter, None, false).unwrap();
    let radial = |t: f64| arc.at(t).unwrap().length() - 1.0;
    assert!((radial(0.211325) - 2.725300e-4).abs() < 1e-9);
    assert!((0..=1000).all(|i| radial(f64::from(i) / 1000.0) >= -1e-15));
    assert!((arc.normal(0.5).unwrap() + DVec2::ONE.normalize()).length() < 1e-14);
}

#[test]
fn boxes_hold_the_curve_and_touch_it() {
    for (name, curve) in zoo() {
        let (low, high) = curve.bounds();
        let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for t in samples(&curve, 4000) {
            let p = curve.at(t).unwrap();
            assert!(p.cmpge(low).all() && p.cmple(high).all(), "{name} at {t}");
            (least, most) = (least.min(p), most.max(p));
        }
        assert!((least - low).length() < 1e-4 && (most - high).length() < 1e-4, "{name}");
    }
}

#[test]
fn parameters_off_by_rounding_are_taken_and_others_are_errors() {
    let c = Curve::bezier(&[0.0, 1.0, 2.0, 3.0], None, false).unwrap();
    assert_eq!(c.at(1.0 + 4.0 * f64::EPSILON), Ok(3.0));
    assert_eq!(c.at(1.001), Err(CurveError::OutsideDomain { t: 1.001, start: 0.0, end: 1.0 }));
    assert!(c.at(f64::NAN).is_err());
}

#[test]
fn what_makes_no_curve_is_said() {
    let p = [0.0, 1.0, 2.0, 3.0, 4.0];
    let count = |r: Result<Curve<f64>, CurveError>| matches!(r, Err(CurveError::PointCount { .. }));
    assert!(count(Curve::bezier(&p, None, false)) && count(Curve::bezier(&p, None, true)));
    assert!(count(Curve::bspline(&p[..3], Ends::Open, None)));
    assert!(count(Curve::natural(&p[..1], None, false)) && count(Curve::natural(&p[..2], None, true)));
    assert!(count(Curve::chain(&p, Basis::Bezier, Some(2), None, false)));
    assert_eq!(
        Curve::hermite(&p, &p[..4], None, false).unwrap_err(),
        CurveError::SlopeCount { expected: 5, given: 4 }
    );
    assert_eq!(
        Curve::bspline(&p, Ends::Open, Some(&[0.0, 1.0])).unwrap_err(),
        CurveError::KnotCount { pieces: 2, given: 2 }
    );
    assert_eq!(
        Curve::bspline(&p, Ends::Open, Some(&[0.0, 1.0, 1.0])).unwrap_err(),
        CurveError::KnotOrder { index: 2, before: 1.0, after: 1.0 }
    );
    assert_eq!(
        Curve::catmull_rom(&[0.0, 1.0, 1.0], CatmullRom::default(), None, false).unwrap_err(),
        CurveError::RepeatedPoint { index: 2 }
    );
    assert_eq!(
        Curve::natural(&[0.0, f64::NAN], None, false).unwrap_err(),
        CurveError::NotFinite { what: "point", index: 1 }
    );
    assert_eq!(Curve::chain(&p, Basis::Bezier, Some(0), None, false), Err(CurveError::Stride));
}
