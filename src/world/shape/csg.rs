//! Solids put together: what is inside any, all, or the first alone of several solids.
//!
//! A ray meets the parts one by one; their meetings are walked in order, each turning its part's inside to outside or back, and
//! those at which the inside of the whole turns are its surface. Nothing asks whether a point is inside: what lies ahead of a
//! ray decides where it starts ([`Shape::crossings`]), so that the walk is never at odds with what it meets.
//!
//! **Coincident faces.** Meetings of different parts that rounding cannot tell apart count as one, at which all turn at once:
//! two faces that are flush leave no wall inside a union, no lid on a difference, and belong to the part that is written first. A
//! ray that only touches a part does not turn it.

mod ball;
mod build;
#[cfg(test)]
mod tests;
mod walk;

pub use build::Part;

use super::mesh::MeshShape;
use super::{EVERYTHING, LocalRay, Meet, Shape, Surface, carry, image_of};
use crate::diag::Span;
use crate::math::error::gamma;
use crate::math::{Aabb, Affine};
use crate::scene::CsgOp;
use crate::world::bvh::Tree;
use crate::world::texture::TextureFault;
use glam::DVec3;
use std::sync::Arc;

/// Solids put together.
#[derive(Clone, Debug)]
pub struct Csg {
    /// How, the whole first, each before what it puts together.
    operations: Vec<Operation>,
    /// What each operation counts where a ray is outside all parts.
    outside: Vec<Tally>,
    parts: Vec<Leaf>,
    /// Over the parts.
    tree: Tree,
    /// Their boxes where these are so few that asking each takes less, else nothing; none of a part that whoever meets the whole's box meets too.
    boxes: Box<[Option<Aabb>]>,
    bounds: Aabb,
}

/// A solid that is put together with others.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// What it is.
    pub solid: Solid,
    /// To the space of the whole; none for the identity.
    pub transform: Option<Affine>,
    /// Its material by number, as an object of the world.
    pub material: u32,
    /// Where it was written.
    pub span: Span,
    /// The operation that it is part of, and whether it is the first there.
    place: Place,
    /// True where its outside is toward the inside of the whole.
    flipped: bool,
}

/// The geometry of a part.
#[derive(Clone, Debug)]
pub enum Solid {
    /// A closed shape or a plane.
    Shape(Shape),
    /// A closed mesh, and the numbers of its file's materials.
    Mesh(Arc<MeshShape>, Arc<[u32]>),
}

impl Solid {
    fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        match self {
            Solid::Shape(shape) => shape.crossings(ray, out),
            Solid::Mesh(mesh, _) => mesh.crossings(ray, out),
        }
    }

    fn starts_inside(&self, ray: &LocalRay, n_crossings: usize) -> bool {
        match self {
            Solid::Shape(shape) => shape.starts_inside(ray, n_crossings),
            Solid::Mesh(..) => n_crossings % 2 == 1,
        }
    }

    fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        match self {
            Solid::Shape(shape) => shape.surface(ray, meet),
            Solid::Mesh(mesh, _) => mesh.surface(meet.face, meet, true),
        }
    }

    fn bounds(&self, transform: Option<&Affine>) -> Aabb {
        match self {
            Solid::Shape(shape) => shape.bounds(transform),
            Solid::Mesh(mesh, _) if mesh.tree.is_unbounded() => EVERYTHING,
            Solid::Mesh(mesh, _) => {
                let local = mesh.tree.bounds();
                transform.map_or(local, |transform| image_of(local, transform))
            }
        }
    }
}

impl Leaf {
    /// A part in its own space.
    fn local(&self, ray: &LocalRay) -> Option<(LocalRay, f64)> {
        match &self.transform {
            None => Some((*ray, 1.0)),
            Some(transform) => ray.into_local(transform),
        }
    }

    fn bounds(&self) -> Aabb {
        self.solid.bounds(self.transform.as_ref())
    }
}

/// Where something stands among what is put together.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// The operation; none for the whole.
    of: Option<u32>,
    /// Whether it is the first there, from which a difference takes the others.
    is_first: bool,
}

/// A way of putting together.
#[derive(Clone, Debug)]
struct Operation {
    op: CsgOp,
    inverse: bool,
    place: Place,
    /// How many it puts together.
    count: u32,
}

