//! What the functions that tapes call can be over intervals, with their derivatives.

use super::enclose::{Enclosed, over_positive, plus, times};
use super::{Call1, Call2, CallN, MAX_CALL, Rule};
use crate::math::elementary::{acos, asin, atan, atan2, cbrt, cosh, log2, log10, sinh, tanh};
use crate::math::interval::{Gaps, Interval};
use crate::math::noise;
use std::f64::consts::{FRAC_PI_2, LN_2, LN_10, PI};

const ONE: Interval = Interval::new(1.0, 1.0);
const UNIT: Interval = Interval::new(-1.0, 1.0);

/// f(a).
pub(super) fn call1<const N: usize>(f: Call1, rule: Rule, a: &Enclosed<N>) -> Enclosed<N> {
    let x = a.value;
    if x.is_empty() {
        return Enclosed::NOTHING;
    }
    match rule {
        Rule::Sin => a.chain(x.sin(), x.cos()),
        Rule::Cos => a.chain(x.cos(), -x.sin()),
        Rule::Tan => {
            let value = x.tan();
            a.chain(value, ONE + value.square())
        }
        Rule::Asin | Rule::Acos => arc(rule, a),
        Rule::Atan => a.chain(x.monotone(atan), over_positive(ONE + x.square())),
        Rule::Sinh => a.chain(x.monotone(sinh), hyperbolic_cosine(x)),
        Rule::Cosh => a.chain(hyperbolic_cosine(x), x.monotone(sinh)),
        Rule::Tanh => {
            let value = x.monotone(tanh);
            a.chain(value, (ONE - value.square()).max(Interval::new(0.0, 0.0)))
        }
        Rule::Exp => {
            let value = x.exp();
            a.chain(value, value)
        }
        Rule::Ln => logarithm(a, 1.0, Interval::ln(x)),
        Rule::Log10 => logarithm(a, LN_10, above_zero(x).map_or(Interval::EMPTY, |p| p.monotone(log10))),
        Rule::Log2 => logarithm(a, LN_2, above_zero(x).map_or(Interval::EMPTY, |p| p.monotone(log2))),
        Rule::Cbrt => {
            let value = x.monotone(cbrt);
            a.chain(value, over_positive(Interval::point(3.0) * value.square()))
        }
        Rule::Sign | Rule::Round => {
            let (lo, hi) = (f(x.lo), f(x.hi));
            Enclosed::flat(Interval { lo, hi, gaps: x.gaps | Gaps::jumping(lo != hi) })
        }
        Rule::Radians | Rule::Degrees => {
            let factor = Interval::point(f(1.0));
            let factor = Interval { lo: factor.lo.next_down(), hi: factor.hi.next_up(), gaps: Gaps::NONE };
            a.chain(x.monotone(f), factor)
        }
        _ => opaque(&[*a], |at| f(at[0])),
    }
}

/// f(a, b).
pub(super) fn call2<const N: usize>(f: Call2, rule: Rule, a: &Enclosed<N>, b: &Enclosed<N>) -> Enclosed<N> {
    if a.value.is_empty() || b.value.is_empty() {
        return Enclosed::NOTHING;
    }
    match rule {
        Rule::Power => power(a, b),
        Rule::Atan2 => angle(a, b),
        Rule::FlooredMod => floored(a, b),
        _ => opaque(&[*a, *b], |at| f(at[0], at[1])),
    }
}

