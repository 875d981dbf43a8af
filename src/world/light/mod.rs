//! Lights made ready to be asked: from this point, which way does light come, and how much? Knows nothing of materials that
//! reflect, of shadows or of tracers; a sample says where a shadow ray must end and leaves the casting to others.
//!
//! The estimate is always the product of visibility, geometry and radiance, sample by sample: a tracer multiplies
//! [`LightSample::weight`] by BSDF, cosine and visibility and averages.

mod aim;
mod choice;
mod emission;
mod picture;
mod pieces;
mod reach;
mod surface;
mod targets;

use super::hit::{Hit, SurfacePoint};
use super::{Emitter, PlacedLight, PrimitiveId, Ray, RayKind, World};
pub use crate::geometry::balls::Ball;
use crate::math::elementary::{sin_cos_degrees, sin_cos_turns};
use crate::scene::{LightSource, Rgb, Sky};
pub use aim::Aim;
pub use choice::Choice;
pub use emission::Emitted;
use glam::{DVec2, DVec3};
use picture::PictureSky;
use std::f64::consts::PI;
pub use surface::{AreaLight, emits_inward};
pub use targets::Targets;

/// All lights of a world, ready.
#[derive(Debug, Default)]
pub struct Lights {
    /// Point, spot, sun and sky lights in the order of the scene, then the surfaces that emit.
    pub lights: Vec<Light>,
    /// Which of them are skies.
    skies: Vec<usize>,
    /// The light of each emitter of the world, by its index there.
    of_emitter: Vec<Option<usize>>,
    /// Whether rays that leave the lights and are stopped by whatever stands in their way bring all light there is.
    pub are_all_sent: bool,
}

/// One light.
#[derive(Debug)]
pub struct Light {
    source: Source,
    /// `a r² + b r + c` in place of r².
    falloff: Option<[f64; 3]>,
    /// Whether it casts shadows.
    pub shadow: bool,
    /// How many samples whitted takes at the first hit: 1 for lights without extent.
    pub samples: u32,
    /// Whether chance finds it as well, by rays that meet it with a density that [`Light::density`] knows: the two share what it sends.
    /// Else all of that counts where it is asked.
    pub is_met: bool,
}

/// The forms of a light, in world space.
#[derive(Debug)]
enum Source {
    Point { position: DVec3, intensity: Rgb },
    Spot { position: DVec3, direction: DVec3, cosines: [f64; 2], intensity: Rgb },
    Sun { toward: DVec3, irradiance: Rgb },
    Sky { radiance: Rgb },
    PictureSky(Box<PictureSky>),
    Area(Box<AreaLight>),
}

/// Light that may arrive at a point, if nothing stands between.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit vector toward the light.
    pub wi: DVec3,
    /// Radiance divided by the density of choosing `wi`; for a light without extent, the irradiance on a surface that faces
    /// it. Times BSDF, cosine and visibility it is the light sent on.
    pub weight: Rgb,
    /// Density per solid angle with which `wi` was chosen; none for a light without extent, which chance cannot find.
    pub pdf: Option<f64>,
    /// Where it comes from.
    pub end: LightEnd,
}

/// Where a shadow ray ends.
#[derive(Clone, Copy, Debug)]
pub enum LightEnd {
    /// A point in space.
    Point(DVec3),
    /// A point of a surface that emits.
    Surface(SurfacePoint),
    /// Beyond everything.
    Infinity,
}

impl LightSample {
    /// The ray from a surface that nothing may meet if the light is to arrive.
    #[inline]
    pub fn shadow_ray(&self, hit: &Hit<'_>) -> Ray {
        match &self.end {
            LightEnd::Point(p) => hit.spawn_to(*p),
            LightEnd::Surface(p) => hit.spawn_to_surface(p),
            LightEnd::Infinity => hit.spawn(self.wi, RayKind::Shadow),
        }
    }
}

impl Lights {
    /// The lights of a world.
    pub fn new(world: &World) -> Lights {
        let placed = world.lights.iter().filter_map(Light::placed);
        let mut lights: Vec<Light> = placed.collect();
        let skies = (0..lights.len()).filter(|&i| lights[i].is_sky()).collect();
        let add = |emitter| {
            Light::emitter(emitter).map(|light| {
                lights.push(light);
                lights.len() - 1
            })
        };
        let of_emitter = world.emitters.iter().map(add).collect();
        let hides = world.hides_from_light();
        if hides {
            lights.iter_mut().for_each(|light| light.is_met = false);
        }
        let are_all_sent = !hides && !world.glows_unasked && lights.iter().all(|light| light.shadow);
        Lights { lights, skies, of_emitter, are_all_sent }
    }

