//! From a meeting in some shape's own space to a [`Hit`] in the world's: the way down through the placements, and the surface
//! carried back up it.

use super::aggregate::{Aggregate, Group, INHERITED, Instance, Item, mesh_material};
use super::query::Candidate;
use super::shape::csg::Solid;
use super::shape::{Csg, LocalRay, Meet, Shape, carry};
use super::{Hit, PrimitiveId, Provenance, World};
use crate::math::Affine;
use glam::DVec3;

/// A step from a group into a placement.
#[derive(Clone, Copy)]
struct Step<'w> {
    group: &'w Group,
    /// Its number in the scene's order.
    item: u32,
    instance: &'w Instance,
}

/// The placements on the way to a primitive, outermost first, and the aggregate it is in.
struct Path<'w> {
    steps: Steps<'w>,
    aggregate: &'w Aggregate,
}

impl Path<'_> {
    /// Those of the placements, outermost first.
    #[inline]
    fn transforms(&self) -> impl Iterator<Item = &Affine> + Clone {
        self.steps.iter().filter_map(|step| step.instance.transform.as_ref())
    }
}

/// A few steps without allocation, any number with.
enum Steps<'w> {
    None,
    One([Step<'w>; 1]),
    Many(Vec<Step<'w>>),
}

impl<'w> Steps<'w> {
    #[inline]
    fn push(&mut self, step: Step<'w>) {
        *self = match std::mem::replace(self, Steps::None) {
            Steps::None => Steps::One([step]),
            Steps::One([first]) => Steps::Many(vec![first, step]),
            Steps::Many(mut steps) => {
                steps.push(step);
                Steps::Many(steps)
            }
        };
    }
}

impl<'w> std::ops::Deref for Steps<'w> {
    type Target = [Step<'w>];

    fn deref(&self) -> &[Step<'w>] {
        match self {
            Steps::None => &[],
            Steps::One(one) => one,
            Steps::Many(many) => many,
        }
    }
}

impl World {
    #[inline(always)]
    fn path(&self, id: u64) -> Path<'_> {
        match id {
            // Most things are not placed.
            0 => Path { steps: Steps::None, aggregate: &self.aggregates[0] },
            _ => self.path_into(id),
        }
    }

    /// The way to what was found: most of what is placed is placed once, and a mesh's placement was noted.
    #[inline(always)]
    fn path_to(&self, candidate: &Candidate) -> Path<'_> {
        let id = candidate.id.instance;
        let noted = match &self.aggregates[0] {
            Aggregate::Group(group) if id != 0 => self.step_at(group, candidate.position),
            _ => None,
        };
        match noted {
            Some((step, aggregate)) if step.instance.first == id => {
                Path { steps: Steps::One([step]), aggregate }
            }
            _ => self.path(id),
        }
    }

    /// The step into the placement at a position of a group, if there is one.
    #[inline(always)]
    fn step_at<'w>(&'w self, group: &'w Group, position: u32) -> Option<(Step<'w>, &'w Aggregate)> {
        let Some(Item::Instance(instance)) = group.items.get(position as usize) else { return None };
        let step = Step { group, item: group.number_of(position), instance };
        Some((step, &self.aggregates[instance.aggregate as usize]))
    }

    /// The way into a placement.
    fn path_into(&self, id: u64) -> Path<'_> {
        let whole = &self.aggregates[0];
        match self.step(whole, id) {
            None => Path { steps: Steps::None, aggregate: whole },
            // Most of what is placed is placed once.
            Some((step, aggregate, 0)) => Path { steps: Steps::One([step]), aggregate },
            Some((step, aggregate, id)) => self.path_on(step, aggregate, id),
        }
    }

    /// The way from a first placement on into others.
    #[inline(never)]
    fn path_on<'w>(&'w self, first: Step<'w>, aggregate: &'w Aggregate, mut id: u64) -> Path<'w> {
        let mut path = Path { steps: Steps::One([first]), aggregate };
        while let Some((step, aggregate, rest)) = self.step(path.aggregate, id) {
            path.steps.push(step);
            (path.aggregate, id) = (aggregate, rest);
        }
        path
    }

    /// The placement that holds, or is, the one numbered `id` from an aggregate, what is placed by it, and the number from there.
    #[inline]
    fn step<'w>(&'w self, aggregate: &'w Aggregate, id: u64) -> Option<(Step<'w>, &'w Aggregate, u64)> {
        let Aggregate::Group(group) = aggregate else { return None };
        let (step, aggregate) = self.step_at(group, group.placement(id)?)?;
        Some((step, aggregate, id - step.instance.first))
    }

    /// The hit that a candidate is. `ray` is the world's.
    #[inline]
    pub(super) fn finish(&self, ray: &LocalRay, t: f64, candidate: &Candidate) -> Option<Hit<'_>> {
        let path = self.path_to(candidate);
        let (shape, own_transform) = match path.aggregate {
            Aggregate::Mesh(_) => (None, None),
            Aggregate::Group(group) => match &group.items[candidate.position as usize] {
                Item::Shape(shape, transform) => (Some(shape), transform.as_deref()),
                Item::Instance(_) => return None,
            },
        };
        let (first, second) = if path.steps.is_empty() {
            (own_transform, None)
        } else {
            let mut all = path.transforms().chain(own_transform);
            (all.next(), all.next())
        };
        match second {
            // Most things stand under one transform at the most.
            None => self.carried(ray, t, candidate, (&path, shape), first.into_iter()),
            Some(_) => self.carried_far(ray, t, candidate, (&path, shape), own_transform),
        }
    }

    /// The hit on what stands under several transforms.
    #[inline(never)]
    fn carried_far<'w>(
        &'w self,
        ray: &LocalRay,
        t: f64,
        candidate: &Candidate,
        (path, shape): (&Path<'w>, Option<&'w Shape>),
        own_transform: Option<&Affine>,
    ) -> Option<Hit<'w>> {
        self.carried(ray, t, candidate, (path, shape), path.transforms().chain(own_transform))
    }

    /// The hit on what stands under transforms, outermost first.
    #[inline]
    fn carried<'w, 't>(
        &'w self,
        ray: &LocalRay,
        t: f64,
        candidate: &Candidate,
        (path, shape): (&Path<'w>, Option<&'w Shape>),
        transforms: impl Iterator<Item = &'t Affine> + Clone,
    ) -> Option<Hit<'w>> {
        let mut moved = None;
        for transform in transforms.clone() {
            moved = Some(moved.as_ref().unwrap_or(ray).into_local(transform)?.0);
        }
        let local = moved.as_ref().unwrap_or(ray);
        let coat = &self.coats[self.material_on(path, shape, candidate) as usize];
        let (mut own_point, mut worn) = (None, None);
        let mut surface = match (shape, path.aggregate) {
            (Some(Shape::Csg(csg)), _) => {
                let part = csg.surface(local, &candidate.meet);
                own_point = Some(part.own_point);
                part.whole
            }
            // On the spot, as where there are spheres there are many.
            (Some(Shape::Sphere(sphere)), _) => sphere.surface(local, &candidate.meet),
            (Some(shape), _) => shape.surface(local, &candidate.meet),
            (None, Aggregate::Mesh(mesh)) => {
                worn = mesh.shape.worn_at(candidate.id.part, &candidate.meet);
                own_point = worn.map(|place| place.rest());
                mesh.shape.surface(candidate.id.part, &candidate.meet, coat.bends_normal())
            }
            (None, Aggregate::Group(_)) => return None,
        };
        let local_point = own_point.unwrap_or(surface.point);
        carry(&mut surface, transforms);
        Some(Hit {
            t,
            point: surface.point,
            error: surface.error,
            geometric_normal: surface.geometric_normal,
            normal: on_side_of(surface.normal, surface.geometric_normal),
            along_u: surface.tangent,
            uv: surface.uv,
            local_point,
            worn,
            coat,
            fault: shape.and_then(|shape| shape.fault(local, &candidate.meet)),
            primitive: candidate.id,
        })
    }

    /// A part's own material wins, then its object's, then its mesh's, then that of the groups around it, from inside out.
    #[inline(always)]
    fn material_on(&self, path: &Path<'_>, shape: Option<&Shape>, candidate: &Candidate) -> u32 {
        // What most things and most meshes have is found on the spot.
        let own = match (shape, path.aggregate, &path.steps[..]) {
            (Some(Shape::Csg(csg)), ..) => part_material(csg, &candidate.meet),
            (_, Aggregate::Group(group), _) => group.material[candidate.id.shape as usize],
            (_, Aggregate::Mesh(_), [.., step]) => step.group.material[step.item as usize],
            (_, Aggregate::Mesh(_), []) => INHERITED,
        };
        if own != INHERITED { own } else { self.material_around(path, candidate) }
    }

    /// The same of what is no part.
    fn material_around(&self, path: &Path<'_>, candidate: &Candidate) -> u32 {
        let id = candidate.id;
        let mut placed = path.steps.iter().rev().map(|step| step.group.material[step.item as usize]);
        let own = match path.aggregate {
            Aggregate::Group(group) => group.material[id.shape as usize],
            Aggregate::Mesh(mesh) => match placed.next() {
                Some(m) if m != INHERITED => m,
                _ => mesh.material_of(id.part),
            },
        };
        if own != INHERITED {
            return own;
        }
        placed.find(|&m| m != INHERITED).unwrap_or(super::lower::DEFAULT_MATERIAL)
    }

    /// Where a primitive came from.
    pub fn provenance(&self, primitive: PrimitiveId) -> Option<Provenance> {
        let path = self.path(primitive.instance);
        let mut spans = Vec::new();
        for step in path.steps.iter() {
            spans.extend(step.group.scopes_around(step.item as usize));
            spans.push(step.group.span[step.item as usize]);
        }
        let (group, item) = match path.aggregate {
            Aggregate::Group(group) => {
                spans.extend(group.scopes_around(primitive.shape as usize));
                (group, primitive.shape)
            }
            Aggregate::Mesh(_) => {
                let step = path.steps.last()?;
                spans.pop();
                (step.group, step.item)
            }
        };
        let name = group.names.get(&item).cloned();
        let own = *group.span.get(item as usize)?;
        let span = match group.csg(item) {
            Some(csg) => {
                spans.push(own);
                csg.part_at(primitive.part)?.span
            }
            None => own,
        };
        Some(Provenance { span, path: spans, name })
    }
}

/// The material that the part of a solid has of its own.
fn part_material(csg: &Csg, meet: &Meet) -> u32 {
    let part = csg.part(meet);
    match &part.solid {
        Solid::Mesh(mesh, materials) if part.material == INHERITED => {
            mesh_material(mesh, materials, meet.face)
        }
        _ => part.material,
    }
}

/// The unit shading normal, turned to the geometric normal's side; the geometric normal where the two are perpendicular or the
/// shading normal vanishes.
fn on_side_of(normal: DVec3, geometric: DVec3) -> DVec3 {
    if normal == geometric {
        return geometric;
    }
    let Some(unit) = normal.try_normalize() else { return geometric };
    let cosine = unit.dot(geometric);
    if cosine > 0.0 {
        unit
    } else if cosine < 0.0 {
        unit - geometric * (2.0 * cosine)
    } else {
        geometric
    }
}
