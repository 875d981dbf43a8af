//! Surfaces of revolution against cones, cylinders and paraboloids, and against what their profiles say along a line.

use super::*;
use crate::geometry::curve::Curve;
use crate::geometry::surface::cubic::of_curve;

fn lathe(points: &[[f64; 2]], closed: bool, angle: Option<f64>) -> Lathe {
    let points: Vec<DVec2> = points.iter().map(|p| DVec2::from(*p)).collect();
    let curve = Curve::bezier(&points, None, closed).unwrap();
    Lathe::new(&of_curve(&curve), closed, angle).unwrap()
}

/// Bézier points of straight sides.
fn polygon(corners: &[[f64; 2]], closed: bool) -> Vec<[f64; 2]> {
    let n = corners.len();
    let sides = if closed { n } else { n - 1 };
    let mut points = Vec::new();
    for k in 0..sides {
        let (a, b) = (DVec2::from(corners[k]), DVec2::from(corners[(k + 1) % n]));
        points.extend([a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0)].map(|p| p.to_array()));
    }
    if !closed {
        points.push(corners[n - 1]);
    }
    points
}

fn line(o: [f64; 3], d: [f64; 3]) -> Line {
    Line::new(DVec3::from(o), DVec3::from(d)).unwrap()
}

fn ts(lathe: &Lathe, o: [f64; 3], d: [f64; 3]) -> Vec<f64> {
    lathe.all(&line(o, d)).iter().map(|h| h.t).collect()
}

fn assert_close(found: &[f64], expected: &[f64], bar: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} is not {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= bar, "{found:?} is not {expected:?}");
    }
}

#[test]
fn a_can_is_met_from_all_sides() {
    let can = lathe(&polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 3.0]], false), false, None);
    assert!(can.is_solid());
    assert_close(&ts(&can, [-5.0, 1.0, 0.0], [1.0, 0.0, 0.0]), &[3.0, 7.0], 1e-14);
    assert_close(&ts(&can, [-5.0, 1.0, 1.2], [1.0, 0.0, 0.0]), &[3.4, 6.6], 1e-14);
    assert_close(&ts(&can, [0.5, 10.0, 0.3], [0.0, -1.0, 0.0]), &[7.0, 10.0], 1e-14);
    assert_close(&ts(&can, [0.0, 10.0, 0.0], [0.0, -2.0, 0.0]), &[3.5, 5.0], 1e-14);
    for (o, d) in [([-5.0, 1.0, 0.5], [1.0, 0.1, 0.0]), ([0.5, 9.0, 0.3], [0.1, -1.0, 0.2])] {
        let (l, all) = (line(o, d), can.all(&line(o, d)));
        assert!(can.surface(&l, &all[0]).normal.dot(l.direction) < 0.0);
        assert!(can.surface(&l, &all[1]).normal.dot(l.direction) > 0.0);
    }
    // Through a lid and the wall, both steep and level.
    assert_close(&ts(&can, [0.0, 5.0, 0.0], [1.0, -2.0, 0.0]), &[1.0, 2.0], 1e-14);
    assert_close(&ts(&can, [-4.0, 3.5, 0.0], [2.0, -0.5, 0.0]), &[1.0, 3.0], 1e-14);
    // Level but for the last bits.
    assert_close(&ts(&can, [-5.0, 1.0, 0.0], [1.0, 1e-17, 0.0]), &[3.0, 7.0], 1e-14);
    assert_close(&ts(&can, [-5.0, 3.1, 0.0], [1.0, 0.0, 0.0]), &[], 0.0);
}

#[test]
fn a_paraboloid_is_met_where_the_formula_says() {
    // x = 2t, y = 4t²: y = x².
    let bowl = lathe(&[[0.0, 0.0], [2.0 / 3.0, 0.0], [4.0 / 3.0, 4.0 / 3.0], [2.0, 4.0]], false, None);
    assert!(!bowl.is_solid());
    for (o, d) in [
        ([0.2, 7.0, -0.3], [0.1, -1.0, 0.05]),
        ([-4.0, 1.5, -3.0], [1.0, -0.2, 0.8]),
        ([3.0, 0.5, 0.1], [-1.0, 0.03, 0.02]),
        ([-0.5, 3.0, 9.0], [0.01, -0.3, -1.0]),
        ([-0.5, 1.0, 9.0], [0.01, 0.0, -1.0]),
        ([-3.0, 0.25, 0.0], [1.0, 0.0, 0.0]),
    ] {
        let ([ox, oy, oz], [dx, dy, dz]) = (o, d);
        let (a, b, c): (f64, f64, f64) =
            (dx * dx + dz * dz, 2.0 * (ox * dx + oz * dz) - dy, ox * ox + oz * oz - oy);
        let root = (b * b - 4.0 * a * c).sqrt();
        let inside = |t: &f64| (0.0..=4.0).contains(&(oy + t * dy));
        let expected: Vec<f64> =
            [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)].into_iter().filter(inside).collect();
        assert!(!expected.is_empty());
        assert_close(&ts(&bowl, o, d), &expected, 1e-12);
    }
    // Grazing its flank, level.
    for delta in [1e-4f64, 1e-8, 1e-12] {
        let half = (1.0 - (1.0 - delta) * (1.0 - delta)).sqrt();
        let found = ts(&bowl, [-5.0, 1.0, 1.0 - delta], [1.0, 0.0, 0.0]);
        assert_close(&found, &[5.0 - half, 5.0 + half], 4e-15 / half);
        assert_close(&ts(&bowl, [-5.0, 1.0, 1.0 + delta], [1.0, 0.0, 0.0]), &[], 0.0);
    }
}

