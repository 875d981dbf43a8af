//! Values to the types of the table: whether a value is of a type, what it becomes there, and how to speak of both.

pub use super::display::number;
use super::table::{Context, CurveOf, Gives, Property, Reported, Type};
use super::value::Value;
use crate::diag::Span;
pub use crate::geometry::mesh::unit;
use crate::scene::{Pattern, PatternKind, Rgb, SampleInput, Texture};
use glam::DVec3;
use std::sync::Arc;

/// Why a value of the right type cannot be used.
pub enum Misfit {
    /// A number or component is NaN or infinite.
    NotFinite,
    /// It is outside its bounds.
    Bounds {
        /// "above 0".
        expected: String,
        /// A thing to try; may be empty.
        hint: String,
    },
    /// Something else, already said.
    Reported(Reported),
}

/// Whether a value is of a type, bounds aside.
pub fn fits(ctx: &dyn Context, kind: Type, value: &Value) -> bool {
    match kind {
        Type::Number { .. } | Type::Positive | Type::Integer { .. } | Type::Factor => {
            matches!(value, Value::Number(_))
        }
        Type::Bool => match value {
            Value::Bool(_) => true,
            Value::Word(word) => matches!(&**word, "on" | "off"),
            _ => false,
        },
        Type::Text => matches!(value, Value::Text(_)),
        Type::Vector2 => matches!(value, Value::Vector2(_)),
        Type::Vector3 | Type::Direction | Type::Factors => matches!(value, Value::Vector3(_)),
        Type::Vector4 => matches!(value, Value::Vector4(_)),
        Type::Colour => matches!(value, Value::Vector3(_) | Value::Number(_)),
        Type::Texture => matches!(value, Value::Vector3(_)) || fits_number_texture(ctx, value),
        Type::NumberTexture { .. } => fits_number_texture(ctx, value),
        Type::Word(words) => matches!(value, Value::Word(word) if words.contains(&&**word)),
        Type::Label => matches!(value, Value::Word(_)),
        Type::Object => matches!(value, Value::Object(_)),
        Type::Material => matches!(value, Value::Material(_)),
        Type::Transform => matches!(value, Value::Transform(_)),
        Type::Point => matches!(value, Value::Number(_) | Value::Vector2(_) | Value::Vector3(_)),
        Type::Curve(of) => matches!(value, Value::Curve(curve) if of.holds(curve.dimension())),
        Type::Function => {
            matches!(value, Value::Function(_) | Value::Builtin(_))
                || super::members::call_of(value).is_some()
        }
        Type::List => matches!(value, Value::List(_) | Value::Range(_)),
        Type::Skeleton => matches!(value, Value::Skeleton(_)),
        Type::Pose => matches!(value, Value::Pose(_)),
        Type::Part(kind) => matches!(value, Value::Part(part) if part.kind() == kind),
        Type::Any => true,
    }
}

fn fits_number_texture(ctx: &dyn Context, value: &Value) -> bool {
    match value {
        Value::Number(_) | Value::Pattern(_) => true,
        Value::Function(_) => ctx.arity(value).is_some(),
        Value::Builtin(builtin) => super::builtins::patterns::of_builtin(builtin, None).is_some(),
        _ => false,
    }
}

/// What a value that [`fits`] becomes: checked against its bounds, and in the one form that builders read.
pub fn coerce(ctx: &mut dyn Context, kind: Type, value: &Value, span: Span) -> Result<Value, Misfit> {
    if !is_finite(value) {
        return Err(Misfit::NotFinite);
    }
    match (kind, value) {
        (Type::Number { min, max }, Value::Number(x)) => bounded(*x, min, max),
        (Type::Positive, Value::Number(x)) => positive(*x),
        (Type::Integer { min }, Value::Number(x)) => integer(*x, min),
        (Type::Bool, Value::Word(word)) => Ok(Value::Bool(&**word == "on")),
        (Type::Direction, Value::Vector3(v)) => direction(*v),
        (Type::Factor, Value::Number(x)) if !invertible(*x) => Err(zero_factor()),
        (Type::Factors, Value::Vector3(v)) if !v.to_array().into_iter().all(invertible) => Err(zero_factor()),
        (Type::Colour, Value::Number(x)) => colour(Rgb::splat(*x)),
        (Type::Colour, Value::Vector3(v)) => colour(*v),
        (Type::Texture, Value::Vector3(v)) => colour(*v),
        (Type::Texture, Value::Number(x)) => colour(Rgb::splat(*x)),
        (Type::NumberTexture { min, max }, Value::Number(x)) => bounded(*x, min, max),
        (Type::Texture, _) => pattern(ctx, value, &[1, 3], span),
        (Type::NumberTexture { .. }, _) => pattern(ctx, value, &[1], span),
        _ => Ok(value.clone()),
    }
}

