//! Every value, computed or true, and every difference quotient lies in the form; the rest shrinks with the square of the box.

use super::*;
use crate::math::elementary;
use crate::math::field::enclose::tests::{Random, tapes};
use crate::math::field::{FieldBuilder, Quadratic};

/// The form of a tape over a box, a side of which goes with each input.
fn form<const N: usize>(field: &Field, middle: &[f64], half: f64) -> Option<Linear<N>> {
    let inputs: Vec<Linear<N>> = (0..field.n_inputs())
        .map(|i| {
            let mut slope = [0.0; N];
            slope[i] = half;
            Linear::new(middle[i], slope, 0.0)
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

/// Products, waves and roots of a place, so that every rule of quadratic forms is used.
fn waves_and_roots() -> Field {
    let mut b = FieldBuilder::new(3);
    let p = [0, 1, 2].map(|i| b.input(i));
    let (s, c) = (b.call1(elementary::sin, Rule::Sin, p[0]), b.call1(elementary::cos, Rule::Cos, p[1]));
    let product = b.binary(Binary::Mul, s, c);
    let squares = p.map(|x| b.binary(Binary::Mul, x, x));
    let sum = squares.into_iter().reduce(|x, y| b.binary(Binary::Add, x, y)).unwrap();
    let root = b.unary(Unary::Sqrt, sum);
    let length = b.call_n(
        |of, to| to[0] = of.iter().map(|x| x * x).sum::<f64>().sqrt(),
        Rule::Length,
        &[root, product],
        1,
    )[0];
    let turned = b.unary(Unary::Neg, length);
    let result = b.binary(Binary::Sub, product, turned);
    b.finish(&[result]).unwrap()
}

#[test]
fn values_and_slopes_lie_in_quadratic_forms_whose_rest_shrinks_with_the_cube() {
    let few = tapes().into_iter().filter(|(_, field, ..)| field.n_inputs() <= 3);
    let all = few.chain([("waves and roots", waves_and_roots(), 0.0, 2.0)]);
    let mut random = Random(12);
    for (name, field, middle, reach) in all {
        let n = field.n_inputs();
        let mut known = 0;
        for case in 0..2000 {
            let half = 0.4 * reach * 0.5f64.powi(case % 12);
            let c: Vec<f64> = (0..n).map(|_| middle + random.next() * (reach - half)).collect();
            let inputs: Vec<Linear<3>> = (0..n)
                .map(|i| {
                    let mut slope = [0.0; 3];
                    slope[i] = half;
                    Linear::new(c[i], slope, 0.0)
                })
                .collect();
            let mut linearizer = Linearizer::reuse(&field, Vec::new());
            let Some((linear, _)) = linearizer.run_choosing(&inputs) else { continue };
            let inputs: Vec<Quadratic> = inputs.iter().map(Quadratic::of).collect();
            let Some(form) = linearizer.quadratic(&inputs, &mut Vec::new()) else { continue };
            known += 1;
            if name == "waves and roots" && half < 0.02 && c.iter().all(|x| x.abs() > 0.3) {
                assert!(form.rest < 0.3 * linear.rest, "{form:?} {linear:?}");
            }
            let value = |e: &[f64]| {
                let p: Vec<f64> = (0..n).map(|i| c[i] + half * e[i]).collect();
                let mut out = [f64::NAN];
                field.eval(&p, &mut out).map(|()| out[0]).ok()
            };
            let e: [f64; 3] = std::array::from_fn(|i| if i < n { random.next() } else { 0.0 });
            let [xx, yy, zz, xy, xz, yz] = form.curve;
            let rows = [
                xx * e[0] + xy * e[1] + xz * e[2],
                xy * e[0] + yy * e[1] + yz * e[2],
                xz * e[0] + yz * e[1] + zz * e[2],
            ];
            let there: f64 = (0..3).map(|i| (form.slope[i] + 0.5 * rows[i]) * e[i]).sum();
            let here = value(&e).unwrap_or_else(|| panic!("{name}: undefined in a form at {c:?}"));
            // The place itself is rounded.
            let steep =
                (0..3).map(|i| form.bend[i] + form.slope[i].abs() + rows[i].abs()).sum::<f64>() / half;
            let slack = 4.0 * f64::EPSILON * c.iter().fold(half, |m, x| m.max(x.abs())) * steep;
            let off = (here - form.middle - there).abs();
            assert!(off <= form.rest + slack, "{name}: {off} beyond {form:?} at {c:?} ± {half}");
            for i in 0..n {
                let (mut next, h) = (e, 1e-6);
                next[i] = if e[i] > 0.0 { e[i] - h } else { e[i] + h };
                let quotient = (value(&next).expect("defined") - here) / (next[i] - e[i]);
                let doubt =
                    1e-15 / h * (1.0 + here.abs()) * 8.0 + 1e-5 * (form.slope[i].abs() + rows[i].abs());
                assert!(
                    (quotient - form.slope[i] - rows[i]).abs() <= form.bend[i] + doubt,
                    "{name}: slope {quotient} beyond {form:?} at {c:?} ± {half}"
                );
            }
        }
        assert!(known > 600, "{name}: {known}");
    }
}