/// f of many.
pub(super) fn call_n<const N: usize>(f: CallN, rule: Rule, from: &[Enclosed<N>], to: &mut [Enclosed<N>]) {
    if from.iter().any(|a| a.value.is_empty()) {
        to.fill(Enclosed::NOTHING);
        return;
    }
    let half = from.len() / 2;
    match rule {
        Rule::Cross => cross(from, to),
        Rule::Length => to[0] = length(from),
        Rule::Distance => {
            let mut d = [Enclosed::constant(0.0); MAX_CALL];
            (0..half).for_each(|i| d[i] = from[i].sub(&from[half + i]));
            to[0] = length(&d[..half]);
        }
        Rule::Normalize => normalize(from, to),
        Rule::Mix => to[0] = from[0].mul(&Enclosed::constant(1.0).sub(&from[2])).add(&from[1].mul(&from[2])),
        Rule::Clamp => {
            let clamped = from[0].max(&from[1]).0.min(&from[2]).0;
            let crossed = from[1].value.hi > from[2].value.lo;
            to[0] = Enclosed { value: clamped.value.with_gaps(Gaps::undefined(crossed)), ..clamped };
        }
        Rule::Smoothstep => to[0] = smoothstep(&from[0], &from[1], &from[2]),
        Rule::Noise => to[0] = noise_of(from, noise_slopes(&values_of(from)[..from.len()]), noise::noise),
        Rule::Fbm => to[0] = fbm(f, from),
        _ => unknown(from, to, |from, to| {
            f(from, to);
            true
        }),
    }
}

/// A function of many of which nothing is known, false where it is undefined: its value at a point; anything elsewhere.
pub(super) fn unknown<const N: usize>(
    from: &[Enclosed<N>],
    to: &mut [Enclosed<N>],
    f: impl Fn(&[f64], &mut [f64]) -> bool,
) {
    let m = to.len();
    for (i, to) in to.iter_mut().enumerate() {
        *to = opaque(from, |at| {
            let mut all = [0.0; MAX_CALL];
            if f(at, &mut all[..m]) { all[i] } else { f64::NAN }
        });
    }
}

/// A function of which nothing is known: its value at a point; anything elsewhere.
fn opaque<const N: usize>(a: &[Enclosed<N>], f: impl Fn(&[f64]) -> f64) -> Enclosed<N> {
    if a.iter().any(|a| a.value.lo != a.value.hi) {
        return Enclosed::ANYTHING;
    }
    let mut at = [0.0; MAX_CALL];
    at.iter_mut().zip(a).for_each(|(at, a)| *at = a.value.lo);
    let value = f(&at[..a.len()]);
    if value.is_nan() {
        return Enclosed::NOTHING;
    }
    let steady = a.iter().all(|a| a.slope.iter().all(|s| s.lo == 0.0 && s.hi == 0.0));
    if steady {
        Enclosed::constant(value)
    } else {
        Enclosed { value: Interval::point(value), ..Enclosed::ANYTHING }
    }
}

/// The part above 0, said to be gaps where there is another.
fn above_zero(x: Interval) -> Option<Interval> {
    (x.hi > 0.0).then(|| Interval {
        lo: x.lo.max(0.0),
        hi: x.hi,
        gaps: x.gaps | Gaps::undefined(x.lo <= 0.0),
    })
}

fn logarithm<const N: usize>(a: &Enclosed<N>, of_base: f64, value: Interval) -> Enclosed<N> {
    let Some(x) = above_zero(a.value) else { return Enclosed::NOTHING };
    a.chain(value, over_positive(x * Interval::point(of_base)))
}

fn arc<const N: usize>(rule: Rule, a: &Enclosed<N>) -> Enclosed<N> {
    let x = a.value.intersect(UNIT).with_gaps(Gaps::undefined(a.value.lo < -1.0 || a.value.hi > 1.0));
    if x.is_empty() {
        return Enclosed::NOTHING;
    }
    let steepness = over_positive((ONE - x.square()).max(Interval::new(0.0, 0.0)).sqrt());
    match rule {
        Rule::Asin => a.chain(x.monotone(asin), steepness),
        _ => a.chain(falling_arc(x), -steepness),
    }
}

/// The arc cosine falls.
fn falling_arc(x: Interval) -> Interval {
    let (lo, hi) = (acos(x.hi), acos(x.lo));
    Interval { lo: lo.next_down().next_down().max(0.0), hi: hi.next_up().next_up(), gaps: x.gaps }
}

