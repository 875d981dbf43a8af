//! Reading and laying out scenes: the trees of the sample scenes, faults and what is said of them, garbage, depth, and
//! the way there and back.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use ogee::diag::{Diagnostic, Severity, SourceId};
use ogee::syntax::ast::{File, ItemKind};
use ogee::syntax::build::{KINDS, ParseLimits, parse_expression, parse_file};
use ogee::syntax::format::format;
use ogee::syntax::print::{print, print_expression};
use proptest::prelude::*;

fn parse(text: &str) -> (File, Vec<Diagnostic>) {
    parse_file(SourceId(0), text, ParseLimits::default())
}

/// The tree of a text that has no fault.
fn tree(text: &str) -> String {
    let (file, found) = parse(text);
    assert!(found.is_empty(), "{text}\n{found:#?}");
    print(&file)
}

/// `code «underlined»` of each diagnostic, in order.
fn faults(text: &str) -> Vec<String> {
    let (_, found) = parse(text);
    let place = |d: &Diagnostic| d.span.map_or("", |s| &text[s.start as usize..s.end as usize]).to_owned();
    found.iter().map(|d| format!("{} «{}»", d.code.text(), place(d))).collect()
}

/// The scenes beside the data, if there are any on this machine.
fn sample_scenes() -> Vec<(String, String)> {
    let Some(data) = std::env::var_os("OGEE_DATA") else {
        println!("skipped without OGEE_DATA");
        return Vec::new();
    };
    let folder = PathBuf::from(data).join("../scenes");
    let mut scenes = Vec::new();
    for entry in std::fs::read_dir(folder).expect("scenes beside the data") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "scene") {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            scenes.push((name, std::fs::read_to_string(&path).expect("a readable scene")));
        }
    }
    scenes.sort();
    scenes
}

#[test]
fn the_grammar_reserves_the_kinds_and_no_other_word() {
    let grammar = include_str!("../../grammar/ogee.pest");
    let rule = grammar.split("kind = @{").nth(1).expect("the rule").split('~').next().expect("its words");
    let words: Vec<&str> = rule.split('"').skip(1).step_by(2).collect();
    assert_eq!(words, KINDS);
}

#[test]
fn sample_scenes_keep_their_trees() {
    for (name, text) in sample_scenes() {
        insta::assert_snapshot!(format!("scene_{name}"), tree(&text));
    }
}

#[test]
fn a_property_ends_where_the_next_item_begins() {
    assert_eq!(
        tree("plane { normal y  material { diffuse 1 } }"),
        "block plane\n  property normal\n    name y\n  block material\n    property diffuse\n      number 1\n"
    );
    assert_eq!(tree("shoulder -30"), "property shoulder\n  unary -\n    number 30\n");
    assert_eq!(tree("a -b - c"), "property a\n  binary -\n    unary -\n      name b\n    name c\n");
    assert_eq!(tree("radius (1 + 2)"), "property radius\n  binary +\n    number 1\n    number 2\n");
    assert_eq!(tree("radius 1\n(a)"), "property radius\n  number 1\nplacement\n  name a\n");
    assert_eq!(tree("f(x)\na[0]\nt.scene"), tree("f(x); a[0]; t.scene"));
    assert_eq!(
        tree("points a,\n b\nclosed"),
        "property points\n  name a\n  name b\nflag-or-placement closed\n"
    );
    assert_eq!(tree("hide camera  radius 1"), "property hide\n  name camera\nproperty radius\n  number 1\n");
}

#[test]
fn a_sign_before_a_component_may_stand_apart() {
    assert_eq!(tree("a <1, - 2, -\t.5>"), tree("a <1, -2, -.5>"));
    assert_eq!(format("a <1, - 2>").unwrap(), "a <1, -2>\n");
    assert!(tree("a <1, - -2>").contains("unary"), "two signs are an expression");
}

#[test]
fn a_word_goes_on_with_every_mark_that_the_grammar_lets_it() {
    for word in ["gT\u{1daa6}", "a\u{c4d}", "a\u{e0100}", "\u{ba}\u{fe20}", "e\u{301}te"] {
        assert_eq!(format(word).as_deref().ok(), Some(format!("{word}\n").as_str()));
        assert_eq!(tree(&format!("{word} 1")), format!("property {word}\n  number 1\n"));
    }
}

