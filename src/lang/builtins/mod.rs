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
mod vectors;

use super::coerce;
use super::display::{abbreviated, display};
use super::table::{Arguments, Builtin, BuiltinBody, Context, Outcome, ShapeOf};
use super::value::{Value, vector};
use crate::diag::{Code, Diagnostic, Span};
use crate::math::field::{CallN, MAX_CALL};
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
    let result = match (&builtin.body, arguments.values) {
        (BuiltinBody::Number1(f), [Value::Number(x)]) => Value::Number(f(*x)),
        (BuiltinBody::Number2(f), [Value::Number(a), Value::Number(b)]) => Value::Number(f(*a, *b)),
        (BuiltinBody::Number3(f, _), [Value::Number(a), Value::Number(b), Value::Number(c)]) => {
            Value::Number(f(*a, *b, *c))
        }
        (BuiltinBody::Number1(f), _) => by_component(ctx, builtin, arguments, &|x| f(x[0]))?,
        (BuiltinBody::Number2(f), _) => {
            by_component(ctx, builtin, arguments, &|x| x[1..].iter().fold(x[0], |a, b| f(a, *b)))?
        }
        (BuiltinBody::Number3(f, _), _) => by_component(ctx, builtin, arguments, &|x| f(x[0], x[1], x[2]))?,
        (BuiltinBody::Numbers(shape, f), _) => numbers(ctx, builtin, arguments, *shape, *f)?,
        (BuiltinBody::General(f), _) => return f(ctx, arguments),
    };
    match may_stand(&result, arguments.values.iter().all(is_finite)) {
        true => Ok(result),
        false => Err(ctx.fail(undefined(builtin, arguments, &result))),
    }
}

/// Whether a result may stand: a NaN never, an infinity where what it was made of is not all finite.
fn may_stand(result: &Value, of_finite: bool) -> bool {
    let component_may = |x: &f64| x.is_finite() || !(of_finite || x.is_nan());
    components(result).is_none_or(|(c, n)| c[..n].iter().all(component_may))
}

/// The same of every element of a list.
fn is_finite_throughout(value: &Value) -> bool {
    match value {
        Value::List(list) => list.iter().all(is_finite),
        _ => is_finite(value),
    }
}

fn is_finite(value: &Value) -> bool {
    components(value).is_none_or(|(c, n)| c[..n].iter().all(|x| x.is_finite()))
}

/// Applies a function of numbers to each component; numbers among vectors stand for every component.
fn by_component(
    ctx: &mut dyn Context,
    builtin: &'static Builtin,
    arguments: &Arguments<'_>,
    f: &dyn Fn(&[f64]) -> f64,
) -> Outcome {
    let mut all = Vec::with_capacity(arguments.values.len());
    for i in 0..arguments.values.len() {
        all.push(argument_components(ctx, builtin, arguments, i)?);
    }
    let n = all.iter().map(|(_, n)| *n).max().unwrap_or(1);
    if let Some(i) = all.iter().position(|(_, m)| *m != 1 && *m != n) {
        let message = format!(
            "`{}` takes vectors of one size, and this has {} components beside {n}",
            builtin.name, all[i].1
        );
        let said = Diagnostic::new(Code::TypeMismatch, arguments.spans[i], message)
            .hint("take components, as in `v.xy`");
        return Err(ctx.fail(said));
    }
    let mut row = vec![0.0; all.len()];
    let mut result = [0.0; 4];
    for (i, to) in result.iter_mut().enumerate().take(n) {
        row.iter_mut().zip(&all).for_each(|(x, (c, m))| *x = if *m == 1 { c[0] } else { c[i] });
        *to = f(&row);
    }
    Ok(vector(&result[..n]))
}

