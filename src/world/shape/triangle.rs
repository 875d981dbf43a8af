//! Triangles without holes between them.
//!
//! Woop, Benthin & Wald, *Watertight ray/triangle intersection*, JCGT 2(1), 2013, in f64: the ray is sheared onto an axis and
//! each edge is decided by the sign of a difference of two products of the shared corners, exactly where they are nearly equal,
//! so that two triangles with a common edge never both let a ray through. The point is found from the barycentric
//! coordinates and not from the distance, which is only as good as the longest axis.

pub mod cut;
pub mod leaf;
pub mod search;
mod surface;

pub use surface::{Corners, surface_of};

use super::{LocalRay, Meet, Surface};
use crate::math::Aabb;
use crate::math::error::gamma;
use crate::math::exact::difference_of_products;
use crate::scene;
use glam::DVec3;

/// A ray prepared for many triangles.
#[derive(Clone, Copy, Debug)]
pub struct Sheared {
    origin: DVec3,
    direction: DVec3,
    /// The ray's largest axis last, which is z after the shear; x and y are the two after it.
    axes: [usize; 3],
    /// The origin along them.
    start: [f64; 3],
    /// x and y of the direction over its z, and 1 over its z.
    shear: [f64; 3],
}

/// Distances below this share of the triangle's depth along the ray are found again from the plane: the sheared distance of a
/// sliver is off by u times its aspect, which stays below this share up to aspects of 2³⁰.
const NEAR: f64 = 1.0 / (1u64 << 22) as f64;

/// The two axes after each, and it.
const AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

impl Sheared {
    /// Prepares a ray.
    pub fn new(ray: &LocalRay) -> Sheared {
        let (o, d): (&[f64; 3], &[f64; 3]) = (ray.origin.as_ref(), ray.direction.as_ref());
        let size = ray.direction.abs();
        // Without branches: which axis is the largest cannot be foreseen.
        let beyond_x = 2 - usize::from(size.y > size.z);
        let is_x = (size.x > size.y) & (size.x > size.z);
        let along = if is_x { 0 } else { beyond_x };
        let axes = AXES[along];
        let inverse = 1.0 / d[along];
        let shear = [d[axes[0]] * inverse, d[axes[1]] * inverse, inverse];
        let start = axes.map(|axis| o[axis]);
        Sheared { origin: ray.origin, direction: ray.direction, axes, start, shear }
    }

    /// A corner relative to the ray: sheared x and y, and z unsheared.
    #[inline(always)]
    fn corner(&self, p: &DVec3) -> [f64; 3] {
        let (p, o): (&[f64; 3], _) = (p.as_ref(), &self.start);
        let [x, y, z] = self.axes;
        let z = p[z] - o[2];
        [(p[x] - o[0]) - self.shear[0] * z, (p[y] - o[1]) - self.shear[1] * z, z]
    }

    /// All three, one by one: mapping an array costs as much as the test.
    #[inline(always)]
    fn corners(&self, [a, b, c]: [&DVec3; 3]) -> [[f64; 3]; 3] {
        [self.corner(a), self.corner(b), self.corner(c)]
    }

    /// Where the ray meets the triangle, at a distance in (0, limit]; from either side.
    #[inline(always)]
    pub fn meet(&self, corners: [&DVec3; 3], limit: f64) -> Option<Meet> {
        let [a, b, c] = self.corners(corners);
        let mut u = c[0] * b[1] - c[1] * b[0];
        let mut v = a[0] * c[1] - a[1] * c[0];
        let mut w = b[0] * a[1] - b[1] * a[0];
        if (u == 0.0) | (v == 0.0) | (w == 0.0) {
            [u, v, w] = exact_sides(a, b, c);
        }
        // One branch: which edge a ray misses by cannot be foreseen.
        if ((u < 0.0) | (v < 0.0) | (w < 0.0)) & ((u > 0.0) | (v > 0.0) | (w > 0.0)) {
            return None;
        }
        self.meet_inside([u, v, w], [a[2], b[2], c[2]], limit, || {
            distance_by_plane(self.origin, self.direction, corners.map(|p| *p))
        })
    }

    /// The same from the sides of the edges that the ray is on, all one or 0, and how deep the corners lie. The distance `by_plane` is rarely asked for.
    #[inline(always)]
    fn meet_inside(
        &self,
        [u, v, w]: [f64; 3],
        [a, b, c]: [f64; 3],
        limit: f64,
        by_plane: impl FnOnce() -> Option<f64>,
    ) -> Option<Meet> {
        meet_inside(self.shear[2], [u, v, w], [a, b, c], limit, by_plane)
    }

    /// Whether a triangle that the ray meets also holds the ray moved by (ε, ε²) across its axis, ε as small as it takes. Of two
    /// triangles with a common edge one does, and of all those around a point of a closed surface as many go in as come out.
    pub fn is_owner(&self, corners: [&DVec3; 3]) -> bool {
        let [a, b, c] = self.corners(corners);
        let [u, v, w] = [side(c, b), side(a, c), side(b, a)];
        u != 0 && u == v && v == w
    }
}

