//! Catmull–Rom splines: through the points, with slopes from the neighbours. Catmull & Rom (1974); Barry & Goldman (1988);
//! Yuksel, Schaefer & Keyser (2011) for the exponent.

use super::build::{Breaks, check_finite, from_slopes, interpolated_pieces};
use super::{Curve, CurveError, Form, FormKind};
use crate::math::elementary::powf;
use crate::math::{Dd, Point};

/// The two freedoms of a Catmull–Rom spline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CatmullRom {
    /// Slopes are multiplied by 1 − tension: 0 is the plain spline, 1 a polygon.
    pub tension: f64,
    /// Intervals are as |ΔP|^alpha: 0 uniform, 0.5 centripetal (no loops or cusps), 1 chordal.
    pub alpha: f64,
}

impl Default for CatmullRom {
    /// Centripetal, without tension.
    fn default() -> Self {
        CatmullRom { tension: 0.0, alpha: 0.5 }
    }
}

impl<P: Point> Curve<P> {
    /// Through the points; C1. At least 2 points. Without knots the intervals over [0, 1] are in proportion to |ΔP|^alpha; with
    /// them `alpha` is not used. An open end takes the slope of its chord, as if a point had been mirrored in it.
    pub fn catmull_rom(
        points: &[P],
        shape: CatmullRom,
        knots: Option<&[f64]>,
        closed: bool,
    ) -> Result<Self, CurveError> {
        let n_pieces = interpolated_pieces("a catmull_rom spline", points, closed)?;
        check_finite("tension", &[shape.tension])?;
        check_finite("alpha", &[shape.alpha])?;
        let breaks = match knots {
            Some(_) => Breaks::new(knots, n_pieces)?,
            None => chord_breaks(points, shape.alpha, n_pieces)?,
        };
        let keep = Dd::difference(1.0, shape.tension);
        let slopes: Vec<_> =
            (0..points.len()).map(|i| slope(points, &breaks.widths, closed, i).times(keep)).collect();
        let bezier = from_slopes(points, &slopes, &breaks.widths);
        let form = Form { kind: FormKind::CatmullRom, points: points.to_vec(), slopes: Vec::new() };
        Ok(Curve::assemble(&breaks.knots, bezier, closed, form))
    }
}

/// Intervals of |ΔP|^alpha, as parts of their sum. Errors: neighbours that coincide, unless alpha is 0.
fn chord_breaks<P: Point>(points: &[P], alpha: f64, n_pieces: usize) -> Result<Breaks, CurveError> {
    if alpha == 0.0 {
        return Breaks::new(None, n_pieces);
    }
    let n = points.len();
    let mut ends = vec![Dd::from(0.0)];
    let mut widths = Vec::with_capacity(n_pieces);
    for i in 0..n_pieces {
        let chord = points[i].distance(points[(i + 1) % n]);
        let width = if alpha == 0.5 { chord.sqrt() } else { powf(chord, alpha) };
        if !(width > 0.0 && width.is_finite()) {
            return Err(CurveError::RepeatedPoint { index: i + 1 });
        }
        widths.push(Dd::from(width));
        ends.push(ends[i] + widths[i]);
    }
    let total = ends[n_pieces];
    let knots: Vec<f64> = ends.iter().map(|end| end.over(total).value()).collect();
    // A point so close to its neighbour that the sum of widths cannot tell them apart is a repeated one.
    match knots.windows(2).position(|w| w[0] >= w[1]) {
        Some(i) => Err(CurveError::RepeatedPoint { index: i + 1 }),
        None => Ok(Breaks { knots, widths }),
    }
}

/// Slope of the parabola through a point and its two neighbours; at an open end that of the chord.
fn slope<P: Point>(points: &[P], widths: &[Dd], closed: bool, i: usize) -> Dd<P> {
    let n = points.len();
    let chord = |k: usize| Dd::difference(points[(k + 1) % n], points[k]).over(widths[k]);
    if !closed && i == 0 {
        return chord(0);
    }
    if !closed && i == n - 1 {
        return chord(n - 2);
    }
    let (before, after) = ((i + n - 1) % n, i);
    let (h, k) = (widths[before], widths[after]);
    (chord(before).times(k) + chord(after).times(h)).over(h + k)
}
