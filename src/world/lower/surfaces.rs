//! Curved surfaces: each prepared once, however often it is placed.

use super::Lowering;
use super::views::{self, Views};
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::mesh::Mesh;
use crate::geometry::patch::{Patch, PatchTree, tessellate};
use crate::geometry::path::Path;
use crate::geometry::surface::cubic::of_measured;
use crate::geometry::surface::lathe::Lathe;
use crate::geometry::surface::outline::Outline;
use crate::geometry::surface::prism::{Placing, Prism};
use crate::geometry::surface::sweep::Sweep;
use crate::geometry::surface::tube::Tube;
use crate::math::Aabb;
use crate::scene::{Along, Node, PatchMethod, PatchNet, PatchSource, Surface};
use crate::world::Footprint;
use crate::world::kept::{Content, Of};
use crate::world::shape::{Form, PatchShape, Shape, Swept};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// What a surface is to rays.
#[derive(Clone)]
pub(super) enum Drawn {
    /// Itself.
    Shape(Shape),
    /// Triangles, by the number of their aggregate.
    Mesh(u32),
}

/// Surfaces by where they come from; none where one cannot be used, which is said once.
#[derive(Default)]
pub(super) struct Surfaces {
    /// By address; the source is kept so that no other takes its place.
    by_source: HashMap<*const Surface, (Option<Drawn>, Arc<Surface>)>,
    by_file: HashMap<PathBuf, Option<Arc<Patch>>>,
    views: HashMap<*const (), Views>,
}

/// Part of a pixel that triangles may be off by where nothing is said: under a quarter.
const PART_OF_PIXEL: f64 = 0.2;

/// No triangle is nearer to its piece than this part of the piece's size by intent: an eye in the surface itself would ask for no error at all.
const FINEST: f64 = 1.0 / (1u64 << 17) as f64;

impl Surfaces {
    /// Before any is lowered: from where each is seen, where a picture is made.
    pub fn of(nodes: &[Node], camera: Option<&Footprint>) -> Surfaces {
        Surfaces {
            views: camera.map(|camera| views::survey(nodes, camera)).unwrap_or_default(),
            ..Surfaces::default()
        }
    }
}

impl Surfaces {
    /// From where something that a tolerance is asked for is seen; none where nothing is known of that.
    pub fn views_of<T>(&mut self, source: &Arc<T>) -> Option<Views> {
        self.views.remove(&Arc::as_ptr(source).cast())
    }
}

/// The tolerance of triangles near a box, seen like this, of something of a size.
pub(super) fn tolerance(views: &Views, near: Aabb, size: f64) -> f64 {
    (PART_OF_PIXEL * views.pixel(near)).max(FINEST * size)
}

impl Lowering<'_> {
    /// What a surface is drawn as.
    pub(super) fn surface(&mut self, source: Arc<Surface>, span: Span) -> Option<Drawn> {
        let address = Arc::as_ptr(&source);
        if let Some((known, _)) = self.surfaces.by_source.get(&address) {
            return known.clone();
        }
        let views = self.surfaces.views_of(&source);
        let drawn = match &*source {
            Surface::Patch(patch) => self.patch(patch, views, span),
            Surface::Tube(_) | Surface::Lathe(_) | Surface::Extrude(_) => {
                self.swept(&source, span).map(|swept| Drawn::Shape(Shape::Swept(swept)))
            }
        };
        self.surfaces.by_source.insert(address, (drawn.clone(), source));
        drawn
    }

    /// A surface along curves, ready for rays.
    fn swept(&mut self, source: &Surface, span: Span) -> Option<Arc<Swept>> {
        let content = self.kept.content(Of::Swept, |content| content.surface(source));
        self.once(content, |lowering| Some(Arc::new(Swept::new(lowering.form(source, span)?))))
    }

    /// The kernel of a surface along curves; says why there is none.
    pub(super) fn form(&mut self, source: &Surface, span: Span) -> Option<Form> {
        let said = |fault| {
            let message = format!("this {} cannot be made: {fault}", source.word());
            self.sink.push(Diagnostic::new(Code::BadGeometry, span, message));
        };
        form(source).map_err(said).ok()
    }

    fn patch(&mut self, source: &PatchSource, views: Option<Views>, span: Span) -> Option<Drawn> {
        let patch = match &source.net {
            PatchNet::Inline(patch) => patch,
            PatchNet::File { path, span } => &*self.patch_file(path, *span)?,
        };
        if !PatchTree::would_hold(patch.pieces()) {
            let fault =
                Diagnostic::new(Code::BadGeometry, span, "this patch has no area: nothing of it is seen");
            self.sink.push(fault);
            return None;
        }
        match views {
            Some(views) if source.method != Some(PatchMethod::Direct) => {
                let views = views.settled(patch.bounds());
                let content = self.kept.content(Of::Tessellation, |content| {
                    content.patch(patch);
                    content.maybe(source.tolerance, Content::number);
                    views.write(content);
                });
                let make = |lowering: &mut Self| {
                    lowering.shape_of(tessellated(patch, source.tolerance, &views), None, span)
                };
                self.same_mesh(content, make).map(Drawn::Mesh)
            }
            _ => Some(Drawn::Shape(Shape::Patch(Arc::new(PatchShape::new(patch))))),
        }
    }

    /// The patches of a file, read once.
    pub(super) fn patch_file(&mut self, path: &PathBuf, span: Span) -> Option<Arc<Patch>> {
        if let Some(known) = self.surfaces.by_file.get(path) {
            return known.clone();
        }
        let patch = self.assets.patch(path, span).map_err(|fault| self.sink.push(*fault)).ok();
        self.surfaces.by_file.insert(path.clone(), patch.clone());
        patch
    }
}

/// A patch as triangles within a tolerance, or as finely as it is seen.
fn tessellated(patch: &Patch, allowed: Option<f64>, views: &Views) -> Mesh {
    match allowed {
        Some(allowed) => tessellate::tessellate(patch, &|_| allowed),
        None => tessellate::tessellate(patch, &|points| {
            let around = Aabb::of(points.iter().copied());
            tolerance(views, around, around.size().length())
        }),
    }
}

/// The kernel of a surface along curves. Its language looked for faults already; other makers may not have.
fn form(source: &Surface) -> Result<Form, String> {
    match source {
        Surface::Tube(tube) => {
            let (path, radius) = (of_measured(&tube.along), tube.radius.pieces());
            Tube::new(&path, &radius, tube.along.closed(), tube.caps)
                .map(Form::Tube)
                .map_err(|e| e.to_string())
        }
        Surface::Lathe(lathe) => {
            let profile = of_measured(&lathe.profile);
            let angle = (lathe.angle < 360.0).then(|| lathe.angle.to_radians());
            Lathe::new(&profile, lathe.profile.closed(), angle).map(Form::Lathe).map_err(|e| e.to_string())
        }
        Surface::Extrude(extrude) => {
            let outline = Outline::new(of_measured(&extrude.outline)).map_err(|e| e.to_string())?;
            match &extrude.along {
                Along::Vector(v) => {
                    let placing = Placing::across(*v).ok_or("it has no height")?;
                    Ok(Form::Prism(Prism::new(outline, placing, v.length())))
                }
                Along::Path(path) => {
                    Sweep::new(outline, path.path()).map(Form::Sweep).map_err(|e| e.to_string())
                }
            }
        }
        Surface::Patch(_) => Err("a patch is no such surface".into()),
    }
}
