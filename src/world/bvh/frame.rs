//! A tree's own coordinates, and rounding into them.

use crate::math::Aabb;
use crate::math::exact::{exponent, power_of_two};
use glam::DVec3;

/// x ↦ (x − center)·scale, with a power of two for scale, so that only the subtraction rounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
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

/// A float at or below x. The subtraction into the frame and the cast are together less than one f32 step.
pub(super) fn round_down(x: f64) -> f32 {
    (x as f32).next_down()
}

/// A float at or above x.
pub(super) fn round_up(x: f64) -> f32 {
    (x as f32).next_up()
}
