//! Text, and functions that speak to the person: print, assert, error.

use crate::diag::{Code, Diagnostic};
use crate::lang::coerce;
use crate::lang::display::{display, interpolated, pieces};
use crate::lang::table::{Arguments, Builtin, BuiltinBody::*, Context, Outcome, Parameter};
use crate::lang::value::Value;

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new(
        "str",
        &[Parameter::new("value", "anything")],
        General(|ctx, arguments| {
            check_shown(ctx, arguments)?;
            Ok(Value::text(&display(&arguments.values[0])))
        }),
        "A value as text: numbers so that they read back as themselves.",
        ("str(<1, 0.5>)", "\"<1, 0.5>\""),
    ),
    Builtin::new(
        "print",
        &[Parameter::new("value", "anything")],
        General(print),
        "Says its arguments, parted by spaces. Gives nothing to place: the empty list.",
        ("print(\"half is\", 1/2)", "[]"),
    )
    .variadic(),
    Builtin::new(
        "assert",
        &[Parameter::new("condition", "true or false"), Parameter::new("message", "a text").or("\"\"")],
        General(assert),
        "An error with the message unless the condition holds. Gives the empty list.",
        ("assert(1 < 2, \"numbers have an order\")", "[]"),
    ),
    Builtin::new(
        "error",
        &[Parameter::new("message", "a text")],
        General(error),
        "An error with this message, always.",
        ("true ? 1 : error(\"cannot be\")", "1"),
    ),
];

/// Counts what the arguments are written of, before they are written.
fn check_shown(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome<()> {
    let total = arguments.values.iter().fold(0usize, |sum, value| sum.saturating_add(pieces(value)));
    ctx.reserve(total, arguments.span)
}

fn print(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    check_shown(ctx, arguments)?;
    let words: Vec<String> = arguments.values.iter().map(interpolated).collect();
    ctx.print(words.join(" "));
    Ok(Value::list(Vec::new()))
}

fn assert(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    check_shown(ctx, arguments)?;
    let message = interpolated(&arguments.values[1]);
    match &arguments.values[0] {
        Value::Bool(true) => Ok(Value::list(Vec::new())),
        Value::Bool(false) => {
            let said = if message.is_empty() { "this assertion does not hold".to_string() } else { message };
            Err(ctx.fail(Diagnostic::new(Code::AssertFailed, arguments.span, said).label("asserted here")))
        }
        other => {
            let said = Diagnostic::new(
                Code::TypeMismatch,
                arguments.spans[0],
                format!("`assert` takes true or false, and this is {}", coerce::shown(other)),
            )
            .hint("write a comparison, as in `assert(n == 3)`");
            Err(ctx.fail(said))
        }
    }
}

fn error(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    check_shown(ctx, arguments)?;
    let message = interpolated(&arguments.values[0]);
    Err(ctx.fail(Diagnostic::new(Code::UserError, arguments.span, message).label("the scene says so here")))
}
