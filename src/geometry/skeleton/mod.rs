//! Skeletons: joints with what each may do, and tips at the ends. Where they are for given coordinates is in [`forward`], how tips
//! move with them in [`jacobian`]. Knows nothing of reaching and of skins.
//!
//! Coordinates are kept in the author's units (degrees of turns, scene units of moves), so that a given angle or a limit is held to the
//! last bit. Every joint's motions are a product T(offset)·M₁·M₂·…: M₁ is the outermost and sees none of the others.

pub mod forward;
pub mod jacobian;
#[cfg(test)]
mod tests;

pub use forward::{Bone, Placement};

use glam::DVec3;

/// What a joint may do.
#[derive(Clone, Debug, PartialEq)]
pub enum Freedom {
    /// Nothing.
    Fixed,
    /// Turns about an axis.
    Hinge(DVec3),
    /// Turns about the first axis, and about the second within it.
    Universal(DVec3, DVec3),
    /// Turns by angles x, y, z: about x, then y, then z, as `rotate <x, y, z>` does.
    Ball,
    /// Moves along an axis.
    Slide(DVec3),
    /// Moves along x, y, z, then turns as a ball does: six coordinates in this order.
    Free,
    /// Any motions, outermost first: channels of motion capture.
    Channels(Vec<(Turning, DVec3)>),
}

/// Whether a motion turns or moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// By degrees, counterclockwise seen against the axis.
    Turn,
    /// By scene units.
    Move,
}

/// One motion of a joint: one coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// What it does.
    pub turning: Turning,
    /// Unit, in the frame of the motions outside it.
    pub axis: DVec3,
    /// Which coordinate drives it.
    pub coordinate: usize,
    /// Whose it is.
    pub joint: usize,
}

/// Least and most of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// At least.
    pub low: f64,
    /// At most.
    pub high: f64,
}

impl Limits {
    /// No limits.
    pub const NONE: Limits = Limits { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// Whether a value is within them, ends included.
    pub fn hold(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// A joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The author's name.
    pub name: String,
    /// The joint it hangs on; smaller than its own index.
    pub parent: Option<usize>,
    /// From the joint above, in that joint's frame.
    pub offset: DVec3,
    /// What it may do.
    pub freedom: Freedom,
    /// Its first coordinate.
    first: usize,
    n_coordinates: usize,
    first_motion: usize,
}

impl Joint {
    /// Its coordinates among the skeleton's.
    pub fn coordinates(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.n_coordinates
    }

    /// Its motions among the skeleton's, outermost first.
    pub fn motions(&self) -> std::ops::Range<usize> {
        self.first_motion..self.first_motion + self.n_coordinates
    }
}

/// The end of a chain: a point that moves with a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Tip {
    /// The author's name.
    pub name: String,
    /// The joint it moves with.
    pub joint: usize,
    /// In that joint's frame.
    pub offset: DVec3,
}

/// Joints, parents before children, and tips. Built joint by joint; see [`Skeleton::add_joint`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skeleton {
    joints: Vec<Joint>,
    tips: Vec<Tip>,
    motions: Vec<Motion>,
    rest: Vec<f64>,
    limits: Vec<Limits>,
}

impl Freedom {
    /// Its motions, outermost first, each with the place of its coordinate among the joint's.
    fn motions(&self) -> Vec<(Turning, DVec3, usize)> {
        use Turning::{Move, Turn};
        let ball = |first: usize| {
            [(Turn, DVec3::Z, first + 2), (Turn, DVec3::Y, first + 1), (Turn, DVec3::X, first)]
        };
        match self {
            Freedom::Fixed => Vec::new(),
            Freedom::Hinge(axis) => vec![(Turn, *axis, 0)],
            Freedom::Universal(outer, inner) => vec![(Turn, *outer, 0), (Turn, *inner, 1)],
            Freedom::Ball => ball(0).to_vec(),
            Freedom::Slide(axis) => vec![(Move, *axis, 0)],
            Freedom::Free => {
                let moves = [(Move, DVec3::X, 0), (Move, DVec3::Y, 1), (Move, DVec3::Z, 2)];
                moves.into_iter().chain(ball(3)).collect()
            }
            Freedom::Channels(channels) => {
                channels.iter().enumerate().map(|(k, (turning, axis))| (*turning, *axis, k)).collect()
            }
        }
    }

