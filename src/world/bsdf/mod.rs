//! A material at a point, seen from a side: plain numbers, and the share of light it sends from one direction to another.
//! Knows nothing of lights, of shadows or of who asks.
//!
//! The meaning, one for all tracers: with mirror share r(θ), light is sent on by (1 − r)·base + r·mirror, where the base is
//! diffuse ρ/π, a specular lobe and what is let through. `wo` and `wi` leave the surface. Surfaces shade on both sides.

mod coat;
mod energy;
pub mod fresnel;
pub mod lobes;
mod normal;
mod scatter;

use super::hit::Hit;
use super::light::{cosine_hemisphere, to_frame};
use super::texture::{self, Sampled, TexturePoint};
use super::{Ray, World};
use crate::scene::{Fresnel, Lobe, Material, Rgb};
pub use coat::Coat;
use coat::Same;
use energy::{Glass, Losses, Lost};
use fresnel::{reflect, refract};
use glam::{DVec2, DVec3};
use lobes::Ggx;
pub use scatter::{Bounce, Odds};
use std::f64::consts::FRAC_1_PI;
use std::mem::MaybeUninit;

/// A material at a hit, seen along `wo`.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    /// Unit vector to where it is seen from.
    pub wo: DVec3,
    /// Unit geometric normal on the side of `wo`.
    pub geometric: DVec3,
    /// Unit shading normal on the side of `wo`, and with a positive cosine to it.
    pub normal: DVec3,
    /// True where `wo` lies on the side that the surface's own normal leaves.
    pub outside: bool,
    /// True where its material is known to have a matt base alone: all else is as of [`Bsdf::BARE`], and need not be looked at.
    plain: bool,
    /// Share of the surface that is there.
    pub opacity: f64,
    /// Radiance sent out on the normal's side.
    pub emit: Rgb,
    /// Radiance that raycast and whitted add.
    pub ambient: Rgb,
    /// Absorption per unit length inside.
    pub absorb: Rgb,
    /// Index inside over outside.
    ior: f64,
    diffuse: Rgb,
    specular: Rgb,
    exponent: f64,
    lobe: Lobe,
    transmit: Rgb,
    roughness: f64,
    mirror: Mirror,
    /// Of rough glass that is the same everywhere.
    losses: Option<&'static Losses>,
}

/// Where a material may be [put](Bsdf::put).
pub type Slot = MaybeUninit<Bsdf>;

/// How the mirror share goes with the angle.
#[derive(Clone, Copy, Debug)]
enum Mirror {
    /// No mirror at all.
    None,
    /// The same at every angle.
    Constant(Rgb),
    /// From a share or colour at normal incidence, by Schlick.
    Schlick(Rgb),
    /// From a share at normal incidence, by Fresnel's equations.
    Exact(Rgb),
    /// The boundary of what lets light through: silvered by a share, the rest by the law for its index.
    Boundary(Rgb, Fresnel),
}

/// From where a surface is seen: what its material has no part in.
struct Sight {
    wo: DVec3,
    outside: bool,
    geometric: DVec3,
    normal: DVec3,
}

impl Sight {
    #[inline(always)]
    fn new(hit: &Hit<'_>, ray: &Ray) -> Sight {
        let wo = -ray.direction;
        let outside = wo.dot(hit.geometric_normal) >= 0.0;
        let side = if outside { 1.0 } else { -1.0 };
        let geometric = hit.geometric_normal * side;
        Sight { wo, outside, geometric, normal: normal::facing(hit.normal * side, geometric, wo) }
    }
}

/// Facets that differ by less than this from one another differ by less than a unit vector's roundings, squared: a smooth mirror.
const SMOOTH: f64 = 1.0 / (1u64 << 26) as f64;

/// A direction in which light goes on, and the share of it that does.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// Unit vector away from the surface.
    pub direction: DVec3,
    /// Radiance that comes from there times this is sent to `wo`.
    pub weight: Rgb,
}

