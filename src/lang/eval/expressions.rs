//! Expressions to values.

use super::Evaluator;
use super::equal::equal;
use super::operators;
use super::slots::{Closure, Empty, Slot};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::shown;
use crate::lang::display;
use crate::lang::resolve::program::{
    Access, Arithmetic, Comparison, Comprehension, Expr, ExprKind, Range, TextPart,
};
use crate::lang::table::{Context, Outcome, Reported};
use crate::lang::value::{RangeValue, Value, vector};
use crate::math::error::gamma;
use glam::DVec3;
use std::rc::Rc;

impl<'p> Evaluator<'p> {
    /// The value of an expression.
    pub(super) fn expr(&mut self, e: &'p Expr) -> Outcome {
        match &e.kind {
            ExprKind::Number(x) => Ok(Value::Number(*x)),
            ExprKind::Name(access) => self.read(*access, e.span),
            ExprKind::Arithmetic(op, operands) => self.arithmetic(*op, operands, e.span),
            ExprKind::Compare(op, operands) => self.compare(*op, operands, e.span),
            ExprKind::CallNumber(builtin, f, argument) => self.call_number(builtin, *f, argument, e.span),
            ExprKind::CallFunction(call) => self.call_function(call, e.span),
            ExprKind::CallBuiltin(call) => self.call_builtin(call, e.span),
            ExprKind::Component(i, base) => self.component(*i, base, e.span),
            ExprKind::Constant(value) => Ok((**value).clone()),
            ExprKind::Vector(components) => self.vector(components),
            ExprKind::Index(parts) => self.index(parts),
            ExprKind::Choice(parts) => {
                let chosen = if self.condition(&parts.0)? { &parts.1 } else { &parts.2 };
                self.expr(chosen)
            }
            ExprKind::Negate(operand) => {
                let value = self.expr(operand)?;
                operators::negate(&value, e.span).map_err(|said| self.fail(said))
            }
            ExprKind::Not(operand) => Ok(Value::Bool(!self.truth(operand, "!")?)),
            ExprKind::And(parts) => {
                Ok(Value::Bool(self.truth(&parts.0, "&&")? && self.truth(&parts.1, "&&")?))
            }
            ExprKind::Or(parts) => {
                Ok(Value::Bool(self.truth(&parts.0, "||")? || self.truth(&parts.1, "||")?))
            }
            ExprKind::List(elements) => self.list(elements, e.span),
            ExprKind::Comprehension(c) => self.comprehension(c, e.span),
            ExprKind::Text(parts) => self.text(parts, e.span),
            ExprKind::Range(range) => self.range(range, e.span),
            ExprKind::CallValue(call) => self.call_value(call, e.span),
            ExprKind::CallMethod(call) => self.call_method(call),
            ExprKind::Field(parts) => self.field(&parts.0, &parts.1, parts.2),
            ExprKind::With(with) => self.with(with, e.span),
            ExprKind::Lambda(function, captures) => {
                let captured = self.capture(captures);
                Ok(Value::Function(Rc::new(Closure { function: *function, captured })))
            }
            ExprKind::Block(block) => self.block(block),
            ExprKind::Poison => Err(Reported),
        }
    }

    /// A name's value.
    #[inline]
    pub(super) fn read(&mut self, access: Access, span: Span) -> Outcome {
        let slot = match access {
            Access::Local(slot) => &self.stack[self.base + slot as usize],
            Access::Global(slot) => &self.globals[slot as usize],
            Access::Captured(slot) => match &self.captured {
                Some(captured) => &captured[slot as usize],
                None => &Slot::Unset,
            },
            Access::Sibling(function) => return Ok(self.sibling(function)),
        };
        match slot.read() {
            Ok(value) => Ok(value),
            Err(Empty::Poison) => Err(Reported),
            Err(Empty::Unset) => Err(self.unset(access, span)),
        }
    }

    #[cold]
    fn unset(&mut self, access: Access, span: Span) -> Reported {
        let said = Diagnostic::new(Code::UsedBeforeSet, span, "this name has no value yet")
            .label("used before its item has run")
            .hint("items are evaluated in order: call the function after the definitions that it uses");
        let said = match access {
            Access::Global(slot) => said.also(self.program.globals[slot as usize].1, "defined here"),
            Access::Local(_) | Access::Captured(_) | Access::Sibling(_) => said,
        };
        self.fail(said)
    }

