//! Indirect light: pictures by paths whose numbers are known from closed forms, and agreement with what asks lights alone.

use crate::stage::*;
use glam::DVec3;
use ogee::render::features::{Layer, Layers as Kept};
use ogee::render::sampler::Sampler;
use ogee::render::settings::{Crop, ResolvedSettings};
use ogee::scene::*;
use ogee::world::bsdf::Bsdf;
use ogee::world::light::Lights;
use ogee::world::{Ray, RayKind, World};
use std::f64::consts::PI;
use std::sync::Arc;

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;

/// Settings of the path tracer without a last segment.
fn paths(samples: u32, seed: u64) -> ResolvedSettings {
    ResolvedSettings { tracer: TracerKind::Path, depth: u32::MAX, samples, seed, ..settings([1, 1]) }
}

/// The mean of 16 pictures of one pixel, each by numbers of its own, and the standard error of that mean.
fn by_paths(world: &World, eye: DVec3, target: DVec3, samples: u32) -> (f64, f64) {
    by(TracerKind::Path, world, (eye, target), samples)
}

fn by(tracer: TracerKind, world: &World, (eye, target): (DVec3, DVec3), samples: u32) -> (f64, f64) {
    let n = 16;
    let settings = |seed| ResolvedSettings { tracer, ..paths(samples, seed) };
    let of = |seed| seen_by(&settings(seed), world, eye, target).0.x;
    let values: Vec<f64> = (0..n).map(of).collect();
    let mean = values.iter().sum::<f64>() / n as f64;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (mean, (squares / (n * (n - 1)) as f64).sqrt())
}

/// Within three standard errors of the truth, and within 3 per mille of it.
fn agrees((mean, error): (f64, f64), exact: f64) {
    let off = (mean - exact).abs();
    assert!(off <= 3.0 * error + 1e-12 && off <= 0.003 * exact, "{mean} ± {error}, truly {exact}");
}

#[test]
fn a_closed_room_that_glows_is_as_bright_as_its_series_and_not_as_the_first_terms() {
    for (albedo, samples) in [(0.5, 256), (0.8, 2048), (0.9, 8192)] {
        let room = world(vec![object(sphere(DVec3::ZERO, 1.0), &glowing_and(1.0, albedo))]);
        let eye = DVec3::new(0.3, 0.1, -0.2);
        agrees(by_paths(&room, eye, eye + X, samples), 1.0 / (1.0 - albedo));
    }
}

#[test]
fn paths_that_branch_find_the_same_light() {
    let by_branches =
        |world: &World, eye, target, samples| by(TracerKind::MonteCarlo, world, (eye, target), samples);
    let glows = world(vec![object(sphere(DVec3::ZERO, 1.0), &glowing_and(1.0, 0.8))]);
    agrees(by_branches(&glows, DVec3::new(0.3, 0.1, -0.2), X, 1024), 5.0);
    let lamp = point(0.5 * X, 1.0);
    let lit = world(vec![object(sphere(DVec3::ZERO, 1.0), &diffuse(0.8)), lamp]);
    agrees(by_branches(&lit, DVec3::new(0.0, 0.0, 0.2), -X, 4096), 1.131768);
    let floor = DVec3::new(0.5, 0.0, 0.5);
    agrees(by_branches(&white_box(0.5), DVec3::splat(0.5), floor, 4096), 0.19760);
    // Past a smooth mirror the first surface that spreads light branches, and no other does.
    let mirrored = world(vec![
        object(rect(2.0 * X, Y, Z), &mirror(1.0)),
        object(sphere(DVec3::ZERO, 4.0), &glowing_and(1.0, 0.5)),
    ]);
    agrees(by_branches(&mirrored, DVec3::ZERO, X, 1024), by_paths(&mirrored, DVec3::ZERO, X, 4096).0);
}

/// A sky of a picture.
fn picture_sky(colour: impl Fn(f64, f64) -> [f64; 3]) -> Node {
    let picture = ogee::scene::assets::image::Picture::default();
    picture.set(Arc::new(ogee::scene::assets::image::Image::from_texels(64, 32, colour)));
    let span = ogee::diag::Span { source: ogee::diag::SourceId(0), start: 0, end: 0 };
    light(LightSource::Sky(Sky::Image { path: "sky.hdr".into(), factor: Rgb::ONE, span, picture }))
}

