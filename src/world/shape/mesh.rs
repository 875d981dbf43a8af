//! Meshes as rays meet them: shared vertices, and a tree over packs of triangles, which propose what the exact test decides.

mod packs;

use super::triangle::{Corners, Sheared, bounds_of, cut, surface_of};
use super::{LocalRay, Meet, Surface};
use crate::geometry::mesh::Mesh;
use crate::geometry::skin::Influences;
use crate::math::Aabb;
use crate::scene::{Accelerator, Armature};
use crate::world::bvh::{Costs, Entry, Visitor};
use crate::world::tree::Tree;
use glam::DVec3;
use packs::{LANES, Pack, PackRay};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// A mesh and its tree.
#[derive(Clone, Debug)]
pub struct MeshShape {
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// Over the triangles.
    pub tree: Tree,
    /// Its triangles in the tree's order; none without a tree, where each is tested exactly.
    packs: Vec<Pack>,
    /// Of a skin, what it was before its bones moved it.
    pub worn: Option<Box<Worn>>,
}

/// What a skin was at rest, by vertex: patterns stay with it.
#[derive(Clone, Debug)]
pub struct Worn {
    /// Where each vertex was, in the space of the bones.
    pub rest: Vec<DVec3>,
    /// The joints that moved it, and by how much.
    pub influences: Influences,
    /// The joints.
    pub armature: Arc<Armature>,
}

/// A place of a skin: in a triangle, by the shares of its corners.
#[derive(Clone, Copy, Debug)]
pub struct WornPlace<'w> {
    worn: &'w Worn,
    corners: [u32; 3],
    shares: [f64; 3],
}

impl WornPlace<'_> {
    /// Where it was before its bones moved it.
    pub fn rest(&self) -> DVec3 {
        let corner = |(i, share): (&u32, &f64)| self.worn.rest[*i as usize] * *share;
        self.corners.iter().zip(&self.shares).map(corner).sum()
    }

    /// How much a joint moves it; 0 of no joint of its skeleton.
    pub fn weight(&self, joint: &str) -> f64 {
        let Some(number) = self.worn.armature.names.iter().position(|name| **name == *joint) else {
            return 0.0;
        };
        let at = |i: &u32| {
            let (joints, weights) = self.worn.influences.of(*i as usize);
            joints
                .iter()
                .zip(weights)
                .filter(|(j, _)| usize::from(**j) == number)
                .map(|(_, w)| w)
                .sum::<f64>()
        };
        self.corners.iter().zip(&self.shares).map(|(i, share)| at(i) * share).sum()
    }
}

impl MeshShape {
    /// Builds the tree.
    pub fn new(mesh: Arc<Mesh>, worn: Option<Worn>, accelerator: Accelerator) -> MeshShape {
        let count = mesh.triangles.len();
        let of = |i: usize| corners(&mesh, i as u32).map(|p| *p);
        let (bounds, clip) = (|i: usize| bounds_of(of(i)), |i: usize, cell: &Aabb| cut::cut(of(i), cell));
        let tree = Tree::build_clipped(accelerator, &COSTS, count, bounds, clip);
        let packs = match (&tree, accelerator) {
            (Tree::Bvh(tree), Accelerator::Bvh) => {
                let pack = |some: &[u32]| Pack::new(tree.frame(), some.iter().map(|&i| of(i as usize)));
                tree.order().par_chunks(LANES).with_min_len(PACKS_BY_ONE_THREAD).map(pack).collect()
            }
            _ => Vec::new(),
        };
        MeshShape { mesh, tree, packs, worn: worn.map(Box::new) }
    }

    /// Offers every triangle that the ray meets at a distance in (0, limit] to `found`, by its number in the mesh, in no order, some
    /// perhaps more than once. `found` gives the limit from then on; a negative one ends it.
    #[inline(always)]
    pub fn meetings(&self, ray: &LocalRay, limit: f64, found: impl FnMut(u32, Meet) -> f64) {
        let mut walk = Walk { shape: self, exact: Sheared::new(ray), packs: PackRay::default(), found };
        match &self.tree {
            Tree::Bvh(tree) if !self.packs.is_empty() => {
                let limit = walk.decide_all(tree.loose(), limit);
                tree.visit(ray.origin, ray.direction, limit, &mut walk);
            }
            tree => {
                tree.traverse(ray.origin, ray.direction, limit, |range, limit| walk.decide_all(range, limit))
            }
        }
    }

    /// As [`MeshShape::meetings`] where there are packs, for those who measure; gives how many nodes were visited and packs tested.
    pub fn meetings_counting(
        &self,
        ray: &LocalRay,
        limit: f64,
        found: impl FnMut(u32, Meet) -> f64,
    ) -> [u64; 2] {
        let Tree::Bvh(tree) = &self.tree else { return [0; 2] };
        let walk = Walk { shape: self, exact: Sheared::new(ray), packs: PackRay::default(), found };
        let mut counted = Counted { walk, packs: 0 };
        let limit = counted.walk.decide_all(tree.loose(), limit);
        let nodes = tree.visit_counting(ray.origin, ray.direction, limit, &mut counted);
        [nodes, counted.packs]
    }

