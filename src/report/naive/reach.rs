//! Inverse kinematics as a textbook's first page has it: steps of the Jacobian's inverse, no cap, no limits, no way out of a saddle.

use crate::geometry::skeleton::jacobian::{Rows, of_tip};
use crate::geometry::skeleton::{Placement, Skeleton};
use crate::math::matrix::singular;

/// Singular values below this share of the largest are left out.
const RANK: f64 = 1e-12;

/// Steps of the first tip toward a point, each singular value s inverted as s/(s² + λ²); λ = 0 is the pseudo-inverse. The distance left, and
/// the steps made, at most 200.
pub fn damped(skeleton: &Skeleton, start: &[f64], target: glam::DVec3, damping: f64) -> (f64, usize) {
    let mut coordinates = start.to_vec();
    for step in 0..=200 {
        let placement = Placement::new(skeleton, &coordinates);
        let missing = target - placement.tip(skeleton, 0);
        if step == 200 || missing.length() <= 1e-12 {
            return (missing.length(), step);
        }
        let parts = singular(&of_tip(skeleton, &placement, 0, Rows::Position));
        let along = parts.u.transpose_times(&missing.to_array());
        let least = RANK * parts.values[0];
        let inverted =
            |(a, s): (&f64, &f64)| if *s > least { a * s / (s * s + damping * damping) } else { 0.0 };
        let change = parts.v.times(&along.iter().zip(&parts.values).map(inverted).collect::<Vec<f64>>());
        coordinates.iter_mut().zip(change).for_each(|(q, c)| *q += c.to_degrees());
    }
    unreachable!("the last step returns")
}
