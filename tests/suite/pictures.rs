//! Pictures as wholes: that they do not depend on what they must not depend on.

use crate::stage::*;
use glam::DVec3;
use ogee::diag::Span;
use ogee::geometry::mesh::Mesh;
use ogee::math::Affine;
use ogee::render::Tracer;
use ogee::render::camera::View;
use ogee::render::features::Layer;
use ogee::render::film::{Clamped, Film};
use ogee::render::passes::Passes;
use ogee::render::sampler::Sampler;
use ogee::render::settings::{Crop, ResolvedSettings};
use ogee::render::tiles::{Picture, Progress, render, render_in_tiles};
use ogee::scene::*;
use ogee::world::{Found, Ray, World};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A pyramid of four triangles with smooth normals, with every length times `s`.
fn pyramid(s: f64) -> Mesh {
    let positions: Vec<DVec3> =
        [(0.0, 0.7, 0.0), (0.5, 0.0, 0.4), (0.4, 0.0, -0.5), (-0.5, 0.0, -0.3), (-0.4, 0.0, 0.5)]
            .map(|(x, y, z)| DVec3::new(x, y, z) * s)
            .to_vec();
    let normals = positions.iter().map(|p| (*p / s + 0.3 * DVec3::Y).normalize()).collect();
    let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    Mesh { positions, normals, triangles, ..Mesh::default() }
}

/// A box with a flush hole and a bite.
fn bitten(s: f64) -> Shape {
    let v = |x, y, z| DVec3::new(x, y, z) * s;
    let hole = Cone { from: v(0.0, -0.3, 0.0), to: v(0.0, 0.3, 0.0), radii: [0.15 * s; 2] };
    let parts = [
        cuboid(v(-0.3, -0.3, -0.3), v(0.3, 0.3, 0.3)),
        Shape::Cone(Box::new(hole)),
        sphere(v(0.3, 0.3, 0.3), 0.2 * s),
    ];
    let children = parts.map(|part| object(part, &diffuse(0.6))).into();
    Shape::Csg(Arc::new(Csg { op: CsgOp::Difference, inverse: false, children }))
}

/// A bit of everything, with every length times `s`.
fn still_life(s: f64) -> Vec<Node> {
    let tinted = layered(0.0, |l| {
        (l.transmit, l.fresnel) = (Texture::number(0.9), Fresnel::Exact);
        l.absorb = Texture::Constant(Rgb::new(0.1, 0.7, 0.3) / s);
    });
    let shiny = layered(0.6, |l| {
        (l.specular, l.exponent) = (Texture::number(0.3), Texture::number(30.0));
        (l.reflect, l.fresnel) = (Texture::number(0.2), Fresnel::Schlick);
    });
    let v = |x, y, z| DVec3::new(x, y, z) * s;
    let checker = Pattern {
        kind: PatternKind::Checker(Texture::number(0.8), Texture::number(0.3)),
        transform: Some(Box::new(Affine::scale(DVec3::splat(0.5 * s)))),
        span: SPAN,
    };
    let floor = Arc::new(Material { diffuse: Texture::Pattern(Arc::new(checker)), layers: None, span: SPAN });
    let turned = Affine::scale(DVec3::new(1.0, 1.5, 0.7))
        .then(&Affine::rotate(DVec3::Y, 30.0))
        .then(&Affine::translate(v(1.2, 0.8, -0.5)));
    let spot = LightSource::Spot {
        position: v(-2.0, 4.0, 2.0),
        direction: DVec3::new(2.0, -3.5, -2.0).normalize(),
        cone: [15.0, 25.0],
        intensity: Rgb::splat(20.0) * s * s,
    };
    vec![
        object(plane(DVec3::Y, 0.0), &floor),
        object(sphere(v(0.0, 1.0, 0.0), s), &tinted),
        object(sphere(v(-1.7, 0.6, 0.4), 0.6 * s), &shiny),
        placed(bitten(s), &diffuse(0.6), Some(Affine::translate(v(-0.6, 0.3, 1.9)))),
        placed(cuboid(v(-0.4, -0.4, -0.4), v(0.4, 0.4, 0.4)), &diffuse(0.7), Some(turned)),
        object(
            Shape::Cone(Box::new(Cone {
                from: v(1.0, 0.0, 1.2),
                to: v(1.0, 0.7, 1.2),
                radii: [0.4 * s, 0.0],
            })),
            &diffuse(0.4),
        ),
        object(
            Shape::Torus(Box::new(Torus {
                center: v(0.6, 0.25, 2.0),
                axis: DVec3::new(0.0, 0.6, 0.8),
                radii: [0.3 * s, 0.1 * s],
            })),
            &shiny,
        ),
        object(
            Shape::Triangle(Box::new(Triangle {
                vertices: [v(-2.6, 0.1, 1.9), v(-1.4, 0.2, 2.1), v(-2.1, 1.1, 1.4)],
                normals: Some([DVec3::Z, DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, 0.6, 0.8)]),
                uvs: None,
            })),
            &shiny,
        ),
        placed(mesh(pyramid(s)), &diffuse(0.5), Some(Affine::translate(v(-0.6, 0.0, 2.2)))),
        placed(
            mesh(pyramid(s)),
            &tinted,
            Some(Affine::rotate(DVec3::Y, 40.0).then(&Affine::translate(v(2.0, 0.1, 1.6)))),
        ),
        point(v(3.0, 5.0, 3.0), 40.0 * s * s),
        light(spot),
        sun(DVec3::new(-0.3, -1.0, 0.2), 0.4),
        area(disc(v(-1.0, 3.0, -1.0), DVec3::new(0.3, -1.0, 0.3), 0.5 * s), 2.0, 4),
        sky_samples(0.2, 4),
    ]
}

