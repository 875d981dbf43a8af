//! Chance at a surface: a direction chosen about as often as light is sent on from there, how often that is, and all that
//! is sent on. Smooth mirrors and smooth boundaries have one direction each and no density; everything else is a lobe.
//!
//! A direction from any lobe is weighed by all lobes together (Veach & Guibas, *Optimally Combining Sampling Techniques*,
//! 1995, §3.4), so that a lobe that was chosen seldom cannot make a sample large.

use super::fresnel::{reflect, refract};
use super::{Bsdf, Mirror, lobes};
use crate::math::colour::mean;
use crate::scene::Rgb;
use crate::world::light::{cosine_hemisphere, to_frame};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// Where a path goes on from a surface.
#[derive(Clone, Copy, Debug)]
pub struct Bounce {
    /// Unit vector away from the surface.
    pub direction: DVec3,
    /// Radiance from there times this, on average over the choice, is what the surface sends to `wo`.
    pub weight: Rgb,
    /// Density of the choice per solid angle; none where chance cannot find the direction again.
    pub density: Option<f64>,
    /// True where the path goes through the surface.
    pub through: bool,
}

/// How often each way of going on is chosen. They sum to 1, or all are 0.
#[derive(Clone, Copy, Debug)]
pub struct Odds {
    /// Of a direction by its cosine.
    diffuse: f64,
    specular: f64,
    /// Of the mirror; of a facet where light is let through a rough boundary, which then mirrors or bends.
    mirror: f64,
    /// Through what is smooth.
    through: f64,
    /// Of a direction beyond the surface, by its cosine.
    beyond: f64,
}

impl Odds {
    /// Whether one way is chosen always.
    pub fn are_certain(&self) -> bool {
        [self.diffuse, self.specular, self.mirror, self.through, self.beyond].contains(&1.0)
    }
}

impl Bsdf {
    /// True where light is sent on from more directions than one: where lights need to be asked.
    #[inline]
    pub fn has_lobes(&self) -> bool {
        self.has_base() || self.is_glossy() || self.is_frosted()
    }

    /// All that is sent to `wo` of the irradiance from `wi`, per steradian, smooth mirrors and boundaries left out.
    pub fn sent(&self, wi: DVec3) -> Rgb {
        if wi.dot(self.geometric) > 0.0 { self.sent_on(wi) } else { self.frosted(wi) }
    }

    /// The share of what [`Bsdf::sent`] sends that is not by the matt part, for each colour.
    pub fn beside_matt(&self, wi: DVec3) -> Rgb {
        if wi.dot(self.geometric) <= 0.0 {
            return Rgb::ONE;
        }
        if self.specular == Rgb::ZERO && !self.is_glossy() {
            return Rgb::ZERO;
        }
        let (sent, matt) = (self.sent(wi), self.matt() * (self.lit(wi) / PI));
        let share = |sent: f64, matt: f64| if sent > matt { (sent - matt) / sent } else { 0.0 };
        Rgb::new(share(sent.x, matt.x), share(sent.y, matt.y), share(sent.z, matt.z))
    }

    /// A way on: which lobe by these odds and `choice` in (0, 1), where in it by u in (0, 1)². None where nothing is sent on from there.
    pub fn bounce(&self, odds: Odds, choice: f64, u: DVec2) -> Option<Bounce> {
        let Odds { diffuse, specular, mirror, .. } = odds;
        let (direction, above) = if choice < diffuse {
            (to_frame(self.normal, cosine_hemisphere(u)), true)
        } else if choice < diffuse + specular {
            (lobes::choose_specular(self.lobe, self.exponent, self.normal, self.wo, u), true)
        } else if choice < diffuse + specular + mirror {
            match self.is_glossy() {
                true => self.by_facet((choice - diffuse - specular) / mirror, u)?,
                false => return self.smooth(self.mirrored(u)?, odds.mirror, false),
            }
        } else if choice < diffuse + specular + mirror + odds.beyond {
            (to_frame(-self.normal, cosine_hemisphere(u)), false)
        } else if odds.through > 0.0 {
            return self.smooth(self.transmitted(u)?, odds.through, true);
        } else {
            return None;
        };
        // A lobe has no density on the other side, though it may point there; the lobe of that side is not this one.
        if (direction.dot(self.normal) > 0.0) != above {
            return None;
        }
        let density = self.density(odds, direction);
        let weight = match self.is_matt() {
            // The density is the cosine's, and so is what is sent.
            true => self.diffuse * (self.lit(direction) / direction.dot(self.normal)),
            false => self.sent(direction) / density,
        };
        let through = direction.dot(self.geometric) < 0.0;
        let useful = density > 0.0 && weight.is_finite() && weight != Rgb::ZERO;
        useful.then_some(Bounce { direction, weight, density: Some(density), through })
    }

