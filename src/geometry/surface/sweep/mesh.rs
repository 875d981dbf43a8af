//! Sweeps as triangles.

use super::Sweep;
use crate::geometry::mesh::Mesh;
use crate::geometry::surface::SurfacePoint;
use crate::geometry::surface::mesh::{even, face, grid, steps_along};

impl Sweep {
    /// Triangles within the tolerance, with normals and (u, v).
    pub fn mesh(&self, tolerance: f64) -> Mesh {
        // Half for the way along, half for the way around.
        let tolerance = 0.5 * tolerance;
        let places = self.outline.places(tolerance);
        let second = self.tree.pieces().iter().flat_map(|piece| {
            piece.points.into_iter().flat_map(|p| [p[0] - 2.0 * p[1] + p[2], p[1] - 2.0 * p[2] + p[3]])
        });
        let steps = steps_along(second.fold(0.0, |m: f64, d| m.max(6.0 * d.length())), tolerance);
        let rows: Vec<(usize, f64)> = (0..self.steps)
            .flat_map(|step| even(steps).skip(usize::from(step > 0)).map(move |v| (step, v)))
            .collect();
        let at = |i: usize, k: usize| {
            let ((step, v), (piece, x)) = (rows[i], places[k]);
            self.point(piece as usize * self.steps + step, x, v)
        };
        let mut mesh = Mesh::default();
        grid(&mut mesh, rows.len(), places.len(), at);
        for (row, end) in [0, rows.len() - 1].into_iter().zip(self.ends.iter().flatten()) {
            let flat = |p: SurfacePoint| SurfacePoint { normal: end.along, uv: end.flat(p.point), ..p };
            let mut outline: Vec<SurfacePoint> = (0..places.len()).map(|k| flat(at(row, k))).collect();
            outline.dedup_by(|a, b| a.point == b.point);
            outline.pop();
            face(&mut mesh, &outline);
        }
        mesh
    }
}
