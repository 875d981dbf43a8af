//! Skins of a file: which nodes are joints, what they do to a surface, and how much each moves each vertex.

use super::accessor::{Elements, Numbers};
use super::nodes::{Place, Tree};
use super::primitive::{attribute, of_count};
use crate::geometry::skeleton::Bone;
use crate::geometry::skin::weights::SUM_SLACK;
use crate::geometry::skin::{Influences, Motion};
use crate::math::Affine;
use crate::scene::Armature;
use glam::DMat3;
use gltf::json::accessor::Type;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::{Root, Skin};
use std::sync::Arc;

/// The joints of a skin where the nodes stand at `places`. At rest they are where its inverse bind matrices say.
pub(super) fn armature(
    root: &Root,
    numbers: &Numbers<'_>,
    index: usize,
    tree: &Tree,
    places: &[Place],
) -> Result<Armature, String> {
    let skin = root.skins.get(index).ok_or_else(|| format!("skin {index} does not exist"))?;
    let named = |why: String| format!("skin {index}: {why}");
    let joints = joints(skin, tree).map_err(named)?;
    let inverse_binds = inverse_binds(skin, numbers, joints.len()).map_err(named)?;
    let names = joints.iter().map(|joint| tree.nodes[*joint].name.as_str().into()).collect();
    let motions = joints.iter().zip(&inverse_binds).map(|(joint, inverse)| motion(&places[*joint], inverse));
    Ok(Armature { names, bones: bones(&joints, tree, &inverse_binds), motions: motions.collect() })
}

/// The numbers of the nodes that are a skin's joints.
pub(super) fn joints(skin: &Skin, tree: &Tree) -> Result<Vec<usize>, String> {
    let joints: Vec<usize> = skin.joints.iter().map(|joint| joint.value()).collect();
    if joints.is_empty() || joints.len() > usize::from(u16::MAX) {
        return Err(format!("it has {} joints", joints.len()));
    }
    match joints.iter().find(|joint| **joint >= tree.nodes.len()) {
        Some(missing) => Err(format!("joint {missing} is no node")),
        None => Ok(joints),
    }
}

/// One for each joint; the identity where the file has none.
fn inverse_binds(skin: &Skin, numbers: &Numbers<'_>, count: usize) -> Result<Vec<Place>, String> {
    let Some(index) = skin.inverse_bind_matrices else { return Ok(vec![Place::IDENTITY; count]) };
    let given = numbers.elements(index, &[Type::Mat4])?;
    if given.count() < count {
        return Err(format!("it has {} inverse bind matrices for {count} joints", given.count()));
    }
    let place = |(i, m): (usize, [f64; 16])| {
        Place::of_matrix(&with_last_row(m)).ok_or_else(|| format!("inverse bind matrix {i} is not affine"))
    };
    given.each().take(count).enumerate().map(place).collect()
}

/// A matrix whose last row is 0, 0, 0, 1 but for rounding, with exactly that: products of exporters are a little off.
fn with_last_row(mut m: [f64; 16]) -> [f64; 16] {
    let rounding = 8.0 * f64::from(f32::EPSILON);
    let last = [(3, 0.0), (7, 0.0), (11, 0.0), (15, 1.0)];
    if last.iter().all(|(k, x)| (m[*k] - x).abs() <= rounding) {
        last.iter().for_each(|(k, x)| m[*k] = *x);
    }
    m
}

/// What a joint does: from where its bind matrix put it to where it is.
fn motion(place: &Place, inverse_bind: &Place) -> Motion {
    match inverse_bind.affine() {
        Some(inverse) => Motion::new(&inverse.inverse(), &without_inverse(place)),
        None => Motion::new(&Affine::IDENTITY, &without_inverse(&inverse_bind.within(place))),
    }
}

/// A place as a map of which nobody asks the inverse: of a pose a [`Motion`] needs none, and a joint may be scaled to nothing.
fn without_inverse(place: &Place) -> Affine {
    let (linear, translation) = (place.linear, place.origin);
    Affine { linear, translation, inverse_linear: DMat3::ZERO, inverse_translation: -place.origin }
}

