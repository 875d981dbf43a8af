//! Natural cubic splines: through the points, twice continuously differentiable, without curvature at open ends; closed ones
//! periodic. de Boor, *A Practical Guide to Splines*, ch. IV.

use super::build::{Breaks, from_slopes, interpolated_pieces};
use super::{Curve, CurveError, Form, FormKind};
use crate::math::{Dd, Point};

impl<P: Point> Curve<P> {
    /// Through the points, C2. At least 2 points, closed 3. γ″ = 0 at open ends.
    pub fn natural(points: &[P], knots: Option<&[f64]>, closed: bool) -> Result<Self, CurveError> {
        let n_pieces = interpolated_pieces("a natural spline", points, closed)?;
        let breaks = Breaks::new(knots, n_pieces)?;
        let mut system = System::new(points, &breaks.widths, closed);
        let slopes = if closed { system.solve_periodic() } else { system.solve() };
        let bezier = from_slopes(points, &slopes, &breaks.widths);
        let form = Form { kind: FormKind::Natural, points: points.to_vec(), slopes: Vec::new() };
        Ok(Curve::assemble(&breaks.knots, bezier, closed, form))
    }
}

/// The equations of the slopes: below·m[i−1] + diagonal·m[i] + above·m[i+1] = right. Diagonally dominant, so elimination needs
/// no pivots. In double-double: the jump of γ″ at the knots, a difference of large terms, is then rounding of the data alone.
struct System<P> {
    below: Vec<Dd>,
    diagonal: Vec<Dd>,
    above: Vec<Dd>,
    right: Vec<Dd<P>>,
}

impl<P: Point> System<P> {
    fn new(points: &[P], widths: &[Dd], closed: bool) -> Self {
        let n = points.len();
        let zero = Dd::from(0.0);
        let mut s = System {
            below: vec![zero; n],
            diagonal: vec![zero; n],
            above: vec![zero; n],
            right: vec![Dd::default(); n],
        };
        for (i, width) in widths.iter().enumerate() {
            let (j, per) = ((i + 1) % n, Dd::from(1.0).over(*width));
            let rise = Dd::difference(points[j], points[i]).times(per).times(per).scaled(3.0);
            s.above[i] = per;
            s.below[j] = per;
            for k in [i, j] {
                s.diagonal[k] = s.diagonal[k] + per.scaled(2.0);
                s.right[k] = s.right[k] + rise;
            }
        }
        if !closed {
            s.below[0] = zero;
            s.above[n - 1] = zero;
        }
        s
    }

    /// Elimination from the top, substitution from the bottom (Thomas).
    fn solve(&mut self) -> Vec<Dd<P>> {
        let n = self.right.len();
        for i in 1..n {
            let factor = self.below[i].over(self.diagonal[i - 1]);
            self.diagonal[i] = self.diagonal[i] - factor.times(self.above[i - 1]);
            self.right[i] = self.right[i] - self.right[i - 1].times(factor);
        }
        let mut m = self.right.clone();
        for i in (0..n).rev() {
            let known = if i + 1 < n { m[i + 1].times(self.above[i]) } else { Dd::default() };
            m[i] = (self.right[i] - known).over(self.diagonal[i]);
        }
        m
    }

    /// The corners `below[0]` and `above[n−1]` couple the ends: Sherman & Morrison's formula with two plain solutions.
    fn solve_periodic(&mut self) -> Vec<Dd<P>> {
        let n = self.right.len();
        let (corner_above, corner_below) = (self.below[0], self.above[n - 1]);
        let gamma = -self.diagonal[0];
        self.diagonal[0] = self.diagonal[0] - gamma;
        self.diagonal[n - 1] = self.diagonal[n - 1] - corner_above.times(corner_below).over(gamma);
        let mut unit = System {
            below: self.below.clone(),
            diagonal: self.diagonal.clone(),
            above: self.above.clone(),
            right: vec![Dd::from(0.0); n],
        };
        unit.right[0] = gamma;
        unit.right[n - 1] = corner_below;
        let (y, q) = (self.solve(), unit.solve());
        let share = corner_above.over(gamma);
        let along = y[0] + y[n - 1].times(share);
        let scale = Dd::from(1.0) + q[0] + q[n - 1].times(share);
        let factor = along.over(scale);
        y.iter().zip(&q).map(|(y, q)| *y - factor.times(*q)).collect()
    }
}
