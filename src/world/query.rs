//! Rays through aggregates and their placements.

pub(super) mod packet;

use super::aggregate::{Aggregate, Group, Item, MeshAggregate};
use super::shape::{Csg, LocalRay, Meet, Shape};
use super::{Found, PrimitiveId, RayKind, World};
use crate::scene::Hide;
use std::ops::Range;

/// The best meeting so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Distance in the world's units of the ray.
    pub t: f64,
    pub id: PrimitiveId,
    /// Where the shape, or the placement of the mesh, is among its group's items.
    pub position: u32,
    /// In the units of the shape's own space.
    pub meet: Meet,
}

/// What is asked of a ray.
#[derive(Clone, Copy)]
pub(super) struct Query<'w> {
    world: &'w World,
    kind: RayKind,
    /// True where any meeting will do.
    any: bool,
    /// Largest distance that counts, in the world's units.
    limit: f64,
    found: Found,
}

/// A ray in an aggregate's space, and where that space stands.
#[derive(Clone, Copy)]
struct Local<'r> {
    /// Where it is already: a copy of what was just written waits for the writes.
    ray: &'r LocalRay,
    /// How many of the ray's distances make one of the world's: a power of two.
    per_world: f64,
    /// The same the other way round.
    world_per: f64,
    /// The placement's number.
    instance: u64,
}

impl<'r> Local<'r> {
    #[inline(always)]
    fn new(ray: &'r LocalRay, per_world: f64, instance: u64) -> Local<'r> {
        Local { ray, per_world, world_per: 1.0 / per_world, instance }
    }
}

impl<'w> Query<'w> {
    /// The nearest meeting with a distance in (0, limit], or any; ties go to the smaller id, whatever the tree.
    #[inline(always)]
    pub fn run(
        world: &'w World,
        ray: &LocalRay,
        per_world: f64,
        limit: f64,
        kind: RayKind,
        any: bool,
    ) -> Option<Candidate> {
        let mut query = Query { world, kind, any, limit, found: Found(None) };
        query.visit(&world.aggregates[0], 0, &Local::new(ray, per_world, 0));
        query.found.0
    }

    /// An aggregate, whose placement is `at` a position.
    #[inline(always)]
    fn visit(&mut self, aggregate: &Aggregate, at: usize, local: &Local<'_>) {
        match aggregate {
            Aggregate::Group(group) => self.visit_group(group, local),
            Aggregate::Mesh(mesh) => self.visit_mesh(mesh, at, local),
        }
    }

    #[inline]
    fn visit_mesh(&mut self, mesh: &MeshAggregate, at: usize, local: &Local<'_>) {
        let met = mesh.shape.meet_nearest(local.ray, self.limit * local.per_world, self.any);
        if let Some((position, meet)) = met {
            self.take_triangle((mesh, at), position, meet, local);
        }
    }

    /// A meeting with a triangle at a position of its mesh's tree.
    #[inline(always)]
    fn take_triangle(
        &mut self,
        (mesh, at): (&MeshAggregate, usize),
        position: usize,
        meet: Meet,
        local: &Local<'_>,
    ) {
        let part = mesh.shape.triangle_at(position);
        let id = PrimitiveId { instance: local.instance, shape: 0, part };
        self.offer(id, at as u32, meet, local);
    }

    /// Groups hold groups, so there is one such function and no copies of it.
    #[inline(never)]
    fn visit_group(&mut self, group: &Group, local: &Local<'_>) {
        self.each(group, local, |query, range| {
            for position in range {
                query.visit_position(group, position, local);
                if query.any && query.found.0.is_some() {
                    break;
                }
            }
        });
    }

    /// What stands where it was made and is hidden from nobody is most of most groups.
    #[inline(always)]
    fn visit_position(&mut self, group: &Group, position: usize, local: &Local<'_>) {
        match &group.items[position] {
            _ if !group.hide.is_empty() => self.visit_item(group, position, local),
            // These are many where there are any, and most are missed: they are tested on the spot.
            Item::Shape(Shape::Sphere(sphere), None) => {
                if let Some(t) = sphere.distance(local.ray, self.limit * local.per_world) {
                    self.take(group, position, Meet::at(t), local);
                }
            }
            Item::Shape(shape, None) => self.meet(shape, group, position, local),
            Item::Shape(_, Some(_)) | Item::Instance(_) => self.visit_item(group, position, local),
        }
    }

    /// All that the ray may meet, near ones first; where any meeting will do in no order, until there is one.
    #[inline(always)]
    fn each(&mut self, group: &Group, local: &Local<'_>, test: impl Fn(&mut Self, Range<usize>)) {
        let LocalRay { origin, direction } = local.ray;
        let limit = self.limit * local.per_world;
        let tree = &group.tree;
        if self.any {
            tree.traverse_any(origin, direction, limit, |range| {
                test(self, range);
                self.found.0.is_none()
            });
        } else {
            tree.traverse(origin, direction, limit, |range, _| {
                test(self, range);
                self.limit * local.per_world
            });
        }
    }

    #[inline(never)]
    fn visit_item(&mut self, group: &Group, position: usize, local: &Local<'_>) {
        if group.hides(position, self.kind) {
            return;
        }
        match &group.items[position] {
            Item::Shape(shape, None) => self.meet(shape, group, position, local),
            Item::Shape(shape, Some(transform)) => {
                let Some((ray, factor)) = local.ray.into_local(transform) else { return };
                self.meet(
                    shape,
                    group,
                    position,
                    &Local::new(&ray, local.per_world * factor, local.instance),
                );
            }
            Item::Instance(instance) => {
                let aggregate = &self.world.aggregates[instance.aggregate as usize];
                let number = local.instance.saturating_add(instance.first);
                let Some(transform) = &instance.transform else {
                    return self.visit(aggregate, position, &Local { instance: number, ..*local });
                };
                let Some((ray, factor)) = local.ray.into_local(transform) else { return };
                self.visit(aggregate, position, &Local::new(&ray, local.per_world * factor, number));
            }
        }
    }

    /// A shape of a group, in its own space.
    #[inline(always)]
    fn meet(&mut self, shape: &Shape, group: &Group, position: usize, inside: &Local<'_>) {
        let limit = self.limit * inside.per_world;
        let met = if self.any { shape.meet_any(inside.ray, limit) } else { shape.meet(inside.ray, limit) };
        if let Some(meet) = met {
            self.take(group, position, meet, inside);
        }
    }

    /// A meeting with a shape of a group.
    #[inline]
    fn take(&mut self, group: &Group, position: usize, meet: Meet, inside: &Local<'_>) {
        let part = Csg::part_number(&meet);
        let number = group.number_of(position as u32);
        let id = PrimitiveId { instance: inside.instance, shape: number, part };
        self.offer(id, position as u32, meet, inside);
    }

    #[inline]
    fn offer(&mut self, id: PrimitiveId, position: u32, meet: Meet, local: &Local<'_>) {
        let t = meet.t * local.world_per;
        let better = self.found.0.is_none_or(|best| t < best.t || (t == best.t && id < best.id));
        if better && t <= self.limit {
            self.limit = t;
            self.found.0 = Some(Candidate { t, id, position, meet });
        }
    }
}

/// Whether rays of a kind pass through.
pub(super) fn is_hidden(hide: Hide, kind: RayKind) -> bool {
    match kind {
        RayKind::Camera => hide.camera,
        RayKind::Shadow => hide.shadow,
        RayKind::Indirect => hide.reflection,
    }
}
