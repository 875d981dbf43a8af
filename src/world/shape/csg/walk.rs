//! The walk of a ray through the parts.

use super::{COINCIDENT, Csg, Solid, Tally, doubt, reach};
use crate::world::bvh::clip;
use crate::world::shape::implicit::{Event, NOWHERE, Window};
use crate::world::shape::{LocalRay, Meet, Shape, Surface};
use std::cell::Cell;

/// Meetings farther apart than this share of the numbers that they were computed from are not tested for coincidence.
const APART: f64 = 1.0 / (1 << 12) as f64;

/// What a ray meets of all parts, and where it is inside.
#[derive(Default)]
struct Walk {
    /// In order; the part's number in each.
    meetings: Vec<Meet>,
    tallies: Vec<Tally>,
    /// Per part.
    inside: Vec<bool>,
    /// Meetings at one place, not passed yet.
    together: Vec<Meet>,
    /// A part that is expensive to follow: it is met as the walk goes on, only where it matters, and no farther than the walk goes.
    slow: Option<u32>,
    /// Where it matters.
    windows: Vec<Window>,
}

thread_local! {
    /// Kept between rays so that a walk does not allocate; in a box, as it is taken and given back for every ray.
    static SPARE: Cell<Option<Box<Walk>>> = const { Cell::new(None) };
}

/// Meetings at one place, and that at which the whole is entered or left.
struct Turn<'w> {
    at: Meet,
    together: &'w [Meet],
}

/// A walk going on: meetings come in order, those at one place are passed together.
struct Steps<'w, F> {
    csg: &'w Csg,
    ray: &'w LocalRay,
    limit: f64,
    walk: &'w mut Walk,
    found: F,
    stopped: bool,
}

