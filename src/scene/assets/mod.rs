//! Files that scenes name: read through a [`Loader`], decoded into plain data, each once.

mod cache;
pub mod image;

pub use cache::{AssetCache, AssetError};

use std::path::Path;

/// The only way that Ogee reads a file. Tests and the language server bring their own.
pub trait Loader: Send + Sync {
    /// The bytes of a file.
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>>;
    /// Whether it could be read, without reading it.
    fn exists(&self, path: &Path) -> bool;
}

/// Files of the machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct DiskLoader;

impl Loader for DiskLoader {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        std::fs::read(path)
    }

    fn exists(&self, path: &Path) -> bool {
        path.is_file()
    }
}
