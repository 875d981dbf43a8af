//! How far two pictures are apart: root mean square error, relative mean square error, and structural similarity.
//!
//! Knows nothing of scenes or of how a picture was made. Errors are measured in linear RGB, so that a PNG and an EXR of
//! the same film can be compared; similarity is measured on what a screen would show, as eyes do.

use crate::math::elementary;
use thiserror::Error;

/// A picture in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear RGB, row by row from the top.
    pub pixels: Vec<[f32; 3]>,
}

/// Why pictures cannot be compared.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum CompareFault {
    /// The bytes are no picture that can be read.
    #[error("this is no PNG, JPEG, HDR or EXR picture that can be read ({0})")]
    Decode(String),
    /// Sizes differ: of the first, of the second.
    #[error("their sizes differ: {}×{} and {}×{}", .0[0], .0[1], .1[0], .1[1])]
    Size([u32; 2], [u32; 2]),
}

/// How far a picture is from its reference. Where one has an infinity or a NaN that the other has not, errors are infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// √ of the mean over pixels and channels of (a − b)², in linear RGB.
    pub rmse: f64,
    /// Mean of (a − b)² / (b² + [`RELATIVE_FLOOR`]), b the reference.
    pub relative_mse: f64,
    /// Structural similarity of the luma of what a screen shows, −1 … 1; 1 is the same (Wang et al. 2004).
    pub ssim: f64,
    /// Largest |a − b| of any channel.
    pub largest: f64,
}

impl Difference {
    /// Whether the RMSE is at most `max_rmse`; a NaN is not.
    pub fn is_within(&self, max_rmse: f64) -> bool {
        self.rmse <= max_rmse
    }
}

/// Keeps the relative error of black pixels finite; the figure that the literature on adaptive sampling uses
/// (Rousselle et al. 2011, §4).
pub const RELATIVE_FLOOR: f64 = 0.01;

impl Picture {
    /// Reads a PNG, JPEG, HDR or EXR file, told apart by its first bytes. Alpha is dropped; 8- and 16-bit pictures are
    /// taken as sRGB.
    pub fn decode(bytes: &[u8]) -> Result<Self, CompareFault> {
        let image =
            image::load_from_memory(bytes).map_err(|error| CompareFault::Decode(error.to_string()))?;
        let is_linear =
            matches!(image, image::DynamicImage::ImageRgb32F(_) | image::DynamicImage::ImageRgba32F(_));
        let size = [image.width(), image.height()];
        let decode = |x: f32| if is_linear { x } else { linear_from_srgb(f64::from(x)) as f32 };
        let pixels = image.into_rgb32f().pixels().map(|p| p.0.map(decode)).collect();
        Ok(Picture { size, pixels })
    }
}

/// All measures of `actual` against `reference`, which must be of one size and have a pixel at least.
pub fn compare(actual: &Picture, reference: &Picture) -> Result<Difference, CompareFault> {
    if actual.size != reference.size {
        return Err(CompareFault::Size(actual.size, reference.size));
    }
    let channels = || actual.pixels.iter().flatten().zip(reference.pixels.iter().flatten());
    let (mut square, mut relative, mut largest) = (0.0, 0.0, 0.0_f64);
    for (a, b) in channels() {
        let error = channel_error(*a, *b);
        square += error * error;
        relative += error * error / (f64::from(*b) * f64::from(*b) + RELATIVE_FLOOR);
        largest = largest.max(error);
    }
    let count = channels().count().max(1) as f64;
    Ok(Difference {
        rmse: (square / count).sqrt(),
        relative_mse: if largest.is_finite() { relative / count } else { f64::INFINITY },
        ssim: ssim(&luma(actual), &luma(reference), actual.size),
        largest,
    })
}

/// The expected picture, the difference (×4, so that the eye sees it), and the actual one, side by side as a PNG;
/// pictures of different sizes leave the middle grey.
pub fn side_by_side(expected: &Picture, actual: &Picture) -> image::RgbImage {
    /// Makes differences of a few levels visible.
    const GAIN: f64 = 4.0;
    let height = expected.size[1].max(actual.size[1]);
    let width = expected.size[0].max(actual.size[0]);
    let mut sheet = image::RgbImage::from_pixel(3 * width, height, image::Rgb([128; 3]));
    paste(&mut sheet, expected, 0);
    paste(&mut sheet, actual, 2 * width);
    if expected.size == actual.size {
        let pixels = expected.pixels.iter().zip(&actual.pixels).map(|(e, a)| {
            std::array::from_fn(|i| (GAIN * channel_error(a[i], e[i])).min(f64::from(f32::MAX)) as f32)
        });
        paste(&mut sheet, &Picture { size: expected.size, pixels: pixels.collect() }, width);
    }
    sheet
}

fn paste(sheet: &mut image::RgbImage, picture: &Picture, left: u32) {
    for (i, pixel) in (0u32..).zip(&picture.pixels) {
        let (x, y) = (i % picture.size[0], i / picture.size[0]);
        let shown = pixel.map(|c| (255.0 * srgb_from_linear(f64::from(c)) + 0.5) as u8);
        sheet.put_pixel(left + x, y, image::Rgb(shown));
    }
}

/// |a − b|; 0 for the same infinity or two NaNs, infinite where only one is finite.
fn channel_error(a: f32, b: f32) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0.0;
    }
    let error = (f64::from(a) - f64::from(b)).abs();
    if error.is_nan() { f64::INFINITY } else { error }
}