impl Bsdf {
    /// The material where a ray met it. The world is only asked where a bump map needs its neighbourhood.
    pub fn at(world: &World, hit: &Hit<'_>, ray: &Ray) -> Sampled<Bsdf> {
        Bsdf::put(&mut Slot::uninit(), world, hit, ray).copied()
    }

    /// The same in a slot, to be looked at there: a copy of so much just written waits for the writes.
    #[inline(always)]
    pub fn put<'p>(slot: &'p mut Slot, world: &World, hit: &Hit<'_>, ray: &Ray) -> Sampled<&'p Bsdf> {
        if let Some(fault) = hit.fault {
            return Err(fault);
        }
        let sight = Sight::new(hit, ray);
        Ok(match &hit.coat.same {
            // Most surfaces: what they do not do is written, not copied.
            Same::Matt(albedo) => {
                slot.write(Bsdf { diffuse: *albedo, plain: true, ..Bsdf::BARE.seen(&sight) })
            }
            Same::All(same) => slot.write(same.seen(&sight)),
            Same::No => {
                let bsdf = slot.write(Bsdf::BARE.seen(&sight));
                bsdf.read(world, hit, ray)?;
                bsdf
            }
        })
    }

    /// The same as it is seen from elsewhere.
    #[inline(always)]
    fn seen(&self, sight: &Sight) -> Bsdf {
        let Sight { wo, outside, geometric, normal } = *sight;
        Bsdf { wo, outside, geometric, normal, ..*self }
    }

    /// What the patterns and maps of its material say there.
    fn read(&mut self, world: &World, hit: &Hit<'_>, ray: &Ray) -> Sampled<()> {
        let at = TexturePoint::from(hit);
        self.add(&hit.coat.material, &at)?;
        self.bend_normal(world, hit, ray, &at)
    }

    /// Reflects nothing.
    pub const BARE: Bsdf = Bsdf {
        wo: DVec3::Z,
        geometric: DVec3::Z,
        normal: DVec3::Z,
        outside: true,
        plain: false,
        opacity: 1.0,
        emit: Rgb::ZERO,
        ambient: Rgb::ZERO,
        absorb: Rgb::ZERO,
        ior: 1.0,
        diffuse: Rgb::ZERO,
        specular: Rgb::ZERO,
        exponent: 1.0,
        lobe: Lobe::Blinn,
        transmit: Rgb::ZERO,
        roughness: 0.0,
        mirror: Mirror::None,
        losses: None,
    };

    /// What a material is made of, beside its normal.
    fn add(&mut self, material: &Material, at: &TexturePoint<'_>) -> Sampled<()> {
        let colour = |t| texture::colour(t, at);
        self.diffuse = colour(&material.diffuse)?;
        self.plain = material.layers.is_none();
        let Some(layers) = material.layers.as_deref() else { return Ok(()) };
        let number = |t| texture::number(t, at);
        self.opacity = texture::opacity(&layers.opacity, at)?;
        self.emit = colour(&layers.emit)?;
        self.ambient = colour(&layers.ambient)?;
        self.specular = colour(&layers.specular)?;
        if self.specular != Rgb::ZERO {
            self.exponent = number(&layers.exponent)?;
            self.lobe = layers.lobe;
        }
        self.transmit = colour(&layers.transmit)?;
        if self.transmit != Rgb::ZERO {
            self.ior = number(&layers.ior)?;
            self.absorb = colour(&layers.absorb)?;
        }
        self.mirror = mirror(colour(&layers.metal)?, self.transmit, colour(&layers.reflect)?, layers.fresnel);
        if !matches!(self.mirror, Mirror::None) {
            self.roughness = number(&layers.roughness)?.max(0.0);
            if self.roughness < SMOOTH {
                self.roughness = 0.0;
            }
        }
        Ok(())
    }

