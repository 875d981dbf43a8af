//! The search with four triangles in the lanes of an instruction, where the processor has such: compiled as one with the traversal around it. One of the
//! rooms with unsafe code: there is no other way to such instructions.

use super::{Found, Ordered};
use crate::world::packet::{Members, Packet, RAYS};
use crate::world::shape::{LocalRay, Meet};
use crate::world::tree::Tree;

/// See [`Ordered::nearest`].
#[inline(always)]
pub(super) fn nearest(
    among: Ordered,
    tree: &Tree,
    ray: &LocalRay,
    limit: f64,
    any: bool,
) -> Option<(usize, Meet)> {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_v3()
        && let Tree::Bvh(tree) = tree
        && tree.is_whole()
    {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe { x86::nearest_walked(&among, tree, ray, limit, any) }.get();
    }
    nearest_otherwise(among, tree, *ray, limit, any)
}

/// The same in any tree. Apart, so that the rest becomes a part of who asks.
#[inline(never)]
fn nearest_otherwise(
    among: Ordered,
    tree: &Tree,
    ray: LocalRay,
    limit: f64,
    any: bool,
) -> Option<(usize, Meet)> {
    let ray = &ray;
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_v3() {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        unsafe {
            match tree {
                Tree::KdTree(tree) => return x86::nearest_walked(&among, tree, ray, limit, any).get(),
                Tree::Bvh(tree) if tree.node_count() == 0 => {
                    return x86::nearest_walked(&among, &(0..among.order.len()), ray, limit, any).get();
                }
                Tree::Bvh(_) => {}
            }
        }
    }
    among.nearest_plain(tree, ray, limit, any)
}

