//! Lights and emitting surfaces, found through all placements.

use crate::diag::{Code, Diagnostic, Sink};
use crate::math::Affine;
use crate::scene::{Light, Material, Rgb, Texture};
use crate::world::aggregate::{Aggregate, Group, INHERITED, Item, MeshAggregate};
use crate::world::shape::Shape;
use crate::world::{Emitter, EmitterShape, PlacedLight, PrimitiveId};
use std::sync::Arc;

/// Lights and emitters beyond this number are left out, with an error: placements of placements multiply them without end.
const MAX_LIGHTS: usize = 1 << 20;

/// Placements of what gives light that are looked into at most: what glows without being sampled is never counted as a light.
const MAX_VISITS: usize = 1 << 24;

/// What gives light.
#[derive(Default)]
pub(super) struct Found {
    /// All lights in the order of the scene.
    pub lights: Vec<PlacedLight>,
    /// All emitters in the order of their ids.
    pub emitters: Vec<Emitter>,
    /// True where something glows that is neither.
    pub glows_unasked: bool,
}

/// Everything that gives light.
pub(super) fn gather(aggregates: &[Aggregate], materials: &[Arc<Material>], sink: &mut Sink) -> Found {
    let emissive: Vec<bool> = materials.iter().map(|m| is_emissive(m)).collect();
    let mut gathering = Gathering {
        aggregates,
        materials,
        luminous: luminous(aggregates, &emissive),
        emissive,
        found: Found::default(),
        visits: 0,
    };
    let place =
        Place { transform: Affine::IDENTITY, instance: 0, material: super::DEFAULT_MATERIAL, light: None };
    if let Aggregate::Group(world) = &aggregates[0] {
        gathering.group(world, &place);
    }
    if gathering.is_full() {
        let message = format!("the scene has more than {MAX_LIGHTS} lights; the rest gives none");
        sink.push(Diagnostic::new(Code::MemoryLimit, None, message));
    }
    let mut found = gathering.found;
    found.emitters.sort_by_key(|e| e.primitive);
    found
}

fn is_emissive(material: &Material) -> bool {
    material.layers.as_ref().is_some_and(|l| !matches!(l.emit, Texture::Constant(Rgb::ZERO)))
}

/// For each aggregate, whether it holds a light or a material that emits. Placed aggregates stand before those that place them, except
/// that the world is first.
fn luminous(aggregates: &[Aggregate], emissive: &[bool]) -> Vec<bool> {
    let mut luminous = vec![false; aggregates.len()];
    let emits = |m: &u32| emissive.get(*m as usize).copied().unwrap_or(false);
    for i in (1..aggregates.len()).chain([0]) {
        luminous[i] = match &aggregates[i] {
            Aggregate::Mesh(mesh) => mesh.materials.iter().any(emits),
            Aggregate::Group(group) => {
                !group.lights.is_empty()
                    || group.material.iter().any(emits)
                    || group.instances.iter().any(|&item| match &group.items[item as usize] {
                        Item::Instance(instance) => luminous[instance.aggregate as usize],
                        Item::Shape(..) => false,
                    })
            }
        };
    }
    luminous
}

struct Gathering<'a> {
    aggregates: &'a [Aggregate],
    materials: &'a [Arc<Material>],
    emissive: Vec<bool>,
    luminous: Vec<bool>,
    found: Found,
    visits: usize,
}

/// Where an aggregate is placed, and with what.
struct Place<'a> {
    transform: Affine,
    instance: u64,
    /// What is inherited.
    material: u32,
    light: Option<&'a Arc<Light>>,
}

