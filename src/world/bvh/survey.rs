//! Which items have a box that a tree can hold, and the box around those. Knows no tree.

use crate::math::Aabb;
use glam::DVec3;
use rayon::prelude::*;

/// So many boxes are surveyed by one thread: no more than one is woken for fewer, and a scene of few starts no threads at all.
pub const BY_ONE_THREAD: usize = 1 << 12;

/// The box around the finite boxes, and the items without one.
pub fn survey(count: usize, bounds_of: &(impl Fn(usize) -> Aabb + Sync)) -> (Aabb, Vec<u32>) {
    let nothing = || (Aabb::EMPTY, Vec::new());
    let with = |(bounds, mut unbounded): (Aabb, Vec<u32>), i: usize| {
        let b = bounds_of(i);
        if is_usable(&b) {
            return (bounds.union(b), unbounded);
        }
        if !is_nothing(&b) {
            unbounded.push(i as u32);
        }
        (bounds, unbounded)
    };
    if count <= BY_ONE_THREAD {
        return (0..count).fold(nothing(), with);
    }
    (0..count).into_par_iter().with_min_len(BY_ONE_THREAD).fold(nothing, with).reduce(
        nothing,
        |(a, mut x), (b, y)| {
            x.extend(y);
            (a.union(b), x)
        },
    )
}

/// Neither empty nor infinite in any direction, nor NaN, nor so large that its size overflows.
pub fn is_usable(b: &Aabb) -> bool {
    let size = b.size();
    (size.cmpge(DVec3::ZERO) & size.cmple(DVec3::MAX)).all()
}

/// The empty box: what has it is never met. All others that are not usable are offered to every ray.
fn is_nothing(b: &Aabb) -> bool {
    b.is_empty() && !b.min.is_nan() && !b.max.is_nan()
}
