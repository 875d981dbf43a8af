//! Real roots of polynomials: of degree four or less for rays, of any small degree for scenes.
//!
//! The roots of the derivative cut the line into intervals on which the polynomial is monotone; in each, a sign change is closed
//! in on by Newton's steps inside a bracket (Yuksel, *High-performance polynomial root finding for graphics*, 2022). Signs are
//! certain: where plain arithmetic cannot tell, the polynomial is summed in twice the working precision. A turn where the polynomial
//! is zero up to the rounding of its coefficients is a root, and stands for the one or two that this rounding has made of it.
//!
//! Coefficients may be of any size: variable and value are scaled by powers of two. Each root is reported once.

use super::error::{UNIT_ROUNDOFF, gamma};
use super::exact::{Double, exponent, scale_by};

/// Real roots in ascending order; room for N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roots<const N: usize = 5> {
    values: [f64; N],
    count: usize,
}

impl<const N: usize> Default for Roots<N> {
    fn default() -> Self {
        Roots { values: [0.0; N], count: 0 }
    }
}

impl<const N: usize> Roots<N> {
    fn push(&mut self, x: f64) {
        if self.count < self.values.len() && !self.contains(&x) {
            self.values[self.count] = x;
            self.count += 1;
        }
    }

    fn sorted(mut self) -> Self {
        self.values[..self.count].sort_by(f64::total_cmp);
        self
    }
}

impl<const N: usize> std::ops::Deref for Roots<N> {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// Roots of ax² + bx + c; none for the zero polynomial. Discriminant in twice the working precision (Kahan), no cancellation in
/// either root: a few ulp each.
pub fn quadratic(a: f64, b: f64, c: f64) -> Roots {
    roots_of(&[c, b, a])
}

/// Roots of ax³ + bx² + cx + d.
pub fn cubic(a: f64, b: f64, c: f64, d: f64) -> Roots {
    roots_of(&[d, c, b, a])
}

/// Roots of ax⁴ + bx³ + cx² + dx + e.
pub fn quartic(a: f64, b: f64, c: f64, d: f64, e: f64) -> Roots {
    roots_of(&[e, d, c, b, a])
}

/// All roots of Σ cᵢxⁱ, at most five coefficients; none for the zero polynomial or where a coefficient is not finite.
pub fn roots_of(coefficients: &[f64]) -> Roots {
    roots_between(coefficients, f64::NEG_INFINITY, f64::INFINITY)
}

/// The same for at most N coefficients.
pub fn roots_of_up_to<const N: usize>(coefficients: &[f64]) -> Roots<N> {
    between(coefficients, f64::NEG_INFINITY, f64::INFINITY)
}

/// The roots in [low, high].
pub fn roots_between(coefficients: &[f64], low: f64, high: f64) -> Roots {
    between(coefficients, low, high)
}

fn between<const N: usize>(coefficients: &[f64], low: f64, high: f64) -> Roots<N> {
    let finite = coefficients.iter().all(|c| c.is_finite()) && coefficients.len() <= N;
    let degree = coefficients.iter().rposition(|c| *c != 0.0);
    let (Some(degree), true) = (degree, finite) else { return Roots::default() };
    let zeros = coefficients.iter().take_while(|c| **c == 0.0).count();
    let mut roots = Roots::default();
    if zeros > 0 && low <= 0.0 && high >= 0.0 {
        roots.push(0.0);
    }
    let rest = Polynomial::<N>::balanced(&coefficients[zeros..=degree]);
    let inward = |x: f64| scale_by(x, -rest.shift);
    for &x in &*rest.roots_between(inward(low), inward(high)) {
        roots.push(scale_by(x, rest.shift));
    }
    roots.sorted()
}

/// Σ cᵢyⁱ with first and last coefficient of like size, both not 0.
struct Polynomial<const N: usize> {
    coefficients: [f64; N],
    degree: usize,
    /// x = y·2^shift.
    shift: i32,
}

impl<const N: usize> Polynomial<N> {
    fn balanced(given: &[f64]) -> Self {
        let degree = given.len() - 1;
        let shift = if degree == 0 {
            0
        } else {
            (exponent(given[0]) - exponent(given[degree])).div_euclid(degree as i32)
        };
        let size = |i: usize| exponent(given[i]) + shift * i as i32;
        let largest = (0..=degree).filter(|&i| given[i] != 0.0).map(size).max().unwrap_or(0);
        let mut coefficients = [0.0; N];
        for (i, &c) in given.iter().enumerate() {
            coefficients[i] = scale_by(c, shift * i as i32 - largest);
        }
        Polynomial { coefficients, degree, shift }
    }

