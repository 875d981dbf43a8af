//! What the body of a member is given, and how it reads it.

use super::{Form, Member};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::shown;
use crate::lang::table::{Arguments, Context, Outcome, Reported};
use crate::lang::value::Value;
use glam::DVec3;

/// A member asked of a value.
pub struct Ask<'a> {
    /// Which.
    pub member: &'static Member,
    /// Of what.
    pub value: &'a Value,
    /// With what.
    pub arguments: &'a Arguments<'a>,
}

impl Ask<'_> {
    /// The member in words: `velocity`; the value's type for its own call.
    pub fn name(&self) -> String {
        match self.member.form {
            Form::Call => shown(self.value),
            Form::Field | Form::Method => format!("`{}`", self.member.name),
        }
    }

    /// The place of an argument.
    pub fn place(&self, i: usize) -> Span {
        self.arguments.spans.get(i).copied().unwrap_or(self.arguments.span)
    }

    /// An argument that is a number.
    #[inline]
    pub fn number(&self, ctx: &mut dyn Context, i: usize) -> Outcome<f64> {
        match self.arguments.values.get(i) {
            Some(Value::Number(x)) => Ok(*x),
            _ => Err(self.wrong(ctx, i)),
        }
    }

    /// An argument that is a whole number.
    pub fn whole(&self, ctx: &mut dyn Context, i: usize) -> Outcome<f64> {
        let x = self.number(ctx, i)?;
        if x == x.trunc() { Ok(x) } else { Err(self.wrong(ctx, i)) }
    }

    /// An argument that is a 3-vector.
    pub fn vector(&self, ctx: &mut dyn Context, i: usize) -> Outcome<DVec3> {
        match self.arguments.values.get(i) {
            Some(Value::Vector3(v)) => Ok(*v),
            _ => Err(self.wrong(ctx, i)),
        }
    }

    /// An argument that is a text.
    pub fn text(&self, ctx: &mut dyn Context, i: usize) -> Outcome<&str> {
        match self.arguments.values.get(i) {
            Some(Value::Text(text)) => Ok(text),
            _ => Err(self.wrong(ctx, i)),
        }
    }

    /// An argument is of the wrong type.
    #[cold]
    pub fn wrong(&self, ctx: &mut dyn Context, i: usize) -> Reported {
        let (name, takes) = self.member.parameters.get(i).map_or(("", "nothing"), |p| (p.name, p.takes));
        let given = self.arguments.values.get(i).map_or("nothing".into(), shown);
        let message = format!("{} takes {takes} for `{name}`, and this is {given}", self.name());
        let said = Diagnostic::new(Code::TypeMismatch, self.place(i), message)
            .hint(format!("write it like `{}`", self.member.example.0));
        ctx.fail(said)
    }
}
