//! Balls around what a world holds, for light that is aimed at it.

use crate::stage::*;
use glam::DVec3;
use ogee::math::Affine;
use ogee::math::random::Random;
use ogee::scene::*;
use ogee::world::{Ray, RayKind, World};
use std::sync::Arc;

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;

fn clear(material: &Material) -> bool {
    material.layers.as_ref().is_some_and(|l| !l.transmit.is(Rgb::ZERO))
}

fn put_together(op: CsgOp, children: Vec<Node>) -> Shape {
    Shape::Csg(Arc::new(Csg { op, inverse: false, children: children.into() }))
}

fn bare(shape: Shape) -> Node {
    Node::Object(Arc::new(Object::new(shape, SPAN)))
}

fn squashed() -> Affine {
    Affine::scale(DVec3::new(1.0, 0.3, 2.0)).then(&Affine::rotate_xyz(DVec3::new(20.0, 50.0, -30.0)))
}

/// A cylinder with a hole: no larger than the cylinder.
fn ring() -> Shape {
    let along =
        |a: f64, b: f64, r| bare(Shape::Cone(Box::new(Cone { from: Y * a, to: Y * b, radii: [r, r] })));
    put_together(CsgOp::Difference, vec![along(0.0, 0.4, 1.0), along(-0.1, 0.5, 0.95)])
}

/// Glass in every form, each moved, squashed and far from the others, and plaster beside it.
fn jumble() -> World {
    let torus = Shape::Torus(Box::new(Torus { center: X, axis: Z, radii: [1.0, 0.3] }));
    let cone = Shape::Cone(Box::new(Cone { from: -Y, to: X, radii: [0.7, 0.2] }));
    let both =
        put_together(CsgOp::Intersection, vec![bare(sphere(X, 1.0)), bare(cuboid(-X - Y - Z, X + Y + Z))]);
    let any = put_together(CsgOp::Union, vec![bare(sphere(X, 0.5)), bare(sphere(-X, 0.4))]);
    let shared: Arc<[Node]> = vec![bare(sphere(Y, 0.6)), object(sphere(-Y, 0.5), &diffuse(0.5))].into();
    let shapes = [
        sphere(X, 1.0),
        disc(X, X + Y, 1.0),
        rect(Y, X, 0.5 * Z + X),
        cuboid(-X - Y, X + Z),
        torus,
        cone,
        ring(),
        both,
        any,
        Shape::Group(Arc::clone(&shared)),
        Shape::Group(shared),
    ];
    let spread = |(i, shape): (usize, Shape)| {
        let place = squashed().then(&Affine::translate(X * (6.0 * i as f64)));
        placed(shape, &glass(1.5), Some(place))
    };
    world(shapes.into_iter().enumerate().map(spread).collect())
}

#[test]
fn every_place_of_glass_is_in_a_ball_and_plaster_is_not_asked_for() {
    let world = jumble();
    let balls = world.balls_of(RayKind::Indirect, clear).expect("all are bounded");
    assert_eq!(balls.len(), 11, "one each");
    let (mut random, mut met) = (Random::new(5), [0; 11]);
    for _ in 0..40_000 {
        let mut side = |most: f64| random.between(-most, most);
        let target = DVec3::new(30.0 + side(33.0), side(2.0), side(2.0));
        let origin = target + DVec3::new(side(9.0), side(9.0), side(9.0));
        let direction = (target - origin).normalize();
        let ray = Ray { origin, direction, t_max: f64::INFINITY, kind: RayKind::Indirect };
        let Some(hit) = world.closest(&ray).filter(|hit| clear(hit.material())) else { continue };
        let of = balls.iter().position(|ball| ball.center.distance(hit.point) <= ball.reach);
        met[of.unwrap_or_else(|| panic!("{} is in no ball", hit.point))] += 1;
    }
    assert!(met.iter().all(|n| *n > 20), "{met:?}");
}

#[test]
fn balls_are_as_small_as_round_things_are() {
    let of = |shape| {
        let balls = world(vec![object(shape, &glass(1.5))]).balls_of(RayKind::Indirect, clear).unwrap();
        assert_eq!(balls.len(), 1);
        balls[0].reach
    };
    near(of(sphere(X, 2.0)), 2.0, 1e-12);
    near(of(ring()), (1.0f64 + 0.04).sqrt(), 1e-12);
    near(of(rect(Y, X, Z)), 2.0f64.sqrt(), 1e-12);
}

#[test]
fn planes_have_no_ball_and_what_light_never_meets_needs_none() {
    let floor = |material| object(plane(Y, 0.0), &material);
    assert!(world(vec![floor(glass(1.5))]).balls_of(RayKind::Indirect, clear).is_none());
    assert!(world(vec![floor(diffuse(0.5))]).balls_of(RayKind::Indirect, clear).unwrap().is_empty());
    let mut unseen = Object::new(sphere(Y, 1.0), SPAN);
    unseen.material = Some(glass(1.5));
    unseen.hide.reflection = true;
    let room = world(vec![Node::Object(Arc::new(unseen))]);
    assert!(room.balls_of(RayKind::Indirect, clear).unwrap().is_empty());
    assert_eq!(room.balls_of(RayKind::Camera, clear).unwrap().len(), 1, "a camera sees it");
}