    /// The light that a primitive is part of, by its index; none where it does not emit or is not asked.
    pub fn of(&self, world: &World, primitive: PrimitiveId) -> Option<usize> {
        self.of_emitter[world.emitter_of(primitive)?]
    }

    /// The radiance of each sky in a direction, with the light that it is.
    pub fn skies(&self, direction: DVec3) -> impl Iterator<Item = (usize, Rgb)> {
        self.skies.iter().map(move |&i| (i, self.lights[i].from_beyond(direction)))
    }

    /// True where some light comes from beyond everything: a sun or a sky.
    pub fn from_afar(&self) -> bool {
        self.lights.iter().any(|light| light.is_sky() || matches!(light.source, Source::Sun { .. }))
    }

    /// Radiance of all skies together in a direction; none where there is no sky.
    pub fn sky(&self, direction: DVec3) -> Option<Rgb> {
        self.skies(direction).map(|(_, radiance)| radiance).reduce(|a, b| a + b)
    }
}

impl Light {
    /// A light where it stands. None for an area light, whose object is among the world's emitters, and for a sky from a
    /// picture that is black or could not be read.
    pub fn placed(placed: &PlacedLight) -> Option<Light> {
        let place = &placed.world_from_local;
        let (source, samples) = match &placed.light.source {
            LightSource::Point { position, intensity } => {
                (Source::Point { position: place.point(*position), intensity: *intensity }, 1)
            }
            LightSource::Spot { position, direction, cone, intensity } => (
                Source::Spot {
                    position: place.point(*position),
                    direction: place.vector(*direction).normalize(),
                    cosines: cone.map(|half_angle| sin_cos_degrees(half_angle).1),
                    intensity: *intensity,
                },
                1,
            ),
            LightSource::Sun { direction, irradiance } => {
                let toward = -place.vector(*direction).normalize();
                (Source::Sun { toward, irradiance: *irradiance }, 1)
            }
            LightSource::Sky(Sky::Uniform(radiance)) => {
                (Source::Sky { radiance: *radiance }, placed.light.samples.max(1))
            }
            LightSource::Sky(Sky::Image { factor, picture, .. }) => {
                let sky = PictureSky::new(picture.shared()?, *factor, place)?;
                (Source::PictureSky(Box::new(sky)), placed.light.samples.max(1))
            }
            LightSource::Area { .. } => return None,
        };
        Some(Light::new(source, placed.light.falloff, placed.light.shadow, samples))
    }

    fn new(source: Source, falloff: Option<[f64; 3]>, shadow: bool, samples: u32) -> Light {
        let has_density = match &source {
            Source::Sky { .. } | Source::PictureSky(_) => true,
            Source::Area(area) => area.knows_density(),
            Source::Point { .. } | Source::Spot { .. } | Source::Sun { .. } => false,
        };
        Light { source, falloff, shadow, samples, is_met: shadow && has_density }
    }

    /// A surface that emits. None for one without area.
    pub fn emitter(emitter: &Emitter) -> Option<Light> {
        let area = AreaLight::new(emitter)?;
        let light = emitter.light.as_deref();
        let samples = light.map_or(DEFAULT_SAMPLES, |l| l.samples).max(1);
        let source = Source::Area(Box::new(area));
        Some(Light::new(source, light.and_then(|l| l.falloff), light.is_none_or(|l| l.shadow), samples))
    }

    /// True for a light that no ray meets by chance: point, spot and sun.
    #[inline]
    pub fn is_delta(&self) -> bool {
        match self.source {
            Source::Point { .. } | Source::Spot { .. } | Source::Sun { .. } => true,
            Source::Sky { .. } | Source::PictureSky(_) | Source::Area(_) => false,
        }
    }

    /// Light toward a point from a place of this light chosen by `u` in (0, 1)². `normal` is the unit normal of the receiving
    /// surface on the side that is lit. None where no light can come that way.
    #[inline]
    pub fn sample(&self, at: DVec3, normal: DVec3, u: DVec2) -> Option<LightSample> {
        match &self.source {
            Source::Point { position, intensity } => self.by_point(at, *position, |_| *intensity),
            Source::Spot { position, direction, cosines, intensity } => {
                self.by_point(at, *position, |wi| *intensity * cone_share(-direction.dot(wi), *cosines))
            }
            Source::Sun { toward, irradiance } => {
                Some(LightSample { wi: *toward, weight: *irradiance, pdf: None, end: LightEnd::Infinity })
            }
            Source::Sky { radiance } => Some(from_sky(*radiance, normal, u)),
            Source::PictureSky(sky) => {
                let (wi, pdf) = sky.choose(u);
                let weight = sky.radiance(wi) / pdf;
                Some(LightSample { wi, weight, pdf: Some(pdf), end: LightEnd::Infinity })
            }
            Source::Area(area) => area.sample(at, normal, u, |distance| self.dimming(distance)),
        }
    }

