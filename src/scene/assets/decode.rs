//! Text of asset files, whatever wrote it: UTF-8, UTF-16 of both orders, or the Latin-1 of old exporters.

use encoding_rs::{Encoding, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// A file's bytes as text with `\n` (or `\r\n`) line ends. Never fails: bytes that are no UTF-8 and no UTF-16 are taken for
/// Windows-1252, the superset of Latin-1 that such files are in practice.
pub fn decode(bytes: Vec<u8>) -> String {
    let text = match Encoding::for_bom(&bytes) {
        Some((encoding, bom)) => encoding.decode_without_bom_handling(&bytes[bom..]).0.into_owned(),
        None => match utf16_by_zeros(&bytes) {
            Some(encoding) => encoding.decode_without_bom_handling(&bytes).0.into_owned(),
            None => String::from_utf8(bytes)
                .unwrap_or_else(|e| WINDOWS_1252.decode_without_bom_handling(e.as_bytes()).0.into_owned()),
        },
    };
    let ends_by_return_alone = text.contains('\r') && !text.contains('\n');
    if ends_by_return_alone { text.replace('\r', "\n") } else { text }
}

/// UTF-16 without its mark: the first character is ASCII, so one of the first two bytes is 0.
fn utf16_by_zeros(bytes: &[u8]) -> Option<&'static Encoding> {
    match bytes {
        [0, first, ..] if *first != 0 => Some(UTF_16BE),
        [first, 0, ..] if *first != 0 => Some(UTF_16LE),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_encodings_of_a_name_give_the_name() {
        let name = "usemtl Terraindæk\n";
        let wide = |to: fn(u16) -> [u8; 2]| name.encode_utf16().flat_map(to).collect::<Vec<u8>>();
        let marked = |mark: &[u8], rest: Vec<u8>| [mark, &rest].concat();
        let latin = name.chars().map(|c| c as u8).collect();
        for bytes in [
            name.as_bytes().to_vec(),
            marked(b"\xEF\xBB\xBF", name.as_bytes().to_vec()),
            marked(b"\xFF\xFE", wide(u16::to_le_bytes)),
            marked(b"\xFE\xFF", wide(u16::to_be_bytes)),
            wide(u16::to_le_bytes),
            wide(u16::to_be_bytes),
            latin,
        ] {
            assert_eq!(decode(bytes), name);
        }
    }

    #[test]
    fn lines_of_old_macintoshes_are_lines() {
        assert_eq!(decode(b"v 0 0 0\rv 1 0 0\r".to_vec()), "v 0 0 0\nv 1 0 0\n");
        assert_eq!(decode(b"".to_vec()), "");
    }
}
