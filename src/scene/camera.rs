//! The camera as it is written.

use crate::diag::Span;
use glam::DVec3;

/// A camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Its label, where it has one.
    pub label: Option<Box<str>>,
    /// Where it stands.
    pub eye: DVec3,
    /// What it looks at.
    pub look_at: DVec3,
    /// Up in the picture (y).
    pub up: DVec3,
    /// Full vertical angle of view in degrees; for orthographic, the height of the picture is 2·|look_at − eye|·tan(fov/2).
    pub fov: f64,
    /// How directions become pixels.
    pub projection: Projection,
    /// Diameter of the lens in scene units; 0 is a pinhole.
    pub aperture: f64,
    /// Distance from the eye that is sharp; none is that of `look_at`.
    pub focus: Option<f64>,
    /// Where it was written.
    pub span: Span,
}

/// How directions become pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Straight lines stay straight.
    Perspective,
    /// Parallel rays.
    Orthographic,
    /// Equidistant: the angle from the axis is proportional to the distance from the middle; `fov` spans the height.
    Fisheye,
    /// 360° × 180° equirectangular; `fov` is not used.
    Panorama,
}
