//! Random numbers: a function of (seed, pixel, sample, dimension) alone, so that a picture is the same for any number of
//! threads, any order of tiles and any crop. Knows nothing of what the numbers are used for.
//!
//! Numbers of three kinds: by default, every pair of dimensions is one 2-D Sobol sequence over the samples of a pixel, shuffled and Owen-scrambled by hashes of
//! (seed, pixel, dimension): "padding". Burley, *Practical Hash-based Owen Scrambling* (JCGT 9-4, 2020), with the permutation
//! of Vegdahl's *Building a Better LK Hash* (2021); the second Sobol dimension as in Ahmed, *An Implementation Algorithm of
//! 2D Sobol Sequence Fast, Elegant, and Compact* (EGSR 2024). Each pair alone is a scrambled (0, 2)-sequence: any 2ᵐ samples
//! that begin at a multiple of 2ᵐ are stratified in every way that 2ᵐ boxes of equal area can stand. `stratified` has one point
//! in each cell of a grid over all samples of the pixel, `independent` has points that know nothing of one another.

use super::features::First;
use super::suspect::Suspect;
use crate::scene::SamplerKind;
use crate::world::texture::TextureFault;
use glam::DVec2;

/// The random numbers of one camera sample, and what is noted while it is traced. Cheap to make; nothing is shared.
#[derive(Clone, Debug)]
pub struct Sampler {
    seed: u64,
    turn: Turn,
    kind: SamplerKind,
    /// Samples of the pixel, which a grid must know.
    samples: u32,
    /// Rays cast, for all samples whose numbers it gave.
    pub rays: RayCounts,
    /// The function of the scene that was undefined on the way, where one was. Such a pixel is shown magenta.
    pub undefined: Option<TextureFault>,
    /// What the camera's ray met first, where that is asked for.
    pub first: First,
    /// Whose fault it is that the sample is not finite, where that is asked for.
    pub suspect: Suspect,
    /// How many other rays find the radiance that the camera sees a surface emit; none where its own ray does.
    pub emission_rays: u32,
}

/// Whose numbers come next: a sample of a pixel, and how many of its dimensions were taken.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Row and column, each 32 bits.
    place: u64,
    /// Both mixed with the seed, once a number is asked for: many a sample needs none.
    pixel: Option<u64>,
    sample: u32,
    dimension: u32,
}

impl Turn {
    /// A sample of the pixel in a column and row of the whole picture, from its first number on.
    #[inline]
    pub const fn new([x, y]: [u32; 2], sample: u32) -> Turn {
        Turn { place: (y as u64) << 32 | x as u64, pixel: None, sample, dimension: 0 }
    }

    /// The pixel's column and row.
    #[inline]
    pub fn place(self) -> [u32; 2] {
        [self.place as u32, (self.place >> 32) as u32]
    }

    /// The sample's number.
    #[inline]
    pub fn sample(self) -> u32 {
        self.sample
    }

    /// The next sample of the pixel.
    #[inline]
    pub fn next(self) -> Turn {
        Turn { sample: self.sample + 1, dimension: 0, ..self }
    }
}

/// How many rays were cast, by what for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera, and on through what is partly transparent.
    pub camera: u64,
    /// Toward lights.
    pub shadow: u64,
    /// Mirrored.
    pub reflected: u64,
    /// Bent through a surface.
    pub refracted: u64,
    /// Sent on by a lobe with a width.
    pub scattered: u64,
}

/// Rows of numbers that no pixel of a picture has, of what is found beside its samples: added to the pixel's own row, or in its place.
pub mod rows {
    /// Whether a pixel shows the outline of a lamp.
    pub const OUTLINE: u32 = 1 << 28;
    /// What ends paths best.
    pub const ROULETTE: u32 = 1 << 29;
    /// Where records of irradiance stand.
    pub const RECORD: u32 = 1 << 30;
    /// What arrives there.
    pub const GATHERING: u32 = 1 << 31;
    /// Photons.
    pub const PHOTONS: u32 = u32::MAX;
}

impl RayCounts {
    /// All of them.
    pub fn total(self) -> u64 {
        self.camera + self.shadow + self.reflected + self.refracted + self.scattered
    }
}

impl std::ops::AddAssign for RayCounts {
    fn add_assign(&mut self, other: Self) {
        self.camera += other.camera;
        self.shadow += other.shadow;
        self.reflected += other.reflected;
        self.refracted += other.refracted;
        self.scattered += other.scattered;
    }
}

