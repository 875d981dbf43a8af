//! The value of one cubic from its Bézier points, by methods that trade speed for error. Knows nothing of chains of pieces.
//!
//! | method | error in [0, 1], of max\|P\| | time | loses digits |
//! |---|---|---|---|
//! | [`Method::Horner`] | 10 ulp | 1 | near multiple roots, in small tails, at the far end |
//! | [`Method::Bernstein`] | 1½ ulp | 1 | near multiple roots |
//! | [`Method::DeCasteljau`] | 2 ulp | 1 | far from the origin |
//! | [`Method::VolkSchumaker`] | 2 ulp | 2½ | near multiple roots, far from the origin |
//! | [`Method::Offset`] | 2½ ulp, ½ ulp of a large offset | 1 | near multiple roots, in small tails |
//! | [`Method::Compensated`] | ½ ulp of the value itself | 16 | nowhere short of a condition number of 10¹⁵ |
//! | [`Method::FromEnds`] | ½ ulp of the value itself | half of that once prepared | nowhere short of a condition number of 10¹⁵ |
//!
//! No plain method meets every bar that a scene may set. The default is [`Method::FromEnds`], whose coefficients a piece of curve makes
//! once; from points alone the two compensated methods cost alike. [`batch`] does more than 10⁹ a second at two ulp of max|P|. Largest
//! errors and times over Horner's as `ogee bench kernels --only curves` gives them.

use super::from_ends::{FromEnds, Nearer};
use crate::math::Point;
use crate::math::dd::{Dd, Factor, two_sum};

/// How to evaluate a cubic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Monomial coefficients, nested.
    Horner,
    /// Σ Pᵢ Bᵢ(t).
    Bernstein,
    /// Repeated (1−t)a + tb.
    DeCasteljau,
    /// Nested in t/(1−t) or its inverse, whichever is at most 1. Volk & Schumaker (1990).
    VolkSchumaker,
    /// P₀ + Σ (Pᵢ−P₀) Bᵢ(t).
    Offset,
    /// De Casteljau with the error of every rounding carried along. Jiang, Li, Cheng & Su (2010).
    Compensated,
    /// Nested in the distance from the nearer end, with the error of every rounding carried along; outside [0, 1] the method before.
    FromEnds,
}

impl Method {
    /// All of them, the default last.
    pub const ALL: [Method; 7] = [
        Method::Horner,
        Method::Bernstein,
        Method::DeCasteljau,
        Method::VolkSchumaker,
        Method::Offset,
        Method::Compensated,
        Method::FromEnds,
    ];
    /// The one that a curve uses unless told otherwise.
    pub const DEFAULT: Method = Method::FromEnds;

    /// The name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Horner => "horner",
            Method::Bernstein => "bernstein",
            Method::DeCasteljau => "de_casteljau",
            Method::VolkSchumaker => "volk_schumaker",
            Method::Offset => "offset",
            Method::Compensated => "compensated",
            Method::FromEnds => "from_ends",
        }
    }

    /// The value of the cubic with these Bézier points at t, which may be any real.
    pub fn evaluate<P: Point>(self, points: &[P; 4], t: f64) -> P {
        match self {
            Method::Horner => Nested::new(points).at(t),
            Method::Bernstein => bernstein(points, t),
            Method::DeCasteljau => de_casteljau(points, t),
            Method::VolkSchumaker => volk_schumaker(points, t),
            Method::Offset => offset(points, t),
            Method::Compensated => compensated(&points.map(Dd::from), |_| Local::unit(t)).hi,
            Method::FromEnds => from_ends(&points.map(Dd::from), t),
        }
    }
}

/// The value from the nearer end; outside [0, 1] by the triangle.
fn from_ends<P: Point>(points: &[Dd<P>; 4], t: f64) -> P {
    let inside = (0.0..=1.0).contains(&t).then(|| Nearer::unit(t));
    let value = inside.and_then(|place| FromEnds::new(points).at(place));
    value.unwrap_or_else(|| compensated(points, |_| Local::unit(t)).hi)
}

/// Monomial coefficients, made once for many evaluations by Horner's rule.
#[derive(Clone, Copy, Debug)]
pub struct Nested<P>([P; 4]);

impl<P: Point> Nested<P> {
    /// From Bézier points.
    #[inline]
    pub fn new(p: &[P; 4]) -> Self {
        let d = [p[1] - p[0], p[2] - p[1], p[3] - p[2]];
        let e = [d[1] - d[0], d[2] - d[1]];
        Nested([p[0], d[0] * 3.0, e[0] * 3.0, e[1] - e[0]])
    }

    /// The value at t.
    #[inline]
    pub fn at(&self, t: f64) -> P {
        let [a, b, c, d] = self.0;
        ((d * t + c) * t + b) * t + a
    }
}

/// Σ Pᵢ Bᵢ(t). At 0 and 1 the end points themselves.
#[inline]
pub fn bernstein<P: Point>(p: &[P; 4], t: f64) -> P {
    let r = 1.0 - t;
    let (rr, tt) = (r * r, t * t);
    (p[0] * (rr * r) + p[1] * (3.0 * (rr * t))) + (p[2] * (3.0 * (tt * r)) + p[3] * (tt * t))
}

/// Repeated (1−t)a + tb.
#[inline]
pub fn de_casteljau<P: Point>(p: &[P; 4], t: f64) -> P {
    let r = 1.0 - t;
    let lerp = |a: P, b: P| a * r + b * t;
    let (a, b, c) = (lerp(p[0], p[1]), lerp(p[1], p[2]), lerp(p[2], p[3]));
    lerp(lerp(a, b), lerp(b, c))
}

