//! The walk of a ray through the parts.

use super::{COINCIDENT, Csg, Tally, doubt, reach};
use crate::world::bvh::clip;
use crate::world::shape::{LocalRay, Meet, Surface};
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
}

thread_local! {
    /// Kept between rays so that a walk does not allocate.
    static SPARE: Cell<Walk> = const {
        Cell::new(Walk { meetings: Vec::new(), tallies: Vec::new(), inside: Vec::new() })
    };
}

/// Meetings at one place, by their range among all, and that at which the whole is entered or left.
struct Turn<'w> {
    at: Meet,
    together: &'w [Meet],
}

impl Csg {
    /// The nearest meeting in (0, limit].
    pub fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        let mut first = None;
        self.each_turn(ray, limit, |turn| {
            first = Some(turn.at);
            false
        });
        first.filter(|meet| meet.t <= limit)
    }

    /// Every meeting, in order.
    pub fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        self.each_turn(ray, f64::MAX, |turn| {
            out.push(turn.at);
            true
        });
    }

    /// Whether a ray starts inside.
    pub fn starts_inside(&self, ray: &LocalRay) -> bool {
        let mut walk = SPARE.take();
        self.gather(ray, &mut walk);
        let inside = self.operations[0].holds(walk.tallies[0]);
        SPARE.set(walk);
        inside
    }

    /// How far beyond a surface those that coincide with it may lie, across it.
    pub(super) fn spread(&self, ray: &LocalRay, meet: &Meet, surface: &Surface) -> f64 {
        let steepness = surface.geometric_normal.dot(ray.direction).abs();
        let mut spread = 0.0f64;
        self.each_turn(ray, f64::MAX, |turn| {
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

    /// Calls `found` at each place up to the limit where the whole is entered or left, until it says false.
    fn each_turn(&self, ray: &LocalRay, limit: f64, mut found: impl FnMut(&Turn<'_>) -> bool) {
        let mut walk = SPARE.take();
        self.gather(ray, &mut walk);
        let Walk { meetings, tallies, inside } = &mut walk;
        let mut from = 0;
        while from < meetings.len() && meetings[from].t <= limit {
            let mut to = from + 1;
            while to < meetings.len() && self.coincide(ray, &meetings[to - 1], &meetings[to]) {
                to += 1;
            }
            let together = &mut meetings[from..to];
            from = to;
            let Some(mut at) = self.pass(together, tallies, inside) else { continue };
            if together.len() > 1 {
                at.part |= COINCIDENT;
            }
            if !found(&Turn { at, together }) {
                break;
            }
        }
        SPARE.set(walk);
    }

    /// Collects the meetings with all parts, and where the ray starts.
    fn gather(&self, ray: &LocalRay, walk: &mut Walk) {
        walk.meetings.clear();
        walk.tallies.clear();
        walk.tallies.extend_from_slice(&self.outside);
        walk.inside.clear();
        walk.inside.resize(self.parts.len(), false);
        // What begins beyond the whole's box is met too late to matter, and the ray does not start in it.
        let far = clip(&self.bounds, ray.origin, ray.direction, f64::MAX).map_or(-1.0, |(_, far)| far);
        if far < 0.0 {
            return;
        }
        self.tree.traverse(ray.origin, ray.direction, far, |range, t_max| {
            for position in range {
                self.gather_part(self.tree.order()[position], ray, walk);
            }
            t_max
        });
        if walk.meetings.len() > 1 {
            walk.meetings.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.part.cmp(&b.part)));
        }
    }

    fn gather_part(&self, number: u32, ray: &LocalRay, walk: &mut Walk) {
        let part = &self.parts[number as usize];
        let Some((local, factor)) = part.local(ray) else { return };
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
        let mut turned = None;
        for meet in together.iter() {
            self.turn(meet.part, tallies, inside);
            if whole.holds(tallies[0]) == before {
                turned = None;
            } else {
                turned = turned.or(Some(*meet));
            }
        }
        turned
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
