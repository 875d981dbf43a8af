//! A picture in tiles: which pixel is traced when and by which thread, and nothing about how. The film's bits depend on
//! neither, because a pixel is made by one thread from random numbers of its own.

use super::Tracer;
use super::camera::View;
use super::film::{Fault, Film, PixelSum, Report};
use super::sampler::Sampler;
use super::settings::{Crop, ResolvedSettings};
use crate::diag::Span;
use crate::scene::Rgb;
use crate::world::{Ray, World};
use glam::DVec2;
use rayon::prelude::*;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Told how far a picture is. Called from any thread, in any order.
pub trait Progress: Sync {
    /// `done` of `total` tiles are finished.
    fn tiles(&self, done: usize, total: usize);
}

/// Nobody is told.
impl Progress for () {
    fn tiles(&self, _done: usize, _total: usize) {}
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
}

/// Does the tiles on as many threads as asked for. One thread, or one tile, starts no pool.
fn run(threads: Option<usize>, tiles: &[Crop], work: &(dyn Fn(&Crop) + Sync)) {
    let one_each = || tiles.par_iter().with_max_len(1).for_each(work);
    match threads {
        Some(0 | 1) => tiles.iter().for_each(work),
        _ if tiles.len() == 1 => tiles.iter().for_each(work),
        None => one_each(),
        Some(n) => match rayon::ThreadPoolBuilder::new().num_threads(n).build() {
            Ok(pool) => pool.install(one_each),
            Err(_) => tiles.iter().for_each(work),
        },
    }
}

/// The tiles of a crop in reading order.
fn tiles_of(crop: Crop, tile: u32) -> Vec<Crop> {
    let steps =
        |from: u32, n: u32| (0..n.div_ceil(tile)).map(move |i| (from + i * tile, tile.min(n - i * tile)));
    steps(crop.y, crop.height)
        .flat_map(|(y, height)| steps(crop.x, crop.width).map(move |(x, width)| Crop { x, y, width, height }))
        .collect()
}

fn render_tile(picture: Picture<'_>, crop: Crop, cancel: &AtomicBool) -> Film {
    let mut film = Film::new(picture.settings.size, crop);
    for row in 0..crop.height {
        for column in 0..crop.width {
            let pixel = [crop.x + column, crop.y + row];
            let Some(radiance) = render_pixel(picture, pixel, &mut film.report, cancel) else { return film };
            let i = (row * crop.width + column) as usize;
            film.pixels[i] = radiance;
            film.finished[i] = true;
        }
    }
    film
}

/// The radiance of a pixel; none where it was cancelled before its last sample.
fn render_pixel(
    picture: Picture<'_>,
    pixel: [u32; 2],
    report: &mut Report,
    cancel: &AtomicBool,
) -> Option<Rgb> {
    let mut sum = PixelSum::default();
    let mut undefined = None;
    for sample in 0..picture.settings.samples {
        if cancel.load(Ordering::Relaxed) {
            return None;
        }
        let ResolvedSettings { seed, sampler: kind, samples, .. } = *picture.settings;
        let mut sampler = Sampler::new(seed, pixel[0], pixel[1], sample).of_kind(kind, samples);
        if let Some(ray) = camera_ray(picture, pixel, &mut sampler) {
            let before = sum.non_finite;
            sum.add(picture.tracer.radiance(picture.world, ray, &mut sampler));
            if sum.non_finite > before {
                note_non_finite(picture.world, ray, pixel, report);
            }
        } else {
            sum.add(Rgb::ZERO);
        }
        undefined = undefined.or(sampler.undefined);
        report.rays += sampler.rays;
    }
    Some(match undefined {
        Some(fault) => {
            report.add_undefined(Fault { pixel, count: 1, span: Some(fault.span), kind: Some(fault.kind) });
            Film::UNDEFINED
        }
        None => sum.mean(),
    })
}

/// The ray of a sample: through the pixel's centre for the only one, else through a point of its square.
fn camera_ray(picture: Picture<'_>, pixel: [u32; 2], sampler: &mut Sampler) -> Option<Ray> {
    let corner = DVec2::new(f64::from(pixel[0]), f64::from(pixel[1]));
    let within = if picture.settings.samples == 1 { DVec2::splat(0.5) } else { sampler.next_2d() };
    let lens = if picture.view.has_lens() { sampler.next_2d() } else { DVec2::ZERO };
    picture.view.ray(corner + within, lens)
}

/// Counts a sample that was not finite, and finds out whose it was by asking again what the camera's ray meets.
fn note_non_finite(world: &World, ray: Ray, pixel: [u32; 2], report: &mut Report) {
    report.non_finite += 1;
    match &mut report.first_non_finite {
        None => report.first_non_finite = Some(Fault { pixel, count: 1, span: seen(world, ray), kind: None }),
        Some(first) => first.count += 1,
    }
}

fn seen(world: &World, ray: Ray) -> Option<Span> {
    let hit = world.closest(&ray)?;
    world.provenance(hit.primitive).map(|p| p.span)
}

/// Copies a part into a film.
fn place(film: &mut Film, part: Film) {
    let width = part.crop.width as usize;
    for row in 0..part.crop.height as usize {
        let to = (row + (part.crop.y - film.crop.y) as usize) * film.crop.width as usize
            + (part.crop.x - film.crop.x) as usize;
        let from = row * width;
        film.pixels[to..to + width].copy_from_slice(&part.pixels[from..from + width]);
        film.finished[to..to + width].copy_from_slice(&part.finished[from..from + width]);
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
