use super::*;
use crate::math::elementary::{cos, ln, sin};

fn value(field: &Field, inputs: &[f64]) -> Result<f64, Fault> {
    let mut out = [f64::NAN];
    field.eval(inputs, &mut out).map(|()| out[0])
}

#[test]
fn a_step_stays_small() {
    assert!(size_of::<Op>() <= 16);
}

#[test]
fn arithmetic_is_that_of_f64() {
    let mut b = FieldBuilder::new(2);
    let (x, y) = (b.input(0), b.input(1));
    let three = b.constant(3.0);
    let product = b.binary(Binary::Mul, x, three);
    let sum = b.binary(Binary::Add, product, y);
    let sine = b.call1(sin, Rule::Sin, sum);
    let field = b.finish(&[sine, x]).unwrap();
    let mut out = [0.0; 2];
    field.eval(&[0.3, -0.1], &mut out).unwrap();
    assert_eq!(out, [sin(0.3 * 3.0 + -0.1), 0.3]);
}

#[test]
fn a_fault_names_the_site_of_its_operation() {
    let mut b = FieldBuilder::new(1);
    let one = b.constant(1.0);
    b.site(7);
    let quotient = b.binary(Binary::Div, one, b.input(0));
    b.site(9);
    let log = b.call1(ln, Rule::Ln, quotient);
    let field = b.finish(&[log]).unwrap();
    assert_eq!(value(&field, &[1.0]), Ok(0.0));
    assert_eq!(value(&field, &[0.0]), Err(Fault { site: 7, kind: FaultKind::DivisionByZero }));
    assert_eq!(value(&field, &[-1.0]), Err(Fault { site: 9, kind: FaultKind::Undefined }));
    assert_eq!(value(&field, &[1e-320]), Err(Fault { site: 7, kind: FaultKind::NotFinite }));
}

#[test]
fn infinity_may_be_compared_with_but_not_given_back() {
    let mut b = FieldBuilder::new(1);
    let inf = b.constant(f64::INFINITY);
    let least = b.binary(Binary::Min, inf, b.input(0));
    let field = b.finish(&[least]).unwrap();
    assert_eq!(value(&field, &[4.0]), Ok(4.0));
    let mut b = FieldBuilder::new(0);
    let inf = b.constant(f64::INFINITY);
    let field = b.finish(&[inf]).unwrap();
    assert_eq!(value(&field, &[]).unwrap_err().kind, FaultKind::NotFinite);
}

#[test]
fn made_ready_a_tape_gives_the_bits_and_the_faults_of_its_steps() {
    let mut b = FieldBuilder::new(3);
    let [x, y, z] = [0, 1, 2].map(|i| b.input(i));
    b.site(1);
    // Cosine before sine, one of them alone, and both of two numbers.
    let (c, lone, s) = (b.call1(cos, Rule::Cos, x), b.call1(sin, Rule::Sin, y), b.call1(sin, Rule::Sin, x));
    let (t, u) = (b.call1(sin, Rule::Sin, z), b.call1(cos, Rule::Cos, z));
    b.site(2);
    let root = b.unary(Unary::Sqrt, y);
    b.site(3);
    let quotient = b.binary(Binary::Div, c, z);
    // Hidden behind a maximum and a divisor, an infinity is a fault all the same.
    let hidden = b.binary(Binary::Max, quotient, s);
    b.site(4);
    let below = b.binary(Binary::Div, lone, hidden);
    let floor = b.unary(Unary::Floor, below);
    let least = b.binary(Binary::Min, floor, u);
    let sum = [root, t, least].into_iter().reduce(|a, x| b.binary(Binary::Sub, a, x)).unwrap();
    let field = b.finish(&[sum, s, c]).unwrap();
    assert!(field.straight.is_some());
    let slow = Field { straight: None, ..field.clone() };
    let mut random = crate::math::random::Random::new(7);
    let mut faults = 0;
    for case in 0..20_000 {
        let mut input = || match random.below(12) {
            0 => 0.0,
            1 => 1e-320 * random.sign(),
            2 => random.between(-1e-8, 1e-8),
            3 => random.between(-1e9, 1e9),
            _ => random.between(-1.0, 9.0),
        };
        let inputs = [input(), input(), input()];
        let run = |field: &Field| {
            let mut out = [7.0; 3];
            let result = field.eval(&inputs, &mut out);
            (result, out.map(f64::to_bits))
        };
        assert_eq!(run(&field), run(&slow), "case {case}: {inputs:?}");
        faults += u32::from(run(&field).0.is_err());
    }
    assert!(faults > 1000, "{faults}");
}

