//! Prisms along a curve: a closed outline carried by the curve's rotation-minimising frame. Knows nothing of scenes.
//!
//! The frame and its origin are followed by cubics to within [`SWEEP_FIT`] of the sweep's size; a point of the outline is then carried by the same
//! cubic combination of its control points, so that the surface is made of bicubic pieces whose seams are shared to the bit, and is met
//! as patches are.

mod mesh;

use super::outline::Outline;
use super::prism::Placing;
use super::{SurfacePoint, Touch};
use crate::geometry::boxes::Line;
use crate::geometry::curve::Side;
use crate::geometry::frame::{Frame, Frames};
use crate::geometry::patch::{Bicubic, PatchHit, PatchTree};
use crate::geometry::path::Path;
use crate::math::Aabb;
use glam::{DVec2, DVec3};

/// The pieces stray from the true sweep by no more than this part of its size: a thousandth of a pixel in a picture of a thousand.
pub const SWEEP_FIT: f64 = 1e-6;
/// Most cubics along the curve.
const MOST_PIECES: usize = 4096;
/// Tangents before and after a place that differ by more than this, radians, make a corner.
const CORNER: f64 = 1e-6;

/// Why an outline cannot be carried along a curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SweepError {
    /// The curve has a corner.
    #[error("its path has a corner of {degrees:.3} degrees where t = {at}")]
    Corner {
        /// Where, in the curve's parameter.
        at: f64,
        /// How sharp.
        degrees: f64,
    },
    /// The curve stands still all along.
    #[error("its path has no length")]
    Still,
}

/// A prism along a curve, ready for rays.
#[derive(Clone, Debug)]
pub struct Sweep {
    outline: Outline,
    tree: PatchTree,
    /// How many pieces go along.
    steps: usize,
    /// The planes of both ends with their normals out; none of a closed curve.
    ends: Option<[Placing; 2]>,
    bounds: Aabb,
}

/// Where the outline is carried, as a cubic in each of its vectors.
struct Carried {
    origin: [DVec3; 4],
    side: [DVec3; 4],
    up: [DVec3; 4],
}

impl Sweep {
    /// Carries an outline along a path.
    pub fn new(outline: Outline, path: &dyn Path<DVec3>) -> Result<Sweep, SweepError> {
        check(path)?;
        let frames = Frames::of(path);
        let chain = follow(path, &frames, outline.size());
        let pieces: Vec<Bicubic> =
            outline.pieces().iter().flat_map(|c| chain.iter().map(move |k| k.carry(&c.points))).collect();
        let (start, end) = path.domain();
        let ends = (!path.closed()).then(|| {
            let at = |t: f64, turn: f64| placing(&frames.at(path, t, DVec3::Y), turn);
            [at(start, -1.0), at(end, 1.0)]
        });
        let tree = PatchTree::new(&pieces);
        let bounds = tree.bounds();
        Ok(Sweep { outline, tree, steps: chain.len(), ends, bounds })
    }

    /// The box around it.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Largest coordinate of anything on it.
    pub fn size(&self) -> f64 {
        self.bounds.min.abs().max(self.bounds.max.abs()).max_element()
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(self.tree.pieces())
    }

    /// The first meeting with `near` < t ≤ `far`.
    pub fn first(&self, line: &Line, near: f64, far: f64) -> Option<Touch> {
        let hit = self.tree.first_hit(line.origin, line.direction * line.length, near.next_up(), far);
        let side = hit.as_ref().map(side_touch);
        let faces = self.faces(line).filter(|touch| touch.t > near && touch.t <= far);
        side.into_iter().chain(faces).reduce(|a, b| if b.t < a.t { b } else { a })
    }

    /// Every meeting along the whole line, both ways, ascending.
    pub fn all(&self, line: &Line) -> Vec<Touch> {
        let everywhere = f64::MAX / line.length.max(1.0);
        let direction = line.direction * line.length;
        let sides = self.tree.all_hits(line.origin, direction, -everywhere, everywhere).hits;
        let mut found: Vec<Touch> = sides.iter().map(side_touch).chain(self.faces(line)).collect();
        found.sort_by(|a, b| a.t.total_cmp(&b.t));
        found
    }

    /// Meetings with the flat faces.
    fn faces(&self, line: &Line) -> impl Iterator<Item = Touch> + '_ {
        let line = *line;
        self.ends.iter().flatten().enumerate().filter_map(move |(k, end)| {
            let rise = end.along.dot(line.direction);
            let s = end.along.dot(end.origin - line.origin) / rise;
            let is_met = s.is_finite() && self.outline.contains(end.flat(line.at(s)));
            is_met.then_some(Touch::new(s / line.length, FACES + k as u32, 0.0))
        })
    }

    /// The surface where a line touched it.
    pub fn surface(&self, line: &Line, touch: &Touch) -> SurfacePoint {
        if let (Some(end), Some(ends)) = (touch.part.checked_sub(FACES), &self.ends) {
            let end = &ends[end as usize];
            let seen = line.at(touch.t * line.length);
            let point = seen - end.along * end.along.dot(seen - end.origin);
            let uv = end.flat(point);
            return SurfacePoint { point, normal: end.along, tangent: end.side, uv };
        }
        self.point(touch.part as usize, touch.x, touch.y)
    }

    /// A point of the side, by its piece.
    fn point(&self, piece: usize, u: f64, v: f64) -> SurfacePoint {
        let [point, du, dv] = self.tree.pieces()[piece].first_order(u, v);
        let normal = self.tree.pieces()[piece].normal(u, v).unwrap_or(DVec3::Y);
        let (outline_piece, step) = ((piece / self.steps) as u32, piece % self.steps);
        // u × v points out of an outline that turns left.
        let out = self.outline.normal(outline_piece, u);
        let turn = self.outline.pieces()[outline_piece as usize].direction(u).unwrap_or(DVec2::Y);
        let side = if out.dot(DVec2::new(turn.y, -turn.x)) < 0.0 { -1.0 } else { 1.0 };
        let (_, share) = self.outline.at(outline_piece, u);
        let tangent = if du == DVec3::ZERO { dv.cross(normal) } else { du };
        let uv = DVec2::new(share, (step as f64 + v) / self.steps as f64);
        SurfacePoint { point, normal: normal * side, tangent, uv }
    }
}

