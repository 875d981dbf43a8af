//! The surface with x, y and z in the lanes of an instruction, where the processor has such, and products whose errors are known by one fused
//! operation each: every bit is the same as by plain operations. One of the rooms with unsafe code: there is no other way to such instructions.

use super::{Corners, tangent_of, uv_at, wound};
use crate::math::error::gamma;
use crate::math::vectors::lanes::{load_3, store_4};
use crate::world::shape::Surface;
use glam::DVec3;
use std::arch::x86_64::*;

/// Edges of which every coordinate is 0 or at least this, and at most [`MOST`]: products and their errors, which are at least 2⁻¹⁰⁴ times as large,
/// are numbers without loss, so that splitting and fusing find the same.
const LEAST: f64 = f64::from_bits((1023 - 400) << 52);

/// See [`LEAST`].
const MOST: f64 = f64::from_bits((1023 + 400) << 52);

/// [`super::plain_surface_of`].
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
pub(super) fn surface_of(corners: [&DVec3; 3], data: &Corners<'_>, u: f64, v: f64, bent: bool) -> Surface {
    let weights = [1.0 - u - v, u, v];
    let [wa, wb, wc] = weights.map(|w| _mm256_set1_pd(w));
    let blended = |all: [&DVec3; 3]| {
        let [a, b, c] = all.map(|p| load_3(p.as_ref()));
        let ab = _mm256_add_pd(_mm256_mul_pd(a, wa), _mm256_mul_pd(b, wb));
        _mm256_add_pd(ab, _mm256_mul_pd(c, wc))
    };
    let point = blended(corners);
    let [a, b, c] = corners.map(|p| load_3(p.as_ref()));
    let spread = |p: __m256d, w: __m256d| {
        let off = _mm256_mul_pd(size(_mm256_sub_pd(p, point)), size(w));
        _mm256_add_pd(size(_mm256_mul_pd(p, w)), off)
    };
    let spread_all = _mm256_add_pd(_mm256_add_pd(spread(a, wa), spread(b, wb)), spread(c, wc));
    let error = _mm256_mul_pd(spread_all, _mm256_set1_pd(gamma(8)));
    let wound = match cross(_mm256_sub_pd(b, a), _mm256_sub_pd(c, a)) {
        Some(n) => unit(n),
        None => wound_plainly(corners),
    };
    let (mut geometric_normal, mut normal) = (wound, wound);
    if let Some(normals) = data.normals {
        let [a, b, c] = normals.map(|n| load_3(n.as_ref()));
        let total = _mm256_add_pd(_mm256_add_pd(a, b), c);
        if sum_of_3(_mm256_mul_pd(total, wound)) < 0.0 {
            geometric_normal = _mm256_xor_pd(wound, _mm256_set1_pd(-0.0));
        }
        let blended = blended(normals);
        let per_length = per_length(blended);
        normal = if per_length.is_finite() && per_length > 0.0 {
            _mm256_mul_pd(blended, _mm256_set1_pd(per_length))
        } else {
            geometric_normal
        };
    }
    Surface {
        point: vector(point),
        error: vector(error),
        geometric_normal: vector(geometric_normal),
        normal: vector(normal),
        tangent: if bent { tangent_of(corners.map(|p| *p), data) } else { DVec3::ZERO },
        uv: uv_at(data, weights).into(),
    }
}

#[cold]
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
fn wound_plainly(corners: [&DVec3; 3]) -> __m256d {
    load_3(wound(corners).as_ref())
}

/// e × f as [`normal_of`](super::normal_of) has it; none where that must be asked.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn cross(e: __m256d, f: __m256d) -> Option<__m256d> {
    const YZX: i32 = 0b11_00_10_01;
    const ZXY: i32 = 0b11_01_00_10;
    let (e_yzx, e_zxy) = (_mm256_permute4x64_pd::<YZX>(e), _mm256_permute4x64_pd::<ZXY>(e));
    let (f_yzx, f_zxy) = (_mm256_permute4x64_pd::<YZX>(f), _mm256_permute4x64_pd::<ZXY>(f));
    let (p, q) = (_mm256_mul_pd(e_yzx, f_zxy), _mm256_mul_pd(e_zxy, f_yzx));
    let (of_p, of_q) = (_mm256_fmsub_pd(e_yzx, f_zxy, p), _mm256_fmsub_pd(e_zxy, f_yzx, q));
    let difference = _mm256_sub_pd(p, q);
    // −0 alone takes its sign from the errors, which are zeros then: fused operations have all of them positive.
    let is_zero = _mm256_cmp_pd::<_CMP_EQ_OQ>(difference, _mm256_setzero_pd());
    let is_hard = _mm256_movemask_pd(_mm256_and_pd(is_zero, difference)) != 0;
    let are_usual = _mm256_movemask_pd(_mm256_and_pd(is_usual(e), is_usual(f))) == 0b1111;
    (are_usual && !is_hard).then(|| _mm256_add_pd(difference, _mm256_sub_pd(of_p, of_q)))
}

/// Where a number is 0 or between [`LEAST`] and [`MOST`].
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn is_usual(x: __m256d) -> __m256d {
    let size = size(x);
    let within = _mm256_and_pd(
        _mm256_cmp_pd::<_CMP_GE_OQ>(size, _mm256_set1_pd(LEAST)),
        _mm256_cmp_pd::<_CMP_LE_OQ>(size, _mm256_set1_pd(MOST)),
    );
    _mm256_or_pd(within, _mm256_cmp_pd::<_CMP_EQ_OQ>(x, _mm256_setzero_pd()))
}

