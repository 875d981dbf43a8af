//! Noise taken out of a finished picture: each pixel becomes a mean of pixels around it that differ from it by no more than noise.
//! Knows no scene, only what the film keeps of each pixel.
//!
//! Non-local means with guides, after Rousselle, Manzi & Zwicker, *Robust Denoising using Feature and Color Information* (2013):
//!
//! 1. Radiance is divided by albedo, so that textures are not there to be blurred, and multiplied by it in the end.
//! 2. Two pixels are alike where their neighbourhoods are, measured by the variance of their samples: squared differences that noise
//!    explains count nothing. And where their guides are: normals, albedos, and how far each lies off the plane of the other. What
//!    guides vary within a pixel (edges, a lens) counts nothing either.
//! 3. The samples of a pixel fall into two parts. Each is averaged with weights that the *other* tells: weights that know the noise
//!    which they weigh prefer what is dark by chance, and the mean of the picture would sink.
//!
//! The variance of even samples is less than that of independent ones, by which it is estimated; the differences between the two parts
//! tell by how much. A neighbourhood's difference is capped pixel by pixel, so that the rim of a lamp does not leave its noise to
//! all pixels around it; a smaller one is not, so that the lamp does not spill.
//!
//! Every pixel is a function of those at most `REACH` away, summed in one order: threads change no bit.

mod band;
mod planes;

use super::film::Film;
use super::tiles::{Progress, run};
use crate::scene::Rgb;
use band::Band;
use planes::Planes;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Pixels are averaged with those in a disc that goes so far. 7 was better than 8, 9 and 10 in rooms at 16 and 64 samples, and in less
/// time.
const WINDOW: usize = 7;

/// Neighbourhoods that are compared go so far to each side.
const PATCH: usize = 2;

/// How far the pixels are that can change a pixel, not counting how uneven samples are found to be.
const REACH: usize = WINDOW + PATCH;

/// What the filter takes at most beside the film, bytes a pixel: its planes, a copy of the film, and what is found.
pub const BYTES_A_PIXEL: u64 = 8 * planes::PLANES + 48 + size_of::<super::features::Features>() as u64;

/// The pixels of a complete film without their noise, by the guides that it keeps ([`super::features::Layers::GUIDES`]). Magenta pixels, where
/// a function was undefined, stay, and tell others nothing. None once `cancel` is true.
pub fn denoised(
    film: &Film,
    threads: Option<usize>,
    progress: &dyn Progress,
    cancel: &AtomicBool,
) -> Option<Vec<Rgb>> {
    progress.phase("noise");
    let planes = Planes::new(film);
    let made = Band::all(film.crop.height as usize).map(|band| (band, Mutex::new(None)));
    let bands: Vec<(Band, Mutex<Option<Vec<Rgb>>>)> = made.collect();
    let done = AtomicUsize::new(0);
    let work = |(band, found): &(Band, Mutex<Option<Vec<Rgb>>>)| {
        *found.lock().unwrap_or_else(PoisonError::into_inner) = band.filtered(&planes, cancel);
        progress.tiles(done.fetch_add(1, Ordering::Relaxed) + 1, bands.len());
    };
    run(threads, &bands, &work);
    let found =
        bands.into_iter().map(|(_, found)| found.into_inner().unwrap_or_else(PoisonError::into_inner));
    let pixels = found.collect::<Option<Vec<_>>>()?.concat();
    let sound = |(new, old): (Rgb, &Rgb)| if new.is_finite() && *old != Film::UNDEFINED { new } else { *old };
    Some(pixels.into_iter().zip(&film.pixels).map(sound).collect())
}

#[cfg(test)]
mod tests;
