//! What records of irradiance ask of paths: where the camera first sees what is matt, and what arrives there from other matt
//! surfaces along a direction.

use super::Path;
use super::walk::{Last, Stage, Walk};
use crate::render::irradiance::Records;
use crate::render::medium::Inside;
use crate::render::sampler::Sampler;
use crate::scene::Rgb;
use crate::world::bsdf::Bsdf;
use crate::world::texture::Sampled;
use crate::world::{Hit, Ray, RayKind, World};
use glam::DVec3;
use std::f64::consts::PI;

/// A matt surface that a path from the camera has come to.
pub struct Matt<'w> {
    /// Where.
    pub hit: Hit<'w>,
    /// What it is made of.
    pub bsdf: Bsdf,
    /// Segments from the camera.
    pub segment: u32,
    inside: Inside,
}

impl Path {
    /// Follows a path from the camera through mirrors and glass, and whatever else is not matt, to what is. None where it
    /// ends before.
    pub fn first_matt<'w>(
        &self,
        world: &'w World,
        ray: Ray,
        sampler: &mut Sampler,
    ) -> Sampled<Option<Matt<'w>>> {
        let mut walk = Walk::from_camera(ray, &self.roulette, sampler);
        loop {
            let Some(hit) = world.closest(&walk.ray) else { return Ok(None) };
            let bsdf = Bsdf::at(world, &hit, &walk.ray)?;
            if walk.slips(&hit, &bsdf) {
                continue;
            }
            if walk.segment >= self.depth {
                return Ok(None);
            }
            if bsdf.matt() != Rgb::ZERO {
                let Walk { segment, inside, .. } = walk;
                return Ok(Some(Matt { hit, bsdf, segment, inside }));
            }
            let (which, u) = (walk.sampler.next_1d(), walk.sampler.next_2d());
            let bounce = bsdf.bounce(bsdf.odds(), which, u);
            if !bounce.is_some_and(|bounce| walk.leave(&hit, &bsdf, &bounce)) {
                return Ok(None);
            }
        }
    }

    /// Radiance that arrives at a matt surface along a direction chosen by the cosine, as far as it left another surface that
    /// spreads light: what came straight from a lamp, or by mirrors and glass alone, is left out. What records tell of what is met is taken from them. Also how far
    /// the way is to what is met first.
    pub fn gather(
        &self,
        world: &World,
        at: &Matt<'_>,
        wi: DVec3,
        records: &Records,
        sampler: &mut Sampler,
    ) -> Sampled<(Rgb, f64)> {
        let (point, normal) = (at.hit.point, at.bsdf.normal);
        let lit = at.bsdf.lit(wi);
        if lit <= 0.0 {
            return Ok((Rgb::ZERO, f64::INFINITY));
        }
        let cosine = wi.dot(normal);
        let mut walk = Walk {
            weight: Rgb::splat(lit / cosine),
            segment: at.segment + 1,
            inside: at.inside,
            last: Some(Last { point, normal, density: cosine / PI }),
            seen: false,
            stage: Stage::Gathered,
            records: Some(records),
            ..Walk::from_camera(at.hit.spawn(wi, RayKind::Indirect), &self.roulette, sampler)
        };
        self.trace(world, &mut walk)?;
        Ok((walk.sum, walk.first_length))
    }
}
