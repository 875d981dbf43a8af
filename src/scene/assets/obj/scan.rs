//! One pass over the text of an OBJ file before tobj reads its numbers: cuts away what tobj would refuse or misread, checks
//! every face, and notes what tobj does not keep: smoothing groups, corners without texture coordinates, places.

/// What a face stands under: faces in a row that agree are one run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FaceState {
    /// Index of the last `usemtl`'s name; [`NO_MATERIAL`] before any.
    pub material: u32,
    /// `s`: 0 for off.
    pub smoothing: u32,
    /// Every corner has a texture coordinate.
    pub has_uvs: bool,
    /// Every corner has a normal.
    pub has_normals: bool,
}

/// The material of faces before any `usemtl`.
pub(super) const NO_MATERIAL: u32 = u32::MAX;

/// What the pass finds.
#[derive(Debug, Default)]
pub(super) struct Scan<'t> {
    /// The lines for tobj: `v`, `vt`, `vn` and `f` alone, each well formed but for the digits of its numbers.
    pub pieces: Vec<Piece>,
    /// (First face, its state), in order.
    pub runs: Vec<(usize, FaceState)>,
    /// Faces given to tobj.
    pub n_faces: usize,
    /// Names after `usemtl`, each once.
    pub material_names: Vec<&'t str>,
    /// What stands after each `mtllib`.
    pub libraries: Vec<&'t str>,
    /// Whether the file has smoothing groups at all.
    pub has_smoothing: bool,
    /// Faces of fewer than three corners, left out.
    pub short_faces: usize,
    /// Curves and free-form surfaces, left out.
    pub free_forms: usize,
    /// Corners that refer to texture coordinates or normals of which the file has none.
    pub dangling: bool,
}

/// A stretch of lines for tobj, without the last line's end.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Piece {
    /// Bytes of the file.
    Range(usize, usize),
    /// A line mended.
    Made(String),
}

/// Where and why a file cannot be used.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// Byte offset of the place.
    pub offset: usize,
    /// What is wrong there.
    pub message: String,
}

/// The three lists that corners refer to.
const LISTS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

struct Pass<'t> {
    text: &'t str,
    scan: Scan<'t>,
    state: FaceState,
    /// How many positions, texture coordinates and normals there were so far.
    counts: [i64; 3],
    /// The greatest index into each list, and where it stands.
    greatest: [(i64, usize); 3],
}

/// Runs the pass.
pub(super) fn scan(text: &str) -> Result<Scan<'_>, Fault> {
    let state = FaceState { material: NO_MATERIAL, smoothing: 0, has_uvs: false, has_normals: false };
    let mut pass = Pass { text, scan: Scan::default(), state, counts: [0; 3], greatest: [(0, 0); 3] };
    let passed = lines(text).try_for_each(|(start, end)| pass.line(start, end));
    if passed.is_err() {
        pass.counts = total_counts(text);
    }
    // An index past the end can only be told at the end, but may stand before the fault that stopped the pass.
    let past_the_end = pass.check_indices();
    let first = [passed, past_the_end].into_iter().filter_map(Result::err).min_by_key(|fault| fault.offset);
    first.map_or(Ok(pass.scan), Err)
}

/// The lengths of the three lists of the whole file.
fn total_counts(text: &str) -> [i64; 3] {
    let mut counts = [0; 3];
    for (start, end) in lines(text) {
        let keyword = text[start..end].split_whitespace().next();
        if let Some(list) = ["v", "vt", "vn"].iter().position(|k| keyword == Some(k)) {
            counts[list] += 1;
        }
    }
    counts
}

/// The lines of a text as byte ranges, without line ends; a line that ends in a backslash goes on in the next.
fn lines(text: &str) -> impl Iterator<Item = (usize, usize)> {
    let bytes = text.as_bytes();
    let mut at = 0;
    std::iter::from_fn(move || {
        if at >= bytes.len() {
            return None;
        }
        let start = at;
        loop {
            let end = bytes[at..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |n| at + n);
            at = end + 1;
            let end = if end > start && bytes[end - 1] == b'\r' { end - 1 } else { end };
            if end == start || bytes[end - 1] != b'\\' || at >= bytes.len() {
                return Some((start, end));
            }
        }
    })
}

impl<'t> Pass<'t> {
    fn line(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        let line = &self.text.as_bytes()[start..end];
        let indent = line.iter().position(|b| !is_blank(*b)).unwrap_or(line.len());
        let (start, line) = (start + indent, &line[indent..]);
        if line.contains(&b'\n') {
            return self.joined_line(start, end);
        }
        match line {
            [b'v', b, ..] if is_blank(*b) => self.vertex(start, end),
            [b'v', b't', b, ..] if is_blank(*b) => self.texture_coordinate(start, end),
            [b'v', b'n', b, ..] if is_blank(*b) => self.normal(start, end),
            [b'f', b, ..] if is_blank(*b) => self.face(start, end),
            [b'f'] => self.face(start, end),
            [] | [b'#', ..] => Ok(()),
            _ => {
                self.statement(start, end);
                Ok(())
            }
        }
    }

