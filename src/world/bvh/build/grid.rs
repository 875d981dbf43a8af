//! Equal bins along each axis, and which a middle is in.

use super::boxes::Box32;
use glam::Vec4;

/// Most bins per axis.
pub(super) const MOST: usize = 32;
/// 1½·2²³: a small float added to it leaves the nearest whole number in its lowest bits.
const WHOLE: f32 = 1.5 * (1u32 << 23) as f32;
/// A little less than a bin to a bin, so that what lies at the far end and is rounded up stays in the last one.
const INSIDE: f32 = 1.0 - 1.0 / (1u32 << 20) as f32;

/// Equal intervals along each axis.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    start: Vec4,
    per_length: Vec4,
}

impl Grid {
    /// `count` bins a side over a box of middles, at most [`MOST`]. An axis along which they do not spread has one bin.
    pub fn over(middles: &Box32, count: usize) -> Grid {
        let mut grid = Grid { start: Vec4::ZERO, per_length: Vec4::ZERO };
        for axis in 0..3 {
            let per_length = count as f32 * INSIDE / (middles.upper(axis) - middles.lower(axis));
            grid.start[axis] = middles.lower(axis);
            grid.per_length[axis] = if per_length.is_finite() { per_length } else { 0.0 };
        }
        grid
    }

    /// The bin of a (doubled) middle on each axis.
    #[inline(always)]
    pub fn bins(&self, middle: Vec4) -> [usize; 3] {
        let [x, y, z, _] = self.whole(middle).to_array();
        [x, y, z].map(|whole| whole.to_bits() as usize & (MOST - 1))
    }

    /// True where the bin on one axis is before another.
    #[inline(always)]
    pub fn is_before(&self, middle: Vec4, axis: usize, bin: usize) -> bool {
        self.whole(middle).cmplt(Vec4::splat(WHOLE + bin as f32)).bitmask() >> axis & 1 == 1
    }

    /// The bins on top of [`WHOLE`].
    #[inline(always)]
    fn whole(&self, middle: Vec4) -> Vec4 {
        // Half less, as the sum rounds to nearest.
        (middle - self.start) * self.per_length - Vec4::splat(0.5) + Vec4::splat(WHOLE)
    }
}
