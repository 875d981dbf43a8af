//! Four triangles at once, in f32: a pack says which of them a ray may meet, and never leaves out one that the exact test finds. Knows
//! no mesh, and of trees only the frame that it is measured in. One of the rooms with unsafe code, as rustc counts instructions that every
//! x86-64 has as special.

use crate::world::bvh::{Entry, Frame};
use glam::DVec3;

/// Triangles of a pack.
pub const LANES: usize = 4;

type Lanes = [f32; LANES];

/// x, y and z of each corner, over the triangles, in a tree's frame.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Pack([[Lanes; 3]; 3]);

impl Pack {
    /// Up to four triangles; lanes without one mean nothing.
    pub fn new(frame: &Frame, triangles: impl Iterator<Item = [DVec3; 3]>) -> Pack {
        let mut pack = Pack([[[0.0; LANES]; 3]; 3]);
        for (lane, corners) in triangles.enumerate() {
            for (corner, p) in corners.into_iter().enumerate() {
                let p = frame.point(p).to_array();
                for axis in 0..3 {
                    pack.0[corner][axis][lane] = p[axis] as f32;
                }
            }
        }
        pack
    }
}

/// Half a step of f32, as a share of a number.
const U: f32 = f32::EPSILON / 2.0;

/// Bound on the error of a corner's sheared x and y and of its distance, for a ray without any error of its own. A corner and the
/// ray's point lie within ±2 of the frame and are rounded (2u each); so is their difference (4u); the shear, at most 1, is
/// rounded and multiplied with a difference that has the same error (4u + 8u + 4u); the last subtraction is of numbers up to 4 (8u).
/// A tenth more for what is of second order.
const SHEARED: f32 = 36.0 * U;

/// An edge's sign is certain beyond this many errors of a corner times the largest coordinate and one error more: 4 from both
/// factors of both products, 1 for the roundings of products and difference (4u, coordinates up to 8: less than one error), 1 spare.
const EDGE: f32 = 6.0;

/// A ray prepared for the packs of one frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct PackRay {
    /// Axes: the largest of the direction last.
    axes: [usize; 3],
    origin: [f32; 3],
    /// x and y of the direction over its z, and 1 over its z.
    shear: [f32; 3],
    /// Bound on the error of a sheared corner.
    error: f32,
}

impl PackRay {
    /// From where the ray enters the frame's tree, the direction's axes with the largest last, and its shear.
    #[inline(always)]
    pub fn new(entry: &Entry, axes: [usize; 3], shear: [f64; 3]) -> PackRay {
        PackRay {
            axes,
            origin: [entry.point[axes[0]] as f32, entry.point[axes[1]] as f32, entry.point[axes[2]] as f32],
            shear: [shear[0] as f32, shear[1] as f32, shear[2] as f32],
            error: SHEARED + 2.0 * entry.margin as f32,
        }
    }

    /// Bits of the triangles that the ray may meet no farther than `limit`, a distance in the frame.
    #[inline(always)]
    pub fn propose(&self, pack: &Pack, limit: f32) -> u32 {
        #[cfg(target_arch = "x86_64")]
        return sse::propose(self, pack, limit);
        #[cfg(not(target_arch = "x86_64"))]
        plain::propose(self, pack, limit)
    }
}

/// By plain operations: the definition. A ray misses a triangle that is certainly on one side of one edge and on the other side of
/// another, or certainly behind or beyond. Triangles of next to no size in their frame (10⁻⁵) have no certain sides: the exact
/// test is asked about all of them in a leaf. Every comparison lets a NaN pass.
#[cfg(any(test, not(target_arch = "x86_64")))]
mod plain {
    use super::{EDGE, LANES, Lanes, Pack, PackRay};

    pub fn propose(ray: &PackRay, pack: &Pack, limit: f32) -> u32 {
        (0..LANES).fold(0, |mask, lane| mask | u32::from(may_meet(ray, pack, lane, limit)) << lane)
    }

    fn may_meet(ray: &PackRay, pack: &Pack, lane: usize, limit: f32) -> bool {
        let [a, b, c] = pack.0.each_ref().map(|corner| sheared(ray, corner, lane));
        let edges = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]];
        let size = [a[0], a[1], b[0], b[1], c[0], c[1]].into_iter().map(f32::abs).fold(0.0, f32::max);
        let error = (size + ray.error) * (EDGE * ray.error);
        let beside = edges.iter().any(|e| *e < -error) && edges.iter().any(|e| *e > error);
        let depths = [a[2], b[2], c[2]];
        let out = depths.iter().all(|z| *z > limit + ray.error) || depths.iter().all(|z| *z < -ray.error);
        !(beside || out)
    }

    fn sheared(ray: &PackRay, corner: &[Lanes; 3], lane: usize) -> [f32; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| corner[ray.axes[i]][lane] - ray.origin[i]);
        [x - z * ray.shear[0], y - z * ray.shear[1], z * ray.shear[2]]
    }
}