/// Whether a value is of a type and in the form that builders read, so that [`coerce`] would give it back: at once, for the commonest types. False
/// says nothing.
#[inline]
pub fn stays(kind: Type, value: &Value) -> bool {
    match (kind, value) {
        (Type::Number { min, max }, Value::Number(x)) => x.is_finite() && (min..=max).contains(x),
        (Type::Positive, Value::Number(x)) => x.is_finite() && *x > 0.0,
        (Type::Vector3, Value::Vector3(v)) => v.is_finite(),
        (Type::Texture | Type::Colour, Value::Vector3(c)) => c.is_finite() && c.min_element() >= 0.0,
        (Type::Material, Value::Material(_)) | (Type::Object, Value::Object(_)) => true,
        _ => false,
    }
}

/// A texture from a value that passed as [`Type::Texture`] or [`Type::NumberTexture`].
pub fn texture(value: &Value) -> Option<Texture> {
    match value {
        Value::Number(x) => Some(Texture::number(*x)),
        Value::Vector3(v) => Some(Texture::Constant(*v)),
        Value::Pattern(pattern) => Some(Texture::Pattern(pattern.clone())),
        _ => None,
    }
}

fn pattern(ctx: &mut dyn Context, value: &Value, outputs: &[usize], span: Span) -> Result<Value, Misfit> {
    match value {
        Value::Builtin(builtin) if super::builtins::patterns::of_builtin(builtin, None).is_some() => {
            let pattern = super::builtins::patterns::of_builtin(builtin, Some(span)).expect("just looked up");
            Ok(Value::Pattern(Arc::new(pattern)))
        }
        Value::Function(_) => sampled(ctx, value, outputs, span).map_err(Misfit::Reported),
        _ => Ok(value.clone()),
    }
}

/// A function of one parameter is one of the point, of two of (u, v).
fn sampled(
    ctx: &mut dyn Context,
    function: &Value,
    outputs: &[usize],
    span: Span,
) -> Result<Value, Reported> {
    let (most, least) = ctx.arity(function).unwrap_or((1, 1));
    let input = match (least..=most).contains(&1) {
        true => SampleInput::Point,
        false => SampleInput::Uv,
    };
    if input == SampleInput::Uv && !(least..=most).contains(&2) {
        let said = crate::diag::Diagnostic::new(
            crate::diag::Code::NotSampled,
            span,
            format!("a function with {least} parameters cannot be a texture"),
        )
        .hint("write `p => …` of the point, or `(u, v) => …` of the surface's coordinates");
        return Err(ctx.fail(said));
    }
    let field = ctx.sampled(function, input, Gives::Components(outputs), span)?;
    Ok(Value::Pattern(Arc::new(Pattern { kind: PatternKind::Function(field), transform: None, span })))
}

fn is_finite(value: &Value) -> bool {
    match value {
        Value::Number(x) => x.is_finite(),
        Value::Vector2(v) => v.is_finite(),
        Value::Vector3(v) => v.is_finite(),
        Value::Vector4(v) => v.is_finite(),
        _ => true,
    }
}

/// "NaN" or "infinite", for a value with such a number in it.
pub fn not_finite_word(value: &Value) -> &'static str {
    let nan = match value {
        Value::Number(x) => x.is_nan(),
        Value::Vector2(v) => v.is_nan(),
        Value::Vector3(v) => v.is_nan(),
        Value::Vector4(v) => v.is_nan(),
        _ => false,
    };
    if nan { "NaN (not a number)" } else { "infinite" }
}

