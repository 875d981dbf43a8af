//! Surfaces cut into pieces that can be sampled by area: parallelograms, ellipses, triangles, and curved ones by their
//! parameters. All in world space.

use super::SurfacePoint;
use crate::math::Affine;
use crate::math::elementary::{atan2, sin_cos_turns};
use crate::math::error::gamma;
use crate::scene::{Cone, Torus};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A piece of surface.
#[derive(Clone, Debug)]
pub(super) enum Piece {
    /// center ± a ± b.
    Parallelogram { center: DVec3, a: DVec3, b: DVec3, normal: DVec3, area: f64 },
    /// center + a cos φ + b sin φ and all inside.
    Ellipse { center: DVec3, a: DVec3, b: DVec3, normal: DVec3, area: f64 },
    /// A corner and the edges from it; the corners' texture coordinates.
    Triangle { corner: DVec3, edges: [DVec3; 2], normal: DVec3, uvs: Option<[DVec2; 3]>, area: f64 },
    /// A surface given by two parameters, under any affine map.
    Curved { shape: Curved, place: Box<Affine> },
}

/// Curved surfaces over the unit square, in their own space.
#[derive(Clone, Copy, Debug)]
pub(super) enum Curved {
    Sphere {
        center: DVec3,
        radius: f64,
    },
    /// The side of a frustum; `x`, `y` are unit vectors across its axis.
    Side {
        cone: Cone,
        x: DVec3,
        y: DVec3,
    },
    /// `x`, `y` unit vectors in the plane of the ring.
    Torus {
        torus: Torus,
        x: DVec3,
        y: DVec3,
    },
}

/// A point of a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct PiecePoint {
    /// The point with its outward normal.
    pub at: SurfacePoint,
    /// Area of the surface per unit of (0, 1)² around it: one over the density per area.
    pub area: f64,
    /// Parameters for textures.
    pub uv: DVec2,
}

impl Piece {
    /// The point that u in (0, 1)² chooses.
    pub(super) fn point(&self, u: DVec2) -> PiecePoint {
        match self {
            Piece::Parallelogram { center, a, b, normal, area } => {
                let s = u * 2.0 - 1.0;
                flat(*center, *a * s.x, *b * s.y, *normal, *area, u)
            }
            Piece::Ellipse { center, a, b, normal, area } => {
                let (s, c) = sin_cos_turns(u.y);
                let r = u.x.sqrt();
                let uv = (DVec2::new(r * c, r * s) + 1.0) / 2.0;
                flat(*center, *a * (r * c), *b * (r * s), *normal, *area, uv)
            }
            Piece::Triangle { corner, edges: [e, f], normal, uvs, area } => {
                let r = u.x.sqrt();
                let (s, t) = (r * (1.0 - u.y), r * u.y);
                let uv = uvs.map_or(DVec2::new(s, t), |[p, q, o]| p * (1.0 - s - t) + q * s + o * t);
                flat(*corner, *e * s, *f * t, *normal, *area, uv)
            }
            Piece::Curved { shape, place } => shape.point(place, u),
        }
    }

    /// Its area, exactly where it is flat, roughly where it is curved: for choosing among pieces only.
    pub(super) fn weight(&self) -> f64 {
        self.point(DVec2::splat(0.5)).area
    }
}

/// A point p + a + b of a flat piece: at most three roundings a coordinate on numbers that a few more have made.
fn flat(p: DVec3, a: DVec3, b: DVec3, normal: DVec3, area: f64, uv: DVec2) -> PiecePoint {
    let error = (p.abs() + a.abs() + b.abs()) * gamma(12);
    PiecePoint { at: SurfacePoint { point: p + a + b, error, normal }, area, uv }
}

impl Curved {
    /// The point at parameters u, with the area element |M·∂u × M·∂v|.
    fn point(self, place: &Affine, u: DVec2) -> PiecePoint {
        let (p, du, dv, normal, size) = self.local(u);
        let (linear, point) = (place.linear, place.point(p));
        // Every coordinate of the point is a sum of products of a few factors, bounded by the sizes of its terms.
        let m = glam::DMat3::from_cols(linear.x_axis.abs(), linear.y_axis.abs(), linear.z_axis.abs());
        let error = (m * size + place.translation.abs()) * gamma(24);
        let area = (linear * du).cross(linear * dv).length();
        let at = SurfacePoint { point, error, normal: place.normal(normal).normalize() };
        let uv = match self {
            Curved::Sphere { .. } => sphere_uv(normal),
            Curved::Side { .. } | Curved::Torus { .. } => u,
        };
        PiecePoint { at, area, uv }
    }

    /// Point, partial derivatives, outward normal, and a bound on the terms that the point was summed from.
    fn local(self, u: DVec2) -> (DVec3, DVec3, DVec3, DVec3, DVec3) {
        let (s, c) = sin_cos_turns(u.x);
        match self {
            Curved::Sphere { center, radius } => {
                let z = 2.0 * u.y - 1.0;
                let r = (1.0 - z * z).max(0.0).sqrt();
                let n = DVec3::new(r * c, r * s, z);
                // Archimedes: area is even in z and the longitude, so any two vectors of the right product do.
                let (a, b) = super::frame(n);
                let k = (2.0 * TAU).sqrt() * radius;
                (center + n * radius, a * k, b * k, n, center.abs() + DVec3::splat(radius))
            }
            Curved::Side { cone, x, y } => {
                let axis = cone.to - cone.from;
                let [r0, r1] = cone.radii;
                let r = r0 + (r1 - r0) * u.y;
                let out = x * c + y * s;
                let n = out * axis.length_squared() - axis * (r1 - r0);
                let size = cone.from.abs() + axis.abs() + DVec3::splat(r0.max(r1));
                let along = axis + out * (r1 - r0);
                (cone.from + axis * u.y + out * r, (y * c - x * s) * (TAU * r), along, n, size)
            }
            Curved::Torus { torus, x, y } => {
                let [major, minor] = torus.radii;
                let (st, ct) = sin_cos_turns(u.y);
                let out = x * c + y * s;
                let n = out * ct + torus.axis * st;
                let r = major + minor * ct;
                let (du, dv) = ((y * c - x * s) * (TAU * r), (torus.axis * ct - out * st) * (TAU * minor));
                (
                    torus.center + out * major + n * minor,
                    du,
                    dv,
                    n,
                    torus.center.abs() + DVec3::splat(major + minor),
                )
            }
        }
    }
}

/// (u, v) of a sphere by its normal, of any length, in its own space: as the sphere's hits report them.
pub(super) fn sphere_uv(n: DVec3) -> DVec2 {
    let horizontal = (n.x * n.x + n.z * n.z).sqrt();
    DVec2::new(0.5 + atan2(n.x, n.z) / TAU, 0.5 + atan2(n.y, horizontal) / PI)
}
