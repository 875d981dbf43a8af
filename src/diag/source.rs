//! Files as text, and places in them.

use std::sync::Arc;

/// A file of a [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
pub struct SourceId(pub u32);

/// A half-open byte range `start..end` of one source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
pub struct Span {
    /// The file.
    pub source: SourceId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The bytes `start..end` of `source`.
    pub fn new(source: SourceId, start: usize, end: usize) -> Self {
        Self { source, start: start as u32, end: end as u32 }
    }

    /// The smallest span that covers both; both must be of one source.
    #[must_use]
    pub fn to(self, other: Span) -> Span {
        Span { source: self.source, start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// The empty span at the end of this one.
    #[must_use]
    pub fn after(self) -> Span {
        Span { start: self.end, ..self }
    }
}

/// A place as a person counts: from 1, columns in Unicode scalar values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct LineColumn {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1, in Unicode scalar values.
    pub column: usize,
}

#[derive(Debug, Clone)]
struct Source {
    name: String,
    text: Arc<str>,
    line_starts: Vec<u32>,
    /// The number of its first line, from 0.
    first_line: usize,
}

/// The files of a session, by [`SourceId`].
#[derive(Debug, Clone, Default)]
pub struct SourceMap {
    sources: Vec<Source>,
}

impl SourceMap {
    /// Adds a file under the name that diagnostics show. Sources are at most 4 GiB − 1; the loader refuses larger ones.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> SourceId {
        self.add_from(name, text, 0)
    }

    /// Adds a text that is a part of something longer: `first_line` lines stand before it.
    pub fn add_from(
        &mut self,
        name: impl Into<String>,
        text: impl Into<Arc<str>>,
        first_line: usize,
    ) -> SourceId {
        let text = text.into();
        let line_starts =
            std::iter::once(0).chain(text.bytes().zip(1u32..).filter(|(b, _)| *b == b'\n').map(|(_, i)| i));
        let line_starts = line_starts.collect();
        self.sources.push(Source { name: name.into(), line_starts, text, first_line });
        SourceId(self.sources.len() as u32 - 1)
    }

    /// The name a file was added under.
    pub fn name(&self, id: SourceId) -> &str {
        &self.sources[id.0 as usize].name
    }

    /// A file's text.
    pub fn text(&self, id: SourceId) -> &Arc<str> {
        &self.sources[id.0 as usize].text
    }

    /// The text under a span.
    pub fn snippet(&self, span: Span) -> &str {
        &self.sources[span.source.0 as usize].text[span.start as usize..span.end as usize]
    }

    /// Line and column of a byte offset (clamped to the text, rounded down to a character's start).
    pub fn line_column(&self, id: SourceId, offset: u32) -> LineColumn {
        let source = &self.sources[id.0 as usize];
        let mut offset = (offset as usize).min(source.text.len());
        while !source.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = source.line_starts.partition_point(|&start| start as usize <= offset);
        let start = source.line_starts[line - 1] as usize;
        LineColumn { line: line + source.first_line, column: source.text[start..offset].chars().count() + 1 }
    }

    /// How many lines stand before a text that is a part of something longer; 0 for a file.
    pub fn first_line(&self, id: SourceId) -> usize {
        self.sources[id.0 as usize].first_line
    }

    /// The number of the line that holds a byte, from 0 at the text's own beginning.
    pub fn line_index(&self, id: SourceId, offset: usize) -> usize {
        self.sources[id.0 as usize].line_starts.partition_point(|&start| start as usize <= offset) - 1
    }

    /// The bytes of the lines `first..=last`, from 0 and clamped to the file, with their line ends.
    pub fn lines(&self, id: SourceId, first: usize, last: usize) -> std::ops::Range<usize> {
        let source = &self.sources[id.0 as usize];
        let start = |line: usize| source.line_starts.get(line).map_or(source.text.len(), |s| *s as usize);
        start(first)..start(last + 1)
    }

    /// The ids of all files, in the order they were added.
    pub fn ids(&self) -> impl Iterator<Item = SourceId> + use<> {
        (0..self.sources.len() as u32).map(SourceId)
    }

    /// "file:line:column" of a span's start.
    pub fn place(&self, span: Span) -> String {
        let at = self.line_column(span.source, span.start);
        format!("{}:{}:{}", self.name(span.source), at.line, at.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_count_from_one() {
        let mut map = SourceMap::default();
        let id = map.add("a", "é\nxy\n");
        assert_eq!(map.line_column(id, 2), LineColumn { line: 1, column: 2 });
        assert_eq!(map.line_column(id, 4), LineColumn { line: 2, column: 2 });
        assert_eq!(map.line_column(id, 99), LineColumn { line: 3, column: 1 });
        let id = map.add_from("b", "x\ny", 4);
        assert_eq!(map.line_column(id, 2), LineColumn { line: 6, column: 1 });
        assert_eq!((map.line_index(id, 2), map.first_line(id)), (1, 4));
    }
}
