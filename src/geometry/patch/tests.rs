//! Surfaces with known answers: polynomials that are bicubic patches exactly, collapsed edges, and patches without area.

use super::*;
use crate::geometry::curve::evaluate;

/// Bézier points of z = f(x, y) over [−1, 1]² for the paraboloid x² + y², moved up.
pub(super) fn paraboloid(lift: f64) -> Bicubic {
    let x = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
    let square = [1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0];
    graph(|i, j| DVec3::new(x[i], x[j], square[i] + square[j] + lift))
}

/// z = x³ − 3xy² over [−1, 1]².
fn monkey_saddle() -> Bicubic {
    let x = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
    let square = [1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0];
    let cube = [-1.0, 1.0, -1.0, 1.0];
    graph(|i, j| DVec3::new(x[i], x[j], cube[i] - 3.0 * x[i] * square[j]))
}

/// x = u(1−v), y = uv, z = u²: the surface z = (x + y)², its edge u = 0 collapsed to a point.
fn apex() -> Bicubic {
    let third = |i: usize| i as f64 / 3.0;
    let square = [0.0, 0.0, 1.0 / 3.0, 1.0];
    graph(|i, j| DVec3::new(third(i) * (1.0 - third(j)), third(i) * third(j), square[i]))
}

fn graph(point: impl Fn(usize, usize) -> DVec3) -> Bicubic {
    Bicubic { points: std::array::from_fn(|i| std::array::from_fn(|j| point(i, j))) }
}

/// A piece without symmetry.
pub(super) fn wild(seed: u32) -> Bicubic {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        f64::from(state >> 8) / f64::from(1 << 24) - 0.5
    };
    let mut points = [[DVec3::ZERO; 4]; 4];
    for (i, row) in points.iter_mut().enumerate() {
        for (j, p) in row.iter_mut().enumerate() {
            *p = DVec3::new(i as f64 + next(), j as f64 + next(), 2.0 * next());
        }
    }
    Bicubic { points }
}

fn ts(tree: &PatchTree, origin: [f64; 3], direction: [f64; 3]) -> Vec<f64> {
    let found = tree.all_hits(origin.into(), direction.into(), 0.0, f64::INFINITY);
    assert!(!found.unresolved, "{origin:?} {direction:?}");
    found.hits.iter().map(|h| h.t).collect()
}

fn assert_close(found: &[f64], expected: &[f64], bar: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= bar), "{found:?} {expected:?}");
}

#[test]
fn three_crossings_of_the_saddle_come_in_order() {
    let tree = PatchTree::new(&[monkey_saddle()]);
    let s = 0.75f64.sqrt();
    assert_close(&ts(&tree, [-5.0, 0.5, 0.0], [1.0, 0.0, 0.0]), &[5.0 - s, 5.0, 5.0 + s], 1e-12);
    let first = tree.first_hit(DVec3::new(-5.0, 0.5, 0.0), DVec3::X, 0.0, f64::INFINITY).unwrap();
    assert!((first.t - (5.0 - s)).abs() < 1e-12);
    // Other heights: x³ − 3xy² = z at x = 2y cos θ where cos 3θ = z / 2y³.
    for (y, z) in [(0.55f64, 0.2), (0.4, -0.09), (-0.52, 0.1), (0.3, 0.0)] {
        let inside = |x: &f64| x.abs() <= 1.0;
        let angle = crate::math::elementary::acos(z / (2.0 * y * y * y)) / 3.0;
        let root = |k: f64| 2.0 * y * crate::math::elementary::cos(angle + k * std::f64::consts::TAU / 3.0);
        let mut x: Vec<f64> = [0.0, 1.0, 2.0].map(root).into_iter().filter(inside).collect();
        x.sort_by(f64::total_cmp);
        let expected: Vec<f64> = x.iter().map(|x| (x + 5.0) / 2.0).collect();
        assert_close(&ts(&tree, [-5.0, y, z], [2.0, 0.0, 0.0]), &expected, 1e-12);
    }
}

