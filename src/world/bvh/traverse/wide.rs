//! The test of a node's children, and the traversal around it, compiled for what the processor has: only how many children one
//! instruction tests differs, not one operation or its order, so that every picture is the same on all of them. Knows nothing of
//! what is traversed. One of the two rooms of the tree with unsafe code: there is no other way to such instructions.

use super::{Met, Narrow, Node, SLOT, Tree, WIDTH};
use glam::DVec3;
use std::ops::Range;

/// [`super::walk`] with the widest instructions that there are.
#[inline(always)]
pub(super) fn walk(
    tree: &Tree,
    origin: DVec3,
    direction: DVec3,
    t_max: f64,
    leaf: impl FnMut(Range<usize>, f64) -> f64,
) {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_avx2() {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe { x86::walk_avx2(tree, origin, direction, t_max, leaf) };
    }
    super::walk(tree, origin, direction, t_max, meets, leaf);
}

/// The test by plain operations: the definition of what the others do.
#[inline(always)]
pub(super) fn meets(ray: &Narrow, node: &Node, limit: f32) -> Met {
    let (mut near, mut far) = ([0.0f32; WIDTH], [limit; WIDTH]);
    for a in 0..3 {
        let (enter, leave) = ray.rows(a);
        let (enter, leave) = (&node.rows[enter & 7], &node.rows[leave & 7]);
        for i in 0..WIDTH {
            let x = (enter[i] - ray.near_origin[a]) * ray.near_inverse[a];
            near[i] = if x > near[i] { x } else { near[i] };
            let y = (leave[i] - ray.far_origin[a]) * ray.far_inverse[a];
            far[i] = if y < far[i] { y } else { far[i] };
        }
    }
    let mask = (0..WIDTH).fold(0, |mask, i| mask | u32::from(near[i] <= far[i]) << i);
    (mask, std::array::from_fn(|i| near[i].to_bits() & !SLOT | i as u32))
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use std::arch::x86_64::*;

    #[target_feature(enable = "avx2")]
    pub(super) fn walk_avx2(
        tree: &Tree,
        origin: DVec3,
        direction: DVec3,
        t_max: f64,
        leaf: impl FnMut(Range<usize>, f64) -> f64,
    ) {
        let meets = |ray: &Narrow, node: &Node, limit| meets_avx2(ray, node, limit);
        super::super::walk(tree, origin, direction, t_max, meets, leaf);
    }

    /// [`super::meets`], eight children at once. The larger and the smaller of two give their second operand where one is NaN, as
    /// the comparisons there do.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn meets_avx2(ray: &Narrow, node: &Node, limit: f32) -> Met {
        let (mut near, mut far) = (_mm256_setzero_ps(), _mm256_set1_ps(limit));
        for a in 0..3 {
            let (enter, leave) = ray.rows(a);
            let (enter, leave) = (load(&node.rows[enter & 7]), load(&node.rows[leave & 7]));
            let x = _mm256_sub_ps(enter, _mm256_set1_ps(ray.near_origin[a]));
            near = _mm256_max_ps(_mm256_mul_ps(x, _mm256_set1_ps(ray.near_inverse[a])), near);
            let y = _mm256_sub_ps(leave, _mm256_set1_ps(ray.far_origin[a]));
            far = _mm256_min_ps(_mm256_mul_ps(y, _mm256_set1_ps(ray.far_inverse[a])), far);
        }
        let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(near, far));
        let slots = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        let keys = _mm256_andnot_si256(_mm256_set1_epi32(SLOT as i32), _mm256_castps_si256(near));
        (mask as u32, store(_mm256_or_si256(keys, slots)))
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    #[allow(unsafe_code, reason = "a vector register has no safe way from memory")]
    fn load(lanes: &[f32; WIDTH]) -> __m256 {
        // SAFETY: eight floats are read from an array of eight; no alignment is asked for.
        unsafe { _mm256_loadu_ps(lanes.as_ptr()) }
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    #[allow(unsafe_code, reason = "a vector register has no safe way to memory")]
    fn store(vector: __m256i) -> [u32; WIDTH] {
        let mut lanes = [0; WIDTH];
        // SAFETY: eight words are written to an array of eight; no alignment is asked for.
        unsafe { _mm256_storeu_si256(lanes.as_mut_ptr().cast(), vector) };
        lanes
    }
}

#[cfg(test)]
mod tests {
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
            let to_plain = |range, t_max| noted(&mut by_plain, range, t_max);
            super::super::walk(&tree, origin, direction, 1e3, meets, to_plain);
            walk(&tree, origin, direction, 1e3, |range, t_max| noted(&mut by_wide, range, t_max));
            n_offered += by_plain.len();
            assert_eq!(by_wide, by_plain, "ray {i}");
        }
        assert!(n_offered > 1000, "{n_offered}");
    }
}
