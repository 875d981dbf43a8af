//! What a `render` block says; every member is optional, so that the command line can override each and defaults stand in
//! one place.

use super::Rgb;
use crate::diag::Span;

/// The `render` block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderSettings {
    /// Width and height in pixels.
    pub size: Option<[u32; 2]>,
    /// The tracer.
    pub tracer: Option<TracerKind>,
    /// Samples per pixel.
    pub samples: Option<u32>,
    /// Most segments from the camera.
    pub depth: Option<u32>,
    /// Of every random number.
    pub seed: Option<u64>,
    /// How even they are.
    pub sampler: Option<SamplerKind>,
    /// How a pixel gathers its samples.
    pub filter: Option<PixelFilter>,
    /// Most radiance of a camera sample in any colour.
    pub clamp: Option<f64>,
    /// The tree.
    pub accelerator: Option<Accelerator>,
    /// In stops.
    pub exposure: Option<f64>,
    /// On 8-bit output only.
    pub tonemap: Option<ToneMap>,
    /// Seen where nothing else is; lights nothing.
    pub background: Option<Rgb>,
    /// How many frames an animation has.
    pub frames: Option<u32>,
    /// Frames per second.
    pub fps: Option<f64>,
    /// Where it was written.
    pub span: Option<Span>,
    /// Where its `size` was.
    pub size_span: Option<Span>,
}

impl RenderSettings {
    /// Frames per second where nothing is said.
    pub const FPS: f64 = 24.0;
}

/// The tracers by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are the words of the language")]
pub enum TracerKind {
    Raycast,
    Whitted,
    MonteCarlo,
    Path,
    Irradiance,
    Photon,
}

impl TracerKind {
    /// Its word in the language.
    pub fn word(self) -> &'static str {
        match self {
            TracerKind::Raycast => "raycast",
            TracerKind::Whitted => "whitted",
            TracerKind::MonteCarlo => "montecarlo",
            TracerKind::Path => "path",
            TracerKind::Irradiance => "irradiance",
            TracerKind::Photon => "photon",
        }
    }
}

/// The kinds of random numbers by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplerKind {
    /// Owen-scrambled Sobol points.
    #[default]
    Sobol,
    /// One point in each cell of a grid over all samples of the pixel.
    Stratified,
    /// Each by itself.
    Independent,
}

impl SamplerKind {
    /// Its word in the language.
    pub fn word(self) -> &'static str {
        match self {
            SamplerKind::Sobol => "sobol",
            SamplerKind::Stratified => "stratified",
            SamplerKind::Independent => "independent",
        }
    }
}

/// The reconstruction filters by name: by what a pixel weighs light around its centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PixelFilter {
    /// Evenly over its square.
    #[default]
    Box,
    /// Falling off evenly to the neighbours' centres.
    Tent,
    /// A bell of half a pixel's deviation.
    Gaussian,
}

impl PixelFilter {
    /// Its word in the language.
    pub fn word(self) -> &'static str {
        match self {
            PixelFilter::Box => "box",
            PixelFilter::Tent => "tent",
            PixelFilter::Gaussian => "gaussian",
        }
    }
}

/// The accelerators by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Accelerator {
    /// Bounding-volume hierarchy.
    #[default]
    Bvh,
    /// kd-tree.
    KdTree,
    /// Every shape against every ray.
    None,
}

impl Accelerator {
    /// Its word in the language.
    pub fn word(self) -> &'static str {
        match self {
            Accelerator::Bvh => "bvh",
            Accelerator::KdTree => "kdtree",
            Accelerator::None => "none",
        }
    }
}

/// From linear radiance to 0 … 1 before sRGB.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// Clip at 1.
    #[default]
    None,
    /// c / (1 + c) on luminance.
    Reinhard,
    /// Narkowicz's fit of the ACES curve.
    Aces,
}

impl ToneMap {
    /// Its word in the language.
    pub fn word(self) -> &'static str {
        match self {
            ToneMap::None => "none",
            ToneMap::Reinhard => "reinhard",
            ToneMap::Aces => "aces",
        }
    }
}
