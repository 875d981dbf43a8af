//! Shapes as rays meet them: exact tests in f64, in each shape's own space.
//!
//! A test answers with the nearest distance in (0, limit] and just enough ([`Meet`]) to find the rest later; only the hit that
//! wins is turned into a [`Surface`]. Surfaces carry a bound on the error of their point, large enough that a ray started
//! beyond it does not meet the same shape at the same place again.

pub mod ball;
mod carry;
mod cone;
pub mod csg;
mod cuboid;
mod disc;
pub mod implicit;
pub mod mesh;
mod patch;
mod plane;
mod rect;
mod sphere;
mod swept;
#[cfg(test)]
mod tests;
mod torus;
pub mod triangle;

pub use carry::carry;
pub use cone::Cone;
pub use csg::Csg;
pub use cuboid::Cuboid;
pub use disc::Disc;
pub use implicit::Implicit;
pub use patch::PatchShape;
pub use plane::Plane;
pub use rect::Rect;
pub use sphere::Sphere;
pub use swept::{Form, Swept};
pub use torus::Torus;
pub use triangle::Triangle;

use crate::math::elementary::atan2;
use crate::math::exact::{exponent, power_of_two};
use crate::math::{Aabb, Affine};
use crate::world::texture::TextureFault;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A ray in some space, its direction scaled by a power of two where its largest component is not in [½, 2), as those of unit vectors are.
#[derive(Clone, Copy, Debug)]
pub struct LocalRay {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes.
    pub direction: DVec3,
}

impl LocalRay {
    /// The ray, and how many of its distances make one of `direction`'s. None where the direction is 0 or not finite.
    #[inline]
    pub fn new(origin: DVec3, direction: DVec3) -> Option<(LocalRay, f64)> {
        let size = direction.abs();
        let larger = if size.x > size.y { size.x } else { size.y };
        let largest = if size.z > larger { size.z } else { larger };
        if !(0.5..2.0).contains(&largest) {
            return LocalRay::scaled(origin, direction, exponent(largest));
        }
        // What is no number may hide behind what is.
        let is_finite = !direction.element_sum().is_nan();
        is_finite.then_some((LocalRay { origin, direction }, 1.0))
    }

    /// By 2 to the power of minus e.
    fn scaled(origin: DVec3, direction: DVec3, e: i32) -> Option<(LocalRay, f64)> {
        let scaled = direction * power_of_two(-e);
        // What is infinite is the largest.
        let is_finite = (-1022..=1023).contains(&e) && !scaled.element_sum().is_nan();
        is_finite.then_some((LocalRay { origin, direction: scaled }, power_of_two(e)))
    }

    /// The same ray in the space that `transform` maps from, and how many of its distances make one of these.
    pub fn into_local(&self, transform: &Affine) -> Option<(LocalRay, f64)> {
        let origin = transform.inverse_linear * self.origin + transform.inverse_translation;
        LocalRay::new(origin, transform.inverse_linear * self.direction)
    }

    /// The point at a distance.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}

/// That a ray meets a shape, and what its test already knows of where.
#[derive(Clone, Copy, Debug, Default)]
pub struct Meet {
    /// Distance along the local ray.
    pub t: f64,
    /// What the shape's test leaves for its surface: barycentric coordinates of the second and third corner of a triangle.
    pub a: f64,
    /// The second such number.
    pub b: f64,
    /// Which face of a shape that has several; the triangle of a mesh among solids that are put together.
    pub face: u32,
    /// Which of the solids that are put together, and more that [`Csg`] alone reads; else 0.
    pub part: u32,
}

/// Whether a distance along a ray counts.
fn ahead(t: f64) -> bool {
    t > 0.0 && t.is_finite()
}

impl Meet {
    /// At a distance, with nothing else known.
    pub fn at(t: f64) -> Meet {
        Meet { t, ..Meet::default() }
    }
}

/// A point of a surface, in its shape's space.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// The point, on the surface up to `error`.
    pub point: DVec3,
    /// Bound on the absolute error of each coordinate.
    pub error: DVec3,
    /// Unit geometric normal, outward.
    pub geometric_normal: DVec3,
    /// Shading normal, not 0.
    pub normal: DVec3,
    /// Along growing u; 0 where u has no direction.
    pub tangent: DVec3,
    /// Surface parameters.
    pub uv: Uv,
}