    fn bend_normal(&mut self, world: &World, hit: &Hit<'_>, ray: &Ray, at: &TexturePoint<'_>) -> Sampled<()> {
        if let Some(n) = normal::bent(world, hit, ray, at)? {
            let side = if self.outside { 1.0 } else { -1.0 };
            self.normal = normal::facing(n * side, self.geometric, self.wo);
        }
        Ok(())
    }

    /// Radiance that the surface sends out to `wo`: on its normal's side, and inward too from a closed solid.
    #[inline]
    pub fn emitted(&self, world: &World, hit: &Hit<'_>) -> Rgb {
        if self.plain || self.emit == Rgb::ZERO || self.outside || world.emits_inward(hit.primitive) {
            self.emit
        } else {
            Rgb::ZERO
        }
    }

    /// Share of light from all around that is sent on to `wo`, mirrored and let through included; linear RGB, exact for a diffuse base and a
    /// smooth mirror, and to the width of their lobes for the others.
    pub fn albedo(&self) -> Rgb {
        let base = self.diffuse + self.specular + self.transmit;
        let mirrored = self.mirror_share(self.wo.dot(self.normal));
        (Rgb::ONE - mirrored) * base + mirrored
    }

    /// True where light that comes from somewhere in particular is sent on: where lights need to be asked at all.
    #[inline]
    pub fn has_base(&self) -> bool {
        self.diffuse != Rgb::ZERO || (!self.plain && self.specular != Rgb::ZERO)
    }

    /// True where a ray goes on, mirrored or through the surface.
    #[inline]
    pub fn goes_on(&self) -> bool {
        !self.plain && (self.is_transmissive() || !matches!(self.mirror, Mirror::None))
    }

    /// True where the mirror is a lobe with a width.
    #[inline]
    pub fn is_glossy(&self) -> bool {
        !self.plain && self.roughness > 0.0 && !matches!(self.mirror, Mirror::None)
    }

    /// The base times the cosine of `wi` to the normal: what is sent on of the irradiance from `wi`, per steradian. 0 from
    /// below either normal; what the difference of the two would cut off at once fades out (Chiang, Li & Burley, *Taming the
    /// Shadow Terminator*, 2019).
    #[inline]
    pub fn base(&self, wi: DVec3) -> Rgb {
        let lit = self.lit(wi);
        if lit <= 0.0 {
            return Rgb::ZERO;
        }
        let mut sent = self.diffuse * FRAC_1_PI;
        if self.plain {
            return sent * lit;
        }
        if self.specular != Rgb::ZERO {
            sent += self.specular * lobes::specular(self.lobe, self.exponent, self.normal, self.wo, wi);
        }
        match self.mirror {
            Mirror::None => sent * lit,
            _ => (Rgb::ONE - self.mirror_share(self.wo.dot(self.normal))) * sent * lit,
        }
    }

    /// The base and the mirror as a lobe together, both times the cosine.
    #[inline]
    pub fn sent_on(&self, wi: DVec3) -> Rgb {
        let base = self.base(wi);
        if self.is_glossy() { base + self.gloss(wi) } else { base }
    }

    /// The mirror as a lobe, times the cosine, with what bounces several times between its facets; 0 where it is smooth and so has no
    /// width.
    pub fn gloss(&self, wi: DVec3) -> Rgb {
        let lit = if self.is_glossy() { self.lit(wi) } else { 0.0 };
        if lit <= 0.0 {
            return Rgb::ZERO;
        }
        let half = (self.wo + wi).normalize_or(self.normal);
        let first = self.mirror_share(self.wo.dot(half)) * self.ggx().lobe(self.wo, wi);
        let (cos_o, cos_i) = (self.wo.dot(self.normal), wi.dot(self.normal));
        let further = match self.rough_glass() {
            Some(glass) => glass.back(cos_o, cos_i),
            None => {
                self.facets_mean().map_or(Rgb::ZERO, |mean| Lost::by(self.roughness).lobe(mean, cos_o, cos_i))
            }
        };
        (first + further) * lit
    }