/// From each joint to those that hang on it, where the bind matrices put them.
fn bones(joints: &[usize], tree: &Tree, inverse_binds: &[Place]) -> Vec<Bone> {
    let at = |joint: usize| inverse_binds[joint].affine().map(|m| m.inverse_translation);
    let above = |joint: usize| {
        let parent = tree.nodes[joints[joint]].parent?;
        joints.iter().position(|node| *node == parent)
    };
    let mut bones = Vec::new();
    for end in 0..joints.len() {
        if let Some(start) = above(end)
            && let (Some(from), Some(to)) = (at(start), at(end))
        {
            bones.push(Bone { joint: start, start: from, end: to });
        }
    }
    Bone::add_bare(&mut bones, joints.len(), at);
    bones
}

/// Weights of vertices, and how many of their rows were mended.
#[derive(Debug)]
pub(super) struct Weighted {
    pub rows: Arc<Influences>,
    /// Rows that did not add up to 1, and were divided by their sums.
    pub off: usize,
    /// Rows without any weight, which follow the skin's first joint.
    pub bare: usize,
}

/// The weights of a primitive of so many vertices, of all its sets; none where it has none.
pub(super) fn weights(
    from: &Primitive,
    numbers: &Numbers<'_>,
    n_vertices: usize,
    n_joints: usize,
) -> Result<Option<Weighted>, String> {
    let sets = sets(from, numbers, n_vertices)?;
    if sets.is_empty() {
        return Ok(None);
    }
    let slack = SUM_SLACK + sets.iter().map(|set| 4.0 * set.weights.quantum).sum::<f64>();
    let mut rows = Influences::default();
    let (mut off, mut bare) = (0, 0);
    for vertex in 0..n_vertices {
        let mut row: Vec<(u32, f64)> = sets.iter().flat_map(|set| set.of(vertex)).collect();
        if let Some((joint, _)) = row.iter().find(|(joint, _)| *joint as usize >= n_joints) {
            return Err(format!("vertex {vertex} follows joint {joint}, but its skin has {n_joints}"));
        }
        if row.is_empty() {
            bare += 1;
            row.push((0, 1.0));
        }
        // Fewer joints than 2^16, as was checked where the skin was read.
        let sum = rows.push(row.iter().map(|(joint, weight)| (*joint as u16, *weight)));
        let sum = sum.map_err(|why| format!("the weights of vertex {vertex} cannot be used: {why}"))?;
        off += usize::from((sum - 1.0).abs() > slack);
    }
    Ok(Some(Weighted { rows: Arc::new(rows), off, bare }))
}

/// Four joints for each vertex, and how much each moves it.
struct Set {
    joints: Vec<u32>,
    weights: Elements,
}

impl Set {
    /// The joints that move a vertex.
    fn of(&self, vertex: usize) -> impl Iterator<Item = (u32, f64)> {
        let at = 4 * vertex..4 * vertex + 4;
        let joints = self.joints[at.clone()].iter().copied();
        joints.zip(self.weights.values[at].iter().copied()).filter(|(_, weight)| *weight != 0.0)
    }
}

/// JOINTS_0 with WEIGHTS_0, and those after them.
fn sets(from: &Primitive, numbers: &Numbers<'_>, n_vertices: usize) -> Result<Vec<Set>, String> {
    let mut sets = Vec::new();
    for set in 0.. {
        let of = |semantic| attribute(from, semantic);
        let (joints, weights) = match (of(Semantic::Joints(set)), of(Semantic::Weights(set))) {
            (Some(joints), Some(weights)) => (joints, weights),
            (None, None) => break,
            _ => return Err(format!("it has only one of JOINTS_{set} and WEIGHTS_{set}")),
        };
        let joints = numbers.whole(joints, &[Type::Vec4])?;
        let weights = numbers.elements(weights, &[Type::Vec4])?;
        of_count("joint numbers", joints.len() / 4, n_vertices)?;
        of_count("weights", weights.count(), n_vertices)?;
        sets.push(Set { joints, weights });
    }
    Ok(sets)
}
