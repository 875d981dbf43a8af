//! Small scenes made in Rust, for tests of rays and light that need no text.

use glam::DVec3;
use ogee::diag::{SourceId, Span};
use ogee::geometry::mesh::Mesh;
use ogee::math::Affine;
use ogee::render::camera::View;
use ogee::render::film::Film;
use ogee::render::sampler::Sampler;
use ogee::render::settings::ResolvedSettings;
use ogee::render::tiles::{Picture, Progress, Watch, render};
use ogee::render::{Tracer, tracer};
use ogee::scene::assets::DiskLoader;
use ogee::scene::*;
use ogee::world::{Ray, RayKind, World, WorldOptions};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// Nowhere in particular.
pub const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };

/// A material with a grey diffuse base.
pub fn diffuse(albedo: f64) -> Arc<Material> {
    Arc::new(Material { diffuse: Texture::number(albedo), layers: None, span: SPAN })
}

/// A material with layers, over a grey base.
pub fn layered(albedo: f64, change: impl FnOnce(&mut Layers)) -> Arc<Material> {
    let mut layers = Layers::DEFAULT;
    change(&mut layers);
    Arc::new(Material { diffuse: Texture::number(albedo), layers: Some(Box::new(layers)), span: SPAN })
}

/// A material that only shines.
pub fn glowing(radiance: f64) -> Arc<Material> {
    layered(0.0, |l| l.emit = Texture::number(radiance))
}

/// A material that shines and has a grey base.
pub fn glowing_and(radiance: f64, albedo: f64) -> Arc<Material> {
    layered(albedo, |l| l.emit = Texture::number(radiance))
}

/// Clear glass.
pub fn glass(ior: f64) -> Arc<Material> {
    layered(0.0, |l| {
        l.transmit = Texture::number(1.0);
        l.ior = Texture::number(ior);
        l.fresnel = Fresnel::Exact;
    })
}

/// A mirror with a share.
pub fn mirror(share: f64) -> Arc<Material> {
    layered(0.0, |l| l.reflect = Texture::number(share))
}

pub fn object(shape: Shape, material: &Arc<Material>) -> Node {
    placed(shape, material, None)
}

pub fn placed(shape: Shape, material: &Arc<Material>, transform: Option<Affine>) -> Node {
    let mut object = Object::new(shape, SPAN);
    object.material = Some(Arc::clone(material));
    object.transform = transform.map(Box::new);
    Node::Object(Arc::new(object))
}

pub fn sphere(center: DVec3, radius: f64) -> Shape {
    Shape::Sphere { center, radius }
}

pub fn plane(normal: DVec3, offset: f64) -> Shape {
    Shape::Plane { normal, offset }
}

pub fn disc(center: DVec3, normal: DVec3, radius: f64) -> Shape {
    Shape::Disc(Box::new(Disc { center, normal: normal.normalize(), radius }))
}

pub fn rect(center: DVec3, a: DVec3, b: DVec3) -> Shape {
    Shape::Rect(Box::new(Rect { center, a, b }))
}

pub fn cuboid(min: DVec3, max: DVec3) -> Shape {
    Shape::Box(Box::new((min, max)))
}

pub fn mesh(mesh: Mesh) -> Shape {
    Shape::Mesh(Arc::new(MeshSource::Inline(mesh)))
}

pub fn light(source: LightSource) -> Node {
    light_with(source, |_| {})
}

pub fn light_with(source: LightSource, change: impl FnOnce(&mut Light)) -> Node {
    let mut light = Light { source, falloff: None, shadow: true, samples: 16, transform: None, span: SPAN };
    change(&mut light);
    Node::Light(Arc::new(light))
}

pub fn point(position: DVec3, intensity: f64) -> Node {
    light(LightSource::Point { position, intensity: Rgb::splat(intensity) })
}

