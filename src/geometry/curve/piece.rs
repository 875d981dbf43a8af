//! One cubic piece of a curve over its own interval of the curve's parameter.

use super::evaluate::{Local, Method, compensated};
use super::from_ends::{FromEnds, Nearer};
use crate::math::{Dd, Point};

/// A cubic over `[start, end]`. Its Bézier points are kept to 106 bits, so that a change of basis or a split costs no accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece<P: Point> {
    start: f64,
    end: f64,
    /// 1 / (end − start).
    per_width: Dd,
    /// Whether that is 1, to the bit.
    is_unit: bool,
    bezier: [Dd<P>; 4],
    from_ends: FromEnds<P>,
    /// Bézier points of γ′, rounded: the fast way to speeds.
    hodograph: [P; 3],
}

impl<P: Point> Piece<P> {
    /// From Bézier points; `start < end`.
    pub(crate) fn new(start: f64, end: f64, bezier: [Dd<P>; 4]) -> Self {
        let per_width = Dd::from(1.0).over(Dd::difference(end, start));
        let slope = |i: usize| (bezier[i + 1] - bezier[i]).scaled(3.0).times(per_width).value();
        let from_ends = FromEnds::new(&bezier);
        let is_unit = per_width == Dd::from(1.0);
        Piece { start, end, per_width, is_unit, bezier, from_ends, hodograph: [slope(0), slope(1), slope(2)] }
    }

    /// First parameter.
    #[inline]
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Last parameter.
    #[inline]
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Bézier points, rounded to f64.
    pub fn points(&self) -> [P; 4] {
        self.bezier.map(Dd::value)
    }

    /// Bézier points to 106 bits.
    pub fn exact_points(&self) -> &[Dd<P>; 4] {
        &self.bezier
    }

    /// t's place in the piece, exact at both ends.
    #[inline(always)]
    pub(crate) fn local(&self, t: f64) -> Local {
        if self.start == 0.0 && self.end == 1.0 {
            return Local::unit(t);
        }
        let x = Dd::difference(t, self.start).times(self.per_width);
        let r = Dd::difference(self.end, t).times(self.per_width);
        Local { x, r }
    }

    /// t's place rounded: 0 at the start, 1 at the end.
    #[inline(always)]
    pub(crate) fn fraction(&self, t: f64) -> f64 {
        (t - self.start) * self.per_width.hi
    }

    /// The parameter at a fraction of the width.
    pub(crate) fn parameter(&self, fraction: f64) -> f64 {
        if fraction == 1.0 {
            return self.end;
        }
        (self.start + fraction * (self.end - self.start)).clamp(self.start, self.end)
    }

    /// γ(t), for any real t: outside the piece's interval the cubic goes on.
    #[inline]
    pub fn at(&self, t: f64) -> P {
        let inside = (t >= self.start && t <= self.end).then(|| self.at_inside(t)).flatten();
        inside.unwrap_or_else(|| self.at_by_triangle(t))
    }

    /// The same for t in the piece's interval; none where the numbers are too large for the quick way.
    #[inline(always)]
    pub(crate) fn at_inside(&self, t: f64) -> Option<P> {
        self.from_ends.at(self.nearer(t))
    }

    /// The same by de Casteljau's triangle, which serves any t.
    #[cold]
    #[inline(never)]
    fn at_by_triangle(&self, t: f64) -> P {
        let local = self.local(t);
        compensated(&self.bezier, |_| local).hi
    }

    /// The same for t inside the piece, of which only the nearer end is asked.
    #[inline(always)]
    fn nearer(&self, t: f64) -> Nearer {
        if self.start == 0.0 && self.end == 1.0 {
            return Nearer::unit(t);
        }
        let from_start = t - self.start <= self.end - t;
        let way = if from_start { Dd::difference(t, self.start) } else { Dd::difference(self.end, t) };
        // The product by 1 is the factor, to the bit: breakpoints one apart are common.
        let distance = if self.is_unit { way } else { way.times(self.per_width) };
        Nearer { from_start, distance }
    }

