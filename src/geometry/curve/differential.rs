//! Derivatives and what is made of them: tangent, normals, curvature, torsion. O'Neill, *Elementary Differential Geometry*, ch. 2.

use super::{Curve, CurveError, Piece};
use crate::math::Point;
use glam::DVec3;

/// From which side a limit is taken where a curve has none from both: at seams and cusps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From smaller parameters.
    Before,
    /// From larger parameters.
    After,
}

/// Direction of motion in the limit from a side, given γ′, γ″, γ‴ and the speed below which the curve stands still. None where
/// all three vanish.
pub(crate) fn tangent_of<P: Point>(derivatives: &[P; 3], still: f64, side: Side) -> Option<P> {
    let [velocity, acceleration, jerk] = *derivatives;
    if velocity.max_abs() > still {
        return velocity.unit();
    }
    // γ′(t ± s) = ±s γ″ + s²/2 γ‴ + …: the first that is not 0 gives the direction.
    let turn = if side == Side::After { 1.0 } else { -1.0 };
    if acceleration.max_abs() > still {
        return (acceleration * turn).unit();
    }
    jerk.unit()
}

/// The part of `v` at right angles to the unit vector `tangent`. Twice, so that the rest along it is rounding of the result.
pub(crate) fn across<P: Point>(v: P, tangent: P) -> P {
    let once = v - tangent * v.dot(tangent);
    once - tangent * once.dot(tangent)
}

/// The unit vector at right angles to `tangent` that is nearest the coordinate axis it leans on least. Zero in one dimension.
pub(crate) fn any_across<P: Point>(tangent: P) -> P {
    let least = (0..P::DIMENSION)
        .min_by(|a, b| tangent.coordinate(*a).abs().total_cmp(&tangent.coordinate(*b).abs()))
        .unwrap_or(0);
    let axis = P::from_coordinates(|i| f64::from(u8::from(i == least)));
    across(axis, tangent).unit().unwrap_or_default()
}

/// The unit vector towards the centre of curvature, given γ′, γ″, γ‴ and the unit tangent; on a straight stretch some fixed one.
pub(crate) fn normal_of<P: Point>([_, acceleration, jerk]: &[P; 3], tangent: P) -> P {
    let bent = |v: P| {
        let part = across(v, tangent);
        (part.max_abs() > 8.0 * f64::EPSILON * v.max_abs()).then(|| part.unit()).flatten()
    };
    bent(*acceleration).or_else(|| bent(*jerk)).unwrap_or_else(|| any_across(tangent))
}

/// |γ′ × γ″| / |γ′|³; 0 where the speed is no more than `still`.
pub(crate) fn curvature_of<P: Point>([velocity, acceleration, _]: &[P; 3], still: f64) -> f64 {
    let speed = velocity.length();
    if speed <= still {
        return 0.0;
    }
    across(*acceleration, *velocity / speed).length() / speed / speed
}

/// (γ′ × γ″)·γ‴ / |γ′ × γ″|²; 0 where the curvature vanishes.
pub(crate) fn torsion_of([velocity, acceleration, jerk]: &[DVec3; 3]) -> f64 {
    let (Some(v), Some(a)) = (velocity.unit(), acceleration.unit()) else { return 0.0 };
    // γ′ × γ″ = |γ′||γ″| (v × a): the lengths are taken out so that no product overflows.
    let turn = v.cross(a);
    if turn.max_abs() <= 8.0 * f64::EPSILON {
        return 0.0;
    }
    turn.dot(*jerk) / turn.length_squared() / Point::length(*velocity) / Point::length(*acceleration)
}

impl<P: Point> Curve<P> {
    /// The piece that holds t; at a seam the one on that side.
    pub(crate) fn piece_from(&self, t: f64, side: Side) -> &Piece<P> {
        let after = self.pieces.partition_point(|piece| piece.start() <= t).saturating_sub(1);
        let step_back = side == Side::Before && after > 0 && self.pieces[after].start() == t;
        &self.pieces[if step_back { after - 1 } else { after }]
    }

    /// The piece and the parameter in it, seen from a side.
    fn seen(&self, t: f64, side: Side) -> Result<(&Piece<P>, f64), CurveError> {
        let t = self.parameter(t)?;
        Ok((self.piece_from(t, side), t))
    }

    /// γ′, γ″, γ‴ at t, from the piece on that side of a seam.
    pub fn derivatives(&self, t: f64, side: Side) -> Result<[P; 3], CurveError> {
        let (piece, t) = self.seen(t, side)?;
        Ok(piece.derivatives(t))
    }

    /// γ′(t), per unit of the parameter. At a seam that of the piece after it.
    pub fn velocity(&self, t: f64) -> Result<P, CurveError> {
        let (piece, t) = self.seen(t, Side::After)?;
        Ok(piece.velocity(t))
    }

    /// γ″(t), per unit of the parameter squared. At a seam that of the piece after it.
    pub fn acceleration(&self, t: f64) -> Result<P, CurveError> {
        Ok(self.derivatives(t, Side::After)?[1])
    }

    /// Unit tangent in the limit from a side; where γ′ vanishes, along the first derivative that does not. Zero for a piece that
    /// is a point.
    pub fn tangent_from(&self, t: f64, side: Side) -> Result<P, CurveError> {
        let (piece, t) = self.seen(t, side)?;
        Ok(tangent_of(&piece.derivatives(t), piece.still(), side).unwrap_or_default())
    }

    /// Unit tangent: at seams and cusps that of the curve ahead, at the end that of the curve behind.
    pub fn tangent(&self, t: f64) -> Result<P, CurveError> {
        let side = if self.parameter(t)? == self.domain().1 { Side::Before } else { Side::After };
        self.tangent_from(t, side)
    }

    /// Principal normal: the unit vector towards the centre of curvature. On a straight stretch some fixed unit vector at right
    /// angles to the tangent; zero for a curve of numbers.
    pub fn normal(&self, t: f64) -> Result<P, CurveError> {
        let tangent = self.tangent(t)?;
        Ok(normal_of(&self.derivatives(t, Side::After)?, tangent))
    }

    /// Curvature κ(t) = |γ′ × γ″| / |γ′|³, per scene unit. 0 where γ′ vanishes.
    pub fn curvature(&self, t: f64) -> Result<f64, CurveError> {
        let (piece, t) = self.seen(t, Side::After)?;
        Ok(curvature_of(&piece.derivatives(t), piece.still()))
    }
}

impl Curve<DVec3> {
    /// Tangent × principal normal.
    pub fn binormal(&self, t: f64) -> Result<DVec3, CurveError> {
        Ok(self.tangent(t)?.cross(self.normal(t)?))
    }

    /// Torsion τ(t) = (γ′ × γ″)·γ‴ / |γ′ × γ″|², per scene unit. 0 where the curvature vanishes.
    pub fn torsion(&self, t: f64) -> Result<f64, CurveError> {
        Ok(torsion_of(&self.derivatives(t, Side::After)?))
    }
}
