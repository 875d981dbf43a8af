//! Rays against bicubic pieces: every root, isolated. Knows nothing of scenes, materials or transforms.
//!
//! A ray is where two planes meet; a hit is a root (u, v) of the two distances to them, a bicubic f: R² → R² in Bernstein form
//! (Kajiya 1982; Nishita, Sederberg & Kakimoto 1990). A box of (u, v) is thrown away where the hull of f, or of f preconditioned by
//! the inverse of its mean Jacobian, leaves 0 out. It holds one root at most where the preconditioned Jacobian is near the identity all
//! over the box (Toth 1985; Krawczyk); Newton then finds it. Otherwise the box is halved. No root is missed for want of a starting
//! point, and no tolerance makes one: what is left at the level of rounding is a tangent, and reported as one if f is 0 there to rounding.
//!
//! The pieces are cut once into parts that are nearly flat, under a tree of boxes, so that most parts are settled at the first look.

mod part;
mod roots;

use super::Bicubic;
use crate::geometry::boxes::{BoxTree, Line};
use crate::math::Aabb;
use crate::math::error::UNIT_ROUNDOFF;
use glam::DVec3;
use part::{Part, parts_of};
use roots::{Matrix2, Net, isolate};

/// A point where a ray meets a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchHit {
    /// Along the ray, in units of its direction's length.
    pub t: f64,
    /// Which piece.
    pub piece: usize,
    /// In the piece, 0 to 1.
    pub u: f64,
    /// In the piece, 0 to 1.
    pub v: f64,
    /// The point of the surface.
    pub point: DVec3,
    /// How far u and v may be off: large where the ray grazes.
    pub uncertainty: f64,
}

/// What a ray met.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hits {
    /// By ascending t; a seam crossed is one hit.
    pub hits: Vec<PatchHit>,
    /// True where the work allowed for one part was not enough to tell its roots apart: the ray runs within rounding of the surface
    /// along a whole curve. Roots may then be missing.
    pub unresolved: bool,
}

/// Pieces cut into nearly flat parts, under a tree of boxes.
#[derive(Clone, Debug)]
pub struct PatchTree {
    pieces: Vec<Bicubic>,
    parts: Vec<Part>,
    tree: BoxTree,
}

/// Parts in a leaf of the tree.
const LEAF: usize = 2;

impl PatchTree {
    /// Prepares pieces for rays. Parts without area are left out: no ray meets them.
    pub fn new(pieces: &[Bicubic]) -> PatchTree {
        let mut parts = Vec::new();
        for (index, piece) in pieces.iter().enumerate() {
            parts_of(index as u32, piece, &mut parts);
        }
        let tree = BoxTree::build(&mut parts, LEAF, Part::bounds);
        PatchTree { pieces: pieces.to_vec(), parts, tree }
    }

    /// Whether there would be anything to meet: false where all pieces are shrunk to curves and points.
    pub fn would_hold(pieces: &[Bicubic]) -> bool {
        let mut parts = Vec::new();
        pieces.iter().any(|piece| {
            parts_of(0, piece, &mut parts);
            !parts.is_empty()
        })
    }

    /// The pieces it was made from.
    pub fn pieces(&self) -> &[Bicubic] {
        &self.pieces
    }

    /// The box around all parts; empty where there are none.
    pub fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    /// Bytes that the parts and their tree take.
    pub fn bytes(&self) -> usize {
        size_of_val(self.parts.as_slice()) + self.tree.bytes()
    }

    /// Every hit with `t_min` ≤ t ≤ `t_max`. `direction` of any length but 0.
    pub fn all_hits(&self, origin: DVec3, direction: DVec3, t_min: f64, t_max: f64) -> Hits {
        let mut found = Hits::default();
        let Some(ray) = Ray::new(origin, direction) else { return found };
        let (near, far) = (t_min * ray.line.length, t_max * ray.line.length);
        self.walk(&ray, near, far, |part, near, far| {
            found.unresolved |= !self.meet(&ray, part, near, far, &mut |hit| found.hits.push(hit));
            far
        });
        found.hits.sort_by(|a, b| a.t.total_cmp(&b.t));
        self.merge_seams(&ray, &mut found.hits);
        found
    }

