//! Light that every tracer finds alike, whichever way it comes: from lamps that are there in part, hidden, without shadows or without a
//! shape that is asked; through water, frosted glass and rough metal.

use crate::stage::*;
use glam::DVec3;
use ogee::render::settings::{Crop, ResolvedSettings};
use ogee::scene::*;
use ogee::world::World;
use std::sync::Arc;

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;

/// Those that find indirect light.
const GLOBAL: [TracerKind; 4] =
    [TracerKind::Path, TracerKind::MonteCarlo, TracerKind::Irradiance, TracerKind::Photon];

/// Pictures of each tracer.
const SEEDS: u32 = 4;

/// The mean of pictures by a tracer, and its standard error.
fn by(tracer: TracerKind, world: &World, camera: &Camera, samples: u32) -> (f64, f64) {
    // As many photons as tell the rest.
    let samples = if tracer == TracerKind::Photon { samples.min(64) } else { samples };
    let of = |seed| {
        let settings = ResolvedSettings { tracer, samples, seed, depth: u32::MAX, ..settings([12, 12]) };
        picture(world, camera, &settings).mean().x
    };
    let means: Vec<f64> = (0..SEEDS).map(|seed| of(u64::from(seed))).collect();
    let n = f64::from(SEEDS);
    let mean = means.iter().sum::<f64>() / n;
    let squares: f64 = means.iter().map(|m| (m - mean) * (m - mean)).sum();
    (mean, (squares / (n * (n - 1.0))).sqrt())
}

/// Whether what a tracer found is the truth, within four standard errors, which must be small, and a share of it: photons and records are
/// blurred.
#[track_caller]
fn is_true(tracer: TracerKind, (mean, error): (f64, f64), (exact, uncertain): (f64, f64)) {
    let blur = match tracer {
        TracerKind::Irradiance | TracerKind::Photon => 0.01,
        _ => 0.001,
    };
    let noise = 4.0 * error.hypot(uncertain);
    assert!(noise < 0.1 * exact, "{tracer:?}: {mean} ± {error} tells nothing of {exact} ± {uncertain}");
    assert!(
        (mean - exact).abs() < noise + blur * exact,
        "{tracer:?}: {mean} ± {error}, not {exact} ± {uncertain}"
    );
}

/// A floor of albedo 1/2 at height 0 under some nodes, seen around the point below them.
fn on_a_floor(nodes: Vec<Node>) -> (World, Camera) {
    let floor = object(rect(DVec3::ZERO, 20.0 * X, -20.0 * Z), &diffuse(0.5));
    let eye = camera(DVec3::new(0.0, 0.5, 0.7), DVec3::ZERO, 0.2);
    (world(nodes.into_iter().chain([floor]).collect()), eye)
}

fn hidden(shape: Shape, material: &Arc<Material>, from: fn(&mut Hide)) -> Node {
    let mut object = Object::new(shape, SPAN);
    object.material = Some(Arc::clone(material));
    from(&mut object.hide);
    Node::Object(Arc::new(object))
}

/// A lamp of radius 1 at height 2 that faces the floor.
fn lamp() -> Shape {
    disc(2.0 * Y, -Y, 1.0)
}

/// What the floor sends on of a round lamp of radiance 1: the sine of what it fills, squared, is 1/5; half of it is sent on.
const OF_LAMP: f64 = 0.5 * 0.2;

fn see_through(radiance: f64, opacity: f64) -> Arc<Material> {
    layered(0.0, |l| (l.emit, l.opacity) = (Texture::number(radiance), Texture::number(opacity)))
}

#[test]
fn a_lamp_that_is_there_in_part_shines_in_part() {
    // Of a ball the far side is seen through the near one.
    let ball = |opacity: f64| (1.0 - (1.0 - opacity) * (1.0 - opacity)) * 0.5 * 0.25;
    let cases = [
        (lamp(), 0.5, 0.5 * OF_LAMP),
        (sphere(2.0 * Y, 1.0), 0.5, ball(0.5)),
        (sphere(2.0 * Y, 1.0), 0.2, ball(0.2)),
    ];
    for (shape, opacity, exact) in cases {
        let (world, eye) = on_a_floor(vec![object(shape, &see_through(8.0, opacity))]);
        for tracer in GLOBAL.into_iter().chain([TracerKind::Whitted]) {
            is_true(tracer, by(tracer, &world, &eye, 64), (8.0 * exact, 0.0));
        }
    }
}

