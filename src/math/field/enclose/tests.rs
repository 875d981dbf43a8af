//! Every value and every difference quotient of a function lies in what intervals say, for each rule.

use super::*;
use crate::math::elementary::*;
use crate::math::field::{FieldBuilder, Rule};
use crate::math::noise;

/// Numbers in −1 … 1.
pub(in crate::math::field) struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn of_one(f: fn(f64) -> f64, rule: Rule) -> Field {
    let mut b = FieldBuilder::new(1);
    let x = b.input(0);
    let y = b.call1(f, rule, x);
    b.finish(&[y]).unwrap()
}

fn of_two(f: fn(f64, f64) -> f64, rule: Rule) -> Field {
    let mut b = FieldBuilder::new(2);
    let (x, y) = (b.input(0), b.input(1));
    let z = b.call2(f, rule, x, y);
    b.finish(&[z]).unwrap()
}

fn of_many(n: usize, f: crate::math::field::CallN, rule: Rule, part: usize, m: usize) -> Field {
    let mut b = FieldBuilder::new(n);
    let inputs: Vec<Register> = (0..n).map(|i| b.input(i)).collect();
    let results = b.call_n(f, rule, &inputs, m);
    b.finish(&[results[part]]).unwrap()
}

fn binary(op: Binary) -> Field {
    let mut b = FieldBuilder::new(2);
    let z = b.binary(op, b.input(0), b.input(1));
    b.finish(&[z]).unwrap()
}

fn length(of: &[f64], to: &mut [f64]) {
    to[0] = of.iter().map(|x| x * x).sum::<f64>().sqrt();
}

fn unit(of: &[f64], to: &mut [f64]) {
    let mut l = [0.0];
    length(of, &mut l);
    to.iter_mut().zip(of).for_each(|(to, x)| *to = x / l[0]);
}

fn cross(of: &[f64], to: &mut [f64]) {
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        to[i] = of[j] * of[3 + k] - of[k] * of[3 + j];
    }
}

fn smooth(of: &[f64], to: &mut [f64]) {
    let t = ((of[2] - of[0]) / (of[1] - of[0])).clamp(0.0, 1.0);
    to[0] = t * t * (3.0 - 2.0 * t);
}

fn power(a: f64, b: f64) -> f64 {
    if b == b.trunc() && b.abs() <= 64.0 { powi(a, b as i32) } else { powf(a, b) }
}

fn floored(a: f64, b: f64) -> f64 {
    a - b * (a / b).floor()
}

