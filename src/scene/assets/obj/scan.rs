//! One pass over the text of an OBJ file: reads its numbers, checks every face, and notes smoothing groups, materials and the
//! places of faults.

use super::numbers::{NONE, Numbers, read_number};
use glam::{DVec2, DVec3};
use std::ops::Range;

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
    /// What `v`, `vt`, `vn` and `f` give.
    pub numbers: Numbers,
    /// (First face, its state), in order.
    pub runs: Vec<(usize, FaceState)>,
    /// Faces of three corners or more.
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
    pass.scan.numbers.finish();
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
            let end = memchr::memchr(b'\n', &bytes[at..]).map_or(bytes.len(), |n| at + n);
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
        if memchr::memchr(b'\n', line).is_some() {
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
            scan: Scan { numbers: std::mem::take(&mut self.scan.numbers), ..Scan::default() },
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
        self.scan.numbers = found.numbers;
        if found.n_faces > 0 {
            self.state = FaceState { material: self.state.material, ..state };
            self.count_face();
        }
        Ok(())
    }

    /// Three numbers; what follows (a weight, colours) says nothing about a polygon's place.
    fn vertex(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        self.counts[0] += 1;
        let position = self.three(start, start + 1, end, "a vertex needs three numbers")?;
        self.scan.numbers.positions.push(position);
        Ok(())
    }

    fn normal(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        self.counts[2] += 1;
        let normal = self.three(start, start + 2, end, "a normal needs three numbers")?;
        self.scan.numbers.normals.push(normal);
        Ok(())
    }

    /// One or two numbers; a third is depth in a solid texture.
    fn texture_coordinate(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        self.counts[1] += 1;
        let (uv, n) = self.fields::<2>(start + 2, end);
        if n == 0 {
            return Err(Fault { offset: start, message: "a texture coordinate needs a number".to_owned() });
        }
        self.scan.numbers.uvs.push(DVec2::from_array(uv));
        Ok(())
    }

    fn three(&mut self, line: usize, from: usize, end: usize, wanted: &str) -> Result<DVec3, Fault> {
        match self.fields::<3>(from, end) {
            (fields, 3) => Ok(DVec3::from_array(fields)),
            _ => Err(Fault { offset: line, message: wanted.to_owned() }),
        }
    }

    /// Up to `N` numbers, and how many there are; 0 in place of those that are missing. What is no number is NaN, and that is
    /// remembered.
    fn fields<const N: usize>(&mut self, from: usize, end: usize) -> ([f64; N], usize) {
        let (mut at, mut fields) = (from, [0.0; N]);
        for (n, field) in fields.iter_mut().enumerate() {
            at = self.skip_blanks(at, end);
            if at == end || self.text.as_bytes()[at] == b'#' {
                return (fields, n);
            }
            *field = read_number(self.text, &mut at, end).unwrap_or_else(|| {
                self.scan.numbers.malformed = true;
                f64::NAN
            });
        }
        (fields, N)
    }

    fn skip_blanks(&self, at: usize, end: usize) -> usize {
        let rest = &self.text.as_bytes()[at..end];
        rest.iter().position(|b| !is_blank(*b)).map_or(end, |n| at + n)
    }

    fn face(&mut self, start: usize, end: usize) -> Result<(), Fault> {
        let first = self.scan.numbers.position_of.len();
        let (mut has_uvs, mut has_normals) = (true, true);
        let mut at = start + 1;
        loop {
            at = self.skip_blanks(at, end);
            if at == end || self.text.as_bytes()[at] == b'#' {
                break;
            }
            let corner = self.corner(&mut at, end)?;
            has_uvs &= corner[1].is_some();
            has_normals &= corner[2].is_some();
            self.scan.numbers.corner(corner);
        }
        if self.scan.numbers.position_of.len() - first < 3 {
            self.scan.numbers.forget_corners(first);
            self.scan.short_faces += 1;
            return Ok(());
        }
        self.scan.numbers.end_face(first);
        self.state = FaceState { has_uvs, has_normals, ..self.state };
        self.count_face();
        Ok(())
    }

    fn count_face(&mut self) {
        if self.scan.runs.last().is_none_or(|(_, state)| *state != self.state) {
            self.scan.runs.push((self.scan.n_faces, self.state));
        }
        self.scan.n_faces += 1;
    }

    /// One corner, `v`, `v/vt`, `v//vn` or `v/vt/vn`, at `at`, which moves on behind it: its indices from 0.
    fn corner(&mut self, at: &mut usize, end: usize) -> Result<[Option<u32>; 3], Fault> {
        let (bytes, start) = (&self.text.as_bytes()[..end], *at);
        let mut given = [None; 3];
        for (list, index) in given.iter_mut().enumerate() {
            let number = *at;
            let value = signed_digits(bytes, at);
            if *at > number {
                *index = Some(self.index(list, value, number..*at)?);
            }
            match bytes.get(*at) {
                Some(b'/') if list < 2 => *at += 1,
                _ => break,
            }
        }
        let ends = bytes.get(*at).is_none_or(|b| is_blank(*b));
        if ends && given[0].is_some() { Ok(given) } else { Err(self.no_corner(start, end)) }
    }

    fn no_corner(&self, start: usize, end: usize) -> Fault {
        let word = word_at(self.text, start, end);
        Fault {
            offset: start,
            message: format!("`{word}` is no corner of a face: expected v, v/vt, v//vn or v/vt/vn"),
        }
    }

    /// An index from 0, checked as far as it can be before the file's end; [`NONE`] into a list that is empty so far.
    fn index(&mut self, list: usize, index: Option<i64>, place: Range<usize>) -> Result<u32, Fault> {
        let count = self.counts[list];
        match index {
            Some(index) if index > 0 => {
                if index > self.greatest[list].0 {
                    self.greatest[list] = (index, place.start);
                }
                Ok((index - 1).min(i64::from(NONE) - 1) as u32)
            }
            Some(index) if index < 0 && -index <= count => Ok((count + index) as u32),
            Some(index) if index < 0 && list > 0 && count == 0 => {
                self.scan.dangling = true;
                Ok(NONE)
            }
            _ => Err(self.no_index(list, index, place)),
        }
    }

    #[cold]
    fn no_index(&self, list: usize, index: Option<i64>, place: Range<usize>) -> Fault {
        let (name, count) = (LISTS[list], self.counts[list]);
        let message = match index {
            None => format!("`{}` is no index", &self.text[place.clone()]),
            Some(0) => format!("a {name} has index 0, but OBJ counts from 1"),
            Some(index) => {
                format!("index {index} refers to a {name} before the first: only {count} come before")
            }
        };
        Fault { offset: place.start, message }
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

/// What stands between the words of a line.
pub(super) fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | 0x0b | 0x0c)
}

/// The whole number of the digits and signs at `at`, which moves on behind them; none where they make none.
fn signed_digits(bytes: &[u8], at: &mut usize) -> Option<i64> {
    let start = *at;
    let (mut value, mut plain) = (0i64, true);
    while let Some(byte @ (b'0'..=b'9' | b'-' | b'+')) = bytes.get(*at) {
        plain &= byte.is_ascii_digit();
        value = value.wrapping_mul(10).wrapping_add(i64::from(byte.wrapping_sub(b'0')));
        *at += 1;
    }
    let digits = &bytes[start..*at];
    if plain && (1..=18).contains(&digits.len()) { Some(value) } else { whole_number(digits) }
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
        let mut words =
            line.split(|c: char| c == '\n' || u8::try_from(c).is_ok_and(is_blank)).filter(|w| !w.is_empty());
        let keyword = words.next()?;
        let n = match keyword {
            "v" | "vn" => 3,
            "vt" => 2,
            _ => return None,
        };
        let words = words.take(n).take_while(|w| *w != "\\");
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
