//! The language: scenes that assert what it means, faults with their codes, guards, imports, and functions that run while
//! rendering held against the evaluator.

use ogee::diag::Diagnostic;
use ogee::scene::assets::Loader;
use ogee::scene::{LightSource, Node, PatternKind, Rgb, SampledFunction, Sky, Texture};
use ogee::session::{Answer, Evaluated, Limits, Options, Session};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files in memory.
#[derive(Default)]
struct Shelf(HashMap<PathBuf, Vec<u8>>);

impl Shelf {
    fn of(files: &[(&str, &str)]) -> Arc<Shelf> {
        Arc::new(Shelf(files.iter().map(|(n, t)| (PathBuf::from(n), t.as_bytes().to_vec())).collect()))
    }
}

impl Loader for Shelf {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        self.0.get(path).cloned().ok_or_else(|| std::io::ErrorKind::NotFound.into())
    }

    fn exists(&self, path: &Path) -> bool {
        self.0.contains_key(path)
    }
}

fn session(files: &[(&str, &str)], options: Options) -> Session {
    Session::new(options, Shelf::of(files))
}

fn evaluate(text: &str) -> Evaluated {
    session(&[], Options::default()).evaluate_text("test.scene", text)
}

fn limited(text: &str, limits: Limits) -> Evaluated {
    session(&[], Options { limits, ..Options::default() }).evaluate_text("test.scene", text)
}

fn codes(diagnostics: &[Diagnostic]) -> Vec<&'static str> {
    diagnostics.iter().map(|d| d.code.text()).collect()
}

fn told(evaluated: &Evaluated) -> String {
    evaluated.diagnostics.iter().map(|d| format!("{} {}\n", d.code.text(), d.message)).collect()
}

fn value(expression: &str) -> Answer {
    let (answer, diagnostics) = Session::default().evaluate_expression(expression, None);
    answer.unwrap_or_else(|| panic!("{expression}: {diagnostics:?}"))
}

#[test]
fn scenes_of_the_language_hold_what_they_assert() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/language");
    let mut faults = String::new();
    let mut n_scenes = 0;
    for entry in std::fs::read_dir(folder).expect("the folder of scenes") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "scene") {
            n_scenes += 1;
            let mut session = Session::default();
            for d in session.evaluate_file(&path).diagnostics {
                let place = d.span.map(|s| session.sources.place(s)).unwrap_or_default();
                faults += &format!("{place} {} {}\n", d.code.text(), d.message);
            }
        }
    }
    assert!(faults.is_empty(), "{faults}");
    assert!(n_scenes >= 8);
}

