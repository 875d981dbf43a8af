//! Pictures as textures: PNG, JPEG, TGA, BMP, Radiance HDR and OpenEXR, decoded once and kept as they were stored, so that
//! one picture serves as colours (sRGB decoded) and as numbers (as they are). Knows nothing of patterns or surfaces.

use crate::math::colour::srgb_decode;
use image::{DynamicImage, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, LazyLock, OnceLock};

/// Most texels of a picture: 16384 × 16384. A larger one is refused before it is decoded.
pub const MAX_TEXELS: u64 = 1 << 28;

/// A decoded picture: rows from the top, 1 (grey), 2 (grey, alpha), 3 or 4 channels.
#[derive(Clone, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    channels: usize,
    texels: Texels,
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "image {} × {} × {}", self.width, self.height, self.channels)
    }
}

#[derive(Clone, PartialEq)]
enum Texels {
    /// 0 … 255, sRGB where they are colours.
    Byte(Vec<u8>),
    /// Encoded 0 … 1 of 16-bit files, sRGB where they are colours.
    Encoded(Vec<f32>),
    /// Light itself: HDR and EXR.
    Linear(Vec<f32>),
}

/// What a picture's numbers are read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// Colours: files of 8 and 16 bits are sRGB.
    Colour,
    /// Numbers, as they stand in the file.
    Data,
}

/// Why a picture cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// It is of no kind that is known.
    #[error("it is no picture of a known kind (PNG, JPEG, TGA, BMP, HDR, EXR)")]
    UnknownFormat,
    /// It is too large.
    #[error("it has {0} × {1} texels, more than 2^28")]
    TooLarge(u32, u32),
    /// It has no texels.
    #[error("it has no texels")]
    Empty,
    /// It is damaged, or of a variant that is not read.
    #[error("{0}")]
    Broken(String),
}