/// The same, four triangles at once.
#[cfg(target_arch = "x86_64")]
#[allow(
    unsafe_code,
    reason = "rustc has no safe way to instructions in a function that becomes part of its caller"
)]
mod sse {
    use super::{EDGE, Lanes, Pack, PackRay};
    use std::arch::x86_64::*;

    #[inline(always)]
    pub fn propose(ray: &PackRay, pack: &Pack, limit: f32) -> u32 {
        let [a, b, c] = [sheared(ray, &pack.0[0]), sheared(ray, &pack.0[1]), sheared(ray, &pack.0[2])];
        // SAFETY: every x86-64 has SSE2, and no memory is touched.
        unsafe {
            let least = |p, q, r| _mm_min_ps(_mm_min_ps(p, q), r);
            let most = |p, q, r| _mm_max_ps(_mm_max_ps(p, q), r);
            let sign = _mm_set1_ps(-0.0);
            let extent = |p: [__m128; 3]| _mm_max_ps(_mm_andnot_ps(sign, p[0]), _mm_andnot_ps(sign, p[1]));
            let size = most(extent(a), extent(b), extent(c));
            let error = _mm_mul_ps(_mm_add_ps(size, _mm_set1_ps(ray.error)), _mm_set1_ps(EDGE * ray.error));
            let edge =
                |p: [__m128; 3], q: [__m128; 3]| _mm_sub_ps(_mm_mul_ps(p[0], q[1]), _mm_mul_ps(p[1], q[0]));
            let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
            let inside_one = _mm_cmplt_ps(error, most(u, v, w));
            let beside = _mm_and_ps(inside_one, _mm_cmplt_ps(least(u, v, w), _mm_xor_ps(sign, error)));
            let beyond = _mm_cmplt_ps(_mm_set1_ps(limit + ray.error), least(a[2], b[2], c[2]));
            let behind = _mm_cmplt_ps(most(a[2], b[2], c[2]), _mm_set1_ps(-ray.error));
            !_mm_movemask_ps(_mm_or_ps(beside, _mm_or_ps(beyond, behind))) as u32 & 0xf
        }
    }

