//! Path tracing (Kajiya, *The Rendering Equation*, 1986): one path from the camera for each sample, which goes on wherever
//! light may have come from, and at every surface asks one light directly. `montecarlo` does the same with a path that
//! branches once, at the first surface that spreads light: what the camera ray cost is shared by all branches. `photon` ends it
//! where photons tell the rest, `irradiance` where records do.
//!
//! What a light sends is found in two ways, by asking it and by meeting it; each counts by its share of the two densities
//! (the balance heuristic of Veach & Guibas, 1995), so that neither is counted twice. Lights without extent are only asked;
//! smooth mirrors and glass only meet. A path that carries little ends by chance and the others count for more
//! (see `roulette`). With the default depth the picture has no bias; a `depth` leaves out what longer paths would bring.
//!
//! Glass casts a shadow here, and what it gathers is found by the paths that meet a light through it: light from `point`,
//! `spot` and `sun` through smooth glass cannot be found so, and is missing.

mod gather;
mod roulette;
mod walk;

use super::Tracer;
use super::camera::View;
use super::irradiance::Records;
use super::outline::Outlines;
use super::photon::Maps;
use super::sampler::Sampler;
use super::settings::ResolvedSettings;
use super::tiles::{Picture, Watch};
use crate::scene::{Material, Rgb};
use crate::world::bsdf::{Bsdf, Odds, Slot};
use crate::world::light::{Choice, Lights};
use crate::world::texture::Sampled;
use crate::world::{Found, Hit, Ray, SurfacePoint, World};
pub(super) use gather::Matt;
use glam::{DVec2, DVec3};
use roulette::Roulette;
pub(super) use roulette::survival;
use std::f64::consts::PI;
use walk::{Last, Stage, Walk};

/// The tracers `path`, `montecarlo`, `irradiance` and `photon`.
pub struct Path {
    lights: Lights,
    choice: Choice,
    depth: u32,
    background: Option<Rgb>,
    /// True where some surface is there only in part.
    has_holes: bool,
    /// How many ways on are taken from the first surface that spreads light.
    branches: u32,
    photons: Option<Maps>,
    records: Option<Records>,
    /// True where a way on may find light of lamps: where it may meet what shines, or come to a rough mirror or glass that asks them.
    finds_lamps: bool,
    outlines: Outlines,
    roulette: Roulette,
}

/// What is made before a picture, to end its paths sooner.
#[derive(Clone, Copy, Debug)]
pub enum Aid {
    /// How often paths end by chance.
    Roulette,
    /// Photons, which tell the rest.
    Photons,
    /// Records of irradiance, which tell the rest.
    Records,
}

/// Branches of `montecarlo`. A power of two, so that the points of a surface's ways are even.
const BRANCHES: u32 = 4;

/// In place of a number of chance where there is nothing to choose.
const CERTAIN: f64 = 0.5;

impl Path {
    /// Paths in a world, by these settings.
    pub fn new(world: &World, settings: &ResolvedSettings) -> Path {
        let lights = Lights::new(world);
        let choice = Choice::new(&lights.lights, world.ball().reach);
        let has_holes = world.materials().any(|m| !m.layers().opacity.is(Rgb::ONE));
        let shines_or_spreads =
            |m: &Material| [&m.layers().emit, &m.layers().roughness].iter().any(|t| !t.is(Rgb::ZERO));
        let finds_lamps =
            lights.lights.iter().any(|light| !light.is_delta()) || world.materials().any(shines_or_spreads);
        let ResolvedSettings { depth, background, .. } = *settings;
        let (photons, records, roulette) = (None, None, Roulette::PLAIN);
        Path {
            lights,
            choice,
            depth,
            background,
            has_holes,
            branches: 1,
            photons,
            records,
            finds_lamps,
            outlines: Outlines::new(world, settings),
            roulette,
        }
    }

