//! Functions of lists.

use super::{components, is_finite, may_stand, undefined, wrong_argument};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce;
use crate::lang::members;
use crate::lang::table::{Arguments, Builtin, BuiltinBody::*, Context, Outcome, Parameter, Reported};
use crate::lang::value::{RangeValue, Value, vector};
use std::rc::Rc;

const LIST: &[Parameter] = &[Parameter::new("list", "a list or range")];

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new(
        "len",
        &[Parameter::new("list", "a list, a range, a text or a vector")],
        General(len),
        "How many elements, characters or components it has.",
        ("len([4, 5, 6])", "3"),
    ),
    Builtin::new("sum", LIST, General(sum), "The sum of numbers or vectors; 0 for none.", ("sum([1, 2, 3.5])", "6.5")),
    Builtin::new(
        "map",
        &[Parameter::new("list", "a list or range"), Parameter::new("f", "a function")],
        General(map),
        "The list of f of each element; `[f(e) for e in list]`.",
        ("map([1, 4, 9], sqrt)", "[1, 2, 3]"),
    ),
    Builtin::new(
        "filter",
        &[Parameter::new("list", "a list or range"), Parameter::new("keep", "a function to true or false")],
        General(filter),
        "The elements for which the function is true.",
        ("filter(0..6, n => n % 2 == 0)", "[0, 2, 4]"),
    ),
    Builtin::new(
        "fold",
        &[
            Parameter::new("list", "a list or range"),
            Parameter::new("start", "anything"),
            Parameter::new("f", "a function of two parameters"),
        ],
        General(fold),
        "f(… f(f(start, first), second) …, last): one value from all elements.",
        ("fold([3, 9, 2], 0, max)", "9"),
    ),
    Builtin::new(
        "zip",
        &[Parameter::new("a", "a list or range"), Parameter::new("b", "a list or range of the same length")],
        General(zip),
        "The list of lists of the first elements, the second ones, and so on.",
        ("zip([1, 2], [\"a\", \"b\"])", "[[1, \"a\"], [2, \"b\"]]"),
    )
    .variadic(),
    Builtin::new(
        "sort",
        &[
            Parameter::new("list", "a list or range"),
            Parameter::new("key", "a function of an element to a number or text").or("[]"),
        ],
        General(sort),
        "Numbers or texts in rising order, or elements by a key; equals keep their order.",
        ("sort([3, 1, 2])", "[1, 2, 3]"),
    ),
    Builtin::new(
        "reverse",
        LIST,
        General(|ctx, arguments| {
            let mut elements = list_argument(ctx, arguments, "reverse", 0)?;
            elements.reverse();
            Ok(Value::list(elements))
        }),
        "The elements from last to first.",
        ("reverse([1, 2, 3])", "[3, 2, 1]"),
    ),
    Builtin::new(
        "range",
        &[Parameter::new("a", "a number")],
        General(range),
        "`range(n)` is 0..n, `range(a, b)` is a..b, `range(a, b, step)` is a..b step step: the end is left out.",
        ("[i * i for i in range(4)]", "[0, 1, 4, 9]"),
    )
    .variadic(),
    Builtin::new(
        "linspace",
        &[
            Parameter::new("a", "a number or vector"),
            Parameter::new("b", "a number or vector"),
            Parameter::new("n", "a whole number"),
        ],
        General(linspace),
        "n values evenly from a to b, both taken in; for n = 1, a alone.",
        ("linspace(0, 1, 5)", "[0, 0.25, 0.5, 0.75, 1]"),
    ),
];

fn misfit(ctx: &mut dyn Context, arguments: &Arguments<'_>, name: &str, i: usize) -> Reported {
    let builtin = super::find(name).expect("a function of the table");
    ctx.fail(wrong_argument(builtin, i, &arguments.values[i], arguments.spans[i]))
}

/// A number or vector that a function of lists made, where it may stand.
fn sound(
    ctx: &mut dyn Context,
    arguments: &Arguments<'_>,
    name: &str,
    result: Value,
    of_finite: bool,
) -> Outcome {
    if may_stand(&result, of_finite) {
        return Ok(result);
    }
    let builtin = super::find(name).expect("a function of the table");
    Err(ctx.fail(undefined(builtin, arguments, &result)))
}

