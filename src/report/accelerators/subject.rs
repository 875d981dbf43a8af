//! A mesh under a tree that some builder makes, asked ray by ray. One exact test and one order of ties for all trees.

use crate::geometry::mesh::Mesh;
use crate::math::Aabb;
use crate::scene::Accelerator;
use crate::world::bvh::{self, Costs};
use crate::world::kdtree;
use crate::world::shape::mesh::MeshShape;
use crate::world::shape::triangle::{Sheared, cut::cut};
use crate::world::shape::{LocalRay, Meet};
use crate::world::tree::Tree;
use glam::DVec3;
use std::sync::Arc;

/// What makes the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Builder {
    /// The hierarchy of boxes that scenes use, with packs of four triangles in its leaves. A pack is one test.
    Packs,
    /// The same over triangles one by one, as the other trees.
    Bvh,
    /// The same, halved by number.
    BvhMedian,
    /// The kd-tree that scenes use.
    KdTree,
    /// The same, its boxes cut and not its triangles.
    KdTreeOfBoxes,
    /// All triangles in turn.
    List,
}

impl Builder {
    /// All that make a tree.
    pub const TREES: [Builder; 5] =
        [Builder::Packs, Builder::Bvh, Builder::BvhMedian, Builder::KdTree, Builder::KdTreeOfBoxes];

    /// As reports name it.
    pub fn name(self) -> &'static str {
        match self {
            Builder::Packs => "bvh",
            Builder::Bvh => "bvh, one by one",
            Builder::BvhMedian => "bvh, one by one, halves by number",
            Builder::KdTree => "kdtree",
            Builder::KdTreeOfBoxes => "kdtree of boxes",
            Builder::List => "none",
        }
    }
}

/// What a ray asked of a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Nodes visited, leaves of a kd-tree among them.
    pub nodes: u64,
    /// Triangles tested, or packs of them.
    pub tests: u64,
}

/// A half-line: from where, to where, and how far in units of its direction.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes.
    pub direction: DVec3,
    /// Meetings beyond do not count.
    pub t_max: f64,
}

/// A mesh and its tree.
pub struct Subject<'m> {
    mesh: &'m Mesh,
    leaves: Leaves,
}

/// What is in a tree's leaves.
enum Leaves {
    Packs(MeshShape),
    /// Triangles, in the tree's order.
    Single(Vec<[u32; 3]>, Tree),
}