    /// The hit with the least t in `t_min` ≤ t ≤ `t_max`.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3, t_min: f64, t_max: f64) -> Option<PatchHit> {
        let ray = Ray::new(origin, direction)?;
        let mut best: Option<PatchHit> = None;
        self.walk(&ray, t_min * ray.line.length, t_max * ray.line.length, |part, near, far| {
            self.meet(&ray, part, near, far, &mut |hit| {
                if best.is_none_or(|b| hit.t < b.t) {
                    best = Some(hit);
                }
            });
            best.map_or(far, |b| (b.t * ray.line.length).min(far))
        });
        best
    }

    /// True where there is a hit with `t_min` ≤ t ≤ `t_max`.
    pub fn any_hit(&self, origin: DVec3, direction: DVec3, t_min: f64, t_max: f64) -> bool {
        let Some(ray) = Ray::new(origin, direction) else { return false };
        let mut hit = false;
        self.walk(&ray, t_min * ray.line.length, t_max * ray.line.length, |part, near, far| {
            self.meet(&ray, part, near, far, &mut |_| hit = true);
            if hit { f64::NEG_INFINITY } else { far }
        });
        hit
    }

    /// Visits the parts whose boxes the ray meets, near ones first. `visit` returns the new far end.
    fn walk(&self, ray: &Ray, near: f64, far: f64, mut visit: impl FnMut(&Part, f64, f64) -> f64) {
        self.tree.walk(&ray.line, near, far, |range, mut far| {
            for part in &self.parts[range] {
                far = visit(part, near, far);
            }
            far
        });
    }

    /// Finds the roots of one part. False where it ran out of work.
    fn meet(&self, ray: &Ray, part: &Part, near: f64, far: f64, found: &mut impl FnMut(PatchHit)) -> bool {
        let seen = Seen::of(ray, part);
        if seen.depth.1 < near || seen.depth.0 > far {
            return true;
        }
        let piece = &self.pieces[part.piece as usize];
        isolate(&seen.net, seen.rounding, |u, v, uncertainty| {
            if let Some(hit) = polish(ray, piece, part, u, v, uncertainty, seen.rounding) {
                // The far end is widened by rounding alone, as the caller's own t was; the near one is exact: a ray leaves its surface.
                let t = hit.t * ray.line.length;
                let slack = seen.rounding;
                if t >= near && t <= far + slack {
                    found(hit);
                }
            }
        })
    }

    /// Of hits at the same point that cross the same way, keeps one: seams and cuts belong to both sides.
    fn merge_seams(&self, ray: &Ray, hits: &mut Vec<PatchHit>) {
        let crossing = |h: &PatchHit| {
            let [_, du, dv] = self.pieces[h.piece].first_order(h.u, h.v);
            du.cross(dv).dot(ray.line.direction)
        };
        let mut kept: Vec<PatchHit> = Vec::with_capacity(hits.len());
        for hit in hits.iter() {
            let same = |other: &&PatchHit| {
                self.same_root(ray, other, hit)
                    && (other.piece == hit.piece || crossing(other) * crossing(hit) > 0.0)
            };
            if !kept.iter().rev().take(4).any(|other| same(&other)) {
                kept.push(*hit);
            }
        }
        *hits = kept;
    }

    fn same_root(&self, ray: &Ray, a: &PatchHit, b: &PatchHit) -> bool {
        let blur = 2.0 * (a.uncertainty + b.uncertainty);
        if a.piece == b.piece {
            return (a.u - b.u).abs() <= blur && (a.v - b.v).abs() <= blur;
        }
        let on_edge = |h: &PatchHit| [h.u, h.v].iter().any(|x| *x <= blur || *x >= 1.0 - blur);
        let reach = |h: &PatchHit| {
            let [_, du, dv] = self.pieces[h.piece].first_order(h.u, h.v);
            (du.length() + dv.length()) * blur
        };
        let scale = a.point.abs().max_element() + ray.line.origin.abs().max_element();
        on_edge(a)
            && on_edge(b)
            && a.point.distance(b.point) <= reach(a) + reach(b) + 16.0 * UNIT_ROUNDOFF * scale
    }
}

