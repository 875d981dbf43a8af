//! A path made of any function of one parameter. Knows nothing of where the function comes from.
//!
//! The function is fitted once by Chebyshev polynomials on intervals halved until they follow it to rounding; derivatives, lengths and
//! frames are those of the polynomials, so that they cost no evaluations of the function and have a known error. Trefethen,
//! *Approximation Theory and Approximation Practice*. Intervals where halving does not help end at kinks and jumps, which become cuts.

use super::curve::{CurveError, Side};
use super::path::Path;
use crate::math::elementary::sin_cos_degrees;
use crate::math::{Point, bracket};
use std::convert::Infallible;

/// Coefficients on one interval: degree 15.
const TERMS: usize = 16;
/// Values that the trailing coefficients must fall below, as a part of the largest value: a few roundings of the function.
const RESOLVED: f64 = 64.0 * f64::EPSILON;
/// An interval this small a part of the whole is not halved further: it holds a kink or a jump.
const NARROWEST: f64 = 1.0 / (1u64 << 40) as f64;
/// Most intervals; beyond, the worst are left as they are and their error reported.
const MOST_PANELS: usize = 4096;

/// Σ cₖ Tₖ over an interval.
#[derive(Clone, Debug, PartialEq)]
struct Panel<P> {
    start: f64,
    end: f64,
    coefficients: [P; TERMS],
    /// Of γ′, γ″ and γ‴, per unit of the parameter.
    derivatives: [[P; TERMS]; 3],
}

/// A function fitted over an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionPath<P> {
    panels: Vec<Panel<P>>,
    error: f64,
    cuts: Vec<f64>,
}

impl<P: Point> FunctionPath<P> {
    /// Fits `f` over `[start, end]`, `start < end`. Errors: those of `f`.
    pub fn fit<E>(start: f64, end: f64, mut f: impl FnMut(f64) -> Result<P, E>) -> Result<Self, E> {
        let mut fit =
            Fit { narrowest: (end - start) * NARROWEST, largest: 0.0, error: 0.0, panels: Vec::new() };
        let mut waiting = vec![(start, end)];
        while let Some((a, b)) = waiting.pop() {
            let room = fit.panels.len() + waiting.len() < MOST_PANELS;
            let middle = 0.5 * (a + b);
            if !fit.accept(a, b, room, &mut f)? {
                waiting.extend([(middle, b), (a, middle)]);
            }
        }
        let mut path = FunctionPath { panels: fit.panels, error: fit.error, cuts: Vec::new() };
        path.cuts = path.find_cuts();
        Ok(path)
    }

    /// Estimated largest distance between the fit and the function, where that is smooth.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Of each interval its ends and the coefficients of its Chebyshev polynomials.
    pub fn panels(&self) -> impl ExactSizeIterator<Item = (f64, f64, &[P])> {
        self.panels.iter().map(|panel| (panel.start, panel.end, &panel.coefficients[..]))
    }

    fn panel_at(&self, t: f64, side: Side) -> &Panel<P> {
        let after = self.panels.partition_point(|panel| panel.start <= t).saturating_sub(1);
        let back = side == Side::Before && after > 0 && self.panels[after].start == t;
        &self.panels[if back { after - 1 } else { after }]
    }

    /// Ends of panels, and parameters where the speed has a dip: found by sampling, since a dip need not be a zero of a quartic.
    fn find_cuts(&self) -> Vec<f64> {
        let mut cuts = vec![self.panels[0].start];
        for panel in &self.panels {
            let at = |i: usize| panel.start + (panel.end - panel.start) * (i as f64 / TERMS as f64);
            let speed = |t: f64| panel.sum(&panel.derivatives[0], t).length();
            let sampled: Vec<f64> = (0..=TERMS).map(|i| speed(at(i))).collect();
            let fastest = sampled.iter().copied().fold(0.0, f64::max);
            for i in 1..TERMS {
                let dip = sampled[i] < sampled[i - 1] && sampled[i] <= sampled[i + 1];
                if dip && sampled[i] < 0.25 * fastest {
                    cuts.push(bracket::minimum(at(i - 1), at(i + 1), speed));
                }
            }
            cuts.push(panel.end);
        }
        cuts.dedup_by(|a, b| *a <= *b);
        cuts
    }
}

impl<P: Point> FunctionPath<P> {
    /// Lower and upper corner of the box around it, inner extremes widened by [`FunctionPath::error`]; an extreme narrower than a
    /// sixteenth of an interval may be missed.
    pub fn bounds(&self) -> (P, P) {
        let per_axis = |axis: usize| {
            let each = self.panels.iter().map(|panel| panel.extremes(axis));
            let (low, high) = each.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0.0, 0.0));
            (low - self.error, high + self.error)
        };
        (P::from_coordinates(|axis| per_axis(axis).0), P::from_coordinates(|axis| per_axis(axis).1))
    }

    /// The parts before and after t in the domain. Errors: t is an end.
    pub fn split(&self, t: f64) -> Result<(Self, Self), CurveError> {
        let (start, end) = self.domain();
        if t <= start || t >= end {
            return Err(CurveError::SplitAtEnd { t });
        }
        Ok((self.refitted(start, t, |x| x), self.refitted(t, end, |x| x)))
    }

    /// The same way backwards, over the same domain: its value at t is that at start + end − t.
    #[must_use]
    pub fn reverse(&self) -> Self {
        let (start, end) = self.domain();
        self.refitted(start, end, |t| (start + (end - t)).clamp(start, end))
    }

    /// The path after a change of parameter.
    fn refitted(&self, start: f64, end: f64, inner: impl Fn(f64) -> f64) -> Self {
        let fit = FunctionPath::fit(start, end, |t| Ok::<P, Infallible>(self.position(inner(t))));
        let mut path = fit.unwrap_or_else(|never| match never {});
        path.error += self.error;
        path
    }
}

