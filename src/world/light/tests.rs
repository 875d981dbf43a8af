//! Tests of lights against closed forms: E/(πL) on a receiver that nothing shadows.

use super::*;
use crate::diag::{SourceId, Span};
use crate::math::Affine;
use crate::scene::{Cone, Disc, Layers, Material, Rect, Texture, Torus, Triangle};
use crate::world::even::grid;
use crate::world::{EmitterShape, PrimitiveId};
use std::sync::Arc;

fn emitter(shape: EmitterShape, place: Affine, radiance: f64) -> Light {
    let span = Span { source: SourceId(0), start: 0, end: 0 };
    let layers = Layers { emit: Texture::number(radiance), ..Layers::DEFAULT };
    let material = Material { diffuse: Texture::ZERO, layers: Some(Box::new(layers)), span };
    let primitive = PrimitiveId { instance: 0, shape: 0, part: 0 };
    let emitter =
        Emitter { shape, world_from_local: place, primitive, material: Arc::new(material), light: None };
    Light::emitter(&emitter).expect("it emits")
}

/// E/π on a receiver, by n × n stratified samples.
fn irradiance(light: &Light, at: DVec3, normal: DVec3, n: u32) -> f64 {
    let mut sum = 0.0;
    for u in grid(n) {
        if let Some(s) = light.sample(at, normal, u) {
            sum += s.weight.x * s.wi.dot(normal).max(0.0);
        }
    }
    sum / f64::from(n * n) / PI
}

fn assert_near(found: f64, exact: f64, tolerance: f64, what: &str) {
    assert!((found - exact).abs() <= tolerance, "{what}: {found}, not {exact}");
}

fn sphere(radius: f64) -> EmitterShape {
    EmitterShape::Sphere { center: DVec3::ZERO, radius }
}

#[test]
fn sphere_lights_give_the_closed_form_at_every_tilt() {
    for (d, degrees, exact) in [
        (2.0, 0.0, 0.25),
        (2.0, 45.0, 0.176777),
        (2.0, 60.0, 0.125),
        (2.0, 75.0, 0.070410),
        (2.0, 90.0, 0.028834),
        (2.0, 100.0, 0.011284),
        (2.0, 115.0, 0.000395),
        (1.2, 80.0, 0.231688),
    ] {
        let (s, c) = sin_cos_degrees(degrees);
        let light = emitter(sphere(1.0), Affine::IDENTITY, 1.0);
        let e = irradiance(&light, DVec3::new(0.0, 0.0, -d), DVec3::new(s, 0.0, c), 400);
        assert_near(e, exact, 3e-5, &format!("d = {d}, {degrees}°"));
    }
}

#[test]
fn tiny_sphere_lights_keep_their_digits() {
    for power in 2..=9 {
        let r = crate::math::elementary::powi(0.1, power);
        let light = emitter(sphere(r), Affine::IDENTITY, 1.0 / (PI * r * r));
        let e = irradiance(&light, DVec3::new(0.0, 0.0, -1.0), DVec3::Z, 32) * PI;
        // Each direction has its own cosine; the deviation from the axis is r²/2 at most.
        assert_near(e, 1.0, 1e-6 + r * r, &format!("R = {r}"));
    }
}

#[test]
fn a_receiver_inside_or_almost_on_a_sphere_light_is_lit_without_nan() {
    let light = emitter(sphere(1.0), Affine::IDENTITY, 1.0);
    for at in [DVec3::ZERO, DVec3::new(0.3, 0.5, -0.2), DVec3::new(0.0, 0.0, -0.999_999_999)] {
        assert_near(irradiance(&light, at, DVec3::Z, 16), 1.0, 1e-12, "inside");
    }
    for d in [1.000_000_1, 1.0, 1.0 + f64::EPSILON] {
        let e = irradiance(&light, DVec3::new(0.0, 0.0, -d), DVec3::Z, 64);
        assert!((0.99..=1.0 + 1e-9).contains(&e), "at {d}: {e}");
    }
}

