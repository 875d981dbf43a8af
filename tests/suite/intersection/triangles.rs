//! Triangles: nothing slips between them, nothing is seen beside them, slivers keep their coordinates.

use super::{Random, bumpy_ball, mesh, ray, world};
use glam::{DVec2, DVec3};
use ogee::geometry::mesh::Mesh;
use ogee::math::exact::Double;
use ogee::scene::{Rect, Shape, Triangle};

const OFFSETS: [DVec3; 3] =
    [DVec3::ZERO, DVec3::new(148_376.0, 1234.0, -223_423.0), DVec3::new(1e6, 1e6, 1e6)];

/// From inside a closed ball every ray must end on it, also those aimed at its edges and corners. Five times as many with
/// OGEE_LONG.
#[test]
fn no_ray_leaves_a_closed_mesh_through_its_edges() {
    let rays = if std::env::var_os("OGEE_LONG").is_some() { 333_334 } else { 20_000 };
    for offset in OFFSETS {
        let ball = bumpy_ball(offset, 2, 17);
        let world = world(mesh(ball.clone()));
        let mut random = Random(9);
        let mut leaks = 0;
        for i in 0..rays {
            let corners = ball.triangles[i % ball.triangles.len()].map(|v| ball.positions[v as usize]);
            let share = if i % 3 == 0 { 0.0 } else { random.next() };
            let aim = corners[0] + (corners[1] - corners[0]) * share;
            let origin = offset + random.vector() * 0.2;
            leaks += usize::from(world.closest(&ray(origin, (aim - origin).normalize())).is_none());
        }
        assert_eq!(leaks, 0, "at {offset}");
    }
}

#[test]
fn a_height_field_with_a_corner_behind_every_pixel_is_closed() {
    const N: usize = 128;
    for offset in [0.0, 1e3, 1e6] {
        let offset = DVec3::splat(offset);
        let mut random = Random(4);
        let direction = |i: usize, j: usize| {
            let at = |k: usize| 2.0 * (k as f64 + 0.5) / N as f64 - 1.0;
            DVec3::new(at(i), at(j), 1.0)
        };
        let positions =
            (0..N * N).map(|k| offset + direction(k % N, k / N) * (1.0 + 2.0 * random.next())).collect();
        let quad = |i: usize, j: usize| {
            let v = (j * N + i) as u32;
            let n = N as u32;
            [[v, v + 1, v + n], [v + 1, v + n + 1, v + n]]
        };
        let triangles = (0..N - 1).flat_map(|j| (0..N - 1).flat_map(move |i| quad(i, j))).collect();
        let world = world(mesh(Mesh { positions, triangles, ..Mesh::default() }));
        let mut holes = 0;
        for j in 1..N - 1 {
            for i in 1..N - 1 {
                let ray = ray(offset, direction(i, j).normalize());
                holes += usize::from(world.closest(&ray).is_none());
            }
        }
        assert_eq!(holes, 0, "at {offset}");
    }
}

fn triangle(a: DVec3, b: DVec3, c: DVec3) -> Shape {
    Shape::Triangle(Box::new(Triangle { vertices: [a, b, c], normals: None, uvs: None }))
}

#[test]
fn a_point_of_the_plane_outside_a_triangle_is_outside() {
    let world = world(triangle(DVec3::ZERO, DVec3::X, DVec3::Y));
    assert!(world.closest(&ray(DVec3::new(1.0, 1.0, 1.0), -DVec3::Z)).is_none());
    assert!(world.closest(&ray(DVec3::new(0.25, 0.25, 1.0), -DVec3::Z)).is_some());
    assert!(world.closest(&ray(DVec3::new(0.25, 0.25, 1.0), DVec3::Z)).is_none(), "behind");
    assert!(world.closest(&ray(DVec3::new(0.25, -1.0, 0.0), DVec3::Y)).is_none(), "in its plane");
}

#[test]
fn a_sliver_keeps_its_coordinates() {
    for height in [1e-3, 1e-6, 1e-8] {
        let (e, f) = (DVec3::X, DVec3::new(1.0, height, 0.0));
        let world = world(triangle(DVec3::ZERO, e, f));
        let point = e * 0.3 + f * 0.4;
        let hit = world.closest(&ray(point + DVec3::Z, -DVec3::Z)).expect("inside");
        assert!((hit.uv() - DVec2::new(0.3, 0.4)).abs().max_element() <= 1e-15, "{height}: {}", hit.uv());
    }
}

