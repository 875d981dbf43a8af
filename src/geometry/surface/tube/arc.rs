//! Short pieces of a tube, bent so little that most rays are settled at the first look.

use crate::geometry::surface::cubic::Cubic;
use crate::geometry::surface::mesh::steps_along;
use crate::math::Aabb;
use glam::DVec3;

/// A cubic centre and a cubic radius over [0, 1].
#[derive(Clone, Debug)]
pub(super) struct Arc {
    pub points: [DVec3; 4],
    pub radii: [f64; 4],
    /// Share of the tube's length at both ends.
    pub shares: (f64, f64),
    /// Unit vector across the start's tangent, carried along the curve.
    pub up: DVec3,
    /// Whether the planes of the tube's start and end may cut its balls.
    pub clipped: [bool; 2],
}

/// Pieces are halved until their tangents' control vectors turn by less than this, in total, radians: then the squared distance from
/// most rays is concave along them.
const MOST_TURN: f64 = 0.5;
/// Most halvings for the sake of bends, and of length.
const MOST_HALVINGS: u32 = 7;
const MOST_SHORTENINGS: u32 = 3;
/// A piece this many times as long as thick is halved, so that its box is not mostly empty.
const SLENDER: f64 = 8.0;

/// Adds the arcs of a piece.
pub(super) fn cut(curve: &Cubic<DVec3>, radius: &Cubic<f64>, arcs: &mut Vec<Arc>) {
    let mut waiting = vec![(*curve, *radius, 0)];
    while let Some((curve, radius, depth)) = waiting.pop() {
        let thick = radius.points.iter().fold(0.0, |m: f64, r| m.max(*r));
        let is_slender = curve.polygon_length() > SLENDER * 2.0 * thick;
        let is_bent = curve.turn() > MOST_TURN || is_uneven(&radius);
        if is_bent && depth < MOST_HALVINGS || is_slender && depth < MOST_SHORTENINGS {
            let ([a, b], [r, s]) = (curve.split(0.5), radius.split(0.5));
            waiting.push((b, s, depth + 1));
            waiting.push((a, r, depth + 1));
            continue;
        }
        arcs.push(Arc {
            points: curve.points,
            radii: radius.points,
            shares: (0.0, 0.0),
            up: DVec3::ZERO,
            clipped: [false; 2],
        });
    }
}

/// Whether the radius bends by a good part of itself.
fn is_uneven(radius: &Cubic<f64>) -> bool {
    let [a, b, c, d] = radius.points;
    let bend = (a - 2.0 * b + c).abs().max((b - 2.0 * c + d).abs());
    bend > 0.25 * a.max(b).max(c).max(d)
}

/// The planes across both ends: a point, and the direction that leaves the tube.
pub(super) fn ends(arcs: &[Arc]) -> [(DVec3, DVec3); 2] {
    let (first, last) = (&arcs[0], &arcs[arcs.len() - 1]);
    [(first.points[0], -first.direction(0.0)), (last.points[3], last.direction(1.0))]
}

/// Marks the arcs near each end whose balls may reach beyond its plane: all up to the first that is clear of it.
pub(super) fn mark_clipped(arcs: &mut [Arc], ends: &[(DVec3, DVec3); 2]) {
    let reaches = |arc: &Arc, (origin, out): (DVec3, DVec3)| {
        let thick = arc.radii.iter().fold(0.0, |m: f64, r| m.max(*r));
        arc.points.iter().any(|p| out.dot(*p - origin) + thick > 0.0)
    };
    let first = arcs.iter().position(|arc| !reaches(arc, ends[0])).unwrap_or(arcs.len());
    arcs[..first].iter_mut().for_each(|arc| arc.clipped[0] = true);
    let last = arcs.iter().rposition(|arc| !reaches(arc, ends[1])).map_or(0, |k| k + 1);
    arcs[last..].iter_mut().for_each(|arc| arc.clipped[1] = true);
}

impl Arc {
    fn curve(&self) -> Cubic<DVec3> {
        Cubic { start: 0.0, end: 1.0, points: self.points }
    }

    /// Around all its balls.
    pub fn bounds(&self) -> Aabb {
        let thick = self.radii.iter().fold(0.0, |m: f64, r| m.max(*r));
        let points = Aabb::of(self.points);
        let size = points.min.abs().max(points.max.abs()) + thick;
        let by = DVec3::splat(thick) + size * (8.0 * f64::EPSILON);
        Aabb { min: points.min - by, max: points.max + by }
    }

    /// Balls whose hull holds all of its balls.
    pub fn balls(&self) -> impl Iterator<Item = (DVec3, f64)> + Clone {
        self.points.into_iter().zip(self.radii)
    }

    /// Centre and radius at x.
    pub fn at(&self, x: f64) -> (DVec3, f64) {
        let radius = Cubic { start: 0.0, end: 1.0, points: self.radii };
        (self.curve().at(x), radius.at(x))
    }

    /// Unit tangent at x; z where the arc is a single point.
    pub fn direction(&self, x: f64) -> DVec3 {
        self.curve().direction(x).unwrap_or(DVec3::Z)
    }

    /// Length from the start to x.
    pub fn length(&self, x: f64) -> f64 {
        self.curve().length_to(x)
    }

    /// Derivatives of the length and of the radius by x.
    pub fn speeds(&self, x: f64) -> (f64, f64) {
        let radius = Cubic { start: 0.0, end: 1.0, points: self.radii };
        (self.curve().velocity(x).length(), radius.velocity(x))
    }

    /// Equal steps along it that keep a tolerance on the wall: the bend of the curve and of the radius, and the turn of the rings.
    pub fn steps(&self, tolerance: f64) -> usize {
        let radius = Cubic { start: 0.0, end: 1.0, points: self.radii };
        let thick = self.radii.iter().fold(0.0, |m: f64, r| m.max(*r));
        let turn = self.curve().turn();
        let second =
            self.curve().largest_acceleration() + radius.largest_acceleration() + thick * turn * turn;
        steps_along(second, tolerance)
    }

    /// Share of the tube's length at x.
    pub fn share(&self, x: f64) -> f64 {
        let (from, to) = self.shares;
        let whole = self.length(1.0);
        if whole > 0.0 { from + (to - from) * (self.length(x) / whole).min(1.0) } else { from }
    }
}
