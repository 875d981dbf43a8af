//! Checks of given properties against the table of kinds: unknown and doubled names, counts of values, types, bounds,
//! words, what is missing. All faults of a block are reported, each at its smallest place.
//!
//! What passes is normalised in place, so that builders read plain values: a grey becomes a colour, a direction a unit
//! vector, `on` a truth value, a function in a texture's place a pattern, a lone list of many values those values. This
//! module knows no kind and no property by name.

use super::coerce::{self, Misfit};
use super::table::{Block, Context, Kind, Outcome, Property, Reported, Type};
use super::value::{Given, Value};
use crate::diag::{Code, Diagnostic, Span};
use std::collections::HashMap;

/// Checks and normalises what a block was given. Reports every fault; an error where there was one, or where the block is
/// poisoned.
pub fn check_block(ctx: &mut dyn Context, block: &mut Block) -> Outcome<()> {
    let properties = check_given(ctx, block.kind, &mut block.given);
    let children = check_children(ctx, block);
    let missing = check_missing(ctx, block);
    properties.and(children).and(missing)?;
    if block.poisoned.is_empty() { Ok(()) } else { Err(Reported) }
}

/// The same for properties alone, of which none must be there: those of `with`.
pub fn check_given(ctx: &mut dyn Context, kind: &'static Kind, given: &mut [Given]) -> Outcome<()> {
    let mut outcome = check_doubles(ctx, kind, given);
    for g in given.iter_mut() {
        if let Err(reported) = check_property(ctx, kind, g) {
            outcome = Err(reported);
        }
    }
    outcome
}

/// How many properties a block may have before doubles are looked for by a table instead of pair by pair.
const PAIRWISE: usize = 16;

fn check_doubles(ctx: &mut dyn Context, kind: &'static Kind, given: &[Given]) -> Outcome<()> {
    let mut outcome = Ok(());
    let mut double = |first: &Given, second: &Given| {
        let repeats = property_of(kind, second).is_none_or(|p| p.repeats);
        if !repeats {
            outcome = Err(ctx.fail(
                Diagnostic::new(
                    Code::DuplicateProperty,
                    second.name_span,
                    format!("`{}` is given twice", second.name),
                )
                .label("again here")
                .also(first.name_span, "first here")
                .hint("keep one of the two; a copy with another value is written `… with { … }`"),
            ));
        }
    };
    if given.len() <= PAIRWISE {
        for (i, second) in given.iter().enumerate() {
            if let Some(first) = given[..i].iter().find(|first| same(first, second)) {
                double(first, second);
            }
        }
    } else {
        let mut first_of: HashMap<&str, &Given> = HashMap::new();
        for second in given {
            match first_of.get(&*second.name) {
                Some(first) => double(first, second),
                None => {
                    first_of.insert(&second.name, second);
                }
            }
        }
    }
    outcome
}

/// Whether two are given under one name.
fn same(first: &Given, second: &Given) -> bool {
    match (first.property, second.property) {
        (Some(first), Some(second)) => std::ptr::eq(first, second),
        _ => first.name == second.name,
    }
}

