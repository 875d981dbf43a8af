//! The tree as text, for `ogee ast` and its snapshots.

use super::ast;

/// The tree of a file.
pub fn print(file: &ast::File) -> String {
    format!("{file:#?}")
}
