//! Rays that leave a surface do not meet it again where they left, and nothing near it is jumped over, at any scale.

use super::{Random, jumble, node, object, placed, ray, sphere, world_of};
use glam::DVec3;
use ogee::geometry::mesh::Mesh;
use ogee::math::Affine;
use ogee::scene::{Accelerator, Cone, Csg, CsgOp, Disc, Node, Object, Rect, Shape, Torus, Triangle};
use ogee::world::{RayKind, World};
use std::sync::Arc;

/// 10^±`range`, either sign.
fn magnitude(random: &mut Random, range: f64) -> f64 {
    random.signed().signum() * ogee::math::elementary::powf(10.0, range * random.signed())
}

fn far_point(random: &mut Random) -> DVec3 {
    DVec3::new(magnitude(random, 8.0), magnitude(random, 8.0), magnitude(random, 8.0))
}

fn wild_transform(random: &mut Random) -> Affine {
    let factors = [0; 3].map(|_| magnitude(random, 4.0));
    Affine::scale(DVec3::from_array(factors))
        .then(&Affine::rotate(random.unit(), 360.0 * random.next()))
        .then(&Affine::translate(far_point(random)))
}

/// A convex or flat shape and a point near its middle.
fn convex(i: usize, random: &mut Random) -> (Shape, DVec3) {
    let at = far_point(random);
    let size = magnitude(random, 4.0).abs();
    match i % 6 {
        0 => (sphere(at, size), at),
        1 => (Shape::Disc(Box::new(Disc { center: at, normal: random.unit(), radius: size })), at),
        2 => {
            let (a, b) = (random.unit() * size, random.unit() * magnitude(random, 4.0).abs());
            (Shape::Rect(Box::new(Rect { center: at, a, b })), at)
        }
        3 => {
            let corner = at + DVec3::splat(size.max(at.abs().max_element() * 1e-12));
            (Shape::Box(Box::new((at, corner))), (at + corner) / 2.0)
        }
        4 => {
            let to = at + random.unit() * size;
            let radii = [size * random.next(), size * random.next()];
            (Shape::Cone(Box::new(Cone { from: at, to, radii })), (at + to) / 2.0)
        }
        _ => {
            let vertices = [far_point(random), far_point(random), far_point(random)];
            let middle = (vertices[0] + vertices[1] + vertices[2]) / 3.0;
            (Shape::Triangle(Box::new(Triangle { vertices, normals: None, uvs: None })), middle)
        }
    }
}

/// Counts rays that leave a convex shape and meet it again.
fn self_hits(world: &World, middle: DVec3, size: f64, rays: usize, random: &mut Random) -> (usize, usize) {
    let (mut again, mut tried) = (0, 0);
    for _ in 0..rays {
        let origin = middle + random.unit() * size * (1.0 + random.next());
        let aim = middle + random.vector() * size * 0.1;
        let Some(hit) = world.closest(&ray(origin, (aim - origin).normalize())) else { continue };
        for _ in 0..4 {
            let mut direction = random.unit();
            if direction.dot(hit.geometric_normal) < 0.0 {
                direction = -direction;
            }
            tried += 1;
            again += usize::from(world.occluded(&hit.spawn(direction, RayKind::Indirect)));
        }
    }
    (again, tried)
}

#[test]
fn convex_shapes_of_any_size_anywhere_do_not_shadow_themselves() {
    let mut random = Random(21);
    let mut total = 0;
    for i in 0..600 {
        let (shape, middle) = convex(i, &mut random);
        let told = format!("{shape:?}");
        let size = 2.0 * middle.abs().max_element().max(1.0);
        let (world, faults) = World::new(vec![node(object(shape))], &Default::default(), &super::DiskLoader);
        if !faults.is_empty() {
            continue;
        }
        let (again, tried) = self_hits(&world, middle, size, 100, &mut random);
        total += tried;
        assert_eq!(again, 0, "shape {i} of {tried} tried: {told}");
    }
    assert!(total > 10_000, "{total}");
}

/// A ball cut by a box, a rod and a plane, all of which it fits into but for their rims, as often flush as not.
fn cut_ball(random: &mut Random) -> Shape {
    let flush = if random.next() < 0.5 { 0.8 } else { 0.5 + random.next() };
    let parts = vec![
        sphere(DVec3::ZERO, 1.0),
        Shape::Box(Box::new((DVec3::splat(-flush), DVec3::splat(0.8)))),
        Shape::Cone(Box::new(Cone { from: -DVec3::Y * flush, to: DVec3::Y * 0.8, radii: [1.0, 0.9] })),
        Shape::Plane { normal: random.unit(), offset: 0.7 },
    ];
    let turn = Affine::rotate(random.unit(), 90.0 * random.next()).then(&Affine::scale(DVec3::splat(0.3)));
    let placed = parts.into_iter().map(|shape| {
        let mut part = object(shape);
        part.transform_by(&turn.then(&turn.inverse()));
        node(part)
    });
    Shape::Csg(Arc::new(Csg { op: CsgOp::Intersection, inverse: false, children: placed.collect() }))
}

