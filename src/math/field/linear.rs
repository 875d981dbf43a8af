//! Linear forms: c + Σ gᵢ εᵢ ± r for εᵢ in −1 … 1, which hold every value of a function over a box, and bounds on how far its derivatives
//! are from the gᵢ there. The rest r shrinks with the square of the box, where intervals shrink with its size: reduced affine arithmetic
//! (Knoll et al., *Fast ray tracing of arbitrary implicit surfaces with interval and affine arithmetic*, 2009) about the midpoint.
//! Knows nothing of tapes.
//!
//! A form holds the true values and those that plain f64 arithmetic computes, step by step as they are made; the derivatives are the true ones.

use crate::math::elementary::{exp, ln};
use crate::math::interval::Interval;

/// Values and derivatives over a box of N sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<const N: usize> {
    /// c.
    pub middle: f64,
    /// gᵢ.
    pub slope: [f64; N],
    /// r, not negative.
    pub rest: f64,
    /// How far the derivative along εᵢ may be from gᵢ, not negative.
    pub bend: [f64; N],
}

/// What the roundings of one step may add, as a part of the sizes it works with: six of half an ε each. A sum has one in the form and one in
/// what is computed; a product three and one; a function four of its value and the slope, each within an ulp, and two.
const BLUR: f64 = 3.0 * f64::EPSILON;
/// What sixteen roundings may take from a bound itself.
const GROWTH: f64 = 8.0 * f64::EPSILON;
/// What underflow may add.
const LEAST: f64 = f64::MIN_POSITIVE;

impl<const N: usize> Linear<N> {
    /// A number that does not change.
    pub const fn constant(x: f64) -> Self {
        Linear { middle: x, slope: [0.0; N], rest: 0.0, bend: [0.0; N] }
    }

    /// A number that changes along these sides by so much, up to a rest.
    pub fn new(middle: f64, slope: [f64; N], rest: f64) -> Self {
        Linear { middle, slope, rest, bend: [0.0; N] }
    }

    /// How far values may be from the middle.
    #[inline(always)]
    pub fn reach(&self) -> f64 {
        let sum = self.slope.iter().fold(self.rest, |sum, g| sum + g.abs());
        sum + sum * GROWTH
    }

    /// Around all values.
    pub fn range(&self) -> Interval {
        let reach = self.reach();
        Interval::new((self.middle - reach).next_down(), (self.middle + reach).next_up())
    }

    /// False where something was undefined or overflowed.
    pub fn is_finite(&self) -> bool {
        (self.middle.abs() + self.reach() + self.bend.iter().sum::<f64>()).is_finite()
    }

    /// Whether every value has the same sign, and then whether it is negative.
    pub fn sign(&self) -> Option<bool> {
        (self.middle.abs() > self.reach()).then_some(self.middle < 0.0)
    }

    #[inline(always)]
    pub(super) fn neg(self) -> Self {
        Linear { middle: -self.middle, slope: self.slope.map(|g| -g), ..self }
    }

    /// With the roundings of a step on numbers up to `size` added, and of slopes up to `sizes`.
    #[inline(always)]
    fn rounded(mut self, size: f64, sizes: [f64; N]) -> Self {
        self.rest = self.rest + self.rest * GROWTH + size * BLUR + LEAST;
        for (bend, size) in self.bend.iter_mut().zip(sizes) {
            *bend = *bend + *bend * GROWTH + size * BLUR + LEAST;
        }
        self
    }

    #[inline(always)]
    pub(super) fn add(&self, b: &Self) -> Self {
        let sum = Linear {
            middle: self.middle + b.middle,
            slope: std::array::from_fn(|i| self.slope[i] + b.slope[i]),
            rest: self.rest + b.rest,
            bend: std::array::from_fn(|i| self.bend[i] + b.bend[i]),
        };
        sum.rounded(sum.middle.abs() + sum.reach(), sum.slope.map(f64::abs))
    }

    #[inline(always)]
    pub(super) fn sub(&self, b: &Self) -> Self {
        self.add(&b.neg())
    }

