//! Every hit along a ray, in order: what `trace` of the language asks.

use super::aggregate::{Aggregate, Group, Item};
use super::query::Candidate;
use super::shape::{Csg, LocalRay, Meet};
use super::{Hit, PrimitiveId, World};
use glam::DVec3;

/// A ray in an aggregate's space.
#[derive(Clone, Copy)]
struct Local {
    ray: LocalRay,
    /// How many of the ray's distances make one of the world's: a power of two.
    per_world: f64,
    /// The placement's number.
    instance: u64,
}

/// What was met, and how much may be.
struct Found {
    meetings: Vec<Candidate>,
    most: usize,
}

impl Found {
    fn is_over(&self) -> bool {
        self.meetings.len() > self.most
    }
}

impl Local {
    fn within(&self, transform: Option<&crate::math::Affine>) -> Option<Local> {
        let Some(transform) = transform else { return Some(*self) };
        let (ray, factor) = self.ray.into_local(transform)?;
        Some(Local { ray, per_world: self.per_world * factor, ..*self })
    }
}

impl World {
    /// Every hit of a ray with what is in the world, hidden or not, nearest first: from `origin` on along `direction`, which may have any
    /// length but 0; the distances are in its lengths. A surface that is only touched is hit once. None where there are more than `most`.
    pub fn every_hit(&self, origin: DVec3, direction: DVec3, most: usize) -> Option<Vec<Hit<'_>>> {
        let Some((ray, per_world)) = LocalRay::new(origin, direction) else { return Some(Vec::new()) };
        let mut found = Found { meetings: Vec::new(), most };
        self.gather(&self.aggregates[0], Local { ray, per_world: 1.0, instance: 0 }, &mut found);
        if found.is_over() {
            return None;
        }
        let mut found = found.meetings;
        found.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.id.cmp(&b.id)));
        let hits = found.iter().filter_map(|one| Some((one.id, self.finish(&ray, one.t / per_world, one)?)));
        Some(once_each(hits, direction))
    }

    fn gather(&self, aggregate: &Aggregate, local: Local, found: &mut Found) {
        let Local { ray, .. } = local;
        match aggregate {
            Aggregate::Mesh(mesh) => {
                let mut meets = Vec::new();
                mesh.shape.crossings(&ray, &mut meets);
                found.meetings.extend(meets.iter().map(|meet| {
                    let id = PrimitiveId { instance: local.instance, shape: 0, part: meet.face };
                    candidate(id, 0, *meet, &local)
                }));
            }
            Aggregate::Group(group) => {
                group.tree.traverse_all(ray.origin, ray.direction, |range| {
                    for position in range {
                        self.gather_item(group, position, &local, found);
                        if found.is_over() {
                            return false;
                        }
                    }
                    true
                });
            }
        }
    }

    fn gather_item(&self, group: &Group, position: usize, local: &Local, found: &mut Found) {
        match &group.items[position] {
            Item::Shape(shape, transform) => {
                let Some(inside) = local.within(transform.as_deref()) else { return };
                let mut meets = Vec::new();
                shape.crossings(&inside.ray, &mut meets);
                let number = group.number_of(position as u32);
                found.meetings.extend(meets.iter().map(|meet| {
                    let part = Csg::part_number(meet);
                    let id = PrimitiveId { instance: local.instance, shape: number, part };
                    candidate(id, position as u32, *meet, &inside)
                }));
            }
            Item::Instance(instance) => {
                let Some(inside) = local.within(instance.transform.as_ref()) else { return };
                let inside = Local { instance: local.instance.saturating_add(instance.first), ..inside };
                self.gather(&self.aggregates[instance.aggregate as usize], inside, found);
            }
        }
    }
}

fn candidate(id: PrimitiveId, position: u32, meet: Meet, local: &Local) -> Candidate {
    Candidate { t: meet.t / local.per_world, id, position, meet }
}

/// Meetings that stand twice are touches: each is kept once, and not at all beside a meeting of the same object at the same place, which is
/// how a mesh is met on an edge.
fn once_each<'w>(hits: impl Iterator<Item = (PrimitiveId, Hit<'w>)>, direction: DVec3) -> Vec<Hit<'w>> {
    let mut kept: Vec<(Hit<'w>, bool)> = Vec::new();
    for (id, hit) in hits {
        let Some((last, is_touch)) = kept.last_mut() else {
            kept.push((hit, false));
            continue;
        };
        let before = last.primitive;
        let same = (before.instance, before.shape) == (id.instance, id.shape);
        let is_near = (hit.t - last.t) * direction.length() <= hit.error.length() + last.error.length();
        if before == id && hit.t == last.t && !*is_touch {
            *is_touch = true;
        } else if same && is_near && *is_touch {
            *is_touch = false;
            *last = hit;
        } else {
            kept.push((hit, false));
        }
    }
    kept.into_iter().map(|(hit, _)| hit).collect()
}
