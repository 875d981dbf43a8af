//! Rays from one point, as those of a camera are: they are asked together what they meet.

use super::shape::LocalRay;
use glam::DVec3;

/// Rays of a packet, at the most.
pub const RAYS: usize = 16;

/// Which rays of a packet, as bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Members(pub u32);

impl Members {
    /// The number of the first, as long as there is one.
    #[inline(always)]
    pub fn first(self) -> usize {
        self.0.trailing_zeros() as usize % RAYS
    }

    /// Those that are among others too.
    #[inline(always)]
    pub fn among(self, others: Members) -> Members {
        Members(self.0 & others.0)
    }

    /// True where one is among them.
    #[inline(always)]
    pub fn has(self, i: usize) -> bool {
        self.0 >> i & 1 != 0
    }

    /// True where there is none.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}

impl Iterator for Members {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let first = (!self.is_empty()).then(|| self.first());
        self.0 &= self.0.wrapping_sub(1);
        first
    }
}

/// Rays from one point in some space.
#[derive(Clone, Debug)]
pub struct Packet {
    /// Where all start.
    pub origin: DVec3,
    /// x, y and z of where each goes, as of a [`LocalRay`]; what are no members go the way of one.
    pub directions: [[f64; RAYS]; 3],
    /// Which there are: one at least.
    pub members: Members,
}

impl Packet {
    /// Of rays that may be missing. None where there are none, or they start at different points.
    #[inline(always)]
    pub fn new(mut each: impl FnMut(usize) -> Option<LocalRay>) -> Option<Packet> {
        let (mut origin, mut directions, mut members) = (DVec3::ZERO, [[0.0; RAYS]; 3], Members(0));
        for i in 0..RAYS {
            let Some(ray) = each(i) else { continue };
            if members.is_empty() {
                origin = ray.origin;
                directions = ray.direction.to_array().map(|x| [x; RAYS]);
            } else if origin != ray.origin {
                return None;
            }
            let [x, y, z] = &mut directions;
            (x[i], y[i], z[i]) = ray.direction.into();
            members.0 |= 1 << i;
        }
        (!members.is_empty()).then_some(Packet { origin, directions, members })
    }

    /// One of them.
    #[inline(always)]
    pub fn ray(&self, i: usize) -> LocalRay {
        let [x, y, z] = &self.directions;
        LocalRay { origin: self.origin, direction: DVec3::new(x[i], y[i], z[i]) }
    }
}
