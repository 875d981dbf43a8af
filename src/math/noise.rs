//! Reproducible randomness and noise: pure functions of their arguments, with the same bits on every machine.
//!
//! Their values are part of the language: scenes rely on them, so no change here may change a bit (tests pin samples).

mod slopes;

pub use slopes::slopes;

use glam::DVec3;

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014, with Stafford's variant 13 constants): a bijection of 64 bits in
/// which every input bit moves every output bit with a chance near 1/2.
pub const fn mix64(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// 2⁶⁴ divided by the golden ratio, odd: the step of SplitMix64's counter.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// A hash of a row of numbers by their bits (−0 counts as 0), of their order and of their count: h₀ = 0 and
/// hᵢ₊₁ = mix64(hᵢ + (i + 1)·γ + mix64(bits(xᵢ) + γ)), γ = `GOLDEN`.
pub fn hash(numbers: &[f64]) -> u64 {
    let bits = |x: f64| (x + 0.0).to_bits();
    let step = |h: u64, (x, i): (&f64, u64)| {
        mix64(h.wrapping_add(i.wrapping_mul(GOLDEN)).wrapping_add(mix64(bits(*x).wrapping_add(GOLDEN))))
    };
    numbers.iter().zip(1..).fold(0, step)
}

/// A number in [0, 1), evenly spread, that is a function of the row of numbers alone: the hash's upper 53 bits over 2⁵³.
pub fn random(numbers: &[f64]) -> f64 {
    (hash(numbers) >> 11) as f64 / (1u64 << 53) as f64
}

/// Bounds of the sums of gradients, so that noise lies in −1 … 1: by 1, 2 and 3 dimensions. In 1-D the slopes ±1 give at most
/// 1/2. In 2-D and 3-D, with gradients of length 1, no point's sum exceeds these maxima of Σᵢ wᵢ·maxg |g·dᵢ|, which
/// `noise_stays_in_its_range` searches; they are rounded up.
const BOUND: [f64; 3] = [0.5, 0.7072, 0.7330];

/// Gradient noise of a point of 1, 2 or 3 components, in −1 … 1 with mean 0: twice continuously differentiable, 0 on the
/// integer lattice, features about one unit across. Perlin, *Improving Noise* (SIGGRAPH 2002), with [`mix64`] in place of the
/// permutation, so that it never repeats. `seed` chooses the field. NaN for any other number of components.
pub fn gradient_noise(p: &[f64], seed: u64) -> f64 {
    match *p {
        [x] => lattice_sum([x, 0.0, 0.0], 1, seed) / BOUND[0],
        [x, y] => lattice_sum([x, y, 0.0], 2, seed) / BOUND[1],
        [x, y, z] => lattice_sum([x, y, z], 3, seed) / BOUND[2],
        _ => f64::NAN,
    }
}

/// Fractional Brownian motion: `octaves` fields of gradient noise, each `lacunarity` times finer and `gain` times weaker than
/// the one before, over the sum of their weights: in −1 … 1, mean 0. 0 for no octaves.
pub fn fbm(p: &[f64], octaves: u32, lacunarity: f64, gain: f64) -> f64 {
    let (mut sum, mut weights, mut weight, mut frequency) = (0.0, 0.0, 1.0, 1.0);
    let mut q = [0.0; 3];
    let q = &mut q[..p.len().min(3)];
    for octave in 0..octaves {
        q.iter_mut().zip(p).for_each(|(q, p)| *q = p * frequency);
        sum += weight * gradient_noise(q, u64::from(octave));
        weights += weight;
        weight *= gain;
        frequency *= lacunarity;
    }
    if weights > 0.0 { sum / weights } else { 0.0 }
}

/// Noise in 0 … 1 with mean 1/2: what the language's `noise` gives.
pub fn noise(p: &[f64]) -> f64 {
    0.5 + 0.5 * gradient_noise(p, 0)
}

/// No partial derivative of [`noise`] exceeds this; by the number of dimensions, 1 to 3. From the greatest slope of the sum of corners over every
/// choice of gradients (searched on a grid: 1.348, 2.003, 2.652), rounded up.
pub fn steepest(dimensions: usize) -> f64 {
    let sum = [1.36, 2.03, 2.70][dimensions - 1];
    0.5 * sum / BOUND[dimensions - 1]
}

/// Quintic fade 6t⁵ − 15t⁴ + 10t³: first and second derivatives vanish at 0 and 1.
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// The corners' gradients times the offsets from them, faded over the cell.
fn lattice_sum(p: [f64; 3], dimensions: usize, seed: u64) -> f64 {
    let cell = p.map(f64::floor);
    let offset: [f64; 3] = std::array::from_fn(|i| p[i] - cell[i]);
    let weight = offset.map(fade);
    let mut sum = 0.0;
    for corner in 0..1usize << dimensions {
        let bit = |i: usize| ((corner >> i) & 1) as f64;
        let d = DVec3::from_array(std::array::from_fn(|i| offset[i] - bit(i)));
        let w: f64 =
            (0..dimensions).map(|i| if bit(i) == 1.0 { weight[i] } else { 1.0 - weight[i] }).product();
        let h = corner_hash(std::array::from_fn(|i| cell[i] + bit(i)), seed);
        sum += w * gradient(h, dimensions).dot(d);
    }
    sum
}

/// Cells beyond ±2⁵³ are those of 2⁵³: there neighbouring numbers are whole, and the noise is 0 anyway.
fn corner_hash(corner: [f64; 3], seed: u64) -> u64 {
    corner
        .iter()
        .fold(mix64(seed.wrapping_add(GOLDEN)), |h, x| mix64(h.wrapping_add(GOLDEN) ^ (*x as i64 as u64)))
}

/// Half the square root of 2: the components of unit vectors along a square's diagonals and a cube's edge midpoints.
const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A gradient of length 1 by a hash: ±x; eight directions of the plane; the twelve midpoints of a cube's edges.
fn gradient(hash: u64, dimensions: usize) -> DVec3 {
    let sign = |bit: u64| if hash >> bit & 1 == 0 { 1.0 } else { -1.0 };
    let (a, b) = (sign(60), sign(61));
    match dimensions {
        1 => DVec3::new(a, 0.0, 0.0),
        2 => match hash >> 62 {
            0 => DVec3::new(a, 0.0, 0.0),
            1 => DVec3::new(0.0, a, 0.0),
            _ => DVec3::new(a, b, 0.0) * DIAGONAL,
        },
        _ => match ((hash & 0xffff_ffff) * 3) >> 32 {
            0 => DVec3::new(a, b, 0.0) * DIAGONAL,
            1 => DVec3::new(a, 0.0, b) * DIAGONAL,
            _ => DVec3::new(0.0, a, b) * DIAGONAL,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The greatest value at a point over every choice of gradients: what no field can exceed.
    fn ceiling(p: [f64; 3], dimensions: usize) -> f64 {
        let weight = p.map(fade);
        (0..1usize << dimensions)
            .map(|corner| {
                let bit = |i: usize| ((corner >> i) & 1) as f64;
                let d: [f64; 3] =
                    std::array::from_fn(|i| if i < dimensions { (p[i] - bit(i)).abs() } else { 0.0 });
                let w: f64 = (0..dimensions)
                    .map(|i| if bit(i) == 1.0 { weight[i] } else { 1.0 - weight[i] })
                    .product();
                let pairs = [d[0] + d[1], d[0] + d[2], d[1] + d[2]];
                let best = match dimensions {
                    1 => d[0],
                    2 => d[0].max(d[1]).max(pairs[0] * DIAGONAL),
                    _ => pairs.into_iter().fold(0.0, f64::max) * DIAGONAL,
                };
                w * best
            })
            .sum()
    }

    #[test]
    fn noise_is_nowhere_steeper_than_said() {
        for dimensions in 1..=3usize {
            let mut greatest: f64 = 0.0;
            for i in 0..60_000u32 {
                let p: Vec<f64> =
                    (0..dimensions).map(|k| 100.0 * random(&[f64::from(i), k as f64])).collect();
                let mut q = p.clone();
                q[0] += 1e-6;
                greatest = greatest.max(((noise(&q) - noise(&p)) / 1e-6).abs());
            }
            assert!(greatest <= steepest(dimensions), "{dimensions}: {greatest}");
            assert!(greatest > 0.6 * steepest(dimensions), "{dimensions}: {greatest} is far below");
        }
    }

    #[test]
    fn noise_stays_in_its_range() {
        let n = 60;
        for dimensions in 1..=3 {
            let mut greatest: f64 = 0.0;
            let steps = |i: usize| if i < dimensions { n } else { 0 };
            for x in 0..=steps(0) {
                for y in 0..=steps(1) {
                    for z in 0..=steps(2) {
                        let p = [x, y, z].map(|i| f64::from(i as u32) / f64::from(n as u32));
                        greatest = greatest.max(ceiling(p, dimensions));
                    }
                }
            }
            println!("{dimensions}: {greatest}");
            assert!(greatest <= BOUND[dimensions - 1], "{dimensions}: {greatest}");
            assert!(
                greatest > 0.97 * BOUND[dimensions - 1],
                "{dimensions}: {greatest} is far below its bound"
            );
        }
    }

    #[test]
    fn values_never_change() {
        let pinned = [
            (random(&[0.0]), 0.6524484863740322),
            (random(&[7.0, 3.0, 4.0]), 0.7934731917429363),
            (random(&[7.5, -3.0]), 0.8500106945815213),
            (noise(&[0.3]), 0.865232),
            (noise(&[0.3, -1.7]), 0.4884934604252771),
            (noise(&[0.3, -1.7, 12.25]), 0.34687426249820685),
            (fbm(&[0.3, -1.7, 12.25], 5, 2.0, 0.5), -0.2178694646673703),
        ];
        for (i, (found, expected)) in pinned.into_iter().enumerate() {
            assert_eq!(found, expected, "sample {i}");
        }
    }

    #[test]
    fn random_tells_order_count_and_sign_apart_but_not_zeros() {
        assert_ne!(random(&[1.0, 2.0]), random(&[2.0, 1.0]));
        assert_ne!(random(&[7.0]), random(&[7.0, 0.0]));
        assert_ne!(random(&[1.0]), random(&[-1.0]));
        assert_eq!(random(&[0.0, 1.0]), random(&[-0.0, 1.0]));
    }

    #[test]
    fn random_is_evenly_spread_over_whole_numbers() {
        let n = 100_000;
        let mut bins = [0.0f64; 64];
        let (mut sum, mut lagged, mut before) = (0.0, 0.0, 0.5);
        for i in 0..n {
            let x = random(&[11.0, f64::from(i)]);
            assert!((0.0..1.0).contains(&x));
            bins[(x * 64.0) as usize] += 1.0;
            sum += x;
            lagged += (x - 0.5) * (before - 0.5);
            before = x;
        }
        let n = f64::from(n);
        // Standard errors: 1/√(12 n) of the mean, 1/(12 √n) of the lagged product; χ² of 63 degrees lies below 104 but for 0.1 %.
        assert!((sum / n - 0.5).abs() < 4.0 / (12.0 * n).sqrt());
        assert!((lagged / n).abs() < 4.0 / (12.0 * n.sqrt()));
        let chi2: f64 = bins.iter().map(|b| (b - n / 64.0) * (b - n / 64.0) / (n / 64.0)).sum();
        assert!(chi2 < 104.0, "χ² = {chi2}");
    }

    #[test]
    fn noise_is_symmetric_about_its_mean_and_uses_its_range() {
        for dimensions in 1..=3 {
            let n = 20_000;
            let at = |i: i32, j: usize| random(&[f64::from(i), j as f64]) * 2000.0 - 1000.0;
            let values: Vec<f64> =
                (0..n).map(|i| gradient_noise(&[at(i, 0), at(i, 1), at(i, 2)][..dimensions], 0)).collect();
            let mean = values.iter().sum::<f64>() / f64::from(n);
            let spread = (values.iter().map(|x| x * x).sum::<f64>() / f64::from(n)).sqrt();
            let skew =
                values.iter().map(|x| x * x * x).sum::<f64>() / f64::from(n) / (spread * spread * spread);
            assert!(values.iter().all(|x| x.abs() <= 1.0));
            assert!(mean.abs() < 0.02 && skew.abs() < 0.1, "{dimensions}: mean {mean}, skew {skew}");
            assert!((0.2..0.5).contains(&spread), "{dimensions}: {spread}");
        }
    }

    #[test]
    fn noise_is_smooth_over_cells_to_the_second_derivative() {
        let h = 1e-3;
        let f = |x: f64| gradient_noise(&[x, 0.4, 7.3], 0);
        let second = |x: f64| (f(x + h) - 2.0 * f(x) + f(x - h)) / (h * h);
        for cell in -3..4 {
            let edge = f64::from(cell);
            let jump = second(edge + 2.0 * h) - second(edge - 2.0 * h);
            // The third derivative of the fade is at most 60, over 4 h.
            assert!(jump.abs() < 60.0 * 4.0 * h * 2.0, "{cell}: {jump}");
            assert_eq!(gradient_noise(&[edge, 2.0, -5.0], 0), 0.0);
        }
    }

    #[test]
    fn far_points_have_values_too() {
        for x in [1e15, 1e18, 1e300, -1e300] {
            assert!(noise(&[x, 0.5, -x]).is_finite());
        }
    }
}
