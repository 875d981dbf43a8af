//! Lines from a pipe or a file: no prompts, no colours, no history.

use super::{Lines, Next, Talk, garbled, goes_on};
use crate::speech::{Failure, reason};
use std::io::BufRead;
use std::string::FromUtf8Error;

/// Standard input.
pub struct Pipe;

impl Lines for Pipe {
    fn next(&mut self, talk: &Talk<'_, '_>) -> Result<Next, Failure> {
        let mut text = String::new();
        loop {
            let mut line = Vec::new();
            let read = std::io::stdin().lock().read_until(b'\n', &mut line);
            let n_bytes = read.map_err(|e| Failure::machine("cannot read standard input", reason(&e)))?;
            let line = match String::from_utf8(line) {
                Ok(line) => line,
                Err(error) => return Ok(no_text(talk.n_lines, 1 + text.lines().count(), &error)),
            };
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

/// After `before` others, of `n_lines` lines the last is no text.
fn no_text(before: usize, n_lines: usize, error: &FromUtf8Error) -> Next {
    let sound = String::from_utf8_lossy(&error.as_bytes()[..error.utf8_error().valid_up_to()]);
    let (line, column) = (before + n_lines, 1 + sound.chars().count());
    let message = format!("line {line} is not UTF-8 text: what stands at column {column} is no character");
    Next::Garbled(n_lines, garbled(message))
}
