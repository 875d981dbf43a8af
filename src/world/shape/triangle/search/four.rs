//! The test of four triangles in the lanes of an instruction: the same operations in the same order as [`Sheared::meet`], so that every bit is the same.

use super::{Found, Ordered};
use crate::math::vectors::lanes::{store_4, widen_4};
use crate::world::bvh::fetch_entry;
use crate::world::shape::triangle::leaf::{AT_ONCE, Axis, Corners, Four};
use crate::world::shape::triangle::{Sheared, distance_by_plane, meet_inside};
use crate::world::shape::{LocalRay, Meet};
use glam::DVec3;
use std::arch::x86_64::*;

/// Three rows of numbers.
type Rows = [__m256d; 3];

/// Where rays start, as the test needs it.
#[derive(Clone, Copy)]
pub struct Start {
    /// The largest axis of their directions last.
    axes: &'static [Axis; 3],
    /// From where corners are measured, along these.
    at: Rows,
    /// How far a corner that is sheared may be from the one that decides; 0 where they are exact.
    margin: __m256d,
}

impl Start {
    /// Of rays from one point that have their largest axis in common, among corners that are `EXACT` or not.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    pub fn new<const EXACT: bool>(corners: &Corners, origin: &DVec3, axes: [usize; 3]) -> Start {
        let moved;
        let (from, margin) = match EXACT {
            true => (origin, 0.0),
            false => {
                moved = *origin - corners.origin;
                (&moved, margin(corners, moved))
            }
        };
        // Axes of a vector are told apart by branches.
        let each: &[f64; 3] = from.as_ref();
        Start {
            axes: Axis::ending_with(axes[2]),
            at: axes.map(|axis| _mm256_set1_pd(each[axis])),
            margin: _mm256_set1_pd(margin),
        }
    }
}

/// Each coordinate of a corner from the start is off by its error and by three roundings, of numbers up to `reach`; its shear is at most 1 and brings as
/// much again, and three roundings of twice that: less than 2e + 2⁻⁴⁹r, of which this is four times.
fn margin(corners: &Corners, from: DVec3) -> f64 {
    const ROUNDINGS: f64 = 4.0 / (1u64 << 49) as f64;
    let reach = from.abs().max_element() + corners.size;
    8.0 * corners.error + ROUNDINGS * reach
}

/// Corners a, b, c of four triangles from where rays start, along x, y, z.
pub struct FromStart([Rows; 3], __m256d);

impl FromStart {
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    pub fn new(four: &Four, start: &Start) -> FromStart {
        let row = |axis: usize, corner: usize| {
            _mm256_sub_pd(widen_4(&four.0[start.axes[axis] as usize + corner]), start.at[axis])
        };
        let rows = |axis: usize| [row(axis, 0), row(axis, 1), row(axis, 2)];
        FromStart([rows(0), rows(1), rows(2)], start.margin)
    }

    /// What a ray is within, by its shear in x and y; none where it is outside of all. Where corners are not `EXACT`, that may be more than it
    /// meets.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    pub fn within<const EXACT: bool>(&self, shear: [__m256d; 2]) -> Option<Within> {
        let FromStart([x, y, z], margin) = self;
        let sheared = |row: &Rows, by: __m256d| {
            let at = |corner: usize| _mm256_sub_pd(row[corner], _mm256_mul_pd(by, z[corner]));
            [at(0), at(1), at(2)]
        };
        let (x, y) = (sheared(x, shear[0]), sheared(y, shear[1]));
        let side = |p: usize, q: usize| _mm256_sub_pd(_mm256_mul_pd(x[p], y[q]), _mm256_mul_pd(y[p], x[q]));
        let (u, v, w) = (side(2, 1), side(0, 2), side(1, 0));
        // Outside where one side is below 0 and another above.
        let least = _mm256_min_pd(_mm256_min_pd(u, v), w);
        let most = _mm256_max_pd(_mm256_max_pd(u, v), w);
        let lanes = if EXACT {
            let zero = _mm256_setzero_pd();
            _mm256_or_pd(_mm256_cmp_pd::<_CMP_GE_OQ>(least, zero), _mm256_cmp_pd::<_CMP_LE_OQ>(most, zero))
        } else {
            // What is no number is within.
            let off = side_margin([x, y], *margin);
            _mm256_or_pd(
                _mm256_cmp_pd::<_CMP_NLT_UQ>(least, _mm256_sub_pd(_mm256_setzero_pd(), off)),
                _mm256_cmp_pd::<_CMP_NGT_UQ>(most, off),
            )
        };
        let lanes = _mm256_movemask_pd(lanes);
        (lanes != 0).then_some(Within { lanes, sides: [u, v, w], depths: *z })
    }
}

/// How far a side may be from the one that decides: with corners off by a quarter of the margin m and s the sum of what they are, the products are off by less than
/// (s + m / 2) · m / 2, and by four roundings of numbers below the sum times the reach, of which the margin has more than eight.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn side_margin([x, y]: [Rows; 2], margin: __m256d) -> __m256d {
    let size = |x: __m256d| _mm256_andnot_pd(_mm256_set1_pd(-0.0), x);
    let sum = |[a, b, c]: Rows| _mm256_add_pd(_mm256_add_pd(size(a), size(b)), size(c));
    _mm256_mul_pd(_mm256_add_pd(_mm256_add_pd(sum(x), sum(y)), margin), margin)
}

/// Triangles of a four that a ray is within.
pub struct Within {
    /// Their lanes, as bits.
    pub lanes: i32,
    /// The sides of their edges that it is on, u, v, w, and how deep their corners lie.
    sides: Rows,
    depths: Rows,
}

impl Within {
    /// Takes what the ray meets of them, which are the four at a place; the first that it meets, where `ANY` will do. True where there was something.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    pub fn take<const EXACT: bool, const ANY: bool>(
        self,
        among: &Ordered,
        at: usize,
        (ray, per_depth): (impl Fn() -> LocalRay, f64),
        found: &mut Found,
    ) -> bool {
        let Within { mut lanes, sides, depths } = self;
        let [u, v, w] = sides.map(|x| store_4(x));
        let [a, b, c] = depths.map(|x| store_4(x));
        let mut any = false;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & 3;
            lanes &= lanes - 1;
            let position = AT_ONCE * at + lane;
            let sides = [u[lane], v[lane], w[lane]];
            let meet = if !EXACT || sides.contains(&0.0) {
                meet_by_corners(ray(), among, position, found.limit)
            } else {
                meet_inside(per_depth, sides, [a[lane], b[lane], c[lane]], found.limit, || {
                    let (LocalRay { origin, direction }, four) = (ray(), &among.corners.fours[at]);
                    distance_by_plane(origin, direction, four.triangle(lane))
                })
            };
            if let Some(meet) = meet {
                found.take(position, meet, among.order);
                fetch_entry(among.order, position);
                if ANY {
                    return true;
                }
                any = true;
            }
        }
        any
    }
}

#[inline(never)]
fn meet_by_corners(ray: LocalRay, among: &Ordered, position: usize, limit: f64) -> Option<Meet> {
    Sheared::new(&ray).meet(among.corners_at(position).each_ref(), limit)
}
