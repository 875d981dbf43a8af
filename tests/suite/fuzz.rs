//! Garbage in, words out: mutated examples, deep nesting and huge numbers must never panic, hang or eat the machine.
//! Short by default; `OGEE_FUZZ_SECONDS=600` runs the long form. Every case is made from its seed alone, which a failure prints.

use ogee::scene::{Node, RenderSettings, Scene, Shape};
use ogee::session::picture::{self, Job};
use ogee::session::{Limits, Options, Session};
use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// SplitMix64: enough to choose mutations by.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    fn pick<'a, T: ?Sized>(&mut self, from: &[&'a T]) -> &'a T {
        from[self.below(from.len())]
    }
}

/// Pieces that have broken parsers before.
const PIECES: &[&str] = &[
    "{",
    "}",
    "(",
    ")",
    "[",
    "]",
    "<",
    ">",
    ",",
    ";",
    "..",
    "..=",
    "=>",
    "=",
    "==",
    "\"",
    "\"{",
    "}\"",
    "/*",
    "*/",
    "//",
    "\\u{110000}",
    "#",
    "#ggg",
    "#cc3311",
    "1e999",
    "-1e308",
    "1e-320",
    "0/0",
    "99999999999999999999",
    ".",
    "..5",
    "0x",
    "é",
    "\u{0}",
    "\r",
    "\t",
    "inf",
    "-",
    "^",
    "with",
    "with {",
    "fn f(a) = f(a)\nf(1)",
    "while true {",
    "for i in 0..1e18 {",
    "if",
    "else",
    "let",
    "let x = x",
    "var",
    "return",
    "import \"a.scene\"",
    "step 0",
    "step -1",
    "sphere {",
    "group {",
    "material {",
    "camera {",
    "[i for i in 0..1e12]",
    "p => p",
    "(u, v) => u",
    "checker(checker(1, 0), 1)",
    "joint j {",
    "skin {",
    "a.b.c.d",
    "x[0][0]",
    "f(f(f(",
    "radius",
    "mesh { file \"/dev/zero\" }",
    "translate",
    "rotate <",
    "scale 0",
    "matrix 1, 2, 3",
    "trace(",
    "roots(",
    "range(0, 1e18)",
    "linspace(0, 1, 1e15)",
    "str(",
    "assert(false)",
];

fn corpus() -> Vec<String> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut texts: Vec<String> = std::fs::read_dir(folder)
        .expect("the examples")
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "scene"))
        .map(|path| std::fs::read_to_string(path).expect("a readable example"))
        .collect();
    texts.sort();
    texts
}

fn char_floor(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// One to eight mutations of an example.
fn mutated(corpus: &[String], random: &mut Random) -> String {
    let mut text = corpus[random.below(corpus.len())].clone();
    for _ in 0..=random.below(8) {
        let a = char_floor(&text, random.below(text.len() + 1));
        let b = char_floor(&text, (a + random.below(60)).min(text.len()));
        match random.below(7) {
            0 => text.replace_range(a..b, ""),
            1 => text.insert_str(a, random.pick(PIECES)),
            2 => text.replace_range(a..b, random.pick(PIECES)),
            3 => {
                let again = text[a..b].to_owned();
                text.insert_str(b, &again);
            }
            4 => {
                let other = &corpus[random.below(corpus.len())];
                let from = char_floor(other, random.below(other.len() + 1));
                let to = char_floor(other, (from + random.below(200)).min(other.len()));
                text.insert_str(a, &other[from..to]);
            }
            5 => text.insert_str(a, &random.pick(PIECES).repeat(1 + random.below(3000))),
            _ => text.truncate(b),
        }
    }
    text
}

/// Numbers that have broken renderers before.
const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "0.5",
    "2",
    "7",
    "1e9",
    "-1e9",
    "1e18",
    "1e300",
    "1e-300",
    "1e160",
    "5e-324",
    "0.1",
    "1000000",
    "1e5",
    "45",
    "180",
    "360",
    "inf",
    "(1 / 3)",
    "<1, 2, 3>",
    "<0, 0, 0>",
    "<1e200, 1, -1e200>",
    "[1, 2]",
    "\"a\"",
    "true",
];

