//! Capped cylinders and cones, as the part of a double cone between two planes: a ray's inside is an interval of each, and the solid
//! is where they overlap, so that no ray slips through the rims.

use super::disc::disc_bounds;
use super::{LocalRay, Meet, Surface, ahead, padded, perpendicular, upright};
use crate::math::Aabb;
use crate::math::elementary::atan2;
use crate::math::error::gamma;
use crate::math::exact::two_product;
use crate::scene;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The side.
const SIDE: u32 = 0;
/// The cap at `from`.
const FROM: u32 = 1;
/// The cap at `to`.
const TO: u32 = 2;

/// A ray that starts farther from the middle than this many sizes is first moved near it.
const FAR: f64 = 4.0;

/// A capped frustum. On the side u goes around (counterclockwise seen from `to`) and v from `from` to `to`; caps have (u, v) over the
/// square around them.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// As it was written.
    pub shape: scene::Cone,
    /// Unit, from `from` to `to`.
    axis: DVec3,
    height: f64,
    /// Radius gained per length along the axis.
    slope: f64,
    /// Perpendicular to the axis, where u is 0.
    side: DVec3,
}

/// An interval of the ray inside something, and the faces at its ends.
#[derive(Clone, Copy)]
struct Span {
    near: (f64, u32),
    far: (f64, u32),
}

impl Span {
    /// Where both are.
    fn overlap(self, other: Span) -> Span {
        Span {
            near: if other.near.0 > self.near.0 { other.near } else { self.near },
            far: if other.far.0 < self.far.0 { other.far } else { self.far },
        }
    }
}

const NOWHERE: Span = Span { near: (f64::INFINITY, SIDE), far: (f64::NEG_INFINITY, SIDE) };
const EVERYWHERE: Span = Span { near: (f64::NEG_INFINITY, SIDE), far: (f64::INFINITY, SIDE) };

impl Cone {
    /// None where it has no height or no radius.
    pub fn new(shape: scene::Cone) -> Option<Cone> {
        let along = shape.to - shape.from;
        let height = along.length();
        let axis = along.try_normalize()?;
        let slope = (shape.radii[1] - shape.radii[0]) / height;
        let good = slope.is_finite() && shape.radii.iter().all(|r| *r >= 0.0) && shape.radii != [0.0; 2];
        let side = DVec3::Z.cross(axis).try_normalize().filter(|s| s.is_finite());
        // Where the axis is z itself, x; any other choice would do.
        let side = side.filter(|_| axis.z.abs() < 1.0).unwrap_or_else(|| perpendicular(axis));
        good.then_some(Cone { shape, axis, height, slope, side })
    }

