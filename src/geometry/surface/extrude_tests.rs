//! Prisms and sweeps against boxes, bent bars with closed forms, and each other.

use super::cubic::of_curve;
use super::outline::{Outline, OutlineError};
use super::prism::{Placing, Prism};
use super::sweep::{Sweep, SweepError};
use crate::geometry::boxes::Line;
use crate::geometry::curve::{Curve, Ends};
use crate::geometry::function::FunctionPath;
use crate::math::elementary::sin_cos;
use glam::{DVec2, DVec3};
use std::convert::Infallible;

fn polygon(corners: &[[f64; 2]]) -> Outline {
    let n = corners.len();
    let points: Vec<DVec2> = (0..n)
        .flat_map(|k| {
            let (a, b) = (DVec2::from(corners[k]), DVec2::from(corners[(k + 1) % n]));
            [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0)]
        })
        .collect();
    Outline::new(of_curve(&Curve::bezier(&points, None, true).unwrap())).unwrap()
}

fn blob() -> Outline {
    let points =
        [[1.0, 0.0], [0.8, 1.0], [-0.5, 0.4], [-1.0, -0.2], [-0.4, -1.0], [0.3, -0.2]].map(DVec2::from);
    Outline::new(of_curve(&Curve::bspline(&points, Ends::Closed, None).unwrap())).unwrap()
}

fn line(o: [f64; 3], d: [f64; 3]) -> Line {
    Line::new(DVec3::from(o), DVec3::from(d)).unwrap()
}

fn assert_close(found: &[f64], expected: &[f64], bar: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} is not {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= bar, "{found:?} is not {expected:?}");
    }
}

fn prism_ts(prism: &Prism, o: [f64; 3], d: [f64; 3]) -> Vec<f64> {
    prism.all(&line(o, d)).iter().map(|h| h.t).collect()
}

#[test]
fn a_square_along_z_is_a_box() {
    let square = polygon(&[[-1.0, -2.0], [1.0, -2.0], [1.0, 2.0], [-1.0, 2.0]]);
    let prism = Prism::new(square, Placing::across(DVec3::Z * 3.0).unwrap(), 3.0);
    assert_close(&prism_ts(&prism, [-5.0, 0.5, 1.0], [1.0, 0.0, 0.0]), &[4.0, 6.0], 1e-14);
    assert_close(&prism_ts(&prism, [0.2, 1.5, -5.0], [0.0, 0.0, 1.0]), &[5.0, 8.0], 1e-14);
    assert_close(&prism_ts(&prism, [1.2, 1.5, -5.0], [0.0, 0.0, 1.0]), &[], 0.0);
    assert_close(&prism_ts(&prism, [0.0, 0.0, -1.0], [0.5, 0.0, 1.0]), &[1.0, 2.0], 1e-14);
    let l = line([0.0, 0.0, -1.0], [0.5, 0.0, 1.0]);
    let all = prism.all(&l);
    assert_eq!(prism.surface(&l, &all[0]).normal, -DVec3::Z);
    assert!(prism.surface(&l, &all[1]).normal.distance(DVec3::X) < 1e-15);
}

#[test]
fn an_outline_stands_upright_or_lies_as_seen_from_above() {
    let z = Placing::across(DVec3::Z).unwrap();
    assert!(z.side.distance(DVec3::X) < 1e-15 && z.up.distance(DVec3::Y) < 1e-15);
    let y = Placing::across(DVec3::Y).unwrap();
    assert!(y.side.distance(DVec3::X) < 1e-15 && y.up.distance(-DVec3::Z) < 1e-15, "{y:?}");
    assert!(Placing::across(DVec3::ZERO).is_none());
}

#[test]
fn holes_wound_twice_are_open_and_meetings_even() {
    let star: Vec<[f64; 2]> = (0..5)
        .map(|k| sin_cos(f64::from(k) * 2.0 * std::f64::consts::TAU / 5.0))
        .map(|(s, c)| [c, s])
        .collect();
    let star = polygon(&star);
    assert!(
        !star.contains(DVec2::ZERO)
            && star.contains(DVec2::new(0.8, 0.0))
            && !star.contains(DVec2::new(1.1, 0.0))
    );
    let prism = Prism::new(star, Placing::across(DVec3::Z).unwrap(), 1.0);
    for k in 0..500 {
        let (s, c) = sin_cos(f64::from(k));
        let l = line([3.0 * c, 3.0 * s, 0.3], [-c + 0.1 * s, -s, 0.05 * c]);
        assert_eq!(prism.all(&l).len() % 2, 0);
    }
    // Straight at a corner, and along a side.
    assert_eq!(prism_ts(&prism, [5.0, 0.0, 0.5], [-1.0, 0.0, 0.0]).len() % 2, 0);
}

