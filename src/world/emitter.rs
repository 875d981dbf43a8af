//! Lights where they stand, and surfaces that emit: what `light` prepares for sampling.

use super::PrimitiveId;
use crate::geometry::mesh::Mesh;
use crate::math::Affine;
use crate::scene::{Cone, Disc, Light, Material, Rect, Torus, Triangle};
use glam::DVec3;
use std::sync::Arc;

/// A point, spot, sun or sky light with the transforms around it.
#[derive(Clone, Debug)]
pub struct PlacedLight {
    /// As it was written. Its own `transform` is already part of `world_from_local`.
    pub light: Arc<Light>,
    /// From the light's own space to the world's.
    pub world_from_local: Affine,
}

/// A surface that emits `material.layers().emit` from the side its normal leaves.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// Its geometry, in its own space.
    pub shape: EmitterShape,
    /// From its own space to the world's.
    pub world_from_local: Affine,
    /// What a hit on it reports (with `part` 0; a mesh's hits report their triangle).
    pub primitive: PrimitiveId,
    /// What it is made of; `emit` is its radiance.
    pub material: Arc<Material>,
    /// The area light it is, for `shadow` and `samples`; none for an object whose material emits.
    pub light: Option<Arc<Light>>,
}

/// The geometry of an emitter.
#[derive(Clone, Debug)]
pub enum EmitterShape {
    /// |p − center| = radius.
    Sphere {
        /// Centre.
        center: DVec3,
        /// Radius.
        radius: f64,
    },
    /// A flat disc.
    Disc(Disc),
    /// A parallelogram.
    Rect(Rect),
    /// An axis-aligned box, by its corners.
    Box(DVec3, DVec3),
    /// A capped cylinder or cone.
    Cone(Cone),
    /// A torus.
    Torus(Torus),
    /// One triangle.
    Triangle(Triangle),
    /// Triangles of a mesh, by number, ascending.
    Mesh(Arc<Mesh>, Vec<u32>),
}

impl EmitterShape {
    /// Whether a primitive's part (a mesh's triangle, else 0) is of this emitter.
    pub fn has_part(&self, part: u32) -> bool {
        match self {
            EmitterShape::Mesh(_, triangles) => triangles.binary_search(&part).is_ok(),
            _ => true,
        }
    }
}
