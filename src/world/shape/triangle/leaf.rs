//! Triangles in the order of a tree, as its leaves read them. Knows no tree.
//!
//! Four by four, so that one test reads each number of all. It is worth that where leaves begin at every fourth place and are as good as full, which
//! the builder sees to: with 2.4 triangles in a four, one after another was faster.

use glam::DVec3;

/// Triangles that are tested together: leaves that begin at multiples of it read the fewest.
pub const AT_ONCE: usize = 4;

/// Corners of triangles.
#[derive(Clone, Debug)]
pub enum Corners {
    /// Four by four, where every coordinate is a f32.
    Narrow(Vec<Four>),
    /// By their places among the vertices.
    Shared(Vec<[u32; 3]>),
}

/// Four triangles by axis, corner and triangle, so that one instruction reads a coordinate of all.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Four(pub [[[f32; AT_ONCE]; 3]; 3]);

impl Corners {
    /// Of triangles over vertices, in their order.
    pub fn new(vertices: &[DVec3], triangles: impl ExactSizeIterator<Item = [u32; 3]>) -> Corners {
        let is_narrow = |p: &DVec3| *p == p.as_vec3().as_dvec3();
        if !vertices.iter().all(is_narrow) {
            return Corners::Shared(triangles.collect());
        }
        let mut all = vec![Four([[[0.0; AT_ONCE]; 3]; 3]); triangles.len().div_ceil(AT_ONCE)];
        for (i, indices) in triangles.enumerate() {
            let Four(rows) = &mut all[i / AT_ONCE];
            for (corner, index) in indices.into_iter().enumerate() {
                for (row, x) in rows.iter_mut().zip(vertices[index as usize].as_vec3().to_array()) {
                    row[corner][i % AT_ONCE] = x;
                }
            }
        }
        Corners::Narrow(all)
    }

    /// The corners of the triangle at a position.
    #[inline]
    pub fn at(&self, vertices: &[DVec3], position: usize) -> [DVec3; 3] {
        match self {
            Corners::Narrow(all) => all[position / AT_ONCE].triangle(position % AT_ONCE),
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
}

impl Four {
    /// The corners of one.
    #[inline]
    pub fn triangle(&self, lane: usize) -> [DVec3; 3] {
        let Four([x, y, z]) = self;
        std::array::from_fn(|i| DVec3::new(x[i][lane].into(), y[i][lane].into(), z[i][lane].into()))
    }
}