    /// How many coordinates it has.
    pub fn n_coordinates(&self) -> usize {
        self.motions().len()
    }

    /// Whether each coordinate turns or moves, in order.
    pub fn turnings(&self) -> Vec<Turning> {
        let mut motions = self.motions();
        motions.sort_by_key(|(_, _, coordinate)| *coordinate);
        motions.into_iter().map(|(turning, ..)| turning).collect()
    }
}

impl Skeleton {
    /// Hangs a joint on another (which is there already), or adds a root, and gives its index. Axes need not be unit, but not 0. `rest`
    /// and `limits` have one entry for each coordinate.
    pub fn add_joint(
        &mut self,
        name: &str,
        parent: Option<usize>,
        offset: DVec3,
        freedom: Freedom,
        rest: &[f64],
        limits: &[Limits],
    ) -> usize {
        let (index, first, first_motion) = (self.joints.len(), self.rest.len(), self.motions.len());
        let motions = freedom.motions();
        let n_coordinates = motions.len();
        assert!(
            rest.len() == n_coordinates && limits.len() == n_coordinates,
            "one entry for each coordinate"
        );
        assert!(parent.is_none_or(|parent| parent < index), "parents come before children");
        self.motions.extend(motions.into_iter().map(|(turning, axis, coordinate)| Motion {
            turning,
            axis: axis.normalize(),
            coordinate: first + coordinate,
            joint: index,
        }));
        self.rest.extend_from_slice(rest);
        self.limits.extend_from_slice(limits);
        self.joints.push(Joint {
            name: name.into(),
            parent,
            offset,
            freedom,
            first,
            n_coordinates,
            first_motion,
        });
        index
    }

    /// Fixes a tip to a joint, and gives its index.
    pub fn add_tip(&mut self, name: &str, joint: usize, offset: DVec3) -> usize {
        self.tips.push(Tip { name: name.into(), joint, offset });
        self.tips.len() - 1
    }

    /// The joints, parents before children.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The tips.
    pub fn tips(&self) -> &[Tip] {
        &self.tips
    }

    /// All motions, in the order of the joints.
    pub fn motions(&self) -> &[Motion] {
        &self.motions
    }

    /// A joint's coordinates of one sort, as its author gives them: in order, those of a ball, of a free joint and of channels by their
    /// axes x, y, z.
    pub fn coordinates_of(&self, joint: usize, turning: Turning) -> Vec<usize> {
        let joint = &self.joints[joint];
        let mut motions: Vec<&Motion> =
            self.motions[joint.motions()].iter().filter(|m| m.turning == turning).collect();
        match joint.freedom {
            Freedom::Channels(_) => motions.sort_by_key(|m| m.axis.abs().max_position()),
            _ => motions.sort_by_key(|m| m.coordinate),
        }
        motions.into_iter().map(|m| m.coordinate).collect()
    }

    /// The coordinates at rest.
    pub fn rest(&self) -> &[f64] {
        &self.rest
    }

    /// The limits of each coordinate.
    pub fn limits(&self) -> &[Limits] {
        &self.limits
    }

    /// The joint of this name.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// The tip of this name.
    pub fn tip(&self, name: &str) -> Option<usize> {
        self.tips.iter().position(|tip| tip.name == name)
    }

    /// A joint and all it hangs on, the root first.
    pub fn chain(&self, joint: usize) -> Vec<usize> {
        let mut chain: Vec<usize> =
            std::iter::successors(Some(joint), |&joint| self.joints[joint].parent).collect();
        chain.reverse();
        chain
    }

    /// Where a tip points: the unit vector from its joint to it, in the joint's frame; where it sits in the joint, along the joint's own
    /// offset; where that is 0 too, along z.
    pub fn pointing(&self, tip: usize) -> DVec3 {
        let Tip { joint, offset, .. } = &self.tips[tip];
        [*offset, self.joints[*joint].offset].into_iter().find_map(super::mesh::unit).unwrap_or(DVec3::Z)
    }
}
