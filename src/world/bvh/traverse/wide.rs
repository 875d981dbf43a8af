//! The test of a node's children, and the traversal around it, compiled for what the processor has: how many children one instruction
//! tests differs, and by half an ulp where a ray meets a box, which margins cover. So which boxes are opened in vain may differ, and what is
//! found inside never does. Knows nothing of what is traversed. One of the rooms with unsafe code: there is no other way to such
//! instructions.

use super::{Met, Narrow, Node, Tree, WIDTH};
use glam::DVec3;
use std::ops::Range;

/// [`super::walk`] with the widest instructions that there are.
#[inline(always)]
pub(super) fn walk(
    tree: &Tree,
    ray: [&DVec3; 2],
    t_max: f64,
    leaf: &mut impl FnMut(Range<usize>, f64) -> f64,
) {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_avx2_and_fma() {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe { x86::walk_avx2(tree, ray, t_max, leaf) };
    }
    super::walk(tree, ray, t_max, meets, leaf);
}

/// [`super::walk_any`] with the widest instructions that there are.
#[inline(always)]
pub(super) fn walk_any(
    tree: &Tree,
    ray: [&DVec3; 2],
    t_max: f64,
    leaf: &mut impl FnMut(Range<usize>) -> bool,
) {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_avx2_and_fma() {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe { x86::walk_any_avx2(tree, ray, t_max, leaf) };
    }
    super::walk_any(tree, ray, t_max, meets, leaf);
}

/// Has the memory of a node brought near. Whatever the index says: that of an item does no harm.
#[inline(always)]
pub(super) fn fetch(nodes: &[Node], index: u32) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let at = nodes.as_ptr().wrapping_add(index as usize).cast::<i8>();
        for line in 0..4 {
            // SAFETY: what a place holds is a hint here, which is neither read nor need be there.
            #[allow(unsafe_code, reason = "a hint has no safe way")]
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(at.wrapping_add(64 * line))
            };
        }
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
        let (enter, leave) = ray.rows(a);
        let (enter, leave) = (&node.rows[enter & 7], &node.rows[leave & 7]);
        for i in 0..WIDTH {
            let x = at(enter[i], ray.inverse[a], ray.near[a]);
            near[i] = if x > near[i] { x } else { near[i] };
            let y = at(leave[i], ray.inverse[a], ray.far[a]);
            far[i] = if y < far[i] { y } else { far[i] };
        }
    }
    let mask = (0..WIDTH).fold(0, |mask, i| mask | u32::from(near[i] <= far[i]) << i);
    (mask, near)
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use crate::math::vectors::lanes::{load_8, store_8};
    use std::arch::x86_64::*;

    #[target_feature(enable = "avx2,fma")]
    pub(super) fn walk_avx2(
        tree: &Tree,
        ray: [&DVec3; 2],
        t_max: f64,
        leaf: &mut impl FnMut(Range<usize>, f64) -> f64,
    ) {
        let meets = |ray: &Narrow, node: &Node, limit| meets_avx2(ray, node, limit);
        super::super::walk(tree, ray, t_max, meets, leaf);
    }

    #[target_feature(enable = "avx2,fma")]
    pub(super) fn walk_any_avx2(
        tree: &Tree,
        ray: [&DVec3; 2],
        t_max: f64,
        leaf: &mut impl FnMut(Range<usize>) -> bool,
    ) {
        let meets = |ray: &Narrow, node: &Node, limit| meets_avx2(ray, node, limit);
        super::super::walk_any(tree, ray, t_max, meets, leaf);
    }

    /// [`super::meets`], eight children at once. The larger and the smaller of two give their second operand where one is NaN, as
    /// the comparisons there do.
    #[target_feature(enable = "avx2,fma")]
    #[inline]
    fn meets_avx2(ray: &Narrow, node: &Node, limit: f32) -> Met {
        let (mut near, mut far) = (_mm256_setzero_ps(), _mm256_set1_ps(limit));
        for a in 0..3 {
            let (enter, leave) = ray.rows(a);
            let (enter, leave) = (load_8(&node.rows[enter & 7]), load_8(&node.rows[leave & 7]));
            let inverse = _mm256_set1_ps(ray.inverse[a]);
            near = _mm256_max_ps(_mm256_fmadd_ps(enter, inverse, _mm256_set1_ps(ray.near[a])), near);
            far = _mm256_min_ps(_mm256_fmadd_ps(leave, inverse, _mm256_set1_ps(ray.far[a])), far);
        }
        let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(near, far));
        (mask as u32, store_8(near))
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
            let mut to_plain = |range, t_max| noted(&mut by_plain, range, t_max);
            super::super::walk(&tree, [&origin, &direction], 1e3, meets_fused, &mut to_plain);
            walk(&tree, [&origin, &direction], 1e3, &mut |range, t_max| noted(&mut by_wide, range, t_max));
            n_offered += by_plain.len();
            assert_eq!(by_wide, by_plain, "ray {i}");
        }
        assert!(n_offered > 1000, "{n_offered}");
    }
}
