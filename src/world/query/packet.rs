//! Rays of a packet through aggregates and their placements: together as long as they go well together, then each as if it were alone.

use super::{Local, Query};
use crate::world::aggregate::{Aggregate, Group, Instance, Item, MeshAggregate};
use crate::world::packet::{Members, Packet, RAYS};
use crate::world::{Found, RayKind, World};

/// What is asked of the rays of a packet, by number.
pub struct Queries<'w>([Query<'w>; RAYS]);

/// A packet in an aggregate's space, which of its rays come there, and where that space stands.
#[derive(Clone, Copy)]
struct Place<'p> {
    packet: &'p Packet,
    members: Members,
    /// How many of a ray's distances make one of the world's, by number.
    per_world: &'p [f64; RAYS],
    /// The placement's number.
    instance: u64,
}

impl Place<'_> {
    /// Tells one of its rays.
    #[inline(always)]
    fn alone<T>(&self, i: usize, tell: impl FnOnce(&Local<'_>) -> T) -> T {
        tell(&Local::new(&self.packet.ray(i), self.per_world[i], self.instance))
    }
}

impl<'w> Queries<'w> {
    /// The nearest meetings with distances in (0, limit], as [`Query::run`] finds them, each by its number.
    pub fn run(world: &'w World, packet: &Packet, limits: &[f64; RAYS], kind: RayKind) -> Queries<'w> {
        let mut queries = Queries([Query { world, kind, any: false, limit: 0.0, found: Found(None) }; RAYS]);
        queries.0.iter_mut().zip(limits).for_each(|(query, limit)| query.limit = *limit);
        let place = Place { packet, members: packet.members, per_world: &[1.0; RAYS], instance: 0 };
        queries.visit(&world.aggregates[0], 0, &place);
        queries
    }

    /// What a ray has met.
    pub fn found(&self, i: usize) -> &Found {
        &self.0[i].found
    }

    /// An aggregate, whose placement is `at` a position.
    fn visit(&mut self, aggregate: &'w Aggregate, at: usize, place: &Place<'_>) {
        match aggregate {
            Aggregate::Group(group) => self.visit_group(group, place),
            Aggregate::Mesh(mesh) => self.visit_mesh(mesh, at, place),
        }
    }

    /// How far each ray matters here; nothing of those that are no members.
    fn limits(&self, place: &Place<'_>) -> [f64; RAYS] {
        let mut limits = [-1.0; RAYS];
        for i in place.members {
            limits[i] = self.0[i].limit * place.per_world[i];
        }
        limits
    }

    fn visit_mesh(&mut self, mesh: &MeshAggregate, at: usize, place: &Place<'_>) {
        let rays = (place.packet, place.members);
        mesh.shape.meet_nearest_each(rays, &self.limits(place), |i, position, meet| {
            place.alone(i, |local| self.0[i].take_triangle((mesh, at), position, meet, local));
        });
    }

    fn visit_group(&mut self, group: &'w Group, place: &Place<'_>) {
        let (rays, limits) = ((place.packet, place.members), self.limits(place));
        let together = group.tree.traverse_each(rays, &limits, |range, members, limits| {
            let place = Place { members, ..*place };
            range.for_each(|position| self.visit_position(group, position, &place));
            members.for_each(|i| limits.lower(i, self.0[i].limit * place.per_world[i]));
        });
        if together.is_none() {
            for i in place.members {
                place.alone(i, |local| self.0[i].visit_group(group, local));
            }
        }
    }

    #[inline]
    fn visit_position(&mut self, group: &'w Group, position: usize, place: &Place<'_>) {
        match &group.items[position] {
            Item::Instance(instance) => self.visit_instance(group, position, instance, place),
            Item::Shape(..) => {
                for i in place.members {
                    place.alone(i, |local| self.0[i].visit_position(group, position, local));
                }
            }
        }
    }

    fn visit_instance(&mut self, group: &'w Group, position: usize, instance: &Instance, place: &Place<'_>) {
        let Query { world, kind, .. } = self.0[place.members.first()];
        if group.hides(position, kind) {
            return;
        }
        let aggregate = &world.aggregates[instance.aggregate as usize];
        let place = Place { instance: place.instance.saturating_add(instance.first), ..*place };
        let Some(transform) = &instance.transform else { return self.visit(aggregate, position, &place) };
        let mut per_world = *place.per_world;
        let inside = Packet::new(|i| {
            let (ray, factor) = place.members.has(i).then(|| place.packet.ray(i))?.into_local(transform)?;
            per_world[i] *= factor;
            Some(ray)
        });
        if let Some(packet) = &inside {
            let members = packet.members;
            self.visit(aggregate, position, &Place { packet, members, per_world: &per_world, ..place });
        }
    }
}
