//! A line for each diagnostic, as editors and compilers write them: `file:line:column: error[E0101]: message`.

use super::{Diagnostic, harmless, severity_word, shortened};
use crate::diag::SourceMap;
use std::fmt::Write as _;

/// One line each, in the order given. A fault of no place has no file in front.
pub fn short(diagnostics: &[Diagnostic], sources: &SourceMap) -> String {
    let mut text = String::new();
    for diagnostic in diagnostics.iter().map(shortened) {
        let place = diagnostic.span.map_or(String::new(), |span| format!("{}: ", sources.place(span)));
        let message = harmless(&diagnostic.message).replace('\n', " ");
        let (severity, code) = (severity_word(diagnostic.severity), diagnostic.code.text());
        writeln!(text, "{place}{severity}[{code}]: {message}").expect("writing to a string cannot fail");
    }
    text
}
