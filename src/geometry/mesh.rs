//! An indexed triangle mesh and what is computed on it: normals, ear clipping, validation. Knows nothing of files or scenes.

mod normals;
mod triangulate;

pub use normals::{angle_weighted_normals, unit};
pub use triangulate::Triangulator;

use crate::math::Aabb;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// Triangles that share vertices. Always valid: indices in range, positions finite, arrays of one length or empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions, scene units.
    pub positions: Vec<DVec3>,
    /// Unit normals, one per position, or none at all (then faces are flat).
    pub normals: Vec<DVec3>,
    /// Texture coordinates, one per position, or none at all.
    pub uvs: Vec<DVec2>,
    /// Three positions each, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Which of the mesh's own materials each triangle has ([`OBJECT_MATERIAL`]: that of its object); empty where the whole
    /// mesh has that of its object.
    pub material_of_triangle: Vec<u16>,
}

/// The entry of [`Mesh::material_of_triangle`] that says "as its object".
pub const OBJECT_MATERIAL: u16 = u16::MAX;

/// Why numbers make no mesh. Faces, positions and corners are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A face of fewer than three corners.
    #[error("face {face} has {corners} corners, fewer than 3")]
    FewCorners {
        /// Which face.
        face: usize,
        /// Its corners.
        corners: usize,
    },
    /// An index past the last position.
    #[error("face {face} refers to vertex {index}, but there are {count} vertices, counted from 0")]
    IndexOutOfRange {
        /// Which face.
        face: usize,
        /// The index.
        index: u32,
        /// How many positions there are.
        count: usize,
    },
    /// A position, normal or texture coordinate that is NaN or infinite.
    #[error("{what} {index} is not finite")]
    NotFinite {
        /// "vertex", "normal" or "uv".
        what: &'static str,
        /// Which.
        index: usize,
    },
    /// A normal of length 0.
    #[error("normal {index} has no length")]
    ZeroNormal {
        /// Which.
        index: usize,
    },
    /// Normals or texture coordinates that are not one per position.
    #[error("there are {given} {what} for {expected} vertices")]
    CountMismatch {
        /// "normals" or "uvs".
        what: &'static str,
        /// How many positions there are.
        expected: usize,
        /// How many were given.
        given: usize,
    },
    /// No triangle with an area.
    #[error("no face has an area")]
    NoArea,
    /// More vertices or triangles than can be numbered in 32 bits.
    #[error("the mesh has more than 4 294 967 294 vertices or triangles")]
    TooLarge,
}

impl Mesh {
    /// A mesh of polygons with positions from 0. Faces of more than three corners are cut along inner diagonals, concave ones
    /// too; triangles without area are left out. Normals are made unit vectors; `normals` and `uvs` may be empty.
    pub fn from_faces<F: AsRef<[u32]>>(
        positions: Vec<DVec3>,
        faces: impl IntoIterator<Item = F>,
        normals: Vec<DVec3>,
        uvs: Vec<DVec2>,
    ) -> Result<Mesh, MeshError> {
        if positions.len() >= u32::MAX as usize {
            return Err(MeshError::TooLarge);
        }
        all_finite("vertex", positions.iter().map(|p| p.is_finite()))?;
        all_finite("uv", uvs.iter().map(|p| p.is_finite()))?;
        one_each("normals", positions.len(), normals.len())?;
        one_each("uvs", positions.len(), uvs.len())?;
        let normals = unit_normals(normals)?;
        let mut mesh = Mesh { positions, normals, uvs, ..Mesh::default() };
        let mut polygons = Triangulator::default();
        for (face, corners) in faces.into_iter().enumerate() {
            mesh.add_face(&mut polygons, face, corners.as_ref())?;
        }
        if mesh.triangles.is_empty() { Err(MeshError::NoArea) } else { Ok(mesh) }
    }

