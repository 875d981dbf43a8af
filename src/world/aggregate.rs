//! What a world stores: shapes and placements in groups, each with a tree; meshes with theirs; and how a placement of a
//! placement is counted.

use super::RayKind;
use super::bvh::fetch_entry;
use super::query::is_hidden;
use super::shape::mesh::MeshShape;
use super::shape::{Csg, EVERYTHING, Shape, image_of};
use super::tree::Tree;
use crate::diag::Span;
use crate::math::{Aabb, Affine};
use crate::scene::{Hide, Light};
use std::collections::HashMap;
use std::sync::Arc;

/// A material that the group around decides.
pub(super) const INHERITED: u32 = u32::MAX;

/// Things under one tree, in one space. The world itself is the first.
#[derive(Debug)]
#[allow(clippy::large_enum_variant, reason = "few, and walked for every ray: no box between")]
pub(super) enum Aggregate {
    Group(Group),
    Mesh(MeshAggregate),
}

impl Aggregate {
    pub fn tree(&self) -> &Tree {
        match self {
            Aggregate::Group(group) => &group.tree,
            Aggregate::Mesh(mesh) => &mesh.shape.tree,
        }
    }

    /// Around everything; all of space where something is infinite.
    pub fn bounds(&self) -> Aabb {
        match self {
            Aggregate::Group(group) => group.bounds,
            Aggregate::Mesh(mesh) => mesh.bounds,
        }
    }

    /// How many placements it holds, those inside its placements included.
    pub fn placements(&self) -> u64 {
        match self {
            Aggregate::Group(group) => group.placements,
            Aggregate::Mesh(_) => 0,
        }
    }
}

/// A mesh and the materials of its file.
#[derive(Debug)]
pub(super) struct MeshAggregate {
    pub shape: Arc<MeshShape>,
    pub bounds: Aabb,
    /// By the mesh's own numbers; empty where it has none.
    pub materials: Arc<[u32]>,
}

impl MeshAggregate {
    /// The material that the mesh's file gives a triangle.
    pub fn material_of(&self, triangle: u32) -> u32 {
        mesh_material(&self.shape, &self.materials, triangle)
    }
}

/// The material that a mesh's file gives a triangle, by the numbers of its materials.
pub(super) fn mesh_material(shape: &MeshShape, materials: &[u32], triangle: u32) -> u32 {
    let own = shape.mesh.material_of_triangle.get(triangle as usize);
    own.and_then(|&m| materials.get(m as usize)).copied().unwrap_or(INHERITED)
}

/// Shapes and placements, in the order of the scene, as columns: what a ray needs first apart from what a hit needs.
#[derive(Debug, Default)]
pub(super) struct Group {
    /// In the order of the tree once it is settled, so that a leaf reads consecutive memory; all other columns keep the scene's.
    pub items: Vec<Item>,
    pub tree: Tree,
    pub bounds: Aabb,
    /// Per item, an index of the world's materials or [`INHERITED`].
    pub material: Vec<u32>,
    pub span: Vec<Span>,
    /// The group of the scene that an item stood in; empty where all stood at the top.
    pub scope: Vec<u32>,
    pub scopes: Vec<Scope>,
    /// Empty where nothing is hidden from anyone.
    pub hide: Vec<Hide>,
    /// Names of the few that have one.
    pub names: HashMap<u32, Box<str>>,
    pub lights: Vec<(Arc<Light>, Affine)>,
    /// Items that are the objects of area lights, with them.
    pub area_lights: Vec<(u32, Arc<Light>)>,
    /// Where in `items` the placements are, in the order of the scene.
    pub instances: Vec<u32>,
    pub placements: u64,
}

/// A group of the scene that was dissolved into a larger one; kept for provenance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scope {
    pub span: Span,
    /// The scope around it; [`Scope::TOP`] for none.
    pub parent: u32,
}

impl Scope {
    pub const TOP: u32 = u32::MAX;
}

