//! How a smooth boundary divides light: Fresnel's equations, Schlick's approximation, Snell's law. Directions leave the
//! surface; η is the index beyond the boundary over the index on the side that the direction is on.

use crate::math::exact::sum_of_products;
use crate::scene::Rgb;
use glam::DVec3;

/// The mirror image of `wo` about the unit normal n: both leave the surface.
pub fn reflect(wo: DVec3, n: DVec3) -> DVec3 {
    n * (2.0 * wo.dot(n)) - wo
}

/// The direction that leaves the surface on the other side when light comes from `wo` on n's side, by Snell's law; none where
/// all is reflected. Unit for unit arguments.
pub fn refract(wo: DVec3, n: DVec3, eta: f64) -> Option<DVec3> {
    let cos_o = wo.dot(n);
    let cos_t = cos_beyond(cos_o, eta)?;
    Some((n * (cos_o / eta - cos_t) - wo / eta).normalize())
}

/// sin² within this of 1 is near enough to the critical angle for its rounding to show in the cosine, by more than 3 bits.
const NEAR_CRITICAL: f64 = 1.0 / 64.0;

/// Cosine of the angle beyond the boundary, for one of cosine `cos_o` ≥ 0 before it; none from the critical angle on.
/// sin² is (1 − c)(1 + c), so that grazing angles keep their digits; near the critical angle η² − 1 + c² is summed in twice the
/// working precision, so that the angle itself is certain.
pub fn cos_beyond(cos_o: f64, eta: f64) -> Option<f64> {
    let sin2 = ((1.0 - cos_o) * (1.0 + cos_o)).max(0.0) / (eta * eta);
    if (sin2 - 1.0).abs() < NEAR_CRITICAL {
        let above = sum_of_products([(eta, eta), (cos_o, cos_o), (-1.0, 1.0)]);
        return (above > 0.0).then(|| above.sqrt() / eta);
    }
    (sin2 < 1.0).then(|| (1.0 - sin2).sqrt())
}

/// Share of unpolarised light that a dielectric boundary reflects. `cos_o` in 0 … 1. 1 from the critical angle on.
pub fn dielectric(cos_o: f64, eta: f64) -> f64 {
    if eta == 1.0 {
        return 0.0;
    }
    let Some(cos_t) = cos_beyond(cos_o, eta) else { return 1.0 };
    let ratio = |a: f64, b: f64| if a + b > 0.0 { (a - b) / (a + b) } else { 1.0 };
    let (s, p) = (ratio(cos_o, eta * cos_t), ratio(eta * cos_o, cos_t));
    (s * s + p * p) / 2.0
}

/// Schlick's approximation of [`dielectric`]: from the denser side by the angle beyond the boundary, as it must be.
pub fn dielectric_schlick(cos_o: f64, eta: f64) -> f64 {
    let r0 = ((1.0 - eta) / (1.0 + eta)) * ((1.0 - eta) / (1.0 + eta));
    let c = if eta < 1.0 { cos_beyond(cos_o, eta) } else { Some(cos_o) };
    c.map_or(1.0, |c| r0 + (1.0 - r0) * pow5(1.0 - c))
}

/// Schlick's approximation from a colour at normal incidence.
pub fn schlick(r0: Rgb, cos_o: f64) -> Rgb {
    r0 + (Rgb::ONE - r0) * pow5(1.0 - cos_o)
}

/// Fresnel's equations from a colour at normal incidence, each channel by the index that gives it: n = (1 + √r₀)/(1 − √r₀).
pub fn dielectric_of(r0: Rgb, cos_o: f64) -> Rgb {
    let channel = |r0: f64| {
        let root = r0.clamp(0.0, 1.0).sqrt();
        if root < 1.0 { dielectric(cos_o, (1.0 + root) / (1.0 - root)) } else { r0 }
    };
    Rgb::new(channel(r0.x), channel(r0.y), channel(r0.z))
}

/// The mean of [`schlick`] over all directions by their cosines.
pub fn mean_of_schlick(r0: Rgb) -> Rgb {
    r0 + (Rgb::ONE - r0) / 21.0
}

/// The mean of [`dielectric`] over all directions by their cosines, from the rarer side, within 0.01: Kulla & Conty's fit (2017).
pub fn mean_of_dielectric(eta: f64) -> f64 {
    (eta - 1.0) / (4.085_67 + 1.000_71 * eta)
}

/// The same of [`dielectric_of`].
pub fn mean_of_dielectric_of(r0: Rgb) -> Rgb {
    let channel = |r0: f64| {
        let root = r0.clamp(0.0, 1.0).sqrt();
        let eta = (1.0 + root) / (1.0 - root).max(f64::MIN_POSITIVE);
        if eta < MOST_ETA { mean_of_dielectric(eta) } else { r0 }
    };
    Rgb::new(channel(r0.x), channel(r0.y), channel(r0.z))
}

/// Up to this index the fit was made; beyond it nearly all is reflected at any angle.
const MOST_ETA: f64 = 400.0;

