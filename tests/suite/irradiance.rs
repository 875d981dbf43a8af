//! Light by records of irradiance: closed forms within one in a hundred, no light where none can be, and agreement with paths.

use crate::stage::*;
use glam::DVec3;
use ogee::render::film::Film;
use ogee::render::sampler::Sampler;
use ogee::render::settings::ResolvedSettings;
use ogee::scene::assets::DiskLoader;
use ogee::scene::*;
use ogee::world::{Ray, RayKind, World, WorldOptions};

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;

fn by(tracer: TracerKind, size: [u32; 2], samples: u32) -> ResolvedSettings {
    ResolvedSettings { tracer, depth: u32::MAX, samples, threads: None, ..settings(size) }
}

fn records(size: [u32; 2], samples: u32) -> ResolvedSettings {
    by(TracerKind::Irradiance, size, samples)
}

/// The mean of a small picture about a point, and of the differences from that mean.
fn about(settings: &ResolvedSettings, world: &World, eye: DVec3, target: DVec3) -> (f64, f64) {
    let film = picture(world, &camera(eye, target, 6.0), settings);
    let mean = film.mean().x;
    let off: f64 = film.pixels.iter().map(|p| (p.x - mean).abs()).sum();
    (mean, off / film.pixels.len() as f64)
}

/// A small picture has few records, each with noise of its own: the mean is of many seeds.
fn agrees(world: &World, eye: DVec3, target: DVec3, exact: f64) {
    let seeds = 24;
    let of = |seed| about(&ResolvedSettings { seed, ..records([8, 8], 64) }, world, eye, target).0;
    let found = (0..seeds).map(of).sum::<f64>() / seeds as f64;
    assert!((found - exact).abs() < 0.01 * exact, "{found}, truly {exact}");
}

#[test]
fn closed_rooms_are_as_bright_as_their_series() {
    for (albedo, exact) in [(0.5, 2.0), (0.8, 5.0)] {
        let room = world(vec![object(sphere(DVec3::ZERO, 1.0), &glowing_and(1.0, albedo))]);
        let eye = DVec3::new(0.3, 0.1, -0.2);
        agrees(&room, eye, X, exact);
        let noise = |tracer| about(&by(tracer, [12, 12], 64), &room, eye, X).1;
        assert!(noise(TracerKind::Irradiance) < 0.5 * noise(TracerKind::Path), "there are records");
    }
}

#[test]
fn a_lamp_in_a_sphere_lights_all_of_it_anew() {
    a_lamp_in_a_sphere(agrees);
}

#[test]
fn spheres_in_one_another_light_each_other() {
    spheres_in_one_another(agrees);
}

#[test]
fn planes_that_face_each_other_have_the_light_of_their_series() {
    let world =
        world(vec![object(plane(Y, 0.0), &glowing_and(1.0, 0.5)), object(plane(Y, 1.0), &diffuse(0.7))]);
    let eye = 0.5 * Y;
    agrees(&world, eye, eye + DVec3::new(0.3, -0.5, 0.1), 1.0 / 0.65);
    agrees(&world, eye, eye + DVec3::new(0.3, 0.5, 0.1), 0.7 / 0.65);
}

#[test]
fn a_white_box_has_the_radiosity_of_its_form_factors() {
    for (albedo, floor, corner, wall, high) in
        [(0.5, 0.19760, 0.14840, 0.17765, 0.29235), (0.8, 0.71306, 0.61290, 0.68366, 0.87217)]
    {
        let (room, centre) = (white_box(albedo), DVec3::splat(0.5));
        agrees(&room, centre, DVec3::new(0.5, 0.0, 0.5), floor);
        agrees(&room, centre, DVec3::new(0.1, 0.0, 0.1), corner);
        agrees(&room, centre, DVec3::new(0.0, 0.5, 0.5), wall);
        agrees(&room, centre, DVec3::new(0.0, 0.9, 0.5), high);
    }
}

/// Two closed rooms beside each other with a wall of a thousandth between them, a lamp in the left one, seen from above by a camera
/// whose rays start in both.
fn two_rooms() -> (World, Camera) {
    let rooms = object(cuboid(DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 1.0, 1.0)), &diffuse(0.8));
    let wall = object(cuboid(DVec3::new(0.0, -1.0, -2.0), DVec3::new(1e-3, 2.0, 2.0)), &diffuse(0.8));
    let world = world(vec![rooms, wall, point(DVec3::new(-0.5, 0.5, 0.0), 1.0)]);
    let mut camera = camera(DVec3::new(0.0, 0.95, 0.0), DVec3::new(0.0, -0.05, 0.0), 90.0);
    camera.projection = Projection::Orthographic;
    (world, camera)
}

#[test]
fn nothing_leaks_through_a_wall_thinner_than_a_pixel() {
    let (world, camera) = two_rooms();
    let film = picture(&world, &camera, &records([40, 40], 4));
    for (x, y) in (0..40).flat_map(|y| (0..40).map(move |x| (x, y))) {
        let seen = film.pixel(x, y);
        // The wall begins at the middle; what stands in its column of pixels is lit from the left.
        match x {
            0..20 => assert!(seen.x > 0.1, "{seen} at ({x}, {y})"),
            20 => (),
            _ => assert_eq!(seen, Rgb::ZERO, "({x}, {y})"),
        }
    }
}

#[test]
fn what_is_painted_over_a_record_is_as_bright_as_its_paint() {
    let room = |albedo: f64| {
        world(vec![
            object(sphere(DVec3::ZERO, 4.0), &diffuse(0.5)),
            object(disc(DVec3::ZERO, Y, 0.5), &diffuse(albedo)),
            point(2.0 * Y, 10.0),
        ])
    };
    let light = |albedo| {
        about(&records([12, 12], 64), &room(albedo), DVec3::new(0.5, 1.0, 0.0), DVec3::ZERO).0 / albedo
    };
    let (bright, dark) = (light(0.8), light(0.2));
    // The small disc changes the room by less than one in a hundred.
    assert!((bright - dark).abs() < 0.01 * bright, "{bright} {dark}");
}

