//! Laws of bases, blossoms and seams over thousands of seeded curves: what a textbook states and plain arithmetic breaks.

use super::*;
use crate::geometry::basis::Basis;
use crate::math::elementary::exp2;
use crate::math::error::UNIT_ROUNDOFF;
use crate::math::random::Random;
use glam::{DVec2, DVec3};

fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

fn points<const N: usize>(r: &mut Random, reach: f64) -> [DVec3; N] {
    [(); N].map(|()| DVec3::from_coordinates(|_| r.between(-reach, reach)))
}

/// The way through monomials, in plain f64: sixths times B-spline matrix, then binomials.
fn through_monomials(p: &[f64; 4]) -> [f64; 4] {
    let [a, b, c, d] = *p;
    let mono =
        [(a + 4.0 * b + c) / 6.0, (c - a) / 2.0, (a - 2.0 * b + c) / 2.0, (d - a + 3.0 * (b - c)) / 6.0];
    let bezier = [
        mono[0],
        mono[0] + mono[1] / 3.0,
        mono[0] + 2.0 * mono[1] / 3.0 + mono[2] / 3.0,
        mono[0] + mono[1] + mono[2] + mono[3],
    ];
    let [p0, p1, p2, p3] = bezier;
    let (m1, m2, m3) = (3.0 * (p1 - p0), 3.0 * (p0 - 2.0 * p1 + p2), p3 - p0 + 3.0 * (p1 - p2));
    [
        p0 - m1 + 2.0 * m2 / 3.0,
        p0 - m2 / 3.0,
        p0 + m1 + 2.0 * m2 / 3.0,
        p0 + 2.0 * m1 + 11.0 * m2 / 3.0 + 6.0 * m3,
    ]
}

