//! Tracers against one another: time and rays against error, over seeds, on scenes. Noise and bias are told apart: what the seeds disagree
//! in is variance, what their mean is off by is bias. Knows neither files nor how a scene is read; whoever asks renders.

pub mod page;
mod statistics;
mod tally;

use crate::scene::{Rgb, SamplerKind, TracerKind};
use serde::{Deserialize, Serialize};
use tally::Tally;

/// A tracer with a sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// How light is followed.
    pub tracer: TracerKind,
    /// Where the random numbers come from.
    pub sampler: SamplerKind,
}

/// What is measured of a scene.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Of these, the first is the one that others are compared with.
    pub variants: Vec<Variant>,
    /// Samples a pixel, rising.
    pub samples: Vec<u32>,
    /// Seeds 0 up to this, at least 2.
    pub seeds: u32,
}

/// A picture to be rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ask {
    /// How.
    pub variant: Variant,
    /// Samples a pixel.
    pub samples: u32,
    /// Of all random numbers.
    pub seed: u64,
}

/// A picture that was rendered.
#[derive(Clone, Debug)]
pub struct Made {
    /// Linear radiance.
    pub pixels: Vec<Rgb>,
    /// Time of the tracer: photons, records and rays.
    pub seconds: f64,
    /// Rays of all sorts.
    pub rays: u64,
}

/// What is taken for true.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Linear radiance, as many pixels as the pictures have.
    pub pixels: Vec<Rgb>,
    /// Its own root mean square error by its noise, 0 where it is not known.
    pub floor: f64,
    /// Where it comes from, in words.
    pub source: String,
}

/// One variant at one number of samples on one scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TracerRow {
    /// The scene's name.
    pub scene: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The tracer's word.
    pub tracer: String,
    /// The sampler's word.
    pub sampler: String,
    /// Samples a pixel.
    pub samples: u32,
    /// Pictures, each of a seed of its own.
    pub seeds: u32,
    /// Median seconds a picture.
    pub seconds: f64,
    /// Mean rays a picture.
    pub rays: f64,
    /// Root of the mean square error against the reference, over pixels, channels and seeds.
    pub rmse: f64,
    /// Mean of squared errors, each over the square of the reference and [`crate::render::compare::RELATIVE_FLOOR`].
    pub relative_mse: f64,
    /// What 999 of 1000 absolute errors are below.
    pub p999: f64,
    /// Mean variance of a picture's values over the seeds.
    pub variance: f64,
    /// Mean squared distance of the mean of all seeds from the reference, less what its noise and the reference's add to it. Below 0
    /// only by chance.
    pub bias2: f64,
    /// How much brighter the mean picture is than the reference, as a part of it; 0 where that is black.
    pub mean_off: f64,
    /// Half of the 95 % interval of that.
    pub mean_off_by: f64,
    /// Whether that is more than chance: at 1 % over all rows of the scene together (Šidák).
    pub biased: bool,
    /// The reference's own root mean square error.
    pub floor: f64,
    /// Where the reference comes from.
    pub reference: String,
}

impl TracerRow {
    /// What a picture is named by: "path, sobol".
    pub fn name(&self) -> String {
        format!("{}, {}", self.tracer, self.sampler)
    }

    /// Root mean square of what seeds disagree in.
    pub fn noise(&self) -> f64 {
        self.variance.sqrt()
    }
}

/// Renders every variant at every number of samples with every seed, in turn, so that a machine that slows down slows all of them, and
/// judges them. `tell` hears of each number of samples before it begins.
pub fn measure<E>(
    plan: &Plan,
    reference: &Reference,
    mut tell: impl FnMut(u32),
    mut render: impl FnMut(&Ask) -> Result<Made, E>,
) -> Result<Vec<TracerRow>, E> {
    let mut rows = Vec::new();
    for samples in &plan.samples {
        tell(*samples);
        let mut tallies = vec![Tally::new(&reference.pixels); plan.variants.len()];
        for seed in 0..u64::from(plan.seeds) {
            for (variant, tally) in plan.variants.iter().zip(&mut tallies) {
                tally.add(&render(&Ask { variant: *variant, samples: *samples, seed })?);
            }
        }
        let made = plan.variants.iter().zip(tallies);
        rows.extend(made.map(|(variant, tally)| row(*variant, *samples, tally, reference)));
    }
    let limit = statistics::sidak(0.01, rows.len());
    rows.iter_mut().for_each(|row| row.biased = is_biased(row, limit));
    Ok(rows)
}

fn row(variant: Variant, samples: u32, tally: Tally<'_>, reference: &Reference) -> TracerRow {
    let row = tally.figures(reference.floor);
    TracerRow {
        tracer: variant.tracer.word().into(),
        sampler: variant.sampler.word().into(),
        samples,
        floor: reference.floor,
        reference: reference.source.clone(),
        ..row
    }
}

/// Whether the mean picture is off by more than chance at a level of both sides.
fn is_biased(row: &TracerRow, level: f64) -> bool {
    let freedom = row.seeds.saturating_sub(1);
    let deviation = row.mean_off_by / statistics::student(0.05, freedom);
    row.mean_off.abs() > deviation * statistics::student(level, freedom)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    const PATH: Variant = Variant { tracer: TracerKind::Path, sampler: SamplerKind::Independent };
    const PHOTON: Variant = Variant { tracer: TracerKind::Photon, sampler: SamplerKind::Independent };

    /// A grey of 1 with even noise of variance 1/(12 n); photons add a tenth to every other pixel.
    fn noisy(ask: &Ask) -> Result<Made, ()> {
        let mut random = Random::new(ask.seed * 1000 + u64::from(ask.samples));
        let off = |i: u32| if ask.variant == PHOTON && i.is_multiple_of(2) { 0.1 } else { 0.0 };
        let mean = |random: &mut Random| {
            (0..ask.samples).map(|_| random.unit() + 0.5).sum::<f64>() / f64::from(ask.samples)
        };
        let pixels =
            (0..2000).map(|i| Rgb::new(mean(&mut random), mean(&mut random), mean(&mut random)) + off(i));
        Ok(Made { pixels: pixels.collect(), seconds: f64::from(ask.samples), rays: 7 })
    }

    #[test]
    fn noise_and_bias_are_told_apart() {
        let plan = Plan { variants: vec![PATH, PHOTON], samples: vec![1, 4, 16], seeds: 16 };
        let reference =
            Reference { pixels: vec![Rgb::ONE; 2000], floor: 0.0, source: "it is known".to_owned() };
        let rows = measure(&plan, &reference, |_| (), noisy).unwrap();
        assert_eq!(rows.len(), 6);
        for row in &rows {
            let variance = 1.0 / (12.0 * f64::from(row.samples));
            assert!((row.variance / variance - 1.0).abs() < 0.02, "{row:?}");
            let is_off = row.tracer == "photon";
            let bias2 = if is_off { 0.005 } else { 0.0 };
            assert!((row.bias2 - bias2).abs() < 0.02 * variance, "{row:?}");
            assert!((row.rmse * row.rmse / (variance + bias2) - 1.0).abs() < 0.02, "{row:?}");
            assert_eq!(row.biased, is_off, "{row:?}");
            assert!((row.mean_off - if is_off { 0.05 } else { 0.0 }).abs() < 0.003);
            assert_eq!((row.seconds, row.rays), (f64::from(row.samples), 7.0));
        }
    }
}
