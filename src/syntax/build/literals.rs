//! Numbers, vectors of numbers, colours and texts, decoded from their characters.

use pest::Parser;

use super::items::{Builder, Token};
use super::{Grammar, Rule};
use crate::diag::{Code, Diagnostic, Span};
use crate::syntax::ast::{ExprKind, TextPart};

impl<'a> Builder<'a> {
    pub fn number(&mut self, token: &Token<'a>, span: Span) -> ExprKind {
        match self.decode(token.as_str(), span) {
            Some(value) => ExprKind::Number(value),
            None => ExprKind::Bad,
        }
    }

    /// `<1, 2.5, -3>`, read as one token; as a vector of expressions where it is not just numbers.
    pub fn vector_literal(&mut self, token: &Token<'a>, span: Span) -> ExprKind {
        let text = token.as_str();
        let mut v = [0.0; 4];
        let mut len = 0;
        for part in text[1..text.len() - 1].split(',') {
            let (Some(value), Some(component)) = (plain_number(part), v.get_mut(len)) else {
                return self.vector_again(token, span);
            };
            *component = value;
            len += 1;
        }
        if len < 2 {
            return self.vector_again(token, span);
        }
        ExprKind::VectorLiteral { len: len as u8, v: Box::new(v) }
    }

    /// A vector that looked like numbers alone: `<1 + 2, e>`, or a faulty one.
    fn vector_again(&mut self, token: &Token<'a>, span: Span) -> ExprKind {
        let at = token.as_span();
        let parsed = Grammar::parse(Rule::whole_vector, &self.text[at.start()..at.end()]);
        let Some(vector) = parsed.ok().and_then(|mut pairs| pairs.next()?.into_inner().next()) else {
            let found = self.faulty_vector(token.as_str(), at.start(), span);
            self.report(found);
            return ExprKind::Bad;
        };
        let mut inner = Builder::new(&self.text[at.start()..at.end()], self.offset(at.start()), self.origin);
        inner.depth = self.depth;
        let value = inner.primary(vector);
        self.found.extend(inner.found);
        value.kind
    }

    /// What is wrong with the characters of a vector of numbers that begins at `start`.
    fn faulty_vector(&self, text: &str, start: usize, span: Span) -> Diagnostic {
        let mut from = start + 1;
        for part in text[1..text.len() - 1].split(',') {
            let number = part.trim_ascii();
            let at = from + (part.len() - part.trim_ascii_start().len());
            let end = from + part.len();
            if number.is_empty() {
                let (after, found) = (&self.text[from - 1..from], &self.text[end..=end]);
                let said = format!("expected a component after `{after}`, found `{found}`");
                return Diagnostic::new(Code::Syntax, self.span_of(end, end + 1), said);
            }
            if let Some(gap) = number.find(|c: char| c.is_ascii_whitespace()) {
                let next_at = at + gap + (number[gap..].len() - number[gap..].trim_ascii_start().len());
                let next = number[next_at - at..]
                    .split(|c: char| c.is_ascii_whitespace())
                    .next()
                    .unwrap_or_default();
                let said = format!("expected `,` or `>` before `{next}`");
                return Diagnostic::new(Code::Syntax, self.span_of(next_at, next_at + next.len()), said)
                    .hint("the components of a vector have a comma between each two");
            }
            if number.parse::<f64>().is_err() || number.ends_with('.') {
                return malformed(number, self.span_of(at, at + number.len()));
            }
            from = end + 1;
        }
        Diagnostic::new(Code::Syntax, span, "this vector cannot be read")
            .hint("a vector is `<a, b>`, `<a, b, c>` or `<a, b, c, d>`: values with a comma between each two")
    }

    /// The number nearest to the digits; nothing, with a diagnostic, where they make none.
    fn decode(&mut self, digits: &str, span: Span) -> Option<f64> {
        let value = digits.parse::<f64>().ok();
        match value {
            Some(value) if value.is_finite() => return Some(value),
            Some(_) => {
                let said = format!("`{}` is too large for a number", shorten(digits));
                self.report(
                    Diagnostic::new(Code::BadNumber, span, said)
                        .hint("the largest is about 1.8e308; infinity is `inf`"),
                );
            }
            None => self.report(malformed(digits, span)),
        }
        None
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

/// E0004 for letters or points that stand tight behind a number.
fn malformed(digits: &str, span: Span) -> Diagnostic {
    let found = Diagnostic::new(Code::BadNumber, span, format!("`{}` is not a number", shorten(digits)));
    let plain = digits.replace('_', "");
    let end = digits.find(|c: char| c.is_alphabetic() || c == '_').unwrap_or(digits.len());
    if let Some(whole) = digits.strip_suffix('.').filter(|d| d.parse::<f64>().is_ok()) {
        found.hint(format!("write `{whole}.0` or `{whole}`"))
    } else if plain.parse::<f64>().is_ok() {
        found.hint(format!("digits are not grouped; write `{plain}`"))
    } else if digits.starts_with("0x") || digits.starts_with("0X") {
        found.hint("numbers are decimal; a colour is written `#cc3311`")
    } else if digits[..end].parse::<f64>().is_ok() {
        found.hint(format!(
            "a product is written `{} * {}`; numbers have no units",
            &digits[..end],
            &digits[end..]
        ))
    } else {
        found.hint("a number has one point at most, and digits on both sides of it")
    }
}

/// A long number with its middle left out.
fn shorten(digits: &str) -> String {
    match digits.len() {
        0..=24 => digits.to_owned(),
        _ => format!("{}…", digits.chars().take(16).collect::<String>()),
    }
}

/// A number of a vector, with the sign before it, tight or not: blanks must not decide what tree is made.
fn plain_number(part: &str) -> Option<f64> {
    let part = part.trim_ascii();
    let digits = part.strip_prefix('-').map_or(part, str::trim_ascii_start);
    let plain = digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') && !digits.ends_with('.');
    let size = if plain { digits.parse::<f64>().ok().filter(|v| v.is_finite())? } else { return None };
    Some(if digits.len() < part.len() { -size } else { size })
}