/// Tapes by name, each with the box that its inputs come from: middle and reach.
pub(in crate::math::field) fn tapes() -> Vec<(&'static str, Field, f64, f64)> {
    let fbm: crate::math::field::CallN = |of, to| to[0] = 0.5 + 0.5 * noise::fbm(&of[..3], 4, 2.0, 0.5);
    let mut b = FieldBuilder::new(3);
    let inputs: Vec<Register> = (0..3).map(|i| b.input(i)).collect();
    let rest = [b.constant(4.0), b.constant(2.0), b.constant(0.5)];
    let all: Vec<Register> = inputs.into_iter().chain(rest).collect();
    let value = b.call_n(fbm, Rule::Fbm, &all, 1)[0];
    let fractal = b.finish(&[value]).unwrap();
    vec![
        ("sin", of_one(sin, Rule::Sin), 0.0, 8.0),
        ("cos", of_one(cos, Rule::Cos), 0.0, 8.0),
        ("tan", of_one(tan, Rule::Tan), 0.0, 1.2),
        ("asin", of_one(asin, Rule::Asin), 0.0, 0.99),
        ("acos", of_one(acos, Rule::Acos), 0.0, 0.99),
        ("atan", of_one(atan, Rule::Atan), 0.0, 5.0),
        ("sinh", of_one(sinh, Rule::Sinh), 0.0, 3.0),
        ("cosh", of_one(cosh, Rule::Cosh), 0.0, 3.0),
        ("tanh", of_one(tanh, Rule::Tanh), 0.0, 3.0),
        ("exp", of_one(exp, Rule::Exp), 0.0, 3.0),
        ("ln", of_one(ln, Rule::Ln), 3.0, 2.9),
        ("log10", of_one(log10, Rule::Log10), 3.0, 2.9),
        ("log2", of_one(log2, Rule::Log2), 3.0, 2.9),
        ("cbrt", of_one(cbrt, Rule::Cbrt), 0.0, 3.0),
        ("sign", of_one(|x| if x == 0.0 { 0.0 } else { x.signum() }, Rule::Sign), 0.0, 3.0),
        ("round", of_one(f64::round, Rule::Round), 0.0, 3.0),
        ("radians", of_one(f64::to_radians, Rule::Radians), 0.0, 3.0),
        ("power", of_two(power, Rule::Power), 2.0, 1.9),
        ("atan2", of_two(atan2, Rule::Atan2), 0.0, 3.0),
        ("mod", of_two(floored, Rule::FlooredMod), 2.0, 1.9),
        ("mix", of_many(3, |o, t| t[0] = o[0] * (1.0 - o[2]) + o[1] * o[2], Rule::Mix, 0, 1), 0.0, 2.0),
        ("clamp", of_many(3, |o, t| t[0] = o[0].max(o[1]).min(o[2]), Rule::Clamp, 0, 1), 0.0, 2.0),
        ("smoothstep", of_many(3, smooth, Rule::Smoothstep, 0, 1), 0.0, 2.0),
        ("length", of_many(3, length, Rule::Length, 0, 1), 0.0, 2.0),
        ("distance", of_many(2, |o, t| t[0] = (o[0] - o[1]).abs(), Rule::Distance, 0, 1), 0.0, 2.0),
        ("normalize", of_many(3, unit, Rule::Normalize, 1, 3), 0.0, 2.0),
        ("cross", of_many(6, cross, Rule::Cross, 2, 3), 0.0, 2.0),
        ("noise", of_many(3, |o, t| t[0] = noise::noise(o), Rule::Noise, 0, 1), 0.0, 4.0),
        ("fbm", fractal, 0.0, 4.0),
        ("+", binary(Binary::Add), 0.0, 3.0),
        ("-", binary(Binary::Sub), 0.0, 3.0),
        ("*", binary(Binary::Mul), 0.0, 3.0),
        ("/", binary(Binary::Div), 0.0, 3.0),
        ("%", binary(Binary::Rem), 0.0, 3.0),
        ("min", binary(Binary::Min), 0.0, 3.0),
        ("max", binary(Binary::Max), 0.0, 3.0),
        ("<", binary(Binary::Less), 0.0, 3.0),
        ("==", binary(Binary::Equal), 0.0, 3.0),
    ]
}

#[test]
fn values_and_slopes_lie_in_what_is_said() {
    let mut random = Random(9);
    for (name, field, middle, reach) in tapes() {
        let n = field.n_inputs();
        let mut tight = 0;
        for case in 0..3000 {
            let size = reach * power(2.0, f64::from(-(case % 12)));
            let low: Vec<f64> =
                (0..n).map(|_| middle + random.next() * (reach - size / 2.0) - size / 2.0).collect();
            let along: Vec<f64> = (0..n).map(|_| random.next()).collect();
            let inputs: Vec<Enclosed<1>> = low
                .iter()
                .zip(&along)
                .map(|(x, d)| Enclosed { value: Interval::new(*x, x + size), slope: [Interval::point(*d)] })
                .collect();
            let all = Encloser::new(&field).run(&inputs);
            let share: Vec<f64> = (0..n).map(|_| (random.next() + 1.0) / 2.0).collect();
            let p: Vec<f64> =
                low.iter().zip(&share).map(|(x, s)| (x + s * size).clamp(*x, x + size)).collect();
            let value = |p: &[f64]| {
                let mut out = [f64::NAN];
                field.eval(p, &mut out).map(|()| out[0]).ok()
            };
            let Some(here) = value(&p) else {
                assert!(all.value.gaps.are_undefined(), "{name}: undefined at {p:?}");
                continue;
            };
            assert!(all.value.contains(here), "{name}: {here} at {p:?} is not in {all:?}");
            let h = 1e-7;
            let q: Vec<f64> = p.iter().zip(&along).map(|(x, d)| x + h * d).collect();
            let inside = q.iter().zip(&low).all(|(q, x)| *x <= *q && *q <= x + size);
            if let (true, false, Some(there)) = (inside, all.value.gaps.are_there(), value(&q)) {
                let slope = (there - here) / h;
                let doubt = 1e-6 * (1.0 + slope.abs() + here.abs()) * 30.0;
                let range = all.slope[0];
                assert!(
                    range.lo - doubt <= slope && slope <= range.hi + doubt,
                    "{name}: slope {slope} at {p:?} is not in {range:?}"
                );
                tight += u32::from(range.width() < 100.0);
            }
        }
        assert!(tight > 200 || name == "==", "{name}: {tight}");
    }
}

