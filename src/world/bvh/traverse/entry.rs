//! Where a ray enters a tree, in the tree's frame, and the same narrowed to f32 for the test of boxes.

use super::{FRAME_SIZE, MARGIN, SLACK, clip_by};
use crate::world::bvh::frame::round_up;
use crate::world::bvh::{Node, Row, Tree, WIDTH};
use glam::DVec3;

/// How a ray's distances are those of a tree's frame, from where it starts, or from where it enters the tree's bounds if it starts farther off.
pub struct Entry {
    /// A distance t of the ray is within t·scale − start of that point in the frame, by [`SLACK`] and [`MARGIN`] more than it is.
    scale: f64,
    start: f64,
}

/// Rays that start within this of a frame's middle along each axis need not be brought nearer.
pub const NEAR: f64 = 8.0;

/// Bound on what the slab test's roundings shift planes by, in steps of half an ulp (2⁻²⁴): of an origin up to [`NEAR`], 8 in its cast, 8 in
/// adding the margin and 8 in its product with the inverse; of a plane up to 2, 2 in its product where that is not fused; 10 of their difference for
/// each of the cast of the direction, its inverse and the sum. Then [`MARGIN`] of such distances, far below one. A power of two above 56.
pub const STEPS: f32 = 64.0 * f32::EPSILON / 2.0;

/// A margin that holds every box, small enough that no product overflows.
const MOST: f32 = (1u64 << 60) as f32;

/// Coordinates of directions below this share of the largest are taken for it: a ray is moved by that share of the way, which no f32 in the frame can tell,
/// and no product overflows.
pub const LEAST: f32 = f32::from_bits((127 - 60) << 23);

/// A ray in a tree's frame, narrowed so that it meets more boxes rather than fewer.
pub struct Narrow {
    /// 1 over each coordinate of the direction.
    pub inverse: [f32; 4],
    /// Minus that times the origin, moved outward: for planes that the ray enters through, and for those it leaves through.
    pub near: [f32; 4],
    pub far: [f32; 4],
    /// Where its planes are in a node.
    pub rows: &'static Rows,
}

/// The planes that a ray enters and leaves through in a node, by axis.
pub type Rows = [[Row; 2]; 3];

/// [`Rows`] by which coordinates of a direction are negative, as bits.
#[inline(always)]
pub fn rows_of(negative: u32) -> &'static Rows {
    // Looked up and not computed, as that would be done again at every node for want of registers.
    static ROWS: [Rows; 8] = {
        use Row::*;
        let ways = [
            [[LowerX, UpperX], [UpperX, LowerX]],
            [[LowerY, UpperY], [UpperY, LowerY]],
            [[LowerZ, UpperZ], [UpperZ, LowerZ]],
        ];
        let mut all = [[[LowerX; 2]; 3]; 8];
        let mut i = 0;
        while i < 24 {
            let (negative, axis) = (i / 3, i % 3);
            all[negative][axis] = ways[axis][negative >> axis & 1];
            i += 1;
        }
        all
    };
    &ROWS[negative as usize & 7]
}

/// A scale that makes distances longer than they are by [`SLACK`] and twice [`MARGIN`]: where a ray comes from afar products are subtracted that are rounded too.
#[inline(always)]
fn scale_and_more(scale: f64) -> f64 {
    scale * (SLACK + 2.0 * MARGIN)
}

impl Entry {
    /// Of a ray that starts within [`NEAR`].
    #[inline(always)]
    pub fn at_start(tree: &Tree) -> Entry {
        Entry { scale: scale_and_more(tree.frame.scale), start: 0.0 }
    }

    /// With the ray from there. None where it starts far off and misses the bounds before `t_max`, or starts nowhere. The largest coordinate of
    /// the direction is from ½ to 2.
    #[inline(always)]
    pub fn entered(tree: &Tree, [origin, direction]: [&DVec3; 2], t_max: f64) -> Option<(Entry, Narrow)> {
        let point = (*origin - tree.frame.center) * tree.frame.scale;
        // Not so where one is NaN.
        if (point.x.abs() <= NEAR) & (point.y.abs() <= NEAR) & (point.z.abs() <= NEAR) {
            return Some((Entry::at_start(tree), Narrow::new(point, STEPS, direction)));
        }
        Entry::from_afar(tree, origin, direction, t_max)
    }

    #[cold]
    #[inline(never)]
    fn from_afar(tree: &Tree, origin: &DVec3, direction: &DVec3, t_max: f64) -> Option<(Entry, Narrow)> {
        let (start, _) = clip_by(&tree.bounds, *origin, direction.recip(), t_max)?;
        let scale = tree.frame.scale;
        let from_center = *origin - tree.frame.center;
        let travelled = from_center.abs().max_element() + 2.0 * start;
        let point = (from_center + *direction * start) * scale;
        // It lies within the bounds, whatever was lost on the way there.
        let point = point.clamp(DVec3::splat(-NEAR), DVec3::splat(NEAR));
        let margin = round_up(MARGIN * (travelled * scale + FRAME_SIZE)).min(MOST) + STEPS;
        point.is_finite().then(|| {
            let entry = Entry { scale: scale_and_more(scale), start: (start * scale * SLACK).min(f64::MAX) };
            (entry, Narrow::new(point, margin, direction))
        })
    }

    /// A float at or beyond the distance t in the tree's frame: [`SLACK`] hides the rounding of the cast too, where a float has all its digits.
    #[inline(always)]
    pub fn limit(&self, t: f64) -> f32 {
        (t * self.scale - self.start) as f32 + f32::MIN_POSITIVE
    }
}

impl Narrow {
    /// From a point in the frame, each coordinate within a margin.
    #[inline(always)]
    fn new(point: DVec3, margin: f32, direction: &DVec3) -> Narrow {
        // Four at once: the last means nothing.
        let [x, y, z] = point.to_array().map(|x| x as f32);
        let point = [x, y, z, 0.0];
        let [x, y, z] = direction.to_array().map(|x| x as f32);
        let along = [x, y, z, 1.0];
        let inverse: [f32; 4] = std::array::from_fn(|a| 1.0 / along[a].abs().max(LEAST).copysign(along[a]));
        let toward: [f32; 4] = std::array::from_fn(|a| margin.copysign(along[a]));
        let near: [f32; 4] = std::array::from_fn(|a| -(point[a] + toward[a]) * inverse[a]);
        let far: [f32; 4] = std::array::from_fn(|a| -(point[a] - toward[a]) * inverse[a]);
        let negative = (0..3).fold(0, |bits, a| bits | (along[a].to_bits() >> 31) << a);
        Narrow { inverse, near, far, rows: rows_of(negative) }
    }

    /// A node's planes that the ray enters through along an axis, and those it leaves through.
    #[inline(always)]
    pub fn planes<'n>(&self, node: &'n Node, axis: usize) -> [&'n [f32; WIDTH]; 2] {
        self.rows[axis].map(|row| node.row(row))
    }
}
