//! A cubic by powers of the distance from the nearer of its ends, with the error of every rounding carried along: a third of the work of
//! de Casteljau's triangle, and exact at both ends like it. Compensated Horner: Graillat, Langlois & Louvet (2009). Knows nothing of
//! chains of pieces.

mod wide;

use crate::math::Point;
use crate::math::dd::{Dd, Factor, two_sum};
use crate::math::point::Lanes;

/// Coefficients of a cubic in powers of the distance from its start, and from its end, made once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FromEnds<P: Point> {
    start: [Dd<P::Lanes>; 4],
    end: [Dd<P::Lanes>; 4],
}

/// A place between 0 and 1 by its distance from the nearer of the two, at most ½.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearer {
    /// Whether that is 0.
    pub from_start: bool,
    pub distance: Dd,
}

impl Nearer {
    /// Of t in [0, 1].
    #[inline(always)]
    pub fn unit(t: f64) -> Nearer {
        let from_start = t <= 0.5;
        Nearer { from_start, distance: if from_start { t.into() } else { Dd::difference(1.0, t) } }
    }
}

impl<P: Point> FromEnds<P> {
    /// From Bézier points.
    pub fn new(b: &[Dd<P>; 4]) -> Self {
        let d = [b[1] - b[0], b[2] - b[1], b[3] - b[2]];
        let e = [d[1] - d[0], d[2] - d[1]];
        let f = e[1] - e[0];
        let lanes = |c: [Dd<P>; 4]| c.map(|c| Dd { hi: Lanes::of_point(c.hi), lo: Lanes::of_point(c.lo) });
        FromEnds {
            start: lanes([b[0], d[0].scaled(3.0), e[0].scaled(3.0), f]),
            end: lanes([b[3], d[2].scaled(-3.0), e[1].scaled(3.0), -f]),
        }
    }

    /// The value inside the piece: error below u|value| + 40 u² Σ |cᵢ| sⁱ, s the distance. None where a coefficient is too large to
    /// split.
    #[inline(always)]
    pub fn at(&self, place: Nearer) -> Option<P> {
        wide::nested(if place.from_start { &self.start } else { &self.end }, place.distance)
    }
}

/// All coordinates side by side: kept apart, so that the loop over them is seen to be one.
#[inline(never)]
fn nested<L: Lanes>(coefficients: &[Dd<L>; 4], s: Dd) -> L {
    let by_s = Factor::new(s.hi);
    L::of(|i| {
        let at = |k: usize| Dd { hi: coefficients[k].hi.lane(i), lo: coefficients[k].lo.lane(i) };
        let sum = step(step(step(at(3), at(2), s, by_s), at(1), s, by_s), at(0), s, by_s);
        sum.hi + sum.lo
    })
}

/// A sum and its rest, times s, plus a coefficient.
#[inline(always)]
fn step(sum: Dd, c: Dd, s: Dd, by_s: Factor) -> Dd {
    let (product, product_error) = by_s.times(sum.hi);
    let (hi, sum_error) = two_sum(product, c.hi);
    Dd { hi, lo: (sum.lo * s.hi + sum.hi * s.lo) + ((product_error + sum_error) + c.lo) }
}
