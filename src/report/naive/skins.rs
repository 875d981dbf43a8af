//! Skinning as a first implementation has it: whole matrices from rest to pose, averaged, or made dual quaternions about the origin of the world.

use crate::math::Affine;
use glam::{DMat3, DQuat, DVec3};

/// Σ w·M·p.
pub fn by_matrices(motions: &[Affine], weights: &[f64], p: DVec3) -> DVec3 {
    motions.iter().zip(weights).map(|(motion, w)| motion.point(p) * *w).sum()
}

/// A normal by the averaged matrix itself, as if it did not stretch.
pub fn normal_by_matrices(motions: &[Affine], weights: &[f64], n: DVec3) -> DVec3 {
    motions.iter().zip(weights).map(|(motion, w)| motion.vector(n) * *w).sum::<DVec3>().normalize()
}

/// A rigid motion: real and dual part.
#[derive(Clone, Copy, Debug)]
pub struct Dual(DQuat, DQuat);

impl Dual {
    /// Of a matrix, whose stretch is lost.
    pub fn new(motion: &Affine) -> Dual {
        let unit = |v: DVec3| v.normalize();
        let [x, y, z] = [motion.linear.x_axis, motion.linear.y_axis, motion.linear.z_axis].map(unit);
        let turn = DQuat::from_mat3(&DMat3::from_cols(x, y, z));
        let t = motion.translation;
        Dual(turn, DQuat::from_xyzw(t.x, t.y, t.z, 0.0) * turn * 0.5)
    }
}

fn blended(motions: &[Dual], weights: &[f64]) -> Dual {
    const ZERO: DQuat = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let add = |Dual(real, dual): Dual, (motion, w): (&Dual, &f64)| {
        let w = if motion.0.dot(motions[0].0) < 0.0 { -w } else { *w };
        Dual(real + motion.0 * w, dual + motion.1 * w)
    };
    let Dual(real, dual) = motions.iter().zip(weights).fold(Dual(ZERO, ZERO), add);
    let length = real.length();
    Dual(real * (1.0 / length), dual * (1.0 / length))
}

/// A point by the averaged dual quaternion.
pub fn by_duals(motions: &[Dual], weights: &[f64], p: DVec3) -> DVec3 {
    let Dual(turn, dual) = blended(motions, weights);
    let t = dual * turn.conjugate() * 2.0;
    turn * p + DVec3::new(t.x, t.y, t.z)
}

/// A normal by it.
pub fn normal_by_duals(motions: &[Dual], weights: &[f64], n: DVec3) -> DVec3 {
    blended(motions, weights).0 * n
}
