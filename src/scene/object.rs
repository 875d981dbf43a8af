//! Objects: a shape, where it stands, what it is made of, and where in the text it was written.

use super::{Light, Material, ModelSource, SampledFunction, Skin, Surface};
use crate::diag::Span;
use crate::geometry::mesh::Mesh;
use crate::math::Affine;
use glam::{DVec2, DVec3};
use std::path::PathBuf;
use std::sync::Arc;

/// What stands in a scene or a group.
#[derive(Clone, Debug)]
pub enum Node {
    /// An object. Shared shapes (`Arc`s inside [`Shape`]) are instances of one another.
    Object(Arc<Object>),
    /// A light.
    Light(Arc<Light>),
}

/// A placed or placeable object. Small, because a scene may hold millions.
#[derive(Clone, Debug)]
pub struct Object {
    /// What it is, in its own space.
    pub shape: Shape,
    /// Parent from local; none is the identity.
    pub transform: Option<Box<Affine>>,
    /// Its material; none takes its group's, and white plaster (diffuse 0.8) in the end.
    pub material: Option<Arc<Material>>,
    /// `name "…"`.
    pub name: Option<Box<str>>,
    /// Where it was written: the block, or the `with` that made this copy.
    pub span: Span,
    /// From whom it is hidden.
    pub hide: Hide,
}

impl Object {
    /// An object of a shape with nothing else said.
    pub fn new(shape: Shape, span: Span) -> Self {
        Object { shape, transform: None, material: None, name: None, span, hide: Hide::default() }
    }

    /// Applies a transform after those that it already has.
    pub fn transform_by(&mut self, next: &Affine) {
        let before = self.transform.as_deref().copied().unwrap_or_default();
        self.transform = Some(Box::new(before.then(next)));
    }
}

/// The rays that do not see an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hide {
    /// Camera rays pass through.
    pub camera: bool,
    /// It casts no shadow.
    pub shadow: bool,
    /// Reflected and refracted rays pass through.
    pub reflection: bool,
}

/// The geometry of an object in its own space. Lengths in scene units; axes and normals are unit vectors.
#[derive(Clone, Debug)]
pub enum Shape {
    /// |p − center| = radius > 0. u is the longitude from −z… see the reference; v the latitude from the south pole.
    Sphere {
        /// Centre.
        center: DVec3,
        /// Radius, positive.
        radius: f64,
    },
    /// Infinite plane n·p = offset, solid on the side its normal leaves.
    Plane {
        /// Unit normal.
        normal: DVec3,
        /// n·p on the plane.
        offset: f64,
    },
    /// Flat disc.
    Disc(Box<Disc>),
    /// Parallelogram center ± a ± b; normal a × b.
    Rect(Box<Rect>),
    /// Axis-aligned box, min < max.
    Box(Box<(DVec3, DVec3)>),
    /// Capped cylinder or cone.
    Cone(Box<Cone>),
    /// Torus.
    Torus(Box<Torus>),
    /// A single triangle.
    Triangle(Box<Triangle>),
    /// A mesh, shared between its placements.
    Mesh(Arc<MeshSource>),
    /// A curved surface, shared between its placements.
    Surface(Arc<Surface>),
    /// A surface that bends with bones, shared between its placements.
    Skin(Arc<Skin>),
    /// A model of a file, shared between its placements.
    Model(Arc<ModelSource>),
    /// Children, shared between placements of the group.
    Group(Arc<[Node]>),
    /// Solids put together, shared between placements.
    Csg(Arc<Csg>),
    /// Where a function is 0, shared between placements.
    Implicit(Arc<Implicit>),
}

/// An implicit surface: where a function of the point is 0 within a box, solid where it is negative.
#[derive(Clone, Debug)]
pub struct Implicit {
    /// Of the point, to one number.
    pub function: Arc<SampledFunction>,
    /// The least and the greatest corner of the box, in this order in each coordinate.
    pub within: (DVec3, DVec3),
    /// A promise that the gradient's length does not exceed this, and where it was given.
    pub gradient: Option<(f64, Span)>,
}

impl Shape {
    /// What stands inside a group or a solid put together; nothing for all else.
    pub fn children(&self) -> &[Node] {
        match self {
            Shape::Group(children) => children,
            Shape::Csg(csg) => &csg.children,
            Shape::Sphere { .. } | Shape::Plane { .. } | Shape::Disc(_) | Shape::Rect(_) | Shape::Box(_) => {
                &[]
            }
            Shape::Cone(_) | Shape::Torus(_) | Shape::Triangle(_) => &[],
            Shape::Mesh(_) | Shape::Surface(_) | Shape::Skin(_) | Shape::Model(_) | Shape::Implicit(_) => &[],
        }
    }
}

/// Solids put together (constructive solid geometry). Groups among the children stand for the union of what they hold.
#[derive(Clone, Debug)]
pub struct Csg {
    /// How.
    pub op: CsgOp,
    /// Whether inside and outside are exchanged.
    pub inverse: bool,
    /// The solids, in order; no lights.
    pub children: Arc<[Node]>,
}

/// How solids are put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CsgOp {
    /// Inside any.
    Union,
    /// Inside all.
    Intersection,
    /// Inside the first alone.
    Difference,
}

impl CsgOp {
    /// The word of the language.
    pub fn word(self) -> &'static str {
        match self {
            CsgOp::Union => "union",
            CsgOp::Intersection => "intersection",
            CsgOp::Difference => "difference",
        }
    }
}

/// A flat disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Centre.
    pub center: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// Radius, positive.
    pub radius: f64,
}

/// A parallelogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Centre.
    pub center: DVec3,
    /// First half-edge; u runs along it.
    pub a: DVec3,
    /// Second half-edge; v runs along it.
    pub b: DVec3,
}

/// A capped frustum: `from`, `to` on the axis and a radius at each (one may be 0; equal radii make a cylinder).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Centre of the first cap.
    pub from: DVec3,
    /// Centre of the second cap.
    pub to: DVec3,
    /// Radii at `from` and `to`, ≥ 0, not both 0.
    pub radii: [f64; 2],
}

/// A torus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Centre.
    pub center: DVec3,
    /// Unit axis of symmetry.
    pub axis: DVec3,
    /// Radius of the ring's centre line, and of the tube; both positive. A spindle (minor > major) is allowed.
    pub radii: [f64; 2],
}

/// A triangle with optional corner data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners, counterclockwise seen from outside.
    pub vertices: [DVec3; 3],
    /// Unit shading normals at the corners.
    pub normals: Option<[DVec3; 3]>,
    /// Texture coordinates at the corners.
    pub uvs: Option<[DVec2; 3]>,
}

/// Where a mesh comes from.
#[derive(Clone, Debug)]
pub enum MeshSource {
    /// A file, read when a picture needs it.
    File {
        /// Path, already joined to the folder of the file that names it.
        path: PathBuf,
        /// `smooth on` or `off`; none follows the file (its normals and smoothing groups).
        smooth: Option<bool>,
        /// The `file` property's value.
        span: Span,
    },
    /// Written in the scene.
    Inline(Mesh),
}
