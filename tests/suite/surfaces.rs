//! Curved surfaces as pictures see them: no crack, no self-hit, no pole without a normal, outlines true to a quarter pixel.

use crate::stage::{SPAN, camera, diffuse, placed};
use glam::{DVec2, DVec3};
use ogee::geometry::patch::{Bicubic, Patch, PatchBasis};
use ogee::math::Affine;
use ogee::render::camera::View;
use ogee::scene::assets::DiskLoader;
use ogee::scene::*;
use ogee::world::{Ray, RayKind, World, WorldOptions};
use std::sync::Arc;

fn patch(patch: Patch, method: PatchMethod) -> Shape {
    let source = PatchSource { net: PatchNet::Inline(patch), method: Some(method), tolerance: None };
    Shape::Surface(Arc::new(Surface::Patch(source)))
}

fn world(shapes: Vec<Shape>, view: Option<&View>) -> World {
    let plaster = diffuse(0.8);
    let nodes = shapes.into_iter().map(|shape| placed(shape, &plaster, None)).collect();
    world_of(nodes, view)
}

fn world_of(nodes: Vec<Node>, view: Option<&View>) -> World {
    let options = WorldOptions { footprint: view.map(View::footprint), ..WorldOptions::default() };
    let (world, faults) = World::new(nodes, &options, &DiskLoader);
    assert!(faults.is_empty(), "{faults:?}");
    world
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin, direction: direction.normalize(), t_max: f64::INFINITY, kind: RayKind::Indirect }
}

/// Numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn unit(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0;
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// z = x² + y² over [−1, 1]².
fn bowl() -> Bicubic {
    let (x, b) = ([-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0], [1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0]);
    Bicubic { points: std::array::from_fn(|i| std::array::from_fn(|j| DVec3::new(x[i], x[j], b[i] + b[j]))) }
}

fn net(points: impl Fn(f64, f64) -> DVec3) -> Bicubic {
    Bicubic { points: std::array::from_fn(|i| std::array::from_fn(|j| points(i as f64, j as f64))) }
}

#[test]
fn no_ray_that_leaves_a_patch_meets_it_again() {
    for scale in [1.0, 1e-6, 1e6] {
        let piece = Bicubic { points: bowl().points.map(|row| row.map(|p| p * scale)) };
        let world = world(vec![patch(Patch::loose(vec![piece]), PatchMethod::Direct)], None);
        let mut random = Random(7);
        let mut met = 0;
        for _ in 0..3000 {
            let target = piece.at(random.next(), random.next());
            // Seen from below, where it bulges toward the eye.
            let eye =
                target + DVec3::new(random.next() - 0.5, random.next() - 0.5, -1.0 - random.next()) * scale;
            let Some(hit) = world.closest(&ray(eye, target - eye)) else { continue };
            met += 1;
            let down =
                if hit.geometric_normal.z < 0.0 { hit.geometric_normal } else { -hit.geometric_normal };
            let away = random.unit();
            let grazing = (away - down * away.dot(down)).normalize() + down * 1e-3 * random.next();
            for direction in [if away.dot(down) > 0.0 { away } else { -away }, grazing.normalize()] {
                let again = world.closest(&hit.spawn(direction, RayKind::Indirect));
                assert!(again.is_none(), "scale {scale}, {target}, {direction}: {}", again.unwrap().t);
            }
        }
        assert!(met > 2000);
    }
}

#[test]
fn a_mirrored_patch_keeps_its_side() {
    let piece = net(|i, j| DVec3::new(i, j, 0.1 * i * j));
    let plaster = diffuse(0.8);
    let mirror = Affine::scale(DVec3::new(-1.0, 1.0, 1.0));
    let shape = || patch(Patch::loose(vec![piece]), PatchMethod::Direct);
    let nodes = vec![placed(shape(), &plaster, None), placed(shape(), &plaster, Some(mirror))];
    let world = world_of(nodes, None);
    for x in [0.7, 1.9] {
        let down = |x: f64| world.closest(&ray(DVec3::new(x, 1.3, 5.0), -DVec3::Z)).unwrap();
        let (own, other) = (down(x), down(-x));
        let image = own.geometric_normal * DVec3::new(-1.0, 1.0, 1.0);
        assert!(other.geometric_normal.distance(image) < 1e-12);
        assert!(own.geometric_normal.z > 0.0);
    }
}

#[test]
fn a_seam_of_two_rates_shows_no_background() {
    // Two patches in blocks of their own share an edge; one is flat beyond it, the other folds up and down.
    let edge = |j: f64| DVec3::new(0.0, j - 1.5, 0.35 * (j - 1.0) * (2.0 - j) * (j + 0.5));
    let calm = net(|i, j| edge(j) - DVec3::X * (3.0 - i) * 0.4);
    let wild = net(|i, j| {
        if i == 0.0 {
            edge(j)
        } else {
            DVec3::new(0.4 * i, j - 1.5, if (i + j) % 2.0 == 0.0 { 1.5 } else { -1.5 })
        }
    });
    let size = [2048, 2048];
    let view = View::new(&camera(DVec3::new(0.1, 0.0, 6.0), DVec3::ZERO, 24.0), size).unwrap();
    let pieces = [calm, wild].map(|piece| patch(Patch::loose(vec![piece]), PatchMethod::Tessellated));
    let world = world(pieces.to_vec(), Some(&view));
    // Every pixel near the seam, in rows where both patches lie on either side of it.
    let (mut looked, mut holes) = (0, 0);
    for y in 200..1848 {
        for x in 940..1060 {
            let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let ray = view.ray(pixel, DVec2::ZERO).unwrap();
            looked += 1;
            holes += u32::from(world.closest(&ray).is_none());
        }
    }
    assert_eq!(holes, 0, "of {looked}");
}

