//! The sum of a cubic's powers, compiled for what the processor has: only how many coordinates one instruction takes differs, not one
//! operation or its order, so that every value is the same to the last bit on all of them. Knows nothing of what the sum is for. One of
//! the rooms with unsafe code: there is no other way to such instructions.

use crate::math::point::Lanes;
use crate::math::{Dd, Point};

/// [`super::nested`] with the widest instructions that there are for as many coordinates; none where that is not finite.
#[inline(always)]
pub(super) fn nested<P: Point>(coefficients: &[Dd<P::Lanes>; 4], s: Dd) -> Option<P> {
    #[cfg(target_arch = "x86_64")]
    if let Some(four) = (coefficients as &dyn std::any::Any).downcast_ref()
        && crate::math::vectors::has_avx2()
    {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe { x86::nested_avx(four, s) }.map(|sums| P::from_coordinates(|axis| sums[axis]));
    }
    plain(coefficients, s)
}

fn plain<P: Point>(coefficients: &[Dd<P::Lanes>; 4], s: Dd) -> Option<P> {
    let sums = super::nested(coefficients, s);
    Some(P::from_coordinates(|axis| sums.lane(axis))).filter(|point| point.is_finite())
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use crate::math::dd::{Dd, Factor};
    use crate::math::vectors::lanes::{load_4, store_4};
    use std::arch::x86_64::*;

    /// s in every place of a register, and its halves.
    struct Spread {
        hi: __m256d,
        lo: __m256d,
        high: __m256d,
        low: __m256d,
    }

    /// What is finite has no difference from itself.
    #[target_feature(enable = "avx")]
    pub(super) fn nested_avx(coefficients: &[Dd<[f64; 4]>; 4], s: Dd) -> Option<[f64; 4]> {
        let (high, low) = Factor::new(s.hi).halves();
        let [hi, lo, high, low] = [s.hi, s.lo, high, low].map(|x| _mm256_set1_pd(x));
        let s = Spread { hi, lo, high, low };
        let [c0, c1, c2, c3] = coefficients;
        let sum = (load_4(&c3.hi), load_4(&c3.lo));
        let (hi, lo) = step(step(step(sum, c2, &s), c1, &s), c0, &s);
        let sums = _mm256_add_pd(hi, lo);
        let same = _mm256_cmp_pd::<_CMP_EQ_OQ>(_mm256_sub_pd(sums, sums), _mm256_setzero_pd());
        (_mm256_movemask_pd(same) == 0b1111).then(|| store_4(sums))
    }

    /// `super::super::step` on four coordinates, with [`Factor::times`] and [`crate::math::dd::two_sum`] written out.
    #[target_feature(enable = "avx")]
    #[inline]
    fn step((hi, lo): (__m256d, __m256d), c: &Dd<[f64; 4]>, s: &Spread) -> (__m256d, __m256d) {
        let high = _mm256_and_pd(hi, _mm256_castsi256_pd(_mm256_set1_epi64x(!((1 << 26) - 1))));
        let low = _mm256_sub_pd(hi, high);
        let p = _mm256_mul_pd(hi, s.hi);
        let rest = _mm256_sub_pd(p, _mm256_mul_pd(high, s.high));
        let rest = _mm256_sub_pd(rest, _mm256_mul_pd(low, s.high));
        let rest = _mm256_sub_pd(rest, _mm256_mul_pd(high, s.low));
        let product_error = _mm256_sub_pd(_mm256_mul_pd(low, s.low), rest);
        let b = load_4(&c.hi);
        let sum = _mm256_add_pd(p, b);
        let bb = _mm256_sub_pd(sum, p);
        let sum_error = _mm256_add_pd(_mm256_sub_pd(p, _mm256_sub_pd(sum, bb)), _mm256_sub_pd(b, bb));
        let carried = _mm256_add_pd(_mm256_mul_pd(lo, s.hi), _mm256_mul_pd(hi, s.lo));
        let errors = _mm256_add_pd(_mm256_add_pd(product_error, sum_error), load_4(&c.lo));
        (sum, _mm256_add_pd(carried, errors))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::exp2;
    use crate::math::random::Random;
    use glam::DVec3;

    #[test]
    fn wide_instructions_give_the_bits_of_plain_ones() {
        let mut random = Random::new(11);
        for case in 0..20_000 {
            // Some too large to split.
            let span = if case % 20 == 0 { 1023.0 } else { 60.0 };
            let mut number =
                || random.sign() * (0.5 + 0.5 * random.unit()) * exp2(random.between(-span, span));
            let mut point = || [number(), number(), number(), 0.0];
            let coefficients = [point(), point(), point(), point()]
                .map(|hi| Dd { hi, lo: hi.map(|x| x * f64::EPSILON * 0.3) });
            let hi = 0.5 * random.unit();
            let s = Dd { hi, lo: hi * f64::EPSILON * random.between(-0.5, 0.5) };
            let bits = |point: Option<DVec3>| point.map(|p| p.to_array().map(f64::to_bits));
            let (wide, narrow) = (nested(&coefficients, s), plain(&coefficients, s));
            assert_eq!(bits(wide), bits(narrow), "case {case}: {coefficients:?} at {s:?}");
        }
    }
}
