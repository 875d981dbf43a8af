//! Pixels side by side: sample by sample, of which the camera's rays find together what they meet.

use super::film::Report;
use super::pixel::Pixel;
use super::sampler::Sampler;
use super::tiles::Picture;
use crate::world::packet::RAYS;
use std::sync::atomic::{AtomicBool, Ordering};

/// Takes the samples up to number `to` of some pixels, no more than a packet has rays, or until the error of each is as small as the settings ask for; false where
/// that was cancelled.
pub fn advance(
    pixels: &mut [Pixel],
    picture: Picture<'_>,
    to: u32,
    report: &mut Report,
    cancel: &AtomicBool,
) -> bool {
    let mut samplers: Vec<Sampler> = pixels.iter_mut().map(|pixel| pixel.sampler(picture, report)).collect();
    while pixels.iter().any(|pixel| pixel.is_open(to)) {
        if cancel.load(Ordering::Relaxed) {
            return false;
        }
        take(pixels, &mut samplers, picture, to, report);
    }
    true
}

/// One sample of each pixel that is to have one more.
fn take(pixels: &mut [Pixel], samplers: &mut [Sampler], picture: Picture<'_>, to: u32, report: &mut Report) {
    let mut rays = [None; RAYS];
    for (i, (pixel, sampler)) in pixels.iter_mut().zip(&mut *samplers).enumerate() {
        if pixel.is_open(to) {
            rays[i] = pixel.ray(picture, sampler);
            if rays[i].is_none() {
                pixel.take(picture, None, sampler, report);
            }
        }
    }
    picture.world.find_each(&rays, |i, ray, found| {
        pixels[i].take(picture, Some((ray, found)), &mut samplers[i], report);
    });
}