impl Image {
    /// Decodes a file's bytes. The format is told by the content, and by the name's ending where the content does not tell.
    pub fn decode(bytes: &[u8], path: &Path) -> Result<Image, ImageError> {
        let format = image::guess_format(bytes).or_else(|_| ImageFormat::from_path(path));
        let format = format.map_err(|_| ImageError::UnknownFormat)?;
        let (width, height) =
            ImageReader::with_format(Cursor::new(bytes), format).into_dimensions().map_err(broken)?;
        if width == 0 || height == 0 {
            return Err(ImageError::Empty);
        }
        if u64::from(width) * u64::from(height) > MAX_TEXELS {
            return Err(ImageError::TooLarge(width, height));
        }
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits());
        let mut decoded = Image::from_decoded(reader.decode().map_err(broken)?, format);
        if let (ImageFormat::Hdr, Texels::Linear(data)) = (format, &mut decoded.texels) {
            let exposure = radiance_exposure(bytes);
            data.iter_mut().for_each(|x| *x /= exposure);
        }
        Ok(decoded)
    }

    /// A picture of linear RGB, rows from the top; for tests and for what is made in memory.
    pub fn from_linear(width: u32, height: u32, rgb: Vec<f32>) -> Image {
        assert_eq!(rgb.len(), width as usize * height as usize * 3, "three numbers a texel");
        Image { width, height, channels: 3, texels: Texels::Linear(rgb) }
    }

    /// Another of the same size, texel by texel: a grey of one number, a colour of three. Numbers are light, or as they are.
    pub fn map<const N: usize>(&self, reading: Reading, change: impl Fn([f64; 4]) -> [f64; N]) -> Image {
        const { assert!(N >= 1 && N <= 4, "one to four channels") };
        let places = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let texels = places.flat_map(|(x, y)| change(self.texel(x, y, reading)).map(|c| c as f32));
        let (width, height) = (self.width, self.height);
        Image { width, height, channels: N, texels: Texels::Linear(texels.collect()) }
    }

    /// A picture of linear RGB from a function of the places of its texels: 0 … 1 from the left and from the top.
    pub fn from_texels(width: u32, height: u32, colour: impl Fn(f64, f64) -> [f64; 3]) -> Image {
        let place = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let texels = places.flat_map(|(x, y)| colour(place(x, width), place(y, height)).map(|c| c as f32));
        Image::from_linear(width, height, texels.collect())
    }

    /// The texel at a place: 0 … 1 from the left and from the top.
    pub fn nearest(&self, x: f64, y: f64, reading: Reading) -> [f64; 4] {
        let index = |x: f64, n: u32| ((x * f64::from(n)) as u32).min(n - 1);
        self.texel(index(x, self.width), index(y, self.height), reading)
    }

    fn from_decoded(decoded: DynamicImage, format: ImageFormat) -> Image {
        let (width, height) = (decoded.width(), decoded.height());
        let channels = decoded.color().channel_count() as usize;
        let words = |data: Vec<u16>| data.iter().map(|&x| f32::from(x) / 65535.0).collect();
        let linear = matches!(format, ImageFormat::Hdr | ImageFormat::OpenExr);
        let texels = match decoded {
            DynamicImage::ImageLuma8(i) => Texels::Byte(i.into_raw()),
            DynamicImage::ImageLumaA8(i) => Texels::Byte(i.into_raw()),
            DynamicImage::ImageRgb8(i) => Texels::Byte(i.into_raw()),
            DynamicImage::ImageRgba8(i) => Texels::Byte(i.into_raw()),
            DynamicImage::ImageLuma16(i) => Texels::Encoded(words(i.into_raw())),
            DynamicImage::ImageLumaA16(i) => Texels::Encoded(words(i.into_raw())),
            DynamicImage::ImageRgb16(i) => Texels::Encoded(words(i.into_raw())),
            DynamicImage::ImageRgba16(i) => Texels::Encoded(words(i.into_raw())),
            DynamicImage::ImageRgb32F(i) if linear => Texels::Linear(finite(i.into_raw())),
            DynamicImage::ImageRgba32F(i) if linear => Texels::Linear(finite(i.into_raw())),
            other => {
                return Image {
                    width,
                    height,
                    channels: 4,
                    texels: Texels::Encoded(finite(other.into_rgba32f().into_raw())),
                };
            }
        };
        Image { width, height, channels, texels }
    }

    /// Texels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Whether some texel is not opaque.
    pub fn is_transparent(&self) -> bool {
        let step = self.channels;
        let has_alpha = step == 2 || step == 4;
        has_alpha
            && match &self.texels {
                Texels::Byte(data) => data.chunks_exact(step).any(|t| t[step - 1] < 255),
                Texels::Encoded(data) | Texels::Linear(data) => {
                    data.chunks_exact(step).any(|t| t[step - 1] < 1.0)
                }
            }
    }

    /// Whether the picture stores an alpha channel.
    pub fn has_alpha(&self) -> bool {
        self.channels == 2 || self.channels == 4
    }

    /// Whether its mean looks like that of a tangent-space normal map: half red, half green, and blue near full.
    pub fn looks_like_normals(&self) -> bool {
        if self.channels < 3 {
            return false;
        }
        let (n_x, n_y) = (self.width.min(64), self.height.min(64));
        let mut sum = [0.0; 3];
        for y in 0..n_y {
            for x in 0..n_x {
                let t = self.texel(x * self.width / n_x, y * self.height / n_y, Reading::Data);
                (0..3).for_each(|c| sum[c] += t[c] / f64::from(n_x * n_y));
            }
        }
        (sum[0] - 0.5).abs() < 0.15 && (sum[1] - 0.5).abs() < 0.15 && sum[2] > 0.7
    }

    /// RGB and alpha of the texel in column x from the left, row y from the top; both inside the picture.
    pub fn texel(&self, x: u32, y: u32, reading: Reading) -> [f64; 4] {
        let at = (y as usize * self.width as usize + x as usize) * self.channels;
        let decode = reading == Reading::Colour;
        match &self.texels {
            Texels::Byte(data) => {
                let plain = |c: usize| f64::from(data[at + c]) / 255.0;
                let colour = |c: usize| if decode { SRGB[data[at + c] as usize] } else { plain(c) };
                spread(self.channels, colour, plain)
            }
            Texels::Encoded(data) => {
                let plain = |c: usize| f64::from(data[at + c]);
                spread(self.channels, |c| if decode { srgb_decode(plain(c)) } else { plain(c) }, plain)
            }
            Texels::Linear(data) => {
                let plain = |c: usize| f64::from(data[at + c]);
                spread(self.channels, plain, plain)
            }
        }
    }
}

/// What a Radiance file's numbers were multiplied by: the product of its EXPOSURE lines.
fn radiance_exposure(bytes: &[u8]) -> f32 {
    let header = bytes.split(|b| *b == b'\n').take_while(|line| !line.is_empty());
    let value = |line: &[u8]| -> Option<f32> {
        std::str::from_utf8(line.strip_prefix(b"EXPOSURE=")?).ok()?.trim().parse().ok()
    };
    let product: f32 = header.filter_map(value).product();
    if product.is_normal() && product > 0.0 { product } else { 1.0 }
}

/// RGB and alpha from 1 to 4 channels.
fn spread(channels: usize, colour: impl Fn(usize) -> f64, alpha: impl Fn(usize) -> f64) -> [f64; 4] {
    match channels {
        1 | 2 => {
            let grey = colour(0);
            [grey, grey, grey, if channels == 2 { alpha(1) } else { 1.0 }]
        }
        _ => [colour(0), colour(1), colour(2), if channels == 4 { alpha(3) } else { 1.0 }],
    }
}

/// What each byte of an sRGB file means.
static SRGB: LazyLock<[f64; 256]> = LazyLock::new(|| std::array::from_fn(|i| srgb_decode(i as f64 / 255.0)));

fn limits() -> Limits {
    let mut limits = Limits::default();
    // Four channels of f32 for every texel, and as much again for the decoder's own needs.
    limits.max_alloc = Some(MAX_TEXELS * 16 * 2);
    limits
}

