//! Bicubic pieces as triangles, within a tolerance and without cracks. Knows nothing of cameras: they reach it as a tolerance.
//!
//! **No cracks.** How many vertices an edge has, and where they are, follow from the four points of the edge alone, taken in an order
//! that does not depend on which piece asks. Two pieces with a common edge put the same bits there, whatever they do inside.
//!
//! **Within the tolerance.** A triangle that spans Δu by Δv of the piece is off by at most
//! ⅛ (max|∂uu| Δu² + 2 max|∂uv| Δu Δv + max|∂vv| Δv²) (Filip, Magedson & Markot 1986, whose proof needs only the spans). The maxima
//! are bounded by second differences of control points. The inside is a grid of equal steps that keep this; along an edge of fewer
//! vertices than the grid, rows are added close to it until the strip between them, with its own second differences, keeps it too.

use super::{Bicubic, Edge, Patch};
use crate::geometry::curve::evaluate::bernstein;
use crate::geometry::mesh::Mesh;
use glam::{DVec2, DVec3};

/// How far the triangles may be from the surface near some control points, scene units: of an edge its four, of a piece its
/// sixteen. Must be above 0; a constant, or from the distance to the eye.
pub type Tolerance<'a> = &'a dyn Fn(&[DVec3]) -> f64;

/// Most steps along an edge, and across a piece. Beyond, the tolerance is not kept: 2 · 1024² triangles a piece.
const MOST_STEPS: usize = 1024;
/// What of the tolerance an edge may use up with its own bend; the rest is for the strip beside it. Little, as edges are outlines, and finer ones
/// cost few triangles.
const EDGE_SHARE: f64 = 0.2;

/// Triangles within `tolerance` of all pieces of a patch, with normals and (u, v).
pub fn tessellate(patch: &Patch, tolerance: Tolerance) -> Mesh {
    let mut mesh = Mesh::default();
    for (index, piece) in patch.pieces().iter().enumerate() {
        let steps = Steps::within(piece, tolerance);
        dice(patch, index, &steps, &mut mesh);
    }
    mesh
}

/// Triangles of one piece of a patch on a grid given.
pub fn dice(patch: &Patch, index: usize, steps: &Steps, mesh: &mut Mesh) {
    let piece = &patch.pieces()[index];
    let mut dicer = Dicer { patch, piece, size: piece.size(), index, mesh, uvs: Vec::new(), first: 0 };
    dicer.first = dicer.mesh.positions.len() as u32;
    dicer.run(steps);
}

/// Where a piece is cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    /// Inner rows, ascending in (0, 1); at least one.
    pub u: Vec<f64>,
    /// Inner columns, ascending in (0, 1); at least one.
    pub v: Vec<f64>,
    /// Equal steps along each edge, in the order of [`EDGES`].
    pub edges: [usize; 4],
}

/// The edges of [`Steps::edges`].
pub const EDGES: [Edge; 4] = [Edge::StartU, Edge::EndU, Edge::StartV, Edge::EndV];

impl Steps {
    /// n equal steps everywhere.
    pub fn even(n: usize) -> Steps {
        let n = n.max(2);
        Steps { u: inner(n), v: inner(n), edges: [n; 4] }
    }

    /// Few enough that every triangle keeps the tolerance.
    pub fn within(piece: &Bicubic, tolerance: Tolerance) -> Steps {
        let points: Vec<DVec3> = piece.points.iter().flatten().copied().collect();
        let allowed = tolerance(&points);
        let (n, m) = Bend::of(piece).steps(allowed);
        let edges = EDGES.map(|edge| edge_steps(&piece.edge(edge), tolerance));
        let mut steps = Steps { u: inner(n), v: inner(m), edges };
        for (k, edge) in EDGES.iter().enumerate() {
            let span = 1.0 / edges[k] as f64;
            fence(piece, *edge, span, allowed, &mut steps);
        }
        steps
    }
}

/// 1/n … (n−1)/n.
fn inner(n: usize) -> Vec<f64> {
    (1..n).map(|k| k as f64 / n as f64).collect()
}

/// Bounds of second derivatives over a piece, per its own u and v.
#[derive(Clone, Copy, Debug)]
struct Bend {
    uu: f64,
    uv: f64,
    vv: f64,
}

