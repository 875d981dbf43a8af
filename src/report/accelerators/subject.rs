//! A mesh under a tree that some builder makes, asked ray by ray. One triangle test and one order of ties for all trees.

use crate::geometry::mesh::Mesh;
use crate::math::Aabb;
use crate::scene::Accelerator;
use crate::world::packet::{Packet, RAYS};
use crate::world::shape::LocalRay;
use crate::world::shape::triangle::search::{Ordered, Search};
use crate::world::shape::triangle::{Sheared, cut::cut, leaf};
use crate::world::tree::Tree;
use crate::world::{bvh, kdtree};
use glam::DVec3;
use std::ops::Range;

/// What makes the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Builder {
    /// The hierarchy of boxes that scenes use.
    Bvh,
    /// The same, built from the triangles up.
    BvhBottomUp,
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
        [Builder::Bvh, Builder::BvhBottomUp, Builder::BvhMedian, Builder::KdTree, Builder::KdTreeOfBoxes];

    /// As reports name it.
    pub fn name(self) -> &'static str {
        match self {
            Builder::Bvh => "bvh",
            Builder::BvhBottomUp => "bvh, bottom up",
            Builder::BvhMedian => "bvh, halves by number",
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
    /// Triangles tested.
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
    /// In the tree's order.
    corners: leaf::Corners,
    tree: Tree,
}

impl<'m> Subject<'m> {
    /// Builds the tree.
    pub fn new(mesh: &'m Mesh, builder: Builder) -> Subject<'m> {
        let n = mesh.triangles.len();
        let corners = |i: usize| mesh.triangles[i].map(|p| mesh.positions[p as usize]);
        let bounds = |i: usize| Aabb::of(corners(i));
        let clip = |i: usize, cell: &Aabb| cut(corners(i), cell);
        let tree = match builder {
            Builder::Bvh => Tree::Bvh(bvh::Tree::build_of_triangles(n, bounds)),
            Builder::BvhBottomUp => Tree::Bvh(bvh::Tree::build_bottom_up(n, bounds)),
            Builder::BvhMedian => Tree::Bvh(bvh::Tree::build_median(n, bounds)),
            Builder::KdTree => Tree::build_of_triangles(Accelerator::KdTree, n, bounds, clip),
            Builder::KdTreeOfBoxes => Tree::KdTree(kdtree::Tree::build(n, bounds)),
            Builder::List => Tree::Bvh(bvh::Tree::list(n, bounds)),
        };
        let triangles = tree.order().iter().map(|&i| mesh.triangles[i as usize]);
        let corners = leaf::Corners::new(&mesh.positions, triangles);
        Subject { mesh, corners, tree }
    }

    /// Memory of the nodes and of what is in the leaves, bytes; with the corners of its triangles, which stand in the tree's order.
    pub fn bytes(&self) -> [usize; 2] {
        let [nodes, leaves] = match &self.tree {
            Tree::Bvh(tree) => tree.bytes(),
            Tree::KdTree(tree) => tree.bytes(),
        };
        [nodes, leaves + self.corners.bytes()]
    }

    /// How often leaves name triangles.
    pub fn references(&self) -> usize {
        match &self.tree {
            Tree::Bvh(_) => self.mesh.triangles.len(),
            Tree::KdTree(tree) => tree.reference_count(),
        }
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.tree.node_count()
    }

    /// The nearest meeting, or any: distance and triangle; of equally near ones the first triangle. None too for a line without direction.
    #[inline(always)]
    pub fn meet(&self, line: &Line, any: bool) -> Option<(f64, u32)> {
        let Local { ray, per_line, limit } = Local::new(line)?;
        let met = self.ordered().nearest(&self.tree, &ray, limit, any);
        met.map(|(place, meet)| (meet.t / per_line, self.tree.order()[place]))
    }

    /// The nearest meetings of lines, no more than a packet has rays, as [`Subject::meet`] finds each.
    #[inline]
    pub fn meet_each(&self, lines: &[Line], mut tell: impl FnMut(usize, Option<(f64, u32)>)) {
        let (mut per_line, mut limits) = ([1.0; RAYS], [-1.0; RAYS]);
        let packet = Packet::new(|i| {
            let local = Local::new(lines.get(i)?)?;
            (per_line[i], limits[i]) = (local.per_line, local.limit);
            Some(local.ray)
        });
        let Some(packet) = packet else {
            lines.iter().enumerate().for_each(|(i, line)| tell(i, self.meet(line, false)));
            return;
        };
        let order = self.tree.order();
        (0..lines.len()).for_each(|i| tell(i, None));
        self.ordered().nearest_each(&self.tree, (&packet, packet.members), &limits, |i, at, meet| {
            tell(i, Some((meet.t / per_line[i], order[at])));
        });
    }

    fn ordered(&self) -> Ordered<'_> {
        Ordered { corners: &self.corners, mesh: self.mesh, order: self.tree.order() }
    }

    /// How far a line goes to one triangle; none where it misses that.
    pub fn distance_to(&self, line: &Line, triangle: u32) -> Option<f64> {
        let Local { ray, per_line, limit } = Local::new(line)?;
        let corners = self.mesh.triangles[triangle as usize].map(|p| self.mesh.positions[p as usize]);
        let meet = Sheared::new(&ray).meet(corners.each_ref(), limit)?;
        Some(meet.t / per_line)
    }

    /// What [`Subject::meet`] costs.
    pub fn work(&self, line: &Line, any: bool) -> Work {
        let Some(Local { ray, limit, .. }) = Local::new(line) else { return Work::default() };
        let LocalRay { origin, direction } = ray;
        let mut search = Search::new(self.ordered(), &ray, limit, any);
        let (mut nodes, mut tests) = (0, 0);
        let mut count = |range: &Range<usize>| tests += range.len() as u64;
        match &self.tree {
            Tree::Bvh(tree) if any => {
                nodes = tree.traverse_any_counting(origin, direction, limit, |range| {
                    count(&range);
                    search.goes_on(range)
                });
            }
            Tree::Bvh(tree) => {
                nodes = tree.traverse_counting(origin, direction, limit, |range, _| {
                    count(&range);
                    search.limit_after(range)
                });
            }
            Tree::KdTree(tree) => tree.traverse_counting(
                origin,
                direction,
                limit,
                || nodes += 1,
                |range, _| {
                    count(&range);
                    search.limit_after(range)
                },
            ),
        }
        Work { nodes, tests }
    }
}

/// A line as trees are asked.
struct Local {
    ray: LocalRay,
    /// How many of the ray's distances make one of the line's.
    per_line: f64,
    /// Largest distance that counts, in the ray's.
    limit: f64,
}

impl Local {
    #[inline]
    fn new(line: &Line) -> Option<Local> {
        let (ray, per_line) = LocalRay::new(line.origin, line.direction)?;
        Some(Local { ray, per_line, limit: line.t_max.min(f64::MAX) * per_line })
    }
}
