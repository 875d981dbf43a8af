//! Where a function along a piece changes its sign: every place, in order. Knows nothing of rays.
//!
//! An interval is thrown away where the function's range leaves out 0, searched by a bracketed Newton where its slope keeps one sign, and
//! halved otherwise. A sign is taken at each end once, 0 counting as positive, so that pieces which join in the same value share their
//! crossings without doubling or losing one: along a closed chain they are even in number. A place where the function touches 0
//! within rounding, without a change of sign, is found as well.

use crate::math::bracket;

/// A function over [0, 1] that can be bounded.
pub trait Bounded {
    /// The value at x, the same bits as often as it is asked.
    fn value(&self, x: f64) -> f64;
    /// The slope at x, for Newton's steps alone.
    fn slope(&self, x: f64) -> f64;
    /// Least and greatest value over `[from, to]`, perhaps wider.
    fn range(&self, from: f64, to: f64) -> (f64, f64);
    /// Least and greatest slope over `[from, to]`, perhaps wider.
    fn slopes(&self, from: f64, to: f64) -> (f64, f64);
    /// What rounding may make of a value that is 0.
    fn noise(&self) -> f64;
}

/// An interval this narrow is not halved further.
const NARROWEST: f64 = 1.0 / (1u64 << 46) as f64;
/// Most intervals looked at. A tangent takes some hundred; where the function is 0 all along, there are no places to be found.
const MOST: usize = 600;
/// Halvings from the whole to the narrowest, and one.
const STACK: usize = 48;

/// Calls `found` with each zero in `[from, to]`, ascending, and whether the sign changes there; a touching one once.
pub fn zeros(f: &impl Bounded, from: f64, to: f64, mut found: impl FnMut(f64, bool)) {
    let mut waiting = [(0.0, 0.0); STACK];
    waiting[0] = (from, to);
    let mut height = 1;
    let mut touched = f64::NEG_INFINITY;
    for _ in 0..MOST {
        if height == 0 {
            return;
        }
        height -= 1;
        let (a, b) = waiting[height];
        let (low, high) = f.range(a, b);
        if low > 0.0 || high < 0.0 {
            continue;
        }
        let (falls, rises) = f.slopes(a, b);
        let middle = 0.5 * (a + b);
        let is_narrow = b - a <= NARROWEST || !(a < middle && middle < b) || height + 2 > STACK;
        if falls > 0.0 || rises < 0.0 || is_narrow {
            let (at_a, at_b) = (f.value(a) >= 0.0, f.value(b) >= 0.0);
            if at_a != at_b {
                found(bracket::newton(a, b, middle, at_b, |x| (f.value(x), f.slope(x))), true);
            } else if is_narrow && a - touched > 1e6 * NARROWEST && f.value(middle).abs() <= f.noise() {
                found(middle, false);
                touched = a;
            }
            continue;
        }
        waiting[height] = (middle, b);
        waiting[height + 1] = (a, middle);
        height += 2;
    }
}

/// Least and greatest value of a quadratic with these Bézier values over `[from, to]` of [0, 1], perhaps wider.
pub fn quadratic_range(q: &[f64; 3], from: f64, to: f64) -> (f64, f64) {
    let blossom = |a: f64, b: f64| {
        let (r, s) = (q[0] + (q[1] - q[0]) * a, q[1] + (q[2] - q[1]) * a);
        r + (s - r) * b
    };
    let (x, y, z) = (blossom(from, from), blossom(from, to), blossom(to, to));
    let (mut low, mut high) = if x < z { (x, z) } else { (z, x) };
    if y < low {
        low = y;
    }
    if y > high {
        high = y;
    }
    (low, high)
}

/// The product of two ranges.
pub fn product((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
    let all = [a * c, a * d, b * c, b * d];
    all.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (if x < low { x } else { low }, if x > high { x } else { high })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (x − ⅓)² (x − 0.8), or that with a little added, whose crossings draw apart.
    struct Touching(f64);

    impl Bounded for Touching {
        fn value(&self, x: f64) -> f64 {
            (x - 1.0 / 3.0) * (x - 1.0 / 3.0) * (x - 0.8) + self.0
        }
        fn slope(&self, x: f64) -> f64 {
            (x - 1.0 / 3.0) * (3.0 * x - 29.0 / 15.0)
        }
        fn range(&self, from: f64, to: f64) -> (f64, f64) {
            let square = product((from - 1.0 / 3.0, to - 1.0 / 3.0), (from - 1.0 / 3.0, to - 1.0 / 3.0));
            let (low, high) = product((square.0, square.1), (from - 0.8, to - 0.8));
            (low + self.0, high + self.0)
        }
        fn slopes(&self, from: f64, to: f64) -> (f64, f64) {
            product((from - 1.0 / 3.0, to - 1.0 / 3.0), (3.0 * from - 29.0 / 15.0, 3.0 * to - 29.0 / 15.0))
        }
        fn noise(&self) -> f64 {
            1e-16
        }
    }

    fn all(f: &impl Bounded) -> Vec<f64> {
        let mut found = Vec::new();
        zeros(f, 0.0, 1.0, |x, _| found.push(x));
        found
    }

    #[test]
    fn a_touch_and_a_crossing_are_told_apart() {
        let found = all(&Touching(0.0));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0] - 1.0 / 3.0).abs() < 1e-7 && (found[1] - 0.8).abs() < 1e-15);
        let apart = all(&Touching(1e-9));
        assert_eq!(apart.len(), 3, "{apart:?}");
        assert_eq!(all(&Touching(-1e-9)).len(), 1);
    }

    #[test]
    fn ranges_of_quadratics_hold_their_values() {
        let q = [0.3, -0.8, 0.5];
        let at = |x: f64| q[0] * (1.0 - x) * (1.0 - x) + 2.0 * q[1] * x * (1.0 - x) + q[2] * x * x;
        for (a, b) in [(0.0, 1.0), (0.2, 0.4), (0.5, 0.500_01)] {
            let (low, high) = quadratic_range(&q, a, b);
            for k in 0..=20 {
                let y = at(a + (b - a) * f64::from(k) / 20.0);
                assert!(y >= low - 1e-15 && y <= high + 1e-15);
            }
        }
    }
}
