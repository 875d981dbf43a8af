//! Deciding about pieces of a ray of which the cell does not know enough: by linear forms along the ray while they are wide, by intervals
//! down to where rounding hides everything. What is not decided is halved.

use super::super::plane::{Along, Part, Zeros};
use super::super::{UNDEFINED, UNRESOLVED, directions};
use super::{Found, MOST_EVALUATIONS, Search};
use crate::math::field::{Enclosed, Encloser, Linear, Linearizer};
use crate::math::interval::{Gaps, Interval};

/// Pieces are not split below this many steps of the floating-point grid.
const LEAST_STEPS: f64 = 4.0;

/// What the rounding of a place on the ray may be, as a share of what it is added up from.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Below this share of the coordinates rounding is asked whether splitting still tells anything.
const SMALL: f64 = 1.0 / (1 << 20) as f64;

impl<'s> Search<'s> {
    /// Searches a piece by halving.
    pub(super) fn piece(&mut self, a: f64, b: f64, found: Found<'_>) {
        let mut lines = Linearizer::reuse(self.field, std::mem::take(&mut self.spare.forms));
        let mut intervals = None;
        let mut pieces = std::mem::take(&mut self.spare.pieces);
        pieces.clear();
        pieces.push((a, b));
        while let Some((a, b)) = pieces.pop() {
            if self.evaluations > MOST_EVALUATIONS {
                self.give_up(a, UNRESOLVED, found);
            }
            if self.stopped {
                break;
            }
            if !self.glance(a, b, &mut lines, &mut pieces, found) {
                let (along, at) = intervals.get_or_insert_with(|| self.enclosers());
                self.look(a, b, along, at, &mut pieces, found);
            }
        }
        if let Some((along, at)) = intervals {
            (self.spare.along, self.spare.at) = (along.into_memory(), at.into_memory());
        }
        (self.spare.forms, self.spare.pieces) = (lines.into_memory(), pieces);
    }

    fn enclosers(&mut self) -> (Encloser<'s, 1>, Encloser<'s, 0>) {
        let along = Encloser::reuse(self.field, std::mem::take(&mut self.spare.along));
        (along, Encloser::reuse(self.field, std::mem::take(&mut self.spare.at)))
    }

    /// Decides about a piece by a linear form, or splits it; false where that says nothing.
    fn glance(
        &mut self,
        a: f64,
        b: f64,
        lines: &mut Linearizer<'_, 1>,
        pieces: &mut Vec<(f64, f64)>,
        found: Found<'_>,
    ) -> bool {
        let scale = self.scale(a).max(self.scale(b));
        let (middle, half) = (a / 2.0 + b / 2.0, (b / 2.0 - a / 2.0).next_up());
        if b - a <= SMALL * scale {
            return false;
        }
        self.evaluations += 1;
        let inputs: [Linear<1>; 3] = std::array::from_fn(|axis| {
            let (o, d) = (self.near.origin[axis], self.near.direction[axis]);
            let rest = ROUNDINGS * (o.abs() + (d * middle).abs() + (d * half).abs());
            Linear::new(o + d * middle, [d * half], rest)
        });
        let Some(form) = lines.run(&inputs) else { return false };
        let along =
            Along { constant: form.middle, slope: form.slope[0], rest: form.rest, bend: form.bend[0] };
        // The middle of the form is that of the piece up to rounding, which the rest holds already.
        match along.zeros(-1.0, 1.0) {
            Zeros::None(negative) => self.arrive(a, negative, found),
            Zeros::Within(part) => {
                let place =
                    |e: f64, end: f64| if e.abs() == 1.0 { end } else { (middle + half * e).clamp(a, b) };
                let part = Part { from: place(part.from, a), to: place(part.to, b), ..part };
                if along.is_steady() {
                    let slope = along.slope / half;
                    let along = Along {
                        constant: along.constant - slope * middle,
                        slope,
                        bend: along.bend / half,
                        ..along
                    };
                    self.monotone(&part, &along, found);
                } else {
                    if let Some(negative) = part.before {
                        self.arrive(a, negative, found);
                    }
                    if part.to - part.from <= 0.5 * (b - a) {
                        pieces.push((part.from, part.to));
                    } else {
                        let cut = part.from / 2.0 + part.to / 2.0;
                        pieces.extend([(cut, part.to), (part.from, cut)]);
                    }
                }
            }
        }
        true
    }

