//! The test of a node's children, and the traversal around it, compiled for what the processor has: how many children one instruction
//! tests differs, and by half an ulp where a ray meets a box, which margins cover. So which boxes are opened in vain may differ, and what is
//! found inside never does. Knows nothing of what is traversed. One of the rooms with unsafe code: there is no other way to such
//! instructions.

use super::entry::{Entry, Narrow};
use super::{Met, Node, Tree, WIDTH};
use glam::DVec3;
use std::ops::Range;

/// [`super::walk`] with the widest instructions that there are.
#[inline(always)]
pub(super) fn walk(
    tree: &Tree,
    ray: [&DVec3; 2],
    t_max: f64,
    leaf: (&mut impl FnMut(Range<usize>, f64) -> f64, impl Fn(usize) -> *const i8),
) {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_v3() {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe {
            let [o, d] = ray;
            x86::walk(tree, o.x, o.y, o.z, d.x, d.y, d.z, t_max, leaf)
        };
    }
    if let Some((entry, narrow)) = Entry::entered(tree, ray, t_max) {
        super::walk(tree, entry, t_max, (|limit| limit, |node, limit| meets(&narrow, node, limit)), leaf);
    }
}

/// [`super::walk_any`] with the widest instructions that there are.
#[inline(always)]
pub(super) fn walk_any(
    tree: &Tree,
    ray: [&DVec3; 2],
    t_max: f64,
    leaf: (&mut impl FnMut(Range<usize>) -> bool, impl Fn(usize) -> *const i8),
) {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_v3() {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe {
            let [o, d] = ray;
            x86::walk_any(tree, o.x, o.y, o.z, d.x, d.y, d.z, t_max, leaf)
        };
    }
    if let Some((entry, narrow)) = Entry::entered(tree, ray, t_max) {
        super::walk_any(tree, entry, t_max, (|limit| limit, |node, limit| meets(&narrow, node, limit)), leaf);
    }
}

/// The test by plain operations.
#[inline(always)]
pub(super) fn meets(ray: &Narrow, node: &Node, limit: f32) -> Met {
    meets_by(ray, node, limit, |plane, inverse, start| plane * inverse + start)
}

/// The test by operations that every machine has and that round as the widest do.
#[inline(always)]
pub(super) fn meets_fused(ray: &Narrow, node: &Node, limit: f32) -> Met {
    meets_by(ray, node, limit, |plane, inverse, start| plane.mul_add(inverse, start))
}

