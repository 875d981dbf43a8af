//! Surfaces of revolution as triangles.

use super::{Arc, Lathe, START_OUT, out_at};
use crate::geometry::mesh::Mesh;
use crate::geometry::surface::SurfacePoint;
use crate::geometry::surface::mesh::{even, face, grid, steps_along, steps_around};
use crate::math::elementary::sin_cos;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A place of the profile.
struct Place {
    at: DVec2,
    direction: DVec2,
    share: f64,
}

impl Lathe {
    /// Triangles within the tolerance, with normals and (u, v).
    pub fn mesh(&self, tolerance: f64) -> Mesh {
        // Half for the way along, half for the way around.
        let tolerance = 0.5 * tolerance;
        let mut arcs: Vec<&Arc> = self.arcs.iter().collect();
        arcs.sort_by(|a, b| a.shares.0.total_cmp(&b.shares.0).then(a.shares.1.total_cmp(&b.shares.1)));
        let places: Vec<Place> = arcs.iter().flat_map(|arc| arc.places(tolerance)).collect();
        let widest = places.iter().fold(0.0, |m: f64, p| m.max(p.at.x));
        let angle = self.angle.unwrap_or(TAU);
        let around = (steps_around(widest, tolerance) as f64 * angle / TAU).ceil().max(2.0) as usize;
        let turn = |j: usize| {
            if self.angle.is_none() && j == around { 0.0 } else { angle * j as f64 / around as f64 }
        };
        let mut mesh = Mesh::default();
        // A kink of the profile has a place for each side.
        grid(&mut mesh, places.len(), around + 1, |i, j| {
            let (s, c) = sin_cos(turn(j));
            let Place { at, direction, share } = &places[i];
            let normal = DVec3::new(c * direction.y, -direction.x, -s * direction.y) * self.side;
            let uv = DVec2::new(j as f64 / around as f64, *share);
            let tangent = DVec3::new(-s, 0.0, -c);
            SurfacePoint { point: DVec3::new(at.x * c, at.y, -at.x * s), normal, tangent, uv }
        });
        if self.angle.is_some() && self.solid {
            for (turn, normal) in [(0.0, START_OUT), (angle, out_at(angle))] {
                face(&mut mesh, &outline(&places, turn, normal));
            }
        }
        mesh
    }
}

/// The profile as a flat face at an angle.
fn outline(places: &[Place], turn: f64, normal: DVec3) -> Vec<SurfacePoint> {
    let (s, c) = sin_cos(turn);
    let out = DVec3::new(c, 0.0, -s);
    let mut points: Vec<SurfacePoint> = places
        .iter()
        .map(|p| SurfacePoint { point: out * p.at.x + DVec3::Y * p.at.y, normal, tangent: out, uv: p.at })
        .collect();
    points.dedup_by(|a, b| a.point == b.point);
    if points.len() > 1 && points[0].point == points[points.len() - 1].point {
        points.pop();
    }
    points
}

impl Arc {
    fn places(&self, tolerance: f64) -> Vec<Place> {
        let curve = self.curve();
        let steps = steps_along(curve.largest_acceleration(), tolerance);
        let at = |x: f64| Place { at: self.at(x), direction: self.direction(x), share: self.share(x) };
        even(steps).map(at).collect()
    }
}
