//! Implicit surfaces: where a function of the scene is 0 within a box, solid where it is negative. The box cuts the solid off, and
//! where it does there is a face.
//!
//! A ray is searched by intervals that are proved to hold no zero, or to hold one; nothing is stepped over and no bound on the gradient
//! is needed (Mitchell, *Robust ray intersection with interval arithmetic*, 1990). Where rounding hides whether the function
//! reaches 0 it counts as touched. A place where the function is undefined, or where the search gives up, is met too, so that its
//! pixel can say so; neither is ever taken for empty space.

mod bowl;
mod cells;
mod grow;
mod plane;
mod search;
#[cfg(test)]
mod tests;

use super::cuboid::Cuboid;
use super::{LocalRay, Meet, Surface, Uv, perpendicular};
use crate::math::Aabb;
use crate::math::elementary::cbrt;
use crate::math::error::gamma;
use crate::math::field::{Enclosed, Encloser, FaultKind, Field, Linear, Linearizer};
use crate::math::interval::Interval;
use crate::scene::SampledFunction;
use crate::world::texture::TextureFault;
use cells::Cells;
use glam::DVec3;
pub use search::{Event, NOWHERE, Window};
use std::cell::Cell;
use std::sync::Arc;

/// The surface itself.
const ON_SURFACE: u32 = 0;
/// The face of the box is this less than the meeting's.
const FIRST_CUT: u32 = 1;
/// The function is undefined there.
pub(super) const UNDEFINED: u32 = 7;
/// The search gave up there.
const UNRESOLVED: u32 = 8;

/// A ray that starts farther from the middle than this many sizes of the box is first moved near it.
const FAR: f64 = 4.0;

/// An implicit surface.
#[derive(Clone, Debug)]
pub struct Implicit {
    function: Arc<SampledFunction>,
    within: Cuboid,
    /// What the scene promises that |∇f| does not exceed.
    steepest: Option<f64>,
    cells: Cells,
}

impl Implicit {
    /// Of a function of the point with one output, in a box with extent. Finds the parts of the box that may hold the surface.
    pub fn new(function: Arc<SampledFunction>, min: DVec3, max: DVec3, steepest: Option<f64>) -> Implicit {
        let within = Cuboid { min, max };
        let cells = grow::grow(&function.field, Aabb { min, max });
        Implicit { function, within, steepest, cells }
    }

    /// f at a point of the box; NaN where it is undefined.
    fn value(&self, p: DVec3) -> f64 {
        value(&self.function.field, p)
    }

    /// Whether f is surely not 0 at a point, rounding included.
    fn is_clear(&self, p: DVec3) -> bool {
        let field = &self.function.field;
        let form = Linearizer::reuse(field, SPARE_POINT.take());
        let (form, memory) = form.once(&p.to_array().map(Linear::constant));
        SPARE_POINT.set(memory);
        match form {
            Some(form) => form.sign().is_some(),
            None => !Encloser::new(field).run(&p.to_array().map(Enclosed::<0>::constant)).value.contains(0.0),
        }
    }

    /// f near a point; none where it is not known.
    fn tangent(&self, p: DVec3) -> Option<Tangent> {
        let step = STEP * self.bounds().size().max_element();
        let inputs = std::array::from_fn::<_, 3, _>(|i| {
            let mut slope = [0.0; 3];
            slope[i] = step;
            Linear::new(p[i], slope, 0.0)
        });
        let (form, memory) = Linearizer::reuse(&self.function.field, SPARE_TANGENT.take()).once(&inputs);
        SPARE_TANGENT.set(memory);
        let form = form?;
        let gradient = DVec3::from_array(form.slope) / step;
        let off = DVec3::from_array(form.bend) / step;
        let normal = gradient.try_normalize()?;
        let is_known = off.max_element() <= gradient.abs().max_element() * LEAST_KNOWN;
        // Along the normal f changes by the gradient's length, up to its roundings; that must outweigh what it may be off by.
        let clear = (form.middle.abs() + form.rest) / gradient.length() * (1.0 + gamma(16));
        let clearance = (clear <= step * 0.5).then_some(clear);
        is_known.then_some(Tangent { gradient, normal, clearance })
    }