    /// Paths with an aid, for a picture by a view: with no more rays for outlines than it can bear. None where making the aid is called off.
    pub fn aided(
        aid: Aid,
        world: &World,
        view: &View,
        settings: &ResolvedSettings,
        watch: Watch<'_>,
    ) -> Option<Path> {
        let path = Path::new(world, settings);
        let outlines = path.outlines.within_budget(Picture { world, view, tracer: &path, settings });
        let path = Path { outlines, ..path };
        Some(match aid {
            Aid::Roulette => {
                let roulette = Roulette::learned(world, &path, view, settings, watch)?;
                Path { roulette, ..path }
            }
            Aid::Photons => {
                let maps = Maps::new(world, (&path.lights, &path.choice), settings, 0, watch)?;
                Path { photons: Some(maps), ..path }
            }
            Aid::Records => {
                let records = Records::new(world, &path, view, settings, watch)?;
                Path { records: Some(records), ..path }
            }
        })
    }

    /// The same paths, each of which branches once.
    pub fn branching(self) -> Path {
        Path { branches: BRANCHES, ..self }
    }
}

impl Tracer for Path {
    fn radiance(&self, world: &World, ray: &Ray, found: &Found, sampler: &mut Sampler) -> Rgb {
        sampler.rays.camera += 1;
        let stage = if self.photons.is_some() { Stage::Seen } else { Stage::Whole };
        let mut walk =
            Walk { branches: self.branches, stage, ..Walk::from_camera(*ray, &self.roulette, sampler) };
        let traced =
            self.come_to(world, world.hit(ray, found).as_ref(), &mut walk).and_then(
                |goes_on| match goes_on {
                    true => self.trace(world, &mut walk),
                    false => Ok(()),
                },
            );
        if let Err(fault) = traced {
            walk.sampler.undefined = Some(fault);
        }
        walk.sum
    }

    fn emission(&self, world: &World, ray: &Ray, found: &Found, sampler: &mut Sampler) -> Rgb {
        sampler.rays.camera += 1;
        let mut walk = Walk::from_camera(*ray, &self.roulette, sampler);
        self.seen_emission(world, found, &mut walk).unwrap_or_else(|fault| {
            walk.sampler.undefined = Some(fault);
            Rgb::ZERO
        })
    }

    fn lasts(&self) -> u32 {
        self.photons.as_ref().map_or(u32::MAX, Maps::last)
    }

    fn renew(&mut self, world: &World, settings: &ResolvedSettings, watch: Watch<'_>) -> Option<()> {
        // There is no need for both at once.
        let round = self.photons.take()?.round + 1;
        self.photons = Some(Maps::new(world, (&self.lights, &self.choice), settings, round, watch)?);
        Some(())
    }

    fn outlines(&self) -> &Outlines {
        &self.outlines
    }
}

impl Path {
    /// What the surface at the end of a path's first segment sends out by itself.
    fn seen_emission(&self, world: &World, found: &Found, walk: &mut Walk<'_>) -> Sampled<Rgb> {
        let mut next;
        let mut found = found;
        while let Some(hit) = world.hit(&walk.ray, found) {
            if hit.is_dark() {
                break;
            }
            let mut slot = Slot::uninit();
            let bsdf = Bsdf::put(&mut slot, world, &hit, &walk.ray)?;
            walk.weight *= walk.inside.left(bsdf, hit.t);
            if !walk.slips(&hit, bsdf) {
                return Ok(walk.weight * bsdf.emitted(world, &hit));
            }
            next = world.find(&walk.ray);
            found = &next;
        }
        Ok(Rgb::ZERO)
    }

    /// Follows a path to its end.
    fn trace(&self, world: &World, walk: &mut Walk<'_>) -> Sampled<()> {
        while self.follow(world, walk)? {}
        Ok(())
    }

    /// Takes a path to the end of its ray and aims it anew. False where it ends.
    fn follow(&self, world: &World, walk: &mut Walk<'_>) -> Sampled<bool> {
        // A hit and what it is made of are many numbers: they are looked at where they were written.
        let met = world.closest(&walk.ray);
        self.come_to(world, met.as_ref(), walk)
    }

    /// The same where it is known what its ray meets.
    #[inline]
    fn come_to(&self, world: &World, met: Option<&Hit<'_>>, walk: &mut Walk<'_>) -> Sampled<bool> {
        let Some(hit) = met else {
            if !walk.stage.is_covered() {
                walk.sum += walk.weight * walk.inside.kept(f64::INFINITY) * self.beyond(walk);
            }
            return Ok(false);
        };
        walk.sampler.first.meet(&walk.ray, hit);
        let mut slot = Slot::uninit();
        let bsdf = Bsdf::put(&mut slot, world, hit, &walk.ray)?;
        walk.sampler.first.look(bsdf);
        let goes_on = self.arrive(world, hit, bsdf, walk);
        walk.sampler.suspect.look(hit.primitive, [walk.sum, walk.weight]);
        goes_on
    }