    /// A line that goes on over line ends: joined, scanned apart, and taken over.
    fn joined_line(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        let joined = self.text[start..end].replace("\\\r\n", " ").replace("\\\n", " ");
        let mut apart = Pass {
            text: &joined,
            scan: Scan::default(),
            state: self.state,
            counts: self.counts,
            greatest: self.greatest,
        };
        apart.line(0, joined.len()).map_err(|f| Fault { offset: start, ..f })?;
        for (before, now) in self.greatest.iter_mut().zip(apart.greatest) {
            if now != *before {
                *before = (now.0, start);
            }
        }
        let (counts, found, state) = (apart.counts, apart.scan, apart.state);
        self.counts = counts;
        self.scan.short_faces += found.short_faces;
        self.scan.dangling |= found.dangling;
        if found.n_faces > 0 {
            self.state = FaceState { material: self.state.material, ..state };
            self.count_face();
        }
        let made = found.pieces.into_iter().map(|piece| match piece {
            Piece::Range(a, b) => Piece::Made(joined[a..b].to_owned()),
            made => made,
        });
        self.scan.pieces.extend(made);
        Ok(())
    }

    /// Three numbers; what follows (a weight, colours) says nothing about a polygon's place.
    fn vertex(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        self.counts[0] += 1;
        let cut = self.end_of_fields(start, end, 3, "a vertex needs three numbers")?;
        self.give(start, cut);
        Ok(())
    }

    fn normal(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        self.counts[2] += 1;
        let cut = self.end_of_fields(start, end, 3, "a normal needs three numbers")?;
        self.give(start, cut);
        Ok(())
    }

    /// One or two numbers; a third is depth in a solid texture.
    fn texture_coordinate(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        self.counts[1] += 1;
        match self.end_of_fields(start, end, 2, "") {
            Ok(cut) => self.give(start, cut),
            Err(_) => {
                let cut = self.end_of_fields(start, end, 1, "a texture coordinate needs a number")?;
                self.scan.pieces.push(Piece::Made(format!("{} 0", &self.text[start..cut])));
            }
        }
        Ok(())
    }

    /// Where the last of `n` fields after the keyword ends.
    fn end_of_fields(&self, start: usize, end: usize, n: usize, wanted: &str) -> Result<usize, Fault> {
        let line = &self.text.as_bytes()[start..end];
        let mut at = 0;
        for _ in 0..=n {
            at += line[at..].iter().position(|b| !is_blank(*b)).unwrap_or(line.len() - at);
            if at == line.len() || line[at] == b'#' {
                return Err(Fault { offset: start, message: wanted.to_owned() });
            }
            at += line[at..].iter().position(|b| is_blank(*b)).unwrap_or(line.len() - at);
        }
        Ok(start + at)
    }

    /// Gives bytes to tobj, in one piece with the line before where they follow on each other.
    fn give(&mut self, start: usize, end: usize) {
        match self.scan.pieces.last_mut() {
            Some(Piece::Range(_, last)) if only_blanks(&self.text.as_bytes()[*last..start]) => *last = end,
            _ => self.scan.pieces.push(Piece::Range(start, end)),
        }
    }

    fn face(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        let bytes = &self.text.as_bytes()[..end];
        let (mut at, mut corners, mut cut) = (start + 1, 0, end);
        let (mut has_uvs, mut has_normals) = (true, true);
        loop {
            while at < end && is_blank(bytes[at]) {
                at += 1;
            }
            if at == end || bytes[at] == b'#' {
                cut = cut.min(at);
                break;
            }
            let given = self.corner(&mut at, end)?;
            has_uvs &= given[1];
            has_normals &= given[2];
            corners += 1;
        }
        if corners < 3 {
            self.scan.short_faces += 1;
            return Ok(());
        }
        self.state = FaceState { has_uvs, has_normals, ..self.state };
        self.count_face();
        self.give(start, cut);
        Ok(())
    }

    fn count_face(&mut self) {
        if self.scan.runs.last().is_none_or(|(_, state)| *state != self.state) {
            self.scan.runs.push((self.scan.n_faces, self.state));
        }
        self.scan.n_faces += 1;
    }

    /// One corner, `v`, `v/vt`, `v//vn` or `v/vt/vn`, at `at`, which moves on behind it; which of the three it gives.
    fn corner(&mut self, at: &mut usize, end: usize) -> Result<[bool; 3], Fault> {
        let (bytes, start) = (self.text.as_bytes(), *at);
        let mut given = [false; 3];
        for (list, is_given) in given.iter_mut().enumerate() {
            let number = *at;
            while *at < end && matches!(bytes[*at], b'0'..=b'9' | b'-' | b'+') {
                *at += 1;
            }
            if *at > number {
                self.index(list, number, *at)?;
                *is_given = true;
            }
            match bytes.get(*at) {
                Some(b'/') if *at < end && list < 2 => *at += 1,
                _ => break,
            }
        }
        let ends = *at == end || is_blank(bytes[*at]);
        if ends && given[0] { Ok(given) } else { Err(self.no_corner(start, end)) }
    }

