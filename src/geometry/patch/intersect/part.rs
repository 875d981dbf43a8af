//! Pieces cut into parts that are nearly flat, so that most are settled at the first look.

use super::super::Bicubic;
use crate::math::Aabb;
use crate::math::error::UNIT_ROUNDOFF;
use glam::DVec3;

/// A rectangle of a piece, as a patch of its own.
#[derive(Clone, Debug)]
pub struct Part {
    /// The piece's number.
    pub piece: u32,
    /// From where to where it lies in the piece.
    pub u: (f64, f64),
    /// The same.
    pub v: (f64, f64),
    /// Its control points.
    pub points: [[DVec3; 4]; 4],
    /// Largest magnitude of a coordinate.
    pub size: f64,
}

/// A piece is cut until its control points are this close to evenly spaced, as a part of their spacing: the measure of
/// how often the first look settles a part. Measured on the teapot: 0.1 to 0.3 are alike within 10 %.
const FLATNESS: f64 = 0.2;
/// Most halvings of a piece in each of u and v.
const MOST_CUTS: u32 = 4;
impl Part {
    fn new(piece: u32, surface: &Bicubic, u: (f64, f64), v: (f64, f64)) -> Part {
        let size = surface.points.iter().flatten().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
        Part { piece, u, v, points: surface.points, size }
    }

    fn surface(&self) -> Bicubic {
        Bicubic { points: self.points }
    }

    /// The box around it.
    pub fn bounds(&self) -> Aabb {
        // Points of parts are rounded at each cut.
        let slack = DVec3::splat(f64::from(4 * MOST_CUTS) * UNIT_ROUNDOFF * self.size);
        let tight = self.surface().bounds();
        Aabb { min: tight.min - slack, max: tight.max + slack }
    }

    /// True where every pair of a u-difference and a v-difference is parallel to rounding.
    fn without_area(&self) -> bool {
        let (along_u, along_v) = differences(&self.points);
        let longest = |d: &[DVec3; 12]| d.iter().fold(0.0, |m: f64, d| m.max(d.length()));
        let bound = 8.0 * UNIT_ROUNDOFF * self.size * (longest(&along_u) + longest(&along_v));
        along_u.iter().all(|a| along_v.iter().all(|b| a.cross(*b).length() <= bound))
    }
}

/// Differences of neighbouring control points along u and along v.
fn differences(p: &[[DVec3; 4]; 4]) -> ([DVec3; 12], [DVec3; 12]) {
    let along_u = std::array::from_fn(|k| p[k / 4 + 1][k % 4] - p[k / 4][k % 4]);
    let along_v = std::array::from_fn(|k| p[k % 4][k / 4 + 1] - p[k % 4][k / 4]);
    (along_u, along_v)
}

/// Adds the parts of a piece that have area.
pub fn parts_of(index: u32, piece: &Bicubic, parts: &mut Vec<Part>) {
    cut(Part::new(index, piece, (0.0, 1.0), (0.0, 1.0)), (0, 0), parts);
}

/// Halves a part until it is nearly flat; drops it without area.
fn cut(part: Part, done: (u32, u32), parts: &mut Vec<Part>) {
    let (along_u, along_v) = differences(&part.points);
    let spacing = |d: &[DVec3; 12]| d.iter().map(|d| d.length()).sum::<f64>() / 12.0;
    // How far the differences stray from their mean.
    let stray = |d: &[DVec3; 12]| {
        let mean = d.iter().copied().sum::<DVec3>() / 12.0;
        d.iter().fold(0.0, |m: f64, d| m.max(d.distance(mean)))
    };
    let (su, sv) = (spacing(&along_u), spacing(&along_v));
    let (bend_u, bend_v) = (stray(&along_u), stray(&along_v));
    let uneven = bend_u > FLATNESS * su || bend_v > FLATNESS * sv;
    let (room_u, room_v) = (done.0 < MOST_CUTS, done.1 < MOST_CUTS);
    if !uneven || !(room_u || room_v) {
        if !part.without_area() {
            parts.push(part);
        }
        return;
    }
    // The bend along u shows in u-differences by rows and in v-differences by columns: halve the longer side of the bent net.
    let split_u =
        room_u && (!room_v || bending(&part.points) >= bending(&part.surface().transposed().points));
    let half = |r: (f64, f64)| 0.5 * (r.0 + r.1);
    if split_u {
        let m = half(part.u);
        let [low, high] = part.surface().split_u(0.5);
        cut(Part::new(part.piece, &low, (part.u.0, m), part.v), (done.0 + 1, done.1), parts);
        cut(Part::new(part.piece, &high, (m, part.u.1), part.v), (done.0 + 1, done.1), parts);
    } else {
        let m = half(part.v);
        let [low, high] = part.surface().split_v(0.5);
        cut(Part::new(part.piece, &low, part.u, (part.v.0, m)), (done.0, done.1 + 1), parts);
        cut(Part::new(part.piece, &high, part.u, (m, part.v.1)), (done.0, done.1 + 1), parts);
    }
}

/// What halving along the first index would mend: second differences that way, and the change of the other differences.
fn bending(p: &[[DVec3; 4]; 4]) -> f64 {
    let second =
        (0..2).flat_map(|i| (0..4).map(move |j| (p[i + 2][j] - p[i + 1][j]) - (p[i + 1][j] - p[i][j])));
    let twist =
        (0..3).flat_map(|i| (0..3).map(move |j| (p[i + 1][j + 1] - p[i + 1][j]) - (p[i][j + 1] - p[i][j])));
    let largest = |a: f64, b: DVec3| a.max(b.length());
    second.fold(0.0, largest) + 0.5 * twist.fold(0.0, largest)
}
