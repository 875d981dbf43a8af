//! Skeletons and poses as scenes hold them. What they are for given coordinates is computed once, where they are made.

use crate::diag::Span;
use crate::geometry::skeleton::{Placement, Skeleton};
use std::sync::Arc;

/// A skeleton.
#[derive(Debug, PartialEq)]
pub struct Rig {
    /// Its joints and tips.
    pub skeleton: Skeleton,
    /// Where they are at rest.
    pub rest: Placement,
    /// What it does over time, where it was read from motion capture.
    pub motion: Option<Motion>,
    /// Where it is written.
    pub span: Span,
}

/// Motion capture: coordinates at equal steps of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Seconds from a frame to the next; above 0.
    pub step: f64,
    /// For each frame all coordinates of the skeleton, author's units; at least one frame.
    pub frames: Vec<Vec<f64>>,
    /// For each coordinate, whether it is an angle.
    pub turns: Vec<bool>,
}

/// A skeleton with coordinates of its own.
#[derive(Debug, PartialEq)]
pub struct Pose {
    /// The skeleton.
    pub rig: Arc<Rig>,
    /// One for each of the skeleton's, author's units.
    pub coordinates: Vec<f64>,
    /// Where joints are.
    pub placement: Placement,
    /// How it was found, where it reaches for something.
    pub reach: Option<Reach>,
    /// Where it is written.
    pub span: Span,
}

/// How a reach ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Reach {
    /// The largest distance of a tip from its target, scene units.
    pub residual: f64,
    /// Steps made.
    pub iterations: usize,
    /// Whether all targets are reached within the tolerance.
    pub converged: bool,
}

/// A skeleton or pose that a scene names.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its name.
    pub name: String,
    /// What it is.
    pub stance: Stance,
}

/// A skeleton at rest or in a pose.
#[derive(Clone, Debug, PartialEq)]
pub enum Stance {
    /// At rest.
    Rest(Arc<Rig>),
    /// In a pose.
    Posed(Arc<Pose>),
}

impl Rig {
    /// About how many bytes it takes in memory.
    pub fn bytes(&self) -> usize {
        let frames = self.motion.as_ref().map_or(0, |motion| motion.frames.len());
        size_of::<Rig>()
            + size_of_val(self.skeleton.joints())
            + size_of_val(self.skeleton.motions())
            + frames * (size_of::<Vec<f64>>() + size_of_val(self.skeleton.rest()))
            + placement_bytes(&self.rest)
    }

    /// A skeleton with its rest pose computed.
    pub fn new(skeleton: Skeleton, motion: Option<Motion>, span: Span) -> Rig {
        Rig { rest: Placement::new(&skeleton, skeleton.rest()), skeleton, motion, span }
    }
}

fn placement_bytes(placement: &Placement) -> usize {
    size_of_val(&placement.frames[..]) + size_of_val(&placement.screws[..])
}

impl Pose {
    /// About how many bytes it takes in memory beside its skeleton.
    pub fn bytes(&self) -> usize {
        size_of::<Pose>() + size_of_val(&self.coordinates[..]) + placement_bytes(&self.placement)
    }

    /// A skeleton at these coordinates.
    pub fn new(rig: Arc<Rig>, coordinates: Vec<f64>, reach: Option<Reach>, span: Span) -> Pose {
        Pose { placement: Placement::new(&rig.skeleton, &coordinates), rig, coordinates, reach, span }
    }
}

impl Stance {
    /// The skeleton.
    pub fn rig(&self) -> &Arc<Rig> {
        match self {
            Stance::Rest(rig) => rig,
            Stance::Posed(pose) => &pose.rig,
        }
    }

    /// Its coordinates, author's units.
    pub fn coordinates(&self) -> &[f64] {
        match self {
            Stance::Rest(rig) => rig.skeleton.rest(),
            Stance::Posed(pose) => &pose.coordinates,
        }
    }

    /// Where its joints are.
    pub fn placement(&self) -> &Placement {
        match self {
            Stance::Rest(rig) => &rig.rest,
            Stance::Posed(pose) => &pose.placement,
        }
    }

    /// How it was found, where it reaches for something.
    pub fn reach(&self) -> Option<&Reach> {
        match self {
            Stance::Rest(_) => None,
            Stance::Posed(pose) => pose.reach.as_ref(),
        }
    }

    /// Where it is written.
    pub fn span(&self) -> Span {
        match self {
            Stance::Rest(rig) => rig.span,
            Stance::Posed(pose) => pose.span,
        }
    }
}

impl Motion {
    /// Its length, seconds; 0 of a single frame.
    pub fn duration(&self) -> f64 {
        (self.frames.len() - 1) as f64 * self.step
    }

    /// The coordinates at a moment. Between two frames each coordinate runs straight from one to the other, an angle the shorter way
    /// round; before the first and after the last frame it stands still.
    pub fn at(&self, seconds: f64) -> Vec<f64> {
        let last = self.frames.len() - 1;
        let place = (seconds / self.step).clamp(0.0, last as f64);
        let (frame, share) = (place.floor() as usize, place.fract());
        let (from, to) = (&self.frames[frame], &self.frames[(frame + 1).min(last)]);
        let between = |(k, (a, b)): (usize, (&f64, &f64))| {
            let way = if self.turns[k] { shorter_way(b - a) } else { b - a };
            a + share * way
        };
        from.iter().zip(to).enumerate().map(between).collect()
    }
}

/// A difference of angles in degrees brought to −180 … 180.
fn shorter_way(degrees: f64) -> f64 {
    degrees - 360.0 * (degrees / 360.0).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_runs_the_shorter_way_and_stands_still_outside() {
        let frames = vec![vec![1.0, 170.0], vec![3.0, -170.0], vec![3.0, 10.0]];
        let motion = Motion { step: 0.5, frames, turns: vec![false, true] };
        assert_eq!(motion.duration(), 1.0);
        assert_eq!(motion.at(0.25), [2.0, 180.0]);
        assert_eq!(motion.at(0.5), [3.0, -170.0]);
        assert_eq!(motion.at(-1.0), [1.0, 170.0]);
        assert_eq!(motion.at(99.0), [3.0, 10.0]);
    }
}
