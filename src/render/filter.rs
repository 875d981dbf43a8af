//! Reconstruction filters: where around a pixel's centre its samples lie. A sample's place is chosen as often as the filter weighs
//! it, so that every sample counts the same (Ernst, Stamminger & Greiner, *Filter Importance Sampling*, 2006): a pixel is made of
//! its own samples alone, noise of neighbours is not alike, and what is white everywhere stays so to the bit. Filters that weigh
//! some places below 0 cannot be had so.

use crate::math::elementary::{ln, sin_cos_turns};
use crate::scene::PixelFilter;
use glam::DVec2;

/// Pixels of deviation of the bell.
const DEVIATION: f64 = 0.5;

/// How much of the bell lies farther than four deviations, two pixels, and is left out: e⁻⁸.
const BEYOND: f64 = 3.354_626_279_025_118_5e-4;

/// The place that u in (0, 1)² chooses, in pixels from the pixel's corner; its centre is (½, ½).
pub fn place(filter: PixelFilter, u: DVec2) -> DVec2 {
    match filter {
        PixelFilter::Box => u,
        PixelFilter::Tent => DVec2::new(tent(u.x), tent(u.y)),
        PixelFilter::Gaussian => DVec2::splat(0.5) + bell(u),
    }
}

/// How far from the centre such places lie at most along either axis, in pixels.
pub fn reach(filter: PixelFilter) -> f64 {
    match filter {
        PixelFilter::Box => 0.5,
        PixelFilter::Tent => 1.0,
        PixelFilter::Gaussian => 4.0 * DEVIATION,
    }
}

/// By the inverse of the area under a tent from −½ to 1½ up to x.
fn tent(u: f64) -> f64 {
    if u < 0.5 { (2.0 * u).sqrt() - 0.5 } else { 1.5 - (2.0 - 2.0 * u).sqrt() }
}

/// By distance and angle (Box & Muller, *A Note on the Generation of Random Normal Deviates*, 1958).
fn bell(u: DVec2) -> DVec2 {
    let distance = DEVIATION * (-2.0 * ln(1.0 - u.x * (1.0 - BEYOND))).sqrt();
    let (s, c) = sin_cos_turns(u.y);
    DVec2::new(c, s) * distance
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean over a grid of places.
    fn mean(filter: PixelFilter, f: impl Fn(DVec2) -> f64) -> f64 {
        let n = 512;
        let at = |i| (f64::from(i) + 0.5) / f64::from(n);
        let sum: f64 = (0..n * n).map(|i| f(place(filter, DVec2::new(at(i % n), at(i / n))) - 0.5)).sum();
        sum / f64::from(n * n)
    }

    #[test]
    fn samples_lie_about_the_centre_as_the_filter_weighs_them() {
        // Variances along an axis: of a square 1/12, of a tent 1/6, of the bell σ² less what lies beyond.
        let bell = DEVIATION * DEVIATION * (1.0 - 8.0 * BEYOND / (1.0 - BEYOND));
        let all =
            [(PixelFilter::Box, 1.0 / 12.0), (PixelFilter::Tent, 1.0 / 6.0), (PixelFilter::Gaussian, bell)];
        for (filter, variance) in all {
            for axis in [0, 1] {
                let (middle, spread) = (mean(filter, |p| p[axis]), mean(filter, |p| p[axis] * p[axis]));
                assert!(middle.abs() < 1e-6, "{filter:?}: {middle}");
                assert!((spread - variance).abs() < 1e-3 * variance, "{filter:?}: {spread}, not {variance}");
            }
        }
    }

    #[test]
    fn no_sample_lies_beyond_the_filter() {
        for (filter, most) in
            [(PixelFilter::Box, 0.5), (PixelFilter::Tent, 1.0), (PixelFilter::Gaussian, 2.0)]
        {
            assert_eq!(reach(filter), most, "{filter:?}");
            for u in
                [1e-10, 0.25, 0.5, 1.0 - 1e-10].into_iter().flat_map(|x| [0.1, 0.5].map(|y| DVec2::new(x, y)))
            {
                let from_centre = place(filter, u) - 0.5;
                assert!(from_centre.abs().max_element() <= most, "{filter:?}, {u}: {from_centre}");
            }
        }
    }
}
