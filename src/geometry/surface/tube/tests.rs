//! Tubes against balls, cylinders, cones and rings with closed forms, and against the union of many balls.

use super::*;
use crate::geometry::curve::{CatmullRom, Curve, Ends};
use crate::geometry::function::FunctionPath;
use crate::geometry::surface::cubic::{of_curve, of_path};
use crate::math::elementary::sin_cos;
use std::convert::Infallible;

fn constant(r: f64) -> Vec<Cubic<f64>> {
    vec![Cubic { start: 0.0, end: 1.0, points: [r; 4] }]
}

fn linear(r: f64, s: f64) -> Vec<Cubic<f64>> {
    vec![Cubic { start: 0.0, end: 1.0, points: [r, r + (s - r) / 3.0, s + (r - s) / 3.0, s] }]
}

fn straight(a: DVec3, b: DVec3) -> Vec<Cubic<DVec3>> {
    vec![Cubic { start: 0.0, end: 1.0, points: [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b] }]
}

fn line(o: [f64; 3], d: [f64; 3]) -> Line {
    Line::new(DVec3::from(o), DVec3::from(d)).unwrap()
}

fn ts(tube: &Tube, o: [f64; 3], d: [f64; 3]) -> Vec<f64> {
    tube.all(&line(o, d)).iter().map(|h| h.t).collect()
}

fn assert_close(found: &[f64], expected: &[f64], bar: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} is not {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= bar, "{found:?} is not {expected:?}");
    }
}

/// Numbers in [−1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

fn wild(seed: u64) -> (Vec<Cubic<DVec3>>, Vec<Cubic<f64>>) {
    let mut random = Random(seed.wrapping_mul(7919) + 1);
    let points: Vec<DVec3> = (0..7).map(|_| random.vector() * 2.0).collect();
    let radii: Vec<f64> = (0..4).map(|_| 0.35 + 0.3 * random.next()).collect();
    let path = Curve::catmull_rom(&points, CatmullRom::default(), None, false).unwrap();
    let radius = Curve::bspline(&radii, Ends::Open, None).unwrap();
    (of_curve(&path), of_curve(&radius))
}

#[test]
fn a_straight_tube_is_a_capsule() {
    let (a, b) = (DVec3::new(-1.0, 0.5, 0.0), DVec3::new(2.0, 0.5, 0.0));
    let tube = Tube::new(&straight(a, b), &constant(0.5), false, Caps::Round).unwrap();
    assert_close(&ts(&tube, [0.3, 0.5, 5.0], [0.0, 0.0, -1.0]), &[4.5, 5.5], 1e-14);
    assert_close(&ts(&tube, [-5.0, 0.5, 0.0], [2.0, 0.0, 0.0]), &[1.75, 3.75], 1e-14);
    // Past the end, through the ball.
    assert_close(&ts(&tube, [2.3, 0.5, 5.0], [0.0, 0.0, -1.0]), &[4.6, 5.4], 1e-14);
    // Grazing: half chord √(2rδ).
    for delta in [1e-4f64, 1e-8, 1e-12] {
        let half = (delta * (1.0 - delta)).sqrt();
        let found = ts(&tube, [0.3, 1.0 - delta, 5.0], [0.0, 0.0, -1.0]);
        assert_close(&found, &[5.0 - half, 5.0 + half], 1e-15 / half);
        assert_close(&ts(&tube, [0.3, 1.0 + delta, 5.0], [0.0, 0.0, -1.0]), &[], 0.0);
    }
}

#[test]
fn a_widening_tube_is_a_cone_between_balls() {
    let (a, b) = (DVec3::ZERO, DVec3::new(0.0, 4.0, 0.0));
    let tube = Tube::new(&straight(a, b), &linear(0.5, 1.5), false, Caps::Round).unwrap();
    // The cone that touches all balls has sine ¼: at height y its radius is (0.5 + y/4)/√(1 − 1/16).
    for y in [1.0, 2.0, 3.2] {
        let radius = (0.5 + y / 4.0) / (1.0f64 - 1.0 / 16.0).sqrt();
        assert_close(&ts(&tube, [-5.0, y, 0.0], [1.0, 0.0, 0.0]), &[5.0 - radius, 5.0 + radius], 1e-13);
    }
    let hit = tube.first(&line([-5.0, 2.0, 0.0], [1.0, 0.0, 0.0]), 0.0, 100.0).unwrap();
    let at = tube.surface(&line([-5.0, 2.0, 0.0], [1.0, 0.0, 0.0]), &hit);
    let expected = DVec3::new(-(1.0f64 - 1.0 / 16.0).sqrt(), -0.25, 0.0);
    assert!(at.normal.distance(expected) < 1e-12, "{at:?}");
}

