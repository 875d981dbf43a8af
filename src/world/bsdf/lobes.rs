//! Lobes with a width: Phong's, Blinn's, and the microfacets of GGX. Values are BRDFs (1/sr) or densities; cosines are
//! clamped, so that nothing is lit from behind and no power of a negative number is taken.

use crate::math::elementary::{powf, powi, sin_cos_turns};
use crate::scene::Lobe;
use crate::world::light::{frame, to_frame};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// The specular lobe for k_s = 1: (q + 2)/2π cos^q of the angle between `wi` and the mirror image of `wo` (Phong), or
/// (q + 8)/8π cos^q of the angle between n and the half vector (Blinn).
pub fn specular(lobe: Lobe, q: f64, n: DVec3, wo: DVec3, wi: DVec3) -> f64 {
    let (cosine, norm) = match lobe {
        Lobe::Phong => (super::fresnel::reflect(wo, n).dot(wi), (q + 2.0) / TAU),
        Lobe::Blinn => (n.dot((wo + wi).normalize_or_zero()), (q + 8.0) / (8.0 * PI)),
    };
    if cosine > 0.0 { norm * power(cosine.min(1.0), q) } else { 0.0 }
}

/// A direction chosen by u in (0, 1)² in proportion to cos^q: of the angle to the mirror image of `wo` (Phong), or of that
/// between n and the half vector (Blinn). It may lie below the surface.
pub fn choose_specular(lobe: Lobe, q: f64, n: DVec3, wo: DVec3, u: DVec2) -> DVec3 {
    let cosine = powf(u.x, 1.0 / (q + 1.0));
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let (s, c) = sin_cos_turns(u.y);
    let local = DVec3::new(sine * c, sine * s, cosine);
    match lobe {
        Lobe::Phong => to_frame(super::fresnel::reflect(wo, n), local),
        Lobe::Blinn => super::fresnel::reflect(wo, to_frame(n, local)),
    }
}

/// Density per solid angle of [`choose_specular`].
pub fn specular_density(lobe: Lobe, q: f64, n: DVec3, wo: DVec3, wi: DVec3) -> f64 {
    let (cosine, spread) = match lobe {
        Lobe::Phong => (super::fresnel::reflect(wo, n).dot(wi), 1.0),
        Lobe::Blinn => {
            let half = (wo + wi).normalize_or_zero();
            (n.dot(half), 4.0 * wo.dot(half))
        }
    };
    if cosine > 0.0 && spread > 0.0 { (q + 1.0) / TAU * power(cosine.min(1.0), q) / spread } else { 0.0 }
}

/// Exponents above this are no longer taken for whole numbers; nobody writes them.
const MOST_WHOLE: f64 = 65536.0;

/// A cosine to the power q. Whole exponents, as nearly all are, by repeated squares: q roundings are no more than the cosine's own
/// rounding comes to after the power.
fn power(cosine: f64, q: f64) -> f64 {
    if q <= MOST_WHOLE && q == q.trunc() { powi(cosine, q as i32) } else { powf(cosine, q) }
}

/// Microfacets of the GGX distribution (Trowbridge & Reitz) with height-correlated Smith shadowing, about a unit normal.
#[derive(Clone, Copy, Debug)]
pub struct Ggx {
    /// Unit normal of the surface.
    pub n: DVec3,
    /// Roughness α > 0.
    pub alpha: f64,
}

impl Ggx {
    /// Density of facets with the unit normal h, per solid angle and projected area.
    pub fn density(self, h: DVec3) -> f64 {
        let c2 = h.dot(self.n) * h.dot(self.n);
        let a2 = self.alpha * self.alpha;
        let d = c2 * a2 + (1.0 - c2).max(0.0);
        a2 / (PI * d * d)
    }

    /// Smith's Λ: how much of what faces `w` is hidden. `cosine` > 0 is that of w to the normal.
    fn lambda(self, cosine: f64) -> f64 {
        let c2 = cosine * cosine;
        let tan2 = (1.0 - c2).max(0.0) / c2;
        (((1.0 + self.alpha * self.alpha * tan2).sqrt() - 1.0) / 2.0).min(f64::MAX)
    }

    /// D·G/(4 cos cos): the reflecting lobe without its Fresnel share. 0 where either direction lies below the surface.
    pub fn lobe(self, wo: DVec3, wi: DVec3) -> f64 {
        let (co, ci) = (wo.dot(self.n), wi.dot(self.n));
        let h = (wo + wi).normalize_or_zero();
        if !(co > 0.0 && ci > 0.0) || h == DVec3::ZERO {
            return 0.0;
        }
        self.density(h) / (4.0 * co * ci * (1.0 + self.lambda(co) + self.lambda(ci)))
    }

    /// The normal of a facet that `wo` sees, chosen in proportion to how much of it is seen. Dupuy & Benyoub, *Sampling
    /// Visible GGX Normals with Spherical Caps* (2023).
    pub fn visible_normal(self, wo: DVec3, u: DVec2) -> DVec3 {
        let (s, t) = frame(self.n);
        let stretched =
            DVec3::new(self.alpha * wo.dot(s), self.alpha * wo.dot(t), wo.dot(self.n)).normalize();
        let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = sin_cos_turns(u.x);
        let h = DVec3::new(r * cos, r * sin, z) + stretched;
        to_frame(self.n, DVec3::new(self.alpha * h.x, self.alpha * h.y, h.z.max(0.0)).normalize_or(DVec3::Z))
    }

