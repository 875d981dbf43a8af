//! What a picture is while it is made: linear RGB radiance per pixel in f64, and what went wrong. Knows neither files nor
//! tracers. A pixel's samples are summed by one thread in the order of their numbers, so that its bits depend on nothing else.

use super::features::{Features, Layers, Source};
use super::sampler::RayCounts;
use super::settings::Crop;
use crate::diag::Span;
use crate::math::colour::luminance;
use crate::math::field::FaultKind;
use crate::scene::Rgb;

/// A picture of linear radiance, whole or in part.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width and height of the whole picture.
    pub size: [u32; 2],
    /// The part that this film holds.
    pub crop: Crop,
    /// Mean radiance, row by row from the top; black where not finished.
    pub pixels: Vec<Rgb>,
    /// What is kept of each pixel beside radiance; empty where nothing is asked for.
    pub features: Vec<Features>,
    /// The objects whose numbers are in `features`, from 1.
    pub sources: Vec<Source>,
    /// Which features are to be layers of a file.
    pub layers: Layers,
    /// Which pixels are finished; all of them unless the rendering was cancelled.
    pub finished: Vec<bool>,
    /// True once noise has been filtered out of it.
    pub denoised: bool,
    /// What happened on the way.
    pub report: Report,
}

/// What happened while a picture was made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Rays cast.
    pub rays: RayCounts,
    /// Samples of the finished pixels.
    pub taken: Taken,
    /// Camera samples that were not finite and were left out.
    pub non_finite: u64,
    /// The first pixel with such a sample, in reading order.
    pub first_non_finite: Option<Fault>,
    /// Functions of the scene that were undefined, each with its count of pixels and its first pixel; sorted by place.
    pub undefined: Vec<Fault>,
}

/// How many samples pixels took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taken {
    /// How many pixels.
    pub pixels: u64,
    /// Samples of all of them.
    pub total: u64,
    /// Fewest of a pixel.
    pub least: u32,
    /// Most of a pixel.
    pub most: u32,
    /// How many pixels had a small enough error; none where no error was asked for.
    pub enough: u64,
    /// What dimming the brightest took; nothing where it was not asked for.
    pub clamped: Clamped,
}

/// Radiance with no colour above `most`, dimmed as a whole so that its hue stays; not what is not finite.
pub fn dimmed(most: f64, radiance: Rgb) -> Rgb {
    let brightest = radiance.max_element();
    if radiance.is_finite() && brightest > most { radiance * (most / brightest) } else { radiance }
}

/// What was taken from samples that were brighter than asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clamped {
    /// How many samples.
    pub samples: u64,
    /// Luminance of all samples as they were traced, and what was taken of it, in 2⁻³²: whole numbers, whose sum is the same in any
    /// order.
    all: u128,
    taken: u128,
}

impl Clamped {
    /// Notes what was left of a sample. One that is not finite is left to whoever counts those.
    pub fn note(&mut self, traced: Rgb, left: Rgb) {
        if !traced.is_finite() {
            return;
        }
        let light = luminance(traced);
        self.all += in_parts(light);
        if left != traced {
            self.samples += 1;
            self.taken += in_parts(light - luminance(left));
        }
    }

    /// The share of all light that was taken, 0 … 1.
    pub fn share(self) -> f64 {
        self.taken as f64 / self.all.max(1) as f64
    }

    fn with(self, other: Clamped) -> Clamped {
        Clamped {
            samples: self.samples + other.samples,
            all: self.all + other.all,
            taken: self.taken + other.taken,
        }
    }
}

/// Light in whole numbers of 2⁻³²; 2⁹⁶ at most, of which 2³² samples do not overflow a sum.
fn in_parts(light: f64) -> u128 {
    const MOST: f64 = (1u128 << 96) as f64;
    (light * (1u64 << 32) as f64).min(MOST) as u128
}

impl Taken {
    /// Counts a pixel with so many samples.
    pub fn add(&mut self, samples: u32, enough: bool) {
        self.least = if self.pixels == 0 { samples } else { self.least.min(samples) };
        self.most = self.most.max(samples);
        self.pixels += 1;
        self.total += u64::from(samples);
        self.enough += u64::from(enough);
    }

