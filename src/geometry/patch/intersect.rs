//! Rays against bicubic pieces: every root, isolated. Knows nothing of scenes, materials or transforms.
//!
//! A ray is where two planes meet; a hit is a root (u, v) of the two distances to them, a bicubic f: R² → R² in Bernstein form
//! (Kajiya 1982; Nishita, Sederberg & Kakimoto 1990). A box of (u, v) is thrown away where the hull of f, or of f preconditioned by
//! the inverse of its mean Jacobian, leaves 0 out. It holds one root at most where the preconditioned Jacobian is near the identity all
//! over the box (Toth 1985; Krawczyk); Newton then finds it. Otherwise the box is halved. No root is missed for want of a starting
//! point, and no tolerance makes one: what is left at the level of rounding is a tangent, and reported as one if f is 0 there to rounding.
//!
//! The pieces are cut once into parts that are nearly flat, under a tree of boxes, so that most parts are settled at the first look.

use super::Bicubic;
use crate::geometry::boxes::{BoxTree, Line};
use crate::math::Aabb;
use crate::math::error::UNIT_ROUNDOFF;
use glam::DVec3;

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

#[derive(Clone, Debug)]
struct Part {
    piece: u32,
    u: (f64, f64),
    v: (f64, f64),
    points: [[DVec3; 4]; 4],
    /// Largest magnitude of a coordinate.
    size: f64,
}