fn pow5(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    (x * x) * (x * x) * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::sin_cos_degrees;

    #[test]
    fn light_bends_to_the_other_side_of_the_normal() {
        let travel = DVec3::new(1.0, -1.0, 0.0).normalize();
        let t = refract(-travel, DVec3::Y, 1.5).unwrap();
        let exact = DVec3::new(0.5f64.sqrt() / 1.5, -(1.0 - 0.5 / 2.25f64).sqrt(), 0.0);
        assert!((t - exact).length() < 1e-15);
        assert!((t - DVec3::new(0.471405, -0.881917, 0.0)).length() < 1e-6);
    }

    #[test]
    fn reflection_stays_above_the_surface() {
        let r = reflect(DVec3::new(-0.6, 0.8, 0.0), DVec3::Y);
        assert!((r - DVec3::new(0.6, 0.8, 0.0)).length() < 1e-15);
    }

    #[test]
    fn beyond_the_critical_angle_all_is_reflected() {
        let c = 0.5f64.sqrt();
        assert_eq!(refract(DVec3::new(c, c, 0.0), DVec3::Y, 1.0 / 1.5), None);
        assert_eq!(dielectric(c, 1.0 / 1.5), 1.0);
        assert_eq!(dielectric_schlick(c, 1.0 / 1.5), 1.0);
    }

    #[test]
    fn reflectances_are_those_of_the_tables() {
        for (degrees, r, tolerance) in [
            (0.0, 0.04, 1e-15),
            (30.0, 0.041523, 5e-7),
            (45.0, 0.050240, 5e-7),
            (60.0, 0.089187, 5e-7),
            (75.0, 0.253061, 5e-7),
            (85.0, 0.612800, 5e-7),
            (89.0, 0.904185, 5e-7),
            (56.309932, 0.073964, 5e-7),
        ] {
            let found = dielectric(sin_cos_degrees(degrees).1, 1.5);
            assert!((found - r).abs() < tolerance, "{degrees}°: {found}");
        }
        for (degrees, r) in [(41.80, 0.890772), (41.81, 0.979855), (41.82, 1.0)] {
            let found = dielectric(sin_cos_degrees(degrees).1, 1.0 / 1.5);
            assert!((found - r).abs() < 5e-7, "{degrees}° inside: {found}");
        }
        assert!((dielectric(1.0, 1.333) - 0.020373).abs() < 5e-7);
    }

    #[test]
    fn the_critical_angle_is_certain_and_its_neighbourhood_keeps_its_digits() {
        // η = 3/5 makes the critical cosine 4/5; both rounded, so the truth is that of the rounded numbers.
        let eta = 0.6;
        for k in 1..200 {
            let c = 0.8 + f64::from(k) * 0.8f64.next_up().rem_euclid(0.8);
            let above = sum_of_products([(eta, eta), (c, c), (-1.0, 1.0)]);
            let beyond = cos_beyond(c, eta).unwrap();
            assert!((beyond * eta / above.sqrt() - 1.0).abs() <= 4.0 * f64::EPSILON, "{k}: {beyond}");
        }
        let seam = |sin2: f64| (1.0 - sin2 * 0.36f64).sqrt();
        for sin2 in [1.0 - NEAR_CRITICAL, 1.0 - 2.0 * NEAR_CRITICAL, 0.999] {
            let found = cos_beyond(seam(sin2), eta).unwrap();
            assert!((found * found - (1.0 - sin2)).abs() < 4e-16, "{sin2}: {found}");
        }
    }

    #[test]
    fn schlick_leaving_a_denser_medium_rises_to_one() {
        let inside = dielectric_schlick(sin_cos_degrees(41.8).1, 1.0 / 1.5);
        assert!(inside > 0.8, "{inside}: by the angle inside it would be 0.041");
        let worst = (0..=9000)
            .map(|i| sin_cos_degrees(f64::from(i) / 100.0).1.max(0.0))
            .map(|c| (dielectric_schlick(c, 1.5) - dielectric(c, 1.5)).abs())
            .fold(0.0, f64::max);
        assert!((worst - 0.0357).abs() < 1e-4, "{worst}");
    }

    #[test]
    fn around_the_critical_angle_nothing_is_nan_and_nothing_jumps() {
        let critical = (1.0 - 1.0 / 2.25f64).sqrt();
        let mut before = None;
        for i in -200..=200 {
            let c = critical + f64::from(i) * 1e-14;
            let r = dielectric(c, 1.0 / 1.5);
            assert!((0.9999..=1.0).contains(&r), "{r} at {i}");
            assert!(before.is_none_or(|b: f64| (r - b).abs() < 5e-6));
            before = Some(r);
        }
    }

    #[test]
    fn no_boundary_reflects_nothing_even_at_grazing_angles() {
        assert_eq!(dielectric(0.0, 1.0), 0.0);
        assert_eq!(dielectric(0.0, 1.5), 1.0);
    }

    #[test]
    fn means_over_all_directions_are_those_integrals() {
        let n = 4000;
        let cosines = || (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n));
        let mean = |f: &dyn Fn(f64) -> f64| cosines().map(|c| 2.0 * c * f(c)).sum::<f64>() / f64::from(n);
        for r0 in [0.02, 0.04, 0.2, 0.5, 0.9, 0.98, 1.0] {
            let r = Rgb::splat(r0);
            let (exact, fit) = (mean(&|c| dielectric_of(r, c).x), mean_of_dielectric_of(r).x);
            assert!((exact - fit).abs() < 0.01, "{r0}: {exact} and {fit}");
            assert!((mean(&|c| schlick(r, c).x) - mean_of_schlick(r).x).abs() < 1e-6);
        }
    }

    #[test]
    fn an_index_found_from_a_share_gives_it_back() {
        let r0 = Rgb::new(0.04, 0.5, 1.0);
        assert!((dielectric_of(r0, 1.0) - r0).abs().max_element() < 1e-15);
        assert!((dielectric_of(Rgb::splat(0.04), 0.5).x - dielectric(0.5, 1.5)).abs() < 1e-14);
    }
}
