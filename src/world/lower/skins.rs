//! Skins: cut into triangles at rest, moved by their bones, and then meshes like others. Curved surfaces are cut as finely as the picture and
//! the motion ask, so that what is seen is the bent surface and not a bent polyhedron.

use super::Lowering;
use super::surfaces::tolerance;
use super::views::Views;
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::mesh::Mesh;
use crate::geometry::patch::{Patch, tessellate};
use crate::geometry::skin::{Influences, Motion, WeightError, bent_normals, deform, refine};
use crate::math::{Aabb, Affine};
use crate::scene::{
    Material, MeshSource, PatchNet, SampledFunction, Skin, SkinSurface, Surface, Weights, divided_weights,
    unusable_weights,
};
use crate::world::kept::{Content, Of};
use crate::world::shape::Form;
use crate::world::shape::mesh::{MeshShape, Worn};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;

/// Skins by address; none where one cannot be used, which is said once.
#[derive(Default)]
pub(super) struct Skins(HashMap<*const Skin, (Option<u32>, Arc<Skin>)>);

/// What of the tolerance the surface at rest may use up; the rest is for the motion.
const REST_SHARE: f64 = 0.5;
/// The first, coarse cut of a curved surface, by its size: only to see where it is taken.
const COARSE: f64 = 1.0 / 64.0;
/// How fine a skin is that no camera sees, by its size.
const UNSEEN: f64 = 1.0 / 4096.0;

/// A curved surface that can be cut.
enum Curved {
    Patch(Arc<Patch>),
    Form(Box<Form>),
}

impl Curved {
    fn bounds(&self) -> Aabb {
        match self {
            Curved::Patch(patch) => patch.bounds(),
            Curved::Form(form) => form.bounds(),
        }
    }

    fn mesh(&self, tolerance: f64) -> Mesh {
        match self {
            Curved::Patch(patch) => tessellate::tessellate(patch, &|_| tolerance),
            Curved::Form(form) => form.mesh(tolerance),
        }
    }
}

