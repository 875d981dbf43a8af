//! Shapes as the scene has them to shapes as rays meet them, refused where they are degenerate.

use crate::scene;
use crate::world::shape::triangle::normal_of;
use crate::world::shape::{Cone, Cuboid, Disc, Plane, Rect, Shape, Sphere, Torus, Triangle};
use glam::DVec3;

/// The shape, or what is wrong with it. Groups and meshes are not shapes of this kind.
pub(super) fn convert(shape: scene::Shape) -> Result<Shape, String> {
    match shape {
        scene::Shape::Sphere { center, radius } => {
            let good = is_length(radius) && center.is_finite();
            check(good, || format!("a sphere of radius {radius} has no surface"))?;
            Ok(Shape::Sphere(Sphere { center, radius }))
        }
        scene::Shape::Plane { normal, offset } => {
            check(is_direction(normal) && offset.is_finite(), || "a plane needs a normal".into())?;
            Ok(Shape::Plane(Plane { normal, offset }))
        }
        scene::Shape::Disc(disc) => {
            let good = is_length(disc.radius) && is_direction(disc.normal) && disc.center.is_finite();
            check(good, || format!("a disc of radius {} has no surface", disc.radius))?;
            Ok(Shape::Disc(Box::new(Disc(*disc))))
        }
        scene::Shape::Rect(rect) => Rect::new(*rect)
            .map(|rect| Shape::Rect(Box::new(rect)))
            .ok_or_else(|| "the edges of this rect are parallel: it has no area".into()),
        scene::Shape::Box(corners) => {
            let (min, max) = *corners;
            let good = (max - min).is_finite() && (max - min).min_element() > 0.0;
            check(good, || "`min` must be less than `max` in each coordinate of a box".into())?;
            Ok(Shape::Cuboid(Box::new(Cuboid { min, max })))
        }
        scene::Shape::Triangle(triangle) => {
            let normal = normal_of(triangle.vertices);
            let good = normal.is_finite() && normal != DVec3::ZERO;
            check(good, || "the corners of this triangle lie on a line: it has no area".into())?;
            Ok(Shape::Triangle(Box::new(Triangle(*triangle))))
        }
        scene::Shape::Cone(cone) => Cone::new(*cone)
            .map(|cone| Shape::Cone(Box::new(cone)))
            .ok_or_else(|| "a cylinder or cone needs a length and a radius".into()),
        scene::Shape::Torus(torus) => {
            let good = torus.radii.into_iter().all(is_length)
                && is_direction(torus.axis)
                && torus.center.is_finite();
            check(good, || "a torus needs two positive radii".into())?;
            Ok(Shape::Torus(Box::new(Torus::new(*torus))))
        }
        scene::Shape::Mesh(_)
        | scene::Shape::Surface(_)
        | scene::Shape::Skin(_)
        | scene::Shape::Model(_)
        | scene::Shape::Group(_)
        | scene::Shape::Csg(_)
        | scene::Shape::Implicit(_) => Err("not a simple shape".into()),
    }
}

fn check(good: bool, fault: impl FnOnce() -> String) -> Result<(), String> {
    if good { Ok(()) } else { Err(fault()) }
}

fn is_length(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}

fn is_direction(v: DVec3) -> bool {
    v.is_finite() && v != DVec3::ZERO
}
