//! Brackets, texts and comments that do not close: says which, guesses where they should have closed, and yields a text
//! in which they do. What is put in is remembered, so that places lead back to the person's own text and nothing is said
//! twice.

use super::outline::{COMMENT_DEPTH, Event, Events, closer};
use super::too_deep;
use crate::diag::{Code, Diagnostic, SourceId, Span};

/// A text whose brackets close.
pub(super) struct Repaired {
    pub text: String,
    /// The offsets in `text` of the bytes that were put in; sorted.
    pub insertions: Vec<u32>,
    pub found: Vec<Diagnostic>,
}

/// Closing brackets without a partner that are reported; past these a file is likely no scene at all.
const MOST_STRAY: usize = 64;

/// A change to the text. Where two stand at one place, their order is that of their making.
#[derive(Clone, Copy, Debug)]
enum Edit {
    Insert {
        at: usize,
        byte: u8,
    },
    /// Overwrites with blanks.
    Blank {
        at: usize,
        len: usize,
    },
    /// Overwrites with the byte that the grammar takes for a bad item.
    Strike {
        at: usize,
        len: usize,
    },
}

impl Edit {
    fn at(self) -> usize {
        match self {
            Edit::Insert { at, .. } | Edit::Blank { at, .. } | Edit::Strike { at, .. } => at,
        }
    }
}

/// A bracket or the beginning of a line, as the repair sees it.
#[derive(Clone, Copy, Debug)]
enum Mark {
    Open {
        at: usize,
        byte: u8,
        hole: bool,
    },
    Close {
        at: usize,
        byte: u8,
    },
    /// The first byte of a line that is not blank.
    Line {
        at: usize,
        indent: usize,
    },
}

/// Makes the brackets of a text close.
pub(super) fn repair(source: SourceId, text: &str, limit: usize) -> Repaired {
    let mut repair = Repair { source, text, edits: Vec::new(), found: Vec::new() };
    let marks = repair.marks();
    repair.brackets(&marks, limit);
    repair.apply()
}

struct Repair<'t> {
    source: SourceId,
    text: &'t str,
    edits: Vec<Edit>,
    found: Vec<Diagnostic>,
}

