//! Running a tape on quadratic forms, after it was run on linear ones.

use super::super::quadratic::{Expansion, Quadratic};
use super::super::{Binary, Choice, Field, Op, Register, Rule, Unary};
use super::Linearizer;
use crate::math::elementary::sin_cos;

impl Linearizer<'_, 3> {
    /// The first output's quadratic form over the box that [`Linearizer::run_choosing`] was last given: steps without a rule for those are taken
    /// from their linear forms.
    pub fn quadratic(&self, inputs: &[Quadratic], memory: &mut Vec<Quadratic>) -> Option<Quadratic> {
        memory.clear();
        memory.extend(self.field.initial.iter().map(|&x| Quadratic::constant(x)));
        memory[..inputs.len()].copy_from_slice(inputs);
        for (at, op) in self.field.ops.iter().enumerate() {
            self.bow(op, self.choices[at], memory);
        }
        Some(memory[self.field.outputs[0].index()]).filter(Quadratic::is_finite)
    }

    fn bow(&self, op: &Op, choice: Choice, forms: &mut [Quadratic]) {
        let get = |register: Register| forms[register.index()];
        let (to, known) = match *op {
            Op::Unary(op, to, a) => (to, unary(op, choice, &get(a))),
            Op::Binary(op, to, a, b) => (to, binary(op, choice, &get(a), &get(b))),
            Op::Call1(_, rule @ (Rule::Sin | Rule::Cos), to, a) => (to, Some(wave(rule, &get(a)))),
            Op::CallN { rule: Rule::Length, from, n_from, to, .. } => {
                let squares = (0..n_from as usize).map(|i| forms[from.index() + i]).map(|x| x.mul(&x));
                (to, squares.reduce(|a, b| a.add(&b)).and_then(|sum| root(&sum)))
            }
            Op::Call1(_, _, to, _) | Op::Call2(_, _, to, ..) | Op::Select(to, ..) => (to, None),
            Op::CallN { to, n_to, .. } => {
                for i in to.index()..to.index() + n_to as usize {
                    forms[i] = Quadratic::of(&self.forms[i]);
                }
                return;
            }
            Op::CheckFinite(_) | Op::Fault(_) | Op::CallHeld { .. } | Op::Table(..) | Op::Gather { .. } => {
                return;
            }
            Op::Jump(_) | Op::JumpIfZero(..) | Op::JumpIfNotZero(..) => return,
        };
        forms[to.index()] = known.unwrap_or_else(|| Quadratic::of(&self.forms[to.index()]));
    }
}

impl Field {
    /// Whether quadratic forms say more of it than linear ones: not where a function is called that has a rule for these alone.
    pub fn is_bowed(&self) -> bool {
        let is_known = |op: &Op| match op {
            Op::Unary(..) | Op::CheckFinite(_) => true,
            Op::Binary(op, ..) => !matches!(op, Binary::Div | Binary::Rem | Binary::Pow),
            Op::Call1(_, rule, ..) | Op::CallN { rule, .. } => {
                matches!(rule, Rule::Sin | Rule::Cos | Rule::Length)
            }
            _ => false,
        };
        self.ops.iter().all(is_known)
    }
}

fn unary(op: Unary, choice: Choice, a: &Quadratic) -> Option<Quadratic> {
    match (op, choice) {
        (Unary::Copy, _) | (Unary::Abs, Choice::First) => Some(*a),
        (Unary::Neg, _) | (Unary::Abs, Choice::Second) => Some(a.neg()),
        (Unary::Sqrt, _) => root(a),
        _ => None,
    }
}

fn binary(op: Binary, choice: Choice, a: &Quadratic, b: &Quadratic) -> Option<Quadratic> {
    match (op, choice) {
        (Binary::Add, _) => Some(a.add(b)),
        (Binary::Sub, _) => Some(a.add(&b.neg())),
        (Binary::Mul, _) => Some(a.mul(b)),
        (Binary::Min | Binary::Max, Choice::First) => Some(*a),
        (Binary::Min | Binary::Max, Choice::Second) => Some(*b),
        _ => None,
    }
}

fn wave(rule: Rule, a: &Quadratic) -> Quadratic {
    let (s, c) = sin_cos(a.middle);
    let (value, first) = if rule == Rule::Sin { (s, c) } else { (c, -s) };
    let third = (first.abs() + a.reach() + 4.0 * f64::EPSILON).min(1.0);
    a.expanded(Expansion { value, first, second: -value, third })
}

/// √x, where it is above 0.
fn root(a: &Quadratic) -> Option<Quadratic> {
    let low = (a.middle - a.reach()) * (1.0 - 64.0 * f64::EPSILON) - a.middle * 64.0 * f64::EPSILON;
    (low > 0.0).then(|| {
        let value = a.middle.sqrt();
        let first = 0.5 / value;
        a.expanded(Expansion {
            value,
            first,
            second: -0.5 * first / a.middle,
            third: 0.375 / (low * low * low.sqrt()),
        })
    })
}
