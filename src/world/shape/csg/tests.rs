//! Solids put together against closed forms, flush faces, and what each point's inside says.

use super::*;
use crate::diag::SourceId;
use crate::scene;
use crate::world::shape::{Cone, Cuboid, Plane, Sphere};

const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };
use CsgOp::{Difference, Intersection, Union};

fn placed(shape: Shape, transform: Option<Affine>) -> Part {
    Part::Solid(Solid::Shape(shape), transform.map(Box::new), 0, SPAN)
}

fn ball(x: f64, y: f64, z: f64, radius: f64) -> Part {
    placed(Shape::Sphere(Sphere { center: DVec3::new(x, y, z), radius }), None)
}

fn block(min: DVec3, max: DVec3) -> Part {
    placed(Shape::Cuboid(Box::new(Cuboid { min, max })), None)
}

fn rod(from: DVec3, to: DVec3, radius: f64) -> Part {
    let cone = Cone::new(scene::Cone { from, to, radii: [radius; 2] }).expect("a proper cylinder");
    placed(Shape::Cone(Box::new(cone)), None)
}

fn below(normal: DVec3, offset: f64) -> Part {
    placed(Shape::Plane(Plane { normal, offset }), None)
}

fn ray(origin: DVec3, direction: DVec3) -> LocalRay {
    LocalRay::new(origin, direction).expect("a direction").0
}

fn along_z(x: f64, y: f64) -> LocalRay {
    ray(DVec3::new(x, y, -5.0), DVec3::Z)
}

/// Distances of all meetings, with the z of the outward normal.
fn hits(csg: &Csg, ray: &LocalRay) -> Vec<(f64, f64)> {
    let mut all = vec![];
    csg.crossings(ray, &mut all);
    all.iter().map(|meet| (meet.t, csg.surface(ray, meet).whole.geometric_normal.z)).collect()
}

#[test]
fn a_lens_of_two_balls() {
    let lens = Csg::new(Intersection, false, vec![ball(0.0, 0.0, -0.5, 1.0), ball(0.0, 0.0, 0.5, 1.0)]);
    assert_eq!(hits(&lens, &along_z(0.0, 0.0)), [(4.5, -1.0), (5.5, 1.0)]);
    let h = 0.5f64;
    let half = (1.0 - h * h).sqrt() - 0.5;
    let across = hits(&lens, &along_z(h, 0.0));
    assert!((across[0].0 - (5.0 - half)).abs() < 1e-15 && (across[1].0 - (5.0 + half)).abs() < 1e-15);
    // Its rim has the radius √¾.
    assert!(hits(&lens, &along_z(0.8661, 0.0)).is_empty());
    assert_eq!(hits(&lens, &along_z(0.8659, 0.0)).len(), 2);
    assert_eq!(lens.bounds(None).size().z, lens.bounds(None).max.z - lens.bounds(None).min.z);
    assert!((lens.bounds(None).size().z - 1.0).abs() < 1e-14, "{:?}", lens.bounds(None));
}

#[test]
fn a_bitten_ball_has_its_bite_seen_from_within() {
    let bitten = Csg::new(Difference, false, vec![ball(0.0, 0.0, 0.0, 1.0), ball(0.0, 0.0, -1.0, 0.5)]);
    assert_eq!(hits(&bitten, &along_z(0.0, 0.0)), [(4.5, -1.0), (6.0, 1.0)]);
    let inverse = Csg::new(Difference, true, vec![ball(0.0, 0.0, 0.0, 1.0), ball(0.0, 0.0, -1.0, 0.5)]);
    assert_eq!(hits(&inverse, &along_z(0.0, 0.0)), [(4.5, 1.0), (6.0, -1.0)]);
    assert_eq!(inverse.bounds(None), EVERYTHING);
    assert!(inverse.starts_inside(&along_z(0.0, 0.0)) && !bitten.starts_inside(&along_z(0.0, 0.0)));
}

#[test]
fn a_union_has_no_wall_inside_and_starts_within() {
    let both = Csg::new(Union, false, vec![ball(0.0, 0.0, -0.5, 1.0), ball(0.0, 0.0, 0.5, 1.0)]);
    assert_eq!(hits(&both, &along_z(0.0, 0.0)), [(3.5, -1.0), (6.5, 1.0)]);
    assert_eq!(hits(&both, &ray(DVec3::ZERO, DVec3::Z)), [(1.5, 1.0)]);
    assert!(both.starts_inside(&ray(DVec3::ZERO, DVec3::Z)));
}

