//! Lengths by a fixed Gauss–Legendre rule, and their inverse by Newton's steps without a bracket.

use glam::DVec2;

/// |γ′(t)| of a plane cubic from its Bézier points.
pub fn speed(p: &[DVec2; 4], t: f64) -> f64 {
    let r = 1.0 - t;
    let d = (p[1] - p[0]) * (r * r) + (p[2] - p[1]) * (2.0 * r * t) + (p[3] - p[2]) * (t * t);
    3.0 * d.length()
}

/// Nodes in (−1, 1) and weights of the rule with n points, by Newton's steps on Legendre's polynomial.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let guess = std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5);
            let mut x = crate::math::elementary::cos(guess);
            for _ in 0..8 {
                let (p, slope) = legendre(n, x);
                x -= p / slope;
            }
            let (_, slope) = legendre(n, x);
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Pₙ(x) and its derivative.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut p) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
    }
    (p, n as f64 * (x * p - before) / (x * x - 1.0))
}

/// The length from 0 to t by the rule, undivided.
pub fn fixed(rule: &[(f64, f64)], p: &[DVec2; 4], t: f64) -> f64 {
    let half = 0.5 * t;
    half * rule.iter().map(|(x, w)| w * speed(p, half + half * x)).sum::<f64>()
}

/// t with length s, by at most 50 of Newton's steps from s over the whole; and how often the speed was evaluated.
pub fn newton(rule: &[(f64, f64)], p: &[DVec2; 4], s: f64) -> (f64, usize) {
    let total = fixed(rule, p, 1.0);
    let mut t = s / total;
    let mut evaluations = rule.len();
    for _ in 0..50 {
        let step = (fixed(rule, p, t) - s) / speed(p, t);
        evaluations += rule.len() + 1;
        t -= step;
        if !(step.abs() > 1e-15) {
            break;
        }
    }
    (t, evaluations)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_for_polynomials_of_twice_its_size() {
        for n in [2, 16, 24, 64] {
            let sum: f64 = gauss_legendre(n)
                .iter()
                .map(|(x, w)| w * crate::math::elementary::powi(*x, 2 * n as i32 - 2))
                .sum();
            assert!((sum - 2.0 / (2.0 * n as f64 - 1.0)).abs() < 1e-14, "{n}: {sum}");
        }
    }
}
