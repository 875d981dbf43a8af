//! Wavefront OBJ meshes.
//!
//! The text is decoded whatever its encoding, and read in one pass (`scan`) that checks faces with their places and notes
//! smoothing groups and materials beside the numbers (`numbers`). Corners are joined into vertices, faces cut into triangles
//! and missing normals computed (`weld`). tobj reads the materials alone: its meshes would be tables of indices by hashing,
//! from text that must be mended first, at three times the time and twice the memory.

mod numbers;
mod scan;
mod weld;

use super::decode::decode;
use super::{AssetCache, mtl};
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::mesh::{Mesh, OBJECT_MATERIAL};
use crate::scene::Material;
use numbers::Numbers;
use scan::{Scan, first_bad_number, place, scan};
use std::path::Path;
use std::sync::Arc;
use weld::{Welded, weld};

/// A mesh file as a scene can use it.
#[derive(Clone, Debug)]
pub struct LoadedMesh {
    /// The triangles. At least one.
    pub mesh: Mesh,
    /// What [`Mesh::material_of_triangle`] refers to.
    pub materials: Vec<Arc<Material>>,
    /// What was mended or is missing, at the file's name.
    pub warnings: Vec<Diagnostic>,
}

/// Reads an OBJ file with its materials and pictures. `smooth` on makes all of it one smooth surface, off makes every face
/// flat; none follows the file: its normals, else its smoothing groups (none: flat). `span` is the place of the file's name.
pub fn load_obj(
    cache: &AssetCache<'_>,
    path: &Path,
    smooth: Option<bool>,
    span: Span,
) -> Result<LoadedMesh, Box<Diagnostic>> {
    let name = path.display();
    let bytes = cache.read(path).map_err(|why| {
        Box::new(Diagnostic::new(
            Code::FileNotFound,
            span,
            format!("the mesh `{name}` cannot be read: {why}"),
        ))
    })?;
    let text = decode(bytes);
    let refused = |why: String| {
        Box::new(Diagnostic::new(Code::BadMesh, span, format!("the mesh `{name}` cannot be used: {why}")))
    };
    let mut scanned = scan(&text).map_err(|fault| refused(worded(&text, &fault)))?;
    if scanned.n_faces == 0 {
        return Err(refused(format!("it has no faces{}", without_faces(&scanned))));
    }
    let mut numbers = std::mem::take(&mut scanned.numbers);
    check(&numbers, &text).map_err(refused)?;
    let bad_uvs = numbers.mend_uvs();
    let found = mtl::load(cache, path, &scanned.libraries, &scanned.material_names, span);
    let Welded { mesh, flat_faces } = weld(&numbers, &scanned, &found.index_of_name, smooth);
    if mesh.triangles.is_empty() {
        return Err(refused("none of its faces has an area".into()));
    }
    let mended = Mended { short: scanned.short_faces, flat: flat_faces, bad_uvs, scanned: &scanned };
    let mut warnings = Vec::from_iter(mended.warning(path, span));
    warnings.extend(found.warning);
    Ok(LoadedMesh { mesh, materials: found.materials, warnings })
}

fn without_faces(scanned: &Scan<'_>) -> &'static str {
    if scanned.short_faces > 0 {
        " of three corners or more"
    } else if scanned.free_forms > 0 {
        ", only curves or free-form surfaces, which are not read"
    } else {
        ""
    }
}

fn worded(text: &str, fault: &scan::Fault) -> String {
    let (line, column) = place(text, fault.offset);
    format!("line {line}, column {column}: {}", fault.message)
}

/// Whether all numbers could be read, and are finite where faces need them.
fn check(numbers: &Numbers, text: &str) -> Result<(), String> {
    let otherwise = match (numbers.malformed, numbers.used_positions_are_finite()) {
        (true, _) => "a number cannot be read",
        (false, false) => "a position is not finite",
        (false, true) => return Ok(()),
    };
    Err(first_bad_number(text).map_or(otherwise.to_owned(), |fault| worded(text, &fault)))
}

/// What was done to a file so that it could be used.
struct Mended<'s, 't> {
    short: usize,
    flat: usize,
    bad_uvs: usize,
    scanned: &'s Scan<'t>,
}

impl Mended<'_, '_> {
    fn warning(&self, path: &Path, span: Span) -> Option<Diagnostic> {
        let mut done = Vec::new();
        let mut count = |n: usize, one: &str, many: &str| {
            if n > 0 {
                done.push(format!("{n} {}", if n == 1 { one } else { many }));
            }
        };
        count(self.flat, "face without area was left out", "faces without area were left out");
        count(
            self.short,
            "face of fewer than 3 corners was left out",
            "faces of fewer than 3 corners were left out",
        );
        count(
            self.bad_uvs,
            "texture coordinate that is not finite became 0",
            "texture coordinates that are not finite became 0",
        );
        count(
            self.scanned.free_forms,
            "curve or free-form surface was not read",
            "curves or free-form surfaces were not read",
        );
        if self.scanned.dangling {
            done.push("corners refer to texture coordinates or normals of which the file has none".into());
        }
        let message = format!("the mesh `{}` was mended: {}", path.display(), done.join("; "));
        (!done.is_empty()).then(|| Diagnostic::new(Code::MeshRepaired, span, message))
    }
}

/// The entry for faces whose `usemtl` names no known material.
pub(super) const UNKNOWN: u16 = OBJECT_MATERIAL;
