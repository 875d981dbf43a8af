//! Russian roulette: how often a path goes on, learned before the picture from a few thousand paths.
//!
//! A path that carries the weight T goes on with the chance min(1, κT), and then counts for those that ended. Where it finds the
//! radiance L by R more rays, and a picture's samples have the variance V and take C rays each, noise times rays is least with
//! κ² = E[T·L²] / V · C / E[T·R] (Rath et al., *EARS: Efficiency-Aware Russian Roulette and Splitting*, 2022). There, space is cut into cells; here there is
//! one κ for each number of segments, after lobes with a width and after what is smooth.
//! So paths end early in a room that many bounces light, and hardly ever under an open sky, whose pictures have little noise to hide theirs in.

use super::{Path, Walk};
use crate::math::colour::mean;
use crate::render::camera::View;
use crate::render::pixel::{corner, ray_through, spread};
use crate::render::sampler::{Sampler, rows};
use crate::render::settings::ResolvedSettings;
use crate::render::tiles::{Watch, on_threads};
use crate::scene::Rgb;
use crate::world::World;
use glam::DVec2;
use rayon::prelude::*;

/// Numbers of segments that are told apart, from two on; the last stands for all that follow.
const LENGTHS: usize = 5;

/// A number for each kind of segment (see [`kind`]).
type Kinds = [f64; 2 * LENGTHS];

/// How often paths go on.
#[derive(Clone, Copy, Debug)]
pub struct Roulette {
    /// κ of each kind of segment.
    factors: Kinds,
}

/// Bounds on κ. What few paths never found may yet be there: what goes on counts for no more than half of what set out.
const FACTORS: [f64; 2] = [2.0, 16.0];

/// Pixels of a picture for each that is learned from: a sixteenth of the time of one sample a pixel.
const SPARSE: usize = 512;

/// From fewer there is nothing to learn, and pictures that small take no time.
const FEWEST: usize = 64;

/// Samples of a pixel, twice: what even samples differ by is known from two sets of them.
const SAMPLES: u32 = 16;

/// A path that loses nothing would go on for ever between perfect mirrors: after [`LONG`] segments one in 64 ends.
const MOST_SURVIVAL: f64 = 1.0 - 1.0 / 64.0;
const LONG: u32 = 256;

/// How often what carries so much goes on from a segment.
pub fn survival(carried: f64, segment: u32) -> f64 {
    carried.min(if segment < LONG { 1.0 } else { MOST_SURVIVAL })
}

impl Roulette {
    /// By the weight alone, from the fifth segment on.
    pub const PLAIN: Roulette = {
        const ALL: f64 = f64::INFINITY;
        Roulette { factors: [ALL, ALL, ALL, ALL, ALL, ALL, 1.0, 1.0, 1.0, 1.0] }
    };

    /// How often a path that carries so much goes on from its segment, from the second on. None where all do, whatever they carry.
    #[inline]
    pub fn survival(&self, carried: f64, segment: u32, is_smooth: bool) -> Option<f64> {
        let factor = self.factors[kind(segment, is_smooth)];
        (factor < f64::INFINITY).then(|| survival(carried * factor, segment))
    }

    /// What ends a picture's paths best. Neither threads nor a crop leave a trace in it. None where the work is called off.
    pub fn learned(
        world: &World,
        path: &Path,
        view: &View,
        settings: &ResolvedSettings,
        watch: Watch<'_>,
    ) -> Option<Roulette> {
        let lesson = Lesson { world, path, view, settings };
        let [width, height] = settings.size;
        let n = width as usize * height as usize / SPARSE;
        if n < FEWEST {
            return Some(Roulette::PLAIN);
        }
        let tally = |i| watch.go_on().map(|()| lesson.pixel(i));
        let tallies = on_threads(settings.threads, || {
            (0..n as u32).into_par_iter().map(tally).collect::<Option<Vec<Tally>>>()
        })?;
        Some(Roulette::of(&tallies))
    }

    /// By what came of some pixels. Errors count relative to brightness, so that the edge of a lamp does not hide the noise of all else.
    fn of(tallies: &[Tally]) -> Roulette {
        let mean = tallies.iter().map(|tally| tally.mean).sum::<f64>() / tallies.len() as f64;
        let mut all = Tally::default();
        for tally in tallies {
            let brightness = tally.mean + mean;
            all.add(tally, 1.0 / (brightness * brightness));
        }
        let factor = |i: usize| {
            let square = all.brought[i] / all.variance * (all.rays / all.took[i]);
            if square.is_nan() { FACTORS[0] } else { square.sqrt().clamp(FACTORS[0], FACTORS[1]) }
        };
        Roulette { factors: std::array::from_fn(factor) }
    }
}

/// Which kind a segment is of: by its number, from two on, and by whether it left what is smooth.
fn kind(segment: u32, is_smooth: bool) -> usize {
    let length = (segment.saturating_sub(2) as usize).min(LENGTHS - 1);
    2 * length + usize::from(is_smooth)
}

/// What came of the samples of a pixel, or of many.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Radiance, mean of the colours.
    mean: f64,
    /// Variance of a sample among even ones. A sum over samples, as all that follows.
    variance: f64,
    rays: f64,
    /// T·L².
    brought: Kinds,
    /// T·R.
    took: Kinds,
}

