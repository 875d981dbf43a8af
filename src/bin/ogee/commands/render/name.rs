//! Names of pictures, with a place for the frame's number: `walk-{frame:04}.png`.

use std::path::{Path, PathBuf};

/// A path as it was given, or with numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    given: PathBuf,
    /// Text, and after each but the last a number of at least so many digits.
    pieces: Option<(Vec<(String, usize)>, String)>,
}

/// More digits than any number of a frame has.
const MOST_DIGITS: usize = 20;

impl Name {
    /// Reads the places for numbers; a sentence where one is written in another way.
    pub fn read(path: &Path) -> Result<Name, String> {
        let given = path.to_owned();
        let Some(mut rest) = path.to_str() else { return Ok(Name { given, pieces: None }) };
        let (mut pieces, mut text) = (Vec::new(), String::new());
        while let Some((before, place)) = rest.split_once('{') {
            let (inside, after) = place.split_once('}').unwrap_or((place, ""));
            let is_closed = place.contains('}');
            text.push_str(before);
            match inside.strip_prefix("frame").and_then(digits).filter(|_| is_closed) {
                Some(digits) => pieces.push((std::mem::take(&mut text), digits)),
                None if !inside.contains('{') && is_meant(inside) => {
                    let written = format!("{{{inside}{}", if is_closed { "}" } else { "" });
                    return Err(format!(
                        "`{written}` is no place for a frame's number: write `{{frame}}`, or `{{frame:04}}` for four digits"
                    ));
                }
                None => {
                    text.push('{');
                    rest = place;
                    continue;
                }
            }
            rest = after;
        }
        text.push_str(rest);
        let pieces = (!pieces.is_empty()).then_some((pieces, text));
        Ok(Name { given, pieces })
    }

    /// Whether each frame has a name of its own.
    pub fn is_numbered(&self) -> bool {
        self.pieces.is_some()
    }

    /// The path of a frame.
    pub fn of(&self, frame: u32) -> PathBuf {
        let Some((pieces, last)) = &self.pieces else { return self.given.clone() };
        let mut path = String::new();
        for (text, digits) in pieces {
            path += &format!("{text}{frame:0digits$}");
        }
        PathBuf::from(path + last)
    }

    /// As it was given.
    pub fn given(&self) -> &Path {
        &self.given
    }

    /// Such a name with a place for numbers, where it has none: `walk.gif` with `walk-{frame:04}.png`.
    pub fn numbered_like(&self, extension: &str) -> String {
        let stem = self.given.file_stem().map_or("frame".into(), |stem| stem.to_string_lossy());
        self.given.with_file_name(format!("{stem}-{{frame:04}}.{extension}")).display().to_string()
    }
}

/// Whether a person who wrote `{inside}` may mean the frame's number: by a word like `frame`, or a number of digits.
fn is_meant(inside: &str) -> bool {
    let (word, format) = inside.split_once(':').unwrap_or((inside, ""));
    let like = word.starts_with("frame") || ogee::diag::nearest(&word.to_lowercase(), ["frame"]).is_some();
    like || inside.is_empty() || digits(&inside[word.len()..]).is_some_and(|_| !format.is_empty())
}

/// How many digits `""`, `":4"` or `":04"` asks for.
fn digits(format: &str) -> Option<usize> {
    if format.is_empty() {
        return Some(0);
    }
    let digits = format.strip_prefix(':')?;
    let is_number = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
    digits.parse().ok().filter(|n| is_number && (1..=MOST_DIGITS).contains(n))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, frame: u32) -> String {
        Name::read(Path::new(name)).unwrap().of(frame).display().to_string()
    }

    #[test]
    fn numbers_stand_where_they_are_asked_for() {
        assert_eq!(of("out/{frame:04}.png", 17), "out/0017.png");
        assert_eq!(of("a{frame}b{frame:3}.png", 5), "a5b005.png");
        assert_eq!(of("{frame:2}.png", 12345), "12345.png");
        assert_eq!(of("{other}.png", 3), "{other}.png");
        assert_eq!(of("{a{frame}.png", 3), "{a3.png");
        assert!(!Name::read(Path::new("walk.png")).unwrap().is_numbered());
        assert_eq!(
            Name::read(Path::new("a/walk.png")).unwrap().numbered_like("png"),
            "a/walk-{frame:04}.png"
        );
    }

    #[test]
    fn places_that_are_none_are_told_as_they_were_written() {
        for (name, written) in [
            ("{frame:xx}.png", "`{frame:xx}`"),
            ("{frame:}.png", "`{frame:}`"),
            ("{frame:0}.png", "`{frame:0}`"),
            ("{frame:+4}.png", "`{frame:+4}`"),
            ("{frames}.png", "`{frames}`"),
            ("{fraem}.png", "`{fraem}`"),
            ("a{Frame:04}.png", "`{Frame:04}`"),
            ("{i:04}.png", "`{i:04}`"),
            ("{}.png", "`{}`"),
            ("a{frame:04.png", "`{frame:04.png`"),
            ("{frame:99999999999999999999999}.png", "`{frame:99999999999999999999999}`"),
        ] {
            let said = Name::read(Path::new(name)).unwrap_err();
            assert!(said.starts_with(written), "{name}: {said}");
        }
    }
}