fn bounded(x: f64, min: f64, max: f64) -> Result<Value, Misfit> {
    if (min..=max).contains(&x) {
        return Ok(Value::Number(x));
    }
    let hint = if min == 0.0 && x < 0.0 && max >= -x {
        format!("did you mean {}?", number(-x))
    } else if min != f64::MIN && max != f64::MAX {
        format!("the nearest is {}", number(x.clamp(min, max)))
    } else {
        String::new()
    };
    Err(Misfit::Bounds { expected: bounds(min, max), hint })
}

fn positive(x: f64) -> Result<Value, Misfit> {
    if x > 0.0 {
        return Ok(Value::Number(x));
    }
    let hint = if x < 0.0 {
        format!("did you mean {}?", number(-x))
    } else {
        "a thing of no size is best left out: put it inside `if size > 0 { … }`".to_string()
    };
    Err(Misfit::Bounds { expected: "above 0".into(), hint })
}

/// The largest whole number that f64 tells from its neighbours.
const LARGEST_INTEGER: f64 = 9_007_199_254_740_992.0;

fn integer(x: f64, min: i64) -> Result<Value, Misfit> {
    if x.floor() == x && x >= min as f64 && x.abs() <= LARGEST_INTEGER {
        return Ok(Value::Number(x));
    }
    let is_too_large = x > LARGEST_INTEGER;
    let expected = if is_too_large {
        format!("a whole number of at most {LARGEST_INTEGER}")
    } else {
        format!("a whole number of at least {min}")
    };
    let hint = if is_too_large {
        "beyond it f64 no longer tells each whole number from the next".into()
    } else if x.floor() != x && x > min as f64 {
        format!("try `floor` or {}", x.round())
    } else {
        String::new()
    };
    Err(Misfit::Bounds { expected, hint })
}

/// Not 0, nor so near to it that 1/x is infinite.
fn invertible(x: f64) -> bool {
    x != 0.0 && x.recip().is_finite()
}

fn zero_factor() -> Misfit {
    Misfit::Bounds {
        expected: "other than 0 on every axis".into(),
        hint: "leave an axis as it is with the factor 1, as in `scale <2, 1, 2>`; flat things are `disc` and `rect`"
            .into(),
    }
}

fn direction(v: DVec3) -> Result<Value, Misfit> {
    unit(v).map(Value::Vector3).ok_or_else(|| Misfit::Bounds {
        expected: "a direction, a vector that is not 0".into(),
        hint: "write an axis such as `x`, `y`, `z` or `<0, 1, 0>`".into(),
    })
}

fn colour(c: Rgb) -> Result<Value, Misfit> {
    if c.min_element() >= 0.0 {
        return Ok(Value::Vector3(c));
    }
    Err(Misfit::Bounds {
        expected: "a colour of channels of at least 0".into(),
        hint: format!("`max(c, 0)` cuts it at black: {}", vector(&c.max(Rgb::ZERO).to_array())),
    })
}

/// How many components a vector type has.
pub fn dimension(kind: Type) -> Option<usize> {
    match kind {
        Type::Vector2 => Some(2),
        Type::Vector3 | Type::Direction | Type::Factors | Type::Colour | Type::Texture => Some(3),
        Type::Vector4 => Some(4),
        _ => None,
    }
}