/// |x| where it is at least y, else y²: with a jump of the tape.
fn branching() -> Field {
    let mut b = FieldBuilder::new(2);
    let (x, y) = (b.input(0), b.input(1));
    let zero = b.constant(0.0);
    let result = b.variable(zero);
    let (other, end) = (b.label(), b.label());
    let less = b.binary(Binary::Less, x, y);
    b.jump_if_not_zero(less, other);
    let size = b.unary(Unary::Abs, x);
    b.assign(result, size);
    b.jump(end);
    b.bind(other);
    let square = b.binary(Binary::Mul, y, y);
    b.assign(result, square);
    b.bind(end);
    b.finish(&[result]).unwrap()
}

#[test]
fn jumps_are_followed_both_ways_where_they_are_not_decided() {
    let field = branching();
    let of = |x: (f64, f64), y: (f64, f64)| {
        let input =
            |(lo, hi), slope| Enclosed { value: Interval::new(lo, hi), slope: [Interval::point(slope)] };
        Encloser::new(&field).run(&[input(x, 1.0), input(y, 0.0)])
    };
    let decided = of((2.0, 3.0), (0.0, 1.0));
    assert!(!decided.value.gaps.are_there() && decided.value.lo == 2.0 && decided.slope[0].lo == 1.0);
    let other = of((-3.0, -2.0), (0.0, 1.0));
    assert!(other.value.hi >= 1.0 && other.value.hi < 1.1 && other.slope[0].hi == 0.0);
    let open = of((0.0, 3.0), (1.0, 2.0));
    assert!(open.value.gaps == Gaps::JUMPS && open.value.contains(4.0) && open.value.contains(1.5));
}

/// x after so many turns of a loop, or without end where x is less than y.
fn looping(turns: f64) -> Field {
    let mut b = FieldBuilder::new(2);
    b.set_turn_limit(10_000);
    let (x, y, one) = (b.input(0), b.input(1), b.constant(1.0));
    let most = b.constant(turns);
    let count = b.variable(one);
    let turn = b.label();
    b.bind(turn);
    let next = b.binary(Binary::Add, count, one);
    b.assign(count, next);
    for again in [b.binary(Binary::Less, count, most), b.binary(Binary::Less, x, y)] {
        b.jump_if_not_zero(again, turn);
    }
    b.finish(&[x]).unwrap()
}

#[test]
fn what_ends_nowhere_is_told_from_what_ends_somewhere() {
    let is_endless = |turns: f64, y: f64| {
        let at =
            [Interval::new(0.0, 1.0), Interval::point(y)].map(|value| Enclosed::<0> { value, slope: [] });
        Encloser::new(&looping(turns)).is_endless(&at)
    };
    assert!(is_endless(1e9, 0.0) && is_endless(1.0, 2.0));
    assert!(!is_endless(1.0, 0.0), "it ends at once");
    assert!(!is_endless(9e3, 0.0), "it ends late");
    assert!(!is_endless(1.0, 0.5), "it ends in the half of it");
}

#[test]
fn a_shorter_tape_gives_the_same_bits() {
    let mut b = FieldBuilder::new(2);
    let (x, y) = (b.input(0), b.input(1));
    let (left, right) = (b.call1(sin, Rule::Sin, x), b.call1(exp, Rule::Exp, y));
    let least = b.binary(Binary::Min, left, right);
    let size = b.unary(Unary::Abs, least);
    let field = b.finish(&[size]).unwrap();
    let at =
        [Interval::new(-1.0, -0.5), Interval::new(0.0, 1.0)].map(|value| Enclosed::<0> { value, slope: [] });
    let mut encloser = Encloser::new(&field);
    encloser.run_choosing(&at);
    let choices = encloser.choices();
    let short = field.simplified(choices).expect("both choices are known");
    assert!(short.ops().len() < field.ops().len());
    for i in 0..20 {
        let p = [-0.5 - f64::from(i) / 40.0, f64::from(i) / 20.0];
        let (mut a, mut b) = ([0.0], [0.0]);
        field.eval(&p, &mut a).unwrap();
        short.eval(&p, &mut b).unwrap();
        assert_eq!(a, b);
    }
}