    /// Where the scene's promise about the gradient is broken, and what it is there: looked for at the middles of all cells.
    pub fn broken_promise(&self) -> Option<(DVec3, f64)> {
        let steepest = self.steepest?;
        let slopes = self.cells.middles(self.bounds()).map(|p| (p, self.gradient(p).length()));
        slopes.filter(|(_, slope)| *slope > steepest * (1.0 + gamma(64))).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        self.meet_counting(ray, limit).0
    }

    /// The nearest meeting in (0, limit], and how often the function was bounded or evaluated to find it.
    pub fn meet_counting(&self, ray: &LocalRay, limit: f64) -> (Option<Meet>, u32) {
        self.first(ray, Window { from: 0.0, to: limit, rough: NOWHERE })
    }

    /// Any meeting in (0, limit].
    pub(super) fn meet_any(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        self.first(ray, Window { from: 0.0, to: limit, rough: (0.0, limit) }).0
    }

    fn first(&self, ray: &LocalRay, window: Window) -> (Option<Meet>, u32) {
        let mut first = None;
        let evaluations = search::each_event(self, ray, window, |event| match event {
            Event::Start(_) => true,
            Event::Meet(meet, _) => {
                first = Some(meet);
                false
            }
        });
        (first, evaluations)
    }

    pub(super) fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        self.each_crossing(ray, Window::AHEAD, |event| {
            if let Event::Meet(meet, _) = event {
                out.push(meet);
            }
            true
        });
    }

    /// Calls `found` with whether a part of a ray begins inside, and then with each crossing in it in order, until it says false.
    pub(super) fn each_crossing(&self, ray: &LocalRay, window: Window, mut found: impl FnMut(Event) -> bool) {
        search::each_event(self, ray, window, |event| match event {
            // Meetings of other kinds do not turn inside to outside: they stand twice.
            Event::Meet(meet, _) if meet.face >= UNDEFINED => found(event) && found(event),
            Event::Meet(..) | Event::Start(_) => found(event),
        });
    }

    pub(super) fn starts_inside(&self, ray: &LocalRay) -> bool {
        let mut inside = false;
        search::each_event(self, ray, Window::AHEAD, |event| {
            inside = matches!(event, Event::Start(true));
            false
        });
        inside
    }

    /// Why there is no surface at a meeting, where there is none.
    pub fn fault(&self, ray: &LocalRay, meet: &Meet) -> Option<TextureFault> {
        match meet.face {
            UNDEFINED => {
                let p = ray.at(meet.t).clamp(self.within.min, self.within.max);
                let fault = self.function.field.eval(&p.to_array(), &mut [0.0]).err();
                Some(TextureFault {
                    span: fault.map_or(self.function.span, |fault| self.function.place(fault)),
                    kind: fault.map_or(FaultKind::Undefined, |fault| fault.kind),
                })
            }
            UNRESOLVED => Some(TextureFault { span: self.function.span, kind: FaultKind::Unresolved }),
            _ => None,
        }
    }

    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        if (FIRST_CUT..UNDEFINED).contains(&meet.face) {
            return self.within.surface(ray, &Meet { face: meet.face - FIRST_CUT, ..*meet });
        }
        let point = ray.at(meet.t).clamp(self.within.min, self.within.max);
        let rounding = (ray.origin.abs() + (ray.direction * meet.t).abs()).max_element() * gamma(4);
        if meet.face >= UNDEFINED {
            return self.marked(point, -ray.direction.normalize(), rounding);
        }
        let tangent = self.tangent(point);
        let normal = tangent.map_or_else(|| self.normal(point, ray, rounding), |t| t.normal);
        let error = match tangent.and_then(|t| t.clearance) {
            // A ray that starts there is rounded as well.
            Some(clearance) => 2.0 * clearance.max(rounding),
            None => self.clearance(point, normal, rounding),
        };
        self.marked(point, normal, error)
    }

    fn marked(&self, point: DVec3, normal: DVec3, error: f64) -> Surface {
        let out = (point - self.bounds().center()).try_normalize().unwrap_or(DVec3::Y);
        Surface {
            point,
            error: DVec3::splat(error),
            geometric_normal: normal,
            normal,
            tangent: perpendicular(normal),
            uv: Uv::Around(out),
        }
    }

    /// How far from a point, along the normal either way, f is surely not 0: rounding included. Doubled until it is, up to a share of the
    /// coordinates at which nothing is left to see.
    fn clearance(&self, point: DVec3, normal: DVec3, rounding: f64) -> f64 {
        let most = rounding * (1u64 << 30) as f64;
        let mut away = rounding.max(f64::MIN_POSITIVE);
        while away < most && !(self.is_clear(point + normal * away) && self.is_clear(point - normal * away)) {
            away *= 2.0;
        }
        // A ray that starts there is rounded as well.
        2.0 * away
    }

    /// The unit gradient; where that vanishes or is not known, that of a place a little before the meeting (a double zero has no gradient on
    /// the surface itself), and in the end the direction the ray came from.
    fn normal(&self, point: DVec3, ray: &LocalRay, rounding: f64) -> DVec3 {
        let usable = |g: DVec3| (g / g.abs().max_element()).try_normalize();
        if let Some(normal) = usable(self.gradient(point)) {
            return normal;
        }
        let back = -ray.direction.normalize();
        (2..24)
            .step_by(3)
            .find_map(|k| usable(self.gradient(point + back * (rounding * f64::from(1 << k)))))
            .unwrap_or(back)
    }

    /// ∇f by exact rules where these know it, else by central differences.
    fn gradient(&self, p: DVec3) -> DVec3 {
        if let Some(tangent) = self.tangent(p) {
            return tangent.gradient;
        }
        let inputs = directions(p.to_array().map(Interval::point), [DVec3::X, DVec3::Y, DVec3::Z]);
        let slope = Encloser::new(&self.function.field).run(&inputs).slope;
        let known = slope.iter().all(|s| s.width() <= s.middle().abs() / 1024.0 + f64::MIN_POSITIVE * 64.0);
        if known {
            return DVec3::from_array(slope.map(Interval::middle));
        }
        // The step at which rounding and the third derivative are alike.
        let step = cbrt(f64::EPSILON) * self.bounds().size().min_element();
        let value = |q: DVec3| self.value(q);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        DVec3::from_array(axes.map(|e| (value(p + e * step) - value(p - e * step)) / (2.0 * step)))
    }

    pub(super) fn bounds(&self) -> Aabb {
        Aabb { min: self.within.min, max: self.within.max }
    }
}