    fn roots_between(&self, low: f64, high: f64) -> Roots<N> {
        let c = &self.coefficients;
        let inside = |roots: Roots<N>| {
            let mut kept = Roots::default();
            roots.iter().filter(|x| (low..=high).contains(*x)).for_each(|&x| kept.push(x));
            kept
        };
        match self.degree {
            0 => Roots::default(),
            1 => {
                let mut root = Roots::default();
                root.push(-c[0] / c[1]);
                inside(root)
            }
            2 => inside(self.quadratic()),
            _ => self.by_intervals(low, high),
        }
    }

    fn quadratic(&self) -> Roots<N> {
        let (c, b, a) = (self.coefficients[0], self.coefficients[1], self.coefficients[2]);
        let discriminant = (Double::product(b, b) - Double::product(4.0 * a, c)).value();
        let mut roots = Roots::default();
        if discriminant >= 0.0 {
            let q = -0.5 * (b + discriminant.sqrt().copysign(b));
            roots.push(q / a);
            // q is 0 only for b = c = 0, and c is not 0.
            roots.push(c / q);
        }
        roots.sorted()
    }

    /// Cuts the interval at the derivative's roots and looks for a root between each two neighbours.
    fn by_intervals(&self, low: f64, high: f64) -> Roots<N> {
        let reach = self.reach();
        let (low, high) = (low.max(-reach), high.min(reach));
        let mut roots = Roots::default();
        if !(low <= high) {
            return roots;
        }
        let mut derivative = [0.0; N];
        for i in 1..=self.degree {
            derivative[i - 1] = i as f64 * self.coefficients[i];
        }
        let turns: Roots<N> = between(&derivative[..self.degree], low, high);
        let mut left = End::at(self, low);
        if left.sign == 0 {
            roots.push(left.x);
        }
        let turns = turns.iter().map(|&x| End { x, sign: if self.touches(x) { 0 } else { self.sign(x) } });
        for right in turns.chain([End::at(self, high)]) {
            if right.sign == 0 {
                roots.push(right.x);
            } else if left.sign * right.sign < 0 {
                roots.push(self.close_in(left, right));
            }
            left = right;
        }
        roots.sorted()
    }

    /// No root is farther from 0 (Cauchy).
    fn reach(&self) -> f64 {
        let lead = self.coefficients[self.degree].abs();
        let largest = self.coefficients[..self.degree].iter().fold(0.0f64, |m, c| m.max(c.abs()));
        (1.0 + largest / lead).min(f64::MAX)
    }

    /// The value and Σ|cᵢxⁱ|, both times the same power of two where the plain sum would overflow.
    fn value(&self, x: f64) -> (f64, f64) {
        let (c, x) = self.at_safe_scale(x);
        c[..=self.degree].iter().rev().fold((0.0, 0.0), |(p, size), c| (p * x + c, size * x.abs() + c.abs()))
    }

    /// The value in twice the working precision, rounded, at the same scale.
    fn precise_value(&self, x: f64) -> f64 {
        let (c, x) = self.at_safe_scale(x);
        let x = Double::new(x);
        c[..=self.degree].iter().rev().fold(Double::new(0.0), |p, &c| p * x + Double::new(c)).value()
    }

    /// Coefficients and variable at a scale where powers of the variable cannot overflow.
    fn at_safe_scale(&self, x: f64) -> ([f64; N], f64) {
        let e = exponent(x);
        if e.abs() < 100 {
            return (self.coefficients, x);
        }
        let size = |i: usize| exponent(self.coefficients[i]) + e * i as i32;
        let largest = (0..=self.degree).filter(|&i| self.coefficients[i] != 0.0).map(size).max().unwrap_or(0);
        let scaled = std::array::from_fn(|i| scale_by(self.coefficients[i], e * i as i32 - largest));
        (scaled, scale_by(x, -e))
    }

    fn sign(&self, x: f64) -> i32 {
        let (value, size) = self.value(x);
        let certain = value.abs() > gamma(2 * self.degree as u32) * size;
        let value = if certain { value } else { self.precise_value(x) };
        i32::from(value > 0.0) - i32::from(value < 0.0)
    }