#[test]
fn slanted_rays_meet_the_paraboloid_where_the_formula_says() {
    let tree = PatchTree::new(&[paraboloid(0.0)]);
    for (o, d) in [
        ([0.2, -0.3, 5.0], [0.1, 0.05, -1.0]),
        ([-4.0, -3.0, 1.5], [1.0, 0.8, -0.2]),
        ([3.0, 0.1, 0.5], [-1.0, 0.02, 0.03]),
        ([-0.5, 9.0, 3.0], [0.01, -1.0, -0.3]),
    ] {
        // z = x² + y² along the ray: a t² + b t + c = 0.
        let [ox, oy, oz] = o;
        let [dx, dy, dz]: [f64; 3] = d;
        let (a, b, c) = (dx * dx + dy * dy, 2.0 * (ox * dx + oy * dy) - dz, ox * ox + oy * oy - oz);
        let root = (b * b - 4.0 * a * c).sqrt();
        let inside = |t: &f64| (ox + t * dx).abs() <= 1.0 && (oy + t * dy).abs() <= 1.0 && *t > 0.0;
        let expected: Vec<f64> =
            [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)].into_iter().filter(inside).collect();
        assert!(!expected.is_empty());
        assert_close(&ts(&tree, o, d), &expected, 1e-12);
    }
}

#[test]
fn grazing_rays_part_to_the_last_digits_and_near_misses_miss() {
    let tree = PatchTree::new(&[paraboloid(0.0)]);
    for delta in [1e-4, 1e-8, 1e-12, 3e-10, 7e-13] {
        let root = f64::sqrt(delta);
        let bar = 2e-15 / root;
        assert_close(&ts(&tree, [-5.0, 0.0, delta], [1.0, 0.0, 0.0]), &[5.0 - root, 5.0 + root], bar);
        // In a general direction: through (0, 0, δ), along the level line.
        let (s, c) = (0.6, 0.8);
        assert_close(&ts(&tree, [-5.0 * c, -5.0 * s, delta], [c, s, 0.0]), &[5.0 - root, 5.0 + root], bar);
    }
    for delta in [-1e-12, -1e-11, -1e-6, -3e-13] {
        assert_close(&ts(&tree, [-5.0, 0.0, delta], [1.0, 0.0, 0.0]), &[], 0.0);
        assert_close(&ts(&tree, [-4.0, -3.0, delta], [0.8, 0.6, 0.0]), &[], 0.0);
    }
}

#[test]
fn an_exact_tangent_is_a_hit_on_the_surface_or_none() {
    let tree = PatchTree::new(&[paraboloid(0.0)]);
    for t in ts(&tree, [-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]) {
        assert!((t - 5.0).abs() < 1e-7, "{t}");
    }
}

#[test]
fn no_ray_at_a_point_of_the_surface_misses_it() {
    for seed in 0..12 {
        let piece = wild(seed);
        let tree = PatchTree::new(&[piece]);
        for k in 0..400u32 {
            let (u, v) = (f64::from(k % 20) / 19.0, f64::from(k / 20) / 19.0);
            let target = piece.at(u, v);
            let origin = DVec3::new(f64::from(k % 7) - 3.0, f64::from(k % 5) - 1.0, 6.0);
            let found = tree.all_hits(origin, target - origin, 0.0, f64::INFINITY);
            let near = found.hits.iter().map(|h| (h.t - 1.0).abs()).fold(f64::INFINITY, f64::min);
            assert!(near < 1e-9, "seed {seed}, ({u}, {v}): {near}");
            let first = tree.first_hit(origin, target - origin, 0.0, f64::INFINITY).unwrap();
            assert_eq!(first.t, found.hits[0].t);
            assert!(tree.any_hit(origin, target - origin, 0.0, f64::INFINITY));
            assert!(found.hits.windows(2).all(|w| w[0].t <= w[1].t));
            for h in &found.hits {
                assert!(h.point.distance(origin + (target - origin) * h.t) < 1e-13 * 20.0);
                assert!(h.point.distance(piece.at(h.u, h.v)) < 1e-14 * 20.0);
            }
        }
    }
}

#[test]
fn crossings_of_a_closed_tube_come_in_pairs() {
    // A ring of B-spline pieces around an axis and closed ends would be a solid; without ends, rays across the axis cross it twice.
    let ring = |k: usize| crate::math::elementary::sin_cos_degrees(60.0 * k as f64);
    let points: Vec<DVec3> = (0..9)
        .flat_map(|k| (0..5).map(move |z| (k, z)))
        .map(|(k, z)| {
            let (s, c) = ring(k);
            DVec3::new(c, s, f64::from(z))
        })
        .collect();
    let patch = Patch::new(PatchBasis::BSpline, &points, Some((9, 5))).unwrap();
    assert_eq!(patch.layout(), Layout::Grid { rows: 6, columns: 2 });
    let tree = PatchTree::new(patch.pieces());
    for k in 0..500 {
        let angle = f64::from(k) * 1.234_5;
        let (s, c) = crate::math::elementary::sin_cos_degrees(angle);
        let o = DVec3::new(5.0 * c, 5.0 * s, 1.5 + f64::from(k % 11) / 10.0);
        let aim = DVec3::new(0.3 * s, 0.1, 2.0);
        let found = tree.all_hits(o, aim - o, 0.0, f64::INFINITY);
        assert_eq!(found.hits.len(), 2, "{k}: {found:?}");
    }
    // Straight at seams, where two or four pieces meet.
    for (r, c) in (0..6).flat_map(|r| (0..3).map(move |c| (r, c))) {
        let seam = patch.at(f64::from(r) / 6.0, f64::from(c) / 2.0).unwrap();
        let o = DVec3::new(seam.x * 4.0, seam.y * 4.0, seam.z);
        let found = tree.all_hits(o, DVec3::new(-seam.x, -seam.y, 0.0), 0.0, f64::INFINITY);
        assert_eq!(found.hits.len(), if c == 1 { 2 } else { found.hits.len() }, "{r} {c}: {found:?}");
        assert!(!found.hits.is_empty());
    }
}

