//! Surfaces of revolution about the y axis, from a profile of distances from it and heights. Knows nothing of scenes.
//!
//! A line sees the profile as a curve that meets one branch of a hyperbola, ρ² = ρ₀² + q², q being the distance along its horizontal part from where
//! it is nearest to the axis. Rather than the polynomial of degree 6 that is left when q is eliminated by squaring, whose roots run
//! together for level lines, a steep line (|dy| ≥ the horizontal part) is asked where x = √(ρ₀² + q(y)²), and a level one where y = y(±√(x² − ρ₀²)): both
//! are well conditioned, and their slopes are bounded by arithmetic on the ends of monotone pieces. No root is missed, none is doubled.

mod mesh;
#[cfg(test)]
mod tests;

use super::cubic::{Cubic, least};
use super::span::{Spans, clip, wedge};
use super::zeros::{self, Bounded, product, quadratic_range};
use super::{SurfacePoint, Touch};
use crate::geometry::boxes::{BoxTree, Line};
use crate::math::Aabb;
use crate::math::elementary::{atan2, sin_cos};
use crate::math::exact::difference_of_products;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Why a profile makes no surface.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LatheError {
    /// A distance from the axis below 0.
    #[error("its profile is beyond the axis, at x = {x}, where t = {at}")]
    Negative {
        /// The least x.
        x: f64,
        /// Where, in the curve's parameter.
        at: f64,
    },
    /// Nothing to see.
    #[error("its profile lies on the axis")]
    Thin,
    /// A coordinate that is NaN, infinite, or too large to be squared.
    #[error("its profile is not finite, or beyond 1e150")]
    NotFinite,
}

/// A surface of revolution, ready for rays.
#[derive(Clone, Debug)]
pub struct Lathe {
    /// In the order of the tree.
    arcs: Vec<Arc>,
    tree: BoxTree,
    /// How far it goes round, radians; none is all the way.
    angle: Option<f64>,
    /// Whether rays tell an inside: the profile is closed, or by the axis.
    solid: bool,
    /// 1 where (y′, −x′) points out of the profile, else −1.
    side: f64,
    size: f64,
}

/// A piece of the profile on which neither coordinate turns back.
#[derive(Clone, Debug)]
struct Arc {
    x: [f64; 4],
    y: [f64; 4],
    /// Bézier values of the derivatives.
    dx: [f64; 3],
    dy: [f64; 3],
    /// Share of the profile's length at both ends.
    shares: (f64, f64),
}

/// x below 0 by no more than this part of the profile's size is on the axis: what making the spline may have cost.
const ON_AXIS: f64 = 64.0 * f64::EPSILON;
/// Coordinates beyond this could not be squared.
const LARGEST: f64 = 1e150;
/// Pieces whose tangents turn by more than this, radians, are halved, this often at most.
const MOST_TURN: f64 = 0.6;
const MOST_HALVINGS: u32 = 5;

impl Lathe {
    /// What keeps a profile from making a surface: cheap.
    pub fn check(profile: &[Cubic<DVec2>]) -> Result<(), LatheError> {
        let size = size_of(profile);
        if !size.le(&LARGEST) {
            return Err(LatheError::NotFinite);
        }
        let across: Vec<Cubic<f64>> = profile
            .iter()
            .map(|c| Cubic { start: c.start, end: c.end, points: c.points.map(|p| p.x) })
            .collect();
        let (x, at) = least(&across);
        if x < -ON_AXIS * size {
            return Err(LatheError::Negative { x, at });
        }
        let is_thin = across.iter().all(|c| c.points.iter().all(|x| *x <= ON_AXIS * size));
        if is_thin { Err(LatheError::Thin) } else { Ok(()) }
    }

    /// Whether a profile bounds a solid: it is closed, or begins and ends on the axis.
    pub fn is_closed(profile: &[Cubic<DVec2>], closed: bool) -> bool {
        let slack = ON_AXIS * size_of(profile);
        let ends = [profile[0].points[0], profile[profile.len() - 1].points[3]];
        closed || ends.iter().all(|end| end.x <= slack) || ends[0].distance(ends[1]) <= slack
    }

