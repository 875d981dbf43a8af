//! Light by photons: closed forms within one in a hundred, caustics that no path finds, and agreement with paths.

use crate::stage::*;
use glam::DVec3;
use ogee::render::camera::View;
use ogee::render::film::Film;
use ogee::render::passes::render_renewing;
use ogee::render::sampler::Sampler;
use ogee::render::settings::{Crop, ResolvedSettings};
use ogee::render::tiles::{Progress, Watch};
use ogee::scene::*;
use ogee::world::light::{Aim, Lights, Targets};
use ogee::world::{Ray, RayKind, World};
use std::f64::consts::PI;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;

fn photons(samples: u32, seed: u64) -> ResolvedSettings {
    let (tracer, depth) = (TracerKind::Photon, u32::MAX);
    ResolvedSettings { tracer, depth, samples, seed, threads: None, ..settings([1, 1]) }
}

/// The mean of what is seen from a point of some others, by maps of three seeds.
fn by(settings: impl Fn(u64) -> ResolvedSettings, world: &World, eye: DVec3, targets: &[DVec3]) -> f64 {
    let (seeds, rays) = (3, 4096 / targets.len() as u32);
    let mut sum = 0.0;
    for seed in 0..seeds {
        let tracer = tracer_from(&settings(seed), world, eye, targets[0]);
        for (i, target) in targets.iter().enumerate() {
            let direction = (*target - eye).normalize();
            let ray = Ray { origin: eye, direction, t_max: f64::INFINITY, kind: RayKind::Camera };
            for sample in 0..rays {
                sum += tracer
                    .radiance(world, &ray, &world.find(&ray), &mut Sampler::new(seed, i as u32, 0, sample))
                    .x;
            }
        }
    }
    sum / f64::from(rays * targets.len() as u32) / seeds as f64
}

fn agrees(world: &World, eye: DVec3, target: DVec3, exact: f64) {
    let found = by(|seed| photons(24, seed), world, eye, &[target]);
    assert!((found - exact).abs() < 0.01 * exact, "{found}, truly {exact}");
}

#[test]
fn closed_rooms_are_as_bright_as_their_series() {
    for (albedo, exact) in [(0.5, 2.0), (0.8, 5.0)] {
        let room = world(vec![object(sphere(DVec3::ZERO, 1.0), &glowing_and(1.0, albedo))]);
        agrees(&room, DVec3::new(0.3, 0.1, -0.2), X, exact);
    }
}

#[test]
fn a_lamp_in_a_sphere_lights_all_of_it_anew_without_a_bias_of_the_nearest() {
    a_lamp_in_a_sphere(agrees);
}

#[test]
fn spheres_in_one_another_light_each_other() {
    spheres_in_one_another(agrees);
}

#[test]
fn a_white_box_has_the_radiosity_of_its_form_factors() {
    for (albedo, floor, wall) in [(0.5, 0.19760, 0.17765), (0.8, 0.71306, 0.68366)] {
        let (room, centre) = (white_box(albedo), DVec3::splat(0.5));
        agrees(&room, centre, DVec3::new(0.5, 0.0, 0.5), floor);
        agrees(&room, centre, DVec3::new(0.0, 0.5, 0.5), wall);
    }
}

#[test]
fn a_floor_in_the_sun_lights_what_is_above_it_as_its_form_factor_says() {
    // Photons that fell as evenly as their numbers are would be told too few: the farthest of the nearest lies beyond where chance would put it.
    let half = 2.0;
    let floor = object(rect(DVec3::ZERO, half * X, -half * Z), &diffuse(0.8));
    let plate = object(rect(Y, 0.02 * X, 0.02 * Z), &diffuse(0.5));
    let world = world(vec![floor, plate, sun(DVec3::new(3.0, -1.0, 0.0), 5.0 * 10.0f64.sqrt())]);
    // 5 on the floor. From above its middle a square of half side a at distance 1 fills 4/π · a/√(1 + a²) · atan(a/√(1 + a²)).
    let leg = half / (1.0 + half * half).sqrt();
    let filled = 4.0 / PI * leg * leg.atan();
    let exact = 0.5 * filled * 0.8 * 5.0 / PI;
    let eye = DVec3::new(0.5, 0.6, 0.3);
    let found = by(|seed| photons(64, seed), &world, eye, &[Y]);
    assert!((found - exact).abs() < 0.01 * exact, "{found}, truly {exact}");
}

