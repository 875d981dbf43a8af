//! A file's nodes as a skeleton of ours.
//!
//! Every node is a joint. Its frame at rest has the axes of the model and no turn of its own: angles are 0 as the model stands, and turn it
//! about the model's x, y and z, which a person can read off the picture. What a pose does to a joint's frame, it does to the node: its
//! place is moved rigidly, and keeps whatever scale and shear it has. The joints are thus exactly where the nodes are, in any pose, also
//! where nodes are scaled unevenly. (Where all scales are even this is what turning the nodes themselves does.)
//!
//! Nodes that are joints of a skin turn as balls, in a file without skins all do; the rest are fixed. Each has a tip where it is, so that it
//! can reach for things: `hand_tip` of the joint `hand`.

use super::nodes::{Place, Tree};
use crate::geometry::skeleton::{Freedom, Limits, Placement, Skeleton};
use crate::scene::assets::names::Names;
use glam::DVec3;

/// The skeleton of nodes that stand at these places. `turns` says of each node whether it does. Joints have the numbers of
/// [`Tree::order`].
pub fn skeleton(tree: &Tree, places: &[Place], turns: &[bool], names: &mut Names<'_>) -> Skeleton {
    let mut skeleton = Skeleton::default();
    let mut joint_of = vec![0; tree.nodes.len()];
    for &node in &tree.order {
        let parent = tree.nodes[node].parent;
        let above = parent.map_or(DVec3::ZERO, |parent| places[parent].origin);
        let offset = places[node].origin - above;
        let name = names.fit(&tree.nodes[node].name);
        let freedom = if turns[node] { Freedom::Ball } else { Freedom::Fixed };
        let n = freedom.n_coordinates();
        let parent_joint = parent.map(|parent| joint_of[parent]);
        joint_of[node] =
            skeleton.add_joint(&name, parent_joint, offset, freedom, &vec![0.0; n], &vec![Limits::NONE; n]);
    }
    for &node in &tree.order {
        let joint = joint_of[node];
        let name = names.fit(&format!("{}_tip", skeleton.joints()[joint].name));
        skeleton.add_tip(&name, joint, DVec3::ZERO);
    }
    skeleton
}

/// Where nodes are in a pose of their skeleton that are at `places` at rest.
pub fn posed(tree: &Tree, places: &[Place], skeleton: &Skeleton, coordinates: &[f64]) -> Vec<Place> {
    let rest = Placement::new(skeleton, skeleton.rest());
    let pose = Placement::new(skeleton, coordinates);
    let mut posed = places.to_vec();
    for (joint, &node) in tree.order.iter().enumerate() {
        let (from, to) = (rest.frames[joint], pose.frames[joint]);
        let turn = to.turn * from.turn.transpose();
        let own = &places[node];
        posed[node] =
            Place { linear: turn * own.linear, origin: turn * (own.origin - from.origin) + to.origin };
    }
    posed
}
