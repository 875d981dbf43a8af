//! Files read and decoded once, whoever asks and from however many threads.

use super::Loader;
use super::bpt::load_bpt;
use super::gltf::{Model, ModelError};
use super::image::{Image, ImageError};
use super::obj::{LoadedMesh, load_obj};
use crate::diag::{Diagnostic, Span};
use crate::geometry::patch::Patch;
use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};

/// Why a file could not be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AssetError {
    /// It cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// It is no picture that can be used.
    #[error("{0}")]
    Image(#[from] ImageError),
}

impl AssetError {
    /// Of a failed read, in words.
    pub fn unreadable(error: &io::Error) -> AssetError {
        AssetError::Unreadable(match error.kind() {
            io::ErrorKind::NotFound => "there is no such file".into(),
            io::ErrorKind::PermissionDenied => "it may not be read".into(),
            io::ErrorKind::IsADirectory => "it is a folder".into(),
            _ => error.to_string(),
        })
    }
}

type Slot<T, E> = Arc<OnceLock<Result<Arc<T>, E>>>;
type Slots<K, T, E> = Mutex<HashMap<K, Slot<T, E>>>;

/// The pictures, meshes, patches and models of a run by their path. What is asked for twice is read once; who comes second waits for the first.
pub struct AssetCache<'a> {
    loader: &'a dyn Loader,
    images: Slots<PathBuf, Image, AssetError>,
    meshes: Slots<(PathBuf, Option<bool>), LoadedMesh, Box<Diagnostic>>,
    models: Slots<PathBuf, Model, ModelError>,
    patches: Slots<PathBuf, Patch, Box<Diagnostic>>,
}

impl<'a> AssetCache<'a> {
    /// An empty cache over a loader.
    pub fn new(loader: &'a dyn Loader) -> Self {
        AssetCache {
            loader,
            images: Mutex::default(),
            meshes: Mutex::default(),
            models: Mutex::default(),
            patches: Mutex::default(),
        }
    }

    /// The way files are read.
    pub fn loader(&self) -> &'a dyn Loader {
        self.loader
    }

    /// A file's bytes, not kept.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>, AssetError> {
        self.loader.read(path).map_err(|e| AssetError::unreadable(&e))
    }

    /// A picture.
    pub fn image(&self, path: &Path) -> Result<Arc<Image>, AssetError> {
        let slot = slot(&self.images, path.to_owned());
        slot.get_or_init(|| Ok(Arc::new(Image::decode(&self.read(path)?, path)?))).clone()
    }

    /// A model.
    pub fn model(&self, path: &Path) -> Result<Arc<Model>, ModelError> {
        let slot = slot(&self.models, path.to_owned());
        slot.get_or_init(|| Model::read(self.loader, path).map(Arc::new)).clone()
    }

    /// Patches by [`load_bpt`]. A diagnostic has the place of whoever asked first.
    pub fn patch(&self, path: &Path, span: Span) -> Result<Arc<Patch>, Box<Diagnostic>> {
        let slot = slot(&self.patches, path.to_owned());
        slot.get_or_init(|| load_bpt(self, path, span).map(Arc::new)).clone()
    }

    /// A mesh by [`load_obj`]. Diagnostics, and the materials of its file, have the place of whoever asked first.
    pub fn mesh(
        &self,
        path: &Path,
        smooth: Option<bool>,
        span: Span,
    ) -> Result<Arc<LoadedMesh>, Box<Diagnostic>> {
        let slot = slot(&self.meshes, (path.to_owned(), smooth));
        slot.get_or_init(|| load_obj(self, path, smooth, span).map(Arc::new)).clone()
    }
}

fn slot<K: std::hash::Hash + Eq, T, E>(slots: &Slots<K, T, E>, key: K) -> Slot<T, E> {
    let mut slots = slots.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    Arc::clone(slots.entry(key).or_default())
}
