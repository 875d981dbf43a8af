//! A ball around solids that are put together.

use super::{Csg, Leaf, Place, Solid};
use crate::geometry::balls::Ball;
use crate::scene::CsgOp;
use crate::world::shape::ball::{ball_around, image, smaller};

/// Of what an operation has put together so far: nothing yet, or a ball around it where there is one.
type SoFar = Option<Option<Ball>>;

impl Csg {
    /// A ball around it, by those around its parts, but for roundings. None where these give none.
    pub fn ball(&self) -> Option<Ball> {
        let mut so_far: Vec<SoFar> = vec![None; self.operations.len()];
        for part in &self.parts {
            self.count_in(&mut so_far, part.place, part.ball());
        }
        // Each operation stands before those that it puts together.
        for (i, operation) in self.operations.iter().enumerate().rev() {
            let whole = so_far[i].flatten().filter(|_| !operation.inverse);
            self.count_in(&mut so_far, operation.place, whole);
            so_far[i] = Some(whole);
        }
        so_far.first().copied().flatten().flatten()
    }

    fn count_in(&self, so_far: &mut [SoFar], place: Place, ball: Option<Ball>) {
        let Some(number) = place.of else { return };
        let of = &mut so_far[number as usize];
        *of = match (self.operations[number as usize].op, *of) {
            (CsgOp::Difference, _) if !place.is_first => return,
            (_, None) => Some(ball),
            (CsgOp::Union, Some(before)) => Some(both(before, ball)),
            (CsgOp::Intersection | CsgOp::Difference, Some(before)) => Some(smaller(before, ball)),
        };
    }
}

impl Leaf {
    fn ball(&self) -> Option<Ball> {
        let own = match &self.solid {
            Solid::Shape(shape) => shape.ball()?,
            Solid::Mesh(mesh, _) => ball_around(mesh.tree.bounds())?,
        };
        Some(self.transform.as_ref().map_or(own, |transform| image(&own, transform)))
    }
}

/// Around both, where both are there.
fn both(a: Option<Ball>, b: Option<Ball>) -> Option<Ball> {
    Some(Ball::around([a?, b?].iter().map(|ball| (ball.center, ball.reach))))
}
