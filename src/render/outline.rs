//! Outlines of lamps: pixels in which something very bright ends. There a few samples that meet it or just miss it decide the whole
//! pixel, and of a room under a lamp they are nine tenths of the picture's squared error. Such pixels find what is seen to emit by many rays of their
//! own, which end where they meet something; what else they show is told by the samples, as everywhere.
//!
//! Which pixels these are is asked along a few rays that their samples know nothing of. So the choice adds no bias, and what falls between
//! these rays is only as noisy as if it had not been asked.
//!
//! There are fewer of these rays the more of the picture is outlines, and none where it is full of them: there other light is as much of its noise.

use super::camera::RIM;
use super::film::dimmed;
use super::filter;
use super::pixel::{corner, spread};
use super::sampler::{PointSet, RayCounts, Sampler, rows};
use super::settings::ResolvedSettings;
use super::tiles::{Picture, on_threads};
use crate::math::elementary::exp2;
use crate::scene::{Rgb, Texture};
use crate::world::light::{Ball, Targets};
use crate::world::packet::RAYS as RAYS_AT_ONCE;
use crate::world::{Ray, RayKind, World};
use glam::DVec2;
use rayon::prelude::*;

/// Rays along which a pixel is asked whether an outline crosses it.
const PROBES: u32 = 16;

/// How many times as wide as a pixel these are spread: between the rays of a pixel alone an outline could slip through its corner.
const SPREAD: f64 = 1.5;

/// Rays of each sample for what is seen to emit, at the most: about as many as ten paths take, in one pixel of a thousand.
const RAYS: u32 = 64;

/// Rays of a sample for what is seen to emit, on average over the picture, at the most.
const BUDGET: f64 = 2.0;

/// Pixels by which that average is told.
const PIXELS: u32 = 1 << 10;

/// Fewer rays of a sample are not worth their own.
const FEWEST: u32 = 4;

/// Radiance that differs by less at an exposure of 0 makes no edge that is worse than those of all that is lit: two stops more than white.
const BRIGHT: f64 = 4.0;

/// What a tracer tells apart where its outline is seen.
#[derive(Debug)]
pub struct Outlines {
    /// Around all bright things that a camera may see emit. None where some of that has no bounds.
    lamps: Vec<Ball>,
    /// Rays of a sample at the most; a power of two, or 0.
    most: u32,
}

/// Of a tracer that tells no emission apart.
pub static NONE: Outlines = Outlines { lamps: Vec::new(), most: 0 };

impl Outlines {
    /// Of what shines in a world, where there is no telling how much of a picture is outlines.
    pub fn new(world: &World, settings: &ResolvedSettings) -> Outlines {
        let bright = BRIGHT * white(settings);
        let balls = world.balls_of(RayKind::Camera, |material| match &material.layers().emit {
            Texture::Constant(radiance) => radiance.max_element() >= bright,
            Texture::Pattern(_) => true,
        });
        let lamps = Targets::new(balls.unwrap_or_default(), world.ball()).balls().to_vec();
        Outlines { lamps, most: RAYS }
    }

    /// With no more rays than a picture can bear, whose tracer tells these outlines, by some of its pixels. Crops leave no trace in it.
    pub fn within_budget(&self, picture: Picture<'_>) -> Outlines {
        let [width, height] = picture.settings.size;
        let n = PIXELS.min(width.saturating_mul(height));
        let wanted = |i| rays(picture, spread(i, picture.settings.size), &mut RayCounts::default());
        let wanted: Vec<u32> = match self.lamps.is_empty() || !may_be_asked(picture.settings) {
            true => Vec::new(),
            false => on_threads(picture.settings.threads, || (0..n).into_par_iter().map(wanted).collect()),
        };
        let mean = |most: u32| {
            let sum: u64 = wanted.iter().map(|rays| u64::from(*rays.min(&most))).sum();
            sum as f64 / f64::from(n)
        };
        let halves = std::iter::successors(Some(RAYS), |most| Some(most / 2));
        let most = halves.take_while(|most| *most >= FEWEST).find(|most| mean(*most) <= BUDGET);
        Outlines { lamps: self.lamps.clone(), most: most.unwrap_or(0) }
    }
}