#[test]
fn a_sky_of_a_picture_lights_as_much_as_it_shines() {
    let eye = DVec3::new(1e-3, 0.5, 0.0);
    let floor = |sky| world(vec![object(plane(Y, 0.0), &diffuse(1.0)), sky]);
    let lit = |tracer, sky| by(tracer, &floor(sky), (eye, DVec3::ZERO), 4096);
    for tracer in [TracerKind::Whitted, TracerKind::Path, TracerKind::MonteCarlo] {
        // With its mirror image it would be even: half the light, and so it stays with a small sun at half height in both.
        agrees(lit(tracer, picture_sky(|x, _| [f64::from(x > 0.5); 3])), 0.5);
        let sun = |x: f64, y: f64| f64::from((x - 0.3).abs() < 0.016 && (y - 0.25).abs() < 0.032) * 1e4;
        let suns = lit(tracer, picture_sky(move |x, y| [sun(x, y) + sun(1.0 - x, y); 3]));
        let one = lit(tracer, picture_sky(move |x, y| [2.0 * sun(x, y); 3]));
        assert!((suns.0 - one.0).abs() < 3e-3 * one.0, "{tracer:?}: {} and {}", suns.0, one.0);
    }
}

#[test]
fn an_even_picture_of_a_sky_is_left_as_it_is_by_what_loses_nothing() {
    for material in [glass(1.5), mirror(1.0)] {
        let world = world(vec![object(sphere(DVec3::ZERO, 1.0), &material), picture_sky(|_, _| [1.0; 3])]);
        for target in [DVec3::ZERO, 0.7 * X, DVec3::new(0.69, 0.69, 0.0)] {
            let found = seen_by(&paths(16, 0), &world, DVec3::new(0.3, 0.2, 4.0), target).0;
            near(found.x, 1.0, 1e-12);
        }
    }
}

#[test]
fn a_depth_leaves_out_what_longer_paths_bring() {
    let room = world(vec![object(sphere(DVec3::ZERO, 1.0), &glowing_and(1.0, 0.5))]);
    let cut = |depth| {
        let settings = ResolvedSettings { depth, ..paths(4096, 1) };
        seen_by(&settings, &room, DVec3::ZERO, X).0.x
    };
    near(cut(1), 1.0, 1e-12);
    near(cut(2), 1.5, 2e-3);
    near(cut(4), 1.875, 4e-3);
}

#[test]
fn an_integrating_sphere_adds_the_same_light_everywhere() {
    let lamp = point(0.5 * X, 1.0);
    let room = world(vec![object(sphere(DVec3::ZERO, 1.0), &diffuse(0.8)), lamp]);
    for (p, exact) in [(X, 2.037183), (-X, 1.131768), (Y, 1.200803)] {
        agrees(by_paths(&room, DVec3::new(0.0, 0.0, 0.2), p, 16384), exact);
    }
}

#[test]
fn spheres_in_one_another_light_each_other() {
    let world = world(vec![
        object(sphere(DVec3::ZERO, 0.5), &glowing_and(1.0, 0.5)),
        object(sphere(DVec3::ZERO, 1.0), &diffuse(0.8)),
    ]);
    agrees(by_paths(&world, 0.8 * X, DVec3::ZERO, 4096), 4.0 / 3.0);
    agrees(by_paths(&world, 0.8 * X, X, 16384), 2.0 / 3.0);
}

#[test]
fn planes_that_face_each_other_have_the_light_of_their_series() {
    let world =
        world(vec![object(plane(Y, 0.0), &glowing_and(1.0, 0.5)), object(plane(Y, 1.0), &diffuse(0.7))]);
    let eye = 0.5 * Y;
    for tracer in [TracerKind::Path, TracerKind::MonteCarlo, TracerKind::Photon] {
        for (side, exact) in [(-0.5, 1.0 / 0.65), (0.5, 0.7 / 0.65)] {
            agrees(by(tracer, &world, (eye, eye + DVec3::new(0.3, side, 0.1)), 8192), exact);
        }
    }
}

