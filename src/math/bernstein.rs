//! Polynomials of one variable on [0, 1] in Bernstein form: value, derivative and all real roots. Knows nothing of curves.
//!
//! Roots are found by the recursion of Yuksel, *High-performance polynomial root finding for graphics* (2022): the roots of
//! the derivative cut [0, 1] into intervals on which the polynomial is monotone, and each sign change is closed in on by
//! bracketed Newton. Coefficients stay in Bernstein form throughout, whose values on [0, 1] have the least error.

use super::bracket;
use super::error::UNIT_ROUNDOFF;

/// Highest degree that [`roots`] takes.
pub const MAX_DEGREE: usize = 9;

/// Σ cᵢ Bᵢ(t) by de Casteljau's algorithm. At most [`MAX_DEGREE`] + 1 coefficients, at least one.
pub fn value(coefficients: &[f64], t: f64) -> f64 {
    value_and_bound(coefficients, t).0
}

/// The value, and Σ |cᵢ| Bᵢ(t): what its rounding error is a small multiple of u of.
pub fn value_and_bound(coefficients: &[f64], t: f64) -> (f64, f64) {
    let n = coefficients.len();
    let mut c = [0.0; MAX_DEGREE + 1];
    let mut magnitude = [0.0; MAX_DEGREE + 1];
    c[..n].copy_from_slice(coefficients);
    for (m, c) in magnitude.iter_mut().zip(coefficients) {
        *m = c.abs();
    }
    let (r, a) = (1.0 - t, (1.0 - t).abs());
    for level in (1..n).rev() {
        for i in 0..level {
            c[i] = r * c[i] + t * c[i + 1];
            magnitude[i] = a * magnitude[i] + t.abs() * magnitude[i + 1];
        }
    }
    (c[0], magnitude[0])
}

/// Value and derivative at t.
fn value_and_slope(coefficients: &[f64], t: f64) -> (f64, f64) {
    let n = coefficients.len();
    let mut c = [0.0; MAX_DEGREE + 1];
    c[..n].copy_from_slice(coefficients);
    let r = 1.0 - t;
    for level in (2..n).rev() {
        for i in 0..level {
            c[i] = r * c[i] + t * c[i + 1];
        }
    }
    (r * c[0] + t * c[1], (n - 1) as f64 * (c[1] - c[0]))
}

/// How far a computed value may be off, in units of u·Σ|cᵢ|Bᵢ: a touching root is one whose value is within this.
const TOUCH: f64 = 8.0;

/// All t in [0, 1] where the polynomial is 0, ascending. A root where the value touches 0 without crossing is reported once, and
/// only where its value is within rounding of 0 (`TOUCH`). None for the zero polynomial, which has no isolated root.
pub fn roots(coefficients: &[f64]) -> Vec<f64> {
    let n = coefficients.len();
    debug_assert!((1..=MAX_DEGREE + 1).contains(&n));
    let largest = coefficients.iter().fold(0.0f64, |m, c| if c.abs() > m { c.abs() } else { m });
    if n < 2 || largest == 0.0 || !coefficients.iter().all(|c| c.is_finite()) {
        return Vec::new();
    }
    if one_sign(coefficients) {
        return Vec::new();
    }
    if n == 2 {
        return vec![coefficients[0] / (coefficients[0] - coefficients[1])];
    }
    let mut cuts = vec![0.0];
    cuts.extend(critical_points(coefficients).into_iter().filter(|t| *t > 0.0 && *t < 1.0));
    cuts.push(1.0);
    roots_between(coefficients, &cuts)
}

/// Where the derivative is 0.
fn critical_points(coefficients: &[f64]) -> Vec<f64> {
    let mut differences = [0.0; MAX_DEGREE + 1];
    let n = coefficients.len() - 1;
    for i in 0..n {
        differences[i] = coefficients[i + 1] - coefficients[i];
    }
    roots(&differences[..n])
}

/// All above 0, or all below: no root, by the convex hull.
fn one_sign(coefficients: &[f64]) -> bool {
    coefficients.iter().all(|c| *c > 0.0) || coefficients.iter().all(|c| *c < 0.0)
}