#[test]
fn changing_basis_and_back_costs_eight_ulp_at_most_and_more_through_monomials() {
    let mut random = Random::new(20);
    let mut plain = 0.0f64;
    for case in 0..5000 {
        let offset = if case == 0 { 1e8 } else { random.sign() * exp2(random.between(0.0, 45.0)) };
        let p = [(); 4].map(|()| offset + random.between(-4.0, 4.0));
        let bar = 8.0 * ulp(p.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
        let bezier = Basis::BSpline.convert(&Basis::Bezier, &p).unwrap();
        let back = Basis::Bezier.convert(&Basis::BSpline, &bezier).unwrap();
        let off = |q: &[f64; 4]| p.iter().zip(q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / bar;
        assert!(off(&back) <= 1.0, "case {case}: {p:?} gave {back:?}");
        plain = plain.max(off(&through_monomials(&p)));
    }
    assert!(plain > 1.0, "monomials kept within the bar: {plain}");
}

#[test]
fn a_change_of_basis_is_rounded_once() {
    // B-spline to Bézier in whole numbers: sixths of integers, whose nearest f64 is known.
    let mut random = Random::new(21);
    for _ in 0..5000 {
        let p = [(); 4].map(|()| (random.between(-1.0, 1.0) * exp2(48.0)).floor());
        let b = Basis::BSpline.convert(&Basis::Bezier, &p).unwrap();
        let i = p.map(|x| x as i64);
        let sixths =
            [i[0] + 4 * i[1] + i[2], 4 * i[1] + 2 * i[2], 2 * i[1] + 4 * i[2], i[1] + 4 * i[2] + i[3]];
        for (value, sixth) in b.iter().zip(sixths) {
            // |6b − n| at most 6 · ½ ulp(b), in integers scaled by 2^12.
            let scaled = (*value * 4096.0) as i128;
            assert!(6 * scaled - i128::from(sixth) * 4096 <= (3.0 * ulp(*value) * 4096.0) as i128 + 6);
            assert!(i128::from(sixth) * 4096 - 6 * scaled <= (3.0 * ulp(*value) * 4096.0) as i128 + 6);
        }
    }
}

#[test]
fn blossoms_are_bit_symmetric_affine_and_have_the_curve_on_their_diagonal() {
    let mut random = Random::new(22);
    let mut sorted_matters = 0;
    for case in 0..2000 {
        let p: [DVec3; 4] = points(&mut random, 3.0);
        let start = random.between(-5.0, 5.0);
        let knots = [start, start + exp2(random.between(-6.0, 6.0))];
        let unit = case % 2 == 0;
        let curve = Curve::bezier(&p, (!unit).then_some(&knots[..]), false).unwrap();
        let (a, b) = curve.domain();
        let [r, s, t] = [(); 3].map(|()| random.between(2.0 * a - b, 2.0 * b - a));
        let f = curve.blossom(r, s, t).unwrap();
        for (x, y, z) in [(r, t, s), (s, r, t), (s, t, r), (t, r, s), (t, s, r)] {
            assert_eq!(curve.blossom(x, y, z).unwrap(), f, "case {case}");
            sorted_matters += u32::from(unsorted(&p, [x, y, z]) != unsorted(&p, [r, s, t]));
        }
        assert_eq!(curve.pieces()[0].blossom(t, t, t), curve.pieces()[0].at(t), "case {case}");
        // Affine in one argument, at a mixture that is exact: any real α.
        let alpha = (random.between(-8.0, 8.0) * 4.0).floor() / 4.0;
        let (u, v) = ((r * 8.0).floor() / 8.0, (s * 8.0).floor() / 8.0);
        let mixed = curve.blossom(alpha * u + (1.0 - alpha) * v, s, t).unwrap();
        let (fu, fv) = (curve.blossom(u, s, t).unwrap(), curve.blossom(v, s, t).unwrap());
        let size = fu.max_abs() * alpha.abs() + fv.max_abs() * (1.0 - alpha).abs();
        let off = (mixed - (fu * alpha + fv * (1.0 - alpha))).max_abs();
        assert!(off <= 4.0 * UNIT_ROUNDOFF * size, "case {case}: {off:e}");
    }
    assert!(sorted_matters > 1000, "order never mattered to plain arithmetic: {sorted_matters}");
}

#[test]
fn blossoms_that_all_but_cancel_are_bit_symmetric_too() {
    let mut random = Random::new(28);
    for case in 0..2000 {
        // (t − k/16)³ exactly, asked so near its root that the errors carried along are of the value's own size.
        let root = (1.0 + random.unit() * 14.0).floor() / 16.0;
        let (a, b) = (root, 1.0 - root);
        let p = [-a * a * a, a * a * b, -a * b * b, b * b * b];
        let curve = Curve::bezier(&p, None, false).unwrap();
        let [r, s, t] = [(); 3].map(|()| root + random.sign() * exp2(random.between(-44.0, -30.0)));
        let f = curve.blossom(r, s, t).unwrap();
        for (x, y, z) in [(r, t, s), (s, r, t), (s, t, r), (t, r, s), (t, s, r)] {
            assert_eq!(curve.blossom(x, y, z).unwrap(), f, "case {case}");
        }
    }
}

/// The blossom by plain de Casteljau steps, arguments as they come.
fn unsorted(p: &[DVec3; 4], arguments: [f64; 3]) -> DVec3 {
    let mut b = *p;
    for (level, t) in arguments.into_iter().enumerate() {
        for i in 0..3 - level {
            b[i] = b[i] * (1.0 - t) + b[i + 1] * t;
        }
    }
    b[0]
}

#[test]
fn uniform_bsplines_jump_in_the_third_derivative_alone() {
    let mut random = Random::new(23);
    for case in 0..1000 {
        let p: [DVec3; 5] = points(&mut random, 5.0);
        let curve = Curve::bspline(&p, Ends::Open, Some(&[0.0, 1.0, 2.0])).unwrap();
        let [v, a, j] = curve.derivatives(1.0, Side::Before).unwrap();
        let [w, b, k] = curve.derivatives(1.0, Side::After).unwrap();
        let size = p.iter().fold(0.0, |m: f64, q| m.max(q.max_abs()));
        assert!((v - w).max_abs() <= 4.0 * ulp(size) && (a - b).max_abs() <= 4.0 * ulp(size), "case {case}");
        let jump = p[4] - p[3] * 4.0 + p[2] * 6.0 - p[1] * 4.0 + p[0];
        assert!((k - j - jump).max_abs() <= 32.0 * ulp(size), "case {case}: {}", (k - j - jump).max_abs());
        assert_eq!(curve.continuity()[0].parametric, Some(2), "case {case}");
    }
}

#[test]
fn repeated_end_points_fall_short_by_the_formula_and_phantoms_pass_exactly() {
    let mut random = Random::new(24);
    for case in 0..1000 {
        let [p0, p1, p2, p3]: [DVec3; 4] = points(&mut random, 5.0);
        let curve = |q: [DVec3; 4]| Curve::bspline(&q, Ends::Open, None).unwrap();
        let doubled = curve([p0, p0, p2, p3]).at(0.0).unwrap();
        assert!((doubled - (p0 * (5.0 / 6.0) + p2 / 6.0)).max_abs() <= 2.0 * ulp(5.0) && doubled != p0);
        let tripled = curve([p0, p0, p0, p3]);
        assert_eq!(tripled.at(0.0).unwrap(), p0, "case {case}");
        assert_eq!(tripled.velocity(0.0).unwrap(), DVec3::ZERO);
        let t = random.unit();
        let line = p0 + (p3 - p0) * (t * t * t / 6.0);
        assert!((tripled.at(t).unwrap() - line).max_abs() <= 4.0 * ulp(5.0), "case {case}");
        // 2p₀ − p₁ rounded stays a phantom: the curve starts at p₀ to the last bit, or its neighbour.
        let phantom = curve([p0 * 2.0 - p1, p0, p1, p2]);
        assert!((phantom.at(0.0).unwrap() - p0).max_abs() <= ulp(5.0), "case {case}");
        assert!(phantom.acceleration(0.0).unwrap().max_abs() <= 8.0 * ulp(5.0), "case {case}");
        let quarters = [p0, p1].map(|p| (p * 1024.0).floor() / 1024.0);
        let exact = curve([quarters[0] * 2.0 - quarters[1], quarters[0], quarters[1], p2]);
        assert_eq!(exact.at(0.0).unwrap(), quarters[0], "case {case}");
    }
}

#[test]
fn n_control_points_make_n_minus_three_beziers_that_are_the_windows() {
    let mut random = Random::new(25);
    for n in 4..40 {
        let p: Vec<DVec2> = (0..n).map(|_| DVec2::new(random.unit(), random.unit())).collect();
        let curve = Curve::bspline(&p, Ends::Open, None).unwrap();
        assert_eq!(curve.pieces().len(), n - 3);
        for (window, piece) in p.windows(4).zip(curve.pieces()) {
            let four = [window[0], window[1], window[2], window[3]];
            let bezier = Basis::BSpline.convert(&Basis::Bezier, &four).unwrap();
            for (a, b) in bezier.iter().zip(piece.points()) {
                assert!((*a - b).max_abs() <= ulp(1.0));
            }
        }
    }
}

#[test]
fn slopes_of_an_interval_are_scaled_by_its_width() {
    let mut random = Random::new(26);
    for case in 0..1000 {
        let [p, q, v, w]: [DVec3; 4] = points(&mut random, 3.0);
        let start = random.between(-3.0, 3.0);
        let width = exp2(random.between(-8.0, 8.0));
        let curve = Curve::hermite(&[p, q], &[v, w], Some(&[start, start + width]), false).unwrap();
        let (a, b) = curve.domain();
        for (t, point, slope) in [(a, p, v), (b, q, w)] {
            assert_eq!(curve.at(t).unwrap(), point, "case {case}");
            assert!((curve.velocity(t).unwrap() - slope).max_abs() <= 4.0 * ulp(3.0), "case {case}");
        }
        // As if over a unit interval, it would be steeper by the width.
        let unit = Curve::hermite(&[p, q], &[v, w], None, false).unwrap().velocity(0.0).unwrap();
        assert!((unit - v).max_abs() <= 4.0 * ulp(3.0), "case {case}");
    }
}

#[test]
fn one_parabola_in_two_parts_is_c3_at_its_own_speed_and_g2_at_any() {
    let mut random = Random::new(27);
    for case in 0..500 {
        // (t, t²) under a random linear map, over [0, 1] and on to 1 + s; all numbers short, so that no point is rounded.
        let s = (1.0 + random.unit() * 255.0).floor() / 64.0;
        let mut short = || (random.between(-2.0, 2.0) * 16.0).floor() / 16.0;
        let [x, y] = [(); 2].map(|()| DVec2::new(short(), short()));
        if x.perp_dot(y) == 0.0 {
            continue;
        }
        let at = |a: f64, b: f64| x * (a + a + b) + y * (a * a + 2.0 * a * b);
        let end = 1.0 + s;
        let p = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (1.0, end), (end, 1.0), (end, end)]
            .map(|(a, b)| at(a, b));
        let seam = |knots: Option<&[f64]>| Curve::bezier(&p, knots, false).unwrap().continuity()[0];
        let own = seam(Some(&[0.0, 1.0, end]));
        assert_eq!(own, Seam { parametric: Some(3), geometric: Some(2) }, "case {case}");
        if s != 1.0 {
            let uniform = seam(None);
            assert_eq!(uniform, Seam { parametric: Some(0), geometric: Some(2) }, "case {case}");
        }
    }
}
