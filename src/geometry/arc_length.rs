//! Arc length of a path and its inverse, with an error estimate. Knows nothing of cubics.
//!
//! The path is cut where its speed is least, since there |γ′| may have a kink (a cusp) or nearly one; between cuts Gauss–Kronrod is
//! halved adaptively. What that leaves are intervals on which one application of the rule is exact to rounding, so that a length up
//! to any parameter costs one application, and the inverse a few.

use super::curve::CurveError;
use super::path::Path;
use crate::math::quadrature::{self, Integral, Leaf};
use crate::math::{Point, bracket};

/// Lengths along one path.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcLength {
    leaves: Vec<Leaf>,
    /// Length up to the start of each leaf, and the whole at the end.
    reached: Vec<f64>,
    error: f64,
    evaluations: usize,
}

/// What lengths may be off by, as a part of the whole: a hundredth of the 10⁻¹² that is promised, above the 10⁻¹⁵ of rounding.
const TOLERANCE: f64 = 1e-14;
/// Most evaluations of the speed between two cuts. A cubic has at most two inner cuts, so at most 1800.
const BUDGET: usize = 600;
/// A length outside the path's by no more than this part of it is taken for the end: what adding up steps may have cost.
const SLACK: f64 = 1e-12;

impl ArcLength {
    /// Measures a path.
    pub fn of<P: Point>(path: &dyn Path<P>) -> ArcLength {
        let cuts = path.cuts();
        let mut evaluations = 0;
        let mut speed = |t: f64| {
            evaluations += 1;
            path.speed(t)
        };
        let rough: f64 = cuts.windows(2).map(|w| quadrature::rule(w[0], w[1], &mut speed).value).sum();
        let tolerance = TOLERANCE * rough / cuts.len() as f64;
        let measure = |w: &[f64]| quadrature::adaptive(w[0], w[1], tolerance, BUDGET, &mut speed);
        let leaves: Vec<Leaf> = cuts.windows(2).flat_map(measure).collect();
        let mut reached = vec![0.0];
        let mut sum = crate::math::Dd::from(0.0);
        for leaf in &leaves {
            sum = sum + crate::math::Dd::from(leaf.integral.value);
            reached.push(sum.value());
        }
        let error = leaves.iter().map(|leaf| leaf.integral.error).sum();
        ArcLength { leaves, reached, error, evaluations }
    }

    /// The whole length, scene units, with its estimated error.
    pub fn total(&self) -> Integral {
        Integral { value: self.reached[self.leaves.len()], error: self.error }
    }

    /// How often the speed was evaluated to measure the path.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Length from the start of the path to t in the domain.
    pub fn up_to<P: Point>(&self, path: &dyn Path<P>, t: f64) -> f64 {
        let i = self.leaf_at(t);
        self.reached[i] + self.within(path, i, t)
    }

    /// Length between two parameters, negative where `b` is before `a`, with its estimated error.
    pub fn between<P: Point>(&self, path: &dyn Path<P>, a: f64, b: f64) -> Integral {
        if b < a {
            let back = self.between(path, b, a);
            return Integral { value: -back.value, ..back };
        }
        let (i, j) = (self.leaf_at(a), self.leaf_at(b));
        if i == j {
            let mut speed = |t: f64| path.speed(t);
            return quadrature::rule(a, b, &mut speed);
        }
        let inside: f64 = self.leaves[i..=j].iter().map(|leaf| leaf.integral.error).sum();
        let from = self.reached[i] + self.within(path, i, a);
        let to = self.reached[j] + self.within(path, j, b);
        Integral { value: to - from, error: inside + f64::EPSILON * to }
    }

    /// The parameter at a length from the start; the least one where the path stands still. Errors: below 0 or beyond the end by more
    /// than rounding, or NaN.
    pub fn parameter_at<P: Point>(&self, path: &dyn Path<P>, s: f64) -> Result<f64, CurveError> {
        let length = self.total().value;
        if !(s >= -SLACK * length && s <= length * (1.0 + SLACK)) {
            return Err(CurveError::OutsideLength { s, length });
        }
        let (first, last) = path.domain();
        if s <= 0.0 {
            return Ok(first);
        }
        if s >= length {
            return Ok(last);
        }
        // The first leaf whose end is not short of s.
        let i = self.reached[1..].partition_point(|end| *end < s).min(self.leaves.len() - 1);
        let leaf = self.leaves[i];
        let rest = s - self.reached[i];
        if s == self.reached[i + 1] {
            return Ok(leaf.end);
        }
        let guess = leaf.start + (leaf.end - leaf.start) * (rest / leaf.integral.value);
        let enough = f64::EPSILON * length;
        Ok(bracket::newton(leaf.start, leaf.end, guess, true, |t| {
            let missing = self.within(path, i, t) - rest;
            (if missing.abs() <= enough { 0.0 } else { missing }, path.speed(t))
        }))
    }

    fn leaf_at(&self, t: f64) -> usize {
        self.leaves.partition_point(|leaf| leaf.start <= t).saturating_sub(1)
    }

    /// Length from the start of leaf i to t inside it.
    fn within<P: Point>(&self, path: &dyn Path<P>, i: usize, t: f64) -> f64 {
        let leaf = &self.leaves[i];
        if t >= leaf.end {
            return leaf.integral.value;
        }
        quadrature::rule(leaf.start, t, &mut |t| path.speed(t)).value
    }
}

