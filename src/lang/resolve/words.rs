//! Bare words: a lone name in a property's place may be a word of an enumeration or a label instead of a variable.

use super::Resolver;
use crate::lang::kinds;
use crate::lang::resolve::program::{Expr, ExprKind, Word};
use crate::lang::table::{Kind, Property, Type};
use crate::lang::value::Value;
use crate::syntax::ast;

/// Whether a property can stand without a value: a flag, or a truth value alone (`closed`, `smooth`).
pub fn is_flag(property: &Property) -> bool {
    property.takes.iter().any(|row| matches!(row, [] | [Type::Bool]))
}

/// Whether any block has a property of this name.
pub fn is_property(name: &str) -> bool {
    kinds::ALL.iter().any(|kind| kind.property(name).is_some())
}

/// What the place of a value takes, gathered over all blocks that may be meant.
#[derive(Default)]
struct Taken {
    words: Vec<&'static str>,
    labels: bool,
    others: bool,
}

impl Taken {
    fn add(&mut self, property: &Property, index: usize) {
        for row in property.takes {
            match row.get(if property.many { 0 } else { index }) {
                Some(Type::Word(words)) => self.words.extend(*words),
                Some(Type::Label) => self.labels = true,
                Some(Type::Bool) | None => {}
                Some(_) => self.others = true,
            }
        }
    }
}

fn taken(kind: Option<&'static Kind>, property: &str, index: usize) -> Taken {
    let mut taken = Taken::default();
    match kind {
        Some(kind) => kind.property(property).into_iter().for_each(|found| taken.add(found, index)),
        None => {
            kinds::ALL.iter().filter_map(|k| k.property(property)).for_each(|p| taken.add(p, index));
        }
    }
    taken
}

impl<'a> Resolver<'a> {
    /// A property's values, with bare words where the property takes them.
    pub(super) fn property_values(
        &mut self,
        kind: Option<&'static Kind>,
        property: &'a ast::Property,
    ) -> Vec<Expr> {
        let values = property.values.iter().enumerate();
        values
            .map(|(i, value)| match &value.kind {
                ast::ExprKind::Name(name) => self.word_or_name(kind, &property.name.name, i, name, value),
                _ => self.expr(value),
            })
            .collect()
    }

    fn word_or_name(
        &mut self,
        kind: Option<&'static Kind>,
        property: &str,
        index: usize,
        name: &'a str,
        value: &'a ast::Expr,
    ) -> Expr {
        let taken = taken(kind, property, index);
        let listed_word = taken.words.contains(&name);
        let words_only = !taken.others;
        let bare = if words_only && (listed_word || taken.labels) {
            true
        } else if self.in_scope(name) {
            false
        } else {
            listed_word || taken.labels || (words_only && !taken.words.is_empty())
        };
        if bare {
            let word: Word = self.word(name);
            return Expr { kind: ExprKind::Constant(Box::new(Value::Word(word))), span: value.span };
        }
        self.name(name, value.span, &taken.words)
    }
}
