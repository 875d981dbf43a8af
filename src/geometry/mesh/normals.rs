//! Vertex normals from the faces around a vertex.

use super::doubled_area;
use crate::math::elementary::atan2;
use crate::math::error::gamma;
use glam::DVec3;

/// The unit vector along `v`, whatever its length; none for 0 and for what is not finite.
pub fn unit(v: DVec3) -> Option<DVec3> {
    let size = v.abs().max_element();
    (size > 0.0 && v.is_finite()).then(|| (v / size).normalize())
}

/// A sum of face normals shorter than this share of its weights is rounding and not a direction: the bound on the rounding of
/// a sum of a thousand terms (more faces at one vertex only make the fallback start a little late).
const CANCELLED: f64 = gamma(1024);

/// Smooth unit normals: at each slot the sum of the unit normals of the faces around it, weighted by the faces' angles there,
/// so that the way a surface is cut into triangles does not tilt them (Thürmer & Wüthrich, *Computing vertex normals from
/// polygonal facets*, 1998). A corner says in which slot it counts and where it is.
///
/// Where the normals cancel (two faces back to back), the first face's is taken; where no face at a slot has an area, +y.
pub fn angle_weighted_normals(
    n_slots: usize,
    triangles: impl Iterator<Item = ([u32; 3], [DVec3; 3])> + Clone,
) -> Vec<DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0); n_slots];
    for (slots, corners) in triangles.clone() {
        let corners = at_unit_size(corners);
        let Some(normal) = unit(doubled_area(corners)) else { continue };
        for (slot, angle) in slots.into_iter().zip(angles(corners)) {
            let (sum, weight) = &mut sums[slot as usize];
            *sum += normal * angle;
            *weight += angle;
        }
    }
    let direction = |(sum, weight): (DVec3, f64)| unit(sum).filter(|_| sum.length() > CANCELLED * weight);
    let mut normals: Vec<DVec3> = sums.into_iter().map(|s| direction(s).unwrap_or(DVec3::ZERO)).collect();
    fill_gaps(&mut normals, triangles);
    normals
}

fn fill_gaps(normals: &mut [DVec3], triangles: impl Iterator<Item = ([u32; 3], [DVec3; 3])>) {
    if normals.iter().all(|n| *n != DVec3::ZERO) {
        return;
    }
    for (slots, corners) in triangles {
        for slot in slots {
            let normal = &mut normals[slot as usize];
            if *normal == DVec3::ZERO {
                *normal = unit(doubled_area(at_unit_size(corners))).unwrap_or(DVec3::ZERO);
            }
        }
    }
    normals.iter_mut().filter(|n| **n == DVec3::ZERO).for_each(|n| *n = DVec3::Y);
}

/// The triangle moved to the origin and scaled, so that no product of its edges under- or overflows.
fn at_unit_size([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    let (u, v) = (b - a, c - a);
    let size = u.abs().max(v.abs()).max_element();
    [DVec3::ZERO, u / size, v / size]
}

/// The angles at a triangle's corners, radians.
fn angles([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let angle = |p: DVec3, q: DVec3, r: DVec3| {
        let (u, v) = (q - p, r - p);
        atan2(u.cross(v).length(), u.dot(v))
    };
    let (at_a, at_b) = (angle(a, b, c), angle(b, c, a));
    [at_a, at_b, (std::f64::consts::PI - at_a - at_b).max(0.0)]
}
