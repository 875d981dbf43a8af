//! APNG frames: exact pixels, the part that changed. How many frames there are stands in front of them all, so each waits as a small PNG.

use super::{Part, places};
use crate::render::output::OutputError;
use png::{AdaptiveFilterType, BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder};
use std::io::Cursor;

pub(super) struct Frames {
    delay: (u16, u16),
    frames: Vec<(Part, Vec<u8>)>,
}

impl Frames {
    pub fn new(fps: f64) -> Frames {
        Frames { delay: delay(fps), frames: Vec::new() }
    }

    pub fn len(&self) -> usize {
        self.frames.len()
    }

    pub fn push(&mut self, now: &[u8], part: Part, width: usize) -> Result<(), OutputError> {
        let pixels: Vec<u8> = places(part, width).flat_map(|at| now[at..at + 3].iter().copied()).collect();
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, part.width as u32, part.height as u32);
        as_pixels(&mut encoder, Compression::Fast);
        let mut writer = encoder.write_header().map_err(said)?;
        writer.write_image_data(&pixels).and_then(|()| writer.finish()).map_err(said)?;
        self.frames.push((part, bytes));
        Ok(())
    }

    pub fn encode(&self, [width, height]: [u32; 2]) -> Result<Vec<u8>, OutputError> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, width, height);
        as_pixels(&mut encoder, Compression::Default);
        encoder.set_animated(self.frames.len() as u32, 0).map_err(said)?;
        encoder.set_frame_delay(self.delay.0, self.delay.1).map_err(said)?;
        encoder.set_blend_op(BlendOp::Source).map_err(said)?;
        encoder.set_dispose_op(DisposeOp::None).map_err(said)?;
        let mut writer = encoder.write_header().map_err(said)?;
        for (part, frame) in &self.frames {
            let pixels = pixels(frame)?;
            writer.reset_frame_position().map_err(said)?;
            writer.set_frame_dimension(part.width as u32, part.height as u32).map_err(said)?;
            writer.set_frame_position(part.left as u32, part.top as u32).map_err(said)?;
            writer.write_image_data(&pixels).map_err(said)?;
        }
        writer.finish().map_err(said)?;
        Ok(bytes)
    }
}

fn as_pixels<W: std::io::Write>(encoder: &mut Encoder<'_, W>, compression: Compression) {
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.set_adaptive_filter(AdaptiveFilterType::Adaptive);
}

/// The pixels of a frame that waited.
fn pixels(frame: &[u8]) -> Result<Vec<u8>, OutputError> {
    let unread = |error: png::DecodingError| OutputError::Encode(error.to_string());
    let mut reader = png::Decoder::new(Cursor::new(frame)).read_info().map_err(unread)?;
    let mut pixels = vec![0; reader.output_buffer_size()];
    reader.next_frame(&mut pixels).map_err(unread)?;
    Ok(pixels)
}

fn said(error: png::EncodingError) -> OutputError {
    OutputError::Encode(error.to_string())
}

/// The time of a frame in seconds, as a fraction of 16-bit numbers: exact for whole and decimal rates up to a thousandth.
pub(super) fn delay(fps: f64) -> (u16, u16) {
    const MOST: f64 = u16::MAX as f64;
    let scales = [1.0, 10.0, 100.0, 1000.0];
    let fits = |scale: &&f64| (fps * **scale).round() <= MOST && (fps * **scale).round() >= 1.0;
    let error = |scale: &f64| ((fps * scale).round() / scale - fps).abs();
    let best = scales.iter().filter(fits).min_by(|a, b| error(a).total_cmp(&error(b)));
    match best {
        Some(scale) => (*scale as u16, (fps * scale).round() as u16),
        None if fps > 1.0 => (0, 1),
        None => ((1.0 / fps).round().min(MOST) as u16, 1),
    }
}