#[test]
fn an_even_sky_without_shadows_shines_through_what_is_above_beside_other_lights_too() {
    let sky = || light_with(LightSource::Sky(Sky::Uniform(Rgb::ONE)), |l| l.shadow = false);
    let roof = || object(rect(3.0 * Y, 20.0 * X, 20.0 * Z), &diffuse(0.0));
    for other in [vec![], vec![point(Y, 1e-6)]] {
        let (world, eye) = on_a_floor([sky(), roof()].into_iter().chain(other).collect());
        for tracer in GLOBAL.into_iter().chain([TracerKind::Whitted]) {
            is_true(tracer, by(tracer, &world, &eye, 16), (0.5, 0.0));
        }
    }
}

#[test]
fn what_is_hidden_from_some_rays_neither_takes_light_away_nor_lets_it_by_twice() {
    let shining = || hidden(lamp(), &glowing(1.0), |hide| hide.reflection = true);
    let bare = || object(lamp(), &glowing(1.0));
    let between = |from| hidden(rect(Y, 20.0 * X, 20.0 * Z), &diffuse(0.0), from);
    let cases = [
        (vec![shining()], OF_LAMP),
        (vec![bare(), between(|hide| hide.shadow = true)], OF_LAMP),
        (vec![bare(), between(|hide| (hide.shadow, hide.reflection) = (true, true))], OF_LAMP),
    ];
    for (nodes, exact) in cases {
        let (world, eye) = on_a_floor(nodes);
        for tracer in GLOBAL.into_iter().chain([TracerKind::Whitted]) {
            is_true(tracer, by(tracer, &world, &eye, 64), (exact, 0.0));
        }
    }
    let (world, eye) = on_a_floor(vec![bare(), between(|hide| hide.reflection = true)]);
    for tracer in GLOBAL {
        assert_eq!(by(tracer, &world, &eye, 16).0, 0.0, "{tracer:?}: what casts a shadow casts all of it");
    }
}

#[test]
fn falloff_counts_the_whole_way_through_a_hole() {
    let fading = light_with(LightSource::Point { position: 2.0 * Y, intensity: Rgb::ONE }, |l| {
        l.falloff = Some([0.0, 1.0, 0.0]);
    });
    let veil = layered(0.0, |l| l.opacity = Texture::number(0.25));
    let above = object(rect(1.8 * Y, 20.0 * X, 20.0 * Z), &veil);
    // Walls all around send on what the floor does, so that photons have something to tell.
    let walls = object(cuboid(DVec3::new(-2.0, -0.5, -2.0), DVec3::new(2.0, 2.5, 2.0)), &diffuse(0.5));
    agree(&on_a_floor(vec![fading, above, walls]), 64, &[TracerKind::Irradiance, TracerKind::Photon]);
}

/// Whether tracers find what paths find.
#[track_caller]
fn agree((world, eye): &(World, Camera), samples: u32, tracers: &[TracerKind]) {
    let truly = by(TracerKind::Path, world, eye, 4 * samples);
    for &tracer in tracers {
        is_true(tracer, by(tracer, world, eye, samples), truly);
    }
}

/// A room of albedo 7/10, two units wide and high, seen from its middle.
fn room(nodes: Vec<Node>, look_at: DVec3) -> (World, Camera) {
    let walls = object(cuboid(DVec3::splat(-1.0), DVec3::ONE), &diffuse(0.7));
    let eye = camera(DVec3::new(0.1, 0.2, 0.3), look_at, 30.0);
    (world(nodes.into_iter().chain([walls]).collect()), eye)
}

#[test]
fn photons_tell_no_less_where_some_lamp_sends_none() {
    let ball = |height: f64, radius| object(sphere(height * Y, radius), &glowing(5.0));
    let children = Arc::from([ball(0.9, 0.5), ball(1.5, 0.3)]);
    let rest = Shape::Csg(Arc::new(Csg { op: CsgOp::Difference, inverse: false, children }));
    let nodes = vec![object(rest, &glowing(5.0)), point(DVec3::new(0.5, 0.5, 0.5), 0.05)];
    agree(&room(nodes, -Y), 128, &[TracerKind::MonteCarlo, TracerKind::Irradiance, TracerKind::Photon]);
}

#[test]
fn records_are_told_under_lobes_that_lead_below_their_surface() {
    let broad = layered(0.4, |l| {
        (l.specular, l.exponent, l.lobe) = (Texture::number(0.5), Texture::number(2.0), Lobe::Phong);
    });
    let nodes = vec![object(rect(-0.9 * Y, X, -Z), &broad), point(DVec3::new(0.5, 0.7, 0.5), 1.0)];
    agree(&room(nodes, DVec3::new(0.3, -0.9, -0.6)), 128, &[TracerKind::Irradiance]);
}

