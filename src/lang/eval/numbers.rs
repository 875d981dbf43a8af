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
            ExprKind::Straight(straight) => self.number_of_straight(straight),
            _ => self.number_of_compound(e),
        }
    }

    /// Leaps to what knows the expression: each is kept apart, so that none pays for the frame of another.
    #[inline]
    fn number_of_compound(&mut self, e: &'p Expr) -> Option<f64> {
        match &e.kind {
            ExprKind::Arithmetic(op, operands) => self.number_of_arithmetic(e, *op, operands),
            ExprKind::CallNumber(builtin, f, argument) => self.number_of_call(e, builtin, *f, argument),
            ExprKind::CallBuiltin(call) => self.number_of_builtin(e, call),
            ExprKind::CallFunction(call) => self.number_of_function(call, e.span),
            ExprKind::Negate(operand) => self.number_of_negated(e, operand),
            ExprKind::Component(i, base) => self.number_of_component(e, *i, base),
            _ => self.other(e),
        }
    }

    #[inline(never)]
    fn number_of_negated(&mut self, e: &'p Expr, operand: &'p Expr) -> Option<f64> {
        if let Some(x) = self.number(operand) {
            return Some(-x);
        }
        let value = self.spilled();
        let negated = value.and_then(|v| operators::negate(&v, e.span).map_err(|said| self.fail(*said)));
        self.spill(negated)
    }

    #[inline(never)]
    fn number_of_component(&mut self, e: &'p Expr, i: u8, base: &'p Expr) -> Option<f64> {
        if let ExprKind::Name(access) = &base.kind
            && let Some(Slot::Value(Value::Vector3(v))) = self.slot_of(*access)
            && i < 3
        {
            return Some(v[usize::from(i)]);
        }
        self.other(e)
    }

    #[inline(never)]
    fn number_of_builtin(&mut self, e: &'p Expr, call: &'p CallBuiltin) -> Option<f64> {
        match (&call.builtin.body, &call.arguments[..]) {
            (BuiltinBody::Number2(f), [(0, a), (1, b)]) => self.number_of_two(call, *f, (a, b), e.span),
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

    #[inline(never)]
    fn number_of_arithmetic(
        &mut self,
        e: &'p Expr,
        op: Arithmetic,
        operands: &'p (Expr, Expr),
    ) -> Option<f64> {
        let Some(a) = self.number(&operands.0) else { return self.mixed_left(op, &operands.1, e.span) };
        let Some(b) = self.number(&operands.1) else { return self.mixed_right(op, a, e.span) };
        let result = operators::number(op, a, b);
        if result.is_finite() {
            return Some(result);
        }
        self.mixed_numbers(op, a, b, e.span)
    }

    #[inline(never)]
    fn mixed_right(&mut self, op: Arithmetic, a: f64, span: Span) -> Option<f64> {
        let b = self.spilled();
        self.mixed(op, Ok(Value::Number(a)), b, span)
    }

    #[cold]
    #[inline(never)]
    fn mixed_numbers(&mut self, op: Arithmetic, a: f64, b: f64, span: Span) -> Option<f64> {
        self.mixed(op, Ok(Value::Number(a)), Ok(Value::Number(b)), span)
    }

    #[inline(never)]
    fn mixed_left(&mut self, op: Arithmetic, right: &'p Expr, span: Span) -> Option<f64> {
        let a = self.spilled();
        if let Ok(Value::Vector3(u)) = a {
            return match self.plain_beside(op, u, right, span) {
                Plain::Number(x) => Some(x),
                Plain::Vector => self.spill(Ok(Value::Vector3(self.vector))),
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

    #[inline(never)]
    fn number_of_call(
        &mut self,
        e: &'p Expr,
        builtin: &'static Builtin,
        f: fn(f64) -> f64,
        argument: &'p Expr,
    ) -> Option<f64> {
        let given = self.number(argument);
        if let Some(result) = given.map(f)
            && result.is_finite()
        {
            return Some(result);
        }
        self.value_of_call(e, builtin, given, argument)
    }

    #[inline(never)]
    fn value_of_call(
        &mut self,
        e: &'p Expr,
        builtin: &'static Builtin,
        given: Option<f64>,
        argument: &'p Expr,
    ) -> Option<f64> {
        let value = given.map_or_else(|| self.spilled(), |x| Ok(Value::Number(x)));
        let called = value.and_then(|value| self.call_table(builtin, &[value], &[argument.span], e.span));
        self.spill(called)
    }

    /// A call of a function of two numbers; the second argument is not evaluated where the first failed.
    #[inline(always)]
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

    /// A number, or what was set aside in its place.
    #[inline]
    pub(super) fn outcome(&mut self, number: Option<f64>) -> Outcome {
        match number {
            Some(x) => Ok(Value::Number(x)),
            None => self.spilled(),
        }
    }

    /// What was set aside.
    pub(super) fn spilled(&mut self) -> Outcome {
        std::mem::replace(&mut self.spilled, Err(Reported))
    }
}
