//! The brackets of a text, and where it can be cut into runs of whole items. One pass over the bytes that knows comments
//! and texts, and no other grammar.

/// What matters in a text outside its comments and the letters of its texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event {
    /// One of `(` `[` `{`.
    Open { at: usize, byte: u8 },
    /// One of `)` `]` `}`.
    Close { at: usize, byte: u8 },
    /// The `{` of an interpolation.
    OpenHole { at: usize },
    /// The `}` of an interpolation.
    CloseHole { at: usize },
    /// A line end outside texts and comments.
    LineEnd { at: usize },
    /// A text that its line does not close; `open` is its quotation mark. `hole` is the `{` that it stopped in.
    OpenText { open: usize, at: usize, hole: Option<usize> },
    /// A block comment that nothing closes, nested `depth` deep where the text ends.
    OpenComment { open: usize, depth: usize },
    /// A block comment from `open` to `end` that nests past [`COMMENT_DEPTH`] at `at`.
    DeepComment { open: usize, at: usize, end: usize },
    /// A byte that no scene contains.
    Control { at: usize },
}

/// Yields the events of a text in order.
pub(super) struct Events<'t> {
    bytes: &'t [u8],
    at: usize,
    /// The quotation mark of the text that is being read.
    text: Option<usize>,
    holes: Vec<Hole>,
}

/// An interpolation that is being read.
struct Hole {
    /// The quotation mark of the text around it.
    text: usize,
    open: usize,
    /// Braces opened in it.
    braces: usize,
}

impl<'t> Events<'t> {
    pub fn new(text: &'t str) -> Self {
        Self { bytes: text.as_bytes(), at: 0, text: None, holes: Vec::new() }
    }

    /// Goes on from a byte, outside any text.
    pub fn resume(&mut self, at: usize) {
        self.at = at;
        self.text = None;
        self.holes.clear();
    }

    fn in_text(&mut self, open: usize) -> Event {
        loop {
            match self.bytes.get(self.at) {
                None | Some(b'\n') => return self.unclosed_text(open),
                Some(b'"') => {
                    self.at += 1;
                    self.text = None;
                    return self.in_code();
                }
                Some(b'\\') => self.skip_escape(),
                Some(b'{') => {
                    let at = self.at;
                    self.at += 1;
                    self.text = None;
                    self.holes.push(Hole { text: open, open: at, braces: 0 });
                    return Event::OpenHole { at };
                }
                Some(0..0x20) if self.bytes[self.at] != b'\t' && self.bytes[self.at] != b'\r' => {
                    self.at += 1;
                    return Event::Control { at: self.at - 1 };
                }
                Some(_) => self.at += 1,
            }
        }
    }

    fn skip_escape(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += match rest.get(1) {
            None | Some(b'\n') => 1,
            Some(b'u') if rest.get(2) == Some(&b'{') => {
                let end = rest.iter().position(|b| matches!(b, b'}' | b'"' | b'\n'));
                end.map_or(rest.len(), |i| if rest[i] == b'}' { i + 1 } else { i })
            }
            Some(_) => 2,
        };
    }

    fn unclosed_text(&mut self, open: usize) -> Event {
        let outermost = self.holes.first().map_or(open, |hole| hole.text);
        let hole = self.holes.first().map(|hole| hole.open);
        let at = self.at;
        self.resume(at);
        Event::OpenText { open: outermost, at, hole }
    }

    /// The next event of a text that is outside quotation marks; `LineEnd` of the last byte stands for the end.
    fn in_code(&mut self) -> Event {
        loop {
            let Some(&byte) = self.bytes.get(self.at) else { return Event::LineEnd { at: self.bytes.len() } };
            if !MATTERS[byte as usize] {
                self.at += 1;
                continue;
            }
            let at = self.at;
            self.at += 1;
            match byte {
                b'"' => {
                    self.text = Some(at);
                    return self.in_text(at);
                }
                b'/' => {
                    if let Some(event) = self.comment(at) {
                        return event;
                    }
                }
                b'\n' => {
                    if let Some(hole) = self.holes.last() {
                        let open = hole.text;
                        self.at = at;
                        return self.unclosed_text(open);
                    }
                    return Event::LineEnd { at };
                }
                b'(' | b'[' | b'{' => {
                    if let (b'{', Some(hole)) = (byte, self.holes.last_mut()) {
                        hole.braces += 1;
                    }
                    return Event::Open { at, byte };
                }
                b')' | b']' => return Event::Close { at, byte },
                b'}' => return self.close_brace(at),
                _ => return Event::Control { at },
            }
        }
    }

    fn close_brace(&mut self, at: usize) -> Event {
        match self.holes.last_mut() {
            Some(hole) if hole.braces == 0 => {
                self.text = Some(hole.text);
                self.holes.pop();
                Event::CloseHole { at }
            }
            Some(hole) => {
                hole.braces -= 1;
                Event::Close { at, byte: b'}' }
            }
            None => Event::Close { at, byte: b'}' },
        }
    }

