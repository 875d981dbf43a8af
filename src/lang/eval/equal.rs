//! Equality of values.

use crate::lang::value::Value;
use std::collections::HashSet;
use std::rc::Rc;
use std::sync::Arc;

/// `a == b`: numbers, texts, vectors and lists by what they hold, built values and functions by being the same one. Values of
/// different types differ. Lists may be nested without bound.
///
/// Lists may also share their parts, as in `l = [l, l]` again and again: a pair of lists is looked into once.
pub fn equal(a: &Value, b: &Value) -> bool {
    equal_in(a, b).0
}

/// The same, and how many pairs of values it took.
pub fn equal_in(a: &Value, b: &Value) -> (bool, usize) {
    let mut pairs = 0;
    let mut waiting = vec![(a.clone(), b.clone())];
    let mut seen = HashSet::new();
    while let Some((a, b)) = waiting.pop() {
        pairs += 1;
        match (&a, &b) {
            (Value::List(u), Value::List(v)) => {
                if u.len() != v.len() {
                    return (false, pairs);
                }
                if !Rc::ptr_eq(u, v) && seen.insert((Rc::as_ptr(u), Rc::as_ptr(v))) {
                    waiting.extend(u.iter().cloned().zip(v.iter().cloned()));
                }
            }
            (Value::Record(u), Value::Record(v)) => {
                let alike = |((m, _), (n, _)): (&(&str, Value), &(&str, Value))| m == n;
                if u.parts.len() != v.parts.len() || !u.parts.iter().zip(&v.parts).all(alike) {
                    return (false, pairs);
                }
                waiting.extend(u.parts.iter().zip(&v.parts).map(|((_, a), (_, b))| (a.clone(), b.clone())));
            }
            _ if !same(&a, &b) => return (false, pairs),
            _ => {}
        }
    }
    (true, pairs)
}

fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) => x == y,
        (Value::Bool(x), Value::Bool(y)) => x == y,
        (Value::Text(s), Value::Text(t)) => s == t,
        (Value::Word(s), Value::Word(t)) => s == t,
        (Value::Vector2(u), Value::Vector2(v)) => u == v,
        (Value::Vector3(u), Value::Vector3(v)) => u == v,
        (Value::Vector4(u), Value::Vector4(v)) => u == v,
        (Value::Range(r), Value::Range(s)) => (r.start, r.step, r.len) == (s.start, s.step, s.len),
        (Value::Curve(c), Value::Curve(d)) => c.same(d),
        (Value::Transform(s), Value::Transform(t)) => s == t,
        (Value::Function(f), Value::Function(g)) => Rc::ptr_eq(f, g),
        (Value::Builtin(f), Value::Builtin(g)) => std::ptr::eq(*f, *g),
        (Value::Object(x), Value::Object(y)) => Arc::ptr_eq(x, y),
        (Value::Light(x), Value::Light(y)) => Arc::ptr_eq(x, y),
        (Value::Material(x), Value::Material(y)) => Arc::ptr_eq(x, y),
        (Value::Pattern(x), Value::Pattern(y)) => Arc::ptr_eq(x, y),
        (Value::Skeleton(x), Value::Skeleton(y)) => Arc::ptr_eq(x, y),
        (Value::Pose(x), Value::Pose(y)) => Arc::ptr_eq(x, y),
        (Value::Part(x), Value::Part(y)) => Rc::ptr_eq(x, y),
        (Value::Camera(x), Value::Camera(y)) => x == y,
        (Value::Render(x), Value::Render(y)) => x == y,
        (Value::Fragment(x), Value::Fragment(y)) => Rc::ptr_eq(x, y),
        _ => false,
    }
}
