//! The first zero along a ray by fixed steps and bisection, and by intervals alone.

use crate::math::interval::Interval;

/// The first change of sign in [0, far] seen by steps of `step`, closed in on by halving; and how often f was evaluated.
pub fn march(f: impl Fn(f64) -> f64, far: f64, step: f64) -> (Option<f64>, usize) {
    let n = (far / step).ceil() as usize;
    let (mut a, mut fa) = (0.0, f(0.0));
    for k in 1..=n {
        let b = k as f64 * step;
        let fb = f(b);
        if fa == 0.0 {
            return (Some(a), k + 1);
        }
        if fa * fb < 0.0 {
            return (Some(halve(&f, a, b, fa)), k + 1 + HALVINGS);
        }
        (a, fa) = (b, fb);
    }
    (None, n + 1)
}

const HALVINGS: usize = 52;

fn halve(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64, fa: f64) -> f64 {
    for _ in 0..HALVINGS {
        let m = 0.5 * (a + b);
        if f(m) * fa > 0.0 { a = m } else { b = m }
    }
    0.5 * (a + b)
}

/// The first zero in [0, far] by halving pieces over which intervals do not exclude one, down to pieces of `least` (Mitchell 1990 without
/// derivatives), and how often f was bounded; none where that would be oftener than `budget`.
pub fn halve_bounded(
    bounds: impl Fn(Interval) -> Interval,
    far: f64,
    least: f64,
    budget: usize,
) -> (Option<f64>, usize) {
    let mut pieces = vec![(0.0, far)];
    let mut n = 0;
    while let Some((a, b)) = pieces.pop().filter(|_| n < budget) {
        n += 1;
        let middle = 0.5 * (a + b);
        if !bounds(Interval::new(a, b)).contains(0.0) {
            continue;
        }
        if b - a <= least {
            return (Some(middle), n);
        }
        pieces.extend([(middle, b), (a, middle)]);
    }
    (None, n)
}
