//! The search for zeros along a ray, nearest first.
//!
//! The sign of f at the ends of pieces, in plain arithmetic, decides how many zeros there are; the same place always has the
//! same sign, so that inside and outside never disagree. Intervals decide which pieces need no look, and which hold one zero.

mod halve;

use super::bowl::Said;
use super::cells::{Leaf, Visited};
use super::plane::{Along, Part, Zeros};
use super::{FAR, FIRST_CUT, Implicit, ON_SURFACE, UNDEFINED};
use crate::math::bracket;
use crate::math::field::{Enclosed, Field, Linear};
use crate::world::shape::{LocalRay, Meet, ahead};
use glam::DVec3;
use std::cell::Cell;

/// How often f may be bounded along one ray before the search gives up: fifty times what the hardest double zeros of the tests take.
const MOST_EVALUATIONS: u32 = 20_000;

thread_local! {
    /// Kept between rays so that a search does not allocate.
    static SPARE: Cell<Spare> = const { Cell::new(Spare { along: Vec::new(), at: Vec::new(), forms: Vec::new(), pieces: Vec::new() }) };
}

#[derive(Default)]
struct Spare {
    along: Vec<Enclosed<1>>,
    at: Vec<Enclosed<0>>,
    forms: Vec<Linear<1>>,
    pieces: Vec<(f64, f64)>,
}

/// What a search comes to, in order.
#[derive(Clone, Copy, Debug)]
pub enum Event {
    /// The beginning; whether it is in the solid. Comes once and first.
    Start(bool),
    /// A meeting, and up to where no other follows: its own distance where that is not known.
    Meet(Meet, f64),
}

/// A part of a ray, by its distances.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Where it begins, not below 0.
    pub from: f64,
    /// What is met beyond need not be told.
    pub to: f64,
    /// Between these distances a crossing is told at any place near it of which no other lies between.
    pub rough: (f64, f64),
}

/// Nowhere, where every crossing is told where it is.
pub const NOWHERE: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

impl Window {
    /// All that is ahead.
    pub const AHEAD: Window = Window { from: 0.0, to: f64::MAX, rough: NOWHERE };
}

/// A ray near the box.
struct Near {
    origin: DVec3,
    direction: DVec3,
    /// The distance of `origin` along the ray.
    start: f64,
    /// Where the search begins and where the box is left, from `origin`.
    from: f64,
    leave: Meet,
    /// The face of the box at which it begins, if it does.
    entered: Option<u32>,
}

impl Near {
    fn new(shape: &Implicit, ray: &LocalRay, window: Window) -> Option<Near> {
        let bounds = shape.bounds();
        let to_middle = bounds.center() - ray.origin;
        let is_far = to_middle.abs().max_element() > FAR * bounds.size().max_element();
        let start = if is_far { to_middle.dot(ray.direction) / ray.direction.length_squared() } else { 0.0 };
        let origin = ray.at(start);
        let (enter, leave) = shape.within.ends(&LocalRay { origin, direction: ray.direction })?;
        let begin = window.from - start;
        let (from, entered) = if enter.t <= begin { (begin, None) } else { (enter.t, Some(enter.face)) };
        let ahead = from < leave.t && leave.t.is_finite() && from + start <= window.to;
        ahead.then_some(Near { origin, direction: ray.direction, start, from, leave, entered })
    }
}

/// Calls `found` with the beginning and each meeting in order, until it says false; gives how often f was bounded or evaluated.
pub(super) fn each_event(
    shape: &Implicit,
    ray: &LocalRay,
    window: Window,
    mut found: impl FnMut(Event) -> bool,
) -> u32 {
    let Some(near) = Near::new(shape, ray, window) else {
        found(Event::Start(false));
        return 0;
    };
    let mut search = Search::new(shape, &near, window.rough, SPARE.take());
    search.run(window.to, &mut |event| match event {
        Event::Start(_) => found(event),
        Event::Meet(meet, _) => {
            !(ahead(meet.t) && meet.t >= window.from) || (meet.t <= window.to && found(event))
        }
    });
    SPARE.set(search.spare);
    search.evaluations
}

/// A run of pieces in which rounding hides what f does.
#[derive(Clone, Copy)]
struct Hidden {
    from: f64,
    to: f64,
    /// True where f may jump or be undefined.
    gaps: bool,
}

struct Search<'s> {
    shape: &'s Implicit,
    near: &'s Near,
    /// Where crossings need not be found exactly.
    rough: (f64, f64),
    spare: Spare,
    evaluations: u32,
    /// Gives f's bits where the search is.
    field: &'s Field,
    /// Whether f is negative where the search has come to; none before it has begun.
    inside: Option<bool>,
    hidden: Option<Hidden>,
    /// A place and f there, which the next piece often begins at.
    last: (f64, f64),
    stopped: bool,
}

type Found<'f> = &'f mut dyn FnMut(Event) -> bool;