#[test]
fn disc_lights_give_the_closed_form() {
    for (h, a, exact) in [
        (1.0, 0.0, 0.5),
        (1.0, 0.5, 0.437983),
        (1.0, 1.0, 0.276393),
        (1.0, 2.0, 0.052786),
        (0.5, 0.9, 0.470054),
    ] {
        let disc = Disc { center: DVec3::new(a, 0.0, h), normal: -DVec3::Z, radius: 1.0 };
        let light = emitter(EmitterShape::Disc(disc), Affine::IDENTITY, 1.0);
        assert_near(
            irradiance(&light, DVec3::ZERO, DVec3::Z, 500),
            exact,
            2e-5,
            &format!("h = {h}, a = {a}"),
        );
    }
}

#[test]
fn rect_and_triangle_lights_give_lamberts_polygons() {
    for (half, offset, exact) in [(0.5, 0.0, 0.239456), (1.0, 0.0, 0.554126), (0.5, 0.5, 0.138532)] {
        let rect = Rect { center: DVec3::new(offset, offset, 1.0), a: DVec3::Y * half, b: DVec3::X * half };
        let light = emitter(EmitterShape::Rect(rect), Affine::IDENTITY, 1.0);
        assert_near(irradiance(&light, DVec3::ZERO, DVec3::Z, 200), exact, 2e-5, "rect");
    }
    let octant = Triangle { vertices: [DVec3::X, DVec3::Z, DVec3::Y], normals: None, uvs: None };
    let light = emitter(EmitterShape::Triangle(octant), Affine::IDENTITY, 1.0);
    let n = DVec3::ONE.normalize();
    assert_near(irradiance(&light, DVec3::ZERO, n, 400), 0.433013, 2e-5, "octant");
}

#[test]
fn flat_lights_do_not_shine_backward() {
    let rect = Rect { center: DVec3::Z, a: DVec3::X, b: DVec3::Y };
    let light = emitter(EmitterShape::Rect(rect), Affine::IDENTITY, 1.0);
    assert_eq!(irradiance(&light, DVec3::ZERO, DVec3::Z, 8), 0.0);
    assert!(irradiance(&light, DVec3::Z * 2.0, -DVec3::Z, 8) > 0.0);
}

/// A solid of any form fills the whole view of a receiver inside.
#[test]
fn closed_solids_light_their_inside() {
    let squash =
        Affine::scale(DVec3::new(1.0, 2.0, 0.5)).then(&Affine::rotate_xyz(DVec3::new(10.0, 20.0, 30.0)));
    let cone = Cone { from: -DVec3::Z, to: DVec3::Z, radii: [1.0, 0.6] };
    for (name, shape) in [
        ("ellipsoid", sphere(1.0)),
        ("box", EmitterShape::Box(-DVec3::ONE, DVec3::ONE)),
        ("frustum", EmitterShape::Cone(cone)),
    ] {
        let light = emitter(shape, squash, 1.0);
        let e = irradiance(&light, squash.point(DVec3::new(0.1, -0.2, 0.1)), DVec3::Z, 800);
        assert_near(e, 1.0, 1e-2, name);
    }
}

/// Far away, E/π = projected area/(π d²) for a convex solid; a torus on its axis's side shows a ring.
#[test]
fn pieces_of_solids_have_their_true_area() {
    let d = 1e4;
    let far = |shape, from: DVec3| {
        irradiance(&emitter(shape, Affine::IDENTITY, 1.0), from * d, -from, 600) * PI * d * d
    };
    assert_near(far(EmitterShape::Box(-DVec3::ONE, DVec3::ONE), DVec3::X), 4.0, 1e-3, "box");
    let cylinder = Cone { from: -DVec3::Z, to: DVec3::Z, radii: [1.0, 1.0] };
    assert_near(far(EmitterShape::Cone(cylinder), DVec3::X), 4.0, 4e-3, "cylinder from the side");
    assert_near(far(EmitterShape::Cone(cylinder), DVec3::Z), PI, 2e-2, "cylinder from its end");
    let torus = Torus { center: DVec3::ZERO, axis: DVec3::Z, radii: [2.0, 0.5] };
    // From above, the outward half of the tube projects to the ring: π((R + r)² − (R − r)²).
    assert_near(far(EmitterShape::Torus(torus), DVec3::Z), 4.0 * PI * 2.0 * 0.5, 1e-2, "torus");
}

