//! Diagnostics for programs: an object a line, then a summary. The schema is described in `docs/diagnostics.md`.

use super::{Counts, Diagnostic, severity_word};
use crate::diag::{SourceMap, Span};
use serde::Serialize;

/// The version of the schema: it changes when a key changes its meaning or goes, not when one is added.
pub const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct Report<'a> {
    schema: u32,
    severity: &'static str,
    code: &'static str,
    message: &'a str,
    file: Option<&'a str>,
    span: Option<Place>,
    labels: Vec<Note<'a>>,
    hints: &'a [String],
    trace: Vec<Note<'a>>,
}

#[derive(Serialize)]
struct Place {
    start: u32,
    end: u32,
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
}

#[derive(Serialize)]
struct Note<'a> {
    file: &'a str,
    span: Place,
    text: &'a str,
}

#[derive(Serialize)]
struct Summary {
    summary: Counts,
}

/// One line of JSON for each diagnostic, in the order given, then `{"summary": {"errors": n, "warnings": n}}`.
pub fn json(diagnostics: &[Diagnostic], sources: &SourceMap) -> String {
    let mut text = String::new();
    for diagnostic in diagnostics {
        push_line(&mut text, &report(diagnostic, sources));
    }
    push_line(&mut text, &Summary { summary: Counts::of(diagnostics) });
    text
}

fn push_line(text: &mut String, value: &impl Serialize) {
    text.push_str(&serde_json::to_string(value).expect("plain data with text keys is always JSON"));
    text.push('\n');
}

fn report<'a>(diagnostic: &'a Diagnostic, sources: &'a SourceMap) -> Report<'a> {
    let primary = diagnostic.span.filter(|_| !diagnostic.label.is_empty());
    let primary = primary.map(|span| note(span, &diagnostic.label, sources));
    let others = diagnostic.labels.iter().map(|label| note(label.span, &label.text, sources));
    Report {
        schema: SCHEMA,
        severity: severity_word(diagnostic.severity),
        code: diagnostic.code.text(),
        message: &diagnostic.message,
        file: diagnostic.span.map(|span| sources.name(span.source)),
        span: diagnostic.span.map(|span| place(span, sources)),
        labels: primary.into_iter().chain(others).collect(),
        hints: &diagnostic.hints,
        trace: diagnostic.trace.iter().map(|frame| note(frame.span, &frame.text, sources)).collect(),
    }
}

fn note<'a>(span: Span, text: &'a str, sources: &'a SourceMap) -> Note<'a> {
    Note { file: sources.name(span.source), span: place(span, sources), text }
}

fn place(span: Span, sources: &SourceMap) -> Place {
    let from = sources.line_column(span.source, span.start);
    let to = sources.line_column(span.source, span.end);
    Place {
        start: span.start,
        end: span.end,
        line: from.line,
        column: from.column,
        end_line: to.line,
        end_column: to.column,
    }
}
