//! What the filter knows of the pixels, a plane of numbers for each, with a margin that repeats the rim: loops over rows need no
//! conditions, and no guide is asked twice.

use super::REACH;
use crate::render::features::Features;
use crate::render::film::Film;
use crate::scene::Rgb;
use glam::DVec3;

/// Albedo that radiance is divided by at least: below it, what is seen is not by albedo.
const LEAST_ALBEDO: f64 = 0.05;

/// Points are of one plane when they lie off it by less than this share of their distance.
const OFF_PLANE: f64 = 0.02;

/// Half the side of the square in which samples are taken to be equally even.
const EVEN: usize = 7;

/// Of even samples' variance the share that they have at least of that of independent ones: two parts that agree by chance.
const LEAST_SHARE: f64 = 0.02;

/// How many planes there are, and what is kept to put them together again.
pub const PLANES: u64 = 25;

/// Numbers of all pixels, row by row, [`REACH`] more at each side.
pub type Plane = Vec<f64>;

/// A picture to be filtered.
pub struct Planes {
    /// Columns of the picture.
    pub width: usize,
    /// Columns of a plane.
    pub stride: usize,
    /// Radiance over albedo, by channels, of the two parts of the samples.
    pub colour: [[Plane; 3]; 2],
    /// Of these means.
    pub variance: [[Plane; 3]; 2],
    /// Guides.
    pub normal: [Plane; 3],
    /// Guides.
    pub albedo: [Plane; 3],
    /// Guides.
    pub position: [Plane; 3],
    /// Variances of the means of the albedo and of the normal.
    pub spread: [Plane; 2],
    /// Over the square of how far off the plane is far.
    pub near: Plane,
    /// 1 where a pixel tells others something, 0 in the margin and where it has no value.
    pub known: Plane,
    /// What a part counts in the pixel's mean and albedo, to be multiplied by in the end.
    back: Vec<(f64, Rgb)>,
}

/// A pixel's parts.
#[derive(Clone, Copy)]
struct Parts {
    colour: [Rgb; 2],
    /// Of the mean of all samples.
    variance: Rgb,
    share: f64,
}

impl Planes {
    /// Of a film that keeps guides.
    pub fn new(film: &Film) -> Planes {
        let [width, height] = [film.crop.width as usize, film.crop.height as usize];
        let divisor = |f: &Features| f.albedo.max(Rgb::splat(LEAST_ALBEDO));
        let pixels = film.pixels.iter().zip(&film.features);
        let mut parts: Vec<Parts> = pixels.map(|(mean, f)| Parts::new(*mean, f, divisor(f))).collect();
        scale(&mut parts, width);
        let frame = Frame { width, height };
        let of_part = |half: usize, i: usize| frame.plane(|at| parts[at].colour[half][i]);
        let noise = |half: usize, i: usize| frame.plane(|at| parts[at].variance_of(half)[i]);
        let guide = |value: fn(&Features) -> DVec3, i: usize| frame.plane(|at| value(&film.features[at])[i]);
        let each = |value: fn(&Features) -> DVec3| [0, 1, 2].map(|i| guide(value, i));
        Planes {
            width,
            stride: width + 2 * REACH,
            colour: [0, 1].map(|half| [0, 1, 2].map(|i| of_part(half, i))),
            variance: [0, 1].map(|half| [0, 1, 2].map(|i| noise(half, i))),
            normal: each(|f| f.normal),
            albedo: each(|f| f.albedo),
            position: each(|f| f.position),
            spread: [guide(|f| f.spread, 0), guide(|f| f.spread, 1)],
            near: frame.plane(|at| near(&film.features[at])),
            known: frame.inside(|at| if film.pixels[at] == Film::UNDEFINED { 0.0 } else { 1.0 }),
            back: film.features.iter().map(|f| (f.halves.share, divisor(f))).collect(),
        }
    }