    #[inline(always)]
    pub(super) fn mul(&self, b: &Self) -> Self {
        let (p, q) = (self.reach(), b.reach());
        let (x, y) = (self.middle.abs(), b.middle.abs());
        let product = Linear {
            middle: self.middle * b.middle,
            slope: std::array::from_fn(|i| self.middle * b.slope[i] + b.middle * self.slope[i]),
            rest: x * b.rest + y * self.rest + p * q,
            bend: std::array::from_fn(|i| {
                self.bend[i] * (y + q) + b.bend[i] * (x + p) + self.slope[i].abs() * q + b.slope[i].abs() * p
            }),
        };
        let sizes = std::array::from_fn(|i| x * b.slope[i].abs() + y * self.slope[i].abs());
        product.rounded((x + p) * (y + q), sizes)
    }

    /// Tighter than the product with itself.
    #[inline(always)]
    pub(super) fn square(&self) -> Self {
        self.curved(self.middle * self.middle, 2.0 * self.middle, (2.0, 2.0))
    }

    /// A function of it with this value and derivative at the middle and a second derivative within these bounds everywhere. Each may be off by
    /// an ulp, and the computed function by two.
    #[inline(always)]
    fn curved(&self, value: f64, first: f64, second: (f64, f64)) -> Self {
        let reach = self.reach();
        let half = 0.5 * reach * reach;
        // ½ f″ · (0 … reach²).
        let (low, high) = (lesser(second.0 * half, 0.0), greater(second.1 * half, 0.0));
        let steep = first.abs();
        let turn = greater(second.0.abs(), second.1.abs()) * reach;
        let result = Linear {
            middle: value + 0.5 * (low + high),
            slope: self.slope.map(|g| first * g),
            rest: steep * self.rest + 0.5 * (high - low),
            bend: std::array::from_fn(|i| steep * self.bend[i] + turn * (self.slope[i].abs() + self.bend[i])),
        };
        result.rounded(value.abs() + steep * reach + 2.0 * (high - low), self.slope.map(|g| steep * g.abs()))
    }

    /// A function of it of which these values and derivatives are known, and no more.
    fn flat(&self, values: Interval, steepest: f64) -> Self {
        let (low, high) = (values.lo, values.hi);
        Linear {
            middle: 0.5 * (low + high),
            slope: [0.0; N],
            rest: 0.5 * (high - low),
            bend: std::array::from_fn(|i| steepest * (self.slope[i].abs() + self.bend[i])),
        }
        .rounded(low.abs() + high.abs(), [0.0; N])
    }

    /// Sine of radians, given sine and cosine of the middle.
    #[inline(always)]
    pub(super) fn sin(&self, (s, c): (f64, f64)) -> Self {
        self.wave(s, c)
    }

    /// Cosine of radians.
    #[inline(always)]
    pub(super) fn cos(&self, (s, c): (f64, f64)) -> Self {
        self.wave(c, -s)
    }

    /// A function that is minus its own second derivative, of amplitude 1.
    #[inline(always)]
    fn wave(&self, value: f64, first: f64) -> Self {
        let reach = self.reach();
        // Beyond, ±1 says more.
        const WIDE: f64 = 1.5;
        if !(reach < WIDE) {
            return self.flat(Interval::new(-1.0, 1.0), 1.0);
        }
        let low = greater(value - reach - GROWTH, -1.0);
        let high = lesser(value + reach + GROWTH, 1.0);
        self.curved(value, first, (-high, -low))
    }

    /// √x, where it is above 0.
    pub(super) fn sqrt(&self) -> Option<Self> {
        let (low, high) = self.above_zero()?;
        let root = self.middle.sqrt();
        let bend = |x: f64| -0.25 / (x * x.sqrt());
        Some(self.curved(root, 0.5 / root, (bend(low), bend(high))))
    }

    /// eˣ.
    pub(super) fn exp(&self) -> Self {
        let reach = self.reach();
        let outward = 1.0 + GROWTH;
        let value = exp(self.middle);
        self.curved(value, value, (exp(self.middle - reach) / outward, exp(self.middle + reach) * outward))
    }

