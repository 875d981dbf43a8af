//! The two forms of a file: JSON text, or a .glb with the JSON and a chunk of bytes in it.

use gltf::Gltf;
use gltf::json::Root;

const MAGIC: &[u8] = b"glTF";
const JSON: &[u8] = b"JSON";
const BINARY: &[u8] = b"BIN\0";
/// Magic, version, length.
const HEADER: usize = 12;
/// Length, kind.
const CHUNK_HEADER: usize = 8;

/// What a file says, and the bytes that a .glb brings along.
pub(super) fn open(bytes: &[u8]) -> Result<(Root, Option<Vec<u8>>), String> {
    let (text, binary) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
    let text = text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(text);
    let read = Gltf::from_slice_without_validation(text);
    let root = read.map_err(|e| format!("its JSON cannot be read: {e}"))?.document.into_json();
    if !root.asset.version.starts_with("2.") {
        return Err(format!("it is of glTF {}, and only glTF 2 is read", root.asset.version));
    }
    Ok((root, binary.map(<[u8]>::to_vec)))
}

fn chunks(file: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let (version, length) = (word(file, 4)?, word(file, 8)? as usize);
    if version != 2 {
        return Err(format!("it is a .glb of version {version}, and only version 2 is read"));
    }
    if length > file.len() {
        return Err(format!("it ends after {} of {length} bytes", file.len()));
    }
    let (json, rest) = chunk(file.get(HEADER..length).unwrap_or_default())?;
    let Some((JSON, text)) = json else { return Err("it does not begin with JSON".into()) };
    let binary = chunk(rest)?.0.filter(|(kind, _)| *kind == BINARY);
    Ok((text, binary.map(|(_, bytes)| bytes)))
}

/// The kind of a chunk and its bytes.
type Chunk<'a> = (&'a [u8], &'a [u8]);

/// The first chunk and what follows it; none at the end.
fn chunk(bytes: &[u8]) -> Result<(Option<Chunk<'_>>, &[u8]), String> {
    if bytes.is_empty() {
        return Ok((None, bytes));
    }
    let length = word(bytes, 0)? as usize;
    let end = CHUNK_HEADER.saturating_add(length);
    match (bytes.get(4..CHUNK_HEADER), bytes.get(CHUNK_HEADER..end)) {
        (Some(kind), Some(content)) => Ok((Some((kind, content)), &bytes[end..])),
        _ => {
            Err(format!("a chunk of {length} bytes ends after {}", bytes.len().saturating_sub(CHUNK_HEADER)))
        }
    }
}

fn word(bytes: &[u8], at: usize) -> Result<u32, String> {
    let word = bytes.get(at..at + 4).and_then(|word| word.try_into().ok());
    word.map(u32::from_le_bytes).ok_or_else(|| "it ends in its header".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
        let chunk =
            |kind: &[u8], content: &[u8]| [&(content.len() as u32).to_le_bytes(), kind, content].concat();
        let chunks = [chunk(JSON, json.as_bytes()), chunk(BINARY, binary)].concat();
        let length = (HEADER + chunks.len()) as u32;
        [MAGIC, &2u32.to_le_bytes(), &length.to_le_bytes(), &chunks].concat()
    }

    const LEAST: &str = r#"{"asset":{"version":"2.0"}}"#;

    #[test]
    fn both_forms_give_the_same() {
        let (_, binary) = open(&glb(LEAST, &[1, 2, 3])).unwrap();
        assert_eq!(binary, Some(vec![1, 2, 3]));
        assert!(open(LEAST.as_bytes()).unwrap().1.is_none());
        assert!(open(format!("\u{FEFF}{LEAST}").as_bytes()).is_ok());
    }

    #[test]
    fn a_file_cut_anywhere_is_refused_and_never_panics() {
        let whole = glb(LEAST, &[1, 2, 3]);
        for end in 0..whole.len() {
            assert!(open(&whole[..end]).is_err(), "{end}");
        }
        for (at, value) in [(4, 1), (8, 5), (8, u32::MAX), (12, u32::MAX), (12, 3), (16, 0)] {
            let mut bytes = whole.clone();
            bytes[at..at + 4].copy_from_slice(&u32::to_le_bytes(value));
            assert!(open(&bytes).is_err(), "{at} {value}");
        }
    }
}
