//! Transforms, and what comes to a primitive through the groups around it: material, visibility, name, light.

use super::{node, object, placed, ray, span, sphere, world_of};
use glam::{DMat3, DVec3};
use ogee::math::Affine;
use ogee::scene::{
    Accelerator, Disc, Hide, Layers, Light, LightSource, Material, Node, Object, Rect, Rgb, Shape, Texture,
};
use ogee::world::{EmitterShape, Ray, RayKind, World};
use std::sync::Arc;

fn grey(x: f64) -> Arc<Material> {
    Arc::new(Material { diffuse: Texture::number(x), layers: None, span: span(7) })
}

fn glowing(x: f64) -> Arc<Material> {
    let layers = Layers { emit: Texture::number(x), ..Layers::DEFAULT };
    Arc::new(Material { diffuse: Texture::ZERO, layers: Some(Box::new(layers)), span: span(7) })
}

fn down(x: f64) -> Ray {
    ray(DVec3::new(x, 50.0, 0.0), -DVec3::Y)
}

fn greyness(world: &World, ray: &Ray) -> f64 {
    match world.closest(ray).expect("a hit").material().diffuse {
        Texture::Constant(c) => c.x,
        Texture::Pattern(_) => f64::NAN,
    }
}

#[test]
fn normals_go_through_the_inverse_transpose_and_stay_unit() {
    let normal = DVec3::new(1.0, 1.0, 0.0).normalize();
    let disc = Shape::Disc(Box::new(Disc { center: DVec3::ZERO, normal, radius: 5.0 }));
    let stretched = Affine::scale(DVec3::new(1.0, 1000.0, 1.0)).then(&Affine::translate(DVec3::X * 5.0));
    let hit = placed(disc, stretched);
    let hit = hit.closest(&ray(DVec3::new(100.0, 0.0, 0.0), -DVec3::X)).expect("a hit");
    let expected = DVec3::new(1000.0, 1.0, 0.0).normalize();
    assert!((hit.geometric_normal - expected).length() < 1e-12, "{}", hit.geometric_normal);
    assert!(hit.geometric_normal.is_normalized());
}

#[test]
fn a_map_of_condition_1e12_keeps_points_and_normals() {
    let turn = Affine::rotate(DVec3::new(0.36, 0.48, 0.8), 37.0);
    let scale = DVec3::new(1e-6, 1.0, 1e6);
    let map = turn.inverse().then(&Affine::scale(scale)).then(&turn);
    let p = DVec3::new(0.3, -0.2, 0.5);
    let back = map.inverse().point(map.point(p));
    assert!((back - p).length() <= 4.0 * (f64::EPSILON / 2.0) * 1e12, "{}", (back - p).length());
    let world = placed(sphere(DVec3::ZERO, 1.0), map);
    let origin = map.point(DVec3::new(0.2, 0.1, 2.0));
    let hit = world.closest(&ray(origin, (map.point(p) - origin).normalize())).expect("a hit");
    // The same normal from the same local point by exact cofactors of the factors of the map.
    let rotation = DMat3::from_cols(turn.linear.x_axis, turn.linear.y_axis, turn.linear.z_axis);
    let local = rotation.transpose() * hit.local_point;
    let expected = (rotation * (local / scale)).normalize();
    assert!((hit.geometric_normal - expected).length() < 1e-12, "{}", hit.geometric_normal - expected);
}

#[test]
fn the_innermost_material_wins_also_through_shared_groups() {
    let balls: Arc<[Node]> = (0..10)
        .map(|i| {
            let mut ball = object(sphere(DVec3::new(f64::from(i) * 3.0, 0.0, 0.0), 1.0));
            ball.material = (i == 0).then(|| grey(0.1));
            node(ball)
        })
        .collect();
    let group = |at: f64, material: Option<Arc<Material>>| {
        let mut group = object(Shape::Group(Arc::clone(&balls)));
        group.transform_by(&Affine::translate(DVec3::X * at));
        group.material = material;
        node(group)
    };
    let mut outer = object(Shape::Group([group(200.0, None), group(300.0, Some(grey(0.4)))].into()));
    outer.material = Some(grey(0.5));
    let world =
        world_of(vec![group(0.0, None), group(100.0, Some(grey(0.3))), node(outer)], Accelerator::Bvh);
    assert_eq!(world.stats().instances, 4, "{:?}", world.stats());
    assert_eq!(greyness(&world, &down(0.0)), 0.1);
    assert_eq!(greyness(&world, &down(3.0)), 0.8, "white plaster");
    assert_eq!(greyness(&world, &down(100.0)), 0.1);
    assert_eq!(greyness(&world, &down(103.0)), 0.3);
    assert_eq!(greyness(&world, &down(203.0)), 0.5);
    assert_eq!(greyness(&world, &down(303.0)), 0.4);
    assert_eq!(greyness(&world, &down(300.0)), 0.1);
}

