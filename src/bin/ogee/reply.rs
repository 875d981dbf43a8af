//! What the library replies to a line, shown: values to standard output, the rest to a person.

use crate::speech::{Failure, data, show, show_uncounted, tell};
use ogee::diag::SourceMap;
use ogee::session::dialogue::{Reply, Said};

/// Whether a line that counts the faults follows them.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Count {
    /// As every other command has it.
    Always,
    /// Where there is more to come.
    Never,
}

/// Shows a reply; numbers to `digits` significant digits, or in the shortest form that reads back.
pub fn show_reply(
    reply: &Reply,
    sources: &SourceMap,
    digits: Option<usize>,
    count: Count,
) -> Result<(), Failure> {
    for said in &reply.said {
        match said {
            Said::Printed(text) => tell(text),
            Said::Within(error) => tell(format!("± {error:.1e}")),
            Said::Answer(answer) => data(format!("{}\n", answer.text(digits)))?,
        }
    }
    match count {
        Count::Always => show(&reply.diagnostics, sources),
        Count::Never => show_uncounted(&reply.diagnostics, sources),
    }
    Ok(())
}
