//! All zeros of a function over an interval, in order, none missed: interval bisection with the mean-value form, and a
//! bracketed solver once a piece is proved to hold exactly one zero.
//!
//! Moore, Kearfott & Cloud, *Introduction to Interval Analysis*, ch. 8. What cannot be told apart down to the resolution
//! (a double zero, a tangent, a jump) is reported as what it is, never dropped.

use super::interval::Interval;

/// A function of one number that can be bounded over an interval.
pub trait Bounded {
    /// The value at `t` in plain f64; NaN where it has none.
    fn value(&self, t: f64) -> f64;
    /// Intervals that hold every value and every derivative over `t`.
    fn bounds(&self, t: Interval) -> (Interval, Interval);
}

/// A zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    /// Where.
    pub t: f64,
    /// How the function behaves there.
    pub kind: ZeroKind,
}

/// How a function behaves at a zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZeroKind {
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
    /// Zero within what rounding can tell, with the same sign on both sides: a tangent or an even zero.
    Touching,
    /// The sign changes across the piece, but by a jump or a cusp rather than a proved single zero.
    Crossing,
}

/// The search for zeros, nearest first.
pub struct Zeros<'f, F: Bounded> {
    f: &'f F,
    /// Pieces still to be searched, nearest last.
    pieces: Vec<Interval>,
    /// Relative width of a piece that is not split again.
    resolution: f64,
    /// How many times the function was bounded or evaluated.
    evaluations: usize,
    budget: usize,
    /// A run of unresolved pieces that touch.
    cluster: Option<Interval>,
    exhausted: bool,
}

/// Pieces are not split below this many steps of the floating-point grid at their larger end.
const LEAST_STEPS: f64 = 4.0;

impl<'f, F: Bounded> Zeros<'f, F> {
    /// Searches `from … to`, splitting pieces down to a few steps of the grid, with at most `budget` evaluations.
    pub fn new(f: &'f F, from: f64, to: f64, budget: usize) -> Self {
        let pieces = if from <= to { vec![Interval::new(from, to)] } else { Vec::new() };
        Zeros {
            f,
            pieces,
            resolution: LEAST_STEPS * f64::EPSILON,
            evaluations: 0,
            budget,
            cluster: None,
            exhausted: false,
        }
    }

    /// How many times the function was bounded or evaluated so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// True where the budget ran out: zeros beyond the last one given may be missing, and the caller must say so.
    pub fn exhausted(&self) -> bool {
        self.exhausted
    }

    fn sign(&mut self, t: f64) -> f64 {
        self.evaluations += 1;
        let (range, _) = self.f.bounds(Interval::point(t));
        if range.lo > 0.0 {
            1.0
        } else if range.hi < 0.0 {
            -1.0
        } else {
            0.0
        }
    }

    /// Ends a cluster of unresolved pieces: one zero where the function comes nearest to 0.
    fn settle(&mut self) -> Option<Zero> {
        let piece = self.cluster.take()?;
        // A little outside the cluster the sign is known again; inside, rounding hides it.
        let reach = (piece.width() * 8.0).max(piece.hi.abs() * f64::EPSILON * 64.0);
        let (before, after) = (self.f.value(piece.lo - reach), self.f.value(piece.hi + reach));
        self.evaluations += 2;
        let kind = if before * after < 0.0 { ZeroKind::Crossing } else { ZeroKind::Touching };
        Some(Zero { t: piece.middle(), kind })
    }

    /// Takes an unresolved piece into the cluster, or ends the cluster before it.
    fn gather(&mut self, piece: Interval) -> Option<Zero> {
        match self.cluster {
            Some(c) if piece.lo - c.hi <= 16.0 * (c.width() + piece.width()) => {
                self.cluster = Some(c.hull(piece));
                None
            }
            _ => {
                let ended = self.settle();
                self.cluster = Some(piece);
                ended
            }
        }
    }

    /// The zero of a piece over which the derivative keeps its sign.
    fn monotone(&mut self, piece: Interval, rising: bool) -> Option<Zero> {
        let (a, b) = (self.sign(piece.lo), self.sign(piece.hi));
        let kind = if rising { ZeroKind::Rising } else { ZeroKind::Falling };
        // Pieces are half open, so that a zero on a seam is counted once: by the piece that starts there.
        if a == 0.0 {
            return Some(Zero { t: piece.lo, kind });
        }
        if b == 0.0 && self.pieces.last().is_none_or(|next| next.lo != piece.hi) {
            return Some(Zero { t: piece.hi, kind });
        }
        (a * b < 0.0).then(|| Zero { t: self.bracketed(piece.lo, piece.hi, a), kind })
    }

    /// The single zero between `a` and `b`, by the ITP method of Oliveira & Takahashi (2020), to the last bit that the
    /// values can tell.
    fn bracketed(&mut self, mut a: f64, mut b: f64, sign_a: f64) -> f64 {
        let (mut fa, mut fb) = (self.f.value(a) * sign_a, self.f.value(b) * sign_a);
        for _ in 0..128 {
            let middle = a / 2.0 + b / 2.0;
            if !(a < middle && middle < b) {
                break;
            }
            // Regula falsi, pulled toward the middle so that a bracket never shrinks from one side alone.
            let guess = (fb * a - fa * b) / (fb - fa);
            let inside = guess > a && guess < b;
            let pull = (b - a) * 0.05;
            let t = if inside {
                guess + pull.copysign(middle - guess).clamp(-(middle - guess).abs(), (middle - guess).abs())
            } else {
                middle
            };
            let t = if t > a && t < b { t } else { middle };
            self.evaluations += 1;
            let ft = self.f.value(t) * sign_a;
            if ft > 0.0 {
                (a, fa) = (t, ft);
            } else if ft < 0.0 {
                (b, fb) = (t, ft);
            } else {
                return t;
            }
            // A tight bracket from the secant leaves the far end behind: test one step beyond.
            let near = guess.next_up().max(t) + (b - a) * f64::EPSILON.sqrt();
            if inside && near < b && near > a {
                self.evaluations += 1;
                let value = self.f.value(near) * sign_a;
                if value > 0.0 { (a, fa) = (near, value) } else { (b, fb) = (near, value) }
            }
        }
        if fa.abs() < fb.abs() { a } else { b }
    }
}