pub fn sun(direction: DVec3, irradiance: f64) -> Node {
    light(LightSource::Sun { direction: direction.normalize(), irradiance: Rgb::splat(irradiance) })
}

pub fn sky(radiance: f64) -> Node {
    light(LightSource::Sky(Sky::Uniform(Rgb::splat(radiance))))
}

pub fn sky_samples(radiance: f64, samples: u32) -> Node {
    light_with(LightSource::Sky(Sky::Uniform(Rgb::splat(radiance))), |l| l.samples = samples)
}

pub fn area(shape: Shape, radiance: f64, samples: u32) -> Node {
    let object = Arc::new(Object::new(shape, SPAN));
    light_with(LightSource::Area { object, radiance: Rgb::splat(radiance) }, |l| l.samples = samples)
}

/// The world of some nodes, which must have nothing wrong with them.
pub fn world(nodes: Vec<Node>) -> World {
    let (world, diagnostics) = World::new(nodes, &WorldOptions::default(), &DiskLoader);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    world
}

/// A unit cube of six squares that reflect alike, its ceiling glowing.
pub fn white_box(albedo: f64) -> World {
    let (x, y, z, h) = (DVec3::X, DVec3::Y, DVec3::Z, 0.5);
    let inward = |n: DVec3, a: DVec3| rect(DVec3::splat(h) - n * h, a * h, n.cross(a) * h);
    let walls =
        [(x, y), (-x, y), (z, y), (-z, y), (y, x)].map(|(n, a)| object(inward(n, a), &diffuse(albedo)));
    let ceiling = object(inward(-y, x), &glowing_and(1.0, albedo));
    world(walls.into_iter().chain([ceiling]).collect())
}

/// Settings of a small picture, one sample a pixel, to be changed.
pub fn settings(size: [u32; 2]) -> ResolvedSettings {
    let none = RenderSettings::default();
    let asked = RenderSettings { size: Some(size), samples: Some(1), ..none.clone() };
    let mut settings = ResolvedSettings::new(&none, &asked);
    settings.threads = Some(1);
    settings
}

pub fn camera(eye: DVec3, look_at: DVec3, fov: f64) -> Camera {
    Camera {
        label: None,
        eye,
        look_at,
        up: DVec3::Y,
        fov,
        projection: Projection::Perspective,
        aperture: 0.0,
        focus: None,
        span: SPAN,
    }
}

/// A picture by the settings' own tracer.
pub fn picture(world: &World, camera: &Camera, settings: &ResolvedSettings) -> Film {
    let view = View::new(camera, settings.size).expect("a camera that sees");
    let tracer = prepared(settings.tracer, world, &view, settings);
    picture_by(&*tracer, world, camera, settings)
}

/// A picture by any tracer.
pub fn picture_by(tracer: &dyn Tracer, world: &World, camera: &Camera, settings: &ResolvedSettings) -> Film {
    let view = View::new(camera, settings.size).expect("a camera that sees");
    render(Picture { world, view: &view, tracer, settings }, &(), &AtomicBool::new(false))
}

/// The tracer of the settings for a camera that looks from one point to another.
pub fn tracer_from(
    settings: &ResolvedSettings,
    world: &World,
    origin: DVec3,
    toward: DVec3,
) -> Box<dyn Tracer> {
    let view = View::new(&camera(origin, toward, 40.0), settings.size).expect("a camera that sees");
    prepared(settings.tracer, world, &view, settings)
}

/// A tracer that nobody watches being made.
pub fn prepared(
    kind: TracerKind,
    world: &World,
    view: &View,
    settings: &ResolvedSettings,
) -> Box<dyn Tracer> {
    let watch = Watch { progress: &(), cancel: &AtomicBool::new(false) };
    tracer(kind, world, view, settings, watch).expect("nobody calls it off")
}

