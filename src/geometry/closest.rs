//! The points of a path nearest to a given one. Knows nothing of surfaces.
//!
//! On a cubic the distance is least where (γ − p)·γ′ = 0, a quintic: its roots in Bernstein form are all found, so that no minimum
//! is missed. On other paths it is sampled and closed in on.

use super::curve::{Curve, Piece};
use super::path::Path;
use crate::math::{Point, bernstein, bracket};

/// A point of a path that is nearer than its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest<P> {
    /// Its parameter.
    pub t: f64,
    /// The point.
    pub point: P,
    /// Its distance, scene units.
    pub distance: f64,
}

/// A local minimum of the distance along one piece: inside, or at an end beyond which it would go on falling.
enum Minimum {
    Start,
    Inside(f64),
    End,
}

impl<P: Point> Curve<P> {
    /// The point of the curve nearest to p; of several, the one with the least parameter.
    pub fn closest(&self, p: P) -> Nearest<P> {
        let mut best = self.nearest_at(self.domain().0, p);
        for piece in self.pieces() {
            if hull_distance(piece, p) > best.distance {
                continue;
            }
            for minimum in minima(piece, p) {
                let t = match minimum {
                    Minimum::Start => piece.start(),
                    Minimum::Inside(x) => piece.parameter(x),
                    Minimum::End => piece.end(),
                };
                let found = self.nearest_at(t, p);
                if found.distance < best.distance {
                    best = found;
                }
            }
        }
        best
    }

    /// Every local minimum of the distance to p, by ascending parameter: inside pieces, at corners, and at open ends.
    pub fn all_closest(&self, p: P) -> Vec<Nearest<P>> {
        let per_piece: Vec<Vec<Minimum>> = self.pieces().iter().map(|piece| minima(piece, p)).collect();
        let n = per_piece.len();
        let starts = |i: usize| per_piece[i].iter().any(|m| matches!(m, Minimum::Start));
        let ends = |i: usize| per_piece[i].iter().any(|m| matches!(m, Minimum::End));
        let mut found = Vec::new();
        for (i, piece) in self.pieces().iter().enumerate() {
            let at_seam = starts(i) && (i > 0 && ends(i - 1) || i == 0 && (!self.closed() || ends(n - 1)));
            if at_seam {
                found.push(self.nearest_at(piece.start(), p));
            }
            let inside = per_piece[i].iter().filter_map(|m| match m {
                Minimum::Inside(x) => Some(self.nearest_at(piece.parameter(*x), p)),
                Minimum::Start | Minimum::End => None,
            });
            found.extend(inside);
        }
        if !self.closed() && ends(n - 1) {
            found.push(self.nearest_at(self.domain().1, p));
        }
        found
    }

    fn nearest_at(&self, t: f64, p: P) -> Nearest<P> {
        let point = self.position(t);
        Nearest { t, point, distance: point.distance(p) }
    }
}

/// No point of the piece is nearer than this: the distance to the box of its control points.
fn hull_distance<P: Point>(piece: &Piece<P>, p: P) -> f64 {
    let points = piece.points();
    let outside = P::from_coordinates(|axis| {
        let c = points.map(|q| q.coordinate(axis) - p.coordinate(axis));
        let (low, high) =
            c.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), c| (l.min(*c), h.max(*c)));
        low.max(-high).max(0.0)
    });
    outside.length() * (1.0 - 4.0 * f64::EPSILON)
}

/// C(3, i)·C(2, j) / C(5, i + j).
const PRODUCT: [[f64; 3]; 4] = [[1.0, 0.4, 0.1], [0.6, 0.6, 0.3], [0.3, 0.6, 0.6], [0.1, 0.4, 1.0]];

/// Where the distance from p to a piece is least among neighbours.
fn minima<P: Point>(piece: &Piece<P>, p: P) -> Vec<Minimum> {
    let from_p = piece.exact_points().map(|b| (b - crate::math::Dd::from(p)).value());
    let d = piece.hodograph();
    let mut quintic = [0.0; 6];
    for i in 0..4 {
        for j in 0..3 {
            quintic[i + j] += PRODUCT[i][j] * from_p[i].dot(d[j]);
        }
    }
    let roots = bernstein::roots(&quintic);
    let mut marks = vec![0.0];
    marks.extend(roots.iter().copied().filter(|x| *x > 0.0 && *x < 1.0));
    marks.push(1.0);
    // The sign between two roots says whether the distance falls or rises there.
    let rises: Vec<f64> = marks.windows(2).map(|w| bernstein::value(&quintic, 0.5 * (w[0] + w[1]))).collect();
    let mut found = Vec::new();
    if rises[0] >= 0.0 {
        found.push(Minimum::Start);
    }
    let turns = rises.windows(2).zip(&marks[1..]).filter(|(w, _)| w[0] < 0.0 && w[1] >= 0.0);
    found.extend(turns.map(|(_, x)| Minimum::Inside(*x)));
    if rises[rises.len() - 1] <= 0.0 {
        found.push(Minimum::End);
    }
    found
}

