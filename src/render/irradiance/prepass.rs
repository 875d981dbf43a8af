//! Where records are made: at what the camera sees, from coarse to fine. In each turn the pixels that no record is enough for
//! are found on all threads against the records of the turns before; in each square of pixels the first of them gets a record, all
//! at once; these are entered in the order of the pixels.

use super::Records;
use super::hemisphere::{Hemisphere, Seen};
use super::record::Record;
use crate::render::camera::View;
use crate::render::path::{Matt, Path};
use crate::render::pixel::corner;
use crate::render::sampler::{Sampler, rows};
use crate::render::settings::ResolvedSettings;
use crate::render::tiles::Watch;
use crate::scene::Rgb;
use crate::world::World;
use crate::world::light::{frame, to_frame};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::HashSet;

/// What records are made from.
#[derive(Clone, Copy)]
pub struct Prepass<'a> {
    /// What is seen.
    pub world: &'a World,
    /// By which light is followed. Without records.
    pub path: &'a Path,
    /// From where.
    pub view: &'a View,
    /// With what.
    pub settings: &'a ResolvedSettings,
    /// For how many samples of a pixel.
    pub samples: u32,
    /// Who looks on.
    pub watch: Watch<'a>,
}

/// A pixel that needs a record, and what it shows.
struct Lack<'a> {
    pixel: [u32; 2],
    matt: Matt<'a>,
}

/// Pixels from one to the next, turn by turn.
const STEPS: [u32; 5] = [16, 8, 4, 2, 1];

/// A square in which one record is made at a time is so many steps wide.
const SQUARE: u32 = 4;

/// Pixels that are looked at together: what bounds the memory of those that lack a record.
const BAND: usize = 1 << 15;

/// Rays of a record for each sample of a pixel. So all records take hardly more rays than as many pixels have samples.
pub const RAYS: u32 = 16;

/// The same of those of the first turn: they have no others to ask, and all that come later ask them.
const FIRST_RAYS: u32 = 64;

/// Records in pictures of few pixels.
const FEW: usize = 1 << 10;

/// Makes all records of a picture, each turn an equal part of the work. None where that is called off.
pub fn fill(records: &mut Records, prepass: Prepass<'_>) -> Option<()> {
    let [width, height] = prepass.settings.size;
    for (turn, &step) in STEPS.iter().enumerate() {
        let coarser = turn.checked_sub(1).map(|before| STEPS[before]);
        let is_new = |x: u32, y: u32| coarser.is_none_or(|c| !x.is_multiple_of(c) || !y.is_multiple_of(c));
        let rows = (0..height).step_by(step as usize);
        let pixels = rows.flat_map(|y| (0..width).step_by(step as usize).map(move |x| [x, y]));
        let pixels: Vec<[u32; 2]> = pixels.filter(|&[x, y]| is_new(x, y)).collect();
        for (i, band) in pixels.chunks(BAND).enumerate() {
            let told = |done: usize| {
                let done = turn * pixels.len() + i * BAND + done;
                prepass.watch.progress.tiles(done, STEPS.len() * pixels.len());
            };
            prepass.cover(records, band, turn, &told)?;
        }
    }
    Some(())
}

impl<'a> Prepass<'a> {
    /// Makes records until every one of these pixels has enough, or there are as many as there may be; tells how many are done. None
    /// where that is called off.
    fn cover(
        &self,
        records: &mut Records,
        pixels: &[[u32; 2]],
        turn: usize,
        told: &dyn Fn(usize),
    ) -> Option<()> {
        let square = STEPS[turn] * SQUARE;
        let [width, height] = self.settings.size;
        let most = (width as usize * height as usize / RAYS as usize).max(FEW);
        let mut lacks: Vec<Lack<'_>> =
            pixels.par_iter().filter_map(|&pixel| self.lack(records, pixel)).collect();
        while !lacks.is_empty() && records.records.len() < most {
            told(pixels.len() - lacks.len());
            self.watch.go_on()?;
            let mut squares = HashSet::new();
            let (first, others): (Vec<_>, Vec<_>) =
                lacks.into_iter().partition(|lack| squares.insert(lack.pixel.map(|n| n / square)));
            let made: Vec<Option<Record>> =
                first.par_iter().map(|lack| self.record(records, lack, turn)).collect();
            made.into_iter().flatten().for_each(|record| records.insert(self.world, record));
            let lacking = |lack: &Lack<'_>| !records.is_enough(self.world, &records.place_of(&lack.matt));
            lacks = others.into_par_iter().filter(lacking).collect();
        }
        told(pixels.len());
        self.watch.go_on()
    }

    /// What a pixel shows, if no record is enough there and the work goes on.
    fn lack(&self, records: &Records, pixel: [u32; 2]) -> Option<Lack<'a>> {
        self.watch.go_on()?;
        let [x, y] = pixel;
        let ray = self.view.ray(corner(pixel) + 0.5, DVec2::ZERO)?;
        let mut sampler = Sampler::new(self.settings.seed, x, y | rows::RECORD, 0);
        // What a surface's function leaves undefined is said by the camera's rays.
        let matt = self.path.first_matt(self.world, ray, &mut sampler).ok()??;
        (!records.is_enough(self.world, &records.place_of(&matt))).then_some(Lack { pixel, matt })
    }

    /// The light gathered at what a pixel shows. The bands of cells are seen by as many rays as chance needs for the slope not to be
    /// noise: the difference of two cells has the noise of each, however narrow they are. None where a record would tell nothing, or the
    /// work is called off.
    fn record(&self, records: &Records, lack: &Lack<'_>, turn: usize) -> Option<Record> {
        let matt = &lack.matt;
        let rays = if turn == 0 { FIRST_RAYS } else { RAYS }.saturating_mul(self.samples);
        let hemisphere = Hemisphere::of(2 * rays.isqrt());
        let each = (rays / hemisphere.cells()).max(1).next_power_of_two();
        let seen = |cell| self.watch.go_on().map(|()| self.seen(records, lack, (hemisphere, cell), each));
        let seen: Vec<Seen> = (0..hemisphere.cells()).map(seen).collect::<Option<_>>()?;
        let place = records.place_of(matt);
        let gathered = hemisphere.gathered(&seen, frame(place.normal));
        Record::new(place, gathered, records.limits(place.point))
    }

    /// What so many rays through a cell see.
    fn seen(
        &self,
        records: &Records,
        lack: &Lack<'_>,
        (hemisphere, cell): (Hemisphere, u32),
        rays: u32,
    ) -> Seen {
        let [x, y] = lack.pixel;
        let (mut radiance, mut nearness, mut nearest) = (Rgb::ZERO, 0.0, f64::INFINITY);
        for ray in cell * rays..(cell + 1) * rays {
            let mut sampler = Sampler::new(self.settings.seed, x, y | rows::GATHERING, ray);
            let about = hemisphere.direction(cell, sampler.next_2d());
            let direction = to_frame(lack.matt.bsdf.normal, about);
            let gathered = self.path.gather(self.world, &lack.matt, direction, records, &mut sampler);
            let Ok((found, distance)) = gathered else { continue };
            radiance += found;
            nearness += 1.0 / distance;
            nearest = nearest.min(distance);
        }
        let n = f64::from(rays);
        Seen { radiance: radiance / n, distance: n / nearness, nearest }
    }
}
