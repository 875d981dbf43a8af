//! Infinite planes. Grazing rays are the hard case: n·d and the distance to the plane are summed in twice the working
//! precision, and the point is put back onto the plane. Across an axis, as floors and walls are, plain arithmetic gives the same bits.

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
    /// The coordinate that the normal is along, and its sign, where it is along one.
    #[inline(always)]
    fn axis(&self) -> Option<(usize, f64)> {
        let n = self.normal;
        match () {
            () if n.x == 0.0 && n.z == 0.0 && n.y.abs() == 1.0 => Some((1, n.y)),
            () if n.y == 0.0 && n.z == 0.0 && n.x.abs() == 1.0 => Some((0, n.x)),
            () if n.x == 0.0 && n.y == 0.0 && n.z.abs() == 1.0 => Some((2, n.z)),
            () => None,
        }
    }

    /// How far a point is above the plane, in multiples of |normal|.
    #[inline]
    fn height(&self, p: DVec3) -> f64 {
        match self.axis() {
            Some((i, sign)) => along(p[i], sign) - self.offset,
            None => self.height_of_any(p),
        }
    }

    #[inline(never)]
    fn height_of_any(&self, p: DVec3) -> f64 {
        let n = self.normal;
        sum_of_products([(n.x, p.x), (n.y, p.y), (n.z, p.z), (-self.offset, 1.0)])
    }

    #[inline]
    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        let t = match self.axis() {
            Some((i, sign)) => {
                let height = along(ray.origin[i], sign) - self.offset;
                let speed = along(ray.direction[i], sign);
                if (height > 0.0) == (speed > 0.0) {
                    return None;
                }
                -height / speed
            }
            None if self.surely_misses(ray, limit) => return None,
            None => -self.height_of_any(ray.origin) / dot(self.normal, ray.direction),
        };
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

    #[inline]
    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let n = self.normal;
        let far = ray.at(meet.t);
        let point = far - n * (self.height(far) / n.length_squared());
        let u = match self.axis() {
            Some((1, _)) => DVec3::X,
            Some(_) => DVec3::Y.cross(n),
            None => upright(n).0,
        };
        Surface {
            point,
            error: point.abs() * gamma(4),
            geometric_normal: n,
            normal: n,
            tangent: u,
            uv: DVec2::new(point.dot(u), point.dot(n.cross(u))).into(),
        }
    }
}

/// x times a sign, as the sum of three products of which two are 0 has it: never −0.
#[inline(always)]
fn along(x: f64, sign: f64) -> f64 {
    0.0 + sign * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    #[test]
    fn planes_across_an_axis_are_met_in_the_bits_of_any_other() {
        let mut random = Random::new(5);
        let mut next = move || if random.below(8) == 0 { 0.0 } else { random.between(-4.0, 4.0) };
        for i in 0..6 {
            let normal = DVec3::AXES[i % 3] * if i < 3 { 1.0 } else { -1.0 };
            for _ in 0..2000 {
                let plane = Plane { normal, offset: next() };
                let mut point = || DVec3::new(next(), next(), next());
                let ray = LocalRay { origin: point(), direction: point() };
                let t = -plane.height_of_any(ray.origin) / dot(normal, ray.direction);
                let met = plane.meet(&ray, 1e3).map(|m| m.t.to_bits());
                assert_eq!(met, (t > 0.0 && t <= 1e3).then_some(t.to_bits()), "{plane:?} {ray:?}");
                let p = point();
                assert_eq!(plane.height(p).to_bits(), plane.height_of_any(p).to_bits(), "{plane:?} {p}");
                let (u, v) = upright(normal);
                let surface = plane.surface(&ray, &Meet::at(1.0));
                assert_eq!((surface.tangent, surface.uv.get().y), (u, surface.point.dot(v)), "{normal}");
            }
        }
    }
}
