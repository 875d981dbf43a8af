//! Rotation-minimising frames along a path. Wang, Jüttler, Zheng & Liu, *Computation of rotation minimizing frames* (2008).
//! Knows nothing of what is swept along them.
//!
//! A frame is carried from node to node by double reflection (fourth order), with nodes as close as it takes for the twist to be
//! right to `TWIST`. On a closed path it comes back turned about the tangent; that angle is spread evenly over its length.

use super::arc_length::ArcLength;
use super::curve::{Side, across, any_across};
use super::path::Path;
use crate::math::elementary::{atan2, sin_cos};
use crate::math::{Affine, Point};
use glam::{DMat3, DVec3};

/// A right-handed frame at a point of a path; the axes are unit vectors at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The point.
    pub origin: DVec3,
    /// To the side: `up` × `tangent`.
    pub side: DVec3,
    /// At the start, as near to the direction asked for as the tangent lets it.
    pub up: DVec3,
    /// Direction of motion.
    pub tangent: DVec3,
}

impl Frame {
    /// The map that takes x to the side, y to `up`, z to the tangent, and the origin to the point.
    pub fn to_affine(&self) -> Affine {
        let linear = DMat3::from_cols(self.side, self.up, self.tangent);
        let back = linear.transpose();
        Affine {
            linear,
            translation: self.origin,
            inverse_linear: back,
            inverse_translation: -(back * self.origin),
        }
    }
}

/// What the twist of a stretch between two cuts may be off by, radians.
const TWIST: f64 = 1e-9;
/// Most nodes between two cuts.
const MOST_NODES: usize = 1024;
/// Nodes to start with.
const FIRST_NODES: usize = 8;

/// A frame without its side, which follows from the rest.
#[derive(Clone, Copy, Debug)]
struct Node {
    t: f64,
    origin: DVec3,
    tangent: DVec3,
    up: DVec3,
}

/// Frames along one path.
#[derive(Clone, Debug)]
pub struct Frames {
    nodes: Vec<Node>,
    /// Of a closed path: what its frame has turned by after one round, about the tangent, and its lengths.
    round: Option<(f64, ArcLength)>,
}

impl Frames {
    /// Prepares the frames of a path.
    pub fn of(path: &dyn Path<DVec3>) -> Frames {
        let cuts = path.cuts();
        let tangent = path.direction(cuts[0], Side::After);
        let start = Node { t: cuts[0], origin: path.position(cuts[0]), tangent, up: any_across(tangent) };
        let mut nodes = vec![start];
        for w in cuts.windows(2) {
            let first = corner(nodes[nodes.len() - 1], path.direction(w[0], Side::After));
            nodes.pop();
            nodes.extend(stretch(path, first, w[1]));
        }
        let round = path.closed().then(|| {
            let end = corner(nodes[nodes.len() - 1], tangent);
            (angle(start.up, end.up, tangent), ArcLength::of(path))
        });
        Frames { nodes, round }
    }

    /// The frame at t in the domain, `up` being where y shall point at the start of the path. Where `up` is along the tangent
    /// there, some fixed direction across it serves instead.
    pub fn at(&self, path: &dyn Path<DVec3>, t: f64, up: DVec3) -> Frame {
        let i = self.nodes.partition_point(|node| node.t <= t).saturating_sub(1);
        let node = self.nodes[i];
        let last = i + 1 == self.nodes.len();
        let here = if t == node.t {
            node
        } else {
            let side = if self.nodes.get(i + 1).is_some_and(|next| next.t == t) || last {
                Side::Before
            } else {
                Side::After
            };
            carry(node, t, path.position(t), path.direction(t, side))
        };
        let turn = self.offset(up) - self.unwound(path, t);
        let up = turned(here.up, here.tangent, turn);
        Frame { origin: here.origin, side: up.cross(here.tangent), up, tangent: here.tangent }
    }

    /// Angle about the first tangent from the frames' own first `up` to the one asked for.
    fn offset(&self, up: DVec3) -> f64 {
        let start = self.nodes[0];
        let wanted = across(up, start.tangent);
        if wanted.max_abs() <= 8.0 * f64::EPSILON * up.max_abs() {
            return 0.0;
        }
        angle(start.up, wanted, start.tangent)
    }

    /// How much of the angle of a whole round is taken back by t.
    fn unwound(&self, path: &dyn Path<DVec3>, t: f64) -> f64 {
        let Some((round, length)) = &self.round else { return 0.0 };
        let total = length.total().value;
        if total == 0.0 { 0.0 } else { round * (length.up_to(path, t) / total) }
    }
}

