//! Triangles made finer where the motion bends them: an edge is halved until its image is straight within a tolerance, at its middle and at its
//! quarters, and with it the longest edge of each triangle that it is one of, so that triangles stay well shaped (slivers would be true in place
//! and wrong in direction). Source: Rivara 1984, "Algorithms for refining triangular grids".
//!
//! Edges are told apart by where their ends are and not by their numbers, so that no crack opens where two triangles have vertices of their own
//! in one place.

use crate::geometry::mesh::Mesh;
use crate::math::error::gamma;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// Halvings of an edge at most. A motion that tears never settles; 2⁻⁸ of an edge is as near as it is followed.
const MOST_HALVINGS: usize = 8;

/// A mesh of more triangles than this is halved no further: finer than a picture shows, and as much as memory should hold.
const MOST_TRIANGLES: usize = 1 << 22;

/// Where on an edge its image is compared: the middle alone is in its place on an edge across a twist too, whose image is an S, and leaves
/// triangles there that stand across the surface.
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];

/// Where a motion takes points.
pub type Images<'f, E> = dyn Fn(&[DVec3]) -> Result<Vec<DVec3>, E> + 'f;

/// Halves edges of a mesh until `images` (of points to where a motion takes them) are straight along them within `tolerance`.
pub fn refine<E>(mesh: &mut Mesh, tolerance: f64, images: &Images<'_, E>) -> Result<(), E> {
    let mut places = Places::of(&mesh.positions);
    let mut moved = images(&places.points)?;
    let mut fresh = mesh.triangles.clone();
    // Each halving of an edge may come with one of the longest edge beside it.
    for _ in 0..2 * MOST_HALVINGS {
        let bent = bent(&places, &moved, &fresh, tolerance, images)?;
        if bent.is_empty() || mesh.triangles.len() > MOST_TRIANGLES {
            break;
        }
        let halved = with_longest(&places, &mesh.triangles, bent);
        fresh = split(mesh, &mut places, &halved);
        moved.extend(images(&places.points[moved.len()..])?);
    }
    Ok(())
}

/// The places of vertices: those in one place share a number.
struct Places {
    of_vertex: Vec<u32>,
    points: Vec<DVec3>,
    /// The number of the middle of two places, where it was made.
    middles: HashMap<Edge, u32>,
}

/// Two places, the lower number first.
type Edge = [u32; 2];

impl Places {
    fn of(positions: &[DVec3]) -> Places {
        let mut places = Places { of_vertex: Vec::new(), points: Vec::new(), middles: HashMap::new() };
        let mut known: HashMap<[u64; 3], u32> = HashMap::with_capacity(positions.len());
        for p in positions {
            // 0 takes the sign away from −0.
            let bits = (*p + DVec3::ZERO).to_array().map(f64::to_bits);
            let place = *known.entry(bits).or_insert_with(|| {
                places.points.push(*p);
                places.points.len() as u32 - 1
            });
            places.of_vertex.push(place);
        }
        places
    }

    fn edge(&self, a: u32, b: u32) -> Edge {
        let [a, b] = [a, b].map(|vertex| self.of_vertex[vertex as usize]);
        [a.min(b), a.max(b)]
    }

    fn edges(&self, [a, b, c]: [u32; 3]) -> [Edge; 3] {
        [self.edge(a, b), self.edge(b, c), self.edge(c, a)]
    }

    fn length_squared(&self, [a, b]: Edge) -> f64 {
        self.points[a as usize].distance_squared(self.points[b as usize])
    }

    fn middle(&mut self, edge: Edge) -> u32 {
        *self.middles.entry(edge).or_insert_with(|| {
            self.points.push(middle(&self.points, edge));
            self.points.len() as u32 - 1
        })
    }
}

fn middle(of: &[DVec3], [a, b]: Edge) -> DVec3 {
    (of[a as usize] + of[b as usize]) * 0.5
}

/// The edges of some triangles whose images are not straight.
fn bent<E>(
    places: &Places,
    moved: &[DVec3],
    triangles: &[[u32; 3]],
    tolerance: f64,
    images: &Images<'_, E>,
) -> Result<HashSet<Edge>, E> {
    let mut edges: Vec<Edge> = triangles.iter().flat_map(|t| places.edges(*t)).collect();
    edges.sort_unstable();
    edges.dedup();
    // An edge of two finer triangles may be halved from the other side already.
    edges.retain(|edge| !places.middles.contains_key(edge));
    let within = |of: &[DVec3], [a, b]: Edge, t: f64| of[a as usize].lerp(of[b as usize], t);
    let points = edges.iter().flat_map(|edge| PLACES.map(|t| within(&places.points, *edge, t)));
    let images = images(&points.collect::<Vec<DVec3>>())?;
    let straight = |edge: Edge, images: &[DVec3]| {
        let mut both = PLACES.iter().zip(images);
        both.all(|(t, image)| agree(*image, within(moved, edge, *t), tolerance))
    };
    let looked_at = edges.into_iter().zip(images.chunks(PLACES.len()));
    Ok(looked_at.filter(|(edge, images)| !straight(*edge, images)).map(|(edge, _)| edge).collect())
}

