//! Prisms: a closed outline moved along a straight line. Exact: a ray crosses each cubic of the outline where a cubic is 0. Knows nothing of
//! scenes.

mod mesh;

use super::outline::Outline;
use super::span::{clip, wedge};
use super::{SurfacePoint, Touch};
use crate::geometry::boxes::Line;
use crate::math::Aabb;
use glam::{DVec2, DVec3};

/// Where an outline lies: its x along `side`, its y along `up`, both unit vectors across `along`; right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// Where x and y are 0.
    pub origin: DVec3,
    /// The outline's x.
    pub side: DVec3,
    /// The outline's y.
    pub up: DVec3,
    /// Out of its plane.
    pub along: DVec3,
}

impl Placing {
    /// Across a direction at the origin, with y nearest to the y axis; along the y axis itself, y is −z, so that the outline is seen from above
    /// as it is drawn. None for a direction of length 0.
    pub fn across(direction: DVec3) -> Option<Placing> {
        let along = crate::math::Point::unit(direction)?;
        let up = crate::geometry::curve::across(DVec3::Y, along);
        // Nearer to the axis than rounding can tell, there is no nearest.
        let is_upright = up.length() <= 64.0 * f64::EPSILON;
        let up = if is_upright { None } else { up.try_normalize() };
        let up = up.unwrap_or_else(|| crate::geometry::curve::across(-DVec3::Z, along).normalize());
        Some(Placing { origin: DVec3::ZERO, side: up.cross(along), up, along })
    }

    /// A point of the plane.
    pub fn place(&self, p: DVec2) -> DVec3 {
        self.origin + self.side * p.x + self.up * p.y
    }

    /// The foot of a point in the plane.
    pub fn flat(&self, p: DVec3) -> DVec2 {
        let from = p - self.origin;
        DVec2::new(self.side.dot(from), self.up.dot(from))
    }

    /// A vector without its part along.
    pub fn flat_vector(&self, v: DVec3) -> DVec2 {
        DVec2::new(self.side.dot(v), self.up.dot(v))
    }
}

/// A prism, ready for rays.
#[derive(Clone, Debug)]
pub struct Prism {
    outline: Outline,
    placing: Placing,
    height: f64,
    bounds: Aabb,
}

/// The number of the face at the start; the one at the end follows. Pieces are fewer.
const FACES: u32 = u32::MAX - 1;

impl Prism {
    /// An outline in its place, moved by `height` > 0 along it.
    pub fn new(outline: Outline, placing: Placing, height: f64) -> Prism {
        let points = outline.pieces().iter().flat_map(|piece| piece.points).map(|p| placing.place(p));
        let all = Aabb::of(points.flat_map(|p| [p, p + placing.along * height]));
        let by = all.min.abs().max(all.max.abs()) * (8.0 * f64::EPSILON);
        Prism { outline, placing, height, bounds: Aabb { min: all.min - by, max: all.max + by } }
    }

    /// The box around it.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.outline.pieces())
    }

    /// The first meeting with `near` < t ≤ `far`.
    pub fn first(&self, line: &Line, near: f64, far: f64) -> Option<Touch> {
        self.all(line).into_iter().find(|h| h.t > near && h.t <= far)
    }

    /// Every meeting along the whole line, both ways, ascending: in and out in turn, a tangent twice.
    pub fn all(&self, line: &Line) -> Vec<Touch> {
        let along = self.placing.along;
        let height = along.dot(line.origin - self.placing.origin);
        let rise = along.dot(line.direction);
        let slab = wedge::both(
            wedge::half_space(-height, -rise, line.length, FACES),
            wedge::half_space(height - self.height, rise, line.length, FACES + 1),
        );
        if slab.is_empty() {
            return Vec::new();
        }
        let (origin, flat) = (self.placing.flat(line.origin), self.placing.flat_vector(line.direction));
        let speed = flat.length();
        let Some(direction) = crate::math::Point::unit(flat).filter(|_| speed > 0.0) else {
            let forever = |t: f64| Touch::new(t, u32::MAX, 0.0);
            let is_inside = self.outline.contains(origin);
            let whole = [forever(f64::NEG_INFINITY), forever(f64::INFINITY)];
            return if is_inside { clip(&whole, &slab) } else { Vec::new() };
        };
        clip(&self.sides(line, origin, direction, speed), &slab)
    }

    /// Meetings with the sides, as if they went on for ever.
    fn sides(&self, line: &Line, origin: DVec2, direction: DVec2, speed: f64) -> Vec<Touch> {
        let mut found = Vec::new();
        for piece in 0..self.outline.pieces().len() as u32 {
            self.outline.cross(piece, origin, direction, |c| {
                let touch = Touch::new(c.s / speed / line.length, c.piece, c.x);
                found.push(touch);
                found.extend((!c.is_crossing).then_some(touch));
            });
        }
        found.sort_by(|a, b| a.t.total_cmp(&b.t));
        found
    }

    /// The surface where a line touched it.
    pub fn surface(&self, line: &Line, touch: &Touch) -> SurfacePoint {
        let seen = line.at(touch.t * line.length);
        let Placing { origin, side, up, along } = self.placing;
        if touch.part >= FACES {
            let (base, normal) = match touch.part == FACES {
                true => (origin, -along),
                false => (origin + along * self.height, along),
            };
            let point = seen - normal * normal.dot(seen - base);
            return SurfacePoint { point, normal, tangent: side, uv: self.placing.flat(point) };
        }
        let (at, share) = self.outline.at(touch.part, touch.x);
        let n = self.outline.normal(touch.part, touch.x);
        let height = along.dot(seen - origin);
        let normal = side * n.x + up * n.y;
        SurfacePoint {
            point: self.placing.place(at) + along * height,
            normal,
            tangent: along.cross(normal),
            uv: DVec2::new(share, (height / self.height).clamp(0.0, 1.0)),
        }
    }

    /// Largest coordinate of anything on it.
    pub fn size(&self) -> f64 {
        let bounds = self.bounds();
        bounds.min.abs().max(bounds.max.abs()).max_element()
    }
}
