//! Triangles made finer where the motion bends them: an edge is halved until the middle of its image is the image of its middle, within a
//! tolerance. Whether an edge is halved follows from its ends alone, so that no crack opens between triangles, of one mesh or of two.

use crate::geometry::mesh::Mesh;
use glam::DVec3;
use std::collections::HashMap;

/// Halvings of an edge at most. A motion that tears never settles; 2⁻⁸ of an edge is as near as it is followed.
const MOST_HALVINGS: usize = 8;

/// Where a motion takes points.
pub type Images<'f, E> = dyn Fn(&[DVec3]) -> Result<Vec<DVec3>, E> + 'f;

/// Halves edges of a mesh until `images` (of points to where a motion takes them) are straight along them within `tolerance`.
pub fn refine<E>(mesh: &mut Mesh, tolerance: f64, images: &Images<'_, E>) -> Result<(), E> {
    let mut moved = images(&mesh.positions)?;
    let mut waiting: Vec<[u32; 2]> = edges(&mesh.triangles);
    for _ in 0..MOST_HALVINGS {
        let halved = bent(mesh, &mut moved, &waiting, tolerance, images)?;
        if halved.is_empty() {
            break;
        }
        waiting = split(mesh, &halved);
    }
    Ok(())
}

/// The middle of an edge, by the numbers of its ends in rising order.
type Middles = HashMap<[u32; 2], u32>;

/// Adds the middles of those edges whose images are not straight.
fn bent<E>(
    mesh: &mut Mesh,
    moved: &mut Vec<DVec3>,
    edges: &[[u32; 2]],
    tolerance: f64,
    images: &Images<'_, E>,
) -> Result<Middles, E> {
    let middle = |of: &[DVec3], [a, b]: [u32; 2]| (of[a as usize] + of[b as usize]) * 0.5;
    let middles: Vec<DVec3> = edges.iter().map(|edge| middle(&mesh.positions, *edge)).collect();
    let images = images(&middles)?;
    let mut halved = Middles::new();
    for ((edge, p), image) in edges.iter().zip(middles).zip(images) {
        if image.distance(middle(moved, *edge)) <= tolerance {
            continue;
        }
        halved.insert(*edge, mesh.positions.len() as u32);
        let [a, b] = edge.map(|k| k as usize);
        if !mesh.normals.is_empty() {
            let normal = (mesh.normals[a] + mesh.normals[b]).try_normalize().unwrap_or(mesh.normals[a]);
            mesh.normals.push(normal);
        }
        if !mesh.uvs.is_empty() {
            mesh.uvs.push((mesh.uvs[a] + mesh.uvs[b]) * 0.5);
        }
        mesh.positions.push(p);
        moved.push(image);
    }
    Ok(halved)
}

/// Cuts the triangles whose edges have middles. Gives the edges that this made.
fn split(mesh: &mut Mesh, middles: &Middles) -> Vec<[u32; 2]> {
    let (before, materials) =
        (std::mem::take(&mut mesh.triangles), std::mem::take(&mut mesh.material_of_triangle));
    let mut fresh = Vec::new();
    for (k, triangle) in before.into_iter().enumerate() {
        let start = mesh.triangles.len();
        cut(triangle, middles, &mut mesh.triangles);
        if mesh.triangles.len() > start + 1 {
            fresh.extend_from_slice(&mesh.triangles[start..]);
        }
        if let Some(material) = materials.get(k) {
            mesh.material_of_triangle.resize(mesh.triangles.len(), *material);
        }
    }
    edges(&fresh)
}

/// A triangle in as many parts as its edges' middles make.
fn cut(triangle: [u32; 3], middles: &Middles, into: &mut Vec<[u32; 3]>) {
    let middle = |k: usize| middles.get(&key(triangle[k], triangle[(k + 1) % 3])).copied();
    // Turned so that the first corner is before a halved edge, and, of two, the second edge is the other.
    let halved = [0, 1, 2].map(|k| middle(k).is_some());
    let first = match halved {
        [true, true, true] | [false, false, false] | [true, _, false] => 0,
        [false, true, _] => 1,
        [_, false, true] => 2,
    };
    let [a, b, c] = [0, 1, 2].map(|k| triangle[(first + k) % 3]);
    let [ab, bc, ca] = [0, 1, 2].map(|k| middle((first + k) % 3));
    match (ab, bc, ca) {
        (Some(ab), Some(bc), Some(ca)) => into.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]),
        (Some(ab), Some(bc), None) => into.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
        (Some(ab), None, _) => into.extend([[a, ab, c], [ab, b, c]]),
        (None, ..) => into.push(triangle),
    }
}

fn key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The edges of triangles, each once.
fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut all: Vec<[u32; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [key(a, b), key(b, c), key(c, a)]).collect();
    all.sort_unstable();
    all.dedup();
    all
}
