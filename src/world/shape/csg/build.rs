//! From a tree of parts to the flat form that rays walk.

use super::{Csg, Leaf, Operation, Place, Solid, Tally};
use crate::diag::Span;
use crate::math::{Aabb, Affine};
use crate::scene::CsgOp;
use crate::world::bvh::Tree;
use crate::world::shape::EVERYTHING;

/// Up to so many parts are asked one by one: a walk down a tree takes a ray longer than ten boxes.
const FEW: usize = 4;

/// Something to be put together.
pub enum Part {
    /// A solid: what it is, its transform to the space of the whole, its material's number, where it was written.
    Solid(Solid, Option<Box<Affine>>, u32, Span),
    /// Several, put together: how, whether inside and outside are exchanged, and what.
    Whole(CsgOp, bool, Vec<Part>),
}

impl Csg {
    /// Puts parts together.
    pub fn new(op: CsgOp, inverse: bool, parts: Vec<Part>) -> Csg {
        let mut csg = Csg {
            operations: Vec::new(),
            outside: Vec::new(),
            parts: Vec::new(),
            tree: Tree::default(),
            boxes: Box::default(),
            bounds: Aabb::EMPTY,
        };
        csg.bounds = csg.add_whole(op, inverse, parts, Place { of: None, is_first: false }, false);
        csg.outside = csg.tallies_outside();
        csg.tree = Tree::build(csg.parts.len(), |i| csg.parts[i].bounds());
        if csg.parts.len() <= FEW {
            let holds_all = |b: &Aabb| b.min.cmple(csg.bounds.min).all() && b.max.cmpge(csg.bounds.max).all();
            let boxes = csg.parts.iter().map(Leaf::bounds);
            csg.boxes = boxes.map(|part| (!holds_all(&part)).then_some(part)).collect();
        }
        csg
    }

    /// Adds what is put together; gives the box around it.
    fn add_whole(&mut self, op: CsgOp, inverse: bool, parts: Vec<Part>, place: Place, flipped: bool) -> Aabb {
        let number = self.operations.len() as u32;
        let count = parts.len() as u32;
        self.operations.push(Operation { op, inverse, place, count });
        let mut bounds = None;
        for (i, part) in parts.into_iter().enumerate() {
            let place = Place { of: Some(number), is_first: i == 0 };
            let removes = op == CsgOp::Difference && i > 0;
            let of_part = self.add(part, place, flipped != (inverse != removes));
            bounds = Some(match (op, bounds) {
                (_, None) => of_part,
                (CsgOp::Union, Some(so_far)) => of_part.union(so_far),
                (CsgOp::Intersection, Some(so_far)) => overlap(so_far, of_part),
                (CsgOp::Difference, Some(first)) => first,
            });
        }
        if inverse { EVERYTHING } else { bounds.unwrap_or(Aabb::EMPTY) }
    }

    fn add(&mut self, part: Part, place: Place, flipped: bool) -> Aabb {
        match part {
            Part::Whole(op, inverse, parts) => self.add_whole(op, inverse, parts, place, flipped),
            Part::Solid(solid, transform, material, span) => {
                let transform = transform.map(|t| *t);
                let leaf = Leaf { solid, transform, material, span, place, flipped };
                let bounds = leaf.bounds();
                self.parts.push(leaf);
                bounds
            }
        }
    }

    /// What each operation counts outside of all parts: inverses hold there.
    fn tallies_outside(&self) -> Vec<Tally> {
        let mut tallies = vec![Tally::default(); self.operations.len()];
        for i in (0..self.operations.len()).rev() {
            let operation = &self.operations[i];
            if let (true, Some(around)) = (operation.holds(tallies[i]), operation.place.of) {
                let tally = &mut tallies[around as usize];
                self.operations[around as usize].count(tally, operation.place.is_first, true);
            }
        }
        tallies
    }
}

/// The box that both hold; empty where there is none.
fn overlap(a: Aabb, b: Aabb) -> Aabb {
    let both = Aabb { min: a.min.max(b.min), max: a.max.min(b.max) };
    if both.is_empty() { Aabb::EMPTY } else { both }
}