impl Repair<'_> {
    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.source, start, end)
    }

    /// The brackets and lines of the text; mends texts, comments and control characters on the way.
    fn marks(&mut self) -> Vec<Mark> {
        let mut marks = vec![];
        marks.extend(self.line(0));
        let mut events = Events::new(self.text);
        while let Some(event) = events.next() {
            match event {
                Event::Open { at, byte } => marks.push(Mark::Open { at, byte, hole: false }),
                Event::OpenHole { at } => marks.push(Mark::Open { at, byte: b'{', hole: true }),
                Event::Close { at, byte } => marks.push(Mark::Close { at, byte }),
                Event::CloseHole { at } => marks.push(Mark::Close { at, byte: b'}' }),
                Event::LineEnd { at } => marks.extend(self.line(at + 1)),
                Event::OpenText { open, at, hole } => {
                    while marks.last().is_some_and(
                        |m| matches!(m, Mark::Open { at, .. } | Mark::Close { at, .. } if *at > open),
                    ) {
                        marks.pop();
                    }
                    let go_on = self.text(open, at, hole);
                    events.resume(go_on);
                }
                Event::OpenComment { open, depth } => self.comment(open, depth),
                Event::DeepComment { open, at, end } => self.deep_comment(open, at, end),
                Event::Control { at } => self.control(at),
            }
        }
        marks
    }

    /// The mark of the line that begins at a byte, unless it is blank or a comment.
    fn line(&self, start: usize) -> Option<Mark> {
        let line = self.text[start..].split('\n').next().unwrap_or_default();
        let indent = line.len() - line.trim_start().len();
        let body = line.trim();
        let counts = !body.is_empty() && !body.starts_with("//") && !body.starts_with("/*");
        counts.then_some(Mark::Line { at: start + indent, indent })
    }

    /// A text that its line does not close; returns where to read on.
    fn text(&mut self, open: usize, line_end: usize, hole: Option<usize>) -> usize {
        if let (Some(hole), Some(close)) = (hole, plain_close(self.text, open, line_end)) {
            self.found.push(
                Diagnostic::new(
                    Code::BadString,
                    self.span(hole, hole + 1),
                    "this `{` in a text is not closed",
                )
                .label("an interpolation begins here")
                .hint("for the brace itself write `\\{`"),
            );
            for (i, _) in self.text[open..close].match_indices('{') {
                self.edits.push(Edit::Blank { at: open + i, len: 1 });
            }
            for (i, _) in self.text[open + 1..close].match_indices('"') {
                self.edits.push(Edit::Blank { at: open + 1 + i, len: 1 });
            }
            return close + 1;
        }
        let line = &self.text[open + 1..line_end];
        let kept = line.trim_end_matches(|c: char| c.is_whitespace() || matches!(c, '}' | ')' | ']' | ';'));
        let at = open + 1 + kept.len();
        self.found.push(
            Diagnostic::new(Code::Unclosed, self.span(open, open + 1), "this text is not closed")
                .label("it begins here and must end on its line")
                .hint("end it with `\"`; a line break in a text is written `\\n`"),
        );
        // Nothing between the marks may open a hole again.
        for (i, c) in kept.char_indices() {
            if matches!(c, '{' | '"' | '\\') {
                self.edits.push(Edit::Blank { at: open + 1 + i, len: 1 });
            }
        }
        self.edits.push(Edit::Insert { at, byte: b'"' });
        at
    }

    fn comment(&mut self, open: usize, depth: usize) {
        self.found.push(
            Diagnostic::new(Code::Unclosed, self.span(open, open + 2), "this comment is not closed")
                .label(if depth > 1 {
                    format!("{depth} levels of comment are open at the end")
                } else {
                    String::new()
                })
                .hint("end it with `*/`; comments nest, so each `/*` needs its own"),
        );
        self.edits.push(Edit::Blank { at: open, len: self.text.len() - open });
    }

    fn deep_comment(&mut self, open: usize, at: usize, end: usize) {
        let message = format!("comments nest more than {COMMENT_DEPTH} levels deep");
        self.found.push(
            Diagnostic::new(Code::TooDeep, self.span(at, at + 2), message)
                .label("one comment too many begins in the others here")
                .hint("comments nest: take out each `/*` that stands in one and is not meant, with its `*/`"),
        );
        self.edits.push(Edit::Blank { at: open, len: end - open });
    }

    fn control(&mut self, at: usize) {
        let byte = self.text.as_bytes()[at];
        if !self.found.iter().any(|d| d.message.starts_with("a control character")) {
            self.found.push(
                Diagnostic::new(
                    Code::Syntax,
                    self.span(at, at + 1),
                    format!("a control character (U+{byte:04X}) stands in the scene"),
                )
                .hint("remove it; in a text, write it as `\\u{…}`"),
            );
        }
        self.edits.push(Edit::Blank { at, len: 1 });
    }

    /// Matches the brackets, and mends those that have no partner.
    fn brackets(&mut self, marks: &[Mark], limit: usize) {
        let plain = Matching::of(marks, self.text, 0, false);
        if let Some((start, at, end)) = plain.too_deep(self.text, marks, limit) {
            self.found.push(too_deep(self.span(at, at + 1), limit));
            self.edits.retain(|edit| edit.at() < start || edit.at() >= end);
            self.edits.push(Edit::Strike { at: start, len: end - start });
            self.found.retain(|d| {
                d.span.is_none_or(|s| {
                    s.start as usize == at || (s.start as usize) < start || s.start as usize >= end
                })
            });
            let outside: Vec<Mark> =
                marks.iter().copied().filter(|m| !(start..end).contains(&m.at())).collect();
            return self.brackets(&outside, limit);
        }
        let guided = plain.first_left_open.map(|first| {
            let (before, after) = marks.split_at(first);
            let head = Matching::of(before, self.text, 0, false);
            head.then(Matching::of(after, self.text, first, true))
        });
        let best = match guided {
            Some(guided) if guided.stray.len() <= plain.stray.len() => guided,
            _ => plain,
        };
        for unclosed in &best.unclosed {
            self.unclosed(unclosed);
        }
        for (n, &at) in best.stray.iter().enumerate() {
            if n < MOST_STRAY {
                self.stray(at);
            }
            self.edits.push(Edit::Blank { at, len: 1 });
        }
    }

    fn unclosed(&mut self, unclosed: &Unclosed) {
        let Unclosed { open, byte, hole, at } = *unclosed;
        let close = closer(byte) as char;
        let said = if hole {
            "this interpolation is not closed".to_owned()
        } else {
            format!("this `{}` is not closed", byte as char)
        };
        let shown = self.text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
        let place = if at >= self.text.trim_end().len() {
            "the file ends without it".to_owned()
        } else {
            format!("a `{close}` was expected before this")
        };
        self.found.push(
            Diagnostic::new(Code::Unclosed, self.span(open, open + 1), said)
                .also(self.span(at, shown), place)
                .hint(format!("end it with `{close}`")),
        );
        self.edits.push(Edit::Insert { at, byte: close as u8 });
    }

    fn stray(&mut self, at: usize) {
        let byte = self.text.as_bytes()[at] as char;
        self.found.push(
            Diagnostic::new(Code::Syntax, self.span(at, at + 1), format!("this `{byte}` closes nothing"))
                .hint("remove it, or look for the opening bracket that is missing before it"),
        );
    }

    /// The text with its edits.
    fn apply(mut self) -> Repaired {
        self.edits.sort_by_key(|edit| edit.at());
        let mut bytes = Vec::with_capacity(self.text.len() + self.edits.len());
        let mut insertions = Vec::new();
        let mut from = 0;
        for edit in &self.edits {
            let at = edit.at().max(from);
            bytes.extend_from_slice(&self.text.as_bytes()[from..at]);
            from = at;
            match *edit {
                Edit::Insert { byte, .. } => {
                    insertions.push(bytes.len() as u32);
                    bytes.push(byte);
                }
                Edit::Blank { at: start, len } => from = fill(&mut bytes, b' ', at, start + len),
                Edit::Strike { at: start, len } => from = fill(&mut bytes, 1, at, start + len),
            }
        }
        bytes.extend_from_slice(&self.text.as_bytes()[from..]);
        // Edits begin and end at characters, so the text stays valid.
        let text = String::from_utf8_lossy(&bytes).into_owned();
        Repaired { text, insertions, found: self.found }
    }
}

