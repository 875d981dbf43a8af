//! Intervals that hold every value a computation can have: f64 ends, rounded outward after each operation.
//!
//! The hardware rounds to nearest, so an end is moved outward by one step of the floating-point grid; functions of
//! [`super::elementary`] are within 1 ulp of the truth and are moved by two. An operation outside its domain gives the
//! part of its range that is defined and says so by [`Interval::gaps`]; where nothing is defined, [`Interval::EMPTY`].

use super::elementary::{cos, exp, ln, powf, sin};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, BitOr, Div, Mul, Neg, Sub};

/// A closed interval `lo … hi`; empty where `lo > hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
    /// Whether the function was undefined, or jumped, somewhere in the arguments.
    pub gaps: Gaps,
}

/// What a function does somewhere in its arguments beside running on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gaps(u8);

impl Gaps {
    /// Nothing.
    pub const NONE: Gaps = Gaps(0);
    /// It jumps, between values that it is known to have there.
    pub const JUMPS: Gaps = Gaps(1);
    /// It is undefined.
    pub const UNDEFINED: Gaps = Gaps(2);
    /// Both.
    pub const ANY: Gaps = Gaps(3);

    /// Jumps, if it does.
    pub fn jumping(jumps: bool) -> Gaps {
        if jumps { Gaps::JUMPS } else { Gaps::NONE }
    }

    /// Undefined, if it is.
    pub fn undefined(undefined: bool) -> Gaps {
        if undefined { Gaps::UNDEFINED } else { Gaps::NONE }
    }

    /// True where there may be one of either kind.
    pub fn are_there(self) -> bool {
        self != Gaps::NONE
    }

    /// True where it may be undefined.
    pub fn are_undefined(self) -> bool {
        self.0 & Gaps::UNDEFINED.0 != 0
    }
}

impl BitOr for Gaps {
    type Output = Gaps;

    fn bitor(self, other: Gaps) -> Gaps {
        Gaps(self.0 | other.0)
    }
}

/// One step of the floating-point grid down; −∞ stays.
fn down(x: f64) -> f64 {
    x.next_down()
}

/// One step of the floating-point grid up; ∞ stays.
fn up(x: f64) -> f64 {
    x.next_up()
}

/// a + b where that is a floating-point number (Knuth's TwoSum tells).
fn exact_sum(a: f64, b: f64) -> Option<f64> {
    let sum = a + b;
    let of_b = sum - a;
    ((a - (sum - of_b)) + (b - of_b) == 0.0).then_some(sum)
}

/// a · b where that is a floating-point number: whole numbers all of whose digits there is room for.
fn exact_product(a: f64, b: f64) -> Option<f64> {
    const MOST: f64 = (1u64 << 53) as f64;
    let product = a * b;
    let are_whole = a.trunc() == a && b.trunc() == b;
    (are_whole && product.abs() <= MOST).then_some(product)
}

