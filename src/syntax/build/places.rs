//! Where the items of a sound text stand, brace by brace, for the formatter.

use std::collections::HashMap;

use pest::Parser;
use pest::iterators::Pair;

use super::{Grammar, ParseLimits, Rule, outline, runs};

/// What an item is, as far as its layout goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::syntax) enum ItemSort {
    /// A word and its values, block or flag: the word is no operand.
    Entry,
    /// `let`, `fn`, `if` and the like.
    Statement,
    /// An expression.
    Placement,
}

/// An item's bytes.
#[derive(Clone, Copy, Debug)]
pub(in crate::syntax) struct ItemPlace {
    pub start: usize,
    pub end: usize,
    pub sort: ItemSort,
}

/// The items of a text.
pub(in crate::syntax) struct Places {
    /// Those of the file.
    pub top: Vec<ItemPlace>,
    /// Those between braces, by the opening brace.
    pub within: HashMap<usize, Vec<ItemPlace>>,
}

/// The places of the items of a text; nothing where it cannot be read.
pub(in crate::syntax) fn places(text: &str, limits: ParseLimits) -> Option<Places> {
    let cuts = outline::outline(text, limits.depth)?;
    let mut places = Places { top: Vec::new(), within: HashMap::new() };
    for (start, end) in runs(text.len(), &cuts) {
        let file = Grammar::parse(Rule::file, &text[start..end]).ok()?.next()?;
        places.top.extend(items(&file, start));
        collect(file, start, &mut places);
    }
    Some(places)
}

fn items(parent: &Pair<'_, Rule>, base: usize) -> Vec<ItemPlace> {
    let place = |item: Pair<'_, Rule>| {
        let sort = match item.as_rule() {
            Rule::EOI => return None,
            Rule::entry => ItemSort::Entry,
            Rule::placement => ItemSort::Placement,
            _ => ItemSort::Statement,
        };
        let span = item.as_span();
        Some(ItemPlace { start: base + span.start(), end: base + span.end(), sort })
    };
    parent.clone().into_inner().filter_map(place).collect()
}

/// Visits every pair; by a list, not by recursion.
fn collect(file: Pair<'_, Rule>, base: usize, places: &mut Places) {
    let mut waiting = vec![file];
    while let Some(pair) = waiting.pop() {
        if pair.as_rule() == Rule::body {
            places.within.insert(base + pair.as_span().start(), items(&pair, base));
        }
        waiting.extend(pair.into_inner());
    }
}
