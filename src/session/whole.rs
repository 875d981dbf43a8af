//! Faults of a scene as a whole: no camera, no light, nothing to see. Other renderers pass these in silence and show black.

use crate::diag::{Code, Diagnostic};
use crate::scene::{LightSource, Material, MeshSource, Node, Object, Scene, Shape, SkinSurface, Texture};
use std::collections::HashSet;
use std::sync::Arc;

/// What the scene lacks. `for_picture` says that a picture is asked for; otherwise a file that shows no sign of being
/// meant for one (no camera, no light, no `render` block: a library for others) lacks nothing.
pub fn faults(scene: &Scene, for_picture: bool) -> Vec<Diagnostic> {
    let survey = Survey::of(&scene.nodes);
    let is_picture = !scene.cameras.is_empty() || survey.lights || scene.render.span.is_some();
    if !for_picture && !is_picture {
        return Vec::new();
    }
    let mut found = Vec::new();
    if scene.cameras.is_empty() {
        found.push(
            Diagnostic::new(Code::NoCamera, None, "the scene has no camera")
                .hint("write `camera { eye <0, 1, 5>  look_at <0, 0, 0> }`"),
        );
    }
    if !survey.objects {
        found.push(
            Diagnostic::new(
                Code::NothingToSee,
                None,
                "the scene has no object: the picture shows the background alone",
            )
            .hint("a `let` only names its value; write the name as an item of its own to place it"),
        );
    } else if !survey.lights && !survey.shines {
        found.push(
            Diagnostic::new(Code::NoLight, None, "the scene has no light: all of it is black")
                .hint("write `light { sky 0.5 }` or `light { point <4, 6, 3>  intensity 60 }`"),
        );
    }
    found
}

/// What there is among a scene's nodes.
#[derive(Default)]
struct Survey {
    objects: bool,
    lights: bool,
    /// Something emits or has an ambient part, or may: the materials of a mesh file or model are not known here.
    shines: bool,
    seen: HashSet<*const [Node]>,
}

impl Survey {
    fn of(nodes: &[Node]) -> Self {
        let mut survey = Survey::default();
        survey.walk(nodes);
        survey
    }

    fn walk(&mut self, nodes: &[Node]) {
        for node in nodes {
            if self.objects && self.lights {
                return;
            }
            match node {
                Node::Light(light) => {
                    self.lights = true;
                    self.objects |= matches!(light.source, LightSource::Area { .. });
                }
                Node::Object(object) => self.visit(object),
            }
        }
    }

    fn visit(&mut self, object: &Object) {
        self.shines |= object.material.as_ref().is_some_and(shines);
        match &object.shape {
            Shape::Group(children) => {
                if self.seen.insert(Arc::as_ptr(children)) {
                    self.walk(children);
                }
            }
            Shape::Model(_) => (self.objects, self.shines) = (true, true),
            Shape::Skin(skin) => {
                self.objects = true;
                if let SkinSurface::Mesh(mesh) = &skin.surface {
                    self.shines |= matches!(**mesh, MeshSource::File { .. }) && object.material.is_none();
                }
            }
            Shape::Mesh(mesh) => {
                self.objects = true;
                self.shines |= matches!(**mesh, MeshSource::File { .. }) && object.material.is_none();
            }
            Shape::Sphere { .. } | Shape::Plane { .. } | Shape::Disc(_) | Shape::Rect(_) | Shape::Box(_) => {
                self.objects = true;
            }
            Shape::Cone(_) | Shape::Torus(_) | Shape::Triangle(_) => self.objects = true,
            Shape::Surface(_) | Shape::Implicit(_) => self.objects = true,
            Shape::Csg(csg) => {
                self.objects = true;
                if self.seen.insert(Arc::as_ptr(&csg.children)) {
                    self.walk(&csg.children);
                }
            }
        }
    }
}

fn shines(material: &Arc<Material>) -> bool {
    let gives = |texture: &Texture| match texture {
        Texture::Constant(colour) => *colour != crate::scene::Rgb::ZERO,
        Texture::Pattern(_) => true,
    };
    material.layers.as_ref().is_some_and(|layers| gives(&layers.emit) || gives(&layers.ambient))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{SourceId, Span};
    use crate::scene::{Layers, Rgb};
    use glam::DVec3;

    fn ball() -> Object {
        let span = Span::new(SourceId(0), 0, 0);
        Object::new(Shape::Sphere { center: DVec3::ZERO, radius: 1.0 }, span)
    }

    fn codes(scene: &Scene, for_picture: bool) -> Vec<&'static str> {
        faults(scene, for_picture).iter().map(|d| d.code.text()).collect()
    }

    #[test]
    fn a_picture_needs_a_camera_a_light_and_an_object() {
        let mut scene = Scene::default();
        assert_eq!(codes(&scene, true), ["E0601", "W0603"]);
        scene.nodes.push(Node::Object(Arc::new(ball())));
        assert_eq!(codes(&scene, true), ["E0601", "W0602"]);
        assert_eq!(codes(&scene, false), [""; 0], "a library needs nothing");
    }

    #[test]
    fn what_emits_is_light_enough_also_inside_a_group() {
        let span = Span::new(SourceId(0), 0, 0);
        let layers = Layers { emit: Texture::Constant(Rgb::ONE), ..Layers::DEFAULT };
        let material = Material { diffuse: Texture::ZERO, layers: Some(Box::new(layers)), span };
        let shining = Object { material: Some(Arc::new(material)), ..ball() };
        let group = Shape::Group(Arc::from([Node::Object(Arc::new(shining))]));
        let scene =
            Scene { nodes: vec![Node::Object(Arc::new(Object::new(group, span)))], ..Scene::default() };
        assert_eq!(codes(&scene, true), ["E0601"]);
    }
}