/// A room with all kinds of lobes in it.
fn furniture() -> Vec<Node> {
    let coated = layered(0.6, |l| {
        l.reflect = Texture::number(0.05);
        l.fresnel = Fresnel::Exact;
    });
    let shiny = layered(0.4, |l| {
        l.specular = Texture::number(0.3);
        l.exponent = Texture::number(30.0);
    });
    let brushed = layered(0.0, |l| {
        l.metal = Texture::number(0.8);
        l.roughness = Texture::number(0.3);
    });
    vec![
        object(cuboid(DVec3::new(-2.0, -1.0, -2.0), DVec3::new(2.0, 2.0, 4.0)), &diffuse(0.6)),
        object(rect(DVec3::new(0.0, -0.99, 0.0), 1.5 * X, -1.5 * Z), &coated),
        object(sphere(DVec3::new(-1.2, -0.4, -0.8), 0.5), &shiny),
        object(sphere(DVec3::new(0.0, -0.4, -0.5), 0.5), &glass(1.5)),
        object(sphere(DVec3::new(1.2, -0.4, -0.8), 0.5), &brushed),
        object(rect(DVec3::new(0.0, 0.8, -1.9), X, 0.5 * Y), &mirror(0.9)),
        area(disc(DVec3::new(0.0, 1.95, 0.5), -Y, 0.6), 6.0, 1),
        point(DVec3::new(1.5, 1.5, 3.0), 2.0),
    ]
}

fn into_the_room() -> Camera {
    camera(DVec3::new(0.0, 0.4, 3.6), DVec3::new(0.0, 0.0, -1.0), 50.0)
}

/// The ratio of the means of two pictures, in squares of so many pixels.
fn ratios(a: &Film, b: &Film, square: u32) -> Vec<f64> {
    let [width, height] = a.size.map(|n| n / square);
    let mean = |film: &Film, x: u32, y: u32| {
        let pixels = (0..square).flat_map(|j| (0..square).map(move |i| (x * square + i, y * square + j)));
        pixels.map(|(x, y)| film.pixel(x, y).element_sum()).sum::<f64>()
    };
    let squares = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    squares.map(|(x, y)| mean(a, x, y) / mean(b, x, y)).collect()
}

#[test]
fn records_and_paths_agree_among_gloss_mirrors_and_glass() {
    let (world, camera) = (world(furniture()), into_the_room());
    for depth in [u32::MAX, 4] {
        let of = |tracer, samples| {
            let settings = ResolvedSettings { depth, ..by(tracer, [48, 48], samples) };
            picture(&world, &camera, &settings)
        };
        let (found, truly) = (of(TracerKind::Irradiance, 64), of(TracerKind::Path, 512));
        let ratio = found.mean().x / truly.mean().x;
        assert!((ratio - 1.0).abs() < 0.01, "{ratio} at depth {depth}");
        for (i, ratio) in ratios(&found, &truly, 12).into_iter().enumerate() {
            assert!((ratio - 1.0).abs() < 0.05, "{ratio} in square {i} at depth {depth}");
        }
    }
}

#[test]
fn where_an_error_decides_records_are_made_for_it_and_not_for_the_most_samples() {
    let room = world(vec![object(sphere(DVec3::ZERO, 1.0), &glowing_and(1.0, 0.5))]);
    let eye = DVec3::new(0.3, 0.1, -0.2);
    // 25 samples of 16 rays: 400 err by a twentieth.
    let [decided, said] = [(Some(0.1), 4096), (None, 25)].map(|(error, samples)| {
        let tracer = tracer_from(&ResolvedSettings { error, ..records([12, 12], samples) }, &room, eye, X);
        let ray = Ray { origin: eye, direction: X, t_max: f64::INFINITY, kind: RayKind::Camera };
        tracer.radiance(&room, &ray, &room.find(&ray), &mut Sampler::new(1, 2, 3, 4))
    });
    assert_eq!(decided, said);
}

#[test]
fn records_leave_the_same_picture_on_any_number_of_threads_and_by_any_tree() {
    let of = |threads, accelerator| {
        let options = WorldOptions { accelerator, ..Default::default() };
        let (world, _) = World::new(furniture(), &options, &DiskLoader);
        let settings = ResolvedSettings { threads: Some(threads), ..records([32, 24], 4) };
        picture(&world, &into_the_room(), &settings).pixels
    };
    let one = of(1, Accelerator::Bvh);
    assert!([2, 3, 8].into_iter().all(|threads| of(threads, Accelerator::Bvh) == one));
    assert!([Accelerator::KdTree, Accelerator::None].into_iter().all(|tree| of(2, tree) == one));
}

#[test]
fn records_are_made_on_as_many_threads_as_asked_for_and_no_more_once_called_off() {
    let world = world(furniture());
    for threads in [1, 3] {
        let settings = ResolvedSettings { threads: Some(threads), ..records([32, 24], 4) };
        let of = |most| watched(&settings, &world, &into_the_room(), most).told.into_inner().unwrap();
        let told = of(usize::MAX);
        assert!(told.iter().all(|&(done, total, on)| done <= total && on == threads));
        assert!(
            told.iter().filter(|(done, total, _)| 5 * done < *total).count() > 1,
            "from the first turn on"
        );
        assert!(told.last().is_some_and(|(done, total, _)| done == total), "to the last");
        for most in [1, 2, told.len() - 1] {
            assert_eq!(of(most), told[..most]);
        }
    }
}
