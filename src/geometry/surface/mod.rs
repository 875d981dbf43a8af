//! Surfaces along curves: tubes, surfaces of revolution, prisms. Rays meet them exactly, and each can be cut into triangles.
//! Knows nothing of scenes or pictures.
//!
//! | module | what it is |
//! |---|---|
//! | [`cubic`] | the cubic pieces that all of them are made of |
//! | [`zeros`] | where a function along a piece is 0, none missed |
//! | [`span`] | stretches of a line, cut by planes |
//! | [`tube`] | what a ball fills that rolls along a curve |
//! | [`lathe`] | a profile turned about an axis |
//! | [`outline`] | closed curves in a plane |
//! | [`prism`], [`sweep`] | an outline moved along a line, and along a curve |

pub mod cubic;
#[cfg(test)]
mod extrude_tests;
pub mod lathe;
mod mesh;
pub mod outline;
pub mod prism;
pub mod span;
pub mod sweep;
pub mod tube;
pub mod zeros;

use glam::{DVec2, DVec3};

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Distance along the ray, in lengths of its direction.
    pub t: f64,
    /// Which part of the surface: of no meaning to others.
    pub part: u32,
    /// The place in the part.
    pub x: f64,
    /// The place in the part, of parts that have two coordinates.
    pub y: f64,
}

impl Touch {
    /// In a part of one coordinate.
    pub fn new(t: f64, part: u32, x: f64) -> Touch {
        Touch { t, part, x, y: 0.0 }
    }
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub point: DVec3,
    /// Unit normal, outward of what is solid.
    pub normal: DVec3,
    /// Along growing u.
    pub tangent: DVec3,
    /// Surface parameters.
    pub uv: DVec2,
}