    /// Zero up to the rounding that the coefficients have seen.
    fn touches(&self, x: f64) -> bool {
        let (_, size) = self.value(x);
        self.precise_value(x).abs() <= 8.0 * UNIT_ROUNDOFF * size
    }

    /// Newton's step from x; NaN where the slope vanishes.
    fn newton(&self, x: f64) -> f64 {
        let (c, y) = self.at_safe_scale(x);
        let (value, slope) =
            c[..=self.degree].iter().rev().fold((0.0, 0.0), |(p, d), c| (p * y + c, d * y + p));
        x - (value / slope) * (x / y)
    }

    /// The root between two ends of opposite sign, to the last bit that the coefficients determine.
    fn close_in(&self, mut left: End, mut right: End) -> f64 {
        let mut x = middle(left.x, right.x, 0);
        let mut probes = 0;
        // Every third turn halves a bracket over many magnitudes in the order of floats: 64 of them, twice where it straddles zero.
        for turn in 0..400 {
            let sign = self.sign(x);
            if sign == 0 {
                return x;
            }
            let (side, other) = if sign == left.sign { (&mut left, right.x) } else { (&mut right, left.x) };
            side.x = x;
            if left.x.next_up() >= right.x {
                break;
            }
            let step = self.newton(x);
            let wide = turn % 3 == 2 && !alike(left.x, right.x);
            x = if (step - x).abs() <= 2.0 * UNIT_ROUNDOFF * x.abs() {
                // Converged from one side: bring the other one up.
                probes += 1;
                beside(x, other, probes)
            } else if left.x < step && step < right.x && !wide {
                step
            } else {
                middle(left.x, right.x, turn)
            };
        }
        let (l, r) = (self.precise_value(left.x).abs(), self.precise_value(right.x).abs());
        if l <= r { left.x } else { right.x }
    }
}

/// An end of a bracket.
#[derive(Clone, Copy)]
struct End {
    x: f64,
    sign: i32,
}

impl End {
    fn at<const N: usize>(p: &Polynomial<N>, x: f64) -> End {
        End { x, sign: p.sign(x) }
    }
}

/// Of one sign and within a factor of 256.
fn alike(a: f64, b: f64) -> bool {
    a * b > 0.0 && a.abs() <= 256.0 * b.abs() && b.abs() <= 256.0 * a.abs()
}

/// A float strictly between two that are not neighbours: the mean where they are of like size, else halfway in the order of floats;
/// across zero the one and the other by turns.
fn middle(a: f64, b: f64, turn: u32) -> f64 {
    let mean = a / 2.0 + b / 2.0;
    if a < mean && mean < b && (alike(a, b) || (a * b < 0.0 && turn.is_multiple_of(2))) {
        return mean;
    }
    let order = |x: f64| {
        let bits = x.to_bits() as i64;
        if bits < 0 { i64::MIN.wrapping_sub(bits) } else { bits }
    };
    let back = |o: i64| f64::from_bits(if o < 0 { i64::MIN.wrapping_sub(o) } else { o } as u64);
    back(((i128::from(order(a)) + i128::from(order(b))) / 2) as i64)
}

/// A few ulp from x toward an end of its bracket, farther with each probe, never at the end.
fn beside(x: f64, end: f64, probes: u32) -> f64 {
    let step = x.abs().max(f64::MIN_POSITIVE) * UNIT_ROUNDOFF * f64::from(1u32 << probes.min(30));
    let near = if end > x { (x + step).max(x.next_up()) } else { (x - step).min(x.next_down()) };
    let inside = if end > x { near < end } else { near > end };
    if inside { near } else { middle(x.min(end), x.max(end), probes) }
}

#[cfg(test)]
mod families;

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest relative error against expected roots; panics where the count differs.
    fn error(found: Roots, expected: &[f64]) -> f64 {
        assert_eq!(found.len(), expected.len(), "{found:?} for {expected:?}");
        found.iter().zip(expected).map(|(f, e)| ((f - e) / e).abs()).fold(0.0, f64::max)
    }

    /// Coefficients of (x − a)(x − b)(x − c)(x − d).
    fn from_roots([a, b, c, d]: [f64; 4]) -> Roots {
        quartic(
            1.0,
            -(a + b + c + d),
            a * (b + c) + b * (c + d) + d * (a + c),
            -a * b * (c + d) - c * d * (a + b),
            a * b * c * d,
        )
    }