fn hyperbolic_cosine(x: Interval) -> Interval {
    x.abs().monotone(cosh).max(ONE)
}

/// aᵇ as [`crate::lang`]'s operator computes it: repeated products for whole b that are not large.
pub(super) fn power<const N: usize>(a: &Enclosed<N>, b: &Enclosed<N>) -> Enclosed<N> {
    let y = b.value;
    let constant = y.lo == y.hi && b.slope.iter().all(|s| s.lo == 0.0 && s.hi == 0.0);
    if constant && y.lo == y.lo.trunc() && y.lo.abs() <= 1024.0 {
        return whole_power(a, y.lo as i32);
    }
    let x = a.value;
    if x.hi < 0.0 {
        return Enclosed::NOTHING;
    }
    let value = x.pow(y);
    if constant {
        let slope = y * x.pow(y - ONE).hull(if x.lo <= 0.0 && y.lo < 1.0 {
            Interval::WHOLE
        } else {
            Interval::EMPTY
        });
        return a.chain(value, slope.with_gaps(Gaps::undefined(x.lo < 0.0)));
    }
    // aᵇ (b a′ / a + b′ ln a).
    let (ratio, log) = (y / x, x.ln());
    let slope = |i: usize| times(plus(times(a.slope[i], ratio), times(b.slope[i], log)), value);
    Enclosed { value, slope: std::array::from_fn(slope) }
}

/// Squares are known not to be negative.
fn whole_power<const N: usize>(a: &Enclosed<N>, n: i32) -> Enclosed<N> {
    if n == 0 {
        return Enclosed::constant(1.0);
    }
    let one = Enclosed::constant(1.0);
    let mut base = if n < 0 { one.div(a) } else { *a };
    let (mut n, mut result) = (n.unsigned_abs(), None);
    while n > 0 {
        if n & 1 == 1 {
            result = Some(result.map_or(base, |r: Enclosed<N>| r.mul(&base)));
        }
        n >>= 1;
        if n > 0 {
            base = base.square();
        }
    }
    result.unwrap_or(one)
}

/// The angle of (x, y): jumps by a turn behind the origin.
fn angle<const N: usize>(y: &Enclosed<N>, x: &Enclosed<N>) -> Enclosed<N> {
    let (v, u) = (y.value, x.value);
    let turn = Interval::new(-PI.next_up(), PI.next_up());
    let gaps = u.gaps | v.gaps;
    let squares = u.square() + v.square();
    let slope = |i: usize| {
        let across = plus(times(y.slope[i], u), -times(x.slope[i], v));
        times(across, over_positive(squares))
    };
    let value = if u.lo <= 0.0 && v.contains(0.0) {
        turn.with_gaps(gaps | Gaps::JUMPS)
    } else {
        let corners = [(v.lo, u.lo), (v.lo, u.hi), (v.hi, u.lo), (v.hi, u.hi)].map(|(y, x)| atan2(y, x));
        let lo = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let hi = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // Straight above or below the origin the angle is greatest between corners where the box spans the axis.
        let (lo, hi) = if u.contains(0.0) { (lo.min(-FRAC_PI_2), hi.max(FRAC_PI_2)) } else { (lo, hi) };
        let (lo, hi) = match v.lo > 0.0 {
            true => (lo.max(0.0), hi),
            false if v.hi < 0.0 => (lo, hi.min(0.0)),
            false => (lo, hi),
        };
        Interval { lo: lo.next_down().next_down(), hi: hi.next_up().next_up(), gaps }.intersect(turn)
    };
    Enclosed { value, slope: std::array::from_fn(slope) }
}

/// a − b·⌊a / b⌋.
fn floored<const N: usize>(a: &Enclosed<N>, b: &Enclosed<N>) -> Enclosed<N> {
    repeated(a, b, (a.value / b.value).floor())
}