/// See [`Ordered::nearest_each`]; none where rays go alone.
#[inline(always)]
pub(super) fn nearest_each(
    among: Ordered,
    tree: &Tree,
    rays: (&Packet, Members),
    limits: &[f64; RAYS],
    found: &mut [Found; RAYS],
) -> Option<()> {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_v3()
        && let Tree::Bvh(tree) = tree
        && tree.is_whole()
    {
        // SAFETY: the processor has just been found to have what the function is compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe {
            match among.corners.are_exact() {
                true => super::packet::nearest::<true>(&among, tree, rays, limits, found),
                false => super::packet::nearest::<false>(&among, tree, rays, limits, found),
            }
        };
    }
    None
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::super::four::{FromStart, Start};
    use super::super::walked::Walked;
    use super::*;
    use crate::world::shape::triangle::Sheared;
    use crate::world::shape::triangle::leaf::AT_ONCE;
    use glam::DVec3;
    use std::arch::x86_64::*;
    use std::ops::Range;

    /// # Safety
    ///
    /// The processor must have x86-64-v3.
    #[inline(always)]
    #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
    pub(super) unsafe fn nearest_walked(
        among: &Ordered,
        tree: &impl Walked,
        ray: &LocalRay,
        limit: f64,
        any: bool,
    ) -> Found {
        let LocalRay { origin: o, direction: d } = ray;
        // SAFETY: it has.
        unsafe { nearest(among, tree, o.x, o.y, o.z, d.x, d.y, d.z, limit, any) }
    }

    /// The ray number by number, so that it comes in registers: what has just been written so cannot be read as a whole before the cache has it.
    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    #[allow(clippy::too_many_arguments, reason = "numbers that come in registers")]
    fn nearest(
        among: &Ordered,
        tree: &impl Walked,
        x: f64,
        y: f64,
        z: f64,
        along_x: f64,
        along_y: f64,
        along_z: f64,
        limit: f64,
        any: bool,
    ) -> Found {
        let (origin, direction) = (DVec3::new(x, y, z), DVec3::new(along_x, along_y, along_z));
        let ray = &LocalRay { origin, direction };
        match (among.corners.are_exact(), any) {
            (true, false) => nearest_of_fours::<true, false, _>(among, tree, ray, limit),
            (true, true) => nearest_of_fours::<true, true, _>(among, tree, ray, limit),
            (false, false) => nearest_of_fours::<false, false, _>(among, tree, ray, limit),
            (false, true) => nearest_of_fours::<false, true, _>(among, tree, ray, limit),
        }
    }

    #[target_feature(enable = "avx2,bmi1,bmi2,fma")]
    fn nearest_of_fours<const EXACT: bool, const ANY: bool, W: Walked>(
        among: &Ordered,
        tree: &W,
        ray: &LocalRay,
        limit: f64,
    ) -> Found {
        let Sheared { axes, shear: [x, y, per_depth], .. } = Sheared::new(ray);
        let start = Start::new::<EXACT>(among.corners, &ray.origin, axes);
        let shear = [x, y].map(|x| _mm256_set1_pd(x));
        let fours = &among.corners.fours[..];
        // Each four that a range touches. What else is in it are triangles too.
        let look = |found: &mut Found, range: Range<usize>| {
            for at in range.start / AT_ONCE..range.end.div_ceil(AT_ONCE) {
                let Some(mut within) = FromStart::new(&fours[at], &start).within::<EXACT>(shear) else {
                    continue;
                };
                within.lanes &= lanes_of::<W>(&range, at);
                if within.take::<EXACT, ANY>(among, at, (|| *ray, per_depth), found) && ANY {
                    return false;
                }
            }
            true
        };
        let ahead = |position: usize| fours.as_ptr().wrapping_add(position / AT_ONCE).cast();
        let mut found = Found::nothing(limit);
        // SAFETY: this function is compiled for the same instructions.
        #[allow(unsafe_code, reason = "a trait has no other functions for some processors")]
        unsafe {
            tree.walk::<ANY>(ray, &mut found, look, ahead);
        }
        found
    }

    /// Which lanes of the four at a place belong to a range that touches it, as bits.
    #[inline(always)]
    fn lanes_of<W: Walked>(range: &Range<usize>, at: usize) -> i32 {
        let before = if W::ANYWHERE { range.start.saturating_sub(AT_ONCE * at) } else { 0 };
        (1 << (range.end - AT_ONCE * at).min(AT_ONCE)) - (1 << before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;
    use crate::math::random::Random;
    use crate::scene::Accelerator;
    use crate::world::shape::triangle::leaf::Corners;
    use crate::world::shape::triangle::{bounds_of, cut};
    use glam::DVec3;

    const TRIANGLES: [[u32; 3]; 10] = {
        let mut all = [[0; 3]; 10];
        let mut i = 0;
        while i < 10 {
            all[i as usize] = [i, i + 1, i + 2];
            i += 1;
        }
        all
    };

    /// Ten triangles with corners in common, where every coordinate is a float in a quarter of all rounds, and a ray at one of them. On a coarse grid,
    /// so that rays go through corners and edges and along planes; and anywhere.
    fn triangles(round: usize, random: &mut Random) -> (Vec<DVec3>, Option<LocalRay>) {
        let steps = if round.is_multiple_of(2) { 8.0 } else { 1e9 };
        let odd = if round % 4 < 2 { DVec3::ZERO } else { DVec3::splat(1.0 / 3.0) };
        let mut point =
            || DVec3::from_array(std::array::from_fn(|_| (random.unit() * steps).floor() / 4.0)) + odd;
        let vertices: Vec<DVec3> = (0..12).map(|_| point()).collect();
        let (from, to) = (point(), vertices[round % 12]);
        let inside = (to + vertices[(round + 1) % 12] + vertices[(round + 2) % 12]) / 3.0;
        let ray = LocalRay::new(from, if round.is_multiple_of(3) { to } else { inside } - from);
        (vertices, ray.map(|(ray, _)| ray))
    }

    fn corners(round: usize, vertices: &[DVec3], order: &[u32]) -> Corners {
        let corners = Corners::new(vertices, order.iter().map(|&i| TRIANGLES[i as usize]));
        assert_eq!(corners.are_exact(), round.is_multiple_of(4), "round {round}");
        corners
    }

    fn mesh_of(positions: Vec<DVec3>) -> Mesh {
        Mesh { positions, triangles: TRIANGLES.to_vec(), ..Mesh::default() }
    }

    fn bits(met: Option<(usize, Meet)>) -> Option<(usize, [u64; 3])> {
        met.map(|(at, m)| (at, [m.t, m.a, m.b].map(f64::to_bits)))
    }

    #[test]
    fn lanes_find_the_same_bits_as_plain_operations() {
        for accelerator in [Accelerator::Bvh, Accelerator::KdTree, Accelerator::None] {
            let mut random = Random::new(11);
            let mut n_met = 0;
            for round in 0..4000 {
                let (vertices, Some(ray)) = triangles(round, &mut random) else { continue };
                let of = |i: usize| [vertices[i], vertices[i + 1], vertices[i + 2]];
                let tree = Tree::build_of_triangles(
                    accelerator,
                    10,
                    |i| bounds_of(of(i)),
                    |i, cell| cut::cut(of(i), cell),
                );
                let corners = &corners(round, &vertices, tree.order());
                let among = Ordered { corners, mesh: &mesh_of(vertices), order: tree.order() };
                for any in [false, true] {
                    let plain = bits(among.nearest_plain(&tree, &ray, f64::MAX, any));
                    let wide = bits(among.nearest(&tree, &ray, f64::MAX, any));
                    assert_eq!(wide, plain, "{accelerator:?}, round {round}");
                    n_met += usize::from(plain.is_some());
                }
            }
            assert!(n_met > 3000, "{n_met}");
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[test]
    fn ranges_begin_and_end_anywhere() {
        if !crate::math::vectors::has_v3() {
            return;
        }
        let (mut random, mut n_met) = (Random::new(12), 0);
        for round in 0..4000 {
            let (vertices, Some(ray)) = triangles(round, &mut random) else { continue };
            let order: Vec<u32> = (0..10).rev().collect();
            let corners = &corners(round, &vertices, &order);
            let among = Ordered { corners, mesh: &mesh_of(vertices), order: &order };
            let range = (random.unit() * 10.0) as usize..10;
            let range = range.start..range.end.min(range.start + 1 + (random.unit() * 5.0) as usize);
            for any in [false, true] {
                let mut search = super::super::Search::new(among, &ray, f64::MAX, any);
                search.goes_on(range.clone());
                let plain = bits(search.found.get());
                // SAFETY: the processor has just been found to have what the function is compiled for.
                #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
                let wide = unsafe { x86::nearest_walked(&among, &range, &ray, f64::MAX, any) }.get();
                assert_eq!(bits(wide), plain, "round {round}, {range:?}");
                n_met += usize::from(plain.is_some());
            }
        }
        assert!(n_met > 1000, "{n_met}");
    }

    /// At any scale, far from the origin and from far off, at corners, edges and places inside.
    #[test]
    fn corners_that_were_rounded_lose_no_meeting() {
        let (mut random, mut n_met) = (Random::new(13), 0);
        let order: Vec<u32> = (0..10).collect();
        let list = Tree::build(Accelerator::None, 10, |_| crate::math::Aabb::EMPTY);
        for round in 0..8000 {
            let scale = [1.0, 1e-300, 1e-42, 1e-20, 1e20, 1e39, 1e90][round % 7];
            let away = [0.0, 1e3, 1e9][round / 7 % 3] * scale;
            let mut vector = || DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)));
            let vertices: Vec<DVec3> = (0..12).map(|_| vector() * scale + away).collect();
            let from = vector() * [1.0, 1e6][round / 21 % 2] * scale + away;
            let [a, b, c] = [0, 1, 2].map(|i| vertices[(round + i) % 10 + 2 - i]);
            let aim = [a, a + (b - a) * random.unit(), (a + b + c) / 3.0][round / 42 % 3];
            let Some((ray, _)) = LocalRay::new(from, aim - from) else { continue };
            let corners = &Corners::new(&vertices, order.iter().map(|&i| TRIANGLES[i as usize]));
            assert!(!corners.are_exact(), "round {round}");
            let among = Ordered { corners, mesh: &mesh_of(vertices), order: &order };
            let plain = bits(among.nearest_plain(&list, &ray, f64::MAX, false));
            assert_eq!(bits(among.nearest(&list, &ray, f64::MAX, false)), plain, "round {round}");
            n_met += usize::from(plain.is_some());
        }
        assert!(n_met > 4000, "{n_met}");
    }
}
