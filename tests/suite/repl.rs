//! `ogee repl` through a pipe: what lines answer, and that a line that fails changes nothing.

use crate::run::{Folder, Run};

fn repl(lines: &str) -> Run {
    Folder::new().ogee_fed("repl", lines)
}

/// What lines answer that all succeed.
fn answers(lines: &str) -> String {
    let run = repl(lines).expect(0);
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    run.out().to_owned()
}

#[test]
fn names_of_earlier_lines_are_known_to_later_ones() {
    assert_eq!(answers("let r = 2\npi * r^2\n"), "12.566370614359172\n");
    assert_eq!(answers("var n = 1\nn = n + 1\nn\n"), "2\n");
    assert_eq!(answers("fn f(a, b = 3) = a * b\nf(2)\nf(2, b: 5)\n"), "6\n10\n");
    assert_eq!(answers("let add = k => (x => x + k)\nlet two = add(2)\ntwo(40)\n"), "42\n");
    assert_eq!(answers("sphere ball { radius 2 }\nball\n"), "an object\n");
}

#[test]
fn a_name_may_be_given_again_and_what_used_the_old_one_keeps_it() {
    assert_eq!(answers("let a = 1\nfn f() = a\nlet a = 2\n[f(), a]\n"), "[1, 2]\n");
}

#[test]
fn every_expression_is_answered_and_nothing_else() {
    assert_eq!(answers("let a = 5\na -3\na\n-a\n(a)\n<1, a>\n\"{a}!\"\n"), "2\n5\n-5\n5\n<1, 5>\n\"5!\"\n");
    assert_eq!(answers("1; 2\nfor i in 0..3 { i * i }\nif true { 7 } else { 8 }\n"), "1\n2\n0\n1\n4\n7\n");
    assert_eq!(
        answers("material { diffuse 1 }\nmaterial clay { diffuse 1 }\n[]\n\n// nothing\n"),
        "a material\n[]\n"
    );
}

#[test]
fn what_prints_says_so_to_the_person_and_is_not_answered() {
    let run = repl("print(1, 2)\n").expect(0);
    assert_eq!((run.out(), &*run.stderr), ("", "1 2\n"));
}

#[test]
fn what_is_open_goes_on_in_the_next_line() {
    let lines = "fn f(a) {\n  let b = a\n\n  return b * 2\n}\nf(\n3)\n1 +\n2\n/* no\n*/ 4\n";
    assert_eq!(answers(lines), "6\n3\n4\n");
}

#[test]
fn a_line_that_fails_changes_nothing() {
    let setup = "var n = 1\nlet counter = () => n\n";
    for failing in ["n = 2; 1 / 0", "n = 2; nope", "n = 2; (", "let n = 3; 1 / 0", "n = 2\u{1}"] {
        let run = repl(&format!("{setup}{failing}\n\n:names\nn\n")).expect(1);
        let expected = "counter\nn\n1\n";
        // A bracket that stays open takes the rest of the input along.
        assert_eq!(run.out(), if failing.ends_with('(') { "" } else { expected }, "{failing}");
    }
}

#[test]
fn variables_that_closures_share_are_taken_back_too() {
    let make = "fn make() {\n  var n = 0\n  fn next() { n = n + 1  return n }\n  return next\n}\n";
    let run = repl(&format!("{make}let next = make()\nnext()\n[next(), next(), 1 / 0]\nnext()\n")).expect(1);
    assert_eq!(run.out(), "1\n2\n");
}

#[test]
fn objects_of_a_line_that_fails_are_not_placed() {
    let run = repl("sphere { }; 1 / 0\nsphere { radius 2 }\n:scene\n").expect(1);
    assert_eq!(run.out(), "an object\nsphere  center <0, 0, 0>  radius 2  # 2:1\n");
}

#[test]
fn faults_are_told_at_their_line_of_the_input() {
    let run = repl("let a = 1\n\n[a,\n  b]\n").expect(1);
    assert!(run.stderr.contains("[<repl>:4:3]") && run.stderr.contains(" 4 │   b]"), "{}", run.stderr);
    let run = repl("fn f(x) = 1 / x\n\nf(0)\n").expect(1);
    assert!(run.stderr.contains("[<repl>:1:11]") && run.stderr.contains("<repl>:3:1"), "{}", run.stderr);
}

#[test]
fn the_names_of_a_file_are_in_scope() {
    let folder = Folder::with(&[
        ("a.scene", "let side = 3\nimport \"b.scene\" as b\nsphere { radius side }\n"),
        ("b.scene", "fn twice(x) = 2 * x\n"),
    ]);
    let run = folder.ogee_fed("repl a.scene", "b.twice(side)\n:scene\n").expect(0);
    assert_eq!(run.out(), "6\nsphere  center <0, 0, 0>  radius 3  # 3:1\n");
    let run = folder.ogee_fed("repl a.scene --set side=4", "side\n").expect(0);
    assert_eq!(run.out(), "4\n");
    folder.ogee("repl --set side=4").expect(2);
    folder.ogee("repl none.scene").expect(3);
}