fn still_camera(s: f64) -> Camera {
    let pinhole = camera(DVec3::new(0.0, 1.8, 5.0) * s, DVec3::new(0.0, 0.8, 0.0) * s, 45.0);
    Camera { aperture: 0.02 * s, focus: Some(4.5 * s), ..pinhole }
}

fn bits(film: &Film) -> Vec<[u64; 3]> {
    film.pixels.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

fn still(scale: f64, tracer: TracerKind) -> Film {
    let settings = ResolvedSettings { samples: 4, tracer, ..settings([48, 36]) };
    picture(&world(still_life(scale)), &still_camera(scale), &settings)
}

/// One tracer of each way to compute.
const TRACERS: [TracerKind; 5] = [
    TracerKind::Whitted,
    TracerKind::Path,
    TracerKind::MonteCarlo,
    TracerKind::Irradiance,
    TracerKind::Photon,
];

#[test]
fn a_scene_of_any_scale_gives_the_same_bits() {
    for tracer in TRACERS {
        let expected = still(1.0, tracer);
        assert!(expected.mean().x > 0.05 && expected.mean().is_finite());
        for power in [20, -20, 40, -40] {
            let scaled = still(ogee::math::elementary::powi(2.0, power), tracer);
            let differing = bits(&expected).iter().zip(&bits(&scaled)).filter(|(a, b)| a != b).count();
            assert_eq!(differing, 0, "{tracer:?}, 2^{power}");
        }
    }
}

/// The still life over a plain floor, in a group that is moved as a whole, and the camera with it. It is lifted off the floor, since two
/// surfaces in one place, and a seam of the floor's pattern seen through a ball as a lens, are decided by the last bits.
fn moved_still(by: DVec3) -> Film {
    let mut settings = settings([48, 36]);
    settings.samples = 4;
    let mut nodes = still_life(1.0);
    nodes[0] = object(plane(DVec3::Y, -0.01), &diffuse(0.5));
    let mut all = Object::new(Shape::Group(nodes.into()), SPAN);
    all.transform_by(&Affine::translate(by));
    let camera = still_camera(1.0);
    let camera = Camera { eye: camera.eye + by, look_at: camera.look_at + by, ..camera };
    picture(&world(vec![Node::Object(Arc::new(all))]), &camera, &settings)
}

#[test]
fn a_scene_far_from_the_origin_looks_as_it_does_there() {
    let expected = moved_still(DVec3::ZERO);
    for by in [DVec3::new(1e6, -1e6, 1e6), DVec3::new(1e7, 1e7, -1e7)] {
        let moved = moved_still(by);
        let squares: Vec<f64> =
            expected.pixels.iter().zip(&moved.pixels).map(|(a, b)| (*a - *b).length_squared()).collect();
        let rmse = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        let far_off = squares.iter().filter(|s| **s > 1e-8).count();
        assert!(rmse <= 1e-6, "{by}: {rmse:e}, {far_off} pixels by more than 1e-4");
    }
}

#[test]
fn normals_that_cancel_leave_a_surface_as_bright_as_it_is() {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    for n in [DVec3::X, DVec3::Z, DVec3::new(0.6, 0.0, 0.8)] {
        // Along the middle column the normals of the left and the right cancel to nothing.
        let quad = Mesh {
            positions: corners.to_vec(),
            normals: vec![n, -n, -n, n],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let triangle =
            Triangle { vertices: [corners[0], corners[1], corners[3]], normals: Some([n, -n, n]), uvs: None };
        for shape in [mesh(quad), Shape::Triangle(Box::new(triangle))] {
            let world = world(vec![object(shape, &diffuse(0.5)), sun(-DVec3::Z, std::f64::consts::PI)]);
            let mut camera = camera(3.0 * DVec3::Z, DVec3::ZERO, 36.0);
            camera.projection = Projection::Orthographic;
            let film = picture(&world, &camera, &settings([33, 33]));
            assert_eq!(film.report.non_finite, 0);
            let lowest = film.pixel(16, 31).x;
            assert!(lowest > 0.2, "{n}: {lowest} where they cancel");
            assert!(film.pixels.iter().all(|p| p.x >= 0.0 && p.x <= 0.5 + 1e-12), "{n}");
            assert!(film.pixels.iter().filter(|p| p.x > 0.2).count() > 400, "{n}: black on a lit side");
        }
    }
}

#[test]
fn threads_and_tiles_do_not_reach_a_pixel() {
    TRACERS.into_iter().for_each(depends_on_nothing_but_the_scene);
}

fn depends_on_nothing_but_the_scene(tracer: TracerKind) {
    let world = world(still_life(1.0));
    let mut settings = ResolvedSettings { samples: 4, tracer, ..settings([70, 50]) };
    let view = View::new(&still_camera(1.0), settings.size).unwrap();
    let tracer = prepared(tracer, &world, &view, &settings);
    let mut expected = None;
    for threads in [Some(1), Some(2), Some(3), Some(8), None] {
        for tile in [7, 16, 32] {
            settings.threads = threads;
            let picture = Picture { world: &world, view: &view, tracer: &*tracer, settings: &settings };
            let film = render_in_tiles(picture, tile, &(), &AtomicBool::new(false));
            assert!(film.is_complete());
            let found = (bits(&film), film.report.clone());
            assert_eq!(
                expected.get_or_insert_with(|| found.clone()),
                &found,
                "{threads:?} threads, tiles of {tile}"
            );
        }
    }
}

#[test]
fn passes_come_to_the_bits_of_as_many_samples_at_once() {
    for tracer in [TracerKind::Whitted, TracerKind::Path] {
        passes_come_to_the_same(tracer);
    }
}

fn passes_come_to_the_same(tracer: TracerKind) {
    let world = world(still_life(1.0));
    let most = ResolvedSettings { samples: u32::MAX, tracer, threads: Some(2), ..settings([40, 30]) };
    let view = View::new(&still_camera(1.0), most.size).unwrap();
    let made = prepared(tracer, &world, &view, &most);
    let cancel = AtomicBool::new(false);
    let whole = Picture { world: &world, view: &view, tracer: &*made, settings: &most };
    let mut passes = Passes::new(&most);
    for n in [2, 4, 6] {
        assert!(passes.advance(whole, n, &(), &cancel));
        let fixed = ResolvedSettings { samples: n, ..most };
        let (film, at_once) = (passes.film(), render(Picture { settings: &fixed, ..whole }, &(), &cancel));
        assert!(film.is_complete());
        assert_eq!(bits(&film), bits(&at_once), "{tracer:?}, {n} samples");
        assert_eq!(film.report, at_once.report);
    }
    cancel.store(true, Ordering::Relaxed);
    assert!(!passes.advance(whole, 8, &(), &cancel), "cancelled");
    assert_eq!(passes.film().share_finished(), 0.0, "none has eight samples");
}

#[test]
fn a_picture_by_its_error_depends_on_nothing_but_the_scene() {
    let world = world(still_life(1.0));
    let layers = Layer::ALL.into_iter().collect();
    let by_error = ResolvedSettings {
        samples: 256,
        error: Some(0.05),
        layers,
        tracer: TracerKind::Path,
        ..settings([40, 30])
    };
    let expected = picture(&world, &still_camera(1.0), &by_error);
    let taken = expected.report.taken;
    assert!(expected.is_complete() && taken.pixels == 1200);
    assert!(taken.least == 32 && taken.most == 256 && taken.enough > 300 && taken.enough < 1200, "{taken:?}");
    let threads = picture(&world, &still_camera(1.0), &ResolvedSettings { threads: Some(3), ..by_error });
    assert_eq!((bits(&threads), &threads.report), (bits(&expected), &expected.report));
    assert!(threads.features == expected.features && threads.sources == expected.sources);
    let crop = Crop { x: 11, y: 7, width: 17, height: 13 };
    let part = picture(&world, &still_camera(1.0), &ResolvedSettings { crop, ..by_error });
    for (x, y) in (0..13).flat_map(|y| (0..17).map(move |x| (x, y))) {
        assert_eq!(part.pixel(x, y), expected.pixel(x + 11, y + 7));
    }
}

#[test]
fn stopping_by_the_error_moves_the_mean_by_a_fraction_of_that_error() {
    let world = white_box(0.5);
    let eye = camera(DVec3::new(0.5, 0.5, 0.98), DVec3::new(0.5, 0.4, 0.0), 60.0);
    let base = ResolvedSettings { tracer: TracerKind::Path, samples: 1024, ..settings([32, 32]) };
    let fixed = picture(&world, &eye, &base).mean().x;
    for error in [0.05, 0.02] {
        let film =
            picture(&world, &eye, &ResolvedSettings { error: Some(error), samples: 4096, seed: 1, ..base });
        let (off, taken) = (film.mean().x / fixed - 1.0, film.report.taken);
        assert!(taken.enough == 1024 && taken.mean() < 1024.0, "{taken:?}");
        assert!(off.abs() < 0.3 * error, "{off} at {error}, {taken:?}");
    }
}

#[test]
fn layers_tell_what_the_rays_meet_and_leave_the_picture_as_it_is() {
    let ball = sphere(DVec3::ZERO, 1.0);
    let world = world(vec![object(ball, &diffuse(0.3)), sun(-DVec3::Z, 2.0)]);
    let eye = camera(4.0 * DVec3::Z, DVec3::ZERO, 40.0);
    let plain = ResolvedSettings { samples: 16, ..settings([33, 33]) };
    let layers = Layer::ALL.into_iter().collect();
    let (without, with) =
        (picture(&world, &eye, &plain), picture(&world, &eye, &ResolvedSettings { layers, ..plain }));
    assert!(without.features.is_empty());
    assert_eq!(bits(&without), bits(&with));
    let (middle, corner) = (with.features[16 * 33 + 16], with.features[0]);
    near(middle.depth, 3.0, 0.01);
    near(middle.albedo.y, 0.3, 1e-12);
    near(middle.normal.z, 1.0, 0.01);
    near(middle.position.z, 1.0, 0.01);
    assert_eq!((middle.source, corner.source, corner.albedo), (1, 0, Rgb::ZERO));
    assert!(corner.depth.is_infinite() && corner.variance == Rgb::ZERO);
    assert!(with.features.iter().any(|f| f.variance.x > 1e-4), "the outline varies");
}

#[test]
fn a_crop_is_the_same_part_of_the_whole() {
    let world = world(still_life(1.0));
    let mut settings = settings([40, 30]);
    settings.samples = 2;
    let whole = picture(&world, &still_camera(1.0), &settings);
    settings.crop = Crop { x: 11, y: 7, width: 17, height: 13 };
    let part = picture(&world, &still_camera(1.0), &settings);
    for (x, y) in (0..13).flat_map(|y| (0..17).map(move |x| (x, y))) {
        assert_eq!(part.pixel(x, y), whole.pixel(x + 11, y + 7));
    }
}

/// Shading normals as colours: a tracer that the library knows nothing of.
struct Normals;

impl Tracer for Normals {
    fn radiance(&self, world: &World, ray: &Ray, found: &Found, _: &mut Sampler) -> Rgb {
        world.hit(ray, found).map_or(Rgb::ZERO, |hit| (hit.normal + 1.0) / 2.0)
    }
}

#[test]
fn a_tracer_from_outside_renders() {
    let world = world(vec![object(sphere(DVec3::ZERO, 1.0), &diffuse(0.5))]);
    let film = picture_by(&Normals, &world, &camera(3.0 * DVec3::Z, DVec3::ZERO, 60.0), &settings([33, 33]));
    assert_eq!(film.pixel(16, 16), Rgb::new(0.5, 0.5, 1.0));
    assert_eq!(film.pixel(0, 0), Rgb::ZERO);
    assert!(film.pixel(16, 8).y > 0.7 && film.pixel(24, 16).x > 0.7, "y is up and x to the right");
}

#[test]
fn what_is_behind_the_camera_is_not_seen() {
    let ball = || object(sphere(5.0 * DVec3::Z, 1.0), &glowing(1.0));
    let sees = |look_at: DVec3| {
        picture(&world(vec![ball()]), &camera(DVec3::ZERO, look_at, 60.0), &settings([16, 16])).mean().x
    };
    assert_eq!(sees(-DVec3::Z), 0.0);
    assert!(sees(DVec3::Z) > 0.05);
}

#[test]
fn a_plane_mirror_shows_the_scene_mirrored() {
    let balls = |flip: f64| {
        vec![
            object(sphere(DVec3::new(0.5, flip, 0.2), 0.5), &diffuse(0.7)),
            object(sphere(DVec3::new(-0.6, 1.4 * flip, -0.4), 0.4), &diffuse(0.4)),
            sun(DVec3::new(0.4, -flip, -0.5), 3.0),
        ]
    };
    let mut mirrored = balls(1.0);
    mirrored.push(object(plane(DVec3::Y, 0.0), &mirror(1.0)));
    let (eye, target) = (DVec3::new(0.3, 2.0, 6.0), DVec3::new(0.0, -1.2, 0.0));
    let film = |nodes| picture(&world(nodes), &camera(eye, target, 20.0), &settings([64, 48]));
    let (by_mirror, behind) = (film(mirrored), film(balls(-1.0)));
    let lit = behind.pixels.iter().filter(|p| p.x > 0.0).count();
    assert!(lit > 200);
    // Shading agrees but for rounding; a pixel on an outline may fall to either side.
    let differing =
        by_mirror.pixels.iter().zip(&behind.pixels).filter(|(a, b)| (*a - *b).length() > 1e-9).count();
    assert!(differing <= 2, "{differing} pixels differ");
}

/// Not a number in one column.
struct Broken;

impl Tracer for Broken {
    fn radiance(&self, _: &World, ray: &Ray, _: &Found, _: &mut Sampler) -> Rgb {
        if (ray.direction.x / ray.direction.z).abs() < 0.05 { Rgb::splat(f64::NAN) } else { Rgb::ONE }
    }
}

#[test]
fn samples_that_are_not_finite_are_left_out_and_counted() {
    let world = world(vec![object(plane(-DVec3::Y, -1.0), &diffuse(0.5))]);
    let film = picture_by(&Broken, &world, &camera(DVec3::ZERO, -DVec3::Z, 90.0), &settings([31, 31]));
    assert!(film.pixels.iter().all(|p| p.is_finite()));
    assert_eq!(film.report.non_finite, 31);
    assert_eq!(film.report.first_non_finite.unwrap().pixel, [15, 0]);
}

#[test]
fn what_makes_a_sample_infinite_is_named_and_not_what_it_is_seen_in() {
    let at = |start| Span { start, ..SPAN };
    let object = |shape, material: Arc<Material>, start| {
        let mut object = Object::new(shape, at(start));
        object.material = Some(material);
        Node::Object(Arc::new(object))
    };
    let mirror = layered(0.0, |l| l.reflect = Texture::number(1.0));
    let ball = object(sphere(4.0 * DVec3::Z, 1.0), mirror, 1);
    let wall = object(plane(-DVec3::Z, 2.0), diffuse(1e300), 2);
    let world = world(vec![ball, wall, point(DVec3::ZERO, 1e200)]);
    for tracer in [TracerKind::Path, TracerKind::MonteCarlo, TracerKind::Whitted] {
        let settings = ResolvedSettings { tracer, samples: 2, ..settings([9, 9]) };
        let film = picture(&world, &camera(DVec3::ZERO, DVec3::Z, 10.0), &settings);
        let first = film.report.first_non_finite.expect("none is finite");
        assert_eq!((first.count, first.span), (162, Some(at(2))), "{tracer:?}");
    }
}

/// Cancels after the first tile.
struct Impatient<'a>(&'a AtomicBool, AtomicUsize);

impl Progress for Impatient<'_> {
    fn tiles(&self, done: usize, total: usize) {
        assert!(done <= total);
        self.1.fetch_max(done, Ordering::Relaxed);
        self.0.store(true, Ordering::Relaxed);
    }
}

