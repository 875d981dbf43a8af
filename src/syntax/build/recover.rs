//! stub
use super::Origin;
use super::items::Failure;
use super::{Grammar, Rule};
use crate::diag::{Code, Diagnostic};
use crate::syntax::ast::{Expr, Item, ItemKind};
use pest::Parser;

pub(super) fn items(text: &str, base: usize, origin: &Origin<'_>) -> (Vec<Item>, Vec<Diagnostic>) {
    let e = Grammar::parse(Rule::file, text).map_err(Failure::of).err().unwrap();
    let span = origin.span(base + e.at, base + e.at);
    (
        vec![Item { kind: ItemKind::Bad { defines: None }, span }],
        vec![Diagnostic::new(Code::Syntax, span, "this cannot be read")],
    )
}
pub(super) fn expression(text: &str, origin: &Origin<'_>) -> (Option<Expr>, Vec<Diagnostic>) {
    let mut pairs = match Grammar::parse(Rule::one_expression, text).map_err(Failure::of) {
        Ok(pairs) => pairs,
        Err(e) => {
            let span = origin.span(e.at, e.at);
            return (None, vec![Diagnostic::new(Code::Syntax, span, "this cannot be read")]);
        }
    };
    let mut builder = super::items::Builder::new(text, 0, origin);
    let e = builder.only_expression(pairs.next().unwrap());
    (Some(e), builder.found)
}