/// Something a ray may meet.
#[derive(Debug)]
pub(super) enum Item {
    /// A shape, and the transform from its own space where there is one.
    Shape(Shape, Option<Box<Affine>>),
    /// An aggregate placed.
    Instance(Box<Instance>),
}

#[derive(Debug)]
pub(super) struct Instance {
    pub aggregate: u32,
    /// The space around from the aggregate's. None for the identity.
    pub transform: Option<Affine>,
    /// Added to the number of the placement around to number this one; see [`Group::number`].
    pub first: u64,
}

impl Group {
    /// The spans of the groups around an item, outermost first.
    pub fn scopes_around(&self, item: usize) -> Vec<Span> {
        let mut spans = Vec::new();
        let mut at = self.scope.get(item).copied().unwrap_or(Scope::TOP);
        while at != Scope::TOP {
            let scope = self.scopes[at as usize];
            spans.push(scope.span);
            at = scope.parent;
        }
        spans.reverse();
        spans
    }

    /// Numbers the placements: a placement's number is that of the one around it plus `first`, and the numbers of all that it holds
    /// follow its own. Saturates beyond 2⁶⁴ placements, where numbers are no longer unique.
    pub fn number(&mut self, aggregates: &[Aggregate]) {
        let mut next = 1u64;
        for &item in &self.instances {
            if let Item::Instance(instance) = &mut self.items[item as usize] {
                instance.first = next;
                next = next
                    .saturating_add(1)
                    .saturating_add(aggregates[instance.aggregate as usize].placements());
            }
        }
        self.placements = next - 1;
    }

    /// Puts the items in the order of the tree, in place: cycle by cycle, as there may be millions.
    pub fn settle(&mut self) {
        debug_assert_eq!(self.tree.order().len(), self.items.len(), "every item has a box that is not empty");
        let mut position = vec![0u32; self.items.len()];
        for (at, &item) in self.tree.order().iter().enumerate() {
            position[item as usize] = at as u32;
        }
        for item in &mut self.instances {
            *item = position[*item as usize];
        }
        for i in 0..position.len() {
            while position[i] as usize != i {
                let to = position[i] as usize;
                fetch_entry(&self.items, position[to] as usize);
                self.items.swap(i, to);
                position.swap(i, to);
            }
        }
    }

    /// The number in the scene's order of the item at a position.
    pub fn number_of(&self, position: u32) -> u32 {
        self.tree.order()[position as usize]
    }

    /// Whether rays of a kind pass through the item at a position.
    #[inline(always)]
    pub fn hides(&self, position: usize, kind: RayKind) -> bool {
        !self.hide.is_empty() && is_hidden(self.hide[self.number_of(position as u32) as usize], kind)
    }

    /// The solid put together that an item is, by its number in the scene's order, if it is one.
    pub fn csg(&self, number: u32) -> Option<&Csg> {
        let position = self.tree.order().iter().position(|&n| n == number)?;
        match &self.items[position] {
            Item::Shape(Shape::Csg(csg), _) => Some(csg),
            Item::Shape(..) | Item::Instance(_) => None,
        }
    }

    /// The position of the placement that holds, or is, the one numbered `id` from this group; none for 0.
    #[inline]
    pub fn placement(&self, id: u64) -> Option<u32> {
        let first = |item: u32| match &self.items[item as usize] {
            Item::Instance(instance) => instance.first,
            Item::Shape(..) => u64::MAX,
        };
        let after = self.instances.partition_point(|&i| first(i) <= id);
        self.instances.get(after.checked_sub(1)?).copied()
    }

    /// The box around an item, in this group's space.
    pub fn item_bounds(&self, item: usize, aggregates: &[Aggregate]) -> Aabb {
        match &self.items[item] {
            Item::Shape(shape, transform) => shape.bounds(transform.as_deref()),
            Item::Instance(instance) => {
                let bounds = aggregates[instance.aggregate as usize].bounds();
                match &instance.transform {
                    _ if bounds.is_empty() || bounds == EVERYTHING => bounds,
                    None => bounds,
                    Some(transform) => image_of(bounds, transform),
                }
            }
        }
    }
}
