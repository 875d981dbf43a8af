//! Operators on values, one table: what is on the left and right decides.

use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::shown;
use crate::lang::display::abbreviated;
use crate::lang::resolve::program::{Arithmetic, Comparison};
use crate::lang::value::Value;
use crate::math::{elementary, exact};
use glam::{DVec2, DVec3, DVec4};
use std::rc::Rc;

/// What is wrong with operands; boxed, because it is rare and large.
type Fault = Box<Diagnostic>;

/// Whole exponents up to this size are repeated products, which are exact while the result fits 53 bits; others go to `pow`.
pub const WHOLE_POWER: f64 = 64.0;

/// One operation on two numbers. May be infinite or NaN.
#[inline]
pub fn number(op: Arithmetic, a: f64, b: f64) -> f64 {
    match op {
        Arithmetic::Add => a + b,
        Arithmetic::Subtract => a - b,
        Arithmetic::Multiply => a * b,
        Arithmetic::Divide => a / b,
        Arithmetic::Remainder => exact::remainder(a, b),
        Arithmetic::Power => power(a, b),
    }
}

/// One operation on two vectors, component by component. May be infinite or NaN.
#[inline(always)]
pub fn vector3(op: Arithmetic, u: DVec3, v: DVec3) -> DVec3 {
    match op {
        Arithmetic::Add => u + v,
        Arithmetic::Subtract => u - v,
        Arithmetic::Multiply => u * v,
        Arithmetic::Divide => u / v,
        Arithmetic::Remainder | Arithmetic::Power => vector3_by_numbers(op, u, v),
    }
}

#[inline(never)]
fn vector3_by_numbers(op: Arithmetic, u: DVec3, v: DVec3) -> DVec3 {
    zip3(u, v, |x, y| number(op, x, y))
}

/// aᵇ: by repeated products where b is a small whole number.
pub fn power(a: f64, b: f64) -> f64 {
    if b == b.trunc() && b.abs() <= WHOLE_POWER {
        elementary::powi(a, b as i32)
    } else {
        elementary::powf(a, b)
    }
}

/// `a op b` on numbers and vectors: component by component, a number beside a vector stands for every component.
/// The error says what is wrong; the caller adds nothing.
pub fn arithmetic(op: Arithmetic, a: &Value, b: &Value, span: Span) -> Result<Value, Fault> {
    let f = |x, y| number(op, x, y);
    let value = match (a, b) {
        (Value::Number(x), Value::Number(y)) => Value::Number(f(*x, *y)),
        (Value::Vector3(u), Value::Vector3(v)) => Value::Vector3(vector3(op, *u, *v)),
        (Value::Vector3(u), Value::Number(y)) => Value::Vector3(vector3(op, *u, DVec3::splat(*y))),
        (Value::Number(x), Value::Vector3(v)) => Value::Vector3(vector3(op, DVec3::splat(*x), *v)),
        (Value::Vector2(u), Value::Vector2(v)) => Value::Vector2(zip2(*u, *v, f)),
        (Value::Vector2(u), Value::Number(y)) => Value::Vector2(zip2(*u, DVec2::splat(*y), f)),
        (Value::Number(x), Value::Vector2(v)) => Value::Vector2(zip2(DVec2::splat(*x), *v, f)),
        (Value::Vector4(u), Value::Vector4(v)) => zip4(**u, **v, f),
        (Value::Vector4(u), Value::Number(y)) => zip4(**u, DVec4::splat(*y), f),
        (Value::Number(x), Value::Vector4(v)) => zip4(DVec4::splat(*x), **v, f),
        _ => return Err(Box::new(mismatch(op, a, b, span))),
    };
    if sound(&value) || (!is_nan(&value) && (infinite(a) || infinite(b))) {
        return Ok(value);
    }
    Err(Box::new(no_value(op, (a, b), is_nan(&value), span)))
}

fn zip2(u: DVec2, v: DVec2, f: impl Fn(f64, f64) -> f64) -> DVec2 {
    DVec2::new(f(u.x, v.x), f(u.y, v.y))
}

