//! Small pictures, one reason each, bit for bit: `tests/golden/<topic>/<name>.scene` beside its `.png`.
//! `OGEE_BLESS=1` writes them anew. A failure leaves expected | difference | actual under `target/golden`.

use ogee::render::compare;
use std::path::{Path, PathBuf};

fn scenes() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut found = Vec::new();
    for topic in std::fs::read_dir(root).expect("the goldens") {
        for entry in std::fs::read_dir(topic.expect("a topic").path()).expect("a topic's scenes") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|e| e == "scene") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
