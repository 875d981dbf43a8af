//! Light as it leaves a lamp: rays that carry power, so that what many of them bring anywhere is on average what the lamp
//! sends there. Knows nothing of what they meet.

use super::aim::{Aim, Spread, cap};
use super::{AreaLight, Light, Source};
use crate::scene::Rgb;
use crate::world::texture::Sampled;
use crate::world::{Ray, RayKind, SurfacePoint};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// A ray of light as it leaves.
#[derive(Clone, Copy, Debug)]
pub struct Emitted {
    /// From the lamp; of a sun or a sky, from outside of everything.
    pub ray: Ray,
    /// W per colour channel, as if this ray were all that the lamp sends.
    pub power: Rgb,
}

impl Light {
    /// A ray from a place chosen by `place` in a direction chosen by `way`, both in (0, 1)²; `side` in (0, 1) chooses the side of
    /// a closed solid. None where nothing is sent, or not to where it is aimed; a fault where a pattern of the lamp has no value.
    pub fn emit(&self, place: DVec2, way: DVec2, side: f64, aim: &Aim) -> Sampled<Option<Emitted>> {
        let from_point = |position, spread| {
            let (direction, sent) = aim.direction(position, &spread, way)?;
            Some((ray(position, direction), sent))
        };
        let from_afar = |toward, irradiance: Rgb| {
            let (start, area) = aim.start(toward, place)?;
            Some(Emitted { ray: ray(start, -toward), power: irradiance * area })
        };
        let emitted = match &self.source {
            Source::Point { position, intensity } => from_point(*position, Spread::Sphere)
                .map(|(ray, sent)| Emitted { ray, power: *intensity * sent }),
            Source::Spot { position, direction, cosines, intensity } => {
                let share = |ray: &Ray| super::cone_share(direction.dot(ray.direction), *cosines);
                from_point(*position, Spread::Cap(*direction, cosines[1]))
                    .map(|(ray, sent)| Emitted { ray, power: *intensity * (share(&ray) * sent) })
            }
            Source::Sun { toward, irradiance } => from_afar(*toward, *irradiance),
            Source::Sky { radiance } => from_afar(sphere(way), *radiance * (4.0 * PI)),
            Source::PictureSky(sky) => {
                let (toward, density) = sky.choose(way);
                from_afar(toward, sky.radiance(toward) / density)
            }
            Source::Area(area) => area.emit(place, way, side, aim)?,
        };
        Ok(emitted.filter(|emitted| emitted.power != Rgb::ZERO && emitted.power.is_finite()))
    }
}

impl AreaLight {
    fn emit(&self, place: DVec2, way: DVec2, side: f64, aim: &Aim) -> Sampled<Option<Emitted>> {
        let Some((at, uv, area, closed)) = self.departure(place) else { return Ok(None) };
        let inward = closed && side < 0.5;
        let normal = if inward { -at.normal } else { at.normal };
        let aimed = aim.direction(at.point, &Spread::Cosine(normal), way);
        let Some((direction, sent)) = aimed else { return Ok(None) };
        let sides = if closed { 2.0 } else { 1.0 };
        let power = self.told(&at, uv.into(), 0.0)? * (sent * area * sides);
        Ok(Some(Emitted { ray: ray(at.offset_toward(direction), direction), power }))
    }
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin, direction, t_max: f64::INFINITY, kind: RayKind::Indirect }
}

/// A unit vector, all directions alike.
pub(super) fn sphere(u: DVec2) -> DVec3 {
    cap(u, 2.0)
}

/// Where light leaves a surface: the point, its parameters, the area that it stands for, and whether both sides shine.
pub(super) type Departure = (SurfacePoint, DVec2, f64, bool);
