//! Axis-aligned boxes: slabs by comparison, so that a ray in the plane of a side (0·∞) is decided and not lost.

use super::{LocalRay, Meet, Surface, ahead};
use crate::math::Aabb;
use crate::math::error::gamma;
use glam::{DVec2, DVec3};

/// The solid between two corners. Each face has its own (u, v) in 0 … 1, upright seen from outside; top and bottom have u along x.
#[derive(Clone, Copy, Debug)]
pub struct Cuboid {
    /// Lower corner.
    pub min: DVec3,
    /// Upper corner, larger in each coordinate.
    pub max: DVec3,
}

/// Faces are 2·axis + (1 for the upper side).
fn face_of(axis: usize, upper: bool) -> u32 {
    2 * axis as u32 + u32::from(upper)
}

impl Cuboid {
    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        let (near, far) = self.ends(ray)?;
        let meet = if near.t > 0.0 { near } else { far };
        (meet.t > 0.0 && meet.t <= limit).then_some(meet)
    }

    pub(super) fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        if let Some((near, far)) = self.ends(ray) {
            out.extend([near, far].into_iter().filter(|meet| ahead(meet.t)));
        }
    }

    /// Where the ray enters and leaves.
    #[inline(always)]
    pub(super) fn ends(&self, ray: &LocalRay) -> Option<(Meet, Meet)> {
        let (mut near, mut far) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for axis in 0..3 {
            let inverse = 1.0 / ray.direction[axis];
            let backward = inverse.is_sign_negative();
            let (first, last) = if backward { (self.max, self.min) } else { (self.min, self.max) };
            let enter = (first[axis] - ray.origin[axis]) * inverse;
            let leave = (last[axis] - ray.origin[axis]) * inverse;
            if enter > near.0 {
                near = (enter, face_of(axis, backward));
            }
            if leave < far.0 {
                far = (leave, face_of(axis, !backward));
            }
        }
        if near.0 > far.0 {
            return None;
        }
        let end = |(t, face)| Meet { t, face, ..Meet::default() };
        Some((end(near), end(far)))
    }

    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let (axis, upper) = (meet.face as usize / 2, meet.face % 2 == 1);
        let mut point = ray.at(meet.t).clamp(self.min, self.max);
        point[axis] = if upper { self.max[axis] } else { self.min[axis] };
        let mut error = (ray.origin.abs() + (ray.direction * meet.t).abs()) * gamma(4);
        error[axis] = 0.0;
        let mut normal = DVec3::ZERO;
        normal[axis] = if upper { 1.0 } else { -1.0 };
        let (u, v) = super::upright(normal);
        let middle = self.min + (self.max - self.min) / 2.0;
        let size = self.max - self.min;
        let place = |direction: DVec3| 0.5 + (point - middle).dot(direction) / size.dot(direction.abs());
        Surface {
            point,
            error,
            geometric_normal: normal,
            normal,
            tangent: u,
            uv: DVec2::new(place(u), place(v)).into(),
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        Aabb { min: self.min, max: self.max }
    }
}
