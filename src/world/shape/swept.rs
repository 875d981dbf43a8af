//! Tubes, surfaces of revolution and prisms as rays meet them: the kernels of [`crate::geometry::surface`], with the errors of their points.

use super::{LocalRay, Meet, Surface, ahead, padded};
use crate::geometry::boxes::Line;
use crate::geometry::mesh::Mesh;
use crate::geometry::surface::Touch;
use crate::geometry::surface::lathe::Lathe;
use crate::geometry::surface::prism::Prism;
use crate::geometry::surface::sweep::Sweep;
use crate::geometry::surface::tube::Tube;
use crate::math::Aabb;
use crate::math::error::UNIT_ROUNDOFF;
use glam::DVec3;

/// A surface along curves. Large: shared between placements.
#[derive(Clone, Debug)]
pub struct Swept {
    form: Form,
    bounds: Aabb,
    /// Bound on the error of a point's coordinates.
    error: f64,
}

/// Its kernel.
#[derive(Clone, Debug)]
#[allow(
    missing_docs,
    clippy::large_enum_variant,
    reason = "each is named for its type, and shared behind one pointer"
)]
pub enum Form {
    Tube(Tube),
    Lathe(Lathe),
    Prism(Prism),
    Sweep(Sweep),
}

/// What a point may be off by, in u of the largest coordinate: a kernel's own roundings are some sixteen, and a tube's distance from its
/// centre is a difference of squares.
const POINT_ROUNDINGS: f64 = 512.0;

impl Form {
    /// The box around it, without the errors of points.
    pub fn bounds(&self) -> Aabb {
        match self {
            Form::Tube(tube) => tube.bounds(),
            Form::Lathe(lathe) => lathe.bounds(),
            Form::Prism(prism) => prism.bounds(),
            Form::Sweep(sweep) => sweep.bounds(),
        }
    }

    /// Triangles within the tolerance, with normals and (u, v).
    pub fn mesh(&self, tolerance: f64) -> Mesh {
        match self {
            Form::Tube(tube) => tube.mesh(tolerance),
            Form::Lathe(lathe) => lathe.mesh(tolerance),
            Form::Prism(prism) => prism.mesh(tolerance),
            Form::Sweep(sweep) => sweep.mesh(tolerance),
        }
    }
}

impl Swept {
    /// Ready for rays.
    pub fn new(form: Form) -> Swept {
        let size = match &form {
            Form::Tube(tube) => 2.0 * tube.size(),
            Form::Lathe(lathe) => lathe.size(),
            Form::Prism(prism) => prism.size(),
            Form::Sweep(sweep) => sweep.size(),
        };
        let error = POINT_ROUNDINGS * UNIT_ROUNDOFF * size;
        let bounds = padded(form.bounds(), DVec3::splat(error));
        Swept { form, bounds, error }
    }

    pub(super) fn meet(&self, ray: &LocalRay, limit: f64) -> Option<Meet> {
        let line = Line::new(ray.origin, ray.direction)?;
        let touch = match &self.form {
            Form::Tube(tube) => tube.first(&line, 0.0, limit),
            Form::Lathe(lathe) => lathe.first(&line, 0.0, limit),
            Form::Prism(prism) => prism.first(&line, 0.0, limit),
            Form::Sweep(sweep) => sweep.first(&line, 0.0, limit),
        };
        touch.filter(|touch| touch.t <= limit).map(|touch| meet_of(&touch))
    }

    pub(super) fn crossings(&self, ray: &LocalRay, out: &mut Vec<Meet>) {
        let Some(line) = Line::new(ray.origin, ray.direction) else { return };
        let all = match &self.form {
            Form::Tube(tube) => tube.all(&line),
            Form::Lathe(lathe) => lathe.all(&line),
            Form::Prism(prism) => prism.all(&line),
            Form::Sweep(sweep) => sweep.all(&line),
        };
        out.extend(all.iter().filter(|touch| ahead(touch.t)).map(meet_of));
    }

    pub(super) fn surface(&self, ray: &LocalRay, meet: &Meet) -> Surface {
        let line = Line::new(ray.origin, ray.direction).expect("this ray has met the surface");
        let touch = Touch { t: meet.t, part: meet.face, x: meet.a, y: meet.b };
        let at = match &self.form {
            Form::Tube(tube) => tube.surface(&line, &touch),
            Form::Lathe(lathe) => lathe.surface(&line, &touch),
            Form::Prism(prism) => prism.surface(&line, &touch),
            Form::Sweep(sweep) => sweep.surface(&line, &touch),
        };
        Surface {
            point: at.point,
            error: DVec3::splat(self.error),
            geometric_normal: at.normal,
            normal: at.normal,
            tangent: at.tangent,
            uv: at.uv.into(),
        }
    }

    /// Whether rays tell an inside.
    pub fn is_solid(&self) -> bool {
        match &self.form {
            Form::Tube(tube) => tube.is_solid(),
            Form::Lathe(lathe) => lathe.is_solid(),
            Form::Prism(_) | Form::Sweep(_) => true,
        }
    }

    /// Around all of it.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }
}

fn meet_of(touch: &Touch) -> Meet {
    Meet { t: touch.t, a: touch.x, b: touch.y, face: touch.part, ..Meet::default() }
}
