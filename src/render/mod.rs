//! Pictures: rays from a camera, radiance by a tracer, sums on a film, files on disk.

use crate::scene::{Rgb, TracerKind};
use crate::world::{Ray, World};

/// A way to find the radiance that arrives along a ray. Made by its constructor from a world, so that what it must prepare
/// (a photon map, a cache) cannot be missing.
pub trait Tracer: Sync {
    /// Radiance along a camera ray, linear RGB. Called once per camera sample.
    fn radiance(&self, world: &World, ray: Ray, sampler: &mut sampler::Sampler) -> Rgb;
}

pub mod camera;
pub mod compare;
pub mod film;
mod medium;
pub mod output;
pub mod path;
mod photon;
pub mod sampler;
pub mod settings;
pub mod tiles;
pub mod whitted;

/// The tracer of a name, ready for a world. None for those that are not built yet.
pub fn tracer(
    kind: TracerKind,
    world: &World,
    settings: &settings::ResolvedSettings,
) -> Option<Box<dyn Tracer>> {
    match kind {
        TracerKind::Raycast => Some(Box::new(whitted::Whitted::raycast(world, settings))),
        TracerKind::Whitted => Some(Box::new(whitted::Whitted::new(world, settings))),
        TracerKind::Path => Some(Box::new(path::Path::new(world, settings))),
        TracerKind::MonteCarlo => Some(Box::new(path::Path::branching(world, settings))),
        TracerKind::Photon => Some(Box::new(path::Path::with_photons(world, settings))),
        TracerKind::Irradiance => None,
    }
}
