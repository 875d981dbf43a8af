//! Clips: what moves nodes over time.

use super::accessor::Numbers;
use super::nodes::{Local, Stance, Tree, unit};
use crate::math::elementary::{atan2, sin_cos};
use glam::{DMat4, DQuat, DVec3};
use gltf::json::Root;
use gltf::json::accessor::Type;
use gltf::json::animation::{Animation, Channel, Interpolation, Property};
use gltf::json::validation::Checked;

/// A clip.
#[derive(Clone, Debug, Default)]
pub struct Clip {
    tracks: Vec<Track>,
    /// When its last key is, in seconds.
    pub duration: f64,
    /// Whether it has channels that are not read: those of morph targets.
    pub is_partial: bool,
}

/// What one property of one node does.
#[derive(Clone, Debug)]
struct Track {
    node: usize,
    property: Property,
    interpolation: Interpolation,
    /// Seconds, growing; at least one.
    times: Vec<f64>,
    /// One for each time, or with cubic interpolation three: the slope in, the value, the slope out.
    values: Vec<f64>,
}

/// The names of a file's clips; "clip 0" where one has none.
pub(super) fn names(root: &Root) -> Vec<String> {
    let name = |(i, clip): (usize, &Animation)| clip.name.clone().unwrap_or_else(|| format!("clip {i}"));
    root.animations.iter().enumerate().map(name).collect()
}

/// A clip by number, which is one of the file's.
pub(super) fn read(root: &Root, numbers: &Numbers<'_>, index: usize) -> Result<Clip, String> {
    let from = &root.animations[index];
    let mut clip = Clip::default();
    for (i, channel) in from.channels.iter().enumerate() {
        match track(root, numbers, from, channel)
            .map_err(|why| format!("channel {i} of clip {index}: {why}"))?
        {
            Some(track) => clip.tracks.push(track),
            None => clip.is_partial = true,
        }
    }
    clip.duration = clip.tracks.iter().map(|t| t.times[t.times.len() - 1]).fold(0.0, f64::max);
    Ok(clip)
}

/// A channel; none for one that moves no node.
fn track(
    root: &Root,
    numbers: &Numbers<'_>,
    from: &Animation,
    channel: &Channel,
) -> Result<Option<Track>, String> {
    let Checked::Valid(property) = channel.target.path else {
        return Err("it moves what is not known".into());
    };
    let node = channel.target.node.value();
    if node >= root.nodes.len() {
        return Err(format!("there is no node {node}"));
    }
    let kind = match property {
        Property::MorphTargetWeights => return Ok(None),
        Property::Rotation => Type::Vec4,
        Property::Translation | Property::Scale => Type::Vec3,
    };
    let sampler = from.samplers.get(channel.sampler.value()).ok_or("its sampler does not exist")?;
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return Err("its interpolation is not known".into());
    };
    let times = numbers.elements(sampler.input, &[Type::Scalar])?.values;
    let values = numbers.elements(sampler.output, &[kind])?;
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if times.is_empty() || values.count() != times.len() * per_key {
        return Err(format!("it has {} values for {} times", values.count(), times.len()));
    }
    if !times.is_sorted() {
        return Err("its times do not grow".into());
    }
    Ok(Some(Track { node, property, interpolation, times, values: values.values }))
}

impl Clip {
    /// How the nodes stand at a moment, in seconds. Before its first key and after its last one each stands still.
    pub fn pose(&self, tree: &Tree, seconds: f64) -> Vec<Local> {
        let mut locals = tree.locals();
        for track in &self.tracks {
            let mut stance = parts(&locals[track.node]);
            match track.property {
                Property::Translation => stance.translation = DVec3::from(track.at(seconds)),
                Property::Scale => stance.scale = DVec3::from(track.at(seconds)),
                Property::Rotation => stance.rotation = track.rotation(seconds).unwrap_or(stance.rotation),
                Property::MorphTargetWeights => {}
            }
            locals[track.node] = Local::Parts(stance);
        }
        locals
    }
}

/// The parts of a node's place. Of a matrix those that are nearest: the format moves none that is written so.
fn parts(local: &Local) -> Stance {
    match local {
        Local::Parts(stance) => *stance,
        Local::Matrix(place) => {
            let matrix = DMat4::from_translation(place.origin) * DMat4::from_mat3(place.linear);
            let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
            Stance { translation, rotation: unit(rotation).unwrap_or(DQuat::IDENTITY), scale }
        }
    }
}

/// Between two keys.
struct Between {
    before: usize,
    /// 0 at the key before, 1 at the one after.
    share: f64,
    /// Seconds between the two.
    step: f64,
}

impl Track {
    fn between(&self, seconds: f64) -> Between {
        let after = self.times.partition_point(|t| *t <= seconds);
        let last = self.times.len() - 1;
        if after == 0 || after > last {
            return Between { before: if after == 0 { 0 } else { last }, share: 0.0, step: 0.0 };
        }
        let step = self.times[after] - self.times[after - 1];
        Between { before: after - 1, share: (seconds - self.times[after - 1]) / step, step }
    }

