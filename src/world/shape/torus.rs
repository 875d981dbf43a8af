//! Tori: the quartic at the ray's point nearest to the centre, where its coefficients are of the torus's size whatever the distance,
//! solved by isolated intervals.

use super::{LocalRay, Meet, Surface, ahead, padded, perpendicular};
use crate::math::Aabb;
use crate::math::elementary::atan2;
use crate::math::error::gamma;
use crate::math::solve::{Roots, roots_between};
use crate::scene;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A ring. u goes around the axis, v around the tube from the outer equator over the top.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    /// As it was written.
    pub shape: scene::Torus,
    /// Perpendicular to the axis and to one another; u is 0 along the first.
    side: [DVec3; 2],
}

/// Σ cᵢsⁱ, negative within the torus (and positive again within a spindle's core), on −far … far.
struct Quartic {
    coefficients: [f64; 5],
    far: f64,
}

impl Quartic {
    fn roots(&self) -> Roots {
        roots_between(&self.coefficients, -self.far, self.far)
    }

    fn value(&self, s: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * s + c)
    }
}

impl Torus {
    /// Of a torus with finite, positive radii.
    pub fn new(shape: scene::Torus) -> Torus {
        let axis = shape.axis;
        let level = DVec3::Z.cross(axis).try_normalize().filter(|_| axis.z.abs() < 1.0);
        let first = level.unwrap_or_else(|| perpendicular(axis));
        Torus { shape, side: [first, axis.cross(first)] }
    }

    /// In coordinates whose third axis is the torus's.
    fn upright(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.side[0]), v.dot(self.side[1]), v.dot(self.shape.axis))
    }

    /// Back again.
    fn tilted(&self, v: DVec3) -> DVec3 {
        self.side[0] * v.x + self.side[1] * v.y + self.shape.axis * v.z
    }

    fn reach(&self) -> f64 {
        self.shape.radii[0] + self.shape.radii[1]
    }

    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        let (start, quartic) = self.quartic(ray)?;
        let t = quartic.roots().iter().map(|s| start + s).find(|t| *t > 0.0)?;
        (t <= limit).then(|| Meet::at(t))
    }

    pub(super) fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        let Some((start, quartic)) = self.quartic(ray) else { return };
        let roots = quartic.roots();
        let mut inside = false;
        for (i, &root) in roots.iter().enumerate() {
            // Beyond the last root all is outside, whatever the signs between say.
            let inside_after = roots.get(i + 1).is_some_and(|next| quartic.value((root + next) / 2.0) < 0.0);
            let times = if inside == inside_after { 2 } else { 1 };
            inside = inside_after;
            if ahead(start + root) {
                out.extend(std::iter::repeat_n(Meet::at(start + root), times));
            }
        }
    }

    /// The ray's distance to the point nearest to the centre, and the quartic from there; none where it passes all of the torus by.
    fn quartic(&self, ray: &LocalRay) -> Option<(f64, Quartic)> {
        let d = ray.direction;
        let from_center = ray.origin - self.shape.center;
        let start = -from_center.dot(d) / d.dot(d);
        let nearest = from_center + d * start;
        let reach = self.reach();
        // The ray's nearest point may be off by the rounding of where it started.
        let doubt = gamma(16) * (from_center.abs().max_element() + reach);
        if nearest.length() > reach + doubt {
            return None;
        }
        Some((start, self.quartic_from(self.upright(nearest), self.upright(d))))
    }

    /// Along the ray from `p`, which is its nearest point to the centre.
    fn quartic_from(&self, p: DVec3, d: DVec3) -> Quartic {
        let [major, minor] = self.shape.radii;
        let flat = |v: DVec3| DVec2::new(v.x, v.y);
        let (alpha, beta) = (d.dot(d), p.dot(d));
        let gamma_ = p.dot(p) + (major - minor) * (major + minor);
        let four = 4.0 * major * major;
        let ring = flat(p).length() - major;
        // γ² − 4R²ρ², factored: the first factor is (ρ − R)² + z² − r², which is 0 on the surface.
        let inner = ring * ring + (p.z - minor) * (p.z + minor);
        let coefficients = [
            inner * (gamma_ + 2.0 * major * flat(p).length()),
            4.0 * beta * gamma_ - 2.0 * four * flat(p).dot(flat(d)),
            4.0 * beta * beta + 2.0 * alpha * gamma_ - four * flat(d).length_squared(),
            4.0 * alpha * beta,
            alpha * alpha,
        ];
        // Everything lies within the sphere around it; a little more, so that its own rounding cuts nothing off.
        Quartic { coefficients, far: 1.0625 * self.reach() / alpha.sqrt() }
    }

    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let [major, minor] = self.shape.radii;
        let q = self.upright((ray.origin - self.shape.center) + ray.direction * meet.t);
        let out = DVec2::new(q.x, q.y).try_normalize().unwrap_or(DVec2::X);
        let ring = DVec3::new(out.x * major, out.y * major, 0.0);
        let mut normal = (q - ring).try_normalize().unwrap_or(DVec3::Z);
        // Inside a spindle the surface seen is that of the ring's other side.
        let other = (q + ring).length();
        let (mut center, on_other) = (ring, ((q - ring).length() - minor).abs() > (other - minor).abs());
        if on_other {
            (center, normal) = (-ring, (q + ring).try_normalize().unwrap_or(normal));
        }
        let point = self.shape.center + self.tilted(center + normal * minor);
        let around = atan2(out.y, out.x) / TAU;
        let tube = atan2(normal.z, normal.x * out.x + normal.y * out.y) / TAU;
        let turn = |x: f64| if x < 0.0 { x + 1.0 } else { x };
        let thinness = 1.0 + major / minor;
        let normal = self.tilted(normal);
        Surface {
            point,
            error: self.shape.center.abs() * gamma(4) + DVec3::splat(self.reach() * thinness * gamma(32)),
            geometric_normal: normal,
            normal,
            tangent: self.tilted(DVec3::new(-out.y, out.x, 0.0)),
            uv: DVec2::new(turn(around), turn(tube)).into(),
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let [major, minor] = self.shape.radii;
        let ring = super::disc::disc_bounds(self.shape.center, self.shape.axis, major);
        padded(ring, DVec3::splat(minor * (1.0 + gamma(8)) + major * gamma(8)))
    }
}