    /// Adds what a surface sends along the path's ray, and goes on from there. False where the path ends.
    #[inline]
    fn arrive(&self, world: &World, hit: &Hit<'_>, bsdf: &Bsdf, walk: &mut Walk<'_>) -> Sampled<bool> {
        walk.note_length(hit.t);
        walk.weight *= walk.inside.left(bsdf, hit.t);
        if walk.slips(hit, bsdf) {
            return Ok(true);
        }
        let emitted = bsdf.emitted(world, hit);
        if emitted != Rgb::ZERO && !walk.tells_no_emission() {
            walk.sum += walk.weight * emitted * self.share_of_meeting(world, hit, walk);
        }
        if walk.segment >= self.depth || !walk.arrives(bsdf) {
            return Ok(false);
        }
        match &self.photons {
            Some(maps) if self.is_told(maps, hit, bsdf, walk) => Ok(walk.is_mirrored(hit, bsdf)),
            _ => self.go_on(world, hit, bsdf, walk),
        }
    }

    /// Adds what photons tell at a surface. True where that is all that its lobes send.
    fn is_told(&self, maps: &Maps, hit: &Hit<'_>, bsdf: &Bsdf, walk: &mut Walk<'_>) -> bool {
        if !bsdf.has_base() {
            return false;
        }
        if walk.stage == Stage::Gathers
            && let Some(light) = maps.all(hit, bsdf, walk.segment)
        {
            walk.sum += walk.weight * light;
            return true;
        }
        walk.sum += walk.weight * maps.caustic(hit, bsdf, walk.segment);
        false
    }

    /// Adds what records tell at a surface: what its matt part sends on of light from other matt surfaces. False where none holds.
    fn is_known(&self, world: &World, hit: &Hit<'_>, bsdf: &Bsdf, walk: &mut Walk<'_>) -> bool {
        if self.records.is_none() && walk.records.is_none() {
            return false;
        }
        let matt = bsdf.matt();
        if matt == Rgb::ZERO {
            return false;
        }
        let ready = self.records.as_ref().and_then(|records| records.told(world, hit, bsdf, walk.segment));
        let told = ready.or_else(|| walk.records?.roughly(world, hit, bsdf, walk.segment));
        walk.sum += walk.weight * matt * told.unwrap_or(Rgb::ZERO) / PI;
        told.is_some()
    }

    /// Asks lights and leaves the surface, along all ways of the branches where it is the one that branches.
    fn go_on(&self, world: &World, hit: &Hit<'_>, bsdf: &Bsdf, walk: &mut Walk<'_>) -> Sampled<bool> {
        let spreads = bsdf.has_lobes() && walk.stage.asks(bsdf.has_base());
        let n = if spreads { std::mem::replace(&mut walk.branches, 1) } else { 1 };
        let odds = bsdf.odds();
        let (one_way, one_light) = (odds.are_certain(), self.choice.is_certain());
        let which = walk.sampler.next_set_if(!(one_way && one_light));
        let chance = |i| which.map_or(DVec2::splat(CERTAIN), |which| which.point(i, n));
        if spreads && !self.lights.lights.is_empty() {
            let places = walk.sampler.next_set();
            for i in 0..n {
                let light = if one_light { CERTAIN } else { chance(i).y };
                let u = (light, places.point(i, n));
                let asked = self.asked(world, hit, (bsdf, odds), u, walk.sampler)?;
                walk.sum += walk.weight * asked / f64::from(n);
            }
        }
        let ways = walk.sampler.next_set();
        let lobe = |i| if one_way { CERTAIN } else { chance(i).x };
        let way = |i| bsdf.bounce(odds, lobe(i), ways.point(i, n));
        if n == 1 {
            let chosen = way(0);
            // What is told is told where no way leads on, too.
            let is_known = self.is_known(world, hit, bsdf, walk);
            let Some(bounce) = &chosen else { return Ok(false) };
            if is_known {
                walk.kept = bounce.density.map_or(Rgb::ONE, |_| bsdf.beside_matt(bounce.direction));
            }
            let goes_on = self.finds_lamps || walk.kept != Rgb::ZERO;
            return Ok(goes_on && walk.leave(hit, bsdf, bounce));
        }
        for bounce in (0..n).filter_map(way) {
            let mut branch = walk.branch();
            if branch.leave(hit, bsdf, &bounce) {
                self.trace(world, &mut branch)?;
            }
            let found = branch.sum;
            walk.sum += found / f64::from(n);
        }
        Ok(false)
    }