impl<F: FnMut(&Turn<'_>) -> bool> Steps<'_, F> {
    /// The next meeting; false once nothing more is wanted.
    fn meet(&mut self, meet: Meet) -> bool {
        if let Some(last) = self.walk.together.last()
            && !self.csg.coincide(self.ray, last, &meet)
        {
            self.pass();
        }
        self.stopped |= self.walk.together.is_empty() && meet.t > self.limit;
        if !self.stopped {
            self.walk.together.push(meet);
        }
        !self.stopped
    }

    /// A slow part begins to matter, inside or not. What came before did not depend on it; false once nothing more is wanted.
    fn start(&mut self, number: u32, inside: bool) -> bool {
        self.pass();
        let Walk { tallies, inside: all, .. } = &mut *self.walk;
        if all[number as usize] != inside {
            self.csg.turn(number, tallies, all);
        }
        !self.stopped
    }

    /// Whether a meeting still to come may be at the place of this one, which is of a slow part and stands alone up to `clear` there.
    fn may_join(&self, meet: &Meet, clear: f64, next: Option<&Meet>) -> bool {
        clear <= meet.t || next.is_some_and(|next| next.t - meet.t <= APART * reach(self.ray, next.t))
    }

    /// Passes what has come together; false once nothing more is wanted.
    fn pass(&mut self) -> bool {
        let Walk { tallies, inside, together, .. } = &mut *self.walk;
        if let Some(mut at) = self.csg.pass(together, tallies, inside) {
            if together.len() > 1 {
                at.part |= COINCIDENT;
            }
            self.stopped |= !(self.found)(&Turn { at, together });
        }
        together.clear();
        !self.stopped
    }
}

impl Csg {
    /// The nearest meeting in (0, limit].
    pub fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        self.first(ray, limit, false)
    }

    /// Any meeting in (0, limit].
    pub fn meet_any(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        self.first(ray, limit, true)
    }

    fn first(&self, ray: &LocalRay, limit: f64, any: bool) -> Option<Meet> {
        let mut first = None;
        self.each_turn(ray, limit, any, |turn| {
            first = Some(turn.at);
            false
        });
        first.filter(|meet| meet.t <= limit)
    }

    /// Every meeting, in order.
    pub fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        self.each_turn(ray, f64::MAX, false, |turn| {
            out.push(turn.at);
            true
        });
    }

    /// Whether a ray starts inside.
    pub fn starts_inside(&self, ray: &LocalRay) -> bool {
        let mut walk = SPARE.take().unwrap_or_default();
        self.gather(ray, &mut walk);
        if let Some(number) = walk.slow
            && self.matters(number, &walk)
        {
            self.each_of_slow(number, ray, Window { from: 0.0, to: 0.0, rough: NOWHERE }, |event| {
                if let Event::Start(true) = event {
                    self.turn(number, &mut walk.tallies, &mut walk.inside);
                }
                false
            });
        }
        let inside = self.operations[0].holds(walk.tallies[0]);
        SPARE.set(Some(walk));
        inside
    }

    /// How far beyond a surface those that coincide with it may lie, across it.
    pub(super) fn spread(&self, ray: &LocalRay, meet: &Meet, surface: &Surface) -> f64 {
        let steepness = surface.geometric_normal.dot(ray.direction).abs();
        let mut spread = 0.0f64;
        self.each_turn(ray, f64::MAX, false, |turn| {
            let is_it = turn.at.t == meet.t && turn.at.part == meet.part;
            if is_it {
                for other in turn.together {
                    let error = self
                        .surface_of_part(ray, other)
                        .map_or(0.0, |(s, _)| s.geometric_normal.abs().dot(s.error));
                    spread = spread.max((other.t - meet.t).abs() * steepness + error);
                }
            }
            !is_it
        });
        spread
    }

    /// Calls `found` at each place up to the limit where the whole is entered or left, until it says false. Where any will do, the first may be
    /// told beside where it is.
    fn each_turn(&self, ray: &LocalRay, limit: f64, any: bool, found: impl FnMut(&Turn<'_>) -> bool) {
        let mut walk = SPARE.take().unwrap_or_default();
        self.gather(ray, &mut walk);
        let slow = walk.slow.inspect(|number| {
            self.find_windows(*number, ray, limit, &mut walk);
            if !any {
                walk.windows.iter_mut().for_each(|window| window.rough = NOWHERE);
            }
        });
        let meetings = std::mem::take(&mut walk.meetings);
        let windows = std::mem::take(&mut walk.windows);
        let mut steps = Steps { csg: self, ray, limit, walk: &mut walk, found, stopped: false };
        let mut rest = 0;
        for (number, window) in slow.into_iter().flat_map(|number| windows.iter().map(move |w| (number, w))) {
            self.each_of_slow(number, ray, *window, |event| {
                let from = match event {
                    Event::Start(_) => window.from,
                    Event::Meet(meet, _) => meet.t,
                };
                let before = |other: &Meet| other.t < from || (other.t == from && other.part < number);
                while let Some(other) = meetings.get(rest).filter(|other| before(other)) {
                    rest += 1;
                    if !steps.meet(*other) {
                        return false;
                    }
                }
                match event {
                    Event::Start(inside) => steps.start(number, inside),
                    Event::Meet(meet, clear) => {
                        steps.meet(meet) && (steps.may_join(&meet, clear, meetings.get(rest)) || steps.pass())
                    }
                }
            });
            if steps.stopped {
                break;
            }
        }
        while !steps.stopped && rest < meetings.len() && steps.meet(meetings[rest]) {
            rest += 1;
        }
        if !steps.stopped {
            steps.pass();
        }
        (walk.meetings, walk.windows) = (meetings, windows);
        SPARE.set(Some(walk));
    }

    /// Follows a slow part through a window, until `found` says false.
    fn each_of_slow(
        &self,
        number: u32,
        ray: &LocalRay,
        window: Window,
        mut found: impl FnMut(Event) -> bool,
    ) {
        let part = &self.parts[number as usize];
        let (Solid::Shape(Shape::Implicit(implicit)), Some((local, factor))) = (&part.solid, part.local(ray))
        else {
            return;
        };
        let rough = (window.rough.0 * factor, window.rough.1 * factor);
        let own = Window { from: window.from * factor, to: window.to * factor, rough };
        implicit.each_crossing(&local, own, |event| match event {
            Event::Start(_) => found(event),
            Event::Meet(meet, clear) => {
                let meet = Meet { t: meet.t / factor, part: number, ..meet };
                found(Event::Meet(meet, clear / factor))
            }
        });
    }

    /// Whether the whole changes where a part is turned.
    fn matters(&self, number: u32, walk: &Walk) -> bool {
        let mut entered = !walk.inside[number as usize];
        let mut place = self.parts[number as usize].place;
        while let Some(of) = place.of {
            let (operation, mut tally) = (&self.operations[of as usize], walk.tallies[of as usize]);
            let was = operation.holds(tally);
            operation.count(&mut tally, place.is_first, entered);
            entered = operation.holds(tally);
            if entered == was {
                return false;
            }
            place = operation.place;
        }
        true
    }

    /// The windows in which a slow part matters, by the meetings of the others: each reaches so far out that what coincides with a meeting at
    /// its end is in it.
    fn find_windows(&self, number: u32, ray: &LocalRay, limit: f64, walk: &mut Walk) {
        walk.windows.clear();
        let meetings = std::mem::take(&mut walk.meetings);
        let (mut from, mut is_after_all) = (0.0, false);
        let mut rest = meetings.iter();
        while !is_after_all && from <= limit {
            let next = rest.next();
            let to = next.map_or(f64::MAX, |meet| meet.t);
            is_after_all = next.is_none();
            if self.matters(number, walk) {
                let apart = |t: f64| APART * reach(ray, t);
                let window = Window {
                    from: (from - apart(from)).max(0.0),
                    to: (to + apart(to)).min(limit + apart(limit)),
                    // So far from other meetings that nothing coincides, twice over for rounding.
                    rough: (from + 2.0 * apart(from), (to - 2.0 * apart(to)).min(limit)),
                };
                match walk.windows.last_mut() {
                    Some(last) if window.from <= last.to => {
                        (last.to, last.rough) = (window.to, NOWHERE);
                    }
                    _ => walk.windows.push(window),
                }
            }
            if let Some(meet) = next {
                self.turn(meet.part, &mut walk.tallies, &mut walk.inside);
                from = to;
            }
        }
        // Back to where the ray starts.
        let n_turned = meetings.len() - rest.len();
        for meet in &meetings[..n_turned] {
            self.turn(meet.part, &mut walk.tallies, &mut walk.inside);
        }
        walk.meetings = meetings;
    }

    /// Collects the meetings with all parts, and where the ray starts.
    fn gather(&self, ray: &LocalRay, walk: &mut Walk) {
        walk.meetings.clear();
        walk.together.clear();
        walk.slow = None;
        walk.tallies.clear();
        walk.tallies.extend_from_slice(&self.outside);
        walk.inside.clear();
        walk.inside.resize(self.parts.len(), false);
        // What begins beyond the whole's box is met too late to matter, and the ray does not start in it.
        let far = clip(&self.bounds, ray.origin, ray.direction, f64::MAX).map_or(-1.0, |(_, far)| far);
        if far < 0.0 {
            return;
        }
        for (number, part) in self.boxes.iter().enumerate() {
            if part.is_none_or(|part| clip(&part, ray.origin, ray.direction, far).is_some()) {
                self.gather_part(number as u32, ray, walk);
            }
        }
        if self.boxes.is_empty() {
            self.tree.traverse(&ray.origin, &ray.direction, far, |range, t_max| {
                for position in range {
                    self.gather_part(self.tree.order()[position], ray, walk);
                }
                t_max
            });
        }
        if walk.meetings.len() > 1 {
            walk.meetings.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.part.cmp(&b.part)));
        }
    }

    fn gather_part(&self, number: u32, ray: &LocalRay, walk: &mut Walk) {
        let part = &self.parts[number as usize];
        let Some((local, factor)) = part.local(ray) else { return };
        if let (Solid::Shape(Shape::Implicit(_)), None) = (&part.solid, walk.slow) {
            walk.slow = Some(number);
            return;
        }
        let first = walk.meetings.len();
        part.solid.crossings(&local, &mut walk.meetings);
        let met = &mut walk.meetings[first..];
        for meet in met.iter_mut() {
            meet.t /= factor;
            meet.part = number;
        }
        if part.solid.starts_inside(&local, met.len()) {
            self.turn(number, &mut walk.tallies, &mut walk.inside);
        }
    }

    /// Turns a part's inside to outside or back, and what follows from it.
    fn turn(&self, number: u32, tallies: &mut [Tally], inside: &mut [bool]) {
        let mut entered = !inside[number as usize];
        inside[number as usize] = entered;
        let mut place = self.parts[number as usize].place;
        while let Some(of) = place.of {
            let (operation, tally) = (&self.operations[of as usize], &mut tallies[of as usize]);
            let was = operation.holds(*tally);
            operation.count(tally, place.is_first, entered);
            entered = operation.holds(*tally);
            if entered == was {
                return;
            }
            place = operation.place;
        }
    }

    /// Passes meetings at one place; where the whole is entered or left by them, the first in the order of the parts that does it.
    fn pass(&self, together: &mut [Meet], tallies: &mut [Tally], inside: &mut [bool]) -> Option<Meet> {
        let whole = &self.operations[0];
        let before = whole.holds(tallies[0]);
        if together.len() > 1 {
            together.sort_by_key(|meet| meet.part);
        }
        let (mut turned, mut unknown) = (None, None);
        for meet in together.iter() {
            self.turn(meet.part, tallies, inside);
            if whole.holds(tallies[0]) == before {
                turned = None;
            } else {
                turned = turned.or(Some(*meet));
                // A part that is not known here stands twice, and turns nothing; it matters where it would.
                unknown = unknown.or(self.is_unknown(meet).then_some(*meet));
            }
        }
        turned.or(unknown)
    }

    /// Whether two meetings, the second not before the first, are at one place as far as rounding can tell. Those of one part are
    /// not, unless it is only touched.
    fn coincide(&self, ray: &LocalRay, a: &Meet, b: &Meet) -> bool {
        let gap = b.t - a.t;
        if gap == 0.0 {
            return true;
        }
        if a.part == b.part || gap > APART * reach(ray, b.t) {
            return false;
        }
        let doubt =
            |meet: &Meet| self.surface_of_part(ray, meet).map_or(0.0, |(s, _)| doubt(ray, meet.t, &s));
        gap <= doubt(a) + doubt(b)
    }
}