/// Who looks on, notes what is told, and calls the work off after so many tellings.
#[derive(Default)]
pub struct Watcher {
    pub most: usize,
    pub cancel: AtomicBool,
    /// Names of phases.
    pub phases: Mutex<Vec<&'static str>>,
    /// Parts done, of how many, on how many threads.
    pub told: Mutex<Vec<(usize, usize, usize)>>,
}

impl Progress for Watcher {
    fn phase(&self, name: &'static str) {
        self.phases.lock().unwrap().push(name);
    }

    fn tiles(&self, done: usize, total: usize) {
        let mut told = self.told.lock().unwrap();
        told.push((done, total, rayon::current_num_threads()));
        self.cancel.fetch_or(told.len() >= self.most, Ordering::Relaxed);
    }
}

/// What is told while a tracer is made that is called off after `most` tellings; it must be none then, and one otherwise.
pub fn watched(settings: &ResolvedSettings, world: &World, camera: &Camera, most: usize) -> Watcher {
    let view = View::new(camera, settings.size).expect("a camera that sees");
    let watcher = Watcher { most, ..Watcher::default() };
    let watch = Watch { progress: &watcher, cancel: &watcher.cancel };
    let made = tracer(settings.tracer, world, &view, settings, watch);
    assert_eq!(made.is_none(), watcher.cancel.load(Ordering::Relaxed));
    watcher
}

/// What whitted sees along one ray, the mean of some camera samples, and the sampler of the last.
pub fn seen_by(settings: &ResolvedSettings, world: &World, origin: DVec3, toward: DVec3) -> (Rgb, Sampler) {
    let tracer = tracer_from(settings, world, origin, toward);
    let ray =
        Ray { origin, direction: (toward - origin).normalize(), t_max: f64::INFINITY, kind: RayKind::Camera };
    let mut sum = Rgb::ZERO;
    let mut last = Sampler::new(0, 0, 0, 0);
    for sample in 0..settings.samples {
        last = Sampler::new(settings.seed, 0, 0, sample);
        sum += tracer.radiance(world, &ray, &world.find(&ray), &mut last);
    }
    (sum / f64::from(settings.samples), last)
}

/// The red of what whitted sees along one ray, to 64 segments.
pub fn seen(world: &World, origin: DVec3, toward: DVec3) -> f64 {
    let mut settings = settings([1, 1]);
    settings.depth = 64;
    seen_by(&settings, world, origin, toward).0.x
}

/// Fails unless `found` is within `tolerance` of `exact`.
#[track_caller]
pub fn near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() <= tolerance, "{found}, not {exact} ± {tolerance}");
}

/// Asks for the radiance of closed forms in spheres with a lamp inside: the world, from where, what is looked at, and how bright it is.
pub fn a_lamp_in_a_sphere(agrees: impl Fn(&World, DVec3, DVec3, f64)) {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let room = world(vec![object(sphere(DVec3::ZERO, 1.0), &diffuse(0.8)), point(0.5 * x, 1.0)]);
    for (p, exact) in [(x, 2.037183), (-x, 1.131768), (y, 1.200803)] {
        agrees(&room, DVec3::new(0.0, 0.0, 0.2), p, exact);
    }
    let centred = world(vec![object(sphere(DVec3::ZERO, 1.0), &diffuse(0.5)), point(DVec3::ZERO, 1.0)]);
    agrees(&centred, 0.2 * z, x, 1.0 / std::f64::consts::PI);
}

/// The same of a glowing sphere within a matt one.
pub fn spheres_in_one_another(agrees: impl Fn(&World, DVec3, DVec3, f64)) {
    let world = world(vec![
        object(sphere(DVec3::ZERO, 0.5), &glowing_and(1.0, 0.5)),
        object(sphere(DVec3::ZERO, 1.0), &diffuse(0.8)),
    ]);
    agrees(&world, 0.8 * DVec3::X, DVec3::ZERO, 4.0 / 3.0);
    agrees(&world, 0.8 * DVec3::X, DVec3::X, 2.0 / 3.0);
}
