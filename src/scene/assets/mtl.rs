//! Materials of OBJ meshes (.mtl) as materials of scenes.
//!
//! tobj reads the statements; before it, each line is brought into the one form that tobj takes (a line it would refuse would
//! cost the whole file), and after it, map options are taken off the file names ([`maps`]) and the models of illumination
//! translated ([`translate`]).

mod maps;
mod translate;

use super::AssetCache;
use super::decode::decode;
use super::obj::UNKNOWN;
use crate::diag::{Code, Diagnostic, Span};
use crate::scene::Material;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The materials that a mesh's names mean.
pub(super) struct Found {
    pub materials: Vec<Arc<Material>>,
    /// Into `materials` for each name; [`UNKNOWN`] where no file says what it is.
    pub index_of_name: Vec<u16>,
    /// One, of all that is missing.
    pub warning: Option<Diagnostic>,
}

/// A material of a file, with the file's folder.
struct Entry {
    material: tobj::Material,
    folder: PathBuf,
}

/// Reads the libraries of a mesh and makes a material for each name that it uses.
pub(super) fn load(
    cache: &AssetCache<'_>,
    mesh: &Path,
    libraries: &[&str],
    names: &[&str],
    span: Span,
) -> Found {
    let mut missing = Vec::new();
    let entries = read_libraries(cache, mesh, libraries, &mut missing);
    let mut found = Found { materials: Vec::new(), index_of_name: Vec::new(), warning: None };
    for name in names {
        let entry = entries.iter().rfind(|e| e.material.name == *name);
        let entry = entry.or_else(|| entries.iter().rfind(|e| e.material.name.eq_ignore_ascii_case(name)));
        let index = match entry {
            Some(entry) if found.materials.len() < UNKNOWN as usize => {
                let mut maps = maps::Maps::new(cache, mesh, &entry.folder, &mut missing);
                found.materials.push(Arc::new(translate::material(&entry.material, &mut maps, span)));
                (found.materials.len() - 1) as u16
            }
            Some(_) => {
                push_once(&mut missing, format!("`{name}` is one material too many (65 535 are read)"));
                UNKNOWN
            }
            None => {
                push_once(&mut missing, format!("no material is called `{name}`"));
                UNKNOWN
            }
        };
        found.index_of_name.push(index);
    }
    found.warning = warning(mesh, &missing, span);
    found
}

fn push_once(missing: &mut Vec<String>, what: String) {
    if !missing.contains(&what) {
        missing.push(what);
    }
}

/// How many missing things a warning names before it counts the rest.
const NAMED: usize = 6;

fn warning(mesh: &Path, missing: &[String], span: Span) -> Option<Diagnostic> {
    if missing.is_empty() {
        return None;
    }
    let rest = missing.len().saturating_sub(NAMED);
    let mut list = missing[..missing.len() - rest].join("; ");
    if rest > 0 {
        list += &format!("; and {rest} more");
    }
    let message = format!("materials of the mesh `{}` are incomplete: {list}", mesh.display());
    Some(
        Diagnostic::new(Code::MissingMaterialFile, span, message).hint(
            "faces whose material is missing have the material of the object: give it one with `material`",
        ),
    )
}

fn read_libraries(
    cache: &AssetCache<'_>,
    mesh: &Path,
    libraries: &[&str],
    missing: &mut Vec<String>,
) -> Vec<Entry> {
    let folder = mesh.parent().unwrap_or(Path::new(""));
    let mut entries = Vec::new();
    for file in
        libraries.iter().flat_map(|line| library_names(line, |name| find(cache, &[folder], name).is_some()))
    {
        let Some(path) = find(cache, &[folder], &file) else {
            push_once(missing, format!("there is no `{file}`"));
            continue;
        };
        match cache.read(&path) {
            Err(why) => push_once(missing, format!("`{file}` cannot be read: {why}")),
            Ok(bytes) => {
                let folder = path.parent().unwrap_or(Path::new("")).to_owned();
                let materials = read_statements(&decode(bytes));
                entries
                    .extend(materials.into_iter().map(|material| Entry { material, folder: folder.clone() }));
            }
        }
    }
    entries
}

/// The files of a `mtllib` line: the whole rest of the line where there is such a file (names may hold blanks), else its
/// words, in which `\ ` is a blank.
fn library_names(line: &str, exists: impl Fn(&str) -> bool) -> Vec<String> {
    if line.is_empty() {
        return Vec::new();
    }
    let line = line.trim_matches('"');
    if exists(line) { vec![line.to_owned()] } else { words(line) }
}