impl Interval {
    /// No value at all.
    pub const EMPTY: Interval = Interval { lo: f64::INFINITY, hi: f64::NEG_INFINITY, gaps: Gaps::UNDEFINED };
    /// Any number.
    pub const WHOLE: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY, gaps: Gaps::NONE };

    /// `lo … hi`, exactly.
    pub const fn new(lo: f64, hi: f64) -> Interval {
        Interval { lo, hi, gaps: Gaps::NONE }
    }

    /// A single number.
    pub const fn point(x: f64) -> Interval {
        Interval::new(x, x)
    }

    /// What an operation on two single numbers gives where it does not round, so that the turns of a loop are counted exactly. None otherwise.
    fn exactly(self, b: Interval, operation: fn(f64, f64) -> Option<f64>) -> Option<Interval> {
        let are_single = self.lo == self.hi && b.lo == b.hi;
        let x = are_single.then(|| operation(self.lo, b.lo))??;
        Some(Interval::point(x).with_gaps(self.gaps | b.gaps))
    }

    /// True for no value at all (or NaN ends).
    pub fn is_empty(self) -> bool {
        !(self.lo <= self.hi)
    }

    /// True where `x` is a value.
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Upper minus lower end, rounded up.
    pub fn width(self) -> f64 {
        up(self.hi - self.lo)
    }

    /// A number near the middle, inside.
    pub fn middle(self) -> f64 {
        (self.lo / 2.0 + self.hi / 2.0).clamp(self.lo, self.hi)
    }

    /// The smallest interval around both.
    #[must_use]
    pub fn hull(self, other: Interval) -> Interval {
        let gaps = self.gaps | other.gaps;
        match (self.is_empty(), other.is_empty()) {
            (true, _) => Interval { gaps, ..other },
            (_, true) => Interval { gaps, ..self },
            _ => Interval { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi), gaps },
        }
    }

    /// What both hold.
    #[must_use]
    pub fn intersect(self, other: Interval) -> Interval {
        Interval { lo: self.lo.max(other.lo), hi: self.hi.min(other.hi), gaps: self.gaps | other.gaps }
    }

    /// The same values, with more gaps.
    #[must_use]
    pub fn with_gaps(self, gaps: Gaps) -> Interval {
        Interval { gaps: self.gaps | gaps, ..self }
    }

    /// Ends moved outward by two steps, for functions within 1 ulp.
    fn outward(lo: f64, hi: f64, gaps: Gaps) -> Interval {
        Interval { lo: down(down(lo)), hi: up(up(hi)), gaps }
    }

    /// |x|.
    #[must_use]
    pub fn abs(self) -> Interval {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else {
            Interval { lo: 0.0, hi: self.hi.max(-self.lo), gaps: self.gaps }
        }
    }

    /// x², tighter than x·x.
    #[must_use]
    pub fn square(self) -> Interval {
        let a = self.abs();
        if let Some(exact) = a.exactly(a, exact_product) {
            return exact;
        }
        Interval { lo: down(a.lo * a.lo).max(0.0), hi: up(a.hi * a.hi), gaps: self.gaps }
    }

    /// √x.
    #[must_use]
    pub fn sqrt(self) -> Interval {
        if self.is_empty() || self.hi < 0.0 {
            return Interval::EMPTY;
        }
        let lo = if self.lo <= 0.0 { 0.0 } else { down(self.lo.sqrt()).max(0.0) };
        Interval { lo, hi: up(self.hi.sqrt()), gaps: self.gaps | Gaps::undefined(self.lo < 0.0) }
    }

    /// eˣ.
    #[must_use]
    pub fn exp(self) -> Interval {
        let wide = Interval::outward(exp(self.lo), exp(self.hi), self.gaps);
        Interval { lo: wide.lo.max(0.0), ..wide }
    }

    /// Natural logarithm.
    #[must_use]
    pub fn ln(self) -> Interval {
        if self.is_empty() || self.hi <= 0.0 {
            return Interval::EMPTY;
        }
        let lo = if self.lo <= 0.0 { f64::NEG_INFINITY } else { ln(self.lo) };
        Interval::outward(lo, ln(self.hi), self.gaps | Gaps::undefined(self.lo <= 0.0))
    }

    /// A function that grows everywhere and is within 1 ulp.
    #[must_use]
    pub fn monotone(self, f: fn(f64) -> f64) -> Interval {
        Interval::outward(f(self.lo), f(self.hi), self.gaps)
    }

    /// Sine of radians.
    #[must_use]
    pub fn sin(self) -> Interval {
        (self - Interval { lo: down(FRAC_PI_2), hi: up(FRAC_PI_2), gaps: Gaps::NONE }).cos_like(self, sin)
    }

    /// Cosine of radians.
    #[must_use]
    pub fn cos(self) -> Interval {
        self.cos_like(self, cos)
    }

    /// The range of cos over `self`, whose end values are `f` of the ends of `argument`.
    fn cos_like(self, argument: Interval, f: fn(f64) -> f64) -> Interval {
        // Past 2^45 the grid of multiples of π is coarser than the test below can tell apart.
        const LARGE: f64 = (1u64 << 45) as f64;
        if self.is_empty() {
            return Interval::EMPTY;
        }
        if !(self.width() < 2.0 * PI) || self.lo.abs().max(self.hi.abs()) > LARGE {
            return Interval { lo: -1.0, hi: 1.0, gaps: self.gaps };
        }
        // Multiples of π inside, tested with ends moved outward by what k·π is off: a crest too many is only loose.
        let slack = (self.lo.abs().max(self.hi.abs()) + 1.0) * 4.0 * f64::EPSILON;
        let first = ((self.lo - slack) / PI).ceil();
        let last = ((self.hi + slack) / PI).floor();
        let (a, b) = (f(argument.lo), f(argument.hi));
        let mut range = Interval::outward(a.min(b), a.max(b), self.gaps);
        let mut k = first;
        while k <= last {
            if k.rem_euclid(2.0) == 0.0 {
                range.hi = 1.0
            } else {
                range.lo = -1.0
            }
            k += 1.0;
        }
        Interval { lo: range.lo.max(-1.0), hi: range.hi.min(1.0), gaps: self.gaps }
    }

    /// Tangent of radians; everything where a pole may lie inside.
    #[must_use]
    pub fn tan(self) -> Interval {
        self.sin() / self.cos()
    }

    /// xⁿ for a whole n.
    #[must_use]
    pub fn powi(self, n: i32) -> Interval {
        match n {
            0 => Interval::point(1.0).with_gaps(self.gaps),
            1 => self,
            2 => self.square(),
            n if n < 0 => Interval::point(1.0) / self.powi(-n),
            n => {
                let base = if n % 2 == 0 { self.abs() } else { self };
                Interval::outward(powf(base.lo, f64::from(n)), powf(base.hi, f64::from(n)), self.gaps)
            }
        }
    }

    /// xʸ: whole constant powers for any base, others for bases that are not negative.
    #[must_use]
    pub fn pow(self, y: Interval) -> Interval {
        if y.lo == y.hi && y.lo.fract() == 0.0 && y.lo.abs() <= 1024.0 {
            return self.powi(y.lo as i32);
        }
        if self.is_empty() || y.is_empty() || self.hi < 0.0 {
            return Interval::EMPTY;
        }
        let base = Interval { lo: self.lo.max(0.0), ..self };
        let corners =
            [(base.lo, y.lo), (base.lo, y.hi), (base.hi, y.lo), (base.hi, y.hi)].map(|(a, b)| powf(a, b));
        let lo = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let hi = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // Between corners the power runs through 1 where the base or the exponent changes sides.
        let (lo, hi) =
            if base.contains(1.0) || y.contains(0.0) { (lo.min(1.0), hi.max(1.0)) } else { (lo, hi) };
        let wide = Interval::outward(lo, hi, self.gaps | y.gaps | Gaps::undefined(self.lo < 0.0));
        Interval { lo: wide.lo.max(0.0), ..wide }
    }

    /// ⌊x⌋; gaps where it jumps.
    #[must_use]
    pub fn floor(self) -> Interval {
        let (lo, hi) = (self.lo.floor(), self.hi.floor());
        Interval { lo, hi, gaps: self.gaps | Gaps::jumping(lo != hi) }
    }

    /// The lesser.
    #[must_use]
    pub fn min(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.min(other.hi), gaps: self.gaps | other.gaps }
    }

    /// The greater.
    #[must_use]
    pub fn max(self, other: Interval) -> Interval {
        Interval { lo: self.lo.max(other.lo), hi: self.hi.max(other.hi), gaps: self.gaps | other.gaps }
    }
}

