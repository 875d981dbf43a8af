//! Tubes: the solid that a ball fills as it rolls along a curve while its radius changes. Knows nothing of scenes.
//!
//! This is a union of balls and stays one at bends however tight, at cusps and where the curve meets itself. Caps are the first and last ball
//! (round), or the planes through the ends of the curve cut them off (flat), or what those cut is left open.

mod arc;
mod cell;
mod frames;
mod mesh;
#[cfg(test)]
mod tests;

use super::cubic::{Cubic, least, together};
use super::{SurfacePoint, Touch};
use crate::geometry::balls::{Ball, BallTree};
use crate::geometry::boxes::Line;
use crate::math::Aabb;
use arc::Arc;
use cell::{Edge, Span};
use glam::{DVec2, DVec3};

/// How a tube ends where its curve is not closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caps {
    /// By half of the last ball.
    Round,
    /// By the plane across the end of the curve.
    Flat,
    /// Not at all: a wall without thickness, no solid.
    Open,
}

/// Why a tube could not be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TubeError {
    /// A radius below 0.
    #[error("its radius is {radius} where t = {at}")]
    Negative {
        /// The least radius.
        radius: f64,
        /// Where, in the curve's parameter.
        at: f64,
    },
    /// Nothing to see.
    #[error("its radius is 0 all along")]
    Thin,
    /// A coordinate or radius that is NaN, infinite, or too large to be squared.
    #[error("its curve or radius is not finite, or beyond 1e150")]
    NotFinite,
}

/// A tube, ready for rays.
#[derive(Clone, Debug)]
pub struct Tube {
    /// In the order of the curve.
    arcs: Vec<Arc>,
    tree: BallTree,
    bounds: Aabb,
    caps: Caps,
    /// The planes across the ends: a point and the direction out. None of a closed curve.
    ends: Option<[(DVec3, DVec3); 2]>,
    /// What the frame has turned by after one round of a closed curve, radians.
    twist: f64,
    /// Largest coordinate.
    size: f64,
}

/// Coordinates beyond this could not be squared.
const LARGEST: f64 = 1e150;

impl Tube {
    /// What keeps a curve and a radius from making a tube: cheap.
    pub fn check(path: &[Cubic<DVec3>], radius: &[Cubic<f64>]) -> Result<(), TubeError> {
        if !size_of(path, radius).le(&LARGEST) {
            return Err(TubeError::NotFinite);
        }
        let (smallest, at) = least(radius);
        if smallest < 0.0 {
            return Err(TubeError::Negative { radius: smallest, at });
        }
        if radius.iter().all(|c| c.points == [0.0; 4]) { Err(TubeError::Thin) } else { Ok(()) }
    }

    /// Along a chain of cubics, with a radius that goes along; its interval is stretched over the curve's. Neither may be empty. Errors: those
    /// of [`Tube::check`].
    pub fn new(
        path: &[Cubic<DVec3>],
        radius: &[Cubic<f64>],
        closed: bool,
        caps: Caps,
    ) -> Result<Tube, TubeError> {
        Tube::check(path, radius)?;
        let mut arcs = Vec::new();
        for (curve, radius) in together(path, radius) {
            arc::cut(&curve, &radius, &mut arcs);
        }
        let twist = frames::carry(&mut arcs, closed);
        let ends = (!closed).then(|| arc::ends(&arcs));
        if let (Some(ends), false) = (&ends, caps == Caps::Round) {
            arc::mark_clipped(&mut arcs, ends);
        }
        let tree = BallTree::build(arcs.len(), |range| Ball::around(arcs[range].iter().flat_map(Arc::balls)));
        let bounds = arcs.iter().fold(Aabb::EMPTY, |sum, arc| sum.union(arc.bounds()));
        Ok(Tube { arcs, tree, bounds, caps, ends, twist, size: size_of(path, radius) })
    }

