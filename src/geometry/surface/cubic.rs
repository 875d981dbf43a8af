//! The cubic pieces that surfaces along curves are made of: exact for splines, fitted for any other path.

use crate::geometry::curve::evaluate::{bernstein, de_casteljau};
use crate::geometry::curve::{Curve, Side};
use crate::geometry::measured::{Made, Measured};
use crate::geometry::path::Path;
use crate::math::Point;
use crate::math::elementary::atan2;
use glam::DVec2;

/// One cubic over `start..end` of its curve's parameter, start < end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic<P> {
    /// First parameter.
    pub start: f64,
    /// Last parameter.
    pub end: f64,
    /// Bézier points.
    pub points: [P; 4],
}

/// A fitted cubic strays from its path by no more than this part of the path's extent, where the path is smooth: far below what any picture
/// shows, and reached with some hundred pieces a turn.
pub const FIT: f64 = 1e-8;
/// Most pieces of a fit; beyond, what is left strays further.
const MOST_PIECES: usize = 1 << 14;

/// Nodes and weights on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

impl<P: Point> Cubic<P> {
    /// The point at x in [0, 1] of the piece.
    pub fn at(&self, x: f64) -> P {
        bernstein(&self.points, x)
    }

    /// The derivative by x.
    pub fn velocity(&self, x: f64) -> P {
        let [a, b, c] = self.hodograph();
        let r = 1.0 - x;
        a * (r * r) + b * (2.0 * r * x) + c * (x * x)
    }

    /// The second derivative by x.
    pub fn acceleration(&self, x: f64) -> P {
        let [a, b, c] = self.hodograph();
        ((b - a) * (1.0 - x) + (c - b) * x) * 2.0
    }

    /// The largest second derivative by x.
    pub fn largest_acceleration(&self) -> f64 {
        self.acceleration(0.0).length().max(self.acceleration(1.0).length())
    }

    /// Bézier points of the derivative by x.
    pub fn hodograph(&self) -> [P; 3] {
        let p = &self.points;
        [1, 2, 3].map(|i| (p[i] - p[i - 1]) * 3.0)
    }

    /// The curve's parameter at x.
    pub fn parameter(&self, x: f64) -> f64 {
        if x == 1.0 { self.end } else { self.start + (self.end - self.start) * x }
    }

    /// The parts before and after x in (0, 1); they meet in the same bits.
    pub fn split(&self, x: f64) -> [Self; 2] {
        let [a, b, c, d] = self.points;
        let mix = |p: P, q: P| p * (1.0 - x) + q * x;
        let (e, f, g) = (mix(a, b), mix(b, c), mix(c, d));
        let (h, i) = (mix(e, f), mix(f, g));
        let m = mix(h, i);
        let t = self.parameter(x);
        [
            Cubic { start: self.start, end: t, points: [a, e, h, m] },
            Cubic { start: t, end: self.end, points: [m, i, g, d] },
        ]
    }

    /// The same with each coordinate that the ends share with a neighbour kept: the pieces cut at parameters of `(start, end)`, ascending.
    pub(super) fn cut_at(self, parameters: impl Iterator<Item = f64>) -> Vec<Self> {
        let mut done = Vec::new();
        let mut rest = self;
        for t in parameters {
            let x = (t - rest.start) / (rest.end - rest.start);
            if x > 0.0 && x < 1.0 && t > rest.start && t < rest.end {
                let [before, mut after] = rest.split(x);
                done.push(Cubic { end: t, ..before });
                after.start = t;
                rest = after;
            }
        }
        done.push(rest);
        done
    }

    /// Unit tangent at x; where the curve stands still, toward where it goes next or comes from. None for a single point.
    pub fn direction(&self, x: f64) -> Option<P> {
        let inward = if x < 0.5 { 1.0 } else { -1.0 };
        let ways = [self.velocity(x), self.acceleration(x) * inward, self.points[3] - self.points[0]];
        let still = 64.0 * f64::EPSILON * self.polygon_length();
        ways.into_iter().find(|v| v.length() > still).and_then(Point::unit)
    }

