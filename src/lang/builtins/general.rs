//! Functions of geometry.

use super::{components, undefined, wrong_argument};
use crate::diag::{Code, Diagnostic};
use crate::geometry::any_curve::IntoCurve;
use crate::geometry::function::FunctionPath;
use crate::lang::coerce::{number, shown};
use crate::lang::table::{Arguments, Builtin, BuiltinBody::*, Context, Outcome, Parameter, Reported, Traced};
use crate::lang::value::{Record, Value};
use crate::math::{Point, solve};
use glam::{DVec2, DVec3};
use std::rc::Rc;

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new(
        "trace",
        &[
            Parameter::new("object", "an object"),
            Parameter::new("origin", "a 3-vector"),
            Parameter::new("direction", "a 3-vector"),
        ],
        General(trace),
        "The hits of a ray with an object's true surface in order, from `origin` on: a list of hits, each with `.t` (how many lengths of \
         `direction` it is away), `.point`, `.normal` (of length 1, outward) and `.uv`. A surface that is only touched is hit once; what is \
         hidden is hit too.",
        ("trace(sphere { radius 1 }, <0, 0, 5>, -z)[0].t", "4"),
    ),
    Builtin::new(
        "roots",
        &[Parameter::new("c0", "a number")],
        General(roots),
        "The real roots of the polynomial c0 + c1·t + c2·t² + …, in rising order, each once; up to degree 32.",
        ("roots(-2, 1, 1)", "[-2, 1]"),
    )
    .variadic()
    .defined("polynomials other than 0, of which every number is a root", "guard it: is there a coefficient other than 0?"),
    Builtin::new(
        "curve",
        &[
            Parameter::new("f", "a function of one number to a number, a 2-vector or a 3-vector"),
            Parameter::new("a", "a number"),
            Parameter::new("b", "a number above `a`"),
        ],
        General(curve),
        "The curve of a function over a … b, with all that a curve has but pieces and control points. The function is followed to rounding \
         where it is smooth; kinks and jumps are found.",
        ("curve(t => <t, t^2, 0>, 0, 2).domain", "[0, 2]"),
    ),
];

fn misfit(ctx: &mut dyn Context, arguments: &Arguments<'_>, name: &str, i: usize) -> Reported {
    let builtin = super::find(name).expect("a function of the table");
    ctx.fail(wrong_argument(builtin, i, &arguments.values[i], arguments.spans[i]))
}

fn number_argument(ctx: &mut dyn Context, arguments: &Arguments<'_>, name: &str, i: usize) -> Outcome<f64> {
    match arguments.values[i] {
        Value::Number(x) if x.is_finite() => Ok(x),
        _ => Err(misfit(ctx, arguments, name, i)),
    }
}

fn trace(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let vector = |i: usize| match arguments.values[i] {
        Value::Vector3(v) if v.is_finite() => Some(v),
        _ => None,
    };
    let Value::Object(object) = &arguments.values[0] else { return Err(misfit(ctx, arguments, "trace", 0)) };
    let Some(origin) = vector(1) else { return Err(misfit(ctx, arguments, "trace", 1)) };
    let Some(direction) = vector(2) else { return Err(misfit(ctx, arguments, "trace", 2)) };
    if direction == DVec3::ZERO {
        let said =
            Diagnostic::new(Code::Undefined, arguments.spans[2], "a ray along the vector 0 goes nowhere");
        return Err(ctx.fail(said.hint("give the direction in which to look, for example `-y`")));
    }
    match ctx.tracer().trace(object, origin, direction, arguments.span) {
        Ok(hits) => {
            ctx.reserve(hits.len() * HIT_SIZE, arguments.span)?;
            Ok(Value::list(hits.iter().map(hit).collect()))
        }
        Err(faults) => {
            faults.into_iter().for_each(|fault| ctx.report(fault));
            Err(Reported)
        }
    }
}

/// What a hit takes, in elements of lists.
const HIT_SIZE: usize = 6;

fn hit(hit: &Traced) -> Value {
    let parts = vec![
        ("t", Value::Number(hit.t)),
        ("point", Value::Vector3(hit.point)),
        ("normal", Value::Vector3(hit.normal)),
        ("uv", Value::Vector2(hit.uv)),
    ];
    Value::Record(Rc::new(Record { name: "a hit", parts }))
}

/// Most coefficients of `roots`.
const COEFFICIENTS: usize = 33;

fn roots(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let n = arguments.values.len();
    if n > COEFFICIENTS {
        let message = format!("`roots` takes at most {COEFFICIENTS} coefficients, and these are {n}");
        return Err(ctx.fail(Diagnostic::new(Code::WrongArity, arguments.spans[COEFFICIENTS], message)));
    }
    let mut coefficients = [0.0; COEFFICIENTS];
    for (i, to) in coefficients.iter_mut().enumerate().take(n) {
        *to = number_argument(ctx, arguments, "roots", i)?;
    }
    if coefficients.iter().all(|c| *c == 0.0) {
        let builtin = super::find("roots").expect("a function of the table");
        return Err(ctx.fail(undefined(builtin, arguments, &Value::Number(f64::NAN))));
    }
    let found = solve::roots_of_up_to::<COEFFICIENTS>(&coefficients[..n]);
    Ok(Value::list(found.iter().copied().map(Value::Number).collect()))
}

fn curve(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    if ctx.arity(&arguments.values[0]).is_none() {
        return Err(misfit(ctx, arguments, "curve", 0));
    }
    let a = number_argument(ctx, arguments, "curve", 1)?;
    let b = number_argument(ctx, arguments, "curve", 2)?;
    if a >= b {
        let message = format!(
            "a curve runs from a lesser to a greater parameter, not from {} to {}",
            number(a),
            number(b)
        );
        let said = Diagnostic::new(Code::Undefined, arguments.spans[2], message);
        let hint = if a == b { "give it some length" } else { "swap the two; `.reverse` runs it backwards" };
        return Err(ctx.fail(said.hint(hint)));
    }
    match dimension(ctx, arguments, a)? {
        1 => fitted::<f64>(ctx, arguments, a, b),
        2 => fitted::<DVec2>(ctx, arguments, a, b),
        _ => fitted::<DVec3>(ctx, arguments, a, b),
    }
}

/// How many numbers the function gives.
fn dimension(ctx: &mut dyn Context, arguments: &Arguments<'_>, t: f64) -> Outcome<usize> {
    let value = ctx.call(&arguments.values[0], &[Value::Number(t)], arguments.spans[0])?;
    match components(&value) {
        Some((_, n @ 1..=3)) => Ok(n),
        _ => Err(ctx.fail(no_point(arguments, t, &value))),
    }
}

fn no_point(arguments: &Arguments<'_>, t: f64, value: &Value) -> Diagnostic {
    let message = format!(
        "a curve runs through numbers, 2-vectors or 3-vectors, all of one sort, and at {} this function gives {}",
        number(t),
        shown(value)
    );
    Diagnostic::new(Code::TypeMismatch, arguments.spans[0], message)
}

fn fitted<P: Point>(ctx: &mut dyn Context, arguments: &Arguments<'_>, a: f64, b: f64) -> Outcome
where
    FunctionPath<P>: IntoCurve<P>,
{
    let path = FunctionPath::fit(a, b, |t| {
        let value = ctx.call(&arguments.values[0], &[Value::Number(t)], arguments.spans[0])?;
        match components(&value) {
            Some((c, n)) if n == P::DIMENSION => Ok(P::from_coordinates(|i| c[i])),
            _ => Err(ctx.fail(no_point(arguments, t, &value))),
        }
    })?;
    Ok(Value::Curve(path.into_curve()))
}
