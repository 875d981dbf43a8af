//! Numbers, vectors of numbers, colours and texts, decoded from their characters.

use super::items::{Builder, Token};
use crate::diag::{Code, Diagnostic, Span};
use crate::syntax::ast::{ExprKind, TextPart};

impl<'a> Builder<'a> {
    pub fn number(&mut self, token: &Token<'a>, span: Span) -> ExprKind {
        match self.decode(token.as_str(), span) {
            Some(value) => ExprKind::Number(value),
            None => ExprKind::Bad,
        }
    }

    /// `<1, 2.5, -3>`, read as one token. The grammar has seen to its form.
    pub fn vector_literal(&mut self, token: &Token<'a>, span: Span) -> ExprKind {
        let text = token.as_str();
        let mut v = [0.0; 4];
        let mut len = 0;
        for (component, digits) in v.iter_mut().zip(text[1..text.len() - 1].split(',')) {
            match self.decode(digits.trim_ascii(), span) {
                Some(value) => *component = value,
                None => return ExprKind::Bad,
            }
            len += 1;
        }
        ExprKind::VectorLiteral { len, v: Box::new(v) }
    }

    /// The number nearest to the digits; nothing, with a diagnostic, where it is past the largest.
    fn decode(&mut self, digits: &str, span: Span) -> Option<f64> {
        let value = digits.parse::<f64>().ok().filter(|v| v.is_finite());
        if value.is_none() {
            let said = format!("`{}` is too large for a number", shorten(digits));
            self.report(
                Diagnostic::new(Code::BadNumber, span, said)
                    .hint("the largest is about 1.8e308; infinity is `inf`"),
            );
        }
        value
    }

    /// `#c31`, `#cc3311`.
    pub fn colour(&mut self, token: &Token<'a>, span: Span) -> ExprKind {
        let digits: Vec<u8> =
            token.as_str()[1..].chars().filter_map(|c| c.to_digit(16)).map(|d| d as u8).collect();
        match digits.as_slice() {
            [r, g, b] => ExprKind::Colour([r * 17, g * 17, b * 17]),
            [r, s, g, h, b, c] => ExprKind::Colour([r * 16 + s, g * 16 + h, b * 16 + c]),
            other => {
                let said = format!("a colour has 3 or 6 digits; this one has {}", other.len());
                self.report(Diagnostic::new(Code::Syntax, span, said).hint("write `#c31` or `#cc3311`"));
                ExprKind::Bad
            }
        }
    }

    /// A text with its interpolations.
    pub fn text(&mut self, token: Token<'a>) -> ExprKind {
        let span = token.as_span();
        let mut parts = Vec::new();
        let mut from = span.start() + 1;
        for interpolation in token.into_inner() {
            let hole = interpolation.as_span();
            self.literal_part(from, hole.start(), &mut parts);
            from = hole.end();
            let value = self.nested(self.span(&interpolation), |b| b.only_expression(interpolation));
            parts.extend(value.map(TextPart::Value));
        }
        self.literal_part(from, span.end() - 1, &mut parts);
        ExprKind::Text(parts)
    }

    /// A text that must be known without evaluation.
    pub fn plain_text(&mut self, token: Token<'a>) -> Option<String> {
        let span = self.span(&token);
        match self.text(token) {
            ExprKind::Text(mut parts) if parts.len() <= 1 => match parts.pop() {
                Some(TextPart::Literal(text)) => Some(text),
                None => Some(String::new()),
                Some(TextPart::Value(_)) => self.not_plain(span),
            },
            _ => self.not_plain(span),
        }
    }

    fn not_plain(&mut self, span: Span) -> Option<String> {
        self.report(
            Diagnostic::new(Code::BadString, span, "the path of an import is a plain text")
                .hint("imports are read before anything is evaluated; write the path out, `\\{` for a brace"),
        );
        None
    }

    /// Decodes the characters `start..end` of the parsed text.
    fn literal_part(&mut self, start: usize, end: usize, parts: &mut Vec<TextPart>) {
        if start >= end {
            return;
        }
        let raw = &self.text[start..end];
        let mut decoded = String::with_capacity(raw.len());
        let mut at = 0;
        while let Some(escape) = raw[at..].find('\\') {
            decoded.push_str(&raw[at..at + escape]);
            at += escape;
            let (c, len) = self.escape(&raw[at..], start + at);
            decoded.extend(c);
            at += len;
        }
        decoded.push_str(&raw[at..]);
        parts.push(TextPart::Literal(decoded));
    }

    /// The character that an escape stands for, and the escape's length in bytes.
    fn escape(&mut self, raw: &str, at: usize) -> (Option<char>, usize) {
        let Some(c) = raw[1..].chars().next() else { return (None, raw.len()) };
        let len = 1 + c.len_utf8();
        let plain = match c {
            'n' => '\n',
            't' => '\t',
            '"' | '\\' | '{' | '}' => c,
            'u' if raw.as_bytes().get(2) == Some(&b'{') => return self.unicode_escape(raw, at),
            _ => {
                let said = format!("`\\{c}` is no escape");
                self.report(
                    Diagnostic::new(Code::BadString, self.span_of(at, at + len), said)
                        .hint("the escapes are `\\n \\t \\\" \\\\ \\{ \\u{…}`; a backslash itself is `\\\\`"),
                );
                return (None, len);
            }
        };
        (Some(plain), len)
    }

    /// `\u{1f600}`.
    fn unicode_escape(&mut self, raw: &str, at: usize) -> (Option<char>, usize) {
        let end = raw.find('}').map_or(raw.len(), |i| i + 1);
        let digits = raw[3..end].trim_end_matches('}');
        let c = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() <= 6).and_then(char::from_u32);
        if c.is_none() {
            let said = format!("`{}` is no character", &raw[..end]);
            self.report(
                Diagnostic::new(Code::BadString, self.span_of(at, at + end), said)
                    .hint("between the braces stand 1 to 6 hexadecimal digits, at most 10ffff"),
            );
        }
        (c, end)
    }
}

/// A long number with its middle left out.
fn shorten(digits: &str) -> String {
    match digits.len() {
        0..=24 => digits.to_owned(),
        n => format!("{}…{}", &digits[..10], &digits[n - 8..]),
    }
}
