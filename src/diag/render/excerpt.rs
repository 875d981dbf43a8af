//! The lines of a file around its faults, as miette asks for them: a text of those lines alone, each cut to the width of the
//! terminal around its fault, with what is needed to number its lines and columns as the file's.
//!
//! miette's own sources are scanned from their first byte for every label. This one is found through the line table, so
//! that a file of any size, or a line without end, costs nothing.

use super::harmless;
use crate::diag::{SourceId, SourceMap, Span};
use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use std::collections::BTreeMap;
use std::ops::Range;

/// Stands where a line is cut.
const CUT: char = '…';

/// Lines of one file.
pub(super) struct Excerpt {
    name: String,
    text: String,
    lines: Vec<Line>,
    /// Lines that stand before the source's first.
    first_line: usize,
}

/// A line of the excerpt.
struct Line {
    /// Its number in the file, from 0.
    number: usize,
    /// Its first byte in the excerpt.
    start: usize,
    /// The column in the file of its first character, from 0; the sign of a cut takes one of those that are cut.
    column: usize,
}

impl Excerpt {
    /// The lines of the spans and one on either side, each cut to `width` characters, and the places of the spans in the
    /// excerpt; none for those that a cut leaves out. The spans are of this file, and the file is not empty.
    pub fn new(
        id: SourceId,
        spans: &[Span],
        sources: &SourceMap,
        width: usize,
    ) -> (Excerpt, Vec<Option<Range<usize>>>) {
        let spans: Vec<Range<usize>> = spans.iter().map(|span| visible(*span, sources)).collect();
        let mut excerpt = Excerpt {
            name: harmless(sources.name(id)).into_owned(),
            text: String::new(),
            lines: Vec::new(),
            first_line: sources.first_line(id),
        };
        let mut places = vec![None; spans.len()];
        for (number, first) in wanted(id, &spans, sources) {
            let window = window(id, number, first, sources, width);
            excerpt.push(id, number, window, &spans, &mut places, sources);
        }
        (excerpt, places)
    }

    /// Adds a line, and notes where in it the spans lie whose start it shows.
    fn push(
        &mut self,
        id: SourceId,
        number: usize,
        window: Range<usize>,
        spans: &[Range<usize>],
        places: &mut [Option<Range<usize>>],
        sources: &SourceMap,
    ) {
        let text = sources.text(id);
        let line = content(id, number, sources);
        let (cut_before, cut_after) = (window.start > line.start, window.end < line.end);
        let column = sources.line_column(id, window.start as u32).column - 1 - usize::from(cut_before);
        self.lines.push(Line { number, start: self.text.len(), column });
        self.text.extend(cut_before.then_some(CUT));
        let mut shown = Vec::with_capacity(window.len() + 1);
        for (i, c) in text[window.clone()].char_indices() {
            shown.push((window.start + i, self.text.len()));
            self.text.push(if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c });
        }
        shown.push((window.end, self.text.len()));
        let place_of = |at: usize| Some(shown[shown.binary_search_by_key(&at, |(of, _)| *of).ok()?].1);
        for (span, place) in spans.iter().zip(places) {
            let (start, end) = (place_of(span.start), place_of(span.end.min(window.end)));
            *place = place.take().or_else(|| Some(start?..end?));
        }
        self.text.extend(cut_after.then_some(CUT));
        self.text.push('\n');
    }

    fn line_at(&self, offset: usize) -> usize {
        self.lines.partition_point(|line| line.start <= offset).saturating_sub(1)
    }

    /// The line `steps` away if all between follow one another in the file, else the last that does.
    fn neighbour(&self, line: usize, steps: usize, forward: bool) -> usize {
        let mut at = line;
        for _ in 0..steps {
            let next = if forward { at + 1 } else { at.wrapping_sub(1) };
            match self.lines.get(next) {
                Some(there) if there.number.abs_diff(self.lines[at].number) == 1 => at = next,
                _ => break,
            }
        }
        at
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let (start, end) = (span.offset(), span.offset() + span.len());
        if end > self.text.len() || self.lines.is_empty() {
            return Err(MietteError::OutOfBounds);
        }
        let (first, last) = (self.line_at(start), self.line_at(end));
        let follow = |pair: &[Line]| pair[1].number == pair[0].number + 1;
        if !self.lines[first..=last].windows(2).all(follow) {
            return Err(MietteError::OutOfBounds);
        }
        let window = if before == 0 && after == 0 {
            start..end
        } else {
            let next = self.lines.get(self.neighbour(last, after, true) + 1);
            self.lines[self.neighbour(first, before, false)].start..next.map_or(self.text.len(), |l| l.start)
        };
        let line = &self.lines[self.line_at(window.start)];
        let column = line.column + self.text[line.start..window.start].chars().count();
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            &self.text.as_bytes()[window.clone()],
            (window.start, window.len()).into(),
            self.first_line + line.number,
            // Only where the text of one span is asked for does miette look at the column.
            if before == 0 && after == 0 { column } else { 0 },
            self.lines[self.line_at(window.start)..].len().min(1 + last - first + before + after),
        )))
    }
}

/// The part of a span that is underlined: its first line, and at the end of the text its last character; whole characters.
fn visible(span: Span, sources: &SourceMap) -> Range<usize> {
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
    let line = content(span.source, sources.line_index(span.source, start), sources);
    let start = start.min(line.end);
    let end = whole((span.end as usize).clamp(start, line.end));
    let seen = text[start..end].trim_ascii_end().len();
    start..if seen == 0 { end } else { start + seen }
}

/// The bytes of a line without its end.
fn content(id: SourceId, number: usize, sources: &SourceMap) -> Range<usize> {
    let line = sources.lines(id, number, number);
    let text = sources.text(id)[line.clone()].trim_end_matches(['\n', '\r']);
    line.start..line.start + text.len()
}

/// The numbers of the lines that are shown, each with the first span that begins in it.
fn wanted<'a>(
    id: SourceId,
    spans: &'a [Range<usize>],
    sources: &SourceMap,
) -> BTreeMap<usize, Option<&'a Range<usize>>> {
    let mut lines: BTreeMap<usize, Option<&Range<usize>>> = BTreeMap::new();
    for span in spans {
        let number = sources.line_index(id, span.start);
        for near in number.saturating_sub(1)..=number + 1 {
            if !sources.lines(id, near, near).is_empty() || near == number {
                lines.entry(near).or_default();
            }
        }
        lines.entry(number).or_default().get_or_insert(span);
    }
    lines
}

/// The bytes of a line that are shown: all that fits, else the beginning, or the neighbourhood of the fault.
fn window(
    id: SourceId,
    number: usize,
    fault: Option<&Range<usize>>,
    sources: &SourceMap,
    width: usize,
) -> Range<usize> {
    let line = content(id, number, sources);
    let text = &sources.text(id)[line.clone()];
    let chars_from = |from: usize, n: usize| text[from..].char_indices().nth(n).map(|(i, _)| from + i);
    let Some(cut) = chars_from(0, width) else { return line };
    let fault = fault.map_or(0..0, |f| f.start - line.start..f.end - line.start);
    if fault.end < cut {
        return line.start..line.start + cut;
    }
    let before = text[..fault.start].char_indices().rev().nth(width / 3);
    let from = before.map_or(0, |(i, _)| i);
    let to = chars_from(from, width).unwrap_or(text.len());
    line.start + from..line.start + to
}