#[test]
fn flat_caps_cut_and_open_ends_let_through() {
    let (a, b) = (DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0));
    let flat = Tube::new(&straight(a, b), &constant(1.0), false, Caps::Flat).unwrap();
    assert_close(&ts(&flat, [-5.0, 0.2, 0.1], [1.0, 0.0, 0.0]), &[5.0, 9.0], 1e-14);
    assert_close(&ts(&flat, [-0.1, 5.0, 0.0], [0.0, -1.0, 0.0]), &[], 0.0);
    assert_close(&ts(&flat, [0.1, 5.0, 0.0], [0.0, -1.0, 0.0]), &[4.0, 6.0], 1e-14);
    // Out through the plane of the start.
    let slanted = line([2.0, 0.0, 0.0], [-1.0, 0.25, 0.0]);
    let out = flat.first(&slanted, 0.0, 100.0).unwrap();
    assert!((out.t - 2.0).abs() < 1e-14);
    assert_eq!(flat.surface(&slanted, &out).normal, -DVec3::X);
    let open = Tube::new(&straight(a, b), &constant(1.0), false, Caps::Open).unwrap();
    assert!(!open.is_solid() && flat.is_solid());
    assert_close(&ts(&open, [-5.0, 0.2, 0.1], [1.0, 0.0, 0.0]), &[], 0.0);
    // In at the open end, out through the wall.
    assert_close(&ts(&open, [-1.0, 0.0, 0.0], [1.0, 0.5, 0.0]), &[2.0], 1e-14);
}

#[test]
fn a_ring_of_a_tube_is_a_torus() {
    let at = |t: f64| {
        let (s, c) = sin_cos(t);
        DVec3::new(3.0 * c, 0.0, 3.0 * s)
    };
    let path = FunctionPath::fit(0.0, std::f64::consts::TAU, |t| Ok::<_, Infallible>(at(t))).unwrap();
    let (pieces, _) = of_path(&path);
    let tube = Tube::new(&pieces, &constant(1.0), true, Caps::Round).unwrap();
    let bar = 1e-6;
    assert_close(&ts(&tube, [-10.0, 0.0, 0.0], [1.0, 0.0, 0.0]), &[6.0, 8.0, 12.0, 14.0], bar);
    assert_close(&ts(&tube, [-10.0, 0.6, 0.0], [1.0, 0.0, 0.0]), &[6.2, 7.8, 12.2, 13.8], bar);
    assert_close(&ts(&tube, [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]), &[], 0.0);
    assert_close(
        &ts(&tube, [2.5, 5.0, 0.0], [0.0, -1.0, 0.0]),
        &[5.0 - 0.75f64.sqrt(), 5.0 + 0.75f64.sqrt()],
        bar,
    );
    // Inside, the first meeting is the way out.
    let hit = tube.first(&line([3.0, 0.0, 0.0], [0.0, 1.0, 0.0]), 0.0, 100.0).unwrap();
    assert!((hit.t - 1.0).abs() < bar);
}

/// The stretches of a line inside ten thousand balls of the tube, joined.
fn by_balls(path: &[Cubic<DVec3>], radius: &[Cubic<f64>], line: &Line) -> Vec<f64> {
    let mut spans: Vec<(f64, f64)> = Vec::new();
    for (curve, radius) in together(path, radius) {
        for k in 0..=4000 {
            let x = f64::from(k) / 4000.0;
            let (from, r) = (curve.at(x) - line.origin, radius.at(x));
            let a = from.dot(line.direction);
            let left = r * r - (from - line.direction * a).length_squared();
            if left >= 0.0 {
                spans.push((a - left.sqrt(), a + left.sqrt()));
            }
        }
    }
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut ends: Vec<f64> = Vec::new();
    for (low, high) in spans {
        match ends.last_mut() {
            Some(last) if low <= *last => *last = last.max(high),
            _ => ends.extend([low, high]),
        }
    }
    ends
}

