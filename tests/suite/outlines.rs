//! Edges of lamps that the camera sees: as even as all else, and without bias.

use crate::stage::*;
use glam::DVec3;
use ogee::render::Tracer;
use ogee::render::camera::View;
use ogee::render::film::Film;
use ogee::render::passes::Passes;
use ogee::render::sampler::Sampler;
use ogee::render::settings::{Crop, ResolvedSettings};
use ogee::render::tiles::Picture;
use ogee::scene::*;
use ogee::world::{Found, Ray, World};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;

/// Width and height of the pictures.
const SIZE: u32 = 32;

/// Of the lamp, at the distance 1.
const RADIUS: f64 = 0.1;

const RADIANCE: f64 = 40.0;

fn of(tracer: TracerKind, samples: u32, seed: u64) -> ResolvedSettings {
    ResolvedSettings { tracer, samples, seed, depth: 8, ..settings([SIZE; 2]) }
}

fn paths(samples: u32, seed: u64) -> ResolvedSettings {
    of(TracerKind::Path, samples, seed)
}

/// From the origin along −z; the picture is one unit high at the distance 1.
fn eye() -> Camera {
    Camera { fov: 2.0 * 0.5f64.atan().to_degrees(), ..camera(DVec3::ZERO, -Z, 40.0) }
}

/// A round lamp before a wall that sends on a little of its light.
fn lamp(material: &Arc<Material>) -> World {
    world(vec![
        object(disc(DVec3::new(0.05, 0.02, -1.0), Z, RADIUS), material),
        object(rect(-1.5 * Z, 3.0 * X, 3.0 * Y), &glowing_and(0.5, 0.5)),
    ])
}

/// A tracer that tells no emission apart.
struct Plain(Box<dyn Tracer>);

impl Tracer for Plain {
    fn radiance(&self, world: &World, ray: &Ray, found: &Found, sampler: &mut Sampler) -> Rgb {
        self.0.radiance(world, ray, found, sampler)
    }
}

fn plain(world: &World, camera: &Camera, settings: &ResolvedSettings) -> Film {
    let tracer = Plain(tracer_from(settings, world, camera.eye, camera.look_at));
    picture_by(&tracer, world, camera, settings)
}

/// The share of a pixel that the disc fills, by a fine grid.
fn share(x: u32, y: u32) -> f64 {
    let n = 100;
    let at =
        |i: u32, sub: u32| (f64::from(i) + (f64::from(sub) + 0.5) / f64::from(n)) / f64::from(SIZE) - 0.5;
    let inside = |i: u32, j: u32| (at(x, i) - 0.05).hypot(-at(y, j) - 0.02) < RADIUS;
    let count = (0..n).map(|j| (0..n).filter(|&i| inside(i, j)).count()).sum::<usize>();
    count as f64 / f64::from(n * n)
}

#[test]
fn the_edge_of_a_lamp_is_as_bright_as_the_share_of_a_pixel_that_it_fills() {
    let alone = world(vec![object(disc(DVec3::new(0.05, 0.02, -1.0), Z, RADIUS), &glowing(RADIANCE))]);
    for tracer in [TracerKind::Path, TracerKind::MonteCarlo, TracerKind::Irradiance, TracerKind::Photon] {
        let film = picture(&alone, &eye(), &of(tracer, 2, 1));
        for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
            // Of 128 even points at most the 16 whose cells a straight line cuts are uncertain, and they err by chance.
            near(film.pixel(x, y).x, RADIANCE * share(x, y), RADIANCE * 0.03);
        }
    }
}

/// Mean and variance of a picture's mean, and the mean of its pixels' variances, over seeds.
fn statistics(film: impl Fn(u64) -> Film) -> (f64, f64, f64) {
    let films: Vec<Film> = (0..32).map(film).collect();
    let n = films.len() as f64;
    let spread = |values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / n;
        (mean, values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0))
    };
    let (mean, variance) = spread(films.iter().map(|film| film.mean().x).collect());
    let pixels = 0..films[0].pixels.len();
    let of_pixel = |i: usize| spread(films.iter().map(|film| film.pixels[i].x).collect()).1;
    (mean, variance / n, pixels.clone().map(of_pixel).sum::<f64>() / pixels.len() as f64)
}

