//! Every value, computed or true, and every difference quotient lies in the form; the rest shrinks with the square of the box.

use super::*;
use crate::math::field::enclose::tests::{Random, tapes};

/// The form of a tape over a box, a side of which goes with each input.
fn form<const N: usize>(field: &Field, middle: &[f64], half: f64) -> Option<Linear<N>> {
    let inputs: Vec<Linear<N>> = (0..field.n_inputs())
        .map(|i| {
            let mut x = Linear::constant(middle[i]);
            x.slope[i] = half;
            x
        })
        .collect();
    Linearizer::reuse(field, Vec::new()).run(&inputs)
}

#[test]
fn values_and_slopes_lie_in_the_form() {
    let mut random = Random(11);
    for (name, field, middle, reach) in tapes() {
        let n = field.n_inputs();
        let (mut known, mut tight) = (0, 0);
        for case in 0..3000 {
            let half = 0.5 * reach * 0.5f64.powi(case % 12);
            let c: Vec<f64> = (0..n).map(|_| middle + random.next() * (reach - half)).collect();
            let Some(form) = form::<6>(&field, &c, half) else { continue };
            known += 1;
            let value = |e: &[f64]| {
                let p: Vec<f64> = (0..n).map(|i| c[i] + half * e[i]).collect();
                let mut out = [f64::NAN];
                field.eval(&p, &mut out).map(|()| out[0]).ok()
            };
            let e: Vec<f64> = (0..n).map(|_| random.next()).collect();
            let here = value(&e).unwrap_or_else(|| panic!("{name}: undefined in a form at {c:?}"));
            let there: f64 = (0..n).map(|i| form.slope[i] * e[i]).sum();
            let off = (here - form.middle - there).abs();
            // The place itself is rounded.
            let slack = 4.0
                * f64::EPSILON
                * (c.iter().fold(half, |m, x| m.max(x.abs())))
                * form.bend.iter().chain(&form.slope).map(|x| x.abs()).sum::<f64>()
                / half;
            assert!(off <= form.rest + slack, "{name}: {off} beyond {form:?} at {c:?} ± {half}");
            tight += u32::from(form.rest < 0.1 * form.slope.iter().map(|g| g.abs()).sum::<f64>());
            for i in 0..n {
                let mut next = e.clone();
                let h = 1e-6;
                next[i] = if e[i] > 0.0 { e[i] - h } else { e[i] + h };
                let quotient = (value(&next).expect("defined") - here) / (next[i] - e[i]);
                let doubt = 1e-15 / h * (1.0 + here.abs()) * 8.0 + 1e-5 * form.slope[i].abs();
                assert!(
                    (quotient - form.slope[i]).abs() <= form.bend[i] + doubt,
                    "{name}: slope {quotient} beyond {form:?} at {c:?} ± {half}"
                );
            }
        }
        println!("{name}: {known} known, {tight} tight");
        let steps = ["sign", "round", "<", "==", "fbm"].contains(&name);
        assert!(known > 900 && (tight > 300 || steps), "{name}: {known} known, {tight} tight");
    }
}

#[test]
fn the_rest_shrinks_with_the_square() {
    for (name, field, ..) in tapes() {
        if !["sin", "exp", "*", "length", "noise", "tanh"].contains(&name) {
            continue;
        }
        let c = [0.7, 0.4, 0.9];
        let rest = |half| form::<6>(&field, &c, half).expect("smooth").rest;
        assert!(rest(1e-3) < 2e-4 * 1.001 * rest(0.1), "{name}: {} to {}", rest(1e-3), rest(0.1));
    }
}