    /// Turns a profile of (x, y) about the y axis, by an angle in (0, 2π), from x toward −z; none is all the way. A profile that is closed,
    /// or begins and ends on the axis, bounds a solid, with flat faces at both ends of the angle; any other is a surface with two sides.
    /// Errors: those of [`Lathe::check`].
    pub fn new(profile: &[Cubic<DVec2>], closed: bool, angle: Option<f64>) -> Result<Lathe, LatheError> {
        Lathe::check(profile)?;
        let size = size_of(profile);
        let solid = Lathe::is_closed(profile, closed);
        let mut arcs: Vec<Arc> = profile.iter().flat_map(|c| tame(c, ON_AXIS * size)).collect();
        share(&mut arcs);
        let area: f64 = arcs.iter().map(Arc::area).sum();
        let tree = BoxTree::build(&mut arcs, 1, Arc::bounds);
        Ok(Lathe { arcs, tree, angle, solid, side: if area < 0.0 { -1.0 } else { 1.0 }, size })
    }

    /// The box around all of it, the part that the angle leaves out included.
    pub fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    /// Largest coordinate of its profile.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// True where rays tell an inside.
    pub fn is_solid(&self) -> bool {
        self.solid
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.arcs.as_slice()) + self.tree.bytes()
    }

    /// The first meeting with `near` < t ≤ `far`.
    pub fn first(&self, line: &Line, near: f64, far: f64) -> Option<Touch> {
        if self.angle.is_some() {
            return self.all(line).into_iter().find(|h| h.t > near && h.t <= far);
        }
        let view = View::of(line, self.size);
        let mut best: Option<Touch> = None;
        self.tree.walk(line, near * line.length, far * line.length, |range, mut reach| {
            for index in range {
                self.arcs[index].meet(&view, index as u32, |touch, _| {
                    if touch.t > near && touch.t <= far && best.is_none_or(|b| touch.t < b.t) {
                        best = Some(touch);
                        reach = reach.min(touch.t * line.length);
                    }
                });
            }
            reach
        });
        best
    }

    /// Every meeting along the whole line, both ways, ascending: in and out in turn where it is solid, a tangent twice.
    pub fn all(&self, line: &Line) -> Vec<Touch> {
        let view = View::of(line, self.size);
        let mut found = Vec::new();
        self.tree.walk(line, f64::NEG_INFINITY, f64::INFINITY, |range, reach| {
            for index in range {
                self.arcs[index].meet(&view, index as u32, |touch, is_crossing| {
                    found.push(touch);
                    found.extend((self.solid && !is_crossing).then_some(touch));
                });
            }
            reach
        });
        found.sort_by(|a, b| a.t.total_cmp(&b.t));
        let Some(angle) = self.angle else { return found };
        if self.solid {
            clip(&found, &self.wedge(line, angle))
        } else {
            found.retain(|touch| longitude(line.at(touch.t * line.length)) <= angle);
            found
        }
    }

    /// The stretches of the line within the angle.
    fn wedge(&self, line: &Line, angle: f64) -> Spans {
        let half = |out: DVec3, part: u32| {
            let (height, rise) = (out.dot(line.origin), out.dot(line.direction));
            wedge::half_space(height, rise, line.length, part)
        };
        let (start, end) = (half(START_OUT, FACES), half(out_at(angle), FACES + 1));
        if angle <= 0.5 * TAU { wedge::both(start, end) } else { wedge::either(start, end) }
    }

    /// The surface where a line touched it.
    pub fn surface(&self, line: &Line, touch: &Touch) -> SurfacePoint {
        let seen = line.at(touch.t * line.length);
        if touch.part >= FACES {
            return self.face(seen, touch.part == FACES);
        }
        let arc = &self.arcs[touch.part as usize];
        let (at, velocity) = (arc.at(touch.x), arc.direction(touch.x));
        let flat = DVec2::new(seen.x, seen.z);
        let toward = DVec2::new(-line.direction.x, -line.direction.z);
        let out = flat.try_normalize().or(toward.try_normalize()).unwrap_or(DVec2::X);
        let normal = DVec3::new(out.x * velocity.y, -velocity.x, out.y * velocity.y) * self.side;
        let point = DVec3::new(out.x * at.x, at.y, out.y * at.x);
        let u = longitude(point) / self.angle.unwrap_or(TAU);
        SurfacePoint {
            point,
            normal,
            tangent: DVec3::new(out.y, 0.0, -out.x),
            uv: DVec2::new(u.min(1.0), arc.share(touch.x)),
        }
    }

    /// A flat face at an end of the angle: (u, v) are distance from the axis and height.
    fn face(&self, seen: DVec3, is_start: bool) -> SurfacePoint {
        let normal = if is_start { START_OUT } else { out_at(self.angle.unwrap_or(TAU)) };
        let point = seen - normal * normal.dot(seen);
        let along = normal.cross(DVec3::Y) * if is_start { 1.0 } else { -1.0 };
        SurfacePoint { point, normal, tangent: along, uv: DVec2::new(along.dot(point).abs(), point.y) }
    }
}

