//! How much each bone moves each point.
//!
//! **Smooth** weights are Franke and Little's modification of Shepard's inverse distances (Franke 1982, "Scattered data interpolation"):
//! with dⱼ the distance from the point to bone j and R the distance to the nearest bone that has no say any more, wⱼ ∝ (1/dⱼ − 1/R)⁴. A bone
//! thus loses all weight before it leaves the nearest few, so that weights are continuous; a point on a bone is moved by it alone.

use crate::geometry::skeleton::Bone;
use crate::math::elementary::powi;
use glam::DVec3;

/// The distance of a point from a bone.
fn distance(bone: &Bone, p: DVec3) -> f64 {
    let (along, to) = (bone.end - bone.start, p - bone.start);
    let square = along.length_squared();
    let share = if square > 0.0 { (to.dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (to - along * share).length()
}

/// Weights of points, row by row; those of a row add up to 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Influences {
    ends: Vec<u32>,
    bones: Vec<u16>,
    weights: Vec<f64>,
}

/// Why a row of weights cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WeightError {
    /// Below 0, or no number.
    #[error("a weight is {0}")]
    Negative(f64),
    /// All 0.
    #[error("all its weights are 0")]
    NoWeight,
    /// More weights than joints.
    #[error("it has {given} weights for {joints} joints")]
    TooMany {
        /// Weights.
        given: usize,
        /// Joints.
        joints: usize,
    },
}

/// The power of [`Influences::smooth`].
const FALLOFF: i32 = 4;

/// Weights within this of a sum of 1 are as good as exact: a file's own rounding to f32, for a dozen of them.
pub const SUM_SLACK: f64 = 12.0 * f32::EPSILON as f64;

impl Influences {
    /// The joints that move point `k`, and by how much.
    pub fn of(&self, k: usize) -> (&[u16], &[f64]) {
        let start = if k == 0 { 0 } else { self.ends[k - 1] as usize };
        let row = start..self.ends[k] as usize;
        (&self.bones[row.clone()], &self.weights[row])
    }

    /// How many points have a row.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether no point has one.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Adds a row from weights by joint, of which those of 0 are left out and the rest are made to add up to 1. Gives the sum as it was.
    pub fn push(&mut self, row: impl IntoIterator<Item = (u16, f64)>) -> Result<f64, WeightError> {
        let start = self.weights.len();
        for (bone, weight) in row {
            if !(weight >= 0.0 && weight.is_finite()) {
                self.bones.truncate(start);
                self.weights.truncate(start);
                return Err(WeightError::Negative(weight));
            }
            if weight > 0.0 {
                self.bones.push(bone);
                self.weights.push(weight);
            }
        }
        let sum: f64 = self.weights[start..].iter().sum();
        if sum == 0.0 {
            return Err(WeightError::NoWeight);
        }
        self.weights[start..].iter_mut().for_each(|w| *w /= sum);
        self.ends.push(self.weights.len() as u32);
        Ok(sum)
    }

    /// Each point wholly by the nearest bone; of equally near ones by the first.
    pub fn rigid(points: &[DVec3], bones: &[Bone]) -> Influences {
        let mut all = Influences::default();
        for p in points {
            let nearest =
                bones.iter().map(|b| (distance(b, *p), b.joint)).reduce(|a, b| if b.0 < a.0 { b } else { a });
            all.bones.extend(nearest.map(|(_, joint)| joint as u16));
            all.weights.extend(nearest.map(|_| 1.0));
            all.ends.push(all.weights.len() as u32);
        }
        all
    }

    /// Each point by at most `most` joints, the nearer the more; see the module. Needs `most` ≥ 1.
    pub fn smooth(points: &[DVec3], bones: &[Bone], most: usize) -> Influences {
        let mut all = Influences::default();
        let n_joints = bones.iter().map(|b| b.joint + 1).max().unwrap_or(0);
        let mut near: Vec<(f64, u16)> = Vec::with_capacity(n_joints);
        let mut distances = vec![f64::INFINITY; n_joints];
        for p in points {
            distances.fill(f64::INFINITY);
            for bone in bones {
                let d = &mut distances[bone.joint];
                *d = d.min(distance(bone, *p));
            }
            near.clear();
            let finite = distances.iter().enumerate().filter(|(_, d)| d.is_finite());
            near.extend(finite.map(|(joint, d)| (*d, joint as u16)));
            near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            all.push_near(&near, most);
        }
        all
    }

    /// Adds a row from joints by growing distance.
    fn push_near(&mut self, near: &[(f64, u16)], most: usize) {
        let start = self.weights.len();
        let beyond = near.get(most).map_or(f64::INFINITY, |(d, _)| *d);
        let nearest = near.first().map_or(0.0, |(d, _)| *d);
        for (d, joint) in near.iter().take(most) {
            // Relative to the nearest, so that no power overflows; joints as near as the nearest where that is 0 or as far as all share.
            let weight = match () {
                () if nearest == 0.0 || beyond == nearest => f64::from(u8::from(*d == nearest)),
                () => powi(nearest / d - nearest / beyond, FALLOFF),
            };
            if weight > 0.0 {
                self.bones.push(*joint);
                self.weights.push(weight);
            }
        }
        let sum: f64 = self.weights[start..].iter().sum();
        self.weights[start..].iter_mut().for_each(|w| *w /= sum);
        self.ends.push(self.weights.len() as u32);
    }
}