/// f near a point.
#[derive(Clone, Copy, Debug)]
struct Tangent {
    gradient: DVec3,
    normal: DVec3,
    /// How far along the normal either way f is surely not 0, rounding included, where that is near.
    clearance: Option<f64>,
}

/// The size of the box in which a tangent is taken, as a share of the shape's: the square of it is not felt, roundings are much smaller.
const STEP: f64 = 1.0 / (1u64 << 36) as f64;
/// A gradient that may be off by more than this is not known.
const LEAST_KNOWN: f64 = 1.0 / (1 << 20) as f64;

thread_local! {
    /// Kept between surfaces so that none allocates.
    static SPARE_POINT: Cell<Vec<Linear<0>>> = const { Cell::new(Vec::new()) };
    static SPARE_TANGENT: Cell<Vec<Linear<3>>> = const { Cell::new(Vec::new()) };
}

/// A tape's value at a point; NaN where it is undefined.
fn value(field: &Field, p: DVec3) -> f64 {
    let mut value = [f64::NAN];
    match field.eval(&p.to_array(), &mut value) {
        Ok(()) => value[0],
        Err(_) => f64::NAN,
    }
}

/// Coordinates with their derivatives along N directions.
fn directions<const N: usize>(at: [Interval; 3], along: [DVec3; N]) -> [Enclosed<N>; 3] {
    std::array::from_fn(|axis| Enclosed {
        value: at[axis],
        slope: std::array::from_fn(|i| Interval::point(along[i][axis])),
    })
}
