//! Balls around shapes: closer than those around their boxes where they are round.

use super::{EVERYTHING, Shape};
use crate::geometry::balls::Ball;
use crate::math::elementary::hypot;
use crate::math::error::gamma;
use crate::math::{Aabb, Affine};

/// Roundings of a ball's image, each no more than one of the numbers that it is computed from; of [`Affine::stretch`] the most.
const ROUNDINGS: f64 = gamma(64);

impl Shape {
    /// A ball around it in its own space, but for roundings that [`image()`] takes in. None of what has no bounds.
    pub fn ball(&self) -> Option<Ball> {
        let around = |center, reach| Some(Ball { center, reach });
        match self {
            Shape::Plane(_) => None,
            Shape::Sphere(s) => around(s.center, s.radius),
            Shape::Disc(s) => around(s.0.center, s.0.radius),
            Shape::Rect(s) => {
                let [plus, minus] = [s.shape.a + s.shape.b, s.shape.a - s.shape.b];
                around(s.shape.center, plus.length().max(minus.length()))
            }
            Shape::Cone(s) => {
                let half = s.shape.from.distance(s.shape.to) / 2.0;
                let reach = s.shape.radii.map(|radius| hypot(radius, half));
                around(s.shape.from.midpoint(s.shape.to), reach[0].max(reach[1]))
            }
            Shape::Torus(s) => around(s.shape.center, s.shape.radii[0] + s.shape.radii[1]),
            Shape::Csg(s) => smaller(ball_around(s.bounds(None)), s.ball()),
            Shape::Cuboid(_)
            | Shape::Triangle(_)
            | Shape::Patch(_)
            | Shape::Swept(_)
            | Shape::Implicit(_) => ball_around(self.bounds(None)),
        }
    }
}

/// Around a box. None where it goes on for ever.
pub fn ball_around(bounds: Aabb) -> Option<Ball> {
    let reach = bounds.size().length() / 2.0;
    (bounds != EVERYTHING && reach.is_finite()).then(|| Ball { center: bounds.center(), reach })
}

/// A ball around a ball's image, and around what rounding makes of both.
pub fn image(ball: &Ball, transform: &Affine) -> Ball {
    let stretch = transform.stretch().1;
    let size = transform.translation.length() + stretch * (ball.center.length() + ball.reach);
    Ball { center: transform.point(ball.center), reach: stretch * ball.reach + size * ROUNDINGS }
}

/// Whichever is there and smaller.
pub fn smaller(a: Option<Ball>, b: Option<Ball>) -> Option<Ball> {
    match (a, b) {
        (Some(a), Some(b)) if b.reach < a.reach => Some(b),
        (a, b) => a.or(b),
    }
}
