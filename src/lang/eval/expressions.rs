//! Expressions to values.

use super::Evaluator;
use super::equal::equal_in;
use super::operators;
use super::slots::{Closure, Empty, Slot};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::shown;
use crate::lang::display;
use crate::lang::resolve::program::{Access, Comparison, Comprehension, Expr, ExprKind, Range, TextPart};
use crate::lang::table::{Context, Outcome, Reported};
use crate::lang::value::{RangeValue, Value, vector};
use glam::DVec3;
use std::rc::Rc;

impl<'p> Evaluator<'p> {
    /// The value of an expression.
    #[inline]
    pub(super) fn expr(&mut self, e: &'p Expr) -> Outcome {
        match &e.kind {
            ExprKind::Number(x) => Ok(Value::Number(*x)),
            ExprKind::Name(access) => match self.slot_of(*access) {
                Some(Slot::Value(Value::Number(x))) => Ok(Value::Number(*x)),
                _ => self.read(*access, e.span),
            },
            ExprKind::Straight(_)
            | ExprKind::Arithmetic(..)
            | ExprKind::CallNumber(..)
            | ExprKind::CallFunction(_)
            | ExprKind::Negate(_) => {
                let number = self.number(e);
                self.outcome(number)
            }
            _ => self.general(e),
        }
    }

    /// The value of an expression that [`Evaluator::number`] has no fast path for.
    pub(super) fn general(&mut self, e: &'p Expr) -> Outcome {
        match &e.kind {
            ExprKind::Compare(op, operands) => self.compare(*op, operands, e.span),
            ExprKind::Number(_)
            | ExprKind::Name(_)
            | ExprKind::Straight(_)
            | ExprKind::Arithmetic(..)
            | ExprKind::CallNumber(..)
            | ExprKind::CallFunction(_)
            | ExprKind::Negate(_) => self.expr(e),
            ExprKind::CallBuiltin(call) => self.call_builtin(call, e.span),
            ExprKind::Component(i, base) => self.component(*i, base, e.span),
            ExprKind::Constant(value) => Ok((**value).clone()),
            ExprKind::Vector(components) => self.vector(components),
            ExprKind::Index(parts) => self.index(parts),
            ExprKind::Choice(parts) => {
                let chosen = if self.condition(&parts.0)? { &parts.1 } else { &parts.2 };
                self.expr(chosen)
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
            ExprKind::CallMethod(call) => self.call_method(call, e.span),
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
    #[inline(never)]
    pub(super) fn read(&mut self, access: Access, span: Span) -> Outcome {
        let slot = match access {
            Access::Local(slot) => &self.stack[self.base + slot as usize],
            Access::Global(slot) => &self.standing.globals[slot as usize],
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
        let name = match access {
            Access::Global(slot) => format!("`{}`", self.program.globals[slot as usize].0),
            Access::Local(_) | Access::Captured(_) | Access::Sibling(_) => "this name".into(),
        };
        let said = Diagnostic::new(Code::UsedBeforeSet, span, format!("{name} has no value yet"))
            .label("used before its item has run")
            .hint("items are evaluated in order: call the function after the definitions that it uses");
        let said = match access {
            Access::Global(slot) => said.also(self.program.globals[slot as usize].1, "defined here"),
            Access::Local(_) | Access::Captured(_) | Access::Sibling(_) => said,
        };
        self.fail(said)
    }

    #[inline]
    fn compare(&mut self, op: Comparison, operands: &'p (Expr, Expr), span: Span) -> Outcome {
        let x = self.number(&operands.0);
        let a = self.outcome(x);
        let y = self.number(&operands.1);
        let b = self.outcome(y);
        let (a, b) = (a?, b?);
        if let (&Value::Number(x), &Value::Number(y)) = (&a, &b) {
            return Ok(Value::Bool(operators::compare(op, x, y)));
        }
        let result = match op {
            Comparison::Equal => Ok(self.equal(&a, &b, span)?),
            Comparison::NotEqual => Ok(!self.equal(&a, &b, span)?),
            Comparison::Less | Comparison::LessEqual | Comparison::Greater | Comparison::GreaterEqual => {
                operators::order(op, &a, &b, span)
            }
        };
        result.map(Value::Bool).map_err(|said| self.fail(*said))
    }

    fn equal(&mut self, a: &Value, b: &Value, span: Span) -> Outcome<bool> {
        let (same, pairs) = equal_in(a, b);
        self.turns(pairs - 1, span)?;
        Ok(same)
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
        match self.number(e) {
            Some(x) => Ok(x),
            None => Err(self.not_a_component(e.span)),
        }
    }

    #[cold]
    fn not_a_component(&mut self, span: Span) -> Reported {
        match self.spilled() {
            Ok(other) => {
                let message = format!("a component is a number, and this is {}", shown(&other));
                self.fail(Diagnostic::new(Code::TypeMismatch, span, message))
            }
            Err(reported) => reported,
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
                Ok(Some(_)) if values.len() >= self.run.limits.list => {
                    return Err(self.list_too_long(values.len() + 1, span));
                }
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
                    Ok(value) => {
                        self.check_shown(&value, span)?;
                        text.push_str(&display::interpolated(&value));
                        self.reserve_text(text.len(), span)?;
                    }
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
        match RangeValue::new(start, end, step, range.inclusive) {
            Some(range) => Ok(Value::Range(Rc::new(range))),
            None => {
                let at = range.step.as_ref().map_or(span, |s| s.span);
                Err(self.fail(Diagnostic::new(Code::Undefined, at, "a range cannot go on in steps of 0")))
            }
        }
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
