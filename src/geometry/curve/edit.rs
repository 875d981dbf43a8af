//! Parts of a curve, the same curve backwards, and the same curve in another basis.

use super::{Curve, CurveError, Form, FormKind, Piece};
use crate::geometry::basis::Basis;
use crate::math::error::UNIT_ROUNDOFF;
use crate::math::{Dd, Point};

impl<P: Point> Curve<P> {
    /// One piece as a curve of its own, over its part of the parameter, with Bézier points.
    pub fn piece(&self, index: usize) -> Result<Self, CurveError> {
        let n_pieces = self.pieces.len();
        let piece = self.pieces.get(index).ok_or(CurveError::NoPiece { index, n_pieces })?;
        Ok(Curve::of_pieces(vec![*piece]))
    }

    /// An open curve of these pieces, its form that of Bézier.
    fn of_pieces(pieces: Vec<Piece<P>>) -> Self {
        let form = bezier_form(&pieces, false);
        Curve::of(pieces, false, form)
    }

    /// The curve up to t and from t on, each over its part of the parameter. They meet in the same bits, and give this curve's
    /// values to within ½ ulp more. Errors: outside the domain, or at an end of it.
    pub fn split(&self, t: f64) -> Result<(Self, Self), CurveError> {
        let t = self.parameter(t)?;
        let (start, end) = self.domain();
        if t == start || t == end {
            return Err(CurveError::SplitAtEnd { t });
        }
        let index = self.pieces.partition_point(|piece| piece.start() <= t) - 1;
        if self.pieces[index].start() == t {
            let (before, after) = self.pieces.split_at(index);
            return Ok((Curve::of_pieces(before.to_vec()), Curve::of_pieces(after.to_vec())));
        }
        let (left, right) = self.pieces[index].split(t);
        let before = self.pieces[..index].iter().copied().chain([left]).collect();
        let after = [right].into_iter().chain(self.pieces[index + 1..].iter().copied()).collect();
        Ok((Curve::of_pieces(before), Curve::of_pieces(after)))
    }

    /// The same way backwards, over the same domain: its value at t is that at start + end − t.
    #[must_use]
    pub fn reverse(&self) -> Self {
        let (start, end) = self.domain();
        let mirror = |t: f64| {
            if t == start {
                end
            } else if t == end {
                start
            } else {
                Dd::sum(start, end).hi - t
            }
        };
        let turned = |p: &Piece<P>| p.reversed(mirror(p.end()), mirror(p.start()));
        let pieces: Vec<_> = self.pieces.iter().rev().map(turned).collect();
        let form = bezier_form(&pieces, self.closed);
        Curve::of(pieces, self.closed, form)
    }

    /// The same curve, bit for bit, its points those of another basis: shared between pieces by the basis's own stride where
    /// neighbours agree on them, four for each piece otherwise. Errors: a matrix as target.
    pub fn to(&self, basis: &Basis) -> Result<Self, CurveError> {
        if let FormKind::Chain { basis: own, .. } = &self.form.kind
            && own == basis
        {
            return Ok(self.clone());
        }
        let fours: Option<Vec<[P; 4]>> = self
            .pieces
            .iter()
            .map(|piece| basis.from_bezier(piece.exact_points()).map(|c| c.map(Dd::value)))
            .collect();
        let form = chain_form(*basis, &fours.ok_or(CurveError::NoInverse)?, self.closed);
        Ok(Curve { form, ..self.clone() })
    }

    /// True where each piece starts where the one before it ends.
    pub fn connected(&self) -> bool {
        let joined = |a: &Piece<P>, b: &Piece<P>| a.points()[3] == b.points()[0];
        let ends_meet = || joined(&self.pieces[self.pieces.len() - 1], &self.pieces[0]);
        self.pieces.windows(2).all(|w| joined(&w[0], &w[1])) && (!self.closed || ends_meet())
    }
}

fn bezier_form<P: Point>(pieces: &[Piece<P>], closed: bool) -> Form<P> {
    let fours: Vec<[P; 4]> = pieces.iter().map(Piece::points).collect();
    chain_form(Basis::Bezier, &fours, closed)
}

/// Points of a chain from those of each piece.
fn chain_form<P: Point>(basis: Basis, fours: &[[P; 4]], closed: bool) -> Form<P> {
    let stride = match basis {
        Basis::Bezier | Basis::BSpline | Basis::CatmullRom => basis.stride(),
        Basis::Hermite | Basis::Monomial | Basis::Matrix(_) => 4,
    };
    let stride = if shares(fours, stride, closed) { stride } else { 4 };
    let mut points: Vec<P> = fours.iter().flat_map(|four| four[..stride].iter().copied()).collect();
    if let (false, Some(last)) = (closed, fours.last()) {
        points.extend_from_slice(&last[stride..]);
    }
    Form { kind: FormKind::Chain { basis, stride }, points, slopes: Vec::new() }
}

/// True where neighbours agree on the points they share, to the rounding that a change of basis makes: the weights of B-spline points
/// in Bézier points sum to 15 in magnitude, each point being off by u.
fn shares<P: Point>(fours: &[[P; 4]], stride: usize, closed: bool) -> bool {
    let agree = |a: &[P; 4], b: &[P; 4]| {
        let scale = a.iter().chain(b).fold(0.0, |m: f64, p| m.max(p.max_abs()));
        a[stride.min(4)..].iter().zip(b).all(|(p, q)| (*p - *q).max_abs() <= 16.0 * UNIT_ROUNDOFF * scale)
    };
    let around = !closed || (fours.len() >= 4 && agree(&fours[fours.len() - 1], &fours[0]));
    // Closed Bézier pieces share one point whatever their number.
    let around = around || (stride == 3 && agree(&fours[fours.len() - 1], &fours[0]));
    fours.windows(2).all(|w| agree(&w[0], &w[1])) && around
}