/// How many of what an operation puts together a point is inside of; a difference counts its first apart.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    first: bool,
    inside: u32,
}

impl Operation {
    /// Whether the point is inside.
    fn holds(&self, tally: Tally) -> bool {
        let within = match self.op {
            CsgOp::Union => tally.inside > 0,
            CsgOp::Intersection => self.count > 0 && tally.inside == self.count,
            CsgOp::Difference => tally.first && tally.inside == 0,
        };
        within != self.inverse
    }

    /// Counts one that is entered or left.
    fn count(&self, tally: &mut Tally, is_first: bool, entered: bool) {
        if self.op == CsgOp::Difference && is_first {
            tally.first = entered;
        } else if entered {
            tally.inside += 1;
        } else {
            tally.inside -= 1;
        }
    }
}

/// A surface of a whole, and the point in the part's own space.
pub struct PartSurface {
    /// In the space of the whole; outward of the whole.
    pub whole: Surface,
    /// For patterns.
    pub own_point: DVec3,
}

/// Set in [`Meet::part`] where other parts met the ray at the same place up to rounding.
const COINCIDENT: u32 = 1 << 31;

impl Csg {
    /// The part that a meeting is of.
    pub fn part(&self, meet: &Meet) -> &Leaf {
        &self.parts[Csg::part_number(meet) as usize]
    }

    /// Its number.
    pub fn part_number(meet: &Meet) -> u32 {
        meet.part & !COINCIDENT
    }

    /// All parts.
    pub fn parts(&self) -> &[Leaf] {
        &self.parts
    }

    /// The part of this number.
    pub fn part_at(&self, number: u32) -> Option<&Leaf> {
        self.parts.get(number as usize)
    }

    /// The surface where a ray met it.
    pub fn surface(&self, ray: &LocalRay, meet: &Meet) -> PartSurface {
        let Some((mut surface, own_point)) = self.surface_of_part(ray, meet) else {
            unreachable!("a ray that met a part has a place in its space")
        };
        if meet.part & COINCIDENT != 0 {
            surface.error += DVec3::splat(self.spread(ray, meet, &surface));
        }
        PartSurface { whole: surface, own_point }
    }

    /// Why there is no surface at a meeting, where there is none.
    pub fn fault(&self, ray: &LocalRay, meet: &Meet) -> Option<TextureFault> {
        let part = self.part(meet);
        let Solid::Shape(shape) = &part.solid else { return None };
        let (local, factor) = part.local(ray)?;
        shape.fault(&local, &Meet { t: meet.t * factor, part: 0, ..*meet })
    }

    fn is_unknown(&self, meet: &Meet) -> bool {
        matches!(&self.part(meet).solid, Solid::Shape(shape) if shape.is_unknown(meet))
    }

    /// The surface of one part in the space of the whole, and the point in its own.
    fn surface_of_part(&self, ray: &LocalRay, meet: &Meet) -> Option<(Surface, DVec3)> {
        let part = self.part(meet);
        let (local, factor) = part.local(ray)?;
        let mut surface = part.solid.surface(&local, &Meet { t: meet.t * factor, part: 0, ..*meet });
        let own_point = surface.point;
        carry(&mut surface, part.transform.iter());
        if part.flipped {
            surface.geometric_normal = -surface.geometric_normal;
            surface.normal = -surface.normal;
        }
        Some((surface, own_point))
    }

    /// The box around it, in the space that `transform` maps to.
    pub fn bounds(&self, transform: Option<&Affine>) -> Aabb {
        match transform {
            Some(transform) if self.bounds != EVERYTHING && !self.bounds.is_empty() => {
                image_of(self.bounds, transform)
            }
            _ => self.bounds,
        }
    }
}

/// How far along a ray a surface may be from where it was met: its error across, over how steeply the ray goes through, and the
/// rounding of the distance.
fn doubt(ray: &LocalRay, t: f64, surface: &Surface) -> f64 {
    let n = surface.geometric_normal;
    n.abs().dot(surface.error) / n.dot(ray.direction).abs() + gamma(32) * reach(ray, t)
}

/// The size of the numbers that a distance was computed from.
fn reach(ray: &LocalRay, t: f64) -> f64 {
    t + ray.origin.abs().max_element()
}