/// A floor in the shadow of a slab of glass under the sun.
fn under_glass() -> World {
    let slab = cuboid(DVec3::new(-1.0, 1.0, -1.0), DVec3::new(1.0, 1.5, 1.0));
    world(vec![object(rect(DVec3::ZERO, X, Z), &diffuse(1.0)), object(slab, &glass(1.5)), sun(-Y, PI)])
}

#[test]
fn sunlight_through_glass_is_found_though_no_path_can() {
    let world = under_glass();
    let eye = DVec3::new(2.5, 0.9, 0.0);
    let targets: Vec<DVec3> =
        (0..256).map(|i| DVec3::new((i % 16) as f64 - 7.5, 0.0, (i / 16) as f64 - 7.5) / 16.0).collect();
    // Four segments: into the glass, out of it, to the eye. Each boundary passes 0.96.
    let settings = |seed| ResolvedSettings { depth: 4, ..photons(16, seed) };
    let found = by(settings, &world, eye, &targets);
    assert!((found - 0.96 * 0.96).abs() < 0.005, "{found}");
    let by_paths = ResolvedSettings { tracer: TracerKind::Path, ..settings(0) };
    assert_eq!(seen_by(&by_paths, &world, eye, DVec3::ZERO).0, Rgb::ZERO);
}

#[test]
fn a_slab_lets_by_a_point_of_light_with_all_its_inner_bounces() {
    // So wide that nothing comes back from its sides, which mirror it all to the axis.
    let slab = cuboid(DVec3::new(-50.0, 1.0, -50.0), DVec3::new(50.0, 2.0, 50.0));
    // So dark that what the slab mirrors back to it is nothing.
    let albedo = 1e-3;
    let floor = object(rect(DVec3::ZERO, 3.0 * X, -3.0 * Z), &diffuse(albedo));
    let world = world(vec![floor, object(slab, &glass(1.5)), point(3.0 * Y, 1.0)]);
    let near_axis: Vec<DVec3> =
        (0..64).map(|i| DVec3::new(f64::from(i % 8) - 3.5, 0.0, f64::from(i / 8) - 3.5) / 20.0).collect();
    let found = by(|seed| photons(24, seed), &world, 0.9 * Y, &near_axis) * PI / albedo;
    // Without its inner bounces 0.129600; without the slab 0.111111.
    assert!((found - 0.129692).abs() < 0.01 * 0.129692, "{found}");
}

#[test]
fn photons_and_paths_agree_where_glass_gathers_the_light_of_a_lamp() {
    let coated = layered(0.6, |l| {
        l.reflect = Texture::number(0.05);
        l.fresnel = Fresnel::Exact;
    });
    let world = world(vec![
        object(sphere(DVec3::ZERO, 4.0), &diffuse(0.5)),
        object(rect(-Y, 2.0 * Z, 2.0 * X), &coated),
        object(sphere(0.3 * Y, 0.6), &glass(1.5)),
        area(disc(DVec3::new(0.0, 2.5, 0.0), -Y, 0.8), 6.0, 1),
    ]);
    let eye = DVec3::new(2.5, 0.6, 0.5);
    let at = |i: i32| f64::from(i) * 0.2 - 1.5;
    let targets: Vec<DVec3> = (0..256).map(|i| DVec3::new(at(i % 16), -1.0, at(i / 16))).collect();
    let found = by(|seed| photons(24, seed), &world, eye, &targets);
    let paths = |target: &DVec3| {
        let settings = ResolvedSettings { tracer: TracerKind::Path, ..photons(4096, 5) };
        seen_by(&settings, &world, eye, *target).0.x
    };
    let truly = targets.iter().map(paths).sum::<f64>() / 256.0;
    assert!((found - truly).abs() < 0.01 * truly, "{found} by photons, {truly} by paths");
}

