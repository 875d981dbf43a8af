//! Evaluation of resolved items.

/// A function value with what it captured.
#[derive(Debug)]
pub struct Closure {}

/// An imported file's names.
#[derive(Debug)]
pub struct Module {}
