//! Values as text; see [`crate::lang::display`].

pub use crate::lang::display::{display, interpolated as said};
