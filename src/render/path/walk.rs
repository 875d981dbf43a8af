//! A path under way: where it is, what it carries, and how it leaves a surface. Knows nothing of lights.

use super::roulette::Roulette;
use crate::render::irradiance::Records;
use crate::render::medium::Inside;
use crate::render::sampler::Sampler;
use crate::scene::Rgb;
use crate::world::bsdf::{Bounce, Bsdf};
use crate::world::{Hit, Ray, RayKind};
use glam::DVec3;

/// The surface that the last segment came from, and how likely its direction was.
#[derive(Clone, Copy)]
pub struct Last {
    /// Where.
    pub point: DVec3,
    /// Unit shading normal.
    pub normal: DVec3,
    /// Of the direction, per solid angle.
    pub density: f64,
}

/// How far a path is that photons may end, or that gathers for a record.
#[derive(Clone, Copy, PartialEq)]
pub enum Stage {
    /// Nothing is told of it elsewhere.
    Whole,
    /// All surfaces so far were mirrors and glass.
    Seen,
    /// It left a matt surface.
    Gathers,
    /// It left a matt surface and mirrors after it: what it meets by itself is among the caustics there.
    Covered,
    /// It left the place of a record, and nothing but mirrors and glass since: what it meets by itself is not among the record.
    Gathered,
}

impl Stage {
    #[inline]
    fn after(self, is_mirror: bool) -> Stage {
        match (self, is_mirror) {
            (Stage::Whole | Stage::Gathered, _) => self,
            (_, false) => Stage::Gathers,
            (Stage::Seen, true) => Stage::Seen,
            (Stage::Gathers | Stage::Covered, true) => Stage::Covered,
        }
    }

    /// At a surface that spreads light.
    #[inline]
    fn at_base(self) -> Stage {
        match self {
            Stage::Covered => Stage::Gathers,
            Stage::Gathered => Stage::Whole,
            Stage::Whole | Stage::Seen | Stage::Gathers => self,
        }
    }

    /// True where light of lamps, met or asked, is counted elsewhere.
    #[inline]
    pub fn is_covered(self) -> bool {
        matches!(self, Stage::Covered | Stage::Gathered)
    }

    /// Whether lamps are asked at a surface that spreads light, or, without a base, is a mirror or glass all the same.
    #[inline]
    pub fn asks(self, has_base: bool) -> bool {
        match self {
            Stage::Whole | Stage::Seen => true,
            Stage::Gathers => has_base,
            Stage::Covered | Stage::Gathered => false,
        }
    }
}

/// A path under way.
pub struct Walk<'a> {
    /// Its last segment.
    pub ray: Ray,
    /// What radiance from here on is multiplied by in the sample.
    pub weight: Rgb,
    /// Segments from the camera, this one counted.
    pub segment: u32,
    /// What it is in.
    pub inside: Inside,
    /// How many ways on the next surface that spreads light gives.
    pub branches: u32,
    /// None after the camera and after what is smooth: nothing but this ray could have met what it meets.
    pub last: Option<Last>,
    /// True while the camera sees along it, by mirrors and glass.
    pub seen: bool,
    /// What of it is told elsewhere.
    pub stage: Stage,
    /// What is left of the weight at the next surface that spreads light: records told the rest.
    pub kept: Rgb,
    /// Those that are there so far, while one is made.
    pub records: Option<&'a Records>,
    /// Of its first segment, once it has met something.
    pub first_length: f64,
    /// What it has brought.
    pub sum: Rgb,
    /// What ends it.
    pub roulette: &'a Roulette,
    /// Its numbers.
    pub sampler: &'a mut Sampler,
}