    /// What bounces several times between facets that let light through; none where there are none. Without Fresnel's equations or Schlick's
    /// approximation of them it is lost.
    fn rough_glass(&self) -> Option<Glass> {
        match self.mirror {
            Mirror::Boundary(silver, Fresnel::Exact | Fresnel::Schlick) if self.is_frosted() => {
                Some(Glass::new(self.roughness, self.eta(), silver, self.losses))
            }
            _ => None,
        }
    }

    /// With sums of its own of what rough glass loses, for a material that is the same everywhere.
    fn with_losses(self) -> Bsdf {
        let losses = match self.mirror {
            Mirror::Boundary(_, law) if self.rough_glass().is_some() => {
                Some(Losses::of(self.roughness, self.ior, law))
            }
            _ => None,
        };
        Bsdf { losses, ..self }
    }

    /// The share that facets of an opaque mirror reflect on average over all directions. None where light is let through.
    fn facets_mean(&self) -> Option<Rgb> {
        match self.mirror {
            Mirror::None | Mirror::Boundary(..) => None,
            Mirror::Constant(r) => Some(r),
            Mirror::Schlick(r0) => Some(fresnel::mean_of_schlick(r0)),
            Mirror::Exact(r0) => Some(fresnel::mean_of_dielectric_of(r0)),
        }
    }

    /// Share of light from all around that is sent to `wo` by bouncing several times between facets.
    fn rebounced(&self) -> Rgb {
        if !self.is_glossy() {
            return Rgb::ZERO;
        }
        let cosine = self.wo.dot(self.normal);
        if let Some(glass) = self.rough_glass() {
            return glass.sent_back(cosine);
        }
        self.facets_mean().map_or(Rgb::ZERO, |mean| {
            let lost = Lost::by(self.roughness);
            lost.share(mean) * lost.at(cosine)
        })
    }

    /// The mirrored direction and its share. A rough mirror's is chosen by u, in (0, 1)²; what bounces several times between its facets is
    /// taken to come from there too.
    pub fn mirrored(&self, u: DVec2) -> Option<Scattered> {
        if matches!(self.mirror, Mirror::None) {
            return None;
        }
        let (facet, rough) = self.facet(u);
        let weight = self.mirror_share(self.wo.dot(facet).clamp(0.0, 1.0));
        let reflected = reflect(self.wo, facet);
        let direction = normal::onto_side(reflected, self.geometric);
        let weight = match rough {
            true => {
                let carried = self.ggx().carried(self.wo.dot(self.normal), reflected.dot(self.normal));
                weight * carried + self.rebounced()
            }
            false => weight,
        };
        (weight != Rgb::ZERO).then_some(Scattered { direction, weight })
    }

    /// The direction beyond the surface and the share let through; a rough boundary's is chosen by u, and what bounces several times between
    /// its facets is taken to come from there too. None where nothing is let through, or all is reflected.
    pub fn transmitted(&self, u: DVec2) -> Option<Scattered> {
        if self.transmit == Rgb::ZERO {
            return None;
        }
        // One that does not bend light does not spread it.
        let (facet, rough) = if self.is_frosted() { self.facet(u) } else { (self.normal, false) };
        let further =
            self.rough_glass().map_or(Rgb::ZERO, |glass| glass.let_through(self.wo.dot(self.normal)));
        let Some(bent) = refract(self.wo, facet, self.eta()) else {
            // What bounces several times goes through all the same.
            let direction = normal::onto_side(to_frame(-self.normal, cosine_hemisphere(u)), -self.geometric);
            let weight = self.transmit * further;
            return (weight != Rgb::ZERO).then_some(Scattered { direction, weight });
        };
        let share = Rgb::ONE - self.mirror_share(self.wo.dot(facet).clamp(0.0, 1.0));
        let direction = normal::onto_side(bent, -self.geometric);
        let carried = if rough {
            self.ggx().carried(self.wo.dot(self.normal), -direction.dot(self.normal))
        } else {
            1.0
        };
        let weight = self.transmit * (share * carried + further);
        (weight != Rgb::ZERO).then_some(Scattered { direction, weight })
    }

