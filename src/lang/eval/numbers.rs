//! The fast path of arithmetic: numbers travel in registers. What is no number after all is set aside in
//! [`Evaluator::spilled`], and the general path goes on with it; nothing is evaluated twice.

use super::Evaluator;
use super::operators;
use super::plain::Plain;
use super::slots::Slot;
use crate::diag::Span;
use crate::lang::resolve::program::{Access, Arithmetic, CallBuiltin, Expr, ExprKind};
use crate::lang::table::{Builtin, BuiltinBody, Context, Outcome, Reported};
use crate::lang::value::Value;

impl<'p> Evaluator<'p> {
    /// An expression's number; none where it is another value or failed, which then is in `spilled`.
    #[inline(always)]
    pub(super) fn number(&mut self, e: &'p Expr) -> Option<f64> {
        match &e.kind {
            ExprKind::Number(x) => Some(*x),
            ExprKind::Name(access) => match self.slot_of(*access) {
                Some(Slot::Value(Value::Number(x))) => Some(*x),
                _ => self.other(e),
            },
            _ => self.number_of_compound(e),
        }
    }

    fn number_of_compound(&mut self, e: &'p Expr) -> Option<f64> {
        match &e.kind {
            ExprKind::Arithmetic(op, operands) => self.number_of_arithmetic(*op, operands, e.span),
            ExprKind::CallNumber(builtin, f, argument) => self.number_of_call(builtin, *f, argument, e.span),
            ExprKind::Negate(operand) => match self.number(operand) {
                Some(x) => Some(-x),
                None => {
                    let value = self.spilled();
                    let negated =
                        value.and_then(|v| operators::negate(&v, e.span).map_err(|said| self.fail(*said)));
                    self.spill(negated)
                }
            },
            ExprKind::Component(i, base) => match &base.kind {
                ExprKind::Name(access) => match self.slot_of(*access) {
                    Some(Slot::Value(Value::Vector3(v))) if *i < 3 => Some(v[usize::from(*i)]),
                    _ => self.other(e),
                },
                _ => self.other(e),
            },
            ExprKind::CallBuiltin(call) => match (&call.builtin.body, &call.arguments[..]) {
                (BuiltinBody::Number2(f), [(0, a), (1, b)]) => self.number_of_two(call, *f, (a, b), e.span),
                _ => self.other(e),
            },
            _ => self.other(e),
        }
    }

    #[inline]
    pub(super) fn slot_of(&self, access: Access) -> Option<&Slot> {
        match access {
            Access::Local(slot) => Some(&self.stack[self.base + slot as usize]),
            Access::Global(slot) => Some(&self.standing.globals[slot as usize]),
            Access::Captured(slot) => self.captured.as_ref().map(|c| &c[slot as usize]),
            Access::Sibling(_) => None,
        }
    }

    #[inline]
    fn number_of_arithmetic(
        &mut self,
        op: Arithmetic,
        operands: &'p (Expr, Expr),
        span: Span,
    ) -> Option<f64> {
        let Some(a) = self.number(&operands.0) else { return self.mixed_left(op, &operands.1, span) };
        let Some(b) = self.number(&operands.1) else {
            let b = self.spilled();
            return self.mixed(op, Ok(Value::Number(a)), b, span);
        };
        let result = operators::number(op, a, b);
        if result.is_finite() {
            return Some(result);
        }
        self.mixed(op, Ok(Value::Number(a)), Ok(Value::Number(b)), span)
    }

    #[inline(never)]
    fn mixed_left(&mut self, op: Arithmetic, right: &'p Expr, span: Span) -> Option<f64> {
        let a = self.spilled();
        if let Ok(Value::Vector3(u)) = a {
            return match self.plain_arithmetic(op, Plain::Vector(u), right, span) {
                Plain::Number(x) => Some(x),
                Plain::Vector(v) => self.spill(Ok(Value::Vector3(v))),
                Plain::Spilled => None,
            };
        }
        let b = self.expr(right);
        self.mixed(op, a, b, span)
    }

    /// Arithmetic on anything.
    #[inline(never)]
    pub(super) fn mixed(&mut self, op: Arithmetic, a: Outcome, b: Outcome, span: Span) -> Option<f64> {
        let joined = match (a, b) {
            (Ok(a), Ok(b)) => operators::arithmetic(op, &a, &b, span).map_err(|said| self.fail(*said)),
            (Err(reported), _) | (_, Err(reported)) => Err(reported),
        };
        self.spill(joined)
    }

    #[inline]
    fn number_of_call(
        &mut self,
        builtin: &'static Builtin,
        f: fn(f64) -> f64,
        argument: &'p Expr,
        span: Span,
    ) -> Option<f64> {
        let value = match self.number(argument) {
            Some(x) => {
                let result = f(x);
                if result.is_finite() {
                    return Some(result);
                }
                Ok(Value::Number(x))
            }
            None => self.spilled(),
        };
        let called = value.and_then(|value| self.call_table(builtin, &[value], &[argument.span], span));
        self.spill(called)
    }

    /// A call of a function of two numbers; the second argument is not evaluated where the first failed.
    #[inline]
    pub(super) fn number_of_two(
        &mut self,
        call: &'p CallBuiltin,
        f: fn(f64, f64) -> f64,
        (a, b): (&'p Expr, &'p Expr),
        span: Span,
    ) -> Option<f64> {
        let Some(x) = self.number(a) else {
            let first = self.spilled();
            return self.value_of_two(call, first, b, span);
        };
        let Some(y) = self.number(b) else {
            let second = self.spilled();
            return self.value_of_both(call, Value::Number(x), second, span);
        };
        let result = f(x, y);
        if result.is_finite() {
            return Some(result);
        }
        self.value_of_both(call, Value::Number(x), Ok(Value::Number(y)), span)
    }

    #[inline(never)]
    fn value_of_two(
        &mut self,
        call: &'p CallBuiltin,
        first: Outcome,
        b: &'p Expr,
        span: Span,
    ) -> Option<f64> {
        match first {
            Ok(first) => {
                let second = self.expr(b);
                self.value_of_both(call, first, second, span)
            }
            Err(reported) => self.spill(Err(reported)),
        }
    }

    #[inline(never)]
    fn value_of_both(
        &mut self,
        call: &'p CallBuiltin,
        first: Value,
        second: Outcome,
        span: Span,
    ) -> Option<f64> {
        let called =
            second.and_then(|second| self.call_table(call.builtin, &[first, second], &call.spans, span));
        self.spill(called)
    }

    /// An expression without a fast path.
    #[inline(never)]
    fn other(&mut self, e: &'p Expr) -> Option<f64> {
        let value = self.general(e);
        self.spill(value)
    }

    /// The number, or none with the outcome set aside.
    pub(super) fn spill(&mut self, value: Outcome) -> Option<f64> {
        if let Ok(Value::Number(x)) = value {
            return Some(x);
        }
        self.spilled = value;
        None
    }

    /// What was set aside.
    pub(super) fn spilled(&mut self) -> Outcome {
        std::mem::replace(&mut self.spilled, Err(Reported))
    }
}
