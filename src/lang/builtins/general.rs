//! Functions of geometry: not built yet.

use crate::diag::{Code, Diagnostic};
use crate::lang::table::{Arguments, Builtin, BuiltinBody::*, Context, Outcome, Parameter, Reported};

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new(
        "trace",
        &[
            Parameter::new("object", "an object"),
            Parameter::new("origin", "a 3-vector"),
            Parameter::new("direction", "a 3-vector"),
        ],
        General(|ctx, arguments| not_built(ctx, arguments, "trace")),
        "The hits of a ray with an object in order, each with `.t .point .normal .uv`. Not built yet.",
        ("trace(ball, <0, 0, 5>, -z)", ""),
    ),
    Builtin::new(
        "roots",
        &[Parameter::new("c0", "a number")],
        General(|ctx, arguments| not_built(ctx, arguments, "roots")),
        "The real roots of the polynomial c0 + c1·t + c2·t² + …, in order. Not built yet.",
        ("roots(-1, 0, 1)", ""),
    )
    .variadic(),
    Builtin::new(
        "curve",
        &[
            Parameter::new("f", "a function"),
            Parameter::new("a", "a number"),
            Parameter::new("b", "a number"),
        ],
        General(|ctx, arguments| not_built(ctx, arguments, "curve")),
        "The curve of a function over a … b. Not built yet.",
        ("curve(t => <t, t^2, 0>, 0, 1)", ""),
    ),
    Builtin::new(
        "weights_of",
        &[Parameter::new("joint", "a joint's name, in quotation marks")],
        General(|ctx, arguments| not_built(ctx, arguments, "weights_of")),
        "A pattern that colours a skin by a joint's influence. Not built yet.",
        ("weights_of(\"elbow\")", ""),
    ),
];

/// A warning, and no value.
pub fn not_built(ctx: &mut dyn Context, arguments: &Arguments<'_>, name: &str) -> Outcome {
    let said = Diagnostic::new(Code::NotBuilt, arguments.span, format!("`{name}` is not built yet"))
        .label("what uses it is left out");
    ctx.report(said);
    Err(Reported)
}
