//! From a scene's nodes to a world: groups dissolved, shared ones kept as aggregates that are placed, materials numbered, lights
//! gathered. The nodes are taken apart as they go, so that a scene and its world never stand side by side in memory.

mod lights;
mod meshes;
mod models;
mod shapes;
mod skins;
mod solids;
mod surfaces;
mod survey;
mod views;

use super::aggregate::{Aggregate, Group, INHERITED, Instance, Item, Scope};
use super::bsdf::Coat;
use super::kept::Content;
use super::shape::{self, EVERYTHING};
use super::tree::Tree;
use super::{Kept, World, WorldOptions};
use crate::diag::{Code, Diagnostic, Sink, Span};
use crate::math::Affine;
use crate::scene::assets::AssetCache;
use crate::scene::{Accelerator, Hide, Light, LightSource, Material, Node, Object, Rgb, Shape, Texture};
use lights::Found;
use meshes::Meshes;
use models::Models;
use skins::Skins;
use solids::Solids;
use std::any::Any;
use std::collections::HashMap;
use std::sync::Arc;
use surfaces::{Drawn, Surfaces};
use survey::Survey;

/// The number of the material of objects that have none: white plaster, diffuse 0.8.
pub(super) const DEFAULT_MATERIAL: u32 = 0;

/// Placements nested deeper than this are left out, with an error: each level costs every ray stack.
const MAX_NESTING: usize = 128;

/// See [`World::new`].
pub(super) fn lower(
    nodes: Vec<Node>,
    options: &WorldOptions,
    assets: &AssetCache<'_>,
    kept: &mut Kept,
) -> (World, Vec<Diagnostic>) {
    let (aggregates, materials, mut sink) = lowered(nodes, options, assets, kept);
    sink.extend(super::texture::load_pictures(materials.iter().map(|m| &**m), assets));
    let found = lights::gather(&aggregates, &materials, &mut sink);
    sink.extend(super::texture::load_skies(found.lights.iter().map(|placed| &*placed.light), assets));
    (settled(found, aggregates, materials, kept), sink.into_sorted())
}

/// See [`World::of_shapes`].
pub(super) fn lower_shapes(
    nodes: Vec<Node>,
    assets: &AssetCache<'_>,
    kept: &mut Kept,
) -> (World, Vec<Diagnostic>) {
    let (aggregates, materials, sink) = lowered(nodes, &WorldOptions::default(), assets, kept);
    (settled(Found::default(), aggregates, materials, kept), sink.into_sorted())
}

fn settled(found: Found, aggregates: Vec<Aggregate>, materials: Vec<Arc<Material>>, kept: &Kept) -> World {
    let Found { lights, emitters, glows_unasked } = found;
    let coats = materials.into_iter().map(Coat::new).collect();
    let mut world = World { lights, emitters, glows_unasked, aggregates, coats, reused: kept.reused() };
    for aggregate in &mut world.aggregates {
        if let Aggregate::Group(group) = aggregate {
            group.settle();
        }
    }
    world
}

fn lowered(
    nodes: Vec<Node>,
    options: &WorldOptions,
    assets: &AssetCache<'_>,
    kept: &mut Kept,
) -> (Vec<Aggregate>, Vec<Arc<Material>>, Sink) {
    kept.begin(options.accelerator);
    let mut lowering = Lowering {
        survey: Survey::of(&nodes),
        accelerator: options.accelerator,
        assets,
        kept,
        sink: Sink::default(),
        materials: Materials::new(),
        aggregates: vec![Aggregate::Group(Group::default())],
        heights: vec![0],
        placed: HashMap::new(),
        meshes: Meshes::default(),
        solids: Solids::default(),
        skins: Skins::default(),
        models: Models::default(),
        surfaces: Surfaces::of(&nodes, options.footprint.as_ref()),
    };
    let world_group = lowering.group(Source::Owned(nodes.into_iter()), 0);
    lowering.aggregates[0] = Aggregate::Group(world_group);
    let Lowering { aggregates, materials, sink, .. } = lowering;
    (aggregates, materials.all, sink)
}