#[test]
fn a_parallelogram_is_met_where_its_two_triangles_are() {
    let mut random = Random(8);
    let mut met = 0;
    for case in 0..3000 {
        let (center, a, b) = (random.vector() * 1e3, random.vector(), random.vector());
        let rect = world(Shape::Rect(Box::new(Rect { center, a, b })));
        let [p, q, r, s] = [-a - b, a - b, a + b, b - a].map(|corner| center + corner);
        let halves = [world(triangle(p, q, r)), world(triangle(p, r, s))];
        let aim = center + a * random.signed() * 0.95 + b * random.signed() * 0.95;
        let origin = center + random.unit() * 10.0;
        let start = ray(origin, (aim - origin).normalize());
        let by_halves = halves.iter().find_map(|half| half.closest(&start));
        let (Some(whole), Some(half)) = (rect.closest(&start), by_halves) else { continue };
        // The corners are rounded at the centre's size; along the ray that shows by the cosine.
        let cosine = whole.geometric_normal.dot(start.direction).abs();
        let ulp = center.abs().max_element().next_up() - center.abs().max_element();
        assert!((whole.t - half.t).abs() * cosine <= 4.0 * ulp, "case {case}: {} {}", whole.t, half.t);
        met += 1;
    }
    assert!(met > 2900, "{met}");
}

#[test]
fn a_hit_lies_on_its_triangle() {
    let mut random = Random(6);
    for _ in 0..2000 {
        let [a, b, c] = [0; 3].map(|_| random.vector() * 1e3);
        let world = world(triangle(a, b, c));
        let (u, v) = (random.next() * 0.5, random.next() * 0.5);
        let aim = a * (1.0 - u - v) + b * u + c * v;
        let origin = random.vector() * 1e4;
        let Some(hit) = world.closest(&ray(origin, (aim - origin).normalize())) else { continue };
        let uv = hit.uv();
        let weights = [1.0 - uv.x - uv.y, uv.x, uv.y];
        let size = (a * weights[0]).abs() + (b * weights[1]).abs() + (c * weights[2]).abs();
        let off = height(hit.point, [a, b, c]);
        assert!(off <= 7.0 * f64::EPSILON / 2.0 * size.length(), "{off} {size}");
        assert!(off <= hit.error.length(), "{off} {}", hit.error);
    }
}

/// A point's distance from a triangle's plane: the determinant in twice the working precision.
fn height(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let edge = |q: DVec3| -> [Double; 3] { std::array::from_fn(|i| Double::difference(q[i], a[i])) };
    let ([px, py, pz], [bx, by, bz], [cx, cy, cz]) = (edge(p), edge(b), edge(c));
    let volume = px * (by * cz - bz * cy) + py * (bz * cx - bx * cz) + pz * (bx * cy - by * cx);
    volume.value().abs() / (b - a).cross(c - a).length()
}

#[test]
fn smooth_normals_lean_over_their_triangle_and_stay_on_its_side() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let leaning = |n: [DVec3; 3]| {
        world(Shape::Triangle(Box::new(Triangle {
            vertices: corners,
            normals: Some(n.map(|n| n.normalize())),
            uvs: None,
        })))
    };
    let down = ray(DVec3::new(0.25, 0.25, 1.0), -DVec3::Z);
    let smooth = leaning([DVec3::new(-1.0, 0.0, 1.0), DVec3::Z, DVec3::Z]);
    let hit = smooth.closest(&down).expect("a hit");
    assert!(hit.normal.x < -0.1 && hit.geometric_normal == DVec3::Z && hit.normal.is_normalized());
    let backward = leaning([-DVec3::Z; 3]);
    let hit = backward.closest(&down).expect("a hit");
    assert_eq!((hit.normal, hit.geometric_normal), (-DVec3::Z, -DVec3::Z), "normals win over winding");
    let opposite = leaning([DVec3::X, -DVec3::X, DVec3::new(1e-9, 0.0, 1.0)]);
    let hit = opposite.closest(&ray(DVec3::new(0.4999999, 0.0, 1.0), -DVec3::Z)).expect("a hit");
    assert!(hit.normal.is_finite() && hit.normal.dot(hit.geometric_normal) > 0.0, "{}", hit.normal);
}
