//! Numbers from memory into a vector register and back. There is no safe way between the two, so it is here and nowhere else.

use std::arch::x86_64::*;

/// Four numbers in a register.
#[target_feature(enable = "avx")]
#[inline]
#[allow(unsafe_code, reason = "a vector register has no safe way from memory")]
pub fn load_4(lanes: &[f64; 4]) -> __m256d {
    // SAFETY: four numbers are read from an array of four; no alignment is asked for.
    unsafe { _mm256_loadu_pd(lanes.as_ptr()) }
}

/// Four numbers of a register.
#[target_feature(enable = "avx")]
#[inline]
#[allow(unsafe_code, reason = "a vector register has no safe way to memory")]
pub fn store_4(vector: __m256d) -> [f64; 4] {
    let mut lanes = [0.0; 4];
    // SAFETY: four numbers are written to an array of four; no alignment is asked for.
    unsafe { _mm256_storeu_pd(lanes.as_mut_ptr(), vector) };
    lanes
}

/// Three numbers in a register, and 0.
#[target_feature(enable = "avx")]
#[inline]
#[allow(unsafe_code, reason = "a vector register has no safe way from memory")]
pub fn load_3(lanes: &[f64; 3]) -> __m256d {
    let three = _mm256_setr_epi64x(-1, -1, -1, 0);
    // SAFETY: three numbers are read from an array of three, as the fourth is masked out; no alignment is asked for.
    unsafe { _mm256_maskload_pd(lanes.as_ptr(), three) }
}

/// Four numbers of single precision in a register of double.
#[target_feature(enable = "avx")]
#[inline]
#[allow(unsafe_code, reason = "a vector register has no safe way from memory")]
pub fn widen_4(lanes: &[f32; 4]) -> __m256d {
    // SAFETY: four floats are read from an array of four; no alignment is asked for.
    _mm256_cvtps_pd(unsafe { _mm_loadu_ps(lanes.as_ptr()) })
}

/// Eight numbers as single precision, rounded to the nearest, in a register.
#[target_feature(enable = "avx")]
#[inline]
pub fn narrow_8(lanes: &[f64; 8]) -> __m256 {
    let (fours, _) = lanes.as_chunks::<4>();
    _mm256_set_m128(_mm256_cvtpd_ps(load_4(&fours[1])), _mm256_cvtpd_ps(load_4(&fours[0])))
}

/// Eight numbers of single precision in a register.
#[target_feature(enable = "avx")]
#[inline]
#[allow(unsafe_code, reason = "a vector register has no safe way from memory")]
pub fn load_8(lanes: &[f32; 8]) -> __m256 {
    // SAFETY: eight floats are read from an array of eight; no alignment is asked for.
    unsafe { _mm256_loadu_ps(lanes.as_ptr()) }
}

/// Eight numbers of single precision of a register.
#[target_feature(enable = "avx")]
#[inline]
#[allow(unsafe_code, reason = "a vector register has no safe way to memory")]
pub fn store_8(vector: __m256) -> [f32; 8] {
    let mut lanes = [0.0; 8];
    // SAFETY: eight floats are written to an array of eight; no alignment is asked for.
    unsafe { _mm256_storeu_ps(lanes.as_mut_ptr(), vector) };
    lanes
}
