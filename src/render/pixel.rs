//! One pixel on the way: camera samples taken one after another, by number. What n samples come to does not depend on how often it was paused, nor on
//! who took them.

use super::adaptive::Blocks;
use super::camera::View;
use super::features::FeatureSum;
use super::film::{Fault, Film, PixelSum, Report, dimmed, reading_order};
use super::filter;
use super::outline::{self, Emission};
use super::sampler::{RayCounts, Sampler, Turn};
use super::settings::ResolvedSettings;
use super::tiles::Picture;
use crate::diag::Span;
use crate::scene::Rgb;
use crate::world::texture::TextureFault;
use crate::world::{Found, Ray};
use glam::DVec2;

/// A camera ray, and what it meets first.
type Sight<'s> = (&'s Ray, &'s Found);

/// The samples of a pixel so far.
#[derive(Clone, Debug)]
pub struct Pixel {
    /// Its place, and the next sample.
    turn: Turn,
    sum: PixelSum,
    /// True where its estimated error is as small as asked for.
    pub enough: bool,
    /// By which its error is estimated, where one is asked for.
    blocks: Option<Box<Blocks>>,
    /// How many rays of each sample find what is seen to emit, once that has been asked.
    emission_rays: Option<u32>,
    undefined: Option<TextureFault>,
    /// What is kept beside radiance, where something is.
    pub features: Option<Box<FeatureSum>>,
}

impl Pixel {
    /// A constant, so that it is written number by number: put together and copied as a whole it waits for its parts to come to memory.
    const BLANK: Pixel = Pixel {
        turn: Turn::new([0, 0], 0),
        sum: PixelSum::NOTHING,
        enough: false,
        blocks: None,
        emission_rays: None,
        undefined: None,
        features: None,
    };

    /// The pixel in a column and row of the whole picture, without a sample.
    #[inline]
    pub fn new(place: [u32; 2], settings: &ResolvedSettings) -> Pixel {
        let features = (!settings.kept().is_empty()).then(Box::default);
        let blocks = settings.error.map(|_| Box::default());
        Pixel { turn: Turn::new(place, 0), blocks, features, ..Pixel::BLANK }
    }

    /// Its column and row in the whole picture.
    #[inline]
    pub fn place(&self) -> [u32; 2] {
        self.turn.place()
    }

    /// How many samples were taken.
    #[inline]
    pub fn taken(&self) -> u32 {
        self.turn.sample()
    }

    /// True where it is to have the samples up to number `to`, and has neither them nor enough.
    #[inline]
    pub fn is_open(&self, to: u32) -> bool {
        self.taken() < to && !self.enough
    }

    /// Finds whether the error is small enough, with one sample more.
    fn weigh(&mut self, radiance: Rgb, settings: &ResolvedSettings) {
        let (Some(blocks), Some(target)) = (&mut self.blocks, settings.error) else { return };
        blocks.add(radiance);
        self.enough = blocks.error(settings.exposure).is_some_and(|error| error <= target);
    }

    /// Finds how many rays of each sample are to find what is seen to emit, once; those that ask are counted.
    #[inline]
    pub fn ask_for_outlines(&mut self, picture: Picture<'_>, counts: &mut RayCounts) {
        let place = self.place();
        self.emission_rays.get_or_insert_with(|| outline::rays(picture, place, counts));
    }

    /// The ray of the next sample, by its first numbers; none where the projection shows nothing.
    #[inline]
    pub fn ray(&mut self, picture: Picture<'_>, sampler: &mut Sampler) -> Option<Ray> {
        sampler.turn_to(self.turn);
        let ray = camera_ray(picture, self.place(), sampler);
        self.turn = sampler.turn();
        ray
    }

    /// Takes the next sample, by its ray and what that meets if it has one, and by the rest of its numbers. Finds whether the error is small enough then.
    #[inline]
    pub fn take(
        &mut self,
        picture: Picture<'_>,
        sight: Option<Sight<'_>>,
        sampler: &mut Sampler,
        report: &mut Report,
    ) {
        sampler.turn_to(self.turn);
        sampler.forget();
        sampler.emission_rays = self.emission_rays.unwrap_or(0);
        let sample = Sample::traced(picture, self.place(), sight, sampler);
        let radiance = match picture.settings.clamp {
            None => sample.radiance(),
            Some(most) => sample.clamped(most, report),
        };
        if !self.sum.add(radiance) {
            note_non_finite(picture, self.place(), sampler, report);
        }
        if let Some(features) = &mut self.features {
            features.add(picture.settings.kept(), picture.world, sampler.first, radiance);
        }
        if sampler.undefined.is_some() {
            self.undefined = self.undefined.or(sampler.undefined);
        }
        self.turn = sampler.turn().next();
        self.weigh(radiance, picture.settings);
    }

