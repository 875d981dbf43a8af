//! Recursive ray tracing after Whitted (1980), and ray casting, which is the same without second rays.
//!
//! At each hit the lights are asked directly; mirrors and glass are followed; nothing else is. Light between diffuse surfaces
//! is left to other tracers, and `ambient` may stand for it. The tree of rays is walked with a list of what is still to do,
//! so that no depth can exhaust the stack.
//!
//! What each does with the meaning of a material:
//! * A perfect mirror and smooth glass take one ray each. A rough one takes one ray per camera sample, off a facet chosen by
//!   GGX; light from point, spot and sun lights, which that ray cannot meet, is evaluated by the lobe instead.
//! * Shadow rays go straight through what transmits and carry off what it takes: its colour, its mirror share, its
//!   absorption. They do not bend.
//! * An area light or a sky gets its `samples` at the first surface seen, and one at surfaces seen in mirrors and glass.

mod local;

use super::Tracer;
use super::medium::Inside;
use super::sampler::Sampler;
use super::settings::ResolvedSettings;
use crate::scene::{Layers, Material, Rgb};
use crate::world::bsdf::{Bsdf, Scattered, Slot};
use crate::world::light::Lights;
use crate::world::texture::Sampled;
use crate::world::{Found, Hit, Ray, RayKind, World};
use std::cell::Cell;

/// The tracers `whitted` and `raycast`.
pub struct Whitted {
    lights: Lights,
    depth: u32,
    background: Option<Rgb>,
    second_rays: bool,
    /// True where some material lets shadow rays through in part.
    clear_shadows: bool,
}

impl Whitted {
    /// Mirrors, glass and shadows, to the settings' depth.
    pub fn new(world: &World, settings: &ResolvedSettings) -> Whitted {
        Whitted {
            lights: Lights::new(world),
            depth: settings.depth,
            background: settings.background,
            second_rays: true,
            clear_shadows: world.materials().any(lets_light_through),
        }
    }

    /// No second ray of any kind: local shading without shadows; mirrors and glass stay black.
    pub fn raycast(world: &World, settings: &ResolvedSettings) -> Whitted {
        Whitted { second_rays: false, ..Whitted::new(world, settings) }
    }

    /// Radiance from where nothing is: the background where it is given, else the sky.
    fn beyond(&self, ray: &Ray) -> Rgb {
        self.background.or_else(|| self.lights.sky(ray.direction)).unwrap_or(Rgb::ZERO)
    }
}

fn lets_light_through(material: &Material) -> bool {
    let is_clear = |l: &Layers| !l.transmit.is(Rgb::ZERO) || !l.opacity.is(Rgb::ONE);
    material.layers.as_deref().is_some_and(is_clear)
}

/// A ray still to be followed.
#[derive(Clone, Copy)]
struct Task {
    ray: Ray,
    stage: Stage,
}

/// How far a sample has come with a ray.
#[derive(Clone, Copy)]
struct Stage {
    /// What the ray's radiance is multiplied by in the sample.
    weight: Rgb,
    /// Segments from the camera, this one counted.
    segment: u32,
    inside: Inside,
}

/// With the ray of the camera.
static FIRST: Stage = Stage { weight: Rgb::ONE, segment: 1, inside: Inside::NOTHING };

thread_local! {
    /// The list of what is still to do, kept between samples so that tracing does not allocate.
    static KEPT: Cell<Vec<Task>> = const { Cell::new(Vec::new()) };
}

/// What is still to do in a sample: nothing at all for most, which then do not ask for the kept list.
#[derive(Default)]
struct Tasks(Vec<Task>);

impl Tasks {
    /// Adds a task, if it can still matter.
    fn push(&mut self, task: Task) -> bool {
        let matters = task.stage.weight.max_element() > LEAST_WEIGHT;
        if matters {
            if self.0.capacity() == 0 {
                self.0 = KEPT.take();
                self.0.clear();
            }
            self.0.push(task);
        }
        matters
    }

