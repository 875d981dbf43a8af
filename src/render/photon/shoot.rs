//! Light followed from the lamps: where it arrives on surfaces that spread it, photons are left. Knows nothing of cameras.

use super::given_up::{GivenUp, Lost, Owner, are_many};
use super::map::Photon;
use crate::math::colour::mean;
use crate::math::field::FaultKind;
use crate::render::medium::Inside;
use crate::render::path::survival;
use crate::render::sampler::{Sampler, rows};
use crate::render::tiles::Watch;
use crate::scene::{Rgb, SamplerKind};
use crate::world::bsdf::{Bounce, Bsdf};
use crate::world::light::{Aim, Choice, Light, Lights};
use crate::world::{Hit, Ray, RayKind, World};
use rayon::prelude::*;
use std::ops::Range;

/// What is shot, into what.
#[derive(Clone, Copy)]
pub struct Shooting<'a> {
    /// What light meets.
    pub world: &'a World,
    /// Where it comes from.
    pub lights: &'a Lights,
    /// How often each is asked.
    pub choice: &'a Choice,
    /// What light shall meet.
    pub aim: &'a Aim,
    /// Most segments from lamp to camera.
    pub depth: u32,
    /// Of the random numbers.
    pub seed: u64,
    /// Whose numbers are its own.
    pub round: u32,
    /// Only light that came by mirrors and glass alone, and what it meets first after them.
    pub caustics: bool,
    /// Who looks on.
    pub watch: Watch<'a>,
}

/// A photon under way.
struct Flight {
    ray: Ray,
    power: Rgb,
    inside: Inside,
    /// Segments from the lamp, this one counted.
    segment: u32,
    /// Of this segment so far, past what let it slip by.
    length: f64,
    sampler: Sampler,
}

impl Flight {
    /// Leaves a surface along a bounce. False where `chance` in (0, 1) ends it.
    fn leave(&mut self, hit: &Hit<'_>, bsdf: &Bsdf, bounce: &Bounce, chance: f64) -> bool {
        if bounce.through {
            self.inside = self.inside.across(bsdf);
        }
        self.ray = hit.spawn(bounce.direction, RayKind::Indirect);
        self.length = 0.0;
        self.segment += 1;
        let weight = bsdf.forwarded(bounce);
        let goes_on = survival(weight.max_element(), self.segment);
        self.power *= weight / goes_on;
        chance < goes_on && self.power.is_finite() && self.power != Rgb::ZERO
    }
}

/// Paths followed before it is asked whether there are enough photons.
const BATCH: u32 = 1 << 14;

/// Paths that a thread follows at a time.
const CHUNK: u32 = 1 << 8;

/// Rays of which the power of lights is measured, and of each at most.
const PROBES: [usize; 2] = [1 << 16, 1 << 10];

/// Columns of random numbers of a round: of the two maps and, in the first, of what is measured.
const COLUMNS: u32 = 3;

/// The last of them.
const PROBING: u32 = 2;

/// How often lights are chosen that are aimed: by what some rays of each carry.
pub fn choice(lights: &Lights, aim: &Aim, seed: u64) -> Choice {
    let n = (PROBES[0] / lights.lights.len().max(1)).clamp(1, PROBES[1]) as u32;
    Choice::by(lights.lights.iter().map(|light| probed(light, aim, seed, n)).collect())
}

/// The power that a light sends where it is aimed, by so many rays. Nothing where it is not known, since a function runs too long.
fn probed(light: &Light, aim: &Aim, seed: u64, n: u32) -> f64 {
    let (mut sum, mut lost) = (0.0, 0);
    for i in 0..n {
        let mut sampler = Sampler::new(seed, PROBING, rows::PHOTONS, i);
        let (side, place, way) = (sampler.next_2d(), sampler.next_2d(), sampler.next_2d());
        match light.emit(place, way, side.y, aim) {
            Ok(emitted) => sum += emitted.map_or(0.0, |emitted| mean(emitted.power)),
            Err(fault) => lost += usize::from(fault.kind == FaultKind::TooManyTurns),
        }
        if are_many(lost, i as usize) {
            return 0.0;
        }
    }
    sum / f64::from(n)
}