/// Surface parameters, or what they follow from: few materials ask.
#[derive(Clone, Copy, Debug)]
pub enum Uv {
    /// They are known.
    At(DVec2),
    /// By longitude from −z and latitude of a unit vector, 0 … 1 each.
    Around(DVec3),
}

impl Uv {
    /// The parameters.
    pub fn get(self) -> DVec2 {
        match self {
            Uv::At(uv) => uv,
            Uv::Around(out) => {
                let horizontal = DVec2::new(out.x, out.z).length();
                DVec2::new(0.5 + atan2(out.x, out.z) / TAU, 0.5 + atan2(out.y, horizontal) / PI)
            }
        }
    }
}

impl Default for Uv {
    fn default() -> Uv {
        Uv::At(DVec2::ZERO)
    }
}

impl From<DVec2> for Uv {
    fn from(uv: DVec2) -> Uv {
        Uv::At(uv)
    }
}

/// The shapes. Small ones are held in place, so that a million spheres are one array.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "each is named for its type")]
pub enum Shape {
    Sphere(Sphere),
    Plane(Plane),
    Disc(Box<Disc>),
    Rect(Box<Rect>),
    Cuboid(Box<Cuboid>),
    Cone(Box<Cone>),
    Torus(Box<Torus>),
    Triangle(Box<Triangle>),
    Csg(Arc<Csg>),
    Patch(Arc<PatchShape>),
    Swept(Arc<Swept>),
    Implicit(Arc<Implicit>),
}