/// What is known while a scene is taken apart.
struct Lowering<'a> {
    survey: Survey,
    accelerator: Accelerator,
    assets: &'a AssetCache<'a>,
    /// Of worlds made before.
    kept: &'a mut Kept,
    sink: Sink,
    materials: Materials,
    aggregates: Vec<Aggregate>,
    /// How deeply placements nest below each aggregate.
    heights: Vec<usize>,
    /// Aggregates of shared groups, by the address of their first node. The group is kept so that no other takes its place.
    placed: HashMap<*const Node, (u32, Arc<[Node]>)>,
    meshes: Meshes,
    solids: Solids,
    skins: Skins,
    models: Models,
    surfaces: Surfaces,
}

/// Nodes on their way. Those of a group that nobody else holds are taken out of it one by one, so that they are freed as they go and
/// a group of a group of … is never dropped in one recursion.
enum Source {
    Owned(std::vec::IntoIter<Node>),
    Group { nodes: Arc<[Node]>, next: usize, taken: Node },
}

impl Source {
    fn group(nodes: Arc<[Node]>) -> Source {
        let nowhere = Span::new(crate::diag::SourceId(0), 0, 0);
        let taken = Node::Object(Arc::new(Object::new(Shape::Group(Arc::new([])), nowhere)));
        Source::Group { nodes, next: 0, taken }
    }
}

impl Iterator for Source {
    type Item = Node;

    fn next(&mut self) -> Option<Node> {
        match self {
            Source::Owned(nodes) => nodes.next(),
            Source::Group { nodes, next, taken } => {
                *next += 1;
                match Arc::get_mut(nodes) {
                    Some(own) => own.get_mut(*next - 1).map(|node| std::mem::replace(node, taken.clone())),
                    None => nodes.get(*next - 1).cloned(),
                }
            }
        }
    }
}

/// What the groups around a node hand down.
#[derive(Clone)]
struct Around {
    transform: Option<Affine>,
    material: u32,
    hide: Hide,
    scope: u32,
    /// The area light whose object this is part of.
    area: Option<Arc<Light>>,
}

impl Around {
    const TOP: Around = Around {
        transform: None,
        material: INHERITED,
        hide: Hide { camera: false, shadow: false, reflection: false },
        scope: Scope::TOP,
        area: None,
    };

    /// The transform from an object's own space, given that to its parent's.
    fn place(&self, own: Option<Box<Affine>>) -> Option<Box<Affine>> {
        match (own, &self.transform) {
            (None, None) => None,
            (Some(own), None) => Some(own),
            (None, Some(outer)) => Some(Box::new(*outer)),
            (Some(own), Some(outer)) => Some(Box::new(own.then(outer))),
        }
    }

    fn hides(&self, own: Hide) -> Hide {
        Hide {
            camera: self.hide.camera || own.camera,
            shadow: self.hide.shadow || own.shadow,
            reflection: self.hide.reflection || own.reflection,
        }
    }
}

