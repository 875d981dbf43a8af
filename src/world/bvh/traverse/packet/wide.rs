//! The walk of rays of a packet, eight in an instruction. Wald, Slusallek, Benthin & Wagner, *Interactive rendering with coherent ray tracing*, 2001; a
//! node's eight children are tried against the packet as a whole first, by intervals (Boulos, Wald & Shirley, *Geometric and arithmetic culling
//! methods for entire ray packets*, 2006), and those that it meets against each ray.

use super::super::entry::{Entry, LEAST, NEAR, Rows, STEPS, rows_of};
use super::super::fetch::{fetch, nowhere};
use super::super::{Child, Node, Tree, WIDTH, take};
use super::{BLOCKS, LANES, Limits};
use crate::math::vectors::lanes::{load_8, narrow_8, store_8};
use crate::world::packet::{Members, Packet, RAYS};
use crate::world::stack::{Held, Stack};
use std::arch::x86_64::*;
use std::ops::Range;

/// Fewer rays gain nothing together.
const FEWEST: u32 = 3;

/// Entries of the stack that need no allocation; deeper ones spill.
const STACK: usize = 64;

/// A number of each ray.
type Each = [[f32; LANES]; BLOCKS];

/// A child that is still to be visited by some rays, after where the first of them may enter it.
#[derive(Clone, Copy)]
struct Pending {
    near: f32,
    child: Child,
    members: Members,
}

impl PartialEq for Pending {
    fn eq(&self, other: &Self) -> bool {
        self.near == other.near
    }
}

impl PartialOrd for Pending {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        self.near.partial_cmp(&other.near)
    }
}

impl Tree {
    /// As [`Tree::traverse_each`], for callers that are compiled for these instructions themselves: `leaf` becomes a part of it.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    pub(in crate::world) fn traverse_each_v3(
        &self,
        (packet, members): (&Packet, Members),
        t_max: &[f64; RAYS],
        mut leaf: impl FnMut(Range<usize>, Members, &mut Limits),
    ) -> Option<()> {
        // Where there are no nodes, all hangs under none.
        let framed = if self.nodes.is_empty() { None } else { Some(Framed::new(self, packet, members)?) };
        let mut limits = Limits::new(Entry::at_start(self), t_max);
        if self.bounded < self.order.len() {
            leaf(self.bounded..self.order.len(), members, &mut limits);
        }
        if let Some(framed) = framed {
            framed.walk(&self.nodes, members, &mut limits, &mut leaf);
        }
        Some(())
    }
}

/// Rays from one point, in a tree's frame.
struct Framed {
    /// Where planes are measured from, by axis: those that rays enter through, and those they leave through. Moved outward by [`STEPS`]: of an origin up to
    /// [`NEAR`], 8 in its cast and 8 in adding the margin; 10 for each of the difference, the cast of the direction, its inverse and the product.
    from: [[__m256; 3]; 2],
    /// 1 over each coordinate of the directions.
    inverse: [Each; 3],
    /// The least and the greatest of these.
    between: [[__m256; 2]; 3],
    rows: &'static Rows,
}