    /// The way that a facet chosen by u sends `wo`, and whether it mirrors it; by `choice` where it may let it through.
    fn by_facet(&self, choice: f64, u: DVec2) -> Option<(DVec3, bool)> {
        let facet = self.ggx().visible_normal(self.wo, u);
        if !self.is_frosted() || choice < self.mirrors(facet) {
            return Some((reflect(self.wo, facet), true));
        }
        Some((refract(self.wo, facet, self.eta())?, false))
    }

    /// How often a facet of a rough boundary mirrors: by its own share, since that of the whole surface is another beyond the critical angle.
    fn mirrors(&self, facet: DVec3) -> f64 {
        let share = self.mirror_share(self.wo.dot(facet).clamp(0.0, 1.0));
        let (mirrored, through) = (mean(share), mean((Rgb::ONE - share) * self.transmit));
        if mirrored > 0.0 { mirrored / (mirrored + through) } else { 0.0 }
    }

    /// What is sent on along a bounce of light that arrives along `wo`: light followed the other way, as power. The base is shaded by
    /// the mirror's share toward who sees it, so the two ways differ; and since radiance is not scaled by the squared index, power
    /// is where it goes through: by the near index over the far one, squared.
    pub fn forwarded(&self, bounce: &Bounce) -> Rgb {
        let Some(density) = bounce.density else {
            let eta = if bounce.through { self.eta() } else { 1.0 };
            return bounce.weight / (eta * eta);
        };
        let seen = self.seen_from(bounce.direction);
        let cosine = bounce.direction.dot(seen.normal).max(0.0);
        seen.sent(self.wo) * (cosine / self.wo.dot(self.normal) / density)
    }

    /// The same surface as it is seen along another direction, of this side or the other.
    fn seen_from(&self, wo: DVec3) -> Bsdf {
        let beyond = wo.dot(self.geometric) < 0.0;
        let side = if beyond { -1.0 } else { 1.0 };
        let (normal, geometric) = (self.normal * side, self.geometric * side);
        Bsdf { wo, normal, geometric, outside: self.outside != beyond, ..*self }
    }

    fn smooth(&self, way: super::Scattered, odds: f64, through: bool) -> Option<Bounce> {
        Some(Bounce { direction: way.direction, weight: way.weight / odds, density: None, through })
    }

    /// Whether the matt part is all there is of it.
    #[inline]
    fn is_matt(&self) -> bool {
        let nothing_else = || {
            matches!(self.mirror, Mirror::None) && self.specular == Rgb::ZERO && self.transmit == Rgb::ZERO
        };
        (self.plain || nothing_else()) && self.diffuse != Rgb::ZERO
    }