    /// What the surface sends on of the light that one of the lights, chosen by `which` and asked directly at the place `u`, sends it.
    fn asked(
        &self,
        world: &World,
        hit: &Hit<'_>,
        (bsdf, odds): (&Bsdf, Odds),
        (which, u): (f64, DVec2),
        sampler: &mut Sampler,
    ) -> Sampled<Rgb> {
        let lights = &self.lights.lights;
        let chosen = self.choice.pick_at(lights, hit.point, bsdf.normal, which);
        let Some((i, often)) = chosen else { return Ok(Rgb::ZERO) };
        let light = &lights[i];
        let sample = light.sample(hit.point, bsdf.normal, u);
        let Some(sample) = &sample else { return Ok(Rgb::ZERO) };
        let sent = bsdf.sent(sample.wi) * sample.weight / often;
        if sent == Rgb::ZERO {
            return Ok(sent);
        }
        let share = match sample.pdf {
            Some(density) if light.is_met => balance(density * often, bsdf.density(odds, sample.wi)),
            _ => 1.0,
        };
        if !light.shadow {
            return Ok(sent * share);
        }
        Ok(sent * share * self.passed(world, &sample.shadow_ray(hit), sampler)?)
    }

    /// The share of light that passes along a shadow ray: all, nothing, or what holes let by.
    fn passed(&self, world: &World, ray: &Ray, sampler: &mut Sampler) -> Sampled<f64> {
        sampler.rays.shadow += 1;
        if !self.has_holes {
            return Ok(if world.occluded(ray) { 0.0 } else { 1.0 });
        }
        let left =
            world.transmittance(ray, |hit| Ok(Rgb::splat(1.0 - Bsdf::at(world, hit, ray)?.opacity)))?;
        Ok(left.x)
    }

    /// How much of a surface's emission counts that a ray met: its share beside what asking the light gives.
    fn share_of_meeting(&self, world: &World, hit: &Hit<'_>, walk: &Walk<'_>) -> f64 {
        let Some(i) = self.lights.of(world, hit.primitive) else {
            // Photons do not come from it; what a record gathers is never what a lamp sends straight.
            return if walk.stage == Stage::Gathered { 0.0 } else { 1.0 };
        };
        if walk.stage.is_covered() {
            return 0.0;
        }
        let Some(last) = &walk.last else { return 1.0 };
        let distance = (hit.point - last.point).length();
        let share = self.share_beside_asking(i, last, walk.ray.direction, Some(&hit.surface_point()));
        share * self.lights.lights[i].dimming(distance)
    }

    /// The share that counts of what a ray found of a light, where asking it might have found the same.
    fn share_beside_asking(&self, i: usize, last: &Last, wi: DVec3, met: Option<&SurfacePoint>) -> f64 {
        let lights = &self.lights.lights;
        let density = lights[i].density(last.point, last.normal, wi, met);
        density.map_or(0.0, |density| {
            let often = self.choice.share_at(lights, i, last.point, last.normal);
            balance(last.density, density * often)
        })
    }

    /// Radiance from where nothing is, less what asking the skies already gave.
    fn beyond(&self, walk: &Walk<'_>) -> Rgb {
        let direction = walk.ray.direction;
        let Some(last) = &walk.last else {
            let background = if walk.seen { self.background } else { None };
            return background.or_else(|| self.lights.sky(direction)).unwrap_or(Rgb::ZERO);
        };
        let skies = self.lights.skies(direction);
        skies.map(|(i, radiance)| radiance * self.share_beside_asking(i, last, direction, None)).sum()
    }
}

/// The share of the first of two ways that find the same light with these densities.
fn balance(this: f64, other: f64) -> f64 {
    if this > 0.0 { this / (this + other) } else { 0.0 }
}