fn broken(error: image::ImageError) -> ImageError {
    match error {
        image::ImageError::Unsupported(e) => ImageError::Broken(format!("{e}")),
        other => ImageError::Broken(format!("it is damaged: {other}")),
    }
}

/// NaN and infinities of a file become 0: a texture must not poison a picture.
fn finite(mut data: Vec<f32>) -> Vec<f32> {
    data.iter_mut().filter(|x| !x.is_finite()).for_each(|x| *x = 0.0);
    data
}

/// Where a pattern keeps its picture once it is read. Empty at first; says nothing about what a scene is, so all are equal.
#[derive(Clone, Debug, Default)]
pub struct Picture(OnceLock<Arc<Image>>);

impl Picture {
    /// The picture, once it is read.
    pub fn get(&self) -> Option<&Image> {
        self.0.get().map(Arc::as_ref)
    }

    /// The same, to be kept elsewhere.
    pub fn shared(&self) -> Option<Arc<Image>> {
        self.0.get().cloned()
    }

    /// Keeps a picture; the first one stays.
    pub fn set(&self, image: Arc<Image>) {
        let _ = self.0.set(image);
    }
}

impl PartialEq for Picture {
    fn eq(&self, _: &Picture) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encode(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn bytes_are_srgb_as_colours_and_plain_as_numbers() {
        let picture = DynamicImage::ImageRgb8(image::RgbImage::from_pixel(2, 1, image::Rgb([0, 128, 255])));
        let png = Image::decode(&encode(&picture, ImageFormat::Png), Path::new("a.png")).unwrap();
        assert_eq!(png.texel(1, 0, Reading::Data), [0.0, 128.0 / 255.0, 1.0, 1.0]);
        assert_eq!(png.texel(1, 0, Reading::Colour)[1], srgb_decode(128.0 / 255.0));
    }

    #[test]
    fn sixteen_bits_keep_their_precision() {
        let picture =
            DynamicImage::ImageLuma16(image::ImageBuffer::from_pixel(1, 1, image::Luma([257 * 3 + 1])));
        let png = Image::decode(&encode(&picture, ImageFormat::Png), Path::new("a.png")).unwrap();
        assert!((png.texel(0, 0, Reading::Data)[2] - 772.0 / 65535.0).abs() < 1e-8);
    }

    #[test]
    fn alpha_is_kept_and_never_decoded() {
        let picture =
            DynamicImage::ImageRgba8(image::RgbaImage::from_pixel(1, 1, image::Rgba([9, 9, 9, 51])));
        let tga = Image::decode(&encode(&picture, ImageFormat::Tga), Path::new("a.tga")).unwrap();
        assert_eq!(tga.texel(0, 0, Reading::Colour)[3], 0.2);
        assert!(tga.is_transparent());
    }

    #[test]
    fn light_of_hdr_files_is_linear_already() {
        let picture =
            DynamicImage::ImageRgb32F(image::ImageBuffer::from_pixel(1, 1, image::Rgb([4.0, 0.5, 0.0])));
        let hdr = Image::decode(&encode(&picture, ImageFormat::Hdr), Path::new("a.hdr")).unwrap();
        assert_eq!(hdr.texel(0, 0, Reading::Colour), [4.0, 0.5, 0.0, 1.0]);
    }

    #[test]
    fn exposure_of_radiance_files_is_undone() {
        let picture =
            DynamicImage::ImageRgb32F(image::ImageBuffer::from_pixel(1, 1, image::Rgb([4.0, 0.5, 0.0])));
        let mut bytes = encode(&picture, ImageFormat::Hdr);
        let first_line = bytes.iter().position(|b| *b == b'\n').unwrap() + 1;
        bytes.splice(first_line..first_line, b"EXPOSURE=2\nEXPOSURE= 4.0\n".iter().copied());
        let hdr = Image::decode(&bytes, Path::new("a.hdr")).unwrap();
        assert_eq!(hdr.texel(0, 0, Reading::Colour), [0.5, 0.0625, 0.0, 1.0]);
    }

    #[test]
    fn exr_files_keep_light_above_one() {
        let picture = DynamicImage::ImageRgba32F(image::ImageBuffer::from_pixel(
            1,
            1,
            image::Rgba([40.0, 0.5, -1.0, 0.25]),
        ));
        let exr = Image::decode(&encode(&picture, ImageFormat::OpenExr), Path::new("a.exr")).unwrap();
        assert_eq!(exr.texel(0, 0, Reading::Colour), [40.0, 0.5, -1.0, 0.25]);
    }

    #[test]
    fn what_is_no_picture_is_refused_in_words() {
        assert_eq!(Image::decode(b"hello", Path::new("a.txt")), Err(ImageError::UnknownFormat));
        let broken = Image::decode(b"\x89PNG\r\n\x1a\nnonsense", Path::new("a.png")).unwrap_err();
        assert!(broken.to_string().contains("damaged"), "{broken}");
    }
}