#[test]
fn scale_and_distance_change_no_answer() {
    let piece = wild(3);
    let (o, d) = (DVec3::new(0.3, 1.1, 7.0), DVec3::new(0.15, 0.1, -1.0));
    let plain = PatchTree::new(&[piece]).all_hits(o, d, 0.0, f64::INFINITY);
    for k in [-40, -20, 20, 40] {
        let s = crate::math::elementary::powi(2.0, k);
        let scaled = Bicubic { points: piece.points.map(|row| row.map(|p| p * s)) };
        let found = PatchTree::new(&[scaled]).all_hits(o * s, d, 0.0, f64::INFINITY);
        let ts: Vec<f64> = found.hits.iter().map(|h| h.t / s).collect();
        assert_eq!(ts, plain.hits.iter().map(|h| h.t).collect::<Vec<_>>());
    }
    for length in [1e160, 1e-160] {
        let found = PatchTree::new(&[piece]).all_hits(o, d * length, 0.0, f64::INFINITY);
        let ts: Vec<f64> = found.hits.iter().map(|h| h.t * length).collect();
        assert_close(&ts, &plain.hits.iter().map(|h| h.t).collect::<Vec<_>>(), 1e-12);
    }
}

#[test]
fn pieces_without_area_are_missed_at_once() {
    let point = graph(|_, _| DVec3::ONE);
    let line = graph(|i, j| DVec3::X * (i as f64 + 0.3 * j as f64));
    let bow_tie = graph(|i, j| {
        let s = (i as f64 - 1.5) * (j as f64 - 1.5);
        DVec3::new(s, i as f64, 0.0)
    });
    let flat = graph(|i, j| DVec3::new(i as f64, j as f64, 0.0));
    let started = std::time::Instant::now();
    for piece in [point, line] {
        let tree = PatchTree::new(&[piece]);
        assert_eq!(ts(&tree, [1.0, 1.0, 5.0], [0.0, 0.0, -1.0]), [0.0; 0]);
        assert_eq!(ts(&tree, [0.5, 0.0, 5.0], [0.0, 0.0, -1.0]), [0.0; 0]);
        assert_eq!(piece.normal(0.5, 0.5), None);
        assert_eq!(piece.curvature(0.5, 0.5), None);
    }
    for piece in [bow_tie, flat] {
        let tree = PatchTree::new(&[piece]);
        // In its own plane, and across it.
        let edge_on = tree.all_hits(DVec3::new(-5.0, 1.3, 0.0), DVec3::X, 0.0, f64::INFINITY);
        assert!(edge_on.hits.iter().all(|h| h.t.is_finite()));
        let across = tree.all_hits(DVec3::new(0.4, 1.3, 5.0), -DVec3::Z, 0.0, f64::INFINITY);
        assert!(across.hits.iter().all(|h| (h.t - 5.0).abs() < 1e-14));
    }
    assert_eq!(ts(&PatchTree::new(&[flat]), [0.4, 1.3, 5.0], [0.0, 0.0, -1.0]), [5.0]);
    assert!(started.elapsed().as_secs_f64() < 1.0);
    let nothing = PatchTree::new(&[]);
    assert!(nothing.first_hit(DVec3::ZERO, DVec3::X, 0.0, 1.0).is_none());
    assert!(PatchTree::new(&[flat]).first_hit(DVec3::ZERO, DVec3::ZERO, 0.0, 1.0).is_none());
}