#[test]
fn what_is_hidden_is_hidden_from_its_rays_alone() {
    let mut ball = object(sphere(DVec3::ZERO, 1.0));
    ball.hide = Hide { camera: true, shadow: false, reflection: true };
    let world = world_of(vec![node(ball), node(object(sphere(DVec3::X * 5.0, 1.0)))], Accelerator::Bvh);
    let seen = |kind| world.occluded(&Ray { kind, ..down(0.0) });
    assert!(!seen(RayKind::Camera) && seen(RayKind::Shadow) && !seen(RayKind::Indirect));
    assert!(world.occluded(&down(5.0)));
}

#[test]
fn every_primitive_knows_its_place_and_the_placements_around_it() {
    let balls: Arc<[Node]> = (0..10)
        .map(|i| node(Object::new(sphere(DVec3::X * f64::from(i) * 3.0, 1.0), span(10 + i as usize))))
        .collect();
    let mut named = Object::new(sphere(DVec3::X * -9.0, 1.0), span(50));
    named.name = Some("moon".into());
    let dissolved = Object::new(Shape::Group([node(named)].into()), span(60));
    let place = |at: f64, s: usize| {
        let mut group = Object::new(Shape::Group(Arc::clone(&balls)), span(s));
        group.transform_by(&Affine::translate(DVec3::X * at));
        node(group)
    };
    let pair = Object::new(Shape::Group([place(100.0, 2), place(200.0, 3)].into()), span(4));
    let world = world_of(vec![place(0.0, 1), node(pair), node(dissolved)], Accelerator::Bvh);
    let of = |x: f64| {
        let hit = world.closest(&down(x)).expect("a hit");
        world.provenance(hit.primitive).expect("every hit has a place")
    };
    assert_eq!((of(6.0).span, of(6.0).path), (span(12), vec![span(1)]));
    assert_eq!((of(203.0).span, of(203.0).path), (span(11), vec![span(4), span(3)]));
    assert_eq!((of(-9.0).span, of(-9.0).path), (span(50), vec![span(60)]));
    assert_eq!(of(-9.0).name.as_deref(), Some("moon"));
}

#[test]
fn lights_and_emitters_are_found_through_placements() {
    let lamp = Light {
        source: LightSource::Area {
            object: Arc::new(object(Shape::Rect(Box::new(Rect {
                center: DVec3::ZERO,
                a: DVec3::X,
                b: DVec3::Z,
            })))),
            radiance: Rgb::splat(3.0),
        },
        falloff: None,
        shadow: true,
        samples: 16,
        transform: Some(Box::new(Affine::translate(DVec3::Y * 2.0))),
        span: span(8),
    };
    let point = Light {
        source: LightSource::Point { position: DVec3::ZERO, intensity: Rgb::ONE },
        transform: None,
        ..lamp.clone()
    };
    let mut children: Vec<Node> =
        (0..10).map(|i| node(object(sphere(DVec3::X * f64::from(i), 0.1)))).collect();
    children.extend([Node::Light(Arc::new(lamp)), Node::Light(Arc::new(point))]);
    let children: Arc<[Node]> = children.into();
    let place = |at: f64| {
        let mut group = object(Shape::Group(Arc::clone(&children)));
        group.transform_by(&Affine::translate(DVec3::X * at));
        node(group)
    };
    let mut glow = object(sphere(DVec3::X * -50.0, 1.0));
    glow.material = Some(glowing(2.0));
    let world = world_of(vec![place(0.0), place(100.0), node(glow)], Accelerator::Bvh);
    assert_eq!(world.lights.len(), 2);
    assert_eq!(world.lights[1].world_from_local.point(DVec3::ZERO), DVec3::X * 100.0);
    assert_eq!(world.emitters.len(), 3);
    for x in [0.3, 100.3, -50.0] {
        let hit = world.closest(&down(x)).expect("an emitter");
        let emitter = &world.emitters[world.emitter_of(hit.primitive).expect("it emits")];
        assert_eq!(emitter.light.is_some(), x > -50.0);
        assert_eq!(matches!(emitter.shape, EmitterShape::Sphere { .. }), x == -50.0);
        let local = emitter.world_from_local.inverse().point(hit.point);
        assert!((local - hit.local_point).length() < 1e-12);
    }
    let dark = world.closest(&down(7.0)).expect("a ball");
    assert_eq!(world.emitter_of(dark.primitive), None);
}