/// Largest coordinate; NaN where one is.
fn size_of(profile: &[Cubic<DVec2>]) -> f64 {
    let numbers = profile.iter().flat_map(|c| c.points).flat_map(|p| p.to_array());
    numbers.fold(0.0, |m: f64, x| if x.abs() <= m { m } else { x.abs() })
}

/// The number of the face at the start of the angle; the one at its end follows. Arcs are fewer.
const FACES: u32 = u32::MAX - 1;
/// Out of the face at the start of the angle.
const START_OUT: DVec3 = DVec3::Z;

/// Out of the face at the end of an angle.
fn out_at(angle: f64) -> DVec3 {
    let (s, c) = sin_cos(angle);
    DVec3::new(-s, 0.0, -c)
}

/// From x toward −z, in [0, 2π).
fn longitude(p: DVec3) -> f64 {
    let angle = atan2(-p.z, p.x);
    if angle < 0.0 { angle + TAU } else { angle }
}

/// The pieces of a cubic on which neither coordinate turns back, and which bend little. `slack` below 0 is 0.
fn tame(curve: &Cubic<DVec2>, slack: f64) -> Vec<Arc> {
    let hodograph = curve.hodograph();
    let turns = [hodograph.map(|d| d.x), hodograph.map(|d| d.y)];
    let mut cuts: Vec<f64> = turns.iter().flat_map(|h| crate::math::bernstein::roots(h)).collect();
    cuts.sort_by(f64::total_cmp);
    let monotone = curve.cut_at(cuts.into_iter().map(|x| curve.parameter(x)));
    let mut arcs = Vec::new();
    for piece in monotone {
        let mut waiting = vec![(piece, 0)];
        while let Some((piece, depth)) = waiting.pop() {
            if depth < MOST_HALVINGS && piece.turn() > MOST_TURN {
                let [a, b] = piece.split(0.5);
                waiting.extend([(b, depth + 1), (a, depth + 1)]);
            } else {
                arcs.push(Arc::new(&piece, slack));
            }
        }
    }
    arcs
}

/// Sets the shares of the length.
fn share(arcs: &mut [Arc]) {
    let lengths: Vec<f64> = arcs.iter().map(|arc| arc.curve().length_to(1.0)).collect();
    let total: f64 = lengths.iter().sum();
    let mut reached = 0.0;
    for (arc, length) in arcs.iter_mut().zip(lengths) {
        let from = if total > 0.0 { reached / total } else { 0.0 };
        reached += length;
        arc.shares = (from, if total > 0.0 { reached / total } else { 0.0 });
    }
}

impl Arc {
    fn new(piece: &Cubic<DVec2>, slack: f64) -> Arc {
        let x = piece.points.map(|p| if p.x <= slack { 0.0 } else { p.x });
        let y = piece.points.map(|p| p.y);
        let steps = |c: &[f64; 4]| [1, 2, 3].map(|i| 3.0 * (c[i] - c[i - 1]));
        Arc { x, y, dx: steps(&x), dy: steps(&y), shares: (0.0, 0.0) }
    }

    fn curve(&self) -> Cubic<DVec2> {
        Cubic { start: 0.0, end: 1.0, points: std::array::from_fn(|i| DVec2::new(self.x[i], self.y[i])) }
    }

    fn at(&self, x: f64) -> DVec2 {
        self.curve().at(x)
    }

    /// Unit tangent at x.
    fn direction(&self, x: f64) -> DVec2 {
        self.curve().direction(x).unwrap_or(DVec2::Y)
    }

    fn share(&self, x: f64) -> f64 {
        let (from, to) = self.shares;
        let whole = self.curve().length_to(1.0);
        if whole > 0.0 { from + (to - from) * (self.curve().length_to(x) / whole).min(1.0) } else { from }
    }

    /// ∫ x dy.
    fn area(&self) -> f64 {
        self.curve().area()
    }

    fn bounds(&self) -> Aabb {
        let fold = |c: &[f64; 4], f: fn(f64, f64) -> f64| c.iter().copied().reduce(f).unwrap_or(0.0);
        let (r, low, high) = (fold(&self.x, f64::max), fold(&self.y, f64::min), fold(&self.y, f64::max));
        let by = 8.0 * f64::EPSILON * r.max(low.abs()).max(high.abs());
        Aabb { min: DVec3::new(-r - by, low - by, -r - by), max: DVec3::new(r + by, high + by, r + by) }
    }

