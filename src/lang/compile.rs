//! Functions of the scene to tapes.

use super::eval::slots::Slot;
use super::resolve::program::Program;
use super::value::Value;
use crate::diag::{Code, Diagnostic, Span};
use crate::scene::{SampleInput, SampledFunction};

/// Compiles a function value to run while rendering. An error is what to report; none was reported already.
pub fn compile(
    program: &Program,
    globals: &[Slot],
    function: &Value,
    input: SampleInput,
    outputs: &[usize],
    at: Span,
) -> Result<SampledFunction, Option<Diagnostic>> {
    let _ = (program, globals, function, input, outputs);
    Err(Some(Diagnostic::new(Code::NotSampled, at, "functions that run while rendering are not built yet")))
}
