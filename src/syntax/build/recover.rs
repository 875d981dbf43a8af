//! Mending a run of items that cannot be read. The brackets of its text close, so every fault lies in one item of one
//! pair of braces: the faulty item is found by stepping from item to item, reported, and struck out with a byte that the
//! grammar takes for a bad item. What is left is read as ever, with all that is sound in it.

use std::collections::HashSet;
use std::sync::Mutex;

use pest::Parser;

use super::diagnose::{self, Fault};
use super::items::{Builder, Failure, is_reserved, near_kind, parse_struck};
use super::lexer::{Pieces, Sort, continues_word};
use super::outline::{Event, Events, outline};
use super::{Grammar, Origin, Rule};
use crate::diag::{Code, Diagnostic};
use crate::syntax::ast::{Expr, Ident, Item, ItemKind};

/// Faults reported of one top-level item; what follows is struck out unsaid. More would not be read, and the work of
/// mending grows with their number times the item's length.
const MOST_FAULTS: usize = 64;

/// Reads a text of whole items, one or more of which are faulty.
pub(super) fn items(text: &str, base: usize, origin: &Origin<'_>) -> (Vec<Item>, Vec<Diagnostic>) {
    let _detail = Detail::on();
    let mut mender = Mender {
        work: text.to_owned(),
        text,
        base,
        origin,
        found: Vec::new(),
        struck: Vec::new(),
        seen: HashSet::new(),
    };
    mender.region(0, text.len());
    mender.struck.sort_by_key(|(start, _)| *start);
    let Mender { work, mut found, struck, .. } = mender;
    match parse_struck(&work, base, origin, &struck) {
        Ok((items, more)) => {
            found.extend(more);
            (items, found)
        }
        Err(failure) => {
            let span = origin.span(base, base + text.len());
            if found.is_empty() {
                found.push(unreadable(&failure, base, text, origin));
            }
            (vec![Item { kind: ItemKind::Bad { defines: None }, span }], found)
        }
    }
}

/// Reads one expression that fills the text.
pub(super) fn expression(text: &str, origin: &Origin<'_>) -> (Option<Expr>, Vec<Diagnostic>) {
    if outline(text, origin.limits.depth).is_none() {
        let repaired = super::repair::repair(origin.source, text, origin.limits.depth);
        return (None, repaired.found);
    }
    let _detail = Detail::on();
    match Grammar::parse(Rule::one_expression, text).map_err(Failure::of) {
        Ok(mut pairs) => {
            let mut builder = Builder::new(text, 0, origin);
            let whole = pairs.next().expect("a parse of `one_expression` yields its pair");
            let value = builder.only_expression(whole);
            (Some(value), builder.found)
        }
        Err(failure) if failure.too_deep => (None, vec![unreadable(&failure, 0, text, origin)]),
        Err(failure) => {
            let fault = diagnose::expression(text, failure.at);
            (None, vec![fault.diagnostic(0, origin)])
        }
    }
}

fn unreadable(failure: &Failure, base: usize, text: &str, origin: &Origin<'_>) -> Diagnostic {
    if failure.too_deep {
        return origin.too_deep(origin.span(base, base + text.len()));
    }
    let at = floor(text, failure.at);
    let end = text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
    Diagnostic::new(Code::Syntax, origin.span(base + at, base + end), "this cannot be read")
}

/// The character that holds a byte.
fn floor(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// Has pest say at which character it gave up, not only at which rule. The switch is the process's; it is on while any
/// text is being mended, so that what is found does not depend on what other threads do.
struct Detail;

static MENDING: Mutex<usize> = Mutex::new(0);

impl Detail {
    fn on() -> Detail {
        let mut n = MENDING.lock().unwrap_or_else(|e| e.into_inner());
        *n += 1;
        pest::set_error_detail(true);
        Detail
    }
}

impl Drop for Detail {
    fn drop(&mut self) {
        let mut n = MENDING.lock().unwrap_or_else(|e| e.into_inner());
        *n -= 1;
        pest::set_error_detail(*n > 0);
    }
}

struct Mender<'a> {
    /// The text with bad items struck out; as long as `text`.
    work: String,
    text: &'a str,
    base: usize,
    origin: &'a Origin<'a>,
    found: Vec<Diagnostic>,
    /// What the struck-out items would have named, by where they begin.
    struck: Vec<(usize, Option<Ident>)>,
    /// The braces that have been looked into.
    seen: HashSet<usize>,
}