impl Bend {
    fn of(piece: &Bicubic) -> Bend {
        let p = &piece.points;
        let second = |a: DVec3, b: DVec3, c: DVec3| ((c - b) - (b - a)).length();
        let mut bend = Bend { uu: 0.0, uv: 0.0, vv: 0.0 };
        for i in 0..4 {
            for j in 0..2 {
                bend.uu = bend.uu.max(6.0 * second(p[j][i], p[j + 1][i], p[j + 2][i]));
                bend.vv = bend.vv.max(6.0 * second(p[i][j], p[i][j + 1], p[i][j + 2]));
            }
        }
        for i in 0..3 {
            for j in 0..3 {
                let twist = (p[i + 1][j + 1] - p[i + 1][j]) - (p[i][j + 1] - p[i][j]);
                bend.uv = bend.uv.max(9.0 * twist.length());
            }
        }
        bend
    }

    /// Largest distance of a triangle spanning du by dv from the surface.
    fn error(&self, du: f64, dv: f64) -> f64 {
        (self.uu * du * du + 2.0 * self.uv * du * dv + self.vv * dv * dv) / 8.0
    }

    /// Numbers of steps that keep the error allowed with few triangles: of all with one product the error is least where both directions
    /// have the same part in it; where nearly all of it is twist, squares. Two at least: the strips along opposite edges need a row between them.
    fn steps(&self, allowed: f64) -> (usize, usize) {
        let product = ((self.uu * self.vv).sqrt() + self.uv) / (4.0 * allowed);
        let part = |own: f64| own + self.uv / 16.0;
        let slant = (part(self.uu) / part(self.vv)).sqrt();
        // What does not bend at all makes a NaN, which the larger leaves out.
        let m = whole((product / slant).sqrt().max((self.vv / (4.0 * allowed)).sqrt()));
        match self.across(self.uu, self.vv, m, allowed) {
            2 => (2, self.across(self.vv, self.uu, 2, allowed).min(m)),
            n => (n, m),
        }
    }

    /// Steps in a direction that bends by `own`, where there are m in the other, which bends by `other`: so many that
    /// own/n² + 2 uv/(n m) + other/m² is 8 times what is allowed.
    fn across(&self, own: f64, other: f64, m: usize, allowed: f64) -> usize {
        let m = m as f64;
        let (mixed, rest) = (self.uv / m, 8.0 * allowed - other / (m * m));
        let n = (mixed + (mixed * mixed + own * rest).sqrt()) / rest;
        whole(if rest > 0.0 { n } else { f64::INFINITY })
    }
}

fn whole(steps: f64) -> usize {
    if steps.is_finite() { (steps.ceil() as usize).clamp(2, MOST_STEPS) } else { MOST_STEPS }
}

/// The four points in the order that does not depend on the piece, and whether that is backwards.
fn canonical(edge: &[DVec3; 4]) -> ([DVec3; 4], bool) {
    let [a, b, c, d] = *edge;
    let key = |p: DVec3, q: DVec3| [p.x, p.y, p.z, q.x, q.y, q.z];
    let backwards = key(d, c).partial_cmp(&key(a, b)).is_some_and(|order| order.is_lt());
    (if backwards { [d, c, b, a] } else { *edge }, backwards)
}

/// Equal steps along an edge that keep its share of the tolerance.
fn edge_steps(edge: &[DVec3; 4], tolerance: Tolerance) -> usize {
    let ([a, b, c, d], _) = canonical(edge);
    let bend = 6.0 * ((c - b) - (b - a)).length().max(((d - c) - (c - b)).length());
    let n = (bend / (8.0 * EDGE_SHARE * tolerance(&[a, b, c, d]))).sqrt();
    if n.is_finite() { (n.ceil() as usize).clamp(1, MOST_STEPS) } else { MOST_STEPS }
}

/// Position of step k of n along an edge, in the edge's own direction.
fn edge_vertex(edge: &[DVec3; 4], k: usize, n: usize) -> DVec3 {
    let (points, backwards) = canonical(edge);
    let k = if backwards { n - k } else { k };
    bernstein(&points, k as f64 / n as f64)
}

/// Most halvings of the distance from an edge to the row beside it.
const MOST_FENCES: usize = 40;