    /// By what each would send on if light came evenly from everywhere. Asked once a surface: they take the mirror's share.
    pub fn odds(&self) -> Odds {
        if self.is_matt() {
            return Odds { diffuse: 1.0, specular: 0.0, mirror: 0.0, through: 0.0, beyond: 0.0 };
        }
        let share = match self.mirror {
            Mirror::None => Rgb::ZERO,
            _ => self.mirror_share(self.wo.dot(self.normal)),
        };
        let rest = Rgb::ONE - share;
        let [d, s, m, t] =
            [mean(rest * self.diffuse), mean(rest * self.specular), mean(share), mean(rest * self.transmit)];
        // What bounces between facets leaves nearly as from a matt surface, and is chosen with it.
        let further = mean(self.rebounced());
        let beyond = self
            .rough_glass()
            .map_or(0.0, |glass| mean(self.transmit * glass.let_through(self.wo.dot(self.normal))));
        let sum = d + s + m + t + further + beyond;
        let of = |part: f64| if sum > 0.0 { part / sum } else { 0.0 };
        let (m, t) = if self.is_frosted() { (m + t, 0.0) } else { (m, t) };
        Odds { diffuse: of(d + further), specular: of(s), mirror: of(m), through: of(t), beyond: of(beyond) }
    }

    /// Density per solid angle with which [`Bsdf::bounce`] goes on along `wi`, smooth mirrors and boundaries left out.
    pub fn density(&self, odds: Odds, wi: DVec3) -> f64 {
        let cosine = wi.dot(self.normal);
        let by_facets = match odds.mirror > 0.0 && self.is_glossy() {
            true => odds.mirror * self.facet_density(wi),
            false => 0.0,
        };
        if cosine <= 0.0 {
            return by_facets + odds.beyond * -cosine * FRAC_1_PI;
        }
        let mut density = odds.diffuse * cosine * FRAC_1_PI;
        if odds.specular > 0.0 {
            density +=
                odds.specular * lobes::specular_density(self.lobe, self.exponent, self.normal, self.wo, wi);
        }
        density + by_facets
    }

    /// Density with which [`Bsdf::by_facet`] comes to `wi`.
    fn facet_density(&self, wi: DVec3) -> f64 {
        let ggx = self.ggx();
        if wi.dot(self.normal) <= 0.0 {
            let bent = self.frosted_density(wi);
            let bends = || 1.0 - self.mirrors(ggx.bending(self.wo, wi, self.eta()));
            return if bent > 0.0 { bent * bends() } else { 0.0 };
        }
        let mirrored = ggx.mirrored_density(self.wo, wi);
        match self.is_frosted() {
            true => mirrored * self.mirrors((self.wo + wi).normalize_or(self.normal)),
            false => mirrored,
        }
    }

    /// True where light goes through a rough boundary, which spreads it. One that does not bend does not spread either.
    pub fn is_frosted(&self) -> bool {
        self.is_transmissive() && self.roughness > 0.0 && self.ior != 1.0
    }

    /// What is sent through a rough boundary, times the cosine (Walter et al., *Microfacet Models for Refraction through Rough
    /// Surfaces*, 2007), with what bounces several times between its facets. As everywhere here, radiance is not scaled by the squared index: it is once it leaves again.
    fn frosted(&self, wi: DVec3) -> Rgb {
        let (cos_o, cos_i) = (self.wo.dot(self.normal), -wi.dot(self.normal));
        if !self.is_frosted() || cos_i <= 0.0 || wi.dot(self.geometric) >= 0.0 {
            return Rgb::ZERO;
        }
        let further = self.rough_glass().map_or(Rgb::ZERO, |glass| glass.through(cos_o, cos_i) * cos_i);
        let density = self.frosted_density(wi);
        if density <= 0.0 {
            return self.transmit * further;
        }
        let ggx = self.ggx();
        let facet = ggx.bending(self.wo, wi, self.eta());
        let rest = Rgb::ONE - self.mirror_share(self.wo.dot(facet));
        self.transmit * (rest * (ggx.carried(cos_o, cos_i) * density) + further)
    }

    fn frosted_density(&self, wi: DVec3) -> f64 {
        let beyond = wi.dot(self.geometric) < 0.0 && wi.dot(self.normal) < 0.0;
        if beyond && self.is_frosted() { self.ggx().bent_density(self.wo, wi, self.eta()) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Fresnel, Lobe};
    use crate::world::even::{grid, over_all_directions};

    fn seen_at(cosine: f64) -> Bsdf {
        Bsdf { wo: DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine), ..Bsdf::BARE }
    }

