//! Roots and minima of functions of one variable inside a bracket that never lets go of them. Knows nothing of polynomials.

/// What a function gave at a point: its value and its derivative there.
pub type ValueSlope = (f64, f64);

/// The root of `f` in `[lo, hi]`, where `f(lo)` and `f(hi)` differ in sign (or one is 0): Newton's steps where they stay inside
/// and shrink, halving otherwise. Ends when the bracket has no f64 inside, the value is 0, or the step is below half a unit in the
/// last place. At most 64 halvings' worth of evaluations and usually 4 to 8. `rising` says the sign of `f(hi)` is positive.
pub fn newton(lo: f64, hi: f64, start: f64, rising: bool, mut f: impl FnMut(f64) -> ValueSlope) -> f64 {
    let (mut lo, mut hi) = (lo, hi);
    let mut x = if start > lo && start < hi { start } else { middle(lo, hi) };
    let (mut last, mut before_last) = (hi - lo, hi - lo);
    for _ in 0..MAX_STEPS {
        let (value, slope) = f(x);
        if value == 0.0 || value.is_nan() {
            return x;
        }
        if (value > 0.0) == rising {
            hi = x;
        } else {
            lo = x;
        }
        let step = value / slope;
        let mut next = x - step;
        // A step must halve every second time; otherwise the bracket does it.
        if !(next > lo && next < hi && step.abs() <= 0.5 * before_last) {
            next = middle(lo, hi);
        }
        if next == x || next <= lo || next >= hi {
            return next.clamp(lo, hi);
        }
        before_last = last;
        last = (next - x).abs();
        x = next;
    }
    x
}

/// 53 bits of a bracket of ordinary size, twice over for the steps of Newton between halvings.
const MAX_STEPS: usize = 128;

fn middle(lo: f64, hi: f64) -> f64 {
    lo + 0.5 * (hi - lo)
}

/// Where `f` is least in `[lo, hi]`, for an `f` with one minimum there: golden sections, to about √u of the width (below which
/// values of `f` cannot tell points apart).
pub fn minimum(lo: f64, hi: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let (mut a, mut b) = (lo, hi);
    let mut x = b - GOLDEN * (b - a);
    let mut y = a + GOLDEN * (b - a);
    let (mut fx, mut fy) = (f(x), f(y));
    for _ in 0..GOLDEN_STEPS {
        if fx <= fy {
            (b, y, fy) = (y, x, fx);
            x = b - GOLDEN * (b - a);
            fx = f(x);
        } else {
            (a, x, fx) = (x, y, fy);
            y = a + GOLDEN * (b - a);
            fy = f(y);
        }
    }
    if fx <= fy { x } else { y }
}

/// (√5 − 1) / 2.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// 0.618⁴⁰ is below 2⁻²⁷, the square root of the unit roundoff.
const GOLDEN_STEPS: usize = 40;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newton_stays_in_its_bracket_where_the_slope_misleads() {
        let mut n = 0;
        let root = newton(-1.0, 1.0, 0.9, true, |x| {
            n += 1;
            (crate::math::elementary::cbrt(x - 0.1), 1e-9)
        });
        assert!((root - 0.1).abs() < 1e-15 && n < 80, "{root} after {n}");
        let root = newton(0.0, 2.0, 1.9, true, |x| (x * x - 2.0, 2.0 * x));
        assert!((root - 2f64.sqrt()).abs() <= f64::EPSILON);
        assert_eq!(newton(0.0, 1.0, 0.5, false, |x| (0.25 - x, -1.0)), 0.25);
    }

    #[test]
    fn golden_sections_find_a_kink() {
        let x = minimum(0.0, 3.0, |x| (x - 1.2345).abs());
        assert!((x - 1.2345).abs() < 1e-7);
    }
}