#[test]
fn files_are_imported_once_and_loaded_anew() {
    let folder = Folder::with(&[("a.scene", "let a = 1\nsphere { radius a }\n")]);
    let lines = "import \"a.scene\"\nimport \"a.scene\"\na\n:scene\n";
    assert_eq!(
        folder.ogee_fed("repl", lines).expect(0).out(),
        "1\nsphere  center <0, 0, 0>  radius 1  # 2:1\n"
    );
    let run = folder.ogee_fed("repl", "import \"a.scene\" as t\nt.a\nimport \"a.scene\"\na\n").expect(0);
    assert_eq!(run.out(), "1\n1\n");
    let lines = ":load a.scene\nlet b = 2\n:reload\n:names\n:scene\n";
    let run = folder.ogee_fed("repl", lines).expect(0);
    assert_eq!(run.out(), "a\nsphere  center <0, 0, 0>  radius 1  # 2:1\n");
}

#[test]
fn a_file_that_fails_to_load_changes_nothing() {
    let folder = Folder::with(&[("bad.scene", "let a = 1\nsphere { }\nlet b = 1 / 0\n")]);
    let run = folder
        .ogee_fed("repl bad.scene", ":load bad.scene\nimport \"bad.scene\"\n:names\n:scene\n")
        .expect(1);
    assert_eq!(run.out(), "");
    assert_eq!(run.stderr.matches("bad.scene:3:9").count(), 3, "{}", run.stderr);
}

#[test]
fn orders_tell_what_they_are_asked() {
    let lines = "fn f(a, b = 2) = a\n:type f\n:type sqrt\n:type [1, 2]\n:type <1, 2>\n:type 1 +\n";
    let run = repl(lines).expect(1);
    assert_eq!(
        run.out(),
        "a function of (a, b = …)\nthe function sqrt(x)\na list of 2 numbers\na 2-vector\n"
    );
    let page = Folder::new().ogee("docs sphere").expect(0);
    assert_eq!(repl(":help sphere\n").expect(0).stdout, page.stdout);
    assert!(repl(":help\n").expect(0).out().contains(":reload "));
    assert!(repl("var n = 1\n:type n\n:time n + 1\n").expect(0).out() == "a number\n2\n");
}

#[test]
fn slips_are_answered_with_the_nearest() {
    for (line, told) in [
        (":relaod", "did you mean `:reload`?"),
        (":help sphre", "did you mean `sphere`?"),
        (":xyzzy", "`:help` lists the orders"),
        (":load", "write `:load FILE`"),
        (":quit now", "`:quit` stands alone"),
        ("exit", "`:quit`"),
    ] {
        let run = repl(&format!("{line}\n")).expect(1);
        assert!(run.stderr.contains(told), "{line}: {}", run.stderr);
    }
    assert_eq!(repl(":quit\n1\n").expect(0).out(), "");
}

/// A block of a page that begins with `$ ogee repl`: numbered prompts with what follows each, as a terminal shows it.
fn transcripts(page: &str) -> Vec<(String, String)> {
    let blocks = page.split("```console\n$ ogee repl\n").skip(1);
    let block = |text: &str| {
        let (mut typed, mut shown, mut open) = (String::new(), String::new(), false);
        for line in text.split("```").next().unwrap_or_default().lines() {
            let after_prompt = line.split_once("> ").filter(|(n, _)| n.parse::<usize>().is_ok());
            let to = match after_prompt {
                None if !open => &mut shown,
                _ => &mut typed,
            };
            let first = to.len();
            to.push_str(after_prompt.map_or(line, |(_, line)| line));
            to.push('\n');
            if after_prompt.is_some() || open {
                let start = if open { 0 } else { first };
                open = ogee::syntax::unfinished::is_unfinished(typed[start..].trim_end());
            }
        }
        (typed, shown)
    };
    blocks.map(block).collect()
}

#[test]
fn the_transcripts_of_the_page_are_what_happens() {
    let found = transcripts(include_str!("../../docs/repl.md"));
    assert!(!found.is_empty());
    let folder = Folder::new();
    for (typed, shown) in found {
        std::fs::write(folder.path().join("lines"), &typed).unwrap();
        let run = folder.sh("$OGEE repl < lines 2>&1");
        assert_eq!(run.out(), shown, "{typed}");
    }
}

#[test]
fn functions_and_curves_are_plotted_in_characters() {
    let run = repl(":plot x => sin(x), 0, 6.28\n").expect(0);
    let lines: Vec<&str> = run.out().lines().collect();
    assert_eq!(lines.len(), 20);
    assert!(lines[0].contains("x => sin(x), 0, 6.28") && lines.iter().all(|l| l.chars().count() <= 72));
    assert!(run.out().contains("-1.0") && run.out().contains("0.5"), "{}", run.out());
    let path = "spline path { bezier <0, 0>, <0, 1>, <1, 1>, <1, 0> }\n";
    for asked in ["path", "path comb polygon blossom 0.5", "path, 0.2, 0.8", "t => path(t), 0, 1"] {
        let run = repl(&format!("{path}:plot {asked}\n")).expect(0);
        assert!(run.out().chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)), "{asked}");
    }
    let run = repl("spline s { natural <0, 0, 0>, <1, 2, 1>, <3, 1, 5> }\n:plot s\n").expect(0);
    assert!(run.out().contains("z, seen along -x") || run.out().contains("seen along -"), "{}", run.out());
}

