//! Text to syntax tree and back: [`parse`] reads a file with the grammar in `grammar/ogee.pest`, [`format`] lays it out
//! again. This module knows no kind's properties and no builtin's name; it knows only which words are kinds.

pub mod ast;
pub mod build;
pub mod format;
