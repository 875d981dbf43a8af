//! Text to syntax tree and back: [`build`] reads a file with the grammar in `grammar/ogee.pest`, [`mod@format`] lays it out
//! again, [`print`](mod@print) shows the tree. This module knows no kind's properties and no builtin's name; it knows
//! only which words are kinds.

pub mod ast;
pub mod build;
pub mod format;
pub mod print;
pub mod unfinished;