    fn no_corner(&self, start: usize, end: usize) -> Fault {
        let word = word_at(self.text, start, end);
        Fault {
            offset: start,
            message: format!("`{word}` is no corner of a face: expected v, v/vt, v//vn or v/vt/vn"),
        }
    }

    /// Checks an index as far as it can be before the file's end.
    fn index(&mut self, list: usize, start: usize, end: usize) -> Result<(), Fault> {
        let digits = &self.text[start..end];
        let fault = |message| Err(Fault { offset: start, message });
        let Some(index) = whole_number(digits.as_bytes()) else {
            return fault(format!("`{digits}` is no index"));
        };
        let (name, count) = (LISTS[list], self.counts[list]);
        match index {
            0 => fault(format!("a {name} has index 0, but OBJ counts from 1")),
            i64::MIN..0 if -index > count && (list == 0 || count > 0) => {
                fault(format!("index {index} refers to a {name} before the first: only {count} come before"))
            }
            1.. if index > self.greatest[list].0 => {
                self.greatest[list] = (index, start);
                Ok(())
            }
            i64::MIN..0 if list > 0 && count == 0 => {
                self.scan.dangling = true;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn check_indices(&mut self) -> Result<(), Fault> {
        for (list, (index, offset)) in self.greatest.into_iter().enumerate() {
            let count = self.counts[list];
            if index > count && (list == 0 || count > 0) {
                let name = LISTS[list];
                let message = format!("a face refers to {name} {index}, but the file has {count}");
                return Err(Fault { offset, message });
            }
            self.scan.dangling |= index > count;
        }
        Ok(())
    }

    /// The lines that are rare.
    fn statement(&mut self, start: usize, end: usize) {
        let line = self.text[start..end].trim_end();
        let (keyword, rest) = line.split_once([' ', '\t']).unwrap_or((line, ""));
        match keyword {
            "usemtl" => self.state.material = self.name_material(rest.trim()),
            "mtllib" => self.scan.libraries.push(rest.trim()),
            "s" => {
                self.scan.has_smoothing = true;
                self.state.smoothing = match rest.trim() {
                    "off" | "" => 0,
                    "on" => 1,
                    number => number.parse().unwrap_or(0),
                };
            }
            "curv" | "curv2" | "surf" => self.scan.free_forms += 1,
            _ => {}
        }
    }

    fn name_material(&mut self, name: &'t str) -> u32 {
        let names = &mut self.scan.material_names;
        let known = names.iter().rposition(|n| *n == name);
        known.unwrap_or_else(|| {
            names.push(name);
            names.len() - 1
        }) as u32
    }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | 0x0b | 0x0c)
}

/// Whether nothing but blanks and line ends lies between two lines that are kept (looked for in a few bytes only).
fn only_blanks(between: &[u8]) -> bool {
    between.len() < 16 && between.iter().all(|b| *b == b'\n' || is_blank(*b))
}

/// A whole number with an optional sign; none where it is malformed or has more than 18 digits.
fn whole_number(digits: &[u8]) -> Option<i64> {
    let (negative, digits) = match digits {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        all => (false, all),
    };
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let mut value = 0;
    for digit in digits {
        value = value * 10 + i64::from(digit.checked_sub(b'0').filter(|d| *d < 10)?);
    }
    Some(if negative { -value } else { value })
}

/// The text up to the next blank.
fn word_at(text: &str, start: usize, end: usize) -> &str {
    text[start..end].split_whitespace().next().unwrap_or("")
}

/// The first number of a `v`, `vt` or `vn` line that is none, or that is no finite position.
pub(super) fn first_bad_number(text: &str) -> Option<Fault> {
    lines(text).find_map(|(start, end)| {
        let line = &text[start..end];
        let keyword = line.split_whitespace().next()?;
        let n = match keyword {
            "v" | "vn" => 3,
            "vt" => 2,
            _ => return None,
        };
        let words = line.split_whitespace().skip(1).take(n).take_while(|w| *w != "\\");
        words.map(|word| (word, word.parse::<f64>())).find_map(|(word, number)| {
            let what = match number {
                Err(_) => "is not a number",
                Ok(x) if keyword == "v" && !x.is_finite() => "is not a finite number",
                Ok(_) => return None,
            };
            // `word` is a slice of `text`, so its address says where it stands.
            let offset = word.as_ptr() as usize - text.as_ptr() as usize;
            Some(Fault { offset, message: format!("`{word}` {what}") })
        })
    })
}

/// Line and column of a byte offset, from 1, columns in characters.
pub(super) fn place(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..offset];
    let line_start = before.rfind('\n').map_or(0, |n| n + 1);
    (before.bytes().filter(|b| *b == b'\n').count() + 1, before[line_start..].chars().count() + 1)
}