    /// Memory of the tree's nodes, and of packs and the order of triangles, bytes.
    pub fn tree_bytes(&self) -> [usize; 2] {
        let [nodes, order] = self.tree.bytes();
        [nodes, order + size_of_val(&*self.packs)]
    }

    /// Every meeting with t > 0, ascending, ties by triangle: as [`super::Shape::crossings`], with the triangle's number as the face.
    ///
    /// A ray through an edge or a corner of a closed mesh meets several triangles in one place. Each edge belongs to one of its two
    /// triangles, by where it would lie were the ray moved by next to nothing; a meeting with another is a touch, and stands twice.
    pub fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        let first = out.len();
        let sheared = Sheared::new(ray);
        self.tree.traverse_all(ray.origin, ray.direction, |range| {
            for &face in &self.tree.order()[range] {
                let corners = corners(&self.mesh, face);
                if let Some(meet) = sheared.meet(corners, f64::MAX) {
                    let owned = sheared.is_owner(corners);
                    out.extend(std::iter::repeat_n(Meet { face, ..meet }, if owned { 1 } else { 2 }));
                }
            }
            true
        });
        out[first..].sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
    }

    /// The place of a skin where a triangle was met; none on what is no skin.
    pub fn worn_at(&self, triangle: u32, meet: &Meet) -> Option<WornPlace<'_>> {
        let worn = self.worn.as_deref()?;
        let shares = [1.0 - meet.a - meet.b, meet.a, meet.b];
        Some(WornPlace { worn, corners: self.mesh.triangles[triangle as usize], shares })
    }

    /// The surface of a triangle of the mesh, with its tangent where its normal is to be `bent` by a map.
    pub fn surface(&self, triangle: u32, meet: &Meet, bent: bool) -> Surface {
        let mesh = &self.mesh;
        let indices = mesh.triangles[triangle as usize];
        let data = Corners {
            normals: (!mesh.normals.is_empty()).then(|| three(&mesh.normals, indices)),
            uvs: (!mesh.uvs.is_empty()).then(|| three(&mesh.uvs, indices)),
        };
        surface_of(corners(mesh, triangle).map(|p| *p), data, meet, bent)
    }
}

/// Packs are tested four triangles at once. Measured on meshes of 36 to 1.3 million triangles: half of both costs makes 60 % more nodes
/// for at most 5 % of the rays' time.
const COSTS: Costs = Costs { lanes: LANES as u32, node: 1.0, child: 0.5 };

/// So many packs are made by one thread: fewer wake no other.
const PACKS_BY_ONE_THREAD: usize = 1 << 10;

/// A ray in a mesh's tree.
struct Walk<'m, F> {
    shape: &'m MeshShape,
    exact: Sheared,
    packs: PackRay,
    found: F,
}

impl<F: FnMut(u32, Meet) -> f64> Walk<'_, F> {
    /// The limit after a triangle's exact test.
    #[inline(always)]
    fn decide(&mut self, triangle: u32, limit: f64) -> f64 {
        match self.exact.meet(corners(&self.shape.mesh, triangle), limit) {
            Some(meet) => (self.found)(triangle, meet),
            None => limit,
        }
    }

    /// The same of all in a range of the tree's order.
    #[inline(always)]
    fn decide_all(&mut self, range: Range<usize>, limit: f64) -> f64 {
        self.shape.tree.order()[range].iter().fold(limit, |limit, &triangle| self.decide(triangle, limit))
    }
}

impl<F: FnMut(u32, Meet) -> f64> Visitor for Walk<'_, F> {
    #[inline(always)]
    fn enter(&mut self, entry: &Entry) {
        self.packs = PackRay::new(entry, self.exact.axes(), self.exact.shear());
    }

    #[inline(always)]
    fn leaf(&mut self, range: Range<usize>, mut t_max: f64, limit: f32) -> f64 {
        for first in range.clone().step_by(LANES) {
            let absent = !0 << (range.end - first).min(LANES);
            let mut proposed = self.packs.propose(&self.shape.packs[first / LANES], limit) & !absent;
            while proposed != 0 {
                let position = first + proposed.trailing_zeros() as usize;
                proposed &= proposed - 1;
                t_max = self.decide_all(position..position + 1, t_max);
            }
            if t_max < 0.0 {
                break;
            }
        }
        t_max
    }
}

/// A walk that counts packs.
struct Counted<W> {
    walk: W,
    packs: u64,
}

impl<W: Visitor> Visitor for Counted<W> {
    fn enter(&mut self, entry: &Entry) {
        self.walk.enter(entry);
    }

    fn leaf(&mut self, range: Range<usize>, t_max: f64, limit: f32) -> f64 {
        self.packs += range.len().div_ceil(LANES) as u64;
        self.walk.leaf(range, t_max, limit)
    }
}

#[inline(always)]
fn corners(mesh: &Mesh, triangle: u32) -> [&DVec3; 3] {
    let [a, b, c] = mesh.triangles[triangle as usize];
    let at = |i: u32| &mesh.positions[i as usize];
    [at(a), at(b), at(c)]
}

/// What stands at three places.
#[inline(always)]
fn three<T: Copy>(all: &[T], [a, b, c]: [u32; 3]) -> [T; 3] {
    [all[a as usize], all[b as usize], all[c as usize]]
}