#[test]
fn flush_faces_leave_neither_lid_nor_wall() {
    let one = DVec3::ONE;
    for k in 1..400 {
        // Faces at k/7, reached by different sums, so that rounding parts them.
        let top = f64::from(k) / 7.0;
        let sum = (0..k).fold(0.0, |s, _| s + 1.0 / 7.0);
        let hole = rod(DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.0, 0.0, sum), 0.5);
        let drilled = Csg::new(Difference, false, vec![block(-one, DVec3::new(1.0, 1.0, top)), hole]);
        let apart = (sum - top).abs();
        for x in [0.0, 0.1, 0.3] {
            for d in [DVec3::Z, DVec3::new(1e-3, 2e-3, 1.0), DVec3::new(0.01, 0.02, -1.0)] {
                let start = DVec3::new(x, 0.2, 0.0) - d * 100.0;
                let met = hits(&drilled, &ray(start, d));
                let lid = met.iter().any(|(t, _)| {
                    let p = ray(start, d).at(*t);
                    p.truncate().length() < 0.499
                });
                assert!(!lid || apart > 1e-14, "{k}: {met:?}, {apart:e} apart");
            }
        }
        let halves = vec![
            block(-one, DVec3::new(1.0, 1.0, top)),
            block(DVec3::new(-1.0, -1.0, sum), DVec3::new(1.0, 1.0, sum + 1.0)),
        ];
        let joined = Csg::new(Union, false, halves);
        let through = hits(&joined, &along_z(0.2, 0.3));
        assert!(through.len() == 2 || apart > 1e-14, "{k}: {through:?}, {apart:e} apart");
    }
}

#[test]
fn a_shared_face_belongs_to_the_first_and_knows_how_far_the_other_lies() {
    let (min, max) = (DVec3::splat(-1.0), DVec3::ONE);
    let turned = Affine::rotate_xyz(DVec3::new(90.0, 0.0, 0.0)).then(&Affine::rotate_xyz(DVec3::X * -90.0));
    let slightly = Affine::translate(DVec3::new(0.5, 0.0, 0.0)).then(&turned);
    let second = placed(Shape::Cuboid(Box::new(Cuboid { min, max })), Some(slightly));
    let both = Csg::new(Union, false, vec![block(min, max), second]);
    let from = along_z(0.5, 0.0);
    let meet = both.meet(&from, f64::MAX).expect("in front");
    assert_eq!(Csg::part_number(&meet), 0);
    let surface = both.surface(&from, &meet).whole;
    assert!(surface.error.z > 0.0 && surface.error.z < 1e-14, "{surface:?}");
}

#[test]
fn nested_solids_are_what_each_point_says() {
    let ring = || {
        let outer = rod(DVec3::new(0.0, 0.0, -0.5), DVec3::new(0.0, 0.0, 0.5), 1.0);
        let inner = rod(DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.0, 0.0, 1.0), 0.5);
        Part::Whole(Difference, false, vec![outer, inner])
    };
    let half = || below(DVec3::new(0.6, 0.0, 0.8), 0.1);
    let parts = vec![Part::Whole(Union, false, vec![ring(), ball(0.0, 0.0, 0.0, 0.4)]), half()];
    let whole = Csg::new(Intersection, false, parts);
    let inside = |p: DVec3| {
        let across = p.truncate().length();
        let ring = p.z.abs() < 0.5 && (0.5..1.0).contains(&across);
        (ring || p.length() < 0.4) && p.x * 0.6 + p.z * 0.8 < 0.1
    };
    assert_is_what_points_say(&whole, inside, 20_000);
}

/// Rays from everywhere are inside the whole exactly where its points are said to be.
fn assert_is_what_points_say(whole: &Csg, inside: impl Fn(DVec3) -> bool, cases: usize) {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    for case in 0..cases {
        let origin = DVec3::new(next(), next(), next()) * 1.5;
        let ray = ray(origin, DVec3::new(next(), next(), next()));
        let mut all = vec![];
        whole.crossings(&ray, &mut all);
        assert_eq!(whole.starts_inside(&ray), inside(origin), "case {case}");
        assert_eq!(all.len() % 2 == 1, inside(origin), "case {case}");
        let first = |limit: f64| all.first().filter(|meet| meet.t <= limit).map(|meet| (meet.t, meet.part));
        for limit in [f64::MAX, 1.0, 0.3, 0.01] {
            assert_eq!(whole.meet(&ray, limit).map(|meet| (meet.t, meet.part)), first(limit), "case {case}");
            assert_eq!(whole.meet_any(&ray, limit).is_some(), first(limit).is_some(), "case {case}");
        }
        let mut within = inside(origin);
        let mut before = 0.0;
        for meet in all.iter().copied().chain([Meet::at(10.0)]) {
            if meet.t - before > 1e-9 {
                assert_eq!(inside(ray.at((before + meet.t) / 2.0)), within, "case {case} at {}", meet.t);
            }
            if meet.t < 10.0 {
                let normal = whole.surface(&ray, &meet).whole.geometric_normal;
                assert_eq!(normal.dot(ray.direction) > 0.0, within, "case {case} at {}", meet.t);
            }
            (within, before) = (!within, meet.t);
        }
    }
}

