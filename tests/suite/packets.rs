//! Rays that are cast together beside the same rays cast alone: every bit of what they meet.

use glam::DVec3;
use ogee::math::random::Random;
use ogee::report::accelerators::meshes::{KINDS, procedural};
use ogee::scene::assets::DiskLoader;
use ogee::scene::{Accelerator, MeshSource, Node, Object, Shape};
use ogee::session::Session;
use ogee::world::packet::RAYS;
use ogee::world::{Found, Ray, RayKind, World, WorldOptions};
use std::sync::Arc;

fn world_of(nodes: Vec<Node>, accelerator: Accelerator) -> World {
    World::new(nodes, &WorldOptions { accelerator, ..WorldOptions::default() }, &DiskLoader).0
}

fn vector(random: &mut Random) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)))
}

/// Beams of rays about a place of some size: from inside it, near it and far off; as narrow as those of a few pixels, wide, and in every direction;
/// along axes, so that signs and largest axes differ, and with some missing.
fn beam(random: &mut Random, middle: DVec3, size: f64) -> [Option<Ray>; RAYS] {
    let origin = middle + vector(random) * size * [0.5, 2.0, 100.0][random.below(3)];
    let toward = match random.below(3) {
        0 => DVec3::AXES[random.below(3)] * random.sign(),
        _ => (middle + vector(random) * size * 0.5 - origin).normalize(),
    };
    let width = [0.0, 1e-6, 0.003, 0.05, 1.0, 10.0][random.below(6)];
    let kind = [RayKind::Camera, RayKind::Indirect][random.below(2)];
    let missing = [0, 0, 3, 12][random.below(4)];
    std::array::from_fn(|_| {
        let direction = toward + vector(random) * width;
        let t_max = if random.below(8) == 0 { size * random.unit() } else { f64::INFINITY };
        (random.below(RAYS) >= missing).then_some(Ray { origin, direction, t_max, kind })
    })
}

/// How many rays met something.
fn agree(world: &World, name: &str, beams: usize, (middle, size): (DVec3, f64)) -> usize {
    let mut random = Random::new(7);
    let bits = |ray: &Ray, found: &Found| {
        world
            .hit(ray, found)
            .map(|hit| (hit.t.to_bits(), hit.primitive, hit.point.to_array().map(f64::to_bits)))
    };
    let mut n_met = 0;
    for _ in 0..beams {
        let rays = beam(&mut random, middle, size);
        let mut told = [false; RAYS];
        world.find_each(&rays, |i, ray, found| {
            let alone = bits(ray, &world.find(&rays[i].expect("a ray that there is")));
            assert_eq!(bits(ray, found), alone, "{name}: ray {i} of {rays:?}");
            n_met += usize::from(alone.is_some());
            told[i] = true;
        });
        assert_eq!(told, rays.map(|ray| ray.is_some()), "{name}");
    }
    n_met
}

#[test]
fn rays_cast_together_meet_of_meshes_what_they_meet_alone() {
    for kind in KINDS {
        let mesh = procedural(kind, 2000).expect("a kind");
        let bounds = ogee::math::Aabb::of(mesh.positions.iter().copied());
        let place = (bounds.center(), bounds.size().max_element());
        let object = Object::new(Shape::Mesh(Arc::new(MeshSource::Inline(mesh))), crate::stage::SPAN);
        let nodes = vec![Node::Object(Arc::new(object))];
        let mut n_met = 0;
        for accelerator in [Accelerator::Bvh, Accelerator::KdTree, Accelerator::None] {
            let world = world_of(nodes.clone(), accelerator);
            let beams = if accelerator == Accelerator::None { 30 } else { 3000 };
            n_met += agree(&world, kind, beams, place);
        }
        assert!(n_met > 500, "{kind}: {n_met}");
    }
}

/// Placements in placements, turned, mirrored, large and small; shapes of every kind beside them; some hidden from cameras, some without end.
const EVERYTHING: &str = "
    let m = mesh { vertices <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <0, 0, 1>  faces <0, 2, 1>, <0, 1, 3>, <0, 3, 2>, <1, 2, 3> }
    let four = group {
        for i in 0..4 { m with { rotate y * 90 * i  translate <2 * i, 0, 0> } }
        sphere { center <3, 2, 0>  radius 1  hide camera }
        m with { scale 0.001  translate <1, 1, 1> }
    }
    for i in 0..40 {
        four with { rotate <20 * i, 7 * i, 0>  scale 1 + i / 20  translate <5 * cos(i), 3 * sin(2 * i), 4 * sin(i)> }
    }
    four with { scale <-1, 2, 0.5> }
    plane { normal <0, 1, 0.1>  offset -6 }
    sphere { center <0, 0, 0>  radius 2  material { transmit 1 } }
    torus { axis x  radii 4, 0.5 }
    difference { box { min <-1, -1, -1>  max <1, 1, 1> } sphere { center <1, 1, 1>  radius 1 } translate <0, 5, 0> }
    for i in 0..200 { sphere { center <9 * sin(i), 9 * sin(1.7 * i), 9 * sin(2.3 * i)>  radius 0.5 } }
";

#[test]
fn rays_cast_together_meet_of_a_scene_of_everything_what_they_meet_alone() {
    let evaluated = Session::default().evaluate_text("everything.scene", EVERYTHING);
    assert!(evaluated.diagnostics.is_empty(), "{:?}", evaluated.diagnostics);
    for accelerator in [Accelerator::Bvh, Accelerator::KdTree, Accelerator::None] {
        let world = world_of(evaluated.scene.nodes.clone(), accelerator);
        let n_met = agree(&world, "everything", 3000, (DVec3::ZERO, 12.0));
        assert!(n_met > 10_000, "{n_met}");
    }
}