/// A patch whose outline curls over itself.
fn curl() -> Patch {
    let points: Vec<DVec3> = (0..36)
        .map(|k| {
            let (i, j) = (f64::from(k / 6), f64::from(k % 6));
            DVec3::new(i - 2.5, (1.7 * i + 0.4).sin() * (1.3 * j).cos(), j - 2.5)
        })
        .collect();
    Patch::new(PatchBasis::BSpline, &points, Some((6, 6))).unwrap()
}

#[test]
fn outlines_of_triangles_are_true_to_a_quarter_pixel() {
    let view = View::new(&camera(DVec3::new(1.0, 1.6, 7.0), DVec3::ZERO, 36.0), [160, 120]).unwrap();
    let exact = world(vec![patch(curl(), PatchMethod::Direct)], Some(&view));
    let diced = world(vec![patch(curl(), PatchMethod::Tessellated)], Some(&view));
    let is_seen =
        |world: &World, p: DVec2| view.ray(p, DVec2::ZERO).is_some_and(|r| world.closest(&r).is_some());
    let mut random = Random(3);
    let (mut seen, mut apart) = (0, 0);
    for _ in 0..60_000 {
        let p = DVec2::new(160.0 * random.next(), 120.0 * random.next());
        let truth = is_seen(&exact, p);
        seen += u32::from(truth);
        if truth != is_seen(&diced, p) {
            apart += 1;
            // The true outline is within a quarter pixel.
            let is_near = (0..32).any(|k| {
                let (s, c) = (f64::from(k) * std::f64::consts::TAU / 32.0).sin_cos();
                is_seen(&exact, p + DVec2::new(c, s) * 0.25) != truth
            });
            assert!(is_near, "{p}");
        }
    }
    assert!(seen > 5000 && apart > 0 && apart < seen / 100, "{apart} of {seen}");
}

#[test]
fn placements_of_one_patch_share_one_mesh() {
    let shape = patch(curl(), PatchMethod::Tessellated);
    let plaster = diffuse(0.8);
    let view = View::new(&camera(DVec3::new(0.0, 9.0, 20.0), DVec3::ZERO, 40.0), [320, 240]).unwrap();
    let nodes = (0..900)
        .map(|k| {
            let at = DVec3::new(f64::from(k % 30) - 15.0, 0.0, -f64::from(k / 30));
            placed(
                shape.clone(),
                &plaster,
                Some(Affine::scale(DVec3::splat(0.1)).then(&Affine::translate(at))),
            )
        })
        .collect();
    let stats = world_of(nodes, Some(&view)).stats();
    assert_eq!((stats.instances, stats.shapes), (900, 0));
    assert!(stats.triangles < 2000, "{stats:?}");
}

#[test]
fn real_patches_have_no_crack_and_no_dark_pole() {
    let Some(data) = std::env::var_os("OGEE_DATA") else {
        eprintln!("skipped: OGEE_DATA is not set");
        return;
    };
    for (name, eye, at) in [
        ("teapot", DVec3::new(3.0, -8.0, 6.0), DVec3::new(0.2, 0.0, 1.5)),
        ("teacup", DVec3::new(1.5, 2.5, 3.0), DVec3::new(0.0, 0.4, 0.0)),
        ("teaspoon", DVec3::new(0.4, -0.3, 1.6), DVec3::new(0.0, -0.4, 0.0)),
    ] {
        let path = std::path::Path::new(&data).join("patches").join(format!("{name}.bpt"));
        let shape = |method| {
            let net = PatchNet::File { path: path.clone(), span: SPAN };
            Shape::Surface(Arc::new(Surface::Patch(PatchSource {
                net,
                method: Some(method),
                tolerance: None,
            })))
        };
        let view = View::new(&camera(eye, at, 34.0), [400, 300]).unwrap();
        let exact = world(vec![shape(PatchMethod::Direct)], Some(&view));
        let diced = world(vec![shape(PatchMethod::Tessellated)], Some(&view));
        let (mut seen, mut apart, mut turned) = (0, 0, 0);
        for k in 0..400 * 300 {
            let pixel = DVec2::new(f64::from(k % 400) + 0.5, f64::from(k / 400) + 0.5);
            let ray = view.ray(pixel, DVec2::ZERO).unwrap();
            match (exact.closest(&ray), diced.closest(&ray)) {
                (Some(a), Some(b)) => {
                    seen += 1;
                    assert!((a.normal.length() - 1.0).abs() < 1e-9 && (b.normal.length() - 1.0).abs() < 1e-9);
                    turned += u32::from(a.normal.dot(b.normal).abs() < 0.9);
                }
                (None, None) => {}
                _ => apart += 1,
            }
        }
        assert!(seen > 4000, "{name}: {seen}");
        assert!(apart < seen / 50, "{name}: {apart} of {seen}");
        assert!(turned < seen / 100, "{name}: {turned} of {seen}");
    }
}