/// Statements that work hard, or grow.
const STATEMENTS: &[&str] = &[
    "while true { }",
    "for i in 0..1e9 { }",
    "for i in 0..1e5 { sphere { radius i + 1 } }",
    "fn again(n) = again(n + 1) + again(n + 2)\nlet a9 = again(0)",
    "fn nest(n) { group { nest(n + 1) } }\nnest(0)",
    "var l9 = [1]\nwhile true { l9 = [l9, l9] }",
    "var m9 = [1]\nfor i in 0..60 { m9 = [m9, m9] }\nlet b9 = str(m9)",
    "var s9 = \"a\"\nwhile true { s9 = \"{s9}{s9}\" }",
    "let c9 = map(0..1e5, i => sum(0..1e5))",
    "let d9 = [fbm(<i, 2, 3>, 9) for i in 0..1e9]",
    "var p9 = checker(0, 1)\nfor i in 0..1e5 { p9 = gradient(p9, p9) }\nsphere { material { diffuse p9 } }",
    "var g9 = sphere { }\nfor i in 0..1e5 { g9 = g9 with { translate x  rotate y, 1 } }\ng9",
    "var g9 = sphere { }\nfor i in 0..40 { let h = g9  g9 = group { h; h; h } }\ng9",
    "var u9 = sphere { }\nfor i in 0..40 { let h = u9  u9 = union { h; h } }\nu9",
    "var e9 = plane { material { emit 1 } }\nfor i in 0..30 { let h = e9  e9 = group { h; h } }\ne9",
    "fn slow(p) { var s = 0\n for i in 0..1e9 { s = s + i }\n return s }\nsphere { material { diffuse p => slow(p) } }",
    "sphere { material { diffuse p => sqrt(p.x) / p.y  bump p => 1 / p.z } }",
    "sphere { radius 1e300 }",
    "sphere { scale <1e-300, 1e300, 1> }",
    "torus { radii 1, 1e-9 }",
    "mesh { vertices <0, 0, 0>, <1, 0, 0>, <0, 1, 0>  faces <0, 1, 2>, <2, 1, 0>, <0, 0, 1> }",
    "cone { from <0, 0, 0>  to <0, 1e-300, 0>  radii 1, 0 }",
];

/// The words, numbers and signs of a text, and what stands between them.
fn tokens(text: &str) -> Vec<String> {
    let sort = |c: char| match c {
        c if c.is_alphanumeric() || matches!(c, '_' | '.') => 0,
        c if c.is_whitespace() => 1,
        _ => 2,
    };
    let mut found: Vec<String> = Vec::new();
    for c in text.chars() {
        match found.last_mut() {
            Some(last) if sort(c) < 2 && last.chars().all(|l| sort(l) == sort(c)) => last.push(c),
            _ => found.push(c.into()),
        }
    }
    found
}

/// An example with one to eight words, numbers and signs changed for others of their sort, and sometimes a statement that
/// works hard: most such texts can be read, and so are evaluated and drawn.
fn altered(corpus: &[String], random: &mut Random) -> String {
    let mut own = tokens(&corpus[random.below(corpus.len())]);
    let others = tokens(&corpus[random.below(corpus.len())]);
    for _ in 0..=random.below(8) {
        let at = random.below(own.len());
        let first = own[at].chars().next().unwrap_or(' ');
        let replacement = match first {
            '0'..='9' | '.' => random.pick(NUMBERS).to_owned(),
            '+' | '-' | '*' | '/' | '^' => random.pick(&["+", "-", "*", "/", "^", "%", "=="]).to_owned(),
            c if c.is_alphabetic() => {
                let words: Vec<&String> =
                    others.iter().filter(|t| t.starts_with(char::is_alphabetic)).collect();
                words[random.below(words.len())].clone()
            }
            _ => continue,
        };
        own[at] = replacement;
    }
    if random.below(4) == 0 {
        let lines: Vec<usize> = (0..own.len()).filter(|i| own[*i].contains('\n')).collect();
        let at = lines[random.below(lines.len())];
        own[at] = format!("\n{}\n", random.pick(STATEMENTS));
    }
    own.concat()
}

/// Limits that make a hang a fault of ours and not of the scene.
fn tight() -> Options {
    let limits = Limits { turns: 100_000, list: 100_000, calls: 500, memory: 256 << 20, ..Limits::default() };
    Options { limits, ..Options::default() }
}

/// Reads nothing: what a mutation names must not be opened.
struct NoFiles;

impl ogee::scene::assets::Loader for NoFiles {
    fn read(&self, _: &std::path::Path) -> std::io::Result<Vec<u8>> {
        Err(std::io::ErrorKind::NotFound.into())
    }

    fn exists(&self, _: &std::path::Path) -> bool {
        false
    }
}

/// Whether a scene is small enough to be drawn here: few things, few samples of lights.
fn is_small(nodes: &[Node], left: &mut u32) -> bool {
    nodes.iter().all(|node| {
        let costs = match node {
            Node::Light(light) => light.samples.saturating_add(1),
            Node::Object(_) => 1,
        };
        *left = left.saturating_sub(costs);
        let inside = match node {
            Node::Object(object) => match &object.shape {
                Shape::Group(children) => is_small(children, left),
                _ => true,
            },
            Node::Light(_) => true,
        };
        *left > 0 && inside
    })
}

/// A picture of a few pixels, where the scene can be seen.
fn draw(scene: Scene) {
    if !is_small(&scene.nodes, &mut 2000) {
        return;
    }
    let overrides =
        RenderSettings { size: Some([4, 3]), samples: Some(1), depth: Some(4), ..RenderSettings::default() };
    let job = Job { overrides, threads: Some(1), ..Job::default() };
    let Ok(settings) = picture::settings(&scene, &job) else { return };
    if let (Some(prepared), _) = picture::prepare(scene, &job, settings, &NoFiles) {
        let film = prepared.render(&(), &AtomicBool::new(false));
        assert!(film.is_complete() && film.pixels.iter().all(|p| p.is_finite()));
        let _ = picture::faults(&film);
    }
}