#[test]
fn a_cancelled_picture_comes_back_as_far_as_it_is() {
    let world = world(still_life(1.0));
    let settings = settings([128, 128]);
    let view = View::new(&still_camera(1.0), settings.size).unwrap();
    let tracer = prepared(TracerKind::Whitted, &world, &view, &settings);
    let cancel = AtomicBool::new(false);
    let progress = Impatient(&cancel, AtomicUsize::new(0));
    let picture = Picture { world: &world, view: &view, tracer: &*tracer, settings: &settings };
    let film = render(picture, &progress, &cancel);
    assert!(!film.is_complete() && film.share_finished() > 0.0);
    let whole = render(picture, &(), &AtomicBool::new(false));
    for (i, done) in film.finished.iter().enumerate() {
        assert_eq!(film.pixels[i], if *done { whole.pixels[i] } else { Rgb::ZERO });
    }
}

#[test]
fn more_samples_come_nearer_to_the_picture() {
    let world = world(still_life(1.0));
    let at = |samples, seed| {
        let mut settings = settings([24, 18]);
        (settings.samples, settings.seed) = (samples, seed);
        picture(&world, &still_camera(1.0), &settings)
    };
    let truth = at(256, 99);
    let error = |film: &Film| {
        film.pixels.iter().zip(&truth.pixels).map(|(a, b)| (*a - *b).length_squared()).sum::<f64>().sqrt()
    };
    let (few, many) = (error(&at(2, 1)), error(&at(32, 1)));
    assert!(many < few / 3.0, "{few} {many}");
    assert_ne!(bits(&at(2, 1)), bits(&at(2, 2)), "the seed matters");
}

