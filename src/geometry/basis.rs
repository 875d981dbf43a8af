//! The bases of cubic pieces, and exact change from one to another. Knows nothing of chains of pieces.
//!
//! A cubic is the same cubic in every basis; only its four coefficients differ. Changes go through control points of the Bézier
//! form as whole-number combinations in double-double, rounded once at the end: never through monomials, whose
//! coefficients lose the low digits of points far from the origin.

use crate::math::{Dd, Point};

/// A basis of the cubics, by the four coefficients of a piece over [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Basis {
    /// Control points; the curve starts at the first and ends at the fourth.
    Bezier,
    /// Control points of the uniform cubic B-spline: the piece lies between the second and the third.
    BSpline,
    /// P₀, P₁, m₀, m₁: ends, then derivatives there with respect to the piece's own parameter over [0, 1].
    Hermite,
    /// Four points in a row; the piece runs from the second to the third. Uniform, without tension.
    CatmullRom,
    /// Coefficients of 1, t, t², t³.
    Monomial,
    /// 4 × 4, a row per control point: its weight is the polynomial with these coefficients of 1, t, t², t³.
    Matrix([[f64; 4]; 4]),
}

/// Whole numbers over one denominator: row i gives coefficient i of the result.
struct Rational {
    rows: [[i64; 4]; 4],
    denominator: i64,
}

impl Basis {
    /// How far one piece moves on along a list of control points, unless said otherwise.
    pub fn stride(&self) -> usize {
        match self {
            Basis::Bezier => 3,
            Basis::Hermite => 2,
            Basis::BSpline | Basis::CatmullRom | Basis::Monomial | Basis::Matrix(_) => 1,
        }
    }

    /// Bézier control points from coefficients in this basis, to 2⁻¹⁰⁰ of the largest.
    pub fn to_bezier<P: Point>(&self, coefficients: &[Dd<P>; 4]) -> [Dd<P>; 4] {
        let rational = match self {
            Basis::Bezier => return *coefficients,
            Basis::BSpline => {
                Rational { rows: [[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]], denominator: 6 }
            }
            Basis::Hermite => {
                Rational { rows: [[3, 0, 0, 0], [3, 0, 1, 0], [0, 3, 0, -1], [0, 3, 0, 0]], denominator: 3 }
            }
            Basis::CatmullRom => {
                Rational { rows: [[0, 6, 0, 0], [-1, 6, 1, 0], [0, 1, 6, -1], [0, 0, 6, 0]], denominator: 6 }
            }
            Basis::Monomial => MONOMIAL_TO_BEZIER,
            Basis::Matrix(matrix) => return matrix_to_bezier(matrix, coefficients),
        };
        combine(&rational, coefficients)
    }

    /// Coefficients in this basis from Bézier control points. None for a matrix, which need not be invertible.
    pub fn from_bezier<P: Point>(&self, bezier: &[Dd<P>; 4]) -> Option<[Dd<P>; 4]> {
        let rows = match self {
            Basis::Bezier => return Some(*bezier),
            Basis::BSpline => [[6, -7, 2, 0], [0, 2, -1, 0], [0, -1, 2, 0], [0, 2, -7, 6]],
            Basis::Hermite => [[1, 0, 0, 0], [0, 0, 0, 1], [-3, 3, 0, 0], [0, 0, -3, 3]],
            Basis::CatmullRom => [[6, -6, 0, 1], [1, 0, 0, 0], [0, 0, 0, 1], [1, 0, -6, 6]],
            Basis::Monomial => [[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]],
            Basis::Matrix(_) => return None,
        };
        Some(combine(&Rational { rows, denominator: 1 }, bezier))
    }

    /// The same cubic's coefficients in another basis, each rounded once. None where `target` is a matrix.
    pub fn convert<P: Point>(&self, target: &Basis, coefficients: &[P; 4]) -> Option<[P; 4]> {
        let bezier = self.to_bezier(&coefficients.map(Dd::from));
        target.from_bezier(&bezier).map(|c| c.map(Dd::value))
    }

    /// 4 × 4, a row per control point: the coefficients of 1, t, t², t³ of its weight. γ(t) = G · M · (1, t, t², t³)ᵀ.
    pub fn matrix(&self) -> [[f64; 4]; 4] {
        if let Basis::Matrix(matrix) = self {
            return *matrix;
        }
        let weight = |row: usize| {
            let unit: [Dd<f64>; 4] = std::array::from_fn(|i| Dd::from(f64::from(u8::from(i == row))));
            let bezier = self.to_bezier(&unit);
            combine(&Rational { rows: BEZIER_TO_MONOMIAL, denominator: 1 }, &bezier).map(Dd::value)
        };
        std::array::from_fn(weight)
    }
}

const MONOMIAL_TO_BEZIER: Rational =
    Rational { rows: [[3, 0, 0, 0], [3, 1, 0, 0], [3, 2, 1, 0], [3, 3, 3, 3]], denominator: 3 };