impl Lowering<'_> {
    /// The aggregate of a skin.
    pub(super) fn skin(&mut self, skin: &Arc<Skin>, span: Span) -> Option<u32> {
        if let Some((known, _)) = self.skins.0.get(&Arc::as_ptr(skin)) {
            return *known;
        }
        let views = self.surfaces.views_of(skin);
        let content = self.kept.content(Of::Skin, |content| {
            content.skin(skin);
            let views = views.as_ref().filter(|_| matches!(skin.surface, SkinSurface::Curved(_)));
            content.maybe(views, |content, views| views.write(content));
        });
        let made = self.once(content, |lowering| lowering.bent(skin, views, span).map(Arc::new));
        let index = made.map(|bent| self.keep_shape(Arc::clone(&bent.shape), bent.materials.clone()));
        self.skins.0.insert(Arc::as_ptr(skin), (index, Arc::clone(skin)));
        index
    }

    /// A skin in its pose.
    fn bent(&mut self, skin: &Skin, views: Option<Views>, span: Span) -> Option<Bent> {
        let (mut mesh, materials) = match &skin.surface {
            SkinSurface::Mesh(source) => {
                let (mesh, materials) = self.mesh_at_rest(source)?;
                (placed(mesh, skin.transform.as_ref()), materials)
            }
            SkinSurface::Curved(surface) => {
                let curved = self.curved(surface, span)?;
                (self.said(skin, curved_at_rest(skin, &curved, views))?, Vec::new())
            }
        };
        let influences = self.said(skin, self.influences(skin, &mesh.positions))?;
        self.warn_of_sums(skin, &influences);
        let rest = mesh.positions.clone();
        let normals = match skin.weights.follow_the_point() {
            false => None,
            true => {
                let size = mesh.bounds().size().length();
                let images = |points: &[DVec3]| {
                    self.influences(skin, points).map(|weights| moved(skin, points, &weights))
                };
                let bent = bent_normals(&rest, &mesh.normals, size, &images);
                Some(self.said(skin, bent)?)
            }
        };
        deform(&mut mesh, &influences.rows, &skin.armature.motions, skin.blend);
        mesh.normals = normals.unwrap_or(mesh.normals);
        let rows = influences.rows.clone();
        let worn = Worn { rest, influences: rows, armature: Arc::clone(&skin.armature) };
        Some(Bent { shape: self.shape_of(mesh, Some(worn), span)?, materials })
    }

    /// The weights of points at rest, which a mesh has again in the next frame.
    fn influences(&self, skin: &Skin, points: &[DVec3]) -> Result<Arc<Rows>, WeightFault> {
        let is_mesh = matches!(skin.surface, SkinSurface::Mesh(_));
        let write = |content: &mut Content| {
            content.weights(&skin.weights);
            content.bones(&skin.armature);
            content.points(points);
        };
        let content = is_mesh.then(|| self.kept.content(Of::Weights, write)).flatten();
        if let Some(known) = self.kept.made(content.as_ref()) {
            return Ok(known);
        }
        let rows = Arc::new(influences(skin, points)?);
        self.kept.keep(content, &rows);
        Ok(rows)
    }

    fn mesh_at_rest(&mut self, source: &MeshSource) -> Option<(Mesh, Vec<Arc<Material>>)> {
        match source {
            MeshSource::Inline(mesh) => Some((mesh.clone(), Vec::new())),
            MeshSource::File { path, smooth, span } => self.read_mesh(&(path.clone(), *smooth), *span),
        }
    }

    fn curved(&mut self, surface: &Surface, span: Span) -> Option<Curved> {
        if let Surface::Patch(source) = surface {
            return match &source.net {
                PatchNet::Inline(patch) => Some(Curved::Patch(Arc::new(patch.clone()))),
                PatchNet::File { path, span } => self.patch_file(path, *span).map(Curved::Patch),
            };
        }
        self.form(surface, span).map(|form| Curved::Form(Box::new(form)))
    }

    /// Passes a value on, or says why there is none.
    fn said<T>(&mut self, skin: &Skin, made: Result<T, WeightFault>) -> Option<T> {
        made.map_err(|fault| self.sink.push(fault.said(skin))).ok()
    }

    fn warn_of_sums(&mut self, skin: &Skin, rows: &Rows) {
        let Some((point, sum)) = rows.off else { return };
        self.sink.push(divided_weights(place(skin), &at(point), sum));
    }
}

/// A skin in its pose, ready for rays, and the materials of its file.
struct Bent {
    shape: Arc<MeshShape>,
    materials: Vec<Arc<Material>>,
}

/// Rows of weights, and the first point whose sum was not 1.
struct Rows {
    rows: Influences,
    off: Option<(DVec3, f64)>,
}

/// Why a skin has no weights somewhere.
enum WeightFault {
    /// A row that cannot be used, and where it is.
    Row(WeightError, DVec3),
    /// A list of other length than the mesh.
    Count { rows: usize, vertices: usize },
    /// The function has no value there.
    NoValue(Span, String, DVec3),
}

impl WeightFault {
    fn said(self, skin: &Skin) -> Diagnostic {
        match self {
            WeightFault::Row(error, p) => unusable_weights(place(skin), &at(p), &error.to_string()),
            WeightFault::Count { rows, vertices } => {
                let message = format!("`weights` has {rows} rows for the {vertices} vertices of its mesh");
                Diagnostic::new(Code::BadWeights, place(skin), message).hint("give a row for each vertex")
            }
            WeightFault::NoValue(span, why, p) => {
                let message = format!("the weights {} have no value: {why}", at(p));
                Diagnostic::new(Code::BadWeights, span, message)
            }
        }
    }
}

/// A point's weights, by where it is.
fn at(p: DVec3) -> String {
    format!("at <{}, {}, {}>", p.x, p.y, p.z)
}

