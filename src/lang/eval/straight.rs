//! Arithmetic as a straight line of steps: the fastest path, for numbers alone. It says nothing and changes nothing: what has no finite
//! number here is computed again as a tree, which knows what to say.

use super::Evaluator;
use super::operators;
use super::slots::Slot;
use crate::lang::resolve::program::{Access, Arithmetic, CallFunction, Expr, ExprKind, FunctionBody};
use crate::lang::resolve::straight::{Line, Register, SOURCES, STEPS, Source, Step, Straight};
use crate::lang::value::Value;
use std::cell::Cell;

/// Of a line: its sources' first. As many as a [`Register`] can tell apart, so that none is ever out of bounds.
pub(super) type Registers = [Cell<f64>; 1 << Register::BITS];

const _: () = assert!(SOURCES + STEPS <= 1 << Register::BITS);

/// How many times a line that failed is passed over: often enough that trying costs arithmetic on vectors nothing to speak of, and seldom
/// enough that a function that takes both soon runs as a line again.
const PASSES: u8 = 100;

/// Arguments of a call without slots, at most.
const GIVEN: usize = 8;

impl<'p> Evaluator<'p> {
    /// The number of arithmetic; none where it is another value or failed, which then is in `spilled`.
    #[inline]
    pub(super) fn number_of_straight(&mut self, straight: &'p Straight) -> Option<f64> {
        match self.straight(straight) {
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
            ExprKind::Straight(straight) => self.straight(straight),
            _ => None,
        }
    }

    /// The number of a call whose function is a line of its arguments; it needs no slots. What gives none may yet give one by another way:
    /// nothing has been said or changed then.
    #[inline]
    pub(super) fn number_of_short_call(&mut self, call: &CallFunction) -> Option<f64> {
        let function = &self.program.functions[call.function.0 as usize];
        let FunctionBody::Expr(Expr { kind: ExprKind::Straight(straight), .. }) = &function.body else {
            return None;
        };
        if !matches!(call.callee, Access::Global(_)) || call.arguments.len() != function.parameters.len() {
            return None;
        }
        let mut given = [0.0; GIVEN];
        for (i, argument) in &call.arguments {
            *given.get_mut(*i as usize)? = self.number_at_once(argument)?;
        }
        let x = self.line_from(&straight.line, Some(&given))?;
        self.deeper_at_once().then_some(x)
    }

    /// The number of arithmetic, where all in it are finite and the line is not passed over.
    #[inline(always)]
    pub(super) fn straight(&self, straight: &Straight) -> Option<f64> {
        match straight.passes.get() {
            0 => self.line(straight),
            passes => {
                straight.passes.set(passes - 1);
                None
            }
        }
    }

    #[inline(never)]
    fn line(&self, straight: &Straight) -> Option<f64> {
        let number = self.line_from(&straight.line, None);
        if number.is_none() {
            straight.passes.set(PASSES);
        }
        number
    }

    /// The number at the end of a line, where all on it are finite. Locals may be numbers that were given.
    #[inline(always)]
    fn line_from(&self, line: &Line, given: Option<&[f64; GIVEN]>) -> Option<f64> {
        for (i, source) in line.sources.iter().enumerate() {
            let number = match (*source, given) {
                (Source::Name(Access::Local(slot)), Some(given)) => given.get(slot as usize).copied(),
                (Source::Component(Access::Local(_), _), Some(_)) => None,
                (source, _) => self.source(source),
            };
            self.registers[i % SOURCES].set(number?);
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