/// The radiance that is shown as white.
fn white(settings: &ResolvedSettings) -> f64 {
    1.0 / exp2(settings.exposure)
}

/// Whether outlines count at all: not where the only sample of a pixel is to go through its centre.
pub fn may_be_asked(settings: &ResolvedSettings) -> bool {
    settings.samples != 1
}

/// How many rays of each sample find what a pixel is seen to emit: none where no outline of a lamp is seen in it; else as many as leave no more
/// noise than the edge of white paper has; a power of two. The rays that ask are counted.
pub fn rays(picture: Picture<'_>, pixel: [u32; 2], counts: &mut RayCounts) -> u32 {
    let Outlines { lamps, most } = picture.tracer.outlines();
    if *most == 0 || !may_show(picture, pixel, lamps) {
        return 0;
    }
    let [x, y] = pixel;
    let mut sampler = Sampler::new(picture.settings.seed, x, y | rows::OUTLINE, 0);
    let rays = Rays::of(picture, pixel, PROBES, &mut sampler);
    let [mut darkest, mut brightest] = [f64::INFINITY, 0.0f64];
    rays.each_emission(SPREAD, &mut sampler, |emitted| {
        let x = emitted.max_element();
        (darkest, brightest) = (x.min(darkest), x.max(brightest));
    });
    *counts += sampler.rays;
    let contrast = (brightest - darkest) / white(picture.settings);
    // Of n rays the variance is the nth part of that of one.
    if contrast >= BRIGHT { ((contrast * contrast) as u32).min(*most).next_power_of_two() } else { 0 }
}

fn may_show(picture: Picture<'_>, pixel: [u32; 2], lamps: &[Ball]) -> bool {
    let beam = if lamps.is_empty() { None } else { Beam::of(picture, pixel) };
    beam.is_some_and(|beam| lamps.iter().any(|ball| beam.may_meet(ball)))
}

/// What a pixel is seen to emit, and what is left of it where none of the rays may bring more than a clamp allows.
pub struct Emission {
    pub all: Rgb,
    pub left: Rgb,
}

impl Emission {
    const NOTHING: Emission = Emission { all: Rgb::ZERO, left: Rgb::ZERO };
}

/// What is seen to emit in a pixel, at the next sample, where rays of their own find it.
#[inline]
pub fn emission(picture: Picture<'_>, pixel: [u32; 2], sampler: &mut Sampler) -> Option<Emission> {
    match sampler.emission_rays {
        0 => None,
        n => Some(emission_by(n, picture, pixel, sampler)),
    }
}

/// The same by n rays, at least one.
#[inline(never)]
fn emission_by(n: u32, picture: Picture<'_>, pixel: [u32; 2], sampler: &mut Sampler) -> Emission {
    let mut found = Emission::NOTHING;
    let rays = Rays::of(picture, pixel, n, sampler);
    rays.each_emission(1.0, sampler, |emitted| {
        found.all += emitted;
        found.left += picture.settings.clamp.map_or(emitted, |most| dimmed(most, emitted));
    });
    let share = 1.0 / f64::from(n);
    Emission { all: found.all * share, left: found.left * share }
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

    /// What is seen to emit along each of them, where they are spread so many times as wide as the pixel's filter.
    fn each_emission(&self, spread: f64, sampler: &mut Sampler, mut tell: impl FnMut(Rgb)) {
        let Picture { world, tracer, .. } = self.picture;
        for first in (0..self.n).step_by(RAYS_AT_ONCE) {
            let ray = |i: u32| if i < self.n { self.ray(i, spread) } else { None };
            let rays = std::array::from_fn(|i| ray(first + i as u32));
            let mut emitted = [Rgb::ZERO; RAYS_AT_ONCE];
            world.find_each(&rays, |i, ray, found| emitted[i] = tracer.emission(world, ray, found, sampler));
            emitted.into_iter().take((self.n - first) as usize).for_each(&mut tell);
        }
    }

    fn ray(&self, i: u32, spread: f64) -> Option<Ray> {
        let Picture { view, settings, .. } = self.picture;
        let off = filter::place(settings.filter, self.places.point(i, self.n)) - 0.5;
        let lens = self.lens.map_or(DVec2::ZERO, |lens| lens.point(i, self.n));
        view.ray(self.centre + off * spread, lens)
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