impl<'s> Search<'s> {
    fn new(shape: &'s Implicit, near: &'s Near, rough: (f64, f64), spare: Spare) -> Self {
        let (last, field) = ((f64::NAN, f64::NAN), &shape.function.field);
        Search {
            shape,
            near,
            rough,
            spare,
            evaluations: 0,
            field,
            inside: None,
            hidden: None,
            last,
            stopped: false,
        }
    }

    fn point(&self, s: f64) -> DVec3 {
        let Implicit { within, .. } = self.shape;
        (self.near.origin + self.near.direction * s).clamp(within.min, within.max)
    }

    /// f in plain arithmetic.
    fn value(&mut self, s: f64) -> f64 {
        if self.last.0 != s {
            self.evaluations += 1;
            self.last = (s, self.value_at(s));
        }
        self.last.1
    }

    fn value_at(&self, s: f64) -> f64 {
        super::value(self.field, self.point(s))
    }

    /// The size of the coordinates that a place is computed from.
    fn scale(&self, s: f64) -> f64 {
        self.near.origin.abs().max_element() + s.abs()
    }

    fn tell(&mut self, s: f64, face: u32, found: Found<'_>) {
        self.tell_until(s, face, s, found);
    }

    /// The same where no other follows up to `clear`.
    fn tell_until(&mut self, s: f64, face: u32, clear: f64, found: Found<'_>) {
        let meet = Meet { t: self.near.start + s, face, ..Meet::default() };
        self.stopped |= !found(Event::Meet(meet, self.near.start + clear));
    }

    /// That f is undefined, or cannot be followed, from here on.
    fn give_up(&mut self, s: f64, face: u32, found: Found<'_>) {
        // Never at the very start, where no meeting counts.
        let least = -self.near.start + self.scale(s) * f64::EPSILON;
        self.tell(s.max(least), face, found);
        self.stopped = true;
    }

    fn run(&mut self, limit: f64, found: Found<'_>) {
        let (from, to) = (self.near.from, self.near.leave.t);
        let shape = self.shape;
        let (origin, direction) = (self.near.origin, self.near.direction);
        shape.cells.along(shape.bounds(), origin, direction, (from, to), &mut |a, b, cell| {
            self.stopped |= a + self.near.start > limit;
            if !self.stopped {
                match cell {
                    Visited::Empty(negative) if self.inside == Some(negative) && self.hidden.is_none() => {}
                    Visited::Empty(negative) => self.arrive(a, negative, found),
                    Visited::Leaf(leaf) => self.leaf(a, b, leaf, found),
                }
            }
            !self.stopped
        });
        if !self.stopped {
            self.settle(found);
        }
        if !self.stopped && self.inside == Some(true) {
            self.tell(to, FIRST_CUT + self.near.leave.face, found);
        }
    }

    /// Comes to a place where f has a sign: a meeting where it is not the last one.
    fn come(&mut self, s: f64, negative: bool, found: Found<'_>) {
        self.come_until(s, negative, s, found);
    }

    /// The same where the sign stays up to `clear`.
    fn come_until(&mut self, s: f64, negative: bool, clear: f64, found: Found<'_>) {
        let was = self.inside.replace(negative);
        match (was, self.near.entered) {
            (None, entered) => {
                self.stopped |= !found(Event::Start(negative && entered.is_none()));
                if let (false, true, Some(face)) = (self.stopped, negative, entered) {
                    self.tell(self.near.from, FIRST_CUT + face, found);
                }
            }
            (Some(was), _) if was != negative => self.tell_until(s, ON_SURFACE, clear, found),
            (Some(_), _) => {}
        }
    }

    /// Searches a piece of the ray in one cell.
    fn leaf(&mut self, a: f64, b: f64, leaf: &Leaf, found: Found<'_>) {
        self.field = self.shape.cells.tape(leaf);
        if self.inside.is_none() {
            self.begin(a, leaf, found);
        }
        if self.stopped || self.certainly_away(a, b) {
            return;
        }
        let Some(plane) = &leaf.plane else { return self.piece(a, b, found) };
        let along = plane.along(self.near.origin, self.near.direction);
        match along.zeros(a, b) {
            Zeros::None(negative) => self.arrive(a, negative, found),
            Zeros::Within(part) if along.is_steady() => self.monotone(&part, &along, found),
            Zeros::Within(part) => self.part(a, &part, leaf, found),
        }
    }

    /// A part of a cell's piece of which the plane does not know enough.
    fn part(&mut self, a: f64, part: &Part, leaf: &Leaf, found: Found<'_>) {
        let (origin, direction) = (self.near.origin, self.near.direction);
        match leaf.shape.as_ref().map(|shape| shape.zeros(origin, direction, part)) {
            Some(Said::Nowhere(negative)) => self.arrive(a, negative, found),
            Some(Said::Steady(part, along)) => self.monotone(&part, &along, found),
            Some(Said::Unclear) | None => {
                if let Some(negative) = part.before {
                    self.arrive(a, negative, found);
                }
                if !self.stopped {
                    self.piece(part.from, part.to, found);
                }
            }
        }
    }