#[test]
fn a_half_hidden_lamp_averages_the_product() {
    // The near half of the lamp hides behind a wall; the share of it that is seen, times what all of it would bring, is 0.111.
    let lamp = object(rect(DVec3::new(2.0, 1.0, 0.0), 2.0 * X, 0.5 * Z), &glowing(1.0));
    let wall = object(rect(DVec3::new(0.0, 0.5, 0.0), X, 5.0 * Z), &diffuse(0.0));
    let world = world(vec![object(plane(Y, 0.0), &diffuse(1.0)), lamp, wall]);
    for tracer in [TracerKind::Path, TracerKind::MonteCarlo] {
        let (found, error) = by(tracer, &world, (DVec3::new(1e-4, 1e-3, 0.0), DVec3::ZERO), 4096);
        near(found, 0.008399, 3.0 * error + 1e-5);
        assert!(error < 1e-4, "{error}");
    }
}

#[test]
fn a_white_box_has_the_radiosity_of_its_form_factors() {
    let centre = DVec3::splat(0.5);
    let floor = DVec3::new(0.5, 0.0, 0.5);
    let corner = DVec3::new(0.1, 0.0, 0.1);
    let wall = DVec3::new(0.0, 0.5, 0.5);
    let high = DVec3::new(0.0, 0.9, 0.5);
    for (albedo, truths) in [
        (0.5, [(floor, 0.19760), (corner, 0.14840), (wall, 0.17765), (high, 0.29235)]),
        (0.8, [(floor, 0.71306), (corner, 0.61290), (wall, 0.68366), (high, 0.87217)]),
    ] {
        let room = white_box(albedo);
        for (p, exact) in truths {
            agrees(by_paths(&room, centre, p, 8192), exact);
        }
    }
}

/// The settings of a picture of so many pixels that its roulette is learned, of which a part is rendered.
fn learned(tracer: TracerKind, samples: u32, crop: Crop) -> ResolvedSettings {
    ResolvedSettings { size: [256, 128], crop, tracer, ..paths(samples, 3) }
}

#[test]
fn a_learned_roulette_leaves_the_radiosity_of_a_white_box() {
    let eye = camera(DVec3::splat(0.5), DVec3::new(0.5, 0.0, 0.5), 1e-3);
    let crop = Crop { x: 96, y: 32, width: 64, height: 64 };
    for (tracer, samples) in [(TracerKind::Path, 64), (TracerKind::MonteCarlo, 16)] {
        // Every pixel sees the same place.
        let film =
            picture(&white_box(0.8), &Camera { up: X, ..eye.clone() }, &learned(tracer, samples, crop));
        let mean = film.mean().x;
        let squares: f64 = film.pixels.iter().map(|p| (p.x - mean) * (p.x - mean)).sum();
        let n = crop.area() as f64;
        agrees((mean, (squares / (n - 1.0) / n).sqrt()), 0.71306);
    }
}

#[test]
fn what_is_learned_before_a_picture_shows_neither_threads_nor_crops() {
    let room = white_box(0.5);
    let eye = camera(DVec3::new(0.5, 0.5, 0.98), DVec3::new(0.5, 0.4, 0.0), 60.0);
    let of = |threads, crop| {
        let settings = ResolvedSettings { threads: Some(threads), ..learned(TracerKind::Path, 2, crop) };
        picture(&room, &eye, &settings)
    };
    let (wide, narrow) =
        (Crop { x: 90, y: 40, width: 40, height: 40 }, Crop { x: 100, y: 50, width: 9, height: 7 });
    let (one, three, part) = (of(1, wide), of(3, wide), of(2, narrow));
    assert_eq!(one.pixels, three.pixels);
    for (x, y) in (0..7).flat_map(|y| (0..9).map(move |x| (x, y))) {
        assert_eq!(part.pixel(x, y), one.pixel(x + 10, y + 10));
    }
}

#[test]
fn direct_light_is_what_asking_every_light_gives() {
    let floor = || object(plane(Y, 0.0), &diffuse(1.0));
    let eye = DVec3::new(1e-3, 0.5, 0.0);
    let lit = |nodes: Vec<Node>| by_paths(&world(nodes), eye, DVec3::ZERO, 4096);
    agrees(lit(vec![floor(), point(2.0 * Y, 10.0)]), 10.0 / (4.0 * PI));
    agrees(lit(vec![floor(), area(disc(Y, -Y, 1.0), 1.0, 1)]), 0.5);
    agrees(lit(vec![floor(), area(rect(Y, 0.5 * X, 0.5 * Z), 1.0, 1)]), 0.239456);
    agrees(lit(vec![floor(), area(sphere(2.0 * Y, 1.0), 1.0, 1)]), 0.25);
    agrees(lit(vec![floor(), object(sphere(2.0 * Y, 1.0), &glowing(1.0)), sky(0.5)]), 0.25 + 0.5 * 0.75);
}