#[cfg(test)]
mod families;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::{CatmullRom, Curve, Ends};
    use crate::math::elementary::ln;
    use glam::{DVec2, DVec3};

    fn bezier(points: &[(f64, f64)]) -> Curve<DVec2> {
        let p: Vec<_> = points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
        Curve::bezier(&p, None, false).unwrap()
    }

    /// Cusps, a line run back and forth, loops, a parabola and near cusps, with their lengths to 20 digits (mpmath, cut at
    /// the speed's minima; `tests/golden-numbers/lengths.py`).
    fn hard() -> Vec<(&'static str, Curve<DVec2>, f64)> {
        let t = 1.0 / 3.0;
        let u = 2.0 / 3.0;
        vec![
            ("cusp", bezier(&[(0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0)]), 2.0 * 2f64.sqrt() - 1.0),
            ("line", bezier(&[(0.0, 0.0), (2.0, 0.0), (-1.0, 0.0), (1.0, 0.0)]), 1.0 + 2.0 / 5f64.sqrt()),
            ("loop", bezier(&[(0.0, 0.0), (2.0, 1.0), (-1.0, 1.0), (1.0, 0.0)]), 2.536_242_651_904_533),
            (
                "parabola",
                bezier(&[(0.0, 0.0), (t, 0.0), (u, t), (1.0, 1.0)]),
                5f64.sqrt() / 2.0 + ln(2.0 + 5f64.sqrt()) / 4.0,
            ),
            ("near cusp", bezier(&[(0.0, 0.0), (1.0, 1.0), (1e-3, 1.0), (1.0, 0.0)]), 1.828_299_336_702_402),
            (
                "nearer cusp",
                bezier(&[(0.0, 0.0), (1.0, 1.0), (1e-6, 1.0), (1.0, 0.0)]),
                1.828_426_996_068_073,
            ),
            (
                "leaning cusp",
                bezier(&[(0.3, 0.1), (3.3, 2.1), (-0.7, 2.1), (2.3, 0.1)]),
                4.237_092_733_232_307,
            ),
        ]
    }

    #[test]
    fn hard_lengths_are_right_to_a_trillionth_within_two_thousand_evaluations() {
        for (name, curve, truth) in hard() {
            let length = ArcLength::of(&curve);
            let total = length.total();
            eprintln!("{name}: {:e} est {:e} n {}", total.value - truth, total.error, length.evaluations());
            assert!((total.value - truth).abs() <= 1e-13, "{name}: {} {truth}", total.value);
            assert!((total.value - truth).abs() <= total.error, "{name}: {total:?}");
            assert!(total.error <= 1e-12, "{name}: {total:?}");
            assert!(length.evaluations() <= 2000, "{name}: {}", length.evaluations());
        }
    }

    #[test]
    fn the_inverse_returns_to_the_length_and_never_steps_back() {
        for (name, curve, _) in hard() {
            let length = ArcLength::of(&curve);
            let total = length.total().value;
            let mut before = -1.0;
            for i in 0..=2000 {
                let s = total * f64::from(i) / 2000.0;
                let t = length.parameter_at(&curve, s).unwrap();
                assert!(t > before, "{name} at {s}: {t} after {before}");
                assert!((length.up_to(&curve, t) - s).abs() <= 1e-12, "{name} at {s}");
                before = t;
            }
        }
    }

    #[test]
    fn parts_add_up_and_agree_with_closed_forms() {
        let parabola = &hard()[3].1;
        let length = ArcLength::of(parabola);
        let exact = |x: f64| {
            let r = (1.0 + 4.0 * x * x).sqrt();
            x * r / 2.0 + ln(2.0 * x + r) / 4.0
        };
        for (a, b) in [(0.0, 1.0), (0.2, 0.7), (0.5, 0.5), (0.9, 0.1), (0.3, 0.3 + 1e-9)] {
            let part = length.between(parabola, a, b);
            assert!((part.value - (exact(b) - exact(a))).abs() < 1e-15, "{a} {b} {part:?}");
        }
    }

    #[test]
    fn chains_over_any_knots_have_the_lengths_of_their_pieces() {
        let p: Vec<DVec3> =
            (0..12).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 5), f64::from(i % 3))).collect();
        for curve in [
            Curve::bspline(&p, Ends::Closed, None).unwrap(),
            Curve::catmull_rom(&p, CatmullRom::default(), None, true).unwrap(),
            Curve::natural(&p, None, false).unwrap(),
        ] {
            let whole = ArcLength::of(&curve).total();
            let pieces: f64 = (0..curve.pieces().len())
                .map(|i| ArcLength::of(&curve.piece(i).unwrap()).total().value)
                .sum();
            assert!((whole.value - pieces).abs() < 1e-12 && whole.error < 1e-11, "{whole:?} {pieces}");
            let polygon: f64 = curve.pieces().iter().map(|p| p.polygon_length()).sum();
            assert!(whole.value < polygon);
        }
    }

    #[test]
    fn a_point_has_no_length_and_lengths_outside_are_errors() {
        let point = Curve::bezier(&[DVec2::ONE; 4], None, false).unwrap();
        let length = ArcLength::of(&point);
        assert_eq!(length.total().value, 0.0);
        assert_eq!(length.parameter_at(&point, 0.0), Ok(0.0));
        let (_, line, total) = &hard()[1];
        let length = ArcLength::of(line);
        assert_eq!(length.parameter_at(line, total * (1.0 + 1e-15)), Ok(1.0));
        assert!(length.parameter_at(line, 3.0).is_err() && length.parameter_at(line, f64::NAN).is_err());
    }
}
