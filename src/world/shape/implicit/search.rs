//! The search for zeros along a ray, nearest first.
//!
//! The sign of f at the ends of pieces, in plain arithmetic, decides how many zeros there are; the same place always has the
//! same sign, so that inside and outside never disagree. Intervals decide which pieces need no look, and which hold one zero.

use super::{FIRST_CUT, Implicit, ON_SURFACE, UNDEFINED, UNRESOLVED, directions};
use crate::math::bracket;
use crate::math::field::{Enclosed, Encloser};
use crate::math::interval::Interval;
use crate::world::shape::{LocalRay, Meet, ahead};
use glam::DVec3;
use std::cell::Cell;

/// A ray that starts farther from the middle than this many sizes of the box is first moved near it.
const FAR: f64 = 4.0;

/// Pieces are not split below this many steps of the floating-point grid.
const LEAST_STEPS: f64 = 4.0;

/// Below this share of the coordinates rounding is asked whether splitting still tells anything.
const SMALL: f64 = 1.0 / (1 << 20) as f64;

/// How often f may be bounded along one ray before the search gives up: fifty times what the hardest double zeros of the tests take.
const MOST_EVALUATIONS: u32 = 20_000;

thread_local! {
    /// Kept between rays so that a search does not allocate.
    static SPARE: Cell<Spare> = const { Cell::new(Spare { along: Vec::new(), at: Vec::new(), pieces: Vec::new() }) };
    /// How often functions were bounded or evaluated by this thread, for tests and figures.
    #[cfg(test)]
    pub(super) static EVALUATIONS: Cell<u64> = const { Cell::new(0) };
}

#[derive(Default)]
struct Spare {
    along: Vec<Enclosed<1>>,
    at: Vec<Enclosed<0>>,
    pieces: Vec<(f64, f64)>,
}

/// A ray near the box.
struct Near {
    origin: DVec3,
    direction: DVec3,
    /// The distance of `origin` along the ray.
    start: f64,
    /// Where it enters and leaves the box, from `origin`.
    enter: Meet,
    leave: Meet,
}

impl Near {
    fn new(shape: &Implicit, ray: &LocalRay) -> Option<Near> {
        let bounds = shape.bounds();
        let to_middle = bounds.center() - ray.origin;
        let is_far = to_middle.abs().max_element() > FAR * bounds.size().max_element();
        let start = if is_far { to_middle.dot(ray.direction) / ray.direction.length_squared() } else { 0.0 };
        let origin = ray.at(start);
        let (enter, leave) = shape.within.ends(&LocalRay { origin, direction: ray.direction })?;
        let ahead = leave.t > -start && enter.t < leave.t && leave.t.is_finite();
        ahead.then_some(Near { origin, direction: ray.direction, start, enter, leave })
    }

    /// Where the search begins.
    fn from(&self) -> f64 {
        self.enter.t.max(-self.start)
    }

    fn starts_within(&self) -> bool {
        self.enter.t <= -self.start
    }
}

/// Whether the ray's origin is in the solid, as the search sees it.
pub(super) fn starts_inside(shape: &Implicit, ray: &LocalRay) -> bool {
    Near::new(shape, ray).is_some_and(|near| {
        let p = near.origin + near.direction * near.from();
        near.starts_within() && shape.value(p.clamp(shape.within.min, shape.within.max)) < 0.0
    })
}

/// Calls `found` with each meeting in order, until it says false. Those beyond the limit may be left out.
pub(super) fn each_meeting(
    shape: &Implicit,
    ray: &LocalRay,
    limit: f64,
    mut found: impl FnMut(Meet) -> bool,
) {
    let Some(near) = Near::new(shape, ray) else { return };
    if near.from() + near.start > limit {
        return;
    }
    let mut search = Search::new(shape, &near, SPARE.take());
    search.run(limit, &mut |meet| !ahead(meet.t) || found(meet));
    #[cfg(test)]
    EVALUATIONS.set(EVALUATIONS.get() + u64::from(search.evaluations));
    SPARE.set(search.spare);
}

