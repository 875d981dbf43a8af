//! Light that is sent where it is wanted and nowhere else. What rays carry is less by as much as is left out, and one carries what the next
//! does (from a surface, by its cosine): where they arrive, nothing shows of where they were aimed.
//!
//! Seen from a place, targets are cones that may overlap. A direction belongs to the first cone that holds it: one that was chosen for a later
//! one is given up. So every direction that is wanted has one density, 1 over the solid angle of all cones together, however many of them hold
//! it. Discs, which are targets as parallel light sees them, are told apart in the same way. Where cones or discs are more than all that a lamp
//! sends to, its light is sent as if it were not aimed, and what meets no target is given up.

use super::emission::sphere;
use super::targets::MOST;
use super::{Targets, cosine_hemisphere, frame, to_frame};
use crate::geometry::balls::Ball;
use crate::math::elementary::sin_cos_turns;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// What light is to meet.
#[derive(Clone, Debug)]
pub enum Aim {
    /// Anything; light from afar only what is in the ball.
    Anything(Ball),
    /// These, and what it meets on its way to them.
    At(Targets),
}

/// How light leaves a place.
#[derive(Clone, Copy, Debug)]
pub(super) enum Spread {
    /// In all directions alike.
    Sphere,
    /// In all directions alike that are no farther from an axis than a cosine says.
    Cap(DVec3, f64),
    /// By the cosine to a normal.
    Cosine(DVec3),
}

impl Spread {
    /// Of all directions together.
    fn whole(&self) -> f64 {
        match self {
            Spread::Sphere => 4.0 * PI,
            Spread::Cap(_, cosine) => TAU * (1.0 - cosine),
            Spread::Cosine(_) => PI,
        }
    }

    /// Of a direction, per steradian.
    fn share(&self, direction: DVec3) -> f64 {
        match self {
            Spread::Sphere => 1.0,
            Spread::Cap(axis, cosine) => f64::from(u8::from(axis.dot(direction) >= *cosine)),
            Spread::Cosine(normal) => normal.dot(direction).max(0.0),
        }
    }

    /// A direction by u in (0, 1)², as often as its share is of the whole.
    fn choose(&self, u: DVec2) -> DVec3 {
        match self {
            Spread::Sphere => sphere(u),
            Spread::Cap(axis, cosine) => to_frame(*axis, cap(u, 1.0 - cosine)),
            Spread::Cosine(normal) => to_frame(*normal, cosine_hemisphere(u)),
        }
    }

    /// False where no direction of a cone has a share.
    fn may_meet(&self, cone: &Cone) -> bool {
        match self {
            Spread::Sphere => true,
            // The cosine of the two half-angles together, and whether these are more than half a turn.
            Spread::Cap(axis, cosine) => {
                let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                let reach = cosine * cone.cosine - sine * cone.sine;
                sine * cone.cosine + cosine * cone.sine <= 0.0 || axis.dot(cone.axis) >= reach
            }
            Spread::Cosine(normal) => normal.dot(cone.axis) >= -cone.sine,
        }
    }
}

/// A ball as it is seen from outside.
#[derive(Clone, Copy)]
struct Cone {
    ball: Ball,
    axis: DVec3,
    /// Of the half-angle.
    sine: f64,
    cosine: f64,
}

impl Cone {
    const NONE: Cone =
        Cone { ball: Ball { center: DVec3::ZERO, reach: 0.0 }, axis: DVec3::Z, sine: 0.0, cosine: 1.0 };

    /// None from inside.
    fn of(ball: &Ball, from: DVec3) -> Option<Cone> {
        let to = ball.center - from;
        let distance = to.length();
        if !(distance > ball.reach) {
            return None;
        }
        let sine = ball.reach / distance;
        Some(Cone { ball: *ball, axis: to / distance, sine, cosine: (1.0 - sine * sine).sqrt() })
    }

    /// 1 less the cosine, with all digits of small ones.
    fn height(&self) -> f64 {
        self.sine * self.sine / (1.0 + self.cosine)
    }
}

impl Aim {
    /// A direction from a place by u in (0, 1)², and what is sent that way, as if it were all, where the spread sends 1 per steradian and share.
    /// None for a direction that is not wanted.
    pub(super) fn direction(&self, from: DVec3, spread: &Spread, u: DVec2) -> Option<(DVec3, f64)> {
        match self {
            Aim::Anything(_) => Some((spread.choose(u), spread.whole())),
            Aim::At(targets) => targets.direction(from, spread, u),
        }
    }

