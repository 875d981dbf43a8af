//! Where the bytes of a buffer or a picture are: written into the name itself, or in a file beside the model. Nothing is fetched from a
//! network.

/// What a URI names.
#[derive(Debug, PartialEq)]
pub(super) enum Source {
    /// Bytes written into it.
    Bytes(Vec<u8>),
    /// A file, relative to the model.
    File(String),
}

/// Takes a URI apart.
pub(super) fn source(uri: &str) -> Result<Source, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        return data_bytes(data).map(Source::Bytes);
    }
    if let Some((scheme, _)) = uri.split_once(':').filter(|(scheme, _)| is_scheme(scheme)) {
        return Err(format!("`{scheme}:` names are not followed: nothing is fetched"));
    }
    if uri.starts_with("//") {
        return Err("`//` names are not followed: nothing is fetched".into());
    }
    let name = unescaped(uri).ok_or("its escapes cannot be read")?;
    String::from_utf8(name).map(Source::File).map_err(|_| "its name is no UTF-8".into())
}

/// Letters, digits and `+-.` after a letter; one letter alone is a drive.
fn is_scheme(text: &str) -> bool {
    let rest = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    text.len() > 1 && text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(rest)
}

/// What follows `data:`.
fn data_bytes(data: &str) -> Result<Vec<u8>, String> {
    let (kind, content) = data.split_once(',').ok_or("a `data:` name has no comma before its data")?;
    if !kind.ends_with(";base64") {
        return unescaped(content).ok_or("its escapes cannot be read".into());
    }
    base64(content).ok_or("its base64 cannot be read".into())
}

/// Bytes with `%41` read as `A`.
fn unescaped(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => (hex(rest.next()?)? << 4) | hex(rest.next()?)?,
            byte => byte,
        });
    }
    Some(bytes)
}

fn hex(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).map(|d| d as u8)
}

/// RFC 4648, of either alphabet; `=` at the end may lack.
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut word = 0u32;
        for (k, letter) in group.iter().enumerate() {
            word |= u32::from(sextet(*letter)?) << (18 - 6 * k);
        }
        if group.len() == 1 {
            return None;
        }
        bytes.extend_from_slice(&word.to_be_bytes()[1..group.len()]);
    }
    Some(bytes)
}

fn sextet(letter: u8) -> Option<u8> {
    match letter {
        b'A'..=b'Z' => Some(letter - b'A'),
        b'a'..=b'z' => Some(letter - b'a' + 26),
        b'0'..=b'9' => Some(letter - b'0' + 52),
        b'+' | b'-' => Some(62),
        b'/' | b'_' => Some(63),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_files_data_or_refused() {
        assert_eq!(source("a%20b.bin"), Ok(Source::File("a b.bin".into())));
        assert_eq!(source("../c.png"), Ok(Source::File("../c.png".into())));
        let hello = Ok(Source::Bytes(b"hello".to_vec()));
        assert_eq!(source("data:application/octet-stream;base64,aGVsbG8="), hello);
        assert_eq!(source("data:;base64,aGVsbG8"), hello);
        assert_eq!(source("data:text/plain,h%65llo"), hello);
        for bad in [
            "https://a.b/c.bin",
            "//a/b",
            "file:///etc/x",
            "data:x",
            "data:;base64,a",
            "data:;base64,!!",
            "%4",
        ] {
            assert!(source(bad).is_err(), "{bad}");
        }
    }
}