fn zip3(u: DVec3, v: DVec3, f: impl Fn(f64, f64) -> f64) -> DVec3 {
    DVec3::new(f(u.x, v.x), f(u.y, v.y), f(u.z, v.z))
}

fn zip4(u: DVec4, v: DVec4, f: impl Fn(f64, f64) -> f64) -> Value {
    Value::Vector4(Rc::new(DVec4::new(f(u.x, v.x), f(u.y, v.y), f(u.z, v.z), f(u.w, v.w))))
}

fn sound(value: &Value) -> bool {
    match value {
        Value::Number(x) => x.is_finite(),
        Value::Vector2(v) => v.is_finite(),
        Value::Vector3(v) => v.is_finite(),
        Value::Vector4(v) => v.is_finite(),
        _ => true,
    }
}

fn is_nan(value: &Value) -> bool {
    match value {
        Value::Number(x) => x.is_nan(),
        Value::Vector2(v) => v.is_nan(),
        Value::Vector3(v) => v.is_nan(),
        Value::Vector4(v) => v.is_nan(),
        _ => false,
    }
}

fn infinite(value: &Value) -> bool {
    !sound(value) && !is_nan(value)
}

/// Whether a value is 0 or has a component that is.
fn has_zero(value: &Value) -> bool {
    match value {
        Value::Number(x) => *x == 0.0,
        Value::Vector2(v) => v.cmpeq(DVec2::ZERO).any(),
        Value::Vector3(v) => v.cmpeq(DVec3::ZERO).any(),
        Value::Vector4(v) => v.cmpeq(DVec4::ZERO).any(),
        _ => false,
    }
}

/// About how many characters of an operand are shown.
const OPERAND: usize = 48;

/// What to say where a result is not finite.
fn no_value(op: Arithmetic, (a, b): (&Value, &Value), is_nan: bool, span: Span) -> Diagnostic {
    let written = format!("{} {} {}", abbreviated(a, OPERAND), op.text(), abbreviated(b, OPERAND));
    let divides = matches!(op, Arithmetic::Divide | Arithmetic::Remainder);
    if divides && has_zero(b) {
        return Diagnostic::new(Code::DivisionByZero, span, format!("`{written}` divides by 0"))
            .label("has no finite value")
            .hint("guard it: `d == 0 ? 0 : n / d`, or keep the divisor away from 0 with `max(d, 1e-9)`");
    }
    if infinite(a) || infinite(b) {
        return Diagnostic::new(Code::NotFinite, span, format!("`{written}` has no value"))
            .label("not a number")
            .hint("`inf` is there to compare with: keep it out of arithmetic, as with `min(x, 1e9)`");
    }
    match op {
        Arithmetic::Power if has_zero(a) => {
            Diagnostic::new(Code::DivisionByZero, span, format!("`{written}` divides by 0"))
                .label("a negative power of 0")
        }
        Arithmetic::Power if is_nan => {
            Diagnostic::new(Code::Undefined, span, format!("`{written}` has no real value"))
                .label("not a finite number")
                .hint("a negative number has only whole powers; `abs(x)^p` is defined everywhere")
        }
        Arithmetic::Add
        | Arithmetic::Subtract
        | Arithmetic::Multiply
        | Arithmetic::Divide
        | Arithmetic::Remainder
        | Arithmetic::Power => {
            Diagnostic::new(Code::NotFinite, span, format!("`{written}` has no finite value"))
                .label("beyond the range of numbers")
                .hint("f64 ends near 1.8e308; is an operand larger than it was meant to be?")
        }
    }
}