/// A value in a few words, with its type: "the number 3", "the 2-vector <1, 2>", "a list".
pub fn shown(value: &Value) -> String {
    match value {
        Value::Number(x) => format!("the number {}", number(*x)),
        Value::Bool(b) => format!("the truth value {b}"),
        Value::Text(text) => short_text(text),
        Value::Vector2(v) => format!("the 2-vector {}", vector(&v.to_array())),
        Value::Vector3(v) => format!("the 3-vector {}", vector(&v.to_array())),
        Value::Vector4(v) => format!("the 4-vector {}", vector(&v.to_array())),
        Value::List(list) => format!("a list of {}", list.len()),
        Value::Range(_) => "a range".into(),
        Value::Function(_) => "a function".into(),
        Value::Builtin(builtin) => format!("the function `{}`", builtin.name),
        Value::Object(_) => "an object".into(),
        Value::Light(_) => "a light".into(),
        Value::Material(_) => "a material".into(),
        Value::Pattern(_) => "a pattern".into(),
        Value::Camera(_) => "a camera".into(),
        Value::Render(_) => "a render block".into(),
        Value::Curve(curve) => a_curve_of(curve.dimension()).into(),
        Value::Skeleton(_) => "a skeleton".into(),
        Value::Pose(_) => "a pose".into(),
        Value::Part(part) => format!("the {} `{}`", part.kind(), part.name),
        Value::Record(record) => record.name.into(),
        Value::Transform(_) => "a transform".into(),
        Value::Fragment(_) => "a group of properties".into(),
        Value::Word(word) => format!("the word `{word}`"),
    }
}

/// A curve in words, by how many numbers its points have.
fn a_curve_of(dimension: usize) -> &'static str {
    match dimension {
        1 => "a curve of numbers",
        2 => "a curve of 2-vectors",
        _ => "a curve of 3-vectors",
    }
}

/// The sort of a value in words, without the value itself: "a number", "a list of 3 numbers".
pub fn sort_of(value: &Value) -> String {
    match value {
        Value::Number(_) => "a number".into(),
        Value::Bool(_) => "a truth value".into(),
        Value::Text(_) => "a text".into(),
        Value::Vector2(_) => "a 2-vector".into(),
        Value::Vector3(_) => "a 3-vector".into(),
        Value::Vector4(_) => "a 4-vector".into(),
        Value::List(list) => sort_of_list(list),
        _ => shown(value),
    }
}

fn sort_of_list(list: &[Value]) -> String {
    let count = format!("a list of {}", list.len());
    let same = |first: &Value| {
        let sort = std::mem::discriminant(first);
        list.iter().all(|other| std::mem::discriminant(other) == sort)
    };
    match list.first() {
        Some(Value::List(_)) | None => count,
        Some(first) if list.len() > 1 && same(first) => {
            let sort = sort_of(first);
            format!("{count} {}s", sort.trim_start_matches("a ").trim_start_matches("an "))
        }
        Some(_) => count,
    }
}

fn short_text(text: &str) -> String {
    let head: String = text.chars().take(24).collect();
    if head.len() == text.len() { format!("the text \"{text}\"") } else { format!("the text \"{head}…\"") }
}

/// `<1, 2, 3>`.
pub fn vector(components: &[f64]) -> String {
    let parts: Vec<String> = components.iter().map(|x| number(*x)).collect();
    format!("<{}>", parts.join(", "))
}

/// "a, b and c".
pub fn listed(words: &[String], last: &str) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [head @ .., tail] => format!("{} {last} {tail}", head.join(", ")),
    }
}

fn bounds(min: f64, max: f64) -> String {
    match (min == f64::MIN, max == f64::MAX) {
        (true, true) => "finite".into(),
        (false, true) => format!("at least {}", number(min)),
        (true, false) => format!("at most {}", number(max)),
        (false, false) => format!("from {} to {}", number(min), number(max)),
    }
}