impl Framed {
    /// None where the rays start far off, go to different sides, or are few.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn new(tree: &Tree, packet: &Packet, members: Members) -> Option<Framed> {
        let origin = tree.frame.point(packet.origin);
        let is_near = (origin.x.abs() <= NEAR) & (origin.y.abs() <= NEAR) & (origin.z.abs() <= NEAR);
        if members.0.count_ones() < FEWEST || !is_near {
            return None;
        }
        let (sign, least, one) = (_mm256_set1_ps(-0.0), _mm256_set1_ps(LEAST), _mm256_set1_ps(1.0));
        let mut inverse = [[[0.0; LANES]; BLOCKS]; 3];
        let mut between = [[one; 2]; 3];
        let mut negative = 0;
        for a in 0..3 {
            let mut bounds = [_mm256_set1_ps(f32::INFINITY), _mm256_set1_ps(f32::NEG_INFINITY)];
            let mut signs = 0;
            let (blocks, _) = packet.directions[a].as_chunks::<LANES>();
            for (block, along) in blocks.iter().enumerate() {
                let x = narrow_8(along);
                let size = _mm256_max_ps(_mm256_andnot_ps(sign, x), least);
                let over = _mm256_div_ps(one, _mm256_or_ps(size, _mm256_and_ps(sign, x)));
                inverse[a][block] = store_8(over);
                bounds = [_mm256_min_ps(over, bounds[0]), _mm256_max_ps(over, bounds[1])];
                signs += _mm256_movemask_ps(x).count_ones();
            }
            if signs != 0 && signs != RAYS as u32 {
                return None;
            }
            negative |= u32::from(signs != 0) << a;
            between[a] = [
                across(bounds[0], |x, y| _mm256_min_ps(x, y)),
                across(bounds[1], |x, y| _mm256_max_ps(x, y)),
            ];
        }
        let from = |toward: f32| {
            let at = |a: usize| {
                let margin = if negative >> a & 1 != 0 { -toward } else { toward };
                _mm256_set1_ps(origin[a] as f32 + margin)
            };
            [at(0), at(1), at(2)]
        };
        Some(Framed { from: [from(STEPS), from(-STEPS)], inverse, between, rows: rows_of(negative) })
    }

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn walk(
        &self,
        nodes: &[Node],
        members: Members,
        limits: &mut Limits,
        leaf: &mut impl FnMut(Range<usize>, Members, &mut Limits),
    ) {
        let (mut held, mut spilled) = (Held::<_, STACK>::new(), Vec::new());
        let mut stack = Stack::on(&mut held, &mut spilled);
        let mut limit = greatest_limit(limits);
        let mut at = Pending { near: 0.0, child: Child::node(0), members };
        loop {
            if let Some(items) = at.child.items() {
                leaf(items, at.members, limits);
                limit = greatest_limit(limits);
            } else {
                let node = at.child.node_of(nodes);
                let from_planes = self.measure(node);
                let (mut met, near) = self.meets(&from_planes, limit);
                let bottom = stack.len();
                while met != 0 {
                    let slot = take(&mut met);
                    let members = at.members.among(self.who_meets(&from_planes, slot, limits));
                    if !members.is_empty() {
                        let child = node.children[slot];
                        fetch(nodes, child, nowhere(nodes));
                        stack.push_above(bottom, Pending { near: near[slot], child, members });
                    }
                }
            }
            let limit = _mm256_cvtss_f32(limit);
            let Some(next) = stack.next(|entry| entry.near <= limit) else { return };
            at = next;
        }
    }

    /// How far each plane of a node is, by axis: those that rays enter through, and those they leave through.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn measure(&self, node: &Node) -> [[[f32; WIDTH]; 3]; 2] {
        let far = |side: usize, a: usize| {
            store_8(_mm256_sub_ps(load_8(node.row(self.rows[a][side])), self.from[side][a]))
        };
        [[far(0, 0), far(0, 1), far(0, 2)], [far(1, 0), far(1, 1), far(1, 2)]]
    }

    /// Which children some ray may meet, and where the first of them may enter each.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn meets(&self, from_planes: &[[[f32; WIDTH]; 3]; 2], limit: __m256) -> (u32, [f32; WIDTH]) {
        let (mut near, mut far) = (_mm256_setzero_si256(), _mm256_castps_si256(limit));
        for a in 0..3 {
            let [least, greatest] = self.between[a];
            let (enter, leave) = (load_8(&from_planes[0][a]), load_8(&from_planes[1][a]));
            let first = _mm256_min_epi32(times(enter, least), times(enter, greatest));
            let last = _mm256_max_epi32(times(leave, least), times(leave, greatest));
            (near, far) = (_mm256_max_epi32(first, near), _mm256_min_epi32(last, far));
        }
        (less(near, far), store_8(_mm256_castsi256_ps(near)))
    }

    /// The rays that meet a child.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn who_meets(&self, from_planes: &[[[f32; WIDTH]; 3]; 2], slot: usize, limits: &Limits) -> Members {
        let plane = |side: usize, a: usize| _mm256_set1_ps(from_planes[side][a][slot]);
        let enter = [plane(0, 0), plane(0, 1), plane(0, 2)];
        let leave = [plane(1, 0), plane(1, 1), plane(1, 2)];
        let mut members = 0;
        for block in 0..BLOCKS {
            let limit = _mm256_castps_si256(load_8(&limits.each[block]));
            let (mut near, mut far) = (_mm256_setzero_si256(), limit);
            for a in 0..3 {
                let inverse = load_8(&self.inverse[a][block]);
                near = _mm256_max_epi32(times(enter[a], inverse), near);
                far = _mm256_min_epi32(times(leave[a], inverse), far);
            }
            members |= less(near, far) << (LANES * block);
        }
        Members(members)
    }
}

/// Products as whole numbers, as which distances are compared: none is NaN, and where one is below 0 it matters only that it is.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn times(x: __m256, y: __m256) -> __m256i {
    _mm256_castps_si256(_mm256_mul_ps(x, y))
}

/// Where one is less than the other, as bits.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn less(near: __m256i, far: __m256i) -> u32 {
    _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(far, near))) as u32
}

/// The farthest that any ray matters, in every lane.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn greatest_limit(limits: &Limits) -> __m256 {
    let mut most = load_8(&limits.each[0]);
    for block in 1..BLOCKS {
        most = _mm256_max_ps(load_8(&limits.each[block]), most);
    }
    across(most, |x, y| _mm256_max_ps(x, y))
}

/// What an operation that may take them in any order makes of all lanes, in every lane.
#[target_feature(enable = "avx2,bmi1,bmi2,fma")]
#[inline]
fn across(x: __m256, of: impl Fn(__m256, __m256) -> __m256) -> __m256 {
    let x = of(x, _mm256_permute2f128_ps::<1>(x, x));
    let x = of(x, _mm256_permute_ps::<0b01_00_11_10>(x));
    of(x, _mm256_permute_ps::<0b10_11_00_01>(x))
}
