//! Closed outlines in a plane, and where a straight line in that plane crosses them. Knows nothing of what is made of them.

use super::cubic::Cubic;
use super::mesh::{even, steps_along};
use super::zeros::{self, Bounded, quadratic_range};
use crate::geometry::curve::evaluate::bernstein;
use glam::DVec2;

/// A closed chain of cubics.
#[derive(Clone, Debug)]
pub struct Outline {
    pieces: Vec<Cubic<DVec2>>,
    /// Share of the whole length at the start of each piece, and 1.
    shares: Vec<f64>,
    /// 1 where it turns left about its inside (of the greater area), else −1.
    turn: f64,
    size: f64,
}

/// Why an outline bounds nothing.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OutlineError {
    /// Its end is not its start.
    #[error("its outline is open: it starts at <{}, {}> and ends at <{}, {}>", .start.x, .start.y, .end.x, .end.y)]
    Open {
        /// First point.
        start: DVec2,
        /// Last point.
        end: DVec2,
    },
    /// All in one line.
    #[error("its outline encloses nothing")]
    Flat,
    /// A coordinate that is NaN, infinite, or too large to be squared.
    #[error("its outline is not finite, or beyond 1e150")]
    NotFinite,
}

/// The ends of an outline may be apart by this part of its size: what making the spline may have cost.
const CLOSED: f64 = 64.0 * f64::EPSILON;
/// Coordinates beyond this could not be squared.
const LARGEST: f64 = 1e150;

/// Where a line crosses an outline.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// Distance along the line, from the foot of its origin.
    pub s: f64,
    /// Which piece.
    pub piece: u32,
    /// Where in the piece.
    pub x: f64,
    /// False where it only touches.
    pub is_crossing: bool,
}

impl Outline {
    /// From its pieces in order; the end is drawn to the start where only rounding keeps them apart.
    pub fn new(mut pieces: Vec<Cubic<DVec2>>) -> Result<Outline, OutlineError> {
        let numbers = pieces.iter().flat_map(|c| c.points).flat_map(|p| p.to_array());
        let size = numbers.fold(0.0, |m: f64, x| if x.abs() <= m { m } else { x.abs() });
        if !size.le(&LARGEST) {
            return Err(OutlineError::NotFinite);
        }
        let start = pieces[0].points[0];
        let last = pieces.last_mut().expect("an outline has pieces");
        let end = last.points[3];
        if start.distance(end) > CLOSED * size {
            return Err(OutlineError::Open { start, end });
        }
        last.points[3] = start;
        // Straight to the last bit through the shared points.
        for k in 1..pieces.len() {
            pieces[k].points[0] = pieces[k - 1].points[3];
        }
        let area: f64 = pieces.iter().map(Cubic::<DVec2>::area).sum();
        let lengths: Vec<f64> = pieces.iter().map(|c| c.length_to(1.0)).collect();
        let total: f64 = lengths.iter().sum();
        if pieces
            .iter()
            .all(|c| c.points.iter().all(|p| (*p - start).perp_dot(farthest(&pieces, start)) == 0.0))
        {
            return Err(OutlineError::Flat);
        }
        let mut reached = 0.0;
        let mut shares = vec![0.0];
        shares.extend(lengths.iter().map(|length| {
            reached += length;
            reached / total
        }));
        Ok(Outline { pieces, shares, turn: if area < 0.0 { -1.0 } else { 1.0 }, size })
    }

    /// Its pieces.
    pub fn pieces(&self) -> &[Cubic<DVec2>] {
        &self.pieces
    }

    /// Largest coordinate.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Unit normal at a place, outward.
    pub fn normal(&self, piece: u32, x: f64) -> DVec2 {
        let d = self.pieces[piece as usize].direction(x).unwrap_or(DVec2::Y);
        DVec2::new(d.y, -d.x) * self.turn
    }