    /// Steps over a comment that begins at `at`, if one does.
    fn comment(&mut self, at: usize) -> Option<Event> {
        match self.bytes.get(at + 1)? {
            b'/' => {
                while self.bytes.get(self.at).is_some_and(|b| *b >= b' ' || b"\t\r".contains(b)) {
                    self.at += 1;
                }
                None
            }
            b'*' => self.block_comment(at),
            _ => None,
        }
    }

    fn block_comment(&mut self, open: usize) -> Option<Event> {
        let mut depth = 1;
        let mut too_deep = None;
        self.at = open + 2;
        while depth > 0 {
            match self.bytes.get(self.at..self.at + 2) {
                None => {
                    self.at = self.bytes.len();
                    return Some(Event::OpenComment { open, depth });
                }
                Some(b"/*") => {
                    depth += 1;
                    if depth == COMMENT_DEPTH + 1 {
                        too_deep.get_or_insert(self.at);
                    }
                    self.at += 2;
                }
                Some(b"*/") => {
                    depth -= 1;
                    self.at += 2;
                }
                Some([0..b' ', _]) if !b"\t\r\n".contains(&self.bytes[self.at]) => {
                    let at = self.at;
                    self.at = self.bytes.len();
                    return Some(Event::Control { at });
                }
                Some(_) => self.at += 1,
            }
        }
        too_deep.map(|at| Event::DeepComment { open, at, end: self.at })
    }
}

/// Comments nest this deep at most: pest reads one by recursion, on a stack that it guards.
pub(super) const COMMENT_DEPTH: usize = 64;

impl Iterator for Events<'_> {
    type Item = Event;

    fn next(&mut self) -> Option<Event> {
        let event = match self.text {
            Some(open) => self.in_text(open),
            None => self.in_code(),
        };
        match event {
            Event::LineEnd { at } if at >= self.bytes.len() => None,
            event => Some(event),
        }
    }
}

/// The bytes that an event may begin with.
const MATTERS: [bool; 256] = {
    let mut table = [false; 256];
    let mut i = 0;
    while i < 0x20 {
        table[i] = i != b'\t' as usize && i != b'\r' as usize;
        i += 1;
    }
    let wanted = b"\"/()[]{}";
    let mut i = 0;
    while i < wanted.len() {
        table[wanted[i] as usize] = true;
        i += 1;
    }
    table
};

/// The closing bracket of an opening one.
pub(super) fn closer(open: u8) -> u8 {
    match open {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

/// Where a text can be cut so that every part is whole items, by byte offsets that increase; nothing where its brackets,
/// texts or comments do not close or nest past `limit`.
pub(super) fn outline(text: &str, limit: usize) -> Option<Vec<u32>> {
    let bytes = text.as_bytes();
    let mut open: Vec<u8> = Vec::new();
    let mut cuts = Vec::new();
    for event in Events::new(text) {
        match event {
            Event::Open { byte, .. } => open.push(closer(byte)),
            Event::OpenHole { .. } => open.push(b'}'),
            Event::Close { at, byte } => {
                if open.pop() != Some(byte) {
                    return None;
                }
                if open.is_empty() {
                    cuts.extend(item_after_bracket(bytes, at));
                }
            }
            Event::CloseHole { .. } => {
                open.pop()?;
            }
            Event::LineEnd { at } => {
                if open.is_empty() {
                    cuts.extend(item_on_next_line(bytes, at));
                }
            }
            Event::OpenText { .. }
            | Event::OpenComment { .. }
            | Event::DeepComment { .. }
            | Event::Control { .. } => return None,
        }
        if open.len() > limit {
            return None;
        }
    }
    cuts.dedup();
    open.is_empty().then_some(cuts)
}

/// The item that begins after a closing bracket, outside all others: a word that cannot go on with what the bracket
/// closed. Behind `)` and `]`, only on another line.
fn item_after_bracket(bytes: &[u8], at: usize) -> Option<u32> {
    let rest = &bytes[at + 1..];
    let blanks = rest.iter().position(|b| !b" \t\r\n;".contains(b))?;
    let far_enough = if bytes[at] == b'}' { blanks > 0 } else { rest[..blanks].contains(&b'\n') };
    let word = word_at(&rest[blanks..]);
    let goes_on = matches!(word, b"" | b"with" | b"else" | b"step" | b"in" | b"as");
    (far_enough && !goes_on).then_some((at + 1 + blanks) as u32)
}

/// The item that begins on the next line with a word that begins nothing but an item.
fn item_on_next_line(bytes: &[u8], at: usize) -> Option<u32> {
    let rest = &bytes[at + 1..];
    let blanks = rest.iter().position(|b| !b" \t".contains(b))?;
    let begins = matches!(
        word_at(&rest[blanks..]),
        b"let" | b"var" | b"fn" | b"import" | b"for" | b"if" | b"while" | b"return"
    );
    begins.then_some((at + 1 + blanks) as u32)
}

/// The word that the bytes begin with.
fn word_at(bytes: &[u8]) -> &[u8] {
    let is_start = bytes.first().is_some_and(|b| b.is_ascii_alphabetic() || *b == b'_' || *b >= 0x80);
    let end = bytes.iter().position(|b| !(b.is_ascii_alphanumeric() || *b == b'_' || *b >= 0x80));
    if is_start { &bytes[..end.unwrap_or(bytes.len())] } else { &[] }
}
