//! What rays see: the scene flattened into shapes, trees, lights and surfaces, ready for any number of threads.
//! Knows nothing of the language; a user's function reaches it as a [`crate::math::field::Field`].
//!
//! [`lower`] makes a [`World`] of a scene's nodes; [`World::closest`], [`World::occluded`] and [`World::transmittance`] ask
//! it about rays; [`Hit::spawn`] goes on from where a ray ended.

mod aggregate;
mod bounding;
pub mod bsdf;
pub mod bvh;
mod emitter;
#[cfg(test)]
mod even;
mod every;
mod find;
mod footprint;
mod hit;
pub mod kdtree;
mod kept;
pub mod light;
pub mod lower;
pub mod packet;
mod place;
mod query;
mod roomy;
pub mod shape;
mod stack;
pub mod texture;
pub mod tree;

pub use emitter::{Emitter, EmitterShape, PlacedLight};
pub use find::Found;
pub use footprint::Footprint;
pub use hit::{Hit, SurfacePoint};
pub use kept::Kept;

use aggregate::Aggregate;
use bsdf::Coat;
use query::Query;
use shape::LocalRay;

use crate::diag::{Diagnostic, Span};
use crate::math::Aabb;
use crate::scene::assets::{AssetCache, Loader};
use crate::scene::{Accelerator, Material, Node, Rgb};
use glam::DVec3;

/// A half-line, or a piece of one.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes; unit length up to rounding.
    pub direction: DVec3,
    /// Hits at or beyond this distance do not count.
    pub t_max: f64,
    /// What it is cast for, which decides what is hidden from it.
    pub kind: RayKind,
}

/// What a ray is cast for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the camera (and on through what is transparent to it).
    Camera,
    /// Toward a light.
    Shadow,
    /// Reflected, refracted or scattered.
    Indirect,
}

/// A primitive of the world as placed: which one, and through which placement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrimitiveId {
    /// The placement, 0 for the world's own primitives. Nested placements multiply, hence the width.
    pub instance: u64,
    /// The shape within it.
    pub shape: u32,
    /// The triangle within a mesh, the part within solids put together, else 0.
    pub part: u32,
}

/// Where a primitive came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// The block or `with` that made it.
    pub span: Span,
    /// The placements around it, outermost first.
    pub path: Vec<Span>,
    /// Its `name`, where it has one.
    pub name: Option<Box<str>>,
}

/// How a world is made.
#[derive(Clone, Copy, Debug, Default)]
pub struct WorldOptions {
    /// The trees over the shapes, and over the triangles of meshes.
    pub accelerator: Accelerator,
    /// The pixels of the picture, which decide how finely patches are cut into triangles. None: no picture is made, and rays meet every
    /// patch directly.
    pub footprint: Option<Footprint>,
}

/// How large a world is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct WorldStats {
    /// Shapes stored, instances' shapes once, triangles of meshes apart.
    pub shapes: u64,
    /// Triangles of meshes stored.
    pub triangles: u64,
    /// Placements of groups and meshes.
    pub instances: u64,
    /// Trees built.
    pub trees: u64,
    /// Nodes of all trees.
    pub tree_nodes: u64,
    /// Meshes, surfaces and weights of skins that frames before had made.
    pub reused: u64,
}

/// Everything that rays see.
pub struct World {
    /// Point, spot, sun and sky lights, in the order of the scene.
    pub lights: Vec<PlacedLight>,
    /// Surfaces that emit: the objects of area lights, and objects whose material has `emit`.
    pub emitters: Vec<Emitter>,
    /// True where something glows that is not among these: a plane, a curved surface that rays meet directly, solids put together. Light of
    /// it is found only by who meets it.
    pub glows_unasked: bool,
    /// The first is the scene itself, the others are what is placed in it.
    aggregates: Vec<Aggregate>,
    coats: Vec<Coat>,
    /// How many things were taken over from worlds before.
    reused: u64,
}

/// A factor per colour channel.
pub type Transmittance = Rgb;

impl World {
    /// Flattens a scene's nodes (taking them, so that each is freed as it goes), reads the meshes they place, and builds the trees.
    pub fn new(nodes: Vec<Node>, options: &WorldOptions, loader: &dyn Loader) -> (World, Vec<Diagnostic>) {
        World::with_assets(nodes, options, &AssetCache::new(loader), &mut Kept::default())
    }

    /// The same with files that were perhaps read before, and meshes of worlds before it, for the frames of an animation.
    pub fn with_assets(
        nodes: Vec<Node>,
        options: &WorldOptions,
        assets: &AssetCache<'_>,
        kept: &mut Kept,
    ) -> (World, Vec<Diagnostic>) {
        lower::lower(nodes, options, assets, kept)
    }