/// Where the weights were given.
fn place(skin: &Skin) -> Option<Span> {
    match &skin.weights {
        Weights::Listed(_, span) | Weights::Function(_, span) => Some(*span),
        Weights::Rigid | Weights::Smooth(_) => None,
    }
}

/// A curved surface cut at rest, so finely that bent it is true to the surface.
fn curved_at_rest(skin: &Skin, curved: &Curved, views: Option<Views>) -> Result<Mesh, WeightFault> {
    let transform = skin.transform.as_ref();
    let coarse = placed(curved.mesh(COARSE * curved.bounds().size().length()), transform);
    let image = Aabb::of(images(skin, &coarse.positions)?);
    let size = image.size().length();
    let allowed = match (skin.tolerance, views) {
        (Some(tolerance), _) => tolerance,
        (None, Some(views)) => tolerance(&views, image, size),
        (None, None) => UNSEEN * size,
    };
    let growth = skin.armature.motions.iter().map(Motion::growth).fold(1.0, f64::max);
    let stretch = transform.map_or(1.0, |place| place.stretch().1);
    let mut mesh = placed(curved.mesh(REST_SHARE * allowed / (growth * stretch)), transform);
    if skin.weights.follow_the_point() {
        refine(&mut mesh, (1.0 - REST_SHARE) * allowed, &|points| images(skin, points))?;
    }
    Ok(mesh)
}

/// Where points at rest are taken.
fn images(skin: &Skin, points: &[DVec3]) -> Result<Vec<DVec3>, WeightFault> {
    Ok(moved(skin, points, &influences(skin, points)?))
}

/// Where points of these weights are taken.
fn moved(skin: &Skin, points: &[DVec3], weights: &Rows) -> Vec<DVec3> {
    let mut moved = Mesh { positions: points.to_vec(), ..Mesh::default() };
    deform(&mut moved, &weights.rows, &skin.armature.motions, skin.blend);
    moved.positions
}

/// The weights of points at rest.
fn influences(skin: &Skin, points: &[DVec3]) -> Result<Rows, WeightFault> {
    let bones = &skin.armature.bones;
    let rows = match &skin.weights {
        Weights::Rigid => Influences::rigid(points, bones),
        Weights::Smooth(most) => Influences::smooth(points, bones, *most),
        Weights::Listed(rows, _) if rows.len() == points.len() => (**rows).clone(),
        Weights::Listed(rows, _) => {
            return Err(WeightFault::Count { rows: rows.len(), vertices: points.len() });
        }
        Weights::Function(function, _) => return by_function(function, points),
    };
    Ok(Rows { rows, off: None })
}

fn by_function(function: &SampledFunction, points: &[DVec3]) -> Result<Rows, WeightFault> {
    let mut all = Rows { rows: Influences::default(), off: None };
    let mut row = vec![0.0; function.field.n_outputs()];
    for p in points {
        function.field.eval(&p.to_array(), &mut row).map_err(|fault| {
            WeightFault::NoValue(function.place(fault), fault.kind.text().to_string(), *p)
        })?;
        let weights = row.iter().enumerate().map(|(joint, w)| (joint as u16, *w));
        let sum = all.rows.push(weights).map_err(|error| WeightFault::Row(error, *p))?;
        if (sum - 1.0).abs() > crate::geometry::skin::weights::SUM_SLACK {
            all.off.get_or_insert((*p, sum));
        }
    }
    Ok(all)
}

/// A mesh carried to where it stands among the bones.
fn placed(mut mesh: Mesh, transform: Option<&Affine>) -> Mesh {
    let Some(transform) = transform else { return mesh };
    mesh.positions.iter_mut().for_each(|p| *p = transform.point(*p));
    mesh.normals.iter_mut().for_each(|n| *n = transform.normal(*n).try_normalize().unwrap_or(*n));
    if transform.mirrors() {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    mesh
}