#[test]
fn an_ellipsoid_is_no_sphere() {
    let light = emitter(sphere(1.0), Affine::scale(DVec3::new(1.0, 1.0, 3.0)), 1.0);
    let d = 1e4;
    let e = irradiance(&light, DVec3::X * d, -DVec3::X, 600) * PI * d * d;
    assert_near(e, 3.0 * PI, 0.02, "seen from the side");
}

#[test]
fn a_uniform_sky_gives_pi_times_its_radiance() {
    let light = Light::new(Source::Sky { radiance: Rgb::ONE }, None, true, 16);
    for normal in [DVec3::Z, -DVec3::Z, DVec3::new(0.3, -0.8, -0.2).normalize()] {
        assert_near(irradiance(&light, DVec3::ZERO, normal, 4), 1.0, 1e-14, "sky");
    }
}

#[test]
fn spots_are_full_inside_and_dark_outside_their_cones() {
    let cones = [20.0, 30.0].map(|a| sin_cos_degrees(a).1);
    let at = |degrees: f64| cone_share(sin_cos_degrees(degrees).1, cones);
    assert_eq!((at(0.0), at(19.99), at(30.01), at(90.0)), (1.0, 1.0, 0.0, 0.0));
    assert!((0.05..0.95).contains(&at(25.0)));
    let steps: Vec<f64> = (0..=100).map(|i| at(19.0 + f64::from(i) * 0.12)).collect();
    assert!(
        steps.windows(2).all(|w| w[1] <= w[0] && w[0] - w[1] < 0.05),
        "begins to fall at the inner angle"
    );
    assert_eq!(cone_share(0.5, [0.5, 0.5]), 1.0, "a hard edge");
}

#[test]
fn point_lights_fall_off_by_the_square_unless_told_otherwise() {
    let position = DVec3::new(0.0, 0.0, 4.0);
    let light = |falloff| {
        let source = Source::Point { position, intensity: Rgb::splat(32.0) };
        Light::new(source, falloff, true, 1)
    };
    let at_origin = |falloff| light(falloff).sample(DVec3::ZERO, DVec3::Z, DVec2::splat(0.5)).unwrap();
    assert_eq!(at_origin(None).weight, Rgb::splat(2.0));
    assert_eq!(at_origin(None).wi, DVec3::Z);
    assert_eq!(at_origin(Some([0.0, 0.0, 1.0])).weight, Rgb::splat(32.0));
    assert_eq!(at_origin(Some([1.0, 2.0, 8.0])).weight, Rgb::splat(1.0));
    assert!(light(None).sample(position, DVec3::Z, DVec2::splat(0.5)).is_none(), "at the light itself");
}

#[test]
fn frames_are_orthonormal_and_right_handed() {
    for n in [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(1e-9, 0.0, -1.0).normalize(), DVec3::ONE.normalize()]
    {
        let (s, t) = frame(n);
        assert!((s.cross(t) - n).length() < 1e-15 && s.dot(t).abs() < 1e-15 && s.is_normalized());
    }
}

#[test]
fn squares_that_face_or_meet_exchange_their_form_factors() {
    let rect = |center, a, b| EmitterShape::Rect(Rect { center, a: a * 0.5, b: b * 0.5 });
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let opposite = emitter(rect(z, y, x), Affine::IDENTITY, 1.0);
    let beside = emitter(rect((x + z) / 2.0, y, -z), Affine::IDENTITY, 1.0);
    for (light, exact) in [(opposite, 0.199825), (beside, 0.200044)] {
        let n = 24;
        let at = |u: DVec2| DVec3::new(u.x - 0.5, u.y - 0.5, 0.0);
        let mean = grid(n).map(|u| irradiance(&light, at(u), z, 128)).sum::<f64>() / f64::from(n * n);
        assert_near(mean, exact, 2e-3 * exact, "from square to square");
    }
}