impl Lowering<'_> {
    /// The group of some nodes, its tree built. Groups inside are dissolved with a stack of our own, since scenes may nest deeply.
    fn group(&mut self, nodes: Source, depth: usize) -> Group {
        let mut group = Group::default();
        if let Source::Owned(nodes) = &nodes {
            group.reserve(nodes.len());
        }
        let mut stack = vec![(nodes, Around::TOP)];
        while let Some((source, around)) = stack.last_mut() {
            let Some(node) = source.next() else {
                stack.pop();
                continue;
            };
            let inside = match node {
                Node::Light(light) => self.light(&mut group, light, around, depth),
                Node::Object(object) => {
                    let object = Arc::try_unwrap(object).unwrap_or_else(|shared| (*shared).clone());
                    self.object(&mut group, object, around, depth)
                }
            };
            stack.extend(inside);
        }
        group.number(&self.aggregates);
        self.plant(&mut group);
        group
    }

    /// What was made of this content, in this world or the one before, or what is made now.
    fn once<T: Any + Send + Sync>(
        &mut self,
        content: Option<Content>,
        make: impl FnOnce(&mut Self) -> Option<Arc<T>>,
    ) -> Option<Arc<T>> {
        if let Some(known) = self.kept.made(content.as_ref()) {
            return Some(known);
        }
        let made = make(self)?;
        self.kept.keep(content, &made);
        Some(made)
    }

    /// Builds the tree.
    fn plant(&self, group: &mut Group) {
        let (count, aggregates) = (group.items.len(), &self.aggregates);
        let bounds_of = |i: usize| group.item_bounds(i, aggregates);
        let tree = Tree::build(self.accelerator, count, bounds_of);
        group.bounds = if tree.is_unbounded() { EVERYTHING } else { tree.bounds() };
        group.tree = tree;
    }

    /// Adds an object; gives the nodes inside where it is a group to be dissolved.
    fn object(
        &mut self,
        group: &mut Group,
        object: Object,
        around: &Around,
        depth: usize,
    ) -> Option<(Source, Around)> {
        let Object { shape, transform, material, name, span, hide } = object;
        let facts = Facts {
            material: material.map_or(around.material, |m| self.materials.number(m)),
            span,
            hide: around.hides(hide),
            scope: around.scope,
            name,
            area: around.area.clone(),
        };
        let transform = around.place(transform);
        match shape {
            Shape::Group(nodes) => {
                if facts.area.is_none() && self.survey.is_shared(&nodes) {
                    let aggregate = self.shared_group(&nodes, depth, span)?;
                    self.instance(group, aggregate, transform, facts);
                    return None;
                }
                let scope = group.open_scope(span, around.scope);
                let Facts { material, hide, area, .. } = facts;
                let transform = transform.map(|t| *t);
                Some((Source::group(nodes), Around { transform, material, hide, scope, area }))
            }
            Shape::Mesh(source) => {
                let aggregate = self.mesh(source, span)?;
                self.instance(group, aggregate, transform, facts);
                None
            }
            Shape::Skin(skin) => {
                let aggregate = self.skin(&skin, span)?;
                self.instance(group, aggregate, transform, facts);
                None
            }
            Shape::Model(source) => {
                let aggregate = self.model(&source, span, depth)?;
                self.instance(group, aggregate, transform, facts);
                None
            }
            Shape::Csg(csg) => {
                if let Some(csg) = self.csg(&csg, span) {
                    group.add(Item::Shape(shape::Shape::Csg(csg), transform), facts);
                }
                None
            }
            Shape::Surface(source) => {
                match self.surface(source, span)? {
                    Drawn::Shape(shape) => group.add(Item::Shape(shape, transform), facts),
                    Drawn::Mesh(aggregate) => self.instance(group, aggregate, transform, facts),
                }
                None
            }
            simple => {
                if let Some(shape) = self.simple(simple, span) {
                    group.add(Item::Shape(shape, transform), facts);
                }
                None
            }
        }
    }

    /// Adds a light; gives its object's nodes where that is a group.
    fn light(
        &mut self,
        group: &mut Group,
        light: Arc<Light>,
        around: &Around,
        depth: usize,
    ) -> Option<(Source, Around)> {
        let transform = around.place(light.transform.clone());
        let LightSource::Area { object, radiance } = &light.source else {
            group.lights.push((light, transform.map_or(Affine::IDENTITY, |t| *t)));
            return None;
        };
        let mut object = (**object).clone();
        object.material = Some(Arc::new(emitting(object.material.as_deref(), *radiance, light.span)));
        let around =
            Around { transform: transform.map(|t| *t), area: Some(Arc::clone(&light)), ..around.clone() };
        self.object(group, object, &around, depth)
    }

    /// The aggregate of a group that is placed more than once.
    fn shared_group(&mut self, nodes: &Arc<[Node]>, depth: usize, span: Span) -> Option<u32> {
        if let Some((index, _)) = self.placed.get(&nodes.as_ptr()) {
            let index = *index;
            return self.may_nest(self.heights[index as usize], span).then_some(index);
        }
        if !self.may_nest(depth + 1, span) {
            return None;
        }
        let group = self.group(Source::group(Arc::clone(nodes)), depth + 1);
        let index = self.keep(Aggregate::Group(group));
        self.placed.insert(nodes.as_ptr(), (index, Arc::clone(nodes)));
        self.may_nest(self.heights[index as usize], span).then_some(index)
    }

    fn may_nest(&mut self, levels: usize, span: Span) -> bool {
        if levels >= MAX_NESTING {
            let message = format!("placements are nested more than {MAX_NESTING} deep; this one is left out");
            let hint = "make the innermost group larger, or place copies of it with a loop";
            self.sink.push(Diagnostic::new(Code::BadGeometry, span, message).hint(hint));
        }
        levels < MAX_NESTING
    }

    /// Stores an aggregate.
    fn keep(&mut self, aggregate: Aggregate) -> u32 {
        let height = match &aggregate {
            Aggregate::Mesh(_) => 0,
            Aggregate::Group(group) => {
                group.placed_aggregates().map(|a| self.heights[a as usize] + 1).max().unwrap_or(0)
            }
        };
        self.aggregates.push(aggregate);
        self.heights.push(height);
        self.aggregates.len() as u32 - 1
    }

    fn instance(&mut self, group: &mut Group, aggregate: u32, transform: Option<Box<Affine>>, facts: Facts) {
        if self.aggregates[aggregate as usize].bounds().is_empty() {
            return;
        }
        let transform = transform.map(|t| *t);
        group.add(Item::Instance(Box::new(Instance { aggregate, transform, first: 0 })), facts);
    }
}

