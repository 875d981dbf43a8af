//! A ray among triangles that stand in the order of a tree: what it has met so far, leaf by leaf.

#[cfg(target_arch = "x86_64")]
mod four;
#[cfg(target_arch = "x86_64")]
mod packet;
#[cfg(target_arch = "x86_64")]
mod walked;
mod wide;

use super::Sheared;
use super::leaf::{AT_ONCE, Corners};
use crate::geometry::mesh::Mesh;
use crate::world::packet::{Members, Packet, RAYS};
use crate::world::shape::{LocalRay, Meet};
use crate::world::tree::Tree;
use glam::DVec3;
use std::ops::Range;

/// Triangles in the order of a tree.
#[derive(Clone, Copy)]
pub struct Ordered<'m> {
    /// Their corners, four by four.
    pub corners: &'m Corners,
    /// By number.
    pub mesh: &'m Mesh,
    /// The triangle at each position.
    pub order: &'m [u32],
}

impl Ordered<'_> {
    /// The corners of the triangle at a position.
    #[inline(always)]
    pub fn corners_at(&self, position: usize) -> [DVec3; 3] {
        if self.corners.are_exact() {
            return self.corners.fours[position / AT_ONCE].triangle(position % AT_ONCE);
        }
        self.mesh.triangles[self.order[position] as usize].map(|i| self.mesh.positions[i as usize])
    }

    /// The nearest meeting at a distance in (0, limit], or any, and its position in the order of this tree; of equally near ones the first triangle.
    #[inline(always)]
    pub fn nearest(self, tree: &Tree, ray: &LocalRay, limit: f64, any: bool) -> Option<(usize, Meet)> {
        wide::nearest(self, tree, ray, limit, any)
    }

    /// The nearest meetings of rays from one point, each as [`Ordered::nearest`] finds it within its limit, by number.
    #[inline]
    pub fn nearest_each(
        self,
        tree: &Tree,
        (packet, members): (&Packet, Members),
        limits: &[f64; RAYS],
        mut tell: impl FnMut(usize, usize, Meet),
    ) {
        let mut found = [Found::nothing(0.0); RAYS];
        found.iter_mut().zip(limits).for_each(|(found, limit)| found.limit = *limit);
        if wide::nearest_each(self, tree, (packet, members), limits, &mut found).is_none() {
            for i in members {
                if let Some((at, meet)) = self.nearest(tree, &packet.ray(i), limits[i], false) {
                    tell(i, at, meet);
                }
            }
            return;
        }
        for i in members {
            if let Some((at, meet)) = found[i].get() {
                tell(i, at, meet);
            }
        }
    }

    /// The same one number at a time.
    fn nearest_plain(self, tree: &Tree, ray: &LocalRay, limit: f64, any: bool) -> Option<(usize, Meet)> {
        let mut search = Search::new(self, ray, limit, any);
        if any {
            tree.traverse_any(&ray.origin, &ray.direction, limit, |range| search.goes_on(range));
        } else {
            tree.traverse(&ray.origin, &ray.direction, limit, |range, _| search.limit_after(range));
        }
        search.found.get()
    }
}

/// What was met so far. Apart and not an option, which would be written and read again as a whole.
#[derive(Clone, Copy)]
struct Found {
    /// The position, [`NOWHERE`] so far.
    at: usize,
    /// How far, or how far a meeting may be.
    limit: f64,
    a: f64,
    b: f64,
}

/// No triangle stands there.
const NOWHERE: usize = usize::MAX;

impl Found {
    #[inline(always)]
    fn nothing(limit: f64) -> Found {
        Found { at: NOWHERE, limit, a: 0.0, b: 0.0 }
    }

    #[inline(always)]
    fn is_something(&self) -> bool {
        self.at != NOWHERE
    }

    /// Takes what was met within the limit; of equally near ones the first in number.
    #[inline(always)]
    fn take(&mut self, at: usize, meet: Meet, order: &[u32]) {
        if meet.t < self.limit || !self.is_something() || order[at] < order[self.at] {
            *self = Found { at, limit: meet.t, a: meet.a, b: meet.b };
        }
    }

    /// The position, and where there.
    #[inline(always)]
    fn get(&self) -> Option<(usize, Meet)> {
        let Found { at, limit, a, b } = *self;
        self.is_something().then_some((at, Meet { t: limit, a, b, face: 0, part: 0 }))
    }
}

/// A search under way, one number at a time.
pub struct Search<'m> {
    among: Ordered<'m>,
    ray: Sheared,
    any: bool,
    found: Found,
}

impl<'m> Search<'m> {
    /// For the nearest meeting at a distance in (0, limit], or any; of equally near ones the first triangle.
    pub fn new(among: Ordered<'m>, ray: &LocalRay, limit: f64, any: bool) -> Search<'m> {
        Search { among, ray: Sheared::new(ray), any, found: Found::nothing(limit) }
    }

    /// Looks at a range of positions, as a traversal in order asks: gives the distance beyond which nothing matters, negative where nothing does.
    #[inline(always)]
    pub fn limit_after(&mut self, range: Range<usize>) -> f64 {
        if self.goes_on(range) { self.found.limit } else { -1.0 }
    }

    /// The same as a traversal without order asks: whether to go on.
    #[inline(always)]
    pub fn goes_on(&mut self, range: Range<usize>) -> bool {
        for position in range {
            let triangle = self.among.corners_at(position);
            if let Some(meet) = self.ray.meet(triangle.each_ref(), self.found.limit) {
                self.found.take(position, meet, self.among.order);
                if self.any {
                    return false;
                }
            }
        }
        true
    }
}