impl Gathering<'_> {
    fn is_full(&self) -> bool {
        self.found.lights.len() + self.found.emitters.len() >= MAX_LIGHTS || self.visits >= MAX_VISITS
    }

    fn group(&mut self, group: &Group, place: &Place<'_>) {
        for (light, transform) in &group.lights {
            let world_from_local = transform.then(&place.transform);
            self.found.lights.push(PlacedLight { light: Arc::clone(light), world_from_local });
        }
        for (item, &own) in group.material.iter().enumerate() {
            if self.is_full() {
                return;
            }
            let material = if own == INHERITED { place.material } else { own };
            let known = group.area_lights.binary_search_by_key(&(item as u32), |(i, _)| *i);
            let light = known.ok().map(|at| &group.area_lights[at].1);
            match &group.items[item] {
                Item::Shape(shape, transform) if self.emissive[material as usize] => {
                    let own_transform = transform.as_deref().copied().unwrap_or_default();
                    let primitive = PrimitiveId { instance: place.instance, shape: item as u32, part: 0 };
                    let place = Place { transform: own_transform.then(&place.transform), light, ..*place };
                    self.emitter(emitter_shape(shape), material, primitive, &place);
                }
                Item::Shape(..) => {}
                Item::Instance(instance) => {
                    let inside = Place {
                        transform: instance.transform.unwrap_or_default().then(&place.transform),
                        instance: place.instance.saturating_add(instance.first),
                        material,
                        light,
                    };
                    if !(self.luminous[instance.aggregate as usize] || self.emissive[material as usize]) {
                        continue;
                    }
                    self.visits += 1;
                    match &self.aggregates[instance.aggregate as usize] {
                        Aggregate::Group(group) => self.group(group, &inside),
                        Aggregate::Mesh(mesh) => self.mesh(mesh, own != INHERITED, &inside),
                    }
                }
            }
        }
    }

    /// One emitter for each material of the mesh that emits. `overridden` where the object's own material covers the file's.
    fn mesh(&mut self, mesh: &MeshAggregate, overridden: bool, place: &Place<'_>) {
        let of = |triangle: u32| match mesh.material_of(triangle) {
            m if overridden || m == INHERITED => place.material,
            m => m,
        };
        let mut by_material: std::collections::BTreeMap<u32, Vec<u32>> = Default::default();
        for triangle in 0..mesh.shape.mesh.triangles.len() as u32 {
            if self.emissive[of(triangle) as usize] {
                by_material.entry(of(triangle)).or_default().push(triangle);
            }
        }
        for (material, triangles) in by_material {
            let primitive = PrimitiveId { instance: place.instance, shape: 0, part: 0 };
            let shape = EmitterShape::Mesh(Arc::clone(&mesh.shape.mesh), triangles);
            self.emitter(Some(shape), material, primitive, place);
        }
    }

    fn emitter(
        &mut self,
        shape: Option<EmitterShape>,
        material: u32,
        primitive: PrimitiveId,
        place: &Place<'_>,
    ) {
        let Some(shape) = shape else {
            self.found.glows_unasked = true;
            return;
        };
        self.found.emitters.push(Emitter {
            shape,
            world_from_local: place.transform,
            primitive,
            material: Arc::clone(&self.materials[material as usize]),
            light: place.light.cloned(),
        });
    }
}

/// A plane emits, but has no finite area to sample; solids put together emit, but nothing knows which part of a surface is left; curved
/// surfaces that are met directly glow without being sampled.
fn emitter_shape(shape: &Shape) -> Option<EmitterShape> {
    Some(match shape {
        Shape::Plane(_) | Shape::Csg(_) | Shape::Implicit(_) | Shape::Patch(_) | Shape::Swept(_) => {
            return None;
        }
        Shape::Sphere(s) => EmitterShape::Sphere { center: s.center, radius: s.radius },
        Shape::Disc(s) => EmitterShape::Disc(s.0),
        Shape::Rect(s) => EmitterShape::Rect(s.shape),
        Shape::Cuboid(s) => EmitterShape::Box(s.min, s.max),
        Shape::Cone(s) => EmitterShape::Cone(s.shape),
        Shape::Torus(s) => EmitterShape::Torus(s.shape),
        Shape::Triangle(s) => EmitterShape::Triangle(s.0),
    })
}
