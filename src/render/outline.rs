//! Outlines of lamps: pixels in which something very bright ends. There a few samples that meet it or just miss it decide the whole
//! pixel, and of a room under a lamp they are nine tenths of the picture's squared error. Such pixels find what is seen to emit by many rays of their
//! own, which end where they meet something; what else they show is told by the samples, as everywhere.
//!
//! Which pixels these are is asked along a few rays that their samples know nothing of. So the choice adds no bias, and what falls between
//! these rays is only as noisy as if it had not been asked.

use super::camera::RIM;
use super::filter;
use super::pixel::corner;
use super::sampler::{PointSet, RayCounts, Sampler, rows};
use super::settings::ResolvedSettings;
use super::tiles::Picture;
use crate::math::elementary::exp2;
use crate::scene::{Rgb, Texture};
use crate::world::light::{Ball, Targets};
use crate::world::{Ray, RayKind, World};
use glam::DVec2;

/// Rays along which a pixel is asked whether an outline crosses it.
const PROBES: u32 = 16;

/// How many times as wide as a pixel these are spread: between the rays of a pixel alone an outline could slip through its corner.
const SPREAD: f64 = 1.5;

/// Rays of each sample for what is seen to emit, at the most: about as many as ten paths take, in one pixel of a thousand.
const RAYS: u32 = 64;

/// Radiance that is shown as white at an exposure of 0: an edge that differs by less is no worse than those of all that is lit.
const WHITE: f64 = 1.0;

/// Balls around all that a camera may see emit more than white. None of what has no bounds.
pub fn lamps(world: &World, settings: &ResolvedSettings) -> Vec<Ball> {
    let white = white(settings);
    let balls = world.balls_of(RayKind::Camera, |material| match &material.layers().emit {
        Texture::Constant(radiance) => radiance.max_element() > white,
        Texture::Pattern(_) => true,
    });
    Targets::new(balls.unwrap_or_default(), world.ball()).balls().to_vec()
}

fn white(settings: &ResolvedSettings) -> f64 {
    WHITE / exp2(settings.exposure)
}

/// How many rays of each sample find what a pixel is seen to emit: none where no outline of a lamp is seen in it, else as many as leave no more noise
/// than the edge of white paper has, up to [`RAYS`]; a power of two. The rays that ask are counted.
pub fn rays(picture: Picture<'_>, pixel: [u32; 2], counts: &mut RayCounts) -> u32 {
    if !may_show(picture, pixel, picture.tracer.lamps()) {
        return 0;
    }
    let [x, y] = pixel;
    let mut sampler = Sampler::new(picture.settings.seed, x, y | rows::OUTLINE, 0);
    let rays = Rays::of(picture, pixel, PROBES, &mut sampler);
    let probes = (0..PROBES).map(|i| rays.emission(i, SPREAD, &mut sampler).max_element());
    let [least, most] = probes.fold([f64::INFINITY, 0.0], |[least, most], x| [x.min(least), x.max(most)]);
    *counts += sampler.rays;
    let contrast = (most - least) / white(picture.settings);
    // Of n rays the variance is the nth part of that of one.
    if contrast > 1.0 { ((contrast * contrast) as u32).min(RAYS).next_power_of_two() } else { 0 }
}

fn may_show(picture: Picture<'_>, pixel: [u32; 2], lamps: &[Ball]) -> bool {
    let beam = if lamps.is_empty() { None } else { Beam::of(picture, pixel) };
    beam.is_some_and(|beam| lamps.iter().any(|ball| beam.may_meet(ball)))
}

/// What is seen to emit in a pixel, at the next sample.
pub fn emission(picture: Picture<'_>, pixel: [u32; 2], sampler: &mut Sampler) -> Rgb {
    let n = sampler.emission_rays;
    let rays = Rays::of(picture, pixel, n, sampler);
    (0..n).map(|i| rays.emission(i, 1.0, sampler)).sum::<Rgb>() / f64::from(n)
}

/// Rays of one sample through a pixel, and through the lens where there is one.
struct Rays<'a> {
    picture: Picture<'a>,
    centre: DVec2,
    n: u32,
    places: PointSet,
    lens: Option<PointSet>,
}

impl Rays<'_> {
    fn of<'a>(picture: Picture<'a>, pixel: [u32; 2], n: u32, sampler: &mut Sampler) -> Rays<'a> {
        let (centre, places) = (corner(pixel) + 0.5, sampler.next_set());
        Rays { picture, centre, n, places, lens: sampler.next_set_if(picture.view.has_lens()) }
    }

    /// What is seen to emit along one of them, where they are spread so many times as wide as the pixel's filter.
    fn emission(&self, i: u32, spread: f64, sampler: &mut Sampler) -> Rgb {
        let Picture { world, view, tracer, settings } = self.picture;
        let off = filter::place(settings.filter, self.places.point(i, self.n)) - 0.5;
        let lens = self.lens.map_or(DVec2::ZERO, |lens| lens.point(i, self.n));
        let ray = view.ray(self.centre + off * spread, lens);
        ray.map_or(Rgb::ZERO, |ray| tracer.emission(world, ray, sampler))
    }
}

/// The rays of a pixel: the middle one, and others as far from it as any, by their place in the pixel and by that on the lens.
struct Beam {
    middle: Ray,
    others: [Option<Ray>; 2],
}

impl Beam {
    fn of(picture: Picture<'_>, pixel: [u32; 2]) -> Option<Beam> {
        let (view, centre) = (picture.view, corner(pixel) + 0.5);
        let beside = view.ray(centre + SPREAD * filter::reach(picture.settings.filter), DVec2::ZERO);
        let rim = if view.has_lens() { view.ray(centre, RIM) } else { None };
        Some(Beam { middle: view.ray(centre, DVec2::ZERO)?, others: [beside, rim] })
    }

    /// Whether one of them comes to a ball, about.
    fn may_meet(&self, ball: &Ball) -> bool {
        let along = (ball.center - self.middle.origin).dot(self.middle.direction).max(0.0);
        let at = |ray: &Ray| ray.origin + ray.direction * along;
        let middle = at(&self.middle);
        let width: f64 = self.others.iter().flatten().map(|ray| at(ray).distance(middle)).sum();
        middle.distance(ball.center) <= ball.reach + width
    }
}
