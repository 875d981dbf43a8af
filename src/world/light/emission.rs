//! Light as it leaves a lamp: rays that carry power, so that what many of them bring anywhere is on average what the lamp
//! sends there. Knows nothing of what they meet.

use super::{AreaLight, Light, Source, cosine_hemisphere, frame, to_frame};
use crate::math::elementary::sin_cos_turns;
use crate::scene::Rgb;
use crate::world::{Ray, RayKind, SurfacePoint, World};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A ray of light as it leaves.
#[derive(Clone, Copy, Debug)]
pub struct Emitted {
    /// From the lamp; of a sun or a sky, from outside of everything.
    pub ray: Ray,
    /// W per colour channel, as if this ray were all that the lamp sends.
    pub power: Rgb,
}

/// A ball that holds all that light from afar shall meet.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// Centre.
    pub center: DVec3,
    /// Radius.
    pub radius: f64,
}

impl Ball {
    /// Around all that is bounded in a world. Without radius where there is nothing of the kind.
    pub fn around(world: &World) -> Ball {
        let bounds = world.bounds();
        let radius = bounds.size().length() / 2.0;
        match radius.is_finite() && radius > 0.0 {
            true => Ball { center: (bounds.min + bounds.max) / 2.0, radius },
            false => Ball { center: DVec3::ZERO, radius: 0.0 },
        }
    }
}

impl Light {
    /// A ray from a place chosen by `place` in a direction chosen by `way`, both in (0, 1)²; `side` in (0, 1) chooses the side of
    /// a closed solid. Suns and skies shine on the ball alone. None where the place sends nothing.
    pub fn emit(&self, place: DVec2, way: DVec2, side: f64, ball: &Ball) -> Option<Emitted> {
        let from_point = |origin, direction, power| Emitted { ray: ray(origin, direction), power };
        let emitted = match &self.source {
            Source::Point { position, intensity } => {
                from_point(*position, sphere(way), *intensity * (4.0 * PI))
            }
            Source::Spot { position, direction, cosines, intensity } => {
                let height = 1.0 - cosines[1];
                let wi = to_frame(*direction, cap(way, height));
                let share = super::cone_share(direction.dot(wi), *cosines);
                from_point(*position, wi, *intensity * (share * TAU * height))
            }
            Source::Sun { toward, irradiance } => from_afar(*toward, *irradiance, place, ball),
            Source::Sky { radiance } => from_afar(sphere(way), *radiance * (4.0 * PI), place, ball),
            Source::PictureSky(sky) => {
                let (toward, density) = sky.choose(way);
                from_afar(toward, sky.radiance(toward) / density, place, ball)
            }
            Source::Area(area) => area.emit(place, way, side)?,
        };
        (emitted.power != Rgb::ZERO && emitted.power.is_finite()).then_some(emitted)
    }
}

impl AreaLight {
    fn emit(&self, place: DVec2, way: DVec2, side: f64) -> Option<Emitted> {
        let (at, uv, area, closed) = self.departure(place)?;
        let inward = closed && side < 0.5;
        let normal = if inward { -at.normal } else { at.normal };
        let direction = to_frame(normal, cosine_hemisphere(way));
        let sides = if closed { 2.0 } else { 1.0 };
        let power = self.emitted(&at, uv.into(), 0.0) * (PI * area * sides);
        Some(Emitted { ray: ray(at.offset_toward(direction), direction), power })
    }
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin, direction, t_max: f64::INFINITY, kind: RayKind::Indirect }
}

/// From the side that `toward` points to, onto the ball's disc across it.
fn from_afar(toward: DVec3, irradiance: Rgb, place: DVec2, ball: &Ball) -> Emitted {
    let ((s, c), r) = (sin_cos_turns(place.y), ball.radius * place.x.sqrt());
    let (a, b) = frame(toward);
    let origin = ball.center + toward * (2.0 * ball.radius) + a * (r * c) + b * (r * s);
    Emitted { ray: ray(origin, -toward), power: irradiance * (PI * ball.radius * ball.radius) }
}

/// A unit vector, all directions alike.
pub(super) fn sphere(u: DVec2) -> DVec3 {
    cap(u, 2.0)
}

/// A unit vector of a cap about z, all alike; `height` is 1 less the least cosine.
fn cap(u: DVec2, height: f64) -> DVec3 {
    let ((s, c), z) = (sin_cos_turns(u.y), 1.0 - height * u.x);
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * c, r * s, z)
}

/// Where light leaves a surface: the point, its parameters, the area that it stands for, and whether both sides shine.
pub(super) type Departure = (SurfacePoint, DVec2, f64, bool);