/// Adds a row beside an edge, so close that triangles as wide as the edge's steps keep the tolerance: as it comes closer, the
/// strip bends like the edge alone, which was given its share.
fn fence(piece: &Bicubic, edge: Edge, span: f64, allowed: f64, steps: &mut Steps) {
    let oriented = |s: &mut Steps| match edge {
        Edge::StartU | Edge::EndU => std::mem::swap(&mut s.u, &mut s.v),
        Edge::StartV | Edge::EndV => {}
    };
    // Rows beside the edge are now in `v`, columns along it in `u`.
    oriented(steps);
    let at_end = matches!(edge, Edge::EndU | Edge::EndV);
    let widest = span.max(widest_gap(&steps.u));
    let mut near = if at_end { 1.0 - steps.v[steps.v.len() - 1] } else { steps.v[0] };
    let first = near;
    for _ in 0..MOST_FENCES {
        let reach = if at_end { (1.0 - near, 1.0) } else { (0.0, near) };
        let strip = match edge {
            Edge::StartU | Edge::EndU => piece.part(reach, (0.0, 1.0)).transposed(),
            Edge::StartV | Edge::EndV => piece.part((0.0, 1.0), reach),
        };
        if Bend::of(&strip).error(widest, 1.0) <= allowed {
            break;
        }
        near *= 0.5;
    }
    if near < first {
        let row = if at_end { 1.0 - near } else { near };
        let place = if at_end { steps.v.len() } else { 0 };
        steps.v.insert(place, row);
    }
    oriented(steps);
}

/// Longest step between neighbours, the ends 0 and 1 among them.
fn widest_gap(inner: &[f64]) -> f64 {
    let ends = inner.iter().copied().chain([1.0]);
    let (gap, _) = ends.fold((0.0f64, 0.0), |(gap, before), next| (gap.max(next - before), next));
    gap
}

struct Dicer<'a> {
    patch: &'a Patch,
    piece: &'a Bicubic,
    /// The piece's.
    size: f64,
    index: usize,
    mesh: &'a mut Mesh,
    /// The piece's own (u, v) of each of its vertices.
    uvs: Vec<(f64, f64)>,
    first: u32,
}

