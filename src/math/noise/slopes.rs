//! Bounds on the partial derivatives of noise over a box: cell by cell of the lattice, the gradients at the corners being known there. Knows
//! nothing of tapes.

use super::{BOUND, corner_hash, fade, gradient, steepest};
use crate::math::interval::Interval;
use glam::DVec3;

type Range = (f64, f64);

/// Most cells of the lattice that a box is looked at in; over more of them no derivative is bounded by less than the greatest of all.
const MOST_CELLS: f64 = 8.0;

/// Rounding of sums of at most a hundred numbers up to 4.
const SLACK: f64 = 512.0 * f64::EPSILON;

/// What the partial derivatives of [`super::gradient_noise`] can be over a box of 1 to 3 sides; 0 beyond these.
pub fn slopes(p: &[Interval], seed: u64) -> [Interval; 3] {
    let dimensions = p.len();
    let mut first = [0.0; 3];
    let mut last = [0.0; 3];
    for (i, x) in p.iter().enumerate() {
        (first[i], last[i]) = (x.lo.floor(), x.hi.floor());
    }
    let n_cells: f64 = (0..3).map(|i| last[i] - first[i] + 1.0).product();
    let bound = BOUND[dimensions - 1];
    // Beyond 2⁵⁰ the offsets within a cell have no digits left.
    let is_far = first.iter().chain(&last).any(|x| !(x.abs() < (1u64 << 50) as f64));
    if is_far || !(n_cells <= MOST_CELLS) {
        let most = 2.0 * steepest(dimensions);
        return std::array::from_fn(|i| {
            if i < dimensions { Interval::new(-most, most) } else { Interval::point(0.0) }
        });
    }
    let mut all = [(f64::INFINITY, f64::NEG_INFINITY); 3];
    let steps = |i: usize| (0..).map(move |k| first[i] + f64::from(k)).take_while(move |x| *x <= last[i]);
    for x in steps(0) {
        for y in steps(1) {
            for z in steps(2) {
                let cell = [x, y, z];
                let within = |i: usize| {
                    p.get(i).map_or((0.0, 0.0), |p| {
                        ((p.lo - cell[i]).clamp(0.0, 1.0), (p.hi - cell[i]).clamp(0.0, 1.0))
                    })
                };
                let here = in_cell(cell, std::array::from_fn(within), dimensions, seed);
                all = std::array::from_fn(|i| (all[i].0.min(here[i].0), all[i].1.max(here[i].1)));
            }
        }
    }
    std::array::from_fn(|i| match i < dimensions {
        true => {
            Interval::new(((all[i].0 - SLACK) / bound).next_down(), ((all[i].1 + SLACK) / bound).next_up())
        }
        false => Interval::point(0.0),
    })
}

/// Over offsets t within one cell. The sum is Σ W(t) g·(t − corner), so its derivative has two parts: of the weights, and of the products.
fn in_cell(cell: [f64; 3], t: [Range; 3], dimensions: usize, seed: u64) -> [Range; 3] {
    let place = |corner: usize| -> [f64; 3] { std::array::from_fn(|i| ((corner >> i) & 1) as f64) };
    let gradients: [DVec3; 8] = std::array::from_fn(|corner| {
        let at = place(corner);
        if corner >> dimensions != 0 {
            DVec3::ZERO
        } else {
            gradient(corner_hash(std::array::from_fn(|i| cell[i] + at[i]), seed), dimensions)
        }
    });
    let weights = t.map(|(a, b)| (fade(a), fade(b)));
    std::array::from_fn(|axis| {
        if axis >= dimensions {
            return (0.0, 0.0);
        }
        let bit = 1 << axis;
        let mut rises = [(0.0, 0.0); 8];
        for corner in (0..1usize << dimensions).filter(|corner| corner & bit == 0) {
            let (low, high) = (gradients[corner], gradients[corner | bit]);
            let constant =
                low.dot(DVec3::from_array(place(corner))) - high.dot(DVec3::from_array(place(corner | bit)));
            rises[corner] = linear(constant, (high - low).to_array(), &t);
        }
        let mut own = gradients.map(|g| (g[axis], g[axis]));
        blend(&mut rises, &weights, dimensions, Some(axis));
        blend(&mut own, &weights, dimensions, None);
        let (low, high) = product(fade_slopes(t[axis]), rises[0]);
        (low + own[0].0, high + own[0].1)
    })
}

/// The range of a linear function over a box.
fn linear(constant: f64, by: [f64; 3], t: &[Range; 3]) -> Range {
    (0..3).fold((constant, constant), |(low, high), i| {
        let (a, b) = (by[i] * t[i].0, by[i] * t[i].1);
        (low + a.min(b), high + a.max(b))
    })
}

/// Weighs values at corners against each other, axis by axis but one; the result is in the first.
fn blend(values: &mut [Range; 8], weights: &[Range; 3], dimensions: usize, but: Option<usize>) {
    for axis in (0..dimensions).filter(|axis| Some(*axis) != but) {
        let bit = 1 << axis;
        let (w0, w1) = weights[axis];
        for corner in (0..8).filter(|corner| corner & bit == 0) {
            let (a, b) = (values[corner], values[corner | bit]);
            let between = |x: f64, y: f64, w: f64| x + (y - x) * w;
            values[corner] = (
                between(a.0, b.0, w0).min(between(a.0, b.0, w1)),
                between(a.1, b.1, w0).max(between(a.1, b.1, w1)),
            );
        }
    }
}

fn product(a: Range, b: Range) -> Range {
    let all = [a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1];
    (all[0].min(all[1]).min(all[2].min(all[3])), all[0].max(all[1]).max(all[2].max(all[3])))
}

/// What 30 t²(1 − t)² can be: greatest in the middle.
fn fade_slopes((a, b): Range) -> Range {
    let at = |t: f64| {
        let s = t * (1.0 - t);
        30.0 * s * s
    };
    let (x, y) = (at(a), at(b));
    (x.min(y), if a <= 0.5 && b >= 0.5 { at(0.5) } else { x.max(y) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::noise::gradient_noise;

    #[test]
    fn difference_quotients_lie_within() {
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut width = 0.0;
        for case in 0..6000usize {
            let n = case % 3 + 1;
            let size = 0.5f64.powi((case / 3 % 8) as i32);
            let low: Vec<f64> = (0..n).map(|_| next() * 20.0 - 10.0).collect();
            let around: Vec<Interval> = low.iter().map(|x| Interval::new(*x, x + size)).collect();
            let all = slopes(&around, 3);
            let p: Vec<f64> = low.iter().map(|x| x + next() * size).collect();
            for i in 0..n {
                let h = 1e-6 * size;
                let (mut a, mut b) = (p.clone(), p.clone());
                (a[i], b[i]) = ((p[i] - h).max(low[i]), (p[i] + h).min(low[i] + size));
                let quotient = (gradient_noise(&b, 3) - gradient_noise(&a, 3)) / (b[i] - a[i]);
                let doubt = 1e-15 / h + 1e-4 * size;
                assert!(
                    all[i].lo - doubt <= quotient && quotient <= all[i].hi + doubt,
                    "{quotient} is not in {:?} at {p:?} of {around:?}",
                    all[i]
                );
                if size < 0.01 {
                    width = all[i].width().max(width);
                }
            }
        }
        assert!(width < 0.2, "{width}");
    }
}