/// A type in words: "a number of at least 0".
pub fn words(kind: Type) -> String {
    match kind {
        Type::Number { min, max } if min == f64::MIN && max == f64::MAX => "a number".into(),
        Type::Number { min, max } if max == f64::MAX => format!("a number of at least {}", number(min)),
        Type::Number { min, max } => format!("a number {}", bounds(min, max)),
        Type::Positive => "a number above 0".into(),
        Type::Integer { min } => format!("a whole number of at least {min}"),
        Type::Bool => "`on` or `off`".into(),
        Type::Text => "a text".into(),
        Type::Vector2 => "a 2-vector".into(),
        Type::Vector3 => "a 3-vector".into(),
        Type::Vector4 => "a 4-vector".into(),
        Type::Direction => "a direction (a 3-vector other than 0)".into(),
        Type::Factor => "a number other than 0".into(),
        Type::Factors => "a 3-vector without 0".into(),
        Type::Colour => "a colour or a number".into(),
        Type::Texture => "a colour, a number, a pattern or a function".into(),
        Type::NumberTexture { min, max } if min == f64::MIN && max == f64::MAX => {
            "a number, a pattern or a function".into()
        }
        Type::NumberTexture { min, max } => format!("a number {}, a pattern or a function", bounds(min, max)),
        Type::Word(list) => listed(&list.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>(), "or"),
        Type::Label => "a name".into(),
        Type::Object => "an object".into(),
        Type::Material => "a material".into(),
        Type::Transform => "a transform".into(),
        Type::Point => "a number, a 2-vector or a 3-vector".into(),
        Type::Curve(CurveOf::Any) => "a curve".into(),
        Type::Curve(CurveOf::Numbers) => a_curve_of(1).into(),
        Type::Curve(CurveOf::Plane) => a_curve_of(2).into(),
        Type::Curve(CurveOf::Space) => a_curve_of(3).into(),
        Type::Function => "a function".into(),
        Type::List => "a list".into(),
        Type::Skeleton => "a skeleton".into(),
        Type::Pose => "a pose".into(),
        Type::Part(kind) => format!("a {kind}"),
        Type::Any => "a value".into(),
    }
}

/// Alternatives in words: "a number or a 3-vector".
pub fn expected(types: &[Type]) -> String {
    let mut said: Vec<String> = Vec::new();
    for word in types.iter().map(|t| words(*t)) {
        if !said.contains(&word) {
            said.push(word);
        }
    }
    listed(&said, "or")
}

/// All forms of a property in words: "a 3-vector, or a direction and a number".
pub fn forms(property: &Property) -> String {
    if property.many {
        return match property.takes {
            [[element]] => format!("any number of values, each {}", words(*element)),
            _ => "any number of values".into(),
        };
    }
    let row = |row: &&[Type]| match row {
        [] => "no value".to_string(),
        [first, rest @ ..] if row.len() > 2 && rest.iter().all(|t| t == first) => {
            format!("{} values, each {}", row.len(), words(*first))
        }
        _ => listed(&row.iter().map(|t| words(*t)).collect::<Vec<_>>(), "and"),
    };
    property.takes.iter().map(row).collect::<Vec<_>>().join(", or ")
}

/// A use of a property with likely values: `rotate <1, 1, 1>`.
pub fn sample_use(property: &Property) -> String {
    let row = property.takes.iter().find(|row| !row.is_empty());
    let telling = !matches!(property.default, "" | "0" | "<0, 0, 0>");
    let values: Vec<String> = match row {
        Some(_) if telling => vec![property.default.to_string()],
        Some(row) => row.iter().map(|t| sample(*t)).collect(),
        None => Vec::new(),
    };
    if values.is_empty() {
        property.name.to_string()
    } else {
        format!("{} {}", property.name, values.join(", "))
    }
}

fn sample(kind: Type) -> String {
    match kind {
        Type::Number { min, max } | Type::NumberTexture { min, max } => number(1f64.clamp(min, max)),
        Type::Positive | Type::Any => "1".into(),
        Type::Skeleton => "arm".into(),
        Type::Pose => "touch".into(),
        Type::Part(_) => "elbow { hinge z }".into(),
        Type::Factor => "2".into(),
        Type::Factors => "<2, 1, 2>".into(),
        Type::Integer { min } => format!("{}", min.max(1)),
        Type::Bool => "on".into(),
        Type::Text => "\"…\"".into(),
        Type::Vector2 => "<0, 1>".into(),
        Type::Vector3 | Type::Direction => "<0, 1, 0>".into(),
        Type::Vector4 => "<0, 0, 0, 1>".into(),
        Type::Colour | Type::Texture => "<0.8, 0.4, 0.3>".into(),
        Type::Word(list) => list.first().copied().unwrap_or("on").into(),
        Type::Label => "elbow".into(),
        Type::Object => "sphere { radius 1 }".into(),
        Type::Material => "material { diffuse 0.5 }".into(),
        Type::Transform => "path.frame(0)".into(),
        Type::Point => "<0, 0, 0>, <1, 2, 0>".into(),
        Type::Curve(_) => "path".into(),
        Type::Function => "p => p.y".into(),
        Type::List => "[1, 2]".into(),
    }
}

