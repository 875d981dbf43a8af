//! Lists of crossings against what one meeting says, and against inside and outside known in closed form.

use super::mesh::MeshShape;
use super::triangle::Sheared;
use super::*;
use crate::geometry::mesh::Mesh;
use crate::scene::{self, Accelerator};
use std::sync::Arc;

/// Numbers in −1 … 1 (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    /// Half of them with coordinates that are multiples of ½, so that rays run along axes, through edges and through corners.
    fn ray(&mut self) -> LocalRay {
        let (mut o, mut d) = (self.vector() * 3.0, self.vector());
        if self.next() < 0.0 {
            (o, d) = ((o * 2.0).round() / 2.0, d.round());
        }
        LocalRay::new(o, if d == DVec3::ZERO { DVec3::X } else { d }).expect("a direction").0
    }
}

type Inside = fn(DVec3) -> bool;

/// Closed shapes of about the size 1 and their insides.
fn closed() -> Vec<(Shape, Inside)> {
    let cone = |from, to, radii| {
        Shape::Cone(Box::new(Cone::new(scene::Cone { from, to, radii }).expect("a proper cone")))
    };
    let torus = |radii| Torus::new(scene::Torus { center: DVec3::ZERO, axis: DVec3::Y, radii });
    vec![
        (Shape::Sphere(Sphere { center: DVec3::ZERO, radius: 1.0 }), |p| p.length() < 1.0),
        (Shape::Cuboid(Box::new(Cuboid { min: -DVec3::ONE, max: DVec3::ONE })), |p| {
            p.abs().max_element() < 1.0
        }),
        (cone(-DVec3::Y, DVec3::Y, [1.0, 1.0]), |p| p.y.abs() < 1.0 && DVec2::new(p.x, p.z).length() < 1.0),
        (cone(-DVec3::Y, DVec3::Y, [1.0, 0.0]), |p| {
            p.y.abs() < 1.0 && DVec2::new(p.x, p.z).length() < (1.0 - p.y) / 2.0
        }),
        (Shape::Torus(Box::new(torus([1.0, 0.5]))), |p| {
            DVec2::new(DVec2::new(p.x, p.z).length() - 1.0, p.y).length() < 0.5
        }),
        // A spindle's core is hollow.
        (Shape::Torus(Box::new(torus([0.5, 1.0]))), |p| {
            let rho = DVec2::new(p.x, p.z).length();
            (DVec2::new(rho - 0.5, p.y).length() < 1.0) != (DVec2::new(rho + 0.5, p.y).length() < 1.0)
        }),
    ]
}

fn open() -> Vec<Shape> {
    let (center, normal) = (DVec3::ZERO, DVec3::new(0.0, 0.6, 0.8));
    let vertices = [DVec3::X, DVec3::Y, DVec3::Z];
    vec![
        Shape::Plane(Plane { normal, offset: 0.25 }),
        Shape::Disc(Box::new(Disc(scene::Disc { center, normal, radius: 1.0 }))),
        Shape::Rect(Box::new(
            Rect::new(scene::Rect { center, a: DVec3::X, b: DVec3::new(0.0, 1.0, 0.5) }).expect("a rect"),
        )),
        Shape::Triangle(Box::new(Triangle(scene::Triangle { vertices, normals: None, uvs: None }))),
    ]
}

fn bits(meet: &Meet) -> (u64, u64, u64, u32) {
    (meet.t.to_bits(), meet.a.to_bits(), meet.b.to_bits(), meet.face)
}

#[test]
fn the_first_crossing_is_the_meeting() {
    let shapes: Vec<Shape> = closed().into_iter().map(|(shape, _)| shape).chain(open()).collect();
    let mut random = Random(1);
    for case in 0..40_000 {
        let ray = random.ray();
        for shape in &shapes {
            let mut all = vec![];
            shape.crossings(&ray, &mut all);
            let meet = shape.meet(&ray, f64::MAX);
            assert_eq!(all.first().map(bits), meet.as_ref().map(bits), "case {case}: {shape:?} {ray:?}");
            assert!(all.is_sorted_by(|a, b| a.t <= b.t), "case {case}: {all:?}");
        }
    }
}

