//! What a ray is inside of, and what that takes from the light on the way.

use crate::math::elementary::exp;
use crate::scene::Rgb;
use crate::world::bsdf::Bsdf;

/// The media that a ray is inside of, innermost last: only as many as fit; more deeply nested ones count as the last.
#[derive(Clone, Copy)]
pub(super) struct Inside {
    absorb: [Rgb; 3],
    n: usize,
}

impl Inside {
    pub(super) const NOTHING: Inside = Inside { absorb: [Rgb::ZERO; 3], n: 0 };

    /// After passing a surface, into the medium or out of it.
    pub(super) fn across(mut self, bsdf: &Bsdf) -> Inside {
        if !bsdf.outside {
            self.n = self.n.saturating_sub(1);
        } else if self.n < self.absorb.len() {
            self.absorb[self.n] = bsdf.absorb;
            self.n += 1;
        }
        self
    }

    /// Share of light left after a length that ends at a surface. What absorbs is the innermost medium, or, for a ray that meets the surface
    /// from within without having entered it, as the camera stands inside, that of the surface.
    #[inline]
    pub(super) fn left(&self, bsdf: &Bsdf, length: f64) -> Rgb {
        match self.n {
            0 if bsdf.outside || !bsdf.is_transmissive() => Rgb::ONE,
            0 => kept(bsdf.absorb, length),
            n => kept(self.absorb[n - 1], length),
        }
    }

    /// Share of light left after a length, by Beer's law. Infinite lengths leave nothing of what is absorbed at all.
    pub(super) fn kept(&self, length: f64) -> Rgb {
        match self.n {
            0 => Rgb::ONE,
            n => kept(self.absorb[n - 1], length),
        }
    }
}

/// exp(−absorb · length), 1 where nothing is absorbed.
pub(super) fn kept(absorb: Rgb, length: f64) -> Rgb {
    let channel = |a: f64| if a == 0.0 { 1.0 } else { exp(-a * length) };
    if absorb == Rgb::ZERO {
        Rgb::ONE
    } else {
        Rgb::new(channel(absorb.x), channel(absorb.y), channel(absorb.z))
    }
}
