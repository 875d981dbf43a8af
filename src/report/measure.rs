//! Timing variants against one another: interleaved blocks in one run, medians and paired ratios. Absolute nanoseconds of a
//! busy machine mean little; ratios taken pair by pair survive.

use crate::math::hex::hex_list;
use std::hint::black_box;
use std::time::Instant;

/// A variant to be timed: runs once over all of its inputs and gives something that depends on every result.
pub struct Timed<'a> {
    /// Its name.
    pub name: &'a str,
    /// How many calls one run makes.
    pub calls: usize,
    /// The run.
    pub run: Box<dyn FnMut() -> f64 + 'a>,
}

/// What timing gives for one variant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Median nanoseconds per call.
    pub ns_median: f64,
    /// Median absolute deviation.
    pub ns_mad: f64,
    /// Time over the first variant's, pair by pair: the median.
    pub ratio: f64,
    /// 95 % bootstrap interval of that median.
    pub ratio_ci: [f64; 2],
}

/// Times the variants in turn, A B C A B C …, `blocks` times after one warm-up; each block lasts at least `block_ns`.
pub fn interleaved(variants: &mut [Timed<'_>], blocks: usize, block_ns: f64) -> Vec<Timing> {
    let repeats: Vec<usize> = variants.iter_mut().map(|v| repeats_for(v, block_ns)).collect();
    let mut ns: Vec<Vec<f64>> = vec![Vec::with_capacity(blocks); variants.len()];
    for _ in 0..blocks {
        for (i, variant) in variants.iter_mut().enumerate() {
            ns[i].push(block(variant, repeats[i]));
        }
    }
    ns.iter().map(|own| timing(own, &ns[0])).collect()
}

/// How often a variant must run for a block to last long enough.
fn repeats_for(variant: &mut Timed<'_>, block_ns: f64) -> usize {
    block(variant, 1);
    let once = block(variant, 1) * variant.calls as f64;
    ((block_ns / once.max(1.0)).ceil() as usize).clamp(1, 1 << 20)
}

/// Nanoseconds per call of one block.
fn block(variant: &mut Timed<'_>, repeats: usize) -> f64 {
    let start = Instant::now();
    for _ in 0..repeats {
        black_box((variant.run)());
    }
    start.elapsed().as_nanos() as f64 / (repeats * variant.calls.max(1)) as f64
}

/// Runs work so often, in a function of its own: a profiler that counts in this function alone counts nothing else.
#[inline(never)]
pub fn counted(work: &mut dyn FnMut() -> f64, repeats: usize) {
    for _ in 0..repeats {
        black_box(work());
    }
}

fn timing(own: &[f64], first: &[f64]) -> Timing {
    let ns_median = median(own);
    let deviations: Vec<f64> = own.iter().map(|x| (x - ns_median).abs()).collect();
    let ratios: Vec<f64> = own.iter().zip(first).map(|(a, b)| a / b).collect();
    Timing {
        ns_median,
        ns_mad: median(&deviations),
        ratio: median(&ratios),
        ratio_ci: bootstrap_median(&ratios),
    }
}

/// The middle number; the mean of the two middle ones of an even count; NaN of none.
pub fn median(numbers: &[f64]) -> f64 {
    quantile(numbers, 0.5)
}

/// The quantile `q` of 0 … 1, linear between neighbours; NaN of none.
pub fn quantile(numbers: &[f64], q: f64) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = q * last as f64;
    let (i, part) = (at.floor() as usize, at.fract());
    sorted[i] + (sorted[(i + 1).min(last)] - sorted[i]) * part
}

/// 95 % interval of the median by 1,000 seeded resamplings.
fn bootstrap_median(numbers: &[f64]) -> [f64; 2] {
    let mut state = 0x2545_f491_4f6c_dd1du64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize
    };
    let medians: Vec<f64> = (0..1000)
        .map(|_| median(&(0..numbers.len()).map(|_| numbers[draw() % numbers.len()]).collect::<Vec<_>>()))
        .collect();
    [quantile(&medians, 0.025), quantile(&medians, 0.975)]
}

/// Errors as they come in, with the input of the largest.
#[derive(Clone, Debug, Default)]
pub struct Errors {
    all: Vec<f64>,
    worst: Option<(f64, String)>,
    /// Answers that were NaN or infinite; they are not among the magnitudes.
    pub not_finite: usize,
}

impl Errors {
    /// Takes an error; the input is written down only where it is the largest yet.
    pub fn push(&mut self, error: f64, input: &[f64]) {
        if !error.is_finite() {
            self.not_finite += 1;
            return;
        }
        if self.worst.as_ref().is_none_or(|(e, _)| error > *e) {
            self.worst = Some((error, hex_list(input)));
        }
        self.all.push(error);
    }

    /// Largest, 99th percentile and mean; 0 of none.
    pub fn summary(&self) -> [f64; 3] {
        let n = self.all.len().max(1) as f64;
        let max = self.worst.as_ref().map_or(0.0, |(e, _)| *e);
        let p99 = if self.all.is_empty() { 0.0 } else { quantile(&self.all, 0.99) };
        [max, p99, self.all.iter().sum::<f64>() / n]
    }

    /// The input of the largest error.
    pub fn worst_input(&self) -> &str {
        self.worst.as_ref().map_or("", |(_, input)| input)
    }

    /// How many finite errors came in.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// True where none came in.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_neighbours() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0]), 2.5);
        assert_eq!(quantile(&[0.0, 10.0], 0.25), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn a_variant_against_itself_has_a_ratio_near_one() {
        let work = || (0..2000).fold(0.0, |s, i| s + f64::from(i).sqrt());
        let mut both = [
            Timed { name: "a", calls: 1, run: Box::new(work) },
            Timed { name: "b", calls: 1, run: Box::new(work) },
        ];
        let timings = interleaved(&mut both, 5, 1e4);
        assert_eq!(timings[0].ratio, 1.0);
        assert!(timings[1].ratio > 0.0 && timings[1].ratio_ci[0] <= timings[1].ratio_ci[1]);
    }

    #[test]
    fn the_worst_input_is_kept_and_nan_is_counted_apart() {
        let mut errors = Errors::default();
        errors.push(1.0, &[0.25]);
        errors.push(f64::NAN, &[f64::NAN]);
        errors.push(3.0, &[0.5]);
        let worst = hex_list(&[0.5]);
        assert_eq!((errors.summary()[0], errors.worst_input(), errors.not_finite), (3.0, &*worst, 1));
    }
}
