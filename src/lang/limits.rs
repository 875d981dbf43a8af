//! Guards of reading and evaluation. Each names itself and its flag where it is met.

use crate::diag::{Code, Diagnostic, Span};

/// Guards; each names itself and its flag (`--limit NAME=N`) when it is met.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// How deeply brackets, braces and operators may nest (`nesting`).
    pub nesting: usize,
    /// How deeply calls may nest (`calls`).
    pub calls: usize,
    /// How many turns all loops of a run may take; each call counts as a turn, and each element that a function of lists goes
    /// through (`turns`).
    pub turns: u64,
    /// How many elements one list may have (`list`).
    pub list: usize,
    /// How many bytes a scene file may have (`file`).
    pub file: u64,
    /// How many bytes evaluation may allocate for values and objects, estimated (`memory`).
    pub memory: u64,
    /// How many shapes an object may stand for, those of groups in groups counted each time they are placed (`placements`).
    pub placements: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            nesting: 256,
            calls: 10_000,
            turns: 1_000_000_000,
            list: 50_000_000,
            file: 1 << 30,
            memory: 8 << 30,
            placements: 1_000_000_000_000,
        }
    }
}

impl Limits {
    /// The names that `--limit` takes.
    pub const NAMES: &[&str] = &["nesting", "calls", "turns", "list", "file", "memory", "placements"];

    /// Sets a guard by its name; false where none has it.
    pub fn set(&mut self, name: &str, value: u64) -> bool {
        let size = usize::try_from(value).unwrap_or(usize::MAX);
        match name {
            "nesting" => self.nesting = size,
            "calls" => self.calls = size,
            "turns" => self.turns = value,
            "list" => self.list = size,
            "file" => self.file = value,
            "memory" => self.memory = value,
            "placements" => self.placements = value,
            _ => return false,
        }
        true
    }
}

/// The error of a guard, with the flag that raises it.
pub fn exceeded(
    code: Code,
    span: impl Into<Option<Span>>,
    message: String,
    name: &str,
    limit: u64,
) -> Diagnostic {
    let raised = limit.saturating_mul(10);
    Diagnostic::new(code, span, message)
        .hint(format!("if this is meant, raise the guard: `--limit {name}={raised}` (it is {limit})"))
}
