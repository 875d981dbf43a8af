//! A curve of numbers, of 2-vectors or of 3-vectors, cheap to copy. Knows nothing of what a scene does with it.

use super::measured::Measured;
use super::path::Path;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A shared curve by the points it runs through.
#[derive(Clone, Debug)]
pub enum AnyCurve {
    /// Through numbers.
    Numbers(Arc<Measured<f64>>),
    /// Through 2-vectors.
    Plane(Arc<Measured<DVec2>>),
    /// Through 3-vectors; colours are such.
    Space(Arc<Measured<DVec3>>),
}

/// Runs the same for a curve of each dimension: `each!(curve, c => c.length())`.
macro_rules! each_curve {
    ($curve:expr, $c:ident => $body:expr) => {
        match $curve {
            $crate::geometry::any_curve::AnyCurve::Numbers($c) => $body,
            $crate::geometry::any_curve::AnyCurve::Plane($c) => $body,
            $crate::geometry::any_curve::AnyCurve::Space($c) => $body,
        }
    };
}
pub(crate) use each_curve;

macro_rules! from_measured {
    ($($point:ty => $variant:ident),*) => {
        $(impl<T: Into<Measured<$point>>> IntoCurve<$point> for T {
            fn into_curve(self) -> AnyCurve {
                AnyCurve::$variant(Arc::new(self.into()))
            }
        })*
    };
}

/// What becomes an [`AnyCurve`]: a curve or a function path of any dimension.
pub trait IntoCurve<P> {
    /// The same, to be shared.
    fn into_curve(self) -> AnyCurve;
}

from_measured!(f64 => Numbers, DVec2 => Plane, DVec3 => Space);

impl AnyCurve {
    /// How many numbers a point has: 1 to 3.
    pub fn dimension(&self) -> usize {
        match self {
            AnyCurve::Numbers(_) => 1,
            AnyCurve::Plane(_) => 2,
            AnyCurve::Space(_) => 3,
        }
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        each_curve!(self, c => c.domain())
    }

    /// True where the end runs on into the start.
    pub fn closed(&self) -> bool {
        each_curve!(self, c => c.closed())
    }

    /// True where both are one and the same.
    pub fn same(&self, other: &AnyCurve) -> bool {
        match (self, other) {
            (AnyCurve::Numbers(a), AnyCurve::Numbers(b)) => Arc::ptr_eq(a, b),
            (AnyCurve::Plane(a), AnyCurve::Plane(b)) => Arc::ptr_eq(a, b),
            (AnyCurve::Space(a), AnyCurve::Space(b)) => Arc::ptr_eq(a, b),
            (AnyCurve::Numbers(_) | AnyCurve::Plane(_) | AnyCurve::Space(_), _) => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::Curve;

    #[test]
    fn curves_are_shared_by_threads_and_measured_once() {
        fn shareable<T: Send + Sync>(_: &T) {}
        let curve = Curve::bezier(&[DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X * 3.0], None, false);
        let curve = curve.unwrap().into_curve();
        shareable(&curve);
        let AnyCurve::Space(space) = &curve else { panic!() };
        assert!((space.length().value - 3.0).abs() < 1e-14);
        assert!(std::ptr::eq(space.lengths(), space.lengths()));
        assert!(curve.same(&curve.clone()) && curve.dimension() == 3);
    }
}