    fn materials(cosine: f64) -> Vec<(&'static str, Bsdf)> {
        let bare = || seen_at(cosine);
        let grey = Rgb::splat(0.5);
        let glass = |outside| Bsdf {
            transmit: Rgb::ONE,
            ior: 1.5,
            roughness: 0.3,
            outside,
            mirror: Mirror::Boundary(Rgb::ZERO, Fresnel::Exact),
            ..bare()
        };
        let glossy = |lobe| Bsdf { diffuse: grey, specular: grey, exponent: 12.0, lobe, ..bare() };
        vec![
            ("diffuse", Bsdf { diffuse: grey, ..bare() }),
            ("phong", glossy(Lobe::Phong)),
            ("blinn", glossy(Lobe::Blinn)),
            ("metal", Bsdf { mirror: Mirror::Schlick(grey), roughness: 0.4, ..bare() }),
            ("rough metal", Bsdf { mirror: Mirror::Schlick(grey), roughness: 1.0, ..bare() }),
            ("rough share", Bsdf { diffuse: grey, mirror: Mirror::Exact(grey), roughness: 0.7, ..bare() }),
            ("coated", Bsdf { diffuse: grey, mirror: Mirror::Constant(grey), roughness: 0.2, ..bare() }),
            ("frosted", glass(true)),
            ("frosted from within", glass(false)),
        ]
    }

    /// The mean over all choices of what a bounce gives.
    fn over_all_choices(bsdf: &Bsdf, f: impl Fn(&Bounce) -> f64) -> f64 {
        let (lobes, n) = (200, 60);
        let choices = (0..lobes).map(|i| (f64::from(i) + 0.5) / f64::from(lobes));
        let sum: f64 = choices
            .flat_map(|choice| grid(n).map(move |u| (choice, u)))
            .filter_map(|(choice, u)| bsdf.bounce(bsdf.odds(), choice, u))
            .map(|bounce| f(&bounce))
            .sum();
        sum / f64::from(lobes * n * n)
    }

    #[test]
    fn bounces_carry_what_the_lobes_send() {
        for cosine in [0.95, 0.5] {
            for (name, bsdf) in materials(cosine) {
                let sent = over_all_directions(1000, |wi| bsdf.sent(wi).x);
                let carried = over_all_choices(&bsdf, |bounce| bounce.weight.x);
                assert!((sent - carried).abs() < 4e-3, "{name}, {cosine}: {sent} sent, {carried} carried");
                // The tables of rough surfaces are within that.
                assert!(carried <= 1.0 + 5e-3, "{name}: {carried}");
            }
        }
    }

    #[test]
    fn a_rough_mirror_that_reflects_all_sends_all_on() {
        for alpha in [0.05, 0.08, 0.15, 0.3, 0.5, 0.75, 1.0] {
            for cosine in [1.0, 0.7, 0.3, 0.1, 0.03] {
                let white = Bsdf { mirror: Mirror::Constant(Rgb::ONE), roughness: alpha, ..seen_at(cosine) };
                // Narrow lobes slip through a grid of directions.
                if alpha >= 0.3 {
                    let sent = over_all_directions(1000, |wi| white.sent(wi).x);
                    assert!((sent - 1.0).abs() < 0.005, "α {alpha}, cos {cosine}: {sent}");
                }
                let n = 256;
                let met = grid(n).filter_map(|u| white.mirrored(u)).map(|s| s.weight.x).sum::<f64>();
                let met = met / f64::from(n * n);
                assert!((met - 1.0).abs() < 0.005, "α {alpha}, cos {cosine}: {met} by one ray");
            }
        }
    }

