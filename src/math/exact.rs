//! Arithmetic whose rounding errors are known: powers of two, error-free sums and products, and short sums of products in
//! twice the working precision. Dekker 1971; Ogita, Rump & Oishi, *Accurate sum and dot product*, 2005.
//!
//! Products overflow or lose their error term beyond about 10^±145; callers scale by powers of two first.

use glam::DVec3;

/// The exponent e of the power of two with 2^e ≤ |x| < 2^(e+1). For 0 and subnormal numbers −1023, for infinities and NaN 1024.
#[inline]
pub fn exponent(x: f64) -> i32 {
    ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023
}

/// 2^e, with e clamped to the range of normal numbers, −1022 … 1023.
#[inline]
pub fn power_of_two(e: i32) -> f64 {
    f64::from_bits(((e.clamp(-1022, 1023) + 1023) as u64) << 52)
}

/// x·2^e in steps that are each in range, so that only the result can overflow or underflow.
pub fn scale_by(x: f64, e: i32) -> f64 {
    let half = e / 2;
    x * power_of_two(half) * power_of_two(e - half)
}

/// a + b as the rounded sum and its exact error (Knuth).
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// The two halves of 26 bits whose sum is x (Veltkamp).
fn split(x: f64) -> (f64, f64) {
    const FACTOR: f64 = 134_217_729.0; // 2^27 + 1
    let c = FACTOR * x;
    let high = c - (c - x);
    (high, x - high)
}

/// a·b as the rounded product and its exact error (Dekker; without fused operations, so that every machine agrees).
pub fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (p, a2 * b2 - (((p - a1 * b1) - a2 * b1) - a1 * b2))
}

/// A number as an unevaluated sum of two, the second below half an ulp of the first: about 106 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double {
    /// The number, rounded.
    pub high: f64,
    /// What is left.
    pub low: f64,
}

impl Double {
    /// A plain number.
    pub const fn new(x: f64) -> Double {
        Double { high: x, low: 0.0 }
    }

    /// a·b, exactly.
    pub fn product(a: f64, b: f64) -> Double {
        let (high, low) = two_product(a, b);
        Double { high, low }
    }

    /// a − b, exactly.
    pub fn difference(a: f64, b: f64) -> Double {
        let (high, low) = two_sum(a, -b);
        Double { high, low }
    }

    /// The nearest plain number.
    pub fn value(self) -> f64 {
        self.high + self.low
    }

    fn normalised(high: f64, low: f64) -> Double {
        let s = high + low;
        Double { high: s, low: low - (s - high) }
    }
}

impl std::ops::Neg for Double {
    type Output = Double;
    fn neg(self) -> Double {
        Double { high: -self.high, low: -self.low }
    }
}

impl std::ops::Add for Double {
    type Output = Double;
    fn add(self, other: Double) -> Double {
        let (s, e) = two_sum(self.high, other.high);
        let (t, f) = two_sum(self.low, other.low);
        let first = Double::normalised(s, e + t);
        Double::normalised(first.high, first.low + f)
    }
}

impl std::ops::Sub for Double {
    type Output = Double;
    fn sub(self, other: Double) -> Double {
        self + -other
    }
}

impl std::ops::Mul for Double {
    type Output = Double;
    fn mul(self, other: Double) -> Double {
        let (p, e) = two_product(self.high, other.high);
        Double::normalised(p, e + (self.high * other.low + self.low * other.high))
    }
}

/// a·b + c·d + e·f over pairs, as if in twice the working precision, rounded once (Ogita, Rump & Oishi, `Dot2`): the errors
/// of products and sums are added beside the sum, so that only one addition waits for the one before.
#[inline]
pub fn sum_of_products<const N: usize>(pairs: [(f64, f64); N]) -> f64 {
    let (mut sum, mut error) = (0.0, 0.0);
    for (a, b) in pairs {
        let (product, of_product) = two_product(a, b);
        let (next, of_sum) = two_sum(sum, product);
        sum = next;
        error += of_product + of_sum;
    }
    sum + error
}

/// a·b in twice the working precision, rounded once.
#[inline]
pub fn dot(a: DVec3, b: DVec3) -> f64 {
    sum_of_products([(a.x, b.x), (a.y, b.y), (a.z, b.z)])
}

/// a % b, in the same bits. What is smaller than its divisor is its own remainder. By a power of two, as most divisors in a loop are, without a loop over the bits of the quotient:
/// dividing by it and taking the whole quotients away rounds nowhere.
pub fn remainder(a: f64, b: f64) -> f64 {
    if a.abs() < b.abs() {
        return a;
    }
    let quotient = a / b;
    let is_power = b.is_normal() && power_of_two(exponent(b)) == b.abs();
    if is_power && quotient.is_finite() { (a - quotient.trunc() * b).copysign(a) } else { a % b }
}

/// ab − cd whose sign is exact and whose value is right to an ulp or two: zero only where the products are equal.
pub fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let (p, q) = (a * b, c * d);
    if p != q {
        return p - q;
    }
    let ((_, e), (_, f)) = (two_product(a, b), two_product(c, d));
    e - f
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_and_exponents_agree() {
        for e in [-1022, -300, -1, 0, 1, 52, 1023] {
            assert_eq!(exponent(power_of_two(e)), e);
            assert_eq!(exponent(power_of_two(e) * 1.999), e);
        }
        assert_eq!(exponent(0.0), -1023);
        assert_eq!(exponent(f64::INFINITY), 1024);
        assert_eq!(scale_by(3.0, -1060) * power_of_two(1000) * power_of_two(60), 3.0);
    }

    #[test]
    fn products_and_sums_give_back_what_rounding_took() {
        let (p, e) = two_product(1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
        assert_eq!((p, e), (1.0, -f64::EPSILON * f64::EPSILON));
        assert_eq!(two_sum(1e17, 1.0), (1e17, 1.0));
    }

    #[test]
    fn a_dot_product_survives_cancellation() {
        assert_eq!(dot(DVec3::new(1e17, 1.0, -1e17), DVec3::ONE), 1.0);
    }

    #[test]
    fn remainders_have_the_bits_of_the_operator() {
        let some = [
            0.0,
            1e-310,
            0.1,
            0.5,
            1.0,
            1.5,
            2.0,
            3.0,
            754_877.7,
            1e17,
            2f64.powi(-1022),
            f64::MAX,
            f64::INFINITY,
            f64::NAN,
        ];
        for a in some.into_iter().flat_map(|a| [a, -a]) {
            for b in some.into_iter().flat_map(|b| [b, -b]) {
                let (fast, slow) = (remainder(a, b), a % b);
                assert!(fast.to_bits() == slow.to_bits() || fast.is_nan() && slow.is_nan(), "{a} % {b}");
            }
        }
    }

    #[test]
    fn the_sign_of_a_difference_of_products_is_exact() {
        let a = 1.0 + f64::EPSILON;
        assert!(difference_of_products(a, a, 1.0, 1.0 + 2.0 * f64::EPSILON) > 0.0);
        assert_eq!(difference_of_products(3.0, 5.0, 5.0, 3.0), 0.0);
    }
}