    /// Numbers of a key; of three with cubic interpolation.
    fn key<const N: usize>(&self, key: usize, part: usize) -> [f64; N] {
        let per_key = if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let start = (key * per_key + part) * N;
        std::array::from_fn(|k| self.values[start + k])
    }

    /// The value at a moment, number by number.
    fn at<const N: usize>(&self, seconds: f64) -> [f64; N] {
        let Between { before, share, step } = self.between(seconds);
        let value = if self.interpolation == Interpolation::CubicSpline { 1 } else { 0 };
        let a: [f64; N] = self.key(before, value);
        if share == 0.0 || self.interpolation == Interpolation::Step {
            return a;
        }
        let b: [f64; N] = self.key(before + 1, value);
        if self.interpolation == Interpolation::Linear {
            return std::array::from_fn(|k| a[k] + share * (b[k] - a[k]));
        }
        let (out, into): ([f64; N], [f64; N]) = (self.key(before, 2), self.key(before + 1, 0));
        std::array::from_fn(|k| hermite(share, a[k], step * out[k], b[k], step * into[k]))
    }

    /// The rotation at a moment; none where interpolation leaves none.
    fn rotation(&self, seconds: f64) -> Option<DQuat> {
        if self.interpolation != Interpolation::Linear {
            return unit(DQuat::from_array(self.at(seconds)));
        }
        let Between { before, share, .. } = self.between(seconds);
        let a = unit(DQuat::from_array(self.key(before, 0)))?;
        if share == 0.0 {
            return Some(a);
        }
        Some(slerp(a, unit(DQuat::from_array(self.key(before + 1, 0)))?, share))
    }
}

/// Cubic Hermite interpolation of a value.
fn hermite(s: f64, a: f64, slope_a: f64, b: f64, slope_b: f64) -> f64 {
    let (s2, s3) = (s * s, s * s * s);
    let from_a = (2.0 * s3 - 3.0 * s2 + 1.0) * a + (s3 - 2.0 * s2 + s) * slope_a;
    from_a + (3.0 * s2 - 2.0 * s3) * b + (s3 - s2) * slope_b
}

/// From a rotation to another the shorter way at even speed (Shoemake 1985): in the plane of a and of what of b is across it, so that
/// neither near nor opposite rotations are divided by what is small.
fn slerp(a: DQuat, b: DQuat, share: f64) -> DQuat {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    let along = a.dot(b);
    let across = b - a * along;
    let length = across.length();
    if length == 0.0 {
        return a;
    }
    let (s, c) = sin_cos(share * atan2(length, along));
    (a * c + across * (s / length)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(interpolation: Interpolation, property: Property, values: &[f64]) -> Track {
        let times = vec![1.0, 3.0];
        Track { node: 0, property, interpolation, times, values: values.to_vec() }
    }

    #[test]
    fn steps_lines_and_cubics_are_those_of_the_format() {
        let (a, b) = ([0.0, 1.0, 2.0], [4.0, 1.0, 0.0]);
        let step = track(Interpolation::Step, Property::Scale, &[a, b].concat());
        assert_eq!([step.at(0.0), step.at(1.0), step.at(2.9), step.at(3.0), step.at(9.0)], [a, a, a, b, b]);
        let line = track(Interpolation::Linear, Property::Scale, &[a, b].concat());
        assert_eq!([line.at(-5.0), line.at(1.5), line.at(3.0)], [a, [1.0, 1.0, 1.5], b]);
        // t² from 1 to 3 and its slopes, which a cubic keeps.
        let squares = [[0.0; 3], [1.0; 3], [2.0; 3], [6.0; 3], [9.0; 3], [0.0; 3]].concat();
        let cubic = track(Interpolation::CubicSpline, Property::Scale, &squares);
        for t in [1.0, 1.25, 2.0, 2.5, 3.0] {
            let [x, ..]: [f64; 3] = cubic.at(t);
            assert!((x - t * t).abs() < 1e-14, "{t}: {x}");
        }
        assert_eq!(cubic.at(0.0), [1.0; 3]);
    }

    #[test]
    fn rotations_go_the_shorter_way_at_even_speed() {
        let turn = |degrees: f64| DQuat::from_rotation_z(degrees.to_radians());
        for (from, to) in [(0.0, 90.0), (0.0, 1e-9), (10.0, 179.0), (0.0, 180.0), (5.0, 5.0)] {
            for flipped in [1.0, -1.0] {
                let keys = [turn(from).to_array(), (turn(to) * flipped).to_array()].concat();
                let track = track(Interpolation::Linear, Property::Rotation, &keys);
                let quarter = track.rotation(1.5).unwrap();
                let expected = turn(from + 0.25 * (to - from));
                assert!(quarter.dot(expected).abs() > 1.0 - 1e-15, "{from} {to}: {quarter} {expected}");
            }
        }
        let opposite =
            track(Interpolation::Linear, Property::Rotation, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(opposite.rotation(2.0), None);
    }
}
