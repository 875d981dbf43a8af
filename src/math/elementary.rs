//! Transcendental functions with the same bits on every machine: pure Rust ports of musl's, within 1 ulp.
//! The standard library's go to the platform's C library, whose last bits differ between versions and processors.

pub use libm::{
    acos, asin, atan, atan2, cbrt, cos, cosh, exp, exp2, hypot, log as ln, log2, log10, pow as powf, sin,
    sinh, tan, tanh,
};

/// Sine and cosine of `x` radians.
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
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
    fn quarter_turns_are_exact() {
        assert_eq!(sin_cos_degrees(90.0), (1.0, 0.0));
        assert_eq!(sin_cos_degrees(-450.0), (-1.0, 0.0));
        assert_eq!(sin_cos_degrees(180.0), (0.0, -1.0));
        let (s, c) = sin_cos_degrees(30.0);
        assert!((s - 0.5).abs() < 1e-15 && (c - 0.75f64.sqrt()).abs() < 1e-15);
    }
}
