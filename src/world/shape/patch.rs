//! Bicubic patches as rays meet them directly: every root isolated by the kernel.

use super::{LocalRay, Meet, Surface, padded};
use crate::geometry::patch::{Layout, Patch, PatchHit, PatchTree};
use crate::math::Aabb;
use crate::math::error::UNIT_ROUNDOFF;
use glam::{DVec2, DVec3};

/// Patches under their tree. Large: shared between placements.
#[derive(Clone, Debug)]
pub struct PatchShape {
    tree: PatchTree,
    layout: Layout,
    bounds: Aabb,
    /// Bound on the error of a point's coordinates.
    error: f64,
}

/// What a point may be off by, in u of the largest coordinate: the kernel holds a root for one within sixteen times its own sixteen
/// roundings of the two distances, for a ray from nearby.
const POINT_ROUNDINGS: f64 = 512.0;

impl PatchShape {
    /// Cuts the pieces and builds their tree.
    pub fn new(patch: &Patch) -> PatchShape {
        let tree = PatchTree::new(patch.pieces());
        let bounds = tree.bounds();
        if bounds.is_empty() {
            return PatchShape { tree, layout: patch.layout(), bounds, error: 0.0 };
        }
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        let error = POINT_ROUNDINGS * UNIT_ROUNDOFF * reach;
        PatchShape { bounds: padded(bounds, DVec3::splat(error)), tree, layout: patch.layout(), error }
    }

    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        self.tree.first_hit(ray.origin, ray.direction, f64::MIN_POSITIVE, limit).map(|hit| meet_of(&hit))
    }

    pub(super) fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        let found = self.tree.all_hits(ray.origin, ray.direction, f64::MIN_POSITIVE, f64::MAX);
        out.extend(found.hits.iter().map(meet_of));
    }

    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let piece = &self.tree.pieces()[meet.face as usize];
        let (u, v) = (meet.a, meet.b);
        let [point, du, dv] = piece.first_order(u, v);
        // A piece seen has area; where its normal is beyond the kernel's limits, it faces the ray.
        let normal = piece.normal(u, v).unwrap_or_else(|| -ray.direction.normalize());
        // At a collapsed edge ∂/∂u may be there still, or follow from the other.
        let tangent = if du == DVec3::ZERO { dv.cross(normal) } else { du };
        let (global_u, global_v) = self.layout.global_uv(meet.face as usize, u, v);
        Surface {
            point,
            error: DVec3::splat(self.error),
            geometric_normal: normal,
            normal,
            tangent,
            uv: DVec2::new(global_u, global_v).into(),
        }
    }

    /// Around all of it; empty where no piece has area.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes that the pieces, their parts and tree take.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(self.tree.pieces())
    }
}

fn meet_of(hit: &PatchHit) -> Meet {
    Meet { t: hit.t, a: hit.u, b: hit.v, face: hit.piece as u32, ..Meet::default() }
}
