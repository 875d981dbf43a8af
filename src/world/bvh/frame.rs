//! A tree's own coordinates, and rounding into them.

use crate::math::Aabb;
use crate::math::exact::{exponent, power_of_two};
use glam::DVec3;

/// x ↦ (x − center)·scale, with a power of two for scale, so that only the subtraction rounds.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub center: DVec3,
    pub scale: f64,
}

impl Default for Frame {
    fn default() -> Self {
        Frame { center: DVec3::ZERO, scale: 1.0 }
    }
}

impl Frame {
    /// The frame in which a finite box lies within ±2.
    pub fn around(bounds: Aabb) -> Frame {
        let center = bounds.center();
        let half = (bounds.max - center).max_element();
        let size = if half > 0.0 { half } else { center.abs().max_element() };
        if size == 0.0 || !size.is_finite() || !center.is_finite() {
            return Frame::default();
        }
        Frame { center, scale: power_of_two(-exponent(size)) }
    }

    /// The point in these coordinates.
    pub fn point(&self, p: DVec3) -> DVec3 {
        (p - self.center) * self.scale
    }
}

/// One f32 step of a number, as a share of it, at the most; casting rounds by half of one.
const STEP: f64 = f32::EPSILON as f64;
/// The same where f32 is no longer that fine.
const LEAST_STEP: f64 = f32::MIN_POSITIVE as f64;

/// A float at or below x. The subtraction into the frame and the cast are together less than one f32 step.
#[inline(always)]
pub fn round_down(x: f64) -> f32 {
    (x - (x.abs() * STEP + LEAST_STEP)) as f32
}

/// A float at or above x.
#[inline(always)]
pub fn round_up(x: f64) -> f32 {
    (x + (x.abs() * STEP + LEAST_STEP)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_goes_outward_by_less_than_two_steps() {
        let magnitudes = [0.0, 1e-60, 1e-40, 1e-38, 1e-20, 0.1, 1.0, 1.0 + 1e-9, 2.0, 3e7];
        for x in magnitudes.into_iter().flat_map(|x| [x, -x]) {
            let (below, above) = (f64::from(round_down(x)), f64::from(round_up(x)));
            assert!(below < x && x < above, "{x}: {below} {above}");
            let most = 2.0 * (x.abs() * STEP + LEAST_STEP);
            assert!(x - below < most && above - x < most, "{x}: {below} {above}");
        }
        assert_eq!(round_up(f64::MAX), f32::INFINITY);
    }
}
