//! Some rows of the picture, filtered: for each shift within the window the differences between pixels and their shifted ones, row by row, so
//! that neighbourhoods share them; then the weights, then the sums.

use super::planes::{Plane, Planes};
use super::{PATCH, WINDOW};
use crate::scene::Rgb;
use std::sync::atomic::{AtomicBool, Ordering};

/// Rows that are filtered at once: their differences stay near the processor.
const ROWS: usize = 16;

/// Squared differences are measured by this times the variances: below 1 fewer unlike pixels get in, above it fewer alike are left out.
const NOISE: f64 = 0.6;

/// What one pixel of a neighbourhood counts at most. Of 25, the five along an edge then do not keep all others from being alike.
const CAP: f64 = 5.0;

/// What the nine pixels in the middle count beside the whole neighbourhood; uncapped.
const MIDDLE: f64 = 0.5;

/// Squared difference of normals that is far: 18°.
const FAR_NORMAL: f64 = 0.1;

/// Squared difference of albedos that is far.
const FAR_ALBEDO: f64 = 0.09;

/// Added to variances, so that equal pixels without noise are alike: far below what a picture shows of radiance over albedo.
const NOTHING: f64 = 1e-10;

/// Side of a neighbourhood.
const SIDE: usize = 2 * PATCH + 1;

/// Rows from the first up to the end.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    first: usize,
    end: usize,
}

/// What is summed for each pixel of a row: three channels and the weight, of each part.
type Sums = [[Vec<f64>; 4]; 2];

/// Differences of a band's pixels to those of a shift, of one part.
struct Differences {
    /// Of single pixels, with [`PATCH`] more at each side.
    single: Vec<f64>,
    /// Capped and summed along rows, a row for each of `single`.
    summed: Vec<f64>,
}

impl Band {
    /// The bands of a picture with so many rows.
    pub fn all(height: usize) -> impl Iterator<Item = Band> {
        (0..height).step_by(ROWS).map(move |first| Band { first, end: (first + ROWS).min(height) })
    }

    /// Its pixels, row by row; none once `cancel` is true.
    pub fn filtered(&self, planes: &Planes, cancel: &AtomicBool) -> Option<Vec<Rgb>> {
        let (rows, width) = (self.end - self.first, planes.width);
        let mut sums: Vec<Sums> =
            (0..rows).map(|_| [0, 1].map(|_| [0; 4].map(|_| vec![0.0; width]))).collect();
        let mut parts = [0, 1].map(|_| Differences::new(rows + 2 * PATCH, width));
        let mut guides = vec![0.0; width];
        let window = WINDOW as isize;
        for dy in -window..=window {
            if cancel.load(Ordering::Relaxed) {
                return None;
            }
            for dx in -window..=window {
                let taper = taper(dx, dy);
                if taper <= 0.0 {
                    continue;
                }
                let shift = dy * planes.stride as isize + dx;
                parts
                    .iter_mut()
                    .enumerate()
                    .for_each(|(half, part)| part.find(planes, half, self.first, shift));
                for (row, sums) in sums.iter_mut().enumerate() {
                    let here = planes.at(0, (self.first + row) as isize);
                    let there = here.wrapping_add_signed(shift);
                    guide(planes, here, there, &mut guides);
                    for (half, sums) in sums.iter_mut().enumerate() {
                        let unlike = parts[1 - half].row(row, width);
                        let weights = |x| taper * weight(larger(unlike(x), guides[x]));
                        add(planes, half, there, weights, sums);
                    }
                }
            }
        }
        let pixel = |row: usize, x: usize| {
            let part = |half: usize| {
                let [r, g, b, weight] = &sums[row][half];
                Rgb::new(r[x], g[x], b[x]) / weight[x]
            };
            planes.mean((self.first + row) * width + x, [part(0), part(1)])
        };
        Some(
            (0..rows)
                .flat_map(|row| (0..width).map(move |x| (row, x)))
                .map(|(row, x)| pixel(row, x))
                .collect(),
        )
    }
}

impl Differences {
    fn new(rows: usize, width: usize) -> Differences {
        Differences { single: vec![0.0; rows * (width + 2 * PATCH)], summed: vec![0.0; rows * width] }
    }

    /// Finds them for a shift.
    fn find(&mut self, planes: &Planes, half: usize, first: usize, shift: isize) {
        let (margin, width) = (PATCH as isize, planes.width);
        let rows = self.single.chunks_exact_mut(width + 2 * PATCH).zip(self.summed.chunks_exact_mut(width));
        for (row, (single, summed)) in rows.enumerate() {
            let here = planes.at(-margin, first as isize + row as isize - margin);
            compare(planes, half, here, here.wrapping_add_signed(shift), single);
            for (x, sum) in summed.iter_mut().enumerate() {
                *sum = single[x..x + SIDE].iter().map(|d| smaller(*d, CAP)).sum();
            }
        }
    }