    /// Takes the pixels of another part.
    pub fn merge(&mut self, other: Taken) {
        let least = match (self.pixels, other.pixels) {
            (0, _) => other.least,
            (_, 0) => self.least,
            _ => self.least.min(other.least),
        };
        *self = Taken {
            pixels: self.pixels + other.pixels,
            total: self.total + other.total,
            least,
            most: self.most.max(other.most),
            enough: self.enough + other.enough,
            clamped: self.clamped.with(other.clamped),
        };
    }

    /// Samples a pixel; 0 without pixels.
    pub fn mean(self) -> f64 {
        self.total as f64 / self.pixels.max(1) as f64
    }
}

/// Something that went wrong at pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Column and row of the first pixel, in reading order.
    pub pixel: [u32; 2],
    /// How many pixels.
    pub count: u64,
    /// The place in the scene, where one is known: the function, or the object seen at the pixel.
    pub span: Option<Span>,
    /// Why a function was undefined; none for samples that were not finite.
    pub kind: Option<FaultKind>,
}

impl Report {
    /// Takes another part's report. The order of the parts does not matter.
    pub fn merge(&mut self, other: Report) {
        self.rays += other.rays;
        self.taken.merge(other.taken);
        self.non_finite += other.non_finite;
        self.first_non_finite = match (self.first_non_finite, other.first_non_finite) {
            (Some(a), Some(b)) => Some(a.with(b)),
            (a, b) => a.or(b),
        };
        other.undefined.into_iter().for_each(|fault| self.add_undefined(fault));
    }

    /// Counts a pixel, or several, where a function was undefined.
    pub fn add_undefined(&mut self, fault: Fault) {
        match self.undefined.binary_search_by_key(&place(fault.span), |f| place(f.span)) {
            Ok(i) => self.undefined[i] = self.undefined[i].with(fault),
            Err(i) => self.undefined.insert(i, fault),
        }
    }
}

/// What pixels are sorted by.
pub(super) fn reading_order([x, y]: [u32; 2]) -> (u32, u32) {
    (y, x)
}

impl Fault {
    /// Both as one: counts added, the first pixel in reading order.
    fn with(self, other: Fault) -> Fault {
        let first = if reading_order(other.pixel) < reading_order(self.pixel) { other } else { self };
        Fault { count: self.count + other.count, ..first }
    }
}

fn place(span: Option<Span>) -> Option<(u32, u32, u32)> {
    span.map(|s| (s.source.0, s.start, s.end))
}

impl Film {
    /// A black film with nothing finished.
    pub fn new(size: [u32; 2], crop: Crop) -> Film {
        let n = crop.area();
        Film {
            size,
            crop,
            pixels: vec![Rgb::ZERO; n],
            features: Vec::new(),
            sources: Vec::new(),
            layers: Layers::NONE,
            finished: vec![false; n],
            denoised: false,
            report: Report::default(),
        }
    }

    /// Makes room for features, where any are kept.
    pub fn keep(&mut self, kept: Layers) {
        let n = if kept.is_empty() { 0 } else { self.pixels.len() };
        self.features = vec![Features::default(); n];
    }

    /// The number of an object in this film, which it gets if it has none.
    pub fn number_of(&mut self, source: &Source) -> u32 {
        let known = self.sources.iter().position(|known| known == source);
        let i = known.unwrap_or_else(|| {
            self.sources.push(source.clone());
            self.sources.len() - 1
        });
        i as u32 + 1
    }

    /// Numbers the objects by their place in the text, whichever was seen first.
    pub fn sort_sources(&mut self) {
        let mut order: Vec<usize> = (0..self.sources.len()).collect();
        order.sort_by(|a, b| self.sources[*a].order(&self.sources[*b]));
        let mut numbers = vec![0; order.len() + 1];
        order.iter().enumerate().for_each(|(new, old)| numbers[old + 1] = new as u32 + 1);
        self.sources = order.iter().map(|old| self.sources[*old].clone()).collect();
        self.features.iter_mut().for_each(|f| f.source = numbers[f.source as usize]);
    }

    /// Shown where a function of the scene is undefined.
    pub const UNDEFINED: Rgb = Rgb::new(1.0, 0.0, 1.0);

