//! Values as text: numbers in the shortest form that reads back the same, vectors `<a, b>`, lists `[a, b]`.
//! Shared by `ogee eval`, interpolation, `print` and messages.

use super::value::{List, Record, Value};
use std::collections::HashMap;
use std::rc::Rc;

/// How a value is written.
#[derive(Clone, Copy, Debug, Default)]
pub struct Style {
    /// Significant digits of numbers; none is the shortest that reads back.
    pub digits: Option<usize>,
    /// About how many characters at most; what is beyond is "…". None is everything.
    pub most: Option<usize>,
}

/// Nested lists deeper than this are shown as "…".
const DEEPEST: usize = 64;

/// A value in full.
pub fn display(value: &Value) -> String {
    styled(value, Style::default())
}

/// A value as it stands inside a text: a text without its quotes.
pub fn interpolated(value: &Value) -> String {
    match value {
        Value::Text(text) => text.to_string(),
        _ => display(value),
    }
}

/// A value cut to about `most` characters, for messages.
pub fn abbreviated(value: &Value, most: usize) -> String {
    styled(value, Style { digits: None, most: Some(most) })
}

/// A value in a style.
pub fn styled(value: &Value, style: Style) -> String {
    let mut out = String::new();
    write(&mut out, value, style, 0);
    out
}

/// A number in the shortest form that reads back: `0.1`, `1`, `1e-9`.
pub fn number(x: f64) -> String {
    if x.is_infinite() {
        return if x > 0.0 { "inf".into() } else { "-inf".into() };
    }
    let text = format!("{x:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A number to `digits` significant digits, without zeros at its end.
pub fn number_to(x: f64, digits: usize) -> String {
    if !x.is_finite() || x == 0.0 {
        return number(x);
    }
    let scientific = format!("{:.*e}", digits.max(1) - 1, x);
    scientific.parse().map_or(scientific, number)
}

/// Of how many values a value is written, each as often as it is written: a list that holds one list twice counts it twice,
/// which doubles with each list around it. Never more than `usize::MAX`.
pub fn pieces(value: &Value) -> usize {
    counted(value, 0, &mut HashMap::new())
}

fn counted(value: &Value, depth: usize, known: &mut HashMap<(*const List, usize), usize>) -> usize {
    let Value::List(list) = value else { return 1 };
    if depth >= DEEPEST {
        return 1;
    }
    let place = (Rc::as_ptr(list), depth);
    if let Some(count) = known.get(&place) {
        return *count;
    }
    let count = list.iter().fold(1usize, |sum, e| sum.saturating_add(counted(e, depth + 1, known)));
    known.insert(place, count);
    count
}

fn write(out: &mut String, value: &Value, style: Style, depth: usize) {
    let shown = |x: f64| style.digits.map_or_else(|| number(x), |digits| number_to(x, digits));
    match value {
        Value::Number(x) => out.push_str(&shown(*x)),
        Value::Bool(b) => out.push_str(if *b { "true" } else { "false" }),
        Value::Text(text) => write_text(out, text, style.most),
        Value::Vector2(v) => out.push_str(&format!("<{}, {}>", shown(v.x), shown(v.y))),
        Value::Vector3(v) => out.push_str(&format!("<{}, {}, {}>", shown(v.x), shown(v.y), shown(v.z))),
        Value::Vector4(v) => {
            out.push_str(&format!("<{}, {}, {}, {}>", shown(v.x), shown(v.y), shown(v.z), shown(v.w)));
        }
        Value::List(list) if depth >= DEEPEST && !list.is_empty() => out.push('…'),
        Value::List(list) => write_list(out, list, style, depth),
        Value::Range(range) => {
            out.push_str(&format!("{}..{}", shown(range.start), shown(range.end)));
            if range.step != 1.0 {
                out.push_str(&format!(" step {}", shown(range.step)));
            }
        }
        Value::Record(record) => write_record(out, record, style, depth),
        Value::Word(word) => out.push_str(word),
        Value::Builtin(builtin) => out.push_str(&format!("function {}", builtin.name)),
        Value::Function(_)
        | Value::Object(_)
        | Value::Light(_)
        | Value::Material(_)
        | Value::Pattern(_)
        | Value::Camera(_)
        | Value::Render(_)
        | Value::Curve(_)
        | Value::Transform(_)
        | Value::Skeleton(_)
        | Value::Pose(_)
        | Value::Part(_)
        | Value::Fragment(_) => out.push_str(&crate::lang::coerce::shown(value)),
    }
}

fn write_text(out: &mut String, text: &str, most: Option<usize>) {
    out.push('"');
    for (i, c) in text.chars().enumerate() {
        if most.is_some_and(|most| i >= most) {
            out.push('…');
            break;
        }
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '{' => out.push_str("\\{"),
            c if c.is_control() => out.push_str(&format!("\\u{{{:x}}}", u32::from(c))),
            c => out.push(c),
        }
    }
    out.push('"');
}

fn write_record(out: &mut String, record: &Record, style: Style, depth: usize) {
    out.push('{');
    for (i, (name, part)) in record.parts.iter().enumerate() {
        out.push_str(if i > 0 { ", " } else { "" });
        out.push_str(name);
        out.push_str(": ");
        write(out, part, style, depth + 1);
    }
    out.push('}');
}

fn write_list(out: &mut String, list: &[Value], style: Style, depth: usize) {
    out.push('[');
    for (i, element) in list.iter().enumerate() {
        if i > 0 {
            out.push_str(", ");
        }
        if style.most.is_some_and(|most| out.len() > most) {
            out.push('…');
            break;
        }
        write(out, element, style, depth + 1);
    }
    out.push(']');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_shortest_that_read_back() {
        let shown = |x: f64| number(x);
        assert_eq!(shown(0.1), "0.1");
        assert_eq!(shown(1.0), "1");
        assert_eq!(shown(1e-9), "1e-9");
        assert_eq!(shown(0.1 + 0.2), "0.30000000000000004");
        assert_eq!(shown(f64::INFINITY), "inf");
        assert_eq!(shown(-2.5), "-2.5");
    }

    #[test]
    fn digits_are_significant_ones() {
        assert_eq!(number_to(std::f64::consts::PI, 4), "3.142");
        assert_eq!(number_to(123_456.0, 2), "120000");
        assert_eq!(number_to(0.5, 6), "0.5");
    }

    #[test]
    fn a_text_in_a_list_keeps_its_quotes() {
        let list = Value::list(vec![Value::text("a\"b"), Value::Number(1.0)]);
        assert_eq!(display(&list), "[\"a\\\"b\", 1]");
        assert_eq!(interpolated(&Value::text("a")), "a");
    }

    #[test]
    fn deep_and_long_lists_end() {
        let mut list = Value::list(Vec::new());
        for _ in 0..1_000_000 {
            list = Value::list(vec![list]);
        }
        assert!(display(&list).contains('…'));
        let long = Value::list((0..1000).map(|i| Value::Number(f64::from(i))).collect());
        assert!(abbreviated(&long, 20).ends_with("…]"));
    }
}
