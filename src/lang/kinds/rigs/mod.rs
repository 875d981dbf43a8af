//! The kinds `skeleton`, `joint`, `tip` and `pose`. The kernels of [`crate::geometry::skeleton`] and [`crate::geometry::ik`] compute; here
//! are names, documentation and the wording of faults.

mod joints;
mod part;
mod poses;
mod reach;
mod skeletons;

pub use joints::{JOINT, TIP};
pub use part::Part;
pub use poses::{POSE, unknown_tip};
pub use skeletons::SKELETON;

use crate::lang::coerce::number;
use crate::lang::members;

/// Whether a joint or tip may not be called so: it would hide a value or a property of a pose.
pub fn is_reserved(name: &str) -> bool {
    let values = members::rigs::FAMILY.members.iter().map(|member| member.name);
    let properties = POSE.own.iter().map(|property| property.name);
    values.chain(properties).any(|taken| taken == name)
}

/// "-90 to 120°", or without the degree sign.
fn range(low: f64, high: f64, is_angle: bool) -> String {
    format!("{} to {}{}", number(low), number(high), if is_angle { "°" } else { "" })
}
