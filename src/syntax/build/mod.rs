//! Text to syntax tree: a scan of the brackets cuts the text into runs of whole items, pest reads each run, the builder
//! turns its pairs into the tree, and a run that cannot be read is mended item by item (`recover`).
//!
//! Nothing here looks up a name, and nothing here stops at the first fault.

use rayon::prelude::*;

use super::ast;
use crate::diag::{Code, Diagnostic, SourceId, Span};

mod diagnose;
mod expressions;
mod items;
mod lexer;
mod literals;
mod operators;
mod outline;
mod places;
mod recover;
mod repair;
mod statements;

pub(crate) use lexer::continues_word;
pub(super) use lexer::{Piece, Pieces, Sort};
pub(super) use places::{ItemPlace, ItemSort, Places, places};

/// The block kinds, as the grammar reserves them. A test holds this equal to the grammar and to the table of kinds.
pub const KINDS: &[&str] = &[
    "camera",
    "render",
    "light",
    "material",
    "sphere",
    "plane",
    "disc",
    "rect",
    "box",
    "cylinder",
    "cone",
    "torus",
    "triangle",
    "mesh",
    "group",
    "spline",
    "patch",
    "tube",
    "lathe",
    "extrude",
    "implicit",
    "union",
    "intersection",
    "difference",
    "skin",
    "model",
    "skeleton",
    "joint",
    "tip",
    "pose",
];

/// The words that bind a program together; like the kinds, no name may be one.
pub const KEYWORDS: &[&str] =
    &["let", "var", "fn", "return", "if", "else", "for", "in", "while", "import", "with", "true", "false"];

/// Guards of the parser.
#[derive(Clone, Copy, Debug)]
pub struct ParseLimits {
    /// How deeply brackets, braces and operators may nest.
    pub depth: usize,
    /// Whether an item may be any expression, also one that is never placed: in a dialogue it is answered.
    pub answers: bool,
}

impl ParseLimits {
    /// Those of a file.
    pub fn nesting(depth: usize) -> Self {
        Self { depth, answers: false }
    }
}

impl Default for ParseLimits {
    fn default() -> Self {
        Self::nesting(256)
    }
}

use grammar::{Grammar, Rule};

/// What `pest` makes of the grammar; a module of its own, because the rules of the grammar are documented there.
#[allow(missing_docs)]
mod grammar {
    use pest_derive::Parser;

    #[derive(Parser)]
    #[grammar = "../grammar/ogee.pest"]
    pub(super) struct Grammar;
}

/// A run of items is at least this many bytes: small enough that a run's tokens stay in the processor's caches and
/// that a file divides among threads, large enough that starting on a run costs nothing.
const RUN_BYTES: usize = 32 << 10;

/// Reads a file. Always returns a tree (bad items are [`ast::ItemKind::Bad`]) and everything that is wrong with the text,
/// in the order of the text.
pub fn parse_file(source: SourceId, text: &str, limits: ParseLimits) -> (ast::File, Vec<Diagnostic>) {
    let span = Span::new(source, 0, text.len());
    let (items, mut found) = match outline::outline(text, limits.depth) {
        Some(cuts) => parse_runs(text, &cuts, &Origin { source, text, limits, insertions: &[] }),
        None => parse_repaired(source, text, limits),
    };
    found.sort_by_key(|d| d.span.map_or(0, |s| s.start));
    (ast::File { items, span }, found)
}

/// Reads one expression that fills the text, for `ogee eval` and the REPL.
pub fn parse_expression(
    source: SourceId,
    text: &str,
    limits: ParseLimits,
) -> (Option<ast::Expr>, Vec<Diagnostic>) {
    recover::expression(text, &Origin { source, text, limits, insertions: &[] })
}

/// Where a text comes from, and how its offsets lead back to what the person wrote.
struct Origin<'a> {
    source: SourceId,
    /// What the person wrote.
    text: &'a str,
    limits: ParseLimits,
    /// Offsets, in the text that is parsed, of the bytes that [`repair`] has put in; sorted.
    insertions: &'a [u32],
}