/// Parses, evaluates, formats and draws a text, and words every diagnostic.
fn exercise(text: &str) {
    let mut session = Session::new(tight(), Arc::new(NoFiles));
    let evaluated = session.evaluate_text("fuzz.scene", text);
    for diagnostic in &evaluated.diagnostics {
        if let Some(span) = diagnostic.span {
            let _ = session.sources.snippet(span);
        }
    }
    let _ = ogee::diag::render::human(
        &evaluated.diagnostics,
        &session.sources,
        ogee::diag::render::Style::plain(100),
    );
    draw(evaluated.scene);
    if let Ok(laid_out) = ogee::syntax::format::format(text) {
        let again = ogee::syntax::format::format(&laid_out);
        assert_eq!(again.as_deref().ok(), Some(laid_out.as_str()), "formatting twice changes the text");
    }
}

fn peak_memory_mib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib >> 10)
}

/// How many mutations the short form tries: a number, so that no clock decides what is tested.
const SHORT_FORM: u64 = 250;

/// The longest that a mutation of a small scene may take, in a build without optimisation on a busy machine.
const PATIENCE: Duration = Duration::from_secs(20);

/// The most memory that the process may come to need, all tests in it together.
const MEMORY_MIB: u64 = 1024;

#[test]
fn fuzz_mutated_examples_never_panic_or_hang() {
    fuzz(mutated);
}

#[test]
fn fuzz_altered_examples_never_panic_or_hang() {
    fuzz(altered);
}

fn fuzz(make: impl Fn(&[String], &mut Random) -> String) {
    let number = |name: &str| -> Option<u64> { std::env::var(name).ok().and_then(|s| s.parse().ok()) };
    let seconds = number("OGEE_FUZZ_SECONDS");
    let first = number("OGEE_FUZZ_SEED").unwrap_or(1);
    let (start, corpus) = (Instant::now(), corpus());
    let mut seed = first;
    let mut slowest = (Duration::ZERO, first);
    let goes_on = |seed: u64| match seconds {
        Some(seconds) => start.elapsed() < Duration::from_secs(seconds),
        None => seed - first < SHORT_FORM,
    };
    while goes_on(seed) {
        let text = make(&corpus, &mut Random(seed));
        let began = Instant::now();
        let outcome = std::panic::catch_unwind(AssertUnwindSafe(|| exercise(&text)));
        assert!(outcome.is_ok(), "seed {seed} panics on:\n{text}");
        assert!(began.elapsed() < PATIENCE, "seed {seed} takes {:?} on:\n{text}", began.elapsed());
        let peak = peak_memory_mib();
        assert!(
            peak.is_none_or(|mib| mib < MEMORY_MIB),
            "by seed {seed} the process peaked at {peak:?} MiB, on:\n{text}"
        );
        slowest = slowest.max((began.elapsed(), seed));
        seed += 1;
    }
    let peak = peak_memory_mib();
    let (longest, slow) = slowest;
    println!(
        "{} mutations from seed {first}, peak memory {peak:?} MiB, longest {longest:.2?} (seed {slow})",
        seed - first
    );
    assert!(seed > first, "no mutation was tried");
}

#[test]
fn fuzz_programs_without_end_stop_at_their_guards() {
    for text in STATEMENTS {
        let began = Instant::now();
        let evaluated = Session::new(tight(), Arc::new(NoFiles)).evaluate_text("endless.scene", text);
        drop(evaluated);
        assert!(began.elapsed() < PATIENCE, "{:?} for:\n{text}", began.elapsed());
    }
}

#[test]
fn fuzz_a_hundred_thousand_open_brackets_are_an_error_and_no_crash() {
    for bracket in [
        "(",
        "[",
        "<",
        "{",
        "-",
        "!",
        "sphere {",
        "f(",
        "a[",
        "\"{",
        "/*",
        "p => ",
        "1 + (",
        "1 ? ",
        "if true {",
        "x ^ ",
    ] {
        let text = format!("let a = {}", bracket.repeat(100_000));
        let began = Instant::now();
        let found = Session::new(tight(), Arc::new(NoFiles)).evaluate_text("deep.scene", &text).diagnostics;
        assert!(
            found.iter().any(|d| d.severity == ogee::diag::Severity::Error),
            "nothing is said about 100000 × {bracket}"
        );
        assert!(began.elapsed() < PATIENCE, "100000 × {bracket} takes {:?}", began.elapsed());
    }
}

#[test]
fn fuzz_long_chains_are_read_or_refused_without_a_crash() {
    for link in
        [" + 1", " * 2", " && true", ".x", "[0]", "(0)", " == 1", " ? 1 : 1", " with { }", " ^ 1", ", 1"]
    {
        let text = format!("let a = 1{}\n", link.repeat(100_000));
        let began = Instant::now();
        let _ = Session::new(tight(), Arc::new(NoFiles)).evaluate_text("long.scene", &text);
        assert!(began.elapsed() < PATIENCE, "100000 × {link} takes {:?}", began.elapsed());
    }
}