/// A run of pieces in which rounding hides what f does.
#[derive(Clone, Copy)]
struct Hidden {
    from: f64,
    to: f64,
    /// True where f may jump or be undefined.
    partial: bool,
}

struct Search<'s> {
    shape: &'s Implicit,
    near: &'s Near,
    spare: Spare,
    evaluations: u32,
    /// Whether f is negative where the search has come to.
    inside: bool,
    hidden: Option<Hidden>,
    /// A place and f there, which the next piece often begins at.
    last: (f64, f64),
    stopped: bool,
}

type Found<'f> = &'f mut dyn FnMut(Meet) -> bool;

impl<'s> Search<'s> {
    fn new(shape: &'s Implicit, near: &'s Near, spare: Spare) -> Self {
        let last = (f64::NAN, f64::NAN);
        Search { shape, near, spare, evaluations: 0, inside: false, hidden: None, last, stopped: false }
    }

    fn point(&self, s: f64) -> DVec3 {
        let Implicit { within, .. } = self.shape;
        (self.near.origin + self.near.direction * s).clamp(within.min, within.max)
    }

    /// f in plain arithmetic.
    fn value(&mut self, s: f64) -> f64 {
        if self.last.0 != s {
            self.evaluations += 1;
            self.last = (s, self.shape.value(self.point(s)));
        }
        self.last.1
    }

    /// The size of the coordinates that a place is computed from.
    fn scale(&self, s: f64) -> f64 {
        self.near.origin.abs().max_element() + s.abs()
    }

    fn tell(&mut self, s: f64, face: u32, found: Found<'_>) {
        let meet = Meet { t: self.near.start + s, face, ..Meet::default() };
        self.stopped |= !found(meet);
    }

    /// That f is undefined, or cannot be followed, from here on.
    fn give_up(&mut self, s: f64, face: u32, found: Found<'_>) {
        // Never at the very start, where no meeting counts.
        let least = -self.near.start + self.scale(s) * f64::EPSILON;
        self.tell(s.max(least), face, found);
        self.stopped = true;
    }

    fn run(&mut self, limit: f64, found: Found<'_>) {
        let (from, to) = (self.near.from(), self.near.leave.t);
        let first = self.value(from);
        if first.is_nan() {
            return self.give_up(from, UNDEFINED, found);
        }
        self.inside = first < 0.0;
        if self.inside && !self.near.starts_within() {
            self.tell(from, FIRST_CUT + self.near.enter.face, found);
        }
        let cells = &self.shape.cells;
        let bounds = self.shape.bounds();
        let mut tape = u32::MAX;
        if !self.stopped {
            let (origin, direction) = (self.near.origin, self.near.direction);
            cells.along(bounds, origin, direction, (from, to), &mut |a, b, of| {
                if a + self.near.start > limit {
                    self.stopped = true;
                    return false;
                }
                self.piece(a, b, of, of == tape, found);
                tape = of;
                !self.stopped
            });
        }
        if !self.stopped {
            self.settle(found);
        }
        if !self.stopped && self.inside {
            self.tell(to, FIRST_CUT + self.near.leave.face, found);
        }
    }

