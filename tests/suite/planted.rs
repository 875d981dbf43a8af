//! Every independent fault of a file in one run, and nothing else: scenes with one to eight planted faults each, made
//! from a seed. What is found must be what was planted, code by code and line by line.

use ogee::diag::Code;
use ogee::session::Session;

/// A fault as lines of a scene: the text, the code, and which of its lines is at fault (from 0).
struct Fault {
    text: &'static str,
    code: Code,
    line: usize,
}

const fn fault(text: &'static str, code: Code, line: usize) -> Fault {
    Fault { text, code, line }
}

/// `#` becomes a number of its own, so that faults planted together do not share names.
const FAULTS: &[Fault] = &[
    // reading
    fault("let a# = <1, 2", Code::Unclosed, 0),
    fault("let a# = [1, 2, , 3]", Code::Syntax, 0),
    fault("let a# = 1 + * 2", Code::Syntax, 0),
    fault("let = 4", Code::Syntax, 0),
    fault("sphere { center <0, 1 0> }", Code::Syntax, 0),
    fault("group {\n  sphere { radius }\n}", Code::BadProperty, 1),
    fault("let a# = 0 < 1 < 2", Code::ChainedComparison, 0),
    fault("sphare { radius 1 }", Code::UnknownKind, 0),
    fault("let sphere = 3", Code::ReservedName, 0),
    fault("let a# = \"text \\q\"", Code::BadString, 0),
    fault("let a# = #12", Code::Syntax, 0),
    // names
    fault("let a# = undefined#", Code::UnknownName, 0),
    fault("let a# = 1\nlet a# = 2", Code::DuplicateName, 1),
    fault("let a# = 1\na# = 2", Code::NotAssignable, 1),
    fault("fn f#(q) {\n  sphere { radius qq }\n}", Code::UnknownName, 1),
    fault("sphere { material paint# }", Code::UnknownName, 0),
    // values
    fault("let a# = 1 + \"two\"", Code::TypeMismatch, 0),
    fault("let a# = sqrt(1, 2)", Code::WrongArity, 0),
    fault("fn f#(p, q) = p + q\nlet a# = f#(1)", Code::WrongArity, 1),
    fault("let a# = 3\nlet b# = a#(2)", Code::NotCallable, 1),
    fault("let a# = <1, 2, 3>.w", Code::NoSuchField, 0),
    fault("let a# = [1, 2][5]", Code::IndexOutOfRange, 0),
    fault("let a# = 1 / 0", Code::DivisionByZero, 0),
    fault("let a# = sqrt(-1)", Code::Undefined, 0),
    fault("let a# = 1e200 * 1e200", Code::NotFinite, 0),
    fault("if 3 { sphere { } }", Code::TypeMismatch, 0),
    // properties
    fault("sphere { raduis 1 }", Code::UnknownProperty, 0),
    fault("fn f#() {\n  sphere { colour 1 }\n}", Code::UnknownProperty, 1),
    fault("disc { center 4 }", Code::TypeMismatch, 0),
    fault("sphere {\n  radius -1\n}", Code::BadProperty, 1),
    fault("sphere {\n  radius 1\n  radius 2\n}", Code::DuplicateProperty, 2),
    fault("mesh { smooth on }", Code::MissingProperty, 0),
    fault("light { intensity 3 }", Code::MissingProperty, 0),
    fault("material m# { diffuse 1  lobe pong }", Code::UnknownWord, 0),
    fault("sphere {\n  material clay# { diffuse 1 }\n}", Code::LabelInsideObject, 1),
    fault("let a# = 3\na#", Code::NotPlaceable, 1),
    fault("sphere { radius inf }", Code::NotFinite, 0),
    // evaluation and files
    fault("assert(1 == 2, \"never\")", Code::AssertFailed, 0),
    fault("error(\"stop\")", Code::UserError, 0),
    fault("fn f#(n) = f#(n + 1)\nlet a# = f#(0)", Code::CallDepth, 0),
    // With an alias: what a plain import would have defined is not known, so that no name is called undefined.
    fault("import \"no-such-file-#.scene\" as m#", Code::FileNotFound, 0),
    fault("return 3", Code::ReturnOutside, 0),
    fault("sphere { scale 0 }", Code::BadProperty, 0),
    fault("material m# { diffuse 0.9  specular 0.8 }", Code::EnergyGain, 0),
];

