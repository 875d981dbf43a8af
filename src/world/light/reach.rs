//! About how much light would reach a point of a surface from each light if nothing stood between: what a path goes by where it
//! chooses one to ask. A guess, which makes noise smaller or larger and changes no mean.

use super::{Light, Source, attenuation, cone_share};
use crate::math::colour::mean;
use glam::DVec3;
use std::f64::consts::PI;

/// A surface that emits, seen from afar.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// Its middle.
    pub center: DVec3,
    /// No point of it is farther from there.
    pub radius: f64,
    /// The area that it shows, on average over directions where it is not flat.
    pub area: f64,
    /// The side that it shines to, where it is flat.
    pub normal: Option<DVec3>,
}

impl Extent {
    /// About the irradiance at a point of a surface with a unit normal by radiance 1.
    fn irradiance(&self, at: DVec3, normal: DVec3) -> f64 {
        let to = self.center - at;
        let squared = to.length_squared().max(self.radius * self.radius);
        let distance = squared.sqrt();
        // Of what lies partly below a horizon, the middle tells too little.
        let above = |height: f64| ((height + self.radius) / distance).clamp(0.0, 1.0);
        let facing = self.normal.map_or(1.0, |n| above(-to.dot(n)));
        self.area * above(to.dot(normal)) * facing / squared
    }
}

impl Light {
    /// About the irradiance at a point of a surface with a unit normal, mean of the colours; patterns count as 1.
    pub(super) fn reach(&self, at: DVec3, normal: DVec3) -> f64 {
        match &self.source {
            Source::Point { position, intensity } => {
                mean(*intensity) * self.from_point(at, normal, *position, |_| 1.0)
            }
            Source::Spot { position, direction, cosines, intensity } => {
                let share = |wi: DVec3| cone_share(-direction.dot(wi), *cosines);
                mean(*intensity) * self.from_point(at, normal, *position, share)
            }
            Source::Sun { toward, irradiance } => mean(*irradiance) * toward.dot(normal).max(0.0),
            Source::Sky { radiance } => PI * mean(*radiance),
            Source::PictureSky(sky) => PI * sky.mean(),
            Source::Area(area) => {
                let extent = area.extent();
                let dimming = self.dimming((extent.center - at).length());
                mean(area.typical()) * extent.irradiance(at, normal) * dimming
            }
        }
    }

    /// Whether a path finds it as well by itself: a sky that is the same everywhere.
    pub(super) fn is_found(&self) -> bool {
        self.is_met && matches!(self.source, Source::Sky { .. })
    }

    fn from_point(&self, at: DVec3, normal: DVec3, position: DVec3, share: impl Fn(DVec3) -> f64) -> f64 {
        let to = position - at;
        let (squared, distance) = (to.length_squared(), to.length());
        let wi = to / distance;
        let arrives = self.falloff.map_or(1.0 / squared, |falloff| attenuation(falloff, distance));
        share(wi) * arrives * wi.dot(normal).max(0.0)
    }
}