/// A finite vector normalised without overflow; y where it is 0.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn unit(v: __m256d) -> __m256d {
    let size = size(v);
    let (xy, z) = (_mm256_castpd256_pd128(size), _mm256_extractf128_pd::<1>(size));
    let largest = _mm_cvtsd_f64(_mm_max_sd(_mm_max_sd(xy, z), _mm_unpackhi_pd(xy, xy)));
    if largest == 0.0 {
        return _mm256_setr_pd(0.0, 1.0, 0.0, 0.0);
    }
    // Its length is 1 to √3.
    let scaled = _mm256_div_pd(v, _mm256_set1_pd(largest));
    _mm256_mul_pd(scaled, _mm256_set1_pd(per_length(scaled)))
}

/// 1 over a vector's length.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn per_length(v: __m256d) -> f64 {
    1.0 / sum_of_3(_mm256_mul_pd(v, v)).sqrt()
}

/// The first two, and the third.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn sum_of_3(v: __m256d) -> f64 {
    let (xy, z) = (_mm256_castpd256_pd128(v), _mm256_extractf128_pd::<1>(v));
    _mm_cvtsd_f64(_mm_add_sd(_mm_add_sd(xy, _mm_unpackhi_pd(xy, xy)), z))
}

#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn size(x: __m256d) -> __m256d {
    _mm256_andnot_pd(_mm256_set1_pd(-0.0), x)
}

#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn vector(v: __m256d) -> DVec3 {
    let [x, y, z, _] = store_4(v);
    DVec3::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::super::{normal_of, plain_surface_of};
    use super::*;
    use crate::math::random::Random;
    use crate::world::shape::Uv;
    use glam::DVec2;

    /// Numbers of one kind: anywhere, on a coarse grid, next to 0 or to what overflows, of all sizes, and a few that are odd.
    fn number(kind: usize, random: &mut Random) -> f64 {
        let x = random.between(-1.0, 1.0);
        let odd = [0.0, -0.0, 5e-324, -1e-310, 1e-160, 1e160, -1e300, LEAST, MOST, 1.0, 1.0 + f64::EPSILON];
        match kind {
            0 => x,
            1 => (3.0 * x).round() / 4.0,
            2 => x * 1e-308,
            3 => x * 1e307,
            4 => x * 2f64.powf(random.between(-1000.0, 1000.0)),
            5 => x * 2f64.powf(random.between(-440.0, -380.0)),
            6 => x * 2f64.powf(random.between(380.0, 440.0)),
            7 => f64::from(x as f32),
            8 => 1.0 + (x * 8.0).round() * f64::EPSILON,
            _ => odd[(random.unit() * odd.len() as f64) as usize],
        }
    }

    fn bits(surface: &Surface) -> Vec<u64> {
        let Surface { point, error, geometric_normal, normal, tangent, uv } = *surface;
        let Uv::At(uv) = uv else { unreachable!("a triangle knows its parameters") };
        let vectors = [point, error, geometric_normal, normal, tangent].map(|v| v.to_array());
        let numbers = vectors.as_flattened().iter().chain(uv.as_ref() as &[f64; 2]).copied();
        // What is not a number has bits that mean nothing.
        numbers.map(|x| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }).collect()
    }

    #[test]
    fn lanes_find_the_same_bits_as_plain_operations() {
        if !crate::math::vectors::has_v3() {
            return;
        }
        let mut random = Random::new(5);
        let mut n_fused = 0;
        for round in 0..60_000 {
            let (kind, other) = (round % 10, if round % 3 == 0 { round / 10 % 10 } else { round % 10 });
            let vector = |random: &mut Random| {
                DVec3::new(number(kind, random), number(kind, random), number(other, random))
            };
            let corners: [DVec3; 3] = std::array::from_fn(|_| vector(&mut random));
            let normals: [DVec3; 3] = std::array::from_fn(|_| vector(&mut random));
            let uvs: [DVec2; 3] = std::array::from_fn(|_| vector(&mut random).truncate());
            let data = Corners {
                normals: (round % 2 == 0).then(|| normals.each_ref()),
                uvs: (round % 5 == 0).then(|| uvs.each_ref()),
            };
            let u = random.unit();
            let (u, v) = if round % 7 == 0 { (0.0, 1.0) } else { (u, (1.0 - u) * random.unit()) };
            let plain = plain_surface_of(corners.each_ref(), &data, u, v, true);
            // SAFETY: the processor has just been found to have what the functions are compiled for.
            #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
            let (wide, fused) = unsafe {
                let [a, b, c] = corners.each_ref().map(|p| load_3(p.as_ref()));
                let fused = cross(_mm256_sub_pd(b, a), _mm256_sub_pd(c, a));
                (surface_of(corners.each_ref(), &data, u, v, true), fused.map(|n| store_4(n)))
            };
            assert_eq!(bits(&wide), bits(&plain), "round {round}: {corners:?} {data:?} {u} {v}");
            if let Some([x, y, z, _]) = fused {
                let plain = normal_of(corners).to_array();
                assert_eq!(
                    [x, y, z].map(f64::to_bits),
                    plain.map(f64::to_bits),
                    "round {round}: {corners:?}"
                );
                n_fused += 1;
            }
        }
        assert!((20_000..50_000).contains(&n_fused), "{n_fused}");
    }
}
