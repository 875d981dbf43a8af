//! Primitives of a file's meshes as triangles.

use super::accessor::Numbers;
use crate::geometry::mesh::{Mesh, angle_weighted_normals, has_area, unit};
use glam::{DVec2, DVec3};
use gltf::json::Index;
use gltf::json::accessor::{Accessor, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

/// An attribute of a primitive.
pub(super) fn attribute(from: &Primitive, semantic: Semantic) -> Option<Index<Accessor>> {
    from.attributes.get(&Checked::Valid(semantic)).copied()
}

/// The triangles of a primitive, with the set of texture coordinates that its material asks for; none where it has none: points, lines,
/// or triangles without area. Vertices stay in the order of the file, those that no triangle uses too.
pub(super) fn triangles(
    from: &Primitive,
    numbers: &Numbers<'_>,
    uv_set: u32,
) -> Result<Option<Mesh>, String> {
    let Checked::Valid(mode) = from.mode else { return Err("its mode is not known".into()) };
    let Some(position) = attribute(from, Semantic::Positions) else { return Ok(None) };
    if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        return Ok(None);
    }
    let positions: Vec<DVec3> = numbers.elements(position, &[Type::Vec3])?.each().map(DVec3::from).collect();
    let corners = corners(from, numbers, positions.len())?;
    let has_area = |t: &[u32; 3]| has_area(t.map(|i| positions[i as usize]));
    let triangles: Vec<[u32; 3]> = assembled(mode, &corners).filter(has_area).collect();
    if triangles.is_empty() {
        return Ok(None);
    }
    let mut mesh = Mesh { triangles, positions, ..Mesh::default() };
    if let Some(index) = attribute(from, Semantic::Normals) {
        let given = numbers.elements(index, &[Type::Vec3])?;
        of_count("normals", given.count(), mesh.positions.len())?;
        mesh.normals = normals(given.each(), &mesh);
    }
    if let Some(index) = attribute(from, Semantic::TexCoords(uv_set)) {
        let given = numbers.elements(index, &[Type::Vec2])?;
        of_count("texture coordinates", given.count(), mesh.positions.len())?;
        // There (0, 0) is the top left corner of a picture.
        mesh.uvs = given.each().map(|[u, v]| DVec2::new(u, 1.0 - v)).collect();
    }
    Ok(Some(mesh))
}

/// Whether an attribute has one element for each vertex.
pub(super) fn of_count(what: &str, given: usize, expected: usize) -> Result<(), String> {
    if given == expected { Ok(()) } else { Err(format!("it has {given} {what} for {expected} vertices")) }
}

/// The vertices in the order in which the mode takes them.
fn corners(from: &Primitive, numbers: &Numbers<'_>, count: usize) -> Result<Vec<u32>, String> {
    let Some(index) = from.indices else { return Ok((0..count as u32).collect()) };
    let corners = numbers.whole(index, &[Type::Scalar])?;
    match corners.iter().find(|i| **i as usize >= count) {
        Some(outside) => Err(format!("it refers to vertex {outside}, but it has {count}")),
        None => Ok(corners),
    }
}

fn assembled(mode: Mode, corners: &[u32]) -> Box<dyn Iterator<Item = [u32; 3]> + '_> {
    match mode {
        Mode::TriangleStrip => {
            let wound =
                |(i, w): (usize, &[u32])| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            Box::new(corners.windows(3).enumerate().map(wound))
        }
        Mode::TriangleFan => {
            Box::new(corners.get(1..).unwrap_or_default().windows(2).map(|w| [corners[0], w[0], w[1]]))
        }
        _ => Box::new(corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]])),
    }
}

/// Given normals of length 1; those of no length are computed from the triangles around.
fn normals(given: impl Iterator<Item = [f64; 3]>, mesh: &Mesh) -> Vec<DVec3> {
    let mut normals: Vec<DVec3> = given.map(|n| unit(DVec3::from(n)).unwrap_or(DVec3::ZERO)).collect();
    if normals.contains(&DVec3::ZERO) {
        let corners = mesh.triangles.iter().map(|t| (*t, t.map(|i| mesh.positions[i as usize])));
        let computed = angle_weighted_normals(normals.len(), corners);
        let lacking = normals.iter_mut().zip(computed).filter(|(n, _)| **n == DVec3::ZERO);
        lacking.for_each(|(n, computed)| *n = computed);
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_turn_all_triangles_one_way() {
        let of = |mode, corners: &[u32]| assembled(mode, corners).collect::<Vec<_>>();
        assert_eq!(of(Mode::TriangleStrip, &[0, 1, 2, 3, 4]), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        assert_eq!(of(Mode::TriangleFan, &[0, 1, 2, 3]), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(of(Mode::Triangles, &[0, 1, 2, 3, 4]), [[0, 1, 2]]);
        for mode in [Mode::TriangleStrip, Mode::TriangleFan, Mode::Triangles] {
            assert!(of(mode, &[]).is_empty() && of(mode, &[0, 1]).is_empty());
        }
    }
}