/// Radiance by column of a row of pixels across the edge of a white half, which lies between the fourth and the fifth.
fn across_an_edge(change: impl FnOnce(&mut ResolvedSettings)) -> (Vec<f64>, Film) {
    let half = rect(DVec3::new(-10.0, 0.0, 0.0), DVec3::X * 10.0, DVec3::Y * 10.0);
    let world = world(vec![object(half, &glowing(1.0))]);
    let mut settings = ResolvedSettings { tracer: TracerKind::Raycast, samples: 4096, ..settings([8, 8]) };
    change(&mut settings);
    let camera = Camera { projection: Projection::Orthographic, ..camera(DVec3::Z, DVec3::ZERO, 90.0) };
    let film = picture(&world, &camera, &settings);
    ((0..8).map(|x| film.pixel(x, 4).x).collect(), film)
}

#[test]
fn filters_blur_an_edge_as_they_weigh() {
    // What of each filter lies left of the edge: the areas under a tent, and the normal distribution at 1 and 3 deviations.
    let (tent, one, three) = (0.875, 0.841_345, 0.998_650);
    for (filter, wanted) in [
        (PixelFilter::Box, [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]),
        (PixelFilter::Tent, [1.0, 1.0, 1.0, tent, 1.0 - tent, 0.0, 0.0, 0.0]),
        (PixelFilter::Gaussian, [1.0, 1.0, three, one, 1.0 - one, 1.0 - three, 0.0, 0.0]),
    ] {
        let (found, _) = across_an_edge(|settings| settings.filter = filter);
        for (x, (found, wanted)) in found.iter().zip(wanted).enumerate() {
            assert!((found - wanted).abs() < 3e-3, "{filter:?}, column {x}: {found}, not {wanted}");
        }
    }
}

#[test]
fn a_clamp_dims_what_is_bright_and_tells_how_much() {
    let (as_it_is, film) = across_an_edge(|_| ());
    assert_eq!(
        (as_it_is[0], film.report.taken.clamped),
        (1.0, Clamped::default()),
        "nothing is clamped unasked"
    );
    let (dimmed, film) = across_an_edge(|settings| settings.clamp = Some(0.25));
    assert_eq!((dimmed[0], dimmed[7]), (0.25, 0.0));
    let clamped = film.report.taken.clamped;
    assert_eq!(clamped.samples, 32 * 4096);
    assert!((clamped.share() - 0.75).abs() < 1e-8, "{}", clamped.share());
}