/// True for points within a tolerance of one another, or as near as their rounding lets one say; and where there is no
/// place to compare.
fn agree(a: DVec3, b: DVec3, tolerance: f64) -> bool {
    let gap = a - b;
    let rounding = (a.abs() + b.abs()).max_element() * gamma(64);
    gap.length() <= tolerance || gap.abs().max_element() <= rounding || !gap.is_finite()
}

/// Those edges, with the longest edge of each triangle that has one of them, and of each that has one of those.
fn with_longest(places: &Places, triangles: &[[u32; 3]], mut halved: HashSet<Edge>) -> HashSet<Edge> {
    loop {
        let before = halved.len();
        for triangle in triangles {
            let edges = places.edges(*triangle);
            if edges.iter().any(|edge| halved.contains(edge)) {
                let longer = |a: Edge, b: Edge| {
                    let by_length = places.length_squared(a).total_cmp(&places.length_squared(b));
                    if by_length.then(a.cmp(&b)).is_ge() { a } else { b }
                };
                halved.insert(longer(longer(edges[0], edges[1]), edges[2]));
            }
        }
        if halved.len() == before {
            return halved;
        }
    }
}

/// Cuts the triangles that have such edges. Gives those that this made.
fn split(mesh: &mut Mesh, places: &mut Places, halved: &HashSet<Edge>) -> Vec<[u32; 3]> {
    let before = std::mem::take(&mut mesh.triangles);
    let materials = std::mem::take(&mut mesh.material_of_triangle);
    let (mut after, mut fresh) = (Vec::with_capacity(before.len()), Vec::new());
    let mut vertices: HashMap<[u32; 2], u32> = HashMap::new();
    for (k, triangle) in before.into_iter().enumerate() {
        let middles = [0, 1, 2].map(|side| {
            let (a, b) = (triangle[side], triangle[(side + 1) % 3]);
            let edge = places.edge(a, b);
            let is_halved = halved.contains(&edge);
            is_halved.then(|| {
                *vertices.entry([a.min(b), a.max(b)]).or_insert_with(|| halve(mesh, places, [a, b], edge))
            })
        });
        let start = after.len();
        cut(triangle, middles, &mut after);
        if after.len() > start + 1 {
            fresh.extend_from_slice(&after[start..]);
        }
        if let Some(material) = materials.get(k) {
            mesh.material_of_triangle.resize(after.len(), *material);
        }
    }
    mesh.triangles = after;
    fresh
}

/// A vertex in the middle of two.
fn halve(mesh: &mut Mesh, places: &mut Places, vertices: [u32; 2], edge: Edge) -> u32 {
    let [a, b] = vertices.map(|k| k as usize);
    let place = places.middle(edge);
    places.of_vertex.push(place);
    mesh.positions.push(places.points[place as usize]);
    if !mesh.normals.is_empty() {
        let normal = (mesh.normals[a] + mesh.normals[b]).try_normalize().unwrap_or(mesh.normals[a]);
        mesh.normals.push(normal);
    }
    if !mesh.uvs.is_empty() {
        mesh.uvs.push((mesh.uvs[a] + mesh.uvs[b]) * 0.5);
    }
    mesh.positions.len() as u32 - 1
}

/// A triangle in as many parts as its edges' middles make; `middles` by the corner before each edge.
fn cut(triangle: [u32; 3], middles: [Option<u32>; 3], into: &mut Vec<[u32; 3]>) {
    // Turned so that the first edge is halved, and, of two, the second is the other.
    let first = match middles.map(|m| m.is_some()) {
        [true, true, true] | [false, false, false] | [true, _, false] => 0,
        [false, true, _] => 1,
        [_, false, true] => 2,
    };
    let [a, b, c] = [0, 1, 2].map(|k| triangle[(first + k) % 3]);
    let [ab, bc, ca] = [0, 1, 2].map(|k| middles[(first + k) % 3]);
    match (ab, bc, ca) {
        (Some(ab), Some(bc), Some(ca)) => into.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]),
        (Some(ab), Some(bc), None) => into.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
        (Some(ab), None, _) => into.extend([[a, ab, c], [ab, b, c]]),
        (None, ..) => into.push(triangle),
    }
}