impl Sampler {
    /// The numbers of one sample of the pixel in column x and row y of the whole picture.
    #[inline]
    pub fn new(seed: u64, x: u32, y: u32, sample: u32) -> Sampler {
        Sampler {
            seed,
            turn: Turn::new([x, y], sample),
            kind: SamplerKind::Sobol,
            samples: 1,
            rays: RayCounts::default(),
            undefined: None,
            first: First::Unasked,
            suspect: Suspect::Unasked,
            emission_rays: 0,
        }
    }

    /// The same sample from its first number on, of which it is asked whose fault it is.
    pub fn accusing(&self, emission_rays: u32) -> Sampler {
        let turn = Turn { dimension: 0, ..self.turn };
        Sampler { turn, first: First::Unasked, suspect: Suspect::Sought, emission_rays, ..*self }
    }

    /// The same sample by numbers of another kind, of so many of its pixel.
    #[inline]
    pub fn of_kind(mut self, kind: SamplerKind, samples: u32) -> Sampler {
        (self.kind, self.samples) = (kind, samples);
        self
    }

    /// The same sample, of which it is asked what the camera's ray meets first.
    #[inline]
    pub fn asking(mut self, asks: bool) -> Sampler {
        self.first = if asks { First::Awaited } else { First::Unasked };
        self
    }

    /// Whose numbers come next.
    #[inline]
    pub fn turn(&self) -> Turn {
        self.turn
    }

    /// Gives the numbers of another turn from now on, with the same seed.
    #[inline]
    pub fn turn_to(&mut self, turn: Turn) {
        self.turn = turn;
    }

    /// Forgets what was noted of a sample alone.
    #[inline]
    pub fn forget(&mut self) {
        self.undefined = None;
        if let First::Seen(_) = self.first {
            self.first = First::Awaited;
        }
    }

    /// The next number, in (0, 1).
    pub fn next_1d(&mut self) -> f64 {
        self.next_2d().x
    }

    /// The next pair, in (0, 1)².
    pub fn next_2d(&mut self) -> DVec2 {
        self.next_set().point(0, 1)
    }

    /// The next dimensions as a set of points that are stratified together. Taken once, before a loop over its points.
    #[inline]
    pub fn next_set(&mut self) -> PointSet {
        let Sampler { seed, kind, samples, ref mut turn, .. } = *self;
        let Turn { place, sample, .. } = *turn;
        let pixel = *turn.pixel.get_or_insert_with(|| mix(mix(seed ^ GOLDEN).wrapping_add(mix(place))));
        let key = mix(pixel.wrapping_add(u64::from(turn.dimension).wrapping_mul(GOLDEN)));
        turn.dimension += 1;
        PointSet { order: key as u32, scramble: mix(key ^ GOLDEN), sample, kind, samples }
    }

    /// The next dimensions where they are needed; none are left out, so that all others stay as they are.
    #[inline]
    pub fn next_set_if(&mut self, needed: bool) -> Option<PointSet> {
        if needed {
            return Some(self.next_set());
        }
        self.turn.dimension += 1;
        None
    }
}

/// Two dimensions of a camera sample, of which any number of points may be taken. The points of all samples of the pixel
/// continue one sequence, so that n points at each of N samples are as even as N·n points at one.
#[derive(Clone, Copy, Debug)]
pub struct PointSet {
    order: u32,
    scramble: u64,
    sample: u32,
    kind: SamplerKind,
    samples: u32,
}

impl PointSet {
    /// Point i of the n taken at this camera sample, in (0, 1)².
    pub fn point(self, i: u32, n: u32) -> DVec2 {
        let index = self.sample.wrapping_mul(n).wrapping_add(i);
        match self.kind {
            SamplerKind::Sobol => scrambled_sobol(index, self.order, self.scramble),
            SamplerKind::Stratified => {
                let within = anywhere(index, self.scramble);
                in_cell(index, self.samples.saturating_mul(n), self.order, within)
            }
            SamplerKind::Independent => anywhere(index, self.scramble),
        }
    }
}

/// A point of the sequence, taken in an order and scrambled by nested uniform scrambling: each bit of a fraction is flipped or not by a
/// hash of the bits above it. Hashes go from the low bits to the high ones, so fractions are turned round for them.
fn scrambled_sobol(index: u32, order: u32, scramble: u64) -> DVec2 {
    let x = hash_upward(index.reverse_bits(), order).reverse_bits();
    let (x, y) = (hash_upward(x, scramble as u32), hash_upward(sobol_second(x), (scramble >> 32) as u32));
    let back = (u64::from(x) << 32 | u64::from(y)).reverse_bits();
    DVec2::new(unit(back as u32), unit((back >> 32) as u32))
}

