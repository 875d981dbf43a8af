//! What is said to a person about a scene: where ([`Span`]), what ([`Diagnostic`], [`Code`]), and how ([`render`]).
//!
//! This module knows no stage of the pipeline; every stage returns diagnostics made here. Kernels of `math` and
//! `geometry` return small errors of their own, and the layer that knows the span words them.

pub mod codes;
pub mod render;
mod source;

pub use codes::Code;
pub use source::{LineColumn, SourceId, SourceMap, Span};

/// How much a diagnostic weighs: an error makes the command exit 1, a warning does not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The scene is rendered all the same.
    Warning,
    /// The scene is at fault; no picture is promised.
    Error,
}

/// A second place that matters, with what matters there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What, as a short phrase without a full stop.
    pub text: String,
}

/// One step of a call trace, innermost first: "in `branch(length: 1.2, depth: 3)`", at the place of the call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The call or the import.
    pub span: Span,
    /// What was called, with its arguments' values.
    pub text: String,
}

/// One thing that is wrong, worded for the person who wrote the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Stable code, the key of `ogee explain`.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// What is wrong here, in one sentence without a full stop.
    pub message: String,
    /// The smallest place that is at fault; none for a fault of the whole file ("no camera").
    pub span: Option<Span>,
    /// What to write under the underlined place; may be empty.
    pub label: String,
    /// Other places.
    pub labels: Vec<Label>,
    /// Things to try, each a sentence.
    pub hints: Vec<String>,
    /// The calls and imports that led here, innermost first.
    pub trace: Vec<Frame>,
}

impl Diagnostic {
    /// An error or warning, as the code's table says, at a place.
    pub fn new(code: Code, span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message: message.into(),
            span: span.into(),
            label: String::new(),
            labels: Vec::new(),
            hints: Vec::new(),
            trace: Vec::new(),
        }
    }

    /// With a phrase under the underlined place.
    #[must_use]
    pub fn label(mut self, text: impl Into<String>) -> Self {
        self.label = text.into();
        self
    }

    /// With a second place.
    #[must_use]
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    /// With a thing to try.
    #[must_use]
    pub fn hint(mut self, text: impl Into<String>) -> Self {
        self.hints.push(text.into());
        self
    }

    /// With "did you mean `x`?" where a name is near enough.
    #[must_use]
    pub fn did_you_mean<'a>(self, word: &str, names: impl IntoIterator<Item = &'a str>) -> Self {
        match nearest(word, names) {
            Some(name) => self.hint(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// With the calls that led here.
    #[must_use]
    pub fn trace(mut self, frames: Vec<Frame>) -> Self {
        self.trace = frames;
        self
    }
}

/// True where one of them is more than a warning.
pub fn has_errors(diagnostics: &[Diagnostic]) -> bool {
    diagnostics.iter().any(|d| d.severity == Severity::Error)
}

/// The name nearest to `word` by Damerau–Levenshtein distance, if it is nearer than a third of the longer of the two.
/// Ties go to the first in alphabetical order, so that the hint does not depend on the order of a hash.
pub fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    /// Names beyond so many bytes are nobody's slip, and the work grows with their square.
    const LONGEST: usize = 256;
    if word.len() > LONGEST {
        return None;
    }
    names
        .into_iter()
        .filter(|name| name.len() <= LONGEST)
        .map(|name| (strsim::damerau_levenshtein(&word.to_lowercase(), &name.to_lowercase()), name))
        .filter(|(distance, name)| *distance <= (word.chars().count().max(name.chars().count()) / 3).max(1))
        .min()
        .map(|(_, name)| name)
}

/// The diagnostics of a run in the order they were found, each place and code once.
#[derive(Debug, Default)]
pub struct Sink {
    found: Vec<Diagnostic>,
    seen: std::collections::HashSet<(Code, Option<Span>)>,
}

impl Sink {
    /// Takes a diagnostic; drops it where the same code already stands at the same place.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if self.seen.insert((diagnostic.code, diagnostic.span)) {
            self.found.push(diagnostic);
        }
    }

    /// Whether the same code already stands at the same place, so that this one would be dropped.
    pub fn holds(&self, diagnostic: &Diagnostic) -> bool {
        self.seen.contains(&(diagnostic.code, diagnostic.span))
    }

    /// Takes many.
    pub fn extend(&mut self, diagnostics: impl IntoIterator<Item = Diagnostic>) {
        diagnostics.into_iter().for_each(|d| self.push(d));
    }

    /// True once an error is in.
    pub fn has_errors(&self) -> bool {
        has_errors(&self.found)
    }

    /// What was found so far.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.found
    }

    /// All of it, in source order within each file, faults without a place last.
    pub fn into_sorted(self) -> Vec<Diagnostic> {
        let mut found = self.found;
        found.sort_by_key(|d| d.span.map_or((1, u32::MAX, u32::MAX), |s| (0, s.source.0, s.start)));
        found
    }
}