const BEZIER_TO_MONOMIAL: [[i64; 4]; 4] = [[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]];

fn combine<P: Point>(by: &Rational, points: &[Dd<P>; 4]) -> [Dd<P>; 4] {
    by.rows.map(|row| {
        // Zero weights are left out, so that a point that does not count may be anything.
        let terms = row.iter().zip(points).filter(|(n, _)| **n != 0);
        let sum = terms.map(|(n, p)| p.scaled(*n as f64)).reduce(|a, b| a + b).unwrap_or_default();
        if by.denominator == 1 { sum } else { sum.over_integer(by.denominator) }
    })
}

/// G · M, then monomials to Bernstein: each point's weights are changed, not the points' combination.
fn matrix_to_bezier<P: Point>(matrix: &[[f64; 4]; 4], points: &[Dd<P>; 4]) -> [Dd<P>; 4] {
    let weights = matrix.map(|row| combine(&MONOMIAL_TO_BEZIER, &row.map(Dd::from)));
    std::array::from_fn(|i| {
        let terms = points.iter().zip(&weights).map(|(p, w)| p.times(w[i]));
        terms.reduce(|a, b| a + b).unwrap_or_default()
    })
}

/// The weights (1−t)³, 3t(1−t)², 3t²(1−t), t³ of Bézier control points.
#[inline]
pub fn bernstein(t: f64) -> [f64; 4] {
    let r = 1.0 - t;
    [r * r * r, 3.0 * t * (r * r), 3.0 * (t * t) * r, t * t * t]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    const NAMED: [Basis; 5] =
        [Basis::Bezier, Basis::BSpline, Basis::Hermite, Basis::CatmullRom, Basis::Monomial];

    fn ulp(x: f64) -> f64 {
        x.abs().next_up() - x.abs()
    }

    #[test]
    fn a_bspline_window_has_these_bezier_points() {
        let p = [(0.0, 0.0), (1.0, 2.0), (3.0, 3.0), (4.0, 0.0)].map(|(x, y)| DVec2::new(x, y));
        let b = Basis::BSpline.convert(&Basis::Bezier, &p).unwrap();
        let sixths = [(7.0, 11.0), (10.0, 14.0), (14.0, 16.0), (17.0, 14.0)];
        let expected = sixths.map(|(x, y)| DVec2::new(x / 6.0, y / 6.0));
        assert_eq!(b, expected);
    }

    #[test]
    fn round_trips_far_from_the_origin_keep_all_but_the_last_bits() {
        for offset in [0.0, 1e8, -3.7e11] {
            let p = [0.1, 1.7, 3.3, 2.9].map(|x| x + offset);
            let bezier = Basis::BSpline.convert(&Basis::Bezier, &p).unwrap();
            let back = Basis::Bezier.convert(&Basis::BSpline, &bezier).unwrap();
            let bar = 8.0 * ulp(p.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
            assert!(p.iter().zip(&back).all(|(a, b)| (a - b).abs() <= bar), "{p:?} {back:?}");
        }
    }

    #[test]
    fn every_named_basis_converts_to_every_other_and_back() {
        let p = [3.0, -1.0, 0.5, 2.0];
        for from in NAMED {
            for to in NAMED {
                let there = from.convert(&to, &p).unwrap();
                let back = to.convert(&from, &there).unwrap();
                assert!(p.iter().zip(back).all(|(a, b)| (a - b).abs() < 2e-14), "{from:?} {to:?} {back:?}");
            }
        }
    }

    #[test]
    fn matrices_are_those_of_the_textbooks_and_convert_alike() {
        let sixth =
            [[1.0, -3.0, 3.0, -1.0], [4.0, 0.0, -6.0, 3.0], [1.0, 3.0, 3.0, -3.0], [0.0, 0.0, 0.0, 1.0]];
        assert_eq!(Basis::BSpline.matrix(), sixth.map(|row| row.map(|x| x / 6.0)));
        assert_eq!(Basis::Hermite.matrix()[0], [1.0, 0.0, -3.0, 2.0]);
        assert_eq!(Basis::Bezier.matrix()[1], [0.0, 3.0, -6.0, 3.0]);
        for basis in NAMED {
            let p = [1.0, 2.0, -3.0, 0.25].map(Dd::from);
            let direct = basis.to_bezier(&p).map(Dd::value);
            let by_matrix = Basis::Matrix(basis.matrix()).to_bezier(&p).map(Dd::value);
            assert!(direct.iter().zip(by_matrix).all(|(a, b)| (a - b).abs() < 4e-15), "{basis:?}");
        }
    }

    #[test]
    fn weights_sum_to_one() {
        for i in 0..=64 {
            let sum: f64 = bernstein(f64::from(i) / 64.0).iter().sum();
            assert!((sum - 1.0).abs() <= 2.0 * f64::EPSILON);
        }
    }
}
