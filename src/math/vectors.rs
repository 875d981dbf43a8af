//! Which instructions code may take that is compiled for several processors. They change no bit of any result, only how long it takes, and
//! a test that compares both needs a processor that keeps to the least.

#[cfg(target_arch = "x86_64")]
pub(crate) mod lanes;

use std::sync::atomic::{AtomicBool, Ordering};

static BASELINE_ONLY: AtomicBool = AtomicBool::new(false);

/// From now on as if the processor had nothing beyond what all of its kind have.
pub fn keep_to_baseline() {
    BASELINE_ONLY.store(true, Ordering::Relaxed);
}

/// Whether AVX2 and fused products are there and may be used. Fused products round once: for what no result shows, such as tests of boxes.
#[inline(always)]
pub fn has_avx2_and_fma() -> bool {
    #[cfg(target_arch = "x86_64")]
    return has_avx2() && std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    false
}

/// Whether AVX2 is there and may be used.
#[inline(always)]
pub fn has_avx2() -> bool {
    #[cfg(target_arch = "x86_64")]
    return !BASELINE_ONLY.load(Ordering::Relaxed) && std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    false
}
