//! Infinite planes. Grazing rays are the hard case: n·d and the distance to the plane are summed in twice the working
//! precision, and the point is put back onto the plane.

use super::{LocalRay, Meet, Surface, upright};
use crate::math::error::gamma;
use crate::math::exact::{dot, sum_of_products};
use glam::{DVec2, DVec3};

/// n·p = offset.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// Unit normal.
    pub normal: DVec3,
    /// n·p on the plane.
    pub offset: f64,
}

impl Plane {
    /// How far a point is above the plane, in multiples of |normal|.
    fn height(&self, p: DVec3) -> f64 {
        let n = self.normal;
        sum_of_products([(n.x, p.x), (n.y, p.y), (n.z, p.z), (-self.offset, 1.0)])
    }

    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        if self.surely_misses(ray, limit) {
            return None;
        }
        let t = -self.height(ray.origin) / dot(self.normal, ray.direction);
        (t > 0.0 && t <= limit).then(|| Meet::at(t))
    }

    /// Whether a ray starts on the solid side: told by where it goes where it `meets` the plane, by where it is where it does not.
    pub(super) fn starts_below(&self, ray: &LocalRay, meets: bool) -> bool {
        if meets { dot(self.normal, ray.direction) > 0.0 } else { self.height(ray.origin) < 0.0 }
    }

    /// True where plain arithmetic already knows that the plane is behind the ray or beyond the limit: so for most rays.
    fn surely_misses(&self, ray: &LocalRay, limit: f64) -> bool {
        let n = self.normal;
        let height = n.dot(ray.origin) - self.offset;
        let height_doubt = (n.abs().dot(ray.origin.abs()) + self.offset.abs()) * gamma(5);
        let speed = n.dot(ray.direction);
        let speed_doubt = n.abs().dot(ray.direction.abs()) * gamma(4);
        let certain = height.abs() > height_doubt && speed.abs() > speed_doubt;
        let away = (height > 0.0) == (speed > 0.0);
        certain && (away || height.abs() - height_doubt > limit * (speed.abs() + speed_doubt))
    }

    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let n = self.normal;
        let far = ray.at(meet.t);
        let point = far - n * (self.height(far) / n.length_squared());
        let (u, v) = upright(n);
        Surface {
            point,
            error: point.abs() * gamma(4),
            geometric_normal: n,
            normal: n,
            tangent: u,
            uv: DVec2::new(point.dot(u), point.dot(v)),
        }
    }
}