impl Mender<'_> {
    /// Strikes out the bad items of `start..end`, a file's worth or what stands between two braces.
    fn region(&mut self, start: usize, end: usize) {
        let cuts = outline(&self.work[start..end], usize::MAX).unwrap_or_default();
        let ends: Vec<usize> = cuts.iter().map(|&c| start + c as usize).chain([end]).collect();
        let mut from = start;
        for to in ends {
            if Grammar::parse(Rule::file, &self.work[from..to]).is_err() {
                self.steps(from, to);
            }
            from = to;
        }
    }

    /// Goes from item to item.
    fn steps(&mut self, start: usize, end: usize) {
        let mut at = start;
        let mut before: Option<(usize, usize)> = None;
        while let Some(item) = self.next_item(at, end) {
            match Grammar::parse(Rule::one_item, &self.work[item..end]) {
                Ok(pairs) => {
                    let len = pairs.last().map_or(1, |pair| pair.as_span().end());
                    at = item + len.max(1);
                    before = Some((item, at));
                }
                Err(error) => {
                    let failure = Failure::of(error);
                    let place = floor(&self.work, item + failure.at);
                    if failure.too_deep || self.found.len() >= MOST_FAULTS {
                        let whole = self.origin.span(self.base + item, self.base + end);
                        if failure.too_deep {
                            self.found.push(self.origin.too_deep(whole));
                        }
                        self.strike(item, end, None);
                        return;
                    }
                    let (item, place, before_it) = self.further(item, place, before, end);
                    (at, before) = (item, None);
                    match self.braces_around(item, place, end) {
                        Some((open, close)) => self.inside(open, close),
                        None => at = self.fault(item, place, before_it, end),
                    }
                }
            }
        }
    }

    /// Mends what stands between two braces. In a block of another language, nothing can be mended.
    fn inside(&mut self, open: usize, close: usize) {
        if self.is_foreign(open) && close > open + 1 {
            self.strike(open + 1, close, None);
        } else {
            self.region(open + 1, close);
        }
    }

    /// Whether a brace opens a block of another language: a word that is no kind nor near one heads its line.
    fn is_foreign(&self, open: usize) -> bool {
        let before = self.work[..open].trim_end();
        let word = before.rsplit(|c: char| !continues_word(c)).next().unwrap_or_default();
        let heads_line = before[..before.len() - word.len()].trim_end_matches([' ', '\t']);
        !word.is_empty()
            && !is_reserved(word)
            && near_kind(word).is_none()
            && (heads_line.is_empty() || heads_line.ends_with(['\n', '{', '}', ';']))
    }

    /// Where reading stopped at the very beginning of an item, the item before it may have broken off there: then that is
    /// the item at fault, and the place is where it broke off.
    fn further(
        &self,
        item: usize,
        place: usize,
        before: Option<(usize, usize)>,
        end: usize,
    ) -> (usize, usize, Option<(usize, usize)>) {
        let unchanged = (item, place, before);
        let head = Pieces::new(&self.work, item, end).next();
        let at_once = place == item || head.is_some_and(|p| p.sort == Sort::Sign && place <= p.end);
        let Some((start, _)) = before.filter(|_| at_once) else { return unchanged };
        let Err(error) = Grammar::parse(Rule::file, &self.work[start..end]) else { return unchanged };
        let broke_off = floor(&self.work, start + Failure::of(error).at);
        let comma_before_item = self.work[item..].starts_with(',')
            && Pieces::new(&self.work, item + 1, end).next().is_some_and(|p| p.sort == Sort::Word);
        let point = self.work[item..].starts_with('.');
        if !point && broke_off <= item + 1 || comma_before_item {
            unchanged
        } else {
            (start, broke_off, None)
        }
    }

    /// Where the next item begins, past blanks, comments and semicolons.
    fn next_item(&self, at: usize, end: usize) -> Option<usize> {
        Pieces::new(&self.work, at, end).find(|p| p.text != ";").map(|p| p.start)
    }

    /// The braces behind `item` that hold `place` and have not been looked into: the outermost of another language, else
    /// the innermost, so that a fault many braces deep is not read for again at each of them.
    fn braces_around(&mut self, item: usize, place: usize, end: usize) -> Option<(usize, usize)> {
        let mut open = Vec::new();
        for event in Events::new(&self.work[item..end]) {
            match event {
                Event::Open { at, byte } if item + at < place => open.push((item + at, byte)),
                Event::OpenHole { at } if item + at < place => open.push((item + at, b'"')),
                Event::Close { at, .. } | Event::CloseHole { at } if item + at < place => {
                    open.pop();
                }
                Event::LineEnd { .. } | Event::Control { .. } => {}
                _ => break,
            }
        }
        open.retain(|(at, byte)| *byte == b'{' && !self.seen.contains(at));
        let foreign = open.iter().find(|(at, _)| self.is_foreign(*at));
        let (open, _) = *foreign.or(open.last())?;
        self.seen.insert(open);
        let group = Pieces::new(&self.work, open, end).next()?;
        Some((open, group.end - 1))
    }

    /// Reports a fault at `place` in the item that begins at `item`, strikes the item out, and returns where to go on.
    fn fault(&mut self, item: usize, place: usize, before: Option<(usize, usize)>, end: usize) -> usize {
        let Fault { start, end: stop, defines, .. } = {
            let fault = diagnose::item(&self.work, item, place, before, end);
            if !self.origin.touches_insertion(self.base + fault.start, self.base + fault.end) {
                self.found.push(fault.diagnostic(self.base, self.origin));
            }
            fault
        };
        let name = defines.map(|(from, to)| Ident {
            name: self.text[from..to].into(),
            span: self.origin.span(self.base + from, self.base + to),
        });
        self.strike(start, stop, name);
        stop
    }

    fn strike(&mut self, start: usize, end: usize, defines: Option<Ident>) {
        self.work.replace_range(start..end, &"\u{1}".repeat(end - start));
        self.struck.retain(|(at, _)| *at < start || *at >= end);
        self.struck.push((start, defines));
    }
}
