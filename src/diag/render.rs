//! Diagnostics as text: for people ([`human`]), one line each ([`short()`]), and for programs ([`json()`], JSON lines).
//!
//! Nothing here prints, or asks what the output is: [`Style`] says it.

mod excerpt;
mod human;
mod json;
mod short;

pub use human::{Style, human};
pub use json::{SCHEMA, json};
pub use short::short;

use super::{Diagnostic, Severity};

/// How many of each severity there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Counts {
    /// Errors.
    pub errors: usize,
    /// Warnings.
    pub warnings: usize,
}

impl Counts {
    /// Counts them.
    pub fn of(diagnostics: &[Diagnostic]) -> Self {
        let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
        Counts { errors, warnings: diagnostics.len() - errors }
    }
}

impl std::fmt::Display for Counts {
    /// "2 errors, 1 warning", "1 error", "no errors".
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let many = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
        match (self.errors, self.warnings) {
            (0, 0) => f.write_str("no errors"),
            (0, w) => f.write_str(&many(w, "warning")),
            (e, 0) => f.write_str(&many(e, "error")),
            (e, w) => write!(f, "{}, {}", many(e, "error"), many(w, "warning")),
        }
    }
}

/// The word of a severity: "error", "warning".
fn severity_word(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    }
}

/// The text with every control character that a terminal would act on replaced: a scene is somebody else's text.
fn harmless(text: &str) -> std::borrow::Cow<'_, str> {
    let acts = |c: char| c.is_control() && c != '\n' && c != '\t';
    if text.contains(acts) { text.replace(acts, "\u{fffd}").into() } else { text.into() }
}

/// For people: words that nobody reads to their end lose their middle.
fn shortened(diagnostic: &Diagnostic) -> Diagnostic {
    let mut short = diagnostic.clone();
    let of_labels = short.labels.iter_mut().map(|label| &mut label.text);
    let texts = [&mut short.message, &mut short.label].into_iter().chain(of_labels).chain(&mut short.hints);
    texts.chain(short.trace.iter_mut().map(|frame| &mut frame.text)).for_each(|text| {
        if text.split_whitespace().any(|word| word.len() > LONGEST_WORD) {
            *text = text.split_inclusive(char::is_whitespace).map(without_middle).collect();
        }
    });
    short
}

/// Bytes of a word that is shown whole: any name or path that is meant to be read has fewer.
const LONGEST_WORD: usize = 256;

