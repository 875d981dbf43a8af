//! Double-double arithmetic: a value as the unevaluated sum of two f64, about 106 bits. Error-free transformations after
//! Dekker (1971) and Knuth; operations after Joldes, Muller & Popescu, *Tight and rigorous error bounds for basic building
//! blocks of double-word arithmetic* (2017). No fused multiply-add, so that every machine gives the same bits at the same price.
//!
//! Products are exact while magnitudes stay within [`SPLIT_LIMIT`] and results above 2⁻⁹⁶⁹; beyond, callers fall back to f64.

use super::Point;
use std::ops::{Add, Neg, Sub};

/// Largest magnitude that Dekker's splitting takes without overflow: 2⁹⁹⁶.
pub const SPLIT_LIMIT: f64 = 6.696928794914171e299;

/// 2²⁷ + 1.
const SPLITTER: f64 = 134_217_729.0;

/// `a + b` and what its rounding left out. Exact. Knuth.
#[inline(always)]
pub fn two_sum<P: Point>(a: P, b: P) -> (P, P) {
    let s = a + b;
    let bb = s - a;
    (s, (a - (s - bb)) + (b - bb))
}

/// `a + b` and what its rounding left out, where |a| ≥ |b| or a = 0 in each coordinate. Exact. Dekker.
#[inline(always)]
pub fn fast_two_sum<P: Point>(a: P, b: P) -> (P, P) {
    let s = a + b;
    (s, b - (s - a))
}

/// Two halves of at most 26 bits whose sum is `a`. Veltkamp.
#[inline(always)]
fn split<P: Point>(a: P) -> (P, P) {
    let c = a * SPLITTER;
    let high = c - (c - a);
    (high, a - high)
}

/// A factor together with its halves, for products with many others.
#[derive(Clone, Copy, Debug)]
pub struct Factor {
    value: f64,
    high: f64,
    low: f64,
}

impl Factor {
    /// The factor `value`.
    #[inline(always)]
    pub fn new(value: f64) -> Factor {
        let (high, low) = split(value);
        Factor { value, high, low }
    }

    /// The two halves, of 26 bits each.
    #[inline(always)]
    pub fn halves(&self) -> (f64, f64) {
        (self.high, self.low)
    }

    /// `a · self` and what its rounding left out. Exact. Dekker; `a` is cut into 27 bits and 26, which takes half as long as by Veltkamp and
    /// leaves every product with the halves of this factor, 26 bits each, exact.
    #[inline(always)]
    pub fn times<P: Point>(&self, a: P) -> (P, P) {
        let high = a.truncated();
        let low = a - high;
        let p = a * self.value;
        (p, low * self.low - (((p - high * self.high) - low * self.high) - high * self.low))
    }
}

/// `a · b` and what its rounding left out. Exact. Dekker.
#[inline(always)]
pub fn two_product<P: Point>(a: P, b: f64) -> (P, P) {
    Factor::new(b).times(a)
}

/// `hi + lo`, where `hi` is the sum rounded to f64. Of a vector: coordinate by coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dd<P = f64> {
    /// The value rounded to f64.
    pub hi: P,
    /// What is left.
    pub lo: P,
}

impl<P: Point> From<P> for Dd<P> {
    fn from(hi: P) -> Self {
        Dd { hi, lo: P::zero() }
    }
}

impl<P: Point> Dd<P> {
    /// The exact sum of two f64.
    pub fn sum(a: P, b: P) -> Self {
        let (hi, lo) = two_sum(a, b);
        Dd { hi, lo }
    }

    /// The exact difference of two f64.
    pub fn difference(a: P, b: P) -> Self {
        Dd::sum(a, -b)
    }

    /// Times a scalar; relative error below 5·2⁻¹⁰⁶.
    #[must_use]
    pub fn times(self, s: Dd) -> Self {
        let (p, e) = two_product(self.hi, s.hi);
        let (hi, lo) = fast_two_sum(p, e + (self.hi * s.lo + self.lo * s.hi));
        Dd { hi, lo }
    }

    /// Times an f64; relative error below 2·2⁻¹⁰⁶.
    #[must_use]
    pub fn scaled(self, s: f64) -> Self {
        let (p, e) = two_product(self.hi, s);
        let (hi, lo) = fast_two_sum(p, e + self.lo * s);
        Dd { hi, lo }
    }

    /// Over a scalar, which must not be 0; relative error below 15·2⁻¹⁰⁶.
    #[must_use]
    pub fn over(self, s: Dd) -> Self {
        let q = self.hi / s.hi;
        let rest = self - s.spread(q);
        let q2 = rest.hi / s.hi;
        let rest = rest - s.spread(q2);
        let (hi, lo) = fast_two_sum(q, q2);
        Dd { hi, lo } + Dd::from(rest.hi / s.hi)
    }

    /// Over a whole number, correctly rounded to about 2⁻¹⁰⁵.
    #[must_use]
    pub fn over_integer(self, n: i64) -> Self {
        self.over(Dd::from(n as f64))
    }

    /// The value rounded to f64.
    pub fn value(self) -> P {
        self.hi
    }
}

impl Dd<f64> {
    /// This scalar times a vector of f64, coordinate by coordinate.
    fn spread<P: Point>(self, v: P) -> Dd<P> {
        Dd::from(v).times(self)
    }
}

impl<P: Point> Add for Dd<P> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.hi, other.hi);
        let (t, f) = two_sum(self.lo, other.lo);
        let (s, e) = fast_two_sum(s, e + t);
        let (hi, lo) = fast_two_sum(s, e + f);
        Dd { hi, lo }
    }
}

impl<P: Point> Neg for Dd<P> {
    type Output = Self;

    fn neg(self) -> Self {
        Dd { hi: -self.hi, lo: -self.lo }
    }
}

impl<P: Point> Sub for Dd<P> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn transformations_lose_nothing() {
        let (s, e) = two_sum(1e16, 1.25);
        assert_eq!((s, e), (1e16 + 2.0, -0.75));
        let a = 1.0 + f64::EPSILON;
        let (p, e) = two_product(a, a);
        assert_eq!((p, e), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
    }

    #[test]
    fn division_undoes_multiplication() {
        let third = Dd::from(1.0).over_integer(3);
        let rest = third.scaled(3.0) - Dd::from(1.0);
        assert!(rest.hi.abs() < 1e-31, "{rest:?}");
        let v = Dd::from(DVec2::new(2.0, -7.0)).over(third) - Dd::from(DVec2::new(6.0, -21.0));
        assert!(v.hi.length() < 1e-30, "{v:?}");
    }
}
