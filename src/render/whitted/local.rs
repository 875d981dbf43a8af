//! Light that comes to a hit straight from the lights, and what stands in its way.

use super::Whitted;
use crate::render::medium::kept;
use crate::render::sampler::Sampler;
use crate::scene::Rgb;
use crate::world::bsdf::Bsdf;
use crate::world::light::{Light, LightSample};
use crate::world::texture::Sampled;
use crate::world::{Hit, Ray, World};
use glam::DVec2;

impl Whitted {
    /// Radiance that the surface sends on from all lights. `first`: seen by the camera itself.
    pub(super) fn local(
        &self,
        world: &World,
        hit: &Hit<'_>,
        bsdf: &Bsdf,
        first: bool,
        sampler: &mut Sampler,
    ) -> Sampled<Rgb> {
        let mut sum = Rgb::ZERO;
        if bsdf.has_base() || bsdf.is_glossy() {
            for light in &self.lights.lights {
                sum += self.sent_by(world, hit, bsdf, light, first, sampler)?;
            }
        }
        Ok(sum)
    }

    fn sent_by(
        &self,
        world: &World,
        hit: &Hit<'_>,
        bsdf: &Bsdf,
        light: &Light,
        first: bool,
        sampler: &mut Sampler,
    ) -> Sampled<Rgb> {
        if light.is_delta() {
            // Looked at where it stands, here and below: it is not small.
            return match &light.sample(hit.point, bsdf.normal, DVec2::ZERO) {
                Some(s) => self.arriving(world, hit, light, s, bsdf.sent_on(s.wi), sampler),
                None => Ok(Rgb::ZERO),
            };
        }
        if !bsdf.has_base() {
            return Ok(Rgb::ZERO);
        }
        let n = if first { light.samples } else { 1 };
        let points = sampler.next_set();
        let mut sum = Rgb::ZERO;
        for i in 0..n {
            if let Some(s) = &light.sample(hit.point, bsdf.normal, points.point(i, n)) {
                sum += self.arriving(world, hit, light, s, bsdf.base(s.wi), sampler)?;
            }
        }
        Ok(sum / f64::from(n))
    }

    /// A sample's light times the share that is sent on, if it arrives. No ray is cast for what would not be seen.
    fn arriving(
        &self,
        world: &World,
        hit: &Hit<'_>,
        light: &Light,
        sample: &LightSample,
        share: Rgb,
        sampler: &mut Sampler,
    ) -> Sampled<Rgb> {
        let sent = share * sample.weight;
        if sent == Rgb::ZERO || !light.shadow || !self.second_rays {
            return Ok(sent);
        }
        let ray = sample.shadow_ray(hit);
        if self.clear_shadows {
            return Ok(sent * passed(world, &ray, sampler)?);
        }
        sampler.rays.shadow += 1;
        Ok(if world.occluded(&ray) { Rgb::ZERO } else { sent })
    }
}

/// Share of light that passes along a shadow ray, through whatever is not opaque.
fn passed(world: &World, ray: &Ray, sampler: &mut Sampler) -> Sampled<Rgb> {
    sampler.rays.shadow += 1;
    world.transmittance(ray, |hit| {
        sampler.rays.shadow += 1;
        through(world, hit, ray)
    })
}

/// Share of light that passes a surface, less what was absorbed on the way to it from within.
fn through(world: &World, hit: &Hit<'_>, ray: &Ray) -> Sampled<Rgb> {
    let bsdf = Bsdf::at(world, hit, ray)?;
    let from_within = !bsdf.outside && bsdf.is_transmissive();
    let arrived = if from_within { kept(bsdf.absorb, hit.t) } else { Rgb::ONE };
    Ok(arrived * bsdf.straight_through())
}