#[test]
fn a_sweep_along_a_straight_path_is_the_prism() {
    let points = [0.0, 1.0, 2.0, 3.0].map(|z| DVec3::new(0.0, 0.0, z));
    let path = Curve::bezier(&points, None, false).unwrap();
    let (prism, sweep) =
        (Prism::new(blob(), Placing::across(DVec3::Z).unwrap(), 3.0), Sweep::new(blob(), &path).unwrap());
    for k in 0..400u32 {
        let (s, c) = sin_cos(f64::from(k) * 1.3);
        let l = line([4.0 * c, 4.0 * s, 1.0 + 3.0 * c], [0.1 - c, 0.05 - s, 0.2 - 0.7 * c]);
        let (a, b) = (prism.all(&l), sweep.all(&l));
        assert_close(
            &b.iter().map(|h| h.t).collect::<Vec<_>>(),
            &a.iter().map(|h| h.t).collect::<Vec<_>>(),
            1e-9,
        );
        for (p, q) in a.iter().zip(&b) {
            let (p, q) = (prism.surface(&l, p), sweep.surface(&l, q));
            assert!(p.normal.distance(q.normal) < 1e-6, "{p:?} {q:?}");
        }
        assert_eq!(sweep.first(&l, 0.0, 1e9).map(|h| h.t), b.iter().map(|h| h.t).find(|t| *t > 0.0));
    }
}

#[test]
fn a_bar_bent_round_is_a_ring() {
    let at = |t: f64| {
        let (s, c) = sin_cos(t);
        DVec3::new(3.0 * c, 0.0, 3.0 * s)
    };
    let path = FunctionPath::fit(0.0, 3.0, |t| Ok::<_, Infallible>(at(t))).unwrap();
    let square = polygon(&[[-1.0, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]]);
    let ring = Sweep::new(square, &path).unwrap();
    let ts = |o, d| ring.all(&line(o, d)).iter().map(|h| h.t).collect::<Vec<_>>();
    let bar = 1e-5;
    assert_close(&ts([0.0, 0.2, -9.0], [0.0, 0.0, 1.0]), &[11.0, 13.0], bar);
    assert_close(&ts([0.0, 5.0, 3.2], [0.0, -1.0, 0.0]), &[4.5, 5.5], bar);
    // In by the flat face at the start, which looks to −z.
    assert_close(&ts([2.5, 0.1, -9.0], [0.0, 0.0, 1.0]), &[9.0, 9.0 + (16.0f64 - 6.25).sqrt()], bar);
}

#[test]
fn what_makes_no_prism_is_said() {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from);
    let open = Curve::bezier(&points, None, false).unwrap();
    let error = Outline::new(of_curve(&open)).unwrap_err();
    assert_eq!(error, OutlineError::Open { start: points[0], end: points[3] });
    let flat = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]].map(DVec2::from);
    let flat = Curve::bezier(&flat, None, true).unwrap();
    assert_eq!(Outline::new(of_curve(&flat)).unwrap_err(), OutlineError::Flat);
    let corner = [
        DVec3::ZERO,
        DVec3::X,
        DVec3::X * 2.0,
        DVec3::X * 3.0,
        DVec3::new(3.0, 1.0, 0.0),
        DVec3::new(3.0, 2.0, 0.0),
        DVec3::new(3.0, 3.0, 0.0),
    ];
    let corner = Curve::bezier(&corner, None, false).unwrap();
    assert!(matches!(Sweep::new(blob(), &corner), Err(SweepError::Corner { at, .. }) if at == 0.5));
    let still = Curve::bezier(&[DVec3::Y; 4], None, false).unwrap();
    assert_eq!(Sweep::new(blob(), &still).unwrap_err(), SweepError::Still);
}