/// |p|² − radius² as a function, in a box that does not cut it.
fn formula(radius: f64) -> Part {
    use crate::math::field::{Binary, FieldBuilder};
    let mut b = FieldBuilder::new(3);
    let squares: Vec<_> = (0..3).map(|i| b.binary(Binary::Mul, b.input(i), b.input(i))).collect();
    let sum = squares.into_iter().reduce(|x, y| b.binary(Binary::Add, x, y)).expect("three");
    let square = b.constant(radius * radius);
    let result = b.binary(Binary::Sub, sum, square);
    let field = b.finish(&[result]).expect("small");
    let function =
        scene::SampledFunction { field, input: scene::SampleInput::Point, span: SPAN, sites: vec![] };
    let half = DVec3::splat(1.25 * radius);
    let implicit = crate::world::shape::Implicit::new(Arc::new(function), -half, half, None);
    placed(Shape::Implicit(Arc::new(implicit)), None)
}

/// A formula is followed only where it matters: before, after and between the others' faces, and from inside of any of them.
#[test]
fn a_formula_is_met_whatever_it_is_put_together_with() {
    let corner = || block(DVec3::splat(0.1), DVec3::splat(1.2));
    let bar = || block(DVec3::new(-1.4, -0.2, -0.3), DVec3::new(1.4, 0.3, 0.2));
    let in_corner = |p: DVec3| p.min_element() > 0.1 && p.max_element() < 1.2;
    let in_bar = |p: DVec3| p.x.abs() < 1.4 && p.y > -0.2 && p.y < 0.3 && p.z > -0.3 && p.z < 0.2;
    let in_ball = |p: DVec3| p.length() < 0.9;
    let bitten = Csg::new(Difference, false, vec![formula(0.9), corner()]);
    assert_is_what_points_say(&bitten, |p| in_ball(p) && !in_corner(p), 4000);
    let hollow = Csg::new(Difference, false, vec![corner(), formula(0.9)]);
    assert_is_what_points_say(&hollow, |p| in_corner(p) && !in_ball(p), 4000);
    let both = Csg::new(Intersection, false, vec![bar(), formula(0.9)]);
    assert_is_what_points_say(&both, |p| in_bar(p) && in_ball(p), 4000);
    let joined = Csg::new(Union, false, vec![bar(), formula(0.9)]);
    assert_is_what_points_say(&joined, |p| in_bar(p) || in_ball(p), 4000);
    let parts = vec![Part::Whole(Difference, true, vec![formula(0.9), bar()]), corner()];
    let turned = Csg::new(Intersection, false, parts);
    assert_is_what_points_say(&turned, |p| !(in_ball(p) && !in_bar(p)) && in_corner(p), 4000);
}

#[test]
fn a_difference_with_much_taken_away_is_what_a_list_gives() {
    let holes = (0..200).map(|i| {
        let a = f64::from(i) * 2.4;
        let z = f64::from(i) / 100.0 - 1.0;
        let r = (1.0 - z * z).sqrt();
        ball(r * crate::math::elementary::cos(a), r * crate::math::elementary::sin(a), z, 0.06)
    });
    let golf = Csg::new(Difference, false, std::iter::once(ball(0.0, 0.0, 0.0, 1.0)).chain(holes).collect());
    let mut dimples = 0;
    for i in 0..400 {
        let (x, y) = (f64::from(i % 20) / 10.5 - 0.9, f64::from(i / 20) / 10.5 - 0.9);
        let Some(meet) = golf.meet(&along_z(x, y), f64::MAX) else { continue };
        let p = along_z(x, y).at(meet.t);
        let is_dimple = Csg::part_number(&meet) != 0;
        assert_eq!(is_dimple, p.length() < 1.0 - 1e-12, "{p}");
        dimples += u32::from(is_dimple);
    }
    assert!(dimples > 50, "{dimples}");
}
