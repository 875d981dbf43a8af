//! Diagnostics for people, drawn by miette from a report made by hand, with [`Excerpt`]s for its sources.

use super::excerpt::Excerpt;
use super::{Counts, Diagnostic, Severity, harmless, severity_word, shortened};
use crate::diag::{Frame, Label, SourceMap, Span};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, SourceCode, ThemeCharacters, ThemeStyles};
use std::fmt::{self, Write as _};

/// How many diagnostics are shown; the rest are counted. A person mends the first few and runs again.
const MOST_SHOWN: usize = 20;
/// Columns that line numbers, the bar and the signs of a cut take.
const GUTTER: usize = 12;
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

    /// The columns that are used: of a very narrow terminal more than it has, of a very wide one no more than can be read.
    fn width(self) -> usize {
        self.width.clamp(40, 200)
    }
}

/// The first diagnostics in the order given, each with its excerpt, hints and trace, and how many more there are.
pub fn human(diagnostics: &[Diagnostic], sources: &SourceMap, style: Style) -> String {
    let mut text = String::new();
    for diagnostic in most_telling(diagnostics).into_iter().map(shortened) {
        let report = Report::new(&diagnostic, sources, style.width());
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
fn handler(report: &Report, style: Style) -> GraphicalReportHandler {
    let styles = if style.colour { ThemeStyles::ansi() } else { ThemeStyles::none() };
    let mut characters = ThemeCharacters::unicode();
    for sign in [&mut characters.error, &mut characters.warning, &mut characters.advice] {
        sign.clone_from(&report.heading);
    }
    GraphicalReportHandler::new_themed(GraphicalTheme { characters, styles })
        .with_width(style.width())
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
struct Report {
    heading: String,
    severity: miette::Severity,
    message: String,
    labels: Vec<LabeledSpan>,
    source: Option<Excerpt>,
    help: Option<String>,
    elsewhere: Vec<Report>,
}

impl Report {
    fn new(diagnostic: &Diagnostic, sources: &SourceMap, width: usize) -> Self {
        let severity = match diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        };
        let heading = format!("{}[{}]:", severity_word(diagnostic.severity), diagnostic.code.text());
        let mut report = Report::bare(heading, severity, &diagnostic.message);
        report.help = (!diagnostic.hints.is_empty()).then(|| diagnostic.hints.join("\n"));
        let primary = diagnostic.span.map(|span| Label { span, text: diagnostic.label.clone() });
        let is_here = |label: &Label| primary.as_ref().is_some_and(|p| p.span.source == label.span.source);
        let (here, mut elsewhere): (Vec<Label>, Vec<Label>) =
            diagnostic.labels.iter().cloned().partition(|label| is_here(label));
        elsewhere.extend(report.underline(primary.iter().cloned().chain(here).collect(), sources, width));
        report.elsewhere = elsewhere.into_iter().map(|label| Report::of(label, sources, width)).collect();
        report
    }

    /// A label that stands apart.
    fn of(label: Label, sources: &SourceMap, width: usize) -> Self {
        let mut report = Report::bare("note:".to_owned(), miette::Severity::Advice, &label.text);
        report.underline(vec![Label { span: label.span, text: String::new() }], sources, width);
        report
    }

    fn bare(heading: String, severity: miette::Severity, message: &str) -> Self {
        Report {
            heading,
            severity,
            message: message.to_owned(),
            labels: Vec::new(),
            source: None,
            help: None,
            elsewhere: Vec::new(),
        }
    }

    /// Underlines labels of one file, the first as the primary one, and gives back those that a cut of a long line leaves
    /// out. In an empty file, which has nothing to underline, the file is named in the message.
    fn underline(&mut self, labels: Vec<Label>, sources: &SourceMap, width: usize) -> Vec<Label> {
        let Some(id) = labels.first().map(|label| label.span.source) else { return Vec::new() };
        if sources.text(id).is_empty() {
            let _ = write!(self.message, " ({} is empty)", sources.name(id));
            return Vec::new();
        }
        let spans: Vec<Span> = labels.iter().map(|label| label.span).collect();
        let (excerpt, places) = Excerpt::new(id, &spans, sources, width - GUTTER);
        let mut left_out = Vec::new();
        for (i, (label, place)) in labels.into_iter().zip(places).enumerate() {
            let Some(place) = place else {
                left_out.push(label);
                continue;
            };
            let text = (!label.text.is_empty()).then_some(label.text);
            let place = (place.start, place.len());
            self.labels.push(match i {
                0 => LabeledSpan::new_primary_with_span(text, place),
                _ => LabeledSpan::new_with_span(text, place),
            });
        }
        self.source = Some(excerpt);
        left_out
    }
}

impl fmt::Debug for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Report {}

impl miette::Diagnostic for Report {
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
