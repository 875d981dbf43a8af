//! How a point of a skeleton moves with the coordinates: the geometric Jacobian. A turn moves it by axis × (point − pivot), a move by
//! its axis; there is no difference quotient.

use super::forward::Placement;
use super::{Skeleton, Turning};
use crate::math::matrix::Matrix;
use glam::DVec3;

/// How many rows: where the point goes, or that and how its frame turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// 3: the point's velocity.
    Position,
    /// 6: the point's velocity, then its frame's angular velocity.
    PositionAndTurn,
}

/// The Jacobian at a point of the world that moves with a joint: 3 × n or 6 × n, a column for each coordinate of the skeleton, per
/// radian of a turn and per scene unit of a move; 0 for coordinates that do not move it. Angular velocities are in radians about the
/// world's axes.
pub fn jacobian(
    skeleton: &Skeleton,
    placement: &Placement,
    joint: usize,
    point: DVec3,
    rows: Rows,
) -> Matrix {
    let n_rows = match rows {
        Rows::Position => 3,
        Rows::PositionAndTurn => 6,
    };
    let mut result = Matrix::zeros(n_rows, skeleton.rest().len());
    for joint in skeleton.chain(joint) {
        for k in skeleton.joints()[joint].motions() {
            let (motion, screw) = (skeleton.motions()[k], placement.screws[k]);
            let (velocity, angular) = match motion.turning {
                Turning::Turn => (screw.axis.cross(point - screw.pivot), screw.axis),
                Turning::Move => (screw.axis, DVec3::ZERO),
            };
            for i in 0..n_rows {
                result[(i, motion.coordinate)] = if i < 3 { velocity[i] } else { angular[i - 3] };
            }
        }
    }
    result
}

/// The Jacobian at a tip.
pub fn of_tip(skeleton: &Skeleton, placement: &Placement, tip: usize, rows: Rows) -> Matrix {
    let joint = skeleton.tips()[tip].joint;
    jacobian(skeleton, placement, joint, placement.tip(skeleton, tip), rows)
}
