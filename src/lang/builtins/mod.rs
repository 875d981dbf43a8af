//! The table of builtin functions and constants.
//!
//! [`find`] looks a function up, [`constant`] a constant, [`call`] computes a call whose arguments are bound to parameters,
//! [`undefined`] words what a function cannot do at its arguments.

mod checks;
mod colour;
mod general;
mod lists;
mod mathematics;
mod noise;
pub mod patterns;
#[cfg(test)]
mod tests;
mod text;
mod vectors;

pub use text::display;

use super::coerce;
use super::table::{Arguments, Builtin, BuiltinBody, Context, Outcome};
use super::value::Value;
use crate::diag::{Code, Diagnostic, Span};
use crate::math::field::MAX_CALL;
use glam::DVec3;

/// The families of functions with their titles, in the order of the reference.
pub static CHAPTERS: &[(&str, &[Builtin])] = &[
    ("Mathematics", mathematics::ALL),
    ("Vectors", vectors::ALL),
    ("Lists", lists::ALL),
    ("Colour", colour::ALL),
    ("Noise", noise::ALL),
    ("Patterns", patterns::ALL),
    ("Text and checks", checks::ALL),
    ("Geometry", general::ALL),
];

/// Every function.
pub fn all() -> impl Iterator<Item = &'static Builtin> {
    CHAPTERS.iter().flat_map(|(_, functions)| functions.iter())
}

/// The function of this name.
pub fn find(name: &str) -> Option<&'static Builtin> {
    all().find(|builtin| builtin.name == name)
}

/// The names of all functions and constants, for hints.
pub fn names() -> impl Iterator<Item = &'static str> {
    all().map(|b| b.name).chain(CONSTANTS.iter().map(|(name, _, _)| *name)).chain(["time", "frame"])
}

/// The constants with what they are; colours are sRGB as HTML defines them. `time` and `frame` are the evaluator's.
pub static CONSTANTS: &[(&str, Constant, &str)] = &[
    ("pi", Constant::Number(std::f64::consts::PI), "half a turn in radians"),
    ("tau", Constant::Number(std::f64::consts::TAU), "a turn in radians"),
    ("inf", Constant::Number(f64::INFINITY), "infinity, for comparisons; no property takes it"),
    ("x", Constant::Vector(DVec3::X), "unit vector, to the right"),
    ("y", Constant::Vector(DVec3::Y), "unit vector, up"),
    ("z", Constant::Vector(DVec3::Z), "unit vector, toward the viewer"),
    ("black", Constant::Srgb([0, 0, 0]), "#000000"),
    ("silver", Constant::Srgb([192, 192, 192]), "#c0c0c0"),
    ("gray", Constant::Srgb([128, 128, 128]), "#808080"),
    ("white", Constant::Srgb([255, 255, 255]), "#ffffff"),
    ("maroon", Constant::Srgb([128, 0, 0]), "#800000"),
    ("red", Constant::Srgb([255, 0, 0]), "#ff0000"),
    ("purple", Constant::Srgb([128, 0, 128]), "#800080"),
    ("fuchsia", Constant::Srgb([255, 0, 255]), "#ff00ff"),
    ("green", Constant::Srgb([0, 128, 0]), "#008000"),
    ("lime", Constant::Srgb([0, 255, 0]), "#00ff00"),
    ("olive", Constant::Srgb([128, 128, 0]), "#808000"),
    ("yellow", Constant::Srgb([255, 255, 0]), "#ffff00"),
    ("navy", Constant::Srgb([0, 0, 128]), "#000080"),
    ("blue", Constant::Srgb([0, 0, 255]), "#0000ff"),
    ("teal", Constant::Srgb([0, 128, 128]), "#008080"),
    ("aqua", Constant::Srgb([0, 255, 255]), "#00ffff"),
];

/// What a constant is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constant {
    /// A number.
    Number(f64),
    /// A 3-vector.
    Vector(DVec3),
    /// A colour as it is written; decoded to linear light.
    Srgb([u8; 3]),
}

impl Constant {
    /// As a value.
    pub fn value(self) -> Value {
        match self {
            Constant::Number(x) => Value::Number(x),
            Constant::Vector(v) => Value::Vector3(v),
            Constant::Srgb(rgb) => Value::Vector3(srgb(rgb)),
        }
    }
}

