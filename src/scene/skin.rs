//! Skins: a surface at rest, the bones that move it, and how. Nothing is cut into triangles or moved here.

use super::{MeshSource, SampledFunction, Surface};
use crate::diag::Span;
use crate::geometry::skeleton::Bone;
use crate::geometry::skin::{Blend, Influences, Motion};
use crate::math::Affine;
use std::sync::Arc;

/// A surface that bends with bones, shared between its placements.
#[derive(Clone, Debug)]
pub struct Skin {
    /// What bends.
    pub surface: SkinSurface,
    /// From the surface's own space to that of the bones; none is the identity.
    pub transform: Option<Affine>,
    /// The bones, shared between the parts of a figure.
    pub armature: Arc<Armature>,
    /// How much each joint moves each point.
    pub weights: Weights,
    /// How the joints' motions are mixed.
    pub blend: Blend,
    /// Largest distance of triangles from the bent surface, in the units of the bones; none is under a quarter pixel.
    pub tolerance: Option<f64>,
}

/// Bones at rest, and where a pose takes them.
#[derive(Clone, Debug)]
pub struct Armature {
    /// Names of the joints, by number.
    pub names: Vec<Box<str>>,
    /// Where they are at rest.
    pub bones: Vec<Bone>,
    /// What the pose does to each joint, by number.
    pub motions: Vec<Motion>,
}

/// A surface that can be given vertices.
#[derive(Clone, Debug)]
pub enum SkinSurface {
    /// It has them.
    Mesh(Arc<MeshSource>),
    /// It is cut into triangles as finely as its motion asks.
    Curved(Arc<Surface>),
}

/// How much each joint moves each point.
#[derive(Clone, Debug)]
pub enum Weights {
    /// The nearest bone alone.
    Rigid,
    /// By distance from the bones, of which at most so many joints count.
    Smooth(usize),
    /// A row for each vertex of a mesh, and where they were given.
    Listed(Arc<Influences>, Span),
    /// A function of the point at rest, to a weight for each joint, and where it was given.
    Function(Arc<SampledFunction>, Span),
}
