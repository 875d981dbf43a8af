//! Solids put together: a tree of the scene's nodes to a tree of parts in one space.

use super::surfaces::Drawn;
use super::{Around, Lowering, shapes};
use crate::diag::{Code, Diagnostic, Span};
use crate::scene::{self, CsgOp, Node, Object, Shape, solid_fault};
use crate::world::aggregate::Aggregate;
use crate::world::kept::{Content, Of};
use crate::world::shape::csg::{Part, Solid};
use crate::world::shape::{self as world, Csg};
use std::collections::HashMap;
use std::sync::Arc;

/// Solids nested deeper than this are left out: the language allows no deeper groups.
const MAX_DEPTH: usize = 1024;

/// What was put together already, by the address of the scene's; that is kept so that no other takes its place. None where it
/// cannot be used, which is said once.
#[derive(Default)]
pub(super) struct Solids {
    by_address: HashMap<*const scene::Csg, (Option<Arc<Csg>>, Arc<scene::Csg>)>,
    implicits: HashMap<*const scene::Implicit, (Arc<world::Implicit>, Arc<scene::Implicit>)>,
    /// Whether a mesh is closed, by its aggregate.
    closed: HashMap<u32, bool>,
}

impl Lowering<'_> {
    /// The solid; none, said, where it cannot be made or where nothing is left of it.
    pub(super) fn csg(&mut self, csg: &Arc<scene::Csg>, span: Span) -> Option<Arc<Csg>> {
        if let Some((known, _)) = self.solids.by_address.get(&Arc::as_ptr(csg)) {
            return known.clone();
        }
        let made =
            self.parts(&csg.children, &Around::TOP, 0).map(|parts| Csg::new(csg.op, csg.inverse, parts));
        let made = made.filter(|made| self.has_points(made, csg, span)).map(Arc::new);
        self.solids.by_address.insert(Arc::as_ptr(csg), (made.clone(), Arc::clone(csg)));
        made
    }

    /// Says where nothing can be left.
    fn has_points(&mut self, made: &Csg, csg: &scene::Csg, span: Span) -> bool {
        let is_empty = made.bounds(None).is_empty();
        if is_empty && !csg.children.is_empty() {
            let message = format!("nothing is left of this {}", csg.op.word());
            let hint = "the boxes around its solids do not overlap: move them together";
            self.sink.push(Diagnostic::new(Code::EmptySolid, span, message).hint(hint));
        }
        !is_empty
    }

    fn parts(&mut self, nodes: &[Node], around: &Around, depth: usize) -> Option<Vec<Part>> {
        let parts: Vec<Option<Part>> = nodes.iter().map(|node| self.part(node, around, depth)).collect();
        parts.into_iter().collect()
    }

    fn part(&mut self, node: &Node, around: &Around, depth: usize) -> Option<Part> {
        if let Some(fault) = solid_fault(node) {
            self.sink.push(fault);
            return None;
        }
        let Node::Object(object) = node else { return None };
        if depth > MAX_DEPTH {
            let message = format!("solids are nested more than {MAX_DEPTH} deep");
            self.sink.push(Diagnostic::new(Code::BadGeometry, object.span, message));
            return None;
        }
        let inside = Around {
            transform: around.place(object.transform.clone()).map(|t| *t),
            material: object.material.clone().map_or(around.material, |m| self.materials.number(m)),
            ..around.clone()
        };
        match &object.shape {
            Shape::Group(nodes) => {
                Some(Part::Whole(CsgOp::Union, false, self.parts(nodes, &inside, depth + 1)?))
            }
            Shape::Csg(csg) => {
                Some(Part::Whole(csg.op, csg.inverse, self.parts(&csg.children, &inside, depth + 1)?))
            }
            _ => {
                let transform = inside.transform.map(Box::new);
                Some(Part::Solid(self.solid(object)?, transform, inside.material, object.span))
            }
        }
    }

    /// A shape on its own; none, said, where it is degenerate.
    pub(super) fn simple(&mut self, shape: Shape, span: Span) -> Option<world::Shape> {
        match shape {
            Shape::Implicit(implicit) => Some(world::Shape::Implicit(self.implicit(implicit))),
            other => shapes::convert(other)
                .map_err(|fault| self.sink.push(Diagnostic::new(Code::BadGeometry, span, fault)))
                .ok(),
        }
    }

    fn implicit(&mut self, implicit: Arc<scene::Implicit>) -> Arc<world::Implicit> {
        if let Some((known, _)) = self.solids.implicits.get(&Arc::as_ptr(&implicit)) {
            return Arc::clone(known);
        }
        let (min, max) = implicit.within;
        let steepest = implicit.gradient.map(|(bound, _)| bound);
        let content = self.kept.content(Of::Implicit, |content| {
            content.function(&implicit.function);
            content.points(&[min, max]);
            content.maybe(steepest, Content::number);
        });
        let made = self.kept.made(content.as_ref()).unwrap_or_else(|| {
            Arc::new(world::Implicit::new(Arc::clone(&implicit.function), min, max, steepest))
        });
        self.kept.keep(content, &made);
        if let (Some((bound, at)), Some((p, slope))) = (implicit.gradient, made.broken_promise()) {
            let place = p.to_array().map(|x| format!("{x:.3}")).join(", ");
            let message = format!("the gradient of `f` is {slope:.4} at <{place}>, more than {bound}");
            let hint = "leave `gradient` out: the surface is found without it";
            self.sink.push(Diagnostic::new(Code::BadProperty, at, message).hint(hint));
        }
        self.solids.implicits.insert(Arc::as_ptr(&implicit), (Arc::clone(&made), implicit));
        made
    }

    fn solid(&mut self, object: &Object) -> Option<Solid> {
        if let Shape::Surface(source) = &object.shape {
            return match self.surface(Arc::clone(source), object.span)? {
                Drawn::Shape(shape) => Some(Solid::Shape(shape)),
                Drawn::Mesh(_) => None,
            };
        }
        let Shape::Mesh(source) = &object.shape else {
            return self.simple(object.shape.clone(), object.span).map(Solid::Shape);
        };
        let number = self.mesh(Arc::clone(source), object.span)?;
        let Aggregate::Mesh(mesh) = &self.aggregates[number as usize] else { return None };
        let (shape, materials) = (Arc::clone(&mesh.shape), Arc::clone(&mesh.materials));
        if !*self.solids.closed.entry(number).or_insert_with(|| shape.mesh.is_closed()) {
            self.sink.push(scene::open_mesh(object.span));
            return None;
        }
        Some(Solid::Mesh(shape, materials))
    }
}