/// Linear RGB of a colour written in sRGB, as `#cc3311` is.
pub fn srgb(rgb: [u8; 3]) -> DVec3 {
    DVec3::from_array(rgb.map(|c| crate::math::colour::srgb_decode(f64::from(c) / 255.0)))
}

/// The constant of this name; `time` and `frame` are none of the table's.
pub fn constant(name: &str) -> Option<Value> {
    CONSTANTS.iter().find(|(n, _, _)| *n == name).map(|(_, constant, _)| constant.value())
}

/// The value of a parameter's default as the table writes it: a number, a text, a truth value or a constant's name.
pub fn default_value(written: &str) -> Option<Value> {
    if let Some(text) = written.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
        return Some(Value::text(text));
    }
    match written {
        "true" => Some(Value::Bool(true)),
        "false" => Some(Value::Bool(false)),
        "[]" => Some(Value::list(Vec::new())),
        _ => written.parse().ok().map(Value::Number).or_else(|| constant(written)),
    }
}

/// One value for each parameter: its default, or a stand-in where it must be given.
pub fn defaults(builtin: &Builtin) -> Vec<Value> {
    let of = |written: &str| default_value(written).expect("the table's defaults are literals or constants");
    builtin.parameters.iter().map(|p| p.default.map_or(Value::Bool(false), of)).collect()
}

/// Computes a call whose arguments stand in the order of the parameters, defaults filled in. Reports arguments of the wrong
/// type, and arguments at which the function is undefined.
pub fn call(ctx: &mut dyn Context, builtin: &'static Builtin, arguments: &Arguments<'_>) -> Outcome {
    let spread = |ctx: &mut dyn Context, f: &dyn Fn(&[f64]) -> f64| by_component(ctx, builtin, arguments, f);
    match &builtin.body {
        BuiltinBody::Number1(f) => match arguments.values {
            [Value::Number(x)] => checked(ctx, builtin, arguments, Value::Number(f(*x))),
            _ => spread(ctx, &|x| f(x[0])),
        },
        BuiltinBody::Number2(f) => match arguments.values {
            [Value::Number(a), Value::Number(b)] => {
                checked(ctx, builtin, arguments, Value::Number(f(*a, *b)))
            }
            _ => spread(ctx, &|x| x[1..].iter().fold(x[0], |a, b| f(a, *b))),
        },
        BuiltinBody::Number3(f) => spread(ctx, &|x| f(x[0], x[1], x[2])),
        BuiltinBody::Numbers(shape, f) => numbers(ctx, builtin, arguments, *shape, *f),
        BuiltinBody::General(f) => f(ctx, arguments),
    }
}

/// Applies a function of numbers to each component; numbers among vectors stand for every component.
fn by_component(
    ctx: &mut dyn Context,
    builtin: &'static Builtin,
    arguments: &Arguments<'_>,
    f: &dyn Fn(&[f64]) -> f64,
) -> Outcome {
    let components = all_components(ctx, builtin, arguments)?;
    let n = components.iter().map(|c| c.len()).max().unwrap_or(1);
    if let Some(i) = components.iter().position(|c| c.len() != 1 && c.len() != n) {
        let said = Diagnostic::new(
            Code::TypeMismatch,
            arguments.spans[i],
            format!(
                "`{}` takes vectors of one size, and this has {} components beside {n}",
                builtin.name,
                components[i].len()
            ),
        )
        .hint("take components, as in `v.xy`");
        return Err(ctx.fail(said));
    }
    let mut row = vec![0.0; components.len()];
    let mut result = [0.0; 4];
    for (i, to) in result.iter_mut().enumerate().take(n) {
        row.iter_mut().zip(&components).for_each(|(x, c)| *x = if c.len() == 1 { c[0] } else { c[i] });
        *to = f(&row);
    }
    checked(ctx, builtin, arguments, coerce::from_components(&result[..n]))
}

