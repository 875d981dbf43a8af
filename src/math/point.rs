//! What a curve may run through: numbers, 2-vectors and 3-vectors (colours are 3-vectors). Knows nothing of curves.

use glam::{DVec2, DVec3};
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A vector of one to three f64, so that one implementation serves all of them. The operators act on each coordinate alone.
pub trait Point:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// How many coordinates.
    const DIMENSION: usize;

    /// The same as an array, with places added where that fills vector registers.
    type Lanes: Lanes;

    /// One coordinate; `axis` below [`Point::DIMENSION`].
    fn coordinate(self, axis: usize) -> f64;

    /// From its coordinates, called for each axis in order.
    fn from_coordinates(coordinate: impl FnMut(usize) -> f64) -> Self;

    /// Each coordinate without its last 26 bits: 27 of its 53 are left.
    fn truncated(self) -> Self;

    /// Inner product.
    fn dot(self, other: Self) -> f64;

    /// All coordinates 0.
    fn zero() -> Self {
        Self::default()
    }

    /// Largest magnitude of a coordinate; NaN where one is NaN.
    fn max_abs(self) -> f64 {
        (0..Self::DIMENSION).fold(0.0, |m, axis| {
            let c = self.coordinate(axis).abs();
            if c > m || c.is_nan() { c } else { m }
        })
    }

    /// Euclidean length; neither overflows nor underflows before the result does.
    fn length(self) -> f64 {
        let square = self.dot(self);
        if square > SMALLEST_SAFE_SQUARE && square < f64::INFINITY {
            return square.sqrt();
        }
        let scale = self.max_abs();
        if scale == 0.0 || !scale.is_finite() {
            return scale;
        }
        let unit = self / scale;
        scale * unit.dot(unit).sqrt()
    }

    /// Distance to another point.
    fn distance(self, other: Self) -> f64 {
        (self - other).length()
    }

    /// The unit vector along this one; None where the length is 0 or not finite.
    fn unit(self) -> Option<Self> {
        let scale = self.max_abs();
        if !(scale > 0.0 && scale < f64::INFINITY) {
            return None;
        }
        // Twice, since the reciprocal of a subnormal overflows and a plain square underflows.
        let near_one = self / scale;
        Some(near_one / near_one.length())
    }

    /// No coordinate NaN or infinite.
    fn is_finite(self) -> bool {
        (0..Self::DIMENSION).all(|axis| self.coordinate(axis).is_finite())
    }
}

/// Numbers side by side, so that what is done to each is done to several at once.
pub trait Lanes: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// One of them.
    fn lane(&self, i: usize) -> f64;

    /// From each of them. A loop, which the compiler turns into steps of two or four.
    fn of(lane: impl FnMut(usize) -> f64) -> Self;

    /// The coordinates of a point, and zeros.
    fn of_point<P: Point<Lanes = Self>>(point: P) -> Self {
        Self::of(|i| if i < P::DIMENSION { point.coordinate(i) } else { 0.0 })
    }
}

impl<const N: usize> Lanes for [f64; N] {
    #[inline(always)]
    fn lane(&self, i: usize) -> f64 {
        self[i]
    }

    #[inline(always)]
    fn of(mut lane: impl FnMut(usize) -> f64) -> Self {
        let mut lanes = [0.0; N];
        for (i, to) in lanes.iter_mut().enumerate() {
            *to = lane(i);
        }
        lanes
    }
}

/// Squares above this lose nothing to underflow: 2⁻⁹⁶⁰, so that a sum of three keeps all 53 bits.
const SMALLEST_SAFE_SQUARE: f64 = 1.026e-289;

#[inline(always)]
fn truncated(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & !((1 << 26) - 1))
}

impl Point for f64 {
    const DIMENSION: usize = 1;

    type Lanes = [f64; 1];

    fn coordinate(self, _axis: usize) -> f64 {
        self
    }

    fn from_coordinates(mut coordinate: impl FnMut(usize) -> f64) -> Self {
        coordinate(0)
    }

    #[inline(always)]
    fn truncated(self) -> Self {
        truncated(self)
    }

    fn dot(self, other: Self) -> f64 {
        self * other
    }
}

impl Point for DVec2 {
    const DIMENSION: usize = 2;

    type Lanes = [f64; 2];

    fn coordinate(self, axis: usize) -> f64 {
        self[axis]
    }

    fn from_coordinates(mut coordinate: impl FnMut(usize) -> f64) -> Self {
        let x = coordinate(0);
        DVec2::new(x, coordinate(1))
    }

    #[inline(always)]
    fn truncated(self) -> Self {
        self.map(truncated)
    }

    fn dot(self, other: Self) -> f64 {
        DVec2::dot(self, other)
    }
}

impl Point for DVec3 {
    const DIMENSION: usize = 3;

    type Lanes = [f64; 4];

    fn coordinate(self, axis: usize) -> f64 {
        self[axis]
    }

    fn from_coordinates(mut coordinate: impl FnMut(usize) -> f64) -> Self {
        let x = coordinate(0);
        let y = coordinate(1);
        DVec3::new(x, y, coordinate(2))
    }

    #[inline(always)]
    fn truncated(self) -> Self {
        self.map(truncated)
    }

    fn dot(self, other: Self) -> f64 {
        DVec3::dot(self, other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_survive_squares_that_do_not_fit() {
        for scale in [1e200, 1e-200] {
            let length = Point::length(DVec2::new(3.0, 4.0) * scale);
            assert!((length / scale - 5.0).abs() < 4.0 * f64::EPSILON, "{length}");
        }
        let tiny = DVec3::new(0.0, 5e-324, 0.0);
        assert_eq!(tiny.unit(), Some(DVec3::Y));
        assert_eq!(DVec3::ZERO.unit(), None);
        assert_eq!((-2.0f64).unit(), Some(-1.0));
    }

    #[test]
    fn lanes_hold_the_coordinates_and_zeros() {
        assert_eq!(Lanes::of_point(DVec3::new(0.1, -7.0, 3.0)), [0.1, -7.0, 3.0, 0.0]);
        assert_eq!(Lanes::of_point(-2.0f64), [-2.0]);
        assert_eq!(<[f64; 3]>::of(|i| i as f64), [0.0, 1.0, 2.0]);
    }
}