    /// The mean radiance; magenta, which is told, where a function was undefined.
    pub fn radiance(&self, report: &mut Report) -> Rgb {
        let Some(fault) = self.undefined else { return self.sum.mean() };
        let (span, kind) = (Some(fault.span), Some(fault.kind));
        report.add_undefined(Fault { pixel: self.place(), count: 1, span, kind });
        Film::UNDEFINED
    }
}

/// What rays for outlines find of a sample, where there are any, and what its own ray does.
struct Sample {
    emission: Option<Emission>,
    found: Rgb,
}

impl Sample {
    /// Finds both. The ray may be missing.
    #[inline(always)]
    fn traced(
        picture: Picture<'_>,
        place: [u32; 2],
        sight: Option<Sight<'_>>,
        sampler: &mut Sampler,
    ) -> Sample {
        let emission = outline::emission(picture, place, sampler);
        let Picture { world, tracer, .. } = picture;
        let found = sight.map_or(Rgb::ZERO, |(ray, found)| tracer.radiance(world, ray, found, sampler));
        Sample { emission, found }
    }

    #[inline(always)]
    fn radiance(&self) -> Rgb {
        match &self.emission {
            None => self.found,
            Some(emission) => emission.all + self.found,
        }
    }

    /// What a clamp leaves of it, which is noted.
    fn clamped(&self, most: f64, report: &mut Report) -> Rgb {
        let dimmed = dimmed(most, self.found);
        let left = self.emission.as_ref().map_or(dimmed, |emission| emission.left + dimmed);
        report.taken.clamped.note(self.radiance(), left);
        left
    }
}

/// The ray of a sample: through the pixel's centre for the only one, else through a point that its filter chooses.
#[inline(always)]
fn camera_ray(picture: Picture<'_>, pixel: [u32; 2], sampler: &mut Sampler) -> Option<Ray> {
    let within = match picture.settings.samples {
        1 => DVec2::splat(0.5),
        _ => filter::place(picture.settings.filter, sampler.next_2d()),
    };
    ray_through(picture.view, corner(pixel) + within, sampler)
}

/// Pixel number i of some that lie evenly over a picture (the lattice of the plastic number).
pub(super) fn spread(i: u32, size: [u32; 2]) -> [u32; 2] {
    const STEP: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
    let place = (STEP * f64::from(i) + 0.5).fract_gl() * DVec2::from(size.map(f64::from));
    [place.x as u32, place.y as u32]
}

/// The pixel's top left corner.
pub(super) fn corner([x, y]: [u32; 2]) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}

/// A ray through a place of the picture, from a place of the lens where there is one.
#[inline(always)]
pub(super) fn ray_through(view: &View, place: DVec2, sampler: &mut Sampler) -> Option<Ray> {
    let lens = if view.has_lens() { sampler.next_2d() } else { DVec2::ZERO };
    view.ray(place, lens)
}

/// Counts a sample that was not finite, and finds out whose fault the first was.
fn note_non_finite(picture: Picture<'_>, pixel: [u32; 2], sampler: &Sampler, report: &mut Report) {
    let known = report.first_non_finite;
    let is_first = known.is_none_or(|first| reading_order(pixel) < reading_order(first.pixel));
    let span = if is_first { culprit(picture, pixel, sampler) } else { None };
    let fault = Fault { pixel, count: 1, span, kind: None };
    report.merge(Report { non_finite: 1, first_non_finite: Some(fault), ..Report::default() });
}

/// Where in the scene what spoiled a sample was made, by tracing that again.
fn culprit(picture: Picture<'_>, pixel: [u32; 2], sampler: &Sampler) -> Option<Span> {
    let suspect = |emission_rays| {
        let mut again = sampler.accusing(emission_rays);
        let sight = camera_ray(picture, pixel, &mut again).map(|ray| (ray, picture.world.find(&ray)));
        Sample::traced(picture, pixel, sight.as_ref().map(|(ray, found)| (ray, found)), &mut again);
        again.suspect.found()
    };
    // What is seen to emit may have been found by other rays.
    let found = suspect(sampler.emission_rays).or_else(|| suspect(0))?;
    picture.world.provenance(found).map(|provenance| provenance.span)
}
