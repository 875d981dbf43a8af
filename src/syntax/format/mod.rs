//! The canonical layout of a file: `ogee fmt`. Keeps every comment and the syntax tree; idempotent.
//!
//! Tokens are printed as they were written; only the blanks between them are the formatter's. Where the person broke a
//! line between items or between the elements of a list, the break stays; blocks stay on one line where they were and
//! where they fit; what is too long is broken at items and commas.

mod layout;
mod tree;

use super::build::{ParseLimits, parse_file, places};
use super::print::print;
use crate::diag::{Diagnostic, SourceId, has_errors};

/// The widest line, in characters. Lines without a place to break may be wider.
pub const WIDTH: usize = 100;

/// The text in canonical layout, or what keeps it from being read. The source of the diagnostics' spans is `SourceId(0)`;
/// [`format_source`] takes another.
pub fn format(text: &str) -> Result<String, Vec<Diagnostic>> {
    format_source(SourceId(0), text, ParseLimits::default())
}

/// The text with each line ended by a line feed alone; none where that is so already. A carriage return that is part of a
/// text or a comment would be changed too: the caller sees that by the tree.
fn with_plain_line_ends(text: &str) -> Option<String> {
    text.contains('\r').then(|| text.replace("\r\n", "\n").replace('\r', "\n"))
}

/// The same, for a file of a source map.
pub fn format_source(source: SourceId, text: &str, limits: ParseLimits) -> Result<String, Vec<Diagnostic>> {
    let (tree, found) = parse_file(source, text, limits);
    if has_errors(&found) {
        return Err(found);
    }
    let shown = print(&tree);
    let reads_alike = |text: &str| {
        let (again, faults) = parse_file(source, text, limits);
        faults.is_empty() && print(&again) == shown
    };
    let unified = with_plain_line_ends(text).filter(|unified| reads_alike(unified));
    let plain = unified.as_deref().unwrap_or(text);
    let Some(places) = places(plain, limits) else { return Err(found) };
    let laid_out = layout::layout(plain, &places);
    let same = reads_alike(&laid_out);
    debug_assert!(same || plain.contains('\r'), "the layout changes the tree:\n{text}\n--- to\n{laid_out}");
    // A scene is worth more than its layout: what would change it is left as it is.
    Ok(if same { laid_out } else { text.to_owned() })
}