    /// How unlike the neighbourhoods of the pixels of a row are.
    fn row(&self, row: usize, width: usize) -> impl Fn(usize) -> f64 {
        let wide = width + 2 * PATCH;
        let summed: [&[f64]; SIDE] = std::array::from_fn(|i| &self.summed[(row + i) * width..][..width]);
        let middle: [&[f64]; 3] =
            std::array::from_fn(|i| &self.single[(row + i + PATCH - 1) * wide + PATCH - 1..][..width + 2]);
        move |x| {
            let all: f64 = summed.iter().map(|row| row[x]).sum();
            let nine: f64 = middle.iter().map(|row| row[x] + row[x + 1] + row[x + 2]).sum();
            larger(all / (SIDE * SIDE) as f64, MIDDLE / 9.0 * nine)
        }
    }
}

/// `n` pixels of a plane from one place on, and from another.
fn pair(plane: &Plane, here: usize, there: usize, n: usize) -> (&[f64], &[f64]) {
    (&plane[here..here + n], &plane[there..there + n])
}

/// Squared differences of single pixels by their variances, less what these explain: 0 on average where only noise differs. What the
/// shifted pixel's own noise explains is no more than this one's: a pixel without noise is not like one that may be anything.
fn compare(planes: &Planes, half: usize, here: usize, there: usize, found: &mut [f64]) {
    let n = found.len();
    let [c0, c1, c2] = planes.colour[half].each_ref().map(|plane| pair(plane, here, there, n));
    let [v0, v1, v2] = planes.variance[half].each_ref().map(|plane| pair(plane, here, there, n));
    for x in 0..n {
        let one = |c: (&[f64], &[f64]), v: (&[f64], &[f64])| {
            let off = c.0[x] - c.1[x];
            (off * off - (v.0[x] + smaller(v.0[x], v.1[x])), v.0[x] + v.1[x])
        };
        let (a, b, c) = (one(c0, v0), one(c1, v1), one(c2, v2));
        found[x] = (a.0 + b.0 + c.0) / (NOTHING + NOISE * NOISE * (a.1 + b.1 + c.1));
    }
}

/// How unlike the guides of the pixels of a row are to those of the shifted ones; the more, the less alike.
fn guide(planes: &Planes, here: usize, there: usize, found: &mut [f64]) {
    let n = found.len();
    let [n0, n1, n2] = planes.normal.each_ref().map(|plane| pair(plane, here, there, n));
    let [a0, a1, a2] = planes.albedo.each_ref().map(|plane| pair(plane, here, there, n));
    let [p0, p1, p2] = planes.position.each_ref().map(|plane| pair(plane, here, there, n));
    let [s0, s1] = planes.spread.each_ref().map(|plane| pair(plane, here, there, n));
    let near = pair(&planes.near, here, there, n);
    for x in 0..n {
        let off = |v: (&[f64], &[f64])| v.1[x] - v.0[x];
        let squares = |a: f64, b: f64, c: f64| a * a + b * b + c * c;
        let varies = |s: (&[f64], &[f64])| 2.0 * smaller(s.0[x], s.1[x]);
        let normal = (squares(off(n0), off(n1), off(n2)) - varies(s1)) * (1.0 / FAR_NORMAL);
        let albedo = (squares(off(a0), off(a1), off(a2)) - varies(s0)) * (1.0 / FAR_ALBEDO);
        let (to0, to1, to2) = (off(p0), off(p1), off(p2));
        let from_here = to0 * n0.0[x] + to1 * n1.0[x] + to2 * n2.0[x];
        let from_there = to0 * n0.1[x] + to1 * n1.1[x] + to2 * n2.1[x];
        let plane = larger(from_here * from_here, from_there * from_there) * smaller(near.0[x], near.1[x]);
        found[x] = larger(larger(normal, albedo), plane);
    }
}

/// Adds the shifted pixels of a row by their weights.
fn add(planes: &Planes, half: usize, there: usize, weights: impl Fn(usize) -> f64, sums: &mut [Vec<f64>; 4]) {
    let n = planes.width;
    let known = &planes.known[there..there + n];
    let [r, g, b] = planes.colour[half].each_ref().map(|plane| &plane[there..there + n]);
    let [red, green, blue, all] = sums.each_mut().map(|sums| &mut sums[..n]);
    for x in 0..n {
        let weight = known[x] * weights(x);
        red[x] += weight * r[x];
        green[x] += weight * g[x];
        blue[x] += weight * b[x];
        all[x] += weight;
    }
}

/// What a shift counts: less toward the rim of a disc, so that a pixel far too bright, which is spread and not lost, leaves no square.
fn taper(dx: isize, dy: isize) -> f64 {
    1.0 - (dx * dx + dy * dy) as f64 / ((WINDOW + 1) * (WINDOW + 1)) as f64
}

/// About e^(−x), and nothing from 4 on.
fn weight(unlike: f64) -> f64 {
    let left = larger(1.0 - 0.25 * larger(unlike, 0.0), 0.0);
    (left * left) * (left * left)
}

/// The first where it is smaller. One instruction for each number, where `f64::min` asks for NaN as well.
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The first where it is larger.
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
