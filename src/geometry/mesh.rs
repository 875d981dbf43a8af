//! An indexed triangle mesh and what is computed on it: normals, ear clipping, validation.

use glam::{DVec2, DVec3};

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
    /// Which of the mesh's own materials each triangle has; empty where the whole mesh has that of its object.
    pub material_of_triangle: Vec<u16>,
}