/// Nodes from `first` to the parameter `end`, both taken in, so many that twice as many would turn the last by less than [`TWIST`].
/// Frames turn by the fourth power of the step, so that the finer half already is 16 times as good.
fn stretch(path: &dyn Path<DVec3>, first: Node, end: f64) -> Vec<Node> {
    let mut coarse = walk(path, first, end, FIRST_NODES);
    loop {
        let n = 2 * (coarse.len() - 1);
        let fine = walk(path, first, end, n);
        let (a, b) = (coarse[coarse.len() - 1], fine[n]);
        if angle(a.up, b.up, b.tangent).abs() <= TWIST || n >= MOST_NODES {
            return fine;
        }
        coarse = fine;
    }
}

fn walk(path: &dyn Path<DVec3>, first: Node, end: f64, n: usize) -> Vec<Node> {
    let mut nodes = vec![first];
    for k in 1..=n {
        let t = if k == n { end } else { first.t + (end - first.t) * (k as f64 / n as f64) };
        let side = if k == n { Side::Before } else { Side::After };
        nodes.push(carry(nodes[k - 1], t, path.position(t), path.direction(t, side)));
    }
    nodes
}

/// Double reflection: in the plane midway between the points, then in the one that brings the tangent to where it should be.
fn carry(from: Node, t: f64, origin: DVec3, tangent: DVec3) -> Node {
    let chord = origin - from.origin;
    let Some(chord) = chord.unit() else { return Node { t, origin, ..corner(from, tangent) } };
    let reflect = |v: DVec3, n: DVec3| v - n * (2.0 * v.dot(n));
    let (up, reflected) = (reflect(from.up, chord), reflect(from.tangent, chord));
    let up = match (tangent - reflected).unit() {
        Some(n) => reflect(up, n),
        None => up,
    };
    Node { t, origin, tangent, up: upright(up, tangent, from.up) }
}

/// Turns a frame on the spot, about the axis at right angles to both tangents; straight back, about its `up`.
fn corner(from: Node, tangent: DVec3) -> Node {
    let sum = from.tangent + tangent;
    let up = from.up - sum * (2.0 * sum.dot(from.up) / sum.dot(sum).max(f64::MIN_POSITIVE));
    Node { tangent, up: upright(up, tangent, from.up), ..from }
}

/// `up`, freed of rounding along the tangent; where nothing is left of it, some vector across.
fn upright(up: DVec3, tangent: DVec3, before: DVec3) -> DVec3 {
    across(up, tangent)
        .unit()
        .or_else(|| across(before, tangent).unit())
        .unwrap_or_else(|| any_across(tangent))
}

/// Angle from a to b about an axis at right angles to both, radians in (−π, π].
fn angle(a: DVec3, b: DVec3, axis: DVec3) -> f64 {
    atan2(axis.dot(a.cross(b)), a.dot(b))
}

