//! What a curve cannot be asked, in words.

use super::curve;
use crate::diag::{Code, Diagnostic};
use crate::geometry::curve::CurveError;
use crate::lang::coerce::{number, shown};
use crate::lang::members::Ask;
use crate::lang::table::{Context, Reported};

/// Reports a fault of the kernel at the argument that caused it.
#[cold]
pub fn report(ctx: &mut dyn Context, ask: &Ask<'_>, error: &CurveError) -> Reported {
    ctx.fail(worded(ask, error))
}

fn worded(ask: &Ask<'_>, error: &CurveError) -> Diagnostic {
    match error {
        CurveError::OutsideDomain { t, start, end } => outside_domain(ask, *t, *start, *end),
        CurveError::OutsideLength { s, length } => {
            let message =
                format!("the length {} is outside the curve, which is {} long", number(*s), number(*length));
            Diagnostic::new(Code::Undefined, ask.place(0), message)
                .label(format!("takes 0 up to {}", number(*length)))
                .hint("cut it: `clamp(s, 0, path.length)`")
        }
        CurveError::SplitAtEnd { t } => {
            let message = format!("{} is an end of the curve: there is nothing to split off", number(*t));
            Diagnostic::new(Code::Undefined, ask.place(0), message)
        }
        other => Diagnostic::new(Code::Undefined, ask.place(0), other.to_string()),
    }
}

fn outside_domain(ask: &Ask<'_>, t: f64, start: f64, end: f64) -> Diagnostic {
    let place = match ask.arguments.values {
        // The length between two parameters: the one that is outside.
        [crate::lang::value::Value::Number(a), _] if a.to_bits() != t.to_bits() => 1,
        _ => 0,
    };
    let (low, high) = (number(start), number(end));
    let message = format!("{} is outside the curve's domain, {low} to {high}", number(t));
    let said = Diagnostic::new(Code::Undefined, ask.place(place), message)
        .label(format!("a parameter runs from {low} to {high}"));
    if curve(ask).closed() && start == 0.0 {
        said.hint(format!("to go round and round, write `mod(t, {high})`"))
    } else {
        said.hint(format!("cut it: `clamp(t, {low}, {high})`"))
    }
}

/// Reports that only curves of more components have this.
#[cold]
pub fn wrong_dimension(ctx: &mut dyn Context, ask: &Ask<'_>, least: usize) -> Reported {
    let owners = if least == 3 { "3-vectors" } else { "2-vectors or 3-vectors" };
    let message = format!("{} is of curves of {owners}, and this is {}", ask.name(), shown(ask.value));
    ctx.fail(Diagnostic::new(Code::NoSuchField, ask.arguments.span, message))
}

/// Reports that only splines have this.
#[cold]
pub fn no_pieces(ctx: &mut dyn Context, ask: &Ask<'_>) -> Reported {
    let message =
        format!("{} is of splines: a curve of a function has no pieces and no control points", ask.name());
    ctx.fail(Diagnostic::new(Code::NoSuchField, ask.arguments.span, message))
}
