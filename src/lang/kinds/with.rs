//! `e with { … }`: a copy of an object, light, material, pattern or camera with the items applied to it. Transforms come
//! after those that are there; everything else replaces what was there.

use super::{common, find};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::builtins::patterns;
use crate::lang::check;
use crate::lang::coerce;
use crate::lang::table::{Context, Outcome};
use crate::lang::value::{Given, Value};
use crate::scene::{Node, Shape};
use std::sync::Arc;

/// Applies items to a copy of a value. `children` are what the items placed (a group takes them).
pub fn apply(
    ctx: &mut dyn Context,
    base: Value,
    base_span: Span,
    mut given: Vec<Given>,
    children: Vec<Node>,
    span: Span,
) -> Outcome {
    match base {
        Value::Object(object) => {
            let kind = find("group").expect("a kind of the table");
            check::check_given(ctx, kind, &mut given)?;
            let mut copy = (*object).clone();
            copy.span = span;
            if !children.is_empty()
                && let Shape::Group(nodes) = &copy.shape
            {
                copy.shape = Shape::Group(nodes.iter().cloned().chain(children).collect());
            }
            common::apply_to_object(ctx, &mut copy, &given)?;
            Ok(Value::Object(Arc::new(copy)))
        }
        other => {
            let _ = patterns::of_builtin;
            let said = Diagnostic::new(
                Code::TypeMismatch,
                base_span,
                format!(
                    "`with` changes an object, light, material, pattern or camera, and this is {}",
                    coerce::shown(&other)
                ),
            );
            Err(ctx.fail(said))
        }
    }
}