/// A text and the codes that it must give, in source order, and no others.
const FAULTS: &[(&str, &[&str])] = &[
    ("let a = b", &["E0101"]),
    ("let a = b\nlet c = a + 1\nassert(c == 1)", &["E0101"]),
    ("let radius = 2\nsphere { radius raduis }", &["E0101"]),
    ("let a = 1\nlet a = 2", &["E0102"]),
    ("fn f(a, a) = a", &["E0102"]),
    ("let a = 1\na = 2", &["E0103"]),
    ("for i in 0..2 { i = 3 }", &["E0103"]),
    ("b = 2", &["E0101"]),
    ("let a = b\nlet b = 1", &["E0104"]),
    ("f()\nlet k = 1\nfn f() = [k]", &["E0104"]),
    ("let a = 1 + \"x\"", &["E0201"]),
    ("let a = [1] + [2]", &["E0201"]),
    ("let a = !3", &["E0201"]),
    ("if 1 { sphere {} }", &["E0201"]),
    ("for i in 3 { sphere {} }", &["E0201"]),
    ("for i in 0..2.5 { sphere {} }", &["E0201"]),
    ("let a = <1, 2> < <3, 4>", &["E0201"]),
    ("let a = <1, \"b\", 3>", &["E0201"]),
    ("fn f(a, b) = a\nlet c = f(1)\nlet d = f(1, 2, 3)\nlet e = f(1, bb: 2)", &["E0202", "E0202", "E0202"]),
    ("let f = a => a\nlet c = f(1, 2)\nlet d = f()", &["E0202", "E0202"]),
    ("let c = sin()\nlet d = sin(1, 2)\nlet e = sin(angel: 1)", &["E0202", "E0202", "E0202"]),
    ("let a = 3\nlet b = a(2)", &["E0203"]),
    ("let a = <1, 2>.z\nlet b = (3.5).x\nlet c = [1].len", &["E0204", "E0204", "E0204"]),
    ("let l = [1, 2]\nlet a = l[2]\nlet b = l[-3]\nlet c = l[0.5]\nlet d = [][0]", &["E0205"; 4]),
    ("let a = 1e300 * 1e300\nlet b = inf - inf", &["E0206", "E0206"]),
    ("var s = <1, 2, 3>\ns = s / <1, 0, 1>\ns = s + 1", &["E0207"]),
    ("var s = <1, 2, 3> * 1e200\ns = s * s", &["E0206"]),
    ("var s = <1, 2, 3>\ns = s + \"x\"\nvar t = <1, 2, 3>\nt = t + none", &["E0201", "E0101"]),
    ("let a = 1 / 0\nlet b = <1, 2> / <1, 0>\nlet c = 5 % 0\nlet d = 0 ^ -1", &["E0207"; 4]),
    ("let a = sqrt(-1)\nlet b = ln(0)\nlet c = (-8) ^ 0.5\nlet d = 0..1 step 0", &["E0208"; 4]),
    ("sphere { radios 2 }", &["E0301"]),
    ("if false { sphere { radios 2 } }", &["E0301"]),
    ("fn never() { sphere { raidus 2 } }", &["E0301"]),
    ("radius 3", &["E0301"]),
    ("sphere { material clay { diffuse 1 } }", &["E0306"]),
    ("let a = 3\na\nsin", &["E0307", "E0307"]),
    ("fn f() { radius 2 }\nf()", &["E0307"]),
    ("material { diffuse 1 }", &["E0307"]),
    ("group { camera { eye x  look_at y } }", &["E0307"]),
    ("fn f(a) = a\nf", &["E0307"]),
    ("material m { lobe pong }", &["E0309"]),
    ("assert(1 > 2, \"no\")", &["E0401"]),
    ("for i in 0..1000 { assert(i < 0) }", &["E0401"]),
    ("error(\"stop\")", &["E0402"]),
    ("return 3", &["E0408"]),
    ("fn f() { group { return 3 } }", &["E0408"]),
    ("sphere { material { diffuse p => \"red\" } }", &["E0410"]),
    ("import \"none.scene\"\nlet a = from_there\nsphere { radius unknown }", &["E0501"]),
    ("import \"none.scene\" as t\nlet a = t.b\nt.c()", &["E0501"]),
    ("render {}\nrender {}", &["E0304"]),
];

