//! Frames of an animation in one file: GIF, or PNG that moves (APNG). Each frame is compressed as it comes, and only where it differs from the
//! frame before; so far as it has come, a file can be made at any moment. The same frames give the same bytes.

mod apng;
mod gif;

use super::{Development, OutputError, develop_film};
use crate::render::film::Film;
use std::path::Path;

/// Formats that hold many frames, by their extensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovieFormat {
    /// 255 colours a frame, times in hundredths of a second.
    Gif,
    /// 8-bit sRGB, exact.
    Apng,
}

impl MovieFormat {
    /// By a path's extension, in upper or lower case. None for another or none.
    pub fn of(path: &Path) -> Option<MovieFormat> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "gif" => Some(MovieFormat::Gif),
            "apng" => Some(MovieFormat::Apng),
            _ => None,
        }
    }

    /// Most pixels on a side.
    pub fn largest_side(self) -> u32 {
        match self {
            MovieFormat::Gif => u32::from(u16::MAX),
            MovieFormat::Apng => i32::MAX as u32,
        }
    }
}

/// Frames on their way into a file.
pub struct Movie {
    frames: Frames,
    size: [u32; 2],
    /// The frame before, as 8-bit sRGB.
    last: Vec<u8>,
}

enum Frames {
    Gif(gif::Frames),
    Apng(apng::Frames),
}

/// A part of a picture, in pixels from its top left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Movie {
    /// With no frames yet, to be shown so many a second, again and again.
    pub fn new(format: MovieFormat, fps: f64) -> Movie {
        let frames = match format {
            MovieFormat::Gif => Frames::Gif(gif::Frames::new(fps)),
            MovieFormat::Apng => Frames::Apng(apng::Frames::new(fps)),
        };
        Movie { frames, size: [0, 0], last: Vec::new() }
    }

    /// How many frames there are.
    pub fn len(&self) -> usize {
        match &self.frames {
            Frames::Gif(frames) => frames.len(),
            Frames::Apng(frames) => frames.len(),
        }
    }

    /// Whether there is none yet: then there is no file of it.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Width and height of every frame; none where there is none yet.
    pub fn size(&self) -> Option<[u32; 2]> {
        (!self.is_empty()).then_some(self.size)
    }

    /// Adds a frame. All must have the size of the first.
    pub fn push(&mut self, film: &Film, develop: &Development) -> Result<(), OutputError> {
        let size = [film.crop.width, film.crop.height];
        if !self.is_empty() && size != self.size {
            let ([w, h], [w0, h0]) = (size, self.size);
            let message = format!("it is {w}×{h}, and the frames before are {w0}×{h0}: all have one size");
            return Err(OutputError::Encode(message));
        }
        let pixels = develop_film(film, develop);
        let part = changed(&self.last, &pixels, size[0] as usize);
        match &mut self.frames {
            Frames::Gif(frames) => frames.push(&self.last, &pixels, part, size[0] as usize),
            Frames::Apng(frames) => frames.push(&pixels, part, size[0] as usize)?,
        }
        (self.size, self.last) = (size, pixels);
        Ok(())
    }

    /// The file of all frames so far.
    pub fn encode(&self) -> Result<Vec<u8>, OutputError> {
        match &self.frames {
            Frames::Gif(frames) => frames.encode(self.size),
            Frames::Apng(frames) => frames.encode(self.size),
        }
    }
}

/// The smallest part of a picture with all pixels that are not as before; all of it where there is none before, one pixel where nothing
/// changed.
fn changed(before: &[u8], now: &[u8], width: usize) -> Part {
    let row_bytes = 3 * width;
    let height = now.len() / row_bytes;
    if before.len() != now.len() {
        return Part { left: 0, top: 0, width, height };
    }
    let (mut left, mut right, mut top, mut bottom) = (width, 0, height, 0);
    for (y, (a, b)) in before.chunks_exact(row_bytes).zip(now.chunks_exact(row_bytes)).enumerate() {
        let differs = |x: &usize| a[3 * x..3 * x + 3] != b[3 * x..3 * x + 3];
        if let Some(first) = (0..width).find(differs) {
            let last = (0..width).rev().find(differs).unwrap_or(first);
            (left, right) = (left.min(first), right.max(last + 1));
            (top, bottom) = (top.min(y), y + 1);
        }
    }
    match right {
        0 => Part { left: 0, top: 0, width: 1, height: 1 },
        _ => Part { left, top, width: right - left, height: bottom - top },
    }
}

/// The pixels of a part, as positions of their first bytes, row by row.
fn places(part: Part, width: usize) -> impl Iterator<Item = usize> {
    let row = move |y: usize| (0..part.width).map(move |x| 3 * ((part.top + y) * width + part.left + x));
    (0..part.height).flat_map(row)
}

#[cfg(test)]
mod tests;
