//! Tubes as triangles: rings where the balls touch the wall, and more of them over round ends.

use super::arc::Arc;
use super::{Caps, Tube};
use crate::geometry::mesh::Mesh;
use crate::geometry::surface::SurfacePoint;
use crate::geometry::surface::mesh::{even, face, grid, steps_around};
use crate::math::elementary::{acos, cos, sin_cos};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A circle of the wall, or of a ball at an end.
#[derive(Clone, Copy)]
struct Ring {
    center: DVec3,
    radius: f64,
    side: DVec3,
    up: DVec3,
    along: DVec3,
    /// The normal's part along the curve: minus the change of the radius by length.
    lean: f64,
    share: f64,
}

impl Tube {
    /// Triangles within the tolerance, with normals and (u, v). Where balls of one place lie inside those of another the wall passes through
    /// itself, as the curve has it.
    pub fn mesh(&self, tolerance: f64) -> Mesh {
        // Half for the way along, half for the way around.
        let tolerance = 0.5 * tolerance;
        let mut arcs: Vec<&Arc> = self.arcs.iter().collect();
        arcs.sort_by(|a, b| a.shares.0.total_cmp(&b.shares.0).then(a.shares.1.total_cmp(&b.shares.1)));
        let thick = arcs.iter().flat_map(|arc| arc.radii).fold(0.0, f64::max);
        let around = steps_around(thick, tolerance);
        let mut rings: Vec<Ring> = Vec::new();
        for (k, arc) in arcs.iter().enumerate() {
            let places = even(arc.steps(tolerance)).skip(usize::from(k > 0));
            rings.extend(places.map(|x| Ring::of(arc, x, self.twist)));
        }
        let mut mesh = Mesh::default();
        let last = rings.len() - 1;
        match (self.ends.is_some(), self.caps) {
            (false, _) => rings[last] = Ring { share: 1.0, ..rings[0] },
            (true, Caps::Round) => round_off(&mut rings, around / 4 + 1),
            (true, Caps::Flat | Caps::Open) => {
                (rings[0].lean, rings[last].lean) = (0.0, 0.0);
                if self.caps == Caps::Flat {
                    face(&mut mesh, &rings[0].outline(around, -1.0));
                    face(&mut mesh, &rings[last].outline(around, 1.0));
                }
            }
        }
        grid(&mut mesh, rings.len(), around + 1, |i, j| rings[i].at(j, around));
        mesh
    }
}

/// Adds the rings of both ends, from their poles to the first and last ring.
fn round_off(rings: &mut Vec<Ring>, steps: usize) {
    let (first, last) = (rings[0], rings[rings.len() - 1]);
    let cap = |ring: Ring, sign: f64| {
        let whole = acos((sign * ring.lean).clamp(-1.0, 1.0));
        let at = move |x: f64| Ring { lean: sign * cos(whole * x), ..ring };
        even(steps).take(steps).map(at).collect::<Vec<_>>()
    };
    let end = cap(last, 1.0);
    rings.splice(0..0, cap(first, -1.0));
    rings.extend(end.into_iter().rev());
}

impl Ring {
    fn of(arc: &Arc, x: f64, twist: f64) -> Ring {
        let (center, radius) = arc.at(x);
        let (side, up, along) = arc.frame(x, twist);
        let (speed, change) = arc.speeds(x);
        let lean = if speed > 0.0 { (-change / speed).clamp(-1.0, 1.0) } else { 0.0 };
        Ring { center, radius, side, up, along, lean, share: arc.share(x) }
    }

    /// The point after j of n steps around; the last is the first.
    fn at(&self, j: usize, n: usize) -> SurfacePoint {
        let (s, c) = sin_cos(TAU * (j % n) as f64 / n as f64);
        let out = self.side * c + self.up * s;
        let normal = self.along * self.lean + out * (1.0 - self.lean * self.lean).max(0.0).sqrt();
        let point = self.center + normal * self.radius;
        SurfacePoint {
            point,
            normal,
            tangent: self.along.cross(out),
            uv: DVec2::new(j as f64 / n as f64, self.share),
        }
    }

    /// The same points with the normal of the plane across the curve.
    fn outline(&self, n: usize, sign: f64) -> Vec<SurfacePoint> {
        (0..n).map(|j| SurfacePoint { normal: self.along * sign, ..self.at(j, n) }).collect()
    }
}
