//! Triangles in the order of a tree, as its leaves read them: corners, four triangles together, so that one test reads each number of all. It is
//! worth that where leaves begin at every fourth place and are as good as full, which the builder sees to: with 2.4 triangles in a four, one after
//! another was faster.
//!
//! The numbers are f32, half of what those of vertices take. Where every coordinate is one, as those of most binary files are, they are exact; else they are
//! measured from the middle and rounded, and propose which triangles a ray may meet; the vertices decide. Knows no tree.

use crate::math::Aabb;
use crate::world::roomy::with_room;
use glam::DVec3;

/// Triangles that are tested together: leaves that begin at multiples of it read the fewest.
pub const AT_ONCE: usize = 4;

/// Corners of triangles.
#[derive(Clone, Debug)]
pub struct Corners {
    /// Four by four.
    pub fours: Vec<Four>,
    /// What coordinates are measured from.
    pub origin: DVec3,
    /// How far a coordinate is from there at the most; 0 where all are exact, which need no bound.
    pub size: f64,
    /// How far a coordinate may be from the true one; 0 where all are exact.
    pub error: f64,
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

/// An f32 step of a number, as a share of it, at the most, and where f32 is no longer that fine. Rounding takes half of one, the
/// subtraction before it less than the rest.
const STEP: f64 = f32::EPSILON as f64;
const LEAST_STEP: f64 = f32::from_bits(1) as f64;

impl Corners {
    /// Of triangles over vertices, which are finite, in their order.
    pub fn new(vertices: &[DVec3], triangles: impl ExactSizeIterator<Item = [u32; 3]>) -> Corners {
        let n_fours = triangles.len().div_ceil(AT_ONCE);
        let mut fours = with_room(n_fours);
        fours.resize(n_fours, Four([[0.0; AT_ONCE]; 9]));
        let bounds = Aabb::of(vertices.iter().copied());
        let is_exact = |p: &DVec3| *p == p.as_vec3().as_dvec3();
        let (origin, size, error) = match vertices.iter().all(is_exact) {
            true => (DVec3::ZERO, 0.0, 0.0),
            false => {
                let (center, size) = (bounds.center(), (bounds.max - bounds.center()).max_element());
                (center, size, size * STEP + LEAST_STEP)
            }
        };
        for (i, indices) in triangles.enumerate() {
            let Four(rows) = &mut fours[i / AT_ONCE];
            for (corner, index) in indices.into_iter().enumerate() {
                let from_origin = (vertices[index as usize] - origin).as_vec3();
                for (axis, x) in from_origin.to_array().into_iter().enumerate() {
                    rows[3 * axis + corner][i % AT_ONCE] = x;
                }
            }
        }
        Corners { fours, origin, size, error }
    }

    /// True where all coordinates are those of the vertices.
    #[inline(always)]
    pub fn are_exact(&self) -> bool {
        // Not as numbers, which are asked for twice.
        self.error.to_bits() == 0
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.fours)
    }
}

impl Four {
    /// The corners of one, from their origin.
    #[inline]
    pub fn triangle(&self, lane: usize) -> [DVec3; 3] {
        let Four(rows) = self;
        let at = |row: usize| rows[row][lane].into();
        std::array::from_fn(|corner| DVec3::new(at(corner), at(3 + corner), at(6 + corner)))
    }
}