#[test]
fn light_passes_what_lets_it_through() {
    let mut glass = object(sphere(DVec3::ZERO, 1.0));
    glass.material = Some(grey(0.5));
    let world = world_of(vec![node(glass), node(object(sphere(DVec3::Y * 9.0, 1.0)))], Accelerator::Bvh);
    let half = |hit: &ogee::world::Hit<'_>| match hit.material().diffuse {
        Texture::Constant(c) if c.x == 0.5 => Rgb::splat(0.5),
        _ => Rgb::ZERO,
    };
    let shadow = |t_max| Ray { t_max, kind: RayKind::Shadow, ..ray(DVec3::Y * -5.0, DVec3::Y) };
    let passed = |t_max| world.transmittance(&shadow(t_max), |hit| Ok::<Rgb, ()>(half(hit))).unwrap();
    assert_eq!(passed(5.0), Rgb::splat(0.5));
    assert_eq!(passed(7.0), Rgb::splat(0.25));
    assert_eq!(passed(f64::INFINITY), Rgb::ZERO);
    assert_eq!(passed(3.0), Rgb::ONE);
}

#[test]
fn groups_in_groups_without_end_are_no_danger() {
    let mut inner = node(object(sphere(DVec3::ZERO, 1.0)));
    for _ in 0..200_000 {
        inner = node(object(Shape::Group([inner].into())));
    }
    let world = world_of(vec![inner], Accelerator::Bvh);
    let hit = world.closest(&down(0.0)).expect("the ball inside");
    assert_eq!(world.provenance(hit.primitive).expect("a place").path.len(), 200_000);
}

#[test]
fn pairs_of_pairs_are_placed_and_not_copied() {
    let mut ball = object(sphere(DVec3::ZERO, 0.4));
    ball.name = Some("cell".into());
    let mut nodes: Vec<Node> = vec![node(ball)];
    for level in 0..30 {
        let shared: Arc<[Node]> = nodes.into();
        let at = |x: f64| {
            let mut group = object(Shape::Group(Arc::clone(&shared)));
            group.transform_by(&Affine::translate(DVec3::X * x * ogee::math::exact::power_of_two(level)));
            node(group)
        };
        nodes = vec![at(0.0), at(1.0)];
    }
    let world = world_of(nodes, Accelerator::Bvh);
    let hit = world.closest(&down(123_456_789.0)).expect("one of 2³⁰ balls");
    assert_eq!(hit.point.x, 123_456_789.0);
    let place = world.provenance(hit.primitive).expect("a place");
    assert_eq!((place.path.len(), place.name.as_deref()), (30, Some("cell")));
    assert!(world.stats().instances < 100);
}

#[test]
fn placements_nested_too_deeply_are_left_out_with_an_error() {
    let mut nodes: Vec<Node> = (0..8).map(|i| node(object(sphere(DVec3::X * f64::from(i), 0.1)))).collect();
    for _ in 0..1000 {
        let shared: Arc<[Node]> = nodes.into();
        nodes = (0..2).map(|_| node(object(Shape::Group(Arc::clone(&shared))))).collect();
    }
    let (world, faults) = World::new(nodes, &Default::default(), &super::DiskLoader);
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert!(!world.occluded(&down(0.0)));
}
