//! A path together with what is measured on it, computed once when first asked for. Knows nothing of who asks.

use super::arc_length::ArcLength;
use super::closest::{Nearest, closest_sampled};
use super::curve::{Curve, CurveError, Side, curvature_of, normal_of, on_domain, torsion_of};
use super::frame::{Frame, Frames};
use super::function::FunctionPath;
use super::path::Path;
use crate::math::Point;
use crate::math::quadrature::Integral;
use glam::DVec3;
use std::sync::OnceLock;

/// What a path is made of.
#[derive(Clone, Debug)]
pub enum Made<P: Point> {
    /// Cubic pieces.
    Spline(Curve<P>),
    /// A function.
    Function(FunctionPath<P>),
}

/// A path with its lengths and frames. Shared by all that hold it, on any thread.
#[derive(Debug)]
pub struct Measured<P: Point> {
    made: Made<P>,
    lengths: OnceLock<ArcLength>,
    frames: OnceLock<Frames>,
}

impl<P: Point> From<Curve<P>> for Measured<P> {
    fn from(curve: Curve<P>) -> Self {
        Measured::of(Made::Spline(curve))
    }
}

impl<P: Point> From<FunctionPath<P>> for Measured<P> {
    fn from(path: FunctionPath<P>) -> Self {
        Measured::of(Made::Function(path))
    }
}

impl<P: Point> Measured<P> {
    fn of(made: Made<P>) -> Self {
        Measured { made, lengths: OnceLock::new(), frames: OnceLock::new() }
    }

    /// What it is made of.
    pub fn made(&self) -> &Made<P> {
        &self.made
    }

    /// Its cubic pieces; none for a function.
    pub fn spline(&self) -> Option<&Curve<P>> {
        match &self.made {
            Made::Spline(curve) => Some(curve),
            Made::Function(_) => None,
        }
    }

    /// As any path, without what was measured.
    pub fn path(&self) -> &dyn Path<P> {
        match &self.made {
            Made::Spline(curve) => curve,
            Made::Function(path) => path,
        }
    }

    /// t, moved onto the domain where only rounding took it off. Errors: further outside, or NaN.
    #[inline]
    pub fn parameter(&self, t: f64) -> Result<f64, CurveError> {
        match &self.made {
            Made::Spline(curve) => curve.parameter(t),
            Made::Function(path) => on_domain(path.domain(), t),
        }
    }

    /// γ(t) of cubic pieces inside the domain; none where [`Measured::at`] has more to look at.
    #[inline(always)]
    pub fn at_inside(&self, t: f64) -> Option<P> {
        match &self.made {
            Made::Spline(curve) => curve.at_inside(t),
            Made::Function(_) => None,
        }
    }

    /// γ(t). Errors: outside the domain.
    #[inline]
    pub fn at(&self, t: f64) -> Result<P, CurveError> {
        match &self.made {
            Made::Spline(curve) => curve.at(t),
            Made::Function(path) => Ok(path.position(on_domain(path.domain(), t)?)),
        }
    }

    /// Lengths along it.
    pub fn lengths(&self) -> &ArcLength {
        self.lengths.get_or_init(|| ArcLength::of(self.path()))
    }

    /// The whole length, scene units, with its estimated error.
    pub fn length(&self) -> Integral {
        self.lengths().total()
    }

    /// Length from a to b, negative where b is before a, with its estimated error. Errors: outside the domain.
    pub fn length_between(&self, a: f64, b: f64) -> Result<Integral, CurveError> {
        let (a, b) = (self.parameter(a)?, self.parameter(b)?);
        Ok(self.lengths().between(self.path(), a, b))
    }

    /// The parameter at a length from the start. Errors: below 0 or beyond the end.
    pub fn parameter_at(&self, s: f64) -> Result<f64, CurveError> {
        self.lengths().parameter_at(self.path(), s)
    }

    /// γ′, γ″ and γ‴ at t: at a seam those of the piece after it, at the end those before it. Errors: outside the domain.
    pub fn derivatives(&self, t: f64) -> Result<[P; 3], CurveError> {
        let t = self.parameter(t)?;
        Ok(self.path().derivatives_from(t, self.side(t)))
    }

