//! Whether a text that is being typed goes on: its brackets or comments are open, or its last sign wants more.
//! Knows where tokens begin and end, and nothing of the grammar.

/// Signs behind which a line cannot end.
const WANTING: &[u8] = b"+-*/%^,=?:|&<";

/// Whether more is to come. A blank line ends a text that only its last sign keeps open.
pub fn is_unfinished(text: &str) -> bool {
    let end = End::of(text);
    if end.faulty || end.open.iter().any(|(closer, _)| *closer == b'"') {
        return false;
    }
    let ends_blank = text.rsplit_once('\n').is_some_and(|(_, line)| line.trim().is_empty());
    end.in_comment || !end.open.is_empty() || (!ends_blank && WANTING.contains(&end.last))
}

/// How a text ends.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct End {
    /// What is open, outermost first: the sign that would close it, and the place of the one that opened it.
    pub open: Vec<(u8, usize)>,
    /// It ends within a comment `/* … */`.
    pub in_comment: bool,
    /// It ends within a comment `// …`.
    pub in_remark: bool,
    /// Brackets close in a wrong order, or a text does not end on its line: no further line mends that.
    pub faulty: bool,
    /// The last byte that is neither blank nor comment; 0 where there is none.
    pub last: u8,
}

impl End {
    /// Reads a text to its end, or to where it is faulty.
    pub fn of(text: &str) -> End {
        let text = text.as_bytes();
        let mut end = End::default();
        let mut at = 0;
        while at < text.len() && !end.faulty {
            at += match (&text[at..], end.in_text()) {
                ([b'/', b'/', ..], false) => {
                    let len = text[at..].iter().position(|b| *b == b'\n');
                    end.in_remark = len.is_none();
                    len.unwrap_or(text.len())
                }
                ([b'/', b'*', ..], false) => {
                    let len = comment(&text[at..]);
                    end.in_comment = len.is_none();
                    len.unwrap_or(text.len())
                }
                ([b'\\', _, ..], true) => 2,
                _ => {
                    end.read(text[at], at);
                    1
                }
            };
        }
        end
    }

    /// It ends within a text.
    pub fn in_text(&self) -> bool {
        self.open.last().is_some_and(|(closer, _)| *closer == b'"')
    }

    fn read(&mut self, byte: u8, at: usize) {
        match (byte, self.in_text()) {
            (b'\n', _) => self.faulty = self.open.iter().any(|(closer, _)| *closer == b'"'),
            (b'"', true) => drop(self.open.pop()),
            (b'"', false) => self.open.push((b'"', at)),
            (b'{', _) => self.open.push((b'}', at)),
            (b'(', false) => self.open.push((b')', at)),
            (b'[', false) => self.open.push((b']', at)),
            (b')' | b']' | b'}', false) => {
                self.faulty = self.open.pop().is_none_or(|(closer, _)| closer != byte);
            }
            _ => {}
        }
        if !byte.is_ascii_whitespace() {
            self.last = byte;
        }
    }
}

/// The length of a comment `/* … */`, which may hold others; none where it does not end.
fn comment(text: &[u8]) -> Option<usize> {
    let (mut depth, mut at) = (0, 0);
    while at + 1 < text.len() {
        match &text[at..at + 2] {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_open_goes_on() {
        for text in [
            "sphere {",
            "f(1,",
            "[1, 2",
            "/* a /* b */",
            "let a =",
            "1 +",
            "1 + // more",
            "sphere {\n\n",
            "c ?",
            "f(\"a {1}\"",
        ] {
            assert!(is_unfinished(text), "{text}");
        }
    }

    #[test]
    fn what_is_closed_or_cannot_be_mended_is_done() {
        for text in [
            "",
            "1 + 2",
            "<1, 2>",
            "\"a {1} }\"",
            "// {",
            "/* { */ 1",
            "sphere { radius 1 }",
            "f(]",
            "1 // {",
            "\"a",
            "f(\"a\\\"",
            "f(\"a {1",
            "f(\"a\n",
            "}",
            "1 +\n",
            "1 +\n  ",
            "\"(\"",
            "a \\\\",
        ] {
            assert!(!is_unfinished(text), "{text}");
        }
    }
}