#[test]
fn a_sign_tight_to_the_word_that_a_placement_begins_with_stays_there() {
    for (text, laid_out) in [
        ("a<b?c:d", "a<b ? c : d\n"),
        ("a-b?c:d", "a-b ? c : d\n"),
        ("a--b?c:(a<b)", "a--b ? c : (a < b)\n"),
        ("f(1)<b?c:d", "f(1) < b ? c : d\n"),
    ] {
        assert_eq!(format(text).as_deref().ok(), Some(laid_out));
        assert_eq!(tree(laid_out), tree(text));
    }
}

#[test]
fn what_is_too_deep_is_told_at_a_whole_character() {
    for open in ["\u{e9}(", "\u{e9}[", "\u{e9} { "] {
        survives(&open.repeat(1000));
        let close = if open.contains('(') {
            ")"
        } else if open.contains('[') {
            "]"
        } else {
            "}"
        };
        let deep = format!("a {}1{}", open.repeat(1000), close.repeat(1000));
        survives(&deep);
        assert!(faults(&deep).iter().any(|fault| fault.starts_with("E0003")), "{open}");
    }
}

#[test]
fn a_blank_of_another_writing_is_a_fault_and_no_crash() {
    for blank in ["\u{2000}", "\u{a0}", "\u{205f}", "\u{3000}"] {
        assert_eq!(faults(blank), [format!("E0001 «{blank}»")]);
        assert_eq!(faults(&format!("sphere {blank}{{ }}")), [format!("E0001 «{blank}»")]);
        survives(&format!("let a = 1 {blank}\nsphere {{ radius {blank} }}{blank}"));
    }
}

#[test]
fn a_tight_bracket_is_an_index_or_a_call_and_never_another_item() {
    assert_eq!(tree("l [e for e in m]"), tree("l  [e for e in m]"));
    assert_eq!(tree("l\n[e for e in m]"), tree("l; [e for e in m]"));
    for text in ["l[e for e in m]", "radius 1(2)", "radius l[e for e in m]", "let a = <1, 2>[0]", "(a)[]"] {
        assert!(!parse(text).1.is_empty(), "{text}");
        assert!(format(text).is_err(), "{text}");
    }
    assert_eq!(faults("l[e for e in m]\nradius 1"), ["E0001 «for»"]);
}

#[test]
fn kinds_tell_blocks_from_labels_and_properties() {
    assert_eq!(tree("surface tube { }"), "property surface\n  block tube\n");
    assert_eq!(tree("joint elbow { }"), "block joint elbow\n");
    assert_eq!(tree("material clay"), "property material\n  name clay\n");
    assert_eq!(tree("material clay with { }"), "property material\n  with\n    name clay\n    items\n");
    assert_eq!(
        tree("sphere\n{\n}\nball\n  with { }"),
        "block sphere\nplacement\n  with\n    name ball\n    items\n"
    );
    assert_eq!(tree("sphere { } with { }"), "placement\n  with\n    block sphere\n    items\n");
}

