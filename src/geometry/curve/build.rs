//! Making curves: what all forms share, and the forms that need no thought: Bézier, Hermite, monomial, chains of any basis.

use super::{Curve, CurveError, Form, FormKind, Piece};
use crate::geometry::basis::Basis;
use crate::math::{Dd, Point};

/// The breakpoints of a curve, and the widths that its basis takes them for. By default the breakpoints are k/n rounded, and the
/// widths exactly equal, so that a uniform spline is one to the last bit.
pub(super) struct Breaks {
    /// One more than the pieces.
    pub knots: Vec<f64>,
    /// One for each piece, in any unit.
    pub widths: Vec<Dd>,
}

impl Breaks {
    /// From the knots given, or n equal intervals over [0, 1].
    pub fn new(knots: Option<&[f64]>, pieces: usize) -> Result<Breaks, CurveError> {
        let Some(knots) = knots else {
            let n = pieces as f64;
            let knots = (0..=pieces).map(|k| k as f64 / n).collect();
            return Ok(Breaks { knots, widths: vec![Dd::from(1.0); pieces] });
        };
        if knots.len() != pieces + 1 {
            return Err(CurveError::KnotCount { pieces, given: knots.len() });
        }
        check_finite("knot", knots)?;
        if let Some(i) = (1..knots.len()).find(|i| knots[*i] <= knots[i - 1]) {
            return Err(CurveError::KnotOrder { index: i, before: knots[i - 1], after: knots[i] });
        }
        let widths = knots.windows(2).map(|w| Dd::difference(w[1], w[0])).collect();
        Ok(Breaks { knots: knots.to_vec(), widths })
    }
}

/// Coordinates beyond this could overflow when split for exact products.
const LARGEST: f64 = 1e290;

/// Errors where a coordinate is NaN, infinite or beyond [`LARGEST`].
pub(super) fn check_finite<P: Point>(what: &'static str, points: &[P]) -> Result<(), CurveError> {
    match points.iter().position(|p| !p.max_abs().le(&LARGEST)) {
        Some(index) => Err(CurveError::NotFinite { what, index }),
        None => Ok(()),
    }
}

impl<P: Point> Curve<P> {
    /// From Bézier points of each piece.
    pub(super) fn assemble(knots: &[f64], bezier: Vec<[Dd<P>; 4]>, closed: bool, form: Form<P>) -> Self {
        let pieces = knots.windows(2).zip(bezier).map(|(w, b)| Piece::new(w[0], w[1], b)).collect();
        Curve::of(pieces, closed, form)
    }

    /// Bézier pieces that share end points: 3n + 1 points, closed 3n.
    pub fn bezier(points: &[P], knots: Option<&[f64]>, closed: bool) -> Result<Self, CurveError> {
        let n = points.len();
        let fits = if closed { n >= 3 && n.is_multiple_of(3) } else { n >= 4 && n % 3 == 1 };
        if !fits {
            let expected = if closed { "3n" } else { "3n + 1" };
            let form = if closed { "a closed bezier" } else { "a bezier" };
            return Err(CurveError::PointCount { form, expected, given: n });
        }
        Curve::chain(points, Basis::Bezier, None, knots, closed)
    }

    /// Each four points in a row are a piece in `basis`; the next four start `stride` further (by default, the basis's own).
    /// Closed, the points go round. γ = G·M·(1, x, x², x³)ᵀ with x from 0 to 1 over the piece, whatever its knots.
    pub fn chain(
        points: &[P],
        basis: Basis,
        stride: Option<usize>,
        knots: Option<&[f64]>,
        closed: bool,
    ) -> Result<Self, CurveError> {
        let stride = stride.unwrap_or(basis.stride());
        if stride == 0 {
            return Err(CurveError::Stride);
        }
        let n_pieces = chain_length(points.len(), stride, closed)?;
        check_finite("point", points)?;
        if let Basis::Matrix(rows) = basis {
            check_finite("basis row", &rows.map(|row| row.iter().sum::<f64>()))?;
        }
        let breaks = Breaks::new(knots, n_pieces)?;
        let four = |i: usize| std::array::from_fn(|k| Dd::from(points[(i * stride + k) % points.len()]));
        let bezier = (0..n_pieces).map(|i| basis.to_bezier(&four(i))).collect();
        let kind = FormKind::Chain { basis, stride };
        let form = Form { kind, points: points.to_vec(), slopes: Vec::new() };
        Ok(Curve::assemble(&breaks.knots, bezier, closed, form))
    }