/// A closed profile that winds about.
fn wild(seed: u64) -> Lathe {
    let mut state = seed.wrapping_mul(7919) + 3;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let points: Vec<DVec2> = (0..9).map(|_| DVec2::new(0.1 + 2.0 * next(), 3.0 * next())).collect();
    let curve = Curve::bspline(&points, crate::geometry::curve::Ends::Closed, None).unwrap();
    Lathe::new(&of_curve(&curve), true, None).unwrap()
}

#[test]
fn meetings_of_closed_profiles_are_even_and_lie_on_them() {
    let (mut lines, mut met) = (0, 0);
    for seed in 0..10 {
        let lathe = wild(seed);
        for k in 0..400u32 {
            let (s, c) = sin_cos(f64::from(k) * 1.7);
            let o = DVec3::new(6.0 * c, 1.5 + 3.0 * sin_cos(f64::from(k)).0, 6.0 * s);
            let aim = DVec3::new(
                f64::from(k % 7) * 0.3 - 1.0,
                f64::from(k % 11) * 0.3,
                f64::from(k % 5) * 0.4 - 0.8,
            );
            let l = Line::new(o, aim - o).unwrap();
            let all = lathe.all(&l);
            lines += 1;
            met += all.len();
            assert_eq!(all.len() % 2, 0, "seed {seed}, {k}: {all:?}");
            assert!(all.windows(2).all(|w| w[0].t <= w[1].t));
            assert_eq!(lathe.first(&l, 0.0, 1e9), all.iter().find(|h| h.t > 0.0).copied());
            for hit in &all {
                let at = lathe.surface(&l, hit);
                assert!(at.point.distance(l.at(hit.t * l.length)) < 1e-12, "{at:?}");
            }
        }
    }
    assert!(met > lines, "{met} of {lines}");
}

#[test]
fn a_part_of_a_turn_has_flat_faces() {
    let wedge =
        lathe(&polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], false), false, Some(TAU / 4.0));
    // From x to −z: z runs from 0 to −2.
    assert_close(&ts(&wedge, [1.0, 0.5, 5.0], [0.0, 0.0, -1.0]), &[5.0, 5.0 + 3f64.sqrt()], 1e-14);
    assert_close(&ts(&wedge, [-1.0, 0.5, 5.0], [0.0, 0.0, -1.0]), &[], 0.0);
    assert_close(&ts(&wedge, [-5.0, 0.5, -1.0], [1.0, 0.0, 0.0]), &[5.0, 5.0 + 3f64.sqrt()], 1e-14);
    let l = line([1.0, 0.5, 5.0], [0.0, 0.0, -1.0]);
    let all = wedge.all(&l);
    assert_eq!(wedge.surface(&l, &all[0]).normal, DVec3::Z);
    let most =
        lathe(&polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], false), false, Some(TAU * 0.75));
    assert_close(&ts(&most, [1.0, 0.5, 5.0], [0.0, 0.0, -1.0]), &[5.0, 5.0 + 3f64.sqrt()], 1e-14);
    assert_close(
        &ts(&most, [-1.0, 0.5, 5.0], [0.0, 0.0, -1.0]),
        &[5.0 - 3f64.sqrt(), 5.0 + 3f64.sqrt()],
        1e-14,
    );
}

#[test]
fn a_thin_lip_near_the_axis_is_whole() {
    // A closed profile whose inner side is close to the axis, seen almost along it.
    let horn = [
        [0.001, 0.2],
        [0.001, 0.2],
        [0.06, 0.11],
        [0.06, 0.1],
        [0.06, 0.09],
        [0.07, 0.09],
        [0.07, 0.1],
        [0.07, 0.15],
        [0.05, 0.19],
        [0.04, 0.2],
        [0.3, 1.0],
        [0.5, 3.0],
        [1.0, 4.0],
        [0.98, 4.0],
        [0.4, 3.0],
        [0.02, 1.0],
        [0.002, 0.6],
        [0.001, 0.5],
    ];
    let lathe = lathe(&horn, true, None);
    for k in 0..3000u32 {
        let (s, c) = sin_cos(f64::from(k) * 0.37);
        let r = f64::from(k % 50) * 1e-3;
        let l = Line::new(DVec3::new(r * c, 9.0, r * s), DVec3::new(0.02 * s, -1.0, 0.013 * c)).unwrap();
        let all = lathe.all(&l);
        assert_eq!(all.len() % 2, 0, "{k}: {all:?}");
        for hit in &all {
            assert!(lathe.surface(&l, hit).point.distance(l.at(hit.t * l.length)) < 1e-12);
        }
    }
}

#[test]
fn what_makes_no_surface_is_said() {
    let make = |points: &[[f64; 2]]| {
        let points: Vec<DVec2> = points.iter().map(|p| DVec2::from(*p)).collect();
        Lathe::new(&of_curve(&Curve::bezier(&points, None, false).unwrap()), false, None)
    };
    let negative = make(&[[1.0, 0.0], [1.0, 1.0], [1.0, 2.0], [-0.5, 3.0]]).unwrap_err();
    assert_eq!(negative, LatheError::Negative { x: -0.5, at: 1.0 });
    assert_eq!(make(&[[0.0, 0.0], [0.0, 1.0], [0.0, 2.0], [0.0, 3.0]]).unwrap_err(), LatheError::Thin);
}
