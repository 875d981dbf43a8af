//! Arithmetic as a straight line of steps: the fastest path, for numbers alone. It says nothing and changes nothing: what has no finite
//! number here is computed again as a tree, which knows what to say.

use super::Evaluator;
use super::operators;
use super::slots::Slot;
use crate::lang::resolve::program::{Arithmetic, Expr, ExprKind};
use crate::lang::resolve::straight::{Line, Register, SOURCES, STEPS, Source, Step, Straight};
use crate::lang::value::Value;
use std::cell::Cell;

/// Of a line: its sources' first. As many as a [`Register`] can tell apart, so that none is ever out of bounds.
pub(super) type Registers = [Cell<f64>; 1 << Register::BITS];

const _: () = assert!(SOURCES + STEPS <= 1 << Register::BITS);

impl<'p> Evaluator<'p> {
    /// The number of arithmetic; none where it is another value or failed, which then is in `spilled`.
    #[inline]
    pub(super) fn number_of_straight(&mut self, straight: &'p Straight) -> Option<f64> {
        match self.line(&straight.line) {
            Some(x) => Some(x),
            None => self.number(&straight.tree),
        }
    }

    /// The number of an expression that can be had without a word and without a change. What gives none may yet give one by another way.
    #[inline(always)]
    pub(super) fn number_at_once(&self, e: &Expr) -> Option<f64> {
        match &e.kind {
            ExprKind::Number(x) => Some(*x),
            ExprKind::Name(access) => self.source(Source::Name(*access)),
            ExprKind::Straight(straight) => self.line(&straight.line),
            _ => None,
        }
    }

    /// The number at the end of a line, where all on it are finite.
    #[inline(never)]
    pub(super) fn line(&self, line: &Line) -> Option<f64> {
        for (i, source) in line.sources.iter().enumerate() {
            self.registers[i % SOURCES].set(self.source(*source)?);
        }
        run(&line.steps, &self.registers).and_then(finite)
    }

    #[inline(always)]
    fn source(&self, source: Source) -> Option<f64> {
        match source {
            Source::Number(x) => Some(x),
            Source::Name(access) => match self.slot_of(access) {
                Some(Slot::Value(Value::Number(x))) => Some(*x),
                _ => None,
            },
            Source::Component(access, i) => match self.slot_of(access) {
                Some(Slot::Value(Value::Vector3(v))) => Some(v[usize::from(i)]),
                _ => None,
            },
        }
    }
}

/// What the last step leaves. None where a step meets what is not finite, and would make it finite again: sums and products do not.
#[inline(always)]
fn run(steps: &[Step], registers: &Registers) -> Option<f64> {
    let mut value = f64::NAN;
    for (step, i) in steps.iter().zip(SOURCES as Register..) {
        let get = |register: Register| registers[usize::from(register)].get();
        value = match *step {
            Step::Add(a, b) => get(a) + get(b),
            Step::Subtract(a, b) => get(a) - get(b),
            Step::Multiply(a, b) => get(a) * get(b),
            Step::Divide(a, b) => get(a) / finite(get(b))?,
            Step::AddNumber(a, x) => get(a) + x,
            Step::MultiplyNumber(a, x) => get(a) * x,
            Step::Remainder(a, b) => {
                operators::number(Arithmetic::Remainder, finite(get(a))?, finite(get(b))?)
            }
            Step::Power(a, b) => operators::number(Arithmetic::Power, finite(get(a))?, finite(get(b))?),
            Step::Negate(a) => -get(a),
            Step::Call(f, a) => f(finite(get(a))?),
            Step::CallTwo(f, a, b) => f(finite(get(a))?, finite(get(b))?),
        };
        registers[usize::from(i)].set(value);
    }
    Some(value)
}

#[inline(always)]
fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}