/// One thing to try where a value is of the wrong type.
pub fn remedy(name: &str, types: &[Type], value: &Value) -> Option<String> {
    let wanted = types.iter().find_map(|t| dimension(*t));
    let wants_number = types.iter().any(|t| {
        matches!(
            t,
            Type::Number { .. }
                | Type::Positive
                | Type::Factor
                | Type::Integer { .. }
                | Type::NumberTexture { .. }
        )
    });
    let wants_words = types.iter().any(|t| !t.words().is_empty());
    match value {
        Value::Vector3(_) | Value::Number(_) if types.contains(&Type::Material) => {
            Some(format!("write `material {{ diffuse {} }}`", plain(value)))
        }
        Value::Number(x) => wanted.map(|n| format!("write `{name} {}`", vector(&vec![*x; n]))),
        Value::Vector2(v) if wanted == Some(3) => {
            Some(format!("write `{name} {}` with a third component", vector(&[v.x, v.y, 0.0])))
        }
        Value::Vector3(v) if wanted == Some(2) => Some(format!("write `{name} {}`", vector(&[v.x, v.y]))),
        Value::Vector3(_) | Value::Vector2(_) if wants_number => {
            Some("take one component, as in `v.x`, or `length(v)`".into())
        }
        Value::Text(text) if wants_words => Some(format!("words stand bare here: `{name} {text}`")),
        Value::Text(text) if text.trim().parse::<f64>().is_ok() && wants_number => {
            Some(format!("leave out the quotation marks: `{name} {}`", text.trim()))
        }
        Value::Word(word) if types.contains(&Type::Text) => {
            Some(format!("a text stands in quotation marks: `\"{word}\"`"))
        }
        Value::Function(_) => Some("call it with its arguments in parentheses".into()),
        Value::List(_) if wanted.is_some() || wants_number => {
            Some("take one element, as in `list[0]`".into())
        }
        Value::Bool(true) if wants_number => Some(format!("write `{name} 1`")),
        Value::Material(_) | Value::Object(_) | Value::Light(_) | Value::Part(_)
            if types.contains(&Type::Bool) =>
        {
            Some(format!("in the middle of a line, set a flag with `{name} on`"))
        }
        _ => None,
    }
}

fn plain(value: &Value) -> String {
    match value {
        Value::Number(x) => number(*x),
        Value::Vector3(v) => vector(&v.to_array()),
        _ => "…".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::mock::{Mock, n, span, v};

    #[test]
    fn what_stays_is_what_would_be_made_of_it() {
        let numbers =
            [-2.0, -0.0, 0.0, 1e-300, 0.5, 1.0, 7.0, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        let vectors = numbers.map(|x| v(0.25, x, 1.0));
        let values: Vec<Value> = numbers.map(n).into_iter().chain(vectors).collect();
        let bounds = [(f64::MIN, f64::MAX), (0.0, 1.0), (0.5, 7.0), (-2.0, 0.0)];
        let kinds = bounds.map(|(min, max)| Type::Number { min, max }).into_iter().chain([
            Type::Positive,
            Type::Vector3,
            Type::Texture,
            Type::Colour,
        ]);
        let mut n_stay = 0;
        for kind in kinds {
            for value in &values {
                let stays = stays(kind, value);
                let made = fits(&Mock::default(), kind, value)
                    .then(|| coerce(&mut Mock::default(), kind, value, span(0)));
                let is_same = matches!(&made, Some(Ok(made)) if shown(made) == shown(value));
                assert_eq!(stays, is_same, "{kind:?}: {value:?} becomes {:?}", made.and_then(Result::ok));
                n_stay += usize::from(stays);
            }
        }
        assert!(n_stay > 40, "{n_stay}");
    }
}