/// The components of all arguments in a row, to those of the result.
fn numbers(
    ctx: &mut dyn Context,
    builtin: &'static Builtin,
    arguments: &Arguments<'_>,
    shape: ShapeOf,
    f: CallN,
) -> Outcome {
    let (mut flat, mut sizes, mut total) = ([0.0; MAX_CALL], [0; MAX_CALL], 0);
    let n_arguments = arguments.values.len();
    for i in 0..n_arguments {
        let (c, n) = argument_components(ctx, builtin, arguments, i)?;
        if total + n > MAX_CALL {
            let message = format!("`{}` takes at most {MAX_CALL} numbers in all", builtin.name);
            return Err(ctx.fail(Diagnostic::new(Code::WrongArity, arguments.spans[i], message)));
        }
        flat[total..total + n].copy_from_slice(&c[..n]);
        sizes[i] = n;
        total += n;
    }
    let Some(n) = shape(&sizes[..n_arguments]) else {
        return Err(ctx.fail(wrong_shapes(builtin, arguments)));
    };
    let mut result = [0.0; 4];
    f(&flat[..total], &mut result[..n]);
    Ok(vector(&result[..n]))
}

fn argument_components(
    ctx: &mut dyn Context,
    builtin: &Builtin,
    arguments: &Arguments<'_>,
    i: usize,
) -> Outcome<([f64; 4], usize)> {
    components(&arguments.values[i])
        .ok_or_else(|| ctx.fail(wrong_argument(builtin, i, &arguments.values[i], arguments.spans[i])))
}

/// The components of a number or vector, and how many they are.
pub fn components(value: &Value) -> Option<([f64; 4], usize)> {
    match value {
        Value::Number(x) => Some(([*x, 0.0, 0.0, 0.0], 1)),
        Value::Vector2(v) => Some(([v.x, v.y, 0.0, 0.0], 2)),
        Value::Vector3(v) => Some(([v.x, v.y, v.z, 0.0], 3)),
        Value::Vector4(v) => Some((v.to_array(), 4)),
        _ => None,
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

/// "`sqrt` takes a number or vector as `x`, and this is a text".
pub fn wrong_argument(builtin: &Builtin, i: usize, value: &Value, span: Span) -> Diagnostic {
    let parameter = builtin.parameters.get(i).or(builtin.parameters.last());
    let (name, takes) = parameter.map_or(("", "nothing"), |p| (p.name, p.takes));
    if !is_finite(value) {
        let message =
            format!("`{}` takes finite numbers alone, and `{name}` is {}", builtin.name, display(value));
        let said = Diagnostic::new(Code::NotFinite, span, message);
        return said.hint("`inf` is there to compare with: give a number that is large enough");
    }
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

/// About how many characters of an argument are shown.
const ARGUMENT: usize = 48;

/// What to say of a result that may not stand.
pub fn undefined(builtin: &Builtin, arguments: &Arguments<'_>, result: &Value) -> Diagnostic {
    let given: Vec<String> = arguments.values.iter().map(|value| abbreviated(value, ARGUMENT)).collect();
    let written = format!("{}({})", builtin.name, given.join(", "));
    let at = if arguments.spans.len() == 1 { arguments.spans[0] } else { arguments.span };
    let (domain, hint) = builtin.domain;
    let any = |value: &Value, is: fn(f64) -> bool| {
        components(value).is_some_and(|(c, n)| c[..n].iter().any(|x| is(*x)))
    };
    let is_nan = any(result, f64::is_nan);
    // Of a function of one number the domain says it all; of several, an infinite one is the likelier fault.
    let is_one = matches!(builtin.body, BuiltinBody::Number1(_)) && !domain.is_empty();
    if is_nan && !is_one && !arguments.values.iter().all(is_finite_throughout) {
        return Diagnostic::new(Code::NotFinite, at, format!("`{written}` has no value"))
            .label("not a number")
            .hint("an argument is infinite; `inf` is for comparisons: guard it, as in `clamp(x, 0, 1)`");
    }
    // Where something vanishes an infinity is a pole, else it has grown too large.
    let is_pole = arguments.values.iter().any(|value| any(value, |x| x == 0.0));
    if domain.is_empty() || !(is_nan || is_pole) {
        return Diagnostic::new(Code::NotFinite, at, format!("`{written}` is beyond the range of numbers"))
            .hint("f64 ends near 1.8e308");
    }
    Diagnostic::new(Code::Undefined, at, format!("`{written}` is undefined"))
        .label(format!("`{}` takes {domain}", builtin.name))
        .hint(hint)
}
