//! Diagnostics for people, drawn by miette from a report made by hand.
//!
//! miette's own sources are scanned from their first byte for every label; [`Excerpt`] answers with a window of the
//! lines that matter, found through the line table, so that a file of any size costs nothing. Lines longer than a
//! screen are clipped around the fault.

use super::{Counts, Diagnostic, Severity, harmless, severity_word};
use crate::diag::{Frame, SourceId, SourceMap, Span};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, SourceSpan, ThemeCharacters};
use miette::{MietteSpanContents, SourceCode, SpanContents, ThemeStyles};
use std::fmt::{self, Write as _};

/// How many diagnostics are shown; the rest are counted. A person mends the first few and runs again.
const MOST_SHOWN: usize = 20;
/// A line of more bytes than this is shown in part: a screen or two of text.
const LONG_LINE: usize = 400;
/// What is shown of a long line on either side of the fault, in bytes.
const CLIP_MARGIN: usize = 60;
/// How many steps of a trace are shown at its inner and outer end.
const TRACE_ENDS: [usize; 2] = [8, 3];

/// How the output looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Colours by escape sequences.
    pub colour: bool,
    /// Columns of the terminal.
    pub width: usize,
}

impl Style {
    /// Without colours.
    pub fn plain(width: usize) -> Self {
        Style { colour: false, width }
    }
}

/// The first diagnostics in the order given, each with its excerpt, hints and trace, and how many more there are.
pub fn human(diagnostics: &[Diagnostic], sources: &SourceMap, style: Style) -> String {
    let mut text = String::new();
    for diagnostic in most_telling(diagnostics) {
        let report = Report::new(diagnostic, sources);
        for part in std::iter::once(&report).chain(&report.elsewhere) {
            let drawn = handler(part, style).render_report(&mut text, part);
            drawn.expect("excerpts give every label's text, and a string takes it");
        }
        push_trace(&mut text, &diagnostic.trace, sources);
        text.push('\n');
    }
    if diagnostics.len() > MOST_SHOWN {
        let hidden = diagnostics.len() - MOST_SHOWN;
        let _ = writeln!(text, "… and {hidden} more of the {}", Counts::of(diagnostics));
    }
    if style.colour { only_colours(&text) } else { harmless(&text).into_owned() }
}

/// The first, errors before warnings where not all can be shown.
fn most_telling(diagnostics: &[Diagnostic]) -> Vec<&Diagnostic> {
    let mut shown: Vec<&Diagnostic> = diagnostics.iter().collect();
    if shown.len() > MOST_SHOWN {
        shown.sort_by_key(|d| std::cmp::Reverse(d.severity));
        shown.truncate(MOST_SHOWN);
    }
    shown
}

/// Draws one report. The theme's sign for its severity carries the code: `error[E0101]: message`.
fn handler(report: &Report<'_>, style: Style) -> GraphicalReportHandler {
    let styles = if style.colour { ThemeStyles::ansi() } else { ThemeStyles::none() };
    let mut characters = ThemeCharacters::unicode();
    for sign in [&mut characters.error, &mut characters.warning, &mut characters.advice] {
        sign.clone_from(&report.heading);
    }
    GraphicalReportHandler::new_themed(GraphicalTheme { characters, styles })
        .with_width(style.width.clamp(40, 200))
        .with_links(false)
        .with_context_lines(1)
        .without_syntax_highlighting()
}

/// The calls that led there, innermost first, the middle of a long trace left out.
fn push_trace(text: &mut String, trace: &[Frame], sources: &SourceMap) {
    let [inner, outer] = TRACE_ENDS;
    let left_out = trace.len().saturating_sub(inner + outer);
    for (i, frame) in trace.iter().enumerate() {
        if left_out > 1 && (inner..inner + left_out).contains(&i) {
            if i == inner {
                let _ = writeln!(text, "  … {left_out} more calls");
            }
            continue;
        }
        let what = frame.text.replace('\n', " ");
        let _ = writeln!(text, "  in {what}, at {}", sources.place(frame.span));
    }
}

/// What miette draws: a diagnostic, or one of its labels that stands elsewhere.
struct Report<'a> {
    heading: String,
    severity: miette::Severity,
    message: String,
    labels: Vec<LabeledSpan>,
    source: Option<Excerpt<'a>>,
    help: Option<String>,
    elsewhere: Vec<Report<'a>>,
}

impl<'a> Report<'a> {
    fn new(diagnostic: &Diagnostic, sources: &'a SourceMap) -> Self {
        let mut report = Report {
            heading: format!("{}[{}]:", severity_word(diagnostic.severity), diagnostic.code.text()),
            severity: match diagnostic.severity {
                Severity::Error => miette::Severity::Error,
                Severity::Warning => miette::Severity::Warning,
            },
            message: diagnostic.message.clone(),
            labels: Vec::new(),
            source: None,
            help: (!diagnostic.hints.is_empty()).then(|| diagnostic.hints.join("\n")),
            elsewhere: Vec::new(),
        };
        if let Some(span) = diagnostic.span {
            report.underline(span, &diagnostic.label, true, sources);
        }
        for label in &diagnostic.labels {
            let beside = diagnostic.span.is_some_and(|span| can_share_excerpt(span, label.span, sources));
            if beside {
                report.underline(label.span, &label.text, false, sources);
            } else {
                report.elsewhere.push(Report::elsewhere(label.span, &label.text, sources));
            }
        }
        report
    }

