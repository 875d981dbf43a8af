//! Spheres, planes, boxes, cones and tori where formulas lose their digits.

use super::{Random, placed, ray, sphere, world};
use glam::DVec3;
use ogee::math::Affine;
use ogee::math::exact::Double;
use ogee::scene::{Cone, Shape, Torus};
use ogee::world::bvh::clip;
use ogee::world::{Ray, World};

fn ulp(x: f64) -> f64 {
    x.abs().next_up() - x.abs()
}

fn t_of(world: &World, ray: &Ray) -> Option<f64> {
    world.closest(ray).map(|hit| hit.t)
}

/// The near distance to a sphere in twice the working precision; none where the exact answer is a miss.
fn reference(origin: DVec3, d: DVec3, center: DVec3, radius: f64) -> Option<f64> {
    let dot = |a: [Double; 3], b: [Double; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (o, c) = (origin.to_array(), center.to_array());
    let f: [Double; 3] = std::array::from_fn(|i| Double::difference(c[i], o[i]));
    let d = d.to_array().map(Double::new);
    let a = dot(d, d);
    let approach = dot(f, d);
    let room = (Double::product(radius, radius) - dot(f, f)) * a + approach * approach;
    let half = room.value().max(0.0).sqrt();
    // The half chord is right to an ulp of its own, which is nothing beside the distance.
    (room.value() >= 0.0).then(|| (approach - Double::new(half)).value() / a.value())
}

#[test]
fn a_sphere_seen_from_afar_keeps_its_outline_and_its_distance() {
    let world = world(sphere(DVec3::ZERO, 1.0));
    let origin = DVec3::new(6e7, -5e7, 6.2e7);
    let across = origin.cross(DVec3::Y).normalize();
    for i in 0..400 {
        let aim = across * (-1.1 + 2.2 * f64::from(i) / 399.0);
        let ray = ray(origin, (aim - origin).normalize());
        let (found, exact) = (t_of(&world, &ray), reference(origin, ray.direction, DVec3::ZERO, 1.0));
        assert_eq!(found.is_some(), exact.is_some(), "ray {i}");
        if let (Some(t), Some(exact)) = (found, exact) {
            assert!((t - exact).abs() <= ulp(exact), "ray {i}: {t} {exact}");
        }
    }
}

#[test]
fn grazing_rays_meet_a_sphere_where_they_touch_it() {
    for k in 1..=14 {
        let height = 1.0 - ogee::math::elementary::powi(0.1, k);
        let world = world(sphere(DVec3::ZERO, 1.0));
        for origin in [DVec3::new(-3.0, height, 0.0), DVec3::new(0.25, height, -7.0)] {
            let d = if origin.x < 0.0 { DVec3::X } else { DVec3::Z };
            let exact = reference(origin, d, DVec3::ZERO, 1.0);
            let (t, exact) = (t_of(&world, &ray(origin, d)), exact);
            match (t, exact) {
                (Some(t), Some(exact)) => assert!((t - exact).abs() <= 4.0 * ulp(exact), "{k}: {t} {exact}"),
                (t, exact) => assert_eq!(t.is_some(), exact.is_some(), "{k} {origin}"),
            }
        }
    }
}

#[test]
fn a_planet_is_felt_under_the_feet() {
    let center = DVec3::new(0.0, -6.371e6, 0.0);
    let world = world(sphere(center, 6.371e6));
    let mut random = Random(3);
    for _ in 0..100 {
        let direction = DVec3::new(random.signed(), -0.2 - random.next(), random.signed()).normalize();
        let eye = DVec3::new(0.0, 1.7, 0.0);
        let t = t_of(&world, &ray(eye, direction)).expect("the ground");
        let exact = reference(eye, direction, center, 6.371e6).expect("the ground");
        assert!((t - exact).abs() <= 2e-9 * exact, "{t} {exact}");
    }
}

#[test]
fn the_length_of_a_direction_does_not_matter() {
    let shapes = [
        sphere(DVec3::ZERO, 1.0),
        Shape::Box(Box::new((DVec3::NEG_ONE, DVec3::ONE))),
        Shape::Torus(Box::new(Torus { center: DVec3::ZERO, axis: DVec3::Y, radii: [1.0, 0.25] })),
        Shape::Cone(Box::new(Cone { from: -DVec3::Y, to: DVec3::Y, radii: [1.0, 1.0] })),
        Shape::Plane { normal: DVec3::Y, offset: 0.0 },
    ];
    for shape in shapes {
        let turn = Affine::rotate(DVec3::new(0.6, 0.8, 0.0), 20.0);
        let world = placed(shape, turn);
        let origin = DVec3::new(4.0, 3.0, 2.0);
        let unit = ray(origin, (turn.point(DVec3::new(0.9, 0.0, 0.1)) - origin).normalize());
        let t = t_of(&world, &unit).expect("a hit");
        for size in [1e160, 1e-160] {
            let long = ray(origin, unit.direction * size);
            let scaled = t_of(&world, &long).expect("the same hit") * size;
            assert!((scaled - t).abs() <= 1e-14 * t, "{size}: {scaled} {t}");
        }
    }
}

#[test]
fn a_plane_is_met_at_its_distance_and_not_at_that_of_its_point() {
    let world = world(Shape::Plane { normal: DVec3::Y, offset: 1.0 });
    let hit = world.closest(&ray(DVec3::new(3.0, 5.0, 4.0), -DVec3::Y)).expect("below");
    assert_eq!((hit.t, hit.point), (4.0, DVec3::new(3.0, 1.0, 4.0)));
    assert!(world.closest(&ray(DVec3::new(3.0, 5.0, 4.0), DVec3::Y)).is_none());
}

#[test]
fn a_grazed_plane_is_met_on_itself_and_a_parallel_one_not_at_all() {
    let normal = DVec3::new(0.36, 0.48, 0.8);
    let normal = normal / normal.length();
    let world = world(Shape::Plane { normal, offset: 3.0 });
    let along = DVec3::new(0.8, -0.6, 0.0);
    for tilt in [1e-3, 1e-6, 1e-9, 1e-12] {
        let direction = (along - normal * tilt).normalize();
        let hit = world.closest(&ray(normal * 83.0, direction)).expect("met in the end");
        assert!((hit.t * tilt / 80.0 - 1.0).abs() < 1e-3, "{tilt}: {}", hit.t);
        let off = Double::product(normal.x, hit.point.x)
            + Double::product(normal.y, hit.point.y)
            + Double::product(normal.z, hit.point.z)
            - Double::new(3.0);
        let length = normal.length();
        assert!(off.value().abs() / length <= 4.0 * ulp(hit.point.abs().max_element()), "{tilt}: {off:?}");
    }
    let level = super::world(Shape::Plane { normal: DVec3::Y, offset: 0.0 });
    assert!(level.closest(&ray(DVec3::Y, DVec3::X)).is_none());
    assert!(level.closest(&ray(DVec3::ZERO, DVec3::X)).is_none());
}

#[test]
fn slabs_decide_rays_in_the_plane_of_a_side() {
    let unit = ogee::math::Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let hits = |origin: [f64; 3], direction: [f64; 3], bounds| {
        clip(&bounds, DVec3::from_array(origin), DVec3::from_array(direction), f64::MAX).is_some()
    };
    let flat = ogee::math::Aabb { min: DVec3::new(-1.0, -1.0, 0.0), max: DVec3::new(1.0, 1.0, 0.0) };
    let all = ogee::math::Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
    assert!(hits([0.0, 0.5, -1.0], [0.0, 0.0, 1.0], unit));
    assert!(hits([0.0, 0.5, -1.0], [-0.0, 0.0, 1.0], unit));
    assert!(hits([1.0, 0.5, -1.0], [0.0, 0.0, 1.0], unit));
    assert!(hits([0.5, 0.5, -1.0], [0.0, 0.0, 1.0], flat));
    assert!(hits([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0], flat));
    assert!(!hits([0.5, 0.5, 5.0], [0.0, 0.0, 1.0], unit), "behind");
    assert!(!hits([-0.5, 0.5, -1.0], [-0.0, 0.0, 1.0], unit), "beside");
    assert!(hits([7.0, -3.0, 2.0], [0.0, -0.0, 1.0], all));
    assert!(hits([0.5, 0.5, -1.0], [5e-324, 0.0, 1.0], unit));
    assert!(!hits([1.5, 0.5, -1.0], [5e-324, 0.0, 1.0], unit));
}

fn torus(radii: [f64; 2]) -> World {
    world(Shape::Torus(Box::new(Torus { center: DVec3::ZERO, axis: DVec3::Z, radii })))
}

#[test]
fn a_torus_is_as_exact_from_afar_as_from_near() {
    let world = torus([1.0, 0.25]);
    for scale in [1.0, 1e2, 1e4] {
        let target = DVec3::new(1.1, 0.05, 0.1);
        let origin = target + (DVec3::new(-1e5, 3e4, 2e4) - target) / 1e4 * scale;
        let hit = world.closest(&ray(origin, (target - origin).normalize())).expect("a hit");
        let ring = DVec3::new(hit.point.x, hit.point.y, 0.0).normalize();
        assert!(((hit.point - ring).length() - 0.25).abs() < 1e-15, "on the surface");
        let p = origin + (target - origin).normalize() * hit.t;
        let ring = DVec3::new(p.x, p.y, 0.0).normalize();
        let cosine = hit.normal.dot((target - origin).normalize()).abs();
        let off = ((p - ring).length() - 0.25).abs() / cosine;
        assert!(off <= 16.0 * ulp(hit.t), "{scale}: {off:e}");
    }
}

/// All distances along a ray, each found beyond the last.
fn all_hits(world: &World, start: &Ray) -> Vec<f64> {
    let (mut ray, mut travelled, mut found) = (*start, 0.0, Vec::new());
    while let Some(hit) = world.closest(&ray) {
        found.push(travelled + hit.t);
        let origin = ray.origin + ray.direction * (hit.t + 1e-12);
        travelled += hit.t + 1e-12;
        ray = Ray { origin, ..ray };
        assert!(found.len() < 10, "{found:?}");
    }
    found
}

#[test]
fn rays_that_touch_a_torus_hit_it_there_or_not_at_all() {
    let world = torus([1.0, 0.25]);
    let off_surface = |hit: f64, start: &Ray| {
        let p = start.origin + start.direction * hit;
        let ring = DVec3::new(p.x, p.y, 0.0).normalize();
        ((p - ring).length() - 0.25).abs()
    };
    let inner = ray(DVec3::new(0.75, -5.0, 0.0), DVec3::Y);
    let through = all_hits(&world, &inner);
    for (t, truth) in [(through[0], 4.0), (through[through.len() - 1], 6.0)] {
        assert!((t - truth).abs() < 1e-11, "{through:?}");
    }
    for t in &through[1..through.len() - 1] {
        assert!((t - 5.0).abs() < 1e-8 && off_surface(*t, &inner) <= 1e-9, "{through:?}");
    }
    let top = ray(DVec3::new(1.0, -5.0, 0.25), DVec3::Y);
    for t in all_hits(&world, &top) {
        assert!((t - 5.0).abs() < 1e-11, "{t}");
    }
    let below = all_hits(&world, &ray(DVec3::new(1.0, -5.0, 0.25 - 1e-8), DVec3::Y));
    for (t, truth) in [(below[0], 4.988_107_718_69), (below[below.len() - 1], 5.011_892_281_31)] {
        assert!((t - truth).abs() < 1e-11, "{below:?}");
    }
}

#[test]
fn tori_of_any_size_and_place_are_met_exactly_from_far_away() {
    let mut random = Random(31);
    for case in 0..2000 {
        let minor = 0.05 + 0.9 * random.next();
        let world = torus([1.0, minor]);
        // A point of the surface that is seen from outside, and a start far along a direction above it.
        let (around, over) = (360.0 * random.next(), 360.0 * random.next());
        let turn = Affine::rotate(DVec3::Z, around);
        let out = turn.vector(Affine::rotate(DVec3::Y, over).vector(DVec3::X));
        let target = turn.vector(DVec3::X) + out * minor;
        let away = (out + random.unit() * 0.5).normalize();
        let origin = target + away * 10f64.powf(5.0 * random.next());
        let toward = (target - origin).normalize();
        let Some(hit) = world.closest(&ray(origin, toward)) else { panic!("case {case}: missed") };
        let p = origin + toward * hit.t;
        let ring = DVec3::new(p.x, p.y, 0.0).normalize();
        let cosine = hit.normal.dot(toward).abs().max(1e-3);
        let off = ((p - ring).length() - minor).abs() / cosine;
        assert!(off <= 16.0 * ulp(hit.t.max(1.0)), "case {case}: {off:e} at {}", hit.t);
    }
}

#[test]
fn a_cone_has_no_gap_at_its_rims() {
    let cone = Shape::Cone(Box::new(Cone { from: DVec3::ZERO, to: DVec3::Y, radii: [1.0, 0.5] }));
    let world = placed(cone, Affine::rotate(DVec3::new(0.48, 0.6, 0.64), 33.0));
    let up = Affine::rotate(DVec3::new(0.48, 0.6, 0.64), 33.0);
    let inside = up.point(DVec3::new(0.1, 0.4, -0.1));
    let mut random = Random(8);
    for i in 0..20_000 {
        let angle = 360.0 * random.next();
        let (y, r) = if i % 2 == 0 { (0.0, 1.0) } else { (1.0, 0.5) };
        let rim = Affine::rotate(DVec3::Y, angle).point(DVec3::new(r, y, 0.0));
        let target = up.point(rim);
        let hit = world.closest(&ray(inside, (target - inside).normalize())).expect("a closed solid");
        assert!((hit.point - target).length() < 1e-12, "{i}: {} {target}", hit.point);
    }
}

#[test]
fn every_solid_has_outward_normals_and_points_on_its_surface() {
    let mut random = Random(5);
    let shapes = [
        sphere(DVec3::ZERO, 1.0),
        Shape::Box(Box::new((DVec3::NEG_ONE, DVec3::ONE))),
        Shape::Cone(Box::new(Cone { from: -DVec3::Y, to: DVec3::Y, radii: [1.0, 0.2] })),
        Shape::Cone(Box::new(Cone { from: -DVec3::Y, to: DVec3::Y, radii: [0.5, 0.5] })),
        Shape::Torus(Box::new(Torus { center: DVec3::ZERO, axis: DVec3::Y, radii: [1.0, 0.25] })),
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        let mirrored = placed(shape, Affine::scale(DVec3::new(-1.0, 2.0, 0.5)));
        for _ in 0..300 {
            let origin = random.unit() * 9.0;
            let toward = (random.vector() * 0.6 - origin).normalize();
            if let Some(hit) = mirrored.closest(&ray(origin, toward)) {
                assert!(hit.geometric_normal.dot(toward) < 1e-9, "shape {i}: inward");
                let seen = origin + toward * hit.t;
                assert!((seen - hit.point).length() < 1e-12, "shape {i}: {}", (seen - hit.point).length());
                assert!(hit.normal.dot(hit.tangent()).abs() < 1e-12 && hit.tangent().is_normalized());
                let uv = hit.uv();
                assert!(uv.min_element() >= -1e-12 && uv.max_element() <= 1.0 + 1e-12, "{uv}");
            }
        }
    }
}