impl Neg for Interval {
    type Output = Interval;

    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo, gaps: self.gaps }
    }
}

impl Add for Interval {
    type Output = Interval;

    fn add(self, b: Interval) -> Interval {
        if let Some(exact) = self.exactly(b, exact_sum) {
            return exact;
        }
        Interval { lo: down(self.lo + b.lo), hi: up(self.hi + b.hi), gaps: self.gaps | b.gaps }
    }
}

impl Sub for Interval {
    type Output = Interval;

    fn sub(self, b: Interval) -> Interval {
        if let Some(exact) = self.exactly(-b, exact_sum) {
            return exact;
        }
        Interval { lo: down(self.lo - b.hi), hi: up(self.hi - b.lo), gaps: self.gaps | b.gaps }
    }
}

/// 0 · ∞ is 0 here: an end of ∞ stands for numbers without bound, never for ∞ itself.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl Mul for Interval {
    type Output = Interval;

    fn mul(self, b: Interval) -> Interval {
        let gaps = self.gaps | b.gaps;
        if self.is_empty() || b.is_empty() {
            return Interval::EMPTY;
        }
        if let Some(exact) = self.exactly(b, exact_product) {
            return exact;
        }
        let p = [times(self.lo, b.lo), times(self.lo, b.hi), times(self.hi, b.lo), times(self.hi, b.hi)];
        let lo = p[0].min(p[1]).min(p[2].min(p[3]));
        let hi = p[0].max(p[1]).max(p[2].max(p[3]));
        Interval { lo: down(lo), hi: up(hi), gaps }
    }
}

impl Div for Interval {
    type Output = Interval;

