//! A model as objects of a scene: each primitive of each mesh where its node is, or as a skin where joints take it.

use super::accessor::Numbers;
use super::material::{self, Made};
use super::nodes::Place;
use super::picture::Pictures;
use super::skin::Weighted;
use super::{Model, ModelError, primitive, skin};
use crate::diag::Span;
use crate::geometry::mesh::Mesh;
use crate::geometry::skin::Blend;
use crate::scene::assets::AssetCache;
use crate::scene::{Armature, MeshSource, Node, Object, Shape, Skin, SkinSurface, Weights};
use gltf::json::mesh::{Primitive, Semantic};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::{Arc, MutexGuard, PoisonError};

/// What a model is in a scene.
#[derive(Debug)]
pub struct Figure {
    /// Its parts, in the space of the model.
    pub parts: Vec<Node>,
    /// What of it is not drawn, or was mended.
    pub mended: Vec<String>,
    /// Pictures that are missing; told to who asks first.
    pub missing: Vec<String>,
}

impl Model {
    /// Its parts where the nodes are at `places`. Parts without a material of the file have none. `span` is the place of the file's name.
    pub fn figure(&self, cache: &AssetCache<'_>, places: &[Place], span: Span) -> Result<Figure, ModelError> {
        let numbers = Numbers::new(&self.root, self.buffers(cache.loader())?);
        let (missing, decoded) = (RefCell::default(), RefCell::default());
        let pictures =
            Pictures { root: &self.root, numbers: &numbers, cache, path: &self.path, span, missing, decoded };
        let mut maker = Maker {
            model: self,
            numbers: &numbers,
            pictures: &pictures,
            places,
            span,
            shared: self.shared.lock().unwrap_or_else(PoisonError::into_inner),
            armatures: HashMap::new(),
            parts: Vec::new(),
            mended: Mended::default(),
        };
        maker.all().map_err(ModelError::Bad)?;
        let (parts, mut mended) = (maker.parts, maker.mended.said());
        mended.extend(self.undrawn().map(|name| format!("what the extension `{name}` adds is not drawn")));
        Ok(Figure { parts, mended, missing: pictures.missing.take() })
    }
}

/// What all figures of a file have in common, read once. A material has the place of who asked first.
#[derive(Debug, Default)]
pub(super) struct Shared {
    materials: HashMap<usize, Arc<Made>>,
    /// By mesh and primitive.
    meshes: HashMap<(usize, usize), Option<Arc<MeshSource>>>,
    /// By mesh, primitive and how many joints there are.
    weights: HashMap<(usize, usize, usize), Option<Arc<Weighted>>>,
}

/// What is kept while a model is put together.
struct Maker<'a, 'c> {
    model: &'a Model,
    numbers: &'a Numbers<'a>,
    pictures: &'a Pictures<'a, 'c>,
    places: &'a [Place],
    span: Span,
    shared: MutexGuard<'a, Shared>,
    armatures: HashMap<usize, Arc<Armature>>,
    parts: Vec<Node>,
    mended: Mended,
}

impl Maker<'_, '_> {
    fn all(&mut self) -> Result<(), String> {
        let (model, tree) = (self.model, &self.model.tree);
        for &node in tree.order.iter().filter(|node| tree.nodes[**node].drawn) {
            let Some(index) = model.root.nodes[node].mesh.map(|mesh| mesh.value()) else { continue };
            let mesh = model
                .root
                .meshes
                .get(index)
                .ok_or_else(|| format!("node {node} has a mesh {index} that does not exist"))?;
            for (k, from) in mesh.primitives.iter().enumerate() {
                self.part(node, (index, k), from)
                    .map_err(|why| format!("primitive {k} of mesh {index}: {why}"))?;
            }
        }
        Ok(())
    }

    /// A primitive of a node's mesh.
    fn part(&mut self, node: usize, key: (usize, usize), from: &Primitive) -> Result<(), String> {
        let made = self.material(from)?;
        let Some(mesh) = self.mesh(key, from, made.as_ref().map_or(0, |made| made.uv_set))? else {
            return Ok(());
        };
        self.note(from, made.as_deref());
        let (shape, transform) = match self.skin(node, key, from, &mesh)? {
            Some(skin) => (Shape::Skin(Arc::new(skin)), None),
            None => match self.places[node].affine() {
                Some(place) => (Shape::Mesh(mesh), Some(Box::new(place))),
                // Scaled to nothing.
                None => return Ok(()),
            },
        };
        let name = Some(self.model.tree.nodes[node].name.as_str().into());
        let material = made.map(|made| Arc::clone(&made.material));
        let object = Object { transform, name, material, ..Object::new(shape, self.span) };
        self.parts.push(Node::Object(Arc::new(object)));
        Ok(())
    }

