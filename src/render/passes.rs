//! A picture in passes over all of it, each with more samples: after any of them it is the picture of so many samples, to the last bit. Knows no
//! clock; who has one decides how far to go. So is a picture made whose tracer must be renewed on the way.

use super::Tracer;
use super::camera::View;
use super::film::Film;
use super::settings::ResolvedSettings;
use super::tiles::{Picture, Progress, TILE, Tile, Watch, place, run, tiles_of};
use crate::world::World;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};

/// A picture on the way.
pub struct Passes<'a> {
    settings: &'a ResolvedSettings,
    tiles: Vec<Mutex<Tile>>,
    /// Samples that each pixel has, or is to have.
    to: u32,
}

impl<'a> Passes<'a> {
    /// Without a sample.
    pub fn new(settings: &'a ResolvedSettings) -> Passes<'a> {
        let tiles = tiles_of(settings.crop, TILE).into_iter();
        let tiles = tiles.map(|crop| Mutex::new(Tile::new(crop, settings))).collect();
        Passes { settings, tiles, to: 0 }
    }

    /// Takes the samples up to number `to` of each pixel; false where that was cancelled. The picture must be the same in all passes, by a tracer
    /// that is ready for these samples.
    pub fn advance(
        &mut self,
        picture: Picture<'_>,
        to: u32,
        progress: &dyn Progress,
        cancel: &AtomicBool,
    ) -> bool {
        self.to = to;
        progress.phase("");
        let done = AtomicUsize::new(0);
        let work = |tile: &Mutex<Tile>| {
            if locked(tile).advance(picture, to, cancel) {
                progress.tiles(done.fetch_add(1, Ordering::Relaxed) + 1, self.tiles.len());
            }
        };
        run(self.settings.threads, &self.tiles, &work);
        done.into_inner() == self.tiles.len()
    }

    /// True where every pixel has enough.
    fn is_enough(&self) -> bool {
        self.tiles.iter().all(|tile| locked(tile).is_enough())
    }

    /// The picture so far; pixels that miss samples of the last pass are not finished.
    pub fn film(&self) -> Film {
        let mut film = Film::new(self.settings.size, self.settings.crop);
        self.tiles.iter().for_each(|tile| place(&mut film, locked(tile).film(self.settings, self.to)));
        film.sort_sources();
        film
    }
}

fn locked(tile: &Mutex<Tile>) -> MutexGuard<'_, Tile> {
    tile.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Renders onto a bare film by a tracer that is renewed as often as it must be. Once the work is called off the film is that of the pass
/// before, or of the first as far as it is.
pub fn render_renewing(
    film: &Mutex<Film>,
    (world, view, settings): (&World, &View, &ResolvedSettings),
    tracer: &mut dyn Tracer,
    watch: Watch<'_>,
) {
    let mut passes = Passes::new(settings);
    let of = settings.samples.div_ceil(tracer.lasts()) as usize;
    for i in 0..of {
        if i > 0 && tracer.renew(world, settings, watch).is_none() {
            return;
        }
        let picture = Picture { world, view, tracer: &*tracer, settings };
        let part = Part { progress: watch.progress, before: i, of };
        let is_whole = passes.advance(picture, tracer.lasts().min(settings.samples), &part, watch.cancel);
        if is_whole || i == 0 {
            *film.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = passes.film();
        }
        if !is_whole || passes.is_enough() {
            return;
        }
    }
}

/// Tells of one of several passes as a part of the whole.
struct Part<'a> {
    progress: &'a dyn Progress,
    before: usize,
    of: usize,
}

impl Progress for Part<'_> {
    fn phase(&self, name: &'static str) {
        self.progress.phase(name);
    }

    fn tiles(&self, done: usize, total: usize) {
        self.progress.tiles(self.before * total + done, self.of * total);
    }
}

/// Samples of the first pass: with one, the ray goes through the pixel's centre, and more could not go on from it.
pub const FIRST: u32 = 2;

/// How many samples to go on to after `n` that took `used` seconds, where `left` are left: twice as many; or by a half or a quarter more, so that the
/// last pass still fits whole blocks of even samples; none where even that would take too long, or `most` have been taken.
pub fn next(n: u32, used: f64, left: f64, most: u32) -> Option<u32> {
    let more = [n, n / 2, n / 4].into_iter().filter(|more| *more > 0 && n.is_power_of_two());
    let mut fits = more.filter(|more| used * f64::from(*more) / f64::from(n) <= left);
    fits.find_map(|more| n.checked_add(more).filter(|to| *to <= most))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_double_and_the_last_fills_what_is_left() {
        assert_eq!(next(8, 1.0, 1.0, 100), Some(16));
        assert_eq!(next(8, 1.0, 0.6, 100), Some(12));
        assert_eq!(next(8, 1.0, 0.3, 100), Some(10));
        assert_eq!(next(8, 1.0, 0.2, 100), None);
        assert_eq!(next(12, 0.1, 100.0, 100), None, "twelve are the last");
        assert_eq!(next(64, 0.1, 100.0, 100), Some(96));
        assert_eq!(next(2, 1.0, 0.9, 100), Some(3));
        assert_eq!(next(1 << 31, 0.0, 1.0, u32::MAX), Some((1 << 31) + (1 << 30)));
    }
}