/// Roots, given points between which the polynomial is monotone.
fn roots_between(coefficients: &[f64], cuts: &[f64]) -> Vec<f64> {
    let sign_at = |t: f64| {
        let (value, bound) = value_and_bound(coefficients, t);
        // The ends are coefficients, without any error.
        let slack = if t == 0.0 || t == 1.0 { 0.0 } else { TOUCH * UNIT_ROUNDOFF * bound };
        if value > slack {
            1
        } else if value < -slack {
            -1
        } else {
            0
        }
    };
    let mut found = Vec::new();
    let mut before = sign_at(cuts[0]);
    if before == 0 {
        found.push(cuts[0]);
    }
    for pair in cuts.windows(2) {
        let after = sign_at(pair[1]);
        if before * after < 0 {
            let f = |t| value_and_slope(coefficients, t);
            found.push(bracket::newton(pair[0], pair[1], secant(coefficients, pair), after > 0, f));
        } else if after == 0 {
            found.push(pair[1]);
        }
        before = after;
    }
    found
}

/// Where the line through the ends of an interval crosses 0.
fn secant(coefficients: &[f64], ends: &[f64]) -> f64 {
    let (a, b) = (value(coefficients, ends[0]), value(coefficients, ends[1]));
    ends[0] + (ends[1] - ends[0]) * (a / (a - b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of Π (t − rᵢ) in Bernstein form, multiplied out factor by factor.
    fn from_roots(roots: &[f64]) -> Vec<f64> {
        roots.iter().fold(vec![1.0], |c, r| {
            let n = c.len();
            let at = |i: usize| c.get(i).copied().unwrap_or(0.0);
            let term = |k: usize| {
                let down = if k == 0 { 0.0 } else { at(k - 1) * k as f64 * (1.0 - r) };
                (at(k) * (n - k) as f64 * -r + down) / n as f64
            };
            (0..=n).map(term).collect()
        })
    }

    #[test]
    fn planted_roots_come_back() {
        for planted in [vec![0.25], vec![0.1, 0.9], vec![0.2, 0.5, 0.7], vec![0.01, 0.3, 0.5, 0.8, 0.99]] {
            let got = roots(&from_roots(&planted));
            assert_eq!(got.len(), planted.len(), "{planted:?} gave {got:?}");
            assert!(got.iter().zip(&planted).all(|(a, b)| (a - b).abs() < 1e-13), "{planted:?} gave {got:?}");
        }
    }

    #[test]
    fn a_touching_root_is_reported_once_and_a_near_miss_is_not() {
        assert_eq!(roots(&[0.25, -0.25, 0.25]), vec![0.5]);
        assert!(roots(&[0.25 + 1e-12, -0.25 + 1e-12, 0.25 + 1e-12]).is_empty());
        assert_eq!(roots(&[0.25 - 1e-12, -0.25 - 1e-12, 0.25 - 1e-12]).len(), 2);
    }

    #[test]
    fn three_roots_a_hundred_thousandth_apart_stay_three() {
        let got = roots(&from_roots(&[0.5 - 1e-5, 0.5, 0.5 + 1e-5]));
        assert_eq!(got.len(), 3, "{got:?}");
        assert!((got[1] - 0.5).abs() < 1e-6, "{got:?}");
    }

    #[test]
    fn ends_are_roots_where_their_coefficient_is_zero() {
        assert_eq!(roots(&[0.0, 1.0, 1.0, 0.0]), vec![0.0, 1.0]);
        assert!(roots(&[0.0; 4]).is_empty());
        assert!(roots(&[f64::NAN, 1.0]).is_empty());
    }

    #[test]
    fn a_tiny_leading_term_loses_no_root() {
        // t² − 1.2 t + 0.32 with 1e-20 t³ in front.
        let (a, b, c) = (0.32, -1.2, 1.0);
        let bernstein = [a, a + b / 3.0, a + 2.0 * b / 3.0 + c / 3.0, a + b + c + 1e-20];
        let got = roots(&bernstein);
        assert_eq!(got.len(), 2);
        assert!((got[0] - 0.4).abs() < 1e-15 && (got[1] - 0.8).abs() < 1e-15, "{got:?}");
    }
}
