//! Small pictures, one reason each, bit for bit: `tests/golden/<topic>/<name>.scene` beside its parse and its `.png`, held by
//! the same command that users have. `ogee test tests/golden --bless` writes them anew.

use std::path::Path;
use std::process::Command;

fn ogee(arguments: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_ogee"))
        .args(arguments)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")))
        .output()
        .expect("the command runs")
}

#[test]
fn every_golden_scene_parses_and_looks_as_it_did() {
    let output = ogee(&["test", "tests/golden"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn every_example_checks_without_a_word() {
    let examples: Vec<_> = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples"))
        .expect("the examples")
        .filter_map(|entry| entry.ok()?.path().to_str().map(str::to_owned))
        .filter(|path| path.ends_with(".scene"))
        .collect();
    assert!(!examples.is_empty());
    let mut arguments = vec!["check"];
    arguments.extend(examples.iter().map(String::as_str));
    let output = ogee(&arguments);
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}