struct Fit<P> {
    narrowest: f64,
    largest: f64,
    error: f64,
    panels: Vec<Panel<P>>,
}

impl<P: Point> Fit<P> {
    /// Adds a panel over `[a, b]` if it follows the function, or may not be halved. False if it must be.
    fn accept<E>(
        &mut self,
        a: f64,
        b: f64,
        room: bool,
        f: &mut impl FnMut(f64) -> Result<P, E>,
    ) -> Result<bool, E> {
        let mut values = [P::zero(); TERMS];
        for (k, value) in values.iter_mut().enumerate() {
            *value = f(0.5 * (a + b) + 0.5 * (b - a) * node(k))?;
            self.largest = self.largest.max(value.max_abs());
        }
        let coefficients = transform(&values);
        let tail = coefficients[TERMS - 3..].iter().fold(0.0, |m: f64, c| m.max(c.max_abs()));
        let resolved = tail <= RESOLVED * self.largest;
        if !resolved && room && b - a > self.narrowest {
            return Ok(false);
        }
        if resolved || b - a > self.narrowest {
            self.error = self.error.max(3.0 * tail + 4.0 * f64::EPSILON * self.largest);
        }
        self.panels.push(Panel::new(a, b, coefficients));
        Ok(true)
    }
}

/// cos(πn / 2N), the angle reduced and in degrees, where it is exact.
fn cosine(n: usize) -> f64 {
    let degrees = 90.0 / TERMS as f64;
    sin_cos_degrees(degrees * (n % (4 * TERMS)) as f64).1
}

/// Chebyshev points of the first kind, ascending.
fn node(k: usize) -> f64 {
    -cosine(2 * k + 1)
}

/// Coefficients of the polynomial with these values at the nodes.
fn transform<P: Point>(values: &[P; TERMS]) -> [P; TERMS] {
    std::array::from_fn(|j| {
        let sum = values.iter().enumerate().fold(P::zero(), |sum, (k, value)| {
            // Tⱼ at node k, whose angle is π − π(k + ½)/n.
            sum + *value * cosine(j * (2 * TERMS - 1 - 2 * k))
        });
        sum * (if j == 0 { 1.0 } else { 2.0 } / TERMS as f64)
    })
}

impl<P: Point> Panel<P> {
    fn new(start: f64, end: f64, coefficients: [P; TERMS]) -> Self {
        let scale = 2.0 / (end - start);
        let first = derivative(&coefficients, scale);
        let second = derivative(&first, scale);
        let third = derivative(&second, scale);
        Panel { start, end, coefficients, derivatives: [first, second, third] }
    }

    /// Least and greatest value of one coordinate, by sampling and closing in.
    fn extremes(&self, axis: usize) -> (f64, f64) {
        let at = |i: usize| self.start + (self.end - self.start) * (i as f64 / TERMS as f64);
        let value = |t: f64| self.sum(&self.coefficients, t).coordinate(axis);
        let sampled: Vec<f64> = (0..=TERMS).map(|i| value(at(i))).collect();
        let extreme = |sign: f64| {
            let (best, _) = sampled
                .iter()
                .enumerate()
                .min_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1)))
                .unwrap_or((0, &0.0));
            let t =
                bracket::minimum(at(best.saturating_sub(1)), at((best + 1).min(TERMS)), |t| sign * value(t));
            sign * (sign * sampled[best]).min(sign * value(t))
        };
        (extreme(1.0), extreme(-1.0))
    }

    /// Clenshaw's sum.
    fn sum(&self, c: &[P; TERMS], t: f64) -> P {
        let x = ((t - self.start) - (self.end - t)) / (self.end - self.start);
        let (mut b1, mut b2) = (P::zero(), P::zero());
        for k in (1..TERMS).rev() {
            (b1, b2) = (b1 * (2.0 * x) - b2 + c[k], b1);
        }
        b1 * x - b2 + c[0]
    }
}

/// Coefficients of the derivative: c′ₖ₋₁ = c′ₖ₊₁ + 2k cₖ.
fn derivative<P: Point>(c: &[P; TERMS], scale: f64) -> [P; TERMS] {
    let mut d = [P::zero(); TERMS];
    for k in (1..TERMS).rev() {
        let above = if k + 1 < TERMS { d[k + 1] } else { P::zero() };
        d[k - 1] = above + c[k] * (2.0 * k as f64 * scale);
    }
    d[0] = d[0] * 0.5;
    d
}

