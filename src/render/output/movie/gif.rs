//! GIF frames: a palette each, made of the pixels that changed; those that did not are left as they are by one colour that is transparent.

use super::{Part, places};
use crate::render::output::OutputError;
use color_quant::NeuQuant;
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use std::collections::HashMap;

/// Colours of a palette, beside the one that is transparent.
const COLOURS: usize = 255;
const TRANSPARENT: u8 = 255;

/// About so many pixels teach a palette: every one of a small picture, one in some of a large one. More take longer, and no eye sees it.
const TAUGHT: usize = 100_000;

/// The largest "one in so many" that the net of colours takes.
const RAREST: usize = 30;

/// Browsers take shorter times, in hundredths of a second, for a mistake, and show the frame for ten.
const SHORTEST: f64 = 2.0;

pub(super) struct Frames {
    fps: f64,
    frames: Vec<Frame<'static>>,
}

impl Frames {
    pub fn new(fps: f64) -> Frames {
        Frames { fps, frames: Vec::new() }
    }

    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// The time of the next frame in hundredths of a second. They are rounded so that their sum is as long as the animation.
    fn delay(&self) -> u16 {
        let end = |n: usize| (n as f64 * (100.0 / self.fps).max(SHORTEST)).round();
        (end(self.len() + 1) - end(self.len())).min(f64::from(u16::MAX)) as u16
    }

    pub fn push(&mut self, before: &[u8], now: &[u8], part: Part, width: usize) {
        let stays = |at: usize| before.get(at..at + 3) == Some(&now[at..at + 3]);
        let pixel = |at: usize| [now[at], now[at + 1], now[at + 2]];
        let fresh = places(part, width).filter(|at| !stays(*at)).map(pixel);
        let palette = Palette::of(fresh);
        let index = |at: usize| if stays(at) { TRANSPARENT } else { palette.index(pixel(at)) };
        let buffer: Vec<u8> = places(part, width).map(index).collect();
        let mut frame = Frame {
            delay: self.delay(),
            dispose: DisposalMethod::Keep,
            transparent: Some(TRANSPARENT),
            left: part.left as u16,
            top: part.top as u16,
            width: part.width as u16,
            height: part.height as u16,
            palette: Some(palette.colours),
            buffer: buffer.into(),
            ..Frame::default()
        };
        frame.make_lzw_pre_encoded();
        self.frames.push(frame);
    }

    pub fn encode(&self, [width, height]: [u32; 2]) -> Result<Vec<u8>, OutputError> {
        let said = |error: gif::EncodingError| OutputError::Encode(error.to_string());
        let mut encoder = Encoder::new(Vec::new(), width as u16, height as u16, &[]).map_err(said)?;
        encoder.set_repeat(Repeat::Infinite).map_err(said)?;
        for frame in &self.frames {
            encoder.write_lzw_pre_encoded_frame(frame).map_err(said)?;
        }
        encoder.into_inner().map_err(said)
    }
}

/// 256 colours, the last of which is never shown.
struct Palette {
    colours: Vec<u8>,
    indices: HashMap<[u8; 3], u8>,
}

impl Palette {
    /// All colours where they are few enough, else those that a net of them settles on (Dekker 1994).
    fn of(pixels: impl Iterator<Item = [u8; 3]>) -> Palette {
        let pixels: Vec<[u8; 3]> = pixels.collect();
        let mut distinct = pixels.clone();
        distinct.sort_unstable();
        distinct.dedup();
        let (mut colours, indices) = match distinct.len() {
            0..=COLOURS => {
                let indices = distinct.iter().enumerate().map(|(i, c)| (*c, i as u8)).collect();
                (distinct.concat(), indices)
            }
            _ => {
                let taught: Vec<u8> = pixels.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
                let net = NeuQuant::new((pixels.len() / TAUGHT).clamp(1, RAREST) as i32, COLOURS, &taught);
                let nearest = |&[r, g, b]: &[u8; 3]| ([r, g, b], net.index_of(&[r, g, b, 255]) as u8);
                (net.color_map_rgb(), distinct.iter().map(nearest).collect())
            }
        };
        colours.resize(3 * (COLOURS + 1), 0);
        Palette { colours, indices }
    }

    fn index(&self, pixel: [u8; 3]) -> u8 {
        self.indices.get(&pixel).copied().unwrap_or(TRANSPARENT)
    }
}
