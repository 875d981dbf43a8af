//! Rays from one point through a tree together, as those of a camera go: what a node is to all of them is found once. A ray is offered whatever it
//! would be offered alone, or more. Only where a processor tests eight rays at once: elsewhere rays go alone. One of the rooms with
//! unsafe code: there is no other way to such instructions.

#[cfg(target_arch = "x86_64")]
mod wide;

use super::Tree;
use super::entry::Entry;
use crate::world::packet::{Members, Packet, RAYS};
use std::ops::Range;

/// So many rays are tested at once.
const LANES: usize = 8;
const BLOCKS: usize = RAYS / LANES;

/// How far each ray of a packet matters, in the tree's frame.
pub struct Limits {
    entry: Entry,
    each: [[f32; LANES]; BLOCKS],
}

impl Limits {
    #[inline(always)]
    fn new(entry: Entry, t_max: &[f64; RAYS]) -> Limits {
        let mut each = [[0.0; LANES]; BLOCKS];
        for (each, t_max) in each.as_flattened_mut().iter_mut().zip(t_max) {
            *each = entry.limit(*t_max);
        }
        Limits { entry, each }
    }

    /// Beyond the distance t nothing of a ray matters any more.
    #[inline(always)]
    pub fn lower(&mut self, ray: usize, t: f64) {
        self.each.as_flattened_mut()[ray] = self.entry.limit(t);
    }
}

impl Tree {
    /// As [`Tree::traverse`] for rays from one point and a limit for each, negative for those that are no members: `leaf` is told for which of them a
    /// range is, and lowers their limits. None where each must go alone; then nothing was offered.
    #[inline(always)]
    pub(in crate::world) fn traverse_each(
        &self,
        rays: (&Packet, Members),
        t_max: &[f64; RAYS],
        leaf: impl FnMut(Range<usize>, Members, &mut Limits),
    ) -> Option<()> {
        #[cfg(target_arch = "x86_64")]
        if crate::math::vectors::has_v3() {
            // SAFETY: the processor has just been found to have what the function is compiled for.
            #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
            return unsafe { self.traverse_each_v3(rays, t_max, leaf) };
        }
        let _ = (rays, t_max, leaf);
        None
    }
}