    /// Calls `found` with each meeting, and whether the line goes through there rather than touching.
    fn meet(&self, view: &View, index: u32, mut found: impl FnMut(Touch, bool)) {
        if view.is_steep {
            let steep = Steep { arc: self, view };
            zeros::zeros(&steep, 0.0, 1.0, |x, is_crossing| {
                let s = (bernstein(&self.y, x) - view.height) / view.dy;
                found(Touch::new(s / view.length, index, x), is_crossing);
            });
            return;
        }
        let Some((from, to)) = self.beyond(view.nearest) else { return };
        for sign in [1.0, -1.0] {
            let level = Level { arc: self, view, sign };
            zeros::zeros(&level, from, to, |x, is_crossing| {
                let s = view.base + sign * level.half_chord(x) / view.level;
                found(Touch::new(s / view.length, index, x), is_crossing);
            });
        }
    }

    /// Where x is at least ρ; none where it is nowhere.
    fn beyond(&self, rho: f64) -> Option<(f64, f64)> {
        let (first, last) = (self.x[0], self.x[3]);
        match (first >= rho, last >= rho) {
            (true, true) => Some((0.0, 1.0)),
            (false, false) => None,
            (_, rises) => {
                let at = crate::math::bracket::newton(0.0, 1.0, 0.5, rises, |t| {
                    (bernstein(&self.x, t) - rho, slope(&self.dx, t))
                });
                Some(if rises { (at, 1.0) } else { (0.0, at) })
            }
        }
    }

    /// Values of a coordinate at both ends of an interval, the lesser first; the whole's ends to the bit.
    fn ends(c: &[f64; 4], from: f64, to: f64) -> (f64, f64) {
        let (a, b) = (bernstein(c, from), bernstein(c, to));
        if a < b { (a, b) } else { (b, a) }
    }
}

fn bernstein(c: &[f64; 4], x: f64) -> f64 {
    crate::geometry::curve::evaluate::bernstein(c, x)
}

fn slope(d: &[f64; 3], x: f64) -> f64 {
    let r = 1.0 - x;
    d[0] * (r * r) + d[1] * (2.0 * r * x) + d[2] * (x * x)
}

/// √(a² + b²) of numbers whose squares fit.
fn hypot(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// A line by what its distance from the axis depends on.
struct View {
    length: f64,
    is_steep: bool,
    /// Vertical and horizontal part of the unit direction.
    dy: f64,
    level: f64,
    /// Height of the origin.
    height: f64,
    /// Distance along the line to where it is nearest to the axis, and the height there. Of no use to steep lines.
    base: f64,
    base_height: f64,
    /// The same distance, along the horizontal part.
    lead: f64,
    /// Least distance from the axis.
    nearest: f64,
    /// What rounding may do to a coordinate.
    noise: f64,
}

/// A line through the axis is taken to pass it at this distance: so it crosses a profile that ends on the axis, rather than touching it.
const OFF_AXIS: f64 = 1e-150;
/// Coordinates are off by so many ε of the largest at most.
const ROUNDINGS: f64 = 16.0;

impl View {
    fn of(line: &Line, size: f64) -> View {
        let (o, d) = (line.origin, line.direction);
        let level = hypot(d.x, d.z);
        let (lead, nearest) = if level > 0.0 {
            let (x, z) = (d.x / level, d.z / level);
            (-(o.x * x + o.z * z), difference_of_products(o.x, z, o.z, x).abs())
        } else {
            (0.0, hypot(o.x, o.z))
        };
        let base = if level > 0.0 { lead / level } else { 0.0 };
        let reach = size + lead.abs() + nearest + o.y.abs();
        View {
            length: line.length,
            is_steep: d.y.abs() >= level,
            dy: d.y,
            level,
            height: o.y,
            base,
            base_height: o.y + base * d.y,
            lead,
            nearest: nearest.max(OFF_AXIS),
            noise: ROUNDINGS * f64::EPSILON * reach,
        }
    }
}

/// x − √(ρ₀² + q²), q the distance along the horizontal part at height y.
struct Steep<'a> {
    arc: &'a Arc,
    view: &'a View,
}

impl Steep<'_> {
    fn along(&self, y: f64) -> f64 {
        self.view.level / self.view.dy * (y - self.view.height) - self.view.lead
    }

    fn lean(&self, q: f64) -> f64 {
        let away = hypot(self.view.nearest, q);
        if away > 0.0 { q / away } else { 0.0 }
    }
}

