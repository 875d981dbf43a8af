//! Trees whose walk is compiled as one with the test in their leaves, for instructions that not every processor has: a copy for each tree and test, so that
//! what both need stays in registers.

use super::Found;
use crate::world::bvh;
use crate::world::kdtree;
use crate::world::shape::LocalRay;
use std::ops::Range;

/// What offers ranges of positions.
#[allow(unsafe_code, reason = "a trait has no other functions for some processors")]
pub(super) trait Walked {
    /// Where ranges begin: anywhere, or at multiples of [`AT_ONCE`](crate::world::shape::triangle::leaf::AT_ONCE) alone.
    const ANYWHERE: bool;

    /// Offers every range that the ray may meet within the limit of what was found; any, in no order, or near ones first. `look` says whether to go on,
    /// which matters where any will do; `ahead` where what is looked at from a position on lies.
    ///
    /// # Safety
    ///
    /// The processor must have x86-64-v3.
    unsafe fn walk<const ANY: bool>(
        &self,
        ray: &LocalRay,
        found: &mut Found,
        look: impl Fn(&mut Found, Range<usize>) -> bool,
        ahead: impl Fn(usize) -> *const i8,
    );
}

/// A hierarchy that is [whole](bvh::Tree::is_whole).
#[allow(unsafe_code, reason = "a trait has no other functions for some processors")]
impl Walked for bvh::Tree {
    const ANYWHERE: bool = false;

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    unsafe fn walk<const ANY: bool>(
        &self,
        ray: &LocalRay,
        found: &mut Found,
        look: impl Fn(&mut Found, Range<usize>) -> bool,
        ahead: impl Fn(usize) -> *const i8,
    ) {
        let (LocalRay { origin, direction }, limit) = (*ray, found.limit);
        if ANY {
            self.traverse_any_v3(origin, direction, limit, (|range| look(found, range), ahead));
        } else {
            let nearest = |range, _| {
                look(found, range);
                found.limit
            };
            self.traverse_v3(origin, direction, limit, (nearest, ahead));
        }
    }
}

#[allow(unsafe_code, reason = "a trait has no other functions for some processors")]
impl Walked for kdtree::Tree {
    const ANYWHERE: bool = true;

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    unsafe fn walk<const ANY: bool>(
        &self,
        ray: &LocalRay,
        found: &mut Found,
        look: impl Fn(&mut Found, Range<usize>) -> bool,
        _: impl Fn(usize) -> *const i8,
    ) {
        let (LocalRay { origin, direction }, limit) = (*ray, found.limit);
        self.traverse_counting(
            origin,
            direction,
            limit,
            || (),
            |range, _| {
                if look(found, range) { found.limit } else { -1.0 }
            },
        );
    }
}

/// All of a list.
#[allow(unsafe_code, reason = "a trait has no other functions for some processors")]
impl Walked for Range<usize> {
    const ANYWHERE: bool = true;

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[inline]
    unsafe fn walk<const ANY: bool>(
        &self,
        _: &LocalRay,
        found: &mut Found,
        look: impl Fn(&mut Found, Range<usize>) -> bool,
        _: impl Fn(usize) -> *const i8,
    ) {
        look(found, self.clone());
    }
}