    /// Natural logarithm, where it is above 0.
    pub(super) fn ln(&self) -> Option<Self> {
        let (low, high) = self.above_zero()?;
        let bend = |x: f64| -1.0 / (x * x);
        Some(self.curved(ln(self.middle), 1.0 / self.middle, (bend(low), bend(high))))
    }

    /// 1 / x, where it is not 0.
    pub(super) fn recip(&self) -> Option<Self> {
        if self.middle < 0.0 {
            return self.neg().recip().map(Linear::neg);
        }
        let (low, high) = self.above_zero()?;
        let one = 1.0 / self.middle;
        let bend = |x: f64| 2.0 / (x * x * x);
        Some(self.curved(one, -one * one, (bend(high), bend(low))))
    }

    /// Ends of the range where that is above 0, moved so far outward that the roundings of a second derivative do not matter.
    fn above_zero(&self) -> Option<(f64, f64)> {
        let reach = self.reach();
        let low = (self.middle - reach) * (1.0 - GROWTH) - self.middle * GROWTH;
        (low > 0.0).then_some((low, (self.middle + reach) * (1.0 + GROWTH)))
    }

    /// |x| where its sign is not known: the chord, which is above it, and half of what lies between.
    pub(super) fn folded(&self) -> Self {
        let reach = self.reach();
        let (low, high) = (reach - self.middle, reach + self.middle);
        if !(low > 0.0 && high > 0.0) {
            return self.flat(Interval::new(0.0, low.max(high)), 1.0);
        }
        let share = (high - low) / (high + low);
        let gap = high * low / (high + low);
        Linear {
            middle: share * self.middle + gap,
            slope: self.slope.map(|g| share * g),
            rest: share.abs() * self.rest + gap,
            bend: std::array::from_fn(|i| (1.0 + share.abs()) * self.slope[i].abs() + self.bend[i]),
        }
        .rounded(2.0 * (low + high), self.slope.map(f64::abs))
    }

    /// Half of it.
    pub(super) fn halved(self) -> Self {
        let by = |x: f64| 0.5 * x;
        Linear {
            middle: by(self.middle),
            slope: self.slope.map(by),
            rest: by(self.rest),
            bend: self.bend.map(by),
        }
        .rounded(0.0, [0.0; N])
    }

    /// A function of several forms with a value at their middles within `value`, and values within `all` and gaps derivatives within `slopes` over
    /// their ranges. None where these are not known.
    pub(super) fn by_derivatives(
        of: &[Self],
        value: Interval,
        all: Interval,
        slopes: &[Interval],
    ) -> Option<Self> {
        let is_known = |x: &Interval| {
            !x.gaps.are_there() && x.lo <= x.hi && x.lo > f64::NEG_INFINITY && x.hi < f64::INFINITY
        };
        if !(is_known(&value) && is_known(&all) && slopes.iter().all(is_known)) {
            return None;
        }
        let mut sum = Linear::constant(value.middle());
        sum.rest = value.width();
        let (mut size, mut sizes) = (sum.middle.abs(), [0.0; N]);
        for (x, d) in of.iter().zip(slopes) {
            let (reach, by, off) = (x.reach(), d.middle(), d.width());
            sum.rest += by.abs() * x.rest + off * reach;
            size += (by.abs() + off) * reach;
            for i in 0..N {
                let g = x.slope[i];
                sum.slope[i] += by * g;
                sum.bend[i] += by.abs() * x.bend[i] + off * (g.abs() + x.bend[i]);
                sizes[i] += 4.0 * by.abs() * g.abs();
            }
        }
        // Of up to eight terms each.
        let sum = sum.rounded(4.0 * size, sizes);
        if all.width() >= sum.reach() {
            return Some(sum);
        }
        let flat = Linear {
            middle: all.middle(),
            slope: [0.0; N],
            rest: all.width(),
            bend: std::array::from_fn(|i| sum.slope[i].abs() + sum.bend[i]),
        };
        Some(flat.rounded(0.0, sum.slope.map(f64::abs)))
    }
}

/// `f64::min` and `max` look for NaN, which the finished form is asked for.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