    /// Where the ray starts.
    fn begin(&mut self, a: f64, leaf: &Leaf, found: Found<'_>) {
        let along = leaf.plane.as_ref().map(|plane| plane.along(self.near.origin, self.near.direction));
        let sign = along.and_then(|along| along.sign(a));
        let negative = match sign {
            Some(negative) => negative,
            None => {
                let value = self.value(a);
                if value.is_nan() {
                    self.come(a, false, found);
                    if !self.stopped {
                        self.give_up(a, UNDEFINED, found);
                    }
                    return;
                }
                value < 0.0
            }
        };
        self.come(a, negative, found);
    }

    /// By the scene's promise about the gradient.
    fn certainly_away(&mut self, a: f64, b: f64) -> bool {
        let Some(steepest) = self.shape.steepest else { return false };
        let value = self.value(a);
        let reach = steepest * self.near.direction.length() * (b - a) * (1.0 + f64::EPSILON * 8.0);
        value.abs() > reach && Some(value < 0.0) == self.inside && self.hidden.is_none()
    }

    /// Comes to a place where the sign is certain.
    fn arrive(&mut self, s: f64, negative: bool, found: Found<'_>) {
        self.settle(found);
        if !self.stopped && self.inside != Some(negative) {
            self.come(s, negative, found);
        }
    }

    /// Signs at the ends of a piece, where they are not known from elsewhere by plain arithmetic; what was hidden before it is settled first.
    /// None where the search is over.
    fn ends(&mut self, part: &Part, found: Found<'_>) -> Option<(bool, bool)> {
        self.settle(found);
        let mut sign = |known: Option<bool>, s: f64| {
            known.or_else(|| Some(self.value(s)).filter(|value| !value.is_nan()).map(|value| value < 0.0))
        };
        let signs = sign(part.before, part.from).zip(sign(part.after, part.to));
        if self.stopped {
            return None;
        }
        let Some((start, end)) = signs else {
            self.give_up(part.from, UNDEFINED, found);
            return None;
        };
        self.come(part.from, start, found);
        (!self.stopped).then_some((start, end))
    }

    /// A piece over which f only rises, or only falls, and is near a line.
    fn monotone(&mut self, part: &Part, along: &Along, found: Found<'_>) {
        let Some((start, end)) = self.ends(part, found) else { return };
        if start != end && self.is_rough(part) {
            self.come_until(part.from, end, part.to, found);
        } else if start != end {
            let tolerance = self.tolerance(part);
            let guess = bracket::Guess { at: along.zero(), slope: along.slope, bend: along.bend };
            let root = bracket::secant(part.from, part.to, guess, tolerance, |s| {
                self.evaluations += 1;
                self.value_at(s)
            });
            self.come_until(root, end, part.to, found);
        }
    }

    /// The same where no more is known.
    fn monotone_between(&mut self, part: &Part, found: Found<'_>) {
        let Some((start, end)) = self.ends(part, found) else { return };
        if start != end {
            let (a, b) = ((part.from, self.value(part.from)), (part.to, self.value(part.to)));
            let root = self.bracketed(a, b);
            self.come_until(root, end, part.to, found);
        }
    }

    /// Whether any place in a part will do.
    fn is_rough(&self, part: &Part) -> bool {
        let place = |s: f64| self.near.start + s;
        place(part.from) > self.rough.0 && place(part.to) < self.rough.1 && part.from < part.to
    }

    fn tolerance(&self, part: &Part) -> f64 {
        f64::EPSILON * self.scale(part.from).max(self.scale(part.to))
    }

    fn bracketed(&mut self, a: (f64, f64), b: (f64, f64)) -> f64 {
        let tolerance = f64::EPSILON * self.scale(a.0).max(self.scale(b.0));
        bracket::closest(a, b, tolerance, |s| {
            self.evaluations += 1;
            self.value_at(s)
        })
    }

    /// Adds a piece to what is hidden.
    fn hide(&mut self, a: f64, b: f64, gaps: bool, found: Found<'_>) {
        match &mut self.hidden {
            Some(hidden) if a - hidden.to <= 16.0 * (hidden.to - hidden.from + b - a) => {
                hidden.to = b;
                hidden.gaps |= gaps;
            }
            _ => {
                self.settle(found);
                self.hidden = Some(Hidden { from: a, to: b, gaps });
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
        if Some(end < 0.0) != self.inside {
            let crosses = (start < 0.0) != (end < 0.0);
            let root = if crosses { self.bracketed((hidden.from, start), (hidden.to, end)) } else { middle };
            self.come(root, end < 0.0, found);
        } else if !hidden.gaps {
            self.tell(middle, ON_SURFACE, found);
            if !self.stopped {
                self.tell(middle, ON_SURFACE, found);
            }
        }
    }
}
