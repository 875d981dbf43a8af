//! What a linear form knows of the zeros of a function along a ray in a cell: where they may be, and whether there is one at most.

use crate::math::field::Linear;
use glam::DVec3;

/// A linear function of the point, and how far f and its derivatives are from it in a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// At the origin.
    constant: f64,
    slope: DVec3,
    rest: f64,
    bend: DVec3,
}

/// f along a piece of a ray: constant + slope · t ± rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Along {
    pub constant: f64,
    pub slope: f64,
    pub rest: f64,
    /// How far the derivative may be from the slope.
    pub bend: f64,
}

/// Where zeros may be on a piece.
#[derive(Clone, Copy, Debug)]
pub(super) enum Zeros {
    /// Nowhere; whether f is negative all along.
    None(bool),
    /// In this part.
    Within(Part),
}

/// A part of a piece, and what is known of f there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub from: f64,
    pub to: f64,
    /// Whether f is negative at either end, where that is certain.
    pub before: Option<bool>,
    pub after: Option<bool>,
}

/// Roundings of a place along a ray and of a plane's value there: four in the place, eight in the value, and as many for the sizes.
const ROUNDINGS: f64 = 16.0 * f64::EPSILON;

impl Plane {
    /// Of a form over a cell with these half sides, for rays from places no farther out than `reach` on each axis.
    pub fn new(form: &Linear<3>, middle: DVec3, half: DVec3, reach: DVec3) -> Option<Plane> {
        let slope = DVec3::from_array(form.slope) / half;
        let constant = form.middle - slope.dot(middle);
        let size = form.middle.abs() + slope.abs().dot(middle.abs() + 3.0 * reach);
        let rest = form.rest + size * ROUNDINGS;
        let bend = DVec3::from_array(form.bend) / half * (1.0 + ROUNDINGS) + slope.abs() * ROUNDINGS;
        (slope.is_finite() && bend.is_finite() && (constant.abs() + rest).is_finite()).then_some(Plane {
            constant,
            slope,
            rest,
            bend,
        })
    }

    /// Along a ray.
    #[inline]
    pub fn along(&self, origin: DVec3, direction: DVec3) -> Along {
        Along {
            constant: self.constant + self.slope.dot(origin),
            slope: self.slope.dot(direction),
            rest: self.rest,
            bend: self.bend.dot(direction.abs()),
        }
    }

    /// Whether f is so nearly linear in the cell that a smaller one would tell little more of it.
    pub fn is_flat(form: &Linear<3>) -> bool {
        let steepness: f64 = form.slope.iter().map(|g| g.abs()).sum();
        let bend: f64 = form.bend.iter().sum();
        form.rest <= steepness * FLAT_REST && bend <= steepness * FLAT_BEND
    }
}

/// The share of the slope that may be uncertain in a cell that is not halved further.
const FLAT_REST: f64 = 1.0 / 16.0;
const FLAT_BEND: f64 = 1.0 / 4.0;

impl Along {
    /// Whether f only rises or only falls.
    #[inline]
    pub fn is_steady(&self) -> bool {
        self.slope.abs() > self.bend
    }

    /// The place where the linear function is 0.
    #[inline]
    pub fn zero(&self) -> f64 {
        -self.constant / self.slope
    }

    /// Whether f is negative at a distance, where that is certain.
    #[inline]
    pub fn sign(&self, t: f64) -> Option<bool> {
        let value = self.constant + self.slope * t;
        (value.abs() > self.rest).then_some(value < 0.0)
    }

    /// Where zeros may be between two distances.
    #[inline]
    pub fn zeros(&self, from: f64, to: f64) -> Zeros {
        let (before, after) = (self.sign(from), self.sign(to));
        if let (Some(start), true) = (before, before == after) {
            return Zeros::None(start);
        }
        let mut part = Part { from, to, before, after };
        // Moved outward by the roundings of a quotient, so that the sign is certain there as well.
        let place = |negative: bool, toward: f64| {
            let edge = if negative { -self.rest } else { self.rest };
            let t = (edge - self.constant) / self.slope;
            t + toward * t.abs() * ROUNDINGS
        };
        if let Some(negative) = before {
            part.from = place(negative, -1.0).clamp(from, to);
        }
        if let Some(negative) = after {
            part.to = place(negative, 1.0).clamp(part.from, to);
        }
        Zeros::Within(part)
    }
}
