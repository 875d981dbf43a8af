//! The tables and the reference against what the language does: every example evaluates, and `docs/reference.md` is what the
//! tables say. `OGEE_BLESS=1` writes the page anew.

use ogee::diag::{Diagnostic, Severity};
use ogee::lang::{builtins, kinds, members, reference};
use ogee::scene::assets::Loader;
use ogee::session::{Options, Session};
use std::path::Path;
use std::sync::Arc;

/// Every file is there and empty, but for models: examples name files of their reader's.
struct EveryFile;

impl Loader for EveryFile {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        Ok(model(path).unwrap_or_default())
    }

    fn exists(&self, _: &Path) -> bool {
        true
    }
}

fn errors_of(text: &str) -> Vec<Diagnostic> {
    let mut session = Session::new(Options::default(), Arc::new(EveryFile));
    let evaluated = session.evaluate_text("example.scene", text);
    evaluated.diagnostics.into_iter().filter(|d| d.severity == Severity::Error).collect()
}

#[test]
fn the_reference_on_disk_is_what_the_tables_say() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference.md");
    if std::env::var_os("OGEE_BLESS").is_some() {
        std::fs::write(&path, reference::whole()).expect("docs/ can be written");
    }
    let on_disk = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(on_disk == reference::whole(), "docs/reference.md is old: run `OGEE_BLESS=1 cargo test tables`");
}

#[test]
fn every_example_of_a_kind_evaluates() {
    for kind in kinds::ALL {
        let errors = errors_of(kind.example);
        assert!(errors.is_empty(), "{}: {errors:#?}", kind.name);
    }
}

#[test]
fn every_scene_of_the_reference_evaluates() {
    let whole = reference::whole();
    let scenes: Vec<&str> =
        whole.split("```ogee\n").skip(1).filter_map(|after| after.split("```").next()).collect();
    assert!(scenes.len() > kinds::ALL.len());
    for scene in scenes {
        let errors = errors_of(scene);
        assert!(errors.is_empty(), "{scene}\n{errors:#?}");
    }
}

#[test]
fn every_example_of_a_function_gives_what_it_says() {
    for builtin in builtins::all() {
        let (written, gives) = builtin.example;
        let mut session = Session::new(Options::default(), Arc::new(EveryFile));
        let (answer, diagnostics) = session.evaluate_expression(written, None);
        if gives.is_empty() {
            continue;
        }
        let found = answer.map(|a| a.text(None));
        assert_eq!(found.as_deref(), Some(gives), "{written}: {diagnostics:#?}");
    }
}

/// The example's model, where a path is one of a model.
fn model(path: &Path) -> Option<Vec<u8>> {
    let is_model = path.extension().is_some_and(|e| e == "gltf");
    is_model.then(|| include_bytes!("../../examples/models/reed.gltf").to_vec())
}

/// One scene, under any name but that of a model.
struct OneScene(&'static str);

impl Loader for OneScene {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        Ok(model(path).unwrap_or_else(|| self.0.as_bytes().to_vec()))
    }

    fn exists(&self, _: &Path) -> bool {
        true
    }
}

#[test]
fn every_example_of_a_member_gives_what_it_says() {
    for family in members::FAMILIES {
        for member in family.members {
            let (written, gives) = member.example;
            let mut session = Session::new(Options::default(), Arc::new(OneScene(family.scene)));
            let (answer, diagnostics) = session.evaluate_expression(written, Some(Path::new("a.scene")));
            let found = answer.map(|a| a.text(None));
            assert_eq!(found.as_deref(), Some(gives), "{written}: {diagnostics:#?}");
        }
    }
}

#[test]
fn what_other_renderers_pass_in_silence_is_said() {
    let codes = |text: &str| -> Vec<&str> { errors_of(text).iter().map(|d| d.code.text()).collect() };
    assert_eq!(codes("sphere { radius -1 }"), ["E0303"]);
    assert_eq!(codes("sphere { scale 0 }"), ["E0303"]);
    assert_eq!(codes("sphere { matrix 1, 0, 0,  0, 1, 0,  1, 1, 0,  0, 0, 0 }"), ["E0303"]);
    assert_eq!(codes("plane { normal <0, 0, 0> }"), ["E0303"]);
    assert_eq!(codes("box { min <1, 1, 1>  max <0, 0, 0> }"), ["E0604"]);
    assert_eq!(codes("cylinder { from <1, 1, 1>  to <1, 1, 1>  radius 1 }"), ["E0604"]);
    assert_eq!(codes("triangle { vertices <0, 0, 0>, <1, 1, 1>, <2, 2, 2> }"), ["E0604"]);
    assert_eq!(codes("sphere { center 1 }"), ["E0201"]);
    assert_eq!(codes("light { intensity 3 }"), ["E0302"]);
    assert_eq!(codes("light { point <0, 1, 0>  sky 0.2 }"), ["E0305"]);
    assert_eq!(codes("camera { eye <1, 1, 1>  look_at <1, 1, 1> }"), ["E0303"]);
}
