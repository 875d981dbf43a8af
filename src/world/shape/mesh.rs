//! Meshes as rays meet them: shared vertices, triangles in the order of their tree.

use super::triangle::leaf;
use super::triangle::search::Ordered;
use super::triangle::{Corners, Sheared, bounds_of, cut, surface_of};
use super::{LocalRay, Meet, Surface};
use crate::geometry::mesh::Mesh;
use crate::geometry::skin::Influences;
use crate::scene::{Accelerator, Armature};
use crate::world::packet::{Members, Packet, RAYS};
use crate::world::tree::Tree;
use glam::DVec3;
use std::sync::Arc;

/// A mesh and its tree.
#[derive(Clone, Debug)]
pub struct MeshShape {
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// Of its triangles in the tree's order, so that a leaf reads consecutive memory.
    corners: leaf::Corners,
    /// Over the triangles.
    pub tree: Tree,
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
        let of = |i: usize| corners(&mesh, mesh.triangles[i]);
        let tree = Tree::build_of_triangles(
            accelerator,
            count,
            |i| bounds_of(of(i)),
            |i, cell| cut::cut(of(i), cell),
        );
        let triangles = tree.order().iter().map(|&i| mesh.triangles[i as usize]);
        let corners = leaf::Corners::new(&mesh.positions, triangles);
        MeshShape { mesh, corners, tree, worn: worn.map(Box::new) }
    }

    /// A ray against the triangle at a position of the tree's order.
    #[inline(always)]
    pub fn meet(&self, position: usize, ray: &Sheared, limit: f64) -> Option<Meet> {
        ray.meet(self.corners_at(position).each_ref(), limit)
    }

    /// The nearest meeting at a distance in (0, limit], or any, and its position in the tree's order; of equally near ones the first triangle.
    #[inline]
    pub fn meet_nearest(&self, ray: &LocalRay, limit: f64, any: bool) -> Option<(usize, Meet)> {
        self.ordered().nearest(&self.tree, ray, limit, any)
    }

    /// The nearest meetings of rays from one point, each as [`MeshShape::meet_nearest`] finds it within its limit: the ray's number, position and
    /// meeting. Limits of those that are no members are negative.
    #[inline]
    pub fn meet_nearest_each(
        &self,
        rays: (&Packet, Members),
        limits: &[f64; RAYS],
        tell: impl FnMut(usize, usize, Meet),
    ) {
        self.ordered().nearest_each(&self.tree, rays, limits, tell);
    }

    #[inline(always)]
    fn ordered(&self) -> Ordered<'_> {
        Ordered { corners: &self.corners, mesh: &self.mesh, order: self.tree.order() }
    }

    #[inline(always)]
    fn corners_at(&self, position: usize) -> [DVec3; 3] {
        self.ordered().corners_at(position)
    }

    /// Every meeting with t > 0, ascending, ties by triangle: as [`super::Shape::crossings`], with the triangle's number as the face.
    ///
    /// A ray through an edge or a corner of a closed mesh meets several triangles in one place. Each edge belongs to one of its two
    /// triangles, by where it would lie were the ray moved by next to nothing; a meeting with another is a touch, and stands twice.
    pub fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        let first = out.len();
        let sheared = Sheared::new(ray);
        self.tree.traverse_all(ray.origin, ray.direction, |range| {
            for position in range {
                if let Some(meet) = self.meet(position, &sheared, f64::MAX) {
                    let owned = sheared.is_owner(self.corners_at(position).each_ref());
                    let meet = Meet { face: self.triangle_at(position), ..meet };
                    out.extend(std::iter::repeat_n(meet, if owned { 1 } else { 2 }));
                }
            }
            true
        });
        out[first..].sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
    }

    /// The triangle at a position of the tree's order, by its number in the mesh.
    #[inline]
    pub fn triangle_at(&self, position: usize) -> u32 {
        self.tree.order()[position]
    }

    /// The place of a skin where a triangle was met; none on what is no skin.
    pub fn worn_at(&self, triangle: u32, meet: &Meet) -> Option<WornPlace<'_>> {
        let worn = self.worn.as_deref()?;
        let shares = [1.0 - meet.a - meet.b, meet.a, meet.b];
        Some(WornPlace { worn, corners: self.mesh.triangles[triangle as usize], shares })
    }

    /// The surface of a triangle of the mesh, with its tangent where its normal is to be `bent` by a map.
    #[inline(always)]
    pub fn surface(&self, triangle: u32, meet: &Meet, bent: bool) -> Surface {
        let mesh = &self.mesh;
        let indices = mesh.triangles[triangle as usize];
        let data = Corners {
            normals: (!mesh.normals.is_empty()).then(|| three(&mesh.normals, indices)),
            uvs: (!mesh.uvs.is_empty()).then(|| three(&mesh.uvs, indices)),
        };
        surface_of(three(&mesh.positions, indices), data, meet, bent)
    }
}

#[inline(always)]
fn corners(mesh: &Mesh, indices: [u32; 3]) -> [DVec3; 3] {
    three(&mesh.positions, indices).map(|p| *p)
}

/// What stands at three places.
#[inline(always)]
fn three<T>(all: &[T], [a, b, c]: [u32; 3]) -> [&T; 3] {
    [&all[a as usize], &all[b as usize], &all[c as usize]]
}
