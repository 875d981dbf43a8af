//! Shading normals that keep light on the right side. A normal that was interpolated or read from a map may face away from
//! where it is seen, or send a mirrored ray into the surface. Each such vector is mirrored back across the plane that it
//! crossed: nothing changes at the plane itself, so no edge appears, and no constant is needed.

use crate::scene::{Layers, Rgb};
use crate::world::hit::Hit;
use crate::world::texture::{self, Sampled, TexturePoint};
use glam::DVec3;

/// A unit normal brought to the side of the geometric normal and of `wo`.
pub(super) fn facing(n: DVec3, geometric: DVec3, wo: DVec3) -> DVec3 {
    if n == geometric {
        return n;
    }
    let n = onto_side(n, geometric);
    if wo.dot(n) < 0.0 { onto_side(n, wo) } else { n }
}

/// A unit vector mirrored across the plane of the unit vector `side`, if it lies behind it.
pub(super) fn onto_side(v: DVec3, side: DVec3) -> DVec3 {
    let d = v.dot(side);
    if d < 0.0 { (v - side * (2.0 * d)).normalize() } else { v }
}

/// The normal by `normal_map` and `bump` on the outside of the surface; none where neither is given. A map's blue leaves the
/// surface, its red goes along growing u, its green along n × that.
pub(super) fn mapped(hit: &Hit<'_>, layers: &Layers, at: &TexturePoint) -> Sampled<Option<DVec3>> {
    let Some(map) = &layers.normal_map else { return Ok(None) };
    let c = texture::data(map, at)? * 2.0 - Rgb::ONE;
    let n = hit.tangent * c.x + hit.normal.cross(hit.tangent) * c.y + hit.normal * c.z;
    Ok(Some(n.normalize_or(hit.normal)))
}
