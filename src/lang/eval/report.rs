//! Diagnostics of a run: the calls and imports that led to a fault are told with it.

use super::{Call, Evaluator};
use crate::diag::{Diagnostic, Frame};
use crate::lang::display::abbreviated;

/// Of a long trace, this many calls are shown at each end.
const SHOWN: usize = 5;

/// About how many characters of an argument are shown.
const ARGUMENT: usize = 24;

impl Evaluator<'_> {
    pub(super) fn say(&mut self, mut diagnostic: Diagnostic) {
        if self.sink.holds(&diagnostic) {
            return;
        }
        diagnostic.trace.extend(self.trace());
        let outermost = diagnostic.trace.last().map(|f| f.span).or(diagnostic.span);
        if let Some(span) = outermost {
            diagnostic.trace.extend(self.run.files.import_trace(span.source));
        }
        self.sink.push(diagnostic);
    }

    /// The calls that are running, innermost first.
    fn trace(&self) -> Vec<Frame> {
        let n = self.calls.len();
        let frame = |call: &Call| Frame { span: call.span, text: self.described(call) };
        if n <= 2 * SHOWN + 1 {
            return self.calls.iter().rev().map(frame).collect();
        }
        let mut frames: Vec<Frame> = self.calls.iter().rev().take(SHOWN).map(frame).collect();
        let left_out = self.calls[n - SHOWN - 1];
        frames.push(Frame { span: left_out.span, text: format!("… {} more calls", n - 2 * SHOWN) });
        frames.extend(self.calls[..SHOWN].iter().rev().map(frame));
        frames
    }

    /// "in `branch(length: 1.2, depth: 3)`".
    fn described(&self, call: &Call) -> String {
        let function = &self.program.functions[call.function.0 as usize];
        let arguments: Vec<String> = function
            .parameters
            .iter()
            .enumerate()
            .filter_map(|(i, parameter)| {
                let value = self.stack.get(call.base + i)?.read().ok()?;
                Some(format!("{}: {}", parameter.name, abbreviated(&value, ARGUMENT)))
            })
            .collect();
        match &function.name {
            Some(name) => format!("`{name}({})`", arguments.join(", ")),
            None => format!("`({}) => …`", arguments.join(", ")),
        }
    }
}