/// v, at right angles to the unit axis, turned about it.
fn turned(v: DVec3, axis: DVec3, angle: f64) -> DVec3 {
    if angle == 0.0 {
        return v;
    }
    let (s, c) = sin_cos(angle);
    across(v * c + axis.cross(v) * s, axis).unit().unwrap_or(v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::{Curve, Ends};

    fn track() -> Curve<DVec3> {
        let p = [
            (4.0, 1.0, 0.0),
            (3.0, 2.5, 3.0),
            (0.0, 1.0, 4.0),
            (-3.0, 0.6, 3.0),
            (-4.0, 3.0, 0.0),
            (-3.0, 1.0, -3.0),
            (0.0, 2.0, -4.0),
            (3.0, 0.6, -3.0),
        ];
        let p = p.map(|(x, y, z)| DVec3::new(x, y, z));
        Curve::bspline(&p, Ends::Closed, None).unwrap()
    }

    fn assert_orthonormal(f: &Frame) {
        let m = DMat3::from_cols(f.side, f.up, f.tangent);
        let rest = (m.transpose() * m - DMat3::IDENTITY).to_cols_array();
        assert!(rest.iter().all(|x| x.abs() < 2e-15) && (m.determinant() - 1.0).abs() < 2e-15, "{f:?}");
    }

    #[test]
    fn frames_of_a_closed_path_close() {
        let path = track();
        let frames = Frames::of(&path);
        for up in [DVec3::Y, DVec3::new(1.0, 2.0, -0.5)] {
            let (start, end) = (frames.at(&path, 0.0, up), frames.at(&path, 1.0, up));
            assert!((start.up - end.up).length() < 1e-12 && (start.side - end.side).length() < 1e-12);
            assert!(start.up.dot(across(up, start.tangent).normalize()) > 1.0 - 1e-15);
        }
    }

    #[test]
    fn frames_are_upright_continuous_and_of_even_twist() {
        let path = track();
        let frames = Frames::of(&path);
        let n = 4000;
        let at: Vec<Frame> =
            (0..=n).map(|i| frames.at(&path, f64::from(i) / f64::from(n), DVec3::Y)).collect();
        let round = frames.round.as_ref().unwrap().0;
        for w in at.windows(2) {
            assert_orthonormal(&w[0]);
            // Carried from one sample to the next, a frame differs from the next by its share of the spread angle alone.
            let node = |f: &Frame| Node { t: 0.0, origin: f.origin, tangent: f.tangent, up: f.up };
            let carried = carry(node(&w[0]), 0.0, w[1].origin, w[1].tangent);
            let twist = angle(carried.up, w[1].up, w[1].tangent);
            assert!((twist + round / f64::from(n)).abs() < 1e-3, "{twist}");
        }
    }

    #[test]
    fn a_plane_path_keeps_its_plane() {
        let p = [(0.0, 0.0), (3.0, 1.0), (-1.0, 2.0), (2.0, 2.0)].map(|(x, y)| DVec3::new(x, 0.0, y));
        let path = Curve::bezier(&p, None, false).unwrap();
        let frames = Frames::of(&path);
        for i in 0..=100 {
            let f = frames.at(&path, f64::from(i) / 100.0, DVec3::Y);
            assert!((f.up - DVec3::Y).length() < 1e-14);
        }
    }

    #[test]
    fn a_helix_turns_back_by_its_torsion() {
        // Dense interpolation of a helix of radius 1 and slope c: the frame turns against Frenet's by τ per unit length.
        let c = 0.5;
        let p: Vec<DVec3> = (0..=400)
            .map(|i| {
                let a = f64::from(i) * 0.02;
                let (s, co) = sin_cos(a);
                DVec3::new(co, s, c * a)
            })
            .collect();
        let path = Curve::natural(&p, None, false).unwrap();
        let frames = Frames::of(&path);
        let relative = |t: f64| {
            let f = frames.at(&path, t, DVec3::Z);
            angle(path.normal(t).unwrap(), f.up, f.tangent)
        };
        let (a, b) = (relative(0.25), relative(0.3));
        let torsion = c / (1.0 + c * c);
        let expected = -torsion * (0.05 * 8.0) * (1.0 + c * c).sqrt();
        assert!((b - a - expected).abs() < 1e-5, "{} {expected}", b - a);
    }

    #[test]
    fn cusps_corners_and_straight_lines_have_frames() {
        let cases = [
            vec![(0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)],
            vec![(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)],
            vec![
                (0.0, 0.0, 0.0),
                (0.0, 1.0, 0.0),
                (0.0, 2.0, 0.0),
                (0.0, 3.0, 0.0),
                (1.0, 3.0, 0.0),
                (2.0, 3.0, 0.0),
                (3.0, 3.0, 1.0),
            ],
            vec![(1.0, 1.0, 1.0); 4],
        ];
        for p in cases {
            let p: Vec<DVec3> = p.iter().map(|(x, y, z)| DVec3::new(*x, *y, *z)).collect();
            let point = p.iter().all(|q| *q == p[0]);
            let path = Curve::bezier(&p, None, false).unwrap();
            let frames = Frames::of(&path);
            for i in 0..=64 {
                let f = frames.at(&path, f64::from(i) / 64.0, DVec3::Y);
                if !point {
                    assert_orthonormal(&f);
                }
            }
        }
    }

    #[test]
    fn the_map_of_a_frame_has_its_inverse() {
        let path = track();
        let map = Frames::of(&path).at(&path, 0.3, DVec3::Y).to_affine();
        let p = DVec3::new(0.3, -2.0, 5.0);
        assert!(map.inverse().point(map.point(p)).distance(p) < 1e-14);
        assert!(map.vector(DVec3::Z).distance(path.tangent(0.3).unwrap()) < 1e-15);
    }
}