    /// A world of which nothing but shapes will be asked: pictures and lights are left out.
    pub fn of_shapes(nodes: Vec<Node>, assets: &AssetCache<'_>, kept: &mut Kept) -> (World, Vec<Diagnostic>) {
        lower::lower_shapes(nodes, assets, kept)
    }

    /// The first thing a ray meets, before `t_max`, that is not hidden from it.
    pub fn closest(&self, ray: &Ray) -> Option<Hit<'_>> {
        let (local, per_world) = LocalRay::new(ray.origin, ray.direction)?;
        let found = Query::run(self, &local, 1.0, last_before(ray.t_max) * per_world, ray.kind, false)?;
        self.finish(&local, found.t / per_world, &found)
    }

    /// Whether anything at all stands between the ray's origin and its `t_max`, transparent or not.
    pub fn occluded(&self, ray: &Ray) -> bool {
        LocalRay::new(ray.origin, ray.direction).is_some_and(|(local, per_world)| {
            Query::run(self, &local, 1.0, last_before(ray.t_max) * per_world, ray.kind, true).is_some()
        })
    }

    /// What is left of the light along a shadow ray. `passes` says what share each surface on the way lets through (0 for most);
    /// it is asked in order until nothing is left. Beyond each the ray is aimed anew at where it ends, so that what it is moved by to be
    /// clear of a surface never brings it into the light itself.
    pub fn transmittance<E>(
        &self,
        ray: &Ray,
        mut passes: impl FnMut(&Hit<'_>) -> Result<Rgb, E>,
    ) -> Result<Transmittance, E> {
        let end = ray.t_max.is_finite().then(|| ray.origin + ray.direction * ray.t_max);
        let (mut left, mut ray) = (Rgb::ONE, *ray);
        while let Some(hit) = self.closest(&ray) {
            left *= passes(&hit)?;
            let next = match end {
                Some(end) => hit.spawn_to(end),
                None => hit.spawn(ray.direction, ray.kind),
            };
            let goes_on = next.direction.dot(ray.direction) > 0.0 && next.origin != ray.origin;
            if left == Rgb::ZERO || !goes_on {
                break;
            }
            ray = Ray { kind: ray.kind, ..next };
        }
        Ok(left)
    }

    /// The index in `emitters` of the emitter that a primitive is part of.
    pub fn emitter_of(&self, primitive: PrimitiveId) -> Option<usize> {
        let place = |p: PrimitiveId| (p.instance, p.shape);
        let first = self.emitters.partition_point(|e| place(e.primitive) < place(primitive));
        let same = self.emitters[first..].iter().take_while(|e| place(e.primitive) == place(primitive));
        same.enumerate().find(|(_, e)| e.shape.has_part(primitive.part)).map(|(i, _)| first + i)
    }

    /// Whether a primitive that emits does so from both sides: one of a closed solid.
    pub fn emits_inward(&self, primitive: PrimitiveId) -> bool {
        self.emitter_of(primitive).is_some_and(|i| light::emits_inward(&self.emitters[i].shape))
    }

    /// Whether something is hidden from rays of shadows, or from those that are reflected and let through: then the two may find different
    /// things on the same way.
    pub fn hides_from_light(&self) -> bool {
        let groups = self.aggregates.iter().filter_map(|aggregate| match aggregate {
            Aggregate::Group(group) => Some(group),
            Aggregate::Mesh(_) => None,
        });
        groups.flat_map(|group| &group.hide).any(|hide| hide.shadow || hide.reflection)
    }

    /// The box around all bounded shapes; empty for none.
    pub fn bounds(&self) -> Aabb {
        self.aggregates[0].tree().bounds()
    }

    /// Every material that a hit may report, each once.
    pub fn materials(&self) -> impl Iterator<Item = &Material> {
        self.coats.iter().map(|coat| &*coat.material)
    }

    /// What was made.
    pub fn stats(&self) -> WorldStats {
        let mut stats = WorldStats { reused: self.reused, ..WorldStats::default() };
        for aggregate in &self.aggregates {
            match aggregate {
                Aggregate::Group(group) => {
                    stats.shapes += (group.items.len() - group.instances.len()) as u64;
                    stats.instances += group.instances.len() as u64;
                }
                Aggregate::Mesh(mesh) => stats.triangles += mesh.shape.mesh.triangles.len() as u64,
            }
            stats.trees += u64::from(aggregate.tree().node_count() > 0);
            stats.tree_nodes += aggregate.tree().node_count() as u64;
        }
        stats
    }
}

/// The largest distance below one, finite; below 0 where there is none.
#[inline]
fn last_before(t_max: f64) -> f64 {
    // The numbers from 0 up have bits that go up with them.
    if t_max > 0.0 { f64::from_bits(t_max.to_bits() - 1) } else { -1.0 }
}
