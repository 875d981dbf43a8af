//! What lengths, frames and tubes need of a curve, whatever it is made of. Knows nothing of cubics beyond their implementation of it.

use super::curve::{Curve, Side, tangent_of};
use crate::math::{Point, bernstein};

/// A point for each parameter of an interval, with derivatives that are continuous but for the [`Path::cuts`].
pub trait Path<P: Point> {
    /// First and last parameter.
    fn domain(&self) -> (f64, f64);

    /// True where the end runs on into the start.
    fn closed(&self) -> bool;

    /// γ(t), t in the domain.
    fn position(&self, t: f64) -> P;

    /// γ′, γ″ and γ‴ at t in the domain, in the limit from a side where t is a cut.
    fn derivatives_from(&self, t: f64, side: Side) -> [P; 3];

    /// |γ′(t)|, as fast as it comes.
    fn speed(&self, t: f64) -> f64;

    /// Speeds below this are 0 but for rounding.
    fn still(&self, t: f64) -> f64;

    /// Parameters between which the speed is smooth and does not dip: both ends of the domain, seams, and least speeds; ascending.
    fn cuts(&self) -> Vec<f64>;

    /// Unit tangent in the limit from a side; zero where the path stands still.
    fn direction(&self, t: f64, side: Side) -> P {
        tangent_of(&self.derivatives_from(t, side), self.still(t), side).unwrap_or_default()
    }
}

impl<P: Point> Path<P> for Curve<P> {
    fn domain(&self) -> (f64, f64) {
        Curve::domain(self)
    }

    fn closed(&self) -> bool {
        Curve::closed(self)
    }

    fn position(&self, t: f64) -> P {
        self.piece_at(t).at(t)
    }

    fn derivatives_from(&self, t: f64, side: Side) -> [P; 3] {
        self.piece_from(t, side).derivatives(t)
    }

    fn speed(&self, t: f64) -> f64 {
        self.piece_at(t).fast_velocity(t).length()
    }

    fn still(&self, t: f64) -> f64 {
        self.piece_at(t).still()
    }

    fn cuts(&self) -> Vec<f64> {
        let mut cuts = vec![Curve::domain(self).0];
        for piece in self.pieces() {
            let inner = slowest(piece.hodograph()).into_iter().map(|x| piece.parameter(x));
            cuts.extend(inner.chain([piece.end()]));
        }
        cuts.dedup_by(|a, b| *a <= *b);
        cuts
    }
}

/// Where |γ′|², a quartic, has its least values inside (0, 1): the rising zeros of its derivative.
fn slowest<P: Point>(d: &[P; 3]) -> Vec<f64> {
    let scale = d.iter().fold(0.0, |m: f64, d| m.max(d.max_abs()));
    if scale == 0.0 {
        return Vec::new();
    }
    let [a, b, c] = d.map(|d| d / scale);
    let square = [a.dot(a), a.dot(b), (a.dot(c) + 2.0 * b.dot(b)) / 3.0, b.dot(c), c.dot(c)];
    let slope: [f64; 4] = std::array::from_fn(|i| square[i + 1] - square[i]);
    let bend: [f64; 3] = std::array::from_fn(|i| slope[i + 1] - slope[i]);
    let rises = |x: &f64| bernstein::value(&bend, *x) >= 0.0;
    bernstein::roots(&slope).into_iter().filter(|x| *x > 0.0 && *x < 1.0).filter(rises).collect()
}
