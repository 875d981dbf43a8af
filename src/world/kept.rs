//! What stays of a world for the next one, frame by frame: meshes with their trees, and what else is dear to make. What comes of a file is
//! known by its path, a mesh that frames share by its address, and all else by its content, number by number: a scene is evaluated
//! anew for each frame, and what comes out the same is not made again.
//! Knows nothing of frames' times, nor of what else stands in a world.

mod content;

use super::shape::mesh::MeshShape;
use crate::scene::{Accelerator, Material, MeshSource};
pub(super) use content::{Content, Of};
use std::any::Any;
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// How the mesh of a file is known: its path, and whether its normals are smooth, where that is asked.
pub(super) type FileKey = (PathBuf, Option<bool>);

/// What worlds that were made before leave. Empty for a world that is made alone.
#[derive(Default)]
pub struct Kept {
    accelerator: Accelerator,
    /// Whether worlds follow in which the same may stand.
    goes_on: bool,
    files: HashMap<FileKey, KeptMesh>,
    /// By address; the source is kept so that no other takes its place.
    shared: HashMap<*const MeshSource, SharedMesh>,
    made: RefCell<HashMap<Content, Made>>,
    reused: Cell<u64>,
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

struct Made {
    what: Arc<dyn Any + Send + Sync>,
    used: bool,
    /// True of what a world before has made.
    before: bool,
}

impl Kept {
    /// For worlds that follow one another.
    pub fn for_frames() -> Kept {
        Kept { goes_on: true, ..Kept::default() }
    }

    /// Before a world is made: what the last one did not use goes, and all of it where trees were of another kind.
    pub(super) fn begin(&mut self, accelerator: Accelerator) {
        if accelerator != self.accelerator {
            *self = Kept { accelerator, goes_on: self.goes_on, ..Kept::default() };
        }
        self.shared.retain(|_, mesh| std::mem::take(&mut mesh.used));
        self.reused.set(0);
        self.made.get_mut().retain(|_, made| {
            made.before = true;
            std::mem::take(&mut made.used)
        });
    }

    /// How many things this world took over from those before; what it made itself, and took again, does not count.
    pub(super) fn reused(&self) -> u64 {
        self.reused.get()
    }

    fn reuse(&self) {
        self.reused.update(|n| n + 1);
    }

    pub(super) fn file(&self, key: &FileKey) -> Option<KeptMesh> {
        let known = self.files.get(key).cloned();
        known.inspect(|_| self.reuse())
    }

    pub(super) fn keep_file(&mut self, key: FileKey, mesh: KeptMesh) {
        self.files.insert(key, mesh);
    }

    pub(super) fn shared(&mut self, source: &Arc<MeshSource>) -> Option<Arc<MeshShape>> {
        let mesh = self.shared.get_mut(&Arc::as_ptr(source))?;
        mesh.used = true;
        self.reused.update(|n| n + 1);
        Some(Arc::clone(&mesh.shape))
    }

    pub(super) fn keep_shared(&mut self, source: &Arc<MeshSource>, shape: Arc<MeshShape>) {
        let mesh = SharedMesh { shape, _source: Arc::clone(source), used: true };
        self.shared.insert(Arc::as_ptr(source), mesh);
    }

    /// The content of something, written by `write`; none where nobody could ask for it: no world follows, and this one does not.
    pub(super) fn content(&self, of: Of, write: impl FnOnce(&mut Content)) -> Option<Content> {
        (self.goes_on || of.is_dear()).then(|| {
            let mut content = Content::new(of);
            write(&mut content);
            content
        })
    }

    /// What was made of this content, in this world or the one before.
    pub(super) fn made<T: Any + Send + Sync>(&self, content: Option<&Content>) -> Option<Arc<T>> {
        let mut made = self.made.borrow_mut();
        let known = made.get_mut(content?)?;
        known.used = true;
        if known.before {
            self.reuse();
        }
        Arc::clone(&known.what).downcast().ok()
    }

    /// Keeps what was made of a content.
    pub(super) fn keep<T: Any + Send + Sync>(&self, content: Option<Content>, made: &Arc<T>) {
        if let Some(content) = content {
            let what: Arc<dyn Any + Send + Sync> = Arc::<T>::clone(made);
            self.made.borrow_mut().entry(content).or_insert(Made { what, used: true, before: false });
        }
    }
}
