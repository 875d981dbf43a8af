//! Triangles in the order of a tree, and the nearest of those of a leaf. Knows no tree.
//!
//! One after another, its three corners side by side. Four triangles at once, in leaves that begin at every fourth place, were as fast or up
//! to a seventh slower: of the four 2.4 were there, and two thirds more memory was read.

mod wide;

use super::Sheared;
use crate::world::shape::Meet;
use glam::DVec3;
use std::ops::Range;

/// Corners of triangles.
#[derive(Clone, Debug)]
pub enum Corners {
    /// Side by side, axis by axis, where every coordinate is a f32, with one more that is read into beyond the last.
    Narrow(Vec<[[f32; 3]; 3]>),
    /// By their places among the vertices.
    Shared(Vec<[u32; 3]>),
}

/// What is asked of the triangles of a leaf.
pub struct Asked<'r> {
    /// The ray.
    pub ray: &'r Sheared,
    /// Largest distance that counts.
    pub limit: f64,
    /// True where any will do.
    pub any: bool,
}

impl Corners {
    /// Of triangles over vertices, in their order.
    pub fn new(vertices: &[DVec3], triangles: impl Iterator<Item = [u32; 3]>) -> Corners {
        let is_narrow = |p: &DVec3| *p == p.as_vec3().as_dvec3();
        if !vertices.iter().all(is_narrow) {
            return Corners::Shared(triangles.collect());
        }
        let rows = |indices: [u32; 3]| {
            let [a, b, c] = indices.map(|i| vertices[i as usize].as_vec3());
            [[a.x, b.x, c.x], [a.y, b.y, c.y], [a.z, b.z, c.z]]
        };
        Corners::Narrow(triangles.map(rows).chain([[[0.0; 3]; 3]]).collect())
    }

    /// The corners of the triangle at a position.
    #[inline]
    pub fn at(&self, vertices: &[DVec3], position: usize) -> [DVec3; 3] {
        match self {
            Corners::Narrow(all) => {
                let [x, y, z] = &all[position];
                std::array::from_fn(|i| DVec3::new(x[i].into(), y[i].into(), z[i].into()))
            }
            Corners::Shared(all) => all[position].map(|i| vertices[i as usize]),
        }
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        match self {
            Corners::Narrow(all) => size_of_val(&**all),
            Corners::Shared(all) => size_of_val(&**all),
        }
    }

    /// The nearest meeting of a range of positions, or any, and where it is; of equally near ones that with the smallest `number`.
    #[inline]
    pub fn nearest(
        &self,
        vertices: &[DVec3],
        range: Range<usize>,
        asked: &Asked,
        number: impl Fn(usize) -> u32,
    ) -> Option<(usize, Meet)> {
        wide::nearest(self, vertices, range, asked, number)
    }
}

/// The nearest of a range by a test of each.
#[inline(always)]
fn nearest_by(
    range: Range<usize>,
    asked: &Asked,
    number: impl Fn(usize) -> u32,
    mut test: impl FnMut(usize, f64) -> Option<Meet>,
) -> Option<(usize, Meet)> {
    // Apart and not an option of a pair, which would be written and read again as a whole.
    let (mut at, mut first, mut limit, mut a, mut b) = (usize::MAX, u32::MAX, asked.limit, 0.0, 0.0);
    for position in range {
        let Some(meet) = test(position, limit) else { continue };
        let number = number(position);
        if meet.t < limit || number < first {
            (at, first, limit, a, b) = (position, number, meet.t, meet.a, meet.b);
            if asked.any {
                break;
            }
        }
    }
    (at != usize::MAX).then_some((at, Meet { t: limit, a, b, face: 0, part: 0 }))
}
