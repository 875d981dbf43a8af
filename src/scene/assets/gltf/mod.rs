//! glTF 2.0 models: a tree of nodes with meshes, materials, pictures, skins and clips. Knows what a file says, and what that is in a scene;
//! neither draws nor keeps it.
//!
//! The JSON is taken apart by the gltf crate, which checks no index and no count, follows circles of nodes into the ground and reads what
//! infinities it is given; everything else is here. Every fault of a part that is used refuses the file in a sentence; what is only not
//! supported is a warning, and the rest is drawn.
//!
//! | module | what it reads |
//! |---|---|
//! | `container` | the two forms of a file |
//! | `uri` | names of buffers and pictures |
//! | `accessor` | numbers out of buffers |
//! | [`nodes`] | the tree |
//! | [`clip`] | motion over time |
//! | `primitive` | triangles |
//! | `skin` | joints and weights |
//! | `picture`, `material` | what things look like |
//! | [`skeleton`] | the tree as a skeleton that can be posed |
//! | `figure` | all of it together, as objects of a scene |

mod accessor;
pub mod clip;
mod container;
mod figure;
mod material;
pub mod nodes;
mod picture;
mod primitive;
pub mod skeleton;
mod skin;
mod uri;

pub use figure::Figure;

use super::names::Names;
use super::{AssetError, Loader};
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::skeleton::Skeleton;
use accessor::Numbers;
use clip::Clip;
use gltf::json::Root;
use nodes::{Place, Tree};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock};

/// A model file, its description read and checked. Its bytes wait until something needs them.
#[derive(Debug)]
pub struct Model {
    path: PathBuf,
    root: Root,
    tree: Tree,
    binary: Option<Vec<u8>>,
    buffers: OnceLock<Result<Vec<Vec<u8>>, String>>,
    shared: Mutex<figure::Shared>,
}

/// Why a model cannot be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ModelError {
    /// The file, or one that belongs to it, cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// What it says cannot be used.
    #[error("{0}")]
    Bad(String),
}

impl ModelError {
    /// In words, at the place of the file's name.
    pub fn said(&self, path: &Path, file: Span) -> Diagnostic {
        let name = path.display();
        match self {
            ModelError::Unreadable(why) => {
                Diagnostic::new(Code::FileNotFound, file, format!("the model `{name}` cannot be read: {why}"))
            }
            ModelError::Bad(why) => {
                Diagnostic::new(Code::BadModel, file, format!("the model `{name}` cannot be used: {why}"))
                    .hint(
                        "a model is a .glb or .gltf file of glTF 2.0, with the files that it names beside it",
                    )
            }
        }
    }
}

/// Extensions that a file may require: what they add is read, or changes nothing that is drawn here.
const READ: &[&str] = &[
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions that a file may use without a word about it: they say nothing about what is seen.
const SILENT: &[&str] = &["FB_ngon_encoding", "KHR_xmp_json_ld", "KHR_xmp", "MSFT_lod"];

impl Model {
    /// Reads and checks a file's description.
    pub fn read(loader: &dyn Loader, path: &Path) -> Result<Model, ModelError> {
        let bytes =
            loader.read(path).map_err(|e| ModelError::Unreadable(AssetError::unreadable(&e).to_string()))?;
        let (root, binary) = container::open(&bytes).map_err(ModelError::Bad)?;
        if let Some(extension) = root.extensions_required.iter().find(|e| !READ.contains(&e.as_str())) {
            return Err(ModelError::Bad(format!("it needs the extension `{extension}`, which is not read")));
        }
        let tree = Tree::new(&root).map_err(ModelError::Bad)?;
        Ok(Model {
            path: path.to_owned(),
            root,
            tree,
            binary,
            buffers: OnceLock::new(),
            shared: Mutex::default(),
        })
    }

    /// Its nodes.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The names of its clips.
    pub fn clips(&self) -> Vec<String> {
        clip::names(&self.root)
    }

    /// A clip of the file by number; panics where there is none.
    pub fn clip(&self, loader: &dyn Loader, index: usize) -> Result<Clip, ModelError> {
        let numbers = Numbers::new(&self.root, self.buffers(loader)?);
        clip::read(&self.root, &numbers, index).map_err(ModelError::Bad)
    }

    /// Where its nodes are: as the file has them, or at a moment of a clip, in seconds.
    pub fn places(&self, at: Option<(&Clip, f64)>) -> Vec<Place> {
        let locals = at.map_or_else(|| self.tree.locals(), |(clip, seconds)| clip.pose(&self.tree, seconds));
        self.tree.places(&locals)
    }

    /// The skeleton of its nodes at these places. Names are made fit for the language; see `Names`.
    pub fn skeleton(&self, places: &[Place], reserved: &dyn Fn(&str) -> bool) -> Skeleton {
        let mut turns = vec![self.root.skins.is_empty(); self.tree.nodes.len()];
        for joint in self.root.skins.iter().flat_map(|skin| &skin.joints) {
            if let Some(turns) = turns.get_mut(joint.value()) {
                *turns = true;
            }
        }
        skeleton::skeleton(&self.tree, places, &turns, &mut Names::new(reserved))
    }

    /// Where its nodes are that are at `places` at rest, in a pose of the skeleton of these places. None for another skeleton.
    pub fn posed(&self, places: &[Place], skeleton: &Skeleton, coordinates: &[f64]) -> Option<Vec<Place>> {
        let fits = skeleton.joints().len() == places.len() && coordinates.len() == skeleton.rest().len();
        fits.then(|| skeleton::posed(&self.tree, places, skeleton, coordinates))
    }

    /// Extensions that the file uses and that are not drawn.
    fn undrawn(&self) -> impl Iterator<Item = &str> {
        let used = self.root.extensions_used.iter().map(String::as_str);
        used.filter(|name| !READ.contains(name) && !SILENT.contains(name))
    }

    /// The bytes of its buffers, each as long as it says, read once.
    fn buffers(&self, loader: &dyn Loader) -> Result<&[Vec<u8>], ModelError> {
        let read = self.buffers.get_or_init(|| {
            (0..self.root.buffers.len())
                .map(|i| self.buffer(loader, i).map_err(|why| format!("buffer {i} {why}")))
                .collect()
        });
        read.as_deref().map_err(|why| ModelError::Bad(why.clone()))
    }

    fn buffer(&self, loader: &dyn Loader, index: usize) -> Result<Vec<u8>, String> {
        let buffer = &self.root.buffers[index];
        let bytes = match &buffer.uri {
            None if index == 0 => self.binary.clone().ok_or("is nowhere")?,
            None => return Err("is nowhere".into()),
            Some(uri) => match uri::source(uri).map_err(|why| format!("cannot be read: {why}"))? {
                uri::Source::Bytes(bytes) => bytes,
                uri::Source::File(name) => {
                    let path = self.path.parent().unwrap_or(Path::new("")).join(&name);
                    let unreadable =
                        |e| format!("in `{name}` cannot be read: {}", AssetError::unreadable(&e));
                    loader.read(&path).map_err(unreadable)?
                }
            },
        };
        let length = buffer.byte_length.0;
        if (bytes.len() as u64) < length {
            return Err(format!("ends after {} of {length} bytes", bytes.len()));
        }
        Ok(bytes)
    }
}