impl Dicer<'_> {
    fn run(&mut self, steps: &Steps) {
        let (rows, columns) = (steps.u.len(), steps.v.len());
        let grid: Vec<u32> = (0..rows * columns)
            .map(|k| {
                let (u, v) = (steps.u[k / columns], steps.v[k % columns]);
                self.vertex(self.piece.fast_at(u, v), u, v)
            })
            .collect();
        for i in 1..rows {
            for j in 1..columns {
                let [a, b] = [grid[(i - 1) * columns + j - 1], grid[(i - 1) * columns + j]];
                let [c, d] = [grid[i * columns + j - 1], grid[i * columns + j]];
                self.triangle(a, c, b);
                self.triangle(b, c, d);
            }
        }
        let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(u, v)| self.corner(u, v));
        // Beside each edge: its own vertices, the grid's, and whether the surface is to the left of it.
        let along_v = |i: usize| grid[i * columns..(i + 1) * columns].to_vec();
        let along_u = |j: usize| -> Vec<u32> { grid.iter().skip(j).step_by(columns).copied().collect() };
        let sides = [
            (corners[0], corners[1], along_v(0), &steps.v, false),
            (corners[2], corners[3], along_v(rows - 1), &steps.v, true),
            (corners[0], corners[2], along_u(0), &steps.u, true),
            (corners[1], corners[3], along_u(columns - 1), &steps.u, false),
        ];
        for (k, (from, to, inside, at, left)) in sides.into_iter().enumerate() {
            let n = steps.edges[k].max(1);
            let mut outside = vec![from];
            outside.extend((1..n).map(|step| self.on_edge(EDGES[k], step, n)));
            outside.push(to);
            self.stitch(&outside, &inside, at, left);
        }
    }

    /// Fills the strip between an edge and the row beside it, always going on along the side whose next vertex comes first.
    fn stitch(&mut self, outside: &[u32], inside: &[u32], at: &[f64], left: bool) {
        let n = outside.len() - 1;
        let (mut i, mut j) = (0, 0);
        while i < n || j + 1 < inside.len() {
            let next_outside = (i + 1) as f64 / n as f64;
            let go_outside = i < n && at.get(j + 1).is_none_or(|next_inside| next_outside < *next_inside);
            let (a, b, c) = if go_outside {
                i += 1;
                (outside[i - 1], outside[i], inside[j])
            } else {
                j += 1;
                (inside[j], inside[j - 1], outside[i])
            };
            if left { self.triangle(a, b, c) } else { self.triangle(b, a, c) }
        }
    }

    fn corner(&mut self, u: f64, v: f64) -> u32 {
        let p = self.piece.points[if u == 0.0 { 0 } else { 3 }][if v == 0.0 { 0 } else { 3 }];
        self.vertex(p, u, v)
    }

    fn on_edge(&mut self, edge: Edge, k: usize, n: usize) -> u32 {
        let t = k as f64 / n as f64;
        let (u, v) = match edge {
            Edge::StartU => (0.0, t),
            Edge::EndU => (1.0, t),
            Edge::StartV => (t, 0.0),
            Edge::EndV => (t, 1.0),
        };
        self.vertex(edge_vertex(&self.piece.edge(edge), k, n), u, v)
    }

    fn vertex(&mut self, position: DVec3, u: f64, v: f64) -> u32 {
        let (global_u, global_v) = self.patch.global_uv(self.index, u, v);
        self.mesh.positions.push(position);
        self.mesh.normals.push(self.piece.normal_by(u, v, self.size).unwrap_or(DVec3::Z));
        self.mesh.uvs.push(DVec2::new(global_u, global_v));
        self.uvs.push((u, v));
        self.first + self.uvs.len() as u32 - 1
    }

    /// Adds a triangle unless two of its corners coincide: at a collapsed edge.
    fn triangle(&mut self, a: u32, b: u32, c: u32) {
        let [p, q, r] = [a, b, c].map(|k| self.mesh.positions[k as usize]);
        if p != q && q != r && r != p {
            self.mesh.triangles.push([a, b, c]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{paraboloid, wild};
    use super::*;
    use std::collections::HashMap;

    fn single(piece: Bicubic) -> Patch {
        Patch::loose(vec![piece])
    }

    /// Largest distance from points of the triangles to the surface at the same (u, v).
    fn largest_error(mesh: &Mesh, piece: &Bicubic) -> f64 {
        let mut largest = 0.0f64;
        for t in &mesh.triangles {
            let [p, uv] =
                [t.map(|k| mesh.positions[k as usize]), t.map(|k| mesh.uvs[k as usize].extend(0.0))];
            for (a, b) in [(0.5, 0.5), (0.5, 0.0), (0.0, 0.5), (1.0 / 3.0, 1.0 / 3.0), (0.2, 0.7)] {
                let mix = |q: [DVec3; 3]| q[0] * (1.0 - a - b) + q[1] * a + q[2] * b;
                let (flat, at) = (mix(p), mix(uv));
                largest = largest.max(flat.distance(piece.fast_at(at.x, at.y)));
            }
        }
        largest
    }

    /// Each edge inside the mesh has a triangle on either side, running opposite ways; those at the border one.
    fn assert_manifold(mesh: &Mesh, border: usize) {
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for [a, b, c] in &mesh.triangles {
            for (p, q) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*p, *q)).or_default() += 1;
            }
        }
        assert!(edges.values().all(|n| *n == 1));
        let open = edges.keys().filter(|(a, b)| !edges.contains_key(&(*b, *a))).count();
        assert_eq!(open, border);
    }

    #[test]
    fn the_error_falls_with_the_square_of_the_step() {
        let patch = single(paraboloid(0.0));
        let error = |n: usize| {
            let mut mesh = Mesh::default();
            dice(&patch, 0, &Steps::even(n), &mut mesh);
            largest_error(&mesh, &patch.pieces()[0])
        };
        assert!((error(8) - 0.03125).abs() < 1e-12, "{}", error(8));
        assert!((error(32) - 0.001_953_125).abs() < 1e-12, "{}", error(32));
        let slope = (error(64) / error(8)).log2() / 3.0;
        assert!((slope + 2.0).abs() < 0.05, "{slope}");
    }

    #[test]
    fn every_tolerance_is_kept_and_the_triangles_join() {
        for seed in 0..8 {
            let patch = single(wild(seed));
            for tolerance in [0.1, 1e-2, 1e-3] {
                let steps = Steps::within(&patch.pieces()[0], &|_| tolerance);
                let mesh = tessellate(&patch, &|_| tolerance);
                let error = largest_error(&mesh, &patch.pieces()[0]);
                assert!(error <= tolerance, "seed {seed}: {error} > {tolerance}");
                assert_manifold(&mesh, steps.edges.iter().sum());
            }
        }
    }

    #[test]
    fn straight_edges_of_a_bumpy_piece_keep_the_tolerance_too() {
        let mut piece = Bicubic {
            points: std::array::from_fn(|i| std::array::from_fn(|j| DVec3::new(i as f64, j as f64, 0.0))),
        };
        for (i, j) in [(1, 1), (1, 2), (2, 1), (2, 2)] {
            piece.points[i][j].z = if i == j { 5.0 } else { -4.0 };
        }
        let patch = single(piece);
        let steps = Steps::within(&piece, &|_| 1e-2);
        assert_eq!(steps.edges, [1; 4]);
        let mesh = tessellate(&patch, &|_| 1e-2);
        assert!(largest_error(&mesh, &piece) <= 1e-2);
        assert_manifold(&mesh, 4);
    }

    #[test]
    fn pieces_put_the_same_bits_on_a_common_edge() {
        // One neighbour shares the edge in its own direction, one backwards, one at another side; insides differ wildly.
        let first = wild(1);
        let mut second = wild(2);
        second.points[0] = first.points[3];
        let mut third = wild(3);
        third.points[3] = {
            let [a, b, c, d] = first.points[3];
            [d, c, b, a]
        };
        let mut fourth = wild(4);
        for i in 0..4 {
            fourth.points[i][3] = first.points[3][3 - i];
        }
        let tolerance: Tolerance = &|_| 1e-3;
        let border = |piece: &Bicubic, edge: usize| {
            let patch = single(*piece);
            let mesh = tessellate(&patch, tolerance);
            let on_edge = |uv: &DVec2| match EDGES[edge] {
                Edge::StartU => uv.x == 0.0,
                Edge::EndU => uv.x == 1.0,
                Edge::StartV => uv.y == 0.0,
                Edge::EndV => uv.y == 1.0,
            };
            let mut bits: Vec<[u64; 3]> = mesh
                .positions
                .iter()
                .zip(&mesh.uvs)
                .filter(|(_, uv)| on_edge(uv))
                .map(|(p, _)| p.to_array().map(f64::to_bits))
                .collect();
            bits.sort_unstable();
            bits
        };
        let expected = border(&first, 1);
        assert!(expected.len() > 4);
        assert_eq!(border(&second, 0), expected);
        assert_eq!(border(&third, 1), expected);
        assert_eq!(border(&fourth, 3), expected);
    }

    #[test]
    fn five_steps_meet_eight_without_a_pinhole() {
        // Rates of the inside differ; the seam's own is one.
        let piece = wild(6);
        let mut mesh = Mesh::default();
        let steps = Steps { u: inner(5), v: inner(8), edges: [3, 7, 11, 1] };
        dice(&single(piece), 0, &steps, &mut mesh);
        assert_manifold(&mesh, 22);
    }

    #[test]
    fn collapsed_edges_make_no_empty_triangles() {
        let mut piece = wild(9);
        piece.points[0] = [piece.points[0][0]; 4];
        let mesh = tessellate(&single(piece), &|_| 1e-2);
        let area = |t: &[u32; 3]| {
            let [p, q, r] = t.map(|k| mesh.positions[k as usize]);
            (q - p).cross(r - p).length()
        };
        assert!(mesh.triangles.iter().all(|t| area(t) > 0.0));
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-14));
        let point = single(Bicubic { points: [[DVec3::ONE; 4]; 4] });
        assert!(tessellate(&point, &|_| 1e-2).triangles.is_empty());
    }

    #[test]
    fn triangles_face_the_way_of_the_normal() {
        let patch = single(paraboloid(0.0));
        let mesh = tessellate(&patch, &|_| 1e-2);
        for t in &mesh.triangles {
            let [p, q, r] = t.map(|k| mesh.positions[k as usize]);
            assert!((q - p).cross(r - p).dot(mesh.normals[t[0] as usize]) > 0.0);
        }
        assert_eq!(mesh.positions.len(), mesh.normals.len());
    }

    #[test]
    fn steps_keep_the_error_and_no_fewer_of_either_direction_would() {
        for uu in [0.0, 1e-9, 0.3, 1.0, 40.0] {
            for uv in [0.0, 1e-9, 0.5, 7.0] {
                for vv in [0.0, 1e-9, 0.3, 1.0, 40.0] {
                    let bend = Bend { uu, uv, vv };
                    let (n, m) = bend.steps(1e-4);
                    let error = |n: usize, m: usize| bend.error(1.0 / n as f64, 1.0 / m as f64);
                    assert!(error(n, m) <= 1e-4 * (1.0 + 1e-12), "{bend:?}: {n} × {m}");
                    let needed = |n: usize, m: usize| n.min(m) > 1 && error(n, m) > 1e-4;
                    assert!(n.max(m) == 2 || needed(n - 1, m) || needed(n, m - 1), "{bend:?}: {n} × {m}");
                }
            }
        }
    }

    #[test]
    fn an_impossible_tolerance_is_bounded() {
        let steps = Steps::within(&wild(1), &|_| 0.0);
        assert_eq!(steps.edges, [MOST_STEPS; 4]);
    }
}
