//! stub
use crate::diag::{Diagnostic, SourceId};
pub(super) struct Repaired {
    pub text: String,
    pub insertions: Vec<u32>,
    pub found: Vec<Diagnostic>,
}
pub(super) fn repair(_source: SourceId, text: &str, _limit: usize) -> Repaired {
    Repaired { text: text.into(), insertions: vec![], found: vec![] }
}
