//! Curved surfaces as a scene has them: exact control points and curves, or the file that holds them. Nothing is tessellated or prepared for
//! rays here.

use crate::diag::Span;
use crate::geometry::measured::Measured;
use crate::geometry::patch::Patch;
use crate::geometry::path::Path;
use crate::geometry::surface::cubic::{self, Cubic};
use crate::geometry::surface::lathe::Lathe;
use crate::geometry::surface::tube::Caps;
use glam::{DVec2, DVec3};
use std::path::PathBuf;
use std::sync::Arc;

/// A surface made of cubics, shared between its placements.
#[derive(Clone, Debug)]
pub enum Surface {
    /// Bicubic patches.
    Patch(PatchSource),
    /// The solid that a ball fills as it rolls along a curve.
    Tube(TubeSource),
    /// A profile turned about the y axis.
    Lathe(LatheSource),
    /// A closed outline moved along a line or a curve.
    Extrude(ExtrudeSource),
}

/// Bicubic patches, and how they are to be drawn.
#[derive(Clone, Debug)]
pub struct PatchSource {
    /// Their control points.
    pub net: PatchNet,
    /// How rays meet them; none leaves it to the picture.
    pub method: Option<PatchMethod>,
    /// Largest distance of triangles from the surface, in the units of its points; none is under a quarter pixel.
    pub tolerance: Option<f64>,
}

/// Where control points come from.
#[derive(Clone, Debug)]
pub enum PatchNet {
    /// Written in the scene.
    Inline(Patch),
    /// A `.bpt` file, read when a picture needs it.
    File {
        /// Path, already joined to the folder of the file that names it.
        path: PathBuf,
        /// The `file` property's value.
        span: Span,
    },
}

/// How rays meet a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatchMethod {
    /// As triangles within the tolerance, joined without cracks.
    Tessellated,
    /// The surface itself, every root isolated.
    Direct,
}

/// A tube: its kernel's faults were looked for when it was made.
#[derive(Clone, Debug)]
pub struct TubeSource {
    /// The curve of its centre.
    pub along: Arc<Measured<DVec3>>,
    /// Its radius.
    pub radius: Radius,
    /// How it ends where the curve is open.
    pub caps: Caps,
}

/// The radius of a tube, scene units.
#[derive(Clone, Debug)]
pub enum Radius {
    /// The same all along, above 0.
    Constant(f64),
    /// Along a curve of numbers whose domain is stretched over the centre's.
    Along(Arc<Measured<f64>>),
}

/// A surface of revolution.
#[derive(Clone, Debug)]
pub struct LatheSource {
    /// Distance from the y axis, never below 0, and height.
    pub profile: Arc<Measured<DVec2>>,
    /// How far it goes round, degrees in (0, 360].
    pub angle: f64,
}

/// An outline moved along something.
#[derive(Clone, Debug)]
pub struct ExtrudeSource {
    /// Closed.
    pub outline: Arc<Measured<DVec2>>,
    /// Along what.
    pub along: Along,
}

/// What an outline is moved along.
#[derive(Clone, Debug)]
pub enum Along {
    /// A vector, not 0.
    Vector(DVec3),
    /// A curve without corners.
    Path(Arc<Measured<DVec3>>),
}

impl Radius {
    /// Its cubic pieces.
    pub fn pieces(&self) -> Vec<Cubic<f64>> {
        match self {
            Radius::Constant(radius) => vec![Cubic { start: 0.0, end: 1.0, points: [*radius; 4] }],
            Radius::Along(curve) => cubic::of_measured(curve),
        }
    }
}

impl Surface {
    /// Whether it has an inside.
    pub fn is_solid(&self) -> bool {
        match self {
            Surface::Patch(_) => false,
            Surface::Tube(tube) => tube.caps != Caps::Open || tube.along.closed(),
            Surface::Lathe(lathe) => {
                Lathe::is_closed(&cubic::of_measured(&lathe.profile), lathe.profile.closed())
            }
            Surface::Extrude(_) => true,
        }
    }

    /// The kind that makes it.
    pub fn word(&self) -> &'static str {
        match self {
            Surface::Patch(_) => "patch",
            Surface::Tube(_) => "tube",
            Surface::Lathe(_) => "lathe",
            Surface::Extrude(_) => "extrude",
        }
    }
}