    /// Sum of the angles between neighbouring control vectors of the derivative, radians; those of length 0 do not count.
    pub fn turn(&self) -> f64 {
        let d: Vec<P> = self.hodograph().into_iter().filter_map(Point::unit).collect();
        // Twice the angle whose tangent is half the chord over half the sum: right for small angles too.
        d.windows(2).map(|w| 2.0 * atan2((w[1] - w[0]).length(), (w[1] + w[0]).length())).sum()
    }

    /// Length from the start to x, by Gauss's rule of five points: to six digits or better where the piece bends by less than a radian.
    pub fn length_to(&self, x: f64) -> f64 {
        let speed = |node: f64| self.velocity(0.5 * x * (1.0 + node)).length();
        0.5 * x * GAUSS.iter().map(|(node, weight)| weight * speed(*node)).sum::<f64>()
    }

    /// Length of the control polygon: never less than that of the curve.
    pub fn polygon_length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }
}

impl Cubic<DVec2> {
    /// ∫ x dy over the piece: the rest of the area of a closed outline is that of its other pieces. Exact but for rounding, by Gauss's rule.
    pub fn area(&self) -> f64 {
        let at = |node: f64| {
            let x = 0.5 * (1.0 + node);
            self.at(x).x * self.velocity(x).y
        };
        0.5 * GAUSS.iter().map(|(node, weight)| weight * at(*node)).sum::<f64>()
    }
}

/// The pieces of a spline, exact but for the rounding of their points.
pub fn of_curve<P: Point>(curve: &Curve<P>) -> Vec<Cubic<P>> {
    curve.pieces().iter().map(|p| Cubic { start: p.start(), end: p.end(), points: p.points() }).collect()
}

/// The pieces of a path: exact for a spline, fitted within [`FIT`] for a function.
pub fn of_measured<P: Point>(path: &Measured<P>) -> Vec<Cubic<P>> {
    match path.made() {
        Made::Spline(curve) => of_curve(curve),
        Made::Function(path) => of_path(path).0,
    }
}

/// Cubics through any path, with its velocities at their ends, and how far they were seen to stray from it.
pub fn of_path<P: Point>(path: &dyn Path<P>) -> (Vec<Cubic<P>>, f64) {
    let cuts = path.cuts();
    let start = path.position(cuts[0]);
    let extent = cuts.iter().fold(0.0, |m: f64, t| m.max(path.position(*t).distance(start)));
    let mut fit = Fit { path, allowed: FIT * extent, error: 0.0, pieces: Vec::new() };
    for w in cuts.windows(2) {
        fit.between(w[0], w[1]);
    }
    (fit.pieces, fit.error)
}

struct Fit<'a, P> {
    path: &'a dyn Path<P>,
    allowed: f64,
    error: f64,
    pieces: Vec<Cubic<P>>,
}

impl<P: Point> Fit<'_, P> {
    fn between(&mut self, start: f64, end: f64) {
        let mut waiting = vec![(start, end)];
        while let Some((a, b)) = waiting.pop() {
            let piece = self.hermite(a, b);
            let stray = [0.2, 0.5, 0.8]
                .into_iter()
                .fold(0.0, |m: f64, x| m.max(self.path.position(a + (b - a) * x).distance(piece.at(x))));
            let middle = 0.5 * (a + b);
            let full = self.pieces.len() + waiting.len() >= MOST_PIECES;
            if stray <= self.allowed || full || !(a < middle && middle < b) {
                self.error = self.error.max(stray);
                self.pieces.push(piece);
            } else {
                waiting.extend([(middle, b), (a, middle)]);
            }
        }
    }

    fn hermite(&self, a: f64, b: f64) -> Cubic<P> {
        let third = (b - a) / 3.0;
        let (p, q) = (self.path.position(a), self.path.position(b));
        let [v, ..] = self.path.derivatives_from(a, Side::After);
        let [w, ..] = self.path.derivatives_from(b, Side::Before);
        Cubic { start: a, end: b, points: [p, p + v * third, q - w * third, q] }
    }
}

