//! What stays of a world for the next one, frame by frame: meshes with their trees. A mesh of a file is known by its path, any other by the
//! value of the scene that it is made of, which stays in models and wherever else several frames share it.
//! Knows nothing of frames' times, nor of what else stands in a world.

use super::shape::mesh::MeshShape;
use crate::scene::{Material, MeshSource};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// How the mesh of a file is known: its path, and whether its normals are smooth, where that is asked.
pub(super) type FileKey = (PathBuf, Option<bool>);

/// Meshes of worlds that were made before, with their trees. Empty for a world that is made alone.
#[derive(Default)]
pub struct Kept {
    with_trees: bool,
    files: HashMap<FileKey, KeptMesh>,
    /// By address; the source is kept so that no other takes its place.
    shared: HashMap<*const MeshSource, SharedMesh>,
}

/// A mesh, ready for rays, and the materials of its file.
#[derive(Clone)]
pub(super) struct KeptMesh {
    pub shape: Arc<MeshShape>,
    pub materials: Vec<Arc<Material>>,
}

struct SharedMesh {
    shape: Arc<MeshShape>,
    /// Holds the address.
    _source: Arc<MeshSource>,
    used: bool,
}

impl Kept {
    /// Before a world is made: what the last one did not use goes, and all of it where trees were not as they are now.
    pub(super) fn begin(&mut self, with_trees: bool) {
        if with_trees != self.with_trees {
            *self = Kept { with_trees, ..Kept::default() };
        }
        self.shared.retain(|_, mesh| std::mem::take(&mut mesh.used));
    }

    pub(super) fn file(&self, key: &FileKey) -> Option<KeptMesh> {
        self.files.get(key).cloned()
    }

    pub(super) fn keep_file(&mut self, key: FileKey, mesh: KeptMesh) {
        self.files.insert(key, mesh);
    }

    pub(super) fn shared(&mut self, source: &Arc<MeshSource>) -> Option<Arc<MeshShape>> {
        let mesh = self.shared.get_mut(&Arc::as_ptr(source))?;
        mesh.used = true;
        Some(Arc::clone(&mesh.shape))
    }

    pub(super) fn keep_shared(&mut self, source: &Arc<MeshSource>, shape: Arc<MeshShape>) {
        let mesh = SharedMesh { shape, _source: Arc::clone(source), used: true };
        self.shared.insert(Arc::as_ptr(source), mesh);
    }
}
