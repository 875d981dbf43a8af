//! Lines from a pipe or a file: no prompts, no colours, no history.

use super::{Lines, Next, Talk, goes_on};
use crate::speech::{Failure, reason};
use std::io::BufRead;

/// Standard input.
pub struct Pipe;

impl Lines for Pipe {
    fn next(&mut self, _: &Talk<'_, '_>) -> Result<Next, Failure> {
        let mut text = String::new();
        loop {
            let mut line = Vec::new();
            let read = std::io::stdin().lock().read_until(b'\n', &mut line);
            let n_bytes = read.map_err(|e| Failure::machine("cannot read standard input", reason(&e)))?;
            let line = String::from_utf8(line)
                .map_err(|_| Failure::machine("cannot read standard input", "it is not UTF-8 text"))?;
            text.push_str(&line);
            match (n_bytes, text.is_empty()) {
                (0, true) => return Ok(Next::End),
                (0, false) => return Ok(Next::Text(text)),
                _ if !goes_on(text.strip_suffix('\n').unwrap_or(&text)) => return Ok(Next::Text(text)),
                _ => {}
            }
        }
    }
}