#[test]
fn photons_leave_the_same_picture_on_any_number_of_threads() {
    let world = under_glass();
    let of = |threads| {
        let settings = ResolvedSettings { threads: Some(threads), ..photons(16, 1) };
        let tracer = tracer_from(&settings, &world, 2.5 * X + 0.9 * Y, DVec3::ZERO);
        let see = |i: u32| {
            let direction = (DVec3::new(f64::from(i) / 64.0 - 0.5, 0.0, 0.1) - 0.9 * Y - 2.5 * X).normalize();
            let ray =
                Ray { origin: 2.5 * X + 0.9 * Y, direction, t_max: f64::INFINITY, kind: RayKind::Camera };
            tracer.radiance(&world, &ray, &world.find(&ray), &mut Sampler::new(1, i, 0, 0))
        };
        (0..64).map(see).collect::<Vec<Rgb>>()
    };
    let one = of(1);
    assert!(one.iter().any(|c| c.x > 0.5), "the caustic is seen");
    assert!([2, 3, 8].into_iter().all(|threads| of(threads) == one));
}

/// Calls the work off when photons are shot anew, if asked to.
struct Renewals {
    calls_off: bool,
    cancel: AtomicBool,
    seen: AtomicUsize,
}

impl Progress for Renewals {
    fn phase(&self, name: &'static str) {
        if name == "photons" {
            self.seen.fetch_add(1, Ordering::Relaxed);
            self.cancel.fetch_or(self.calls_off, Ordering::Relaxed);
        }
    }

    fn tiles(&self, _done: usize, _total: usize) {}
}

#[test]
fn samples_that_one_map_is_not_made_for_have_maps_of_their_own() {
    let room = world(vec![object(sphere(DVec3::ZERO, 1.0), &glowing_and(1.0, 0.5))]);
    let eye = camera(DVec3::new(0.3, 0.1, -0.2), X, 60.0);
    let of = |threads, calls_off, samples, error| {
        let size = [6, 5];
        let settings = ResolvedSettings {
            threads: Some(threads),
            error,
            size,
            crop: Crop::all(size),
            ..photons(samples, 3)
        };
        let view = View::new(&eye, size).expect("a camera that sees");
        let mut tracer = prepared(TracerKind::Photon, &room, &view, &settings);
        let film = Mutex::new(Film::new(size, settings.crop));
        let looks_on = Renewals { calls_off, cancel: AtomicBool::new(false), seen: AtomicUsize::new(0) };
        let watch = Watch { progress: &looks_on, cancel: &looks_on.cancel };
        render_renewing(&film, (&room, &view, &settings), &mut *tracer, watch);
        (film.into_inner().unwrap(), looks_on.seen.into_inner())
    };
    let (all, renewals) = of(1, false, 200, None);
    assert_eq!((renewals, all.report.taken.least, all.is_complete()), (1, 200, true));
    assert_eq!(all.pixels, of(3, false, 200, None).0.pixels);
    let (first, _) = of(1, false, 128, None);
    assert_ne!(all.pixels, first.pixels);
    assert_eq!(of(1, true, 200, None).0.pixels, first.pixels, "what was whole is kept");
    let (enough, renewals) = of(1, false, 4096, Some(0.5));
    assert_eq!((renewals, enough.report.taken.most, enough.is_complete()), (0, 32, true));
}

#[test]
fn photons_are_shot_on_as_many_threads_as_asked_for_and_no_more_once_called_off() {
    let (world, camera) = (under_glass(), camera(2.5 * X + 0.9 * Y, DVec3::ZERO, 40.0));
    for threads in [1, 3] {
        let settings = ResolvedSettings { threads: Some(threads), ..photons(4, 1) };
        let of = |most| {
            let Watcher { phases, told, .. } = watched(&settings, &world, &camera, most);
            (phases.into_inner().unwrap(), told.into_inner().unwrap())
        };
        let (phases, told) = of(usize::MAX);
        assert_eq!(phases, ["photons", "caustics"]);
        assert!(told.iter().all(|&(done, total, on)| 0 < done && done <= total && on == threads));
        assert_eq!(told.iter().filter(|(done, total, _)| done == total).count(), 2, "both to their end");
        assert_eq!(of(1), (vec!["photons"], told[..1].to_vec()));
        assert_eq!(of(3), (phases, told[..3].to_vec()));
    }
}