/// The number of the face at the start; the one at the end follows.
const FACES: u32 = u32::MAX - 1;

fn side_touch(hit: &PatchHit) -> Touch {
    Touch { t: hit.t, part: hit.piece as u32, x: hit.u, y: hit.v }
}

/// The outline's place at an end: its normal out is along (`turn` 1) or against the tangent.
fn placing(frame: &Frame, turn: f64) -> Placing {
    Placing { origin: frame.origin, side: frame.side, up: frame.up, along: frame.tangent * turn }
}

/// What keeps an outline from being carried along a path: cheap.
pub fn check(path: &dyn Path<DVec3>) -> Result<(), SweepError> {
    let cuts = path.cuts();
    let ways = |t: f64| [Side::Before, Side::After].map(|side| path.direction(t, side));
    let inner = cuts.iter().skip(1).take(cuts.len().saturating_sub(2));
    let (start, end) = path.domain();
    let seam = path
        .closed()
        .then(|| (start, [path.direction(end, Side::Before), path.direction(start, Side::After)]));
    for (at, [before, after]) in inner.map(|t| (*t, ways(*t))).chain(seam) {
        let angle = crate::math::elementary::atan2(before.cross(after).length(), before.dot(after));
        if angle > CORNER {
            return Err(SweepError::Corner { at, degrees: angle.to_degrees() });
        }
    }
    let first = path.position(start);
    let is_still =
        cuts.iter().all(|t| path.position(*t) == first) && path.position(0.5 * (start + end)) == first;
    if is_still { Err(SweepError::Still) } else { Ok(()) }
}

/// Cubics that follow the frames within the tolerance for points as far out as `reach`.
fn follow(path: &dyn Path<DVec3>, frames: &Frames, reach: f64) -> Vec<Carried> {
    let cuts = path.cuts();
    let origin = path.position(cuts[0]);
    let extent = cuts.iter().fold(reach, |m: f64, t| m.max(path.position(*t).distance(origin)));
    let allowed = SWEEP_FIT * extent;
    let at = |t: f64| frames.at(path, t, DVec3::Y);
    let mut chain: Vec<Carried> = Vec::new();
    for w in cuts.windows(2) {
        let mut waiting = vec![(w[0], w[1])];
        while let Some((a, b)) = waiting.pop() {
            let piece = Carried::between(&|x| at(a + (b - a) * x));
            let stray = [0.2, 0.5, 0.8]
                .into_iter()
                .fold(0.0, |m: f64, x| m.max(piece.stray(x, &at(a + (b - a) * x), reach)));
            let middle = 0.5 * (a + b);
            let is_full = chain.len() + waiting.len() >= MOST_PIECES;
            if stray <= allowed || is_full || !(a < middle && middle < b) {
                chain.push(piece);
            } else {
                waiting.extend([(middle, b), (a, middle)]);
            }
        }
    }
    join(&mut chain, path.closed());
    chain
}

/// Neighbours share the vectors where they meet, to the bit.
fn join(chain: &mut [Carried], closed: bool) {
    for k in 1..chain.len() {
        let end = [chain[k - 1].origin[3], chain[k - 1].side[3], chain[k - 1].up[3]];
        let next = &mut chain[k];
        [next.origin[0], next.side[0], next.up[0]] = end;
    }
    if closed {
        let start = [chain[0].origin[0], chain[0].side[0], chain[0].up[0]];
        if let Some(last) = chain.last_mut() {
            [last.origin[3], last.side[3], last.up[3]] = start;
        }
    }
}

impl Carried {
    /// Through the frames at 0, ⅓, ⅔ and 1.
    fn between(at: &dyn Fn(f64) -> Frame) -> Carried {
        let frames = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(at);
        Carried {
            origin: through(frames.map(|f| f.origin)),
            side: through(frames.map(|f| f.side)),
            up: through(frames.map(|f| f.up)),
        }
    }

    /// How far a point of the outline within `reach` of its origin may be from where the frame carries it.
    fn stray(&self, x: f64, frame: &Frame, reach: f64) -> f64 {
        let off = |points: &[DVec3; 4], true_one: DVec3| {
            crate::geometry::curve::evaluate::bernstein(points, x).distance(true_one)
        };
        off(&self.origin, frame.origin) + reach * (off(&self.side, frame.side) + off(&self.up, frame.up))
    }

    /// A piece of the outline along u, this stretch along v.
    fn carry(&self, outline: &[DVec2; 4]) -> Bicubic {
        let points =
            outline.map(|p| std::array::from_fn(|j| self.origin[j] + self.side[j] * p.x + self.up[j] * p.y));
        Bicubic { points }
    }
}

/// Bézier points of the cubic through four values at 0, ⅓, ⅔ and 1.
fn through([a, b, c, d]: [DVec3; 4]) -> [DVec3; 4] {
    [a, (a * -5.0 + b * 18.0 - c * 9.0 + d * 2.0) / 6.0, (a * 2.0 - b * 9.0 + c * 18.0 - d * 5.0) / 6.0, d]
}
