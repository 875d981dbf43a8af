//! The directions of dependency that the head of `src/lib.rs` promises, held against every `crate::` of the tree.

use std::path::{Path, PathBuf};

/// A module of the tree and those it may use.
const MAY_USE: &[(&str, &[&str])] = &[
    ("diag", &[]),
    ("math", &[]),
    ("syntax", &["diag"]),
    ("geometry", &["math"]),
    ("scene", &["geometry", "math", "diag"]),
    ("lang", &["scene", "geometry", "math", "syntax", "diag"]),
    ("world", &["scene", "geometry", "math", "diag"]),
    ("render", &["world", "scene", "math", "diag"]),
    ("plot", &["math"]),
    ("report", &["plot", "render", "world", "scene", "geometry", "math", "diag"]),
    ("session", &["plot", "render", "world", "lang", "scene", "geometry", "math", "syntax", "diag"]),
];

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder of the tree") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// The modules named after `crate::`, also inside `crate::{…}`, outside comments.
fn used_modules(text: &str) -> Vec<String> {
    let code: String =
        text.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let first_word =
        |s: &str| s.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    let mut modules = Vec::new();
    for after in code.split("crate::").skip(1) {
        match after.strip_prefix('{') {
            None => modules.push(first_word(after)),
            Some(group) => {
                let (mut depth, mut start) = (0, 0);
                for (i, c) in group.char_indices() {
                    match c {
                        '{' => depth += 1,
                        '}' if depth == 0 => {
                            modules.push(first_word(&group[start..]));
                            break;
                        }
                        '}' => depth -= 1,
                        ',' if depth == 0 => {
                            modules.push(first_word(&group[start..]));
                            start = i + 1;
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    modules
}

#[test]
fn no_module_uses_one_above_it() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut faults = Vec::new();
    for (module, allowed) in MAY_USE {
        let root = src.join(module);
        let files = if root.is_dir() { rust_files(&root) } else { vec![root.with_extension("rs")] };
        for file in files {
            for used in used_modules(&std::fs::read_to_string(&file).expect("readable source")) {
                let known = MAY_USE.iter().any(|(m, _)| *m == used);
                if known && used != *module && !allowed.contains(&used.as_str()) {
                    faults.push(format!("{} uses {used}", file.display()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn groups_of_imports_are_read_too() {
    assert_eq!(
        used_modules("use crate::{a::{b, c}, world::X};\nuse crate::lang::Y;"),
        ["a", "world", "lang"]
    );
}