    fn elsewhere(span: Span, text: &str, sources: &'a SourceMap) -> Self {
        let mut report = Report {
            heading: "note:".to_owned(),
            severity: miette::Severity::Advice,
            message: text.to_owned(),
            labels: Vec::new(),
            source: None,
            help: None,
            elsewhere: Vec::new(),
        };
        report.underline(span, "", true, sources);
        report
    }

    /// Adds an underline, or, in an empty file, which has nothing to underline, names the file in the message.
    fn underline(&mut self, span: Span, label: &str, primary: bool, sources: &'a SourceMap) {
        if sources.text(span.source).is_empty() {
            let _ = write!(self.message, " ({} is empty)", sources.name(span.source));
            return;
        }
        let span = visible(span, sources);
        let label = (!label.is_empty()).then(|| label.to_owned());
        let place = (span.start as usize, (span.end - span.start) as usize);
        self.labels.push(match primary {
            true => LabeledSpan::new_primary_with_span(label, place),
            false => LabeledSpan::new_with_span(label, place),
        });
        self.source = Some(Excerpt { sources, id: span.source });
    }
}

/// Two labels are drawn in one excerpt where they stand in one file, and not on one endless line.
fn can_share_excerpt(a: Span, b: Span, sources: &SourceMap) -> bool {
    let long = |span: Span| {
        let line = sources.line_index(span.source, span.start as usize);
        sources.lines(span.source, line, line).len() > LONG_LINE
    };
    a.source == b.source
        && a != b
        && (a.start.abs_diff(b.start) < LONG_LINE as u32 / 2 || !(long(a) || long(b)))
}

/// The part of a span that is underlined: its first line, and at the end of the text its last character; whole characters.
fn visible(span: Span, sources: &SourceMap) -> Span {
    let text = sources.text(span.source);
    let whole = |mut at: usize| {
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let mut start = whole((span.start as usize).min(text.len()));
    if start == text.len() && text.ends_with('\n') {
        start = text.trim_ascii_end().len();
    }
    let line = sources.line_index(span.source, start);
    let line_end = sources.lines(span.source, line, line).end.max(start);
    let end = whole((span.end as usize).clamp(start, line_end).min(start + LONG_LINE));
    let seen = text[start..end].trim_ascii_end().len();
    Span::new(span.source, start, if seen == 0 { end } else { start + seen })
}

/// A file as miette asks for it.
struct Excerpt<'a> {
    sources: &'a SourceMap,
    id: SourceId,
}

impl SourceCode for Excerpt<'_> {
    fn read_span<'b>(
        &'b self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'b> + 'b>, MietteError> {
        let (start, end) = (span.offset(), span.offset() + span.len());
        let text = self.sources.text(self.id);
        if end > text.len() {
            return Err(MietteError::OutOfBounds);
        }
        let first = self.sources.line_index(self.id, start).saturating_sub(before);
        let last = self.sources.line_index(self.id, end) + after;
        let lines = self.sources.lines(self.id, first, last);
        let is_long = (first..=last).any(|l| self.sources.lines(self.id, l, l).len() > LONG_LINE);
        let window = match (before, after) {
            (0, 0) => start..end,
            _ if is_long => self.clip(start, end),
            _ => lines,
        };
        let at = self.sources.line_column(self.id, window.start as u32);
        let count = text.as_bytes()[window.clone()].iter().filter(|b| **b == b'\n').count();
        Ok(Box::new(MietteSpanContents::new_named(
            harmless(self.sources.name(self.id)).into_owned(),
            &text.as_bytes()[window.clone()],
            (window.start, window.len()).into(),
            at.line - 1,
            at.column - 1,
            count,
        )))
    }
}

impl Excerpt<'_> {
    /// The neighbourhood of a fault within its own lines.
    fn clip(&self, start: usize, end: usize) -> std::ops::Range<usize> {
        let text = self.sources.text(self.id);
        let first = self.sources.line_index(self.id, start);
        let last = self.sources.line_index(self.id, end);
        let lines = self.sources.lines(self.id, first, last);
        let mut from = start.saturating_sub(CLIP_MARGIN).max(lines.start);
        let mut to = (end + CLIP_MARGIN).min(lines.end);
        while !text.is_char_boundary(from) {
            from -= 1;
        }
        while !text.is_char_boundary(to) {
            to += 1;
        }
        from..to
    }
}

impl fmt::Debug for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Report<'_> {}

impl miette::Diagnostic for Report<'_> {
    fn severity(&self) -> Option<miette::Severity> {
        Some(self.severity)
    }

    fn help<'b>(&'b self) -> Option<Box<dyn fmt::Display + 'b>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|source| source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }
}

/// The text with its colours (`ESC [ digits ; … m`), and every other control character replaced.
fn only_colours(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut pieces = text.split('\u{1b}');
    out.push_str(&harmless(pieces.next().unwrap_or("")));
    for piece in pieces {
        let parameters = piece.strip_prefix('[').map(|p| p.find(|c: char| !c.is_ascii_digit() && c != ';'));
        let is_colour = matches!(parameters, Some(Some(n)) if piece[1 + n..].starts_with('m'));
        out.push(if is_colour { '\u{1b}' } else { '\u{fffd}' });
        out.push_str(&harmless(piece));
    }
    out
}