#[test]
fn wild_tubes_are_the_union_of_their_balls() {
    let mut compared = 0;
    for seed in 0..12 {
        let (path, radius) = wild(seed);
        let tube = Tube::new(&path, &radius, false, Caps::Round).unwrap();
        let mut random = Random(seed + 100);
        for _ in 0..150 {
            let o = random.vector() * 6.0;
            let l = Line::new(o, random.vector() * 2.0 - o).unwrap();
            let expected = by_balls(&path, &radius, &l);
            let found: Vec<f64> = tube.all(&l).iter().map(|h| h.t * l.length).collect();
            // Where a stretch or a gap is shorter than the balls are apart, counting them is no judge.
            let is_clear = expected.windows(2).all(|w| w[1] - w[0] > 0.1);
            if !is_clear {
                continue;
            }
            compared += 1;
            assert_close(&found, &expected, 2e-5);
            let first = tube.first(&l, 0.0, 1e9).map(|h| h.t * l.length);
            assert_eq!(first, found.iter().copied().find(|s| *s > 0.0), "seed {seed}");
        }
    }
    assert!(compared > 1000, "{compared}");
}

#[test]
fn meetings_lie_on_the_surface_with_its_normal() {
    for seed in 0..8 {
        let (path, radius) = wild(seed);
        let tube = Tube::new(&path, &radius, false, Caps::Round).unwrap();
        let mut random = Random(seed + 50);
        for _ in 0..200 {
            let o = random.vector() * 5.0;
            let l = Line::new(o, random.vector() - o).unwrap();
            for hit in tube.all(&l) {
                let at = tube.surface(&l, &hit);
                let bar = 1e-7;
                assert!(at.point.distance(l.at(hit.t * l.length)) < bar, "{at:?}");
                assert!((at.normal.length() - 1.0).abs() < 1e-12);
                assert!((0.0..=1.0).contains(&at.uv.x) && (0.0..=1.0).contains(&at.uv.y), "{at:?}");
                // Just outside there is nothing, just inside there is.
                let beyond = Line::new(at.point + at.normal * 1e-4, at.normal).unwrap();
                let around = tube.all(&beyond);
                let inside = around.iter().filter(|h| h.t > 0.0).count() % 2 == 1;
                assert!(!inside || around.iter().any(|h| h.t.abs() < 1e-2), "seed {seed}: {around:?}");
            }
        }
    }
}

#[test]
fn a_sharp_turn_has_no_disc_and_no_veil() {
    // A curve that slows to a crowd of points in its middle, and one that turns on the spot.
    let crowd = [
        DVec3::new(-2.0, 0.0, 0.0),
        DVec3::ZERO,
        DVec3::new(0.025, 0.0, 0.0),
        DVec3::new(0.05, 0.0, 0.0),
        DVec3::new(0.075, 0.0, 0.0),
        DVec3::new(3.0, 0.0, 0.0),
    ];
    let path = Curve::catmull_rom(&crowd, CatmullRom::default(), None, false).unwrap();
    let tube = Tube::new(&of_curve(&path), &constant(0.2), false, Caps::Round).unwrap();
    for k in 0..4000 {
        let (y, z) = sin_cos(f64::from(k));
        let distance = 0.2 * (1.0 + (f64::from(k % 97) + 1.0) * 1e-3);
        // Past the tube, in a plane across it and slanted: nothing is there.
        for x in [-0.01, 0.0, 0.03] {
            let o = [x, y * distance - z * 5.0, z * distance + y * 5.0];
            assert_close(&ts(&tube, o, [0.0, z, -y]), &[], 0.0);
        }
    }
    let cusp =
        [DVec3::ZERO, DVec3::new(2.0, 1.0, 0.0), DVec3::new(-1.0, 1.0, 0.0), DVec3::new(1.0, 0.0, 0.0)];
    let path = [Cubic { start: 0.0, end: 1.0, points: cusp }];
    let tube = Tube::new(&path, &constant(0.1), false, Caps::Round).unwrap();
    for k in 0..300 {
        let (x, y) = (f64::from(k % 20) / 15.0 - 0.2, f64::from(k / 20) / 14.0);
        let l = line([x, y, 3.0], [0.0, 0.0, -1.0]);
        assert_close(&ts(&tube, [x, y, 3.0], [0.0, 0.0, -1.0]), &by_balls(&path, &constant(0.1), &l), 1e-5);
    }
}