/// Samples between two cuts of a path that is not made of cubics.
const SAMPLES: usize = 64;

/// The point of any path nearest to p, found by sampling each stretch and closing in on the least by golden sections: a minimum
/// narrower than a 64th of a stretch may be missed.
pub fn closest_sampled<P: Point>(path: &dyn Path<P>, p: P) -> Nearest<P> {
    let distance = |t: f64| path.position(t).distance(p);
    let mut best = (distance(path.domain().0), path.domain().0);
    for w in path.cuts().windows(2) {
        let at = |i: usize| w[0] + (w[1] - w[0]) * (i as f64 / SAMPLES as f64);
        let sampled: Vec<f64> = (0..=SAMPLES).map(|i| distance(at(i))).collect();
        for i in 0..=SAMPLES {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(SAMPLES));
            if sampled[i] <= sampled[before] && sampled[i] <= sampled[after] {
                let t = bracket::minimum(at(before), at(after), distance);
                for t in [t, at(i)] {
                    if distance(t) < best.0 {
                        best = (distance(t), t);
                    }
                }
            }
        }
    }
    Nearest { t: best.1, point: path.position(best.1), distance: best.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::Ends;
    use glam::{DVec2, DVec3};

    fn wavy() -> Curve<DVec3> {
        let p: Vec<DVec3> =
            (0..14).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 7), f64::from(i * 5 % 4))).collect();
        Curve::bspline(&p, Ends::Open, None).unwrap()
    }

    #[test]
    fn no_sample_is_nearer_than_the_closest_point() {
        let curve = wavy();
        for i in 0..60 {
            let p = DVec3::new(f64::from(i * 7 % 15), f64::from(i * 3 % 8) - 0.5, f64::from(i % 5));
            let found = curve.closest(p);
            let sampled = closest_sampled(&curve, p);
            assert!(found.distance <= sampled.distance + 1e-15, "{i}");
            assert!((found.distance - sampled.distance).abs() < 1e-6, "{i}: {found:?} {sampled:?}");
            let all = curve.all_closest(p);
            assert!(all.iter().any(|n| n.t == found.t), "{i}");
            assert!(all.windows(2).all(|w| w[0].t < w[1].t), "{i}");
        }
    }

    #[test]
    fn all_minima_of_a_loop_around_the_point() {
        // A closed curve of four like pieces has four nearest points from its centre, at the seams or between them.
        let p = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(x, y)| DVec2::new(x, y));
        let ring = Curve::bspline(&p, Ends::Closed, None).unwrap();
        assert_eq!(ring.all_closest(DVec2::ZERO).len(), 4);
        let off_centre = ring.closest(DVec2::new(0.3, 0.1));
        assert!(
            off_centre.point.x > 0.5
                && (off_centre.distance - off_centre.point.distance(DVec2::new(0.3, 0.1))).abs() < 1e-16
        );
    }

    #[test]
    fn ends_corners_and_points_on_the_curve() {
        let corner = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (3.0, 1.0), (3.0, 2.0), (3.0, 3.0)];
        let p: Vec<DVec2> = corner.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
        let curve = Curve::bezier(&p, None, false).unwrap();
        let all = curve.all_closest(DVec2::new(4.0, -1.0));
        assert_eq!(all.iter().map(|n| n.t).collect::<Vec<_>>(), [0.5]);
        assert_eq!(curve.closest(DVec2::new(-1.0, -1.0)).t, 0.0);
        assert_eq!(curve.closest(DVec2::new(3.5, 9.0)).t, 1.0);
        let on = curve.at(0.3).unwrap();
        let found = curve.closest(on);
        assert!((found.t - 0.3).abs() < 1e-14 && found.distance < 1e-15, "{found:?}");
    }

    #[test]
    fn a_point_curve_is_its_own_nearest() {
        let dot = Curve::bezier(&[DVec2::ONE; 4], None, false).unwrap();
        assert_eq!(dot.closest(DVec2::ZERO).distance, 2f64.sqrt());
    }
}
