//! Transcendental functions with the same bits on every machine: pure Rust ports of musl's, within 1 ulp.
//! The standard library's go to the platform's C library, whose last bits differ between versions and processors.

pub use libm::{
    acos, asin, atan, atan2, cbrt, cos, cosh, exp, exp2, hypot, log as ln, log2, log10, pow as powf, sin,
    sinh, tan, tanh,
};

use std::f64::consts::TAU;

/// Sine and cosine of `x` radians.
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Sine and cosine of a part of a full turn, 0 … 1, to one unit in the last place; exact at quarters. By the polynomials of fdlibm's
/// kernels (Sun Microsystems, 1993) on an eighth of a turn, without a branch: which quarter it is is chance where directions are.
#[inline]
pub fn sin_cos_turns(turns: f64) -> (f64, f64) {
    let quarter = (4.0 * turns + 0.5) as u64;
    let x = (turns - quarter as f64 / 4.0) * TAU;
    let z = x * x;
    let sine = z
        * (-1.984_126_982_985_795e-4
            + z * (2.755_731_370_707_006_8e-6
                + z * (-2.505_076_025_340_686_3e-8 + z * 1.589_690_995_211_55e-10)));
    let sine = x + x * z * (-0.166_666_666_666_666_32 + z * (8.333_333_333_322_49e-3 + sine));
    let cosine = z
        * (2.480_158_728_947_673e-5
            + z * (-2.755_731_435_139_066_3e-7
                + z * (2.087_572_321_298_175e-9 + z * -1.135_964_755_778_819_5e-11)));
    let cosine =
        1.0 - (z / 2.0 - z * z * (4.166_666_666_666_66e-2 + z * (-1.388_888_888_887_411e-3 + cosine)));
    let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
    let swap = (sine ^ cosine) & (quarter & 1).wrapping_neg();
    let sign = |quarter: u64| (quarter >> 1 & 1) << 63;
    (f64::from_bits(sine ^ swap ^ sign(quarter)), f64::from_bits(cosine ^ swap ^ sign(quarter + 1)))
}

/// Integer power by repeated squaring; exact while the result fits 53 bits.
pub fn powi(x: f64, n: i32) -> f64 {
    let mut base = if n < 0 { 1.0 / x } else { x };
    let (mut n, mut result) = (n.unsigned_abs(), 1.0);
    while n > 0 {
        if n & 1 == 1 {
            result *= base;
        }
        base *= base;
        n >>= 1;
    }
    result
}

/// Sine and cosine of an angle in degrees; exact at multiples of 90°, so that `rotate y*90` maps axes to axes.
pub fn sin_cos_degrees(angle: f64) -> (f64, f64) {
    let turns = angle % 360.0;
    let quadrant = (turns / 90.0).round();
    let (s, c) = sin_cos((turns - 90.0 * quadrant).to_radians());
    match (quadrant as i64).rem_euclid(4) {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_turn_are_those_of_the_angle() {
        for i in 0..=4096 {
            let turns = f64::from(i) / 4096.0 + if i % 2 == 0 { 0.0 } else { 1.0 / 12289.0 };
            let ((s, c), (sine, cosine)) = (sin_cos_turns(turns), sin_cos(TAU * turns));
            assert!((s - sine).abs() < 1e-15 && (c - cosine).abs() < 1e-15, "{turns}: {s} {c}");
            assert!((s * s + c * c - 1.0).abs() < 5e-16, "{turns}");
        }
        let quarters = [0.0, 0.25, 0.5, 0.75, 1.0].map(sin_cos_turns);
        assert_eq!(quarters, [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0)]);
    }

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(sin_cos_degrees(90.0), (1.0, 0.0));
        assert_eq!(sin_cos_degrees(-450.0), (-1.0, 0.0));
        assert_eq!(sin_cos_degrees(180.0), (0.0, -1.0));
        let (s, c) = sin_cos_degrees(30.0);
        assert!((s - 0.5).abs() < 1e-15 && (c - 0.75f64.sqrt()).abs() < 1e-15);
    }
}
