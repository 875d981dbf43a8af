//! What a quadratic form knows of the zeros of a function along a ray in a cell.

use super::plane::{Along, Part};
use crate::math::field::Quadratic;
use glam::{DMat3, DVec3};

/// A quadratic function of the point, and how far f and its derivatives are from it in a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bowl {
    middle: DVec3,
    constant: f64,
    slope: DVec3,
    curve: DMat3,
    rest: f64,
    bend: DVec3,
}

/// Roundings of a place along a ray and of the bowl's value there, of the sizes they are made of.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// What is known of a cell beyond its plane.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// One function near f.
    Bowl(Bowl),
    /// Two of which f is the greater, or else the lesser.
    Fold(Box<[Bowl; 2]>, bool),
}

impl Shape {
    /// What is known of a part of a ray.
    pub fn zeros(&self, origin: DVec3, direction: DVec3, part: &Part) -> Said {
        match self {
            Shape::Bowl(bowl) => bowl.zeros(origin, direction, part),
            Shape::Fold(sides, greater) => {
                // The side that is certainly below 0 is never the greater where that is 0; one above 0 decides.
                match sides[0].zeros(origin, direction, part) {
                    Said::Nowhere(negative) if negative != *greater => Said::Nowhere(negative),
                    Said::Nowhere(_) => sides[1].zeros(origin, direction, part),
                    first => match sides[1].zeros(origin, direction, part) {
                        Said::Nowhere(negative) if negative != *greater => Said::Nowhere(negative),
                        Said::Nowhere(_) => first,
                        Said::Steady(..) | Said::Unclear => Said::Unclear,
                    },
                }
            }
        }
    }
}

/// What it says of a part of a ray.
pub(super) enum Said {
    /// No zero; whether f is negative.
    Nowhere(bool),
    /// One zero at most, in this part, near such a line.
    Steady(Part, Along),
    /// Not enough.
    Unclear,
}

impl Bowl {
    /// Of a form over a cell with these half sides, for rays from places no farther out than `reach` on each axis.
    pub fn new(form: &Quadratic, middle: DVec3, half: DVec3, reach: DVec3) -> Option<Bowl> {
        let [xx, yy, zz, xy, xz, yz] = form.curve;
        let rows = [DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz)];
        let curve =
            DMat3::from_cols(rows[0] / half / half.x, rows[1] / half / half.y, rows[2] / half / half.z);
        let slope = DVec3::from_array(form.slope) / half;
        let turn = DVec3::from_array(rows.map(|row| row.abs().element_sum())) / half;
        let size = form.middle.abs() + (slope.abs() + turn).dot(middle.abs() + 3.0 * reach) + turn.dot(half);
        let rest = form.rest + size * ROUNDINGS;
        // The derivative is that of a place which is off by as much.
        let off = (middle.abs() + 3.0 * reach).max_element() / half.min_element();
        let bend = DVec3::from_array(form.bend) / half * (1.0 + ROUNDINGS)
            + (slope.abs() + turn * (1.0 + off)) * ROUNDINGS;
        let bowl = Bowl { middle, constant: form.middle, slope, curve, rest, bend };
        (slope.is_finite() && curve.is_finite() && bend.is_finite() && (form.middle + rest).is_finite())
            .then_some(bowl)
    }

    /// How far f may be from it.
    pub fn rest(&self) -> f64 {
        self.rest
    }

    /// What is known of a part of a ray.
    pub fn zeros(&self, origin: DVec3, direction: DVec3, part: &Part) -> Said {
        let at = part.from / 2.0 + part.to / 2.0;
        let half = (part.to / 2.0 - part.from / 2.0) * (1.0 + ROUNDINGS);
        let place = origin + direction * at - self.middle;
        let (turned, turning) = (self.curve * place, self.curve * direction);
        // f(at + s) = constant + slope s + curve s² ± rest.
        let constant = self.constant + (self.slope + 0.5 * turned).dot(place);
        let slope = (self.slope + turned).dot(direction);
        let curve = 0.5 * turning.dot(direction);
        let value = |s: f64| constant + (slope + curve * s) * s;
        let (start, end) = (value(-half), value(half));
        let (mut low, mut high) = if start < end { (start, end) } else { (end, start) };
        let steepest = (slope.abs() - 2.0 * curve.abs() * half).abs();
        let is_steady = slope.abs() > 2.0 * curve.abs() * half;
        if !is_steady && curve != 0.0 {
            let top = value((-0.5 * slope / curve).clamp(-half, half));
            (low, high) = (low.min(top), high.max(top));
        }
        if low > self.rest || high < -self.rest {
            return Said::Nowhere(high < 0.0);
        }
        let least = steepest - self.bend.dot(direction.abs());
        if !is_steady || !(least > 0.0) {
            return Said::Unclear;
        }
        let inner = (slope * slope - 4.0 * constant * curve).max(0.0).sqrt();
        let zero = (-2.0 * constant / (slope + inner.copysign(slope))).clamp(-half, half);
        let steepness = slope + 2.0 * curve * zero;
        // Farther from the zero of the form than this f has the sign of the form.
        let reach = (self.rest + value(zero).abs()) / least * (1.0 + ROUNDINGS) + at.abs() * ROUNDINGS;
        let rises = slope > 0.0;
        let mut part = *part;
        if value(zero).abs() <= self.rest {
            if at + (zero - reach) > part.from {
                (part.from, part.before) = (at + (zero - reach), Some(rises));
            }
            if at + (zero + reach) < part.to {
                (part.to, part.after) = (at + (zero + reach), Some(!rises));
            }
        }
        let bend = self.bend.dot(direction.abs()) + curve.abs() * (part.to - part.from);
        let along = Along { constant: -steepness * (at + zero), slope: steepness, rest: self.rest, bend };
        Said::Steady(part, along)
    }
}
