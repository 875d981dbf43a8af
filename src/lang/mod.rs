//! From a syntax tree to a scene: names are resolved to slots ([`resolve`]), values computed ([`eval`]), blocks built by
//! the tables of kinds ([`kinds`]) and of functions ([`builtins`]), functions that run while rendering compiled
//! ([`compile`]).
//!
//! The evaluator knows no kind and no builtin by name: it looks both up in their tables, and so do the diagnostics, the
//! reference page and completion. This module reads files only through [`crate::scene::assets::Loader`].

pub mod builtins;
pub mod check;
pub mod coerce;
pub mod compile;
pub mod complete;
pub mod display;
pub mod eval;
pub mod kinds;
pub mod limits;
pub mod members;
#[cfg(test)]
mod mock;
mod range;
pub mod reference;
pub mod resolve;
pub mod table;
pub mod value;