/// Overwrites `from..to`; returns where to go on.
fn fill(bytes: &mut Vec<u8>, byte: u8, from: usize, to: usize) -> usize {
    bytes.extend(std::iter::repeat_n(byte, to.saturating_sub(from)));
    to.max(from)
}

/// The closing quotation mark of a text, if braces in it mean nothing.
fn plain_close(text: &str, open: usize, end: usize) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut at = open + 1;
    let mut last = None;
    while at < end {
        match bytes[at] {
            b'\\' => at += 1,
            b'"' => {
                last = Some(at);
                break;
            }
            _ => {}
        }
        at += 1;
    }
    last
}

impl Mark {
    fn at(self) -> usize {
        match self {
            Mark::Open { at, .. } | Mark::Close { at, .. } | Mark::Line { at, .. } => at,
        }
    }
}

/// An opening bracket without a partner, and where the partner is put in.
#[derive(Clone, Copy, Debug)]
struct Unclosed {
    open: usize,
    byte: u8,
    hole: bool,
    at: usize,
}

/// An opening bracket that waits for its partner.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    at: usize,
    byte: u8,
    hole: bool,
    /// The indentation of its line.
    indent: usize,
    /// Its place among the marks.
    mark: usize,
}

/// The brackets without partners.
#[derive(Default)]
struct Matching {
    unclosed: Vec<Unclosed>,
    stray: Vec<usize>,
    /// Among the marks, the outermost bracket that is open at the end.
    first_left_open: Option<usize>,
    /// The outermost and the first too deep bracket, by depth; see `too_deep`.
    deepest: Vec<(usize, usize)>,
}