/// Words divided by blanks; a backslash before a blank keeps it in its word.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut letters = line.chars().peekable();
    while let Some(c) = letters.next() {
        let last = words.last_mut().expect("there is always a word at hand");
        match c {
            '\\' if letters.peek() == Some(&' ') => last.extend(letters.next()),
            c if c.is_whitespace() => words.push(String::new()),
            c => last.push(c),
        }
    }
    words.retain(|w| !w.is_empty());
    words
}

/// The file that a name written on some machine means here: relative to one of the folders, with either slash, its folders
/// left out where they are those of another machine, or in another case.
fn find(cache: &AssetCache<'_>, folders: &[&Path], name: &str) -> Option<PathBuf> {
    let name = name.replace('\\', "/");
    let last = name.rsplit('/').next().unwrap_or(&name);
    let candidates = [name.as_str(), last];
    let exact = candidates
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
        .find(|path| cache.loader().exists(path));
    exact.or_else(|| {
        let mut paths =
            candidates.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
        paths.find_map(|path| in_other_case(cache, &path))
    })
}

fn in_other_case(cache: &AssetCache<'_>, path: &Path) -> Option<PathBuf> {
    let (folder, wanted) = (path.parent()?, path.file_name()?.to_str()?);
    let names = cache.loader().list(folder);
    let name = names.iter().find(|name| name.eq_ignore_ascii_case(wanted))?;
    Some(folder.join(name)).filter(|path| cache.loader().exists(path))
}

/// The materials of a file's text.
fn read_statements(text: &str) -> Vec<tobj::Material> {
    let plain: String = text.lines().filter_map(plain_statement).collect();
    tobj::load_mtl_buf(&mut plain.as_bytes()).map(|(materials, _)| materials).unwrap_or_default()
}

/// A statement in the form that tobj takes, with its line end; none for what says nothing.
fn plain_statement(line: &str) -> Option<String> {
    let line = line.trim();
    let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    if keyword.starts_with('#') || keyword.is_empty() || (rest.is_empty() && keyword != "newmtl") {
        return None;
    }
    let lower = keyword.to_ascii_lowercase();
    match lower.as_str() {
        "newmtl" => Some(format!("newmtl {}\n", if rest.is_empty() { "unnamed" } else { rest })),
        "ka" | "kd" | "ks" | "ke" | "tf" | "kt" => {
            let [r, g, b] = colour(rest)?;
            Some(format!("{}{} {r} {g} {b}\n", lower[..1].to_uppercase(), &lower[1..]))
        }
        "ns" | "ni" | "d" | "tr" | "pr" | "pm" => {
            let number = last_number(rest)?;
            let keyword = if lower == "d" { lower } else { lower[..1].to_uppercase() + &lower[1..] };
            Some(format!("{keyword} {number}\n"))
        }
        "illum" => Some(format!("illum {}\n", last_number(rest)?.clamp(0.0, 10.0) as u8)),
        "map_kd" => Some(format!("map_Kd {rest}\n")),
        "map_ks" => Some(format!("map_Ks {rest}\n")),
        "bump" | "map_bump" | "map_d" => Some(format!("{lower} {rest}\n")),
        "map_ns" | "map_ka" => None,
        _ => Some(format!("{lower} {rest}\n")),
    }
}

/// Three numbers, or one for a grey. None for spectral files, `xyz` and what is no number.
fn colour(rest: &str) -> Option<[f64; 3]> {
    let numbers = |rest: &str| {
        let finite = |w: &str| w.parse::<f64>().ok().filter(|x| x.is_finite());
        rest.split_whitespace().map_while(finite).take(3).collect::<Vec<f64>>()
    };
    match numbers(rest)[..] {
        [r, g, b] => Some([r, g, b]),
        [grey] | [grey, _] => Some([grey; 3]),
        _ => None,
    }
}

/// The number of a statement like `d 0.5` or `d -halo 0.5`; a comment may follow.
fn last_number(rest: &str) -> Option<f64> {
    let before_comment = rest.split('#').next().unwrap_or(rest);
    let words = before_comment.split_whitespace();
    words.filter_map(|w| w.parse::<f64>().ok()).rfind(|x| x.is_finite())
}

#[cfg(test)]
mod tests;
