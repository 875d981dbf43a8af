//! Whose fault a sample is that came out infinite or not a number: found by tracing it again, by the same numbers, with an eye on every surface.

use crate::scene::Rgb;
use crate::world::PrimitiveId;

/// The surface at which a sample ceased to be finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Suspect {
    /// Nobody asks.
    #[default]
    Unasked,
    /// All was finite so far.
    Sought,
    /// The first at which something was not.
    Found(PrimitiveId),
}

impl Suspect {
    /// Looks at what a sample is once a surface has done what it does to it.
    #[inline]
    pub fn look(&mut self, primitive: PrimitiveId, numbers: [Rgb; 2]) {
        if let Suspect::Sought = self
            && numbers.iter().any(|rgb| !rgb.is_finite())
        {
            *self = Suspect::Found(primitive);
        }
    }

    /// The surface, if there was one.
    pub fn found(self) -> Option<PrimitiveId> {
        if let Suspect::Found(primitive) = self { Some(primitive) } else { None }
    }
}
