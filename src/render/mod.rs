//! Pictures: rays from a camera, radiance by a tracer, sums on a film, files on disk.

use crate::scene::{Rgb, TracerKind};
use crate::world::{Found, Ray, World};

/// A way to find the radiance that arrives along a ray. Made by its constructor from a world, so that what it must prepare
/// (a photon map, a cache) cannot be missing.
pub trait Tracer: Sync {
    /// Radiance along a camera ray, of which it has been found what it meets first, linear RGB. Called once per camera sample. What the ray meets first is told
    /// to the sampler.
    fn radiance(&self, world: &World, ray: &Ray, found: &Found, sampler: &mut sampler::Sampler) -> Rgb;

    /// The part of it that what is seen emits by itself. [`Tracer::radiance`] leaves it out where the sampler says that it is found
    /// [by others](sampler::Sampler::emission_rays).
    fn emission(&self, _: &World, _ray: &Ray, _found: &Found, _: &mut sampler::Sampler) -> Rgb {
        Rgb::ZERO
    }

    /// How many samples of a pixel it is ready for, by their numbers.
    fn lasts(&self) -> u32 {
        u32::MAX
    }

    /// Makes it ready for as many samples after those. None where that is called off.
    fn renew(
        &mut self,
        _world: &World,
        _settings: &settings::ResolvedSettings,
        _watch: tiles::Watch<'_>,
    ) -> Option<()> {
        Some(())
    }

    /// What emits so much that its emission is worth finding apart where its outline is seen. Nothing where the tracer does not tell it
    /// apart.
    fn outlines(&self) -> &Outlines {
        &outline::NONE
    }
}

pub use outline::Outlines;

pub mod adaptive;
mod block;
pub mod camera;
pub mod compare;
pub mod denoise;
pub mod features;
pub mod film;
mod filter;
mod irradiance;
mod medium;
mod outline;
pub mod output;
pub mod passes;
pub mod path;
mod photon;
mod pixel;
pub mod sampler;
pub mod settings;
mod suspect;
pub mod tiles;
pub mod whitted;

/// The tracer of a name, ready for a world as a camera sees it. What it makes beforehand is made on the settings' threads and
/// watched; none where that is called off.
pub fn tracer(
    kind: TracerKind,
    world: &World,
    view: &camera::View,
    settings: &settings::ResolvedSettings,
    watch: tiles::Watch<'_>,
) -> Option<Box<dyn Tracer>> {
    let paths = |aid| path::Path::aided(aid, world, view, settings, watch);
    Some(match kind {
        TracerKind::Raycast => Box::new(whitted::Whitted::raycast(world, settings)),
        TracerKind::Whitted => Box::new(whitted::Whitted::new(world, settings)),
        TracerKind::Path => Box::new(paths(path::Aid::Roulette)?),
        TracerKind::MonteCarlo => Box::new(paths(path::Aid::Roulette)?.branching()),
        TracerKind::Irradiance => Box::new(paths(path::Aid::Records)?),
        TracerKind::Photon => Box::new(paths(path::Aid::Photons)?),
    })
}
