//! The numbers of an OBJ file as its lines give them, and how one is read. Knows nothing of lines, names or meshes.

use super::scan::is_blank;
use glam::{DVec2, DVec3};

/// The three lists of a file and the corners that refer to them.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    /// All positions in the order of the file; the component of a malformed number is NaN.
    pub positions: Vec<DVec3>,
    /// All texture coordinates.
    pub uvs: Vec<DVec2>,
    /// All normals, of any length.
    pub normals: Vec<DVec3>,
    /// Corners of each face; empty while all are triangles.
    pub arities: Vec<u32>,
    /// Indices into `positions` of all corners of all faces in a row.
    pub position_of: Vec<u32>,
    /// The same into `uvs`, [`NONE`] where a corner has none; shorter where no later corner has one.
    pub uv_of: Vec<u32>,
    /// The same into `normals`.
    pub normal_of: Vec<u32>,
    /// Some number could not be read.
    pub malformed: bool,
}

/// The index of a corner that gives none.
pub(super) const NONE: u32 = u32::MAX;

impl Numbers {
    /// Adds a corner to the face at hand: its position, texture coordinate and normal.
    pub fn corner(&mut self, [position, uv, normal]: [Option<u32>; 3]) {
        let before = self.position_of.len();
        self.position_of.push(position.unwrap_or(NONE));
        for (list, index) in [(&mut self.uv_of, uv), (&mut self.normal_of, normal)] {
            if let Some(index) = index {
                list.resize(before, NONE);
                list.push(index);
            }
        }
    }

    /// Ends a face whose first corner is the one of this number.
    pub fn end_face(&mut self, first: usize) {
        let corners = self.position_of.len() - first;
        if corners != 3 && self.arities.is_empty() {
            self.arities = vec![3; first / 3];
        }
        if corners != 3 || !self.arities.is_empty() {
            self.arities.push(corners as u32);
        }
    }

    /// Takes back the corners from one on.
    pub fn forget_corners(&mut self, first: usize) {
        self.position_of.truncate(first);
        self.uv_of.truncate(first);
        self.normal_of.truncate(first);
    }

    /// Corners that refer to lists of which the file has nothing refer to nothing.
    pub fn finish(&mut self) {
        if self.uvs.is_empty() {
            self.uv_of.clear();
        }
        if self.normals.is_empty() {
            self.normal_of.clear();
        }
    }

    /// Whether every position that a face uses is finite.
    pub fn used_positions_are_finite(&self) -> bool {
        let finite = |i: &u32| self.positions.get(*i as usize).is_none_or(|p| p.is_finite());
        self.positions.iter().all(|p| p.is_finite()) || self.position_of.iter().all(finite)
    }

    /// Texture coordinates that are not finite become 0; how many of those there were that a face uses.
    pub fn mend_uvs(&mut self) -> usize {
        let mut bad: Vec<u32> =
            (0..).zip(&self.uvs).filter(|(_, uv)| !uv.is_finite()).map(|(i, _)| i).collect();
        for &i in &bad {
            self.uvs[i as usize] = DVec2::ZERO;
        }
        if !bad.is_empty() {
            let used: std::collections::HashSet<u32> = self.uv_of.iter().copied().collect();
            bad.retain(|i| used.contains(i));
        }
        bad.len()
    }
}

/// The number at `at` in a line that ends at `end`, which moves on behind the word; none where the word is no number. The
/// same bits as `str::parse`.
pub(super) fn read_number(text: &str, at: &mut usize, end: usize) -> Option<f64> {
    let (bytes, start) = (&text.as_bytes()[..end], *at);
    if let Some((value, stop)) = plain_decimal(bytes, start) {
        *at = stop;
        return Some(value);
    }
    let stop = bytes[start..].iter().position(|b| is_blank(*b)).map_or(end, |n| start + n);
    *at = stop;
    text[start..stop].parse().ok()
}

/// Digits up to this many make a whole number below 2⁵³ …
const EXACT_DIGITS: usize = 15;

/// … and these are the powers of ten that f64 holds exactly, so that one division rounds once (Clinger, *How to read floating
/// point numbers accurately*, 1990).
const EXACT_POWERS: [f64; EXACT_DIGITS + 1] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// A word of a sign, few digits and a point, and where it ends; none for any other, which may be a number all the same.
fn plain_decimal(bytes: &[u8], start: usize) -> Option<(f64, usize)> {
    let negative = bytes.get(start) == Some(&b'-');
    let mut at = start + usize::from(negative);
    let first = at;
    let (mut digits, mut point) = (0u64, None);
    loop {
        match bytes.get(at) {
            Some(d @ b'0'..=b'9') => digits = digits.wrapping_mul(10).wrapping_add(u64::from(d - b'0')),
            Some(b'.') if point.is_none() => point = Some(at),
            Some(b) if !is_blank(*b) => return None,
            _ => break,
        }
        at += 1;
    }
    let n_digits = at - first - usize::from(point.is_some());
    if n_digits == 0 || n_digits > EXACT_DIGITS {
        return None;
    }
    let value = digits as f64 / EXACT_POWERS[point.map_or(0, |point| at - point - 1)];
    Some((if negative { -value } else { value }, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(word: &str) -> Option<f64> {
        let text = format!("{word} 7");
        let mut at = 0;
        let value = read_number(&text, &mut at, text.len());
        assert_eq!(at, word.len(), "{word}");
        value
    }

    #[test]
    fn numbers_have_the_bits_that_the_standard_library_gives() {
        let mut random = 1u64;
        let mut next = |n: u64| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 33) % n
        };
        for _ in 0..20_000 {
            let whole: String = (0..next(12)).map(|_| char::from(b'0' + next(10) as u8)).collect();
            let rest: String = (0..next(12)).map(|_| char::from(b'0' + next(10) as u8)).collect();
            let sign = ["", "-", "+"][next(3) as usize];
            let tail = ["", "", "", "e3", "E-7"][next(5) as usize];
            let word = format!("{sign}{whole}.{rest}{tail}");
            assert_eq!(read(&word).map(f64::to_bits), word.parse().ok().map(f64::to_bits), "{word}");
        }
    }

    #[test]
    fn words_at_the_edge_of_being_numbers_are_read_as_the_standard_library_does() {
        for word in [
            "-0",
            "0",
            "-",
            ".",
            "-.",
            "5.",
            ".5",
            "1.2.3",
            "1e",
            "1e5",
            "inf",
            "-nan",
            "0x1",
            "1_0",
            "--1",
            "1-",
            "123456789012345",
            "1234567890123456",
            "9007199254740993",
            "0.000000000000001",
            "0.0000000000000001",
        ] {
            assert_eq!(read(word).map(f64::to_bits), word.parse().ok().map(f64::to_bits), "{word}");
        }
    }
}