impl Shape {
    /// The nearest meeting in (0, limit].
    #[inline]
    pub fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        match self {
            Shape::Sphere(s) => s.meet(ray, limit),
            Shape::Plane(s) => s.meet(ray, limit),
            Shape::Disc(s) => s.meet(ray, limit),
            Shape::Rect(s) => s.meet(ray, limit),
            Shape::Cuboid(s) => s.meet(ray, limit),
            Shape::Cone(s) => s.meet(ray, limit),
            Shape::Torus(s) => s.meet(ray, limit),
            Shape::Triangle(s) => s.meet(ray, limit),
            Shape::Csg(s) => s.meet(ray, limit),
            Shape::Patch(s) => s.meet(ray, limit),
            Shape::Swept(s) => s.meet(ray, limit),
            Shape::Implicit(s) => s.meet(ray, limit),
        }
    }

    /// A meeting in (0, limit], found where [`Shape::meet`] finds one, but perhaps another, or not quite where it is.
    #[inline]
    pub fn meet_any(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        match self {
            Shape::Csg(s) => s.meet_any(ray, limit),
            Shape::Implicit(s) => s.meet_any(ray, limit),
            Shape::Sphere(_) | Shape::Plane(_) | Shape::Disc(_) | Shape::Rect(_) | Shape::Cuboid(_) => {
                self.meet(ray, limit)
            }
            Shape::Cone(_) | Shape::Torus(_) | Shape::Triangle(_) | Shape::Patch(_) | Shape::Swept(_) => {
                self.meet(ray, limit)
            }
        }
    }

    /// Every meeting with a finite t > 0, appended in ascending order; the first is the meeting that [`Shape::meet`] gives, to the bit.
    ///
    /// For a closed shape each passes from outside to inside or back, and where the ray only touches it the meeting stands twice.
    /// So the ray starts inside exactly where the count is odd, and a walk over the list that toggles at each is never
    /// wrong about the inside, whatever was rounded. A plane, closed at infinity, is inside at the ray's end where the ray goes
    /// against its normal.
    pub fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        match self {
            Shape::Sphere(s) => s.crossings(ray, out),
            Shape::Torus(s) => s.crossings(ray, out),
            Shape::Cuboid(s) => s.crossings(ray, out),
            Shape::Cone(s) => s.crossings(ray, out),
            Shape::Csg(s) => s.crossings(ray, out),
            Shape::Patch(s) => s.crossings(ray, out),
            Shape::Swept(s) => s.crossings(ray, out),
            Shape::Implicit(s) => s.crossings(ray, out),
            Shape::Plane(_) | Shape::Disc(_) | Shape::Rect(_) | Shape::Triangle(_) => {
                out.extend(self.meet(ray, f64::MAX));
            }
        }
    }

    /// Whether a ray starts inside a closed shape that it meets so many times. The plane's inside is below it.
    pub fn starts_inside(&self, ray: &LocalRay, n_crossings: usize) -> bool {
        match self {
            Shape::Plane(s) => s.starts_below(ray, n_crossings > 0),
            Shape::Csg(s) => s.starts_inside(ray),
            Shape::Implicit(s) => s.starts_inside(ray),
            _ => n_crossings % 2 == 1,
        }
    }

    /// The surface where a ray met it.
    #[inline]
    pub fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        match self {
            Shape::Sphere(s) => s.surface(ray, meet),
            Shape::Plane(s) => s.surface(ray, meet),
            Shape::Disc(s) => s.surface(ray, meet),
            Shape::Rect(s) => s.surface(ray, meet),
            Shape::Cuboid(s) => s.surface(ray, meet),
            Shape::Cone(s) => s.surface(ray, meet),
            Shape::Torus(s) => s.surface(ray, meet),
            Shape::Triangle(s) => s.surface(meet),
            Shape::Csg(s) => s.surface(ray, meet).whole,
            Shape::Patch(s) => s.surface(ray, meet),
            Shape::Swept(s) => s.surface(ray, meet),
            Shape::Implicit(s) => s.surface(ray, meet),
        }
    }

    /// Whether there is no surface at a meeting, but a place where it is not known.
    fn is_unknown(&self, meet: &Meet) -> bool {
        matches!(self, Shape::Implicit(_) if meet.face >= implicit::UNDEFINED)
    }

    /// Why there is no surface at a meeting, where there is none: a function of the scene is undefined there.
    pub fn fault(&self, ray: &LocalRay, meet: &Meet) -> Option<TextureFault> {
        match self {
            Shape::Implicit(s) => s.fault(ray, meet),
            Shape::Csg(s) => s.fault(ray, meet),
            _ => None,
        }
    }

    /// A box around it, infinite for a plane; in the space that `transform` maps to.
    pub fn bounds(&self, transform: Option<&Affine>) -> Aabb {
        let local = match (self, transform) {
            (Shape::Sphere(s), _) => return s.bounds(transform),
            (Shape::Plane(_), _) => return EVERYTHING,
            (Shape::Csg(s), _) => return s.bounds(transform),
            (Shape::Disc(s), _) => s.bounds(),
            (Shape::Rect(s), _) => s.bounds(),
            (Shape::Cuboid(s), _) => s.bounds(),
            (Shape::Cone(s), _) => s.bounds(),
            (Shape::Torus(s), _) => s.bounds(),
            (Shape::Triangle(s), _) => s.bounds(),
            (Shape::Patch(s), _) => s.bounds(),
            (Shape::Swept(s), _) => s.bounds(),
            (Shape::Implicit(s), _) => s.bounds(),
        };
        transform.map_or(local, |transform| image_of(local, transform))
    }
}

/// All of space.
pub const EVERYTHING: Aabb = Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

/// The box around a box's image, widened by the rounding of the map.
pub fn image_of(bounds: Aabb, transform: &Affine) -> Aabb {
    let reach = bounds.min.abs().max(bounds.max.abs());
    let linear = transform.linear;
    let terms = linear.x_axis.abs() * reach.x + linear.y_axis.abs() * reach.y + linear.z_axis.abs() * reach.z;
    padded(transform.aabb(bounds), (terms + transform.translation.abs()) * crate::math::error::gamma(6))
}

/// The box with each side moved outward.
pub fn padded(bounds: Aabb, by: DVec3) -> Aabb {
    Aabb { min: bounds.min - by, max: bounds.max + by }
}

/// A unit vector perpendicular to a unit vector (Duff et al., *Building an orthonormal basis, revisited*, 2017).
pub fn perpendicular(n: DVec3) -> DVec3 {
    let sign = 1.0f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    DVec3::new(1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x)
}

/// Unit vectors u and v of a plane with unit normal n: u is horizontal and u × v = n, so that a picture on a wall stands upright;
/// on a floor u is x.
pub fn upright(n: DVec3) -> (DVec3, DVec3) {
    let u = DVec3::Y.cross(n).try_normalize().unwrap_or(DVec3::X);
    (u, n.cross(u))
}
