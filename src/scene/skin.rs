//! Skins: a surface at rest, the bones that move it, and how. Nothing is cut into triangles or moved here.

use super::{MeshSource, SampledFunction, Surface};
use crate::diag::{Code, Diagnostic, Span};
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

impl Weights {
    /// Whether they follow from where a point is, so that places between two vertices have weights too that change without a jump.
    pub fn follow_the_point(&self) -> bool {
        matches!(self, Weights::Smooth(_) | Weights::Function(..))
    }
}

/// That a row of weights cannot be used. `whose` says which: "of vertex 3", "at <1, 2, 3>".
pub fn unusable_weights(place: Option<Span>, whose: &str, why: &str) -> Diagnostic {
    Diagnostic::new(Code::BadWeights, place, format!("the weights {whose} cannot be used: {why}"))
        .hint("give each joint a weight of 0 or more, and one of them more than 0")
}

/// That rows of weights were divided by their sums, as the first of them shows.
pub fn divided_weights(place: Option<Span>, whose: &str, sum: f64) -> Diagnostic {
    let message = format!("the weights {whose} add up to {sum}, and not to 1");
    Diagnostic::new(Code::WeightsNormalised, place, message)
        .label("all weights were divided by their sums")
        .hint("divide by the sum yourself, so that nothing is changed behind your back")
}