#[test]
fn operators_bind_as_the_reference_says() {
    let shape = |text: &str| {
        let (value, found) = parse_expression(SourceId(0), text, ParseLimits::default());
        assert!(found.is_empty(), "{text}: {found:#?}");
        print_expression(&value.expect("a value")).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(shape("-x ^ 2"), "unary - binary ^ name x number 2");
    assert_eq!(shape("2 ^ -3 ^ 4"), "binary ^ number 2 unary - binary ^ number 3 number 4");
    assert_eq!(shape("a - b - c * d"), "binary - binary - name a name b binary * name c name d");
    assert_eq!(shape("a || b && c == d"), "binary || name a binary && name b binary == name c name d");
    assert_eq!(
        shape("0..n + 1 step 2 < x"),
        "binary < range .. number 0 binary + name n number 1 step number 2 name x"
    );
    assert_eq!(shape("a ? b : c ? d : e"), "choice name a name b choice name c name d name e");
    assert_eq!(shape("p => q => p"), "lambda parameter p value lambda parameter q value name p");
    assert_eq!(shape("(u, v) => u"), "lambda parameter u parameter v value name u");
    assert_eq!(shape("<a + b, 1, 2>.x"), "field .x vector binary + name a name b number 1 number 2");
    assert_eq!(shape("<1 + 2, 3>"), "vector binary + number 1 number 2 number 3");
    assert_eq!(
        shape("f(a, k: b)[0].c(d)"),
        "call field .c index call name f name a argument k name b number 0 name d"
    );
    assert_eq!(
        shape("!a.b && -c[0] > 1"),
        "binary && unary ! field .b name a binary > unary - index name c number 0 number 1"
    );
    assert_eq!(shape("#c31"), "colour #cc3311");
    assert_eq!(shape("\"a{1}\\u{e9}\\{\""), "text literal \"a\" interpolation number 1 literal \"é{\"");
    assert_eq!(
        shape("[x for v in l if v > 0]"),
        "comprehension v value name x over name l condition binary > name v number 0"
    );
    assert_eq!(shape("1.5e-3"), "number 0.0015");
}

#[test]
fn every_fault_is_said_once_and_the_rest_is_read() {
    let text = "sphere { center <0, , 1>  radius 2 }\nlet x = 3 +\nbox { min <1,2,3>  max , }\nspher { }\n\
                let 3 = 4\ngroup { sphere { center <1,1 } }\nlet q = 1 < 2 < 3\nlet zz = 4\n";
    assert_eq!(
        faults(text),
        [
            "E0001 «,»",
            "E0001 «+»",
            "E0001 «,»",
            "E0007 «spher»",
            "E0001 «3»",
            "E0002 «<»",
            "E0006 «1 < 2 < 3»"
        ]
    );
    let (file, _) = parse(text);
    let names: Vec<&str> = file
        .items
        .iter()
        .filter_map(|item| match &item.kind {
            ItemKind::Let(name, _) | ItemKind::Bad { defines: Some(name) } => Some(&*name.name),
            _ => None,
        })
        .collect();
    assert_eq!(names, ["x", "q", "zz"], "what a bad item would have bound is not undefined");
}

#[test]
fn a_fault_in_a_block_keeps_the_other_items() {
    let (file, found) =
        parse("group { group { sphere { radius 1 + } sphere { radius 2 } box { min , max 1 } } }");
    assert_eq!(found.len(), 2);
    let text = print(&file);
    assert!(text.contains("number 2") && text.contains("property max"), "{text}");
}

#[test]
fn what_is_not_closed_points_to_its_opening() {
    assert_eq!(faults("group {\n  sphere {\n    radius 1\n  translate x\n}\nplane { }\n"), ["E0002 «{»"]);
    assert_eq!(faults("sphere { radius 1\nplane { normal y }\n"), ["E0002 «{»"]);
    assert_eq!(faults("sphere { radius max(1, 2  material clay }\n"), ["E0002 «(»"]);
    assert_eq!(faults("let a = [1, 2\nlet b = (1 + 2\nlet c = 3"), ["E0002 «[»", "E0002 «(»"]);
    assert_eq!(faults("sphere { name \"abc }\nplane { }"), ["E0002 «\"»"]);
    assert_eq!(faults("sphere { }\n/* a /* b */\nplane { }"), ["E0002 «/*»"]);
    assert_eq!(faults("sphere { } }\nplane { }"), ["E0001 «}»"]);
    let (file, _) = parse("group {\n  sphere { radius 1\n  plane { normal y }\n}\nlet a = 1\n");
    assert_eq!(file.items.len(), 2, "{}", print(&file));
}

#[test]
fn what_people_bring_from_elsewhere_is_answered() {
    let hint = |text: &str| parse(text).1.into_iter().flat_map(|d| d.hints).next().unwrap_or_default();
    assert!(hint("#declare R = 3;").contains("let R"));
    assert!(hint("sphere { <0, 0, 0>, 1 }").contains("center"));
    assert!(hint("if a and b { }").contains("&&"));
    assert!(hint("light_source { <0, 1, 2> }").contains("`light`"));
    assert!(hint("let x = 0 < t < 1").contains("`0 < t && t < 1`"));
    assert!(hint("let v = <1 -1, 2>").contains("`, -`"));
    assert!(hint("let a = 12deg").contains("12 * deg"));
    assert!(hint("let a = 5.").contains("5.0"));
    assert!(hint("let y = “a”").contains("straight"));
    assert!(hint("let box = 1").contains("my_box"));
}

#[test]
fn nesting_is_read_fast_and_past_the_limit_refused() {
    let nest = |open: &str, close: &str, n: usize| format!("let a = {}1{}", open.repeat(n), close.repeat(n));
    for (open, close) in
        [("(", ")"), ("[", "]"), ("<1, ", ">"), ("f(", ")"), ("-(", ")"), ("a with { b ", " }")]
    {
        let started = Instant::now();
        assert_eq!(faults(&nest(open, close, 64)), Vec::<String>::new(), "{open}");
        assert!(started.elapsed() < Duration::from_millis(500), "{open} takes {:?}", started.elapsed());
        let deep = nest(open, close, 1000);
        assert!(parse(&deep).1.iter().any(|d| d.code.text() == "E0003"), "{open}");
    }
    assert_eq!(
        faults(&"group { ".repeat(64).chars().chain("}".repeat(64).chars()).collect::<String>()).len(),
        0
    );
}

/// Read again at each of its braces, this took half a minute.
#[test]
fn a_fault_deep_inside_braces_is_found_without_reading_at_each_of_them() {
    let deep = |inner: &str| {
        let (open, close) = (format!("{}joint j {{", ";".repeat(20)).repeat(200), "}".repeat(200));
        format!("light {{ {open} {inner} {close} }}\nsphere {{ radius 2 * }}\n")
    };
    let started = Instant::now();
    assert_eq!(faults(&deep("radius )")).len(), 2);
    assert_eq!(faults(&deep("radius 1 +")), ["E0001 «+»", "E0001 «*»"]);
    assert_eq!(faults(&deep("a 1 +  joint j { b 2 * }  c 3")).len(), 3);
    assert!(started.elapsed() < Duration::from_secs(5), "took {:?}", started.elapsed());
}

#[test]
fn endless_brackets_and_chains_neither_crash_nor_hang() {
    let n = 100_000;
    let started = Instant::now();
    let repeated = [
        "(",
        "[",
        "{",
        "<",
        "sphere {",
        "let a = \"{",
        "/*",
        "-",
        "!",
        "a => ",
        "a ? ",
        "a.",
        "f(",
        "}",
        ")",
        "if a { } else ",
    ];
    for piece in repeated {
        let text = format!("let a = {}", piece.repeat(n));
        let (file, found) = parse(&text);
        assert!(!found.is_empty(), "{piece}");
        drop(file);
        drop(parse(&piece.repeat(n)));
    }
    for (head, piece) in [("1", " + 1"), ("f", "(1)"), ("a", ".b"), ("1", " ^ 1"), ("a", " ? b : c")] {
        let (file, found) = parse(&format!("let a = {head}{}", piece.repeat(n)));
        assert_eq!(found.len(), 1, "{piece}: {found:?}");
        drop(file);
    }
    assert!(started.elapsed() < Duration::from_secs(60), "took {:?}", started.elapsed());
}

#[test]
fn sample_scenes_are_laid_out_without_changing_them() {
    for (name, text) in sample_scenes() {
        let once = format(&text).expect("a sound scene");
        assert_eq!(tree(&once), tree(&text), "{name}");
        assert_eq!(format(&once).expect("a sound scene"), once, "{name}: again");
        assert!(
            once.lines().all(|l| l.chars().count() <= ogee::syntax::format::WIDTH || l.contains("//")),
            "{name}"
        );
    }
}

#[test]
fn the_layout_keeps_comments_and_groups() {
    let text = "// head\n\n\n\nsphere{radius 1 /* why */ center<0,0,0>.xyz}\nlet a=[1,2, // two\n3]\n\
                if a>b{closed;radius -3}else{x}  // end\n\n/* block\n   of lines */ plane { normal y }\n";
    let laid_out = format(text).expect("a sound scene");
    insta::assert_snapshot!(laid_out);
    assert_eq!(format(&laid_out).expect("sound"), laid_out);
}

/// A text that is likely a scene: pieces of the language in a random order.
fn scraps() -> impl Strategy<Value = String> {
    let pieces = prop::sample::select(vec![
        "sphere",
        "group",
        "material",
        "let",
        "var",
        "fn",
        "if",
        "else",
        "for",
        "in",
        "while",
        "import",
        "with",
        "return",
        "x",
        "radius",
        "clay",
        "1",
        "2.5",
        "-",
        "+",
        "*",
        "<",
        ">",
        "<1, 2, 3>",
        ",",
        "=",
        "==",
        "=>",
        "?",
        ":",
        "..",
        ".",
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        "{",
        "}",
        "\"",
        "\"a\"",
        "\"{",
        "\\",
        "//",
        "/*",
        "*/",
        "#",
        "#c31",
        ";",
        "\n",
        "\n",
        " ",
        " ",
        "é",
        "\u{1}",
        "“",
    ]);
    prop::collection::vec(pieces, 0..60).prop_map(|pieces| pieces.concat())
}

/// Reads a text, and holds its spans to the text.
fn survives(text: &str) {
    let (file, found) = parse(text);
    let ok = |span: ogee::diag::Span| {
        span.start <= span.end
            && text.is_char_boundary(span.start as usize)
            && text.is_char_boundary(span.end as usize)
    };
    for diagnostic in &found {
        let spans = diagnostic.span.into_iter().chain(diagnostic.labels.iter().map(|l| l.span));
        spans.for_each(|span| assert!(ok(span), "{diagnostic:?} in {text:?}"));
    }
    file.items.iter().for_each(|item| assert!(ok(item.span), "{item:?} in {text:?}"));
    let json = ogee::syntax::print::print_json(&file);
    check_spans(&json, text);
    if found.iter().all(|d| d.severity != Severity::Error) {
        let once = format(text).expect("a sound text");
        assert_eq!(print(&parse(&once).0), print(&file), "{text:?} -> {once:?}");
        assert_eq!(format(&once).expect("a sound text"), once, "{text:?}");
    }
    let _ = parse_expression(SourceId(0), text, ParseLimits::default());
}

fn check_spans(node: &serde_json::Value, text: &str) {
    if let Some(span) = node.get("span") {
        for end in span.as_array().into_iter().flatten() {
            let at = end.as_u64().expect("a number") as usize;
            assert!(text.is_char_boundary(at), "{at} in {text:?}");
        }
    }
    node.get("children")
        .and_then(|c| c.as_array())
        .into_iter()
        .flatten()
        .for_each(|child| check_spans(child, text));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn scraps_of_scenes_never_panic(text in scraps()) {
        survives(&text);
    }

    #[test]
    fn random_text_never_panics(text in "\\PC{0,80}") {
        survives(&text);
    }

    #[test]
    fn mangled_scenes_never_panic(cuts in prop::collection::vec((0usize..4000, 0usize..12, scraps()), 1..4)) {
        let sample = include_str!("syntax_sample.scene");
        let mut text = sample.to_owned();
        for (at, len, scrap) in cuts {
            let start = text.floor_char_boundary(at % (text.len() + 1));
            let end = text.floor_char_boundary((start + len).min(text.len())).max(start);
            text.replace_range(start..end, &scrap[..scrap.floor_char_boundary(scrap.len().min(9))]);
        }
        survives(&text);
    }
}

// ---------------------------------------------------------------- programs there and back

fn name() -> impl Strategy<Value = String> {
    prop::sample::select(vec!["a", "b", "radius", "path", "n_1", "step", "of", "at", "ä"])
        .prop_map(str::to_owned)
}

fn kind() -> impl Strategy<Value = String> {
    prop::sample::select(KINDS.to_vec()).prop_map(str::to_owned)
}

fn value() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        name(),
        (0.0..1e6f64).prop_map(|v| format!("{v}")),
        Just("<1, -2.5, 3e-2>".to_owned()),
        Just("#c31".to_owned()),
        Just("\"t {1 + 2} \\n\"".to_owned()),
        Just("true".to_owned()),
    ];
    leaf.prop_recursive(4, 24, 4, |inner| {
        let operator = prop::sample::select(vec!["+", "-", "*", "/", "%", "^", "&&", "||", "=="]);
        prop_oneof![
            (inner.clone(), operator, inner.clone()).prop_map(|(a, op, b)| format!("({a}) {op} ({b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("<({a}), ({b})>")),
            prop::collection::vec(inner.clone(), 0..4).prop_map(|v| format!("[{}]", v.join(", "))),
            (name(), prop::collection::vec(inner.clone(), 0..3))
                .prop_map(|(f, v)| format!("{f}({})", v.join(", "))),
            (name(), inner.clone()).prop_map(|(f, v)| format!("{f}(key: {v})")),
            inner.clone().prop_map(|v| format!("-({v})")),
            (name(), inner.clone()).prop_map(|(p, v)| format!("({p} => {v})")),
            (inner.clone(), inner.clone(), inner.clone())
                .prop_map(|(a, b, c)| format!("(({a}) ? {b} : {c})")),
            (name(), inner.clone(), inner.clone())
                .prop_map(|(v, a, b)| format!("[{a} for {v} in [{b}] if true]")),
            (name(), inner.clone()).prop_map(|(a, v)| format!("{a} with {{ scale {v} }}")),
            (kind(), inner).prop_map(|(k, v)| format!("{k} {{ size {v} }}")),
        ]
    })
}

fn program() -> impl Strategy<Value = String> {
    let blank = || prop::sample::select(vec!["\n", "\n\n\n", "  // c\n", "\n/* d */ ", "\n  ", " ;\n"]);
    let line = prop_oneof![
        (name(), value()).prop_map(|(n, v)| format!("{n} {v}")),
        (name(), value(), value()).prop_map(|(n, a, b)| format!("{n} ({a}),\n  ({b})")),
        (name(), value()).prop_map(|(n, v)| format!("let {n} = {v}")),
        (name(), value()).prop_map(|(n, v)| format!("{n} = {v}")),
        (name(), name(), value()).prop_map(|(f, p, v)| format!("fn {f}({p}, q = 1) = {v}")),
        name(),
    ];
    let item = line.prop_recursive(4, 40, 5, move |inner| {
        let items = prop::collection::vec((inner, blank()), 0..5)
            .prop_map(|items| items.into_iter().map(|(i, b)| i + b).collect::<String>());
        prop_oneof![
            (kind(), items.clone()).prop_map(|(k, i)| format!("{k} {{ {i} }}")),
            (kind(), name(), items.clone()).prop_map(|(k, n, i)| format!("{k} {n} {{ {i} }}")),
            (name(), items.clone()).prop_map(|(n, i)| format!("if {n} {{ {i} }} else {{ }}")),
            (name(), items.clone()).prop_map(|(n, i)| format!("for {n} in 0..3 {{ {i} }}")),
            (name(), items).prop_map(|(n, i)| format!("fn {n}() {{ {i} }}")),
        ]
    });
    prop::collection::vec((item, blank()), 0..6)
        .prop_map(|items| items.into_iter().map(|(i, b)| i + b).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn programs_are_laid_out_without_changing_them(text in program()) {
        let (file, found) = parse(&text);
        prop_assert!(found.is_empty(), "{text}\n{found:#?}");
        let once = format(&text).expect("a sound program");
        let (again, _) = parse(&once);
        prop_assert_eq!(print(&again), print(&file), "{}\n--- to\n{}", text, once);
        prop_assert_eq!(format(&once).expect("a sound program"), once.clone(), "again: {}", text);
        let comments = |t: &str| t.matches("// c").count() + t.matches("/* d */").count();
        prop_assert_eq!(comments(&once), comments(&text), "{}", once);
    }
}

#[test]
fn a_lone_carriage_return_ends_a_line_for_the_layout_too() {
    let laid_out = ogee::syntax::format::format("plane { diff\ruse 0.4 }\rball\r").expect("it can be read");
    assert!(!laid_out.contains('\r'), "{laid_out:?}");
    assert!(!laid_out.contains("diff  use"), "a flag and a property became one: {laid_out:?}");
}
