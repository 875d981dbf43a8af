//! The pieces of a scanned file as a reader for tobj, without a copy of the text.

use super::scan::Piece;
use std::io::{BufRead, Read, Result};

/// Reads pieces in order, each followed by a line end.
pub(super) struct Feed<'a> {
    text: &'a str,
    pieces: std::slice::Iter<'a, Piece>,
    current: &'a [u8],
    owes_line_end: bool,
}

impl<'a> Feed<'a> {
    /// Of pieces whose ranges are of `text`.
    pub(super) fn new(text: &'a str, pieces: &'a [Piece]) -> Self {
        Feed { text, pieces: pieces.iter(), current: b"", owes_line_end: false }
    }
}

impl BufRead for Feed<'_> {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        while self.current.is_empty() {
            if self.owes_line_end {
                self.current = b"\n";
                self.owes_line_end = false;
                continue;
            }
            match self.pieces.next() {
                None => break,
                Some(Piece::Range(start, end)) => self.current = &self.text.as_bytes()[*start..*end],
                Some(Piece::Made(line)) => self.current = line.as_bytes(),
            }
            self.owes_line_end = true;
        }
        Ok(self.current)
    }

    fn consume(&mut self, amount: usize) {
        self.current = &self.current[amount..];
    }
}

impl Read for Feed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let amount = self.fill_buf()?.len().min(buffer.len());
        buffer[..amount].copy_from_slice(&self.current[..amount]);
        self.consume(amount);
        Ok(amount)
    }
}