    #[test]
    fn quadratics_keep_their_small_root_and_do_not_overflow() {
        const ULP: f64 = f64::EPSILON;
        assert!(error(quadratic(1.0, -1e8, 1.0), &[1e-8, 1e8]) <= 4.0 * ULP);
        assert!(error(quadratic(1e-30, -1.0, 1.0), &[1.0, 1e30]) <= 4.0 * ULP);
        let close = quadratic(94906265.625, -189812534.0, 94906268.375);
        assert!(error(close, &[1.0, 1.000000028975958]) <= 4.0 * ULP, "{close:?}");
        assert!(error(quadratic(1e200, -3e200, 2e200), &[1.0, 2.0]) <= 4.0 * ULP);
        assert!(error(quadratic(1e200, 0.0, -1e-200), &[-1e-200, 1e-200]) <= 4.0 * ULP);
    }

    #[test]
    fn degenerate_polynomials_have_the_roots_of_what_is_left() {
        assert_eq!(&*quadratic(0.0, 2.0, -1.0), [0.5]);
        assert!(quadratic(0.0, 0.0, 1.0).is_empty());
        assert!(quadratic(0.0, 0.0, 0.0).is_empty());
        assert!(quadratic(1.0, 0.0, 1.0).is_empty());
        assert_eq!(&*quartic(1.0, 0.0, 0.0, 0.0, 0.0), [0.0]);
        assert_eq!(&*cubic(1.0, 0.0, -1.0, 0.0), [-1.0, 0.0, 1.0]);
        assert!(quadratic(f64::NAN, 1.0, 1.0).is_empty());
    }

    #[test]
    fn a_tiny_leading_coefficient_does_not_hide_the_roots_of_the_rest() {
        for lead in [1e-14, 1e-20] {
            let roots = roots_between(&[0.32, -1.2, 1.0, lead], 0.0, 1.0);
            assert!(error(roots, &[0.4, 0.8]) < 1e-13, "{roots:?}");
        }
        assert_eq!(cubic(1e-20, 1.0, -1.2, 0.32).len(), 3);
    }

    #[test]
    fn touching_and_nearly_touching_roots_are_found() {
        let double = cubic(1.0, -1.4, 0.57, -0.072);
        assert!(
            double.iter().any(|x| (x - 0.3).abs() < 1e-7) && (double[double.len() - 1] - 0.8).abs() < 1e-14
        );
        let (a, b, c): (f64, f64, f64) = (0.5, 0.50001, 0.49999);
        let near = cubic(1.0, -(a + b + c), a * b + b * c + c * a, -a * b * c);
        assert!(near.iter().all(|x| (x - 0.5).abs() < 2e-5) && !near.is_empty());
        assert_eq!(quartic(1.0, 0.0, -2.0, 0.0, 1.0).to_vec(), [-1.0, 1.0]);
        assert!(quartic(1.0, 0.0, 0.0, 0.0, 1e-30).is_empty());
    }