    /// The side from which limits are taken at t: ahead, and at the end behind.
    pub fn side(&self, t: f64) -> Side {
        if t == self.path().domain().1 { Side::Before } else { Side::After }
    }

    /// Unit tangent: at seams and cusps that of the curve ahead, at the end that of the curve behind; zero for a point. Errors: outside
    /// the domain.
    pub fn tangent(&self, t: f64) -> Result<P, CurveError> {
        let t = self.parameter(t)?;
        Ok(self.path().direction(t, self.side(t)))
    }

    /// Principal normal: the unit vector towards the centre of curvature; on a straight stretch some fixed unit vector across. Errors:
    /// outside the domain.
    pub fn normal(&self, t: f64) -> Result<P, CurveError> {
        Ok(normal_of(&self.derivatives(t)?, self.tangent(t)?))
    }

    /// Curvature, per scene unit; 0 where the path stands still. Errors: outside the domain.
    pub fn curvature(&self, t: f64) -> Result<f64, CurveError> {
        let t = self.parameter(t)?;
        Ok(curvature_of(&self.derivatives(t)?, self.path().still(t)))
    }

    /// Lower and upper corner of the box around it.
    pub fn bounds(&self) -> (P, P) {
        match &self.made {
            Made::Spline(curve) => curve.bounds(),
            Made::Function(path) => path.bounds(),
        }
    }

    /// The parts before and after t, each over its part of the parameter. Errors: outside the domain, or at an end of it.
    pub fn split(&self, t: f64) -> Result<(Self, Self), CurveError> {
        match &self.made {
            Made::Spline(curve) => curve.split(t).map(|(a, b)| (a.into(), b.into())),
            Made::Function(path) => path.split(self.parameter(t)?).map(|(a, b)| (a.into(), b.into())),
        }
    }

    /// The same way backwards, over the same domain.
    #[must_use]
    pub fn reverse(&self) -> Self {
        match &self.made {
            Made::Spline(curve) => curve.reverse().into(),
            Made::Function(path) => path.reverse().into(),
        }
    }

    /// The point nearest to p; of several, the one with the least parameter.
    pub fn closest(&self, p: P) -> Nearest<P> {
        match &self.made {
            Made::Spline(curve) => curve.closest(p),
            Made::Function(path) => closest_sampled(path, p),
        }
    }
}

impl Measured<DVec3> {
    /// The rotation-minimising frame at t, y as near to `up` at the start as it can be. Errors: outside the domain.
    pub fn frame(&self, t: f64, up: DVec3) -> Result<Frame, CurveError> {
        let t = self.parameter(t)?;
        Ok(self.frames().at(self.path(), t, up))
    }

    /// Tangent × principal normal. Errors: outside the domain.
    pub fn binormal(&self, t: f64) -> Result<DVec3, CurveError> {
        Ok(self.tangent(t)?.cross(self.normal(t)?))
    }

    /// Torsion, per scene unit; 0 where the curvature vanishes. Errors: outside the domain.
    pub fn torsion(&self, t: f64) -> Result<f64, CurveError> {
        Ok(torsion_of(&self.derivatives(t)?))
    }

    /// Its frames.
    pub fn frames(&self) -> &Frames {
        self.frames.get_or_init(|| Frames::of(self.path()))
    }
}

impl<P: Point> Path<P> for Measured<P> {
    fn domain(&self) -> (f64, f64) {
        self.path().domain()
    }

    fn closed(&self) -> bool {
        self.path().closed()
    }

    fn position(&self, t: f64) -> P {
        self.path().position(t)
    }

    fn derivatives_from(&self, t: f64, side: Side) -> [P; 3] {
        self.path().derivatives_from(t, side)
    }

    fn speed(&self, t: f64) -> f64 {
        self.path().speed(t)
    }

    fn still(&self, t: f64) -> f64 {
        self.path().still(t)
    }

    fn cuts(&self) -> Vec<f64> {
        self.path().cuts()
    }
}
