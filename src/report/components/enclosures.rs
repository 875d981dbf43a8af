//! All that a formula can be over a box. Input: the middle of a box and half its side. Truth: closed forms of its range. An error is what an
//! enclosure is wider than that, in widths of the truth; one that does not hold the truth has missed it.

use super::SEED;
use super::tapes::{Squares, Tape, tangle, torus};
use crate::math::field::{Enclosed, Encloser, Linear, Linearizer};
use crate::math::interval::Interval;
use crate::math::random::Random;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use std::rc::Rc;

type Input = [f64; 4];
type Ends = Option<[f64; 2]>;

#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    formula: Tape,
    range: fn(&Input) -> [f64; 2],
    /// Half the side of the boxes.
    half: f64,
    bar: f64,
}

const CASES: [Case; 6] = [
    Case { name: "tanglecube, boxes of 1", formula: tangle, range: of_tangle, half: 0.5, bar: 3.0 },
    Case { name: "tanglecube, boxes of 1/8", formula: tangle, range: of_tangle, half: 0.0625, bar: 1.5 },
    Case { name: "tanglecube, boxes of 1/64", formula: tangle, range: of_tangle, half: 0.0078125, bar: 0.5 },
    Case { name: "torus, boxes of 1", formula: torus, range: of_torus, half: 0.5, bar: 5.0 },
    Case { name: "torus, boxes of 1/8", formula: torus, range: of_torus, half: 0.0625, bar: 2.5 },
    Case { name: "torus, boxes of 1/64", formula: torus, range: of_torus, half: 0.0078125, bar: 1.5 },
];

/// Trials of bounds over boxes.
pub fn rows(plan: &Plan) -> Vec<Row> {
    CASES.iter().flat_map(|case| trial(plan, *case)).collect()
}

fn trial(plan: &Plan, case: Case) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let mut draw = || random.between(-2.0, 2.0);
    let inputs = (0..plan.inputs).map(|_| [draw(), draw(), draw(), case.half]).collect();
    let subject = Subject {
        component: "bounds over a box",
        case: case.name,
        unit: "widths of the true range",
        work: "",
        bar: Some(case.bar),
    };
    let mut trial = Trial::new(plan, subject, inputs, move |i, ends| judge((case.range)(i), ends));
    for (name, squares) in [("intervals, x·x", Squares::Products), ("intervals", Squares::Known)] {
        let field = Rc::new((case.formula)(squares));
        trial.run(variant(name), move |i| {
            let value =
                Encloser::new(&field).run(&sides(i).map(|value| Enclosed::<0> { value, slope: [] })).value;
            Some([value.lo, value.hi])
        });
    }
    let why =
        "its excess shrinks with the box, and that of intervals does not; of large boxes both are asked";
    for (label, squares) in [
        (variant("linear forms, x·x"), Squares::Products),
        (default("linear forms").note(why), Squares::Known),
    ] {
        let field = Rc::new((case.formula)(squares));
        trial.run(label, move |i| {
            let form = Linearizer::reuse(&field, Vec::new()).run(&forms(i))?;
            Some([form.range().lo, form.range().hi])
        });
    }
    trial.finish()
}

fn sides(i: &Input) -> [Interval; 3] {
    [0, 1, 2].map(|axis| Interval::new(i[axis] - i[3], i[axis] + i[3]))
}

fn forms(i: &Input) -> [Linear<3>; 3] {
    [0, 1, 2].map(|axis| {
        let mut slope = [0.0; 3];
        slope[axis] = i[3];
        Linear::new(i[axis], slope, 4.0 * f64::EPSILON)
    })
}

/// What f64 may be off in the truth itself, as a part of the sizes that are added up to it.
const DOUBT: f64 = 1e-12;

fn judge([low, high]: [f64; 2], ends: &Ends) -> Verdict {
    let Some([lo, hi]) = *ends else { return Verdict { missed: 1, ..Verdict::default() } };
    let doubt = DOUBT * (1.0 + low.abs() + high.abs());
    let missed = usize::from(lo > low + doubt || hi < high - doubt);
    let excess = (hi - lo) / (high - low) - 1.0;
    Verdict { missed, ..Verdict::error(excess.max(0.0)) }
}

/// Least and greatest square in the box along an axis.
fn squares(i: &Input, axis: usize) -> [f64; 2] {
    let (a, b) = (i[axis] - i[3], i[axis] + i[3]);
    let least = if a <= 0.0 && b >= 0.0 { 0.0 } else { (a * a).min(b * b) };
    [least, (a * a).max(b * b)]
}

/// Σ u² − 5u for squares u, which fall up to 5/2 and rise beyond.
fn of_tangle(i: &Input) -> [f64; 2] {
    let term = |u: f64| u * (u - 5.0);
    (0..3).fold([11.8; 2], |[low, high], axis| {
        let [a, b] = squares(i, axis);
        [low + term(2.5f64.clamp(a, b)), high + term(a).max(term(b))]
    })
}

/// (s + w + R² − r²)² − 4R²s for s = x² + y², w = z², R = 1 and r = 0.4: it rises with w, and as s it falls up to 2R² − w − R² + r².
fn of_torus(i: &Input) -> [f64; 2] {
    let ([a, b], [c, d], [w0, w1]) = (squares(i, 0), squares(i, 1), squares(i, 2));
    let (s0, s1) = (a + c, b + d);
    let rest = 1.0 - 0.4 * 0.4;
    let value = |s: f64, w: f64| (s + w + rest) * (s + w + rest) - 4.0 * s;
    [value((2.0 - w0 - rest).clamp(s0, s1), w0), value(s0, w1).max(value(s1, w1))]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Least and greatest of what a formula gives on a grid over a box, its corners among the places.
    fn sampled(field: &crate::math::field::Field, i: &Input) -> [f64; 2] {
        const STEPS: usize = 16;
        let place = |axis: usize, k: usize| i[axis] + i[3] * (2.0 * k as f64 / STEPS as f64 - 1.0);
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
        for at in 0..(STEPS + 1).pow(3) {
            let (x, y, z) = (at % (STEPS + 1), at / (STEPS + 1) % (STEPS + 1), at / (STEPS + 1).pow(2));
            let mut value = [0.0];
            field.eval(&[place(0, x), place(1, y), place(2, z)], &mut value).expect("a sum of products");
            ends = [ends[0].min(value[0]), ends[1].max(value[0])];
        }
        ends
    }

    #[test]
    fn the_ranges_that_are_taken_for_true_are_those_of_samples() {
        let mut random = Random::new(SEED);
        for case in CASES {
            let field = (case.formula)(Squares::Known);
            for _ in 0..20 {
                let mut draw = || random.between(-2.0, 2.0);
                let input = [draw(), draw(), draw(), case.half];
                let ([low, high], [least, greatest]) = ((case.range)(&input), sampled(&field, &input));
                let (doubt, width) = (1e-9, high - low);
                assert!(low <= least + doubt && greatest <= high + doubt, "{}: {input:?}", case.name);
                assert!(
                    least - low <= 0.05 * width && high - greatest <= 0.05 * width,
                    "{}: {input:?}",
                    case.name
                );
            }
        }
    }
}