    fn div(self, b: Interval) -> Interval {
        let gaps = self.gaps | b.gaps;
        if self.is_empty() || b.is_empty() {
            return Interval::EMPTY;
        }
        if b.contains(0.0) {
            return Interval { gaps: Gaps::UNDEFINED, ..Interval::WHOLE };
        }
        let q = [self.lo / b.lo, self.lo / b.hi, self.hi / b.lo, self.hi / b.hi];
        let lo = q[0].min(q[1]).min(q[2].min(q[3]));
        let hi = q[0].max(q[1]).max(q[2].max(q[3]));
        Interval { lo: down(lo), hi: up(hi), gaps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary;

    /// Seeded numbers in −10 … 10.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * 20.0 - 10.0
        }
    }

    #[test]
    fn every_value_of_the_arguments_lies_in_the_result() {
        let mut next = numbers(7);
        for _ in 0..20_000 {
            let (a, w, b, v) = (next(), next().abs() / 4.0, next(), next().abs() / 4.0);
            let (x, y) = (Interval::new(a, a + w), Interval::new(b, b + v));
            let (s, t) = ((next() + 10.0) / 20.0, (next() + 10.0) / 20.0);
            let (p, q) = ((a + s * w).clamp(a, a + w), (b + t * v).clamp(b, b + v));
            let cases = [
                ("+", x + y, p + q),
                ("-", x - y, p - q),
                ("*", x * y, p * q),
                ("square", x.square(), p * p),
                ("sin", x.sin(), elementary::sin(p)),
                ("cos", x.cos(), elementary::cos(p)),
                ("exp", x.exp(), elementary::exp(p)),
                ("abs", x.abs(), p.abs()),
                ("cube", x.powi(3), p * p * p),
                ("fourth", x.powi(4), p * p * p * p),
                ("floor", x.floor(), p.floor()),
                ("min", x.min(y), p.min(q)),
                ("max", x.max(y), p.max(q)),
            ];
            for (name, range, value) in cases {
                assert!(range.contains(value), "{name}: {value:e} is not in {range:?} for {x:?}, {y:?}");
            }
            if !y.contains(0.0) {
                assert!((x / y).contains(p / q), "{x:?} / {y:?}");
            }
            if a > 0.0 {
                assert!(x.ln().contains(elementary::ln(p)) && x.sqrt().contains(p.sqrt()));
                assert!(x.pow(y).contains(elementary::powf(p, q)), "{x:?} ^ {y:?} lacks {p} ^ {q}");
            }
        }
    }

    #[test]
    fn what_does_not_round_is_a_single_number() {
        let [two, five, tenth] = [2.0, 5.0, 0.1].map(Interval::point);
        assert_eq!(
            [two + five, two - five, two * five, five.square()],
            [7.0, -3.0, 10.0, 25.0].map(Interval::point)
        );
        for rounded in [tenth + two, tenth - two, tenth * five, tenth.square()] {
            assert!(rounded.width() > 0.0);
        }
        let most = Interval::point((1u64 << 53) as f64);
        assert!((most + Interval::point(1.0)).contains(most.lo + 1.0) && (most * two).width() > 0.0);
        assert!((Interval::point(f64::MAX) + Interval::point(f64::MAX)).lo < f64::INFINITY);
        assert!((five.with_gaps(Gaps::JUMPS) + two).gaps.are_there());
    }

    #[test]
    fn crests_inside_are_reached() {
        assert_eq!(Interval::new(0.0, 4.0).cos().lo, -1.0);
        assert_eq!(Interval::new(1.0, 2.0).sin().hi, 1.0);
        assert_eq!(Interval::new(-1.0, 1.0).cos().hi, 1.0);
        assert!(Interval::new(0.1, 0.2).sin().width() < 0.1);
    }

    #[test]
    fn undefined_parts_are_said() {
        assert!(Interval::new(-1.0, 4.0).sqrt().gaps.are_undefined());
        assert_eq!(Interval::new(-1.0, 4.0).sqrt().lo, 0.0);
        assert!(Interval::new(-2.0, -1.0).sqrt().is_empty());
        assert!((Interval::point(1.0) / Interval::new(-1.0, 1.0)).gaps.are_undefined());
        assert_eq!(Interval::new(0.5, 1.5).floor().gaps, Gaps::JUMPS);
        assert_eq!(Interval::new(1.25, 1.5).floor().gaps, Gaps::NONE);
    }

    #[test]
    fn a_square_is_tighter_than_a_product() {
        let x = Interval::new(-1.0, 2.0);
        assert!(x.square().lo >= 0.0 && (x * x).lo <= -2.0);
    }
}
