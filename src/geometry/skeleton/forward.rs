//! Forward kinematics: P_world = T(offset)·M₁·M₂·…·P_local, down the chain.

use super::{Skeleton, Turning};
use crate::math::Affine;
use glam::{DMat3, DVec3};

/// Where a joint's frame stands: turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// 3 × 3, orthonormal columns: the frame's axes in the world.
    pub turn: DMat3,
    /// The frame's origin in the world.
    pub origin: DVec3,
}

impl Frame {
    const WORLD: Frame = Frame { turn: DMat3::IDENTITY, origin: DVec3::ZERO };

    /// Where a point of the frame is in the world.
    pub fn point(&self, local: DVec3) -> DVec3 {
        self.turn * local + self.origin
    }

    /// world_from_joint, its inverse by the transpose.
    pub fn affine(&self) -> Affine {
        let inverse_linear = self.turn.transpose();
        Affine {
            linear: self.turn,
            translation: self.origin,
            inverse_linear,
            inverse_translation: -(inverse_linear * self.origin),
        }
    }
}

/// A motion's axis as it stands in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screw {
    /// Unit.
    pub axis: DVec3,
    /// A point on it.
    pub pivot: DVec3,
}

/// A skeleton at some coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placement {
    /// For each joint its frame, all its motions made.
    pub frames: Vec<Frame>,
    /// For each motion its axis, the motions outside it made.
    pub screws: Vec<Screw>,
}

/// A straight part of a skeleton: from a joint to a joint or tip that hangs on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bone {
    /// Whose motions move it.
    pub joint: usize,
    /// Where that joint is.
    pub start: DVec3,
    /// Where it leads.
    pub end: DVec3,
}

impl Bone {
    /// Adds a bone without length for each of so many joints that no bone begins at, where it is known where the joint is.
    pub fn add_bare(bones: &mut Vec<Bone>, n_joints: usize, at: impl Fn(usize) -> Option<DVec3>) {
        let mut is_bare = vec![true; n_joints];
        bones.iter().for_each(|bone| is_bare[bone.joint] = false);
        let bare = (0..n_joints).filter(|joint| is_bare[*joint]);
        bones.extend(bare.filter_map(|joint| at(joint).map(|p| Bone { joint, start: p, end: p })));
    }
}

impl Placement {
    /// Of a skeleton at these coordinates (one for each of the skeleton's).
    pub fn new(skeleton: &Skeleton, coordinates: &[f64]) -> Placement {
        let mut placement = Placement::default();
        placement.update(skeleton, coordinates);
        placement
    }

    /// The same in the memory that is there.
    pub fn update(&mut self, skeleton: &Skeleton, coordinates: &[f64]) {
        self.frames.clear();
        self.screws.clear();
        for joint in &skeleton.joints {
            let above = joint.parent.map_or(Frame::WORLD, |parent| self.frames[parent]);
            let mut frame = Frame { origin: above.point(joint.offset), ..above };
            for motion in &skeleton.motions[joint.motions()] {
                self.screws.push(Screw { axis: frame.turn * motion.axis, pivot: frame.origin });
                let amount = coordinates[motion.coordinate];
                match motion.turning {
                    Turning::Turn => frame.turn *= Affine::rotate(motion.axis, amount).linear,
                    Turning::Move => frame.origin += frame.turn * motion.axis * amount,
                }
            }
            self.frames.push(frame);
        }
    }

    /// Where a joint is.
    pub fn joint(&self, joint: usize) -> DVec3 {
        self.frames[joint].origin
    }

    /// Where a tip is.
    pub fn tip(&self, skeleton: &Skeleton, tip: usize) -> DVec3 {
        let tip = &skeleton.tips[tip];
        self.frames[tip.joint].point(tip.offset)
    }

    /// world_from_joint for each joint.
    pub fn affines(&self) -> Vec<Affine> {
        self.frames.iter().map(Frame::affine).collect()
    }

    /// A bone for each joint that hangs on another, then one for each tip, then one without length for each joint on which nothing hangs.
    pub fn bones(&self, skeleton: &Skeleton) -> Vec<Bone> {
        let bone = |joint: usize, end| Bone { joint, start: self.joint(joint), end };
        let of_joints = skeleton.joints.iter().zip(&self.frames);
        let between = of_joints.filter_map(|(joint, frame)| Some(bone(joint.parent?, frame.origin)));
        let to_tips =
            skeleton.tips.iter().map(|tip| bone(tip.joint, self.frames[tip.joint].point(tip.offset)));
        let mut bones: Vec<Bone> = between.chain(to_tips).collect();
        Bone::add_bare(&mut bones, self.frames.len(), |joint| Some(self.joint(joint)));
        bones
    }
}
