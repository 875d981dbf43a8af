//! Pictures as files: 8-bit sRGB as PNG and JPEG, linear radiance as HDR (RGBE) and EXR (32-bit float, with metadata).
//! A file appears whole or not at all: it is written beside its place and renamed. Many pictures in one file are [`movie`]s.

mod layers;
pub mod movie;

use super::film::Film;
use crate::math::colour::{luminance, srgb_decode};
use crate::math::elementary::exp2;
use crate::scene::{Rgb, ToneMap};
use std::io::Cursor;
use std::path::Path;

/// The formats, by their extensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8-bit sRGB.
    Png,
    /// 8-bit sRGB, lossy.
    Jpeg,
    /// Radiance's RGBE, linear.
    Hdr,
    /// OpenEXR, 32-bit float, linear.
    Exr,
}

impl Format {
    /// The extensions that are known, for messages.
    pub const EXTENSIONS: [&'static str; 5] = ["png", "jpg", "jpeg", "hdr", "exr"];

    /// By a path's extension, in upper or lower case. None for another or none.
    pub fn of(path: &Path) -> Option<Format> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "png" => Some(Format::Png),
            "jpg" | "jpeg" => Some(Format::Jpeg),
            "hdr" => Some(Format::Hdr),
            "exr" => Some(Format::Exr),
            _ => None,
        }
    }
}

/// How radiance becomes 8-bit numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Development {
    /// In stops: radiance is multiplied by 2 to this power.
    pub exposure: f64,
    /// From radiance to 0 … 1.
    pub tonemap: ToneMap,
}

/// What an EXR file says of how it was made. No paths and no clocks: the same picture gives the same file.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Metadata {
    /// Of the program.
    pub version: String,
    /// A hash of the scene's text.
    pub scene: String,
    /// The tracer's name.
    pub tracer: String,
    /// Samples per pixel.
    pub samples: u32,
    /// Most segments of a path; 2³² − 1 is without end.
    pub depth: u32,
    /// Of the random numbers.
    pub seed: u64,
    /// How even they are.
    pub sampler: String,
    /// How a pixel gathers its samples.
    pub filter: String,
    /// Most radiance of a camera sample.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clamp: Option<f64>,
    /// Width and height of the whole picture.
    pub size: [u32; 2],
    /// The estimated error at which a pixel was finished; `samples` are then the most.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Whether noise was filtered out of the finished picture.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub denoise: bool,
    /// The objects that the layer `source` numbers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sources: Vec<Origin>,
}

/// An object of the layer `source`.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Origin {
    /// From 1.
    pub number: u32,
    /// The scene's file, without the folders it lies in.
    pub file: String,
    /// From 1.
    pub line: usize,
    /// Its `name`, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// Why a picture could not be made into a file.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The encoder refused.
    #[error("the picture cannot be encoded: {0}")]
    Encode(String),
    /// The machine refused.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// A picture as the bytes of a file.
pub fn encode(
    film: &Film,
    format: Format,
    develop: &Development,
    about: &Metadata,
) -> Result<Vec<u8>, OutputError> {
    let [width, height] = [film.crop.width, film.crop.height];
    let mut bytes = Cursor::new(Vec::new());
    match format {
        Format::Png => {
            use image::codecs::png::{CompressionType, FilterType, PngEncoder};
            let encoder =
                PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive);
            write_rgb8(encoder, &develop_film(film, develop), width, height)?;
        }
        Format::Jpeg => {
            let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY);
            write_rgb8(encoder, &develop_film(film, develop), width, height)?;
        }
        Format::Hdr => {
            let pixels: Vec<_> = film
                .pixels
                .iter()
                .map(|c| image::Rgb(c.as_vec3().max(glam::Vec3::ZERO).to_array()))
                .collect();
            image::codecs::hdr::HdrEncoder::new(&mut bytes)
                .encode(&pixels, width as usize, height as usize)
                .map_err(|e| OutputError::Encode(e.to_string()))?;
        }
        Format::Exr => write_exr(film, about, &mut bytes)?,
    }
    Ok(bytes.into_inner())
}

/// Of 100: above it files grow much and pictures change little.
const JPEG_QUALITY: u8 = 92;

fn write_rgb8(
    encoder: impl image::ImageEncoder,
    pixels: &[u8],
    width: u32,
    height: u32,
) -> Result<(), OutputError> {
    encoder
        .write_image(pixels, width, height, image::ExtendedColorType::Rgb8)
        .map_err(|e| OutputError::Encode(e.to_string()))
}

fn write_exr(film: &Film, about: &Metadata, bytes: &mut Cursor<Vec<u8>>) -> Result<(), OutputError> {
    use exr::prelude::*;
    let crop = film.crop;
    let size = (crop.width as usize, crop.height as usize);
    let window = IntegerBounds::new((0, 0), (film.size[0] as usize, film.size[1] as usize));
    let attributes = attributes(film, about)?;
    let written = if film.layers.is_empty() {
        let at = |p: Vec2<usize>| {
            let c = film.pixels[p.y() * size.0 + p.x()];
            (c.x as f32, c.y as f32, c.z as f32)
        };
        let layer = Layer::new(size, attributes, ENCODING, SpecificChannels::rgb(at));
        Image::new(ImageAttributes::new(window), layer).write().non_parallel().to_buffered(bytes)
    } else {
        let layer = Layer::new(size, attributes, ENCODING, layers::channels(film));
        Image::new(ImageAttributes::new(window), layer).write().non_parallel().to_buffered(bytes)
    };
    written.map_err(|e| OutputError::Encode(e.to_string()))
}