#[test]
fn solids_put_together_do_not_shadow_themselves() {
    let mut random = Random(27);
    let mut total = 0;
    for i in 0..300 {
        let shape = cut_ball(&mut random);
        let transform = wild_transform(&mut random);
        let middle = transform.point(DVec3::ZERO);
        let size = transform.linear.x_axis.length().min(transform.linear.y_axis.length());
        let (again, tried) = self_hits(&placed(shape, transform), middle, size * 2.0, 100, &mut random);
        total += tried;
        assert_eq!(again, 0, "shape {i} of {tried} tried: {transform:?}");
    }
    assert!(total > 5_000, "{total}");
}

#[test]
fn transformed_shapes_do_not_shadow_themselves() {
    let mut random = Random(22);
    let mut total = 0;
    for i in 0..600 {
        let shape = match i % 4 {
            0 => sphere(random.vector(), 1.0),
            1 => Shape::Disc(Box::new(Disc { center: random.vector(), normal: random.unit(), radius: 1.0 })),
            2 => Shape::Box(Box::new((DVec3::NEG_ONE, DVec3::ONE))),
            _ => Shape::Cone(Box::new(Cone { from: -DVec3::Y, to: DVec3::Y, radii: [1.0, random.next()] })),
        };
        let transform = wild_transform(&mut random);
        let told = format!("{shape:?} {transform:?}");
        let middle = transform.point(DVec3::ZERO);
        let size = transform.linear.x_axis.length().min(transform.linear.y_axis.length());
        let (again, tried) = self_hits(&placed(shape, transform), middle, size * 2.0, 100, &mut random);
        total += tried;
        assert_eq!(again, 0, "shape {i} of {tried} tried: {told}");
    }
    assert!(total > 10_000, "{total}");
}

/// A torus is not convex: what leaves it may meet it again, but not where it left.
#[test]
fn a_torus_is_met_again_only_farther_on() {
    let mut random = Random(23);
    for i in 0..100 {
        let major = magnitude(&mut random, 4.0).abs();
        let minor = major * ogee::math::elementary::powf(10.0, -2.0 * random.next());
        let center = DVec3::ZERO + random.vector() * major * 1e3;
        let torus = Torus { center, axis: random.unit(), radii: [major, minor] };
        let world = placed(Shape::Torus(Box::new(torus)), Affine::IDENTITY);
        for _ in 0..100 {
            let origin = center + random.unit() * 4.0 * major;
            let aim = center + random.unit() * major;
            let Some(hit) = world.closest(&ray(origin, (aim - origin).normalize())) else { continue };
            let mut direction = random.unit();
            if direction.dot(hit.geometric_normal) < 0.0 {
                direction = -direction;
            }
            if let Some(next) = world.closest(&hit.spawn(direction, RayKind::Indirect)) {
                // The next meeting is at least as far as the tube's own curve allows: a chord of the angle that the ray leaves at.
                let cosine = direction.dot(hit.geometric_normal);
                assert!(
                    next.t > minor * cosine * 1e-3,
                    "torus {i} {torus:?}: {} at {cosine}",
                    next.t / minor
                );
            }
        }
    }
}

#[test]
fn a_gap_of_a_billionth_still_throws_a_shadow() {
    for scale in [1e-6, 1.0, 1e6] {
        let gap = 1e-9 * scale;
        let lid = Shape::Rect(Box::new(Rect {
            center: DVec3::new(0.0, gap, 0.0),
            a: DVec3::X * scale,
            b: DVec3::NEG_Z * scale,
        }));
        let floor = Shape::Rect(Box::new(Rect {
            center: DVec3::ZERO,
            a: DVec3::X * scale * 3.0,
            b: DVec3::NEG_Z * scale * 3.0,
        }));
        let world = world_of(vec![node(object(lid)), node(object(floor))], Accelerator::Bvh);
        let mut random = Random(31);
        for _ in 0..1000 {
            let at = DVec3::new(random.signed() * 0.99, 0.0, random.signed() * 0.99) * scale;
            let origin = at + DVec3::new(0.0, gap / 2.0, 0.0);
            let hit = world.closest(&ray(origin, -DVec3::Y)).expect("the floor");
            assert!(hit.point.y.abs() < gap / 4.0, "{}", hit.point);
            let light = DVec3::new(random.signed(), 5.0, random.signed()) * scale;
            assert!(world.occluded(&hit.spawn_to(light)), "{scale}: {at}");
        }
    }
}