#[cfg(test)]
mod tests {
    use crate::diag::{SourceId, Span};
    use crate::math::field::{Binary, FieldBuilder};
    use crate::scene::assets::DiskLoader;
    use crate::scene::{self, Node, Object, SampledFunction};
    use crate::world::aggregate::{Aggregate, Item};
    use crate::world::shape::{Implicit, Shape};
    use crate::world::{World, WorldOptions};
    use glam::DVec3;
    use std::sync::Arc;

    /// x + y + z − offset, written anew.
    fn slant(offset: f64) -> Node {
        let mut builder = FieldBuilder::new(3);
        let [x, y, z] = [0, 1, 2].map(|i| builder.input(i));
        let offset = builder.constant(offset);
        let sum = builder.binary(Binary::Add, x, y);
        let sum = builder.binary(Binary::Add, sum, z);
        let slant = builder.binary(Binary::Sub, sum, offset);
        let function = Arc::new(SampledFunction::of_point(builder.finish(&[slant]).expect("small")));
        let implicit = scene::Implicit { function, within: (-DVec3::ONE, DVec3::ONE), gradient: None };
        let span = Span::new(SourceId(0), 0, 0);
        Node::Object(Arc::new(Object::new(scene::Shape::Implicit(Arc::new(implicit)), span)))
    }

    fn implicits(world: &World) -> Vec<Arc<Implicit>> {
        let Aggregate::Group(group) = &world.aggregates[0] else { return Vec::new() };
        let implicit = |item: &Item| match item {
            Item::Shape(Shape::Implicit(implicit), _) => Some(Arc::clone(implicit)),
            _ => None,
        };
        group.items.iter().filter_map(implicit).collect()
    }

    #[test]
    fn the_cells_of_a_formula_that_is_written_twice_are_made_once() {
        let nodes = [0.1, 0.1, 0.2].map(slant).to_vec();
        let (world, _) = World::new(nodes, &WorldOptions::default(), &DiskLoader);
        let made = implicits(&world);
        let same = |a: usize, b: usize| Arc::ptr_eq(&made[a], &made[b]);
        assert_eq!(made.len(), 3);
        assert_eq!([same(0, 1), same(1, 2), same(0, 2)].into_iter().filter(|same| *same).count(), 1);
        assert_eq!(world.stats().reused, 0, "no world was before");
    }
}
