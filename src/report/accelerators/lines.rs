//! Rays through a mesh: from a camera, toward a light, diffusely on; and hard ones, through its edges and corners.

use super::subject::{Line, Subject};
use crate::diag::{SourceId, Span};
use crate::geometry::mesh::Mesh;
use crate::math::Aabb;
use crate::math::elementary::atan2;
use crate::math::random::Random;
use crate::scene::{Camera, Projection};
use crate::world::packet::RAYS;
use glam::DVec3;

/// A set of rays with its name, and whether any meeting will do.
pub struct Set {
    /// "camera", "together", "shadow" or "diffuse".
    pub name: &'static str,
    /// True of shadow rays.
    pub any: bool,
    /// True of rays that are asked as many at once as a packet has.
    pub together: bool,
    /// The rays.
    pub lines: Vec<Line>,
}

impl Set {
    /// Rays that are asked one by one what they meet first.
    pub fn new(name: &'static str, lines: Vec<Line>) -> Set {
        Set { name, any: false, together: false, lines }
    }

    /// How many of the rays meet something.
    pub fn met(&self, subject: &Subject<'_>) -> usize {
        if !self.together {
            return self.lines.iter().filter(|line| subject.meet(line, self.any).is_some()).count();
        }
        let mut met = 0;
        let each = self.lines.chunks(RAYS);
        each.for_each(|some| subject.meet_each(some, |_, found| met += usize::from(found.is_some())));
        met
    }
}

/// What keeps a ray that starts on a surface from it, as a share of the mesh's size.
const OFFSET: f64 = 1e-6;

fn vector(random: &mut Random) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)))
}

/// The camera that sees the whole mesh in a square picture: the half of its width is half as far as it is away.
pub fn view_of(mesh: &Mesh) -> Camera {
    let bounds = Aabb::of(mesh.positions.iter().copied());
    let (middle, reach) = (bounds.center(), bounds.size().length() / 2.0);
    Camera {
        label: None,
        eye: middle + DVec3::new(0.4, 0.5, 1.0).normalize() * reach * 2.0,
        look_at: middle,
        up: DVec3::Y,
        fov: 2.0 * atan2(1.0, 2.0).to_degrees(),
        projection: Projection::Perspective,
        aperture: 0.0,
        focus: None,
        span: Span::new(SourceId(0), 0, 0),
    }
}

/// Where the light stands.
pub fn light_of(mesh: &Mesh) -> DVec3 {
    let bounds = Aabb::of(mesh.positions.iter().copied());
    bounds.center() + DVec3::new(0.7, 1.0, 0.3) * bounds.size().length()
}

/// Rays of a square picture of the whole mesh, `side` a side, row by row.
pub fn camera(mesh: &Mesh, side: usize) -> Vec<Line> {
    let Camera { eye: origin, look_at, .. } = view_of(mesh);
    let forward = (look_at - origin).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let part = move |i: usize| (i as f64 + 0.5) / side as f64 - 0.5;
    let line = move |i: usize| {
        let direction = (forward + right * part(i % side) - up * part(i / side)).normalize();
        Line { origin, direction, t_max: f64::INFINITY }
    };
    (0..side * side).map(line).collect()
}

/// A place that a ray meets in a mesh of a size, kept from it by as much as new rays need.
fn place_of(line: &Line, t: f64, size: f64) -> DVec3 {
    line.origin + line.direction * (t - OFFSET * size)
}

/// The three sets: a picture of `side` by `side`, and from each place that it sees a ray to a light and one anywhere.
pub fn sets(mesh: &Mesh, seen_by: &Subject<'_>, side: usize) -> Vec<Set> {
    let camera = camera(mesh, side);
    let size = Aabb::of(mesh.positions.iter().copied()).size().length();
    let light = light_of(mesh);
    let mut random = Random::new(21);
    let (mut shadow, mut diffuse) = (Vec::new(), Vec::new());
    for line in &camera {
        let Some((t, _)) = seen_by.meet(line, false) else { continue };
        let origin = place_of(line, t, size);
        shadow.push(Line { origin, direction: light - origin, t_max: 1.0 });
        diffuse.push(Line { origin, direction: vector(&mut random), t_max: f64::INFINITY });
    }
    vec![
        Set::new("camera", camera),
        Set { any: true, ..Set::new("shadow", shadow) },
        Set::new("diffuse", diffuse),
    ]
}

/// Rays to the light from the places that a picture sees lit: those whose face is seen from the light's side.
pub fn lit(mesh: &Mesh, seen_by: &Subject<'_>, camera: &[Line]) -> Set {
    let size = Aabb::of(mesh.positions.iter().copied()).size().length();
    let light = light_of(mesh);
    let toward_light = |line: &Line| {
        let (t, triangle) = seen_by.meet(line, false)?;
        let [a, b, c] = mesh.triangles[triangle as usize].map(|p| mesh.positions[p as usize]);
        let normal = (b - a).cross(c - a);
        let origin = place_of(line, t, size);
        let direction = light - origin;
        let faces_light = normal.dot(direction) * -normal.dot(line.direction) > 0.0;
        faces_light.then_some(Line { origin, direction, t_max: 1.0 })
    };
    Set { any: true, ..Set::new("shadow", camera.iter().filter_map(toward_light).collect()) }
}

/// The rays of a square picture, square after square of pixels, each row by row, to be asked together. The side is a multiple of a square's.
pub fn in_squares(camera: &[Line], side: usize) -> Set {
    let square = RAYS.isqrt();
    let line = |i: usize| {
        let (place, within) = (i / RAYS, i % RAYS);
        let column = place % (side / square) * square + within % square;
        let row = place / (side / square) * square + within / square;
        camera[row * side + column]
    };
    Set { together: true, ..Set::new("together", (0..camera.len()).map(line).collect()) }
}

/// Rays anywhere through the mesh's surroundings; every eighth along an axis, every fourth from a corner of the mesh.
pub fn anywhere(mesh: &Mesh, n: usize, seed: u64) -> Vec<Line> {
    let bounds = Aabb::of(mesh.positions.iter().copied());
    let (middle, size) = (bounds.center(), bounds.size().max_element());
    let mut random = Random::new(seed);
    let line = |i: usize| {
        let from = match i % 4 {
            0 => mesh.positions[random.below(mesh.positions.len())],
            _ => middle + vector(&mut random) * size,
        };
        let direction = match i % 8 {
            1 => DVec3::AXES[random.below(3)] * random.sign(),
            _ => vector(&mut random),
        };
        Line { origin: from, direction, t_max: f64::INFINITY }
    };
    (0..n).map(line).collect()
}

/// Rays from around the mesh to its corners and to places on its edges, in turn.
pub fn at_edges(mesh: &Mesh, n: usize, seed: u64) -> Vec<Line> {
    let bounds = Aabb::of(mesh.positions.iter().copied());
    let (middle, size) = (bounds.center(), bounds.size().max_element());
    let mut random = Random::new(seed);
    let line = |i: usize| {
        let [a, b, _] =
            mesh.triangles[random.below(mesh.triangles.len())].map(|p| mesh.positions[p as usize]);
        let aim = if i.is_multiple_of(2) { a } else { a + (b - a) * random.unit() };
        let origin = middle + vector(&mut random) * size;
        Line { origin, direction: aim - origin, t_max: f64::INFINITY }
    };
    (0..n).map(line).collect()
}
