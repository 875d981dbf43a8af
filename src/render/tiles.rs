//! A picture in tiles: which pixel is traced when and by which thread, and nothing about how. The film's bits depend on
//! neither, because a pixel is made by one thread from random numbers of its own.

use super::camera::View;
use super::features::Features;
use super::film::{Film, Report};
use super::pixel::Pixel;
use super::settings::{Crop, ResolvedSettings};
use super::{Tracer, block};
use crate::world::World;
use crate::world::packet::RAYS;
use rayon::prelude::*;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Told how far a picture is. Called from any thread, in any order.
pub trait Progress: Sync {
    /// What is done from now on, before or after the tiles; empty for the tiles themselves.
    fn phase(&self, _name: &'static str) {}

    /// `done` of `total` tiles, or parts of another phase, are finished.
    fn tiles(&self, done: usize, total: usize);
}

/// Nobody is told.
impl Progress for () {
    fn tiles(&self, _done: usize, _total: usize) {}
}

/// Who looks on: is told how far the work is, and may call it off.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Who is told.
    pub progress: &'a dyn Progress,
    /// True once the work is called off.
    pub cancel: &'a AtomicBool,
}

impl Watch<'_> {
    /// True where the work is to end.
    pub fn is_over(self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// None where the work is to end.
    pub fn go_on(self) -> Option<()> {
        (!self.is_over()).then_some(())
    }
}

/// Everything of a picture that is the same at each of its pixels.
#[derive(Clone, Copy)]
pub struct Picture<'a> {
    /// What is seen.
    pub world: &'a World,
    /// From where.
    pub view: &'a View,
    /// How.
    pub tracer: &'a dyn Tracer,
    /// With what.
    pub settings: &'a ResolvedSettings,
}

/// Width and height of a tile: some thousand rays, so that two threads share a small picture evenly and a large one is not
/// counted tile by tile.
pub const TILE: u32 = 32;

/// Width and height of a block of pixels, whose camera rays are cast together.
const BLOCK: u32 = RAYS.isqrt() as u32;

/// Renders the settings' crop. Once `cancel` is true, no further sample is begun, and the film comes back as far as it
/// is, with [`Film::finished`] telling which pixels count.
pub fn render(picture: Picture<'_>, progress: &dyn Progress, cancel: &AtomicBool) -> Film {
    render_in_tiles(picture, TILE, progress, cancel)
}

/// The same with tiles of another size, which changes nothing but the time.
pub fn render_in_tiles(
    picture: Picture<'_>,
    tile: u32,
    progress: &dyn Progress,
    cancel: &AtomicBool,
) -> Film {
    let film = Mutex::new(Film::new(picture.settings.size, picture.settings.crop));
    render_onto(&film, picture, tile, progress, cancel);
    film.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// The same onto a bare film of the settings' size and crop, which gets each tile as it is finished: who holds it as well sees what
/// there is so far.
pub fn render_onto(
    film: &Mutex<Film>,
    picture: Picture<'_>,
    tile: u32,
    progress: &dyn Progress,
    cancel: &AtomicBool,
) {
    progress.phase("");
    let tiles = tiles_of(picture.settings.crop, tile);
    let done = AtomicUsize::new(0);
    let work = |crop: &Crop| {
        if cancel.load(Ordering::Relaxed) {
            return;
        }
        let part = render_tile(picture, *crop, cancel);
        let mut film = film.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        place(&mut film, part);
        progress.tiles(done.fetch_add(1, Ordering::Relaxed) + 1, tiles.len());
    };
    run(picture.settings.threads, &tiles, &work);
    film.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).sort_sources();
}

/// Does the tiles on as many threads as asked for. One thread, or one tile, starts no pool.
pub(super) fn run<T: Sync>(threads: Option<usize>, tiles: &[T], work: &(dyn Fn(&T) + Sync)) {
    let one_each = || tiles.par_iter().with_max_len(1).for_each(work);
    match threads {
        Some(0 | 1) => tiles.iter().for_each(work),
        _ if tiles.len() == 1 => tiles.iter().for_each(work),
        _ => on_threads(threads, one_each),
    }
}