/// What the table says of a property: known since names were resolved, or looked up.
fn property_of(kind: &'static Kind, given: &Given) -> Option<&'static Property> {
    given.property.or_else(|| kind.property(&given.name))
}

fn check_property(ctx: &mut dyn Context, kind: &'static Kind, given: &mut Given) -> Outcome<()> {
    let Some(property) = property_of(kind, given) else {
        return if kind.open {
            Ok(())
        } else {
            Err(ctx.fail(unknown_property(kind, &given.name, given.name_span)))
        };
    };
    if is_one_that_stays(property, given) {
        return Ok(());
    }
    flatten_list(property, given);
    if property.many { check_many(ctx, property, given) } else { check_row(ctx, property, given) }
}

/// Whether there is one value, of the only type that the property takes, in the form that builders read: so are most.
#[inline]
fn is_one_that_stays(property: &Property, given: &Given) -> bool {
    matches!((property.takes, &given.values[..]), ([[kind]], [(value, _)]) if coerce::stays(*kind, value))
}

/// "`sphere` has no property `radus`", with the nearest, or all that there are.
pub fn unknown_property(kind: &Kind, name: &str, span: Span) -> Diagnostic {
    let names = || kind.properties().map(|p| p.name);
    let said =
        Diagnostic::new(Code::UnknownProperty, span, format!("`{}` has no property `{name}`", kind.name))
            .did_you_mean(name, names());
    if !said.hints.is_empty() {
        return said;
    }
    let said = match &of_others(name)[..] {
        [] => said,
        others => said.hint(format!("`{name}` is a property of {}", coerce::listed(others, "and"))),
    };
    let own: Vec<String> = kind.own.iter().map(|p| format!("`{}`", p.name)).collect();
    if own.is_empty() {
        said.hint(format!("`ogee docs {}` lists what it takes", kind.name))
    } else {
        said.hint(format!("it takes {}; see `ogee docs {}`", coerce::listed(&own, "and"), kind.name))
    }
}

/// The kinds that have a property of their own of this name, where they are few enough to tell anything.
fn of_others(name: &str) -> Vec<String> {
    const FEW: usize = 4;
    let has = |kind: &&&Kind| kind.own.iter().any(|p| p.name == name);
    let kinds: Vec<String> = super::kinds::ALL.iter().filter(has).map(|k| format!("`{}`", k.name)).collect();
    if kinds.len() <= FEW { kinds } else { Vec::new() }
}

/// A property that takes many values also takes one list of them, and so does one that takes several, unless it takes a list.
fn flatten_list(property: &Property, given: &mut Given) {
    let [(Value::List(list), span)] = &given.values[..] else { return };
    let takes_list = property.takes.iter().any(|row| matches!(row, [Type::List | Type::Any]));
    let several = property.takes.iter().any(|row| row.len() > 1);
    if property.many || (several && !takes_list) {
        let (list, span) = (list.clone(), *span);
        given.values = list.iter().map(|v| (v.clone(), span)).collect();
    }
}

fn check_many(ctx: &mut dyn Context, property: &'static Property, given: &mut Given) -> Outcome<()> {
    let &[[element]] = property.takes else {
        unreachable!("a property of many values has one type");
    };
    if given.values.is_empty() {
        return Err(ctx.fail(no_value(property, given)));
    }
    let mut outcome = Ok(());
    for (value, span) in &mut given.values {
        if let Err(reported) = coerce_or_report(ctx, property.name, &[*element], value, *span) {
            outcome = Err(reported);
        }
    }
    outcome
}

/// Finds the alternative that the values fit. Where none does, speaks of those that fit best.
fn check_row(ctx: &mut dyn Context, property: &'static Property, given: &mut Given) -> Outcome<()> {
    let misfits = |ctx: &dyn Context, row: &[Type], given: &Given| {
        row.iter().zip(&given.values).filter(|(t, (v, _))| !coerce::fits(ctx, **t, v)).count()
    };
    let n = given.values.len();
    let rows = || property.takes.iter().copied().filter(move |row| row.len() == n);
    if let Some(row) = rows().find(|row| misfits(ctx, row, given) == 0) {
        return coerce_values(ctx, property, given, |i| std::borrow::Cow::Borrowed(&row[i..=i]));
    }
    let Some(best) = rows().map(|row| misfits(ctx, row, given)).min() else {
        let said = if n == 0 { no_value(property, given) } else { wrong_count(property, given) };
        return Err(ctx.fail(said));
    };
    let candidates: Vec<&[Type]> = rows().filter(|row| misfits(ctx, row, given) == best).collect();
    coerce_values(ctx, property, given, |i| candidates.iter().map(|row| row[i]).collect())
}

fn coerce_values(
    ctx: &mut dyn Context,
    property: &Property,
    given: &mut Given,
    types: impl Fn(usize) -> std::borrow::Cow<'static, [Type]>,
) -> Outcome<()> {
    let mut outcome = Ok(());
    for (i, (value, span)) in given.values.iter_mut().enumerate() {
        let asked =
            Asked { name: property.name, optional: !property.required && property.default.is_empty() };
        if let Err(reported) = coerce_asked(ctx, &asked, &types(i), value, *span) {
            outcome = Err(reported);
        }
    }
    outcome
}

/// Makes a value the first of these types that it fits, or says what is wrong with it.
///
/// `name` is the property's; empty for a texture among arguments.
pub fn coerce_or_report(
    ctx: &mut dyn Context,
    name: &str,
    types: &[Type],
    value: &mut Value,
    span: Span,
) -> Outcome<()> {
    coerce_asked(ctx, &Asked { name, optional: false }, types, value, span)
}

/// For what a value is given.
struct Asked<'a> {
    /// The property; empty for a texture among arguments.
    name: &'a str,
    /// True where it can be left out, and nothing stands for it then.
    optional: bool,
}

fn coerce_asked(
    ctx: &mut dyn Context,
    asked: &Asked<'_>,
    types: &[Type],
    value: &mut Value,
    span: Span,
) -> Outcome<()> {
    let name = asked.name;
    let fit = types.iter().copied().find(|t| coerce::fits(ctx, *t, value));
    match fit.map(|t| coerce::coerce(ctx, t, value, span)) {
        Some(Ok(normal)) => {
            *value = normal;
            Ok(())
        }
        Some(Err(misfit)) => Err(report_misfit(ctx, asked, misfit, value, span)),
        None => {
            let said = wrong_type(&subject(name), name, types, value, span);
            Err(ctx.fail(said))
        }
    }
}

fn subject(name: &str) -> String {
    if name.is_empty() { "a texture".into() } else { format!("`{name}`") }
}

