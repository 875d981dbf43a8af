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
//! More samples shoot more photons, and the discs shrink. Maps hold as many as there is room for; further samples are taken in rounds of [`ROUND`],
//! each with maps of its own, whose estimates take fewer photons from round to round, so that blur and noise vanish together (Knaus & Zwicker,
//! *Progressive Photon Mapping: A Probabilistic Approach*, 2011). Those of caustics are sent only to what may be the first mirror or glass on
//! their way; all others would leave none.

mod given_up;
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
    /// How many rounds were before.
    pub round: u32,
    /// Photons in an estimate of each.
    most: [usize; 2],
    /// Within which an estimate of each is made.
    radii: [f64; 2],
    /// Where light from afar was sent; none where there is no such light.
    lit: Option<Ball>,
    depth: u32,
}

/// Samples of a pixel by one map.
const ROUND: u32 = 1 << 7;

/// Photons in an estimate of the first round: of all light, which is averaged over many places, and of caustics, which are seen as they are.
const MOST: [f64; 2] = [16.0, 64.0];

/// The same in any round at least: the farthest only measures, and without three others the estimate would have no variance that is finite.
const LEAST: f64 = 4.0;

/// What is kept of the photons of an estimate as rounds go on: the square of its radius falls as the number of rounds to this less 1. At ⅔
/// blur, which is a bias, and noise fall alike, as the cube root.
const KEPT: f64 = 2.0 / 3.0;

/// Paths from the lamps for each sample of a pixel: of all light, and of caustics, many of which end at once.
const PATHS: [u32; 2] = [1 << 12, 1 << 15];

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
    /// Shoots the photons of a round in a world. Threads leave no trace in the maps. None where the work is called off.
    pub fn new(
        world: &World,
        (lights, choice): (&Lights, &Choice),
        settings: &ResolvedSettings,
        round: u32,
        watch: Watch<'_>,
    ) -> Option<Maps> {
        let ball = world.ball();
        let ResolvedSettings { depth, seed, .. } = *settings;
        let samples = settings.samples.saturating_sub(round.saturating_mul(ROUND)).min(ROUND);
        let map = |i: usize, choice: &Choice, aim: &Aim| {
            let caustics = i == 1;
            let shooting = Shooting { world, lights, choice, aim, depth, seed, round, caustics, watch };
            let [each, most] = ROOM[i];
            let room = samples.saturating_mul(each).min(most);
            watch.progress.phase(PHASES[i]);
            let photons = || shooting.photons(samples * PATHS[i], room as usize);
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
        let most = MOST.map(|most| (most * kept(round)).round().max(LEAST) as usize);
        let reach = |map: &Map, most| REACH * map.spacing(most).unwrap_or(0.0);
        let radii = [reach(&global, most[0]), reach(&caustics, most[1])];
        Some(Maps { global, caustics, round, most, radii, lit: lights.from_afar().then_some(ball), depth })
    }

    /// The number of the sample before which others must be made.
    pub fn last(&self) -> u32 {
        (self.round + 1).saturating_mul(ROUND)
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
            most: self.most[i],
            segments,
        }
    }
}

/// The share of the photons of an estimate that is kept after so many rounds.
fn kept(round: u32) -> f64 {
    (1..=round).map(f64::from).map(|i| (i + KEPT) / (i + 1.0)).product()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::{cos, log2};
    use crate::render::sampler::Sampler;
    use crate::scene::SamplerKind;
    use glam::DVec3;
    use std::f64::consts::TAU;
    use std::sync::atomic::AtomicBool;

    /// Light on the unit square that is brightest along the line x = ½.
    fn density(x: f64) -> f64 {
        1.0 - 0.9 * cos(TAU * x)
    }

    const PHOTONS: u32 = 2000;

    /// A map of some photons of it, of power 1 in all.
    fn map(series: u32, round: u32) -> Map {
        let photons = (0..PHOTONS).filter_map(|i| {
            let mut sampler =
                Sampler::new(u64::from(series), round, 0, i).of_kind(SamplerKind::Independent, PHOTONS);
            let (at, chance) = (sampler.next_2d(), sampler.next_2d().x);
            let power = Rgb::splat(1.9 / f64::from(PHOTONS));
            let point = DVec3::new(at.x, at.y, 0.0);
            (chance * 1.9 < density(at.x)).then(|| Photon::new(point, DVec3::Z, DVec3::Z, power, 1))
        });
        let watch = Watch { progress: &(), cancel: &AtomicBool::new(false) };
        Map::new(photons.collect(), watch).expect("nobody calls it off")
    }

    /// What is off in the brightest places after each round.
    fn errors(series: u32, rounds: u32) -> Vec<[f64; 4]> {
        let mut sums = [0.0; 4];
        let after = |round: u32| {
            let map = map(series, round);
            let most = (MOST[1] * kept(round)).round() as usize;
            for (place, sum) in sums.iter_mut().enumerate() {
                let point = DVec3::new(0.5, 0.2 + 0.2 * place as f64, 0.0);
                let query =
                    Query { point, normal: DVec3::Z, both_sides: false, radius: 1.0, most, segments: 1 };
                *sum += map.gather(&query, false, |photon| photon.power.as_dvec3()).expect("enough").x;
            }
            sums.map(|sum| sum / f64::from(round + 1) / density(0.5) - 1.0)
        };
        (0..rounds).map(after).collect()
    }

    #[test]
    fn blur_and_noise_vanish_as_the_cube_root_of_the_rounds() {
        let (series, doublings) = (40, 7);
        let all: Vec<Vec<[f64; 4]>> = (0..series).map(|i| errors(i, 1 << doublings)).collect();
        let rmse = |round: usize| {
            let squares: f64 = all.iter().flat_map(|errors| errors[round]).map(|e| e * e).sum();
            (squares / f64::from(4 * series)).sqrt()
        };
        let slope = log2(rmse((1 << doublings) - 1) / rmse(0)) / f64::from(doublings);
        assert!((slope + 1.0 / 3.0).abs() < 0.07, "{slope}");
        assert!(rmse(0) > 0.05, "there is something to lose");
    }
}
