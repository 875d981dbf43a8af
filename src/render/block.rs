//! Pixels side by side: sample by sample, of which the camera's rays find together what they meet.

use super::film::Report;
use super::pixel::Pixel;
use super::sampler::{Sampler, Turn};
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
    let mut block = Block::new(pixels, picture, report);
    while block.pixels.iter().any(|pixel| pixel.is_open(to)) {
        if cancel.load(Ordering::Relaxed) {
            return false;
        }
        block.take(to, report);
    }
    true
}

/// Pixels under way. One sampler is enough, as only one of them is traced at a time: it is not small.
struct Block<'b> {
    pixels: &'b mut [Pixel],
    picture: Picture<'b>,
    sampler: Sampler,
    /// The next sample of each pixel.
    turns: [Turn; RAYS],
}

impl<'b> Block<'b> {
    fn new(pixels: &'b mut [Pixel], picture: Picture<'b>, report: &mut Report) -> Block<'b> {
        let settings = picture.settings;
        let sampler = Sampler::new(settings.seed, 0, 0, 0).of_kind(settings.sampler, settings.samples);
        let mut turns = [sampler.turn(); RAYS];
        for (pixel, turn) in pixels.iter_mut().zip(&mut turns) {
            pixel.ask_for_outlines(picture, &mut report.rays);
            *turn = Turn::new(pixel.place(), pixel.taken);
        }
        Block { pixels, picture, sampler: sampler.asking(settings.kept().look()), turns }
    }

    /// One sample of each pixel that is to have one more.
    fn take(&mut self, to: u32, report: &mut Report) {
        let Block { pixels, picture, sampler, turns } = self;
        let mut rays = [None; RAYS];
        for (i, pixel) in pixels.iter_mut().enumerate().filter(|(_, pixel)| pixel.is_open(to)) {
            sampler.turn_to(turns[i]);
            rays[i] = pixel.ray(*picture, sampler);
            turns[i] = sampler.turn();
            if rays[i].is_none() {
                pixel.take(*picture, None, sampler, report);
                turns[i] = turns[i].next();
            }
        }
        picture.world.find_each(&rays, |i, ray, found| {
            sampler.turn_to(turns[i]);
            pixels[i].take(*picture, Some((ray, found)), sampler, report);
            turns[i] = sampler.turn().next();
        });
    }
}