    /// Where in the planes the pixel in a column and row is, of the margin too.
    pub fn at(&self, x: isize, y: isize) -> usize {
        let margin = REACH as isize;
        ((y + margin) * self.stride as isize + x + margin) as usize
    }

    /// The radiance of a pixel whose parts came to this.
    pub fn mean(&self, pixel: usize, parts: [Rgb; 2]) -> Rgb {
        let (share, albedo) = self.back[pixel];
        (parts[0] * share + parts[1] * (1.0 - share)) * albedo
    }
}

impl Parts {
    fn new(mean: Rgb, f: &Features, divisor: Rgb) -> Parts {
        let share = f.halves.share;
        let second = if share > 0.0 { (mean - f.halves.first * share) / (1.0 - share) } else { mean };
        let colour = [f.halves.first / divisor, second / divisor];
        Parts { colour, variance: f.variance / (divisor * divisor), share }
    }

    fn variance_of(&self, half: usize) -> Rgb {
        let share = if half == 0 { self.share } else { 1.0 - self.share };
        if share > 0.0 { self.variance / share } else { Rgb::ZERO }
    }

    /// The variance of the mean, of all channels, as the difference of the parts tells it.
    fn by_difference(&self) -> f64 {
        let off = self.colour[0] - self.colour[1];
        off.length_squared() * self.share * (1.0 - self.share)
    }
}

fn near(f: &Features) -> f64 {
    let far = OFF_PLANE * if f.depth.is_finite() { f.depth } else { 1.0 };
    let squared = far * far + f.spread.z;
    if squared > 0.0 { 1.0 / squared } else { 0.0 }
}

/// Scales the variances, which take samples for independent, by what the differences of parts tell around each pixel.
fn scale(parts: &mut [Parts], width: usize) {
    let told = around(&parts.iter().map(Parts::by_difference).collect::<Vec<_>>(), width);
    let taken = around(&parts.iter().map(|p| p.variance.element_sum()).collect::<Vec<_>>(), width);
    for (part, (told, taken)) in parts.iter_mut().zip(told.into_iter().zip(taken)) {
        let share = if taken > 0.0 { (told / taken).clamp(LEAST_SHARE, 1.0) } else { 1.0 };
        part.variance *= share;
    }
}

/// Sums over the square around each pixel, as far as it is in the picture.
fn around(values: &[f64], width: usize) -> Vec<f64> {
    let height = values.len() / width.max(1);
    let span = |i: usize, n: usize| i.saturating_sub(EVEN)..(i + EVEN + 1).min(n);
    let rows: Vec<f64> =
        (0..values.len()).map(|at| values[at - at % width..][span(at % width, width)].iter().sum()).collect();
    (0..values.len()).map(|at| span(at / width, height).map(|y| rows[y * width + at % width]).sum()).collect()
}

/// The size of a picture, around which planes have a margin.
struct Frame {
    width: usize,
    height: usize,
}

impl Frame {
    /// A plane of what the pixels have, the rim's repeated.
    fn plane(&self, value: impl Fn(usize) -> f64) -> Plane {
        let clamped = |i: usize, n: usize| i.saturating_sub(REACH).min(n - 1);
        let row = |y: usize| clamped(y, self.height) * self.width;
        let all = (0..self.height + 2 * REACH).flat_map(|y| (0..self.width + 2 * REACH).map(move |x| (x, y)));
        all.map(|(x, y)| value(row(y) + clamped(x, self.width))).collect()
    }

    /// The same with 0 in the margin.
    fn inside(&self, value: impl Fn(usize) -> f64) -> Plane {
        let pixel = |i: usize, n: usize| i.checked_sub(REACH).filter(|i| *i < n);
        let all = (0..self.height + 2 * REACH).flat_map(|y| (0..self.width + 2 * REACH).map(move |x| (x, y)));
        let at = |(x, y)| Some(pixel(y, self.height)? * self.width + pixel(x, self.width)?);
        all.map(|place| at(place).map_or(0.0, &value)).collect()
    }
}