impl<P: Point> Path<P> for FunctionPath<P> {
    fn domain(&self) -> (f64, f64) {
        (self.panels[0].start, self.panels[self.panels.len() - 1].end)
    }

    fn closed(&self) -> bool {
        false
    }

    fn position(&self, t: f64) -> P {
        let panel = self.panel_at(t, Side::After);
        panel.sum(&panel.coefficients, t)
    }

    fn derivatives_from(&self, t: f64, side: Side) -> [P; 3] {
        let panel = self.panel_at(t, side);
        [0, 1, 2].map(|k| panel.sum(&panel.derivatives[k], t))
    }

    fn speed(&self, t: f64) -> f64 {
        let panel = self.panel_at(t, Side::After);
        panel.sum(&panel.derivatives[0], t).length()
    }

    fn still(&self, t: f64) -> f64 {
        // Differentiating a polynomial of degree n on [−1, 1] multiplies an error by up to n².
        let panel = self.panel_at(t, Side::After);
        let degree = (TERMS - 1) as f64;
        self.error * degree * degree * 2.0 / (panel.end - panel.start)
    }

    fn cuts(&self) -> Vec<f64> {
        self.cuts.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::arc_length::ArcLength;
    use crate::math::elementary::{exp, sin, sin_cos};
    use glam::{DVec2, DVec3};

    fn fit<P: Point>(a: f64, b: f64, f: impl Fn(f64) -> P) -> FunctionPath<P> {
        FunctionPath::fit(a, b, |t| Ok::<P, Infallible>(f(t))).unwrap_or_else(|e| match e {})
    }

    #[test]
    fn smooth_functions_are_followed_with_their_derivatives() {
        let path = fit(-1.0, 3.0, |t| DVec2::new(sin(3.0 * t), exp(t)));
        for i in 0..=400 {
            let t = -1.0 + f64::from(i) / 100.0;
            let [v, a, _] = path.derivatives_from(t, Side::After);
            let (s, c) = sin_cos(3.0 * t);
            assert!(path.position(t).distance(DVec2::new(s, exp(t))) < 1e-13);
            assert!(v.distance(DVec2::new(3.0 * c, exp(t))) < 1e-10, "{t} {v}");
            assert!(a.distance(DVec2::new(-9.0 * s, exp(t))) < 1e-7, "{t} {a}");
        }
        assert!(path.error() < 1e-12 && path.panels.len() < 40, "{}", path.panels.len());
    }

    #[test]
    fn a_helix_has_its_length() {
        let path = fit(0.0, 20.0, |t| {
            let (s, c) = sin_cos(t);
            DVec3::new(3.0 * c, 3.0 * s, 4.0 * t)
        });
        let length = ArcLength::of(&path).total();
        assert!((length.value - 100.0).abs() < 1e-11, "{length:?}");
    }

    #[test]
    fn kinks_and_jumps_end_intervals() {
        let path = fit(0.0, 1.0, |t: f64| (t - 0.3).abs());
        assert!((path.position(0.31) - 0.01).abs() < 1e-15 && (path.position(0.29) - 0.01).abs() < 1e-15);
        assert!((path.derivatives_from(0.25, Side::After)[0] + 1.0).abs() < 1e-10);
        let length = ArcLength::of(&path).total();
        assert!((length.value - 1.0).abs() < 1e-9, "{length:?}");
        let step = fit(0.0, 1.0, |t: f64| if t < 1.0 / 3.0 { 0.0 } else { 5.0 });
        assert_eq!((step.position(0.3).round(), step.position(0.34).round()), (0.0, 5.0));
    }

    #[test]
    fn roughness_without_end_is_bounded_and_owned_up_to() {
        let mut n = 0;
        let path = FunctionPath::fit(0.0, 1.0, |t: f64| {
            n += 1;
            Ok::<f64, Infallible>(sin(1e9 * t * t))
        })
        .unwrap_or_else(|e| match e {});
        assert!(n < 200_000 && path.error() > 1e-3, "{n} {}", path.error());
    }

    #[test]
    fn parts_and_boxes_are_those_of_the_function() {
        let path = fit(0.0, 6.0, |t| DVec2::new(t, sin(t)));
        let (low, high) = path.bounds();
        assert!(
            (low - DVec2::new(0.0, -1.0)).length() < 1e-13 && (high - DVec2::new(6.0, 1.0)).length() < 1e-13
        );
        let (before, after) = path.split(2.5).unwrap();
        assert_eq!((before.domain(), after.domain()), ((0.0, 2.5), (2.5, 6.0)));
        assert!(before.position(1.25).distance(path.position(1.25)) < 1e-14);
        assert!(after.position(5.5).distance(path.position(5.5)) < 1e-14);
        assert!(path.reverse().position(1.0).distance(path.position(5.0)) < 1e-14);
        assert!(path.split(6.0).is_err());
    }

    #[test]
    fn faults_of_the_function_come_through() {
        let r = FunctionPath::<f64>::fit(0.0, 1.0, |t| if t > 0.5 { Err(t) } else { Ok(t) });
        assert!(r.is_err());
    }
}
