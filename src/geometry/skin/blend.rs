//! Where a point goes that several bones move. Linear blending averages the places (and shrinks a twist by half an angle α to cos(α/2));
//! dual quaternions average the rigid motions (and keep a twist's radius), after the stretches were blended linearly about each bone.
//! Source: Kavan, Collins, Žára, O'Sullivan 2008, "Geometric skinning with approximate dual quaternion blending".

use super::Motion;
use super::motion::turn_less_identity;
use glam::{DMat3, DQuat, DVec3};

/// How the motions of several bones are mixed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// Places are averaged.
    #[default]
    Linear,
    /// Rigid motions are averaged, the shorter way round from the bone of most weight.
    DualQuaternion,
}

/// Where a point went, and what its surroundings did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// The point.
    pub point: DVec3,
    turn: DQuat,
    change: DMat3,
}

impl Moved {
    /// A unit normal as the surface at the point has it now: by the cofactors of the blended matrix, which stretches and mirrors may
    /// make other than the matrix itself. A surface pressed flat keeps its normal.
    pub fn normal(&self, n: DVec3) -> DVec3 {
        let pressed =
            if self.change == DMat3::ZERO { n } else { cofactors(self.change + DMat3::IDENTITY) * n };
        let turned = pressed + turn_less_identity(self.turn, pressed);
        if turned == n { n } else { turned.try_normalize().unwrap_or(n) }
    }
}

impl Blend {
    /// Moves a point by the bones `influences` names with their weights, which add up to 1 and are not negative. No bones: it stays.
    pub fn apply(self, motions: &[Motion], influences: (&[u16], &[f64]), p: DVec3) -> Moved {
        match self {
            Blend::Linear => linear(motions, influences, p),
            Blend::DualQuaternion => dual_quaternion(motions, influences, p),
        }
    }
}

fn linear(motions: &[Motion], (bones, weights): (&[u16], &[f64]), p: DVec3) -> Moved {
    let (mut by, mut change) = (DVec3::ZERO, DMat3::ZERO);
    for (bone, w) in bones.iter().zip(weights) {
        let motion = &motions[usize::from(*bone)];
        by += motion.displacement(p) * *w;
        change += motion.change * *w;
    }
    Moved { point: p + by, turn: DQuat::IDENTITY, change }
}

/// Rigid motions are taken about the place of the bone of most weight, whose rotation also says which of q and −q is meant.
fn dual_quaternion(motions: &[Motion], (bones, weights): (&[u16], &[f64]), p: DVec3) -> Moved {
    let most = bones.iter().zip(weights).reduce(|a, b| if b.1 > a.1 { b } else { a });
    let Some((most, _)) = most else {
        return Moved { point: p, turn: DQuat::IDENTITY, change: DMat3::ZERO };
    };
    let lead = &motions[usize::from(*most)];
    let (mut real, mut dual) = (ZERO, ZERO);
    let (mut by, mut change) = (DVec3::ZERO, DMat3::ZERO);
    for (bone, w) in bones.iter().zip(weights) {
        let motion = &motions[usize::from(*bone)];
        let sign = if motion.turn.dot(lead.turn) < 0.0 { -w } else { *w };
        let shift = turn_less_identity(motion.turn, lead.pivot - motion.pivot) + motion.shift;
        real += motion.turn * sign;
        dual += (DQuat::from_xyzw(shift.x, shift.y, shift.z, 0.0) * motion.turn) * sign;
        by += motion.stretch * (p - motion.pivot) * *w;
        change += motion.stretch * *w;
    }
    let length = real.length();
    let (turn, dual) = (real * (1.0 / length), dual * (1.0 / length));
    let shift = dual * turn.conjugate();
    let stretched = p + by;
    let turned = turn_less_identity(turn, stretched - lead.pivot);
    Moved { point: stretched + (turned + DVec3::new(shift.x, shift.y, shift.z)), turn, change }
}

const ZERO: DQuat = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);

/// det(m)·m⁻ᵀ, which is there for singular matrices too.
fn cofactors(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}