    /// Decides about a piece, or splits it.
    fn look(
        &mut self,
        a: f64,
        b: f64,
        along: &mut Encloser<'_, 1>,
        at: &mut Encloser<'_, 0>,
        pieces: &mut Vec<(f64, f64)>,
        found: Found<'_>,
    ) {
        let all = self.bounds(a, b, along);
        let (value, slope) = (all.value, all.slope[0]);
        if value.is_empty() {
            self.settle(found);
            if !self.stopped {
                self.give_up(a, UNDEFINED, found);
            }
            return;
        }
        // Where it jumps, it does so on one side of 0.
        if !value.gaps.are_undefined() && !value.contains(0.0) {
            return self.arrive(a, value.hi < 0.0, found);
        }
        let is_steady = !value.gaps.are_there() && !slope.gaps.are_there() && !slope.contains(0.0);
        if is_steady {
            let part = Part { from: a, to: b, before: None, after: None };
            return self.monotone_between(&part, found);
        }
        let middle = a / 2.0 + b / 2.0;
        let scale = self.scale(a).max(self.scale(b));
        let is_least = b - a <= LEAST_STEPS * f64::EPSILON * scale || !(a < middle && middle < b);
        if is_least {
            return self.hide(a, b, value.gaps.are_there(), found);
        }
        let here = self.bounds_at(middle, at);
        if !value.gaps.are_there() && b - a <= SMALL * scale && value.width() <= 4.0 * here.width() {
            return self.hide(a, b, false, found);
        }
        let (left, right) =
            if value.gaps.are_there() { (middle, middle) } else { gap(a, b, middle, here, slope) };
        if right < b {
            pieces.push((right, b));
        }
        if left > a {
            pieces.push((a, left));
        } else if right > middle || left < middle {
            // Nothing up to here; what comes after starts with a known sign.
            self.arrive(a, here.hi < 0.0, found);
        }
    }

    fn bounds(&mut self, a: f64, b: f64, along: &mut Encloser<'_, 1>) -> Enclosed<1> {
        self.evaluations += 1;
        let s = Interval::new(a, b);
        let (o, d) = (self.near.origin, self.near.direction);
        let within = &self.shape.within;
        let coordinate = |axis: usize| {
            let along = Interval::point(o[axis]) + Interval::point(d[axis]) * s;
            Interval {
                lo: along.lo.max(within.min[axis]),
                hi: along.hi.min(within.max[axis]),
                gaps: Gaps::NONE,
            }
        };
        let at = [0, 1, 2].map(|axis| {
            let inside = coordinate(axis);
            let clamped = |x: f64| x.clamp(within.min[axis], within.max[axis]);
            if inside.is_empty() { Interval::new(clamped(inside.hi), clamped(inside.lo)) } else { inside }
        });
        along.run(&directions(at, [d]))
    }

    /// All that f can be at a place, rounding included.
    fn bounds_at(&mut self, s: f64, at: &mut Encloser<'_, 0>) -> Interval {
        self.evaluations += 1;
        at.run(&self.point(s).to_array().map(Enclosed::constant)).value
    }
}

/// Around the middle f stays on one side of 0: where that ends on either hand, by the extreme slopes. Both are the middle where nothing is
/// known.
fn gap(a: f64, b: f64, middle: f64, here: Interval, slope: Interval) -> (f64, f64) {
    let size = if here.lo > 0.0 {
        here.lo
    } else if here.hi < 0.0 {
        -here.hi
    } else {
        return (middle, middle);
    };
    let (toward_left, toward_right) =
        if here.lo > 0.0 { (slope.hi, -slope.lo) } else { (-slope.lo, slope.hi) };
    // Rounded so that the gap is never too wide.
    let reach = |steepness: f64| {
        if steepness > 0.0 { size / steepness * (1.0 - 8.0 * f64::EPSILON) } else { f64::INFINITY }
    };
    ((middle - reach(toward_left)).max(a).min(middle), (middle + reach(toward_right)).min(b).max(middle))
}
