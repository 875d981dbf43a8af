//! Faults planted in sound scenes: every one is said, at its line, and nothing else is.

use ogee::diag::{SourceId, SourceMap};
use ogee::syntax::build::{ParseLimits, parse_file};
use proptest::prelude::*;

/// Items without fault.
const SOUND: &[&str] = &[
    "sphere { center <0, 1, 0>  radius 1  material clay }",
    "material clay { diffuse <0.8, 0.4, 0.3>  specular 0.2 }",
    "let size = 2 * (3 + 4)",
    "fn tree(n) {\n  cone { from 0  to y }\n  if n > 0 { tree(n - 1) } else { leaf }\n}",
    "for i in 0..12 {\n  sphere {\n    radius 0.15\n    rotate y * 30 * i\n  }\n}",
    "tree(5) with { translate x * 2 }",
    "// a comment with a { and a \"",
    "spline track { bspline <4, 1, 0>, <3, 2.5, 3>,\n  <0, 1, 4>  closed }",
    "let p = [\n  <0, 0, 0>,\n  <1, 1.5, 0>\n]",
    "ball",
    "import \"trees.scene\" as trees",
    "let f = p => p.x ? 1 : 2",
    "print(\"a {size} b\")",
    "group { sphere { }  box { }  translate x }",
];

/// Items with one fault each, on their first line, and its code.
const FAULTY: &[(&str, &str)] = &[
    ("sphere { center <0, , 1>  radius 2 }", "E0001"),
    ("sphere { center <0, 1 1>  radius 2 }", "E0001"),
    ("sphere { center <0, a b, 1>  radius 2 }", "E0001"),
    ("sphere { radius , 2  material clay }", "E0001"),
    ("sphere { radius 1, material clay }", "E0001"),
    ("sphere { radius 1 + }", "E0001"),
    ("sphere { <0, 0, 0>, 1 }", "E0001"),
    ("sphere { radius 1 2 }", "E0001"),
    ("group { group { sphere { radius * 2 } } box { } }", "E0001"),
    ("for i in 0..3 { if i > 1 { sphere { radius 1 ++ 2 } } }", "E0001"),
    ("let x = 3 + ;", "E0001"),
    ("let x = ;", "E0001"),
    ("let 3 = x", "E0001"),
    ("let y 4", "E0001"),
    ("let w = 2 * * 3", "E0001"),
    ("let t = a ? b", "E0001"),
    ("let z = f(1,, 2)", "E0001"),
    ("let z = f(1 2)", "E0001"),
    ("let z = f(k = 2)", "E0001"),
    ("let m = a & b", "E0001"),
    ("let u = “a”", "E0001"),
    ("let v = [1, 2 3]", "E0001"),
    ("let e = [x for v l]", "E0001"),
    ("let c = #12345", "E0001"),
    ("let l = f(x) => 3", "E0001"),
    ("let r = 0..1..2", "E0001"),
    ("let g = (1, 2)", "E0001"),
    ("let h = a.", "E0001"),
    ("a b = 3", "E0001"),
    ("x = = 3", "E0001"),
    ("fn f(a b) = a", "E0001"),
    ("fn g = 3", "E0001"),
    ("fn h(a)", "E0001"),
    ("for i on 0..3 { sphere { radius i } }", "E0001"),
    ("for i 0..3 { sphere { radius i } }", "E0001"),
    ("for i in { sphere { } }", "E0001"),
    ("if a = b { sphere { } } else { box { } }", "E0001"),
    ("if a and b { sphere { } }", "E0001"),
    ("while { sphere { } }", "E0001"),
    ("import foo", "E0001"),
    ("#declare R = 3;", "E0001"),
    ("print(\"a {1 + }\")", "E0001"),
    ("plane { normal y },", "E0001"),
    ("@", "E0001"),
    ("let v = <1, 2", "E0002"),
    ("group { sphere { center <1, 1 } }", "E0002"),
    ("sphere { radius max(1, 2 }", "E0002"),
    ("sphere { radius 1", "E0002"),
    ("group { sphere { radius 1 }", "E0002"),
    ("let s = \"abc", "E0002"),
    ("sphere { name \"abc }", "E0002"),
    ("let l = [1, 2", "E0002"),
    ("let p = (1 + 2", "E0002"),
    ("let n = 12deg", "E0004"),
    ("let n = 1e999", "E0004"),
    ("let n = 5.", "E0004"),
    ("let n = <1., 2, 3>", "E0004"),
    ("let e = \"\\q\"", "E0005"),
    ("print(\"a { b\")", "E0005"),
    ("let q = 1 < 2 < 3", "E0006"),
    ("spher { radius 1 }", "E0007"),
    ("spher ball { radius 1 }", "E0007"),
    ("group { materal clay { diffuse 1 } }", "E0007"),
    ("let box = 1", "E0008"),
    ("fn let(a) = 3", "E0008"),
    ("material light { diffuse 1 }", "E0008"),
    ("let v = <1 -1, 2>", "E0011"),
];

