//! Flat discs.

use super::{LocalRay, Meet, Surface, padded, upright};
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::scene;
use glam::{DVec2, DVec3};

/// A flat disc. (u, v) runs over the square around it.
#[derive(Clone, Copy, Debug)]
pub struct Disc(pub scene::Disc);

impl Disc {
    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        let f = ray.origin - self.0.center;
        let t = -f.dot(self.0.normal) / ray.direction.dot(self.0.normal);
        let inside = |t: f64| (f + ray.direction * t).length_squared() <= self.0.radius * self.0.radius;
        (t > 0.0 && t <= limit && inside(t)).then(|| Meet::at(t))
    }

    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let (n, center) = (self.0.normal, self.0.center);
        let off = (ray.origin - center) + ray.direction * meet.t;
        let q = off - n * (off.dot(n) / n.length_squared());
        let (u, v) = upright(n);
        Surface {
            point: center + q,
            error: (center.abs() + DVec3::splat(q.length())) * gamma(8),
            geometric_normal: n,
            normal: n,
            tangent: u,
            uv: ((DVec2::new(q.dot(u), q.dot(v)) / self.0.radius + 1.0) / 2.0).into(),
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        disc_bounds(self.0.center, self.0.normal, self.0.radius)
    }
}

/// The box around a disc: along each axis it reaches r·√(1 − n²).
pub fn disc_bounds(center: DVec3, normal: DVec3, radius: f64) -> Aabb {
    let n = normal.normalize_or_zero();
    let half = (DVec3::ONE - n * n).max(DVec3::ZERO).to_array().map(f64::sqrt);
    let half = DVec3::from_array(half) * radius;
    // 1 − n² cancels where n is nearly an axis: its error is γ, the root's √γ of the radius.
    let doubt = DVec3::splat(radius * gamma(8).sqrt());
    padded(Aabb { min: center - half, max: center + half }, doubt + center.abs() * gamma(2))
}
