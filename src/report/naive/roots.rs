//! Roots by formulas: the textbook's quadratic, Cardano and Viète, Ferrari. Coefficients of 1, x, x², …

use crate::math::elementary::{acos, cbrt, cos};
use std::f64::consts::TAU;

/// At most four roots, ascending.
#[derive(Clone, Copy, Debug, Default)]
pub struct Found {
    roots: [f64; 4],
    n: usize,
}

impl Found {
    /// Of these.
    pub fn of(roots: &[f64]) -> Found {
        let mut found = Found::default();
        for x in roots.iter().take(4) {
            found.roots[found.n] = *x;
            found.n += 1;
        }
        found.roots[..found.n].sort_by(f64::total_cmp);
        found
    }
}

impl std::ops::Deref for Found {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.roots[..self.n]
    }
}

/// (−b ± √(b² − 4ac)) / 2a.
pub fn textbook_quadratic(c: &[f64]) -> Found {
    let d = c[1] * c[1] - 4.0 * c[2] * c[0];
    if d < 0.0 {
        return Found::default();
    }
    let s = d.sqrt();
    Found::of(&[(-c[1] - s) / (2.0 * c[2]), (-c[1] + s) / (2.0 * c[2])])
}

/// Both roots from the larger one, the discriminant plain.
pub fn stable_quadratic(c: &[f64]) -> Found {
    let d = c[1] * c[1] - 4.0 * c[2] * c[0];
    if d < 0.0 {
        return Found::default();
    }
    let q = -0.5 * (c[1] + d.sqrt().copysign(c[1]));
    Found::of(&[q / c[2], c[0] / q])
}

/// Cardano with one real root, Viète's cosines with three.
pub fn cardano(c: &[f64]) -> Found {
    let (a, b, d) = (c[2] / c[3], c[1] / c[3], c[0] / c[3]);
    let q = (a * a - 3.0 * b) / 9.0;
    let r = (a * (2.0 * a * a - 9.0 * b) + 27.0 * d) / 54.0;
    let third = a / 3.0;
    if r * r < q * q * q {
        let theta = acos((r / (q * q * q).sqrt()).clamp(-1.0, 1.0));
        let s = -2.0 * q.sqrt();
        return Found::of(&[0.0, TAU, -TAU].map(|turn| s * cos((theta + turn) / 3.0) - third));
    }
    let u = -cbrt(r.abs() + (r * r - q * q * q).sqrt()).copysign(r);
    let v = if u == 0.0 { 0.0 } else { q / u };
    Found::of(&[u + v - third])
}

/// Cardano, then two of Newton's steps for each root.
pub fn polished_cardano(c: &[f64]) -> Found {
    let polished: Vec<f64> = cardano(c).iter().map(|&x| newton(c, newton(c, x))).collect();
    Found::of(&polished)
}

fn newton(c: &[f64], x: f64) -> f64 {
    let (p, d) = c.iter().rev().fold((0.0, 0.0), |(p, d), c| (p * x + c, d * x + p));
    if d == 0.0 { x } else { x - p / d }
}

/// Ferrari, by the largest root of the resolvent.
pub fn ferrari(c: &[f64]) -> Found {
    let [a, b, d, e] = [3, 2, 1, 0].map(|i: usize| c[i] / c[4]);
    let shift = a / 4.0;
    let p = b - 6.0 * shift * shift;
    let q = d - 2.0 * b * shift + 8.0 * shift * shift * shift;
    let r = e - d * shift + b * shift * shift - 3.0 * shift * shift * shift * shift;
    let resolvent = [-q * q, 2.0 * (p * p - 4.0 * r), 8.0 * p, 8.0];
    // 8m³ + 8pm² + (2p² − 8r)m − q² has a root m ≥ 0.
    let resolvent = [resolvent[0], resolvent[1], resolvent[2], resolvent[3]];
    let m = cardano(&resolvent).last().copied().unwrap_or(0.0);
    if !(m > 0.0) {
        // Biquadratic: y⁴ + py² + r.
        let squares = stable_quadratic(&[r, p, 1.0]);
        let pairs: Vec<f64> = squares
            .iter()
            .filter(|s| **s >= 0.0)
            .flat_map(|s| [s.sqrt() - shift, -s.sqrt() - shift])
            .collect();
        return Found::of(&pairs);
    }
    let s = (2.0 * m).sqrt();
    let half = |s: f64, rest: f64| stable_quadratic(&[p / 2.0 + m + rest, s, 1.0]);
    let rest = q / (2.0 * s);
    let all: Vec<f64> = half(s, -rest).iter().chain(half(-s, rest).iter()).map(|y| y - shift).collect();
    Found::of(&all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_right_where_nothing_is_hard() {
        let close = |found: Found, expected: &[f64]| {
            assert_eq!(found.len(), expected.len(), "{found:?}");
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        };
        close(textbook_quadratic(&[2.0, -3.0, 1.0]), &[1.0, 2.0]);
        close(stable_quadratic(&[2.0, -3.0, 1.0]), &[1.0, 2.0]);
        for cubic in [cardano, polished_cardano] {
            close(cubic(&[-6.0, 11.0, -6.0, 1.0]), &[1.0, 2.0, 3.0]);
            close(cubic(&[-2.0, 1.0, -2.0, 1.0]), &[2.0]);
        }
        close(ferrari(&[24.0, -50.0, 35.0, -10.0, 1.0]), &[1.0, 2.0, 3.0, 4.0]);
        close(ferrari(&[-4.0, 0.0, 3.0, 0.0, 1.0]), &[-1.0, 1.0]);
        close(ferrari(&[4.0, 0.0, 5.0, 0.0, 1.0]), &[]);
        close(ferrari(&[-2.0, -1.0, -1.0, -1.0, 1.0]), &[-1.0, 2.0]);
    }
}