impl<'m> Subject<'m> {
    /// Builds the tree.
    pub fn new(mesh: &'m Mesh, builder: Builder) -> Subject<'m> {
        if builder == Builder::Packs {
            let shape = MeshShape::new(Arc::new(mesh.clone()), None, Accelerator::Bvh);
            return Subject { mesh, leaves: Leaves::Packs(shape) };
        }
        let n = mesh.triangles.len();
        let corners = |i: usize| mesh.triangles[i].map(|p| mesh.positions[p as usize]);
        let bounds = |i: usize| Aabb::of(corners(i));
        let clip = |i: usize, cell: &Aabb| cut(corners(i), cell);
        let tree = match builder {
            Builder::Packs | Builder::Bvh => Tree::Bvh(bvh::Tree::build(n, bounds)),
            Builder::BvhMedian => Tree::Bvh(bvh::Tree::build_median(n, bounds)),
            Builder::KdTree => Tree::build_clipped(Accelerator::KdTree, &Costs::SINGLE, n, bounds, clip),
            Builder::KdTreeOfBoxes => Tree::KdTree(kdtree::Tree::build(n, bounds)),
            Builder::List => Tree::Bvh(bvh::Tree::list(n, bounds)),
        };
        let triangles = tree.order().iter().map(|&i| mesh.triangles[i as usize]).collect();
        Subject { mesh, leaves: Leaves::Single(triangles, tree) }
    }

    /// Memory of the nodes and of what is in the leaves, bytes.
    pub fn bytes(&self) -> [usize; 2] {
        match &self.leaves {
            Leaves::Packs(shape) => shape.tree_bytes(),
            Leaves::Single(_, tree) => tree.bytes(),
        }
    }

    /// How often leaves name triangles.
    pub fn references(&self) -> usize {
        match self.tree() {
            Tree::Bvh(tree) => tree.order().len(),
            Tree::KdTree(tree) => tree.reference_count(),
        }
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.tree().node_count()
    }

    fn tree(&self) -> &Tree {
        match &self.leaves {
            Leaves::Packs(shape) => &shape.tree,
            Leaves::Single(_, tree) => tree,
        }
    }

    /// The nearest meeting, or any: distance and triangle; of equally near ones the first triangle. None too for a line without direction.
    #[inline]
    pub fn meet(&self, line: &Line, any: bool) -> Option<(f64, u32)> {
        let mut asked = Asked::new(self.mesh, line, any)?;
        let (ray, limit) = (asked.ray, asked.limit);
        match &self.leaves {
            Leaves::Packs(shape) => shape.meetings(&ray, limit, |triangle, meet| asked.offer(triangle, meet)),
            Leaves::Single(triangles, tree) => {
                tree.traverse(ray.origin, ray.direction, limit, |range, _| {
                    asked.leaf(triangles, tree, range)
                });
            }
        }
        asked.found()
    }

    /// What [`Subject::meet`] costs.
    pub fn work(&self, line: &Line, any: bool) -> Work {
        let Some(mut asked) = Asked::new(self.mesh, line, any) else { return Work::default() };
        let (ray, limit) = (asked.ray, asked.limit);
        let (triangles, tree) = match &self.leaves {
            Leaves::Packs(shape) => {
                let [nodes, tests] =
                    shape.meetings_counting(&ray, limit, |triangle, meet| asked.offer(triangle, meet));
                return Work { nodes, tests };
            }
            Leaves::Single(triangles, tree) => (triangles, tree),
        };
        let mut work = Work::default();
        let leaf = |range: std::ops::Range<usize>, _: f64| {
            work.tests += range.len() as u64;
            asked.leaf(triangles, tree, range)
        };
        let mut nodes = 0;
        match tree {
            Tree::Bvh(tree) => nodes = tree.traverse_counting(ray.origin, ray.direction, limit, leaf),
            Tree::KdTree(tree) => {
                tree.traverse_counting(ray.origin, ray.direction, limit, || nodes += 1, leaf);
            }
        }
        Work { nodes, ..work }
    }
}

/// A ray under way.
struct Asked<'m> {
    mesh: &'m Mesh,
    ray: LocalRay,
    sheared: Sheared,
    per_line: f64,
    limit: f64,
    any: bool,
    best: Option<(f64, u32)>,
}

impl<'m> Asked<'m> {
    #[inline]
    fn new(mesh: &'m Mesh, line: &Line, any: bool) -> Option<Asked<'m>> {
        let (ray, per_line) = LocalRay::new(line.origin, line.direction)?;
        let limit = line.t_max.next_down() * per_line;
        Some(Asked { mesh, sheared: Sheared::new(&ray), ray, per_line, limit, any, best: None })
    }

    #[inline(always)]
    fn leaf(&mut self, triangles: &[[u32; 3]], tree: &Tree, range: std::ops::Range<usize>) -> f64 {
        let mut limit = self.limit;
        for place in range {
            let corners = triangles[place].map(|p| self.mesh.positions[p as usize]);
            if let Some(meet) = self.sheared.meet(corners.each_ref(), self.limit) {
                limit = self.offer(tree.order()[place], meet);
            }
        }
        limit
    }

    /// Takes a meeting where it is better; gives what limits others.
    #[inline(always)]
    fn offer(&mut self, triangle: u32, meet: Meet) -> f64 {
        if self.best.is_none_or(|(t, first)| meet.t < t || (meet.t == t && triangle < first)) {
            self.best = Some((meet.t, triangle));
            self.limit = meet.t;
        }
        if self.any { -1.0 } else { self.limit }
    }

    #[inline]
    fn found(&self) -> Option<(f64, u32)> {
        self.best.map(|(t, triangle)| (t / self.per_line, triangle))
    }
}