/// Does work that shares itself out on as many threads as asked for, at least one; on those that there are where none is said, or no more
/// can be had.
pub(super) fn on_threads<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> T {
    let pool = |n: usize| rayon::ThreadPoolBuilder::new().num_threads(n.max(1)).build().ok();
    match threads.and_then(pool) {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// The tiles of a crop in reading order.
pub(super) fn tiles_of(crop: Crop, tile: u32) -> Vec<Crop> {
    let steps =
        |from: u32, n: u32| (0..n.div_ceil(tile)).map(move |i| (from + i * tile, tile.min(n - i * tile)));
    steps(crop.y, crop.height)
        .flat_map(|(y, height)| steps(crop.x, crop.width).map(move |(x, width)| Crop { x, y, width, height }))
        .collect()
}

/// A rectangle of pixels on the way, and what happened there.
pub(super) struct Tile {
    crop: Crop,
    pixels: Vec<Pixel>,
    report: Report,
}

impl Tile {
    /// Without a sample.
    pub fn new(crop: Crop, settings: &ResolvedSettings) -> Tile {
        let mut pixels = Vec::with_capacity(crop.area());
        blocks_of(crop).for_each(|block| fill(&mut pixels, block, settings));
        Tile { crop, pixels, report: Report::default() }
    }

    /// Takes the samples up to number `to` of each pixel that has not enough; false where that was cancelled.
    pub fn advance(&mut self, picture: Picture<'_>, to: u32, cancel: &AtomicBool) -> bool {
        let Tile { pixels, report, .. } = self;
        pixels.chunks_mut(RAYS).all(|block| block::advance(block, picture, to, report, cancel))
    }

    /// True where every pixel has enough.
    pub fn is_enough(&self) -> bool {
        self.pixels.iter().all(|pixel| pixel.enough)
    }

    /// What there is of the picture; pixels with fewer than `to` samples are not finished, unless they have enough.
    pub fn film(&self, settings: &ResolvedSettings, to: u32) -> Film {
        let mut film = blank(self.crop, settings, self.report.clone());
        self.pixels.iter().for_each(|pixel| show(&mut film, pixel, to));
        film
    }
}

/// The square blocks of a crop, in reading order.
fn blocks_of(crop: Crop) -> impl Iterator<Item = Crop> {
    tiles_of(crop, BLOCK).into_iter()
}

/// Adds the pixels of a block in reading order, without a sample.
fn fill(pixels: &mut Vec<Pixel>, block: Crop, settings: &ResolvedSettings) {
    for y in block.y..block.y + block.height {
        for x in block.x..block.x + block.width {
            pixels.push(Pixel::new([x, y], settings));
        }
    }
}

/// A crop's film without a pixel.
fn blank(crop: Crop, settings: &ResolvedSettings, report: Report) -> Film {
    let mut film = Film::new(settings.size, crop);
    film.layers = settings.layers;
    film.report = report;
    film.keep(settings.kept());
    film
}

/// Puts what a pixel has come to into its place, if that is `to` samples or enough.
#[inline]
fn show(film: &mut Film, pixel: &Pixel, to: u32) {
    if pixel.is_open(to) {
        return;
    }
    let ([x, y], crop) = (pixel.place(), film.crop);
    let place = (y - crop.y) as usize * crop.width as usize + (x - crop.x) as usize;
    film.pixels[place] = pixel.radiance(&mut film.report);
    film.finished[place] = true;
    film.report.taken.add(pixel.taken(), pixel.enough);
    if let Some(sum) = &pixel.features {
        let (features, source) = sum.features();
        film.features[place] = Features { source: source.map_or(0, |s| film.number_of(s)), ..features };
    }
}

/// Block by block: none is kept, as all samples are taken at once. Whoever wants to know which are finished asks the film.
fn render_tile(picture: Picture<'_>, crop: Crop, cancel: &AtomicBool) -> Film {
    let (settings, to) = (picture.settings, picture.settings.samples);
    let mut film = blank(crop, settings, Report::default());
    let mut pixels = Vec::with_capacity(RAYS);
    for block in blocks_of(crop) {
        pixels.clear();
        fill(&mut pixels, block, settings);
        let goes_on = block::advance(&mut pixels, picture, to, &mut film.report, cancel);
        pixels.iter().for_each(|pixel| show(&mut film, pixel, to));
        if !goes_on {
            break;
        }
    }
    film
}

/// Copies a part into a film.
pub(super) fn place(film: &mut Film, part: Film) {
    let has_features = !part.features.is_empty();
    if has_features {
        film.features.resize(film.pixels.len(), Features::default());
    }
    film.layers = part.layers;
    let numbers: Vec<u32> = part.sources.iter().map(|source| film.number_of(source)).collect();
    let width = part.crop.width as usize;
    for row in 0..part.crop.height as usize {
        let to = (row + (part.crop.y - film.crop.y) as usize) * film.crop.width as usize
            + (part.crop.x - film.crop.x) as usize;
        let from = row * width;
        film.pixels[to..to + width].copy_from_slice(&part.pixels[from..from + width]);
        film.finished[to..to + width].copy_from_slice(&part.finished[from..from + width]);
        if has_features {
            let renumbered = part.features[from..from + width].iter().map(|features| Features {
                source: features.source.checked_sub(1).map_or(0, |source| numbers[source as usize]),
                ..*features
            });
            film.features[to..to + width]
                .iter_mut()
                .zip(renumbered)
                .for_each(|(to, features)| *to = features);
        }
    }
    film.report.merge(part.report);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_a_crop_once() {
        for (crop, tile) in [
            (Crop { x: 3, y: 5, width: 70, height: 33 }, 32),
            (Crop { x: 0, y: 0, width: 1, height: 1 }, 16),
            (Crop { x: 0, y: 0, width: 64, height: 64 }, 32),
        ] {
            let mut seen = vec![0; crop.area()];
            for t in tiles_of(crop, tile) {
                for (x, y) in (t.y..t.y + t.height).flat_map(|y| (t.x..t.x + t.width).map(move |x| (x, y))) {
                    seen[((y - crop.y) * crop.width + x - crop.x) as usize] += 1;
                }
            }
            assert!(seen.iter().all(|n| *n == 1));
        }
    }
}