/// Rays from within some roundings of a sphere's surface, half of them almost along it: the roots alone give the same answers as where
/// spheres behind a ray's start are told before.
#[test]
fn a_sphere_that_a_ray_leaves_is_told_as_by_its_roots() {
    let mut random = Random(23);
    let mut behind = 0;
    for case in 0..100_000 {
        let size = 4f64.powi(case % 16);
        let sphere = Sphere { center: random.vector() * size, radius: 1.5 + random.next() };
        let out = random.vector().normalize_or(DVec3::X);
        let origin = sphere.center + out * (sphere.radius * (1.0 + random.next() * 64.0 * f64::EPSILON));
        let slope = if case % 2 == 0 { random.next() } else { random.next() * 2f64.powi(-(case / 2 % 60)) };
        let direction = random.vector().cross(out).normalize_or(DVec3::Y) + out * slope;
        let (ray, _) = LocalRay::new(origin, direction).expect("a direction");
        let (shape, mut all) = (Shape::Sphere(sphere), Vec::new());
        shape.crossings(&ray, &mut all);
        let met = shape.meet(&ray, f64::MAX);
        assert_eq!(met.as_ref().map(bits), all.first().map(bits), "case {case}: {sphere:?}, {ray:?}");
        behind += usize::from(met.is_none());
    }
    assert!(behind > 25_000, "{behind}");
}

#[test]
fn an_odd_number_of_crossings_lies_ahead_of_a_point_inside() {
    let mut random = Random(2);
    for case in 0..40_000 {
        let ray = random.ray();
        for (shape, inside) in closed() {
            // A point on the surface is neither.
            let step = |i: i32| f64::from(i % 3 - 1) * 1e-9;
            let around = (0..27).map(|i| inside(ray.origin + DVec3::new(step(i), step(i / 3), step(i / 9))));
            if around.clone().any(|here| here != inside(ray.origin)) {
                continue;
            }
            let mut all = vec![];
            shape.crossings(&ray, &mut all);
            assert_eq!(all.len() % 2 == 1, inside(ray.origin), "case {case}: {shape:?} {ray:?} {all:?}");
        }
    }
}

/// A cube of eight corners and twelve triangles.
fn cube() -> Mesh {
    let positions = Aabb { min: -DVec3::ONE, max: DVec3::ONE }.corners().to_vec();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { positions, triangles, ..Mesh::default() }
}

#[test]
fn a_closed_mesh_has_an_inside_through_edges_and_corners() {
    for accelerator in [Accelerator::Bvh, Accelerator::KdTree, Accelerator::None] {
        let shape = MeshShape::new(Arc::new(cube()), None, accelerator);
        let mut random = Random(3);
        for case in 0..40_000 {
            let ray = random.ray();
            let mut all = vec![];
            shape.crossings(&ray, &mut all);
            let sheared = Sheared::new(&ray);
            let mut nearest: Option<Meet> = None;
            for i in 0..shape.tree.order().len() {
                let limit = nearest.map_or(f64::MAX, |m| m.t);
                if let Some(meet) = shape.meet(i, &sheared, limit) {
                    let meet = Meet { face: shape.triangle_at(i), ..meet };
                    if nearest.is_none_or(|n| meet.t < n.t || meet.face < n.face) {
                        nearest = Some(meet);
                    }
                }
            }
            assert_eq!(all.first().map(bits), nearest.as_ref().map(bits), "case {case}: {ray:?}");
            if ray.origin.abs().max_element() != 1.0 {
                let inside = ray.origin.abs().max_element() < 1.0;
                assert_eq!(all.len() % 2 == 1, inside, "case {case}: {ray:?} {all:?}");
            }
        }
    }
}

#[test]
fn no_triangle_of_a_small_mesh_is_lost_by_any_tree() {
    for accelerator in [Accelerator::Bvh, Accelerator::KdTree, Accelerator::None] {
        for count in 1..=20 {
            let corner = |i: u32| DVec3::new(f64::from(i / 3), f64::from(i % 3 / 2), f64::from(i % 3 % 2));
            let positions: Vec<_> = (0..3 * count).map(corner).collect();
            let triangles: Vec<_> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let mesh = Mesh { positions, triangles, ..Mesh::default() };
            let shape = MeshShape::new(Arc::new(mesh), None, accelerator);
            let (ray, _) = LocalRay::new(DVec3::new(-1.0, 0.25, 0.25), DVec3::X).expect("a direction");
            let mut met = Vec::new();
            shape.crossings(&ray, &mut met);
            let met: Vec<u32> = met.iter().map(|meet| meet.face).collect();
            assert_eq!(met, (0..count).collect::<Vec<_>>(), "{accelerator:?}");
        }
    }
}
