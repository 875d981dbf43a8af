//! Curves: chains of cubic pieces through numbers, 2-vectors or 3-vectors. Knows nothing of scenes, spans or pictures.
//!
//! Every form of spline becomes Bézier pieces over the true breakpoints when it is made; what it was made from is kept beside
//! them, to be shown and changed to other bases. A value is within ½ ulp and a hair of the exact one for the numbers given.

mod bounds;
mod bspline;
mod build;
mod catmull;
mod continuity;
mod differential;
mod edit;
mod error;
pub mod evaluate;
#[cfg(test)]
mod families;
mod from_ends;
#[cfg(test)]
mod laws;
mod natural;
mod piece;
#[cfg(test)]
mod tests;

pub use bspline::Ends;
pub use catmull::CatmullRom;
pub use continuity::Seam;
pub use differential::Side;
pub(crate) use differential::{across, any_across, curvature_of, normal_of, tangent_of, torsion_of};
pub use error::CurveError;
pub use evaluate::Method;
pub use piece::Piece;

use super::basis::Basis;
use crate::math::Point;

/// A chain of cubics over strictly increasing breakpoints.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<P: Point> {
    pieces: Vec<Piece<P>>,
    /// First and last parameter.
    domain: (f64, f64),
    /// Pieces for each unit of the parameter, on the average.
    per_unit: f64,
    closed: bool,
    form: Form<P>,
}

/// What the pieces were made from.
#[derive(Clone, Debug, PartialEq)]
pub struct Form<P> {
    /// Which form of spline.
    pub kind: FormKind,
    /// The points as given (or as a change of basis made them).
    pub points: Vec<P>,
    /// Of [`FormKind::Hermite`]: a slope for each point. Empty otherwise.
    pub slopes: Vec<P>,
}

/// The forms of spline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FormKind {
    /// Points that a piece of cubic shares with the next by a stride, in some basis.
    Chain {
        /// The basis of each four.
        basis: Basis,
        /// How far on the next four start.
        stride: usize,
    },
    /// B-spline over knots that are not all one apart, or with its ends clamped.
    BSpline,
    /// Points and slopes.
    Hermite,
    /// Through the points, slopes from their neighbours.
    CatmullRom,
    /// Through the points, twice continuously differentiable.
    Natural,
    /// Coefficients of 1, t, t², t³ in the curve's own parameter.
    Monomial,
}

/// A parameter outside the domain by no more than this many units in the last place of the domain's larger end is taken for the end:
/// what adding up steps may have cost.
const DOMAIN_SLACK: f64 = 16.0;

/// t, moved onto a domain where only rounding took it off. Errors: further outside, or NaN.
#[inline]
pub(crate) fn on_domain((start, end): (f64, f64), t: f64) -> Result<f64, CurveError> {
    if t >= start && t <= end {
        return Ok(t);
    }
    let slack = DOMAIN_SLACK * f64::EPSILON * start.abs().max(end.abs());
    if t >= start - slack && t <= end + slack {
        Ok(t.clamp(start, end))
    } else {
        Err(CurveError::OutsideDomain { t, start, end })
    }
}

impl<P: Point> Curve<P> {
    /// Of pieces in order, at least one.
    fn of(pieces: Vec<Piece<P>>, closed: bool, form: Form<P>) -> Self {
        let domain = (pieces[0].start(), pieces[pieces.len() - 1].end());
        let per_unit = pieces.len() as f64 / (domain.1 - domain.0);
        Curve { pieces, domain, per_unit, closed, form }
    }

    /// First and last parameter.
    #[inline]
    pub fn domain(&self) -> (f64, f64) {
        self.domain
    }

    /// True where the end runs on into the start.
    pub fn closed(&self) -> bool {
        self.closed
    }

    /// The pieces in order; at least one.
    pub fn pieces(&self) -> &[Piece<P>] {
        &self.pieces
    }

    /// The breakpoints: one more than the pieces.
    pub fn knots(&self) -> Vec<f64> {
        let ends = self.pieces.iter().map(Piece::end);
        std::iter::once(self.domain().0).chain(ends).collect()
    }

    /// What the curve was made from.
    pub fn form(&self) -> &Form<P> {
        &self.form
    }

    /// The points of its form.
    pub fn points(&self) -> &[P] {
        &self.form.points
    }

    /// t, moved onto the domain where only rounding took it off. Errors: further outside, or NaN.
    #[inline]
    pub fn parameter(&self, t: f64) -> Result<f64, CurveError> {
        on_domain(self.domain(), t)
    }

    /// The piece that holds t; at a seam the one after it. Outside the domain the first or the last.
    #[inline(always)]
    pub(crate) fn piece_at(&self, t: f64) -> &Piece<P> {
        // Where the breakpoints are as far apart as each other, this is it.
        let guess = ((t - self.domain.0) * self.per_unit) as u32 as usize;
        let guess = &self.pieces[guess.min(self.pieces.len() - 1)];
        if t >= guess.start() && t < guess.end() {
            return guess;
        }
        self.piece_by_search(t)
    }

    #[inline(never)]
    fn piece_by_search(&self, t: f64) -> &Piece<P> {
        let after = self.pieces.partition_point(|piece| piece.start() <= t);
        &self.pieces[after.saturating_sub(1)]
    }

    /// γ(t). Error below half an ulp of the value, and a hair, for any t of the domain.
    #[inline]
    pub fn at(&self, t: f64) -> Result<P, CurveError> {
        let t = self.parameter(t)?;
        Ok(self.piece_at(t).at(t))
    }

    /// The same by the quick way; none outside the domain, and where numbers are too large for it.
    #[inline(always)]
    pub fn at_inside(&self, t: f64) -> Option<P> {
        let (start, end) = self.domain;
        if t >= start && t <= end { self.piece_at(t).at_inside(t) } else { None }
    }

    /// γ(t) by another method than the default.
    pub fn at_by(&self, method: Method, t: f64) -> Result<P, CurveError> {
        let t = self.parameter(t)?;
        Ok(self.piece_at(t).at_by(method, t))
    }

    /// The blossom of one piece: symmetric to the last bit, affine in each argument, with γ on its diagonal. Arguments may be any
    /// reals. Errors: more than one piece, each of which has a blossom of its own.
    pub fn blossom(&self, a: f64, b: f64, c: f64) -> Option<P> {
        match self.pieces.as_slice() {
            [piece] => Some(piece.blossom(a, b, c)),
            _ => None,
        }
    }
}
