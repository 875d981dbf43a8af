//! Boxes and items as the builder holds them: laid out so that two minima over four lanes join two boxes. Knows no tree.

use crate::math::Aabb;
use crate::world::bvh::frame::{Frame, round_down, round_up};
use glam::{Vec4, Vec4Swizzles};

/// A box of three axes in a tree's frame: its lower corner, and the upper one with its signs turned, so that both are joined by minima.
/// The last lanes are spare.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Box32 {
    lower: Vec4,
    turned: Vec4,
}

impl Box32 {
    /// The identity of [`Box32::grow`].
    pub const EMPTY: Box32 = Box32 { lower: Vec4::INFINITY, turned: Vec4::INFINITY };

    /// The smallest such box around a box.
    pub fn around(bounds: &Aabb, frame: &Frame) -> Box32 {
        let (min, max) = (frame.point(bounds.min), frame.point(bounds.max));
        Box32 {
            lower: Vec4::new(round_down(min.x), round_down(min.y), round_down(min.z), 0.0),
            turned: Vec4::new(-round_up(max.x), -round_up(max.y), -round_up(max.z), 0.0),
        }
    }

    /// Joins another to this one.
    #[inline(always)]
    pub fn grow(&mut self, other: &Box32) {
        *self = self.with(other);
    }

    /// Around both.
    #[inline(always)]
    pub fn with(&self, other: &Box32) -> Box32 {
        Box32 { lower: self.lower.min(other.lower), turned: self.turned.min(other.turned) }
    }

    /// Half the area; of a box that is not empty.
    #[inline(always)]
    pub fn area(&self) -> f32 {
        let size = self.lower + self.turned;
        let sides = size * size.yzxx();
        sides.x + sides.y + sides.z
    }

    /// The same of three at once; the last lane means nothing.
    #[inline(always)]
    pub fn areas(boxes: &[Box32; 3]) -> Vec4 {
        let [a, b, c] = [0, 1, 2].map(|i| boxes[i].lower + boxes[i].turned);
        let x = Vec4::new(a.x, b.x, c.x, c.x);
        let y = Vec4::new(a.y, b.y, c.y, c.y);
        let z = Vec4::new(a.z, b.z, c.z, c.z);
        x * y + y * z + z * x
    }

    /// Of the lower corner.
    #[inline(always)]
    pub fn lower(&self, axis: usize) -> f32 {
        self.lower[axis]
    }

    /// Of the upper corner.
    #[inline(always)]
    pub fn upper(&self, axis: usize) -> f32 {
        -self.turned[axis]
    }

    /// Twice the middle; the last lane means nothing.
    #[inline(always)]
    pub fn middle(&self) -> Vec4 {
        // A number in a spare lane would be a float so small that arithmetic with it is slow on some processors.
        (self.lower - self.turned).xyzz()
    }

    /// The box that is one point.
    #[inline(always)]
    pub fn of_point(p: Vec4) -> Box32 {
        Box32 { lower: p, turned: -p }
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
        bounds.lower.w = f32::from_bits(number);
        Item(bounds)
    }

    /// Its box without the number.
    pub fn bare(&self) -> Box32 {
        let mut bounds = self.0;
        bounds.lower.w = 0.0;
        bounds
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
        self.0.lower.w.to_bits()
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
