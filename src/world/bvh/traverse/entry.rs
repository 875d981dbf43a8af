//! Where a ray enters a tree, in the tree's frame, and the same narrowed to f32 for the test of boxes.

use super::{FRAME_SIZE, MARGIN, SLACK, WIDEN, clip_by};
use crate::world::bvh::Tree;
use crate::world::bvh::frame::round_up;
use glam::DVec3;

/// A ray where it enters a tree's bounds, in the tree's frame.
pub struct Entry {
    /// The point, each coordinate within `margin`.
    point: DVec3,
    /// 1 over each coordinate of the direction.
    inverse: DVec3,
    /// Bound on the roundings up to the point, and in an exact test of what is inside.
    margin: f64,
    /// s = (t − start)·scale: distances from the point in the frame, by distances of the ray.
    start: f64,
    scale: f64,
}

impl Entry {
    /// None where the ray misses the bounds before `t_max`. No coordinate of its direction reaches 2.
    #[inline(always)]
    pub fn new(tree: &Tree, origin: DVec3, direction: DVec3, t_max: f64) -> Option<Entry> {
        let inverse = direction.recip();
        let (start, _) = clip_by(&tree.bounds, origin, inverse, t_max)?;
        let scale = tree.frame.scale;
        let from_center = origin - tree.frame.center;
        let travelled = from_center.abs().max_element() + 2.0 * start;
        Some(Entry {
            point: (from_center + direction * start) * scale,
            inverse,
            margin: MARGIN * (travelled * scale + FRAME_SIZE),
            start,
            scale,
        })
    }

    /// A float at or beyond the distance t in the tree's frame.
    #[inline(always)]
    pub fn limit(&self, t: f64) -> f32 {
        round_up(((t - self.start) * SLACK + t * MARGIN) * self.scale * f64::from(WIDEN))
    }
}

/// Bound on what rounding the entry's point and its margin to f32, and widening by it, lose: three roundings of numbers up to 4.
const POINT_STEP: f32 = 8.0 * f32::EPSILON;

/// A ray in a tree's frame, narrowed so that it meets more boxes rather than fewer.
#[derive(Default)]
pub struct Narrow {
    /// Where the planes that the ray enters through are measured from, and those it leaves through.
    pub near_origin: [f32; 3],
    pub far_origin: [f32; 3],
    /// Of the direction; widened for the far planes.
    pub near_inverse: [f32; 3],
    pub far_inverse: [f32; 3],
    /// Which coordinates of the direction are negative, as bits.
    negative: u32,
}

impl Narrow {
    #[inline(always)]
    pub fn new(entry: &Entry) -> Narrow {
        let mut ray = Narrow::default();
        let around = entry.margin as f32 * WIDEN + POINT_STEP;
        for a in 0..3 {
            let (point, inverse) = (entry.point[a] as f32, entry.inverse[a] as f32);
            let toward = around.copysign(inverse);
            (ray.near_origin[a], ray.far_origin[a]) = (point + toward, point - toward);
            ray.negative |= u32::from(inverse.is_sign_negative()) << a;
            (ray.near_inverse[a], ray.far_inverse[a]) = (inverse, inverse * WIDEN);
        }
        ray
    }

    /// The row of a node's planes that the ray enters through along an axis, and of those it leaves through.
    #[inline(always)]
    pub fn rows(&self, axis: usize) -> (usize, usize) {
        let negative = (self.negative >> axis & 1) as usize;
        (axis + 3 * negative, axis + 3 - 3 * negative)
    }
}