fn without_middle(word: &str) -> std::borrow::Cow<'_, str> {
    const ENDS: [usize; 2] = [60, 20];
    let n = word.chars().count();
    if word.len() <= LONGEST_WORD || n <= ENDS[0] + ENDS[1] {
        return word.into();
    }
    let start: String = word.chars().take(ENDS[0]).collect();
    let end: String = word.chars().skip(n - ENDS[1]).collect();
    format!("{start}…{end}").into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{Code, SourceMap, Span};

    #[test]
    fn words_without_end_lose_their_middle() {
        let name = "n".repeat(100_000);
        let mut sources = SourceMap::default();
        let file = sources.add("a.scene", format!("let a = {name}\n"));
        let fault = Diagnostic::new(
            Code::UnknownName,
            Span::new(file, 8, 100_008),
            format!("`{name}` is not defined"),
        )
        .label(format!("no `{name}`"))
        .hint(format!("leave out `{name}`, or define it"));
        for text in [human(&[fault.clone()], &sources, Style::plain(100)), short(&[fault.clone()], &sources)]
        {
            assert!(text.len() < 2500 && text.contains("nnn…nnn"), "{text}");
            assert!(text.contains("is not defined"), "{text}");
        }
        let path = format!("/{}/a.obj", "folder/".repeat(20));
        let whole = Diagnostic::new(Code::FileNotFound, None, format!("`{path}` cannot be read"));
        assert!(short(&[whole], &sources).contains(&path));
    }

    pub(super) fn sample() -> (SourceMap, Vec<Diagnostic>) {
        let mut sources = SourceMap::default();
        let main = sources.add("main.scene", "let a = 1\nsphere { radius raduis }\n");
        let other = sources.add("other.scene", "// é\nlet radius = 2\n");
        let fault = Diagnostic::new(Code::UnknownName, Span::new(main, 26, 32), "`raduis` is not defined")
            .label("no such name")
            .also(Span::new(main, 4, 5), "this is near")
            .also(Span::new(other, 10, 16), "defined here")
            .hint("did you mean `radius`?")
            .trace(vec![crate::diag::Frame { span: Span::new(main, 10, 16), text: "ball(1)".into() }]);
        let whole = Diagnostic::new(Code::NoLight, None, "nothing lights the scene");
        (sources, vec![fault, whole])
    }

    #[test]
    fn one_of_a_kind_takes_no_plural() {
        assert_eq!(Counts { errors: 1, warnings: 2 }.to_string(), "1 error, 2 warnings");
        assert_eq!(Counts { errors: 0, warnings: 1 }.to_string(), "1 warning");
        assert_eq!(Counts::default().to_string(), "no errors");
    }

    #[test]
    fn short_lines_name_file_line_and_column() {
        let (sources, found) = sample();
        assert_eq!(
            short(&found, &sources),
            "main.scene:2:17: error[E0101]: `raduis` is not defined\n\
             warning[W0602]: nothing lights the scene\n"
        );
    }

    #[test]
    fn json_lines_hold_the_promised_keys_and_end_in_a_summary() {
        let (sources, found) = sample();
        let text = json(&found, &sources);
        let lines: Vec<serde_json::Value> =
            text.lines().map(|l| serde_json::from_str(l).expect("each line is JSON")).collect();
        assert_eq!(lines.len(), 3);
        let keys = |v: &serde_json::Value| v.as_object().map(|o| o.keys().cloned().collect::<Vec<_>>());
        let promised = ["schema", "severity", "code", "message", "file", "span", "labels", "hints", "trace"];
        assert_eq!(keys(&lines[0]).expect("an object"), promised);
        assert_eq!(
            lines[0]["span"].to_string(),
            r#"{"start":26,"end":32,"line":2,"column":17,"end_line":2,"end_column":23}"#
        );
        assert!(lines[1]["file"].is_null() && lines[1]["span"].is_null());
        assert_eq!(lines[2].to_string(), r#"{"summary":{"errors":1,"warnings":1}}"#);
    }

    #[test]
    fn the_human_form_shows_the_place_the_other_file_the_hint_and_the_trace() {
        let (sources, found) = sample();
        let text = human(&found, &sources, Style::plain(80));
        for part in [
            "error[E0101]",
            "main.scene:2:17",
            "no such name",
            "this is near",
            "other.scene:2:5",
            "defined here",
            "did you mean `radius`?",
            "in ball(1), at main.scene:2:1",
            "warning[W0602]",
        ] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
        assert!(!text.contains('\u{1b}'));
    }

    #[test]
    fn a_line_without_end_is_clipped_around_its_fault() {
        let mut sources = SourceMap::default();
        let text = format!("{}@{}", "1 ".repeat(500_000), " 2".repeat(500_000));
        let id = sources.add("long.scene", text);
        let fault = Diagnostic::new(Code::Syntax, Span::new(id, 1_000_000, 1_000_001), "no")
            .also(Span::new(id, 0, 1), "and far away");
        let text = human(&[fault], &sources, Style::plain(80));
        assert!(text.len() < 5_000 && text.contains("long.scene:1:1000001"), "{} bytes", text.len());
        assert!(text.contains("and far away"), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    }

    #[test]
    fn more_than_twenty_are_counted_and_not_shown() {
        let mut sources = SourceMap::default();
        let id = sources.add("many.scene", "x ".repeat(30));
        let found: Vec<_> = (0..30)
            .map(|i| Diagnostic::new(Code::UnknownName, Span::new(id, 2 * i, 2 * i + 1), format!("no {i}")))
            .collect();
        let text = human(&found, &sources, Style::plain(80));
        assert!(text.contains("no 19") && !text.contains("no 20"), "{text}");
        assert!(text.contains("10 more"), "{text}");
    }

    #[test]
    fn a_fault_at_the_end_of_the_text_or_of_an_empty_one_is_still_placed() {
        let mut sources = SourceMap::default();
        let ends = sources.add("ends.scene", "sphere {\n\n");
        let empty = sources.add("empty.scene", "");
        let at_end =
            Diagnostic::new(Code::Unclosed, Span::new(ends, 10, 10), "not closed").label("ends here");
        let text = human(&[at_end], &sources, Style::plain(80));
        assert!(text.contains("ends here"), "{text}");
        let nothing = Diagnostic::new(Code::Syntax, Span::new(empty, 0, 0), "empty");
        assert!(human(&[nothing], &sources, Style::plain(80)).contains("empty.scene"));
    }

    #[test]
    fn a_scene_cannot_speak_to_the_terminal() {
        let mut sources = SourceMap::default();
        let id = sources.add("esc.scene", "let a = \u{1b}[2J\u{7} b\n");
        let fault = Diagnostic::new(Code::Syntax, Span::new(id, 8, 9), "found \u{1b}[2J");
        let plain = human(std::slice::from_ref(&fault), &sources, Style::plain(80));
        assert!(!plain.contains('\u{1b}') && !plain.contains('\u{7}'));
        let coloured = human(std::slice::from_ref(&fault), &sources, Style { colour: true, width: 80 });
        assert!(!coloured.contains("\u{1b}[2J"));
        assert!(!short(&[fault], &sources).contains('\u{1b}'));
    }

    #[test]
    fn any_place_in_any_text_can_be_shown() {
        const PIECES: [&str; 9] =
            ["sphere {", "\n", "\r\n", "é", "\t", "\u{1b}[31m", "漢字", "x = 1 ", "// a long comment "];
        let mut state = 7_u64;
        let mut next = |n: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % n
        };
        for turn in 0..2_000 {
            let text: String = (0..next(120)).map(|_| PIECES[next(PIECES.len())]).collect();
            let mut sources = SourceMap::default();
            let id = sources.add("any.scene", text.as_str());
            let mut place = || {
                let (a, b) = (next(text.len() + 1), next(text.len() + 1));
                Span::new(id, a.min(b), a.max(b))
            };
            let fault = Diagnostic::new(Code::Syntax, place(), format!("turn {turn}"))
                .label("here")
                .also(place(), "there")
                .also(place(), "and there");
            let found = [fault];
            assert!(human(&found, &sources, Style::plain(60)).contains("any.scene") || text.is_empty());
            human(&found, &sources, Style { colour: true, width: 0 });
            assert!(
                json(&found, &sources).lines().count() == 2 && short(&found, &sources).lines().count() == 1
            );
        }
    }
}