/// Element i of a range.
fn element(range: &RangeValue, i: usize) -> Value {
    Value::Number(range.start + i as f64 * range.step)
}

/// The elements of a list or range.
fn list_argument(
    ctx: &mut dyn Context,
    arguments: &Arguments<'_>,
    name: &str,
    i: usize,
) -> Outcome<Vec<Value>> {
    match &arguments.values[i] {
        Value::List(list) => {
            ctx.reserve(list.len(), arguments.span)?;
            Ok(list.to_vec())
        }
        Value::Range(range) => {
            ctx.reserve(range.len, arguments.span)?;
            Ok((0..range.len).map(|i| element(range, i)).collect())
        }
        _ => Err(misfit(ctx, arguments, name, i)),
    }
}

fn function_argument<'a>(
    ctx: &mut dyn Context,
    arguments: &'a Arguments<'_>,
    name: &str,
    i: usize,
) -> Outcome<&'a Value> {
    match &arguments.values[i] {
        f @ (Value::Function(_) | Value::Builtin(_)) => Ok(f),
        f if members::call_of(f).is_some() => Ok(f),
        _ => Err(misfit(ctx, arguments, name, i)),
    }
}

fn len(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let n = match &arguments.values[0] {
        Value::List(list) => list.len(),
        Value::Range(range) => range.len,
        Value::Text(text) => text.chars().count(),
        Value::Vector2(_) => 2,
        Value::Vector3(_) => 3,
        Value::Vector4(_) => 4,
        _ => return Err(misfit(ctx, arguments, "len", 0)),
    };
    Ok(Value::Number(n as f64))
}

fn sum(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let elements = list_argument(ctx, arguments, "sum", 0)?;
    let mut total: Option<([f64; 4], usize)> = None;
    for value in &elements {
        total = match (total, components(value)) {
            (None, Some(first)) => Some(first),
            (Some((sum, n)), Some((next, m))) if n == m => {
                Some((std::array::from_fn(|i| sum[i] + next[i]), n))
            }
            _ => return Err(ctx.fail(not_summable(arguments.spans[0], value))),
        };
    }
    let total = total.map_or(Value::Number(0.0), |(sum, n)| vector(&sum[..n]));
    sound(ctx, arguments, "sum", total, elements.iter().all(is_finite))
}

fn not_summable(span: Span, value: &Value) -> Diagnostic {
    Diagnostic::new(
        Code::TypeMismatch,
        span,
        format!("`sum` takes numbers, or vectors of one size, and one element is {}", coerce::shown(value)),
    )
    .hint("use `fold` with a function of your own")
}

fn map(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let f = function_argument(ctx, arguments, "map", 1)?;
    let elements = list_argument(ctx, arguments, "map", 0)?;
    let mut mapped = Vec::with_capacity(elements.len());
    for value in elements {
        mapped.push(ctx.call(f, &[value], arguments.spans[1])?);
    }
    Ok(Value::list(mapped))
}

fn filter(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let f = function_argument(ctx, arguments, "filter", 1)?;
    let mut kept = Vec::new();
    for value in list_argument(ctx, arguments, "filter", 0)? {
        match ctx.call(f, std::slice::from_ref(&value), arguments.spans[1])? {
            Value::Bool(true) => kept.push(value),
            Value::Bool(false) => {}
            other => {
                let said = Diagnostic::new(
                    Code::TypeMismatch,
                    arguments.spans[1],
                    format!(
                        "`filter` takes a function to true or false, and this one gives {}",
                        coerce::shown(&other)
                    ),
                )
                .hint("write a comparison, as in `n => n > 0`");
                return Err(ctx.fail(said));
            }
        }
    }
    Ok(Value::list(kept))
}

fn fold(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let f = function_argument(ctx, arguments, "fold", 2)?;
    let mut so_far = arguments.values[1].clone();
    for value in list_argument(ctx, arguments, "fold", 0)? {
        so_far = ctx.call(f, &[so_far, value], arguments.spans[2])?;
    }
    Ok(so_far)
}

