//! Shading normals that keep light on the right side. A normal that was interpolated or read from a map may face away from
//! where it is seen, or send a mirrored ray into the surface. Each such vector is mirrored back across the plane that it
//! crossed: nothing changes at the plane itself, so no edge appears, and no constant is needed.

use crate::scene::Texture;
use crate::world::hit::Hit;
use crate::world::texture::{self, Sampled, TexturePoint};
use crate::world::{Ray, World};
use glam::DVec3;

/// A unit normal brought to the side of the geometric normal and of `wo`, on whose side that is.
#[inline]
pub(super) fn facing(n: DVec3, geometric: DVec3, wo: DVec3) -> DVec3 {
    if n == geometric { n } else { brought(n, geometric, wo) }
}

fn brought(n: DVec3, geometric: DVec3, wo: DVec3) -> DVec3 {
    let n = onto_side(n, geometric);
    if wo.dot(n) < 0.0 { onto_side(n, wo) } else { n }
}

/// A unit vector mirrored across the plane of the unit vector `side`, if it lies behind it.
pub(super) fn onto_side(v: DVec3, side: DVec3) -> DVec3 {
    let d = v.dot(side);
    if d < 0.0 { (v - side * (2.0 * d)).normalize() } else { v }
}

/// The normal by `normal_map` and `bump` on the outside of the surface; none where neither is given.
pub(super) fn bent(world: &World, hit: &Hit<'_>, ray: &Ray, at: &TexturePoint<'_>) -> Sampled<Option<DVec3>> {
    let Some(layers) = hit.coat.material.layers.as_deref() else { return Ok(None) };
    let mapped = match &layers.normal_map {
        Some(map) => Some(mapped(map, hit, at)?),
        None => None,
    };
    match &layers.bump {
        Some(bump @ Texture::Pattern(_)) => {
            bumped(bump, world, hit, ray, at, mapped.unwrap_or(hit.normal)).map(Some)
        }
        Some(Texture::Constant(_)) | None => Ok(mapped),
    }
}

/// A map's blue leaves the surface, its red goes along growing u, its green along n × that.
fn mapped(map: &Texture, hit: &Hit<'_>, at: &TexturePoint<'_>) -> Sampled<DVec3> {
    let c = texture::data(map, at)? * 2.0 - DVec3::ONE;
    let tangent = hit.tangent();
    let n = tangent * c.x + hit.normal.cross(tangent) * c.y + hit.normal * c.z;
    Ok(n.normalize_or(hit.normal))
}

/// The normal of the surface raised by a height along its normal: n less the height's slope (Blinn, *Simulation of Wrinkled
/// Surfaces*, 1978). The slope is a difference over [`BUMP_STEP`] of the ray's length in two directions.
fn bumped(
    bump: &Texture,
    world: &World,
    hit: &Hit<'_>,
    ray: &Ray,
    at: &TexturePoint<'_>,
    normal: DVec3,
) -> Sampled<DVec3> {
    let height = texture::number(bump, at)?;
    let step = hit.t * ray.direction.length() * BUMP_STEP;
    let mut slope = DVec3::ZERO;
    let tangent = hit.tangent();
    for along in [tangent, hit.geometric_normal.cross(tangent).normalize_or_zero()] {
        slope += along * slope_along(bump, world, hit, ray, height, along * step)?;
    }
    Ok((normal - slope).normalize_or(normal))
}

/// About a pixel of a picture a thousand pixels wide that sees 60°: finer heights would only be noise.
const BUMP_STEP: f64 = 1.0 / 1024.0;

/// The height's change to the surface's own point at an offset, per unit of length. The point is found by a ray onto the same
/// shape, so that any shape and any mesh can be bumped; where it ends before the offset, the other side is asked, and where it
/// ends there too it counts as level.
fn slope_along(
    bump: &Texture,
    world: &World,
    hit: &Hit<'_>,
    ray: &Ray,
    height: f64,
    offset: DVec3,
) -> Sampled<f64> {
    let step = offset.length();
    for sign in [1.0, -1.0] {
        let above = hit.point + offset * sign + hit.geometric_normal * step;
        let probe =
            Ray { origin: above, direction: -hit.geometric_normal, t_max: 2.0 * step, kind: ray.kind };
        let near = world.closest(&probe).filter(|near| is_same_shape(near, hit));
        if let Some(near) = near {
            return Ok((texture::number(bump, &TexturePoint::from(&near))? - height) * sign / step);
        }
    }
    Ok(0.0)
}

fn is_same_shape(a: &Hit<'_>, b: &Hit<'_>) -> bool {
    (a.primitive.instance, a.primitive.shape) == (b.primitive.instance, b.primitive.shape)
}
