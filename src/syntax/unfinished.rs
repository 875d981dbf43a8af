//! Whether a text that is being typed goes on: its brackets or comments are open, or its last sign wants more.
//! Knows where tokens begin and end, and nothing of the grammar.

/// Signs behind which a line cannot end.
const WANTING: &[u8] = b"+-*/%^,=?:|&<";

/// Whether more is to come. A blank line ends a text that only its last sign keeps open.
pub fn is_unfinished(text: &str) -> bool {
    match scan(text.as_bytes()) {
        End::Open => true,
        End::Faulty => false,
        End::Closed(last) => {
            let ends_blank = text.rsplit_once('\n').is_some_and(|(_, line)| line.trim().is_empty());
            !ends_blank && last.is_some_and(|sign| WANTING.contains(&sign))
        }
    }
}

enum End {
    /// Something is open.
    Open,
    /// Brackets close in a wrong order, or a text does not end on its line: no further line mends that.
    Faulty,
    /// All is closed; the last byte that is neither blank nor comment.
    Closed(Option<u8>),
}

fn scan(text: &[u8]) -> End {
    let mut open: Vec<u8> = Vec::new();
    let mut last = None;
    let mut at = 0;
    while at < text.len() {
        let byte = text[at];
        let in_text = open.last() == Some(&b'"');
        match (byte, text.get(at + 1)) {
            (b'\n', _) if open.contains(&b'"') => return End::Faulty,
            (b'\\', _) if in_text => at += 1,
            (b'/', Some(b'/')) if !in_text => {
                at += text[at..].iter().position(|b| *b == b'\n').unwrap_or(text.len());
                continue;
            }
            (b'/', Some(b'*')) if !in_text => match comment(&text[at..]) {
                Some(len) => {
                    at += len;
                    continue;
                }
                None => return End::Open,
            },
            (b'"', _) if in_text => drop(open.pop()),
            (b'"', _) => open.push(b'"'),
            (b'{', _) => open.push(b'}'),
            (b'(', _) if !in_text => open.push(b')'),
            (b'[', _) if !in_text => open.push(b']'),
            (b')' | b']' | b'}', _) if !in_text && open.pop() != Some(byte) => return End::Faulty,
            _ => {}
        }
        if !byte.is_ascii_whitespace() {
            last = Some(byte);
        }
        at += 1;
    }
    match open {
        open if open.is_empty() => End::Closed(last),
        open if open.contains(&b'"') => End::Faulty,
        _ => End::Open,
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
