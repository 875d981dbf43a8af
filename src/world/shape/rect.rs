//! Parallelograms.

use super::{LocalRay, Meet, Surface, padded};
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::scene;
use glam::{DVec2, DVec3};

/// center ± a ± b, u along a and v along b.
#[derive(Clone, Copy, Debug)]
pub struct Rect {
    /// As it was written.
    pub shape: scene::Rect,
    /// Unit a × b.
    normal: DVec3,
    /// In the plane, with dual_a·a = 1 and dual_a·b = 0; and the other way round.
    dual_a: DVec3,
    dual_b: DVec3,
    /// Of a point's place along a and b: a bound on its error.
    doubt: f64,
}

impl Rect {
    /// None where a and b are parallel.
    pub fn new(shape: scene::Rect) -> Option<Rect> {
        let (a, b) = (shape.a, shape.b);
        let normal = a.cross(b).try_normalize()?;
        let (across_a, across_b) = (normal.cross(a), b.cross(normal));
        let dual_a = across_b / across_b.dot(a);
        let dual_b = across_a / across_a.dot(b);
        let doubt = (a.length() + b.length()) * gamma(8);
        (dual_a.is_finite() && dual_b.is_finite()).then_some(Rect { shape, normal, dual_a, dual_b, doubt })
    }

    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        let f = ray.origin - self.shape.center;
        let t = -f.dot(self.normal) / ray.direction.dot(self.normal);
        if !(t > 0.0 && t <= limit) {
            return None;
        }
        let q = f + ray.direction * t;
        let (a, b) = (q.dot(self.dual_a), q.dot(self.dual_b));
        (a.abs() <= 1.0 && b.abs() <= 1.0).then_some(Meet { t, a, b, face: 0, part: 0 })
    }

    pub(super) fn surface(&self, _ray: &LocalRay, meet: &Meet) -> Surface {
        let scene::Rect { center, a, b } = self.shape;
        let across = a * meet.a + b * meet.b;
        Surface {
            point: center + across,
            error: (center.abs() + (a * meet.a).abs() + (b * meet.b).abs()) * gamma(4)
                + DVec3::splat(self.doubt),
            geometric_normal: self.normal,
            normal: self.normal,
            tangent: a,
            uv: ((DVec2::new(meet.a, meet.b) + 1.0) / 2.0).into(),
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let scene::Rect { center, a, b } = self.shape;
        let half = a.abs() + b.abs();
        padded(Aabb { min: center - half, max: center + half }, (center.abs() + half) * gamma(4))
    }
}