/// Mean and variance of some numbers.
fn spread(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0))
}

/// Plates and lamps of all sizes, as in Veach & Guibas (1995): where one of the two ways is noisy the other is not.
#[test]
fn asking_meeting_and_both_find_the_same_light_and_both_is_never_noisy() {
    let n = 1 << 14;
    for (roughness, radius) in
        [0.05, 0.2, 0.7].into_iter().flat_map(|roughness| [0.03, 0.3, 1.2].map(|radius| (roughness, radius)))
    {
        let plate =
            layered(0.0, |l| (l.metal, l.roughness) = (Texture::number(0.9), Texture::number(roughness)));
        let lamp = object(sphere(DVec3::new(0.0, 2.0, -2.0), radius), &glowing(1.0));
        let world = world(vec![object(rect(DVec3::ZERO, 4.0 * X, -4.0 * Z), &plate), lamp]);
        let lights = Lights::new(&world);
        let light = &lights.lights[0];
        let (origin, t_max, kind) = (DVec3::new(0.0, 2.0, 2.2), f64::INFINITY, RayKind::Camera);
        let ray = Ray { origin, direction: -origin.normalize(), t_max, kind };
        let hit = world.closest(&ray).expect("the plate");
        let bsdf = Bsdf::at(&world, &hit, &ray).expect("no function");
        let (odds, at, normal) = (bsdf.odds(), hit.point, bsdf.normal);
        let share = |this: f64, other: f64| this / (this + other);
        let (mut asked, mut met, mut both) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..n {
            let mut sampler = Sampler::new(7, 0, 0, i).of_kind(SamplerKind::Independent, n);
            let (place, which, way) = (sampler.next_2d(), sampler.next_1d(), sampler.next_2d());
            let of_lamp = light.sample(at, normal, place);
            let (one, by_one) = of_lamp.map_or((0.0, 0.0), |sample| {
                let found = (bsdf.sent(sample.wi) * sample.weight).x;
                let density = sample.pdf.expect("it has an extent");
                (found, found * share(density, bsdf.density(odds, sample.wi)))
            });
            let shining = bsdf.bounce(odds, which, way).and_then(|bounce| {
                let found = world.closest(&hit.spawn(bounce.direction, RayKind::Indirect))?;
                lights.of(&world, found.primitive)?;
                let by_lamp = light.density(at, normal, bounce.direction, Some(&found.surface_point()));
                Some((bounce.weight.x, share(bounce.density?, by_lamp?)))
            });
            let (other, part) = shining.unwrap_or((0.0, 0.0));
            asked.push(one);
            met.push(other);
            both.push(by_one + other * part);
        }
        let [asked, met, both] = [asked, met, both].map(|values| spread(&values));
        let case = format!("roughness {roughness}, radius {radius}: {asked:?} {met:?} {both:?}");
        for (mean, variance) in [asked, met] {
            let error = ((variance + both.1) / f64::from(n)).sqrt();
            assert!((mean - both.0).abs() < 4.0 * error, "{case}");
        }
        // Theory allows half of the light squared beside what the better way has.
        let most = asked.1.min(met.1) + 0.15 * both.0 * both.0;
        assert!(both.0 > 0.0 && both.1 < most, "{case}");
    }
}

#[test]
fn curved_lights_that_chance_cannot_weigh_are_only_asked() {
    let squashed = |d| Some(ogee::math::Affine::scale(d));
    let lamp = |d| placed(sphere(DVec3::new(0.0, 2.0, 0.0), 1.0), &glowing(1.0), squashed(d));
    let seen = |d| {
        let nodes = vec![object(plane(Y, 0.0), &diffuse(1.0)), lamp(d)];
        by_paths(&world(nodes), DVec3::new(1e-3, 0.5, 0.0), DVec3::ZERO, 16384)
    };
    let (round, _) = seen(DVec3::ONE);
    // A scale that is a similarity but for its last bits takes the other way to sample.
    agrees(seen(DVec3::new(1.0, 1.0, 1.0 + 1e-9)), round);
}

