//! A cubic by powers of the distance from the nearer of its ends, with the error of every rounding carried along: a third of the work of
//! de Casteljau's triangle, and exact at both ends like it. Compensated Horner: Graillat, Langlois & Louvet (2009). Knows nothing of
//! chains of pieces.

use crate::math::Point;
use crate::math::dd::{Dd, Factor, two_sum};

/// Coefficients of a cubic in powers of the distance from its start, and from its end, made once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FromEnds<P> {
    start: [Dd<P>; 4],
    end: [Dd<P>; 4],
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
        FromEnds {
            start: [b[0], d[0].scaled(3.0), e[0].scaled(3.0), f],
            end: [b[3], d[2].scaled(-3.0), e[1].scaled(3.0), -f],
        }
    }

    /// The value inside the piece: error below u|value| + 40 u² Σ |cᵢ| sⁱ, s the distance. Not finite where a coefficient is too large to
    /// split.
    #[inline]
    pub fn at(&self, place: Nearer) -> P {
        let (coefficients, s) = (if place.from_start { &self.start } else { &self.end }, place.distance);
        let by_s = Factor::new(s.hi);
        let Dd { hi: mut value, lo: mut rest } = coefficients[3];
        for c in coefficients[..3].iter().rev() {
            let (product, product_error) = by_s.times(value);
            let (sum, sum_error) = two_sum(product, c.hi);
            rest = (rest * s.hi + value * s.lo) + ((product_error + sum_error) + c.lo);
            value = sum;
        }
        value + rest
    }
}