#[test]
fn rays_of_its_own_leave_the_light_as_it_is_and_its_noise_a_seventh() {
    let thin = layered(0.2, |l| {
        (l.emit, l.opacity) = (Texture::number(RADIANCE), Texture::number(0.5));
    });
    let wide = Camera { aperture: 0.1, focus: Some(0.6), ..eye() };
    let soft = |s: ResolvedSettings| ResolvedSettings { filter: PixelFilter::Gaussian, ..s };
    let scattered = |s: ResolvedSettings| ResolvedSettings { sampler: SamplerKind::Independent, ..s };
    type Change = fn(ResolvedSettings) -> ResolvedSettings;
    let cases: [(_, _, Change); 4] = [
        (glowing_and(RADIANCE, 0.3), eye(), scattered),
        (glowing_and(RADIANCE, 0.3), eye(), soft),
        (glowing_and(RADIANCE, 0.3), wide, scattered),
        (thin, eye(), scattered),
    ];
    for (i, (material, camera, change)) in cases.into_iter().enumerate() {
        let room = lamp(&material);
        let apart = statistics(|seed| picture(&room, &camera, &change(paths(4, seed))));
        let (mean, variance, noise) = statistics(|seed| plain(&room, &camera, &change(paths(4, seed))));
        near(apart.0, mean, 3.0 * (apart.1 + variance).sqrt());
        assert!(7.0 * apart.2 < noise, "{i}: {} of {noise}", apart.2);
    }
}

#[test]
fn what_is_not_much_brighter_than_white_or_hidden_takes_no_rays_of_its_own() {
    let mut hidden = Object::new(disc(-Z, Z, 0.3), SPAN);
    hidden.material = Some(glowing(RADIANCE));
    hidden.hide.camera = true;
    let walls = || object(rect(-1.5 * Z, 3.0 * X, 3.0 * Y), &diffuse(0.5));
    let rooms = [lamp(&glowing_and(3.9, 0.3)), world(vec![walls(), Node::Object(Arc::new(hidden))])];
    for room in rooms {
        let (film, before) = (picture(&room, &eye(), &paths(4, 7)), plain(&room, &eye(), &paths(4, 7)));
        assert_eq!(film.pixels, before.pixels);
        assert_eq!(film.report.rays, before.report.rays);
    }
}

#[test]
fn an_exposure_decides_what_is_much_brighter_than_white() {
    let room = lamp(&glowing_and(3.9, 0.3));
    let rays = |exposure| {
        let settings = ResolvedSettings { exposure, ..paths(4, 7) };
        picture(&room, &eye(), &settings).report.rays.camera
    };
    assert!(rays(3.0) > rays(0.0), "{} rays", rays(3.0));
}

#[test]
fn edges_show_neither_crops_nor_passes() {
    let room = lamp(&glowing_and(RADIANCE, 0.3));
    let whole = picture(&room, &eye(), &paths(4, 3));
    let crop = Crop { x: 12, y: 11, width: 9, height: 8 };
    let part = picture(&room, &eye(), &ResolvedSettings { crop, ..paths(4, 3) });
    for (x, y) in (0..8).flat_map(|y| (0..9).map(move |x| (x, y))) {
        assert_eq!(part.pixel(x, y), whole.pixel(x + 12, y + 11));
    }
    let (settings, camera) = (paths(4, 3), eye());
    let view = View::new(&camera, settings.size).expect("a camera that sees");
    let tracer = prepared(settings.tracer, &room, &view, &settings);
    let of_room = Picture { world: &room, view: &view, tracer: &*tracer, settings: &settings };
    let mut passes = Passes::new(&settings);
    for to in [1, 3, 4] {
        assert!(passes.advance(of_room, to, &(), &AtomicBool::new(false)));
    }
    assert_eq!(passes.film().pixels, whole.pixels);
}

#[test]
fn the_only_sample_goes_through_the_centre_of_its_pixel() {
    let room = lamp(&glowing_and(RADIANCE, 0.3));
    assert_eq!(picture(&room, &eye(), &paths(1, 3)).pixels, plain(&room, &eye(), &paths(1, 3)).pixels);
}

#[test]
fn a_clamp_dims_each_ray_and_not_their_mean() {
    let room = lamp(&glowing(RADIANCE));
    let clamped = |seed| ResolvedSettings { clamp: Some(4.0), ..paths(4, seed) };
    let apart = statistics(|seed| picture(&room, &eye(), &clamped(seed)));
    let (mean, variance, _) = statistics(|seed| plain(&room, &eye(), &clamped(seed)));
    near(apart.0, mean, 3.0 * (apart.1 + variance).sqrt());
    let share = |film: Film| film.report.taken.clamped.share();
    near(share(picture(&room, &eye(), &clamped(1))), share(plain(&room, &eye(), &clamped(1))), 0.01);
}

#[test]
fn a_picture_full_of_edges_takes_few_rays_more() {
    let lamps = (0..900).map(|i| {
        let (x, y) = (f64::from(i % 30), f64::from(i / 30));
        object(disc(DVec3::new(x / 30.0 - 0.5, y / 30.0 - 0.5, -1.0), Z, 0.01), &glowing(RADIANCE))
    });
    let (room, n) = (world(lamps.collect()), f64::from(SIZE * SIZE * 64));
    let [apart, before] = [picture(&room, &eye(), &paths(64, 3)), plain(&room, &eye(), &paths(64, 3))]
        .map(|film| film.report.rays.camera as f64 / n);
    assert!(before <= 1.0 && apart <= 3.5, "{apart} rays of the camera each sample, {before} before");
}
