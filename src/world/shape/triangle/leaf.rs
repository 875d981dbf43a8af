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

/// Four triangles, so that one instruction reads a coordinate of all: rows of one corner's coordinate, of x three, of y and of z.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Four(pub [[f32; AT_ONCE]; 9]);

/// An axis, by how many rows of a [`Four`] stand before its own.
#[derive(Clone, Copy)]
#[repr(u8)]
pub enum Axis {
    /// First.
    X = 0,
    /// After it.
    Y = 3,
    /// Last.
    Z = 6,
}

impl Axis {
    /// The two axes after one, and it. Looked up where it is needed: then it is known to be within a [`Four`].
    #[inline]
    pub fn ending_with(number: usize) -> &'static [Axis; 3] {
        use Axis::*;
        const TURNED: [[Axis; 3]; 3] = [[Y, Z, X], [Z, X, Y], [X, Y, Z]];
        &TURNED[number.min(2)]
    }
}

impl Corners {
    /// Of triangles over vertices, in their order.
    pub fn new(vertices: &[DVec3], triangles: impl ExactSizeIterator<Item = [u32; 3]>) -> Corners {
        let is_narrow = |p: &DVec3| *p == p.as_vec3().as_dvec3();
        if !vertices.iter().all(is_narrow) {
            return Corners::Shared(triangles.collect());
        }
        let mut all = vec![Four([[0.0; AT_ONCE]; 9]); triangles.len().div_ceil(AT_ONCE)];
        for (i, indices) in triangles.enumerate() {
            let Four(rows) = &mut all[i / AT_ONCE];
            for (corner, index) in indices.into_iter().enumerate() {
                for (axis, x) in vertices[index as usize].as_vec3().to_array().into_iter().enumerate() {
                    rows[3 * axis + corner][i % AT_ONCE] = x;
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
        let Four(rows) = self;
        let at = |row: usize| rows[row][lane].into();
        std::array::from_fn(|corner| DVec3::new(at(corner), at(3 + corner), at(6 + corner)))
    }
}