/// A piece is cut until its control points are this close to evenly spaced, as a part of their spacing: the measure of
/// how often the first look settles a part. Measured on the teapot: 0.1 to 0.3 are alike within 10 %.
const FLATNESS: f64 = 0.2;
/// Most halvings of a piece in each of u and v.
const MOST_CUTS: u32 = 4;
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
        seen.roots(|u, v, uncertainty| {
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

impl Part {
    fn new(piece: u32, surface: &Bicubic, u: (f64, f64), v: (f64, f64)) -> Part {
        let size = surface.points.iter().flatten().fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
        Part { piece, u, v, points: surface.points, size }
    }

    fn surface(&self) -> Bicubic {
        Bicubic { points: self.points }
    }

    fn bounds(&self) -> Aabb {
        // Points of parts are rounded at each cut.
        let slack = DVec3::splat(f64::from(4 * MOST_CUTS) * UNIT_ROUNDOFF * self.size);
        let tight = self.surface().bounds();
        Aabb { min: tight.min - slack, max: tight.max + slack }
    }

    /// True where every pair of a u-difference and a v-difference is parallel to rounding.
    fn without_area(&self) -> bool {
        let (along_u, along_v) = differences(&self.points);
        let longest = |d: &[DVec3; 12]| d.iter().fold(0.0, |m: f64, d| m.max(d.length()));
        let bound = 8.0 * UNIT_ROUNDOFF * self.size * (longest(&along_u) + longest(&along_v));
        along_u.iter().all(|a| along_v.iter().all(|b| a.cross(*b).length() <= bound))
    }
}

/// Differences of neighbouring control points along u and along v.
fn differences(p: &[[DVec3; 4]; 4]) -> ([DVec3; 12], [DVec3; 12]) {
    let along_u = std::array::from_fn(|k| p[k / 4 + 1][k % 4] - p[k / 4][k % 4]);
    let along_v = std::array::from_fn(|k| p[k % 4][k / 4 + 1] - p[k % 4][k / 4]);
    (along_u, along_v)
}

/// Adds the parts of a piece that have area.
fn parts_of(index: u32, piece: &Bicubic, parts: &mut Vec<Part>) {
    cut(Part::new(index, piece, (0.0, 1.0), (0.0, 1.0)), (0, 0), parts);
}

/// Halves a part until it is nearly flat; drops it without area.
fn cut(part: Part, done: (u32, u32), parts: &mut Vec<Part>) {
    let (along_u, along_v) = differences(&part.points);
    let spacing = |d: &[DVec3; 12]| d.iter().map(|d| d.length()).sum::<f64>() / 12.0;
    // How far the differences stray from their mean.
    let stray = |d: &[DVec3; 12]| {
        let mean = d.iter().copied().sum::<DVec3>() / 12.0;
        d.iter().fold(0.0, |m: f64, d| m.max(d.distance(mean)))
    };
    let (su, sv) = (spacing(&along_u), spacing(&along_v));
    let (bend_u, bend_v) = (stray(&along_u), stray(&along_v));
    let uneven = bend_u > FLATNESS * su || bend_v > FLATNESS * sv;
    let (room_u, room_v) = (done.0 < MOST_CUTS, done.1 < MOST_CUTS);
    if !uneven || !(room_u || room_v) {
        if !part.without_area() {
            parts.push(part);
        }
        return;
    }
    // The bend along u shows in u-differences by rows and in v-differences by columns: halve the longer side of the bent net.
    let split_u =
        room_u && (!room_v || bending(&part.points) >= bending(&part.surface().transposed().points));
    let half = |r: (f64, f64)| 0.5 * (r.0 + r.1);
    if split_u {
        let m = half(part.u);
        let [low, high] = part.surface().split_u(0.5);
        cut(Part::new(part.piece, &low, (part.u.0, m), part.v), (done.0 + 1, done.1), parts);
        cut(Part::new(part.piece, &high, (m, part.u.1), part.v), (done.0 + 1, done.1), parts);
    } else {
        let m = half(part.v);
        let [low, high] = part.surface().split_v(0.5);
        cut(Part::new(part.piece, &low, part.u, (part.v.0, m)), (done.0, done.1 + 1), parts);
        cut(Part::new(part.piece, &high, part.u, (m, part.v.1)), (done.0, done.1 + 1), parts);
    }
}

/// What halving along the first index would mend: second differences that way, and the change of the other differences.
fn bending(p: &[[DVec3; 4]; 4]) -> f64 {
    let second =
        (0..2).flat_map(|i| (0..4).map(move |j| (p[i + 2][j] - p[i + 1][j]) - (p[i + 1][j] - p[i][j])));
    let twist =
        (0..3).flat_map(|i| (0..3).map(move |j| (p[i + 1][j + 1] - p[i + 1][j]) - (p[i][j + 1] - p[i][j])));
    let largest = |a: f64, b: DVec3| a.max(b.length());
    second.fold(0.0, largest) + 0.5 * twist.fold(0.0, largest)
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

/// Control values of the two distances, row by row.
#[derive(Clone, Copy)]
struct Net {
    x: [f64; 16],
    y: [f64; 16],
}

/// A box of (u, v) within a part, both from 0 to 1, with its net.
#[derive(Clone, Copy)]
struct Cell {
    net: Net,
    u: (f64, f64),
    v: (f64, f64),
}

/// Most boxes looked at in one part. A tangent to the last bit takes some 400; a whole curve of them would take all there are.
const MOST_CELLS: usize = 3000;
/// A box this narrow in u and v is not halved further: 2⁻⁴⁴ of a part.
const NARROWEST: f64 = 5.7e-14;
/// Boxes are given up as seen edge-on only after this many, since the test costs as much as several.
const EDGE_ON_CHECK: usize = 48;

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

    /// Calls `found` with each root and how far it may be off, in the part's own u and v. False where the work allowed was not enough.
    fn roots(&self, mut found: impl FnMut(f64, f64, f64)) -> bool {
        let whole = Cell { net: self.net, u: (0.0, 1.0), v: (0.0, 1.0) };
        if whole.net.excludes_zero(self.rounding) {
            return true;
        }
        let mut waiting = vec![whole];
        let mut looked = 0;
        while let Some(cell) = waiting.pop() {
            looked += 1;
            if looked == EDGE_ON_CHECK && self.net.edge_on(self.rounding) {
                return true;
            }
            if looked > MOST_CELLS {
                return false;
            }
            match cell.look(self.rounding) {
                Look::Empty => {}
                Look::One { u, v, uncertainty } => found(u, v, uncertainty),
                Look::Unclear if cell.narrow() => {
                    if let Some(blur) = cell.touches(self.rounding) {
                        found(0.5 * (cell.u.0 + cell.u.1), 0.5 * (cell.v.0 + cell.v.1), blur);
                    }
                }
                Look::Unclear => waiting.extend(cell.halves()),
            }
        }
        true
    }
}

/// What one look at a box says.
enum Look {
    /// No root.
    Empty,
    /// One root, here.
    One { u: f64, v: f64, uncertainty: f64 },
    /// Perhaps several.
    Unclear,
}

/// A 2 × 2 matrix, row by row.
#[derive(Clone, Copy)]
struct Matrix2 {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
}

impl Net {
    fn excludes_zero(&self, slack: f64) -> bool {
        one_sided(&self.x, slack) || one_sided(&self.y, slack)
    }

    /// True where the two distances are dependent all over: the part is seen as a line.
    fn edge_on(&self, rounding: f64) -> bool {
        let step_u = |f: &[f64; 16], k: usize| f[k + 4] - f[k];
        let step_v = |f: &[f64; 16], k: usize| f[k / 3 * 4 + k % 3 + 1] - f[k / 3 * 4 + k % 3];
        let size = self.x.iter().chain(&self.y).fold(0.0, |m: f64, x| m.max(x.abs()));
        let determinant = |i: usize, j: usize| {
            step_u(&self.x, i) * step_v(&self.y, j) - step_u(&self.y, i) * step_v(&self.x, j)
        };
        (0..12).all(|i| (0..12).all(|j| determinant(i, j).abs() <= 8.0 * rounding * size))
    }

    /// Mean Jacobian over the box, per its own width.
    fn mean_jacobian(&self) -> Matrix2 {
        let rise_u = |f: &[f64; 16]| (0..4).map(|j| f[12 + j] - f[j]).sum::<f64>() / 4.0;
        let rise_v = |f: &[f64; 16]| (0..4).map(|i| f[4 * i + 3] - f[4 * i]).sum::<f64>() / 4.0;
        Matrix2 { a: rise_u(&self.x), b: rise_v(&self.x), c: rise_u(&self.y), d: rise_v(&self.y) }
    }

    /// The net of m · f.
    fn transformed(&self, m: &Matrix2) -> Net {
        let mut out = Net { x: [0.0; 16], y: [0.0; 16] };
        for k in 0..16 {
            out.x[k] = m.a * self.x[k] + m.b * self.y[k];
            out.y[k] = m.c * self.x[k] + m.d * self.y[k];
        }
        out
    }

    /// How far the Jacobian strays from the identity anywhere in the box: the greater row sum of |I − J|, J bounded by its control values.
    fn stray(&self) -> f64 {
        let mut rows = [0.0f64; 2];
        for (row, f) in rows.iter_mut().zip([&self.x, &self.y]) {
            let own = |wanted: f64, found: f64| (3.0 * found - wanted).abs();
            let first = f64::from(u8::from(std::ptr::eq(f, &self.x)));
            let (mut u, mut v) = (0.0, 0.0);
            for k in 0..12 {
                let du = own(first, f[k + 4] - f[k]);
                if du > u {
                    u = du;
                }
            }
            for i in 0..4 {
                for j in 0..3 {
                    let dv = own(1.0 - first, f[4 * i + j + 1] - f[4 * i + j]);
                    if dv > v {
                        v = dv;
                    }
                }
            }
            *row = u + v;
        }
        rows[0].max(rows[1])
    }

    /// f and its Jacobian at a place in the box.
    fn at(&self, u: f64, v: f64) -> ([f64; 2], Matrix2) {
        let (bu, bv) = (crate::geometry::basis::bernstein(u), crate::geometry::basis::bernstein(v));
        let slopes = |t: f64| {
            let r = 1.0 - t;
            let (a, b, c) = (3.0 * r * r, 6.0 * r * t, 3.0 * t * t);
            [-a, a - b, b - c, c]
        };
        let (su, sv) = (slopes(u), slopes(v));
        let sum = |f: &[f64; 16], wu: &[f64; 4], wv: &[f64; 4]| {
            (0..4).map(|i| wu[i] * (0..4).map(|j| wv[j] * f[4 * i + j]).sum::<f64>()).sum::<f64>()
        };
        let jacobian = Matrix2 {
            a: sum(&self.x, &su, &bv),
            b: sum(&self.x, &bu, &sv),
            c: sum(&self.y, &su, &bv),
            d: sum(&self.y, &bu, &sv),
        };
        ([sum(&self.x, &bu, &bv), sum(&self.y, &bu, &bv)], jacobian)
    }

    fn halves_u(&self) -> [Net; 2] {
        let mut out = [*self, *self];
        for j in 0..4 {
            for (axis, f) in [&self.x, &self.y].into_iter().enumerate() {
                let [low, high] = halve([f[j], f[4 + j], f[8 + j], f[12 + j]]);
                for i in 0..4 {
                    *out[0].value(axis, 4 * i + j) = low[i];
                    *out[1].value(axis, 4 * i + j) = high[i];
                }
            }
        }
        out
    }

    fn halves_v(&self) -> [Net; 2] {
        let mut out = [*self, *self];
        for i in 0..4 {
            for (axis, f) in [&self.x, &self.y].into_iter().enumerate() {
                let [low, high] = halve([f[4 * i], f[4 * i + 1], f[4 * i + 2], f[4 * i + 3]]);
                for j in 0..4 {
                    *out[0].value(axis, 4 * i + j) = low[j];
                    *out[1].value(axis, 4 * i + j) = high[j];
                }
            }
        }
        out
    }

    fn value(&mut self, axis: usize, k: usize) -> &mut f64 {
        if axis == 0 { &mut self.x[k] } else { &mut self.y[k] }
    }
}

/// De Casteljau's halves of one row.
fn halve([a, b, c, d]: [f64; 4]) -> [[f64; 4]; 2] {
    let (e, f, g) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
    let (h, i) = (0.5 * (e + f), 0.5 * (f + g));
    let m = 0.5 * (h + i);
    [[a, e, h, m], [m, i, g, d]]
}

/// All beyond `slack` on one side of 0.
fn one_sided(f: &[f64; 16], slack: f64) -> bool {
    let (mut low, mut high) = (f[0], f[0]);
    for x in f {
        if *x < low {
            low = *x;
        }
        if *x > high {
            high = *x;
        }
    }
    low > slack || high < -slack
}

impl Matrix2 {
    /// The inverse, and by how much it can enlarge. None for a singular or badly unbalanced matrix, which preconditions nothing.
    fn inverse(&self) -> Option<Matrix2> {
        let det = self.a * self.d - self.b * self.c;
        let size = (self.a.abs() + self.b.abs()) * (self.c.abs() + self.d.abs());
        let m = Matrix2 { a: self.d / det, b: -self.b / det, c: -self.c / det, d: self.a / det };
        (det.abs() > 16.0 * f64::EPSILON * size && (m.a + m.b + m.c + m.d).is_finite()).then_some(m)
    }

    /// Largest row sum of magnitudes.
    fn norm(&self) -> f64 {
        (self.a.abs() + self.b.abs()).max(self.c.abs() + self.d.abs())
    }
}

/// Contraction of the preconditioned map below which a box is left to Newton. Below 1 there is one root at most; a margin makes the
/// steps quick.
const CONTRACTION: f64 = 0.75;
/// Steps of Newton in a box with one root at most: each squares the error once it is below a half.
const STEPS: usize = 60;

impl Cell {
    fn look(&self, rounding: f64) -> Look {
        if self.net.excludes_zero(rounding) {
            return Look::Empty;
        }
        let Some(inverse) = self.net.mean_jacobian().inverse() else { return Look::Unclear };
        let g = self.net.transformed(&inverse);
        let slack = rounding * inverse.norm();
        if g.excludes_zero(slack) {
            return Look::Empty;
        }
        if g.stray() > CONTRACTION {
            return Look::Unclear;
        }
        self.only_root(&g, slack)
    }

    /// The root of a preconditioned net whose Jacobian is near the identity. Iterates stay in the box, where the map contracts; an iterate
    /// that rests at the border without being a root shows that there is none inside.
    fn only_root(&self, g: &Net, slack: f64) -> Look {
        let (mut x, mut y) = (0.5, 0.5);
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let ([fx, fy], j) = g.at(x, y);
            let Some(inverse) = j.inverse() else { return Look::Unclear };
            let (dx, dy) = (inverse.a * fx + inverse.b * fy, inverse.c * fx + inverse.d * fy);
            let (nx, ny) = ((x - dx).clamp(0.0, 1.0), (y - dy).clamp(0.0, 1.0));
            let moved = (nx - x).abs().max((ny - y).abs());
            (x, y) = (nx, ny);
            if moved <= 4.0 * f64::EPSILON || moved >= last && moved <= slack {
                break;
            }
            last = moved;
        }
        let ([fx, fy], j) = g.at(x, y);
        // How far the root is outside at most: |g| over the least stretch of a map within CONTRACTION of the identity.
        let beyond = fx.abs().max(fy.abs()) / (1.0 - CONTRACTION);
        let blur = (2.0 * slack + 8.0 * f64::EPSILON) * j.inverse().map_or(1.0, |m| m.norm().max(1.0));
        if beyond > 2.0 * blur / (1.0 - CONTRACTION) {
            return Look::Empty;
        }
        let (wu, wv) = (self.u.1 - self.u.0, self.v.1 - self.v.0);
        Look::One {
            u: self.u.0 + x * wu,
            v: self.v.0 + y * wv,
            uncertainty: blur * wu.max(wv) + 4.0 * f64::EPSILON,
        }
    }

    fn narrow(&self) -> bool {
        self.u.1 - self.u.0 <= NARROWEST && self.v.1 - self.v.0 <= NARROWEST
    }

    /// Of a box too narrow to halve: the uncertainty of a root in it, if f is 0 there to rounding.
    fn touches(&self, rounding: f64) -> Option<f64> {
        let ([x, y], j) = self.net.at(0.5, 0.5);
        let steepest = j.norm();
        // Over the box f changes by its Jacobian; a second derivative of the part's own size changes it by less than rounding.
        (x.abs().max(y.abs()) <= 2.0 * rounding + steepest).then(|| rounding.sqrt().max(NARROWEST))
    }

    /// Halved across the direction in which f changes most.
    fn halves(&self) -> [Cell; 2] {
        let reach = |d: (f64, f64)| d.0.abs().max(d.1.abs());
        let steps = |far: usize, near: usize, stride: usize| {
            (0..4)
                .map(|k| {
                    reach((
                        self.net.x[far + k * stride] - self.net.x[near + k * stride],
                        self.net.y[far + k * stride] - self.net.y[near + k * stride],
                    ))
                })
                .fold(0.0, f64::max)
        };
        let along_u = steps(4, 0, 1).max(steps(8, 4, 1)).max(steps(12, 8, 1));
        let along_v = steps(1, 0, 4).max(steps(2, 1, 4)).max(steps(3, 2, 4));
        let (wu, wv) = (self.u.1 - self.u.0, self.v.1 - self.v.0);
        // Neither side may fall far behind: what is hidden in a long box is seen only when it is halved.
        let by_u = if wu > 64.0 * wv {
            true
        } else if wv > 64.0 * wu {
            false
        } else {
            along_u >= along_v
        };
        if by_u {
            let m = 0.5 * (self.u.0 + self.u.1);
            let [low, high] = self.net.halves_u();
            [Cell { net: high, u: (m, self.u.1), v: self.v }, Cell { net: low, u: (self.u.0, m), v: self.v }]
        } else {
            let m = 0.5 * (self.v.0 + self.v.1);
            let [low, high] = self.net.halves_v();
            [Cell { net: high, u: self.u, v: (m, self.v.1) }, Cell { net: low, u: self.u, v: (self.v.0, m) }]
        }
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