#[test]
fn sine_and_cosine_have_the_same_bits_together_and_alone() {
    let mut random = crate::math::random::Random::new(3);
    for exponent in -40..40 {
        for _ in 0..2000 {
            let x = random.between(-2.0, 2.0) * 2f64.powi(exponent);
            let (s, c) = crate::math::elementary::sin_cos(x);
            assert_eq!((s.to_bits(), c.to_bits()), (sin(x).to_bits(), cos(x).to_bits()), "{x:e}");
        }
    }
}

/// Σ i for i in 0..n, as a loop.
fn sum_below() -> Field {
    let mut b = FieldBuilder::new(1);
    let (zero, one) = (b.constant(0.0), b.constant(1.0));
    let (i, sum) = (b.variable(zero), b.variable(zero));
    let (top, end) = (b.label(), b.label());
    b.bind(top);
    let more = b.binary(Binary::Less, i, b.input(0));
    b.jump_if_zero(more, end);
    let next = b.binary(Binary::Add, sum, i);
    b.assign(sum, next);
    let next = b.binary(Binary::Add, i, one);
    b.assign(i, next);
    b.jump(top);
    b.bind(end);
    b.finish(&[sum]).unwrap()
}

#[test]
fn loops_run_and_endless_ones_are_stopped() {
    let field = sum_below();
    assert_eq!(value(&field, &[101.0]), Ok(5050.0));
    assert_eq!(value(&field, &[0.0]), Ok(0.0));
    assert_eq!(value(&field, &[f64::MAX]).unwrap_err().kind, FaultKind::TooManyTurns);
}

#[test]
fn a_branch_guards_what_it_does_not_take() {
    let mut b = FieldBuilder::new(1);
    let (zero, one) = (b.constant(0.0), b.constant(1.0));
    let result = b.variable(zero);
    let end = b.label();
    b.jump_if_zero(b.input(0), end);
    let quotient = b.binary(Binary::Div, one, b.input(0));
    b.assign(result, quotient);
    b.bind(end);
    let field = b.finish(&[result]).unwrap();
    assert_eq!(value(&field, &[4.0]), Ok(0.25));
    assert_eq!(value(&field, &[0.0]), Ok(0.0));
}

#[test]
fn lists_are_bounds_checked_and_count_from_the_end() {
    let mut b = FieldBuilder::new(1);
    let table = b.add_table([2.0, 3.0, 5.0]);
    let index = b.input(0);
    let from_table = b.table(table, index);
    let list = [b.constant(7.0), index, b.constant(11.0)];
    let gathered = b.gather(&list, index);
    let field = b.finish(&[from_table, gathered]).unwrap();
    let at = |i: f64| {
        let mut out = [0.0; 2];
        field.eval(&[i], &mut out).map(|()| out)
    };
    assert_eq!(at(0.0), Ok([2.0, 7.0]));
    assert_eq!(at(1.0), Ok([3.0, 1.0]));
    assert_eq!(at(-1.0), Ok([5.0, 11.0]));
    for outside in [3.0, -4.0, 0.5, f64::NAN] {
        assert_eq!(at(outside).unwrap_err().kind, FaultKind::IndexOutOfRange);
    }
}

#[test]
fn calls_of_many_arguments_read_and_write_in_order() {
    fn swap_and_scale(from: &[f64], to: &mut [f64]) {
        (to[0], to[1]) = (from[2] * from[1], from[2] * from[0]);
    }
    let mut b = FieldBuilder::new(2);
    let ten = b.constant(10.0);
    let arguments = [b.input(0), b.input(1), ten];
    let results = b.call_n(swap_and_scale, Rule::Opaque, &arguments, 2);
    let field = b.finish(&results).unwrap();
    let mut out = [0.0; 2];
    field.eval(&[1.0, 2.0], &mut out).unwrap();
    assert_eq!(out, [20.0, 10.0]);
}

#[test]
fn a_tape_larger_than_the_stack_buffer_gives_the_same() {
    let mut b = FieldBuilder::new(1);
    let mut sum = b.input(0);
    for _ in 0..10 * SMALL {
        sum = b.binary(Binary::Add, sum, b.input(0));
    }
    let field = b.finish(&[sum]).unwrap();
    assert!(field.n_registers() > SMALL);
    assert_eq!(value(&field, &[0.5]), Ok(0.5 * (10 * SMALL + 1) as f64));
}

#[test]
fn a_function_too_large_to_number_is_refused() {
    let mut b = FieldBuilder::new(1);
    let mut sum = b.input(0);
    for _ in 0..70_000 {
        sum = b.binary(Binary::Add, sum, sum);
    }
    assert_eq!(b.finish(&[sum]).unwrap_err(), TooLarge);
}