/// Written by one thread in order, so that the bytes do not depend on who was faster.
const ENCODING: exr::prelude::Encoding = exr::prelude::Encoding {
    compression: exr::prelude::Compression::ZIP16,
    blocks: exr::prelude::Blocks::ScanLines,
    line_order: exr::prelude::LineOrder::Increasing,
};

fn attributes(film: &Film, about: &Metadata) -> Result<exr::prelude::LayerAttributes, OutputError> {
    use exr::prelude::{LayerAttributes, Text, Vec2};
    let text = |s: &str| Text::new_or_none(s).unwrap_or_default();
    let json = serde_json::to_string(about).map_err(|e| OutputError::Encode(e.to_string()))?;
    Ok(LayerAttributes {
        layer_position: Vec2(film.crop.x as i32, film.crop.y as i32),
        software_name: Some(text(&format!("ogee {}", about.version))),
        comments: Some(text(&json)),
        ..LayerAttributes::default()
    })
}

/// All pixels as 8-bit sRGB, row by row.
pub fn develop_film(film: &Film, develop: &Development) -> Vec<u8> {
    let table = srgb_table();
    let mut bytes = vec![0; film.pixels.len() * 3];
    for (encoded, pixel) in bytes.chunks_exact_mut(3).zip(&film.pixels) {
        encoded.copy_from_slice(&develop.pixel_by(table, *pixel));
    }
    bytes
}

impl Development {
    /// Linear radiance to 8-bit sRGB.
    pub fn pixel(&self, radiance: Rgb) -> [u8; 3] {
        self.pixel_by(srgb_table(), radiance)
    }

    #[inline]
    fn pixel_by(&self, table: &SrgbTable, radiance: Rgb) -> [u8; 3] {
        /// More make any light white, and their factor would be no number: 2¹⁰²⁴.
        const MOST_STOPS: f64 = 1000.0;
        let stops = self.exposure.min(MOST_STOPS);
        let exposed = if stops == 0.0 { radiance } else { radiance * exp2(stops) };
        let c = tone(self.tonemap, exposed);
        [table.encode(c.x), table.encode(c.y), table.encode(c.z)]
    }
}

fn tone(map: ToneMap, c: Rgb) -> Rgb {
    /// What squared is still a number; a map has long come to its end there.
    const LARGEST: f64 = 1e150;
    let c = if c.max_element() > LARGEST { c.min(Rgb::splat(LARGEST)) } else { c };
    match map {
        ToneMap::None => c,
        ToneMap::Reinhard => c / (1.0 + luminance(c).max(0.0)),
        ToneMap::Aces => c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14),
    }
}

/// A linear number in 0 … 1 as 8-bit sRGB (IEC 61966-2-1), clipped, rounded to the nearest. NaN is 0.
pub fn to_srgb8(linear: f64) -> u8 {
    srgb_table().encode(linear)
}

/// Into how many equal parts 0 … 1 is cut: more than steps are anywhere (sRGB begins with 12.92 · 255 = 3295 a unit), so that no cell has
/// two.
const CELLS: usize = 4096;

struct SrgbTable {
    /// The least linear number that rounds to each of 1 … 255; after them one that is never reached.
    steps: [f64; 256],
    /// What the lower end of each cell, and 1, rounds to.
    first: [u8; CELLS + 1],
}

impl SrgbTable {
    /// Without a power for each channel of each pixel: the number that the lower end of the cell rounds to, or the next.
    #[inline]
    fn encode(&self, linear: f64) -> u8 {
        // Of 16 bits, which the machine makes sooner of a number than 64; NaN is 0.
        let cell = (linear.clamp(0.0, 1.0) * CELLS as f64) as u16;
        let encoded = self.first[usize::from(cell).min(CELLS)];
        encoded + u8::from(self.steps[usize::from(encoded)] <= linear)
    }
}

fn srgb_table() -> &'static SrgbTable {
    static TABLE: std::sync::OnceLock<SrgbTable> = std::sync::OnceLock::new();
    TABLE.get_or_init(|| {
        let step = |i: usize| if i < 255 { srgb_decode((i as f64 + 0.5) / 255.0) } else { f64::NAN };
        let steps: [f64; 256] = std::array::from_fn(step);
        let first = std::array::from_fn(|cell| {
            steps.partition_point(|step| *step <= cell as f64 / CELLS as f64) as u8
        });
        SrgbTable { steps, first }
    })
}

/// Writes bytes so that the file appears whole or not at all: beside its place, then renamed over it.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    use std::io::Write;
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    };
    let mut options = tempfile::Builder::new();
    options.prefix(".ogee-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        options.permissions(std::fs::Permissions::from_mode(0o666)); // less what the user's mask takes away
    }
    let mut file = options.tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.persist(path).map(drop).map_err(|e| e.error)
}

#[cfg(test)]
mod tests;
