//! Balls around what a world holds, for light that is aimed at it. Knows nothing of lights.

use super::aggregate::{Aggregate, Group, INHERITED, Item, MeshAggregate};
use super::query::is_hidden;
use super::shape::Shape;
use super::shape::ball::{ball_around, image};
use super::shape::csg::{Leaf, Solid};
use super::{RayKind, World};
use crate::geometry::balls::Ball;
use crate::math::Affine;
use crate::scene::Material;

/// Placements are looked into for the balls of what they hold until there are so many; then each is one ball as a whole.
const MANY: usize = 1 << 16;

impl World {
    /// Around all that is bounded. Without reach where there is nothing of the kind.
    pub fn ball(&self) -> Ball {
        let bounds = self.bounds();
        let reach = bounds.size().length() / 2.0;
        match reach.is_finite() && reach > 0.0 {
            true => Ball { center: (bounds.min + bounds.max) / 2.0, reach },
            false => Ball { center: glam::DVec3::ZERO, reach: 0.0 },
        }
    }

    /// Balls that hold between them every place of a wanted material that a ray of a kind may meet: one of each shape, solid put
    /// together and mesh. None where one of them is infinite.
    pub fn balls_of(&self, kind: RayKind, wanted: impl Fn(&Material) -> bool) -> Option<Vec<Ball>> {
        let wanted: Vec<bool> = self.materials().map(wanted).collect();
        let holds = holding(&self.aggregates, &wanted);
        let mut gathering =
            Gathering { aggregates: &self.aggregates, kind, wanted, holds, balls: Vec::new() };
        let all = Place { transform: Affine::IDENTITY, material: super::lower::DEFAULT_MATERIAL };
        match &self.aggregates[0] {
            Aggregate::Group(group) => gathering.group(group, &all)?,
            Aggregate::Mesh(mesh) => gathering.mesh(mesh, false, &all)?,
        }
        Some(gathering.balls)
    }
}

/// For each aggregate, whether something of a wanted material is in it, whatever it inherits. Placed aggregates stand before those that
/// place them, except that the world is first.
fn holding(aggregates: &[Aggregate], wanted: &[bool]) -> Vec<bool> {
    let mut holds = vec![false; aggregates.len()];
    for i in (1..aggregates.len()).chain([0]) {
        holds[i] = match &aggregates[i] {
            Aggregate::Mesh(mesh) => mesh.materials.iter().any(|m| is(wanted, *m)),
            Aggregate::Group(group) => {
                let inside = |item: &Item| match item {
                    Item::Instance(instance) => holds[instance.aggregate as usize],
                    Item::Shape(Shape::Csg(csg), _) => csg.parts().iter().any(|part| part_is(wanted, part)),
                    Item::Shape(..) => false,
                };
                group.material.iter().any(|m| is(wanted, *m)) || group.items.iter().any(inside)
            }
        };
    }
    holds
}

/// Whether a material that is not inherited is wanted.
fn is(wanted: &[bool], material: u32) -> bool {
    material != INHERITED && wanted[material as usize]
}

/// Whether a part of a solid is of a wanted material of its own.
fn part_is(wanted: &[bool], part: &Leaf) -> bool {
    let of_mesh = match &part.solid {
        Solid::Mesh(_, materials) => materials.iter().any(|m| is(wanted, *m)),
        Solid::Shape(_) => false,
    };
    is(wanted, part.material) || of_mesh
}

struct Gathering<'a> {
    aggregates: &'a [Aggregate],
    kind: RayKind,
    wanted: Vec<bool>,
    holds: Vec<bool>,
    balls: Vec<Ball>,
}

/// Where an aggregate is placed, and the material that it inherits.
struct Place {
    transform: Affine,
    material: u32,
}

impl Gathering<'_> {
    /// None where something wanted has no bounds; so all below.
    fn group(&mut self, group: &Group, place: &Place) -> Option<()> {
        for (position, item) in group.items.iter().enumerate() {
            let number = group.number_of(position as u32) as usize;
            if group.hide.get(number).is_some_and(|hide| is_hidden(*hide, self.kind)) {
                continue;
            }
            let own = group.material[number];
            let material = if own == INHERITED { place.material } else { own };
            match item {
                Item::Shape(shape, transform) => {
                    if self.wanted[material as usize] || self.has_wanted_part(shape) {
                        let own = transform.as_deref().copied().unwrap_or_default();
                        self.add(shape.ball()?, &own.then(&place.transform));
                    }
                }
                Item::Instance(instance) => {
                    let transform = instance.transform.unwrap_or_default().then(&place.transform);
                    let inside = Place { transform, material };
                    self.placed(instance.aggregate as usize, own != INHERITED, &inside)?;
                }
            }
        }
        Some(())
    }

    fn placed(&mut self, aggregate: usize, overridden: bool, place: &Place) -> Option<()> {
        if !(self.holds[aggregate] || self.wanted[place.material as usize]) {
            return Some(());
        }
        match &self.aggregates[aggregate] {
            _ if self.balls.len() >= MANY => {
                self.add(ball_around(self.aggregates[aggregate].bounds())?, &place.transform);
                Some(())
            }
            Aggregate::Group(group) => self.group(group, place),
            Aggregate::Mesh(mesh) => self.mesh(mesh, overridden, place),
        }
    }

    /// `overridden` where the object's own material covers the file's.
    fn mesh(&mut self, mesh: &MeshAggregate, overridden: bool, place: &Place) -> Option<()> {
        let of = |triangle: u32| match mesh.material_of(triangle) {
            m if overridden || m == INHERITED => place.material,
            m => m,
        };
        let inner = &mesh.shape.mesh;
        let wanted = (0..inner.triangles.len() as u32).filter(|triangle| self.wanted[of(*triangle) as usize]);
        let corners = wanted.flat_map(|triangle| inner.triangles[triangle as usize]);
        let points = corners.map(|corner| (inner.positions[corner as usize], 0.0));
        if points.clone().next().is_some() {
            let ball = Ball::around(points);
            self.add(ball.reach.is_finite().then_some(ball)?, &place.transform);
        }
        Some(())
    }

    fn has_wanted_part(&self, shape: &Shape) -> bool {
        matches!(shape, Shape::Csg(csg) if csg.parts().iter().any(|part| part_is(&self.wanted, part)))
    }

    fn add(&mut self, ball: Ball, transform: &Affine) {
        self.balls.push(image(&ball, transform));
    }
}
