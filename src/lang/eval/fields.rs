//! Components, elements and members of values.

use super::Evaluator;
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::shown;
use crate::lang::members;
use crate::lang::resolve::program::Expr;
use crate::lang::table::{Context, Outcome, Reported};
use crate::lang::value::{Value, vector};

/// The letters of components: of points, and of colours.
const LETTERS: [&str; 2] = ["xyzw", "rgba"];

impl<'p> Evaluator<'p> {
    /// `v.x`, and the like.
    #[inline]
    pub(super) fn component(&mut self, i: u8, base: &'p Expr, span: Span) -> Outcome {
        let value = self.expr(base)?;
        let component = match &value {
            Value::Vector3(v) if i < 3 => v[usize::from(i)],
            Value::Vector2(v) if i < 2 => v[usize::from(i)],
            Value::Vector4(v) => v[usize::from(i)],
            _ => {
                let name = &LETTERS[0][usize::from(i)..=usize::from(i)];
                let place = Span { start: span.end.saturating_sub(1), ..span };
                return members::field(self, &value, name, place)
                    .unwrap_or_else(|| Err(self.no_field(&value, name, place)));
            }
        };
        Ok(Value::Number(component))
    }

    pub(super) fn field(&mut self, base: &'p Expr, name: &str, name_span: Span) -> Outcome {
        let value = self.expr(base)?;
        if let Some(value) = swizzle(&value, name) {
            return Ok(value);
        }
        self.estimate = None;
        match members::field(self, &value, name, name_span) {
            Some(outcome) => outcome,
            None => Err(self.no_field(&value, name, name_span)),
        }
    }

    #[cold]
    fn no_field(&mut self, value: &Value, name: &str, span: Span) -> Reported {
        let said = members::unknown(value, name, members::Form::Field, span);
        let count = components(value).len();
        self.fail(match value {
            Value::Vector2(_) | Value::Vector3(_) | Value::Vector4(_) => {
                let letters: Vec<String> = LETTERS[0][..count].chars().map(|c| format!("`.{c}`")).collect();
                said.hint(format!("it has {}, and combinations such as `.xy`", letters.join(", ")))
            }
            Value::List(_) if matches!(name, "length" | "len" | "size" | "count") => {
                said.hint("write `len(list)`")
            }
            Value::List(_) => said.hint("elements are written `list[0]`"),
            Value::Number(_) => said.hint("only vectors have components"),
            Value::Fragment(_) => {
                said.hint("a body without `return` gives properties; `return` a value to use it")
            }
            _ => said,
        })
    }

    /// `list[i]`: negative indices count from the end.
    pub(super) fn index(&mut self, parts: &'p (Expr, Expr)) -> Outcome {
        let base = self.expr(&parts.0)?;
        let index = self.expr(&parts.1)?;
        let Value::Number(i) = index else {
            let message = format!("an index is a whole number, and this is {}", shown(&index));
            return Err(self.fail(Diagnostic::new(Code::TypeMismatch, parts.1.span, message)));
        };
        let n = match &base {
            Value::List(list) => list.len(),
            Value::Range(range) => range.len,
            Value::Vector2(_) | Value::Vector3(_) | Value::Vector4(_) => components(&base).len(),
            other => {
                let message = format!("only lists and vectors have elements, and this is {}", shown(other));
                return Err(self.fail(Diagnostic::new(Code::TypeMismatch, parts.0.span, message)));
            }
        };
        let Some(place) = place(i, n) else { return Err(self.no_element(i, n, parts.1.span)) };
        Ok(match &base {
            Value::List(list) => list[place].clone(),
            Value::Range(range) => Value::Number(range.element(place)),
            vector => Value::Number(components(vector)[place]),
        })
    }

    #[cold]
    fn no_element(&mut self, i: f64, n: usize, span: Span) -> Reported {
        let shown = crate::lang::display::number(i);
        let said = match (i == i.trunc(), n) {
            (false, _) => Diagnostic::new(
                Code::IndexOutOfRange,
                span,
                format!("an index is a whole number, and this is {shown}"),
            )
            .hint("round it: `list[floor(i)]`"),
            (true, 0) => {
                Diagnostic::new(Code::IndexOutOfRange, span, format!("index {shown} of an empty list"))
            }
            (true, _) => Diagnostic::new(
                Code::IndexOutOfRange,
                span,
                format!("index {shown} is outside a list of {n} element{}", if n == 1 { "" } else { "s" }),
            )
            .hint(format!("indices run from 0 to {}; -1 is the last", n - 1)),
        };
        self.fail(said)
    }
}

/// The place that an index means in a list of `n`; none outside, or where it is not whole.
pub fn place(i: f64, n: usize) -> Option<usize> {
    let n = n as f64;
    let from_start = if i < 0.0 { i + n } else { i };
    (i == i.trunc() && (0.0..n).contains(&from_start)).then_some(from_start as usize)
}

/// The components of a vector; nothing else has any.
pub fn components(value: &Value) -> Vec<f64> {
    match value {
        Value::Vector2(v) => v.to_array().to_vec(),
        Value::Vector3(v) => v.to_array().to_vec(),
        Value::Vector4(v) => v.to_array().to_vec(),
        _ => Vec::new(),
    }
}

/// One to four components by their letters.
pub fn swizzle(value: &Value, name: &str) -> Option<Value> {
    let components = components(value);
    let picked: Vec<f64> = letters(name, components.len())?.into_iter().map(|i| components[i]).collect();
    Some(vector(&picked))
}

/// The places that one to four letters name in a vector of `n` components.
pub fn letters(name: &str, n: usize) -> Option<Vec<usize>> {
    let of = |letters: &str| -> Option<Vec<usize>> {
        name.chars().map(|c| letters.find(c).filter(|i| *i < n)).collect()
    };
    let picked = LETTERS.iter().find_map(|letters| of(letters))?;
    (1..=4).contains(&picked.len()).then_some(picked)
}
