//! Normals of a surface that a motion bends whose weights follow the point: the motion's own derivative turns them, with what the change of the
//! weights adds. (The blended matrix alone leaves that out, and is wrong where weights change fast.)

use super::refine::Images;
use glam::DVec3;

/// Points whose images are asked for at once.
const CHUNK: usize = 1 << 14;
/// The step of central differences, by the size of the surface: its error and that of rounding are both near 1e-10 there.
const STEP: f64 = 1.0 / (1 << 16) as f64;

/// Unit normals of the images of points with unit normals, by central differences along the surface. `size` is that of the surface at rest.
pub fn bent_normals<E>(
    points: &[DVec3],
    normals: &[DVec3],
    size: f64,
    images: &Images<'_, E>,
) -> Result<Vec<DVec3>, E> {
    let mut bent = Vec::with_capacity(normals.len());
    let step = STEP * size;
    for (points, normals) in points.chunks(CHUNK).zip(normals.chunks(CHUNK)) {
        let around = points.iter().zip(normals).flat_map(|(p, n)| {
            let (a, b) = n.any_orthonormal_pair();
            [*p + a * step, *p - a * step, *p + b * step, *p - b * step]
        });
        let around: Vec<DVec3> = around.collect();
        let moved = images(&around)?;
        for (k, n) in normals.iter().enumerate() {
            let (a, b) = n.any_orthonormal_pair();
            // As differences of displacements, so that what does not move keeps its normal to the bit.
            let by = |i: usize| moved[4 * k + i] - around[4 * k + i];
            let slope = |i: usize| (by(i) - by(i + 1)) / (2.0 * step);
            let (along, across) = (slope(0), slope(2));
            let is_moved = along != DVec3::ZERO || across != DVec3::ZERO;
            let turned = (a + along).cross(b + across).try_normalize();
            bent.push(if is_moved { turned.unwrap_or(*n) } else { *n });
        }
    }
    Ok(bent)
}