    /// Keeps the room for the next sample.
    fn keep(self) {
        if self.0.capacity() > 0 {
            KEPT.set(self.0);
        }
    }
}

/// A branch that can change its sample by less than this share of the light it meets is not followed: it bounds the number
/// of rays between many glass surfaces, at an error far below what a 32-bit picture stores.
const LEAST_WEIGHT: f64 = 1.0 / (1u64 << 30) as f64;

impl Tracer for Whitted {
    fn radiance(&self, world: &World, ray: &Ray, found: &Found, sampler: &mut Sampler) -> Rgb {
        sampler.rays.camera += 1;
        let mut tasks = Tasks::default();
        let mut sum = Rgb::ZERO;
        let mut sent =
            self.come_to(world, world.hit(ray, found).as_ref(), (ray, &FIRST), &mut tasks, sampler);
        loop {
            match sent {
                Ok(radiance) => sum += radiance,
                Err(fault) => {
                    sampler.undefined = Some(fault);
                    break;
                }
            }
            let Some(Task { ray, stage }) = &tasks.0.pop() else { break };
            // A hit and what it is made of are looked at where they stand: a copy of so much just written waits for the writes.
            sent = self.come_to(world, world.closest(ray).as_ref(), (ray, stage), &mut tasks, sampler);
        }
        tasks.keep();
        sum
    }
}

impl Whitted {
    /// What the end of one ray adds to the sample; the rays that go on from there are added to the tasks.
    fn come_to(
        &self,
        world: &World,
        met: Option<&Hit<'_>>,
        (ray, stage): (&Ray, &Stage),
        tasks: &mut Tasks,
        sampler: &mut Sampler,
    ) -> Sampled<Rgb> {
        let Some(hit) = met else {
            return Ok(stage.weight * stage.inside.kept(f64::INFINITY) * self.beyond(ray));
        };
        sampler.first.meet(ray, hit);
        let mut slot = Slot::uninit();
        let bsdf = Bsdf::put(&mut slot, world, hit, ray)?;
        sampler.first.look(bsdf);
        let mut weight = stage.weight * stage.inside.left(bsdf, hit.t);
        if bsdf.opacity < 1.0 {
            let past = Stage { weight: weight * (1.0 - bsdf.opacity), ..*stage };
            tasks.push(Task { ray: hit.spawn(ray.direction, ray.kind), stage: past });
            weight *= bsdf.opacity;
        }
        let mut radiance = bsdf.ambient + bsdf.emitted(world, hit);
        let last = self.second_rays && stage.segment >= self.depth;
        if !last {
            radiance += self.local(world, hit, bsdf, stage.segment == 1, sampler)?;
        }
        if self.second_rays && !last && bsdf.goes_on() {
            self.branch(hit, bsdf, &Stage { weight, ..*stage }, tasks, sampler);
        }
        let sent = weight * radiance;
        sampler.suspect.look(hit.primitive, [sent, weight]);
        Ok(sent)
    }

    /// The mirrored and the bent ray of a hit.
    fn branch(&self, hit: &Hit<'_>, bsdf: &Bsdf, from: &Stage, tasks: &mut Tasks, sampler: &mut Sampler) {
        let next = |s: Scattered, inside| Task {
            ray: hit.spawn(s.direction, RayKind::Indirect),
            stage: Stage { weight: from.weight * s.weight, segment: from.segment + 1, inside },
        };
        let u = if bsdf.is_glossy() { sampler.next_2d() } else { glam::DVec2::ZERO };
        if let Some(bent) = bsdf.transmitted(u) {
            sampler.rays.refracted += u64::from(tasks.push(next(bent, from.inside.across(bsdf))));
        }
        if let Some(mirrored) = bsdf.mirrored(u) {
            sampler.rays.reflected += u64::from(tasks.push(next(mirrored, from.inside)));
        }
    }
}
