//! What is said of faulty scenes, word for word: each `tests/errors/NAME.scene` against `NAME.txt` beside it, for the faults
//! that other renderers pass in silence and for the forms that diagnostics take. `OGEE_BLESS=1` writes the texts.

use crate::run::Folder;
use std::path::{Path, PathBuf};

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/errors");
    let entries = std::fs::read_dir(folder).unwrap().flatten().map(|e| e.path());
    let mut scenes: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "scene")).collect();
    scenes.sort();
    scenes
}

/// Renders a small picture of it; what is said of the picture itself, which holds times, is left out.
fn said(scene: &Path) -> String {
    let folder = Folder::new();
    let mut command = folder.command("render --size 16x12 --samples 1 -o");
    command.arg(folder.path().join("out.png")).arg(scene.file_name().unwrap());
    command.current_dir(scene.parent().unwrap());
    let output = command.output().unwrap();
    let code = output.status.code().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    let lines = stderr.lines().filter(|line| !line.contains("a pixel  "));
    format!("{}exit {code}\n", lines.map(|line| format!("{line}\n")).collect::<String>())
}

#[test]
fn faults_are_said_as_they_were_blessed() {
    let mut apart = String::new();
    for scene in scenes() {
        let (text, said) = (scene.with_extension("txt"), said(&scene));
        if std::env::var_os("OGEE_BLESS").is_some() {
            std::fs::write(&text, &said).unwrap();
        }
        let blessed = std::fs::read_to_string(&text).unwrap_or_default();
        if blessed != said {
            apart += &format!("--- {}\n{blessed}+++\n{said}\n", scene.display());
        }
    }
    assert!(apart.is_empty(), "{apart}");
}

#[test]
fn json_diagnostics_hold_byte_ranges_and_end_in_a_summary() {
    let folder = Folder::with(&[("a.scene", "// é\nsphere { radius raduis }\nlet b = nope\n")]);
    let run = folder.ogee("check --format json a.scene").expect(1);
    let lines: Vec<serde_json::Value> =
        run.out().lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect();
    let first = &lines[0];
    assert_eq!((first["schema"].as_u64(), first["code"].as_str()), (Some(1), Some("E0101")));
    assert_eq!(first["file"], "a.scene");
    let span = r#"{"start":22,"end":28,"line":2,"column":17,"end_line":2,"end_column":23}"#;
    assert_eq!(first["span"].to_string(), span);
    let summary = lines.last().unwrap();
    assert_eq!(summary["summary"]["errors"], 2, "both faults in one run");
    assert!(run.stderr.is_empty(), "{}", run.stderr);
}

#[test]
fn a_sound_scene_has_a_summary_too() {
    let folder = Folder::with(&[("a.scene", "sphere { radius 1 }\n")]);
    let run = folder.ogee("check --format json a.scene").expect(0);
    assert_eq!(run.out(), "{\"summary\":{\"errors\":0,\"warnings\":0}}\n");
    let run = folder.ogee("check a.scene").expect(0);
    assert_eq!((run.out(), run.stderr.as_str()), ("", ""));
}

#[test]
fn short_diagnostics_are_lines_that_editors_read() {
    let folder = Folder::with(&[("a.scene", "sphere { radius raduis }\n")]);
    let run = folder.ogee("check --format short a.scene").expect(1);
    let first = run.stderr.lines().next().unwrap();
    assert!(first.starts_with("a.scene:1:17: error[E0101]: "), "{first}");
    assert_eq!(run.stderr.lines().last(), Some("1 error"));
}

#[test]
fn a_fault_in_a_file_of_any_length_is_shown_at_once() {
    let flat = "sphere { center <1, 2, 3>  radius 0.5 }\n".repeat(20_000);
    let folder = Folder::with(&[("long.scene", &format!("{flat}sphere {{ radius nope }}\n"))]);
    let run = folder.ogee("check long.scene").expect(1);
    assert!(run.stderr.contains("long.scene:20001:17"), "{}", run.stderr);
}