#[test]
fn scale_and_distance_change_no_answer() {
    let (path, radius) = wild(3);
    let tube = Tube::new(&path, &radius, false, Caps::Round).unwrap();
    let o = DVec3::new(0.3, 1.1, 7.0);
    let d = path[2].at(0.4) - o;
    let plain = ts(&tube, o.to_array(), d.to_array());
    let far = ts(&tube, (o - d * 1e6).to_array(), d.to_array());
    assert!(!plain.is_empty());
    assert_close(&far.iter().map(|t| t - 1e6).collect::<Vec<_>>(), &plain, 1e-8);
    for scale in [1e-9, 1e9] {
        let path: Vec<_> = path.iter().map(|c| Cubic { points: c.points.map(|p| p * scale), ..*c }).collect();
        let radius: Vec<_> =
            radius.iter().map(|c| Cubic { points: c.points.map(|r| r * scale), ..*c }).collect();
        let tube = Tube::new(&path, &radius, false, Caps::Round).unwrap();
        let found = ts(&tube, (o * scale).to_array(), d.to_array());
        assert_close(&found.iter().map(|t| t / scale).collect::<Vec<_>>(), &plain, 1e-12);
    }
}

#[test]
fn what_makes_no_tube_is_said() {
    let path = straight(DVec3::ZERO, DVec3::X);
    let negative = Tube::new(&path, &linear(0.5, -0.5), false, Caps::Round).unwrap_err();
    assert_eq!(negative, TubeError::Negative { radius: -0.5, at: 1.0 });
    assert_eq!(Tube::new(&path, &constant(0.0), false, Caps::Round).unwrap_err(), TubeError::Thin);
    assert_eq!(Tube::new(&path, &constant(f64::NAN), false, Caps::Round).unwrap_err(), TubeError::NotFinite);
    // A curve that stands still is a ball.
    let still = straight(DVec3::Y, DVec3::Y);
    let ball = Tube::new(&still, &constant(1.0), false, Caps::Round).unwrap();
    assert_close(&ts(&ball, [0.0, 1.0, 5.0], [0.0, 0.0, -1.0]), &[4.0, 6.0], 1e-14);
}

#[test]
fn u_goes_round_and_v_along_without_a_seam() {
    let (path, radius) = wild(2);
    let tube = Tube::new(&path, &radius, false, Caps::Round).unwrap();
    let mut shares: Vec<(f64, f64)> = tube.arcs.iter().map(|a| a.shares).collect();
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(shares[0].0 == 0.0 && (shares[shares.len() - 1].1 - 1.0).abs() < 1e-12);
    assert!(shares.windows(2).all(|w| w[0].1 == w[1].0));
    for arc in &tube.arcs {
        if let Some(next) = tube.arcs.iter().find(|next| next.shares.0 == arc.shares.1) {
            assert!(arc.frame(1.0, 0.0).1.distance(next.frame(0.0, 0.0).1) < 1e-6);
        }
    }
}

#[test]
fn each_arc_is_the_union_of_its_balls_and_is_settled_soon() {
    let (mut worst, mut looks, mut rays) = (0.0f64, 0, 0);
    for seed in 0..12 {
        let (path, radius) = wild(seed);
        let tube = Tube::new(&path, &radius, false, Caps::Round).unwrap();
        let mut random = Random(seed + 100);
        for _ in 0..40 {
            let o = random.vector() * 6.0;
            let l = Line::new(o, random.vector() * 2.0 - o).unwrap();
            let planes = l.across();
            for (i, arc) in tube.arcs.iter().enumerate() {
                let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
                tube.spans(&l, &planes, i, (f64::NEG_INFINITY, f64::INFINITY), |s| {
                    looks += 1;
                    (low, high) = (low.min(s.low.s), high.max(s.high.s));
                });
                rays += usize::from(low < high);
                for k in 0..=500 {
                    let (c, r) = arc.at(f64::from(k) / 500.0);
                    let a = (c - l.origin).dot(l.direction);
                    let left = r * r - (c - l.at(a)).length_squared();
                    if left > 1e-9 {
                        worst = worst.max(low - (a - left.sqrt())).max(a + left.sqrt() - high);
                    }
                }
            }
        }
    }
    assert!(worst < 1e-10, "{worst}");
    assert!(rays > 500 && looks < 4 * rays, "{looks} stretches of {rays}");
}
