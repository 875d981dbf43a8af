//! Garbage in, words out: mutated examples, deep nesting and huge numbers must never panic, hang or eat the machine.
//! Short by default; `OGEE_FUZZ_SECONDS=600` runs the long form. Every case is made from its seed alone, which a failure prints.

use ogee::session::{Limits, Options, Session};
use std::panic::AssertUnwindSafe;
use std::sync::Arc;
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

/// Parses, evaluates, formats, and words every diagnostic of a text.
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

#[test]
fn fuzz_mutated_examples_never_panic_or_hang() {
    let seconds: Option<u64> = std::env::var("OGEE_FUZZ_SECONDS").ok().and_then(|s| s.parse().ok());
    let (start, corpus) = (Instant::now(), corpus());
    let first: u64 = std::env::var("OGEE_FUZZ_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(1);
    let mut seed = first;
    let goes_on = |seed: u64| match seconds {
        Some(seconds) => start.elapsed() < Duration::from_secs(seconds),
        None => seed - first < SHORT_FORM,
    };
    while goes_on(seed) {
        let text = mutated(&corpus, &mut Random(seed));
        let began = Instant::now();
        let outcome = std::panic::catch_unwind(AssertUnwindSafe(|| exercise(&text)));
        assert!(outcome.is_ok(), "seed {seed} panics on:\n{text}");
        assert!(began.elapsed() < PATIENCE, "seed {seed} takes {:?} on:\n{text}", began.elapsed());
        seed += 1;
    }
    let peak = peak_memory_mib();
    println!("{} mutations from seed {first}, peak memory {peak:?} MiB", seed - first);
    assert!(seed > first, "no mutation was tried");
    assert!(peak.is_none_or(|mib| mib < 1024), "the process peaked at {peak:?} MiB");
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
