//! The surface of a triangle where a ray meets it.

#[cfg(target_arch = "x86_64")]
mod wide;

use super::{accurate, normal_of};
use crate::math::error::gamma;
use crate::world::shape::{Meet, Surface};
use glam::{DVec2, DVec3};

/// What a triangle's corners may carry.
#[derive(Clone, Copy, Debug, Default)]
pub struct Corners<'m> {
    /// Unit shading normals.
    pub normals: Option<[&'m DVec3; 3]>,
    /// Texture coordinates; barycentric ones where there are none.
    pub uvs: Option<[&'m DVec2; 3]>,
}

/// The surface of a triangle at barycentric coordinates. The geometric normal follows the corner normals where there are any
/// (files wind their faces carelessly more often than they turn normals inside out), else the winding. Its tangent is only found where the
/// normal is to be `bent` by a map, else it is 0.
#[inline(always)]
pub fn surface_of(corners: [&DVec3; 3], data: Corners<'_>, meet: &Meet, bent: bool) -> Surface {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_v3() {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe { wide::surface_of(corners, &data, meet.a, meet.b, bent) };
    }
    plain_surface_of(corners, &data, meet.a, meet.b, bent)
}

/// The same one number at a time.
fn plain_surface_of(corners: [&DVec3; 3], data: &Corners<'_>, u: f64, v: f64, bent: bool) -> Surface {
    let [a, b, c] = corners.map(|p| *p);
    let weights = [1.0 - u - v, u, v];
    let point = a * weights[0] + b * weights[1] + c * weights[2];
    let spread = |p: DVec3, w: f64| (p * w).abs() + (p - point).abs() * w.abs();
    let error = (spread(a, weights[0]) + spread(b, weights[1]) + spread(c, weights[2])) * gamma(8);
    let wound = wound(corners);
    let total = data.normals.map_or(wound, |n| *n[0] + *n[1] + *n[2]);
    let geometric_normal = if total.dot(wound) < 0.0 { -wound } else { wound };
    let blended = data.normals.map(|n| *n[0] * weights[0] + *n[1] * weights[1] + *n[2] * weights[2]);
    let normal = blended.and_then(DVec3::try_normalize).unwrap_or(geometric_normal);
    let tangent = if bent { tangent_of([a, b, c], data) } else { DVec3::ZERO };
    Surface { point, error, geometric_normal, normal, tangent, uv: uv_at(data, weights).into() }
}

/// The unit normal by the winding; y of a triangle without area.
fn wound(corners: [&DVec3; 3]) -> DVec3 {
    unit(normal_of(corners.map(|p| *p))).unwrap_or(DVec3::Y)
}

/// The texture coordinates of the corners.
#[inline(always)]
fn uvs_of(data: &Corners<'_>) -> [DVec2; 3] {
    data.uvs.map_or([DVec2::ZERO, DVec2::X, DVec2::Y], |uvs| uvs.map(|uv| *uv))
}

/// Those between.
#[inline(always)]
fn uv_at(data: &Corners<'_>, weights: [f64; 3]) -> DVec2 {
    let uvs = uvs_of(data);
    uvs[0] * weights[0] + uvs[1] * weights[1] + uvs[2] * weights[2]
}

/// ∂p/∂u; 0 where (u, v) is degenerate.
fn tangent_of([a, b, c]: [DVec3; 3], data: &Corners<'_>) -> DVec3 {
    let uvs = uvs_of(data);
    let (e, f) = (uvs[1] - uvs[0], uvs[2] - uvs[0]);
    let determinant = accurate(e.x, f.y, e.y, f.x);
    if determinant == 0.0 {
        return DVec3::ZERO;
    }
    let along = ((b - a) * f.y - (c - a) * e.y) * determinant.signum();
    if along.is_finite() { along } else { DVec3::ZERO }
}

/// A vector of any finite length but 0, normalised without overflow.
fn unit(v: DVec3) -> Option<DVec3> {
    let size = v.abs().max_element();
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    (v / size).try_normalize()
}