    /// Searches a piece of the ray in one cell.
    fn piece(&mut self, a: f64, b: f64, tape: u32, _same: bool, found: Found<'_>) {
        if self.certainly_away(a, b) {
            return;
        }
        let field = self.shape.cells.tape(tape);
        let mut along = Encloser::reuse(field, std::mem::take(&mut self.spare.along));
        let mut at = Encloser::reuse(field, std::mem::take(&mut self.spare.at));
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
            self.look(a, b, &mut along, &mut at, &mut pieces, found);
        }
        self.spare = Spare { along: along.into_memory(), at: at.into_memory(), pieces };
    }

    /// By the scene's promise about the gradient.
    fn certainly_away(&mut self, a: f64, b: f64) -> bool {
        let Some(steepest) = self.shape.steepest else { return false };
        let value = self.value(a);
        let reach = steepest * self.near.direction.length() * (b - a) * (1.0 + f64::EPSILON * 8.0);
        value.abs() > reach && (value < 0.0) == self.inside && self.hidden.is_none()
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
        if !value.partial && !value.contains(0.0) {
            return self.arrive(a, value.hi < 0.0, found);
        }
        let is_steady = !value.partial && !slope.partial && !slope.contains(0.0);
        if is_steady {
            return self.monotone(a, b, found);
        }
        let middle = a / 2.0 + b / 2.0;
        let scale = self.scale(a).max(self.scale(b));
        let is_least = b - a <= LEAST_STEPS * f64::EPSILON * scale || !(a < middle && middle < b);
        if is_least {
            return self.hide(a, b, value.partial, found);
        }
        let here = self.bounds_at(middle, at);
        if !value.partial && b - a <= SMALL * scale && value.width() <= 4.0 * here.width() {
            return self.hide(a, b, false, found);
        }
        let (left, right) = if value.partial { (middle, middle) } else { gap(a, b, middle, here, slope) };
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
                partial: false,
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

    /// Comes to a place where the sign is certain.
    fn arrive(&mut self, s: f64, negative: bool, found: Found<'_>) {
        self.settle(found);
        if !self.stopped && negative != self.inside {
            self.inside = negative;
            self.tell(s, ON_SURFACE, found);
        }
    }

    /// A piece over which f only rises, or only falls.
    fn monotone(&mut self, a: f64, b: f64, found: Found<'_>) {
        if self.hidden.is_some() {
            self.settle(found);
            if self.stopped {
                return;
            }
        }
        let start = self.value(a);
        let end = self.value(b);
        if start.is_nan() || end.is_nan() {
            return self.give_up(a, UNDEFINED, found);
        }
        if (start < 0.0) != self.inside {
            self.inside = start < 0.0;
            self.tell(a, ON_SURFACE, found);
        }
        if (end < 0.0) != self.inside && !self.stopped {
            let root = self.bracketed((a, start), (b, end));
            self.inside = end < 0.0;
            self.last = (b, end);
            self.tell(root, ON_SURFACE, found);
        }
    }

    fn bracketed(&mut self, a: (f64, f64), b: (f64, f64)) -> f64 {
        let tolerance = f64::EPSILON * self.scale(a.0).max(self.scale(b.0));
        bracket::closest(a, b, tolerance, |s| {
            self.evaluations += 1;
            self.shape.value(self.point(s))
        })
    }

    /// Adds a piece to what is hidden.
    fn hide(&mut self, a: f64, b: f64, partial: bool, found: Found<'_>) {
        match &mut self.hidden {
            Some(hidden) if a - hidden.to <= 16.0 * (hidden.to - hidden.from + b - a) => {
                hidden.to = b;
                hidden.partial |= partial;
            }
            _ => {
                self.settle(found);
                self.hidden = Some(Hidden { from: a, to: b, partial });
            }
        }
    }

    /// Decides what a hidden run was: a crossing where the sign changed, else a touch; where f may jump, a touch is nothing.
    fn settle(&mut self, found: Found<'_>) {
        let Some(hidden) = self.hidden.take() else { return };
        let (start, end) = (self.value(hidden.from), self.value(hidden.to));
        if start.is_nan() || end.is_nan() {
            return self.give_up(hidden.from, UNDEFINED, found);
        }
        let middle = hidden.from / 2.0 + hidden.to / 2.0;
        if (end < 0.0) != self.inside {
            let crosses = (start < 0.0) != (end < 0.0);
            let root = if crosses { self.bracketed((hidden.from, start), (hidden.to, end)) } else { middle };
            self.inside = end < 0.0;
            self.tell(root, ON_SURFACE, found);
        } else if !hidden.partial {
            self.tell(middle, ON_SURFACE, found);
            if !self.stopped {
                self.tell(middle, ON_SURFACE, found);
            }
        }
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