    fn size(&self) -> f64 {
        self.height + self.shape.radii[0] + self.shape.radii[1]
    }

    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        self.ends(ray).into_iter().flatten().find(|m| ahead(m.t)).filter(|m| m.t <= limit)
    }

    pub(super) fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        out.extend(self.ends(ray).into_iter().flatten().filter(|m| ahead(m.t)));
    }

    /// Where the ray enters and leaves, in order: once or, where it passes the apex' other side, twice.
    #[inline(always)]
    fn ends(&self, ray: &LocalRay) -> [Option<Meet>; 4] {
        let (d, axis) = (ray.direction, self.axis);
        let mut f = ray.origin - self.shape.from;
        let to_middle = axis * (self.height / 2.0) - f;
        let start =
            if to_middle.abs().max_element() > FAR * self.size() { to_middle.dot(d) / d.dot(d) } else { 0.0 };
        f += d * start;
        let (y, dy) = (f.dot(axis), d.dot(axis));
        let (p, dp) = (f - axis * y, d - axis * dy);
        let slab = self.slab(y, dy);
        let mut ends = [None; 4];
        if slab.near.0 > slab.far.0 {
            return ends;
        }
        for (i, part) in self.double_cone(y, dy, p, dp).into_iter().enumerate() {
            let inside = part.overlap(slab);
            if inside.near.0 > inside.far.0 {
                continue;
            }
            let end = |(t, face): (f64, u32)| Some(Meet { t: start + t, face, ..Meet::default() });
            (ends[2 * i], ends[2 * i + 1]) = (end(inside.near), end(inside.far));
        }
        ends
    }

    /// Between the planes of the caps.
    fn slab(&self, y: f64, dy: f64) -> Span {
        if dy == 0.0 {
            return if (0.0..=self.height).contains(&y) { EVERYWHERE } else { NOWHERE };
        }
        let (from, to) = ((-y / dy, FROM), ((self.height - y) / dy, TO));
        if dy > 0.0 { Span { near: from, far: to } } else { Span { near: to, far: from } }
    }

    /// Inside the double cone: |p + t·dp| ≤ |r + t·dr|. One interval, or two that go on for ever, the first in front.
    fn double_cone(&self, y: f64, dy: f64, p: DVec3, dp: DVec3) -> [Span; 2] {
        let (r, dr) = (self.shape.radii[0] + self.slope * y, self.slope * dy);
        let (length, along) = (p.length(), dp.length());
        let a = (along - dr.abs()) * (along + dr.abs());
        let b = p.dot(dp) - r * dr;
        let c = (length - r.abs()) * (length + r.abs());
        if a == 0.0 {
            let t = -c / (2.0 * b);
            let only = if b > 0.0 {
                Span { far: (t, SIDE), ..EVERYWHERE }
            } else if b < 0.0 {
                Span { near: (t, SIDE), ..EVERYWHERE }
            } else if c <= 0.0 {
                EVERYWHERE
            } else {
                NOWHERE
            };
            return [only, NOWHERE];
        }
        let discriminant = self.discriminant(a, b, c, p, dp);
        if discriminant < 0.0 {
            return [if a > 0.0 { NOWHERE } else { EVERYWHERE }, NOWHERE];
        }
        let q = -(b + discriminant.sqrt().copysign(b));
        let (s, t) = (q / a, if q == 0.0 { 0.0 } else { c / q });
        let (s, t) = if s <= t { (s, t) } else { (t, s) };
        if a > 0.0 {
            [Span { near: (s, SIDE), far: (t, SIDE) }, NOWHERE]
        } else {
            [Span { far: (s, SIDE), ..EVERYWHERE }, Span { near: (t, SIDE), ..EVERYWHERE }]
        }
    }

    /// b² − ac; for a cylinder from the ray's distance to the axis, which does not cancel.
    fn discriminant(&self, a: f64, b: f64, c: f64, p: DVec3, dp: DVec3) -> f64 {
        if self.slope == 0.0 {
            let r = self.shape.radii[0];
            let nearest = (p - dp * (b / a)).length();
            return a * (r - nearest) * (r + nearest);
        }
        let ((m, e), (n, f)) = (two_product(b, b), two_product(a, c));
        (m - n) + (e - f)
    }

    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let (axis, [r0, r1]) = (self.axis, self.shape.radii);
        let q = (ray.origin - self.shape.from) + ray.direction * meet.t;
        let y = q.dot(axis);
        let across = q - axis * y;
        let error = (self.shape.from.abs() + DVec3::splat(self.size())) * gamma(32);
        if meet.face == SIDE {
            let y = y.clamp(0.0, self.height);
            let out = across.try_normalize().unwrap_or(self.side);
            let point = self.shape.from + axis * y + out * (r0 + self.slope * y);
            let normal = (out - axis * self.slope).normalize();
            let around = atan2(out.dot(axis.cross(self.side)), out.dot(self.side)) / TAU;
            let u = if around < 0.0 { around + 1.0 } else { around };
            return Surface {
                point,
                error,
                geometric_normal: normal,
                normal,
                tangent: axis.cross(out),
                uv: DVec2::new(u, y / self.height).into(),
            };
        }
        let (center, normal, radius) =
            if meet.face == TO { (self.shape.to, axis, r1) } else { (self.shape.from, -axis, r0) };
        let (u, v) = upright(normal);
        Surface {
            point: center + across,
            error,
            geometric_normal: normal,
            normal,
            tangent: u,
            uv: ((DVec2::new(across.dot(u), across.dot(v)) / radius + 1.0) / 2.0).into(),
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let scene::Cone { from, to, radii } = self.shape;
        let caps = disc_bounds(from, self.axis, radii[0]).union(disc_bounds(to, self.axis, radii[1]));
        padded(caps, DVec3::splat(self.size() * gamma(8)))
    }
}
