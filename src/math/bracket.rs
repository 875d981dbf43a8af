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

/// The root of a continuous `f` between two places with its values there, which differ in sign (or one is 0), to within `tolerance`: of the last
/// bracket the end whose value is nearer to 0. Inverse quadratic steps where they promise more than halving (Chandrupatla, *A new hybrid
/// quadratic/bisection algorithm*, 1997); a NaN ends the search. Usually 5 to 8 evaluations.
pub fn closest(a: (f64, f64), b: (f64, f64), tolerance: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    // `one` is the newest, on the other side of 0 from `two`; `three` is what was dropped last.
    let (mut one, mut two) = (b, a);
    let mut share = 0.5;
    for _ in 0..MAX_STEPS {
        let best = if one.1.abs() < two.1.abs() { one } else { two };
        let width = (two.0 - one.0).abs();
        let least = 0.5 * (tolerance + f64::EPSILON * best.0.abs()) / width;
        if best.1 == 0.0 || !(least < 0.5) {
            return best.0;
        }
        let x = one.0 + f64::clamp(share, least, 1.0 - least) * (two.0 - one.0);
        let value = f(x);
        if value.is_nan() {
            return best.0;
        }
        let three = if (value < 0.0) == (one.1 < 0.0) { one } else { std::mem::replace(&mut two, one) };
        one = (x, value);
        share = chandrupatla(one, two, three);
    }
    one.0
}

/// Where a root may be, and how steep the function is there.
#[derive(Clone, Copy, Debug)]
pub struct Guess {
    /// The place.
    pub at: f64,
    /// The slope, not 0.
    pub slope: f64,
    /// How far the slope may change over the bracket.
    pub bend: f64,
}

/// The root of a monotone `f` between two places where its signs differ, to within `tolerance`: secants from a guess, halvings where those do not
/// converge. The last step is not checked where the one before it says that it is exact. A NaN ends the search. Usually 3 to 5 evaluations.
pub fn secant(lo: f64, hi: f64, guess: Guess, tolerance: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let (mut lo, mut hi, mut slope) = (lo, hi, guess.slope);
    let mut x = if guess.at > lo && guess.at < hi { guess.at } else { middle(lo, hi) };
    let mut last: Option<(f64, f64)> = None;
    let (mut size, mut size_before) = (hi - lo, hi - lo);
    let curvature = 2.0 * guess.bend / (hi - lo);
    for _ in 0..MAX_STEPS {
        let y = f(x);
        if y == 0.0 || y.is_nan() {
            return x;
        }
        if (y > 0.0) == (guess.slope > 0.0) {
            hi = x
        } else {
            lo = x
        }
        // How far the slope may be off, as a share of it.
        let mut doubt = 1.0;
        if let Some((x0, y0)) = last {
            let secant = (y - y0) / (x - x0);
            if secant * guess.slope > 0.0 {
                doubt = (secant - slope).abs().max(curvature * (x - x0).abs()) / secant.abs();
                slope = secant;
            }
        }
        let step = y / slope;
        let next = x - step;
        if step.abs() * doubt <= 0.5 * tolerance || hi - lo <= tolerance {
            return next.clamp(lo, hi);
        }
        last = Some((x, y));
        // A step must halve every second time; otherwise the bracket does it.
        let converges = next > lo && next < hi && step.abs() <= 0.5 * size_before;
        (size_before, size) = (size, step.abs());
        x = if converges { next } else { middle(lo, hi) };
        if !(x > lo && x < hi) {
            return x;
        }
    }
    x
}

/// Where between `one` and `two` to look next, as a share of the way.
fn chandrupatla(one: (f64, f64), two: (f64, f64), three: (f64, f64)) -> f64 {
    let xi = (one.0 - two.0) / (three.0 - two.0);
    let phi = (one.1 - two.1) / (three.1 - two.1);
    let fits = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
    if !fits {
        return 0.5;
    }
    let direct = one.1 / (two.1 - one.1) * three.1 / (two.1 - three.1);
    let bent = (three.0 - one.0) / (two.0 - one.0) * one.1 / (three.1 - one.1) * two.1 / (three.1 - two.1);
    direct + bent
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
    fn the_nearest_end_is_found_in_few_steps() {
        let mut n = 0;
        let mut counted = |lo: f64, hi: f64, f: &dyn Fn(f64) -> f64| {
            n = 0;
            let root = closest((lo, f(lo)), (hi, f(hi)), 0.0, |x| {
                n += 1;
                f(x)
            });
            (root, n)
        };
        let (root, n) = counted(0.0, 2.0, &|x| x * x - 2.0);
        assert!((root - 2f64.sqrt()).abs() <= f64::EPSILON && n <= 9, "{root} after {n}");
        let (root, n) = counted(-1.0, 1.0, &|x| crate::math::elementary::cbrt(x - 0.1));
        assert!((root - 0.1).abs() < 1e-15 && n <= 60, "{root} after {n}");
        let (root, _) = counted(0.0, 1.0, &|x| if x < 0.3 { -1.0 } else { 1.0 });
        assert!((root - 0.3).abs() <= f64::EPSILON, "{root}");
        assert_eq!(counted(0.0, 1.0, &|x| x - 0.25).0, 0.25);
    }

    #[test]
    fn secants_end_at_the_root_from_any_guess() {
        type Case = (&'static str, fn(f64) -> f64, f64);
        let functions: [Case; 4] = [
            ("a square", |x| x * x - 2.0, 2f64.sqrt()),
            ("a line", |x| 3.0 * x - 3.75, 1.25),
            ("a kink", |x| if x < 1.1 { x - 1.1 } else { 40.0 * (x - 1.1) }, 1.1),
            ("a cube", |x| (x - 1.3) * (x - 1.3) * (x - 1.3), 1.3),
        ];
        for (name, f, root) in functions {
            for (at, slope) in [(1.41, 2.8), (1.0, 1.0), (9.0, 1e-3), (1.9, 1e6)] {
                let mut n = 0;
                let found = secant(1.0, 2.0, Guess { at, slope, bend: 40.0 }, f64::EPSILON, |x| {
                    n += 1;
                    f(x)
                });
                // Beside a triple root the values themselves are 0.
                let (allowed, most) = if name == "a cube" { (1e-5, 100) } else { (4.0 * f64::EPSILON, 70) };
                assert!(
                    (found - root).abs() <= allowed && n <= most,
                    "{name} from {at}, {slope}: {found} after {n}"
                );
                let reverse =
                    secant(-2.0, -1.0, Guess { at: -at, slope: -slope, bend: 40.0 }, f64::EPSILON, |x| f(-x));
                assert_eq!(reverse, -found, "{name} from {at}, {slope}");
            }
        }
        let mut n = 0;
        secant(1.0, 2.0, Guess { at: 1.41, slope: 2.8, bend: 2.0 }, f64::EPSILON, |x| {
            n += 1;
            x * x - 2.0
        });
        assert!(n <= 4, "{n}");
    }

    #[test]
    fn golden_sections_find_a_kink() {
        let x = minimum(0.0, 3.0, |x| (x - 1.2345).abs());
        assert!((x - 1.2345).abs() < 1e-7);
    }
}
