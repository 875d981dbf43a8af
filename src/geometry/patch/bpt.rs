//! `.bpt` files: the number of patches, then for each its two degrees and its control points row by row, as numbers between white space.
//! Knows nothing of files on disk.

use super::Bicubic;
use glam::DVec3;

/// What is wrong with the text of a `.bpt` file, and in which line (from 1).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BptError {
    /// A word that is not a finite number, or not a whole one where a count or degree is due.
    #[error("line {line}: {expected} expected, not \"{found}\"")]
    Number {
        /// The line.
        line: usize,
        /// "the number of patches", "a degree", "a coordinate".
        expected: &'static str,
        /// The word.
        found: String,
    },
    /// The text ends too early.
    #[error("the file ends where {expected} is expected, in patch {patch} of {n_patches}")]
    Ends {
        /// What was due.
        expected: &'static str,
        /// Which patch, from 1; 0 before the first.
        patch: usize,
        /// How many there should be.
        n_patches: usize,
    },
    /// Degrees other than 3 and 3.
    #[error("line {line}: a patch of degrees {u} and {v}; only bicubic ones (3 3) can be read")]
    Degree {
        /// The line.
        line: usize,
        /// Degree in u.
        u: usize,
        /// Degree in v.
        v: usize,
    },
    /// More text after the last patch.
    #[error("line {line}: \"{found}\" after the last of {n_patches} patches")]
    Rest {
        /// The line.
        line: usize,
        /// The word.
        found: String,
        /// How many patches were announced.
        n_patches: usize,
    },
}

/// Reads patches. The number at the head is not trusted with memory: patches are counted as they come.
pub fn parse(text: &str) -> Result<Vec<Bicubic>, BptError> {
    let mut words = Words { lines: text.lines().enumerate(), line: 0, rest: "".split_whitespace() };
    let n_patches = words.whole("the number of patches", 0, 0)?;
    let mut patches = Vec::new();
    for patch in 1..=n_patches {
        let u = words.whole("a degree", patch, n_patches)?;
        let v = words.whole("a degree", patch, n_patches)?;
        if (u, v) != (3, 3) {
            return Err(BptError::Degree { line: words.line, u, v });
        }
        let mut points = [[DVec3::ZERO; 4]; 4];
        for coordinate in points.iter_mut().flatten().flat_map(|p| p.as_mut().iter_mut()) {
            *coordinate = words.coordinate(patch, n_patches)?;
        }
        patches.push(Bicubic { points });
    }
    match words.next() {
        Some(found) => Err(BptError::Rest { line: words.line, found: found.to_owned(), n_patches }),
        None => Ok(patches),
    }
}

/// The words of a text, with their lines.
struct Words<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    line: usize,
    rest: std::str::SplitWhitespace<'a>,
}

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<&'a str> {
        loop {
            if let Some(word) = self.rest.next() {
                return Some(word);
            }
            let (index, line) = self.lines.next()?;
            (self.line, self.rest) = (index + 1, line.split_whitespace());
        }
    }

    fn read<T: std::str::FromStr>(
        &mut self,
        expected: &'static str,
        patch: usize,
        n_patches: usize,
        valid: impl Fn(&T) -> bool,
    ) -> Result<T, BptError> {
        let word = self.next().ok_or(BptError::Ends { expected, patch, n_patches })?;
        let wrong = || BptError::Number { line: self.line, expected, found: word.to_owned() };
        word.parse().ok().filter(valid).ok_or_else(wrong)
    }

    fn whole(&mut self, expected: &'static str, patch: usize, n_patches: usize) -> Result<usize, BptError> {
        self.read(expected, patch, n_patches, |_| true)
    }

    fn coordinate(&mut self, patch: usize, n_patches: usize) -> Result<f64, BptError> {
        self.read("a coordinate", patch, n_patches, |x: &f64| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sixteen(extra: &str) -> String {
        let points: String = (0..16).map(|i| format!("{} {} 0\n", i / 4, i % 4)).collect();
        format!("1\n3 3\n{points}{extra}")
    }

    #[test]
    fn points_are_read_row_by_row() {
        let patches = parse(&sixteen("")).unwrap();
        assert_eq!(patches[0].points[2][1], DVec3::new(2.0, 1.0, 0.0));
    }

    #[test]
    fn faults_say_where_they_are() {
        assert_eq!(
            parse(&sixteen("7")).unwrap_err(),
            BptError::Rest { line: 19, found: "7".into(), n_patches: 1 }
        );
        let cut = sixteen("");
        let cut = &cut[..cut.len() - 4];
        assert!(matches!(parse(cut), Err(BptError::Ends { patch: 1, n_patches: 1, .. })));
        assert_eq!(parse("1\n2 3\n").unwrap_err(), BptError::Degree { line: 2, u: 2, v: 3 });
        let wrong = sixteen("").replace("2 1 0", "2 nan 0");
        assert!(matches!(parse(&wrong), Err(BptError::Number { line: 12, .. })), "{:?}", parse(&wrong));
        assert!(parse("99999999999\n3 3\n1").is_err() && parse("").is_err() && parse("-1").is_err());
    }

    #[test]
    fn the_classic_models_are_read_whole() {
        let Some(data) = std::env::var_os("OGEE_DATA") else {
            eprintln!("skipped: OGEE_DATA is not set");
            return;
        };
        for (name, n) in [("teapot", 32), ("teacup", 26), ("teaspoon", 16)] {
            let path = std::path::Path::new(&data).join("patches").join(format!("{name}.bpt"));
            assert_eq!(parse(&std::fs::read_to_string(path).unwrap()).unwrap().len(), n);
        }
    }
}
