//! Values as text.

use crate::lang::value::{RangeValue, Value};

/// A value as `ogee eval` prints it: numbers in the shortest form that reads back as themselves, texts in quotation marks.
pub fn display(value: &Value) -> String {
    match value {
        Value::Number(x) => number(*x),
        Value::Bool(b) => b.to_string(),
        Value::Text(text) => format!("\"{}\"", escaped(text)),
        Value::Vector2(v) => vector(&v.to_array()),
        Value::Vector3(v) => vector(&v.to_array()),
        Value::Vector4(v) => vector(&v.to_array()),
        Value::List(list) => {
            let parts: Vec<String> = list.iter().map(display).collect();
            format!("[{}]", parts.join(", "))
        }
        Value::Range(range) => display_range(range),
        Value::Word(word) => word.to_string(),
        other => crate::lang::coerce::shown(other),
    }
}

/// The same, but a text is said without quotation marks.
pub fn said(value: &Value) -> String {
    match value {
        Value::Text(text) => text.to_string(),
        other => display(other),
    }
}

fn number(x: f64) -> String {
    if x.is_infinite() {
        (if x > 0.0 { "inf" } else { "-inf" }).into()
    } else {
        crate::lang::coerce::number(x)
    }
}

fn vector(components: &[f64]) -> String {
    let parts: Vec<String> = components.iter().map(|x| number(*x)).collect();
    format!("<{}>", parts.join(", "))
}

fn display_range(range: &RangeValue) -> String {
    let whole = format!("{}..{}", number(range.start), number(range.end));
    if range.step == 1.0 { whole } else { format!("{whole} step {}", number(range.step)) }
}

fn escaped(text: &str) -> String {
    text.chars().fold(String::new(), |mut out, c| {
        match c {
            '"' | '\\' | '{' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            _ => out.push(c),
        }
        out
    })
}
