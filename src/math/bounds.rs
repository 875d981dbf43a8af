//! Axis-aligned boxes in f64.

use glam::DVec3;

/// An axis-aligned box, closed on all sides. Empty where `min > max` on some axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lower corner.
    pub min: DVec3,
    /// Upper corner.
    pub max: DVec3,
}

impl Default for Aabb {
    fn default() -> Self {
        Aabb::EMPTY
    }
}

impl Aabb {
    /// The empty box, the identity of [`Aabb::union`].
    pub const EMPTY: Aabb = Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around points; empty for none.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Aabb {
        points.into_iter().fold(Aabb::EMPTY, Aabb::with)
    }

    /// The smallest box around this one and a point.
    #[must_use]
    pub fn with(self, p: DVec3) -> Aabb {
        Aabb { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Aabb) -> Aabb {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True where it holds no point.
    pub fn is_empty(self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Upper minus lower corner.
    pub fn size(self) -> DVec3 {
        self.max - self.min
    }

    /// The middle.
    pub fn center(self) -> DVec3 {
        self.min + (self.max - self.min) / 2.0
    }

    /// Half the surface area; 0 for the empty box.
    pub fn half_area(self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let d = self.size();
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The eight corners; meaningless for an empty box.
    pub fn corners(self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            DVec3::select(glam::BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), self.max, self.min)
        })
    }
}
