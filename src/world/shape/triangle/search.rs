//! A ray among triangles that stand in the order of a tree: what it has met so far, leaf by leaf.

use super::Sheared;
use super::leaf::{Asked, Corners};
use crate::world::shape::{LocalRay, Meet};
use crate::world::tree::Tree;
use glam::DVec3;
use std::ops::Range;

/// Triangles in the order of a tree.
#[derive(Clone, Copy)]
pub struct Ordered<'m> {
    /// Their corners.
    pub corners: &'m Corners,
    /// What those may name.
    pub vertices: &'m [DVec3],
    /// The triangle at each position.
    pub order: &'m [u32],
}

impl Ordered<'_> {
    /// The nearest meeting at a distance in (0, limit], or any, and its position in the order of this tree; of equally near ones the first triangle.
    #[inline]
    pub fn nearest(self, tree: &Tree, ray: &LocalRay, limit: f64, any: bool) -> Option<(usize, Meet)> {
        let mut search = Search::new(self, ray, limit, any);
        if any {
            tree.traverse_any(&ray.origin, &ray.direction, limit, |range| search.goes_on(range));
        } else {
            tree.traverse(&ray.origin, &ray.direction, limit, |range, _| search.limit_after(range));
        }
        search.found()
    }
}

/// A search under way.
pub struct Search<'m> {
    among: Ordered<'m>,
    ray: Sheared,
    any: bool,
    /// The position, [`NOWHERE`] so far, and where there. Apart and not an option, which would be written and read again as a whole.
    at: usize,
    limit: f64,
    a: f64,
    b: f64,
}

/// No triangle stands there.
const NOWHERE: usize = usize::MAX;

impl<'m> Search<'m> {
    /// For the nearest meeting at a distance in (0, limit], or any; of equally near ones the first triangle.
    #[inline]
    pub fn new(among: Ordered<'m>, ray: &LocalRay, limit: f64, any: bool) -> Search<'m> {
        Search { among, ray: Sheared::new(ray), any, at: NOWHERE, limit, a: 0.0, b: 0.0 }
    }

    /// Looks at a range of positions, as a traversal in order asks: gives the distance beyond which nothing matters, negative where nothing does.
    #[inline(always)]
    pub fn limit_after(&mut self, range: Range<usize>) -> f64 {
        self.look(range);
        if self.any && self.at != NOWHERE { -1.0 } else { self.limit }
    }

    /// The same as a traversal without order asks: whether to go on.
    #[inline(always)]
    pub fn goes_on(&mut self, range: Range<usize>) -> bool {
        self.look(range);
        self.at == NOWHERE
    }

    #[inline(always)]
    fn look(&mut self, range: Range<usize>) {
        let Ordered { corners, vertices, order } = self.among;
        let asked = Asked { ray: &self.ray, limit: self.limit, any: self.any };
        if let Some((at, meet)) = corners.nearest(vertices, range, &asked, |i| order[i])
            && (self.at == NOWHERE || meet.t < self.limit || order[at] < order[self.at])
        {
            (self.at, self.limit, self.a, self.b) = (at, meet.t, meet.a, meet.b);
        }
    }

    /// The position that was met, and where there.
    #[inline]
    fn found(&self) -> Option<(usize, Meet)> {
        (self.at != NOWHERE)
            .then_some((self.at, Meet { t: self.limit, a: self.a, b: self.b, face: 0, part: 0 }))
    }
}
