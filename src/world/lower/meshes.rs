//! Meshes: each read once and given one tree, however often it is placed.

use super::Lowering;
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::mesh::Mesh;
use crate::scene::assets::obj::load_obj;
use crate::scene::{Material, MeshSource};
use crate::world::aggregate::{Aggregate, MeshAggregate};
use crate::world::kept::{Content, FileKey, KeptMesh, Of};
use crate::world::shape::EVERYTHING;
use crate::world::shape::mesh::{MeshShape, Worn};
use std::collections::HashMap;
use std::sync::Arc;

/// Aggregates of meshes by where they come from; none where a mesh cannot be used, which is said once.
#[derive(Default)]
pub(super) struct Meshes {
    /// By address; the source is kept so that no other takes its place.
    by_source: HashMap<*const MeshSource, (Option<u32>, Arc<MeshSource>)>,
    by_file: HashMap<FileKey, Option<u32>>,
}

impl Lowering<'_> {
    /// The aggregate of a mesh.
    pub(super) fn mesh(&mut self, source: Arc<MeshSource>, span: Span) -> Option<u32> {
        let address = Arc::as_ptr(&source);
        if let Some((known, _)) = self.meshes.by_source.get(&address) {
            return *known;
        }
        match Arc::try_unwrap(source) {
            Ok(MeshSource::Inline(mesh)) => self.own_mesh(mesh, span),
            Ok(file @ MeshSource::File { .. }) => self.mesh_of(&file, span),
            Err(shared) => {
                let index = self.shared_mesh(&shared, span);
                self.meshes.by_source.insert(address, (index, shared));
                index
            }
        }
    }

    /// A mesh of the scene's text that nobody else holds.
    fn own_mesh(&mut self, mesh: Mesh, span: Span) -> Option<u32> {
        let content = self.kept.content(Of::Mesh, |content| content.mesh(&mesh));
        self.same_mesh(content, |lowering| lowering.shape_of(mesh, None, span))
    }

    /// The mesh that was made of this content before, or what is made now.
    pub(super) fn same_mesh(
        &mut self,
        content: Option<Content>,
        make: impl FnOnce(&mut Self) -> Option<Arc<MeshShape>>,
    ) -> Option<u32> {
        let shape = self.once(content, make)?;
        Some(self.keep_shape(shape, Vec::new()))
    }

    /// A mesh that others hold as well: perhaps a world before, and perhaps one after.
    fn shared_mesh(&mut self, source: &Arc<MeshSource>, span: Span) -> Option<u32> {
        let MeshSource::Inline(mesh) = &**source else { return self.mesh_of(source, span) };
        let known = self.kept.shared(source);
        let shape = match known {
            Some(shape) => shape,
            None => {
                let shape = self.shape_of(mesh.clone(), None, span)?;
                self.kept.keep_shared(source, Arc::clone(&shape));
                shape
            }
        };
        Some(self.keep_shape(shape, Vec::new()))
    }

    fn mesh_of(&mut self, source: &MeshSource, span: Span) -> Option<u32> {
        match source {
            MeshSource::Inline(mesh) => self.own_mesh(mesh.clone(), span),
            MeshSource::File { path, smooth, span } => {
                let key = (path.clone(), *smooth);
                if let Some(known) = self.meshes.by_file.get(&key) {
                    return *known;
                }
                let index =
                    self.mesh_of_file(&key, *span).map(|kept| self.keep_shape(kept.shape, kept.materials));
                self.meshes.by_file.insert(key, index);
                index
            }
        }
    }

    fn mesh_of_file(&mut self, key: &FileKey, span: Span) -> Option<KeptMesh> {
        if let Some(known) = self.kept.file(key) {
            return Some(known);
        }
        let loaded =
            load_obj(self.assets, &key.0, key.1, span).map_err(|fault| self.sink.push(*fault)).ok()?;
        self.sink.extend(loaded.warnings);
        let shape = self.shape_of(loaded.mesh, None, span)?;
        let kept = KeptMesh { shape, materials: loaded.materials };
        self.kept.keep_file(key.clone(), kept.clone());
        Some(kept)
    }

    /// The mesh of a file without a tree, to be bent.
    pub(super) fn read_mesh(&mut self, key: &FileKey, span: Span) -> Option<(Mesh, Vec<Arc<Material>>)> {
        let loaded = self.assets.mesh(&key.0, key.1, span).map_err(|fault| self.sink.push(*fault)).ok()?;
        self.sink.extend(loaded.warnings.iter().cloned());
        Some((loaded.mesh.clone(), loaded.materials.clone()))
    }

    /// A mesh, which may be a skin, with its tree; none, said, where it has no triangles.
    pub(super) fn shape_of(&mut self, mesh: Mesh, worn: Option<Worn>, span: Span) -> Option<Arc<MeshShape>> {
        if mesh.triangles.is_empty() {
            let message = "this mesh has no triangles: nothing of it is seen";
            self.sink.push(Diagnostic::new(Code::MeshRepaired, span, message));
            return None;
        }
        Some(Arc::new(MeshShape::new(Arc::new(mesh), worn, self.accelerator)))
    }

    pub(super) fn keep_shape(&mut self, shape: Arc<MeshShape>, materials: Vec<Arc<Material>>) -> u32 {
        let materials = materials.into_iter().map(|m| self.materials.number(m)).collect();
        let bounds = if shape.tree.is_unbounded() { EVERYTHING } else { shape.tree.bounds() };
        self.keep(Aggregate::Mesh(MeshAggregate { shape, bounds, materials }))
    }
}