#[inline(always)]
fn meets_by(ray: &Narrow, node: &Node, limit: f32, at: impl Fn(f32, f32, f32) -> f32) -> Met {
    let (mut near, mut far) = ([0.0f32; WIDTH], [limit; WIDTH]);
    for a in 0..3 {
        let [enter, leave] = ray.planes(node, a);
        for i in 0..WIDTH {
            let x = at(enter[i], ray.inverse[a], ray.near[a]);
            near[i] = if x > near[i] { x } else { near[i] };
            let y = at(leave[i], ray.inverse[a], ray.far[a]);
            far[i] = if y < far[i] { y } else { far[i] };
        }
    }
    let mask = (0..WIDTH).fold(0, |mask, i| mask | u32::from(near[i] < far[i]) << i);
    (mask, near)
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::super::entry::{LEAST, NEAR, Rows, STEPS, rows_of};
    use super::*;
    use crate::math::vectors::lanes::{load_8, store_8};
    use crate::world::bvh::frame::Frame;
    use std::arch::x86_64::*;

    impl Tree {
        /// [`Tree::traverse`] of a tree that is [whole](Tree::is_whole), for callers that are compiled for these instructions themselves: `leaf` becomes a
        /// part of it, and what both need stays in registers. `ahead` says where the items from a position on lie.
        #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
        #[inline]
        pub(in crate::world) fn traverse_v3(
            &self,
            origin: DVec3,
            direction: DVec3,
            t_max: f64,
            (mut leaf, ahead): (impl FnMut(Range<usize>, f64) -> f64, impl Fn(usize) -> *const i8),
        ) {
            if t_max >= 0.0 {
                walk_v3(self, [origin, direction], t_max, (&mut leaf, ahead));
            }
        }

        /// [`Tree::traverse_any`], so.
        #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
        #[inline]
        pub(in crate::world) fn traverse_any_v3(
            &self,
            origin: DVec3,
            direction: DVec3,
            t_max: f64,
            (mut leaf, ahead): (impl FnMut(Range<usize>) -> bool, impl Fn(usize) -> *const i8),
        ) {
            if t_max >= 0.0 {
                walk_any_v3(self, [origin, direction], t_max, (&mut leaf, ahead));
            }
        }
    }

    /// The ray number by number, so that it comes in registers: what has just been written so cannot be read as a whole before the cache has it.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[allow(clippy::too_many_arguments, reason = "numbers that come in registers")]
    pub(super) fn walk(
        tree: &Tree,
        x: f64,
        y: f64,
        z: f64,
        along_x: f64,
        along_y: f64,
        along_z: f64,
        t_max: f64,
        leaf: (&mut impl FnMut(Range<usize>, f64) -> f64, impl Fn(usize) -> *const i8),
    ) {
        let ray = [DVec3::new(x, y, z), DVec3::new(along_x, along_y, along_z)];
        walk_v3(tree, ray, t_max, leaf);
    }

    /// The same in no order.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[allow(clippy::too_many_arguments, reason = "numbers that come in registers")]
    pub(super) fn walk_any(
        tree: &Tree,
        x: f64,
        y: f64,
        z: f64,
        along_x: f64,
        along_y: f64,
        along_z: f64,
        t_max: f64,
        leaf: (&mut impl FnMut(Range<usize>) -> bool, impl Fn(usize) -> *const i8),
    ) {
        let ray = [DVec3::new(x, y, z), DVec3::new(along_x, along_y, along_z)];
        walk_any_v3(tree, ray, t_max, leaf);
    }

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn walk_v3(
        tree: &Tree,
        ray: [DVec3; 2],
        t_max: f64,
        leaf: (&mut impl FnMut(Range<usize>, f64) -> f64, impl Fn(usize) -> *const i8),
    ) {
        let Some((entry, narrow)) = entered(tree, ray, t_max) else { return };
        let limit_of = |limit| _mm256_castps_si256(_mm256_set1_ps(limit));
        super::super::walk(tree, entry, t_max, (limit_of, |node, limit| narrow.meets(node, limit)), leaf);
    }

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn walk_any_v3(
        tree: &Tree,
        ray: [DVec3; 2],
        t_max: f64,
        leaf: (&mut impl FnMut(Range<usize>) -> bool, impl Fn(usize) -> *const i8),
    ) {
        let Some((entry, narrow)) = entered(tree, ray, t_max) else { return };
        let limit_of = |limit| _mm256_castps_si256(_mm256_set1_ps(limit));
        super::super::walk_any(tree, entry, t_max, (limit_of, |node, limit| narrow.meets(node, limit)), leaf);
    }

    /// [`Narrow`], each number eight times.
    struct Wide {
        inverse: [__m256; 3],
        near: [__m256; 3],
        far: [__m256; 3],
        rows: &'static Rows,
    }

    /// [`Entry::entered`], all coordinates at once, with the same roundings.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn entered(tree: &Tree, [origin, direction]: [DVec3; 2], t_max: f64) -> Option<(Entry, Wide)> {
        let four = |v: DVec3, rest: f64| _mm256_setr_pd(v.x, v.y, v.z, rest);
        // The fourth numbers mean nothing. What stands after the center is read with it.
        let Frame { center, scale } = tree.frame;
        let from_center = _mm256_sub_pd(four(origin, 0.0), four(center, scale));
        let point = _mm256_mul_pd(from_center, _mm256_set1_pd(scale));
        let size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), point);
        let is_far = _mm256_cmp_pd::<_CMP_NLE_UQ>(size, _mm256_set1_pd(NEAR));
        if _mm256_movemask_pd(is_far) & 0b111 != 0 {
            let (entry, narrow) = from_afar(tree, [origin, direction], t_max)?;
            return Some((entry, Wide::of(&narrow)));
        }
        let (sign, least, margin) = (_mm_set1_ps(-0.0), _mm_set1_ps(LEAST), _mm_set1_ps(STEPS));
        let (from, along) = (_mm256_cvtpd_ps(point), _mm256_cvtpd_ps(four(direction, 0.0)));
        let signs = _mm_and_ps(sign, along);
        let size = _mm_max_ps(_mm_andnot_ps(sign, along), least);
        let inverse = _mm_div_ps(_mm_set1_ps(1.0), _mm_or_ps(size, signs));
        let toward = _mm_or_ps(margin, signs);
        let negated = _mm_xor_ps(inverse, sign);
        let near = _mm_mul_ps(_mm_add_ps(from, toward), negated);
        let far = _mm_mul_ps(_mm_sub_ps(from, toward), negated);
        let rows = rows_of(_mm_movemask_ps(along) as u32);
        let wide = Wide { inverse: spread(inverse), near: spread(near), far: spread(far), rows };
        Some((Entry::at_start(tree), wide))
    }

    /// The first three numbers, each eight times.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    fn spread(x: __m128) -> [__m256; 3] {
        [
            _mm256_broadcastss_ps(x),
            _mm256_broadcastss_ps(_mm_movehdup_ps(x)),
            _mm256_broadcastss_ps(_mm_movehl_ps(x, x)),
        ]
    }

    #[cold]
    #[inline(never)]
    fn from_afar(tree: &Tree, ray: [DVec3; 2], t_max: f64) -> Option<(Entry, Narrow)> {
        Entry::entered(tree, ray.each_ref(), t_max)
    }

    impl Wide {
        #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
        #[inline]
        fn of(narrow: &Narrow) -> Wide {
            let spread = |from: &[f32; 4]| [from[0], from[1], from[2]].map(|x| _mm256_set1_ps(x));
            Wide {
                inverse: spread(&narrow.inverse),
                near: spread(&narrow.near),
                far: spread(&narrow.far),
                rows: narrow.rows,
            }
        }

        /// [`super::meets`], eight children at once. Distances are compared as whole numbers, which takes a quarter of the time: none is NaN, those below 0 are
        /// below all others, and margins keep the two sides of what is met apart.
        #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
        #[inline]
        fn meets(&self, node: &Node, limit: __m256i) -> Met {
            let (mut near, mut far) = (_mm256_setzero_si256(), limit);
            for a in 0..3 {
                let [enter, leave] = self.rows[a].map(|row| load_8(node.row(row)));
                let enter = _mm256_fmadd_ps(enter, self.inverse[a], self.near[a]);
                let leave = _mm256_fmadd_ps(leave, self.inverse[a], self.far[a]);
                near = _mm256_max_epi32(_mm256_castps_si256(enter), near);
                far = _mm256_min_epi32(_mm256_castps_si256(leave), far);
            }
            let mask = _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(far, near)));
            (mask as u32, store_8(_mm256_castsi256_ps(near)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fetch::nowhere;
    use super::*;
    use crate::math::Aabb;

    #[test]
    fn the_widest_instructions_take_the_same_way_as_plain_operations() {
        let part = |i: usize, c: f64| (i as f64 * c).fract() * 20.0 - 10.0;
        let corner = |i| DVec3::new(part(i, 0.754_877_666), part(i, 0.569_840_291), part(i, 0.430_159_709));
        let boxes: Vec<Aabb> = (0..5000).map(|i| Aabb::of([corner(i), corner(i) + 0.4])).collect();
        let tree = Tree::build(boxes.len(), |i| boxes[i]);
        let mut n_offered = 0;
        for i in 0..200 {
            let origin = corner(i + 7) * 3.0;
            // Some along an axis, where planes meet 0·∞.
            let direction = if i % 5 == 0 { DVec3::AXES[i % 3] } else { (corner(i) - origin).normalize() };
            let (mut by_plain, mut by_wide) = (Vec::new(), Vec::new());
            let noted = |all: &mut Vec<Range<usize>>, range, t_max| {
                all.push(range);
                t_max
            };
            let mut to_plain = |range, t_max| noted(&mut by_plain, range, t_max);
            if let Some((entry, narrow)) = Entry::entered(&tree, [&origin, &direction], 1e3) {
                let meets = |node: &Node, limit| meets_fused(&narrow, node, limit);
                super::super::walk(
                    &tree,
                    entry,
                    1e3,
                    (|limit| limit, meets),
                    (&mut to_plain, nowhere(&tree.nodes)),
                );
            }
            let mut to_wide = |range, t_max| noted(&mut by_wide, range, t_max);
            walk(&tree, [&origin, &direction], 1e3, (&mut to_wide, nowhere(&tree.nodes)));
            n_offered += by_plain.len();
            assert_eq!(by_wide, by_plain, "ray {i}");
        }
        assert!(n_offered > 1000, "{n_offered}");
    }
}