#[test]
fn plots_go_to_files_as_svg_and_png() {
    let folder = Folder::new();
    let lines = "spline path { bezier <0, 0>, <0, 1>, <1, 1>, <1, 0> }\n\
                 :plot path comb polygon blossom 0.25 --to a.svg\n\
                 :plot x => 1 / x, -2, 2 --to \"b c.png\"\n\
                 material clay { diffuse <0.8, 0.3, 0.2>  specular 0.3  exponent 30 }\n\
                 :plot brdf clay --to c.svg\n";
    assert_eq!(folder.ogee_fed("repl", lines).expect(0).out(), "");
    assert_eq!(folder.names(), ["a.svg", "b c.png", "c.svg"]);
    insta::assert_snapshot!("plot_of_a_curve", String::from_utf8(folder.read("a.svg")).unwrap());
    let picture = image::load_from_memory(&folder.read("b c.png")).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (720, 480));
    assert!(picture.pixels().any(|p| p.0 == [0x44, 0x77, 0xaa]));
    assert!(String::from_utf8(folder.read("c.svg")).unwrap().contains("brdf clay"));
}

#[test]
fn numbers_of_every_size_are_plotted() {
    for (asked, told) in [
        ("x => 1e308 * x", "1e308"),
        ("x => x, -1.7e308, 1.7e308", "1e308"),
        ("x => x, 0, 5e-324", "5e-324"),
        ("x => <x, 1e308>, -1e308, 1e308", "1e308"),
        ("x => x < 0 ? inf : x", "4"),
        ("x => x, 1e15, 1e15 + 1", "+1e15"),
    ] {
        let run = repl(&format!(":plot {asked}\n")).expect(0);
        assert!(run.out().contains(told) && run.out().lines().count() == 20, "{asked}: {}", run.out());
        let inked = run.out().chars().filter(|c| ('\u{2801}'..='\u{28ff}').contains(c)).count();
        assert!(inked > 100, "{asked}: {}", run.out());
    }
}

#[test]
fn a_line_that_is_no_text_is_told_and_the_next_is_read() {
    let run = Folder::new().sh(r"printf '1\n2 + \3773\n(4\n\300)\n5\n1 / 0\n' | $OGEE repl").expect(1);
    assert_eq!(run.out(), "1\n5\n");
    for told in
        ["error[E0010]: line 2 is not UTF-8 text: what stands at column 5", "line 4 is not", "[<repl>:6:1]"]
    {
        assert!(run.stderr.contains(told), "{told}: {}", run.stderr);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_figure_that_does_not_fit_the_disk_is_told_and_the_next_line_is_read() {
    let folder = Folder::new();
    std::fs::write(folder.path().join("lines"), ":plot sin --to a.svg\n2 + 3\n").unwrap();
    let run = folder.sh("trap '' XFSZ; ulimit -f 1; $OGEE repl < lines").expect(1);
    assert_eq!(run.out(), "5\n");
    assert!(run.stderr.contains("cannot write a.svg"), "{}", run.stderr);
}

#[test]
fn what_cannot_be_plotted_is_told_at_its_place_and_changes_nothing() {
    for (asked, told) in [
        ("3", "a function or a curve can be plotted"),
        ("x => sin(x), 0", "a range is two numbers"),
        ("x => sin(x), 1, 0", "from a smaller to a larger"),
        ("x => inf", " 2 │ :plot x => inf \n   ·       ────────\n"),
        ("x => x]", " 2 │ :plot x => x] \n   ·             ─\n"),
        ("x => (x", " 2 │ :plot x => (x"),
        ("\"a]b\"", " 2 │ :plot \"a]b\" \n   ·       ─────\n"),
        ("x => sin(x), 0, inf", "between finite numbers"),
        ("x => inf", "none of its values here is finite"),
        ("x => sin(x) comb", "want a curve"),
        ("x => sqrt(-1 - x^2)", "<repl>:2:17"),
        ("x => nope", "`nope` is not defined"),
        ("brdf 3", "`brdf` wants a material"),
        ("sin --to a.gif", "figures are .svg or .png"),
        ("sin --to none/a.svg", "there is no folder none"),
        ("sin blossom x", "`blossom` wants a number"),
    ] {
        let run = repl(&format!("var n = 1\n:plot {asked}\nn\n")).expect(1);
        assert!(run.stderr.contains(told), "{asked}: {}", run.stderr);
        assert_eq!(run.out(), "1\n", "{asked}");
    }
}
