//! The transfer function of sRGB (IEC 61966-2-1), both ways. Primaries stay: linear RGB here has sRGB's.

use super::elementary::powf;

/// Linear light 0 … 1 of an sRGB-encoded component 0 … 1. Odd beyond: −decode(−x) below 0; above 1 the curve goes on.
pub fn srgb_decode(encoded: f64) -> f64 {
    let x = encoded.abs();
    let linear = if x <= 0.040_45 { x / 12.92 } else { powf((x + 0.055) / 1.055, 2.4) };
    linear.copysign(encoded)
}

/// The sRGB-encoded component of linear light; the inverse of [`srgb_decode`].
pub fn srgb_encode(linear: f64) -> f64 {
    let x = linear.abs();
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * powf(x, 1.0 / 2.4) - 0.055 };
    encoded.copysign(linear)
}

/// Luminance of linear RGB: Rec. 709 weights. A grey's is the grey itself, to the last bit.
pub fn luminance(rgb: glam::DVec3) -> f64 {
    if rgb.x == rgb.y && rgb.y == rgb.z { rgb.x } else { rgb.dot(glam::DVec3::new(0.2126, 0.7152, 0.0722)) }
}

/// The mean of the three components: how much light there is, where the eye does not matter.
#[inline]
pub fn mean(rgb: glam::DVec3) -> f64 {
    rgb.element_sum() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoding_undoes_decoding() {
        for i in 0..=255 {
            let x = f64::from(i) / 255.0;
            assert!((srgb_encode(srgb_decode(x)) - x).abs() < 1e-6, "{x}");
        }
        assert_eq!((srgb_decode(0.0), srgb_decode(1.0)), (0.0, 1.0));
        assert!((srgb_decode(0.5) - 0.214_041_140_482_232_55).abs() < 1e-15);
    }

    #[test]
    fn the_luminance_of_a_grey_is_the_grey() {
        assert_eq!(luminance(glam::DVec3::splat(0.1)), 0.1);
        assert!((luminance(glam::DVec3::ONE) - 1.0).abs() < 1e-15);
    }
}
