//! Skins: surfaces that follow the bones of a skeleton. Which bone moves a point how much, and where that takes it. Knows nothing of
//! scenes, and of skeletons only where their bones are.
//!
//! | module | what it is |
//! |---|---|
//! | [`weights`] | how much each bone moves each point: by nearness, smoothly, or as listed |
//! | [`motion`] | what a pose does to each bone, split so that rest is exactly rest |
//! | [`blend`] | where a point and its normal go: linear and dual-quaternion blending |
//! | [`normals`] | normals where weights follow the point |
//! | [`refine`](mod@refine) | triangles made finer where a motion bends them |

pub mod blend;
pub mod motion;
pub mod normals;
pub mod refine;
#[cfg(test)]
mod tests;
pub mod weights;

pub use blend::Blend;
pub use motion::Motion;
pub use normals::bent_normals;
pub use refine::refine;
pub use weights::{Influences, WeightError};

use crate::geometry::mesh::Mesh;
use rayon::prelude::*;

/// Points that one task moves: enough to pay for the task.
const CHUNK: usize = 4096;

/// Moves all vertices of a mesh, and turns its normals. `influences` has a row for each vertex.
pub fn deform(mesh: &mut Mesh, influences: &Influences, motions: &[Motion], blend: Blend) {
    let move_one = |k: usize, p: &mut glam::DVec3, n: Option<&mut glam::DVec3>| {
        let moved = blend.apply(motions, influences.of(k), *p);
        *p = moved.point;
        if let Some(n) = n {
            *n = moved.normal(*n);
        }
    };
    if mesh.normals.is_empty() {
        let chunks = mesh.positions.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(c, points)| {
            points.iter_mut().enumerate().for_each(|(i, p)| move_one(c * CHUNK + i, p, None));
        });
        return;
    }
    let chunks = mesh.positions.par_chunks_mut(CHUNK).zip(mesh.normals.par_chunks_mut(CHUNK)).enumerate();
    chunks.for_each(|(c, (points, normals))| {
        for (i, (p, n)) in points.iter_mut().zip(normals).enumerate() {
            move_one(c * CHUNK + i, p, Some(n));
        }
    });
}
