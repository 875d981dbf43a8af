//! Equal bins along each axis, and which a middle is in.

use super::boxes::Box32;

/// Most bins per axis.
pub(super) const MOST: usize = 32;
/// 1½·2²³: a small float added to it leaves the nearest whole number in its lowest bits.
const WHOLE: f32 = 1.5 * (1u32 << 23) as f32;
/// A little less than a bin to a bin, so that what lies at the far end and is rounded up stays in the last one.
const INSIDE: f32 = 1.0 - 1.0 / (1u32 << 20) as f32;

/// Equal intervals along each axis.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    start: [f32; 4],
    per_length: [f32; 4],
}

impl Grid {
    /// `count` bins a side over a box of middles, at most [`MOST`]. An axis along which they do not spread has one bin.
    pub fn over(middles: &Box32, count: usize) -> Grid {
        let mut grid = Grid { start: [0.0; 4], per_length: [0.0; 4] };
        for axis in 0..3 {
            let per_length = count as f32 * INSIDE / (middles.upper(axis) - middles.lower(axis));
            grid.start[axis] = middles.lower(axis);
            grid.per_length[axis] = if per_length.is_finite() { per_length } else { 0.0 };
        }
        grid
    }

    /// The bin of a (doubled) middle on each axis; the last means nothing.
    #[inline(always)]
    pub fn bins(&self, middle: [f32; 4]) -> [usize; 4] {
        std::array::from_fn(|a| self.bin(middle[a], a))
    }

    /// The bin on one axis.
    #[inline(always)]
    pub fn bin(&self, middle: f32, axis: usize) -> usize {
        // Half less, as the sum rounds to nearest.
        let x = (middle - self.start[axis]) * self.per_length[axis] - 0.5;
        (x + WHOLE).to_bits() as usize & (MOST - 1)
    }
}
