//! Meshes to measure trees on, made by number: a skin of even triangles, hills, triangles around one corner, slivers, a heap that overlaps.

use crate::geometry::mesh::Mesh;
use crate::math::elementary::sin_cos;
use crate::math::random::Random;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The kinds by name.
pub const KINDS: [&str; 5] = ["ball", "hills", "fan", "slivers", "heap"];

/// About `count` triangles of a kind, and at least one; none of an unknown name. Within 2 of the origin.
pub fn procedural(kind: &str, count: usize) -> Option<Mesh> {
    let side = ((count as f64 / 2.0).sqrt().round() as usize).max(3);
    Some(match kind {
        "ball" => grid(side, |u, v| {
            let ((s, c), (polar, along)) = (sin_cos(TAU * u), sin_cos(PI * v));
            DVec3::new(polar * c, along, polar * s)
        }),
        "hills" => grid(side, |u, v| {
            let height = sin_cos(17.0 * u).0 * sin_cos(13.0 * v).1;
            DVec3::new(2.0 * u - 1.0, 0.15 * height + 0.02 * sin_cos(211.0 * u * v).0, 2.0 * v - 1.0)
        }),
        "fan" => fan(count.max(3)),
        "slivers" => heap(count.max(1), [1.0, 1e-3]),
        "heap" => doubled(heap(count.div_ceil(2), [0.4, 0.4])),
        _ => return None,
    })
}

/// A square of parameters, 0 … 1 each, in so many squares a side, each cut in two.
fn grid(side: usize, at: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let part = |i: usize| i as f64 / side as f64;
    let positions =
        (0..=side).flat_map(|j| (0..=side).map(move |i| (i, j))).map(|(i, j)| at(part(i), part(j)));
    let triangles = (0..side * side).flat_map(|square| {
        let first = (square / side * (side + 1) + square % side) as u32;
        let above = first + side as u32 + 1;
        [[first, first + 1, above + 1], [first, above + 1, above]]
    });
    Mesh { positions: positions.collect(), triangles: triangles.collect(), ..Mesh::default() }
}

/// Triangles with one corner in common.
fn fan(count: usize) -> Mesh {
    let rim = (0..=count).map(|i| {
        let (s, c) = sin_cos(TAU * i as f64 / count as f64);
        DVec3::new(c, 0.3 * s * c, s)
    });
    let triangles = (1..=count as u32).map(|i| [0, i, i + 1]).collect();
    Mesh { positions: std::iter::once(DVec3::ZERO).chain(rim).collect(), triangles, ..Mesh::default() }
}

/// Triangles anywhere in a cube, so long and so wide.
fn heap(count: usize, size: [f64; 2]) -> Mesh {
    let mut random = Random::new(11);
    let mut vector = || DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)));
    let mut positions = Vec::with_capacity(3 * count);
    for _ in 0..count {
        let at = vector();
        positions.extend([at, at + vector() * size[0], at + vector() * size[1]]);
    }
    let triangles = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh { positions, triangles, ..Mesh::default() }
}

/// Every triangle twice, so that all meetings are ties.
fn doubled(mut mesh: Mesh) -> Mesh {
    mesh.triangles.extend_from_within(..);
    mesh
}
