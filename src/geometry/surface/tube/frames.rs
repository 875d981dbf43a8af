//! Frames along a tube's arcs, for its coordinates: carried by double reflection. Wang, Jüttler, Zheng & Liu, *Computation of rotation
//! minimizing frames* (2008). Within an arc the step is the same that leads to the next, so that u has no seams.

use super::arc::Arc;
use crate::geometry::curve::{across, any_across};
use crate::math::elementary::{atan2, sin_cos};
use glam::DVec3;

/// Sets each arc's frame and share of the length; gives the angle by which a closed curve's frame comes back turned.
pub(super) fn carry(arcs: &mut [Arc], closed: bool) -> f64 {
    let total: f64 = arcs.iter().map(|arc| arc.length(1.0)).sum();
    let start = arcs[0].direction(0.0);
    // At the start up is nearest to y, as of a curve's own frame.
    let first = across(DVec3::Y, start).try_normalize().unwrap_or_else(|| any_across(start));
    let (mut up, mut length) = (first, 0.0);
    for arc in arcs.iter_mut() {
        arc.up = onto(up, arc.direction(0.0));
        let from = share_of(length, total);
        length += arc.length(1.0);
        arc.shares = (from, share_of(length, total));
        up = arc.up_at(1.0);
    }
    if !closed {
        return 0.0;
    }
    let back = onto(up, start);
    atan2(first.cross(back).dot(start), first.dot(back))
}

fn share_of(length: f64, total: f64) -> f64 {
    if total > 0.0 { length / total } else { 0.0 }
}

/// The unit vector across a tangent that is nearest to `up`.
fn onto(up: DVec3, tangent: DVec3) -> DVec3 {
    across(up, tangent).try_normalize().unwrap_or_else(|| any_across(tangent))
}

impl Arc {
    /// The carried vector at x, at right angles to the tangent there.
    fn up_at(&self, x: f64) -> DVec3 {
        let (from, to) = (self.points[0], self.at(x).0);
        let (tangent, next) = (self.direction(0.0), self.direction(x));
        let step = to - from;
        let squared = step.length_squared();
        if squared == 0.0 {
            return onto(self.up, next);
        }
        let reflect = |v: DVec3| v - step * (2.0 / squared * step.dot(v));
        let (up, tangent) = (reflect(self.up), reflect(tangent));
        let second = next - tangent;
        let squared = second.length_squared();
        let turned = if squared == 0.0 { up } else { up - second * (2.0 / squared * second.dot(up)) };
        onto(turned, next)
    }

    /// Side, up and tangent at x: unit vectors. `twist` is spread over the length of a closed tube.
    pub fn frame(&self, x: f64, twist: f64) -> (DVec3, DVec3, DVec3) {
        let (up, tangent) = (self.up_at(x), self.direction(x));
        let side = up.cross(tangent);
        let (s, c) = sin_cos(-twist * self.share(x));
        (side * c + up * s, up * c - side * s, tangent)
    }
}