    /// The point at a place, and its share of the length from the start.
    pub fn at(&self, piece: u32, x: f64) -> (DVec2, f64) {
        let k = piece as usize;
        let curve = &self.pieces[k];
        let whole = curve.length_to(1.0);
        let part = if whole > 0.0 { (curve.length_to(x) / whole).min(1.0) } else { 0.0 };
        (curve.at(x), self.shares[k] + (self.shares[k + 1] - self.shares[k]) * part)
    }

    /// Places along it, in order, between which straight lines keep a tolerance; corners have two, and the last is where the first is.
    pub(super) fn places(&self, tolerance: f64) -> Vec<(u32, f64)> {
        let of = |(k, piece): (usize, &Cubic<DVec2>)| {
            let steps = steps_along(piece.largest_acceleration(), tolerance);
            even(steps).map(move |x| (k as u32, x)).collect::<Vec<_>>()
        };
        self.pieces.iter().enumerate().flat_map(of).collect()
    }

    /// Calls `found` with each place where the line through a point in a unit direction crosses one piece.
    pub fn cross(&self, piece: u32, origin: DVec2, direction: DVec2, mut found: impl FnMut(Crossing)) {
        let points = &self.pieces[piece as usize].points;
        let from = points.map(|p| p - origin);
        let offset = Offset::new(from.map(|p| direction.perp_dot(p)), origin.abs().max_element() + self.size);
        if offset.is_one_sided() {
            return;
        }
        let along = from.map(|p| direction.dot(p));
        zeros::zeros(&offset, 0.0, 1.0, |x, is_crossing| {
            found(Crossing { s: bernstein(&along, x), piece, x, is_crossing });
        });
    }

    /// Whether a point is inside, by the number of crossings on one side of it: what the outline goes round twice is outside.
    pub fn contains(&self, p: DVec2) -> bool {
        let mut is_inside = false;
        for piece in 0..self.pieces.len() as u32 {
            self.cross(piece, p, DVec2::X, |c| is_inside ^= c.is_crossing && c.s > 0.0);
        }
        is_inside
    }
}

/// From a point to the farthest control point.
fn farthest(pieces: &[Cubic<DVec2>], from: DVec2) -> DVec2 {
    let all = pieces.iter().flat_map(|c| c.points).map(|p| p - from);
    all.reduce(|a, b| if b.length_squared() > a.length_squared() { b } else { a }).unwrap_or(DVec2::ZERO)
}

/// Signed distance of a piece from a line.
struct Offset {
    values: [f64; 4],
    slopes: [f64; 3],
    noise: f64,
}

impl Offset {
    fn new(values: [f64; 4], reach: f64) -> Offset {
        let slopes = [1, 2, 3].map(|i| 3.0 * (values[i] - values[i - 1]));
        Offset { values, slopes, noise: 16.0 * f64::EPSILON * reach }
    }

    /// All on one side: 0 counts as positive, as it does for ends.
    fn is_one_sided(&self) -> bool {
        self.values.iter().all(|v| *v > self.noise) || self.values.iter().all(|v| *v < -self.noise)
    }
}

impl Bounded for Offset {
    fn value(&self, x: f64) -> f64 {
        bernstein(&self.values, x)
    }

    fn slope(&self, x: f64) -> f64 {
        let ([a, b, c], r) = (self.slopes, 1.0 - x);
        a * (r * r) + b * (2.0 * r * x) + c * (x * x)
    }

    fn range(&self, from: f64, to: f64) -> (f64, f64) {
        // Both ends, and how far the slopes may lead away from them.
        let (low, high) = self.slopes(from, to);
        let (a, b) = (self.value(from), self.value(to));
        let width = to - from;
        let least = (a + low.min(0.0) * width).max(b - high.max(0.0) * width);
        let most = (a + high.max(0.0) * width).min(b - low.min(0.0) * width);
        (least.min(a).min(b) - self.noise, most.max(a).max(b) + self.noise)
    }

    fn slopes(&self, from: f64, to: f64) -> (f64, f64) {
        quadratic_range(&self.slopes, from, to)
    }

    fn noise(&self) -> f64 {
        self.noise
    }
}