    /// Sheared x and y of corners, and their distances.
    #[inline(always)]
    fn sheared(ray: &PackRay, corner: &[Lanes; 3]) -> [__m128; 3] {
        // SAFETY: every x86-64 has SSE2, and no memory is touched.
        unsafe {
            let from = |i: usize| {
                let lanes = corner[ray.axes[i]];
                _mm_sub_ps(_mm_setr_ps(lanes[0], lanes[1], lanes[2], lanes[3]), _mm_set1_ps(ray.origin[i]))
            };
            let along = |z, i: usize| _mm_mul_ps(z, _mm_set1_ps(ray.shear[i]));
            let z = from(2);
            [_mm_sub_ps(from(0), along(z, 0)), _mm_sub_ps(from(1), along(z, 1)), along(z, 2)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Aabb;
    use crate::math::random::Random;
    use crate::world::bvh::{Tree, Visitor};
    use crate::world::shape::LocalRay;
    use crate::world::shape::triangle::{Sheared, bounds_of};
    use std::ops::Range;

    /// Where a ray enters a tree, and the limit that its first leaf is told.
    struct Probe(Option<(Entry, f32)>);

    impl Visitor for Probe {
        fn enter(&mut self, entry: &Entry) {
            self.0 = Some((*entry, f32::INFINITY));
        }

        fn leaf(&mut self, _: Range<usize>, _: f64, limit: f32) -> f64 {
            self.0.iter_mut().for_each(|probe| probe.1 = limit);
            -1.0
        }
    }

    fn point(random: &mut Random) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)))
    }

    /// Some as large as all, most small, some needles.
    fn triangle(random: &mut Random, least: f64) -> [DVec3; 3] {
        let (at, size) = (point(random), 10f64.powf(random.between(least, 0.0)));
        let thin = if random.below(4) == 0 { 1e-4 } else { 1.0 };
        [at, at + point(random) * size, at + point(random) * size * thin]
    }

    /// From near or far, at random, along an axis, or at an edge or a corner.
    fn ray_at(triangles: &[[DVec3; 3]], random: &mut Random) -> (DVec3, DVec3) {
        let origin = point(random) * [0.5, 3.0, 1e4][random.below(3)];
        let [a, b, _] = triangles[random.below(triangles.len())];
        let along = [0.0, 1.0, random.unit()][random.below(3)];
        match random.below(4) {
            0 => (origin, point(random)),
            1 => {
                let axis = DVec3::AXES[random.below(3)] * random.sign();
                (a - axis * random.between(0.0, 3.0), axis)
            }
            _ => (origin, a + (b - a) * along - origin),
        }
    }

    type Place = Box<dyn Fn(DVec3) -> DVec3>;

    /// How many triangles are met and how many proposed; none that is met is left out, and both ways propose the same.
    fn count(place: &Place, least: f64, seed: u64) -> (usize, usize) {
        let mut random = Random::new(seed);
        let triangles: Vec<_> = (0..400).map(|_| triangle(&mut random, least)).collect();
        let placed: Vec<_> = triangles.iter().map(|t| t.map(place)).collect();
        let tree = Tree::build(placed.len(), |i| bounds_of(placed[i]));
        let packs: Vec<_> =
            placed.chunks(LANES).map(|some| Pack::new(tree.frame(), some.iter().copied())).collect();
        let (mut met, mut proposed) = (0, 0);
        for _ in 0..3000 {
            let (origin, direction) = ray_at(&triangles, &mut random);
            let along = place(direction) - place(DVec3::ZERO);
            let Some((ray, _)) = LocalRay::new(place(origin), along) else { continue };
            let exact = Sheared::new(&ray);
            let limit = if random.below(2) == 0 {
                f64::MAX
            } else {
                tree.bounds().size().max_element() * random.unit()
            };
            let mut probe = Probe(None);
            tree.visit(ray.origin, ray.direction, limit, &mut probe);
            let Some((entry, near)) = probe.0 else { continue };
            let rays = PackRay::new(&entry, exact.axes(), exact.shear());
            for (number, some) in placed.chunks(LANES).enumerate() {
                let mask = rays.propose(&packs[number], near);
                assert_eq!(mask, plain::propose(&rays, &packs[number], near));
                for (lane, t) in some.iter().enumerate() {
                    let is_met = exact.meet(t.each_ref(), limit).is_some();
                    let is_proposed = mask >> lane & 1 == 1;
                    assert!(is_proposed || !is_met, "{ray:?} {t:?} {limit}");
                    (met, proposed) = (met + usize::from(is_met), proposed + usize::from(is_proposed));
                }
            }
        }
        (met, proposed)
    }

    #[test]
    fn no_triangle_that_a_ray_meets_is_left_out() {
        let far = DVec3::new(148_376.0, 1234.0, -223_423.0);
        // And how many are proposed for one that is met, where half of those aimed at are missed; all that are seen from the edge.
        let places: [(&str, Place, usize); 4] = [
            ("here", Box::new(|p| p), 4),
            ("tiny", Box::new(|p| p * 1e-60), 4),
            ("far", Box::new(move |p| p + far), 4),
            ("flat and huge", Box::new(|p| DVec3::new(p.x * 1e40, p.y * 1e20, p.z * 1e40)), 400),
        ];
        for (seed, (name, place, most)) in places.iter().enumerate() {
            let (met, proposed) = count(place, -3.0, seed as u64);
            assert!(met > 1000, "{name}: {met}");
            assert!(proposed < most * met, "{name}: {proposed} of {met}");
            count(place, -9.0, seed as u64 + 10);
        }
    }

    #[test]
    fn a_box_that_rounds_to_nothing_still_proposes() {
        let at = [DVec3::ONE, DVec3::ONE, DVec3::ONE];
        let tree = Tree::build(2, |_| Aabb::of(at));
        let pack = Pack::new(tree.frame(), [at, at].into_iter());
        let (ray, _) = LocalRay::new(DVec3::ZERO, DVec3::ONE).expect("a direction");
        let mut probe = Probe(None);
        tree.visit(ray.origin, ray.direction, f64::MAX, &mut probe);
        let (entry, limit) = probe.0.expect("met");
        let exact = Sheared::new(&ray);
        assert_eq!(PackRay::new(&entry, exact.axes(), exact.shear()).propose(&pack, limit) & 3, 3);
    }
}
