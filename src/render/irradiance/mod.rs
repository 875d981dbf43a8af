//! Irradiance records as the tracer `irradiance` uses them (Ward, Rubinstein & Clear, *A Ray Tracing Solution for Diffuse
//! Interreflection*, 1988): the light that matt surfaces send each other changes slowly, so it is found well at few places and
//! interpolated between them.
//!
//! | light on its way to a matt surface that the camera sees | found by |
//! |---|---|
//! | straight from a lamp or the sky, or from one by mirrors and glass | the path, which asks and meets |
//! | from other matt surfaces | records |
//!
//! Where no record holds, the path goes on as any other. All records are made before the picture, in an order that neither
//! threads nor hashes reach.
//!
//! There are more of them than a cache that goes by the mean distance alone would make: about 1,050 on the Cornell box of 128 × 128 pixels at 16
//! samples, half of them as short as they may be and nearly all others shortened by their neighbours. If neighbours did not agree 400 would do,
//! for 1.8 times the error of 4 × 4 pixels (0.034 in place of 0.019), and asking for no more than the error that is borne (`ENOUGH` of 1) makes 560, for 1.6
//! times. A least reach of 8 pixels makes 610 and takes 0.6 of the time, but what more samples gain in the rest makes the error no smaller, there, in
//! `examples/window.scene` and, within chance, in a room lit by the sun on its floor; so it stays 4.

mod grid;
mod hemisphere;
mod prepass;
mod record;

use super::camera::View;
use super::path::{Matt, Path};
use super::settings::ResolvedSettings;
use super::tiles::{Watch, on_threads};
use crate::scene::Rgb;
use crate::world::bsdf::Bsdf;
use crate::world::{Footprint, Hit, Ray, RayKind, World};
use glam::DVec3;
use grid::Grid;
use record::{Place, Record};

/// The records of a picture.
pub struct Records {
    records: Vec<Record>,
    grid: Grid,
    /// Errors of place up to this are borne.
    error: f64,
    footprint: Footprint,
    has_end: bool,
}

/// The error that is borne at 64 samples a pixel.
const ERROR: f64 = 0.3;

/// A place with a record of less than this share of the error needs no other.
const ENOUGH: f64 = 0.7;

/// Pixels that a record holds for at least and at most, to each side.
const PIXELS: [f64; 2] = [4.0, 64.0];

/// The ray from one record's place to the next is lifted by this share of its length, so that the surface itself is not met.
const LIFTED: f64 = 1.0 / 64.0;

/// Samples of a pixel that records are made for. Where an error decides, as many as leave half of it to the light of one record, whose rays
/// err by about 1 over the root of their number.
fn samples(settings: &ResolvedSettings) -> u32 {
    let Some(error) = settings.error else { return settings.samples };
    let rays = 1.0 / (error / 2.0 * (error / 2.0));
    settings.samples.min((rays / f64::from(prepass::RAYS)).ceil() as u32)
}

impl Records {
    /// The records that a picture needs. Threads leave no trace in them. None where the work is called off.
    pub fn new(
        world: &World,
        path: &Path,
        view: &View,
        settings: &ResolvedSettings,
        watch: Watch<'_>,
    ) -> Option<Records> {
        // Noise falls as the root of the samples, and the error of what is interpolated about as the square of its reach.
        let samples = samples(settings);
        let error = ERROR * (64.0 / f64::from(samples)).sqrt().sqrt();
        let mut records = Records {
            records: Vec::new(),
            grid: Grid::default(),
            error: error.clamp(ERROR / 3.0, ERROR * 1.5),
            footprint: view.footprint(),
            has_end: settings.depth < u32::MAX,
        };
        let prepass = prepass::Prepass { world, path, view, settings, samples, watch };
        watch.progress.phase("records");
        on_threads(settings.threads, || prepass::fill(&mut records, prepass))?;
        Some(records)
    }

    /// The irradiance of a place by light from other matt surfaces. None where no record holds.
    pub fn told(&self, world: &World, hit: &Hit<'_>, bsdf: &Bsdf, segment: u32) -> Option<Rgb> {
        let at = self.place(hit.point, bsdf.normal, segment);
        let (mut sum, mut weights) = (Rgb::ZERO, 0.0);
        for record in self.near(&at) {
            let weight = 1.0 - record.error(&at) / self.error;
            if weight > 0.0 && self.sees(world, record, &at) {
                sum += record.told(&at) * weight;
                weights += weight;
            }
        }
        (weights > 0.0).then(|| sum / weights)
    }

    /// The irradiance of a place by the record that errs least there, if it holds: for what is only one of many that a record gathers,
    /// which need not be smooth.
    pub fn roughly(&self, world: &World, hit: &Hit<'_>, bsdf: &Bsdf, segment: u32) -> Option<Rgb> {
        let at = self.place(hit.point, bsdf.normal, segment);
        let with_error = self.near(&at).map(|record| (record.error(&at), record));
        let (error, record) = with_error.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (error < self.error && self.sees(world, record, &at)).then(|| record.told(&at))
    }

    fn place(&self, point: DVec3, normal: DVec3, segment: u32) -> Place {
        Place { point, normal, segment: if self.has_end { segment } else { 0 } }
    }

    fn place_of(&self, matt: &Matt<'_>) -> Place {
        self.place(matt.hit.point, matt.bsdf.normal, matt.segment)
    }

    fn near(&self, at: &Place) -> impl Iterator<Item = &Record> {
        self.grid.near(at.point).map(|i| &self.records[i as usize])
    }

    /// True where a place needs no record of its own.
    fn is_enough(&self, world: &World, at: &Place) -> bool {
        let mut near = self.near(at);
        near.any(|record| record.error(at) < ENOUGH * self.error && self.sees(world, record, at))
    }

    /// False where something stands between a record and a place that it might hold for.
    fn sees(&self, world: &World, record: &Record, at: &Place) -> bool {
        if !record.is_tight(self.error) {
            return true;
        }
        let lift = LIFTED * record.place.point.distance(at.point);
        let from = at.point + at.normal * lift;
        let way = record.place.point + record.place.normal * lift - from;
        let length = way.length();
        let ray = Ray { origin: from, direction: way / length, t_max: length, kind: RayKind::Shadow };
        length == 0.0 || !world.occluded(&ray)
    }

    /// The least and most radius of a record at a point, by the size of a pixel there.
    fn limits(&self, point: DVec3) -> [f64; 2] {
        let Footprint { eye, per_distance, constant } = self.footprint;
        let pixel = constant + per_distance * eye.distance(point);
        PIXELS.map(|pixels| pixels * pixel / self.error)
    }

    /// Enters a record, unless one that was entered before is enough at its place.
    fn insert(&mut self, world: &World, mut record: Record) {
        if self.is_enough(world, &record.place) {
            return;
        }
        let near: Vec<u32> = self.grid.near(record.place.point).collect();
        near.iter().for_each(|&i| record.clamp_to(&self.records[i as usize]));
        near.iter().for_each(|&i| self.records[i as usize].clamp_to(&record));
        self.grid.insert(self.records.len() as u32, record.place.point, self.error * record.radius());
        self.records.push(record);
    }
}
