//! Which instructions code may take that is compiled for several processors. They change no bit of any result, only how long it takes, and
//! a test that compares both needs a processor that keeps to the least.

#[cfg(target_arch = "x86_64")]
pub(crate) mod lanes;

use std::sync::atomic::{AtomicU8, Ordering};

/// What there is, as bits; [`UNKNOWN`] until somebody asks. One number, as every ray asks.
static FOUND: AtomicU8 = AtomicU8::new(UNKNOWN);

const UNKNOWN: u8 = 1;
const AVX2: u8 = 2;
/// AVX2, fused products and the instructions for bits.
const V3: u8 = 4;

/// From now on as if the processor had nothing beyond what all of its kind have.
pub fn keep_to_baseline() {
    FOUND.store(0, Ordering::Relaxed);
}

/// Whether AVX2, FMA, BMI1 and BMI2 are there and may be used: x86-64-v3. Fused products round once: for what no result shows, such as tests of
/// boxes.
#[inline(always)]
pub fn has_v3() -> bool {
    found() & V3 != 0
}

/// Whether AVX2 is there and may be used.
#[inline(always)]
pub fn has_avx2() -> bool {
    found() & AVX2 != 0
}

#[inline(always)]
fn found() -> u8 {
    match FOUND.load(Ordering::Relaxed) {
        UNKNOWN => find(),
        found => found,
    }
}

#[cold]
#[inline(never)]
fn find() -> u8 {
    #[cfg(target_arch = "x86_64")]
    let there = {
        use std::arch::is_x86_feature_detected as has;
        let avx2 = has!("avx2");
        let v3 = avx2 && has!("fma") && has!("bmi1") && has!("bmi2");
        (u8::from(avx2) * AVX2) | (u8::from(v3) * V3)
    };
    #[cfg(not(target_arch = "x86_64"))]
    let there = 0;
    // Whoever was faster has found the same, or has been told to keep to the baseline.
    match FOUND.compare_exchange(UNKNOWN, there, Ordering::Relaxed, Ordering::Relaxed) {
        Ok(_) => there,
        Err(found) => found,
    }
}
