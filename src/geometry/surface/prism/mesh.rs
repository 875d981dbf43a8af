//! Prisms as triangles.

use super::Prism;
use crate::geometry::mesh::Mesh;
use crate::geometry::surface::SurfacePoint;
use crate::geometry::surface::mesh::{face, grid};
use glam::DVec2;

impl Prism {
    /// Triangles within the tolerance, with normals and (u, v).
    pub fn mesh(&self, tolerance: f64) -> Mesh {
        let places = self.outline.places(tolerance);
        let super::Placing { side, up, along, .. } = self.placing;
        let at = |row: usize, k: usize| {
            let (piece, x) = places[k];
            let (p, share) = self.outline.at(piece, x);
            let n = self.outline.normal(piece, x);
            let normal = side * n.x + up * n.y;
            let point = self.placing.place(p) + along * (row as f64 * self.height);
            SurfacePoint { point, normal, tangent: along.cross(normal), uv: DVec2::new(share, row as f64) }
        };
        let mut mesh = Mesh::default();
        grid(&mut mesh, 2, places.len(), at);
        for (row, normal) in [(0, -along), (1, along)] {
            let flat = |p: SurfacePoint| SurfacePoint { normal, uv: self.placing.flat(p.point), ..p };
            let mut outline: Vec<SurfacePoint> = (0..places.len()).map(|k| flat(at(row, k))).collect();
            outline.dedup_by(|a, b| a.point == b.point);
            outline.pop();
            face(&mut mesh, &outline);
        }
        mesh
    }
}
