//! The test of a triangle with its three corners in the lanes of one instruction, where the processor has such: the same operations in the
//! same order as [`Sheared::meet`], so that every bit is the same. One of the rooms with unsafe code: there is no other way
//! to such instructions.

use super::{Asked, Corners, nearest_by};
use crate::world::shape::Meet;
use glam::DVec3;
use std::ops::Range;

/// See [`Corners::nearest`].
#[inline(always)]
pub(super) fn nearest(
    all: &Corners,
    vertices: &[DVec3],
    range: Range<usize>,
    asked: &Asked,
    number: impl Fn(usize) -> u32,
) -> Option<(usize, Meet)> {
    #[cfg(target_arch = "x86_64")]
    if crate::math::vectors::has_avx2() {
        // SAFETY: the processor has just been found to have what the functions are compiled for.
        #[allow(unsafe_code, reason = "code for instructions that not every processor has")]
        return unsafe {
            match all {
                Corners::Narrow(rows) => x86::nearest_narrow(rows, range, asked, number),
                Corners::Shared(triangles) => x86::nearest_shared(triangles, vertices, range, asked, number),
            }
        };
    }
    nearest_plain(all, vertices, range, asked, number)
}

/// The same one number at a time.
pub(super) fn nearest_plain(
    all: &Corners,
    vertices: &[DVec3],
    range: Range<usize>,
    asked: &Asked,
    number: impl Fn(usize) -> u32,
) -> Option<(usize, Meet)> {
    nearest_by(range, asked, number, |position, limit| {
        asked.ray.meet(all.at(vertices, position).each_ref(), limit)
    })
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use crate::math::vectors::lanes::{load_3, store_4, widen_4};
    use crate::world::shape::triangle::Sheared;
    use std::arch::x86_64::*;

    /// Rows of corners a, b, c: x and y before the shear, and z, relative to the ray. The last lane means nothing.
    type Rows = [__m256d; 3];

    #[target_feature(enable = "avx2")]
    pub(super) fn nearest_narrow(
        all: &[[[f32; 3]; 3]],
        range: Range<usize>,
        asked: &Asked,
        number: impl Fn(usize) -> u32,
    ) -> Option<(usize, Meet)> {
        let ray = asked.ray;
        let origin = ray.start.map(|x| _mm256_set1_pd(x));
        // Below 8, as it is anyway: so that no row needs to be looked for within what was found for all.
        let rows = ray.axes.map(|axis| (3 * axis) & 7);
        let all = all.as_flattened().as_flattened();
        nearest_by(range, asked, number, |position, limit| {
            let rest = &all[9 * position..];
            let nine: &[f32; 16] = rest.first_chunk().expect("one more stands after all");
            // The last of four is another row's, or lies after all.
            let four = |at: usize| nine[at..at + 4].first_chunk().expect("four of four");
            let row = |i: usize| _mm256_sub_pd(widen_4(four(rows[i])), origin[i]);
            let corners = || {
                std::array::from_fn(|i| DVec3::new(nine[i].into(), nine[3 + i].into(), nine[6 + i].into()))
            };
            meet(ray, [row(0), row(1), row(2)], limit, corners)
        })
    }

    #[target_feature(enable = "avx2")]
    pub(super) fn nearest_shared(
        all: &[[u32; 3]],
        vertices: &[DVec3],
        range: Range<usize>,
        asked: &Asked,
        number: impl Fn(usize) -> u32,
    ) -> Option<(usize, Meet)> {
        let ray = asked.ray;
        let [x, y, z] = ray.axes.map(|axis| 2 * axis as i32);
        let order = _mm256_setr_epi32(x, x + 1, y, y + 1, z, z + 1, 6, 7);
        let turned = |v: &DVec3| {
            let v = _mm256_castpd_ps(load_3(v.as_ref()));
            _mm256_castps_pd(_mm256_permutevar8x32_ps(v, order))
        };
        let origin = load_3(&ray.start);
        nearest_by(range, asked, number, |position, limit| {
            let places = all[position].map(|i| &vertices[i as usize]);
            let at = |i: usize| _mm256_sub_pd(turned(places[i]), origin);
            meet(ray, transposed(at(0), at(1), at(2)), limit, || places.map(|p| *p))
        })
    }

    /// Rows of the columns a, b, c.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn transposed(a: __m256d, b: __m256d, c: __m256d) -> Rows {
        let (xz, y) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let c_y = _mm256_castpd256_pd128(_mm256_permute_pd::<5>(c));
        [
            _mm256_insertf128_pd::<1>(xz, _mm256_castpd256_pd128(c)),
            _mm256_insertf128_pd::<1>(y, c_y),
            _mm256_permute2f128_pd::<0x31>(xz, c),
        ]
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn meet(ray: &Sheared, [x, y, z]: Rows, limit: f64, corners: impl Fn() -> [DVec3; 3]) -> Option<Meet> {
        let x = _mm256_sub_pd(x, _mm256_mul_pd(_mm256_set1_pd(ray.shear[0]), z));
        let y = _mm256_sub_pd(y, _mm256_mul_pd(_mm256_set1_pd(ray.shear[1]), z));
        // u, v, w of c a b and b c a.
        const CAB: i32 = 0b11_01_00_10;
        const BCA: i32 = 0b11_00_10_01;
        let one = _mm256_mul_pd(_mm256_permute4x64_pd::<CAB>(x), _mm256_permute4x64_pd::<BCA>(y));
        let other = _mm256_mul_pd(_mm256_permute4x64_pd::<CAB>(y), _mm256_permute4x64_pd::<BCA>(x));
        let sides = _mm256_sub_pd(one, other);
        let on_edge = _mm256_cmp_pd::<_CMP_EQ_OQ>(sides, _mm256_setzero_pd());
        if _mm256_movemask_pd(on_edge) & 7 != 0 {
            return meet_on_edge(ray, corners(), limit);
        }
        // All or none: 7 and 0, which follow each other.
        if (_mm256_movemask_pd(sides) + 1) & 7 > 1 {
            return None;
        }
        let ([u, v, w, _], [a, b, c, _]) = (store_4(sides), store_4(z));
        ray.meet_inside([u, v, w], [a, b, c], limit, corners)
    }

    #[cold]
    fn meet_on_edge(ray: &Sheared, corners: [DVec3; 3], limit: f64) -> Option<Meet> {
        ray.meet(corners.each_ref(), limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use crate::world::shape::LocalRay;
    use crate::world::shape::triangle::Sheared;

    #[test]
    fn lanes_find_the_same_bits_as_plain_operations() {
        let mut random = Random::new(11);
        // On a coarse grid, so that rays go through corners and edges and along planes; and anywhere.
        let mut point =
            |steps: f64| DVec3::from_array(std::array::from_fn(|_| (random.unit() * steps).floor() / 4.0));
        let mut n_met = 0;
        for round in 0..4000 {
            let steps = if round % 2 == 0 { 8.0 } else { 1e9 };
            let odd = if round % 4 < 2 { DVec3::ZERO } else { DVec3::splat(1.0 / 3.0) };
            let vertices: Vec<DVec3> = (0..12).map(|_| point(steps) + odd).collect();
            let all = Corners::new(&vertices, (0..10).map(|i| [i, i + 1, i + 2]));
            assert_eq!(matches!(all, Corners::Narrow(_)), round % 4 == 0, "round {round}");
            let (from, to) = (point(steps) + odd, vertices[round % 12]);
            let inside = (to + vertices[(round + 1) % 12] + vertices[(round + 2) % 12]) / 3.0;
            let Some((ray, _)) = LocalRay::new(from, if round % 3 == 0 { to } else { inside } - from) else {
                continue;
            };
            let ray = Sheared::new(&ray);
            for any in [false, true] {
                let asked = Asked { ray: &ray, limit: f64::MAX, any };
                let found =
                    |of: Option<(usize, Meet)>| of.map(|(i, m)| (i, [m.t, m.a, m.b].map(f64::to_bits)));
                let plain = found(nearest_plain(&all, &vertices, 0..10, &asked, |i| 20 - i as u32));
                assert_eq!(
                    found(all.nearest(&vertices, 0..10, &asked, |i| 20 - i as u32)),
                    plain,
                    "round {round}"
                );
                n_met += usize::from(plain.is_some());
            }
        }
        assert!(n_met > 3000, "{n_met}");
    }
}