impl Shooting<'_> {
    /// The photons of so many paths, or of fewer where there are as many photons as can be kept. None where
    /// the work is called off.
    pub fn photons(&self, paths: u32, most: usize) -> Option<Vec<Photon>> {
        let (mut photons, mut given_up) = (Vec::new(), GivenUp::default());
        let mut shot = 0;
        while shot < paths && photons.len() < most {
            let batch = shot..paths.min(shot + BATCH);
            while shot < batch.end {
                // No more at once than before: what photons are to leave alone, the first few tell.
                let part = shot..batch.end.min((2 * shot).max(1));
                shot = part.end;
                photons.extend(self.part(part, &mut given_up));
            }
            self.watch.progress.tiles(shot as usize, paths as usize);
            self.watch.go_on()?;
        }
        let share = 1.0 / shot.max(1) as f32;
        photons.iter_mut().for_each(|photon| photon.power *= share);
        Some(photons)
    }

    /// The photons of some paths, in their order. What they tell of is given up after them, so that threads leave no trace.
    fn part(&self, paths: Range<u32>, given_up: &mut GivenUp) -> impl Iterator<Item = Photon> + use<> {
        let chunks: Vec<u32> = paths.clone().step_by(CHUNK as usize).collect();
        let of = |&first: &u32| self.chunk(first..paths.end.min(first + CHUNK), given_up);
        let (photons, lost): (Vec<_>, Vec<_>) = chunks.par_iter().map(of).unzip();
        given_up.learn(&lost.concat(), paths.len());
        photons.into_iter().flatten()
    }

    /// The photons of some paths, and whose functions ran too long for others.
    fn chunk(&self, paths: Range<u32>, given_up: &GivenUp) -> (Vec<Photon>, Vec<Owner>) {
        let (mut photons, mut lost) = (Vec::new(), Vec::new());
        for path in paths.take_while(|_| !self.watch.is_over()) {
            // What a surface's function leaves undefined is said by the camera's rays, if they see it.
            if let Err(why) = self.shoot(path, given_up, &mut photons) {
                lost.extend(why.too_long());
            }
        }
        (photons, lost)
    }

    fn shoot(&self, path: u32, given_up: &GivenUp, photons: &mut Vec<Photon>) -> Result<(), Lost> {
        let column = self.round.wrapping_mul(COLUMNS) + u32::from(self.caustics);
        let mut sampler =
            Sampler::new(self.seed, column, rows::PHOTONS, path).of_kind(SamplerKind::Independent, 1);
        let (which, place, way) = (sampler.next_2d(), sampler.next_2d(), sampler.next_2d());
        let Some((i, often)) = self.choice.pick(which.x) else { return Ok(()) };
        let light = &self.lights.lights[i];
        if given_up.has(light) {
            return Ok(());
        }
        let emitted = light.emit(place, way, which.y, self.aim);
        let Some(emitted) = emitted.map_err(|fault| Lost::of(Owner::of(light), fault))? else {
            return Ok(());
        };
        let power = emitted.power / often;
        let (inside, length) = (Inside::NOTHING, 0.0);
        let mut flight = Flight { ray: emitted.ray, power, inside, segment: 1, length, sampler };
        while self.follow(light, &mut flight, given_up, photons)? {}
        Ok(())
    }

    /// Takes a photon to the end of its ray and aims it anew. False where it ends.
    fn follow(
        &self,
        light: &Light,
        flight: &mut Flight,
        given_up: &GivenUp,
        photons: &mut Vec<Photon>,
    ) -> Result<bool, Lost> {
        let Some(hit) = self.world.closest(&flight.ray) else { return Ok(false) };
        if given_up.has(hit.material()) {
            return Ok(false);
        }
        let bsdf = Bsdf::at(self.world, &hit, &flight.ray).map_err(|fault| Lost::at(&hit, fault))?;
        flight.power *= flight.inside.left(&bsdf, hit.t);
        flight.length += hit.t;
        if bsdf.opacity < 1.0 && flight.sampler.next_1d() >= bsdf.opacity {
            flight.ray = hit.spawn(flight.ray.direction, flight.ray.kind);
            return Ok(true);
        }
        if flight.segment == 1 {
            flight.power *= light.dimming(flight.length);
        }
        if bsdf.has_base() && (flight.segment > 1 || !self.caustics) {
            let from = -flight.ray.direction;
            photons.push(Photon::new(hit.point, from, bsdf.geometric, flight.power, flight.segment));
        }
        // One more segment leads to the camera.
        if flight.segment.saturating_add(1) >= self.depth {
            return Ok(false);
        }
        let (which, u) = (flight.sampler.next_2d(), flight.sampler.next_2d());
        let Some(bounce) = bsdf.bounce(bsdf.odds(), which.x, u) else { return Ok(false) };
        if self.caustics && bsdf.has_base() && bounce.density.is_some() {
            return Ok(false);
        }
        Ok(flight.leave(&hit, &bsdf, &bounce, which.y))
    }
}