    fn add_face(
        &mut self,
        polygons: &mut Triangulator,
        face: usize,
        corners: &[u32],
    ) -> Result<(), MeshError> {
        if corners.len() < 3 {
            return Err(MeshError::FewCorners { face, corners: corners.len() });
        }
        let count = self.positions.len();
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= count) {
            return Err(MeshError::IndexOutOfRange { face, index, count });
        }
        let points = corners.iter().map(|&i| self.positions[i as usize]);
        for triangle in polygons.polygon(points) {
            let triangle = triangle.map(|corner| corners[corner as usize]);
            if has_area(triangle.map(|i| self.positions[i as usize])) {
                self.triangles.push(triangle);
            }
        }
        if self.triangles.len() >= u32::MAX as usize { Err(MeshError::TooLarge) } else { Ok(()) }
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|i| self.positions[i as usize])
    }

    /// The box around all triangles (positions that no triangle uses do not count); empty for no triangles.
    pub fn bounds(&self) -> Aabb {
        Aabb::of(self.triangles.iter().flatten().map(|&i| self.positions[i as usize]))
    }

    /// Sum of the triangles' areas, square scene units.
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| doubled_area(self.corners(t)).length() / 2.0).sum()
    }

    /// Signed volume, cubic scene units, where the mesh is closed: positive where its faces look outward.
    pub fn volume(&self) -> f64 {
        let center = self.bounds().center();
        let six_fold = |t| {
            let [a, b, c] = self.corners(t).map(|p| p - center);
            a.dot(b.cross(c))
        };
        (0..self.triangles.len()).map(six_fold).sum::<f64>() / 6.0
    }

    /// Whether each edge lies between two triangles, or some other even number of them, so that the mesh has an inside. Corners at the
    /// same place are one, whatever their numbers.
    pub fn is_closed(&self) -> bool {
        let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
        // Adding 0 makes −0 the same as 0.
        let place_of = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits);
        let places: Vec<u32> = self
            .positions
            .iter()
            .map(|p| {
                let next = numbers.len() as u32;
                *numbers.entry(place_of(*p)).or_insert(next)
            })
            .collect();
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(3 * self.triangles.len());
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| places[i as usize]);
            edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]));
        }
        edges.sort_unstable();
        !edges.is_empty() && edges.chunk_by(|a, b| a == b).all(|same| same.len() % 2 == 0)
    }

    /// Sets smooth normals, one per position, from the triangles around it.
    pub fn compute_normals(&mut self) {
        let corners = self.triangles.iter().map(|t| (*t, t.map(|i| self.positions[i as usize])));
        self.normals = angle_weighted_normals(self.positions.len(), corners);
    }
}

/// (b − a) × (c − a): normal to a triangle, twice as long as its area.
pub fn doubled_area([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Whether a triangle's area, as computed, is not 0. Small triangles are scaled up first, so that their area cannot underflow.
pub fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    let (u, v) = (b - a, c - a);
    let size = u.abs().max(v.abs()).max_element();
    size > 0.0 && (u / size).cross(v / size) != DVec3::ZERO
}

fn all_finite(what: &'static str, finite: impl Iterator<Item = bool>) -> Result<(), MeshError> {
    match finite.enumerate().find(|(_, finite)| !finite) {
        Some((index, _)) => Err(MeshError::NotFinite { what, index }),
        None => Ok(()),
    }
}

fn one_each(what: &'static str, expected: usize, given: usize) -> Result<(), MeshError> {
    if given == 0 || given == expected {
        Ok(())
    } else {
        Err(MeshError::CountMismatch { what, expected, given })
    }
}

fn unit_normals(normals: Vec<DVec3>) -> Result<Vec<DVec3>, MeshError> {
    all_finite("normal", normals.iter().map(|n| n.is_finite()))?;
    let unit = |(index, n)| unit(n).ok_or(MeshError::ZeroNormal { index });
    normals.into_iter().enumerate().map(unit).collect()
}

#[cfg(test)]
mod tests;