impl Origin<'_> {
    /// E0003 at the first character of a span.
    fn too_deep(&self, span: Span) -> Diagnostic {
        let covered = self.text.get(span.start as usize..span.end as usize).unwrap_or_default();
        let first = covered.chars().next().map_or(0, char::len_utf8) as u32;
        too_deep(Span { end: span.start + first, ..span }, self.limits.depth)
    }

    /// The span, in the person's text, of the bytes `start..end` of the text that is parsed.
    fn span(&self, start: usize, end: usize) -> Span {
        if self.insertions.is_empty() {
            return Span::new(self.source, start, end);
        }
        let original = |at: usize| at - self.insertions.partition_point(|&i| (i as usize) < at);
        Span::new(self.source, original(start), original(end).max(original(start)))
    }

    /// The person's text under a span, with its white space drawn together.
    fn snippet(&self, span: Span) -> String {
        let text = self.text.get(span.start as usize..span.end as usize).unwrap_or_default();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Whether a byte that was put in lies in `start..=end`: what is wrong there has been said already.
    fn touches_insertion(&self, start: usize, end: usize) -> bool {
        let first = self.insertions.partition_point(|&i| (i as usize) < start);
        self.insertions.get(first).is_some_and(|&i| i as usize <= end)
    }
}

/// A text whose brackets do not close: they are mended first, which says what is wrong with them.
fn parse_repaired(source: SourceId, text: &str, limits: ParseLimits) -> (Vec<ast::Item>, Vec<Diagnostic>) {
    let repaired = repair::repair(source, text, limits.depth);
    let origin = Origin { source, text, limits, insertions: &repaired.insertions };
    let Some(cuts) = outline::outline(&repaired.text, limits.depth) else {
        let bad =
            ast::Item { kind: ast::ItemKind::Bad { defines: None }, span: Span::new(source, 0, text.len()) };
        return (vec![bad], repaired.found);
    };
    let (items, mut found) = parse_runs(&repaired.text, &cuts, &origin);
    found.extend(repaired.found);
    (items, found)
}

/// Parses the runs between the cuts, on all threads where that pays. The order is that of the text.
fn parse_runs(text: &str, cuts: &[u32], origin: &Origin<'_>) -> (Vec<ast::Item>, Vec<Diagnostic>) {
    let runs = runs(text.len(), cuts);
    let parse = |run: &(usize, usize)| parse_run(text, *run, cuts, origin);
    let alone = runs.len() < 4 || std::thread::available_parallelism().is_ok_and(|n| n.get() == 1);
    let parsed: Vec<_> =
        if alone { runs.iter().map(parse).collect() } else { runs.par_iter().map(parse).collect() };
    let mut items = Vec::with_capacity(parsed.iter().map(|(items, _)| items.len()).sum());
    let mut found = Vec::new();
    for (run_items, run_found) in parsed {
        items.extend(run_items);
        found.extend(run_found);
    }
    (items, found)
}

/// Joins the pieces between cuts to runs of [`RUN_BYTES`] or more.
fn runs(len: usize, cuts: &[u32]) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut start = 0;
    for &cut in cuts {
        if cut as usize - start >= RUN_BYTES {
            runs.push((start, cut as usize));
            start = cut as usize;
        }
    }
    runs.push((start, len));
    runs
}

/// One run: as a whole where it is without fault, else piece by piece.
fn parse_run(
    text: &str,
    (start, end): (usize, usize),
    cuts: &[u32],
    origin: &Origin<'_>,
) -> (Vec<ast::Item>, Vec<Diagnostic>) {
    if let Ok(parsed) = items::parse(&text[start..end], start, origin) {
        return parsed;
    }
    let (mut items, mut found) = (Vec::new(), Vec::new());
    let inner = &cuts[cuts.partition_point(|&c| c as usize <= start)..];
    let ends = inner.iter().map(|&c| c as usize).take_while(|&c| c < end).chain([end]);
    let mut from = start;
    for to in ends {
        let (more_items, more_found) = items::parse(&text[from..to], from, origin)
            .unwrap_or_else(|_| recover::items(&text[from..to], from, origin));
        items.extend(more_items);
        found.extend(more_found);
        from = to;
    }
    (items, found)
}

/// E0003, that a place is nested too deeply.
fn too_deep(span: Span, limit: usize) -> Diagnostic {
    Diagnostic::new(Code::TooDeep, span, format!("this is nested more than {limit} levels deep"))
        .label("brackets and operators nest past the limit here")
        .hint("name parts of it with `let`, or raise the limit with `--limit nesting=N`")
}