#[test]
fn an_even_sky_is_left_as_it_is_by_what_loses_nothing() {
    let eye = DVec3::new(0.3, 0.2, 4.0);
    let is_one = |material: &Arc<Material>| {
        let world = world(vec![object(sphere(DVec3::ZERO, 1.0), material), sky(1.0)]);
        for target in [DVec3::ZERO, 0.7 * X, 0.9 * Y, DVec3::new(0.69, 0.69, 0.0)] {
            let found = seen_by(&paths(16, 0), &world, eye, target).0;
            near(found.x, 1.0, 1e-12);
        }
    };
    is_one(&diffuse(1.0));
    is_one(&glass(1.5));
    is_one(&mirror(1.0));
    is_one(&layered(1.0, |l| l.reflect = Texture::number(0.5)));
}

#[test]
fn a_hole_lets_by_what_it_should() {
    let veil = layered(0.0, |l| l.opacity = Texture::number(0.25));
    let nodes = vec![
        object(plane(Y, 0.0), &diffuse(1.0)),
        object(rect(Y, 100.0 * X, 100.0 * Z), &veil),
        point(2.0 * Y, 4.0 * PI),
    ];
    agrees(by_paths(&world(nodes), DVec3::new(1e-3, 0.5, 0.0), DVec3::ZERO, 1024), 0.75);
}

#[test]
fn frosted_glass_lights_by_lamps_and_by_chance_alike() {
    // The same small bright ball, as a light that is asked and as one that paths must meet.
    let frosted = layered(0.0, |l| {
        (l.transmit, l.ior) = (Texture::number(1.0), Texture::number(1.5));
        (l.roughness, l.fresnel) = (Texture::number(0.4), Fresnel::Exact);
    });
    let scene = |lamp: Node| world(vec![object(rect(Y, 4.0 * X, 4.0 * Z), &frosted), lamp]);
    let radius = 0.01;
    let ball = |center: DVec3| sphere(center, radius);
    let radiance = 1000.0;
    let (eye, at) = (DVec3::new(0.0, 2.0, 0.5), Y);
    let lamp = DVec3::new(0.3, 0.0, 0.0);
    let asked = by_paths(&scene(point(lamp, radiance * PI * radius * radius)), eye, at, 1024);
    let both = by_paths(&scene(object(ball(lamp), &glowing(radiance))), eye, at, 16384);
    let off = (asked.0 - both.0).abs();
    assert!(asked.0 > 0.005 && off < 3.0 * both.1 + 0.002 * both.0, "{asked:?} and {both:?}");
}

#[test]
fn one_of_many_lights_is_asked_and_all_count() {
    let lamps = (0..20).map(|i| point(DVec3::new(f64::from(i) - 10.0, 2.0, 0.0), f64::from(i * i)));
    let nodes: Vec<Node> = [object(plane(Y, 0.0), &diffuse(0.7))].into_iter().chain(lamps).collect();
    let exact: f64 = (0..20)
        .map(|i| {
            let x = f64::from(i) - 10.0;
            0.7 / PI * f64::from(i * i) * 2.0 / (x * x + 4.0f64).powf(1.5)
        })
        .sum();
    agrees(by_paths(&world(nodes), DVec3::new(1e-3, 0.5, 0.0), DVec3::ZERO, 8192), exact);
}

#[test]
fn a_perfect_mirror_takes_one_ray_and_lamps_are_asked_once_a_surface() {
    let nodes = vec![object(plane(Y, 0.0), &mirror(1.0)), sky(1.0), point(Y, 1.0)];
    let (seen, sampler) = seen_by(&paths(1, 0), &world(nodes), DVec3::new(0.0, 1.0, 1.0), DVec3::ZERO);
    near(seen.x, 1.0, 1e-12);
    let rays = sampler.rays;
    assert_eq!((rays.camera, rays.reflected, rays.shadow, rays.scattered), (1, 1, 0, 0));
}