fn anywhere(index: u32, scramble: u64) -> DVec2 {
    let bits = mix(scramble.wrapping_add(u64::from(index).wrapping_mul(GOLDEN)));
    DVec2::new(unit(bits as u32), unit((bits >> 32) as u32))
}

/// A point of one of n cells, each taken once in an order of chance: as many columns as divide n and are at most its root.
fn in_cell(index: u32, n: u32, order: u32, within: DVec2) -> DVec2 {
    let columns = (1..=n.isqrt()).rev().find(|d| n.is_multiple_of(*d)).unwrap_or(1);
    let cell = shuffled(index % n, n, order);
    let corner = DVec2::new(f64::from(cell % columns), f64::from(cell / columns));
    (corner + within) / DVec2::new(f64::from(columns), f64::from(n / columns))
}

/// A permutation of 0 … n − 1: one of the next power of two, gone on with until it is inside.
fn shuffled(i: u32, n: u32, seed: u32) -> u32 {
    let bits = 32 - (n - 1).leading_zeros();
    if bits == 0 {
        return 0;
    }
    let mask = u32::MAX >> (32 - bits);
    let step = |x: u32| {
        // Odd factors, sums and shifts to the right are each undone by others, so that no two places fall on one.
        let x = x.wrapping_add(seed).wrapping_mul((seed >> 8) | 1) & mask;
        let x = x ^ (x >> (bits / 2 + 1));
        let x = x.wrapping_mul(0x9e37_79b1).wrapping_add(seed >> 16) & mask;
        x ^ (x >> (bits / 2 + 1))
    };
    let mut x = step(i);
    while x >= n {
        x = step(x);
    }
    x
}

/// 2⁶⁴ over the golden ratio, odd: Weyl steps that spread well.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// A bijection of 64 bits whose every output bit depends on every input bit (Stafford's variant 13 of MurmurHash3's finaliser).
pub(crate) fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// The middle of the cell that 32 bits name: never 0, never 1.
fn unit(x: u32) -> f64 {
    (f64::from(x) + 0.5) * (1.0 / 4_294_967_296.0)
}