#[test]
fn a_shadow_ray_stops_before_the_surface_it_goes_to() {
    let floor = Shape::Rect(Box::new(Rect { center: DVec3::ZERO, a: DVec3::X * 9.0, b: DVec3::NEG_Z * 9.0 }));
    let lamp = sphere(DVec3::new(1.0, 3.0, 1e3), 0.5);
    let world = world_of(vec![node(object(floor)), node(object(lamp))], Accelerator::Bvh);
    let mut random = Random(12);
    for _ in 0..1000 {
        let below = DVec3::new(random.signed(), 1.0, random.signed());
        let hit = world.closest(&ray(below, -DVec3::Y)).expect("the floor");
        let toward = DVec3::new(1.0, 3.0, 1e3) + random.vector() * 0.3 - hit.point;
        let on_lamp = world.closest(&hit.spawn(toward.normalize(), RayKind::Indirect)).expect("the lamp");
        assert!(!world.occluded(&hit.spawn_to_surface(&on_lamp.surface_point())));
        assert!(world.occluded(&hit.spawn_to(on_lamp.point - on_lamp.geometric_normal * 0.1)));
    }
}

fn scaled(nodes: Vec<Node>, factor: f64) -> Vec<Node> {
    let group: Arc<[Node]> = nodes.into();
    let mut whole = Object::new(Shape::Group(group), super::span(0));
    whole.transform_by(&Affine::scale(DVec3::splat(factor)));
    vec![node(whole)]
}

#[test]
fn a_scene_scaled_by_a_power_of_two_is_met_at_the_same_bits() {
    let exponents = [20, -20, 40, -40];
    let reference = world_of(scaled(jumble(3), 1.0), Accelerator::Bvh);
    for e in exponents {
        let factor = ogee::math::exact::power_of_two(e);
        let world = world_of(scaled(jumble(3), factor), Accelerator::Bvh);
        let mut random = Random(40);
        for i in 0..500 {
            let mut ray = super::any_ray(&mut random, i);
            let a = reference.closest(&ray);
            ray.origin *= factor;
            let b = world.closest(&ray);
            let of =
                |h: &ogee::world::Hit<'_>, f: f64| (h.t * f, h.point * f, h.normal, h.error * f, h.primitive);
            assert_eq!(a.map(|h| of(&h, 1.0)), b.map(|h| of(&h, 1.0 / factor)), "2^{e} ray {i}");
        }
    }
}

fn scaled_ball(factor: f64) -> Mesh {
    let ball = super::bumpy_ball(DVec3::new(0.1, -0.2, 0.3), 3, 5);
    Mesh { positions: ball.positions.iter().map(|p| *p * factor).collect(), ..ball }
}

/// The same without a transform: the shapes' own lengths are scaled.
#[test]
fn shapes_scaled_by_a_power_of_two_are_met_at_the_same_bits() {
    let shapes = |f: f64| -> Vec<Shape> {
        vec![
            sphere(DVec3::new(0.3, 0.1, 0.2) * f, 1.1 * f),
            Shape::Plane { normal: DVec3::new(0.6, 0.0, 0.8), offset: 0.7 * f },
            Shape::Torus(Box::new(Torus {
                center: DVec3::ONE * f,
                axis: DVec3::Y,
                radii: [1.3 * f, 0.3 * f],
            })),
            Shape::Cone(Box::new(Cone {
                from: DVec3::ZERO,
                to: DVec3::new(1.0, 2.0, 0.5) * f,
                radii: [0.7 * f, 0.2 * f],
            })),
            Shape::Box(Box::new((DVec3::new(-1.0, -0.5, 0.1) * f, DVec3::new(0.7, 0.9, 1.3) * f))),
            Shape::Disc(Box::new(Disc {
                center: DVec3::new(0.1, 0.2, 0.3) * f,
                normal: DVec3::new(0.6, 0.0, 0.8),
                radius: 2.0 * f,
            })),
            Shape::Rect(Box::new(Rect {
                center: DVec3::new(0.1, 0.2, 0.3) * f,
                a: DVec3::new(2.0, 0.3, 0.1) * f,
                b: DVec3::new(-0.2, 1.7, 0.4) * f,
            })),
            Shape::Triangle(Box::new(Triangle {
                vertices: [
                    DVec3::new(-3.0, -2.0, 0.1) * f,
                    DVec3::new(2.0, -1.0, 0.7) * f,
                    DVec3::new(0.3, 3.0, -0.5) * f,
                ],
                normals: Some([DVec3::Z, DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, 0.6, 0.8)]),
                uvs: None,
            })),
            super::mesh(scaled_ball(f)),
        ]
    };
    for e in [20, -20, 40, -40] {
        let factor = ogee::math::exact::power_of_two(e);
        for (one, other) in shapes(1.0).into_iter().zip(shapes(factor)) {
            let (one, other) = (super::world(one), super::world(other));
            let mut random = Random(41);
            for i in 0..200 {
                let mut ray = super::any_ray(&mut random, i);
                let a = one.closest(&ray).map(|h| (h.t, h.point, h.normal, h.error));
                ray.origin *= factor;
                let b = other.closest(&ray);
                let b = b.map(|h| (h.t / factor, h.point / factor, h.normal, h.error / factor));
                assert_eq!(a, b, "2^{e} ray {i}");
            }
        }
    }
}
