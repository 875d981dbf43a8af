//! From where each patch and skin of a scene is seen, through all its placements: what its tolerance follows from.

use crate::math::{Aabb, Affine};
use crate::scene::{LightSource, Node, Object, Shape};
use crate::world::Footprint;
use crate::world::kept::Content;
use std::collections::HashMap;
use std::sync::Arc;

/// Most placements that are looked at. Patches in groups of groups of … beyond are drawn directly, which asks for no tolerance.
const MOST_PLACEMENTS: usize = 1 << 20;
/// Views that a tolerance may follow piece by piece; of more, the finest decides for all pieces.
const MOST_VIEWS: usize = 8;

/// How a patch is seen.
#[derive(Clone, Debug)]
pub(super) struct Views(Vec<Footprint>);

impl Views {
    /// The smallest pixel near a box.
    pub fn pixel(&self, near: Aabb) -> f64 {
        self.0.iter().map(|view| view.at(near)).fold(f64::INFINITY, f64::min)
    }

    /// Writes what a tolerance follows from.
    pub fn write(&self, content: &mut Content) {
        content.word(self.0.len());
        for Footprint { eye, per_distance, constant } in &self.0 {
            content.point(*eye);
            content.numbers([*per_distance, *constant]);
        }
    }

    /// The same views, few enough to be asked again and again for parts of a box.
    pub fn settled(self, whole: Aabb) -> Views {
        if self.0.len() <= MOST_VIEWS {
            return self;
        }
        let constant = self.pixel(whole);
        Views(vec![Footprint { eye: whole.center(), per_distance: 0.0, constant }])
    }
}

/// The views of every surface and skin of some nodes, by its address. One that is missing was not reached.
pub(super) fn survey(nodes: &[Node], camera: &Footprint) -> HashMap<*const (), Views> {
    let mut walk = Walk { holds: HashMap::new(), views: HashMap::new(), visited: 0 };
    if !walk.holds_patch(nodes) {
        return HashMap::new();
    }
    walk.paths(nodes, camera);
    if walk.visited > MOST_PLACEMENTS { HashMap::new() } else { walk.views }
}

struct Walk {
    /// Whether a group holds a patch anywhere, by the address of its first node.
    holds: HashMap<*const Node, bool>,
    views: HashMap<*const (), Views>,
    visited: usize,
}

impl Walk {
    /// Looks into each group once, with a stack of its own, since scenes may nest deeply.
    fn holds_patch(&mut self, nodes: &[Node]) -> bool {
        let mut stack = vec![(nodes.iter(), nodes.as_ptr(), false)];
        let mut last = false;
        while let Some((rest, group, holds)) = stack.last_mut() {
            let Some(node) = rest.next() else {
                last = *holds;
                self.holds.insert(*group, last);
                stack.pop();
                if let Some((_, _, around)) = stack.last_mut() {
                    *around |= last;
                }
                continue;
            };
            match object_of(node).map(|object| &object.shape) {
                Some(Shape::Surface(_) | Shape::Skin(_)) => *holds = true,
                Some(Shape::Group(inside)) => match self.holds.get(&inside.as_ptr()) {
                    Some(known) => *holds |= *known,
                    None => stack.push((inside.iter(), inside.as_ptr(), false)),
                },
                _ => {}
            }
        }
        last
    }

    /// Follows every placement of what holds patches, down to each of them.
    fn paths(&mut self, nodes: &[Node], camera: &Footprint) {
        let mut stack = vec![(nodes.iter(), None::<Affine>)];
        while let Some((rest, around)) = stack.last_mut() {
            let Some(node) = rest.next() else {
                stack.pop();
                continue;
            };
            self.visited += 1;
            if self.visited > MOST_PLACEMENTS {
                return;
            }
            let Some(object) = object_of(node) else { continue };
            let is_followed = match &object.shape {
                Shape::Surface(_) | Shape::Skin(_) => true,
                Shape::Group(inside) => self.holds.get(&inside.as_ptr()) == Some(&true),
                _ => false,
            };
            if !is_followed {
                continue;
            }
            let place = placed(node, object, around.as_ref());
            match &object.shape {
                Shape::Surface(surface) => self.seen(Arc::as_ptr(surface).cast(), place, camera),
                Shape::Skin(skin) => self.seen(Arc::as_ptr(skin).cast(), place, camera),
                Shape::Group(inside) => stack.push((inside.iter(), place)),
                _ => {}
            }
        }
    }

    fn seen(&mut self, address: *const (), place: Option<Affine>, camera: &Footprint) {
        let view = place.map_or(*camera, |place| camera.through(&place));
        self.views.entry(address).or_insert(Views(Vec::new())).0.push(view);
    }
}

fn object_of(node: &Node) -> Option<&Object> {
    match node {
        Node::Object(object) => Some(object),
        Node::Light(light) => match &light.source {
            LightSource::Area { object, .. } => Some(object),
            _ => None,
        },
    }
}

/// From an object's own space to the world's.
fn placed(node: &Node, object: &Object, around: Option<&Affine>) -> Option<Affine> {
    let light = match node {
        Node::Light(light) => light.transform.as_deref(),
        Node::Object(_) => None,
    };
    [object.transform.as_deref(), light, around]
        .into_iter()
        .flatten()
        .copied()
        .reduce(|inner, outer| inner.then(&outer))
}
