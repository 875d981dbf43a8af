//! When a pixel has samples enough: its error estimated from blocks of its own samples. Knows nothing of other pixels, so that threads, tiles and
//! crops change nothing.
//!
//! Samples in order are cut into 16 blocks of one length 2ʲ, each of which is as even as the whole sequence lets it be; the spread of
//! their means is the error of even samples, where the spread of single samples would tell that of independent ones, which is larger. Who stops as soon as an estimate from the same samples is small
//! stops too early where they happened to be alike, and his mean is biased. Two things are done against it: [`LEAST`] samples
//! are taken in any case, and each half of the blocks must agree by itself.

use crate::math::colour::luminance;
use crate::math::elementary::exp2;
use crate::scene::Rgb;

/// Blocks that samples are cut into: enough to know a spread to a fifth.
const BLOCKS: usize = 16;

/// Samples that each pixel gets at least.
pub const LEAST: u32 = 32;

/// Samples that a pixel gets at most where nothing is said.
pub const MOST: u32 = 4096;

/// Luminance, after exposure, below which the error is measured against this and not against the pixel: about where sRGB is half as steep as
/// its black.
pub const FLOOR: f64 = 0.05;

/// Luminance of a pixel's samples, summed in blocks.
#[derive(Clone, Debug)]
pub struct Blocks {
    sums: [f64; BLOCKS],
    /// Samples of a full block.
    length: u32,
    taken: u32,
}

/// Without a sample.
impl Default for Blocks {
    fn default() -> Self {
        Blocks { sums: [0.0; BLOCKS], length: 1, taken: 0 }
    }
}

impl Blocks {
    /// Takes the next sample. One that is not finite is left out of the pixel, and counts as black here.
    pub fn add(&mut self, radiance: Rgb) {
        if self.taken == self.length * BLOCKS as u32 {
            self.merge();
        }
        let block = (self.taken / self.length) as usize;
        self.sums[block] += if radiance.is_finite() { luminance(radiance) } else { 0.0 };
        self.taken += 1;
    }

    /// Pairs of blocks become blocks.
    fn merge(&mut self) {
        let old = self.sums;
        self.sums = std::array::from_fn(|i| if 2 * i < BLOCKS { old[2 * i] + old[2 * i + 1] } else { 0.0 });
        self.length *= 2;
    }

    /// Standard error of the mean luminance over the mean, or over the floor where that is more. None but at [`LEAST`] samples and each doubling.
    pub fn error(&self, exposure: f64) -> Option<f64> {
        if self.taken < LEAST || self.taken != self.length * BLOCKS as u32 {
            return None;
        }
        let mean = self.sums.iter().sum::<f64>() / f64::from(self.taken);
        let floor = FLOOR / exp2(exposure);
        let (first, second) = self.sums.split_at(BLOCKS / 2);
        let error = self.by_half(first).max(self.by_half(second));
        Some(error / mean.abs().max(floor))
    }

    /// Standard error of the mean of all blocks, by the spread of these.
    fn by_half(&self, sums: &[f64]) -> f64 {
        let n = sums.len() as f64;
        let mean = sums.iter().sum::<f64>() / n;
        let squares: f64 = sums.iter().map(|s| (s - mean) * (s - mean)).sum();
        (squares / (n - 1.0) / BLOCKS as f64).sqrt() / f64::from(self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::sampler::Sampler;
    use crate::scene::SamplerKind;

    /// The error and the mean after n samples of f at pixel x.
    fn after(n: u32, kind: SamplerKind, x: u32, f: impl Fn(glam::DVec2) -> f64) -> (Option<f64>, f64) {
        let mut blocks = Blocks::default();
        let values: Vec<f64> =
            (0..n).map(|s| f(Sampler::new(5, x, 0, s).of_kind(kind, n).next_2d())).collect();
        values.iter().for_each(|v| blocks.add(Rgb::splat(*v)));
        (blocks.error(0.0), values.iter().sum::<f64>() / f64::from(n))
    }

    #[test]
    fn errors_are_known_at_powers_of_two_alone() {
        let known = |n| after(n, SamplerKind::Sobol, 0, |p| p.x).0.is_some();
        assert_eq!(
            [16, 31, 32, 33, 48, 64, 96, 128].map(known),
            [false, false, true, false, false, true, false, true]
        );
    }

    #[test]
    fn a_constant_has_no_error_and_black_none_either() {
        for value in [0.0, 0.75] {
            assert_eq!(after(32, SamplerKind::Sobol, 0, |_| value).0, Some(0.0));
        }
    }

    /// Root of the mean square of the estimates, and of the true errors, over many pixels; both relative to the mean ½.
    fn estimated_and_true(n: u32, kind: SamplerKind) -> (f64, f64) {
        let f = |p: glam::DVec2| if p.x + p.y < 1.0 { 1.0 } else { 0.0 };
        let (mut estimated, mut actual) = (0.0, 0.0);
        for x in 0..400 {
            let (error, mean) = after(n, kind, x, f);
            let error = error.expect("n is a power of two") * mean;
            estimated += error * error;
            actual += (mean - 0.5) * (mean - 0.5);
        }
        ((estimated / 400.0).sqrt(), (actual / 400.0).sqrt())
    }

    #[test]
    fn errors_are_not_told_too_small_nor_many_times_too_large() {
        for (kind, most) in [(SamplerKind::Independent, 1.6), (SamplerKind::Sobol, 6.0)] {
            let (estimated, actual) = estimated_and_true(256, kind);
            assert!((0.95..most).contains(&(estimated / actual)), "{kind:?}: {estimated} for {actual}");
        }
    }
}