    #[test]
    fn a_rough_metal_sends_the_same_both_ways() {
        let metal =
            |wo| Bsdf { wo, mirror: Mirror::Schlick(Rgb::new(0.9, 0.6, 0.2)), roughness: 0.6, ..Bsdf::BARE };
        for u in grid(7) {
            let (a, b) = (cosine_hemisphere(u), cosine_hemisphere(DVec2::new(u.y, 1.0 - u.x)));
            let (there, back) = (metal(a).gloss(b) / b.z, metal(b).gloss(a) / a.z);
            assert!((there - back).abs().max_element() <= 1e-13 * there.max_element(), "{there} and {back}");
        }
    }

    #[test]
    fn lobes_send_the_same_both_ways_and_glass_but_for_the_squared_index() {
        // All but those whose base is shaded by the mirror's share toward who sees it.
        for (name, bsdf) in
            materials(0.6).into_iter().filter(|(name, _)| !["rough share", "coated"].contains(name))
        {
            let above = grid(9).map(cosine_hemisphere);
            for wi in above.flat_map(|up| [up, up * DVec3::new(1.0, 1.0, -1.0)]) {
                let (there, back) =
                    (bsdf.sent(wi) / wi.z.abs(), bsdf.seen_from(wi).sent(bsdf.wo) / bsdf.wo.z);
                let eta = if wi.z < 0.0 { bsdf.eta() } else { 1.0 };
                let off = (there - back * (eta * eta)).abs().max_element();
                assert!(off <= 1e-9 * there.max_element(), "{name}, {wi}: {there} and {back}, η {eta}");
            }
        }
    }

    #[test]
    fn light_followed_forward_carries_what_it_carries_back() {
        let matt_glass = Bsdf { diffuse: Rgb::splat(0.3), ..materials(0.7).remove(7).1 };
        for bsdf in materials(0.7).into_iter().map(|(_, bsdf)| bsdf).chain([matt_glass]) {
            // Power that arrives along `wo`, and is sent on: by the lobes as they are seen from where it goes.
            let forwarded = over_all_choices(&bsdf, |bounce| bsdf.forwarded(bounce).x);
            let seen =
                over_all_directions(1000, |to| bsdf.seen_from(to).sent(bsdf.wo).x * to.z.abs() / bsdf.wo.z);
            assert!((forwarded - seen).abs() < 5e-3, "{bsdf:?}: {forwarded} and {seen}");
        }
    }

    #[test]
    fn densities_are_those_of_the_choice() {
        // Any function of the direction has the same mean by choosing and by the density.
        let probe = |w: DVec3| 1.0 + w.x + w.z * w.z + w.y * w.y * w.x;
        for (name, bsdf) in materials(0.6) {
            let by_density = over_all_directions(1000, |wi| match bsdf.sent(wi).x > 0.0 {
                true => bsdf.density(bsdf.odds(), wi) * probe(wi),
                false => 0.0,
            });
            let by_choice = over_all_choices(&bsdf, |bounce| probe(bounce.direction));
            assert!((by_density - by_choice).abs() < 8e-3, "{name}: {by_density} and {by_choice}");
        }
    }

    #[test]
    fn smooth_ways_have_no_density_and_lose_nothing() {
        let glass = Bsdf {
            transmit: Rgb::ONE,
            ior: 1.5,
            mirror: Mirror::Boundary(Rgb::ZERO, Fresnel::Exact),
            ..seen_at(0.7)
        };
        let (mut through, n) = (0, 1000);
        for i in 0..n {
            let bounce =
                glass.bounce(glass.odds(), (f64::from(i) + 0.5) / f64::from(n), DVec2::splat(0.5)).unwrap();
            assert!(bounce.density.is_none() && (bounce.weight.x - 1.0).abs() < 1e-12);
            through += i32::from(bounce.through);
        }
        let share = super::super::fresnel::dielectric(0.7, 1.5);
        assert!((f64::from(through) / f64::from(n) - (1.0 - share)).abs() < 2e-3);
        assert_eq!(glass.sent(DVec3::Z), Rgb::ZERO);
    }
}
