//! The search for rays from one point together: what a triangle is to all of them is found once. The same operations in the same order for
//! each as alone, so that every bit is the same.

use super::four::{FromStart, Start};
use super::{Found, Ordered};
use crate::math::vectors::lanes::{load_4, store_4};
use crate::world::bvh::{self, Limits};
use crate::world::packet::{Members, Packet, RAYS};
use crate::world::shape::triangle::AXES;
use crate::world::shape::triangle::leaf::AT_ONCE;
use std::arch::x86_64::*;
use std::ops::Range;

/// Rays in a register.
const LANES: usize = 4;

/// As [`Ordered::nearest`] for each of some rays from one point within its limit, which `found` has too. `None` where they do not go well together; then
/// nothing was done.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
pub(super) fn nearest<const EXACT: bool>(
    among: &Ordered,
    tree: &bvh::Tree,
    (packet, members): (&Packet, Members),
    limits: &[f64; RAYS],
    found: &mut [Found; RAYS],
) -> Option<()> {
    let (groups, fours) = (Group::all::<EXACT>(among, packet, members), &among.corners.fours[..]);
    let look = |range: Range<usize>, members: Members, limits: &mut Limits| {
        for at in range.start / AT_ONCE..range.end.div_ceil(AT_ONCE) {
            let real = (1 << (range.end - AT_ONCE * at).min(AT_ONCE)) - 1;
            for group in &groups {
                let members = members.among(group.members);
                if members.is_empty() {
                    continue;
                }
                let from_start = FromStart::new(&fours[at], &group.start);
                for i in members {
                    let [x, y, per_depth] = group.shear.each_ref().map(|each| each[i]);
                    let shear = [x, y].map(|x| _mm256_set1_pd(x));
                    let Some(mut within) = from_start.within::<EXACT>(shear) else { continue };
                    within.lanes &= real;
                    let ray = (|| packet.ray(i), per_depth);
                    if within.take::<EXACT, false>(among, at, ray, &mut found[i]) {
                        limits.lower(i, found[i].limit);
                    }
                }
            }
        }
    };
    tree.traverse_each_v3((packet, members), limits, look)
}

/// The rays of a packet that have the same largest axis: what [`Sheared`](super::Sheared) is to one.
struct Group {
    members: Members,
    start: Start,
    /// By number; those that are no members mean nothing.
    shear: [[f64; RAYS]; 3],
}

impl Group {
    /// The rays of a packet by their largest axis, with the roundings of a [`Sheared`](super::Sheared).
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn all<const EXACT: bool>(among: &Ordered, packet: &Packet, members: Members) -> [Group; 3] {
        let sign = _mm256_set1_pd(-0.0);
        let larger = |a, b| _mm256_cmp_pd::<_CMP_GT_OQ>(a, b);
        let (mut along_x, mut along_y) = (0, 0);
        for four in 0..RAYS / LANES {
            let [x, y, z] =
                [0, 1, 2].map(|a| _mm256_andnot_pd(sign, load_4(lanes(&packet.directions[a], four))));
            let is_x = _mm256_and_pd(larger(x, y), larger(x, z));
            let is_y = _mm256_andnot_pd(is_x, larger(y, z));
            along_x |= (_mm256_movemask_pd(is_x) as u32) << (LANES * four);
            along_y |= (_mm256_movemask_pd(is_y) as u32) << (LANES * four);
        }
        let all = [along_x, along_y, !(along_x | along_y)];
        let group =
            |axis: usize| Group::along::<EXACT>(axis, members.among(Members(all[axis])), among, packet);
        [group(0), group(1), group(2)]
    }

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn along<const EXACT: bool>(axis: usize, members: Members, among: &Ordered, packet: &Packet) -> Group {
        let axes = AXES[axis];
        let start = Start::new::<EXACT>(among.corners, &packet.origin, axes);
        let mut shear = [[0.0; RAYS]; 3];
        if !members.is_empty() {
            let along = axes.map(|axis| &packet.directions[axis]);
            for four in 0..RAYS / LANES {
                let [x, y, z] = along.map(|each| load_4(lanes(each, four)));
                let inverse = _mm256_div_pd(_mm256_set1_pd(1.0), z);
                let all = [_mm256_mul_pd(x, inverse), _mm256_mul_pd(y, inverse), inverse];
                for (each, four_of_it) in shear.iter_mut().zip(all) {
                    each[LANES * four..][..LANES].copy_from_slice(&store_4(four_of_it));
                }
            }
        }
        Group { members, start, shear }
    }
}

fn lanes(each: &[f64; RAYS], four: usize) -> &[f64; LANES] {
    &each.as_chunks().0[four]
}