impl<'a> Walk<'a> {
    /// At its first segment.
    #[inline]
    pub fn from_camera(ray: Ray, roulette: &'a Roulette, sampler: &'a mut Sampler) -> Walk<'a> {
        Walk {
            ray,
            weight: Rgb::ONE,
            segment: 1,
            inside: Inside::NOTHING,
            branches: 1,
            last: None,
            seen: true,
            stage: Stage::Whole,
            kept: Rgb::ONE,
            records: None,
            first_length: f64::INFINITY,
            sum: Rgb::ZERO,
            roulette,
            sampler,
        }
    }
}

impl Walk<'_> {
    /// A path of its own from here on, of which nothing is summed yet.
    #[inline]
    pub fn branch(&mut self) -> Walk<'_> {
        Walk { sum: Rgb::ZERO, sampler: &mut *self.sampler, ..*self }
    }

    /// True where what is met emits has been found by other rays.
    #[inline]
    pub fn tells_no_emission(&self) -> bool {
        self.segment == 1 && self.sampler.emission_rays > 0
    }

    /// Notes how long the first segment is.
    #[inline]
    pub fn note_length(&mut self, length: f64) {
        if self.first_length == f64::INFINITY {
            self.first_length = length;
        }
    }

    /// Goes straight on where the surface is there only in part, by chance. False where it is met.
    #[inline]
    pub fn slips(&mut self, hit: &Hit<'_>, bsdf: &Bsdf) -> bool {
        let slips = bsdf.opacity < 1.0 && self.sampler.next_1d() >= bsdf.opacity;
        if slips {
            self.ray = hit.spawn(self.ray.direction, self.ray.kind);
        }
        slips
    }

    /// Comes to a surface with what is not told elsewhere. False where that is nothing.
    #[inline]
    pub fn arrives(&mut self, bsdf: &Bsdf) -> bool {
        if bsdf.has_base() {
            self.stage = self.stage.at_base();
            self.weight *= std::mem::replace(&mut self.kept, Rgb::ONE);
        }
        self.weight != Rgb::ZERO
    }

    /// Leaves a surface. False where the path ends by chance.
    #[inline]
    pub fn leave(&mut self, hit: &Hit<'_>, bsdf: &Bsdf, bounce: &Bounce) -> bool {
        self.count(bounce);
        if bounce.through {
            self.inside = self.inside.across(bsdf);
        }
        self.weight *= bounce.weight;
        self.ray = hit.spawn(bounce.direction, RayKind::Indirect);
        self.last = bounce.density.map(|density| Last { point: hit.point, normal: bsdf.normal, density });
        self.stage = self.stage.after(self.last.is_none() || !bsdf.has_base());
        self.seen &= self.last.is_none();
        self.segment += 1;
        self.survives()
    }

    /// Ends by chance where little is carried; what goes on counts for those that ended.
    #[inline]
    fn survives(&mut self) -> bool {
        let carried = self.weight.max_element();
        let Some(survival) = self.roulette.survival(carried, self.segment, self.last.is_none()) else {
            return true;
        };
        let Some(chance) = self.sampler.next_set_if(survival < 1.0) else { return true };
        self.weight /= survival;
        chance.point(0, 1).x < survival
    }

    /// Goes on from a surface whose lobes are told, off its smooth mirror if it has one. False where the path ends.
    pub fn is_mirrored(&mut self, hit: &Hit<'_>, bsdf: &Bsdf) -> bool {
        if !bsdf.goes_on() || bsdf.is_glossy() {
            return false;
        }
        let (which, way) = (self.sampler.next_1d(), self.sampler.next_2d());
        let bounce = bsdf.bounce(bsdf.odds(), which, way).filter(|bounce| bounce.density.is_none());
        bounce.is_some_and(|bounce| self.leave(hit, bsdf, &bounce))
    }

    fn count(&mut self, bounce: &Bounce) {
        let rays = &mut self.sampler.rays;
        let counter = match (bounce.density, bounce.through) {
            (Some(_), _) => &mut rays.scattered,
            (None, true) => &mut rays.refracted,
            (None, false) => &mut rays.reflected,
        };
        *counter += 1;
    }
}