    /// The box around it.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Largest coordinate of its curve and radius.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// True where rays tell an inside: not where its ends are open.
    pub fn is_solid(&self) -> bool {
        self.caps != Caps::Open || self.ends.is_none()
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.arcs.as_slice()) + self.tree.bytes()
    }

    /// The first meeting with `near` < t ≤ `far`.
    pub fn first(&self, line: &Line, near: f64, far: f64) -> Option<Touch> {
        let (near, far) = (near * line.length, far * line.length);
        if !self.is_solid() {
            return self.all(line).into_iter().find(|h| h.t * line.length > near && h.t * line.length <= far);
        }
        let planes = line.across();
        let mut best: Option<Span> = None;
        let mut is_inside = false;
        self.tree.walk(line, near, far, |index, mut far| {
            self.spans(line, &planes, index, (near, far), |span| {
                if span.low.s > near {
                    if span.low.s <= far {
                        far = span.low.s;
                        best = Some(span);
                    }
                } else if span.high.s > near {
                    is_inside = true;
                }
            });
            if is_inside { f64::NEG_INFINITY } else { far }
        });
        if is_inside {
            return self.all(line).into_iter().find(|h| h.t * line.length > near && h.t * line.length <= far);
        }
        best.map(|span| touch(&span.low, line))
    }

    /// Every meeting along the whole line, both ways, ascending: in and out in turn where it is solid. A tangent is in and out at once.
    pub fn all(&self, line: &Line) -> Vec<Touch> {
        let planes = line.across();
        let mut spans = Vec::new();
        let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
        self.tree.walk(line, everywhere.0, everywhere.1, |index, far| {
            self.spans(line, &planes, index, everywhere, |span| spans.push(span));
            far
        });
        spans.sort_by(|a: &Span, b: &Span| a.low.s.total_cmp(&b.low.s));
        let mut joined: Vec<Span> = Vec::with_capacity(spans.len());
        for span in spans {
            match joined.last_mut() {
                Some(last) if span.low.s <= last.high.s => {
                    if span.high.s > last.high.s {
                        last.high = span.high;
                    }
                }
                _ => joined.push(span),
            }
        }
        let is_wall = |edge: &Edge| self.is_solid() || edge.cap.is_none();
        joined.iter().flat_map(|s| [s.low, s.high]).filter(is_wall).map(|edge| touch(&edge, line)).collect()
    }

    /// The stretches of the line inside the balls of an arc.
    fn spans(
        &self,
        line: &Line,
        planes: &[DVec3; 2],
        index: usize,
        window: (f64, f64),
        mut found: impl FnMut(Span),
    ) {
        let arc = &self.arcs[index];
        cell::spans(arc, index as u32, line, planes, window, |mut span| {
            for (end, is_clipped) in arc.clipped.into_iter().enumerate() {
                if let (true, Some(ends)) = (is_clipped, &self.ends) {
                    span.clip(line, ends[end], end as u8);
                }
            }
            if span.low.s <= span.high.s {
                found(span);
            }
        });
    }

    /// The surface where a line touched it.
    pub fn surface(&self, line: &Line, touch: &Touch) -> SurfacePoint {
        let arc = &self.arcs[(touch.part / PLACES) as usize];
        let seen = line.at(touch.t * line.length);
        let (center, radius) = arc.at(touch.x);
        let (side, up, along) = arc.frame(touch.x, self.twist);
        let cap = (touch.part % PLACES).checked_sub(1).zip(self.ends.as_ref());
        let (point, normal) = match cap {
            Some((end, ends)) => {
                let (origin, out) = ends[end as usize];
                (seen - out * out.dot(seen - origin), out)
            }
            None => {
                let normal = (seen - center).try_normalize().unwrap_or(-line.direction);
                (center + normal * radius, normal)
            }
        };
        let out = point - center;
        let angle = crate::math::elementary::atan2(out.dot(up), out.dot(side)) / std::f64::consts::TAU;
        let u = if angle < 0.0 { angle + 1.0 } else { angle };
        let v = match cap {
            Some((end, _)) => f64::from(end),
            None => arc.share(touch.x),
        };
        SurfacePoint { point, normal, tangent: along.cross(out), uv: DVec2::new(u, v) }
    }
}

/// Largest coordinate or radius; NaN where one is.
fn size_of(path: &[Cubic<DVec3>], radius: &[Cubic<f64>]) -> f64 {
    let numbers = path.iter().flat_map(|c| c.points).flat_map(|p| p.to_array());
    let numbers = numbers.chain(radius.iter().flat_map(|c| c.points));
    numbers.fold(0.0, |m: f64, x| if x.abs() <= m { m } else { x.abs() })
}

/// Places of an arc that a touch may be at: its side, and the planes of both ends.
const PLACES: u32 = 3;

fn touch(edge: &Edge, line: &Line) -> Touch {
    let place = edge.cap.map_or(0, |end| u32::from(end) + 1);
    Touch::new(edge.s / line.length, edge.arc * PLACES + place, edge.x)
}