/// Luma of what a screen shows, 0 … 1 (Rec. 709 weights on sRGB values).
fn luma(picture: &Picture) -> Vec<f64> {
    let shown = |c: f32| srgb_from_linear(f64::from(c));
    picture
        .pixels
        .iter()
        .map(|[r, g, b]| 0.2126 * shown(*r) + 0.7152 * shown(*g) + 0.0722 * shown(*b))
        .collect()
}

/// Mean structural similarity of two pictures in 0 … 1, with the Gaussian window of σ = 1.5 over 11 × 11 pixels of
/// Wang et al. 2004, cut at the borders and normalised.
fn ssim(a: &[f64], b: &[f64], size: [u32; 2]) -> f64 {
    /// (K₁L)² and (K₂L)² of the paper, for a range L = 1.
    const C: [f64; 2] = [0.01 * 0.01, 0.03 * 0.03];
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).collect::<Vec<_>>();
    let [mean_a, mean_b] = [a, b].map(|x| blur(x, size));
    let [aa, bb, ab] = [product(a, a), product(b, b), product(a, b)].map(|x| blur(&x, size));
    let local = (0..a.len()).map(|i| {
        let (ma, mb) = (mean_a[i], mean_b[i]);
        let (va, vb, cov) = (aa[i] - ma * ma, bb[i] - mb * mb, ab[i] - ma * mb);
        (2.0 * ma * mb + C[0]) * (2.0 * cov + C[1]) / ((ma * ma + mb * mb + C[0]) * (va + vb + C[1]))
    });
    local.sum::<f64>() / a.len().max(1) as f64
}

/// A separable Gaussian of σ = 1.5 and radius 5, its weights normalised over the pixels that are there.
fn blur(values: &[f64], [width, height]: [u32; 2]) -> Vec<f64> {
    const RADIUS: usize = 5;
    const SIGMA: f64 = 1.5;
    let weights: Vec<f64> =
        (0..=RADIUS).map(|i| elementary::exp(-((i * i) as f64) / (2.0 * SIGMA * SIGMA))).collect();
    let (width, height) = (width as usize, height as usize);
    let pass = |source: &[f64], length: usize, at: &dyn Fn(usize, usize) -> usize, lines: usize| {
        let mut out = vec![0.0; source.len()];
        for line in 0..lines {
            for i in 0..length {
                let near = i.saturating_sub(RADIUS)..(i + RADIUS + 1).min(length);
                let (mut sum, mut total) = (0.0, 0.0);
                for j in near {
                    let weight = weights[i.abs_diff(j)];
                    sum += weight * source[at(line, j)];
                    total += weight;
                }
                out[at(line, i)] = sum / total;
            }
        }
        out
    };
    let rows = pass(values, width, &|line, i| line * width + i, height);
    pass(&rows, height, &|line, i| i * width + line, width)
}

/// IEC 61966-2-1, from 0 … 1 to 0 … 1.
fn linear_from_srgb(x: f64) -> f64 {
    if x <= 0.04045 { x / 12.92 } else { elementary::powf((x + 0.055) / 1.055, 2.4) }
}

/// IEC 61966-2-1 after clipping to 0 … 1; NaN is black.
fn srgb_from_linear(x: f64) -> f64 {
    let x = if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) };
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * elementary::powf(x, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(value: f32) -> Picture {
        Picture { size: [16, 12], pixels: vec![[value; 3]; 16 * 12] }
    }

    #[test]
    fn a_picture_is_not_apart_from_itself() {
        let mut noisy = flat(0.5);
        noisy.pixels.iter_mut().enumerate().for_each(|(i, p)| p[0] = (i % 7) as f32 / 7.0);
        let same = compare(&noisy, &noisy).unwrap();
        assert_eq!((same.rmse, same.relative_mse, same.largest), (0.0, 0.0, 0.0));
        assert!((same.ssim - 1.0).abs() < 1e-12);
    }

    #[test]
    fn constant_offsets_have_closed_forms() {
        let apart = compare(&flat(0.75), &flat(0.5)).unwrap();
        assert_eq!((apart.rmse, apart.largest), (0.25, 0.25));
        assert!((apart.relative_mse - 0.0625 / 0.26).abs() < 1e-12);
        assert!(apart.ssim < 1.0);
    }

    #[test]
    fn a_nan_or_an_infinity_is_never_within_a_threshold() {
        let mut broken = flat(0.5);
        broken.pixels[3][1] = f32::NAN;
        assert!(!compare(&broken, &flat(0.5)).unwrap().is_within(1e30));
        broken.pixels[3][1] = f32::INFINITY;
        assert!(!compare(&flat(0.5), &broken).unwrap().is_within(1e30));
        assert!(compare(&broken, &broken).unwrap().is_within(0.0));
    }

    #[test]
    fn sizes_must_agree() {
        let other = Picture { size: [12, 16], ..flat(0.5) };
        assert_eq!(compare(&flat(0.5), &other), Err(CompareFault::Size([16, 12], [12, 16])));
        let fault = compare(&flat(0.5), &other).unwrap_err().to_string();
        assert_eq!(fault, "their sizes differ: 16×12 and 12×16");
    }

    #[test]
    fn noise_is_less_similar_than_a_shift_in_brightness_of_the_same_rmse() {
        let mut noisy = flat(0.5);
        noisy.pixels.iter_mut().enumerate().for_each(|(i, p)| *p = [if i % 2 == 0 { 0.4 } else { 0.6 }; 3]);
        let (noise, shift) = (compare(&noisy, &flat(0.5)).unwrap(), compare(&flat(0.6), &flat(0.5)).unwrap());
        assert!((noise.rmse - shift.rmse).abs() < 1e-6);
        assert!(noise.ssim < 0.5 && shift.ssim > 0.9, "{} {}", noise.ssim, shift.ssim);
    }
}
