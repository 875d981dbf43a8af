//! What a picture is rendered with: the command line's words before the scene's, the scene's before the defaults.
//! Every default of the `render` block stands here and nowhere else.

use super::features::Layers;
use crate::scene::{Accelerator, PixelFilter, RenderSettings, Rgb, SamplerKind, ToneMap, TracerKind};

/// Settings with nothing left open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolvedSettings {
    /// Width and height of the whole picture in pixels; at least 1 each.
    pub size: [u32; 2],
    /// The part of it that is rendered.
    pub crop: Crop,
    /// The tracer.
    pub tracer: TracerKind,
    /// Samples per pixel, at least 1.
    pub samples: u32,
    /// Most segments of a path from the camera, the last of which may end on a light.
    pub depth: u32,
    /// Of every random number.
    pub seed: u64,
    /// How even they are.
    pub sampler: SamplerKind,
    /// How a pixel gathers its samples.
    pub filter: PixelFilter,
    /// Most radiance of a camera sample in any colour; none leaves every sample as it is.
    pub clamp: Option<f64>,
    /// The tree.
    pub accelerator: Accelerator,
    /// In stops; of 8-bit pictures.
    pub exposure: f64,
    /// Of 8-bit pictures.
    pub tonemap: ToneMap,
    /// Seen where nothing else is, in place of any sky; lights nothing.
    pub background: Option<Rgb>,
    /// Where each pixel is finished once the estimated error of its luminance, relative to it, is this; `samples` are then the most.
    pub error: Option<f64>,
    /// What of each pixel is written beside its radiance.
    pub layers: Layers,
    /// Whether noise is filtered out of the finished picture.
    pub denoise: bool,
    /// Threads; none takes as many as the machine has processors.
    pub threads: Option<usize>,
}

/// A rectangle of pixels inside a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Crop {
    /// All of a picture.
    pub fn all(size: [u32; 2]) -> Crop {
        Crop { x: 0, y: 0, width: size[0], height: size[1] }
    }

    /// How many pixels it holds.
    pub fn area(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// True where it holds a pixel and all that it holds are of the picture.
    pub fn fits(self, size: [u32; 2]) -> bool {
        let inside = |from: u32, n: u32, all: u32| n > 0 && from.checked_add(n).is_some_and(|end| end <= all);
        inside(self.x, self.width, size[0]) && inside(self.y, self.height, size[1])
    }
}

impl ResolvedSettings {
    /// Width and height where nothing is said.
    pub const SIZE: [u32; 2] = [640, 480];
    /// Samples a pixel of tracers that follow direct light only.
    pub const SAMPLES: u32 = 4;
    /// Samples a pixel of tracers that follow indirect light.
    pub const SAMPLES_INDIRECT: u32 = 64;
    /// Segments of a path of tracers that follow direct light only; the others end their paths by chance.
    pub const DEPTH: u32 = 8;

    /// The first of each setting that is given: by `overrides` (the command line), by the scene, by the defaults.
    pub fn new(scene: &RenderSettings, overrides: &RenderSettings) -> ResolvedSettings {
        let size = overrides.size.or(scene.size).unwrap_or(Self::SIZE).map(|n| n.max(1));
        let tracer = overrides.tracer.or(scene.tracer).unwrap_or(TracerKind::Whitted);
        ResolvedSettings {
            size,
            crop: Crop::all(size),
            tracer,
            samples: overrides.samples.or(scene.samples).unwrap_or(default_samples(tracer)).max(1),
            depth: overrides.depth.or(scene.depth).unwrap_or(default_depth(tracer)).max(1),
            seed: overrides.seed.or(scene.seed).unwrap_or(0),
            sampler: overrides.sampler.or(scene.sampler).unwrap_or_default(),
            filter: overrides.filter.or(scene.filter).unwrap_or_default(),
            clamp: overrides.clamp.or(scene.clamp),
            accelerator: overrides.accelerator.or(scene.accelerator).unwrap_or_default(),
            exposure: overrides.exposure.or(scene.exposure).unwrap_or(0.0),
            tonemap: overrides.tonemap.or(scene.tonemap).unwrap_or_default(),
            background: overrides.background.or(scene.background),
            error: None,
            layers: Layers::NONE,
            denoise: false,
            threads: None,
        }
    }
}

impl ResolvedSettings {
    /// What is kept of each pixel beside its radiance: what is written, and what the filter of noise goes by.
    pub fn kept(&self) -> Layers {
        if self.denoise { self.layers.and(Layers::GUIDES) } else { self.layers }
    }
}

fn default_samples(tracer: TracerKind) -> u32 {
    match tracer {
        TracerKind::Raycast | TracerKind::Whitted => ResolvedSettings::SAMPLES,
        TracerKind::MonteCarlo | TracerKind::Path | TracerKind::Irradiance | TracerKind::Photon => {
            ResolvedSettings::SAMPLES_INDIRECT
        }
    }
}

fn default_depth(tracer: TracerKind) -> u32 {
    match tracer {
        TracerKind::Raycast | TracerKind::Whitted => ResolvedSettings::DEPTH,
        TracerKind::MonteCarlo | TracerKind::Path | TracerKind::Irradiance | TracerKind::Photon => u32::MAX,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_comes_before_the_scene_and_the_scene_before_the_defaults() {
        let scene = RenderSettings { samples: Some(9), depth: Some(3), ..Default::default() };
        let line = RenderSettings { samples: Some(2), ..Default::default() };
        let s = ResolvedSettings::new(&scene, &line);
        assert_eq!((s.samples, s.depth, s.size, s.seed), (2, 3, [640, 480], 0));
    }

    #[test]
    fn tracers_of_indirect_light_take_more_samples() {
        let with = |tracer| RenderSettings { tracer: Some(tracer), ..Default::default() };
        let none = RenderSettings::default();
        assert_eq!(ResolvedSettings::new(&none, &none).samples, 4);
        assert_eq!(ResolvedSettings::new(&with(TracerKind::Path), &none).samples, 64);
    }

    #[test]
    fn crops_beyond_the_picture_do_not_fit() {
        let crop = |x, y, width, height| Crop { x, y, width, height }.fits([10, 8]);
        assert!(crop(0, 0, 10, 8) && crop(9, 7, 1, 1));
        assert!(!crop(1, 0, 10, 8) && !crop(0, 0, 0, 8) && !crop(u32::MAX, 0, 2, 1));
    }
}
