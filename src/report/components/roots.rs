//! Real roots of quadratics, cubics and quartics whose coefficients are exactly the numbers given. Input: five coefficients of 1, x, x², …
//! (the last ones 0), then at most four roots, NaN where there are no more. Truth: counts by Sturm's theorem in exact rationals,
//! roots to 120 digits, rounded. The hard quartics of Orellana and De Michele are those of table 1 of ACM TOMS 46 (2020), by the numbers of
//! `accuracytest.c` in CALGO 1010; 14 to 16 and 19 to 21 stand among the touching ones.

use crate::math::error::UNIT_ROUNDOFF;
use crate::math::exact::{Double, exponent, scale_by};
use crate::math::hex::parse_hex_list;
use crate::math::solve::roots_of;
use crate::report::naive::roots::{self as naive, Found};
use crate::report::row::Row;
use crate::report::trial::{Label, Plan, Subject, Trial, Verdict, default, variant};

type Input = [f64; 9];
type Solver = fn(&[f64]) -> Found;
type Formulas = &'static [(Label, Solver)];

/// Degree, component, variants by formula.
const DEGREES: [(usize, &str, Formulas); 3] = [
    (
        2,
        "quadratic roots",
        &[(variant("b²−4ac"), naive::textbook_quadratic), (variant("stable q"), naive::stable_quadratic)],
    ),
    (
        3,
        "cubic roots",
        &[(variant("cardano"), naive::cardano), (variant("cardano + newton"), naive::polished_cardano)],
    ),
    (4, "quartic roots", &[(variant("ferrari"), naive::ferrari)]),
];

/// Family in the goldens and the case's name, by degree.
const CASES: [(usize, &str, &str); 16] = [
    (2, "quadratic-tame", "any"),
    (2, "quadratic-spread", "roots of unlike size"),
    (2, "quadratic-close", "nearly double"),
    (2, "quadratic-tiny-lead", "tiny lead"),
    (2, "quadratic-rows", "known traps"),
    (3, "cubic-tame", "three roots"),
    (3, "cubic-one-real", "one root"),
    (3, "cubic-tiny-lead", "tiny lead"),
    (3, "cubic-close", "close roots"),
    (3, "touch-cubic", "touching"),
    (4, "quartic-tame", "four roots"),
    (4, "quartic-two-real", "two roots"),
    (4, "quartic-none-real", "no root"),
    (4, "quartic-spread", "roots of unlike size"),
    (4, "quartic-orellana", "Orellana and De Michele"),
    (4, "touch-quartic", "touching"),
];

/// Trials of root finding.
pub fn rows(plan: &Plan) -> Vec<Row> {
    CASES.iter().flat_map(|(degree, family, case)| trial(plan, *degree, family, case)).collect()
}

fn trial(plan: &Plan, degree: usize, family: &str, case: &'static str) -> Vec<Row> {
    let (_, component, formulas) = DEGREES[degree - 2];
    let touching = family.starts_with("touch");
    let (unit, bar) = if touching { ("u, backward", 8.0) } else { ("u times condition", 4.0) };
    let subject = Subject { component, case, unit, work: "", bar: Some(bar) };
    let judge = move |input: &Input, found: &Found| {
        if touching { backward(input, found) } else { forward(input, found) }
    };
    let mut trial = Trial::new(plan, subject, goldens(family), judge)
        .in_chains(|found| found.first().copied().unwrap_or(0.0));
    for (label, solve) in formulas {
        trial.run(*label, move |i| solve(&i[..=degree]));
    }
    trial.run(default("intervals").note("formulas lose or make up roots"), move |i| {
        Found::of(&roots_of(&i[..=degree]))
    });
    trial.finish()
}

fn goldens(family: &str) -> Vec<Input> {
    let lines = include_str!("../../../tests/golden-numbers/roots.txt").lines();
    let own = lines.filter(|line| line.split(' ').next() == Some(family));
    own.filter_map(|line| {
        let mut words = line.splitn(3, ' ').skip(1);
        let degree: usize = words.next()?.parse().ok()?;
        let numbers = parse_hex_list(words.next()?)?;
        let mut input = [0.0, 0.0, 0.0, 0.0, 0.0, f64::NAN, f64::NAN, f64::NAN, f64::NAN];
        input[..=degree].copy_from_slice(&numbers[..=degree]);
        // Roots are high + low; the low part is below what any variant can show.
        numbers[degree + 1..].chunks(2).zip(&mut input[5..]).for_each(|(root, place)| *place = root[0]);
        Some(input)
    })
    .collect()
}

fn planted(input: &Input) -> &[f64] {
    let n = input[5..].iter().take_while(|x| !x.is_nan()).count();
    &input[5..5 + n]
}

/// Counts, and where they agree the largest error of a root in units of u times the condition number.
fn forward(input: &Input, found: &Found) -> Verdict {
    let expected = planted(input);
    let (missed, spurious) =
        (expected.len().saturating_sub(found.len()), found.len().saturating_sub(expected.len()));
    let off = |(x, truth): (&f64, &f64)| {
        let (_, sum, slope) = scaled(&input[..5], *truth);
        // Half an ulp is what rounding the root itself costs.
        let rounding = 2.0 * UNIT_ROUNDOFF;
        ((x - truth) / truth).abs() / (UNIT_ROUNDOFF * sum / slope.abs()).max(rounding)
    };
    let error = (missed + spurious == 0).then(|| found.iter().zip(expected).map(off).fold(0.0, worse));
    Verdict { error, missed, spurious, work: 0.0 }
}

/// The largest residual in units of u Σ|cᵢxⁱ|; a root that nothing found stands for is missed, one with a residual above 64 is spurious.
fn backward(input: &Input, found: &Found) -> Verdict {
    let residual = |x: f64| {
        let (p, sum, _) = scaled(&input[..5], x);
        p.abs() / sum / UNIT_ROUNDOFF
    };
    let stands = |truth: f64| found.iter().any(|x| (x - truth).abs() <= 1e-4 * truth.abs());
    let missed = planted(input).iter().filter(|truth| !stands(**truth)).count();
    let spurious = found.iter().filter(|x| !(residual(**x) <= 64.0)).count();
    let error = found.iter().map(|x| residual(*x)).filter(|r| !(*r > 64.0)).fold(0.0, worse);
    Verdict { error: Some(error), missed, spurious, work: 0.0 }
}

/// The larger; NaN wins.
fn worse(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// p(x), Σ|cᵢxⁱ| and x·p′(x), all over one power of two; the first in twice the working precision.
fn scaled(c: &[f64], x: f64) -> (f64, f64, f64) {
    let e = if x == 0.0 { 0 } else { exponent(x) };
    let y = Double::new(scale_by(x, -e));
    let size = |i: usize| exponent(c[i]) + e * i as i32;
    let largest = (0..c.len()).filter(|i| c[*i] != 0.0).map(size).max().unwrap_or(0);
    let mut power = Double::new(1.0);
    let (mut p, mut sum, mut slope) = (Double::new(0.0), 0.0, 0.0);
    for (i, c) in c.iter().enumerate() {
        let term = Double::new(scale_by(*c, e * i as i32 - largest)) * power;
        (p, sum, slope) = (p + term, sum + term.value().abs(), slope + i as f64 * term.value());
        power = power * y;
    }
    (p.value(), sum, slope)
}
