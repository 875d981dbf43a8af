//! Cubic B-splines over any breakpoints, as Bézier pieces. Boehm; de Boor. Knows nothing of other forms.

use super::build::{Breaks, check_finite};
use super::{Curve, CurveError, Form, FormKind};
use crate::geometry::basis::Basis;
use crate::math::{Dd, Point};

/// How a B-spline ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// The knots go on beyond the ends with the width of the first and last interval; the curve stays clear of its end points.
    Open,
    /// The end knots are fourfold; the curve starts at the first point and ends at the last.
    Clamped,
    /// Points and knots go round.
    Closed,
}

impl<P: Point> Curve<P> {
    /// Cubic B-spline: at least 4 points; n points make n − 3 pieces, closed n. Without knots the intervals are equal. With them
    /// they enter the basis, so that the curve is C2 at every one.
    pub fn bspline(points: &[P], ends: Ends, knots: Option<&[f64]>) -> Result<Self, CurveError> {
        let n = points.len();
        if n < 4 {
            return Err(CurveError::PointCount { form: "a bspline", expected: "at least 4", given: n });
        }
        check_finite("point", points)?;
        let closed = ends == Ends::Closed;
        let uniform = knots.is_none() && ends != Ends::Clamped;
        if uniform {
            return Curve::chain(points, Basis::BSpline, None, None, closed).map(share_seams);
        }
        let n_pieces = if closed { n } else { n - 3 };
        let breaks = Breaks::new(knots, n_pieces)?;
        let around = Around { widths: &breaks.widths, ends };
        let exact: Vec<_> = points.iter().copied().map(Dd::from).collect();
        let four = |i: usize| std::array::from_fn(|k| exact[(i + k) % n]);
        let bezier = (0..n_pieces).map(|i| window_to_bezier(&four(i), &around.widths_of(i))).collect();
        let form = Form { kind: FormKind::BSpline, points: points.to_vec(), slopes: Vec::new() };
        Ok(share_seams(Curve::assemble(&breaks.knots, bezier, closed, form)))
    }
}

/// Makes neighbours meet in the same bits: their common point is computed once from either side and may differ by 2⁻¹⁰⁰.
fn share_seams<P: Point>(mut curve: Curve<P>) -> Curve<P> {
    let n = curve.pieces.len();
    for i in 0..if curve.closed { n } else { n - 1 } {
        let next = (i + 1) % n;
        let piece = curve.pieces[i];
        let [a, b, c, _] = *piece.exact_points();
        let end = curve.pieces[next].exact_points()[0];
        curve.pieces[i] = super::Piece::new(piece.start(), piece.end(), [a, b, c, end]);
    }
    curve
}

/// The intervals around each piece, beyond the ends too.
struct Around<'a> {
    widths: &'a [Dd],
    ends: Ends,
}

impl Around<'_> {
    /// Widths of the five intervals from two before piece i to two after.
    fn widths_of(&self, i: usize) -> [Dd; 5] {
        let n = self.widths.len() as isize;
        std::array::from_fn(|k| {
            let j = i as isize + k as isize - 2;
            match self.ends {
                Ends::Closed => self.widths[j.rem_euclid(n) as usize],
                Ends::Open => self.widths[j.clamp(0, n - 1) as usize],
                Ends::Clamped if j < 0 || j >= n => Dd::default(),
                Ends::Clamped => self.widths[j as usize],
            }
        })
    }
}

/// Bézier points of the middle interval: blossom values F(0,0,0), F(0,0,h), F(0,h,h), F(h,h,h), with F at three neighbouring
/// knots being the control points. Each is an affine combination by parts of knot distances.
fn window_to_bezier<P: Point>(p: &[Dd<P>; 4], w: &[Dd; 5]) -> [Dd<P>; 4] {
    let [u2, u1, h, v1, v2] = *w;
    // a + (b − a) · part / whole
    let mix = |a: Dd<P>, b: Dd<P>, part: Dd, whole: Dd| {
        let (share, rest) = (part.over(whole), (whole - part).over(whole));
        a.times(rest) + b.times(share)
    };
    // F(·, 0, h) is affine between F(-u1, 0, h) = p[1] and F(0, h, h + v1) = p[2].
    let inner = u1 + h + v1;
    let b1 = mix(p[1], p[2], u1, inner);
    let b2 = mix(p[1], p[2], u1 + h, inner);
    // F(-u1, 0, 0): between p[0] = F(-u1-u2, -u1, 0) and p[1] = F(-u1, 0, h).
    let left = mix(p[0], p[1], u1 + u2, u2 + u1 + h);
    // F(h, h, h+v1): between p[2] = F(0, h, h+v1) and p[3] = F(h, h+v1, h+v1+v2).
    let right = mix(p[2], p[3], h, h + v1 + v2);
    [mix(left, b1, u1, u1 + h), b1, b2, mix(b2, right, h, h + v1)]
}