#[test]
fn light_off_rough_metal_is_counted_once() {
    let metal = layered(0.0, |l| (l.metal, l.roughness) = (Texture::number(0.9), Texture::number(0.6)));
    let nodes = vec![object(rect(0.99 * X, Y, Z), &metal), point(DVec3::new(0.0, 0.8, 0.0), 1.0)];
    agree(&room(nodes, DVec3::new(0.4, -1.0, 0.0)), 128, &[TracerKind::Irradiance, TracerKind::Photon]);
}

#[test]
fn what_lies_in_water_gets_the_light_that_it_gathers() {
    let water = cuboid(DVec3::new(-0.8, -0.8, -0.8), DVec3::new(0.8, -0.3, 0.8));
    let bed = cuboid(DVec3::new(-0.7, -0.7, -0.7), DVec3::new(0.7, -0.5, 0.7));
    let nodes =
        vec![object(water, &glass(1.333)), object(bed, &diffuse(0.7)), area(disc(0.95 * Y, -Y, 0.5), 4.0, 1)];
    agree(&room(nodes, -0.5 * Y), 256, &[TracerKind::Photon]);
}

#[test]
fn matt_glass_passes_its_light_on_whichever_side_it_comes_from() {
    let paper = layered(0.2, |l| {
        (l.transmit, l.ior) = (Texture::number(0.7), Texture::number(1.5));
        (l.roughness, l.fresnel) = (Texture::number(0.4), Fresnel::Exact);
    });
    let screen = object(cuboid(DVec3::new(-1.0, -1.0, -0.3), DVec3::new(1.0, 1.0, -0.2)), &paper);
    let lamp = area(disc(-0.95 * Z, Z, 0.9), 4.0, 1);
    agree(&room(vec![screen, lamp], DVec3::new(0.3, -1.0, 0.6)), 256, &[TracerKind::Photon]);
}

#[test]
fn a_mirror_rougher_than_nothing_by_a_trace_is_a_mirror_and_glass_that_does_not_bend_is_not_seen() {
    let rough = |change: fn(&mut Layers), roughness| {
        layered(0.0, |l| {
            change(l);
            l.roughness = Texture::number(roughness);
        })
    };
    let metal: fn(&mut Layers) = |l| l.metal = Texture::number(1.0);
    let clear: fn(&mut Layers) = |l| (l.transmit, l.ior) = (Texture::number(1.0), Texture::number(1.0));
    let traces = [1e-9, 1e-20, 1e-82, 1e-160, 1e-320];
    let cases = traces.map(|r| (metal, r)).into_iter().chain([0.1, 0.5, 1.0].map(|r| (clear, r)));
    for (change, roughness) in cases {
        let nodes = vec![object(sphere(DVec3::ZERO, 1.0), &rough(change, roughness)), sky(1.0)];
        let (world, eye) = (world(nodes), camera(4.0 * Z, DVec3::ZERO, 20.0));
        for tracer in GLOBAL.into_iter().chain([TracerKind::Whitted]) {
            let film = picture(&world, &eye, &ResolvedSettings { tracer, samples: 4, ..settings([8, 8]) });
            for pixel in &film.pixels {
                near(pixel.x, 1.0, 1e-9);
            }
        }
    }
}

/// A box with a red and a green wall, two blocks and a lamp, as in figures of global illumination.
fn cornell() -> (World, Camera) {
    let colour = |rgb| Arc::new(Material { diffuse: Texture::Constant(rgb), layers: None, span: SPAN });
    let white = colour(Rgb::splat(0.75));
    let wall = |n: DVec3, a: DVec3, material: &Arc<Material>| object(rect(-n, a, n.cross(a)), material);
    let block = |min, max| object(cuboid(min, max), &white);
    let nodes = vec![
        wall(Y, X, &white),
        wall(-Y, X, &white),
        wall(Z, X, &white),
        wall(X, Y, &colour(Rgb::new(0.65, 0.05, 0.05))),
        wall(-X, Y, &colour(Rgb::new(0.12, 0.45, 0.15))),
        block(DVec3::new(-0.7, -1.0, -0.6), DVec3::new(-0.1, 0.2, 0.0)),
        block(DVec3::new(0.1, -1.0, -0.1), DVec3::new(0.7, -0.4, 0.5)),
        area(rect(0.999 * Y, 0.25 * X, 0.25 * Z), 15.0, 16),
    ];
    (world(nodes), camera(3.8 * Z, DVec3::ZERO, 39.0))
}

