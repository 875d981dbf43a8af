//! Rays against shapes, trees and placements: closed forms, hard cases, and one oracle, the list of all shapes.

mod offsets;
mod placements;
mod quadrics;
mod triangles;

use glam::DVec3;
use ogee::diag::{SourceId, Span};
use ogee::geometry::mesh::Mesh;
use ogee::math::Affine;
use ogee::scene::assets::DiskLoader;
use ogee::scene::{Accelerator, Cone, Disc, MeshSource, Node, Object, Rect, Shape, Torus, Triangle};
use ogee::world::{Hit, PrimitiveId, Ray, RayKind, World, WorldOptions};
use std::sync::Arc;

fn span(at: usize) -> Span {
    Span::new(SourceId(0), at, at + 1)
}

fn object(shape: Shape) -> Object {
    Object::new(shape, span(0))
}

fn node(object: Object) -> Node {
    Node::Object(Arc::new(object))
}

fn world_of(nodes: Vec<Node>, accelerator: Accelerator) -> World {
    let (world, faults) =
        World::new(nodes, &WorldOptions { accelerator, ..WorldOptions::default() }, &DiskLoader);
    assert!(faults.is_empty(), "{faults:?}");
    world
}

fn world(shape: Shape) -> World {
    world_of(vec![node(object(shape))], Accelerator::Bvh)
}

fn placed(shape: Shape, transform: Affine) -> World {
    let mut object = object(shape);
    object.transform_by(&transform);
    world_of(vec![node(object)], Accelerator::Bvh)
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin, direction, t_max: f64::INFINITY, kind: RayKind::Camera }
}

fn sphere(center: DVec3, radius: f64) -> Shape {
    Shape::Sphere { center, radius }
}

/// Numbers in 0 … 1 that depend on the seed alone (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.vector();
            if v.length_squared() > 0.01 && v.length_squared() < 1.0 {
                return v.normalize();
            }
        }
    }
}

#[test]
fn a_sphere_is_seen_in_front_and_not_behind() {
    let world = world(sphere(DVec3::ZERO, 1.0));
    let hit = world.closest(&ray(DVec3::new(0.0, 0.0, -5.0), DVec3::Z)).expect("in front");
    assert_eq!(hit.t, 4.0);
    assert_eq!(hit.geometric_normal, -DVec3::Z);
    assert!(world.closest(&ray(DVec3::new(0.0, 0.0, -5.0), -DVec3::Z)).is_none());
    let inside = world.closest(&ray(DVec3::ZERO, DVec3::X)).expect("from inside");
    assert_eq!((inside.t, inside.geometric_normal), (1.0, DVec3::X));
}

