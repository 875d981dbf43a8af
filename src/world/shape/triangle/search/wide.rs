//! The search with four triangles, or the three corners of one, in the lanes of an instruction, where the processor has such: the same operations in the
//! same order as [`Sheared::meet`], so that every bit is the same, and compiled as one with the traversal around it. One of the rooms with
//! unsafe code: there is no other way to such instructions.

use super::Ordered;
use crate::world::shape::{LocalRay, Meet};
use crate::world::tree::Tree;

/// See [`Ordered::nearest`].
#[inline(always)]
pub(super) fn nearest(
    among: Ordered,
    tree: &Tree,
    ray: &LocalRay,
    limit: f64,
    any: bool,
) -> Option<(usize, Meet)> {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_v3()
        && let Tree::Bvh(tree) = tree
        && tree.is_whole()
    {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe { x86::nearest_walked(&among, tree, ray, limit, any) };
    }
    nearest_otherwise(among, tree, ray, limit, any)
}

/// The same in any tree. Apart, so that the rest becomes a part of who asks.
#[inline(never)]
fn nearest_otherwise(
    among: Ordered,
    tree: &Tree,
    ray: &LocalRay,
    limit: f64,
    any: bool,
) -> Option<(usize, Meet)> {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_v3() {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        unsafe {
            match tree {
                Tree::KdTree(tree) => return x86::nearest_walked(&among, tree, ray, limit, any),
                Tree::Bvh(tree) if tree.node_count() == 0 => {
                    return x86::nearest_walked(&among, &(0..among.order.len()), ray, limit, any);
                }
                Tree::Bvh(_) => {}
            }
        }
    }
    among.nearest_plain(tree, ray, limit, any)
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::super::Found;
    use super::super::walked::Walked;
    use super::*;
    use crate::math::vectors::lanes::{load_3, store_4, widen_4};
    use crate::world::bvh::{Stored, fetch_entry};
    use crate::world::shape::triangle::leaf::{AT_ONCE, Axis, Corners, Four};
    use crate::world::shape::triangle::{Sheared, distance_by_plane};
    use glam::DVec3;
    use std::arch::x86_64::*;
    use std::ops::Range;

    /// Three rows of numbers.
    type Rows = [__m256d; 3];

    /// # Safety
    ///
    /// The processor must have x86-64-v3.
    #[inline(always)]
    #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
    pub(super) unsafe fn nearest_walked(
        among: &Ordered,
        tree: &impl Walked,
        ray: &LocalRay,
        limit: f64,
        any: bool,
    ) -> Option<(usize, Meet)> {
        let LocalRay { origin: o, direction: d } = ray;
        // SAFETY: it has.
        unsafe { nearest(among, tree, o.x, o.y, o.z, d.x, d.y, d.z, limit, any) }
    }

    /// The ray number by number, so that it comes in registers: what has just been written so cannot be read as a whole before the cache has it.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[allow(clippy::too_many_arguments, reason = "numbers that come in registers")]
    fn nearest(
        among: &Ordered,
        tree: &impl Walked,
        x: f64,
        y: f64,
        z: f64,
        along_x: f64,
        along_y: f64,
        along_z: f64,
        limit: f64,
        any: bool,
    ) -> Option<(usize, Meet)> {
        let (origin, direction) = (DVec3::new(x, y, z), DVec3::new(along_x, along_y, along_z));
        let ray = &LocalRay { origin, direction };
        match (among.corners, any) {
            (Corners::Narrow(all), false) => nearest_narrow::<false, _>(among, all, tree, ray, limit),
            (Corners::Narrow(all), true) => nearest_narrow::<true, _>(among, all, tree, ray, limit),
            (Corners::Shared(all), false) => nearest_shared::<false, _>(among, all, tree, ray, limit),
            (Corners::Shared(all), true) => nearest_shared::<true, _>(among, all, tree, ray, limit),
        }
    }

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    fn nearest_narrow<const ANY: bool, W: Walked>(
        among: &Ordered,
        all: &[Four],
        tree: &W,
        ray: &LocalRay,
        limit: f64,
    ) -> Option<(usize, Meet)> {
        let sheared = Sheared::new(ray);
        let lanes = Lanes::of(&sheared);
        // Each four that a range touches. What else is in it are triangles too.
        let look = |found: &mut Found, range: Range<usize>| {
            for at in range.start / AT_ONCE..range.end.div_ceil(AT_ONCE) {
                let four = &all[at];
                let Some((mut within, sides, depths)) = lanes.within(four) else { continue };
                within &= lanes_of::<W>(&range, at);
                let [u, v, w] = sides.map(|x| store_4(x));
                let [a, b, c] = depths.map(|x| store_4(x));
                while within != 0 {
                    let lane = within.trailing_zeros() as usize & 3;
                    within &= within - 1;
                    let sides = [u[lane], v[lane], w[lane]];
                    let meet = if sides.contains(&0.0) {
                        meet_on_edge(*ray, four.triangle(lane), found.limit)
                    } else {
                        sheared.meet_inside(sides, [a[lane], b[lane], c[lane]], found.limit, || {
                            distance_by_plane(ray.origin, ray.direction, four.triangle(lane))
                        })
                    };
                    if let Some(meet) = meet {
                        found.take(AT_ONCE * at + lane, meet, among.order);
                        fetch_entry(among.order, AT_ONCE * at + lane);
                        if ANY {
                            return false;
                        }
                    }
                }
            }
            true
        };
        search::<ANY, W>(tree, ray, limit, Stored::of(all, AT_ONCE), look)
    }

    /// Which lanes of the four at a place belong to a range that touches it, as bits.
    #[inline(always)]
    fn lanes_of<W: Walked>(range: &Range<usize>, at: usize) -> i32 {
        let before = if W::ANYWHERE { range.start.saturating_sub(AT_ONCE * at) } else { 0 };
        (1 << (range.end - AT_ONCE * at).min(AT_ONCE)) - (1 << before)
    }

    /// A ray, each number four times.
    struct Lanes {
        start: [__m256d; 3],
        /// Of x and y.
        shear: [__m256d; 2],
        axes: &'static [Axis; 3],
    }

    impl Lanes {
        #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
        #[inline]
        fn of(ray: &Sheared) -> Lanes {
            let [x, y, _] = ray.shear;
            Lanes {
                start: ray.start.map(|x| _mm256_set1_pd(x)),
                shear: [x, y].map(|x| _mm256_set1_pd(x)),
                axes: Axis::ending_with(ray.axes[2]),
            }
        }

        /// The lanes of those triangles that the ray is within, as bits, the sides of their edges that it is on, u, v, w, and how deep their corners
        /// lie. Where a side is 0, exact numbers tell. None where it is outside of all.
        #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
        #[inline]
        fn within(&self, four: &Four) -> Option<(i32, Rows, Rows)> {
            let row = |axis: usize, corner: usize| {
                _mm256_sub_pd(widen_4(&four.0[self.axes[axis] as usize + corner]), self.start[axis])
            };
            let z = [row(2, 0), row(2, 1), row(2, 2)];
            let sheared = |axis: usize, corner: usize| {
                _mm256_sub_pd(row(axis, corner), _mm256_mul_pd(self.shear[axis], z[corner]))
            };
            let x = [sheared(0, 0), sheared(0, 1), sheared(0, 2)];
            let y = [sheared(1, 0), sheared(1, 1), sheared(1, 2)];
            let side =
                |p: usize, q: usize| _mm256_sub_pd(_mm256_mul_pd(x[p], y[q]), _mm256_mul_pd(y[p], x[q]));
            let (u, v, w) = (side(2, 1), side(0, 2), side(1, 0));
            // Outside where one side is below 0 and another above.
            let least = _mm256_min_pd(_mm256_min_pd(u, v), w);
            let most = _mm256_max_pd(_mm256_max_pd(u, v), w);
            let zero = _mm256_setzero_pd();
            let within = _mm256_movemask_pd(_mm256_or_pd(
                _mm256_cmp_pd::<_CMP_GE_OQ>(least, zero),
                _mm256_cmp_pd::<_CMP_LE_OQ>(most, zero),
            ));
            (within != 0).then_some((within, [u, v, w], z))
        }
    }

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    fn nearest_shared<const ANY: bool, W: Walked>(
        among: &Ordered,
        all: &[[u32; 3]],
        tree: &W,
        ray: &LocalRay,
        limit: f64,
    ) -> Option<(usize, Meet)> {
        let sheared = Sheared::new(ray);
        let [x, y, z] = sheared.axes.map(|axis| 2 * axis as i32);
        let order = _mm256_setr_epi32(x, x + 1, y, y + 1, z, z + 1, 6, 7);
        let turned = |v: &DVec3| {
            let v = _mm256_castpd_ps(load_3(v.as_ref()));
            _mm256_castps_pd(_mm256_permutevar8x32_ps(v, order))
        };
        let [start_x, start_y, start_z] = sheared.start;
        let origin = _mm256_setr_pd(start_x, start_y, start_z, 0.0);
        let look = |found: &mut Found, range: Range<usize>| {
            for position in range {
                let places = all[position].map(|i| &among.vertices[i as usize]);
                let at = |i: usize| _mm256_sub_pd(turned(places[i]), origin);
                let rows = transposed(at(0), at(1), at(2));
                let limit = if ANY { limit } else { found.limit };
                if let Some(meet) = meet(ray, &sheared, rows, limit, || places.map(|p| *p)) {
                    found.take(position, meet, among.order);
                    if ANY {
                        return false;
                    }
                }
            }
            true
        };
        search::<ANY, W>(tree, ray, limit, Stored::NOWHERE, look)
    }

    /// The search by a look at what is in a range, which says whether to go on.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn search<const ANY: bool, W: Walked>(
        tree: &W,
        ray: &LocalRay,
        limit: f64,
        stored: Stored,
        look: impl Fn(&mut Found, Range<usize>) -> bool,
    ) -> Option<(usize, Meet)> {
        let mut found = Found::nothing(limit);
        // SAFETY: this function is compiled for the same instructions.
        #[allow(unsafe_code, reason = "a trait has no other functions for some processors")]
        unsafe {
            tree.walk::<ANY>(ray, stored, &mut found, look);
        }
        found.get()
    }

    /// Rows of the columns a, b, c. The last lane means nothing.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn transposed(a: __m256d, b: __m256d, c: __m256d) -> Rows {
        let (xz, y) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let c_y = _mm256_castpd256_pd128(_mm256_permute_pd::<5>(c));
        [
            _mm256_insertf128_pd::<1>(xz, _mm256_castpd256_pd128(c)),
            _mm256_insertf128_pd::<1>(y, c_y),
            _mm256_permute2f128_pd::<0x31>(xz, c),
        ]
    }

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn meet(
        ray: &LocalRay,
        sheared: &Sheared,
        [x, y, z]: Rows,
        limit: f64,
        corners: impl Fn() -> [DVec3; 3],
    ) -> Option<Meet> {
        let x = _mm256_sub_pd(x, _mm256_mul_pd(_mm256_set1_pd(sheared.shear[0]), z));
        let y = _mm256_sub_pd(y, _mm256_mul_pd(_mm256_set1_pd(sheared.shear[1]), z));
        // u, v, w of c a b and b c a.
        const CAB: i32 = 0b11_01_00_10;
        const BCA: i32 = 0b11_00_10_01;
        let one = _mm256_mul_pd(_mm256_permute4x64_pd::<CAB>(x), _mm256_permute4x64_pd::<BCA>(y));
        let other = _mm256_mul_pd(_mm256_permute4x64_pd::<CAB>(y), _mm256_permute4x64_pd::<BCA>(x));
        let sides = _mm256_sub_pd(one, other);
        let on_edge = _mm256_cmp_pd::<_CMP_EQ_OQ>(sides, _mm256_setzero_pd());
        if _mm256_movemask_pd(on_edge) & 7 != 0 {
            return meet_on_edge(*ray, corners(), limit);
        }
        // All or none: 7 and 0, which follow each other.
        if (_mm256_movemask_pd(sides) + 1) & 7 > 1 {
            return None;
        }
        let ([u, v, w, _], [a, b, c, _]) = (store_4(sides), store_4(z));
        sheared.meet_inside([u, v, w], [a, b, c], limit, || {
            distance_by_plane(ray.origin, ray.direction, corners())
        })
    }

    #[cold]
    fn meet_on_edge(ray: LocalRay, corners: [DVec3; 3], limit: f64) -> Option<Meet> {
        Sheared::new(&ray).meet(corners.each_ref(), limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use crate::scene::Accelerator;
    use crate::world::shape::triangle::leaf::Corners;
    use crate::world::shape::triangle::{bounds_of, cut};
    use glam::DVec3;

    /// Ten triangles with corners in common, where every coordinate is a float in a quarter of all rounds, and a ray at one of them. On a coarse grid,
    /// so that rays go through corners and edges and along planes; and anywhere.
    fn triangles(round: usize, random: &mut Random) -> (Vec<DVec3>, Option<LocalRay>) {
        let steps = if round.is_multiple_of(2) { 8.0 } else { 1e9 };
        let odd = if round % 4 < 2 { DVec3::ZERO } else { DVec3::splat(1.0 / 3.0) };
        let mut point =
            || DVec3::from_array(std::array::from_fn(|_| (random.unit() * steps).floor() / 4.0)) + odd;
        let vertices: Vec<DVec3> = (0..12).map(|_| point()).collect();
        let (from, to) = (point(), vertices[round % 12]);
        let inside = (to + vertices[(round + 1) % 12] + vertices[(round + 2) % 12]) / 3.0;
        let ray = LocalRay::new(from, if round.is_multiple_of(3) { to } else { inside } - from);
        (vertices, ray.map(|(ray, _)| ray))
    }

    fn corners(round: usize, vertices: &[DVec3], order: &[u32]) -> Corners {
        let corners = Corners::new(vertices, order.iter().map(|&i| [i, i + 1, i + 2]));
        assert_eq!(matches!(corners, Corners::Narrow(_)), round.is_multiple_of(4), "round {round}");
        corners
    }

    fn bits(met: Option<(usize, Meet)>) -> Option<(usize, [u64; 3])> {
        met.map(|(at, m)| (at, [m.t, m.a, m.b].map(f64::to_bits)))
    }

    #[test]
    fn lanes_find_the_same_bits_as_plain_operations() {
        for accelerator in [Accelerator::Bvh, Accelerator::KdTree, Accelerator::None] {
            let mut random = Random::new(11);
            let mut n_met = 0;
            for round in 0..4000 {
                let (vertices, Some(ray)) = triangles(round, &mut random) else { continue };
                let of = |i: usize| [vertices[i], vertices[i + 1], vertices[i + 2]];
                let tree = Tree::build_of_triangles(
                    accelerator,
                    10,
                    |i| bounds_of(of(i)),
                    |i, cell| cut::cut(of(i), cell),
                );
                let corners = &corners(round, &vertices, tree.order());
                let among = Ordered { corners, vertices: &vertices, order: tree.order() };
                for any in [false, true] {
                    let plain = bits(among.nearest_plain(&tree, &ray, f64::MAX, any));
                    let wide = bits(among.nearest(&tree, &ray, f64::MAX, any));
                    assert_eq!(wide, plain, "{accelerator:?}, round {round}");
                    n_met += usize::from(plain.is_some());
                }
            }
            assert!(n_met > 3000, "{n_met}");
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn ranges_begin_and_end_anywhere() {
        if !crate::math::vectors::has_v3() {
            return;
        }
        let (mut random, mut n_met) = (Random::new(12), 0);
        for round in 0..4000 {
            let (vertices, Some(ray)) = triangles(round, &mut random) else { continue };
            let order: Vec<u32> = (0..10).rev().collect();
            let corners = &corners(round, &vertices, &order);
            let among = Ordered { corners, vertices: &vertices, order: &order };
            let range = (random.unit() * 10.0) as usize..10;
            let range = range.start..range.end.min(range.start + 1 + (random.unit() * 5.0) as usize);
            for any in [false, true] {
                let mut search = super::super::Search::new(among, &ray, f64::MAX, any);
                search.goes_on(range.clone());
                let plain = bits(search.found.get());
                // SAFETY: the processor has just been found to have what the function is compiled for.
                #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
                let wide = unsafe { x86::nearest_walked(&among, &range, &ray, f64::MAX, any) };
                assert_eq!(bits(wide), plain, "round {round}, {range:?}");
                n_met += usize::from(plain.is_some());
            }
        }
        assert!(n_met > 1000, "{n_met}");
    }
}