/// A ray and two planes through it.
struct Ray {
    line: Line,
    planes: [DVec3; 2],
}

impl Ray {
    fn new(origin: DVec3, direction: DVec3) -> Option<Ray> {
        let line = Line::new(origin, direction)?;
        Some(Ray { line, planes: line.across() })
    }
}

/// A part as the ray sees it: distances of its control points from the two planes.
struct Seen {
    net: Net,
    /// Least and greatest distance along the ray.
    depth: (f64, f64),
    /// How far rounding may have moved a distance.
    rounding: f64,
}

impl Seen {
    fn of(ray: &Ray, part: &Part) -> Seen {
        let mut net = Net { x: [0.0; 16], y: [0.0; 16] };
        let mut depth = (f64::INFINITY, f64::NEG_INFINITY);
        for (k, p) in part.points.iter().flatten().enumerate() {
            let from = *p - ray.line.origin;
            net.x[k] = ray.planes[0].dot(from);
            net.y[k] = ray.planes[1].dot(from);
            let along = ray.line.direction.dot(from);
            depth = (depth.0.min(along), depth.1.max(along));
        }
        // A difference, three products and two sums of unit vectors: below 4·√3·u of the operands; halving adds u a level.
        let rounding = 16.0 * UNIT_ROUNDOFF * (part.size + ray.line.origin.abs().max_element());
        Seen { net, depth: (depth.0 - rounding, depth.1 + rounding), rounding }
    }
}

/// A root of a part as a hit on the piece it was cut from: two steps of Newton on the piece itself, which is not rounded by cutting.
/// None where the place is not on the ray to rounding after all.
fn polish(
    ray: &Ray,
    piece: &Bicubic,
    part: &Part,
    u: f64,
    v: f64,
    blur: f64,
    rounding: f64,
) -> Option<PatchHit> {
    let (wu, wv) = (part.u.1 - part.u.0, part.v.1 - part.v.0);
    let (mut u, mut v) = (part.u.0 + u * wu, part.v.0 + v * wv);
    // Steps may mend what cutting rounded, not go to another root.
    let most = 64.0 * blur * wu.max(wv) + 64.0 * f64::EPSILON;
    let mut best = (f64::INFINITY, u, v, DVec3::ZERO);
    for _ in 0..3 {
        let [point, du, dv] = piece.first_order(u, v);
        let from = point - ray.line.origin;
        let (x, y) = (ray.planes[0].dot(from), ray.planes[1].dot(from));
        let miss = x.abs().max(y.abs());
        if miss < best.0 {
            best = (miss, u, v, point);
        }
        let j = Matrix2 {
            a: ray.planes[0].dot(du),
            b: ray.planes[0].dot(dv),
            c: ray.planes[1].dot(du),
            d: ray.planes[1].dot(dv),
        };
        let Some(m) = j.inverse() else { break };
        let (step_u, step_v) = (m.a * x + m.b * y, m.c * x + m.d * y);
        if step_u.abs().max(step_v.abs()) > most {
            break;
        }
        (u, v) = ((u - step_u).clamp(0.0, 1.0), (v - step_v).clamp(0.0, 1.0));
    }
    let (miss, u, v, point) = best;
    // A place that halving held for a root, but rounding alone put there.
    if miss > 2.0 * rounding {
        return None;
    }
    let t = ray.line.direction.dot(point - ray.line.origin) / ray.line.length;
    let uncertainty = blur * wu.max(wv) + 4.0 * f64::EPSILON;
    t.is_finite().then_some(PatchHit { t, piece: part.piece as usize, u, v, point, uncertainty })
}