/// a − b·trunc(a / b).
pub(super) fn remainder<const N: usize>(a: &Enclosed<N>, b: &Enclosed<N>) -> Enclosed<N> {
    let q = a.value / b.value;
    let (lo, hi) = (q.lo.trunc(), q.hi.trunc());
    repeated(a, b, Interval { lo, hi, gaps: q.gaps | Gaps::jumping(lo != hi) })
}

fn repeated<const N: usize>(a: &Enclosed<N>, b: &Enclosed<N>, times: Interval) -> Enclosed<N> {
    if times.is_empty() || b.value.contains(0.0) {
        return Enclosed::ANYTHING;
    }
    let whole = a.sub(&b.mul(&Enclosed::flat(times)));
    let size = b.value.abs().hi;
    whole.within(Interval::new(-size, size)).with_gaps(times.gaps)
}

fn cross<const N: usize>(from: &[Enclosed<N>], to: &mut [Enclosed<N>]) {
    let (a, b) = from.split_at(3);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        to[i] = a[j].mul(&b[k]).sub(&a[k].mul(&b[j]));
    }
}

fn length<const N: usize>(v: &[Enclosed<N>]) -> Enclosed<N> {
    let squares = v.iter().map(|x| x.value.square()).reduce(|a, b| a + b).unwrap_or(Interval::new(0.0, 0.0));
    // Squares are never below 0, but their sum was rounded down.
    let value = squares.max(Interval::new(0.0, 0.0)).sqrt();
    let slope = |i: usize| {
        v.iter().fold(Interval::new(0.0, 0.0), |sum, x| plus(sum, times(x.slope[i], share(x.value, value))))
    };
    Enclosed { value, slope: std::array::from_fn(slope) }
}

/// A component over the length.
fn share(x: Interval, length: Interval) -> Interval {
    if length.lo <= 0.0 { UNIT } else { (x / length).intersect(UNIT) }
}

fn normalize<const N: usize>(from: &[Enclosed<N>], to: &mut [Enclosed<N>]) {
    let length = length(from);
    let gaps = if length.value.lo <= 0.0 { Gaps::ANY } else { Gaps::NONE };
    for (to, x) in to.iter_mut().zip(from) {
        let whole = x.div(&length);
        *to = Enclosed { value: share(x.value, length.value).with_gaps(gaps), slope: whole.slope };
    }
}

fn smoothstep<const N: usize>(edge0: &Enclosed<N>, edge1: &Enclosed<N>, x: &Enclosed<N>) -> Enclosed<N> {
    let (zero, one) = (Enclosed::constant(0.0), Enclosed::constant(1.0));
    let t = x.sub(edge0).div(&edge1.sub(edge0)).max(&zero).0.min(&one).0;
    let rises = |t: f64| t * t * (3.0 - 2.0 * t);
    let v = t.value.intersect(Interval::new(0.0, 1.0));
    if v.is_empty() {
        return Enclosed::ANYTHING;
    }
    let slope = Interval::point(6.0) * v * (ONE - v);
    // Six roundings of numbers up to 1.
    let slack = 8.0 * f64::EPSILON;
    let value = Interval { lo: rises(v.lo) - slack, hi: rises(v.hi) + slack, gaps: t.value.gaps };
    t.chain(value.intersect(Interval::new(0.0, 1.0)), slope.max(Interval::new(0.0, 0.0)))
}

/// What rounding may add to noise: of the offsets in a cell, of eight corners' sums.
pub(super) const NOISE_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A noise in 0 … 1 with these gaps derivatives.
fn noise_of<const N: usize>(
    p: &[Enclosed<N>],
    steep: [Interval; 3],
    noise: impl Fn(&[f64]) -> f64,
) -> Enclosed<N> {
    let mut middle = [0.0; MAX_CALL];
    let mut away = Interval::new(0.0, 0.0);
    for (i, x) in p.iter().enumerate() {
        middle[i] = x.value.middle();
        away = away + steep[i] * (x.value - Interval::point(middle[i]));
    }
    let doubt = NOISE_ROUNDING;
    let at = noise(&middle[..p.len()]);
    let gaps = p.iter().fold(Gaps::NONE, |gaps, x| gaps | x.value.gaps);
    let around =
        Interval { lo: (at + away.lo - doubt).next_down(), hi: (at + away.hi + doubt).next_up(), gaps };
    let slope = |i: usize| {
        p.iter().zip(&steep).fold(Interval::new(0.0, 0.0), |sum, (x, d)| plus(sum, times(x.slope[i], *d)))
    };
    let value = if around.lo.is_nan() { Interval { gaps, ..Interval::WHOLE } } else { around };
    Enclosed { value: value.intersect(Interval::new(0.0, 1.0)), slope: std::array::from_fn(slope) }
}

