//! Bicubic patches by Newton's steps from one start, and as triangles.

use super::shapes::{Line, triangle_moller_trumbore};
use crate::geometry::patch::tessellate::{Steps, dice};
use crate::geometry::patch::{Bicubic, Patch};
use crate::math::Aabb;
use crate::world::bvh::Tree;
use glam::DVec3;

/// Steps before Newton is given up, and the distance from the ray that is taken for a hit.
const STEPS: usize = 50;
const CLOSE: f64 = 1e-10;

/// A hit by Newton's steps on the distances to two planes through the ray, from near the middle (at the very middle of a symmetric
/// patch there may be no step); whichever it comes to.
pub fn newton(piece: &Bicubic, line: &Line) -> Option<f64> {
    let n = line.direction.any_orthogonal_vector().normalize();
    let m = line.direction.cross(n).normalize();
    let (mut u, mut v) = (0.45, 0.55);
    for _ in 0..STEPS {
        let [p, pu, pv] = piece.first_order(u, v);
        let (f, g) = (n.dot(p - line.origin), m.dot(p - line.origin));
        if f.abs().max(g.abs()) <= CLOSE {
            let inside = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
            let t = line.direction.dot(p - line.origin) / line.direction.length_squared();
            return (inside && t > 0.0).then_some(t);
        }
        let (a, b, c, d) = (n.dot(pu), n.dot(pv), m.dot(pu), m.dot(pv));
        let det = a * d - b * c;
        u -= (f * d - g * b) / det;
        v -= (a * g - c * f) / det;
    }
    None
}

/// A patch as triangles under a tree.
pub struct Diced {
    triangles: Vec<[DVec3; 3]>,
    tree: Tree,
}

impl Diced {
    /// n × n steps of one piece.
    pub fn new(piece: &Bicubic, n: usize) -> Diced {
        let mut mesh = crate::geometry::mesh::Mesh::default();
        dice(&Patch::loose(vec![*piece]), 0, &Steps::even(n), &mut mesh);
        let corner = |i: u32| mesh.positions[i as usize];
        let triangles: Vec<[DVec3; 3]> = mesh.triangles.iter().map(|t| t.map(corner)).collect();
        let tree = Tree::build(triangles.len(), |i| Aabb::of(triangles[i]));
        Diced { triangles, tree }
    }

    /// The nearest triangle's distance.
    pub fn meet(&self, line: &Line) -> Option<f64> {
        let mut best = f64::INFINITY;
        self.tree.traverse(&line.origin, &line.direction, f64::INFINITY, |range, _| {
            for &i in &self.tree.order()[range] {
                if let Some(t) = triangle_moller_trumbore(line, self.triangles[i as usize]) {
                    best = best.min(t);
                }
            }
            best
        });
        best.is_finite().then_some(best)
    }
}
