//! Files that scenes name: read through a [`Loader`], decoded into plain data, each once.

pub mod bpt;
mod cache;
mod decode;
pub mod gltf;
pub mod image;
pub mod mocap;
mod mtl;
mod names;
pub mod obj;

pub use cache::{AssetCache, AssetError};

use std::path::Path;

/// The only way that Ogee reads a file. Tests and the language server bring their own.
pub trait Loader: Send + Sync {
    /// The bytes of a file.
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>>;
    /// Whether it could be read, without reading it.
    fn exists(&self, path: &Path) -> bool;
    /// The names in a folder, sorted; none where it cannot be read or listing is not offered. Finds files whose name was
    /// written in another case.
    fn list(&self, folder: &Path) -> Vec<String> {
        let _ = folder;
        Vec::new()
    }
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

    fn list(&self, folder: &Path) -> Vec<String> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut names: Vec<String> = entries.filter_map(|e| e.file_name().into_string().ok()).collect();
        names.sort_unstable();
        names
    }
}