impl Bounded for Steep<'_> {
    fn value(&self, x: f64) -> f64 {
        bernstein(&self.arc.x, x) - hypot(self.view.nearest, self.along(bernstein(&self.arc.y, x)))
    }

    fn slope(&self, x: f64) -> f64 {
        let lean = self.lean(self.along(bernstein(&self.arc.y, x)));
        slope(&self.arc.dx, x) - lean * (self.view.level / self.view.dy) * slope(&self.arc.dy, x)
    }

    fn range(&self, from: f64, to: f64) -> (f64, f64) {
        let (x0, x1) = Arc::ends(&self.arc.x, from, to);
        let (y0, y1) = Arc::ends(&self.arc.y, from, to);
        let (a, b) = (self.along(y0), self.along(y1));
        let inner = if (a > 0.0) == (b > 0.0) { a.abs().min(b.abs()) } else { 0.0 };
        let rho = self.view.nearest;
        let noise = self.view.noise;
        (x0 - hypot(rho, a.abs().max(b.abs())) - noise, x1 - hypot(rho, inner) + noise)
    }

    fn slopes(&self, from: f64, to: f64) -> (f64, f64) {
        let (y0, y1) = Arc::ends(&self.arc.y, from, to);
        let ratio = self.view.level / self.view.dy;
        let (a, b) = (self.along(y0), self.along(y1));
        // Where the line meets the axis itself, the lean jumps.
        let leans = if self.view.nearest == 0.0 && (a > 0.0) != (b > 0.0) {
            (-1.0, 1.0)
        } else {
            (self.lean(a).min(self.lean(b)), self.lean(a).max(self.lean(b)))
        };
        let rise = product(product(leans, (ratio, ratio)), quadratic_range(&self.arc.dy, from, to));
        let (low, high) = quadratic_range(&self.arc.dx, from, to);
        (low - rise.1, high - rise.0)
    }

    fn noise(&self) -> f64 {
        self.view.noise
    }
}

/// y − y₀ ∓ m √(x² − ρ₀²), m the rise of the line.
struct Level<'a> {
    arc: &'a Arc,
    view: &'a View,
    sign: f64,
}

impl Level<'_> {
    /// √(x² − ρ₀²), 0 below.
    fn chord(&self, x: f64) -> f64 {
        let rho = self.view.nearest;
        ((x - rho).max(0.0) * (x + rho)).sqrt()
    }

    fn half_chord(&self, x: f64) -> f64 {
        self.chord(bernstein(&self.arc.x, x))
    }

    fn rise(&self) -> f64 {
        self.sign * self.view.dy / self.view.level
    }
}

impl Bounded for Level<'_> {
    fn value(&self, x: f64) -> f64 {
        (bernstein(&self.arc.y, x) - self.view.base_height) - self.rise() * self.half_chord(x)
    }

    fn slope(&self, x: f64) -> f64 {
        let at = bernstein(&self.arc.x, x);
        let chord = self.chord(at);
        let steep = if chord > 0.0 { at / chord } else { f64::INFINITY };
        slope(&self.arc.dy, x) - self.rise() * slope(&self.arc.dx, x) * steep
    }

    fn range(&self, from: f64, to: f64) -> (f64, f64) {
        let (x0, x1) = Arc::ends(&self.arc.x, from, to);
        let (y0, y1) = Arc::ends(&self.arc.y, from, to);
        let rise = self.rise();
        let (low, high) = product((rise, rise), (self.chord(x0), self.chord(x1)));
        let (y, noise) = (self.view.base_height, self.view.noise);
        (y0 - y - high - noise, y1 - y - low + noise)
    }

    fn slopes(&self, from: f64, to: f64) -> (f64, f64) {
        let (x0, x1) = Arc::ends(&self.arc.x, from, to);
        let own = quadratic_range(&self.arc.dy, from, to);
        let sideways = product((self.rise(), self.rise()), quadratic_range(&self.arc.dx, from, to));
        // x/√(x² − ρ₀²) falls from ∞ as x grows.
        let (near, far) = (self.chord(x0), self.chord(x1));
        let (steepest, least) = (
            if near > 0.0 { x0 / near } else { f64::INFINITY },
            if far > 0.0 { x1 / far } else { f64::INFINITY },
        );
        let scaled = |v: f64, up: bool| match (v > 0.0) == up {
            _ if v == 0.0 => 0.0,
            true => v * steepest,
            false => v * least,
        };
        let (low, high) = (scaled(sideways.0, false), scaled(sideways.1, true));
        (own.0 - high, own.1 - low)
    }

    fn noise(&self) -> f64 {
        self.view.noise
    }
}
