//! Boxes in a tree's frame. Knows no tree.

use crate::math::Aabb;
use crate::world::bvh::frame::{Frame, round_down, round_up};
use glam::DVec3;

/// A box in f32; empty where a lower coordinate is above the upper one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub lower: [f32; 3],
    pub upper: [f32; 3],
}

impl Cell {
    /// The identity of [`Cell::union`].
    pub const EMPTY: Cell = Cell { lower: [f32::INFINITY; 3], upper: [f32::NEG_INFINITY; 3] };

    /// The smallest such box around a box, rounding included.
    pub fn around(bounds: &Aabb, frame: &Frame) -> Cell {
        Cell {
            lower: frame.point(bounds.min).to_array().map(round_down),
            upper: frame.point(bounds.max).to_array().map(round_up),
        }
    }

    /// The box in the world, to an ulp of its coordinates.
    pub fn in_world(&self, frame: &Frame) -> Aabb {
        let point = |p: [f32; 3]| DVec3::from_array(p.map(f64::from)) / frame.scale + frame.center;
        Aabb { min: point(self.lower), max: point(self.upper) }
    }

    /// The smallest box around both.
    pub fn union(mut self, other: &Cell) -> Cell {
        for a in 0..3 {
            self.lower[a] = self.lower[a].min(other.lower[a]);
            self.upper[a] = self.upper[a].max(other.upper[a]);
        }
        self
    }

    /// What both share.
    pub fn common(mut self, other: &Cell) -> Cell {
        for a in 0..3 {
            self.lower[a] = self.lower[a].max(other.lower[a]);
            self.upper[a] = self.upper[a].min(other.upper[a]);
        }
        self
    }

    /// What lies below a plane and what lies above; both hold the plane.
    pub fn halves(&self, axis: usize, plane: f32) -> [Cell; 2] {
        let (mut below, mut above) = (*self, *self);
        below.upper[axis] = plane;
        above.lower[axis] = plane;
        [below, above]
    }

    pub fn is_empty(&self) -> bool {
        (0..3).any(|a| self.lower[a] > self.upper[a])
    }

    /// Half the surface area; of a box that is not empty.
    pub fn area(&self) -> f64 {
        let [x, y, z] = std::array::from_fn(|a| f64::from(self.upper[a]) - f64::from(self.lower[a]));
        x * y + y * z + z * x
    }
}