#[test]
fn two_mirrors_that_lose_nothing_end() {
    let nodes = vec![object(plane(Y, 0.0), &mirror(1.0)), object(plane(-Y, -1.0), &mirror(1.0)), sky(1.0)];
    let (seen, sampler) = seen_by(&paths(64, 0), &world(nodes), DVec3::new(0.0, 0.5, 0.0), Y);
    assert!(seen.is_finite() && sampler.rays.reflected < 5000, "{:?}", sampler.rays);
}

#[test]
fn a_white_rough_metal_under_a_white_sky_is_white_at_every_pixel() {
    let eye = camera(4.0 * DVec3::Z, DVec3::ZERO, 35.0);
    let layers = Kept::NONE.with(Layer::Variance);
    for (roughness, tracer) in [0.05, 0.08, 0.15, 0.3, 0.5, 0.75, 1.0]
        .into_iter()
        .flat_map(|r| [(r, TracerKind::Path), (r, TracerKind::Whitted), (r, TracerKind::MonteCarlo)])
    {
        let white = layered(0.0, |l| {
            (l.metal, l.roughness) = (Texture::number(1.0), Texture::number(roughness));
        });
        let world = world(vec![object(sphere(DVec3::ZERO, 1.0), &white), sky(1.0)]);
        let settings = ResolvedSettings { tracer, layers, samples: 256, ..settings([12, 12]) };
        let film = picture(&world, &eye, &settings);
        for (pixel, features) in film.pixels.iter().zip(&film.features) {
            let (off, sigma) = ((pixel.x - 1.0).abs(), features.variance.x.sqrt());
            assert!(
                off <= 3.0 * sigma + 0.006,
                "{tracer:?}, roughness {roughness}: {} with {sigma}",
                pixel.x
            );
            assert!(off <= 0.05, "{tracer:?}, roughness {roughness}: {}", pixel.x);
        }
        assert!((film.mean().x - 1.0).abs() < 0.006, "{tracer:?}, {roughness}: {}", film.mean().x);
    }
}

fn rough_glass(roughness: f64, ior: f64) -> Arc<Material> {
    layered(0.0, |l| {
        (l.transmit, l.ior) = (Texture::number(1.0), Texture::number(ior));
        (l.roughness, l.fresnel) = (Texture::number(roughness), Fresnel::Exact);
    })
}

#[test]
fn rough_glass_under_a_white_sky_is_white_at_every_pixel_from_both_sides() {
    let layers = Kept::NONE.with(Layer::Variance);
    let tracers = [TracerKind::Path, TracerKind::Whitted, TracerKind::MonteCarlo];
    for (roughness, ior) in [(0.1, 1.5), (0.3, 1.33), (0.5, 1.5), (0.5, 2.4), (1.0, 1.5)] {
        let boundary = world(vec![object(plane(Y, 0.0), &rough_glass(roughness, ior)), sky(1.0)]);
        for (tracer, side) in tracers.into_iter().flat_map(|tracer| [(tracer, 1.0), (tracer, -1.0)]) {
            let eye = camera(DVec3::new(0.0, side, 1.0), DVec3::ZERO, 70.0);
            let settings = ResolvedSettings { tracer, layers, samples: 256, ..settings([8, 8]) };
            let film = picture(&boundary, &eye, &settings);
            let of = format!("{tracer:?}, roughness {roughness}, ior {ior}, side {side}");
            for (pixel, features) in film.pixels.iter().zip(&film.features) {
                let (off, sigma) = ((pixel.x - 1.0).abs(), features.variance.x.sqrt());
                assert!(off <= 3.5 * sigma + 0.02, "{of}: {} with {sigma}", pixel.x);
            }
            assert!((film.mean().x - 1.0).abs() < 0.015, "{of}: {}", film.mean().x);
        }
    }
}

#[test]
fn a_ball_of_rough_glass_in_a_white_room_is_not_seen() {
    let ball = world(vec![object(sphere(DVec3::ZERO, 1.0), &rough_glass(0.5, 1.5)), sky(1.0)]);
    let film = picture(
        &ball,
        &camera(4.0 * DVec3::Z, DVec3::ZERO, 20.0),
        &ResolvedSettings {
            tracer: TracerKind::Path,
            ..ResolvedSettings { depth: u32::MAX, samples: 1024, ..settings([8, 8]) }
        },
    );
    // Each bounce within it adds its own 0.004.
    assert!((film.mean().x - 1.0).abs() < 0.02, "{}", film.mean().x);
}