    /// Density per solid angle with which a visible facet mirrors `wo` to `wi`.
    pub fn mirrored_density(self, wo: DVec3, wi: DVec3) -> f64 {
        let (co, ci) = (wo.dot(self.n), wi.dot(self.n));
        let h = (wo + wi).normalize_or_zero();
        if !(co > 0.0 && ci > 0.0) || h == DVec3::ZERO {
            return 0.0;
        }
        self.density(h) / (4.0 * co * (1.0 + self.lambda(co)))
    }

    /// The normal of the facet that bends `wo` to `wi` beyond it, for an index η ≠ 1 of the far side over the near one.
    pub fn bending(self, wo: DVec3, wi: DVec3, eta: f64) -> DVec3 {
        let h = (wo + wi * eta).normalize_or_zero();
        if h.dot(self.n) < 0.0 { -h } else { h }
    }

    /// Density per solid angle with which a visible facet bends `wo` to `wi`. 0 where none can.
    pub fn bent_density(self, wo: DVec3, wi: DVec3, eta: f64) -> f64 {
        let h = self.bending(wo, wi, eta);
        let (near, far) = (wo.dot(h), wi.dot(h));
        let co = wo.dot(self.n);
        if !(co > 0.0 && near > 0.0 && far < 0.0) {
            return 0.0;
        }
        let spread = near + eta * far;
        let seen = self.density(h) * near / (co * (1.0 + self.lambda(co)));
        seen * (eta * eta * -far) / (spread * spread)
    }

    /// What a ray mirrored or bent by a visible facet still carries: G₂/G₁, given the cosines of the two directions.
    pub fn carried(self, cos_o: f64, cos_i: f64) -> f64 {
        if !(cos_o > 0.0 && cos_i > 0.0) {
            return 0.0;
        }
        let (o, i) = (self.lambda(cos_o), self.lambda(cos_i));
        (1.0 + o) / (1.0 + o + i)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::even::grid;
    use crate::world::light::cosine_hemisphere;

    /// ∫ f(wi) cos over the hemisphere about z, by a grid of cosine-weighted directions.
    fn albedo(f: impl Fn(DVec3) -> f64) -> f64 {
        let n = 1000;
        let sum: f64 = grid(n).map(|u| f(cosine_hemisphere(u)) * PI).sum();
        sum / f64::from(n * n)
    }

    fn tilted(cosine: f64) -> DVec3 {
        DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
    }

    #[test]
    fn phong_is_one_at_normal_incidence_and_never_more() {
        for q in [1.0, 5.0, 50.0] {
            let at = |c| albedo(|wi| specular(Lobe::Phong, q, DVec3::Z, tilted(c), wi));
            assert!((at(1.0) - 1.0).abs() < 1e-3, "q = {q}: {}", at(1.0));
            assert!(at(0.5) <= 1.001 && at(0.1) <= 1.001);
        }
    }

    #[test]
    fn highlights_stay_on_the_lit_side_and_finite() {
        let wo = tilted(0.3);
        let behind = -super::super::fresnel::reflect(wo, DVec3::Z);
        assert_eq!(specular(Lobe::Phong, 2.0, DVec3::Z, wo, behind), 0.0);
        assert_eq!(specular(Lobe::Phong, 2.5, DVec3::Z, wo, behind), 0.0);
        assert_eq!(specular(Lobe::Blinn, 2.5, DVec3::Z, DVec3::Z, -DVec3::Z), 0.0);
    }

    #[test]
    fn blinn_needs_four_times_phongs_exponent() {
        // Half maximum in the plane of incidence: 9.518° for Phong 50, 9.535° for Blinn 200.
        for (lobe, q, degrees) in [(Lobe::Phong, 50.0, 9.518), (Lobe::Blinn, 200.0, 9.535)] {
            let at = |a: f64| {
                let (s, c) = crate::math::elementary::sin_cos_degrees(a);
                specular(lobe, q, DVec3::Z, DVec3::Z, DVec3::new(s, 0.0, c))
            };
            assert!((at(degrees) / at(0.0) - 0.5).abs() < 1e-4);
        }
    }

    #[test]
    fn facets_project_to_the_surface_they_stand_on() {
        for alpha in [0.3, 0.6, 1.0] {
            let ggx = Ggx { n: DVec3::Z, alpha };
            assert!((albedo(|h| ggx.density(h)) - 1.0).abs() < 2e-3, "α = {alpha}");
        }
    }

    #[test]
    fn chosen_facets_carry_what_the_lobe_reflects() {
        let ggx = Ggx { n: DVec3::Z, alpha: 0.5 };
        for c in [1.0, 0.6, 0.2] {
            let wo = tilted(c);
            let n = 300;
            let mut sum = 0.0;
            for u in grid(n) {
                let h = ggx.visible_normal(wo, u);
                let wi = super::super::fresnel::reflect(wo, h);
                sum += ggx.carried(wo.z, wi.z);
            }
            let (chosen, integrated) = (sum / f64::from(n * n), albedo(|wi| ggx.lobe(wo, wi)));
            assert!((chosen - integrated).abs() < 3e-3, "cos {c}: {chosen} and {integrated}");
            assert!(chosen <= 1.0);
        }
    }
}