/// Nested in the smaller of t/(1−t) and (1−t)/t.
#[inline]
pub fn volk_schumaker<P: Point>(p: &[P; 4], t: f64) -> P {
    let r = 1.0 - t;
    if t.abs() <= r.abs() {
        let q = t / r;
        (((p[3] * q + p[2] * 3.0) * q + p[1] * 3.0) * q + p[0]) * (r * r * r)
    } else {
        let q = r / t;
        (((p[0] * q + p[1] * 3.0) * q + p[2] * 3.0) * q + p[3]) * (t * t * t)
    }
}

/// P₀ + Σ (Pᵢ−P₀) Bᵢ(t); at 1 the last point itself, which the sum would miss by a rounding.
#[inline]
pub fn offset<P: Point>(p: &[P; 4], t: f64) -> P {
    if t == 1.0 {
        return p[3];
    }
    let r = 1.0 - t;
    let (rr, tt) = (r * r, t * t);
    let rise =
        (p[1] - p[0]) * (3.0 * (rr * t)) + ((p[2] - p[0]) * (3.0 * (tt * r)) + (p[3] - p[0]) * (tt * t));
    p[0] + rise
}

/// A parameter's place in a piece: `x` from its start and `r` from its end, as parts of its width.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    pub x: Dd,
    pub r: Dd,
}

impl Local {
    /// In [0, 1].
    #[inline(always)]
    pub fn unit(t: f64) -> Local {
        Local { x: Dd { hi: t, lo: 0.0 }, r: Dd::difference(1.0, t) }
    }
}

/// De Casteljau's algorithm with one argument a level, the error of every product and sum carried along in a second triangle.
/// Error below u|value| + 40 u² Σ |Pᵢ||Bᵢ|. Where a number is too large to split, the plain algorithm's answer.
#[inline]
pub(crate) fn compensated<P: Point, const N: usize>(
    points: &[Dd<P>; N],
    argument: impl Fn(usize) -> Local,
) -> Dd<P> {
    let mut b = points.map(|p| p.hi);
    let mut c = points.map(|p| p.lo);
    for level in 1..N {
        let Local { x, r } = argument(level - 1);
        let (by_x, by_r) = (Factor::new(x.hi), Factor::new(r.hi));
        for i in 0..N - level {
            let (p, p_error) = by_r.times(b[i]);
            let (q, q_error) = by_x.times(b[i + 1]);
            let (s, s_error) = two_sum(p, q);
            let low = b[i] * r.lo + b[i + 1] * x.lo;
            c[i] = (c[i] * r.hi + c[i + 1] * x.hi) + ((p_error + q_error) + (s_error + low));
            b[i] = s;
        }
    }
    let (hi, lo) = two_sum(b[0], c[0]);
    if hi.is_finite() { Dd { hi, lo } } else { plain(points, argument).into() }
}

/// The same triangle in f64.
#[cold]
fn plain<P: Point, const N: usize>(points: &[Dd<P>; N], argument: impl Fn(usize) -> Local) -> P {
    let mut b = points.map(|p| p.hi);
    for level in 1..N {
        let Local { x, r } = argument(level - 1);
        for i in 0..N - level {
            b[i] = b[i] * r.hi + b[i + 1] * x.hi;
        }
    }
    b[0]
}

/// The value in double-double throughout, by de Casteljau's algorithm: off by at most 2⁻¹⁰⁰ Σ |Pᵢ||Bᵢ(t)|. What the other methods
/// are judged against.
pub fn double_double(points: &[f64; 4], t: f64) -> Dd {
    let (x, r) = (Dd::from(t), Dd::difference(1.0, t));
    let mut b = points.map(Dd::from);
    for level in (1..4).rev() {
        for i in 0..level {
            b[i] = b[i].times(r) + b[i + 1].times(x);
        }
    }
    b[0]
}

/// Σ |Pᵢ||Bᵢ(t)|: what an error at t is measured by where the value itself cancels.
pub fn magnitude(points: &[f64; 4], t: f64) -> f64 {
    let (x, r) = (t.abs(), (1.0 - t).abs());
    bernstein_sum(&points.map(f64::abs), x, r)
}

fn bernstein_sum(p: &[f64; 4], x: f64, r: f64) -> f64 {
    (p[0] * (r * r * r) + p[1] * (3.0 * (r * r * x))) + (p[2] * (3.0 * (x * x * r)) + p[3] * (x * x * x))
}

/// Values of one cubic at many parameters, in Bernstein form: the fast one, for tessellation, within two ulp of max|P| and a
/// tenth.
/// One coordinate a call, so that the loop is done in vector registers; `out` is as long as `ts`.
pub fn batch(points: &[f64; 4], ts: &[f64], out: &mut [f64]) {
    let [a, b, c, d] = [points[0], 3.0 * points[1], 3.0 * points[2], points[3]];
    for (t, value) in ts.iter().zip(out) {
        let (t, r) = (*t, 1.0 - *t);
        let (rr, tt) = (r * r, t * t);
        *value = rr * (a * r + b * t) + tt * (c * r + d * t);
    }
}

/// [`batch`] for each coordinate of a vector in turn: `out` holds [`Point::DIMENSION`] rows, each as long as `ts`.
pub fn batch_rows<P: Point>(points: &[P; 4], ts: &[f64], out: &mut [f64]) {
    for (axis, row) in out.chunks_exact_mut(ts.len().max(1)).take(P::DIMENSION).enumerate() {
        batch(&points.map(|p| p.coordinate(axis)), ts, row);
    }
}