fn numbers(
    ctx: &mut dyn Context,
    builtin: &'static Builtin,
    arguments: &Arguments<'_>,
    shape: crate::lang::table::ShapeOf,
    f: crate::math::field::CallN,
) -> Outcome {
    let components = all_components(ctx, builtin, arguments)?;
    let sizes: Vec<usize> = components.iter().map(Vec::len).collect();
    let flat: Vec<f64> = components.concat();
    let mut result = [0.0; 4];
    match shape(&sizes) {
        Some(n) if flat.len() <= MAX_CALL => {
            f(&flat, &mut result[..n]);
            checked(ctx, builtin, arguments, coerce::from_components(&result[..n]))
        }
        Some(_) => {
            let message = format!("`{}` takes at most {MAX_CALL} numbers in all", builtin.name);
            Err(ctx.fail(Diagnostic::new(Code::WrongArity, arguments.span, message)))
        }
        None => Err(ctx.fail(wrong_shapes(builtin, arguments))),
    }
}

fn wrong_shapes(builtin: &Builtin, arguments: &Arguments<'_>) -> Diagnostic {
    let given: Vec<String> = arguments.values.iter().map(coerce::shown).collect();
    let takes: Vec<String> = builtin.parameters.iter().map(|p| p.takes.to_string()).collect();
    let at = if arguments.spans.len() == 1 { arguments.spans[0] } else { arguments.span };
    Diagnostic::new(
        Code::TypeMismatch,
        at,
        format!("`{}` cannot take {}", builtin.name, coerce::listed(&given, "and")),
    )
    .hint(format!("it takes {}, as in `{}`", coerce::listed(&takes, "and"), builtin.example.0))
}

fn all_components(
    ctx: &mut dyn Context,
    builtin: &Builtin,
    arguments: &Arguments<'_>,
) -> Outcome<Vec<Vec<f64>>> {
    let each = arguments.values.iter().zip(arguments.spans).enumerate();
    each.map(|(i, (value, span))| {
        components(value).ok_or_else(|| ctx.fail(wrong_argument(builtin, i, value, *span)))
    })
    .collect()
}

/// The components of a number or vector.
pub fn components(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Number(x) => Some(vec![*x]),
        Value::Vector2(v) => Some(v.to_array().to_vec()),
        Value::Vector3(v) => Some(v.to_array().to_vec()),
        Value::Vector4(v) => Some(v.to_array().to_vec()),
        _ => None,
    }
}

/// "`sqrt` takes a number or vector as `x`, and this is a text".
pub fn wrong_argument(builtin: &Builtin, i: usize, value: &Value, span: Span) -> Diagnostic {
    let parameter = builtin.parameters.get(i).or(builtin.parameters.last());
    let (name, takes) = parameter.map_or(("", "nothing"), |p| (p.name, p.takes));
    let said = Diagnostic::new(
        Code::TypeMismatch,
        span,
        format!("`{}` takes {takes} for `{name}`, and this is {}", builtin.name, coerce::shown(value)),
    );
    match value {
        Value::Text(text) if text.trim().parse::<f64>().is_ok() => {
            said.hint(format!("leave out the quotation marks: `{}`", text.trim()))
        }
        Value::Function(_) | Value::Builtin(_) => said.hint("call it with its arguments in parentheses"),
        Value::List(_) => said.hint("apply it to each element, as in `[f(e) for e in list]`"),
        _ => said.hint(format!("write it like `{}`", builtin.example.0)),
    }
}

/// A result, unless it is not finite though the arguments are.
fn checked(
    ctx: &mut dyn Context,
    builtin: &'static Builtin,
    arguments: &Arguments<'_>,
    result: Value,
) -> Outcome {
    let finite = |v: &Value| components(v).is_none_or(|c| c.iter().all(|x| x.is_finite()));
    if finite(&result) || !arguments.values.iter().all(finite) {
        return Ok(result);
    }
    Err(ctx.fail(undefined(builtin, arguments)))
}

/// What to say where a function has no finite value at finite arguments.
pub fn undefined(builtin: &Builtin, arguments: &Arguments<'_>) -> Diagnostic {
    let given: Vec<String> = arguments.values.iter().map(display).collect();
    let written = format!("{}({})", builtin.name, given.join(", "));
    let at = if arguments.spans.len() == 1 { arguments.spans[0] } else { arguments.span };
    let (domain, hint) = builtin.domain;
    if domain.is_empty() {
        return Diagnostic::new(Code::NotFinite, at, format!("`{written}` is beyond the range of numbers"))
            .hint("f64 ends near 1.8e308");
    }
    Diagnostic::new(Code::Undefined, at, format!("`{written}` is undefined"))
        .label(format!("`{}` takes {domain}", builtin.name))
        .hint(hint)
}
