//! Pixels side by side: sample by sample, of which the camera's rays find together what they meet.

use super::film::Report;
use super::outline;
use super::pixel::Pixel;
use super::sampler::Sampler;
use super::tiles::Picture;
use crate::world::packet::RAYS;
use std::sync::atomic::{AtomicBool, Ordering};

/// Takes the samples up to number `to` of some pixels, no more than a packet has rays, or until the error of each is as small as the settings ask for; false where
/// that was cancelled. One sampler is enough, as only one of them is traced at a time.
pub fn advance(
    pixels: &mut [Pixel],
    picture: Picture<'_>,
    to: u32,
    report: &mut Report,
    cancel: &AtomicBool,
) -> bool {
    let settings = picture.settings;
    let sampler = Sampler::new(settings.seed, 0, 0, 0).of_kind(settings.sampler, settings.samples);
    let mut sampler = sampler.asking(settings.kept().look());
    if outline::may_be_asked(settings) {
        pixels.iter_mut().for_each(|pixel| pixel.ask_for_outlines(picture, &mut report.rays));
    }
    let mut goes_on = true;
    while goes_on && pixels.iter().any(|pixel| pixel.is_open(to)) {
        goes_on = !cancel.load(Ordering::Relaxed);
        if goes_on {
            step(pixels, picture, to, &mut sampler, report);
        }
    }
    report.rays += sampler.rays;
    goes_on
}

/// One sample of each pixel that is to have one more.
fn step(pixels: &mut [Pixel], picture: Picture<'_>, to: u32, sampler: &mut Sampler, report: &mut Report) {
    let mut rays = [None; RAYS];
    for (pixel, ray) in pixels.iter_mut().zip(&mut rays).filter(|(pixel, _)| pixel.is_open(to)) {
        *ray = pixel.ray(picture, sampler);
        if ray.is_none() {
            pixel.take(picture, None, sampler, report);
        }
    }
    picture.world.find_each(&rays, |i, ray, found| {
        pixels[i].take(picture, Some((ray, found)), sampler, report);
    });
}