#[test]
fn all_tracers_find_the_same_light_in_every_part_of_a_cornell_box() {
    let (world, eye) = cornell();
    let film = |tracer, samples, seed| {
        let settings = ResolvedSettings { tracer, samples, seed, depth: u32::MAX, ..settings([48, 48]) };
        picture(&world, &eye, &settings)
    };
    let parts = |film: &ogee::render::film::Film| -> Vec<Rgb> {
        let places = (0..36u32).map(|i| (i % 6 * 8, i / 6 * 8));
        let pixels =
            |(x, y): (u32, u32)| (0..64).map(move |i| film.pixel(x + i % 8, y + i / 8)).sum::<Rgb>() / 64.0;
        places.map(pixels).collect()
    };
    let truly = parts(&film(TracerKind::Path, 1024, 9));
    for (tracer, samples, most, least) in [
        (TracerKind::MonteCarlo, 256, 0.03, 0.002),
        (TracerKind::Irradiance, 64, 0.05, 0.01),
        (TracerKind::Photon, 64, 0.05, 0.01),
    ] {
        let found = parts(&film(tracer, samples, 1));
        for (i, (a, b)) in found.iter().zip(&truly).enumerate() {
            let off = ((*a - *b).abs() / (*b + 0.02)).max_element();
            assert!(off < most, "{tracer:?}, part {i}: {a} of {b}");
        }
        let [all, exact] = [&found, &truly].map(|parts| parts.iter().sum::<Rgb>().element_sum());
        assert!((all / exact - 1.0).abs() < least, "{tracer:?}: {} of it all", all / exact);
    }
}

#[test]
fn without_indirect_light_whitted_and_paths_agree_and_raycast_lacks_shadows_alone() {
    let lamps = || vec![point(DVec3::new(0.5, 1.0, 0.5), 2.0), sun(DVec3::new(0.3, -1.0, 0.2), 1.0)];
    let ball = object(sphere(0.5 * Y, 0.3), &diffuse(0.0));
    let with = |node: Option<Node>| on_a_floor(lamps().into_iter().chain(node).collect());
    let film = |(world, _): &(World, Camera), tracer| {
        let eye = camera(DVec3::new(0.0, 1.5, 2.0), DVec3::ZERO, 50.0);
        picture(world, &eye, &ResolvedSettings { tracer, depth: 2, samples: 1, ..settings([24, 24]) })
    };
    let (clear, shadowed) = (with(None), with(Some(ball)));
    let whitted = film(&clear, TracerKind::Whitted);
    assert_eq!(film(&clear, TracerKind::Raycast).pixels, whitted.pixels);
    let darker = film(&shadowed, TracerKind::Raycast)
        .pixels
        .into_iter()
        .zip(film(&shadowed, TracerKind::Whitted).pixels);
    let differ: Vec<(Rgb, Rgb)> = darker.filter(|(lit, shadowed)| lit != shadowed).collect();
    assert!(!differ.is_empty() && differ.iter().all(|(lit, shadowed)| shadowed.x < lit.x));
    for scene in [&clear, &shadowed] {
        let of = |tracer, samples| {
            let eye = camera(DVec3::new(0.0, 1.5, 2.0), DVec3::ZERO, 50.0);
            picture(&scene.0, &eye, &ResolvedSettings { tracer, depth: 2, samples, ..settings([24, 24]) })
                .mean()
                .x
        };
        near(of(TracerKind::Path, 256), of(TracerKind::Whitted, 256), 2e-3);
    }
}

#[test]
fn a_crop_has_the_pixels_of_the_whole_picture_by_every_tracer() {
    let (world, eye) = cornell();
    for tracer in GLOBAL.into_iter().chain([TracerKind::Whitted, TracerKind::Raycast]) {
        let whole = ResolvedSettings { tracer, samples: 4, ..settings([24, 20]) };
        let crop = Crop { x: 8, y: 6, width: 9, height: 7 };
        let of = |settings| picture(&world, &eye, &settings);
        let (whole, part) = (of(whole), of(ResolvedSettings { crop, ..whole }));
        for (x, y) in (0..7).flat_map(|y| (0..9).map(move |x| (x, y))) {
            assert_eq!(part.pixel(x, y), whole.pixel(x + 8, y + 6), "{tracer:?}");
        }
    }
}
