//! A rough reading of a faulty text as words, numbers and signs, to say what stands where and to find the next item.
//! The grammar decides what a scene is; this only has to be right about where tokens begin and end.

/// What a piece of text looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::syntax) enum Sort {
    Word,
    Number,
    Text,
    /// An opening bracket with all that it encloses, up to the closing one.
    Group,
    /// A closing bracket without its opening one: the end of the region.
    Closer,
    /// An operator, a comma and the like.
    Sign,
    /// Text that recovery has struck out.
    Struck,
    /// A character that no scene has outside texts and comments.
    Strange,
}

/// A piece of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::syntax) struct Piece<'t> {
    pub sort: Sort,
    pub start: usize,
    pub end: usize,
    pub text: &'t str,
    /// Whether it is the first on its line.
    pub first: bool,
    /// Whether blanks stand before it.
    pub apart: bool,
}

impl Piece<'_> {
    /// Whether a value can end here, so that a word behind it begins another item.
    pub fn ends_value(&self) -> bool {
        match self.sort {
            Sort::Word => !super::KEYWORDS.contains(&self.text) || matches!(self.text, "true" | "false"),
            Sort::Sign => matches!(self.text, ">" | ";"),
            Sort::Number | Sort::Text | Sort::Group | Sort::Struck | Sort::Strange | Sort::Closer => true,
        }
    }
}

/// Reads pieces from a place on; groups as one piece.
pub(in crate::syntax) struct Pieces<'t> {
    text: &'t str,
    at: usize,
    end: usize,
    first: bool,
}

impl<'t> Pieces<'t> {
    /// The pieces of `text[start..end]`.
    pub fn new(text: &'t str, start: usize, end: usize) -> Self {
        let line = text[..start].rfind('\n').map_or(0, |i| i + 1);
        Self { text, at: start, end, first: text[line..start].trim().is_empty() }
    }

    fn rest(&self) -> &'t [u8] {
        &self.text.as_bytes()[self.at..self.end]
    }

    /// Steps over blanks and comments; true if there were any.
    fn skip_blanks(&mut self) -> bool {
        let start = self.at;
        loop {
            match self.rest() {
                [b'\n', ..] => {
                    self.first = true;
                    self.at += 1;
                }
                [b' ' | b'\t' | b'\r', ..] => self.at += 1,
                [b'/', b'/', ..] => {
                    self.at += self.rest().iter().position(|b| *b == b'\n').unwrap_or(self.rest().len())
                }
                [b'/', b'*', ..] => self.at += block_comment(self.rest()),
                _ => return self.at > start,
            }
        }
    }

    fn piece_len(&self) -> (Sort, usize) {
        let rest = self.rest();
        let text = &self.text[self.at..self.end];
        let Some(c) = text.chars().next() else { return (Sort::Closer, 0) };
        match c {
            '(' | '[' | '{' => (Sort::Group, group(rest)),
            ')' | ']' | '}' => (Sort::Closer, 1),
            '"' => (Sort::Text, string(rest)),
            '\u{1}' => (Sort::Struck, rest.iter().take_while(|b| **b == 1).count()),
            '0'..='9' => (Sort::Number, number(text)),
            '.' if rest.get(1).is_some_and(u8::is_ascii_digit) => (Sort::Number, number(text)),
            c if starts_word(c) => (Sort::Word, word(text)),
            '#' => (Sort::Word, 1 + word(&text[1..])),
            '@' | '$' | '~' | '`' | '\'' | '\\' => (Sort::Strange, 1),
            c if c.is_ascii_graphic() => (Sort::Sign, sign(rest)),
            c => (Sort::Strange, c.len_utf8()),
        }
    }
}

impl<'t> Iterator for Pieces<'t> {
    type Item = Piece<'t>;

    fn next(&mut self) -> Option<Piece<'t>> {
        let apart = self.skip_blanks();
        if self.at >= self.end {
            return None;
        }
        let (sort, len) = self.piece_len();
        let start = self.at;
        let end = (start + len.max(1)).min(self.end);
        self.at = end;
        let first = std::mem::replace(&mut self.first, false);
        Some(Piece { sort, start, end, text: &self.text[start..end], first, apart })
    }
}

/// Whether a word may begin with a character: what the grammar's `word_start` is.
pub(crate) fn starts_word(c: char) -> bool {
    c == '_' || pest::unicode::XID_START(c)
}

/// Whether a word may go on with a character, such as a digit or an accent of its own: what the grammar's `word_char` is.
pub(crate) fn continues_word(c: char) -> bool {
    c == '_' || pest::unicode::XID_CONTINUE(c)
}

fn word(text: &str) -> usize {
    text.find(|c: char| !continues_word(c)).unwrap_or(text.len())
}

fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut i = 0;
    while let Some(b) = bytes.get(i) {
        let goes_on = b.is_ascii_alphanumeric()
            || *b == b'_'
            || *b == b'.'
                && bytes.get(i + 1) != Some(&b'.')
                && bytes.get(i + 1).is_none_or(|b| !b.is_ascii_alphabetic())
            || matches!(b, b'+' | b'-')
                && matches!(bytes[i - 1], b'e' | b'E')
                && bytes.get(i + 1).is_some_and(u8::is_ascii_digit);
        if !goes_on {
            break;
        }
        i += 1;
    }
    i
}

fn sign(rest: &[u8]) -> usize {
    const LONG: &[&[u8]] = &[b"..=", b"..", b"==", b"=>", b"!=", b"<=", b">=", b"&&", b"||"];
    LONG.iter().find(|sign| rest.starts_with(sign)).map_or(1, |sign| sign.len())
}

/// The length of a comment that nests.
fn block_comment(rest: &[u8]) -> usize {
    let (mut depth, mut i) = (1, 2);
    while depth > 0 && i < rest.len() {
        match rest.get(i..i + 2) {
            Some(b"/*") => (depth, i) = (depth + 1, i + 2),
            Some(b"*/") => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
    }
    i.min(rest.len())
}

/// The length of a text with its quotation marks, interpolations and all; to the end of the line where it does not close.
fn string(rest: &[u8]) -> usize {
    bracketed(rest)
}

/// The length of a bracket and all that it encloses.
fn group(rest: &[u8]) -> usize {
    bracketed(rest)
}

/// The length of what begins with a bracket or a quotation mark. The text's brackets are known to close.
fn bracketed(rest: &[u8]) -> usize {
    let mut open: Vec<u8> = Vec::new();
    let mut i = 0;
    while let Some(&b) = rest.get(i) {
        let in_text = open.last() == Some(&b'"');
        match b {
            b'\\' if in_text => i += 1,
            b'"' if in_text => {
                open.pop();
            }
            b'"' => open.push(b'"'),
            b'{' => open.push(b'{'),
            b'(' | b'[' if !in_text => open.push(b),
            b')' | b']' | b'}' if !in_text => {
                open.pop();
            }
            b'/' if !in_text && rest.get(i + 1) == Some(&b'/') => {
                i += rest[i..].iter().position(|b| *b == b'\n').unwrap_or(rest.len() - i);
                continue;
            }
            b'/' if !in_text && rest.get(i + 1) == Some(&b'*') => {
                i += block_comment(&rest[i..]);
                continue;
            }
            _ => {}
        }
        i += 1;
        if open.is_empty() {
            break;
        }
    }
    i.min(rest.len())
}
