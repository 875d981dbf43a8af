//! Meshes: each read once and given one tree, however often it is placed.

use super::Lowering;
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::mesh::Mesh;
use crate::scene::assets::obj::load_obj;
use crate::scene::{Material, MeshSource};
use crate::world::aggregate::{Aggregate, MeshAggregate};
use crate::world::shape::EVERYTHING;
use crate::world::shape::mesh::{MeshShape, Worn};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Aggregates of meshes by where they come from; none where a mesh cannot be used, which is said once.
#[derive(Default)]
pub(super) struct Meshes {
    /// By address; the source is kept so that no other takes its place.
    by_source: HashMap<*const MeshSource, (Option<u32>, Arc<MeshSource>)>,
    by_file: HashMap<(PathBuf, Option<bool>), Option<u32>>,
}

impl Lowering<'_> {
    /// The aggregate of a mesh.
    pub(super) fn mesh(&mut self, source: Arc<MeshSource>, span: Span) -> Option<u32> {
        let address = Arc::as_ptr(&source);
        if let Some((known, _)) = self.meshes.by_source.get(&address) {
            return *known;
        }
        match Arc::try_unwrap(source) {
            Ok(MeshSource::Inline(mesh)) => self.keep_mesh(mesh, Vec::new(), span),
            Ok(file @ MeshSource::File { .. }) => self.mesh_of(&file, span),
            Err(shared) => {
                let index = self.mesh_of(&shared, span);
                self.meshes.by_source.insert(address, (index, shared));
                index
            }
        }
    }

    fn mesh_of(&mut self, source: &MeshSource, span: Span) -> Option<u32> {
        match source {
            MeshSource::Inline(mesh) => self.keep_mesh(mesh.clone(), Vec::new(), span),
            MeshSource::File { path, smooth, span } => {
                let key = (path.clone(), *smooth);
                if let Some(known) = self.meshes.by_file.get(&key) {
                    return *known;
                }
                let (mesh, materials) = self.read_mesh(&key, *span);
                let index = mesh.and_then(|mesh| self.keep_mesh(mesh, materials, *span));
                self.meshes.by_file.insert(key, index);
                index
            }
        }
    }

    pub(super) fn read_mesh(
        &mut self,
        key: &(PathBuf, Option<bool>),
        span: Span,
    ) -> (Option<Mesh>, Vec<Arc<Material>>) {
        match load_obj(self.assets, &key.0, key.1, span) {
            Ok(loaded) => {
                self.sink.extend(loaded.warnings);
                (Some(loaded.mesh), loaded.materials)
            }
            Err(fault) => {
                self.sink.push(*fault);
                (None, Vec::new())
            }
        }
    }

    /// Builds the tree of a mesh.
    pub(super) fn keep_mesh(&mut self, mesh: Mesh, materials: Vec<Arc<Material>>, span: Span) -> Option<u32> {
        self.keep_worn(mesh, None, materials, span)
    }

    /// Builds the tree of a mesh that may be a skin.
    pub(super) fn keep_worn(
        &mut self,
        mesh: Mesh,
        worn: Option<Worn>,
        materials: Vec<Arc<Material>>,
        span: Span,
    ) -> Option<u32> {
        if mesh.triangles.is_empty() {
            let message = "this mesh has no triangles: nothing of it is seen";
            self.sink.push(Diagnostic::new(Code::MeshRepaired, span, message));
            return None;
        }
        let materials = materials.into_iter().map(|m| self.materials.number(m)).collect();
        let shape = Arc::new(MeshShape::new(Arc::new(mesh), worn, self.with_trees));
        let bounds = if shape.tree.is_unbounded() { EVERYTHING } else { shape.tree.bounds() };
        Some(self.keep(Aggregate::Mesh(MeshAggregate { shape, bounds, materials })))
    }
}