fn zip(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let mut lists = Vec::new();
    for i in 0..arguments.values.len() {
        lists.push(list_argument(ctx, arguments, "zip", i)?);
    }
    let n = lists[0].len();
    if let Some(i) = lists.iter().position(|list| list.len() != n) {
        let said = Diagnostic::new(
            Code::Undefined,
            arguments.spans[i],
            format!("`zip` takes lists of one length, and this has {} elements beside {n}", lists[i].len()),
        )
        .also(arguments.spans[0], format!("{n} elements here"))
        .hint("cut the longer one, as in `[list[i] for i in 0..n]`");
        return Err(ctx.fail(said));
    }
    Ok(Value::list((0..n).map(|i| Value::list(lists.iter().map(|l| l[i].clone()).collect())).collect()))
}

fn sort(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let elements = list_argument(ctx, arguments, "sort", 0)?;
    let key = match &arguments.values[1] {
        Value::List(list) if list.is_empty() => None,
        _ => Some(function_argument(ctx, arguments, "sort", 1)?),
    };
    let mut keyed = Vec::with_capacity(elements.len());
    for value in elements {
        let by = match key {
            None => value.clone(),
            Some(f) => ctx.call(f, std::slice::from_ref(&value), arguments.spans[1])?,
        };
        keyed.push((by, value));
    }
    if let Some((odd, _)) = keyed.iter().find(|(by, _)| order(&keyed[0].0, by).is_none()) {
        let said = Diagnostic::new(
            Code::TypeMismatch,
            arguments.spans[0],
            format!("`sort` takes numbers or texts alone, and there is {}", coerce::shown(odd)),
        )
        .hint("give a key, as in `sort(points, p => p.x)`");
        return Err(ctx.fail(said));
    }
    keyed.sort_by(|(a, _), (b, _)| order(a, b).unwrap_or(std::cmp::Ordering::Equal));
    Ok(Value::list(keyed.into_iter().map(|(_, value)| value).collect()))
}

fn order(a: &Value, b: &Value) -> Option<std::cmp::Ordering> {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => Some(a.total_cmp(b)),
        (Value::Text(a), Value::Text(b)) => Some(a.cmp(b)),
        _ => None,
    }
}

fn range(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let mut numbers = Vec::new();
    for (i, value) in arguments.values.iter().enumerate() {
        match value {
            Value::Number(x) if x.is_finite() => numbers.push(*x),
            _ => return Err(misfit(ctx, arguments, "range", i)),
        }
    }
    let (start, end, step) = match numbers[..] {
        [end] => (0.0, end, 1.0),
        [start, end] => (start, end, 1.0),
        [start, end, step] if step != 0.0 => (start, end, step),
        [_, _, _] => {
            let said =
                Diagnostic::new(Code::Undefined, arguments.spans[2], "a `range` with step 0 has no end")
                    .hint("give a step above or below 0");
            return Err(ctx.fail(said));
        }
        _ => {
            let message = format!("`range` takes 1 to 3 numbers, and this gives {}", numbers.len());
            return Err(ctx.fail(Diagnostic::new(Code::WrongArity, arguments.span, message)));
        }
    };
    let len = ((end - start) / step).ceil().max(0.0);
    Ok(Value::Range(Rc::new(RangeValue { start, end, step, len: len as usize })))
}

fn linspace(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let Some((a, size)) = components(&arguments.values[0]) else {
        return Err(misfit(ctx, arguments, "linspace", 0));
    };
    let Some((b, _)) = components(&arguments.values[1]).filter(|(_, m)| *m == size) else {
        return Err(misfit(ctx, arguments, "linspace", 1));
    };
    let Value::Number(n) = arguments.values[2] else { return Err(misfit(ctx, arguments, "linspace", 2)) };
    if !(n >= 0.0 && n.floor() == n && n < usize::MAX as f64) {
        let message = format!("`linspace` makes a whole number of values, and this is {}", coerce::number(n));
        let said = Diagnostic::new(Code::Undefined, arguments.spans[2], message)
            .hint("write `floor(n)`, or 0 and above");
        return Err(ctx.fail(said));
    }
    let n = n as usize;
    ctx.reserve(n, arguments.span)?;
    let of_finite = arguments.values[..2].iter().all(is_finite);
    let at = |i: usize| {
        let t = if n > 1 { i as f64 / (n - 1) as f64 } else { 0.0 };
        let mixed: [f64; 4] = std::array::from_fn(|i| a[i] * (1.0 - t) + b[i] * t);
        sound(ctx, arguments, "linspace", vector(&mixed[..size]), of_finite)
    };
    Ok(Value::list((0..n).map(at).collect::<Outcome<_>>()?))
}