impl<F: Bounded> Iterator for Zeros<'_, F> {
    type Item = Zero;

    fn next(&mut self) -> Option<Zero> {
        while let Some(piece) = self.pieces.pop() {
            if self.evaluations >= self.budget {
                self.exhausted = true;
                self.pieces.clear();
                break;
            }
            self.evaluations += 1;
            let (value, slope) = self.f.bounds(piece);
            if !value.contains(0.0) && !value.gaps.are_there() {
                continue;
            }
            if !slope.contains(0.0) && !slope.is_empty() && !slope.gaps.are_there() && !value.gaps.are_there()
            {
                if let Some(zero) = self.monotone(piece, slope.lo > 0.0) {
                    // The cluster before it comes first.
                    if let Some(ended) = self.settle() {
                        self.pieces.push(piece);
                        return Some(ended);
                    }
                    return Some(zero);
                }
                continue;
            }
            let middle = piece.middle();
            let steps = piece.lo.abs().max(piece.hi.abs()) * self.resolution;
            if piece.width() <= steps.max(f64::MIN_POSITIVE) || !(piece.lo < middle && middle < piece.hi) {
                if let Some(ended) = self.gather(piece) {
                    return Some(ended);
                }
                continue;
            }
            self.pieces.push(Interval::new(middle, piece.hi));
            self.pieces.push(Interval::new(piece.lo, middle));
        }
        self.settle()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Of<V: Fn(f64) -> f64, B: Fn(Interval) -> (Interval, Interval)>(V, B);

    impl<V: Fn(f64) -> f64, B: Fn(Interval) -> (Interval, Interval)> Bounded for Of<V, B> {
        fn value(&self, t: f64) -> f64 {
            self.0(t)
        }

        fn bounds(&self, t: Interval) -> (Interval, Interval) {
            self.1(t)
        }
    }

    fn constant(x: f64) -> Interval {
        Interval::point(x)
    }

    /// ((t − 3)² − 1)² − 1e-8: a shell one ten-thousandth thick at 2 and at 4.
    fn thin_shell() -> impl Bounded {
        Of(
            |t| ((t - 3.0) * (t - 3.0) - 1.0).powi(2) - 1e-8,
            |t| {
                let d = t - constant(3.0);
                let r = d.square() - constant(1.0);
                (r.square() - constant(1e-8), constant(4.0) * r * d)
            },
        )
    }

    #[test]
    fn all_four_sides_of_a_thin_shell_are_found() {
        let f = thin_shell();
        let zeros: Vec<_> = Zeros::new(&f, 0.0, 10.0, 10_000).collect();
        let inner = (1.0f64 - 1e-4).sqrt();
        let outer = (1.0f64 + 1e-4).sqrt();
        let expected = [3.0 - outer, 3.0 - inner, 3.0 + inner, 3.0 + outer];
        assert_eq!(zeros.len(), 4, "{zeros:?}");
        for (zero, t) in zeros.iter().zip(expected) {
            assert!((zero.t - t).abs() < 1e-11, "{zero:?} is not {t}");
        }
    }

    #[test]
    fn a_double_zero_touches_and_is_said_once() {
        let f = Of(
            |t: f64| (t - 2.0) * (t - 2.0),
            |t| {
                let d = t - constant(2.0);
                (d.square(), constant(2.0) * d)
            },
        );
        let zeros: Vec<_> = Zeros::new(&f, 0.0, 5.0, 10_000).collect();
        assert_eq!(zeros.len(), 1, "{zeros:?}");
        assert!((zeros[0].t - 2.0).abs() < 1e-14 && zeros[0].kind == ZeroKind::Touching);
    }

    #[test]
    fn twenty_crests_of_a_sine_are_found_in_order_with_their_signs() {
        let f = Of(crate::math::elementary::sin, |t| (t.sin(), t.cos()));
        let zeros: Vec<_> = Zeros::new(&f, 1.0, 20.5 * std::f64::consts::PI, 10_000).collect();
        assert_eq!(zeros.len(), 20);
        for (k, zero) in zeros.iter().enumerate() {
            assert!((zero.t - (k + 1) as f64 * std::f64::consts::PI).abs() < 1e-14 * zero.t, "{zero:?}");
            assert_eq!(zero.kind, if k % 2 == 0 { ZeroKind::Falling } else { ZeroKind::Rising });
        }
    }

    #[test]
    fn a_zero_on_a_seam_counts_once_and_evaluations_are_few() {
        let f = Of(|t| t - 2.5, |t| (t - constant(2.5), constant(1.0)));
        let mut zeros = Zeros::new(&f, 0.0, 5.0, 1000);
        assert_eq!(zeros.by_ref().map(|z| z.t).collect::<Vec<_>>(), [2.5]);
        assert!(zeros.evaluations() < 12, "{}", zeros.evaluations());
    }

    #[test]
    fn an_empty_budget_is_said() {
        let f = thin_shell();
        let mut zeros = Zeros::new(&f, 0.0, 10.0, 5);
        assert_eq!(zeros.by_ref().count(), 0);
        assert!(zeros.exhausted());
    }
}