    /// γ(t) by another method than the default, from rounded Bézier points.
    pub fn at_by(&self, method: Method, t: f64) -> P {
        match method {
            Method::FromEnds => self.at(t),
            Method::Compensated => self.at_by_triangle(t),
            Method::Horner
            | Method::Bernstein
            | Method::DeCasteljau
            | Method::VolkSchumaker
            | Method::Offset => method.evaluate(&self.points(), self.local(t).x.hi),
        }
    }

    /// The blossom F(a, b, c): symmetric in its arguments to the last bit, affine in each, and F(t, t, t) = [`Piece::at`] (t) to
    /// the last bit. Arguments may be any reals.
    pub fn blossom(&self, a: f64, b: f64, c: f64) -> P {
        if a == b && b == c {
            return self.at(a);
        }
        let mut arguments = [a, b, c];
        arguments.sort_by(f64::total_cmp);
        let local = arguments.map(|t| self.local(t));
        compensated(&self.bezier, |level| local[level]).hi
    }

    /// The blossom to 106 bits.
    pub(crate) fn exact_blossom(&self, arguments: [f64; 3]) -> Dd<P> {
        let local = arguments.map(|t| self.local(t));
        compensated(&self.bezier, |level| local[level])
    }

    /// γ′(t), γ″(t) and γ‴(t), per unit of the curve's parameter.
    pub fn derivatives(&self, t: f64) -> [P; 3] {
        let b = &self.bezier;
        let d = [b[1] - b[0], b[2] - b[1], b[3] - b[2]];
        let e = [d[1] - d[0], d[2] - d[1]];
        let local = self.local(t);
        let w = self.per_width;
        let velocity = compensated(&d, |_| local).scaled(3.0).times(w);
        let acceleration = compensated(&e, |_| local).scaled(6.0).times(w).times(w);
        let jerk = (e[1] - e[0]).scaled(6.0).times(w).times(w).times(w);
        [velocity.value(), acceleration.value(), jerk.value()]
    }

    /// γ′(t) alone.
    pub fn velocity(&self, t: f64) -> P {
        let b = &self.bezier;
        let local = self.local(t);
        compensated(&[b[1] - b[0], b[2] - b[1], b[3] - b[2]], |_| local)
            .scaled(3.0)
            .times(self.per_width)
            .value()
    }

    /// γ′(t) in plain f64, within a few u of the largest control velocity.
    #[inline]
    pub(crate) fn fast_velocity(&self, t: f64) -> P {
        let (x, [a, b, c]) = (self.fraction(t), self.hodograph);
        let r = 1.0 - x;
        a * (r * r) + b * (2.0 * r * x) + c * (x * x)
    }

    /// Bézier points of γ′ in plain f64.
    pub(crate) fn hodograph(&self) -> &[P; 3] {
        &self.hodograph
    }

    /// Velocities below this are 0 but for rounding: a few u of the largest control velocity.
    pub(crate) fn still(&self) -> f64 {
        4.0 * f64::EPSILON * self.hodograph.iter().fold(0.0, |m: f64, d| m.max(d.max_abs()))
    }

    /// Length of the control polygon: never less than that of the curve.
    pub fn polygon_length(&self) -> f64 {
        let p = self.points();
        p.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// The parts before and after t, which lies inside the interval. They meet in the same bits.
    pub(crate) fn split(&self, t: f64) -> (Self, Self) {
        let (a, b) = (self.start, self.end);
        let middle = self.exact_blossom([t, t, t]);
        let before = [self.bezier[0], self.exact_blossom([a, a, t]), self.exact_blossom([a, t, t]), middle];
        let after = [middle, self.exact_blossom([t, t, b]), self.exact_blossom([t, b, b]), self.bezier[3]];
        (Piece::new(a, t, before), Piece::new(t, b, after))
    }

    /// Run backwards, over another interval.
    pub(crate) fn reversed(&self, start: f64, end: f64) -> Self {
        let [a, b, c, d] = self.bezier;
        Piece::new(start, end, [d, c, b, a])
    }
}