/// Two chains over the same interval, cut so that their pieces go together. The second chain's interval is stretched over the first's.
pub fn together<P: Point, Q: Point>(first: &[Cubic<P>], second: &[Cubic<Q>]) -> Vec<(Cubic<P>, Cubic<Q>)> {
    let (start, end) = (first[0].start, first[first.len() - 1].end);
    let (from, to) = (second[0].start, second[second.len() - 1].end);
    let stretch = |t: f64| match t {
        t if t == from => start,
        t if t == to => end,
        t => (start + (t - from) * ((end - start) / (to - from))).clamp(start, end),
    };
    let second: Vec<Cubic<Q>> = second
        .iter()
        .map(|c| Cubic { start: stretch(c.start), end: stretch(c.end), points: c.points })
        .filter(|c| c.start < c.end)
        .collect();
    let knots = |a: &mut dyn Iterator<Item = f64>| a.collect::<Vec<f64>>();
    let of_first = knots(&mut first.iter().map(|c| c.end));
    let of_second = knots(&mut second.iter().map(|c| c.end));
    let cut_first = first.iter().flat_map(|c| c.cut_at(of_second.iter().copied()));
    let cut_second = second.iter().flat_map(|c| c.cut_at(of_first.iter().copied()));
    cut_first.zip(cut_second).collect()
}

/// Where a number that goes along is least: its value and the parameter.
pub fn least(pieces: &[Cubic<f64>]) -> (f64, f64) {
    let candidates = pieces.iter().flat_map(|piece| {
        let inner = crate::math::bernstein::roots(&piece.hodograph());
        [0.0, 1.0].into_iter().chain(inner).map(|x| (de_casteljau(&piece.points, x), piece.parameter(x)))
    });
    candidates.fold((f64::INFINITY, f64::NAN), |best, next| if next.0 < best.0 { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::function::FunctionPath;
    use crate::math::elementary::sin_cos;
    use glam::DVec3;
    use std::convert::Infallible;

    #[test]
    fn a_helix_is_followed_by_cubics() {
        let at = |t: f64| {
            let (s, c) = sin_cos(t);
            DVec3::new(c, s, 0.2 * t)
        };
        let path = FunctionPath::fit(0.0, 12.0, |t| Ok::<_, Infallible>(at(t))).unwrap();
        let (pieces, error) = of_path(&path);
        assert!(error <= 3.2 * FIT && pieces.len() < 300, "{error} {}", pieces.len());
        for piece in &pieces {
            for k in 0..=10 {
                let x = f64::from(k) / 10.0;
                assert!(piece.at(x).distance(at(piece.parameter(x))) < 4.0 * FIT);
            }
        }
        assert!(pieces.windows(2).all(|w| w[0].points[3] == w[1].points[0] && w[0].end == w[1].start));
    }

    #[test]
    fn chains_of_different_knots_are_cut_to_go_together() {
        let path = Curve::bezier(&[0.0, 1.0, 2.0, 3.0, 5.0, 4.0, 7.0], None, false).unwrap();
        let radius = Curve::bezier(
            &[1.0, 2.0, 0.5, 1.0, 2.0, 2.0, 3.0, 1.0, 1.0, 0.25],
            Some(&[0.0, 1.0, 3.0, 6.0]),
            false,
        )
        .unwrap();
        let both = together(&of_curve(&path), &of_curve(&radius));
        assert_eq!(both.len(), 3);
        for (p, r) in &both {
            assert_eq!((p.start, p.end), (r.start, r.end));
            let t = 0.5 * (p.start + p.end);
            assert!((p.at(0.5) - path.at(t).unwrap()).abs() < 1e-14);
            assert!((r.at(0.5) - radius.at(6.0 * t).unwrap()).abs() < 1e-14);
        }
        let (value, t) = least(&of_curve(&radius));
        assert!(value == 0.25 && t == 6.0, "{value} at {t}");
    }
}