    /// Cubic Hermite through the points with γ′ = slope at each, per unit of the curve's parameter: over an interval of width h
    /// the piece leaves with h·slope. At least 2 points; closed, the last runs on to the first.
    pub fn hermite(
        points: &[P],
        slopes: &[P],
        knots: Option<&[f64]>,
        closed: bool,
    ) -> Result<Self, CurveError> {
        let n_pieces = interpolated_pieces("a hermite spline", points, closed)?;
        if slopes.len() != points.len() {
            return Err(CurveError::SlopeCount { expected: points.len(), given: slopes.len() });
        }
        check_finite("slope", slopes)?;
        let mut breaks = Breaks::new(knots, n_pieces)?;
        if knots.is_none() {
            breaks.widths.fill(Dd::from(1.0).over_integer(n_pieces as i64));
        }
        let exact: Vec<_> = slopes.iter().copied().map(Dd::from).collect();
        let bezier = from_slopes(points, &exact, &breaks.widths);
        let form = Form { kind: FormKind::Hermite, points: points.to_vec(), slopes: slopes.to_vec() };
        Ok(Curve::assemble(&breaks.knots, bezier, closed, form))
    }

    /// One piece: c₀ + c₁t + c₂t² + c₃t³ over [0, 1] or the interval given.
    pub fn monomial(coefficients: &[P], knots: Option<&[f64]>) -> Result<Self, CurveError> {
        let &[c0, c1, c2, c3] = coefficients else {
            let given = coefficients.len();
            return Err(CurveError::PointCount { form: "a monomial", expected: "4", given });
        };
        check_finite("coefficient", coefficients)?;
        let breaks = Breaks::new(knots, 1)?;
        let (a, b) = (breaks.knots[0], breaks.knots[1]);
        let c = [c0, c1, c2, c3].map(Dd::from);
        let bezier = [[a, a, a], [a, a, b], [a, b, b], [b, b, b]].map(|t| monomial_blossom(&c, t));
        let form = Form { kind: FormKind::Monomial, points: coefficients.to_vec(), slopes: Vec::new() };
        Ok(Curve::assemble(&breaks.knots, vec![bezier], false, form))
    }
}

/// Pieces of a chain. Errors: the last four would not end with the points.
fn chain_length(n: usize, stride: usize, closed: bool) -> Result<usize, CurveError> {
    let fits =
        if closed { n > 0 && n.is_multiple_of(stride) } else { n >= 4 && (n - 4).is_multiple_of(stride) };
    if !fits {
        let expected = if closed { "a multiple of the stride in" } else { "4, and as many strides more," };
        return Err(CurveError::PointCount { form: "a chain of fours", expected, given: n });
    }
    Ok(if closed { n / stride } else { (n - 4) / stride + 1 })
}

/// Pieces of a curve through all the points, which must be finite. Errors: fewer than 2, closed 3.
pub(super) fn interpolated_pieces<P: Point>(
    form: &'static str,
    points: &[P],
    closed: bool,
) -> Result<usize, CurveError> {
    let (least, expected) = if closed { (3, "at least 3 (closed)") } else { (2, "at least 2") };
    if points.len() < least {
        return Err(CurveError::PointCount { form, expected, given: points.len() });
    }
    check_finite("point", points)?;
    Ok(if closed { points.len() } else { points.len() - 1 })
}

/// Bézier points of Hermite pieces: one for each width, points and slopes going round.
pub(super) fn from_slopes<P: Point>(points: &[P], slopes: &[Dd<P>], widths: &[Dd]) -> Vec<[Dd<P>; 4]> {
    let n = points.len();
    let piece = |(i, width): (usize, &Dd)| {
        let (j, third) = ((i + 1) % n, width.over_integer(3));
        let (p, q) = (Dd::from(points[i]), Dd::from(points[j]));
        [p, p + slopes[i].times(third), q - slopes[j].times(third), q]
    };
    widths.iter().enumerate().map(piece).collect()
}

/// c₀ + c₁ (r+s+t)/3 + c₂ (rs+rt+st)/3 + c₃ rst.
fn monomial_blossom<P: Point>(c: &[Dd<P>; 4], [r, s, t]: [f64; 3]) -> Dd<P> {
    let [r, s, t] = [r, s, t].map(Dd::from);
    let sum = (r + s + t).over_integer(3);
    let pairs = (r.times(s) + r.times(t) + s.times(t)).over_integer(3);
    c[0] + c[1].times(sum) + c[2].times(pairs) + c[3].times(r.times(s).times(t))
}
