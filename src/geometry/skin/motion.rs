//! What a pose does to a bone: a stretch about the bone's place at rest, a turn about it, and a move. Kept as differences from rest, so
//! that a bone that did not move moves nothing by not one bit, however far from the origin it is.

use crate::math::Affine;
use glam::{DMat3, DQuat, DVec3};

/// The motion of a bone from its place in the bind pose to its place in a pose: p ↦ p + change·(p − pivot) + shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Where the bone is in the bind pose.
    pub pivot: DVec3,
    /// How far that place moves.
    pub shift: DVec3,
    /// Linear part less the identity.
    pub change: DMat3,
    /// The rotation of the linear part's polar decomposition, turn · stretch.
    pub turn: DQuat,
    /// The stretch less the identity, symmetric. Of a map that mirrors, the stretch is negative in all directions.
    pub stretch: DMat3,
}

/// Newton's iteration doubles the digits each time; matrices within 2^±40 of a rotation reach rounding in this many.
const POLAR_STEPS: usize = 60;

impl Motion {
    /// Of a bone by its world matrices in the bind pose and in the pose: M·B⁻¹ = I + (M − B)·B⁻¹.
    pub fn new(bind: &Affine, pose: &Affine) -> Motion {
        let change = (pose.linear - bind.linear) * bind.inverse_linear;
        let (turn, stretch) = polar(change);
        Motion { pivot: bind.translation, shift: pose.translation - bind.translation, change, turn, stretch }
    }

    /// By how much it lengthens anything at most, from above: the largest column sum of the symmetric stretch bounds its eigenvalues.
    pub fn growth(&self) -> f64 {
        let stretch = self.stretch + DMat3::IDENTITY;
        stretch.to_cols_array_2d().iter().map(|c| c.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max)
    }

    /// How far a point moves if this bone alone moves it.
    pub fn displacement(&self, p: DVec3) -> DVec3 {
        self.change * (p - self.pivot) + self.shift
    }
}

/// How far a rotation takes a vector: R·v − v, exactly 0 for no rotation.
pub fn turn_less_identity(q: DQuat, v: DVec3) -> DVec3 {
    let u = DVec3::new(q.x, q.y, q.z);
    let across = u.cross(v);
    2.0 * (q.w * across + u.cross(across))
}

/// Rotation, and stretch less the identity, of a linear map given less the identity. Higham 1986, "Computing the polar decomposition".
fn polar(change: DMat3) -> (DQuat, DMat3) {
    if change == DMat3::ZERO {
        return (DQuat::IDENTITY, DMat3::ZERO);
    }
    let map = change + DMat3::IDENTITY;
    let mut turn = if map.determinant() < 0.0 { -map } else { map };
    for _ in 0..POLAR_STEPS {
        let inverse = turn.inverse();
        if !inverse.is_finite() {
            // A bone of no volume has no rotation of its own.
            return (DQuat::IDENTITY, change);
        }
        // Scaled by norms, so that far matrices come near fast.
        let scale = (norm(inverse) / norm(turn)).sqrt();
        let next = (turn * scale + inverse.transpose() * (1.0 / scale)) * 0.5;
        let moved = norm(next - turn);
        turn = next;
        if moved <= 4.0 * f64::EPSILON * norm(turn) {
            break;
        }
    }
    let quaternion = DQuat::from_mat3(&turn).normalize();
    (quaternion, turn.transpose() * map - DMat3::IDENTITY)
}

/// Frobenius norm.
fn norm(m: DMat3) -> f64 {
    m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
}