    /// Share of light that goes straight on, as if the surface did not bend it: what a shadow ray keeps.
    pub fn straight_through(&self) -> Rgb {
        let beyond = if self.transmit == Rgb::ZERO {
            Rgb::ZERO
        } else {
            (Rgb::ONE - self.mirror_share(self.wo.dot(self.normal))) * self.transmit
        };
        Rgb::splat(1.0 - self.opacity) + self.opacity * beyond
    }

    /// True where light is let through the surface, and not only past it.
    #[inline]
    pub fn is_transmissive(&self) -> bool {
        !self.plain && self.transmit != Rgb::ZERO
    }

    /// Index beyond the surface over the index on the side of `wo`.
    fn eta(&self) -> f64 {
        if self.outside { self.ior } else { 1.0 / self.ior }
    }

    fn ggx(&self) -> Ggx {
        Ggx { n: self.normal, alpha: self.roughness }
    }

    /// The normal that mirrors or bends: the shading normal, or that of a facet seen from `wo`.
    fn facet(&self, u: DVec2) -> (DVec3, bool) {
        if self.roughness > 0.0 {
            (self.ggx().visible_normal(self.wo, u), true)
        } else {
            (self.normal, false)
        }
    }

    /// What the matt part of the base sends on of light that comes evenly: π times its radiance per irradiance, whatever `wi` is.
    pub fn matt(&self) -> Rgb {
        match self.mirror {
            Mirror::None => self.diffuse,
            _ if self.diffuse == Rgb::ZERO => Rgb::ZERO,
            _ => (Rgb::ONE - self.mirror_share(self.wo.dot(self.normal))) * self.diffuse,
        }
    }

    /// The cosine of `wi` to the shading normal, faded out toward the geometric horizon where the two normals differ. 0 from below
    /// either.
    #[inline]
    pub fn lit(&self, wi: DVec3) -> f64 {
        let (above, cosine) = (wi.dot(self.geometric), wi.dot(self.normal));
        if !(above > 0.0 && cosine > 0.0) {
            return 0.0;
        }
        if self.normal == self.geometric {
            return cosine;
        }
        let g = (above / (cosine * self.normal.dot(self.geometric))).clamp(0.0, 1.0);
        cosine * (g * (1.0 + g * (1.0 - g)))
    }

    /// r(θ) for a cosine in 0 … 1.
    fn mirror_share(&self, cosine: f64) -> Rgb {
        let c = cosine.clamp(0.0, 1.0);
        match self.mirror {
            Mirror::None => Rgb::ZERO,
            Mirror::Constant(r) => r,
            Mirror::Schlick(r0) => fresnel::schlick(r0, c),
            Mirror::Exact(r0) => fresnel::dielectric_of(r0, c),
            Mirror::Boundary(silver, law) => {
                let eta = self.eta();
                let share = match law {
                    Fresnel::Exact => fresnel::dielectric(c, eta),
                    Fresnel::Schlick => fresnel::dielectric_schlick(c, eta),
                    Fresnel::None if fresnel::cos_beyond(c, eta).is_none() => 1.0,
                    Fresnel::None => 0.0,
                };
                silver + (Rgb::ONE - silver) * share
            }
        }
    }
}

fn mirror(metal: Rgb, transmit: Rgb, reflect: Rgb, law: Fresnel) -> Mirror {
    match law {
        _ if metal != Rgb::ZERO => Mirror::Schlick(metal),
        _ if transmit != Rgb::ZERO => Mirror::Boundary(reflect, law),
        _ if reflect == Rgb::ZERO => Mirror::None,
        Fresnel::None => Mirror::Constant(reflect),
        Fresnel::Schlick => Mirror::Schlick(reflect),
        Fresnel::Exact => Mirror::Exact(reflect),
    }
}

#[cfg(test)]
mod tests;
