//! How smoothly pieces meet: parametric (C) and geometric (G) continuity, which are different things. Knows nothing of the forms
//! that promise either.
//!
//! C2 is the continuity of γ″; G1 that of direction, at a point passed with speed; G2 that of curvature too. A cusp may be C2
//! (a cubic can stop and turn) and is not G1; the same parabola continued at double speed is G2 and not C1.

use super::differential::across;
use super::{Curve, Piece};
use crate::math::Point;
use crate::math::error::UNIT_ROUNDOFF;

/// How the curve runs through one seam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seam {
    /// Highest derivative that is continuous, with all before it: 0 to 3 (3: both sides are one cubic). None where the
    /// ends do not meet.
    pub parametric: Option<u8>,
    /// 0 to 2. 0 too where the speed vanishes on a side. None where the ends do not meet, or for a curve of numbers, which has no
    /// direction.
    pub geometric: Option<u8>,
}

impl Seam {
    /// One class for both: "C2", "C1 G2", "C1", "G2", "G1", "C0"; "C2 cusp" and the like where a smooth parametrisation comes to
    /// a stop; "gap".
    pub fn name(&self) -> &'static str {
        match (self.parametric, self.geometric) {
            (None, _) => "gap",
            (Some(2..), Some(0)) => "C2 cusp",
            (Some(1), Some(0)) => "C1 cusp",
            (Some(2..), _) => "C2",
            (Some(1), Some(2..)) => "C1 G2",
            (Some(1), _) => "C1",
            (Some(0), Some(2..)) => "G2",
            (Some(0), Some(1)) => "G1",
            (Some(0), _) => "C0",
        }
    }
}

/// Jumps below this many roundings of the data are rounding: a control point written as a midpoint is off by one or two.
const SLACK: f64 = 8.0 * UNIT_ROUNDOFF;

impl<P: Point> Curve<P> {
    /// A class for each seam in order; for a closed curve the one from the end to the start last.
    pub fn continuity(&self) -> Vec<Seam> {
        let n = self.pieces.len();
        let last = self.closed.then(|| seam(&self.pieces[n - 1], &self.pieces[0]));
        self.pieces.windows(2).map(|w| seam(&w[0], &w[1])).chain(last).collect()
    }
}

/// γ and its derivatives at one side of a seam, each with how far rounding of the data may have moved it.
struct Jet<P> {
    values: [P; 4],
    slack: [f64; 4],
}

impl<P: Point> Jet<P> {
    fn of(piece: &Piece<P>, t: f64) -> Self {
        let [v, a, j] = piece.derivatives(t);
        let size = piece.points().iter().fold(0.0, |m: f64, p| m.max(p.max_abs()));
        let per_width = 1.0 / (piece.end() - piece.start());
        // Breakpoints such as 1/3 are rounded, and with them the width that each derivative is divided by.
        let width_error = piece.start().abs().max(piece.end().abs()) * per_width;
        let slack = |order: i32, weights: f64, value: P| {
            let scale = crate::math::elementary::powi(per_width, order);
            SLACK * (size * weights * scale + f64::from(order) * value.max_abs() * width_error)
        };
        // Weights of the points in each derivative, by magnitude: 3·2, 6·4, 6·8.
        let slack = [SLACK * size, slack(1, 6.0, v), slack(2, 24.0, a), slack(3, 48.0, j)];
        Jet { values: [piece.at(t), v, a, j], slack }
    }
}

fn seam<P: Point>(before: &Piece<P>, after: &Piece<P>) -> Seam {
    let (a, b) = (Jet::of(before, before.end()), Jet::of(after, after.start()));
    let continuous = |k: usize| (a.values[k] - b.values[k]).max_abs() <= a.slack[k] + b.slack[k];
    let smooth = (0..4).take_while(|k| continuous(*k)).count();
    let parametric = (smooth as u8).checked_sub(1);
    let geometric = (parametric.is_some() && P::DIMENSION > 1).then(|| geometric(&a, &b));
    Seam { parametric, geometric }
}

fn geometric<P: Point>(a: &Jet<P>, b: &Jet<P>) -> u8 {
    let (speed_a, speed_b) = (a.values[1].length(), b.values[1].length());
    if speed_a <= a.slack[1] || speed_b <= b.slack[1] {
        return 0;
    }
    let (tangent_a, tangent_b) = (a.values[1] / speed_a, b.values[1] / speed_b);
    let (turn_a, turn_b) = (a.slack[1] / speed_a, b.slack[1] / speed_b);
    if (tangent_a - tangent_b).max_abs() > turn_a + turn_b + SLACK {
        return 0;
    }
    // Curvature vectors: the part of γ″ across the tangent, over the speed squared.
    let bend = |jet: &Jet<P>, tangent, speed: f64| across(jet.values[2], tangent) / speed / speed;
    let slack = |jet: &Jet<P>, turn: f64, speed: f64| {
        (jet.slack[2] + 4.0 * turn * jet.values[2].length()) / speed / speed
    };
    let jump = (bend(a, tangent_a, speed_a) - bend(b, tangent_b, speed_b)).max_abs();
    if jump <= slack(a, turn_a, speed_a) + slack(b, turn_b, speed_b) { 2 } else { 1 }
}
