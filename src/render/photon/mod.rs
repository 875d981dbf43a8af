//! Photon maps (Jensen, *Global Illumination Using Photon Maps*, 1996) as the tracer `photon` uses them: the light that paths
//! from the camera cannot find or find only by many segments is looked up where light from the lamps has left it.
//!
//! | light on its way to the first matt surface that the camera sees | found by |
//! |---|---|
//! | straight from a lamp | the path, which asks and meets |
//! | from a lamp by mirrors and glass alone | the map of caustics, there |
//! | from other matt surfaces | one segment on, the map of all photons at the matt surface met |
//!
//! Light that is not stopped by what photons meet, since its lamp casts no shadow or something is hidden from shadows, and light of what glows
//! but is no lamp, is in no map of all photons: then there is none, and paths find what is not a caustic.
//!
//! Where photons are sparse, or the surface met is too close for a disc of them, the path goes on as any other: the
//! estimate is blurred by no more than a few times the distance of photons where there is light.
//! More samples shoot more photons, and the discs shrink. Those of caustics are sent only to what may be the first mirror or glass on
//! their way; all others would leave none.

mod map;
mod shoot;

use super::settings::ResolvedSettings;
use super::tiles::{Watch, on_threads};
use crate::scene::{Material, Rgb, Texture};
use crate::world::bsdf::Bsdf;
use crate::world::light::{Aim, Ball, Choice, Lights, Targets};
use crate::world::{Hit, RayKind, World};
use map::{Map, Photon, Query};
use shoot::Shooting;

/// The photons of a world.
pub struct Maps {
    global: Map,
    caustics: Map,
    /// Within which an estimate of each is made.
    radii: [f64; 2],
    /// Where light from afar was sent; none where there is no such light.
    lit: Option<Ball>,
    depth: u32,
}

/// Photons in an estimate: of all light, which is averaged over many places, and of caustics, which are seen as they are.
const MOST: [usize; 2] = [16, 64];

/// Paths from the lamps for each sample of a pixel, and at most: of all light, and of caustics, many of which end at once.
const PATHS: [[u32; 2]; 2] = [[1 << 12, 1 << 20], [1 << 15, 1 << 22]];

/// What is shot, for who looks on.
const PHASES: [&str; 2] = ["photons", "caustics"];

/// Photons after which there are enough: for each sample of a pixel, and at most. Of caustics that are aimed every second path leaves one.
const ROOM: [[u32; 2]; 2] = [[1 << 22, 1 << 22], [1 << 14, 1 << 21]];

/// An estimate reaches no farther than so many times the middle distance of photons: where they are sparser there is less light
/// than blur.
const REACH: f64 = 4.0;

/// A surface met at less than so many reaches is in the same corner.
const CORNER: f64 = 2.0;

impl Maps {
    /// Shoots the photons of a world. Threads leave no trace in the maps. None where the work is called off.
    pub fn new(
        world: &World,
        lights: &Lights,
        choice: &Choice,
        settings: &ResolvedSettings,
        watch: Watch<'_>,
    ) -> Option<Maps> {
        let ball = world.ball();
        let ResolvedSettings { depth, seed, samples, .. } = *settings;
        let map = |i: usize, choice: &Choice, aim: &Aim| {
            let shooting = Shooting { world, lights, choice, aim, depth, seed, caustics: i == 1, watch };
            let [paths, room] =
                [PATHS[i], ROOM[i]].map(|[each, most]| samples.saturating_mul(each).min(most));
            watch.progress.phase(PHASES[i]);
            let photons = || shooting.photons(paths, room as usize);
            on_threads(settings.threads, || Map::new(photons()?, watch))
        };
        let global = match lights.are_all_sent {
            true => map(0, choice, &Aim::Anything(ball))?,
            false => Map::default(),
        };
        let caustics = match world.balls_of(RayKind::Indirect, bends) {
            Some(balls) if balls.is_empty() => Map::default(),
            Some(balls) => {
                let aim = Aim::At(Targets::new(balls, ball));
                map(1, &shoot::choice(lights, &aim, seed), &aim)?
            }
            // Nothing can be left out where mirrors go on for ever.
            None => map(1, choice, &Aim::Anything(ball))?,
        };
        let reach = |map: &Map, most| REACH * map.spacing(most).unwrap_or(0.0);
        let radii = [reach(&global, MOST[0]), reach(&caustics, MOST[1])];
        Some(Maps { global, caustics, radii, lit: lights.from_afar().then_some(ball), depth })
    }

    /// What a surface sends on of all light, at the end of a segment that begins at a matt surface. None where photons cannot
    /// tell.
    pub fn all(&self, hit: &Hit<'_>, bsdf: &Bsdf, segment: u32) -> Option<Rgb> {
        let outside = |ball: &Ball| ball.center.distance_squared(hit.point) > ball.reach * ball.reach;
        if hit.t < CORNER * self.radii[0] || self.lit.as_ref().is_some_and(outside) {
            return None;
        }
        self.global.gather(&self.query(0, hit, bsdf, segment), false, |photon| sent_on(bsdf, photon))
    }

    /// What a surface sends on of light that came by mirrors and glass alone.
    pub fn caustic(&self, hit: &Hit<'_>, bsdf: &Bsdf, segment: u32) -> Rgb {
        if self.radii[1] == 0.0 {
            return Rgb::ZERO;
        }
        let query = self.query(1, hit, bsdf, segment);
        self.caustics.gather(&query, true, |photon| sent_on(bsdf, photon)).unwrap_or(Rgb::ZERO)
    }

    fn query(&self, i: usize, hit: &Hit<'_>, bsdf: &Bsdf, segment: u32) -> Query {
        let segments = self.depth.saturating_sub(segment);
        Query {
            point: hit.point,
            normal: bsdf.geometric,
            both_sides: bsdf.is_frosted(),
            radius: self.radii[i],
            most: MOST[i],
            segments,
        }
    }
}

/// Whether a material may send light on among caustics: by what is smooth, or by whatever has no base beside it.
fn bends(material: &Material) -> bool {
    let Some(layers) = material.layers.as_deref() else { return false };
    let zero = |texture: &Texture| texture.is(Rgb::ZERO);
    let surely = |texture: &Texture| matches!(texture, Texture::Constant(value) if *value != Rgb::ZERO);
    let has_base = surely(&material.diffuse) || surely(&layers.specular);
    let is_mirror = !(zero(&layers.metal) && zero(&layers.reflect));
    !zero(&layers.transmit) || is_mirror && !(has_base && surely(&layers.roughness))
}

/// What becomes of a photon's power: sent on to where the surface is seen from, per area and solid angle.
fn sent_on(bsdf: &Bsdf, photon: &Photon) -> Rgb {
    let from = photon.from.as_dvec3();
    let cosine = from.dot(bsdf.normal).abs();
    if cosine == 0.0 {
        return Rgb::ZERO;
    }
    bsdf.sent(from) / cosine * photon.power.as_dvec3()
}
