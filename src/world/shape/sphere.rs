//! Spheres: factored discriminant, in twice the working precision where the ray is far or grazes.
//!
//! Haines, Günther & Akenine-Möller, *Precision improvements for ray/sphere intersection*, Ray Tracing Gems ch. 7: the
//! discriminant from the ray's distance to the centre, never from b² − 4ac.

use super::{LocalRay, Meet, Surface, Uv, ahead, padded};
use crate::math::error::{UNIT_ROUNDOFF, gamma};
use crate::math::exact::Double;
use crate::math::{Aabb, Affine};
use glam::DVec3;

/// |p − center| = radius.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Centre.
    pub center: DVec3,
    /// Radius, positive.
    pub radius: f64,
}

/// Rays that start farther away than this many radii take the precise path: nearer ones lose fourteen bits of the outline at worst,
/// which is within the next bound.
const FAR: f64 = 16384.0;

/// So do rays that pass within this share of the radius from grazing: the others lose six bits of the chord at worst.
const GRAZING: f64 = 1.0 / 64.0;

/// True where plain arithmetic already knows that a ray misses: so for most. `al` is its point nearest to the centre, as seen from there,
/// times a; that nothing was divided by a moves it, as against the full test, by less than 32 roundings of `reach`.
#[inline(always)]
fn passes_by(al: DVec3, a: f64, radius: f64, reach: f64) -> bool {
    let clear = a * (radius + gamma(64) * (reach + radius));
    al.length_squared() > clear * clear
}

/// By how much the square of a distance from the centre must exceed that of the radius, as a share of it, to be surely outside. Seven units are
/// what rounding does to both; the nine that are left keep what is behind the ray's start behind it, by however a root is found and rounded.
const OUTSIDE: f64 = 1.0 + gamma(16);

/// Where a ray meets a sphere: two quotients in order, of which most rays need one.
struct Roots {
    near: (f64, f64),
    far: (f64, f64),
}

impl Roots {
    #[inline(always)]
    fn near(&self) -> f64 {
        self.near.0 / self.near.1
    }

    #[inline(always)]
    fn far(&self) -> f64 {
        self.far.0 / self.far.1
    }
}

impl Sphere {
    /// The least distance in (0, limit] at which a ray meets it.
    #[inline(always)]
    pub fn distance(&self, ray: &LocalRay, limit: f64) -> Option<f64> {
        if self.is_left(ray) {
            return None;
        }
        let roots = self.roots(ray)?;
        let near = roots.near();
        let t = if near > 0.0 { near } else { roots.far() };
        (t > 0.0 && t <= limit).then_some(t)
    }

    #[inline]
    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        self.distance(ray, limit).map(Meet::at)
    }

    /// True where a ray surely starts outside and goes away: so do all that leave it.
    #[inline(always)]
    fn is_left(&self, ray: &LocalRay) -> bool {
        let f = ray.origin - self.center;
        f.dot(ray.direction) > 0.0 && f.length_squared() > self.radius * self.radius * OUTSIDE
    }

    pub(super) fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        if let Some(roots) = self.roots(ray) {
            out.extend([roots.near(), roots.far()].into_iter().filter(|t| ahead(*t)).map(Meet::at));
        }
    }

    /// Both distances.
    #[inline(always)]
    fn roots(&self, ray: &LocalRay) -> Option<Roots> {
        let (d, r) = (ray.direction, self.radius);
        let f = ray.origin - self.center;
        let a = d.dot(d);
        let b = -f.dot(d);
        let reach = f.abs().max_element();
        if passes_by(f * a + d * b, a, r, reach) {
            return None;
        }
        let l = f + d * (b / a);
        let miss_by = l.length() - r;
        if miss_by > gamma(16) * (reach + r) {
            return None;
        }
        if reach > FAR * r || -miss_by < GRAZING * r {
            let (near, far) = self.precise_roots(ray, b / a)?;
            return Some(Roots { near: (near, 1.0), far: (far, 1.0) });
        }
        let length = f.length();
        let c = (length - r) * (length + r);
        let root = (-a * miss_by * (l.length() + r)).sqrt();
        Some(if b > 0.0 {
            Roots { near: (c, b + root), far: (b + root, a) }
        } else {
            Roots { near: (b - root, a), far: (c, b - root) }
        })
    }

    /// From the point nearest to the centre, found in twice the working precision. `approach` is its distance, roughly.
    #[inline(never)]
    fn precise_roots(&self, ray: &LocalRay, approach: f64) -> Option<(f64, f64)> {
        let (o, d, c) = (ray.origin.to_array(), ray.direction.to_array(), self.center.to_array());
        let along = |from: [Double; 3], t: f64| -> [Double; 3] {
            std::array::from_fn(|i| from[i] + Double::product(d[i], t))
        };
        let dot = |x: [Double; 3], y: [Double; 3]| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
        let direction = d.map(Double::new);
        let a = dot(direction, direction).value();
        let start = std::array::from_fn(|i| Double::difference(o[i], c[i]));
        let close = along(start, approach);
        let rest = -dot(close, direction).value() / a;
        let nearest = along(close, rest);
        let room = Double::product(self.radius, self.radius) - dot(nearest, nearest);
        let half = (room.value() / a).sqrt();
        (half >= 0.0).then_some((approach + (rest - half), approach + (rest + half)))
    }

    /// The surface where a ray met it.
    #[inline]
    pub fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let from_center = (ray.origin - self.center) + ray.direction * meet.t;
        let normal = from_center.try_normalize().unwrap_or(DVec3::Y);
        let point = self.center + normal * self.radius;
        Surface {
            point,
            error: normal.abs() * (self.radius * gamma(8)) + point.abs() * gamma(2),
            geometric_normal: normal,
            normal,
            tangent: DVec3::new(normal.z, 0.0, -normal.x),
            uv: Uv::Around(normal),
        }
    }

    /// Tight under any transform: along each axis the image reaches radius times the length of the matrix's row.
    pub(super) fn bounds(&self, transform: Option<&Affine>) -> Aabb {
        let (center, half) = match transform {
            None => (self.center, DVec3::splat(self.radius)),
            Some(m) => {
                let rows = m.linear.transpose();
                let lengths = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
                (m.point(self.center), lengths * self.radius)
            }
        };
        let terms = transform.map_or(center.abs(), |m| {
            let l = m.linear;
            let c = self.center.abs();
            l.x_axis.abs() * c.x + l.y_axis.abs() * c.y + l.z_axis.abs() * c.z + m.translation.abs()
        });
        padded(
            Aabb { min: center - half, max: center + half },
            terms * gamma(6) + half * (8.0 * UNIT_ROUNDOFF),
        )
    }
}