#[test]
fn each_fault_is_told_once_and_draws_no_others() {
    let mut wrong = String::new();
    for (text, expected) in FAULTS {
        let evaluated = evaluate(text);
        let found = codes(&evaluated.diagnostics);
        if found != *expected {
            wrong += &format!("{text}\n  expected {expected:?}, found:\n{}\n", told(&evaluated));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn every_independent_fault_of_a_file_is_told_in_one_run() {
    let text = "let a = b\nsphere { radios 1 }\nsphere { center c }\nlet d = 1 / 0\nfor i in 0..3 { sphere { radius e } }\n\
                fn f() { g() }\nf()\nassert(1 == 2)\nsphere { radius a }\nsphere { radius d + 1 }";
    let found = codes(&evaluate(text).diagnostics);
    assert_eq!(found, ["E0101", "E0301", "E0101", "E0207", "E0101", "E0101", "E0401"]);
}

#[test]
fn what_a_failed_value_reaches_stays_silent() {
    let text = "let a = none\nlet b = a * 2\nlet c = [b]\nfn f() = c[0].x\nsphere { radius f()  center <a, b, 0> }\n\
                mesh { file a }\na\nassert(a == b)\n\"{a}\" == \"x\" ? a : b\nfor i in a { error(\"no\") }";
    assert_eq!(codes(&evaluate(text).diagnostics), ["E0101"]);
}

#[test]
fn hints_name_what_was_meant() {
    let hint = |text: &str| {
        let found = evaluate(text).diagnostics;
        found.first().map(|d| d.hints.join(" ")).unwrap_or_default()
    };
    assert!(hint("let length_of = 2\nlet b = lenght_of").contains("length_of"));
    assert!(hint("let s = sqt(2)").contains("sqrt"));
    assert!(hint("sphere { radios 2 }").contains("radius"));
    assert!(hint("fn f(width) = width\nlet a = f(widht: 2)").contains("width"));
    assert!(hint("sphere { material clay { diffuse 1 } }").contains("material clay with"));
    assert!(hint("sphere { radius = 2 }").contains("without `=`"));
    assert!(hint("let l = [1]\nlet n = l.length").contains("len(list)"));
}

#[test]
fn a_trace_names_the_calls_with_their_arguments_innermost_first() {
    let text = "fn leaf(size) = sqrt(size)\nfn branch(length, depth) = depth == 0 ? leaf(-length) : branch(length / 2, depth - 1)\n\
                let a = branch(8, 2)";
    let found = evaluate(text).diagnostics;
    let frames: Vec<&str> = found[0].trace.iter().map(|f| f.text.as_str()).collect();
    assert_eq!(
        frames,
        [
            "`leaf(size: -2)`",
            "`branch(length: 2, depth: 0)`",
            "`branch(length: 4, depth: 1)`",
            "`branch(length: 8, depth: 2)`"
        ]
    );
}

#[test]
fn a_long_trace_shows_both_its_ends() {
    let found = evaluate("fn f(n) = n == 0 ? 1 / 0 : f(n - 1)\nlet a = f(1000)").diagnostics;
    let trace = &found[0].trace;
    assert_eq!(trace.len(), 11);
    assert_eq!(trace[0].text, "`f(n: 0)`");
    assert_eq!(trace[5].text, "… 991 more calls");
    assert_eq!(trace[10].text, "`f(n: 1000)`");
}

#[test]
fn endless_recursion_is_an_error_and_deep_recursion_is_not() {
    assert_eq!(value("[1]"), Answer::List(vec![Answer::Number(1.0)]));
    let found = evaluate("fn f(n) = f(n + 1)\nlet a = f(0)").diagnostics;
    assert_eq!(codes(&found), ["E0403"]);
    assert!(found[0].hints.iter().any(|h| h.contains("--limit calls=")), "{:?}", found[0].hints);
    let nested = "fn f(n) { if n > 0 { for i in 0..1 { group { f(n - 1) } } } else { sphere {} } }\nf(400)";
    assert_eq!(told(&evaluate(nested)), "");
    let deep = "fn f(n) { if n > 0 { if true { return [f(n - 1)] } }  return [] }\nlet a = f(9900)";
    assert_eq!(told(&evaluate(deep)), "");
}

#[test]
fn a_text_that_grows_too_long_is_not_said_to_be_a_list() {
    let limits = Limits { list: 1000, ..Limits::default() };
    let found = limited("var s = \"ab\"\nwhile true { s = \"{s}{s}\" }\n", limits).diagnostics;
    assert_eq!(codes(&found), ["E0405"]);
    assert!(found[0].message.starts_with("a text grows to about "), "{}", found[0].message);
    let found = limited("let l = [i for i in 0..2000]\n", limits).diagnostics;
    assert!(found[0].message.starts_with("a list grows to "), "{}", found[0].message);
}

/// On the way back from the deepest call, the other branches are not gone down again: that took all turns of the guard.
#[test]
fn endless_recursion_with_two_branches_is_told_at_once() {
    for text in ["fn f(n) = f(n + 1) + f(n + 2)\nlet a = f(0)", "fn f(n) { f(n + 1)  f(n + 2) }\nf(0)"] {
        let limits = Limits { turns: 50_000, ..Limits::default() };
        assert_eq!(codes(&limited(text, limits).diagnostics), ["E0403"], "{text}");
    }
    let again = "fn f(n) = f(n)\nfn g(n) = n\nlet a = f(0)\nassert(g(2) == 3)";
    assert_eq!(codes(&evaluate(again).diagnostics), ["E0403", "E0401"]);
}

#[test]
fn groups_inside_groups_end_before_the_stack_does() {
    let text = "var g = sphere {}\nfor i in 0..5000 { let h = g  g = group { h } }\ng";
    assert_eq!(codes(&evaluate(text).diagnostics), ["E0003"]);
}

/// Some levels of a block, each with what the last one made placed three times.
fn levels(kind: &str, levels: u32) -> String {
    format!("var g = sphere {{}}\nfor i in 0..{levels} {{ let h = g  g = {kind} {{ h; h; h }} }}\n")
}

#[test]
fn placements_of_placements_are_counted_and_not_expanded() {
    assert_eq!(codes(&evaluate(&(levels("group", 40) + "g")).diagnostics), ["E0411"]);
    let endless = levels("group", 1000) + "g";
    assert_eq!(codes(&evaluate(&endless).diagnostics), ["E0411"]);
    assert_eq!(told(&evaluate(&(levels("group", 20) + "g"))), "");
    let few = Limits { placements: 81, ..Limits::default() };
    assert_eq!(told(&limited(&(levels("group", 4) + "g"), few)), "");
    assert_eq!(codes(&limited(&(levels("group", 5) + "g"), few).diagnostics), ["E0411"]);
    let whole = "let g = group { sphere {}  sphere {} }\nlet l = [g, g, g, g, g]\ngroup { l;  sphere {} }";
    assert_eq!(told(&limited(whole, Limits { placements: 11, ..few })), "");
    assert_eq!(codes(&limited(whole, Limits { placements: 10, ..few }).diagnostics), ["E0411"]);
}

#[test]
fn solids_of_solids_are_refused_before_they_fill_the_memory() {
    for kind in ["union", "intersection"] {
        assert_eq!(codes(&evaluate(&(levels(kind, 20) + "g")).diagnostics), ["E0406"], "{kind}");
    }
    let text = levels("group", 20) + "union { g }";
    assert_eq!(codes(&evaluate(&text).diagnostics), ["E0406"]);
}

#[test]
fn a_ray_that_meets_placements_without_end_is_an_error() {
    let text = levels("group", 20) + "let hits = trace(g, <0, 0, 5>, -z)";
    let limits = Limits { list: 10_000, ..Limits::default() };
    assert_eq!(codes(&limited(&text, limits).diagnostics), ["E0405"]);
    let limits = Limits { memory: 10 << 20, ..Limits::default() };
    assert_eq!(codes(&limited(&text, limits).diagnostics), ["E0406"]);
    let few = levels("group", 4) + "assert(len(trace(g, <0, 0, 5>, -z)) == 162)";
    assert_eq!(told(&evaluate(&few)), "");
}

#[test]
fn a_plane_lies_at_its_offset_whatever_the_length_of_its_normal() {
    for plane in ["offset 1", "through y", "through <7, 1, -9>"] {
        let text = format!("assert(trace(plane {{ normal <0, 2, 0>  {plane} }}, <3, 5, 4>, -y)[0].t == 4)");
        assert_eq!(told(&evaluate(&text)), "", "{plane}");
    }
}

#[test]
fn a_raised_guard_of_calls_gets_a_stack_that_holds_them() {
    let limits = Limits { calls: 200_000, ..Limits::default() };
    let text = "fn f(n) = n == 0 ? 0 : 1 + f(n - 1)\nassert(f(150000) == 150000)";
    assert_eq!(told(&limited(text, limits)), "");
    let endless = Limits { calls: usize::MAX, ..Limits::default() };
    assert_eq!(
        codes(&limited("fn f(n) = f(n + 1)\nf(0)", Limits { turns: 1000, ..endless }).diagnostics),
        ["E0404"]
    );
}

#[test]
fn each_guard_names_itself_and_its_flag() {
    let limits =
        Limits { turns: 1000, list: 100, memory: 100_000, nesting: 20, placements: 50, ..Limits::default() };
    let cases = [
        ("while true {}", "E0404", "turns"),
        ("for i in 0..100000 {}", "E0404", "turns"),
        ("fn f(n) = n < 2 ? 1 : f(n - 1) + f(n - 2)\nlet a = f(40)", "E0404", "turns"),
        ("let a = [sum(0..90) for i in 0..50]", "E0404", "turns"),
        (
            "let l = [i for i in 0..90]\nlet m = [i for i in 0..90]\nlet a = [l == m for i in 0..50]",
            "E0404",
            "turns",
        ),
        ("let l = [i for i in 0..500]", "E0405", "list"),
        ("var l = [1]\nfor i in 0..60 { l = [l, l] }\nlet s = str(l)", "E0405", "list"),
        ("var l = [1]\nfor i in 0..60 { l = [l, l] }\nlet s = \"{l}\"", "E0405", "list"),
        ("var l = [1]\nfor i in 0..60 { l = [l, l] }\nprint(l)", "E0405", "list"),
        ("let l = linspace(0, 1, 500)", "E0405", "list"),
        ("for i in 0..900 { sphere {} }", "E0406", "memory"),
        ("group { for i in 0..60 { sphere {} } }", "E0411", "placements"),
    ];
    for (text, code, name) in cases {
        let found = limited(text, limits).diagnostics;
        assert_eq!(codes(&found), [code], "{text}");
        assert!(
            found[0].hints.iter().any(|h| h.contains(&format!("--limit {name}="))),
            "{text}: {:?}",
            found[0]
        );
    }
}

#[test]
fn nested_lists_of_any_depth_are_dropped_compared_and_shown() {
    let text = "var l = []\nvar m = []\nfor i in 0..300000 { l = [l]  m = [m] }\nassert(l == m)\nprint(l)\n\
                var f = 0\nfor i in 0..100000 { let g = f  f = () => g }";
    assert_eq!(told(&evaluate(text)), "");
}

#[test]
fn lists_that_share_their_parts_are_compared_once() {
    let text = "var l = [1]\nvar m = [1]\nvar n = [2]\nfor i in 0..60 { l = [l, l]  m = [m, m]  n = [n, n] }\n\
                assert(l == m)\nassert(l != n)";
    assert_eq!(told(&evaluate(text)), "");
}

#[test]
fn patterns_inside_patterns_end_before_the_stack_does() {
    let nested = |n: usize, by: &str| {
        evaluate(&format!(
            "var p = checker(0, 1)\nfor i in 0..{n} {{ p = {by} }}\nsphere {{ material {{ diffuse p }} }}"
        ))
    };
    assert_eq!(codes(&nested(5000, "checker(p, 0)").diagnostics), ["E0003"]);
    assert_eq!(codes(&nested(60, "gradient(p, p)").diagnostics), ["E0003"]);
    assert_eq!(told(&nested(900, "checker(p, 0)")), "");
}

#[test]
fn settings_replace_top_level_lets_and_unknown_ones_are_told() {
    let set = |pairs: &[(&str, &str)]| Options {
        set: pairs.iter().map(|(n, e)| (n.to_string(), e.to_string())).collect(),
        ..Options::default()
    };
    let text = "let base = 2\nlet count = base + 1\nprint(count)\nif true { let count = 9  print(count) }";
    let run = |pairs| session(&[], set(pairs)).evaluate_text("a.scene", text);
    assert_eq!(run(&[]).printed, ["3", "9"]);
    assert_eq!(run(&[("count", "base * 10")]).printed, ["20", "9"]);
    let unknown = run(&[("cuont", "1")]);
    assert_eq!(codes(&unknown.diagnostics), ["E0606"]);
    assert!(unknown.diagnostics[0].hints[0].contains("count"));
}

#[test]
fn time_and_frame_are_those_of_the_options() {
    let options = Options { time: 0.25, frame: 12, ..Options::default() };
    assert_eq!(session(&[], options).evaluate_text("a", "print(time, frame)").printed, ["0.25 12"]);
}

#[test]
fn imports_are_relative_to_the_file_that_writes_them_and_run_once() {
    let files = [
        (
            "scenes/main.scene",
            "import \"parts/a.scene\"\nimport \"parts/b.scene\" as b\nprint(one, b.two)\nb.ball",
        ),
        ("scenes/parts/a.scene", "import \"c.scene\"\nimport \"../parts/c.scene\"\nlet one = base + 1"),
        (
            "scenes/parts/b.scene",
            "import \"c.scene\"\nlet two = base + 2\nlet ball = sphere {}\ncamera { eye z  look_at <0, 0, 0> }",
        ),
        ("scenes/parts/c.scene", "let base = 10\nprint(\"c\")"),
    ];
    let evaluated = session(&files, Options::default()).evaluate_file(Path::new("scenes/main.scene"));
    assert_eq!(codes(&evaluated.diagnostics), ["W0409"], "{}", told(&evaluated));
    assert_eq!(evaluated.printed, ["c", "c", "11 12"]);
    assert_eq!(evaluated.scene.nodes.len(), 1);
    assert!(evaluated.scene.cameras.is_empty());
}

#[test]
fn imports_inside_braces_are_seen_there_alone() {
    let files = [
        (
            "a.scene",
            "fn f() { import \"b.scene\"  return base }\nfn g() { import \"b.scene\"  return base * 2 }\n\
                     let h = group { import \"b.scene\"  sphere { radius base } }\nprint(f(), g())\nh\nlet k = base",
        ),
        ("b.scene", "let base = 10"),
    ];
    let evaluated = session(&files, Options::default()).evaluate_file(Path::new("a.scene"));
    assert_eq!(codes(&evaluated.diagnostics), ["E0101"], "{}", told(&evaluated));
    assert_eq!(evaluated.printed, ["10 20"]);
}

#[test]
fn a_circle_of_imports_is_shown() {
    let files = [
        ("a.scene", "import \"b.scene\"\nsphere {}"),
        ("b.scene", "import \"c.scene\" as c\nlet b = 1"),
        ("c.scene", "import \"a.scene\"\nlet c = 1"),
    ];
    let evaluated = session(&files, Options::default()).evaluate_file(Path::new("a.scene"));
    assert_eq!(codes(&evaluated.diagnostics), ["E0407"]);
    assert!(evaluated.diagnostics[0].message.contains("a.scene → b.scene → c.scene → a.scene"));
}

#[test]
fn faults_inside_imports_tell_who_imported_them() {
    let files =
        [("a.scene", "import \"b.scene\" as b\nb.f(0)"), ("b.scene", "fn f(n) = [1 / n]\nlet broken = none")];
    let mut session = session(&files, Options::default());
    let found = session.evaluate_file(Path::new("a.scene")).diagnostics;
    assert_eq!(codes(&found), ["E0207", "E0101"]);
    assert_eq!(session.sources.place(found[0].trace[0].span), "a.scene:2:1");
    assert_eq!(found[1].trace[0].text, "imported here");
    assert_eq!(session.sources.place(found[1].trace[0].span), "a.scene:1:8");
}

#[test]
fn bytes_that_are_no_text_and_files_too_large_are_refused() {
    let mut shelf = Shelf::default();
    shelf.0.insert("latin.scene".into(), b"let a = 1 // \xe9\n".to_vec());
    let mut session = Session::new(Options::default(), Arc::new(shelf));
    assert_eq!(codes(&session.evaluate_file(Path::new("latin.scene")).diagnostics), ["E0010"]);
    let mut small = session_with_limit(4);
    assert_eq!(codes(&small.evaluate_file(Path::new("a.scene")).diagnostics), ["E0009"]);
}

fn session_with_limit(file: u64) -> Session {
    let limits = Limits { file, ..Limits::default() };
    session(&[("a.scene", "sphere {}")], Options { limits, ..Options::default() })
}

#[test]
fn words_win_where_only_words_are_taken_and_names_elsewhere() {
    let text = "let phong = 3\nlet lobe_word = 2\nmaterial m { lobe phong  exponent phong  specular 0.1 }\nsphere { material m }\n\
                fn words() { lobe blinn }\nmaterial n { words() }\nrender { tracer raycast  size 8, 8 }";
    assert_eq!(told(&evaluate(text)), "");
}

#[test]
fn a_copy_of_a_sky_keeps_its_picture_though_its_path_was_joined_already() {
    let text =
        "let a = light { sky \"sky.hdr\"  radiance 2 }\na with { radiance 3  rotate y * 90 }\nsphere { }";
    let files = [("scenes/test.scene", text), ("scenes/sky.hdr", "")];
    let evaluated = session(&files, Options::default()).evaluate_text("scenes/test.scene", text);
    assert_eq!(told(&evaluated), "");
    let Some(Node::Light(light)) = evaluated.scene.nodes.first() else { panic!("a light") };
    let LightSource::Sky(Sky::Image { path, factor, .. }) = &light.source else { panic!("a picture") };
    assert_eq!((path.as_path(), *factor), (std::path::Path::new("scenes/sky.hdr"), Rgb::splat(3.0)));
    assert!(light.transform.is_some());
}

/// The function of the first object's diffuse texture.
fn compiled(definitions: &str, function: &str) -> Arc<SampledFunction> {
    let text = format!("{definitions}\nsphere {{ material {{ diffuse {function} }} }}");
    let evaluated = evaluate(&text);
    assert_eq!(told(&evaluated), "", "{text}");
    let Some(Node::Object(object)) = evaluated.scene.nodes.first() else { panic!("an object") };
    let material = object.material.as_ref().expect("a material");
    let Texture::Pattern(pattern) = &material.diffuse else { panic!("a pattern") };
    let PatternKind::Function(function) = &pattern.kind else { panic!("a function") };
    function.clone()
}

/// Definitions, and a function of a point: the tape must give the evaluator's bits.
const FUNCTIONS: &[(&str, &str)] = &[
    ("", "p => p.x + 2 * p.y - p.z / 3"),
    ("", "p => p * 2 + <1, 0, 1>"),
    ("", "p => abs(sin(p.x * 3)) + cos(p.y) ^ 2 + exp(-p.z ^ 4)"),
    ("", "p => p.x ^ 3 + p.y ^ 7 + abs(p.z) ^ 0.5 + (p.x + 9) ^ -2"),
    ("", "p => p.x < 0.2 ? red : p.y >= p.z ? <0.1, 0.2, 0.3> : p"),
    ("", "p => p.x > 0 && p.y / p.x > 1 || !(p.z < 0) ? 1 : 0"),
    ("", "p => mix(white, red, clamp(p.x, 0, 1)) * smoothstep(-1, 1, p.y)"),
    ("", "p => min(p.x, p.y, p.z) + max(p.x, 0.25) + mod(p.y, 0.3) + p.z % 0.3"),
    ("", "p => length(p) + dot(p, y) + distance(p, <1, 2, 3>) + noise(p * 2) + fbm(p, 4)"),
    ("", "p => normalize(p + <3, 4, 5>).zyx"),
    ("", "p => hsv(abs(p.x), 0.5, 1) * luminance(p * p)"),
    ("let k = 3\nvar v = 1\nv = 5", "p => p.x * k + v"),
    ("fn wave(t, f = 2) = sin(t * f)", "p => wave(p.x) + wave(p.y, f: 3)"),
    ("fn sums(p, n) = n == 0 ? 0 : noise(p) / 2 + sums(p * 2, n - 1) / 2", "p => sums(p, 4)"),
    ("let palette = [0.1, 0.7, 0.4]", "p => palette[floor(abs(p.x) * 2) % 3]"),
    ("let palette = [red, green, <0.2, 0.3, 0.4>]", "p => palette[floor(abs(p.x) * 2) % 3]"),
    ("", "p => [p.x, p.y, p.z][floor(abs(p.y) * 2) % 3]"),
    ("", "p => sum([p.x * i for i in 0..4])"),
    ("", "p => fold([p.x, p.y, p.z], 0, (a, b) => a * 0.5 + b)"),
    ("", "p => sum(map([1, 2, 3], i => sin(p.x * i)))"),
    ("fn f(p) { var s = 0  for i in 0..40 { s = s + sin(p.x * i) / (i + 1) }  return s }", "f"),
    (
        "fn f(p) {\n var a = p.x\n var n = 0\n while n < 30 && a * a < 4 { a = a * a + p.y\n n = n + 1 }\n return <a, n, 0> / 100 }",
        "f",
    ),
    (
        "fn f(p) { if p.x > 0.5 { return red } else if p.x < -0.5 { let q = p * 2  return q }  return white * p.y }",
        "f",
    ),
    (
        "fn f(p) { var s = 0  for i in 0..5 { if p.x * i > 1 { s = s + i } else { s = s - p.y } }  return s }",
        "f",
    ),
    (
        "fn f(p) { var s = 0  for i in 0..50 { var t = p.x  if i > 10 { t = t + 1 }  t = t * 2  s = s + t  if s > 60 { return s } }  return -s }",
        "f",
    ),
    ("fn f(p) { let scale = 2  fn inner(t) = t * scale + p.y  return inner(p.x) }", "f"),
    ("let made = [c => q => q.x * c, c => q => q.y + c]", "made[1](0.5)"),
    (
        "spline s { natural red, green, blue, white  closed }",
        "p => s(mod(p.x, 1)) + s(0.5) * s.piece(1).domain[0]",
    ),
    (
        "spline s { natural x, y, z, x + y }",
        "p => s.velocity(abs(sin(p.x))) + s.tangent(0.3) * s.curvature(clamp(p.y)) + s.binormal(0.4)",
    ),
    (
        "spline s { bspline <0, 0>, <1, 2>, <2, -1>, <3, 0> }",
        "p => s.closest(p.xy).distance + s.closest(p.xy).point.x",
    ),
    (
        "let s = curve(t => <sin(3 * t), t>, -2, 2)",
        "p => s(clamp(p.x, -2, 2)).x + s.at_length(abs(p.y)).y + s.parameter_at(1) + s.length",
    ),
    (
        "spline s { bezier 1, 4, 2, 3 }\nfn f(t, c = s) = c(t)",
        "p => f(abs(sin(p.x))) + s.reverse(clamp(p.y))",
    ),
];

#[test]
fn compiled_functions_give_the_bits_of_the_evaluator() {
    for (definitions, function) in FUNCTIONS {
        let tape = compiled(definitions, function);
        for p in [[0.3, 0.6, -0.2], [-0.7, 0.4, 0.9], [1.5, -2.25, 0.125], [-0.1, -0.2, 0.3]] {
            let mut out = [0.0; 3];
            let n = tape.field.n_outputs();
            tape.field.eval(&p, &mut out[..n]).unwrap_or_else(|f| panic!("{function} at {p:?}: {f:?}"));
            let [x, y, z] = p;
            let text = format!(
                "{definitions}\nlet the_function = {function}\nlet result = the_function(<{x}, {y}, {z}>)"
            );
            let mut session = session(&[("a.scene", &text)], Options::default());
            let (answer, found) = session.evaluate_expression("result", Some(Path::new("a.scene")));
            let expected = match answer {
                Some(Answer::Number(x)) => vec![x],
                Some(Answer::Vector(v)) => v,
                other => panic!("{function} at {p:?}: {other:?} {found:?}"),
            };
            assert_eq!(out[..n], expected[..], "{definitions}\n{function} at {p:?}");
        }
    }
}

#[test]
fn a_fault_of_a_tape_names_its_expression() {
    let tape = compiled("", "p => 1 + 2 / p.x");
    let fault = tape.field.eval(&[0.0, 1.0, 1.0], &mut [0.0]).expect_err("a division by 0");
    let place = tape.place(fault);
    assert_eq!(place.end - place.start, "2 / p.x".len() as u32);
    let tape = compiled("", "p => p.x > 0 ? sqrt(-1) : 2");
    assert!(tape.field.eval(&[1.0, 0.0, 0.0], &mut [0.0]).is_err());
    assert!(tape.field.eval(&[-1.0, 0.0, 0.0], &mut [0.0]).is_ok(), "an undefined branch that is not taken");
}

#[test]
fn a_curve_outside_its_domain_is_undefined_at_that_sample() {
    for function in ["p => s(p.x)", "p => s.at_length(100 * p.x)", "p => p.y > 0 ? s(0.5) : s(2)"] {
        let tape = compiled("spline s { bezier x, y, z, white }", function);
        let mut out = [0.0; 3];
        assert!(tape.field.eval(&[0.01, 1.0, 0.0], &mut out).is_ok(), "{function}");
        let fault = tape.field.eval(&[1.5, -1.0, 0.0], &mut out).expect_err("outside");
        assert!(tape.place(fault).end > tape.place(fault).start);
    }
    let wrong = [
        ("p => s(p)", "E0201"),
        ("p => s(u: p.x)", "E0202"),
        ("p => s.wiggle(p.x)", "E0204"),
        ("p => s.to(p.x)", "E0410"),
    ];
    for (function, code) in wrong {
        let text =
            format!("spline s {{ bezier x, y, z, white }}\nsphere {{ material {{ diffuse {function} }} }}");
        assert_eq!(codes(&evaluate(&text).diagnostics), [code], "{function}");
    }
}

#[test]
fn functions_that_cannot_run_while_rendering_say_why_and_where() {
    let cases = [
        ("p => print(p)", "print(p)"),
        ("p => <p.x, 1>", "<p.x, 1>"),
        ("p => \"{p}\"", "\"{p}\""),
        ("p => [1, \"a\"][floor(p.x)]", "floor(p.x)"),
        ("p => len(sort([p.x, p.y]))", "sort([p.x, p.y])"),
    ];
    for (function, place) in cases {
        let text = format!("sphere {{ material {{ diffuse {function} }} }}");
        let found = evaluate(&text).diagnostics;
        assert_eq!(codes(&found), ["E0410"], "{function}");
        let span = found[0].span.expect("a place");
        assert_eq!(&text[span.start as usize..span.end as usize], place);
    }
}
