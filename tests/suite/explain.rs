//! Every page of `ogee explain`: the broken scene has its fault, the mended one has none.

use crate::run::{Folder, Run};
use ogee::diag::Code;

/// Codes whose fault cannot stand in a page: bytes that are no text.
const UNWRITABLE: &[Code] = &[Code::NotUtf8];

/// A fenced scene: "```ogee broken --set size=2", or "```ogee file other.scene" for a file beside it.
struct Example {
    /// "broken", "mended", "file".
    role: String,
    /// The rest of the fence's line.
    rest: String,
    text: String,
}

fn examples(page: &str) -> Vec<Example> {
    let fences = page.split("```ogee ").skip(1).filter_map(|after| after.split_once("```"));
    fences
        .filter_map(|(block, _)| block.split_once('\n'))
        .map(|(head, text)| {
            let (role, rest) = head.trim().split_once(' ').unwrap_or((head.trim(), ""));
            Example { role: role.to_owned(), rest: rest.to_owned(), text: text.to_owned() }
        })
        .collect()
}

/// Runs what finds this code: most are found by `check`, those of the camera's choice and of samples by `render` alone.
fn run(code: Code, example: &Example, all: &[Example]) -> Run {
    let folder = Folder::with(&[("scene.scene", &example.text)]);
    for file in all.iter().filter(|e| e.role == "file") {
        std::fs::write(folder.path().join(file.rest.trim()), &file.text).unwrap();
    }
    let is_render = matches!(
        code,
        Code::NoCamera
            | Code::UnknownCamera
            | Code::UndefinedSample
            | Code::BadPatch
            | Code::BadModel
            | Code::ModelRepaired
            | Code::NonFiniteSample
            | Code::BadMesh
            | Code::MeshRepaired
            | Code::MissingMaterialFile
            | Code::BadImage
            | Code::EmptySolid
    );
    let command = if is_render { "render --size 16x12 --samples 1" } else { "check --format short" };
    folder.ogee(&format!("{command} {} scene.scene", example.rest))
}

#[test]
fn every_code_has_a_page_with_a_broken_and_a_mended_scene() {
    let lacking = |code: &&Code| {
        let examples = examples(code.explanation());
        let has = |role| examples.iter().any(|e| e.role == role);
        !UNWRITABLE.contains(code) && !(has("broken") && has("mended"))
    };
    let without: Vec<&str> = Code::ALL.iter().filter(lacking).map(|code| code.text()).collect();
    assert!(without.is_empty(), "pages without examples: {without:?}");
}

#[test]
fn broken_scenes_have_the_fault_and_mended_ones_none() {
    let mut faults = String::new();
    for code in Code::ALL {
        let examples = examples(code.explanation());
        for example in &examples {
            let run = run(*code, example, &examples);
            let codes = run.codes();
            let is_right = match example.role.as_str() {
                "broken" => codes.iter().any(|c| c == code.text()),
                "mended" => codes.is_empty(),
                _ => true,
            };
            if !is_right {
                faults +=
                    &format!("{} {}: {codes:?}\n{}{}\n", code.text(), example.role, example.text, run.stderr);
            }
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

#[test]
fn explain_prints_the_page_and_lists_all_codes() {
    let folder = Folder::new();
    let page = folder.ogee("explain e0101").expect(0);
    assert!(page.out().starts_with("# E0101: a name is not defined\n"), "{}", page.out());
    let list = folder.ogee("explain").expect(0);
    assert_eq!(list.out().lines().count(), Code::ALL.len());
    let unknown = folder.ogee("explain E0109").expect(2);
    assert!(unknown.stderr.contains("there is no code `E0109`"), "{}", unknown.stderr);
}