/// Two balls of glass behind one another as the lamps see them, a small one beside them, and a lamp.
fn three_balls(lamp: Node) -> World {
    let ball = |center, radius| object(sphere(center, radius), &glass(1.5));
    world(vec![ball(DVec3::ZERO, 1.0), ball(-2.0 * Y + 0.7 * X, 1.2), ball(3.0 * X, 0.25), lamp])
}

/// What a lamp sends to the first thing met, summed for each of the three, and by how many rays, of so many.
fn received(world: &World, aim: &Aim, n: u32) -> [(f64, f64); 3] {
    let lights = Lights::new(world);
    let mut sums = [(0.0, 0.0); 3];
    for path in 0..n {
        let mut sampler = Sampler::new(3, 0, 0, path);
        let (side, place, way) = (sampler.next_2d(), sampler.next_2d(), sampler.next_2d());
        let Ok(Some(emitted)) = lights.lights[0].emit(place, way, side.y, aim) else { continue };
        let Some(hit) = world.closest(&emitted.ray) else { continue };
        if let Some((sum, count)) = sums.get_mut(hit.primitive.shape as usize) {
            *sum += emitted.power.x / f64::from(n);
            *count += 1.0;
        }
    }
    sums
}

fn aimed(world: &World) -> Aim {
    let balls = world.balls_of(RayKind::Indirect, |material| {
        material.layers.as_ref().is_some_and(|l| !l.transmit.is(Rgb::ZERO))
    });
    Aim::At(Targets::new(balls.expect("all are bounded"), world.ball()))
}

#[test]
fn aimed_light_brings_each_thing_as_much_as_light_sent_everywhere() {
    let at = 3.5 * Y + X;
    let spot = |cone| LightSource::Spot {
        position: at,
        direction: (-0.2 * X - Y).normalize(),
        cone,
        intensity: Rgb::splat(5.0),
    };
    let lamps = [
        ("point", point(at, 5.0)),
        ("narrow spot", light(spot([5.0, 12.0]))),
        ("wide spot", light(spot([30.0, 80.0]))),
        ("sun", sun(0.2 * X - Y, 5.0)),
        ("sky", sky(5.0)),
        ("panel", area(rect(at, Z, 2.0 * X), 5.0, 1)),
        ("globe", area(sphere(at, 0.5), 5.0, 1)),
        ("near", point(1.6 * X, 5.0)),
    ];
    for (name, lamp) in lamps {
        let world = three_balls(lamp);
        let everywhere = received(&world, &Aim::Anything(world.ball()), 1 << 17);
        let aimed = received(&world, &aimed(&world), 1 << 16);
        for (i, ((sum, n), (truly, m))) in aimed.into_iter().zip(everywhere).enumerate() {
            if m == 0.0 {
                assert_eq!(n, 0.0, "{name}, {i}: nothing was sent there before");
                continue;
            }
            // Three deviations of both if they were independent; even points do better.
            let noise = 3.0 * truly * (1.0 / n + 1.0 / m).sqrt();
            assert!((sum - truly).abs() <= noise, "{name}, {i}: {sum}, {truly} by light sent everywhere");
            assert!(n > 0.49 * m, "{name}, {i}: {n} rays of half as many, {m} before");
        }
    }
}

#[test]
fn a_point_of_light_sends_by_the_solid_angle_that_a_ball_fills() {
    let world = world(vec![object(sphere(DVec3::ZERO, 0.01), &glass(1.5)), point(2.0 * Z, 3.0)]);
    let sine = 0.01 / 2.0f64;
    let exact = 3.0 * 2.0 * PI * (1.0 - (1.0 - sine * sine).sqrt());
    let n = 1 << 12;
    let found = received(&world, &aimed(&world), n)[0].0;
    assert!(
        (found - exact).abs() < 1e-6 * exact,
        "{found}, truly {exact}: every ray meets it and carries as much"
    );
}