/// The gaps derivatives of noise in 0 … 1 over a box.
pub(super) fn noise_slopes(p: &[Interval]) -> [Interval; 3] {
    octaves_slopes(p, std::iter::once((0.5, 1.0)))
}

/// The same of a mean of octaves, of which there are so many, each so much finer and weaker than the one before; none where these make no mean.
pub(super) fn fbm_slopes(p: &[Interval], [octaves, lacunarity, gain]: [f64; 3]) -> Option<[Interval; 3]> {
    let weighed = || {
        std::iter::successors(Some((1.0, 1.0)), |(w, f)| Some((w * gain, f * lacunarity)))
            .take(octaves as usize)
    };
    let weights: f64 = weighed().map(|(weight, _)| weight).sum();
    // Half of the mean; the weights' own roundings are far less than the share.
    let share = Interval::new(0.5 / weights * (1.0 - SUMS), 0.5 / weights * (1.0 + SUMS));
    let slopes = octaves_slopes(p, weighed()).map(|d| d * share);
    let is_known = gain >= 0.0 && slopes.iter().all(|d| d.lo.is_finite() && d.hi.is_finite());
    is_known.then_some(slopes)
}

/// Rounding of weights and of their sum: of at most some hundred numbers.
const SUMS: f64 = 512.0 * f64::EPSILON;

/// The gaps derivatives of a sum of octaves of gradient noise, each with its weight and frequency, over a box.
fn octaves_slopes(p: &[Interval], octaves: impl Iterator<Item = (f64, f64)>) -> [Interval; 3] {
    let mut sum = [Interval::new(0.0, 0.0); 3];
    for ((weight, frequency), seed) in octaves.zip(0..) {
        let mut q = [Interval::new(0.0, 0.0); 3];
        for (q, x) in q.iter_mut().zip(p) {
            *q = *x * Interval::point(frequency);
        }
        let factor = Interval::point(weight) * Interval::point(frequency);
        let here = noise::slopes(&q[..p.len()], seed);
        sum = std::array::from_fn(|i| sum[i] + here[i] * factor);
    }
    sum
}

fn values_of<const N: usize>(p: &[Enclosed<N>]) -> [Interval; 3] {
    let mut values = [Interval::new(0.0, 0.0); 3];
    values.iter_mut().zip(p).for_each(|(value, x)| *value = x.value);
    values
}

fn fbm<const N: usize>(f: CallN, from: &[Enclosed<N>]) -> Enclosed<N> {
    let (p, rest) = from.split_at(from.len() - 3);
    if rest.iter().any(|r| r.value.lo != r.value.hi) {
        return Enclosed::ANYTHING;
    }
    let parameters = [0, 1, 2].map(|i| rest[i].value.lo);
    let Some(slopes) = fbm_slopes(&values_of(p)[..p.len()], parameters) else {
        return opaque(from, |at| {
            let mut to = [0.0];
            f(at, &mut to);
            to[0]
        });
    };
    noise_of(p, slopes, |p| {
        let mut arguments = [0.0; MAX_CALL];
        arguments[..p.len()].copy_from_slice(p);
        arguments[p.len()..p.len() + 3].copy_from_slice(&parameters);
        let mut to = [0.0];
        f(&arguments[..p.len() + 3], &mut to);
        to[0]
    })
}
