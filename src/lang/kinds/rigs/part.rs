//! A joint or tip on its way into a skeleton: what its block says, checked by itself.

use crate::diag::Span;
use crate::geometry::skeleton::{Freedom, Limits};
use glam::DVec3;
use std::rc::Rc;

/// A joint or tip that hangs on nothing yet.
#[derive(Debug)]
pub struct Part {
    /// Its name.
    pub name: Rc<str>,
    /// Where that stands.
    pub name_span: Span,
    /// From what it hangs on.
    pub offset: DVec3,
    /// Which it is.
    pub sort: Sort,
}

/// A tip, or a joint with what hangs on it.
#[derive(Debug)]
pub enum Sort {
    /// The end of a chain.
    Tip,
    /// A joint.
    Joint {
        /// What it may do.
        freedom: Freedom,
        /// A value for each coordinate.
        rest: Vec<f64>,
        /// Of each coordinate.
        limits: Vec<Limits>,
        /// In the order written.
        parts: Vec<Rc<Part>>,
        /// How many joints hang on one another here: 1 for a joint alone.
        depth: usize,
    },
}

impl Part {
    /// The word of its kind.
    pub fn kind(&self) -> &'static str {
        match &self.sort {
            Sort::Tip => "tip",
            Sort::Joint { .. } => "joint",
        }
    }

    /// How many joints hang on one another here.
    pub fn depth(&self) -> usize {
        match &self.sort {
            Sort::Tip => 0,
            Sort::Joint { depth, .. } => *depth,
        }
    }
}