/// Parses items a line apart, and compares the faults found, by line and code, with those planted.
fn check(items: &[(&str, Option<&str>)], join: &str) -> Result<(), String> {
    let mut text = String::new();
    let mut planted = Vec::new();
    for (item, code) in items {
        if let Some(code) = code {
            planted.push((text.matches('\n').count() + 1, (*code).to_owned()));
        }
        text.push_str(item);
        text.push_str(join);
    }
    let mut map = SourceMap::default();
    let id = map.add("scene", text.as_str());
    let (_, found) = parse_file(id, &text, ParseLimits::default());
    let line = |d: &ogee::diag::Diagnostic| d.span.map_or(0, |s| map.line_column(SourceId(0), s.start).line);
    let said: Vec<(usize, String)> = found.iter().map(|d| (line(d), d.code.text().to_owned())).collect();
    if said == planted {
        return Ok(());
    }
    let messages: Vec<String> =
        found.iter().map(|d| format!("{}: {} {}", line(d), d.code.text(), d.message)).collect();
    Err(format!("{text}\nplanted {planted:?}\nsaid {messages:#?}"))
}

fn planted() -> impl Strategy<Value = (&'static str, Option<&'static str>)> {
    prop_oneof![
        3 => prop::sample::select(SOUND).prop_map(|item| (item, None)),
        2 => prop::sample::select(FAULTY).prop_map(|(item, code)| (item, Some(code))),
    ]
}

#[test]
fn each_fault_alone_is_said_once() {
    let mut wrong = Vec::new();
    for (item, code) in FAULTY {
        for join in ["\n", "\n\n"] {
            wrong.extend(check(&[(SOUND[0], None), (item, Some(code)), (SOUND[1], None)], join).err());
            wrong.extend(check(&[(item, Some(code))], join).err());
        }
        wrong.extend(check(&[(item, Some(code)), (SOUND[2], None), (SOUND[9], None)], "\n").err());
    }
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn each_pair_of_faults_is_said() {
    let mut wrong = Vec::new();
    for (first, code) in FAULTY {
        for (second, other) in FAULTY {
            if first.starts_with("if") && second.starts_with("else") {
                continue; // belong together
            }
            wrong.extend(check(&[(first, Some(code)), (second, Some(other)), (SOUND[0], None)], "\n").err());
        }
    }
    assert!(
        wrong.is_empty(),
        "{} wrong\n{}",
        wrong.len(),
        wrong.iter().take(12).cloned().collect::<Vec<_>>().join("\n")
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn many_faults_among_sound_items_are_all_said(items in prop::collection::vec(planted(), 1..20)) {
        if let Err(wrong) = check(&items, "\n") {
            prop_assert!(false, "{}", wrong);
        }
    }
}
