//! Where a ray met a surface, and the rays that go on from there.
//!
//! A point on a surface is known up to a bound on its rounding error, so a new ray starts far enough along the normal to be
//! clear of the surface whatever the rounding was, and no farther: no absolute distance appears. Pharr, Jakob & Humphreys,
//! *Physically Based Rendering* (4th ed.) §6.8.

use super::bsdf::Coat;
use super::shape::mesh::WornPlace;
use super::shape::{Uv, perpendicular};
use super::texture::TextureFault;
use super::{PrimitiveId, Ray, RayKind};
use crate::math::error::gamma;
use crate::scene::Material;
use glam::{DVec2, DVec3};

/// Where a ray meets a surface. Everything in world space unless said otherwise.
#[derive(Clone, Debug)]
pub struct Hit<'w> {
    /// Distance along the ray, in multiples of its direction's length.
    pub t: f64,
    /// The point, put back onto the surface.
    pub point: DVec3,
    /// Bound on the absolute error of each coordinate of `point`.
    pub error: DVec3,
    /// Unit geometric normal, outward for closed shapes whatever the transforms.
    pub geometric_normal: DVec3,
    /// Unit shading normal, on the geometric normal's side.
    pub normal: DVec3,
    /// Along growing u, of any length and not quite perpendicular to `normal`; 0 where u has no direction.
    pub(super) along_u: DVec3,
    /// Surface parameters.
    pub(super) uv: Uv,
    /// The point in the object's own space before its transforms, for solid patterns.
    pub local_point: DVec3,
    /// The place of the skin that was hit, for patterns of weights; none on what is no skin.
    pub worn: Option<WornPlace<'w>>,
    /// What it is made of.
    pub(super) coat: &'w Coat,
    /// Why the surface is not known here: a function that makes it has no value. The pixel says so.
    pub fault: Option<TextureFault>,
    /// Which primitive of the world, for provenance and for emitters.
    pub primitive: PrimitiveId,
}

/// A point on a surface with what is needed to start or end a ray there.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// The point.
    pub point: DVec3,
    /// Bound on the absolute error of each coordinate.
    pub error: DVec3,
    /// Unit geometric normal.
    pub normal: DVec3,
}

impl SurfacePoint {
    /// The point moved clear of its surface, to the side that `direction` points to: by the bound along the normal, and by what
    /// rounding the sum may undo, which is half a step of each coordinate and is counted twice.
    #[inline]
    pub fn offset_toward(&self, direction: DVec3) -> DVec3 {
        let distance = self.normal.abs().dot(self.error + self.point.abs() * f64::EPSILON);
        let along = if direction.dot(self.normal) < 0.0 { -distance } else { distance };
        self.point + self.normal * along
    }
}

impl Hit<'_> {
    /// Unit tangent along growing u, perpendicular to `normal` (arbitrary where u has no direction).
    pub fn tangent(&self) -> DVec3 {
        tangent_for(self.normal, self.along_u)
    }

    /// What it is made of.
    pub fn material(&self) -> &Material {
        &self.coat.material
    }

    /// True where what is met surely emits nothing and hides what is behind it.
    pub fn is_dark(&self) -> bool {
        self.coat.is_dark()
    }

    /// Surface parameters.
    pub fn uv(&self) -> DVec2 {
        self.uv.get()
    }

    /// The point with its error and geometric normal.
    #[inline]
    pub fn surface_point(&self) -> SurfacePoint {
        SurfacePoint { point: self.point, error: self.error, normal: self.geometric_normal }
    }

    /// A ray without end from the point, clear of the surface on the side that `direction` points to.
    pub fn spawn(&self, direction: DVec3, kind: RayKind) -> Ray {
        let origin = self.surface_point().offset_toward(direction);
        Ray { origin, direction, t_max: f64::INFINITY, kind }
    }

    /// A shadow ray to a point in space (not on a surface): unit direction, `t_max` the distance.
    #[inline]
    pub fn spawn_to(&self, target: DVec3) -> Ray {
        let origin = self.surface_point().offset_toward(target - self.point);
        shadow_ray(origin, target)
    }

    /// A shadow ray to a point on a surface: ends clear of that surface by its own bound.
    pub fn spawn_to_surface(&self, target: &SurfacePoint) -> Ray {
        let origin = self.surface_point().offset_toward(target.point - self.point);
        shadow_ray(origin, target.offset_toward(self.point - target.point))
    }
}

/// Ends short of the target by the rounding of the distance and of the direction (a length is 4 roundings, a quotient 1).
#[inline]
fn shadow_ray(origin: DVec3, target: DVec3) -> Ray {
    let to = target - origin;
    let distance = to.length();
    let t_max = distance * (1.0 - gamma(8));
    Ray { origin, direction: to / distance, t_max, kind: RayKind::Shadow }
}

/// The unit tangent nearest to one that need not be perpendicular, or any where there is none.
fn tangent_for(normal: DVec3, along: DVec3) -> DVec3 {
    let size = along.abs().max_element();
    let scaled = along / size;
    let across = scaled - normal * normal.dot(scaled);
    // What is left of a tangent that is the normal up to rounding points nowhere.
    let usable = size > 0.0 && across.length_squared() > gamma(16) * gamma(16);
    let chosen = if usable { across.try_normalize() } else { None };
    chosen.unwrap_or_else(|| perpendicular(normal))
}
