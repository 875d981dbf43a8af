//! What rays see: the scene flattened into shapes, trees, lights and surfaces, ready for any number of threads.
//! Knows nothing of the language; a user's function reaches it as a [`crate::math::field::Field`].

pub mod bsdf;
pub mod bvh;
pub mod light;
pub mod lower;
pub mod shape;
pub mod texture;

use crate::diag::Span;
use crate::scene::{Material, Rgb};
use glam::{DVec2, DVec3};

/// A half-line, or a piece of one.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes; unit length up to rounding.
    pub direction: DVec3,
    /// Hits at or beyond this distance do not count.
    pub t_max: f64,
    /// What it is cast for, which decides what is hidden from it.
    pub kind: RayKind,
}

/// What a ray is cast for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the camera (and on through what is transparent to it).
    Camera,
    /// Toward a light.
    Shadow,
    /// Reflected, refracted or scattered.
    Indirect,
}

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
    /// Unit tangent along growing u, perpendicular to `normal` (arbitrary where u has no direction).
    pub tangent: DVec3,
    /// Surface parameters.
    pub uv: DVec2,
    /// The point in the object's own space before its transforms, for solid patterns.
    pub local_point: DVec3,
    /// The material.
    pub material: &'w Material,
    /// Which primitive of the world, for provenance and for emitters.
    pub primitive: PrimitiveId,
}

/// A primitive of the world as placed: which one, and through which placement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrimitiveId {
    /// The placement, 0 for the world's own primitives.
    pub instance: u32,
    /// The shape within it.
    pub shape: u32,
    /// The triangle within a mesh, else 0.
    pub part: u32,
}

/// Where a primitive came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// The block or `with` that made it.
    pub span: Span,
    /// The placements around it, outermost first.
    pub path: Vec<Span>,
    /// Its `name`, where it has one.
    pub name: Option<Box<str>>,
}

/// Everything that rays see.
pub struct World {}

/// A factor per colour channel.
pub type Transmittance = Rgb;