/// Harmless items that stand between the faults.
const FILLERS: &[&str] = &[
    "sphere { center <#, 1, 0>  radius 0.5 }",
    "let fine# = [i * i for i in 0..10 if i % 2 == 0]",
    "fn good#(a, b = 2) {\n  sphere { radius a + b }\n}\ngood#(1) with { translate <0, #, 0> }",
    "// a comment with { braces and \"quotes",
    "group {\n  box { min <0, 0, 0>  max <1, 1, 1> }\n  translate x * #\n}",
    "for i in 0..3 { sphere { center <i, #, 0> } }",
    "",
    "let text# = \"five is {2 + 3}\"",
];

fn random(seed: &mut u64) -> usize {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 33) as usize
}

/// A scene with `n` planted faults, and where each must be found: (code, line from 1).
fn planted(seed: u64) -> (String, Vec<(Code, usize)>) {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let n = 1 + random(&mut state) % 8;
    let mut text = String::from("camera { eye z * 5  look_at <0, 0, 0> }\nlight { sky 1 }\nsphere { }\n");
    let mut expected = Vec::new();
    for k in 0..n {
        for _ in 0..random(&mut state) % 3 {
            text.push_str(
                &FILLERS[random(&mut state) % FILLERS.len()]
                    .replace('#', &format!("{}", random(&mut state) % 1_000_000)),
            );
            text.push('\n');
        }
        let fault = &FAULTS[random(&mut state) % FAULTS.len()];
        let line = text.lines().count() + 1 + fault.line;
        expected.push((fault.code, line));
        // A colour's `#` is not a number's place.
        let number = format!("{seed}x{k}");
        let unique = if fault.text.contains("#12") {
            fault.text.replacen('#', &number, 1)
        } else {
            fault.text.replace('#', &number)
        };
        text.push_str(&unique);
        text.push('\n');
    }
    text.push_str("sphere { center <0, 9, 0> }\n");
    expected.sort_by_key(|(code, line)| (*line, *code));
    (text, expected)
}

fn found(text: &str) -> (Vec<(Code, usize)>, String) {
    let mut session = Session::default();
    let evaluated = session.evaluate_text("planted.scene", text);
    let line = |d: &ogee::diag::Diagnostic| {
        d.span.map_or(0, |s| session.sources.line_column(s.source, s.start).line)
    };
    let mut list: Vec<_> = evaluated.diagnostics.iter().map(|d| (d.code, line(d))).collect();
    list.sort_by_key(|(code, line)| (*line, *code));
    (
        list,
        ogee::diag::render::human(
            &evaluated.diagnostics,
            &session.sources,
            ogee::diag::render::Style::plain(100),
        ),
    )
}

#[test]
fn each_fault_alone_is_found_at_its_line_and_nothing_else_is() {
    let mut wrong = Vec::new();
    for fault in FAULTS {
        let unique = if fault.text.contains("#12") {
            fault.text.replacen('#', "1", 1)
        } else {
            fault.text.replace('#', "1")
        };
        let text = format!(
            "camera {{ eye z * 5  look_at <0, 0, 0> }}\nlight {{ sky 1 }}\n{unique}\nsphere {{ center <0, 9, 0> }}\n"
        );
        let (list, said) = found(&text);
        if list != [(fault.code, 3 + fault.line)] {
            wrong.push(format!(
                "--- {text}planted {:?} in line {}, found {list:?}\n{said}",
                fault.code,
                3 + fault.line
            ));
        }
    }
    assert!(wrong.is_empty(), "{} of {} faults\n{}", wrong.len(), FAULTS.len(), wrong.join("\n"));
}

#[test]
fn a_hundred_scenes_with_up_to_eight_faults_say_each_of_them_and_nothing_else() {
    let mut wrong = Vec::new();
    for seed in 0..100 {
        let (text, expected) = planted(seed);
        let (list, said) = found(&text);
        if list != expected {
            wrong.push(format!("--- seed {seed}\n{text}planted {expected:?}\nfound   {list:?}\n{said}"));
        }
    }
    assert!(wrong.is_empty(), "{} of 100 scenes\n{}", wrong.len(), wrong.join("\n"));
}