impl Tally {
    /// Adds another, whose squares count so much.
    fn add(&mut self, other: &Tally, weight: f64) {
        self.variance += weight * other.variance;
        self.rays += other.rays;
        for i in 0..self.took.len() {
            self.brought[i] += weight * other.brought[i];
            self.took[i] += other.took[i];
        }
    }

    /// Notes what a path brought and took in all, that had left a surface so. By its weight as it went on, and so whatever ended others there:
    /// those that went on count for them.
    fn note(&mut self, left: &Left, sum: Rgb, rays: u64) {
        if left.weight > 0.0 {
            self.brought[left.kind] += square(sum - left.sum) / left.weight;
            // The ray that has been counted is yet to be cast.
            self.took[left.kind] += left.weight * (rays - left.rays + 1) as f64;
        }
    }
}

/// What is learned from.
#[derive(Clone, Copy)]
struct Lesson<'a> {
    world: &'a World,
    path: &'a Path,
    view: &'a View,
    settings: &'a ResolvedSettings,
}

/// A path when it had just left a surface.
struct Left {
    kind: usize,
    weight: f64,
    sum: Rgb,
    rays: u64,
}

impl Lesson<'_> {
    /// What comes of one of the pixels, which a lattice spreads evenly over the picture (Roberts's R₂).
    fn pixel(&self, i: u32) -> Tally {
        let place = corner(spread(i, self.settings.size));
        let mut tally = Tally::default();
        let [one, other] = [0, 1].map(|set| {
            let samples = (0..SAMPLES).map(|sample| self.sample(place, [2 * i + set, sample], &mut tally));
            samples.sum::<Rgb>() / f64::from(SAMPLES)
        });
        let n = f64::from(SAMPLES);
        // Of the mean of n, half the square of the difference of two; of one, n times that; summed over 2 n.
        tally.variance = square(one - other) * n * n;
        tally.mean = mean(one + other) / 2.0;
        tally
    }

    /// The radiance of a sample of a pixel; what it tells is added. Nothing where it is not finite or a function was undefined, of which the picture tells.
    fn sample(&self, pixel: DVec2, [column, sample]: [u32; 2], tally: &mut Tally) -> Rgb {
        let settings = self.settings;
        let mut sampler =
            Sampler::new(settings.seed, column, rows::ROULETTE, sample).of_kind(settings.sampler, SAMPLES);
        let within = sampler.next_2d();
        let Some(ray) = ray_through(self.view, pixel + within, &mut sampler) else { return Rgb::ZERO };
        sampler.rays.camera += 1;
        let mut walk = Walk::from_camera(ray, &self.path.roulette, &mut sampler);
        let mut ways: Vec<Left> = Vec::new();
        loop {
            let before = walk.segment;
            match self.path.follow(self.world, &mut walk) {
                Err(_) => return Rgb::ZERO,
                Ok(false) => break,
                Ok(true) if walk.segment == before => {}
                Ok(true) => ways.push(Left::of(&walk)),
            }
        }
        let (sum, rays) = (walk.sum, walk.sampler.rays.total());
        if !sum.is_finite() {
            return Rgb::ZERO;
        }
        tally.rays += rays as f64;
        ways.iter().for_each(|left| tally.note(left, sum, rays));
        sum
    }
}

impl Left {
    fn of(walk: &Walk<'_>) -> Left {
        let kind = kind(walk.segment, walk.last.is_none());
        let (weight, rays) = (walk.weight.max_element(), walk.sampler.rays.total());
        Left { kind, weight, sum: walk.sum, rays }
    }
}

/// Mean of the colours' squares.
fn square(c: Rgb) -> f64 {
    mean(c * c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of paths that take so many rays before their second segment and after it, where that brings L with variance `beyond` beside `before`.
    fn tally(rays: [f64; 2], before: f64, beyond: f64) -> Tally {
        let mut tally =
            Tally { mean: 1.0, variance: before + beyond, rays: rays[0] + rays[1], ..Tally::default() };
        (tally.brought[0], tally.took[0]) = (beyond, rays[1]);
        tally
    }

    #[test]
    fn noise_times_rays_is_least() {
        let (rays, before, beyond) = ([30.0, 2.0], 1.0, 4.0);
        let factor = Roulette::of(&[tally(rays, before, beyond)]).factors[0];
        assert!((factor - (4.0 / 5.0 * 32.0 / 2.0f64).sqrt()).abs() < 1e-12, "{factor}");
    }

    #[test]
    fn paths_go_on_where_samples_are_so_even_that_ending_them_would_show() {
        let even = Tally { variance: 1e-9, ..tally([2.0, 8.0], 1.0, 4.0) };
        assert_eq!(Roulette::of(&[even; 2]).factors[0], FACTORS[1]);
    }

    #[test]
    fn what_was_never_found_is_ended_no_more_often_than_the_least_factor_says() {
        for tallies in [[Tally::default(); 2], [tally([2.0, 8.0], 1.0, 0.0); 2]] {
            assert_eq!(Roulette::of(&tallies).factors, [FACTORS[0]; 2 * LENGTHS]);
        }
    }

    #[test]
    fn the_plain_rule_begins_with_the_fifth_segment() {
        let often = |segment| Roulette::PLAIN.survival(0.5, segment, false);
        assert_eq!([2, 4, 5, 9].map(often), [None, None, Some(0.5), Some(0.5)]);
        assert_eq!(Roulette::PLAIN.survival(1.0, LONG, true), Some(MOST_SURVIVAL));
    }
}