    /// A place by u in (0, 1)² from which light from afar starts, against the unit vector `toward`, and the area that it stands for. None for
    /// one that is not wanted.
    pub(super) fn start(&self, toward: DVec3, u: DVec2) -> Option<(DVec3, f64)> {
        match self {
            Aim::Anything(ball) => {
                Some((ball.center + toward * (2.0 * ball.reach) + across(ball, toward, u), disc(ball)))
            }
            Aim::At(targets) => {
                let (place, area) = targets.place(toward, u)?;
                let world = &targets.world;
                let outward = 2.0 * world.reach - (place - world.center).dot(toward);
                Some((place + toward * outward, area))
            }
        }
    }
}

impl Targets {
    /// See [`Aim::direction`].
    fn direction(&self, from: DVec3, spread: &Spread, u: DVec2) -> Option<(DVec3, f64)> {
        let mut cones = Cones { of: [Cone::NONE; MOST], n: 0, height: 0.0 };
        for ball in &self.balls {
            match Cone::of(ball, from) {
                Some(cone) => cones.add(cone, spread),
                // From inside, every way is wanted.
                None => return Some((spread.choose(u), spread.whole())),
            }
        }
        let (height, solid_angle) = (cones.height, TAU * cones.height);
        let cones = &cones.of[..cones.n];
        if solid_angle >= spread.whole() {
            let direction = spread.choose(u);
            return holds(cones, from, direction).then(|| (direction, spread.whole()));
        }
        let (i, u) = pick(cones.iter().map(Cone::height), height, u)?;
        let direction = to_frame(cones[i].axis, cap(u, cones[i].height()));
        let is_first = !holds(&cones[..i], from, direction);
        is_first.then(|| (direction, solid_angle * spread.share(direction)))
    }

    /// A place of all discs that the targets are across `toward`, and the area of all together.
    fn place(&self, toward: DVec3, u: DVec2) -> Option<(DVec3, f64)> {
        let area: f64 = self.balls.iter().map(disc).sum();
        let meets = |balls: &[Ball], place| balls.iter().any(|ball| is_met(ball, place, toward));
        if area >= disc(&self.world) {
            let place = self.world.center + across(&self.world, toward, u);
            return meets(&self.balls, place).then(|| (place, disc(&self.world)));
        }
        let (i, u) = pick(self.balls.iter().map(disc), area, u)?;
        let place = self.balls[i].center + across(&self.balls[i], toward, u);
        let is_first = !meets(&self.balls[..i], place);
        is_first.then_some((place, area))
    }
}

/// The cones of some targets.
struct Cones {
    of: [Cone; MOST],
    n: usize,
    /// The sum of their heights.
    height: f64,
}

impl Cones {
    /// One more, if a spread sends anything into it.
    fn add(&mut self, cone: Cone, spread: &Spread) {
        if spread.may_meet(&cone) {
            self.height += cone.height();
            self.of[self.n] = cone;
            self.n += 1;
        }
    }
}

/// Whether one of some cones holds a direction.
fn holds(cones: &[Cone], from: DVec3, direction: DVec3) -> bool {
    cones.iter().any(|cone| direction.dot(cone.axis) > 0.0 && is_met(&cone.ball, from, direction))
}

/// Whether a line meets a ball.
fn is_met(ball: &Ball, origin: DVec3, direction: DVec3) -> bool {
    let to = ball.center - origin;
    (to - direction * to.dot(direction)).length_squared() <= ball.reach * ball.reach
}

/// The part that u.x falls on of what has these sizes, and `whole` together; and u once more within it.
fn pick(sizes: impl Iterator<Item = f64>, whole: f64, u: DVec2) -> Option<(usize, DVec2)> {
    let at = u.x * whole;
    let (mut before, mut chosen) = (0.0, None);
    for (i, size) in sizes.enumerate().filter(|(_, size)| *size > 0.0) {
        chosen = Some((i, DVec2::new(((at - before) / size).clamp(0.0, 1.0), u.y)));
        before += size;
        if at < before {
            break;
        }
    }
    chosen
}

/// The area of a ball as it is seen from afar.
fn disc(ball: &Ball) -> f64 {
    PI * ball.reach * ball.reach
}

/// From a ball's centre to a place of its disc across a direction, all alike.
fn across(ball: &Ball, direction: DVec3, u: DVec2) -> DVec3 {
    let ((s, c), r) = (sin_cos_turns(u.y), ball.reach * u.x.sqrt());
    let (a, b) = frame(direction);
    a * (r * c) + b * (r * s)
}

/// A unit vector of a cap about z, all alike; `height` is 1 less the least cosine.
pub(super) fn cap(u: DVec2, height: f64) -> DVec3 {
    let ((s, c), below) = (sin_cos_turns(u.y), height * u.x);
    let r = (below * (2.0 - below)).max(0.0).sqrt();
    DVec3::new(r * c, r * s, 1.0 - below)
}