/// What an item has besides its geometry.
struct Facts {
    material: u32,
    span: Span,
    hide: Hide,
    scope: u32,
    name: Option<Box<str>>,
    area: Option<Arc<Light>>,
}

impl Group {
    fn reserve(&mut self, count: usize) {
        self.items.reserve_exact(count);
        self.material.reserve_exact(count);
        self.span.reserve_exact(count);
    }

    fn open_scope(&mut self, span: Span, parent: u32) -> u32 {
        self.scopes.push(Scope { span, parent });
        self.scopes.len() as u32 - 1
    }

    fn placed_aggregates(&self) -> impl Iterator<Item = u32> {
        self.instances.iter().filter_map(|&i| match &self.items[i as usize] {
            Item::Instance(instance) => Some(instance.aggregate),
            Item::Shape(..) => None,
        })
    }

    fn add(&mut self, item: Item, facts: Facts) {
        let index = self.items.len();
        if matches!(item, Item::Instance(_)) {
            self.instances.push(index as u32);
        }
        self.items.push(item);
        self.material.push(facts.material);
        self.span.push(facts.span);
        if !self.scope.is_empty() || facts.scope != Scope::TOP {
            self.scope.resize(index, Scope::TOP);
            self.scope.push(facts.scope);
        }
        if !self.hide.is_empty() || facts.hide != Hide::default() {
            self.hide.resize(index, Hide::default());
            self.hide.push(facts.hide);
        }
        if let Some(name) = facts.name {
            self.names.insert(index as u32, name);
        }
        if let Some(light) = facts.area {
            self.area_lights.push((index as u32, light));
        }
    }
}

/// Materials by number, each once.
struct Materials {
    all: Vec<Arc<Material>>,
    /// Of those that others hold as well; a material that only one object has needs no looking up.
    numbers: HashMap<*const Material, u32>,
}

impl Materials {
    fn new() -> Materials {
        // Its span is that of nothing: no text wrote it.
        let nowhere = Span::new(crate::diag::SourceId(0), 0, 0);
        let plaster = Material { diffuse: Texture::number(0.8), layers: None, span: nowhere };
        Materials { all: vec![Arc::new(plaster)], numbers: HashMap::new() }
    }

    fn number(&mut self, material: Arc<Material>) -> u32 {
        let next = self.all.len() as u32;
        if Arc::strong_count(&material) > 1 {
            let known = *self.numbers.entry(Arc::as_ptr(&material)).or_insert(next);
            if known != next {
                return known;
            }
        }
        self.all.push(material);
        next
    }
}

/// An area light's object is of its own material, black where it has none, and emits besides.
fn emitting(base: Option<&Material>, radiance: Rgb, span: Span) -> Material {
    let black = Material { diffuse: Texture::ZERO, layers: None, span };
    let mut material = base.cloned().unwrap_or(black);
    let mut layers = material.layers().clone();
    layers.emit = Texture::Constant(radiance);
    material.layers = Some(Box::new(layers));
    material
}
