//! Lights as they are written.

use super::assets::image::Picture;
use super::{Object, Rgb};
use crate::diag::Span;
use crate::math::Affine;
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// A light source.
#[derive(Clone, Debug)]
pub struct Light {
    /// What it is.
    pub source: LightSource,
    /// `a r² + b r + c` instead of r², where it is given.
    pub falloff: Option<[f64; 3]>,
    /// Whether it casts shadows.
    pub shadow: bool,
    /// Samples that whitted takes of an area or sky light at the first hit.
    pub samples: u32,
    /// Parent from local.
    pub transform: Option<Box<Affine>>,
    /// Where it was written.
    pub span: Span,
}

/// The forms of a light. Directions say where the light goes.
#[derive(Clone, Debug)]
pub enum LightSource {
    /// From a point to all sides.
    Point {
        /// Where.
        position: DVec3,
        /// W/sr per colour channel.
        intensity: Rgb,
    },
    /// From a point into a cone.
    Spot {
        /// Where.
        position: DVec3,
        /// Unit vector along the axis, away from the light.
        direction: DVec3,
        /// Half-angles in degrees: full light inside the first, none outside the second.
        cone: [f64; 2],
        /// W/sr on the axis.
        intensity: Rgb,
    },
    /// Parallel light.
    Sun {
        /// Unit vector along which the light travels.
        direction: DVec3,
        /// W/m² on a surface that faces it.
        irradiance: Rgb,
    },
    /// An emitting surface, which is also seen; emits along its normal.
    Area {
        /// Rect, disc, sphere, triangle or mesh, perhaps transformed.
        object: Arc<Object>,
        /// W/(m² sr).
        radiance: Rgb,
    },
    /// From all directions, behind everything.
    Sky(Sky),
}

/// The radiance of the sky.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// The same everywhere.
    Uniform(Rgb),
    /// An equirectangular picture: its middle toward −z, its upper edge toward +y, its right half toward +x.
    Image {
        /// Path, joined to the folder of the file that names it.
        path: PathBuf,
        /// Multiplies the picture's light.
        factor: Rgb,
        /// The name, where it is given.
        span: Span,
        /// The picture itself, once it is read.
        picture: Picture,
    },
}