    #[inline]
    fn arithmetic(&mut self, op: Arithmetic, operands: &'p (Expr, Expr), span: Span) -> Outcome {
        let a = self.expr(&operands.0);
        let b = self.expr(&operands.1);
        let (a, b) = (a?, b?);
        if let (&Value::Number(x), &Value::Number(y)) = (&a, &b) {
            let result = operators::number(op, x, y);
            if result.is_finite() {
                return Ok(Value::Number(result));
            }
        }
        operators::arithmetic(op, &a, &b, span).map_err(|said| self.fail(said))
    }

    #[inline]
    fn compare(&mut self, op: Comparison, operands: &'p (Expr, Expr), span: Span) -> Outcome {
        let a = self.expr(&operands.0);
        let b = self.expr(&operands.1);
        let (a, b) = (a?, b?);
        let result = match op {
            Comparison::Equal => Ok(equal(&a, &b)),
            Comparison::NotEqual => Ok(!equal(&a, &b)),
            Comparison::Less | Comparison::LessEqual | Comparison::Greater | Comparison::GreaterEqual => {
                operators::order(op, &a, &b, span)
            }
        };
        result.map(Value::Bool).map_err(|said| self.fail(said))
    }

    /// An operand of logic.
    fn truth(&mut self, operand: &'p Expr, op: &str) -> Outcome<bool> {
        match self.expr(operand)? {
            Value::Bool(b) => Ok(b),
            other => {
                let message = format!("`{op}` takes true or false, and this is {}", shown(&other));
                let said = Diagnostic::new(Code::TypeMismatch, operand.span, message);
                Err(self.fail(match other {
                    Value::Number(_) => said.hint("compare it: `… != 0`"),
                    _ => said,
                }))
            }
        }
    }

    fn vector(&mut self, components: &'p [Expr]) -> Outcome {
        if let [x, y, z] = components {
            let (x, y, z) = (self.vector_component(x), self.vector_component(y), self.vector_component(z));
            return Ok(Value::Vector3(DVec3::new(x?, y?, z?)));
        }
        let mut numbers = [0.0; 4];
        let mut outcome = Ok(());
        for (number, e) in numbers.iter_mut().zip(components) {
            match self.vector_component(e) {
                Ok(x) => *number = x,
                Err(reported) => outcome = Err(reported),
            }
        }
        outcome.map(|()| vector(&numbers[..components.len().min(4)]))
    }

    #[inline]
    fn vector_component(&mut self, e: &'p Expr) -> Outcome<f64> {
        match self.expr(e)? {
            Value::Number(x) => Ok(x),
            other => {
                let message = format!("a component is a number, and this is {}", shown(&other));
                Err(self.fail(Diagnostic::new(Code::TypeMismatch, e.span, message)))
            }
        }
    }

    fn list(&mut self, elements: &'p [Expr], span: Span) -> Outcome {
        self.reserve_list(elements.len(), span)?;
        let mut values = Vec::with_capacity(elements.len());
        let mut outcome = Ok(());
        for e in elements {
            match self.expr(e) {
                Ok(value) => values.push(value),
                Err(reported) => outcome = Err(reported),
            }
        }
        outcome.map(|()| Value::list(values))
    }

    fn comprehension(&mut self, c: &'p Comprehension, span: Span) -> Outcome {
        let list = self.expr(&c.list)?;
        let mut values = Vec::new();
        let mut outcome = Ok(());
        let mut failing = 0;
        let mut i = 0;
        while let Some(element) = self.element_of(&list, i, c.list.span)? {
            self.turn(span)?;
            i += 1;
            let slot = self.base + c.slot as usize;
            self.stack[slot] = Slot::Value(element);
            match self.comprehended(c) {
                Ok(Some(value)) => values.push(value),
                Ok(None) => {}
                Err(reported) => {
                    outcome = Err(reported);
                    failing += 1;
                }
            }
            if failing >= super::items::FAILING_TURNS {
                break;
            }
            if values.len().is_power_of_two() {
                self.reserve_list(values.len(), span)?;
            }
        }
        outcome?;
        self.reserve_list(values.len(), span)?;
        Ok(Value::list(values))
    }

