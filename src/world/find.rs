//! What rays meet first: found by one step, and looked at by another. Camera rays take the first together.

use super::aggregate::{Aggregate, INHERITED};
use super::bvh::fetch_entry;
use super::packet::{Packet, RAYS};
use super::query::packet::Queries;
use super::query::{Candidate, Query};
use super::shape::LocalRay;
use super::{Hit, Ray, RayKind, World, last_before};

/// What a ray meets first, before it is looked at: which primitive, how far, and where on it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Found(pub(super) Option<Candidate>);

/// Materials that the nearest cache does not hold beside all else.
const MANY: usize = 1 << 8;

impl World {
    /// Finds what a ray meets first, before `t_max`, of what is not hidden from it.
    #[inline]
    pub fn find(&self, ray: &Ray) -> Found {
        let found = LocalRay::new(ray.origin, ray.direction).and_then(|(local, per_world)| {
            Query::run(self, &local, 1.0, last_before(ray.t_max) * per_world, ray.kind, false)
        });
        Found(found)
    }

    /// The hit of a ray on what it was found to meet in this world.
    #[inline]
    pub fn hit(&self, ray: &Ray, found: &Found) -> Option<Hit<'_>> {
        let found = found.0.as_ref()?;
        let (local, per_world) = LocalRay::new(ray.origin, ray.direction)?;
        self.finish(&local, found.t / per_world, found)
    }

    /// Finds what each of some rays meets first, as [`World::find`] does, and tells it with its number. Sooner than one by one where they start at one
    /// point and go side by side; all are of one kind.
    pub fn find_each(&self, rays: &[Option<Ray>; RAYS], mut tell: impl FnMut(usize, &Ray, &Found)) {
        let mut limits = [-1.0; RAYS];
        let packet = Packet::new(|i| {
            let ray = rays[i].as_ref()?;
            let (local, per_world) = LocalRay::new(ray.origin, ray.direction)?;
            limits[i] = last_before(ray.t_max) * per_world;
            Some(local)
        });
        let each = rays.iter().enumerate().filter_map(|(i, ray)| Some((i, ray.as_ref()?)));
        match &packet {
            Some(packet) => {
                let kind = rays[packet.members.first()].map_or(RayKind::Camera, |ray| ray.kind);
                let queries = Queries::run(self, packet, &limits, kind);
                self.fetch_coats(|| packet.members.filter_map(|i| queries.found(i).0.as_ref()));
                each.for_each(|(i, ray)| tell(i, ray, queries.found(i)));
            }
            None => each.for_each(|(i, ray)| tell(i, ray, &self.find(ray))),
        }
    }

    /// Has the materials of what was found brought near all at once, where there are many: each would be waited for. Changes nothing but time.
    #[inline(always)]
    fn fetch_coats<'f, F: Iterator<Item = &'f Candidate>>(&self, found: impl Fn() -> F) {
        let Aggregate::Group(group) = &self.aggregates[0] else { return };
        if self.coats.len() < MANY {
            return;
        }
        let placed_nowhere = || found().filter(|candidate| candidate.id.instance == 0);
        placed_nowhere().for_each(|candidate| fetch_entry(&group.material, candidate.id.shape as usize));
        for candidate in placed_nowhere() {
            let own = group.material[candidate.id.shape as usize];
            if own != INHERITED {
                fetch_entry(&self.coats, own as usize);
            }
        }
    }
}