    /// Radiance at a column and row of the film (of its crop).
    pub fn pixel(&self, x: u32, y: u32) -> Rgb {
        self.pixels[y as usize * self.crop.width as usize + x as usize]
    }

    /// True where every pixel is finished.
    pub fn is_complete(&self) -> bool {
        self.finished.iter().all(|f| *f)
    }

    /// Share of the pixels that are finished, 0 … 1.
    pub fn share_finished(&self) -> f64 {
        self.finished.iter().filter(|f| **f).count() as f64 / self.finished.len().max(1) as f64
    }

    /// Mean of all pixels.
    pub fn mean(&self) -> Rgb {
        self.pixels.iter().copied().sum::<Rgb>() / self.pixels.len().max(1) as f64
    }
}

/// The samples of one pixel on the way to their mean.
#[derive(Clone, Copy, Debug)]
pub struct PixelSum {
    sum: Rgb,
    /// How many were finite.
    count: u32,
}

impl PixelSum {
    /// No sample.
    pub const NOTHING: PixelSum = PixelSum { sum: Rgb::ZERO, count: 0 };

    /// Takes a sample. One that is not finite is left out, so that it cannot spoil its pixel: false for such a one.
    #[inline]
    pub fn add(&mut self, radiance: Rgb) -> bool {
        let is_finite = radiance.is_finite();
        if is_finite {
            self.sum += radiance;
            self.count += 1;
        }
        is_finite
    }

    /// The mean of the finite samples; black for none.
    pub fn mean(self) -> Rgb {
        self.sum / f64::from(self.count.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_equal_samples_keep_their_mean() {
        let mut pixel = PixelSum::NOTHING;
        assert!((0..1 << 22).all(|_| pixel.add(Rgb::splat(0.1))));
        assert!((pixel.mean() - Rgb::splat(0.1)).abs().max_element() < 1e-10);
    }

    #[test]
    fn a_clamp_keeps_the_hue_and_tells_what_it_took() {
        let mut clamped = Clamped::default();
        let mut at_most = |most, radiance| {
            let left = dimmed(most, radiance);
            clamped.note(radiance, left);
            left
        };
        assert_eq!(at_most(2.0, Rgb::splat(1.0)), Rgb::splat(1.0));
        assert_eq!(at_most(2.0, Rgb::new(8.0, 4.0, 0.0)), Rgb::new(2.0, 1.0, 0.0));
        assert_eq!(at_most(2.0, Rgb::splat(f64::INFINITY)), Rgb::splat(f64::INFINITY));
        let (whole, bright) = (luminance(Rgb::ONE), luminance(Rgb::new(8.0, 4.0, 0.0)));
        assert_eq!(clamped.samples, 1);
        assert!((clamped.share() - 0.75 * bright / (whole + bright)).abs() < 1e-8, "{}", clamped.share());
    }

    #[test]
    fn a_sample_that_is_not_finite_is_told_and_left_out() {
        let mut pixel = PixelSum::NOTHING;
        let taken = [1.0, f64::NAN, 3.0, f64::INFINITY].map(|x| pixel.add(Rgb::splat(x)));
        assert_eq!((pixel.mean(), taken), (Rgb::splat(2.0), [true, false, true, false]));
    }

    #[test]
    fn reports_merge_to_the_same_in_any_order() {
        let fault = |x, y, count| Fault { pixel: [x, y], count, span: None, kind: None };
        let one = Report {
            non_finite: 2,
            first_non_finite: Some(fault(5, 1, 2)),
            undefined: vec![fault(0, 3, 1)],
            ..Default::default()
        };
        let two = Report {
            non_finite: 1,
            first_non_finite: Some(fault(9, 0, 1)),
            undefined: vec![fault(7, 2, 4)],
            ..Default::default()
        };
        let merged = |mut a: Report, b: Report| {
            a.merge(b);
            a
        };
        let both = merged(one.clone(), two.clone());
        assert_eq!(both, merged(two, one));
        assert_eq!(both.first_non_finite, Some(fault(9, 0, 3)));
        assert_eq!(both.undefined, vec![fault(7, 2, 5)]);
    }
}
