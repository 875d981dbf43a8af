//! What may be put together with solids, and what is said of what may not.

use super::{MeshSource, Node, Object, Shape, Surface};
use crate::diag::{Code, Diagnostic, Span};

/// Why a node is no solid; none where it is one, or a group of which each member is asked on its own, or a mesh whose file tells.
pub fn solid_fault(node: &Node) -> Option<Diagnostic> {
    let object = match node {
        Node::Object(object) => object,
        Node::Light(light) => {
            let message = "a light is no solid";
            let hint = "place it beside the block that puts solids together";
            return Some(Diagnostic::new(Code::NotSolid, light.span, message).hint(hint));
        }
    };
    match &object.shape {
        Shape::Sphere { .. } | Shape::Plane { .. } | Shape::Box(_) | Shape::Cone(_) | Shape::Torus(_) => None,
        Shape::Group(_) | Shape::Csg(_) | Shape::Implicit(_) => None,
        Shape::Mesh(mesh) => match &**mesh {
            MeshSource::Inline(mesh) if !mesh.is_closed() => Some(open_mesh(object.span)),
            MeshSource::Inline(_) | MeshSource::File { .. } => None,
        },
        Shape::Disc(_) => Some(flat(object, "disc", "write a flat `cylinder` instead")),
        Shape::Rect(_) => Some(flat(object, "rect", "write a flat `box` instead")),
        Shape::Triangle(_) => Some(flat(object, "triangle", "write a closed `mesh` instead")),
        Shape::Surface(surface) if surface.is_solid() => None,
        Shape::Surface(surface) => Some(open_surface(surface, object.span)),
        Shape::Model(_) => Some(flat(
            object,
            "model",
            "a closed `mesh` has an inside; the parts of a model are not put together",
        )),
        Shape::Skin(_) => {
            Some(flat(object, "skin", "put the solids together first, out of parts that do not bend"))
        }
    }
}

/// That a mesh has open edges.
pub fn open_mesh(span: Span) -> Diagnostic {
    Diagnostic::new(Code::NotSolid, span, "this mesh is not closed, so that it has no inside")
        .hint("a closed mesh has two faces at each edge: look for holes, and for faces that are given twice")
}

/// That a curved surface has open edges.
fn open_surface(surface: &Surface, span: Span) -> Diagnostic {
    let message = format!("this {} is not closed, so that it has no inside", surface.word());
    let hint = match surface {
        Surface::Tube(_) => "leave `caps open` away, or write `caps flat`",
        Surface::Lathe(_) => "begin and end its profile on the axis, or close it",
        Surface::Patch(_) | Surface::Extrude(_) => {
            "a closed `mesh`, `lathe`, `tube` or `extrude` has an inside"
        }
    };
    Diagnostic::new(Code::NotSolid, span, message).hint(hint)
}

fn flat(object: &Object, kind: &str, hint: &str) -> Diagnostic {
    let message = format!("a {kind} has no inside, and only solids are put together");
    let half = "to cut along its plane use a `plane`, which is solid below";
    Diagnostic::new(Code::NotSolid, object.span, message).hint(hint).hint(half)
}
