//! Boxes and items as the builder holds them: laid out so that one minimum over eight lanes joins two boxes. Knows no tree.

use crate::math::Aabb;
use crate::world::bvh::frame::{Frame, round_down, round_up};

/// Where the upper corner begins.
const UPPER: usize = 4;
/// The lane after the lower corner: free in a box, the number in an item.
const NUMBER: usize = 3;

/// A box of three axes in a tree's frame: lower x, y, z, a spare lane, then upper x, y, z with their signs turned, and another.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Box32([f32; 8]);

impl Box32 {
    /// The identity of [`Box32::grow`].
    pub const EMPTY: Box32 = Box32([f32::INFINITY; 8]);

    /// The smallest such box around a box.
    pub fn around(bounds: &Aabb, frame: &Frame) -> Box32 {
        let min = frame.point(bounds.min).to_array().map(round_down);
        let max = frame.point(bounds.max).to_array().map(round_up);
        Box32([min[0], min[1], min[2], 0.0, -max[0], -max[1], -max[2], 0.0])
    }

    /// Joins another to this one.
    #[inline(always)]
    pub fn grow(&mut self, other: &Box32) {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a = if *b < *a { *b } else { *a };
        }
    }

    /// Half the area; of a box that is not empty.
    #[inline(always)]
    pub fn area(&self) -> f32 {
        let d = |a: usize| self.upper(a) - self.lower(a);
        d(0) * d(1) + d(1) * d(2) + d(2) * d(0)
    }

    /// Of the lower corner.
    #[inline(always)]
    pub fn lower(&self, axis: usize) -> f32 {
        self.0[axis]
    }

    /// Of the upper corner.
    #[inline(always)]
    pub fn upper(&self, axis: usize) -> f32 {
        -self.0[axis + UPPER]
    }

    /// Twice the middle; the last lane means nothing.
    #[inline(always)]
    pub fn middle(&self) -> [f32; 4] {
        std::array::from_fn(|a| self.0[a] - self.0[a + UPPER])
    }

    /// The box that is one point.
    #[inline(always)]
    pub fn of_point(p: [f32; 4]) -> Box32 {
        Box32([p[0], p[1], p[2], p[3], -p[0], -p[1], -p[2], -p[3]])
    }
}

/// What is split: an item, or many of them as one.
pub(super) trait Boxed: Copy {
    /// Around it; the spare lanes mean nothing.
    fn bounds(&self) -> &Box32;
    /// How many items it stands for.
    fn weight(&self) -> u32;
    /// Different for each.
    fn number(&self) -> u32;
}

/// An item's box, with its number in the spare lane.
#[derive(Clone, Copy)]
pub(super) struct Item(Box32);

impl Item {
    /// Item `number` with its box.
    pub fn new(mut bounds: Box32, number: u32) -> Item {
        bounds.0[NUMBER] = f32::from_bits(number);
        Item(bounds)
    }
}

impl Boxed for Item {
    #[inline(always)]
    fn bounds(&self) -> &Box32 {
        &self.0
    }

    #[inline(always)]
    fn weight(&self) -> u32 {
        1
    }

    fn number(&self) -> u32 {
        self.0.0[NUMBER].to_bits()
    }
}

/// The box around all.
#[inline(always)]
pub(super) fn bounds_of<'a, T: Boxed + 'a>(all: impl IntoIterator<Item = &'a T>) -> Box32 {
    all.into_iter().fold(Box32::EMPTY, |mut bounds, one| {
        bounds.grow(one.bounds());
        bounds
    })
}

/// The box around the (doubled) middles.
pub(super) fn middles_of<T: Boxed>(all: &[T]) -> Box32 {
    all.iter().fold(Box32::EMPTY, |mut bounds, one| {
        bounds.grow(&Box32::of_point(one.bounds().middle()));
        bounds
    })
}