/// Where a ray meets a triangle of whose edges it is on these sides, all one or 0, and whose corners lie so deep along its axis; by how far it goes for
/// one of depth. The distance `by_plane` is rarely asked for.
#[inline(always)]
fn meet_inside(
    per_depth: f64,
    [u, v, w]: [f64; 3],
    [a, b, c]: [f64; 3],
    limit: f64,
    by_plane: impl FnOnce() -> Option<f64>,
) -> Option<Meet> {
    let determinant = u + v + w;
    if determinant == 0.0 {
        return None;
    }
    let inverse = 1.0 / determinant;
    let sum = u * a + v * b + w * c;
    let mut t = sum * per_depth * inverse;
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let depth = larger(larger(a.abs(), b.abs()), c.abs()) * per_depth.abs();
    if t.abs() <= depth * NEAR {
        t = by_plane()?;
    }
    (t > 0.0 && t <= limit).then_some(Meet { t, a: v * inverse, b: w * inverse, face: 0, part: 0 })
}

/// From the triangle's plane through its nearest corner, for rays that start on or beside it; none where that is surely behind.
#[inline(never)]
fn distance_by_plane(origin: DVec3, direction: DVec3, corners: [DVec3; 3]) -> Option<f64> {
    if is_surely_behind(origin, direction, corners) {
        None
    } else {
        precise_distance(origin, direction, corners)
    }
}

/// Whether a triangle's plane is behind the ray's start, whatever plain arithmetic rounds: two products and a difference in the normal,
/// three products and two sums with it, and as many again where the accurate normal is used. Most rays that start on a triangle leave it.
#[inline(always)]
fn is_surely_behind(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let (e, f, to) = (b - a, c - a, a - origin);
    let reach = |v: DVec3| v.x.abs() + v.y.abs() + v.z.abs();
    // Of every corner, and of what the normal is made of.
    let far = reach(to) + reach(e) + reach(f);
    let size = reach(e) * reach(f) * gamma(16);
    let n = e.cross(f);
    let (to_plane, along) = (n.dot(to), n.dot(direction));
    to_plane * along < 0.0
        && to_plane.abs() > size * far + f64::MIN_POSITIVE
        && along.abs() > size * reach(direction) + f64::MIN_POSITIVE
}

#[cold]
fn precise_distance(origin: DVec3, direction: DVec3, corners: [DVec3; 3]) -> Option<f64> {
    let n = normal_of(corners);
    let nearest = corners
        .into_iter()
        .map(|p| p - origin)
        .min_by(|p, q| p.length_squared().total_cmp(&q.length_squared()))?;
    let t = n.dot(nearest) / n.dot(direction);
    t.is_finite().then_some(t)
}

/// Which side of each edge the ray is on, where plain products do not tell.
#[cold]
fn exact_sides(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> [f64; 3] {
    [
        difference_of_products(c[0], b[1], c[1], b[0]),
        difference_of_products(a[0], c[1], a[1], c[0]),
        difference_of_products(b[0], a[1], b[1], a[0]),
    ]
}

/// The sign of p × q in the plane across the ray, exactly; where the ray goes through the edge, of the ray moved to (ε, ε²). 0 only for
/// an edge that is a point there.
fn side(p: [f64; 3], q: [f64; 3]) -> i32 {
    let sign = |a: f64, b: f64| i32::from(a > b) - i32::from(a < b);
    match sign(difference_of_products(p[0], q[1], p[1], q[0]), 0.0) {
        0 => match sign(p[1], q[1]) {
            0 => sign(q[0], p[0]),
            across => across,
        },
        beside => beside,
    }
}

/// (b − a) × (c − a), each component to an ulp or two of the edges' own rounding. Not normalised.
pub fn normal_of([a, b, c]: [DVec3; 3]) -> DVec3 {
    let (e, f) = (b - a, c - a);
    DVec3::new(accurate(e.y, f.z, e.z, f.y), accurate(e.z, f.x, e.x, f.z), accurate(e.x, f.y, e.y, f.x))
}

/// ab − cd to 1.5 ulp (Kahan).
fn accurate(a: f64, b: f64, c: f64, d: f64) -> f64 {
    use crate::math::exact::two_product;
    let ((p, e), (q, f)) = (two_product(a, b), two_product(c, d));
    (p - q) + (e - f)
}

/// A triangle on its own.
#[derive(Clone, Copy, Debug)]
pub struct Triangle(pub scene::Triangle);

impl Triangle {
    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        Sheared::new(ray).meet(self.0.vertices.each_ref(), limit)
    }

    pub(super) fn surface(&self, meet: &Meet) -> Surface {
        let scene::Triangle { vertices, normals, uvs, .. } = &self.0;
        let data = Corners {
            normals: normals.as_ref().map(|all| all.each_ref()),
            uvs: uvs.as_ref().map(|all| all.each_ref()),
        };
        surface_of(vertices.each_ref(), data, meet, true)
    }

    pub(super) fn bounds(&self) -> Aabb {
        bounds_of(self.0.vertices)
    }
}

/// The box around corners, which are finite: exact, as no arithmetic is done.
#[inline]
pub fn bounds_of([a, b, c]: [DVec3; 3]) -> Aabb {
    let (low, high) =
        (|a: f64, b: f64| if b < a { b } else { a }, |a: f64, b: f64| if b > a { b } else { a });
    let each = |pick: fn(f64, f64) -> f64| {
        DVec3::new(pick(pick(a.x, b.x), c.x), pick(pick(a.y, b.y), c.y), pick(pick(a.z, b.z), c.z))
    };
    Aabb { min: each(low), max: each(high) }
}