    fn comprehended(&mut self, c: &'p Comprehension) -> Outcome<Option<Value>> {
        if let Some(condition) = &c.condition
            && !self.condition(condition)?
        {
            return Ok(None);
        }
        self.expr(&c.value).map(Some)
    }

    fn text(&mut self, parts: &'p [TextPart], span: Span) -> Outcome {
        let mut text = String::new();
        let mut outcome = Ok(());
        for part in parts {
            match part {
                TextPart::Literal(literal) => text.push_str(literal),
                TextPart::Value(e) => match self.expr(e) {
                    Ok(value) => text.push_str(&display::interpolated(&value)),
                    Err(reported) => outcome = Err(reported),
                },
            }
        }
        outcome?;
        self.spend(text.len() as u64, span)?;
        Ok(Value::text(&text))
    }

    fn range(&mut self, range: &'p Range, span: Span) -> Outcome {
        let start = self.range_number(&range.start, range.step.is_none());
        let end = self.range_number(&range.end, range.step.is_none());
        let step = range.step.as_ref().map_or(Ok(1.0), |step| self.range_number(step, false));
        let (start, end, step) = (start?, end?, step?);
        if step == 0.0 {
            let at = range.step.as_ref().map_or(span, |s| s.span);
            let said = Diagnostic::new(Code::Undefined, at, "a range cannot go on in steps of 0");
            return Err(self.fail(said));
        }
        let len = range_len(start, end, step, range.inclusive);
        Ok(Value::Range(Rc::new(RangeValue { start, end, step, len })))
    }

    fn range_number(&mut self, e: &'p Expr, whole: bool) -> Outcome<f64> {
        let said = match self.expr(e)? {
            Value::Number(x) if x.is_finite() && (!whole || x == x.trunc()) => return Ok(x),
            Value::Number(x) if x.is_finite() => Diagnostic::new(
                Code::TypeMismatch,
                e.span,
                format!("a range without `step` runs over whole numbers, and this is {}", display::number(x)),
            )
            .hint("round it, `floor(n)`, or give a step: `a..b step 0.5`"),
            Value::Number(_) => Diagnostic::new(Code::NotFinite, e.span, "a range cannot be infinite")
                .hint("use `while` for a loop whose end is not known"),
            other => Diagnostic::new(
                Code::TypeMismatch,
                e.span,
                format!("a range runs over numbers, and this is {}", shown(&other)),
            ),
        };
        Err(self.fail(said))
    }
}

/// How many elements a range has: those start + i·step before `end`, or up to it where it is inclusive.
/// Start, end and step as written are each off by half a unit in their last place, and so is every operation on them: a
/// quotient that near to a whole number counts as whole, so that `0..=0.3 step 0.1` reaches 0.3.
fn range_len(start: f64, end: f64, step: f64, inclusive: bool) -> usize {
    let steps = (end - start) / step;
    let near = gamma(4) * (start.abs() + end.abs()).max((end - start).abs()) / step.abs();
    let whole = steps.round();
    let n = match ((steps - whole).abs() <= near, inclusive) {
        (true, true) => whole + 1.0,
        (true, false) => whole,
        (false, true) => steps.floor() + 1.0,
        (false, false) => steps.ceil(),
    };
    n.max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use super::range_len;

    #[test]
    fn ranges_end_where_they_are_written_to_end() {
        assert_eq!(range_len(0.0, 12.0, 1.0, false), 12);
        assert_eq!(range_len(0.0, 12.0, 1.0, true), 13);
        assert_eq!(range_len(0.0, 0.3, 0.1, true), 4);
        assert_eq!(range_len(0.0, 0.3, 0.1, false), 3);
        assert_eq!(range_len(0.0, 1.0, 0.3, true), 4);
        assert_eq!(range_len(5.0, 0.0, -1.0, false), 5);
        assert_eq!(range_len(5.0, 0.0, 1.0, false), 0);
        assert_eq!(range_len(3.0, 3.0, 1.0, true), 1);
    }
}
