//! Tight boxes around curves.

use super::{Curve, Piece};
use crate::math::{Point, bernstein};

impl<P: Point> Curve<P> {
    /// Lower and upper corner of the smallest box around the curve: by the zeros of each coordinate's derivative, inner extremes
    /// rounded outward by one unit in the last place.
    pub fn bounds(&self) -> (P, P) {
        let per_axis = |axis: usize| {
            let extremes = self.pieces.iter().map(|piece| extremes(piece, axis));
            extremes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0.0, 0.0))
        };
        (P::from_coordinates(|axis| per_axis(axis).0), P::from_coordinates(|axis| per_axis(axis).1))
    }
}

/// Least and greatest value of one coordinate of a piece.
fn extremes<P: Point>(piece: &Piece<P>, axis: usize) -> (f64, f64) {
    let points = piece.points().map(|p| p.coordinate(axis));
    let (mut low, mut high) = (points[0].min(points[3]), points[0].max(points[3]));
    // Between the ends' values by the convex hull: no inner extreme counts.
    if points.iter().all(|p| *p >= low && *p <= high) {
        return (low, high);
    }
    let slopes = piece.hodograph().map(|d| d.coordinate(axis));
    for x in bernstein::roots(&slopes) {
        let value = piece.at(piece.parameter(x)).coordinate(axis);
        if value < low {
            low = value.next_down();
        } else if value > high {
            high = value.next_up();
        }
    }
    (low, high)
}