/// A permutation in which no bit depends on a higher one.
fn hash_upward(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The second coordinate of the 2-D Sobol sequence by the first, both as fractions whose first bit is their lowest: Pascal's matrix
/// modulo 2. The first, van der Corput's, is then the index itself.
fn sobol_second(x: u32) -> u32 {
    let mut y = x;
    y ^= y >> 16;
    y ^= (y & 0xff00_ff00) >> 8;
    y ^= (y & 0xf0f0_f0f0) >> 4;
    y ^= (y & 0xcccc_cccc) >> 2;
    y ^ (y & 0xaaaa_aaaa) >> 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sobol's second dimension by its direction numbers: v₁ = 2³¹, vₖ₊₁ = vₖ ^ (vₖ >> 1).
    fn by_direction_numbers(index: u32) -> u32 {
        let (mut v, mut y) = (1u32 << 31, 0);
        for bit in 0..32 {
            if index >> bit & 1 == 1 {
                y ^= v;
            }
            v ^= v >> 1;
        }
        y
    }

    #[test]
    fn the_second_dimension_is_sobols() {
        for index in (0..4096).chain([u32::MAX, 0x8000_0001, 0x1234_5678]) {
            assert_eq!(sobol_second(index).reverse_bits(), by_direction_numbers(index), "index {index}");
        }
    }

    /// Each box of the 2ᵃ × 2ᵐ⁻ᵃ grids holds one of 2ᵐ points.
    fn assert_net(points: &[DVec2]) {
        let m = points.len().trailing_zeros();
        for a in 0..=m {
            let (nx, ny) = (1usize << a, 1usize << (m - a));
            let mut seen = vec![false; points.len()];
            for p in points {
                let cell = (p.x * nx as f64) as usize * ny + (p.y * ny as f64) as usize;
                assert!(!seen[cell], "two points in a box of the {nx} × {ny} grid");
                seen[cell] = true;
            }
        }
    }

    #[test]
    fn powers_of_two_of_samples_are_nets_in_every_dimension() {
        for dimension in 0..20 {
            let points: Vec<DVec2> = (0..64)
                .map(|s| {
                    let mut sampler = Sampler::new(7, 3, 5, s);
                    for _ in 0..dimension {
                        sampler.next_1d();
                    }
                    sampler.next_2d()
                })
                .collect();
            assert_net(&points);
        }
    }

    #[test]
    fn sets_of_points_are_nets_at_each_sample_and_over_all() {
        let set = |s| Sampler::new(0, 1, 2, s).next_set();
        let at_each: Vec<Vec<DVec2>> =
            (0..4).map(|s| (0..16).map(|i| set(s).point(i, 16)).collect()).collect();
        at_each.iter().for_each(|points| assert_net(points));
        assert_net(&at_each.concat());
    }

    /// Pearson's correlation of two lists.
    fn correlation(a: &[f64], b: &[f64]) -> f64 {
        let n = a.len() as f64;
        let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
        let (ma, mb) = (mean(a), mean(b));
        let cov: f64 = a.iter().zip(b).map(|(x, y)| (x - ma) * (y - mb)).sum();
        let var = |v: &[f64], m: f64| v.iter().map(|x| (x - m) * (x - m)).sum::<f64>();
        cov / (var(a, ma) * var(b, mb)).sqrt()
    }

    #[test]
    fn neighbours_dimensions_and_seeds_are_not_correlated() {
        let draw = |seed, dx: u32, dy: u32, skip: usize| -> Vec<f64> {
            (0..256 * 256)
                .map(|i| {
                    let mut s = Sampler::new(seed, i % 256 + dx, i / 256 + dy, 0);
                    for _ in 0..skip {
                        s.next_1d();
                    }
                    s.next_1d()
                })
                .collect()
        };
        let base = draw(0, 0, 0, 0);
        for (name, other) in [
            ("right", draw(0, 1, 0, 0)),
            ("below", draw(0, 0, 1, 0)),
            ("diagonal", draw(0, 1, 1, 0)),
            ("seed", draw(1, 0, 0, 0)),
            ("next dimension", draw(0, 0, 0, 1)),
            ("pixel + seed swapped", draw(1, 1, 0, 0)),
        ] {
            let r = correlation(&base, &other);
            assert!(r.abs() < 0.01, "{name}: r = {r}");
        }
    }

    #[test]
    fn a_shuffle_takes_every_place_once() {
        for n in [1, 2, 3, 7, 16, 60, 100, 1000] {
            for seed in [0, 1, 0xdead_beef, u32::MAX] {
                let mut places: Vec<u32> = (0..n).map(|i| shuffled(i, n, seed)).collect();
                places.sort_unstable();
                assert!(places.into_iter().eq(0..n), "{n}, {seed}");
            }
        }
    }

    #[test]
    fn a_grid_has_one_point_in_each_cell() {
        let point = |s| Sampler::new(3, 1, 2, s).of_kind(SamplerKind::Stratified, 12).next_2d();
        let mut cells: Vec<(u32, u32)> =
            (0..12).map(point).map(|p| ((p.x * 3.0) as u32, (p.y * 4.0) as u32)).collect();
        cells.sort_unstable();
        cells.dedup();
        assert_eq!(cells.len(), 12);
    }

    /// Root-mean-square error of n samples over 64 repetitions (pixels).
    fn error(kind: SamplerKind, n: u32, f: impl Fn(DVec2) -> f64, exact: f64) -> f64 {
        let reps = 64;
        let square = |r: u32| {
            let sum: f64 = (0..n).map(|s| f(Sampler::new(11, r, 0, s).of_kind(kind, n).next_2d())).sum();
            (sum / f64::from(n) - exact) * (sum / f64::from(n) - exact)
        };
        ((0..reps).map(square).sum::<f64>() / f64::from(reps)).sqrt()
    }

    #[test]
    fn smooth_integrals_converge_as_fast_as_the_numbers_are_even() {
        let f = |p: DVec2| p.x * p.x * p.y + (p.x - p.y) * (p.x - p.y);
        let exact = 1.0 / 6.0 + 1.0 / 6.0;
        let slope = |kind| {
            let [few, many] = [16, 4096].map(|n| error(kind, n, f, exact));
            crate::math::elementary::log2(many / few) / 8.0
        };
        assert!(slope(SamplerKind::Sobol) < -1.3, "{}", slope(SamplerKind::Sobol));
        assert!(slope(SamplerKind::Stratified) < -0.9, "{}", slope(SamplerKind::Stratified));
        assert!((slope(SamplerKind::Independent) + 0.5).abs() < 0.05, "{}", slope(SamplerKind::Independent));
    }

    #[test]
    fn numbers_lie_strictly_between_0_and_1() {
        assert!(unit(0) > 0.0 && unit(u32::MAX) < 1.0);
    }
}
