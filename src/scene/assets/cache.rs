//! Files read and decoded once, whoever asks and from however many threads.

use super::Loader;
use super::image::{Image, ImageError};
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

type Slot<T> = Arc<OnceLock<Result<Arc<T>, AssetError>>>;

/// The pictures of a run by their path. What is asked for twice is read once; who comes second waits for the first.
pub struct AssetCache<'a> {
    loader: &'a dyn Loader,
    images: Mutex<HashMap<PathBuf, Slot<Image>>>,
}

impl<'a> AssetCache<'a> {
    /// An empty cache over a loader.
    pub fn new(loader: &'a dyn Loader) -> Self {
        AssetCache { loader, images: Mutex::default() }
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
        let slot = {
            let mut images = self.images.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            Arc::clone(images.entry(path.to_owned()).or_default())
        };
        slot.get_or_init(|| Ok(Arc::new(Image::decode(&self.read(path)?, path)?))).clone()
    }
}