    /// Orellana & De Michele, ACM TOMS 46 (2020), table 1, as `accuracytest.c` of CALGO 1010 has it case by case: those that have real
    /// roots. Cases 9 to 13, 16 and 18 have none; `tests/golden-numbers/roots.py` holds all.
    #[test]
    fn the_hard_quartics_of_orellana_and_de_michele() {
        assert!(error(from_roots([1.0, 1e3, 1e6, 1e9]), &[1.0, 1e3, 1e6, 1e9]) <= 2e-16);
        let two = from_roots([2.0, 2.001, 2.002, 2.003]);
        // What the rounded coefficients determine: the roots of those, to 60 digits, are up to 1.8e-6 from the planted ones.
        let of_rounded = [1.9999988183252392, 2.0010035629219733, 2.001996433286205, 2.0030011854665827];
        assert!(error(two, &of_rounded) <= 1e-14, "{two:?}");
        assert!(error(from_roots([1e47, 1e49, 1e50, 1e53]), &[1e47, 1e49, 1e50, 1e53]) <= 4e-16);
        assert!(error(from_roots([-1.0, 1.0, 2.0, 1e14]), &[-1.0, 1.0, 2.0, 1e14]) <= 2e-16);
        assert!(error(from_roots([-2e7, -1.0, 1.0, 1e7]), &[-2e7, -1.0, 1.0, 1e7]) <= 2e-16);
        let six = quartic(1.0, -9000002.0, -9999981999998.0, 19999982e6, -2e13);
        assert!(error(six, &[-1e6, 1e7]) <= 2e-16, "{six:?}");
        let seven = quartic(1.0, 2000011.0, 1010022000028.0, 11110056e6, 2828e10);
        assert!(error(seven, &[-7.0, -4.0]) <= 2e-16, "{seven:?}");
        let eight = quartic(1.0, -100002011.0, 201101022001.0, -102200111000011.0, 11000011e8);
        assert!(error(eight, &[11.0, 1e8]) <= 2e-16, "{eight:?}");
        assert!(error(from_roots([1000.0; 4]), &[1000.0]) <= 2e-16);
        let fifteen = from_roots([1e-15, 1000.0, 1000.0, 1000.0]);
        assert!(error(fifteen, &[1e-15, 1000.0]) <= 1e-15, "{fifteen:?}");
        let seventeen = from_roots([1e4, 10001.0, 10010.0, 10100.0]);
        assert!(error(seventeen, &[1e4, 10001.0, 10010.0, 10100.0]) <= 1e-6);
        let nineteen = from_roots([1.0, 1e30, 1e30, 1e44]);
        assert!(error(nineteen, &[1.0, 1e30, 1e44]) <= 2e-16, "{nineteen:?}");
        let twenty = from_roots([1.0, 1e7, 1e7, 1e14]);
        assert!(error(twenty, &[1.0, 1e7, 1e14]) <= 1e-12, "{twenty:?}");
        let twenty_one = from_roots([1.0, 1e7, 1e7, 1e15]);
        assert!(error(twenty_one, &[1.0, 1e7, 1e15]) <= 1e-12, "{twenty_one:?}");
        let twenty_two = from_roots([1.0, 10.0, 1e152, 1e154]);
        assert!(error(twenty_two, &[1.0, 10.0, 1e152, 1e154]) <= 4e-16, "{twenty_two:?}");
        let twenty_three = quartic(1.0, 1.0, 1.0, 3.0 / 8.0, 1e-3);
        assert!(error(twenty_three, &[-0.497314148060048, -0.00268585193995149]) <= 2e-15);
        const S: f64 = 1e30;
        let last = quartic(1.0, -(1.0 + 1.0 / S), 1.0 / S - S * S, S * S + S, -S);
        assert!(error(last, &[-S, 1e-30, 1.0, S]) <= 4e-16, "{last:?}");
    }

    #[test]
    fn polynomials_of_higher_degree_have_all_their_real_roots() {
        // (x − 1)(x − 2)…(x − 9), and x⁶ − 1, and the quintic x⁵ − x − 1 that no radicals solve.
        let mut product = vec![1.0];
        for root in 1..10 {
            let mut next = vec![0.0; product.len() + 1];
            for (i, c) in product.iter().enumerate() {
                next[i] -= f64::from(root) * c;
                next[i + 1] += c;
            }
            product = next;
        }
        let found = roots_of_up_to::<16>(&product);
        assert_eq!(found.len(), 9, "{found:?}");
        assert!(found.iter().zip(1..).all(|(x, n)| (x - f64::from(n)).abs() < 1e-10), "{found:?}");
        assert_eq!(roots_of_up_to::<8>(&[-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).to_vec(), [-1.0, 1.0]);
        let quintic = roots_of_up_to::<8>(&[-1.0, -1.0, 0.0, 0.0, 0.0, 1.0]);
        assert!(quintic.len() == 1 && (quintic[0] - 1.167_303_978_261_418_7).abs() < 1e-15, "{quintic:?}");
        assert!(roots_of_up_to::<4>(&[1.0; 5]).is_empty(), "more coefficients than there is room for");
    }

    #[test]
    fn polynomials_with_planted_roots_give_them_back() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for case in 0..2000 {
            let mut planted: Vec<f64> = (0..4).map(|i| i as f64 + 0.8 * random() - 2.0).collect();
            planted.sort_by(f64::total_cmp);
            let found = from_roots([planted[0], planted[1], planted[2], planted[3]]);
            assert_eq!(found.len(), 4, "case {case}: {planted:?} gave {found:?}");
            for (f, p) in found.iter().zip(&planted) {
                assert!((f - p).abs() < 1e-11, "case {case}: {planted:?} gave {found:?}");
            }
        }
    }
}
