//! The lobe of a material: how much of the light from one direction goes on in each direction of the plane that holds the
//! normal, as the length of a ray.

use super::{Fault, stroke, wrong};
use crate::math::colour::luminance;
use crate::math::elementary::sin_cos_degrees;
use crate::plot::{Figure, Pen};
use crate::scene::{Material, Node, Object, Shape};
use crate::session::dialogue::Look;
use crate::world::bsdf::Bsdf;
use crate::world::{Ray, RayKind, World, WorldOptions};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Degrees from the surface to the surface, by halves.
const HALVES: i32 = 180;

/// A figure of the material seen from `angle` degrees off the normal: the luminance of what is sent there of light from
/// each direction, the cosine included; a smooth mirror or passage is a line as long as its share.
pub fn figure(look: &Look<'_, '_>, material: &Arc<Material>, angle: f64) -> Result<Figure, Fault> {
    if !(0.0..90.0).contains(&angle) {
        return Err(wrong(look, "the angle is in degrees off the normal, from 0 up to 90"));
    }
    let world = world(look, material);
    let (sin, cos) = sin_cos_degrees(angle);
    let from = DVec3::new(-sin, cos, 0.0);
    let ray = Ray { origin: from, direction: -from, t_max: f64::INFINITY, kind: RayKind::Camera };
    let hit = world.closest(&ray).ok_or_else(|| wrong(look, "the material's surface is met by no ray"))?;
    let bsdf = Bsdf::at(&world, &hit, &ray).map_err(|_| wrong(look, "the material has no value here"))?;
    Ok(drawn(&bsdf, from))
}

/// The plane y = 0 of this material.
fn world(look: &Look<'_, '_>, material: &Arc<Material>) -> World {
    let plane = Shape::Plane { normal: DVec3::Y, offset: 0.0 };
    let object = Object { material: Some(material.clone()), ..Object::new(plane, look.span) };
    World::new(vec![Node::Object(Arc::new(object))], &WorldOptions::default(), look.means.loader).0
}

fn drawn(bsdf: &Bsdf, from: DVec3) -> Figure {
    let lobe: Vec<DVec2> = (-HALVES..=HALVES)
        .map(|half| {
            let (sin, cos) = sin_cos_degrees(0.5 * f64::from(half));
            let to = DVec3::new(sin, cos, 0.0);
            DVec2::new(sin, cos) * luminance(bsdf.sent_on(to))
        })
        .collect();
    let middle = DVec2::splat(0.5);
    let smooth = [bsdf.mirrored(middle).filter(|_| !bsdf.is_glossy()), bsdf.transmitted(middle)];
    let lines: Vec<DVec2> =
        smooth.into_iter().flatten().map(|s| s.direction.truncate() * luminance(s.weight)).collect();
    let reach = lobe.iter().chain(&lines).map(|p| p.length()).fold(1e-3, f64::max);
    let mut strokes = vec![
        stroke(vec![DVec2::new(-reach, 0.0), DVec2::new(reach, 0.0)], Pen::Frame, false),
        stroke(vec![from.truncate() * reach, DVec2::ZERO], Pen::Aid, false),
    ];
    strokes.extend(lines.into_iter().map(|end| stroke(vec![DVec2::ZERO, end], Pen::Accent, false)));
    strokes.push(stroke(lobe, Pen::Curve, false));
    Figure {
        x_label: "along the surface".into(),
        y_label: "f cos".into(),
        strokes,
        same_scale: true,
        ..Figure::default()
    }
}