impl Matching {
    /// Matches brackets; `guided`, a line that is indented no deeper than the line of an open bracket closes that bracket.
    fn of(marks: &[Mark], text: &str, first: usize, guided: bool) -> Matching {
        let mut matching = Matching::default();
        let mut open: Vec<Waiting> = Vec::new();
        let mut indent = 0;
        for (i, mark) in marks.iter().enumerate() {
            match *mark {
                Mark::Line { at, indent: column } => {
                    indent = column;
                    let closes = text.as_bytes().get(at).is_some_and(|b| b")]}".contains(b));
                    while let Some(top) = open.last().filter(|_| guided) {
                        let due = if closes { column < top.indent } else { column <= top.indent };
                        if !due {
                            break;
                        }
                        matching.close(*top, at);
                        open.pop();
                    }
                }
                Mark::Open { at, byte, hole } => {
                    open.push(Waiting { at, byte, hole, indent, mark: first + i });
                    matching.deepest.push((open.len(), first + i));
                }
                Mark::Close { at, byte } => matching.close_by(&mut open, byte, at, text, marks, i),
            }
        }
        matching.first_left_open = open.first().map(|w| w.mark);
        while let Some(top) = open.pop() {
            matching.close(top, text.len());
        }
        matching
    }

    fn close(&mut self, top: Waiting, at: usize) {
        self.unclosed.push(Unclosed { open: top.at, byte: top.byte, hole: top.hole, at });
    }

    /// A closing bracket: takes its partner from the stack, and what stands open above it.
    fn close_by(
        &mut self,
        open: &mut Vec<Waiting>,
        byte: u8,
        at: usize,
        text: &str,
        marks: &[Mark],
        mark: usize,
    ) {
        let partner = open.iter().rposition(|w| closer(w.byte) == byte);
        let crosses_brace = partner.is_some_and(|p| {
            byte != b'}' && open[p..].iter().any(|w| w.byte == b'{' && text[w.at..at].contains('\n'))
        });
        let Some(partner) = partner.filter(|_| !crosses_brace) else {
            self.stray.push(at);
            return;
        };
        while open.len() > partner + 1 {
            let top = open.pop().expect("longer than the partner's place");
            self.close(top, likely_end(&top, at, text, &marks[..mark]));
        }
        open.pop();
    }

    fn then(mut self, after: Matching) -> Matching {
        self.unclosed.extend(after.unclosed);
        self.stray.extend(after.stray);
        self
    }

    /// Where brackets nest past `limit`: the region to strike out, which is its whole line to the end of the outermost
    /// bracket, and the first bracket past the limit.
    fn too_deep(&self, text: &str, marks: &[Mark], limit: usize) -> Option<(usize, usize, usize)> {
        let over = self.deepest.iter().position(|(depth, _)| *depth > limit)?;
        let outermost = self.deepest[..over].iter().rposition(|(depth, _)| *depth == 1)?;
        let (outer, at) = (marks[self.deepest[outermost].1].at(), marks[self.deepest[over].1].at());
        let line = text[..outer].rfind('\n').map_or(0, |i| i + 1);
        let mut depth = 0;
        let mut end = text.len();
        for mark in &marks[self.deepest[outermost].1..] {
            match mark {
                Mark::Open { .. } => depth += 1,
                Mark::Close { .. } => depth -= 1,
                Mark::Line { .. } => {}
            }
            if depth == 0 {
                end = mark.at() + 1;
                break;
            }
        }
        let closed_before = marks[..self.deepest[outermost].1]
            .iter()
            .rev()
            .find(|m| matches!(m, Mark::Close { .. }))
            .map_or(0, |m| m.at() + 1);
        Some((line.max(closed_before), at, end))
    }
}

/// Where a bracket that a later one closes over should have closed: before the first line that is not deeper than its
/// own, before two blanks and a word on its own line, or before the later one.
fn likely_end(top: &Waiting, close: usize, text: &str, marks: &[Mark]) -> usize {
    let line_end = text[top.at..close].find('\n').map(|i| top.at + i);
    let Some(line_end) = line_end else {
        let gap = text[top.at..close]
            .match_indices("  ")
            .map(|(i, _)| top.at + i)
            .find(|&i| text[i..close].trim_start().starts_with(|c: char| c.is_alphabetic()));
        return gap.unwrap_or(top.at + text[top.at..close].trim_end().len());
    };
    let next = marks.iter().find_map(|mark| match *mark {
        Mark::Line { at, indent } if at > line_end && indent <= top.indent => Some(at),
        _ => None,
    });
    next.map_or(close, |at| top.at + text[top.at..at].trim_end().len())
}
