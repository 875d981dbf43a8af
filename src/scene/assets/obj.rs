//! Wavefront OBJ meshes: tobj reads the numbers, and what it lacks is built around it.
//!
//! The text is decoded whatever its encoding, and scanned once (`scan`): lines that tobj refuses or misreads without need
//! are left out or mended, faces are checked with their places, smoothing groups and materials noted. tobj reads what is
//! left (`feed`). Corners are joined into vertices, faces cut into triangles and missing normals computed (`weld`).
//! For a while the text, tobj's faces (about 130 bytes each) and the mesh (24 bytes a position and 12 a triangle) are in
//! memory together: a million triangles (37 MB of text) take 0.55 s of one core and 235 MB at the peak.

mod feed;
mod scan;
mod weld;

use super::decode::decode;
use super::{AssetCache, mtl};
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::mesh::{Mesh, OBJECT_MATERIAL};
use crate::scene::Material;
use feed::Feed;
use glam::{DVec2, DVec3};
use scan::{Scan, first_bad_number, place, scan};
use std::path::Path;
use std::sync::Arc;
use weld::{Numbers, Welded, weld};

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
    let scanned = scan(&text).map_err(|fault| refused(worded(&text, &fault)))?;
    if scanned.n_faces == 0 {
        return Err(refused(format!("it has no faces{}", without_faces(&scanned))));
    }
    let mut numbers = read_numbers(&text, &scanned).map_err(refused)?;
    let bad_uvs = mend_uvs(&mut numbers);
    let found = mtl::load(cache, path, &scanned.libraries, &scanned.material_names, span);
    let Welded { mesh, flat_faces } = weld(numbers, &scanned, &found.index_of_name, smooth);
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

/// The numbers of the lines that the scan kept.
fn read_numbers(text: &str, scanned: &Scan<'_>) -> Result<Numbers, String> {
    let options = tobj::LoadOptions::default();
    let no_libraries = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let in_words = |error: &dyn std::fmt::Display| match first_bad_number(text) {
        Some(fault) => worded(text, &fault),
        None => error.to_string(),
    };
    let read = tobj::load_obj_buf(&mut Feed::new(text, &scanned.pieces), &options, no_libraries);
    let (models, _) = read.map_err(|error| in_words(&error))?;
    let mesh = match <[tobj::Model; 1]>::try_from(models) {
        Ok([model]) => model.mesh,
        Err(models) => return Err(format!("it has {} parts where one was read", models.len())),
    };
    if !mesh.positions.iter().all(|x| x.is_finite()) {
        return Err(in_words(&"a position is not finite"));
    }
    let n_faces = if mesh.face_arities.is_empty() { mesh.indices.len() / 3 } else { mesh.face_arities.len() };
    if n_faces != scanned.n_faces {
        return Err(format!("{n_faces} faces were read of {}", scanned.n_faces));
    }
    Ok(Numbers {
        positions: triples(&mesh.positions),
        uvs: mesh.texcoords.chunks_exact(2).map(DVec2::from_slice).collect(),
        normals: triples(&mesh.normals),
        arities: mesh.face_arities,
        position_of: mesh.indices,
        uv_of: mesh.texcoord_indices,
        normal_of: mesh.normal_indices,
    })
}

fn triples(numbers: &[f64]) -> Vec<DVec3> {
    numbers.chunks_exact(3).map(DVec3::from_slice).collect()
}

/// Texture coordinates that are not finite become 0; how many there were.
fn mend_uvs(numbers: &mut Numbers) -> usize {
    let mut bad = 0;
    for uv in numbers.uvs.iter_mut().filter(|uv| !uv.is_finite()) {
        *uv = DVec2::ZERO;
        bad += 1;
    }
    bad
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