    fn material(&mut self, from: &Primitive) -> Result<Option<Arc<Made>>, String> {
        let Some(index) = from.material.map(|m| m.value()) else { return Ok(None) };
        if let Some(known) = self.shared.materials.get(&index) {
            return Ok(Some(Arc::clone(known)));
        }
        let material =
            self.model.root.materials.get(index).ok_or_else(|| format!("there is no material {index}"))?;
        let made = Arc::new(material::material(material, self.pictures, self.span));
        self.shared.materials.insert(index, Arc::clone(&made));
        Ok(Some(made))
    }

    fn mesh(
        &mut self,
        key: (usize, usize),
        from: &Primitive,
        uv_set: u32,
    ) -> Result<Option<Arc<MeshSource>>, String> {
        if let Some(known) = self.shared.meshes.get(&key) {
            return Ok(known.clone());
        }
        let mesh = primitive::triangles(from, self.numbers, uv_set)?;
        self.mended.empty += usize::from(mesh.is_none());
        let mesh = mesh.map(|mesh| Arc::new(MeshSource::Inline(mesh)));
        self.shared.meshes.insert(key, mesh.clone());
        Ok(mesh)
    }

    /// The skin of a node that has one, if its mesh has weights.
    fn skin(
        &mut self,
        node: usize,
        key: (usize, usize),
        from: &Primitive,
        mesh: &Arc<MeshSource>,
    ) -> Result<Option<Skin>, String> {
        let Some(index) = self.model.root.nodes[node].skin.map(|skin| skin.value()) else { return Ok(None) };
        let armature = self.armature(index)?;
        let MeshSource::Inline(Mesh { positions, .. }) = &**mesh else { return Ok(None) };
        let Some(weighted) = self.weights(key, from, positions.len(), armature.names.len())? else {
            return Ok(None);
        };
        self.mended.off += weighted.off;
        self.mended.bare += weighted.bare;
        let surface = SkinSurface::Mesh(Arc::clone(mesh));
        let weights = Weights::Listed(Arc::clone(&weighted.rows), self.span);
        Ok(Some(Skin { surface, transform: None, armature, weights, blend: Blend::Linear, tolerance: None }))
    }

    fn weights(
        &mut self,
        (mesh, primitive): (usize, usize),
        from: &Primitive,
        n_vertices: usize,
        n_joints: usize,
    ) -> Result<Option<Arc<Weighted>>, String> {
        let key = (mesh, primitive, n_joints);
        if let Some(known) = self.shared.weights.get(&key) {
            return Ok(known.clone());
        }
        let weighted = skin::weights(from, self.numbers, n_vertices, n_joints)?.map(Arc::new);
        self.shared.weights.insert(key, weighted.clone());
        Ok(weighted)
    }

    fn armature(&mut self, index: usize) -> Result<Arc<Armature>, String> {
        if let Some(known) = self.armatures.get(&index) {
            return Ok(Arc::clone(known));
        }
        let model = self.model;
        let armature = Arc::new(skin::armature(&model.root, self.numbers, index, &model.tree, self.places)?);
        self.armatures.insert(index, Arc::clone(&armature));
        Ok(armature)
    }

    fn note(&mut self, from: &Primitive, made: Option<&Made>) {
        let has = |semantic| primitive::attribute(from, semantic).is_some();
        self.mended.coloured |= has(Semantic::Colors(0));
        self.mended.morphs |= from.targets.as_ref().is_some_and(|targets| !targets.is_empty());
        self.mended.mixes_uv_sets |= made.is_some_and(|made| made.mixes_uv_sets);
    }
}

/// What was mended or left out.
#[derive(Default)]
struct Mended {
    empty: usize,
    off: usize,
    bare: usize,
    coloured: bool,
    morphs: bool,
    mixes_uv_sets: bool,
}

impl Mended {
    fn said(&self) -> Vec<String> {
        let count = |n: usize, one: &str, many: &str| {
            (n > 0).then(|| format!("{n} {}", if n == 1 { one } else { many }))
        };
        let flag = |is: bool, what: &str| is.then(|| what.to_owned());
        let all = [
            count(self.empty, "part without triangles was left out", "parts without triangles were left out"),
            count(
                self.off,
                "vertex has weights that do not add up to 1: they were divided by their sum",
                "vertices have weights that do not add up to 1: they were divided by their sums",
            ),
            count(
                self.bare,
                "vertex has no weights: it follows the first joint of its skin",
                "vertices have no weights: they follow the first joint of their skin",
            ),
            flag(self.coloured, "colours of vertices are not drawn"),
            flag(self.morphs, "morph targets are not drawn"),
            flag(
                self.mixes_uv_sets,
                "a material uses more than one set of texture coordinates: the first is used for all of it",
            ),
        ];
        all.into_iter().flatten().collect()
    }
}