#[test]
fn normals_at_collapsed_edges_are_limits() {
    let piece = apex();
    for v in [0.0, 0.2, 0.5, 0.77, 1.0] {
        let n = piece.normal(0.0, v).unwrap();
        assert!(n.distance(DVec3::Z) <= 1e-9, "{n}");
        // Just inside, the normal is that of z = (x + y)².
        let inside = piece.normal(1e-7, v).unwrap();
        assert!(inside.distance(DVec3::Z) <= 1e-6, "{inside}");
    }
    // The same surface with its collapsed edge at u = 1, v = 0 or v = 1, and mirrored: the limit keeps the side of ∂u × ∂v.
    let flipped = Bicubic { points: [piece.points[3], piece.points[2], piece.points[1], piece.points[0]] };
    assert!(flipped.normal(1.0, 0.3).unwrap().distance(-DVec3::Z) <= 1e-9);
    assert!(piece.transposed().normal(0.3, 0.0).unwrap().distance(-DVec3::Z) <= 1e-9);
    assert!(flipped.transposed().normal(0.3, 1.0).unwrap().distance(DVec3::Z) <= 1e-9);
}

#[test]
fn a_corner_where_both_tangents_vanish_has_a_normal() {
    let mut piece = graph(|i, j| DVec3::new(i as f64, j as f64, 0.0));
    piece.points[0][1] = piece.points[0][0];
    piece.points[1][0] = piece.points[0][0];
    assert!(piece.normal(0.0, 0.0).unwrap().distance(DVec3::Z) <= 1e-9);
}

#[test]
fn every_pole_of_the_teapot_has_a_finite_normal() {
    let Some(data) = std::env::var_os("OGEE_DATA") else {
        eprintln!("skipped: OGEE_DATA is not set");
        return;
    };
    for name in ["teapot", "teacup", "teaspoon"] {
        let path = std::path::Path::new(&data).join("patches").join(format!("{name}.bpt"));
        let pieces = bpt::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
        for (index, piece) in pieces.iter().enumerate() {
            for k in 0..81 {
                let (u, v) = (f64::from(k % 9) / 8.0, f64::from(k / 9) / 8.0);
                let n = piece.normal(u, v);
                assert!(
                    n.is_some_and(|n| (n.length() - 1.0).abs() < 1e-14),
                    "{name} {index} at ({u}, {v}): {n:?}"
                );
            }
        }
    }
}

#[test]
fn derivatives_agree_with_differences() {
    for seed in 0..6 {
        let piece = wild(seed);
        let (u, v, h) = (0.37, 0.61, 1e-5);
        let jet = piece.jet(u, v);
        let difference = |a: DVec3, b: DVec3| (a - b) / (2.0 * h);
        assert!(difference(piece.at(u + h, v), piece.at(u - h, v)).distance(jet.du) < 1e-8);
        assert!(difference(piece.at(u, v + h), piece.at(u, v - h)).distance(jet.dv) < 1e-8);
        assert!(difference(piece.jet(u + h, v).du, piece.jet(u - h, v).du).distance(jet.duu) < 1e-7);
        assert!(difference(piece.jet(u, v + h).du, piece.jet(u, v - h).du).distance(jet.duv) < 1e-7);
        assert!(difference(piece.jet(u, v + h).dv, piece.jet(u, v - h).dv).distance(jet.dvv) < 1e-7);
        let [p, du, dv] = piece.first_order(u, v);
        assert!(p.distance(jet.point) < 1e-14 && du.distance(jet.du) < 1e-13 && dv.distance(jet.dv) < 1e-13);
        assert!(p.distance(piece.at(u, v)) < 1e-14 && p.distance(piece.fast_at(u, v)) < 1e-14);
    }
}

#[test]
fn curvature_of_paraboloid_and_saddle() {
    // At the bottom of z = x² + y², K = 4 and H = 2, seen from above; where z = x³ − 3xy² is flat, both are 0.
    let bowl = paraboloid(0.0).curvature(0.5, 0.5).unwrap();
    assert!((bowl.gaussian - 4.0).abs() < 1e-12 && (bowl.mean - 2.0).abs() < 1e-12, "{bowl:?}");
    assert!(bowl.principal().iter().all(|k| (k - 2.0).abs() < 1e-6));
    let flat = monkey_saddle().curvature(0.5, 0.5).unwrap();
    assert!(flat.gaussian.abs() < 1e-12 && flat.mean.abs() < 1e-12);
}