/// A bumpy ball of triangles around a point: an octahedron divided `levels` times, each vertex at a radius of its own.
fn bumpy_ball(center: DVec3, levels: u32, seed: u64) -> Mesh {
    let mut corners = vec![DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let mut faces: Vec<[u32; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut next = Vec::new();
        for [a, b, c] in faces {
            let mut middle = |i: u32, j: u32| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    corners.push((corners[i as usize] + corners[j as usize]).normalize());
                    corners.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            next.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = next;
    }
    let mut random = Random(seed);
    let positions = corners.into_iter().map(|p| center + p * (0.8 + 0.4 * random.next())).collect();
    Mesh { positions, triangles: faces, ..Mesh::default() }
}

fn mesh(mesh: Mesh) -> Shape {
    Shape::Mesh(Arc::new(MeshSource::Inline(mesh)))
}

/// Shapes of every kind, placed in every way: plain, transformed, in groups that are shared and nested.
fn jumble(seed: u64) -> Vec<Node> {
    let mut random = Random(seed);
    let mut nodes = Vec::new();
    let shared_mesh = mesh(bumpy_ball(DVec3::ZERO, 2, seed));
    for i in 0..60 {
        let at = random.vector() * 4.0;
        let shape = simple_shape(i, at, &mut random);
        let mut object = object(shape);
        if random.next() < 0.4 {
            object.transform_by(&some_transform(&mut random));
        }
        nodes.push(node(object));
    }
    for _ in 0..6 {
        let mut object = object(shared_mesh.clone());
        object.transform_by(&some_transform(&mut random));
        nodes.push(node(object));
    }
    let group: Arc<[Node]> = (0..20)
        .map(|i| {
            let at = random.vector();
            node(object(simple_shape(i, at, &mut random)))
        })
        .chain([node(object(shared_mesh))])
        .collect();
    let pair: Arc<[Node]> = (0..9)
        .map(|_| {
            let mut object = object(Shape::Group(Arc::clone(&group)));
            object.transform_by(&some_transform(&mut random));
            node(object)
        })
        .collect();
    for _ in 0..3 {
        let mut object = object(Shape::Group(Arc::clone(&pair)));
        object.transform_by(&some_transform(&mut random));
        nodes.push(node(object));
    }
    nodes
}

fn simple_shape(i: usize, at: DVec3, random: &mut Random) -> Shape {
    let size = 0.1 + 0.5 * random.next();
    match i % 7 {
        0 => sphere(at, size),
        1 => Shape::Box(Box::new((at, at + DVec3::splat(size)))),
        2 => Shape::Disc(Box::new(Disc { center: at, normal: random.unit(), radius: size })),
        3 => Shape::Rect(Box::new(Rect { center: at, a: random.unit() * size, b: random.unit() * size })),
        4 => Shape::Cone(Box::new(Cone {
            from: at,
            to: at + random.unit() * size,
            radii: [size * random.next(), size * (random.next() - 0.3).max(0.0)],
        })),
        5 => Shape::Torus(Box::new(Torus {
            center: at,
            axis: random.unit(),
            radii: [size, size * 0.6 * random.next()],
        })),
        _ => Shape::Triangle(Box::new(Triangle {
            vertices: [at, at + random.unit() * size, at + random.unit() * size],
            normals: None,
            uvs: None,
        })),
    }
}

fn some_transform(random: &mut Random) -> Affine {
    let sign = if random.next() < 0.3 { -1.0 } else { 1.0 };
    let factors = DVec3::new(sign, 1.0, 1.0) * (0.3 + random.next());
    Affine::scale(factors + random.vector().abs() * factors * 0.5)
        .then(&Affine::rotate(random.unit(), 360.0 * random.next()))
        .then(&Affine::translate(random.vector() * 3.0))
}

/// A ray from around the scene into it; some along axes, some from grid points, some backward zeros.
fn any_ray(random: &mut Random, i: usize) -> Ray {
    let origin = random.vector() * 8.0;
    let mut direction = (random.vector() * 3.0 - origin).normalize();
    if i.is_multiple_of(4) {
        let axis = i / 4 % 3;
        direction = DVec3::ZERO;
        direction[axis] = random.signed().signum();
        direction[(axis + 1) % 3] = -0.0;
    }
    ray(if i.is_multiple_of(8) { origin.round() } else { origin }, direction)
}

fn facts(hit: &Hit<'_>) -> (u64, PrimitiveId, DVec3, DVec3, DVec3) {
    (hit.t.to_bits(), hit.primitive, hit.point, hit.normal, hit.error)
}

#[test]
fn trees_meet_what_the_list_of_all_shapes_meets() {
    let mut hits = 0;
    for seed in 0..4 {
        let trees = [Accelerator::Bvh, Accelerator::KdTree].map(|tree| world_of(jumble(seed), tree));
        let list = world_of(jumble(seed), Accelerator::None);
        let mut random = Random(seed + 100);
        for i in 0..800 {
            let ray = any_ray(&mut random, i);
            let truth = list.closest(&ray);
            for tree in &trees {
                let met = tree.closest(&ray);
                assert_eq!(
                    met.as_ref().map(facts),
                    truth.as_ref().map(facts),
                    "seed {seed} ray {i}: {ray:?}"
                );
                assert_eq!(tree.occluded(&ray), truth.is_some(), "seed {seed} ray {i}: {ray:?}");
                if let Some(hit) = met {
                    let beyond = Ray { t_max: hit.t, ..ray };
                    assert!(tree.closest(&beyond).is_none(), "a hit at t_max does not count: {ray:?}");
                }
            }
            hits += usize::from(truth.is_some());
        }
    }
    assert!(hits > 800, "{hits}");
}