fn mismatch(op: Arithmetic, a: &Value, b: &Value, span: Span) -> Diagnostic {
    let message = format!("`{}` cannot join {} and {}", op.text(), shown(a), shown(b));
    let said = Diagnostic::new(Code::TypeMismatch, span, message);
    match (op, a, b) {
        (Arithmetic::Add, Value::Text(_), _) | (Arithmetic::Add, _, Value::Text(_)) => {
            said.hint("texts are joined by interpolation: `\"{a}{b}\"`")
        }
        (Arithmetic::Add, Value::List(_), Value::List(_)) => said
            .hint("lists are not added; write the elements in one: `[for …]` over both, or `map` and `zip`"),
        (_, Value::List(_), _) | (_, _, Value::List(_)) => {
            said.hint("apply it to each element: `[e * 2 for e in list]`")
        }
        (
            _,
            Value::Vector2(_) | Value::Vector3(_) | Value::Vector4(_),
            Value::Vector2(_) | Value::Vector3(_) | Value::Vector4(_),
        ) => said.hint("both vectors must have as many components; `v.xy` takes two of them"),
        (_, Value::Function(_), _) | (_, _, Value::Function(_)) => said.hint("call the function: `f(x)`"),
        (Arithmetic::Multiply, Value::Transform(_), _) | (Arithmetic::Multiply, _, Value::Transform(_)) => {
            said.hint("a transform is applied by `matrix`, inside an object's braces")
        }
        _ => said,
    }
}

/// `-a`.
pub fn negate(a: &Value, span: Span) -> Result<Value, Fault> {
    match a {
        Value::Number(x) => Ok(Value::Number(-x)),
        Value::Vector2(v) => Ok(Value::Vector2(-*v)),
        Value::Vector3(v) => Ok(Value::Vector3(-*v)),
        Value::Vector4(v) => Ok(Value::Vector4(Rc::new(-**v))),
        other => {
            let message = format!("`-` takes a number or a vector, and this is {}", shown(other));
            Err(Box::new(Diagnostic::new(Code::TypeMismatch, span, message)))
        }
    }
}

/// `a op b` on numbers.
#[inline]
pub fn compare(op: Comparison, a: f64, b: f64) -> bool {
    match op {
        Comparison::Equal => a == b,
        Comparison::NotEqual => a != b,
        Comparison::Less => a < b,
        Comparison::LessEqual => a <= b,
        Comparison::Greater => a > b,
        Comparison::GreaterEqual => a >= b,
    }
}

/// `a < b` and the like, on numbers; texts are ordered by their characters.
pub fn order(op: Comparison, a: &Value, b: &Value, span: Span) -> Result<bool, Fault> {
    let ordering = match (a, b) {
        (Value::Number(x), Value::Number(y)) => x.partial_cmp(y),
        (Value::Text(s), Value::Text(t)) => Some(s.cmp(t)),
        _ => {
            let message =
                format!("`{}` orders numbers, and these are {} and {}", op.text(), shown(a), shown(b));
            let said = Diagnostic::new(Code::TypeMismatch, span, message);
            let vectors = matches!((a, b), (Value::Vector2(_) | Value::Vector3(_) | Value::Vector4(_), _));
            let hinted = |said: Diagnostic| said.hint("compare a component, `v.x`, or the `length(v)`");
            return Err(Box::new(if vectors { hinted(said) } else { said }));
        }
    };
    Ok(ordering.is_some_and(|o| match op {
        Comparison::Less => o.is_lt(),
        Comparison::LessEqual => o.is_le(),
        Comparison::Greater => o.is_gt(),
        Comparison::GreaterEqual => o.is_ge(),
        Comparison::Equal => o.is_eq(),
        Comparison::NotEqual => o.is_ne(),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_powers_are_exact_and_the_others_agree_with_them() {
        assert_eq!(power(3.0, 4.0), 81.0);
        assert_eq!(power(-2.0, 3.0), -8.0);
        assert_eq!(power(2.0, -2.0), 0.25);
        assert_eq!(power(2.0, 0.5), 2.0f64.sqrt());
        assert_eq!(power(10.0, 22.0), 1e22);
    }

    #[test]
    fn a_remainder_has_the_sign_of_its_dividend() {
        assert_eq!(number(Arithmetic::Remainder, -7.0, 3.0), -1.0);
        assert_eq!(number(Arithmetic::Remainder, 7.0, -3.0), 1.0);
    }
}
