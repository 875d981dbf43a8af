//! What photons no longer leave or come to: lamps and materials with a function that runs too long. Each photon there would run it until its guard says
//! no, and bring nothing. Knows nothing of how photons are followed.
//!
//! A function without an end is known by the first few photons; one that seldom fails to end is borne with, so that the light of all other places
//! is kept.

use crate::math::field::FaultKind;
use crate::world::Hit;
use crate::world::texture::TextureFault;
use std::collections::HashSet;

/// A lamp or a material, by its address: it is only asked whether two are the same, so that addresses leave no trace in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Owner(usize);

impl Owner {
    /// Of a function: a lamp or a material.
    pub fn of<T>(thing: &T) -> Owner {
        Owner(std::ptr::from_ref(thing).addr())
    }
}

/// Why a photon ended where it should have been sent on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lost {
    /// Something has no value there.
    Undefined,
    /// A function of this ran too long.
    TooLong(Owner),
}

impl Lost {
    /// At something of which a function has no value.
    pub fn of(owner: Owner, fault: TextureFault) -> Lost {
        if fault.kind == FaultKind::TooManyTurns { Lost::TooLong(owner) } else { Lost::Undefined }
    }

    /// At a hit, since something has no value there. A function that makes the surface itself has run before its material could be left alone.
    pub fn at(hit: &Hit<'_>, fault: TextureFault) -> Lost {
        match hit.fault {
            None => Lost::of(Owner::of(hit.material()), fault),
            Some(_) => Lost::Undefined,
        }
    }

    /// Whose function ran too long, if one did.
    pub fn too_long(self) -> Option<Owner> {
        if let Lost::TooLong(owner) = self { Some(owner) } else { None }
    }
}

/// The lamps and materials that are given up.
#[derive(Clone, Debug, Default)]
pub struct GivenUp(HashSet<Owner>);

/// As few photons as this tell nothing.
const FEWEST: usize = 4;

/// One path of so many may end so. Guards let a function take about two milliseconds: less than ten microseconds a path are lost then, and a third of a
/// second for the 37,000 of a picture of one sample.
const SHARE: usize = 1 << 8;

impl GivenUp {
    /// Whether photons neither leave it nor go on from it.
    #[inline]
    pub fn has<T>(&self, thing: &T) -> bool {
        !self.0.is_empty() && self.0.contains(&Owner::of(thing))
    }

    /// Takes note of the photons that were lost of so many paths: where these are too many, all that they were lost at is given up, as each of
    /// a thousand materials may be met seldom.
    pub fn learn(&mut self, lost: &[Owner], paths: usize) {
        if are_many(lost.len(), paths) {
            self.0.extend(lost);
        }
    }
}

/// Whether too many were lost of some paths.
pub fn are_many(lost: usize, paths: usize) -> bool {
    lost >= FEWEST.max(paths / SHARE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{SourceId, Span};
    use crate::scene::{Material, Texture};

    const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };

    fn material() -> Material {
        Material { diffuse: Texture::ZERO, layers: None, span: SPAN }
    }

    #[test]
    fn what_runs_too_long_in_many_photons_is_given_up_and_nothing_else_is() {
        let (slow, other) = (material(), material());
        for (n, paths, is_many) in [(3, 3, false), (4, 4, true), (4, 1024, true), (15, 4096, false)] {
            let mut given_up = GivenUp::default();
            given_up.learn(&vec![Owner::of(&slow); n], paths);
            assert_eq!([given_up.has(&slow), given_up.has(&other)], [is_many, false], "{n} of {paths}");
        }
    }
}
