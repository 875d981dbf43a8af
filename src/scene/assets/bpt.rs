//! Patches from `.bpt` files.

use super::AssetCache;
use super::decode::decode;
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::patch::{Patch, bpt};
use std::path::Path;

/// Reads a `.bpt` file; at least one patch. `span` is the place of the file's name. Errors: it cannot be read, or holds no patches that
/// can be used.
pub fn load_bpt(cache: &AssetCache<'_>, path: &Path, span: Span) -> Result<Patch, Box<Diagnostic>> {
    let name = path.display();
    let bytes = cache.read(path).map_err(|why| {
        let message = format!("the patch file `{name}` cannot be read: {why}");
        Box::new(Diagnostic::new(Code::FileNotFound, span, message))
    })?;
    let refused = |why: String| {
        let message = format!("the patch file `{name}` cannot be used: {why}");
        let hint = "a .bpt file holds the number of patches, then for each `3 3` and 16 points, numbers between white space";
        Box::new(Diagnostic::new(Code::BadPatch, span, message).hint(hint))
    };
    let pieces = bpt::parse(&decode(bytes)).map_err(|error| refused(error.to_string()))?;
    if pieces.is_empty() {
        return Err(refused("it has no patches".into()));
    }
    Ok(Patch::loose(pieces))
}