fn report_misfit(
    ctx: &mut dyn Context,
    asked: &Asked<'_>,
    misfit: Misfit,
    value: &Value,
    span: Span,
) -> Reported {
    let what = subject(asked.name);
    match misfit {
        Misfit::Reported(reported) => reported,
        Misfit::NotFinite => {
            let said = Diagnostic::new(
                Code::NotFinite,
                span,
                format!("{what} is {}", coerce::not_finite_word(value)),
            )
            .label("every number of a property must be finite")
            .hint("only `inf` makes infinities: give a number, or bound it, as in `min(r, 100)`");
            ctx.fail(said)
        }
        Misfit::Bounds { expected, hint } => {
            let said = Diagnostic::new(
                Code::BadProperty,
                span,
                format!("{what} must be {expected}, and this is {}", coerce::shown(value)),
            );
            let nothing = matches!(value, Value::Number(x) if *x == 0.0);
            let hint = if nothing && asked.optional {
                format!("leave {what} out where it is not wanted")
            } else {
                hint
            };
            ctx.fail(if hint.is_empty() { said } else { said.hint(hint) })
        }
    }
}

/// "`radius` takes a number, and this is a 3-vector", with a thing to try. Words that are none of the listed get a code of
/// their own.
pub fn wrong_type(what: &str, name: &str, types: &[Type], value: &Value, span: Span) -> Diagnostic {
    let words: Vec<&'static str> = types.iter().flat_map(|t| t.words().iter().copied()).collect();
    if let (Value::Word(word), false) = (value, words.is_empty()) {
        return Diagnostic::new(
            Code::UnknownWord,
            span,
            format!("{what} takes {}, not `{word}`", coerce::expected(types)),
        )
        .did_you_mean(word, words);
    }
    let said = Diagnostic::new(
        Code::TypeMismatch,
        span,
        format!("{what} takes {}, and this is {}", coerce::expected(types), coerce::shown(value)),
    );
    match coerce::remedy(name, types, value) {
        Some(hint) => said.hint(hint),
        None => said,
    }
}

fn no_value(property: &Property, given: &Given) -> Diagnostic {
    Diagnostic::new(Code::BadProperty, given.name_span, format!("`{}` needs a value", given.name))
        .label(format!("takes {}", coerce::forms(property)))
        .hint(format!("write it on the same line: `{}`", coerce::sample_use(property)))
}

fn wrong_count(property: &Property, given: &Given) -> Diagnostic {
    let n = given.values.len();
    let first = given.values.first().map_or(given.name_span, |(_, span)| *span);
    let values = first.to(given.span());
    let said = Diagnostic::new(
        Code::BadProperty,
        if n == 1 { first } else { values },
        format!(
            "`{}` takes {}, and this gives {n} value{}",
            given.name,
            coerce::forms(property),
            if n == 1 { "" } else { "s" }
        ),
    );
    let numbers: Option<Vec<f64>> =
        given.values.iter().map(|(v, _)| if let Value::Number(x) = v { Some(*x) } else { None }).collect();
    let wants_vector = property.takes.iter().any(|row| row.iter().any(|t| coerce::dimension(*t) == Some(n)));
    match numbers {
        Some(numbers) if wants_vector => said.hint(format!(
            "write the vector in angle brackets: `{} {}`",
            given.name,
            coerce::vector(&numbers)
        )),
        _ if property.is_flag() && property.takes.len() == 1 => {
            said.hint(format!("write `{}` alone, with a line end or `;` after it", given.name))
        }
        _ => said.hint(format!("write it like `{}`", coerce::sample_use(property))),
    }
}

fn check_children(ctx: &mut dyn Context, block: &Block) -> Outcome<()> {
    if block.kind.children {
        return Ok(());
    }
    let mut outcome = Ok(());
    for child in &block.children {
        let (what, span) = match child {
            crate::scene::Node::Object(object) => ("an object", object.span),
            crate::scene::Node::Light(light) => ("a light", light.span),
        };
        outcome = Err(ctx.fail(
            Diagnostic::new(
                Code::NotPlaceable,
                if span.source == block.span.source { span } else { block.kind_span },
                format!("{what} cannot be placed inside `{}`", block.kind.name),
            )
            .also(block.kind_span, "inside this block")
            .hint("put both into a `group { … }`, or close the block before it"),
        ));
    }
    outcome
}

fn check_missing(ctx: &mut dyn Context, block: &Block) -> Outcome<()> {
    let there = |p: &Property| {
        block.given.iter().any(|g| *g.name == *p.name) || block.poisoned.iter().any(|(n, _)| **n == *p.name)
    };
    let missing = || block.kind.own.iter().filter(|p| p.required && !there(p));
    let Some(first) = missing().next() else { return Ok(()) };
    let missing: Vec<&Property> = missing().collect();
    let names: Vec<String> = missing.iter().map(|p| format!("`{}`", p.name)).collect();
    let nearest_unknown = block.given.iter().find(|g| {
        block.kind.property(&g.name).is_none() && crate::diag::nearest(&g.name, [first.name]).is_some()
    });
    if nearest_unknown.is_some() && missing.len() == 1 {
        return Err(Reported);
    }
    Err(ctx.fail(
        Diagnostic::new(
            Code::MissingProperty,
            block.kind_span,
            format!("`{}` lacks {}", block.kind.name, coerce::listed(&names, "and")),
        )
        .label(format!("needs {}", coerce::listed(&names, "and")))
        .hint(format!("add `{}`: {}", coerce::sample_use(first), first.doc)),
    ))
}
