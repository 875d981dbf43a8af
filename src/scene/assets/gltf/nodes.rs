//! The tree of a file's nodes: who hangs on whom, what is drawn, and where everything is.

use crate::math::Affine;
use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};
use gltf::json::{Node as FileNode, Root};

/// A map of a node's space to that of the node above. May flatten, so it carries no inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// 3 × 3, columns are the images of x, y and z.
    pub linear: DMat3,
    /// The image of the origin.
    pub origin: DVec3,
}

impl Place {
    /// The identity.
    pub const IDENTITY: Place = Place { linear: DMat3::IDENTITY, origin: DVec3::ZERO };

    /// This, seen from outside the space that `outer` places.
    #[must_use]
    pub fn within(&self, outer: &Place) -> Place {
        Place { linear: outer.linear * self.linear, origin: outer.linear * self.origin + outer.origin }
    }

    /// With its inverse; none where it flattens.
    pub fn affine(&self) -> Option<Affine> {
        Affine::from_columns(self.linear, self.origin)
    }

    /// A 4 × 4 matrix, column by column. None where it is not affine or not finite.
    pub(super) fn of_matrix(columns: &[f64; 16]) -> Option<Place> {
        let m = DMat4::from_cols_array(columns);
        let is_affine = m.is_finite() && m.row(3) == DVec4::W;
        is_affine.then(|| Place { linear: DMat3::from_mat4(m), origin: m.w_axis.truncate() })
    }
}

/// Where a node stands in the one above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// Moved last.
    pub translation: DVec3,
    /// Unit.
    pub rotation: DQuat,
    /// Made first.
    pub scale: DVec3,
}

impl Stance {
    /// Translation · rotation · scale.
    pub fn place(&self) -> Place {
        Place {
            linear: DMat3::from_quat(self.rotation) * DMat3::from_diagonal(self.scale),
            origin: self.translation,
        }
    }
}

/// How a file writes where a node stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Local {
    /// In parts, which clips may move.
    Parts(Stance),
    /// As a matrix.
    Matrix(Place),
}

impl Local {
    /// The map.
    pub fn place(&self) -> Place {
        match self {
            Local::Parts(stance) => stance.place(),
            Local::Matrix(place) => *place,
        }
    }
}

/// A node.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its name; "node 3" where it has none.
    pub name: String,
    /// On which it hangs.
    pub parent: Option<usize>,
    /// Where it stands by itself.
    pub local: Local,
    /// Whether it belongs to the scene that is drawn.
    pub drawn: bool,
}

/// All nodes by number.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// By their numbers in the file.
    pub nodes: Vec<Node>,
    /// Parents before children, and these in the order of the file.
    pub order: Vec<usize>,
}

impl Tree {
    /// Of a file; what hangs in a circle, on two nodes, or on nothing that is there, is refused.
    pub(super) fn new(root: &Root) -> Result<Tree, String> {
        let parents = parents(root)?;
        let order = order(root, &parents)?;
        let mut drawn = drawn_roots(root, &parents)?;
        for &node in &order {
            drawn[node] |= parents[node].is_some_and(|parent| drawn[parent]);
        }
        let made = root.nodes.iter().enumerate().map(|(i, from)| {
            let local = local(from).map_err(|why| format!("node {i} {why}"))?;
            let name = from.name.clone().unwrap_or_else(|| format!("node {i}"));
            Ok(Node { name, parent: parents[i], local, drawn: drawn[i] })
        });
        Ok(Tree { nodes: made.collect::<Result<_, String>>()?, order })
    }

    /// Where each node is, in the space of the model, if each stands as `locals` says.
    pub fn places(&self, locals: &[Local]) -> Vec<Place> {
        let mut places = vec![Place::IDENTITY; self.nodes.len()];
        for &node in &self.order {
            let own = locals[node].place();
            places[node] = self.nodes[node].parent.map_or(own, |parent| own.within(&places[parent]));
        }
        places
    }

    /// As the file has them.
    pub fn locals(&self) -> Vec<Local> {
        self.nodes.iter().map(|node| node.local).collect()
    }
}

fn children(node: &FileNode) -> impl Iterator<Item = usize> {
    node.children.iter().flatten().map(|child| child.value())
}

fn parents(root: &Root) -> Result<Vec<Option<usize>>, String> {
    let mut parents = vec![None; root.nodes.len()];
    for (parent, node) in root.nodes.iter().enumerate() {
        for child in children(node) {
            let slot = parents.get_mut(child);
            let slot = slot.ok_or_else(|| {
                format!("node {parent} has a child {child}, but there are {} nodes", root.nodes.len())
            })?;
            if let Some(other) = slot.replace(parent) {
                return Err(format!("node {child} hangs on two nodes, {other} and {parent}"));
            }
        }
    }
    Ok(parents)
}

/// From the roots down, with a stack of our own; what is never reached hangs in a circle.
fn order(root: &Root, parents: &[Option<usize>]) -> Result<Vec<usize>, String> {
    let mut stack: Vec<usize> = (0..parents.len()).rev().filter(|node| parents[*node].is_none()).collect();
    let mut order = Vec::with_capacity(parents.len());
    while let Some(node) = stack.pop() {
        order.push(node);
        let first = stack.len();
        stack.extend(children(&root.nodes[node]));
        stack[first..].reverse();
    }
    if order.len() == parents.len() {
        return Ok(order);
    }
    let mut reached = vec![false; parents.len()];
    order.iter().for_each(|node| reached[*node] = true);
    let lost = reached.iter().position(|reached| !reached).unwrap_or_default();
    Err(format!("node {lost} hangs in a circle of nodes"))
}

/// The roots of the scene: the file's own choice, the first, or where it has none all nodes that hang on none.
fn drawn_roots(root: &Root, parents: &[Option<usize>]) -> Result<Vec<bool>, String> {
    let scene = match (root.scene, root.scenes.first()) {
        (Some(index), _) => Some(root.scenes.get(index.value()).ok_or_else(|| {
            format!("it shows scene {}, but it has {} scenes", index.value(), root.scenes.len())
        })?),
        (None, first) => first,
    };
    let Some(scene) = scene else { return Ok(parents.iter().map(Option::is_none).collect()) };
    let mut drawn = vec![false; parents.len()];
    for node in &scene.nodes {
        let slot = drawn.get_mut(node.value());
        *slot.ok_or_else(|| {
            format!("its scene has a node {}, but there are {} nodes", node.value(), parents.len())
        })? = true;
    }
    Ok(drawn)
}

fn local(node: &FileNode) -> Result<Local, String> {
    if let Some(matrix) = &node.matrix {
        let place = Place::of_matrix(&matrix.map(f64::from));
        return place.map(Local::Matrix).ok_or("has a matrix that is not affine".into());
    }
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
    let stance = Stance {
        translation: node.translation.map_or(DVec3::ZERO, vector),
        rotation: unit(rotation).ok_or("has a rotation of no length")?,
        scale: node.scale.map_or(DVec3::ONE, vector),
    };
    let is_finite = stance.translation.is_finite() && stance.scale.is_finite();
    if is_finite { Ok(Local::Parts(stance)) } else { Err("is moved or scaled by what is not finite".into()) }
}

/// A rotation; none where the quaternion has no direction.
pub(super) fn unit(q: DQuat) -> Option<DQuat> {
    let unit = q.normalize();
    (q.is_finite() && unit.is_finite()).then_some(unit)
}