    /// Density per solid angle with which [`Light::sample`] chooses the direction `wi` from a point, given where a ray that way
    /// met the light (the sky: nothing). None where chance does not find what the light sends, so that only samples count.
    pub fn density(&self, at: DVec3, normal: DVec3, wi: DVec3, met: Option<&SurfacePoint>) -> Option<f64> {
        match (&self.source, met) {
            _ if !self.is_met => None,
            (Source::Sky { .. }, None) => Some(wi.dot(normal).max(0.0) / PI),
            (Source::PictureSky(sky), None) => Some(sky.density(wi)),
            (Source::Area(area), Some(met)) => area.density(at, normal, wi, met),
            _ => None,
        }
    }

    /// What a falloff makes of radiance that comes from a distance.
    pub fn dimming(&self, distance: f64) -> f64 {
        self.falloff.map_or(1.0, |f| distance * distance * attenuation(f, distance))
    }

    fn is_sky(&self) -> bool {
        matches!(self.source, Source::Sky { .. } | Source::PictureSky(_))
    }

    /// What comes of it from beyond everything, along a unit vector toward there: nothing but of skies.
    fn from_beyond(&self, direction: DVec3) -> Rgb {
        match &self.source {
            Source::Sky { radiance } => *radiance,
            Source::PictureSky(sky) => sky.radiance(direction),
            Source::Point { .. } | Source::Spot { .. } | Source::Sun { .. } | Source::Area(_) => Rgb::ZERO,
        }
    }

    #[inline]
    fn by_point(&self, at: DVec3, position: DVec3, intensity: impl Fn(DVec3) -> Rgb) -> Option<LightSample> {
        let to = position - at;
        let squared = to.length_squared();
        let distance = squared.sqrt();
        let wi = to / distance;
        let weight = match self.falloff {
            None => intensity(wi) / squared,
            Some(falloff) => intensity(wi) * attenuation(falloff, distance),
        };
        let useful = wi.is_finite() && weight != Rgb::ZERO;
        useful.then_some(LightSample { wi, weight, pdf: None, end: LightEnd::Point(position) })
    }
}

/// Samples that whitted takes of an emitting surface that no `light` block speaks of.
const DEFAULT_SAMPLES: u32 = 16;

/// 1/(a r² + b r + c).
fn attenuation([a, b, c]: [f64; 3], r: f64) -> f64 {
    1.0 / ((a * r + b) * r + c)
}

/// Full inside the inner cone, nothing outside the outer, a smooth step in the cosine between.
fn cone_share(cosine: f64, [inner, outer]: [f64; 2]) -> f64 {
    if cosine >= inner {
        1.0
    } else if cosine <= outer {
        0.0
    } else {
        let x = (cosine - outer) / (inner - outer);
        x * x * (3.0 - 2.0 * x)
    }
}

/// A uniform sky by the cosine law.
fn from_sky(radiance: Rgb, normal: DVec3, u: DVec2) -> LightSample {
    let local = cosine_hemisphere(u);
    let pdf = local.z / PI;
    LightSample {
        wi: to_frame(normal, local),
        weight: radiance / pdf,
        pdf: Some(pdf),
        end: LightEnd::Infinity,
    }
}

/// A unit vector about z with density cos θ/π per solid angle. u in (0, 1)².
pub fn cosine_hemisphere(u: DVec2) -> DVec3 {
    let (s, c) = sin_cos_turns(u.y);
    let r = u.x.sqrt();
    DVec3::new(r * c, r * s, (1.0 - u.x).sqrt())
}

/// Two unit vectors that make a right-handed frame with the unit vector n. Duff et al., *Building an Orthonormal Basis,
/// Revisited* (JCGT 6-1, 2017).
pub fn frame(n: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y))
}

/// A vector given about z, about n instead.
pub fn to_frame(n: DVec3, v: DVec3) -> DVec3 {
    let (s, t) = frame(n);
    s * v.x + t * v.y + n * v.z
}

#[cfg(test)]
mod tests;
