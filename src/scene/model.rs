//! Models of files, and how they stand. Nothing is read here.

use super::Pose;
use crate::diag::Span;
use std::path::PathBuf;
use std::sync::Arc;

/// A model, shared between its placements.
#[derive(Clone, Debug)]
pub struct ModelSource {
    /// Path, joined to the folder of the file that names it.
    pub path: PathBuf,
    /// The place of the file's name.
    pub span: Span,
    /// At which moment of which clip it stands; none is as its file has it.
    pub moment: Option<Moment>,
    /// A pose of its skeleton, that from where it stands so.
    pub pose: Option<Arc<Pose>>,
}

/// A moment of a clip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The clip's number in its file.
    pub clip: usize,
    /// Seconds from the clip's beginning; before and after the clip it stands still.
    pub seconds: f64,
    /// Where it is asked for.
    pub span: Span,
}