#[test]
fn parts_are_the_surface_they_were_cut_from() {
    let piece = wild(5);
    let [low, high] = piece.split_u(0.3);
    assert_eq!(low.edge(Edge::EndU), high.edge(Edge::StartU));
    let part = piece.part((0.2, 0.9), (0.1, 0.55));
    for (a, b) in [(0.0, 0.0), (1.0, 1.0), (0.3, 0.8)] {
        let there = piece.at(0.2 + 0.7 * a, 0.1 + 0.45 * b);
        assert!(part.at(a, b).distance(there) < 2e-15 * 8.0);
        assert!(low.at(a, b).distance(piece.at(0.3 * a, b)) < 2e-15 * 8.0);
    }
    let patch = Patch::new(PatchBasis::Bezier, &piece.points.into_iter().flatten().collect::<Vec<_>>(), None)
        .unwrap();
    let quarters = patch.split(0.3, 0.6).unwrap();
    assert!(quarters[2].at(0.5, 0.5).unwrap().distance(patch.at(0.65, 0.3).unwrap()) < 1e-14);
    assert_eq!(patch.split(0.0, 0.5), Err(PatchError::SplitAtEdge { at: 0.0 }));
}

#[test]
fn edges_are_their_own_curves_to_the_bit() {
    let piece = wild(8);
    for k in 0..=16 {
        let t = f64::from(k) / 16.0;
        assert_eq!(piece.fast_at(0.0, t), evaluate::bernstein(&piece.edge(Edge::StartU), t));
        assert_eq!(piece.fast_at(1.0, t), evaluate::bernstein(&piece.edge(Edge::EndU), t));
        assert_eq!(piece.fast_at(t, 0.0), evaluate::bernstein(&piece.edge(Edge::StartV), t));
        assert_eq!(piece.fast_at(t, 1.0), evaluate::bernstein(&piece.edge(Edge::EndV), t));
    }
}

#[test]
fn grids_share_their_seams_and_are_counted_in_points_or_pieces() {
    let points = |rows: usize, columns: usize| -> Vec<DVec3> {
        let at = |(i, j): (usize, usize)| DVec3::new(i as f64, j as f64, ((i * 7 + j * 5) % 11) as f64 / 3.0);
        (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))).map(at).collect()
    };
    let by_points = Patch::new(PatchBasis::Bezier, &points(7, 4), Some((7, 4))).unwrap();
    let by_pieces = Patch::new(PatchBasis::Bezier, &points(7, 4), Some((2, 1))).unwrap();
    assert_eq!(by_points, by_pieces);
    assert_eq!(by_points.points(), points(7, 4));
    let spline = Patch::new(PatchBasis::BSpline, &points(6, 7), Some((6, 7))).unwrap();
    assert_eq!(spline.layout(), Layout::Grid { rows: 3, columns: 4 });
    for r in 0..3 {
        for c in 0..4 {
            let piece = &spline.pieces()[r * 4 + c];
            if c < 3 {
                assert_eq!(piece.edge(Edge::EndV), spline.pieces()[r * 4 + c + 1].edge(Edge::StartV));
            }
            if r < 2 {
                assert_eq!(piece.edge(Edge::EndU), spline.pieces()[(r + 1) * 4 + c].edge(Edge::StartU));
            }
        }
    }
    // A B-spline surface has no kinks: derivatives agree across the seam.
    let (before, after) =
        (spline.jet(1.0 / 3.0 - 1e-9, 0.4).unwrap(), spline.jet(1.0 / 3.0 + 1e-9, 0.4).unwrap());
    assert!(before.du.distance(after.du) < 1e-6 && before.duu.distance(after.duu) < 1e-4);
}

#[test]
fn what_makes_no_patch_is_said() {
    let p = vec![DVec3::ZERO; 15];
    assert_eq!(
        Patch::new(PatchBasis::Bezier, &p, None).unwrap_err(),
        PatchError::PointCount { expected: "16".into(), given: 15 }
    );
    assert!(matches!(Patch::new(PatchBasis::Bezier, &p, Some((3, 5))), Err(PatchError::GridShape { .. })));
    assert!(matches!(Patch::new(PatchBasis::BSpline, &p, Some((5, 5))), Err(PatchError::PointCount { .. })));
    assert!(Patch::new(PatchBasis::BSpline, &p, Some((usize::MAX, usize::MAX))).is_err());
    let mut p = vec![DVec3::ZERO; 16];
    p[7].y = f64::NAN;
    assert_eq!(Patch::new(PatchBasis::Bezier, &p, None).unwrap_err(), PatchError::NotFinite { index: 7 });
    let two = Patch::loose(vec![wild(1), wild(2)]);
    assert_eq!(two.at(0.5, 0.5), Err(PatchError::Loose { n_pieces: 2 }));
    assert!(two.piece(2).is_err());
    assert!(Patch::loose(vec![wild(1)]).at(0.5, 1.5).is_err());
}
