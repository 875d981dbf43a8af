//! The value of an expression as plain data, for those outside the language: the command line prints it, tests compare it.

use crate::lang::display::{self, Style};
use crate::lang::value::Value;

/// A value that was asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// A number.
    Number(f64),
    /// A truth value.
    Bool(bool),
    /// A text.
    Text(String),
    /// The 2 to 4 components of a vector.
    Vector(Vec<f64>),
    /// A list.
    List(Vec<Answer>),
    /// Any other value, in words: "an object", "a function".
    Other(String),
}

/// Lists nested deeper than this become "…".
const DEEPEST: usize = 64;

impl Answer {
    /// Of a value.
    pub fn of(value: &Value) -> Answer {
        Answer::nested(value, 0)
    }

    fn nested(value: &Value, depth: usize) -> Answer {
        match value {
            Value::Number(x) => Answer::Number(*x),
            Value::Bool(b) => Answer::Bool(*b),
            Value::Text(text) => Answer::Text(text.to_string()),
            Value::Vector2(v) => Answer::Vector(v.to_array().to_vec()),
            Value::Vector3(v) => Answer::Vector(v.to_array().to_vec()),
            Value::Vector4(v) => Answer::Vector(v.to_array().to_vec()),
            Value::List(list) if depth < DEEPEST => {
                Answer::List(list.iter().map(|e| Answer::nested(e, depth + 1)).collect())
            }
            Value::List(_) => Answer::Other("…".into()),
            other => Answer::Other(display::display(other)),
        }
    }

    /// As text: numbers in the shortest form that reads back, or to `digits` significant digits.
    pub fn text(&self, digits: Option<usize>) -> String {
        let style = Style { digits, most: None };
        match self {
            Answer::Number(x) => display::styled(&Value::Number(*x), style),
            Answer::Bool(b) => b.to_string(),
            Answer::Text(text) => display::display(&Value::text(text)),
            Answer::Vector(v) => display::styled(&crate::lang::value::vector(v), style),
            Answer::List(list) => {
                let parts: Vec<String> = list.iter().map(|e| e.text(digits)).collect();
                format!("[{}]", parts.join(", "))
            }
            Answer::Other(text) => text.clone(),
        }
    }
}
