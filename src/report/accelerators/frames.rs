//! Whole pictures beside the rays in them alone: how much of the time of `raycast` and `whitted` the search for what rays meet takes. A matt mesh as
//! the camera of the rays' sets sees it, under their light, one sample a pixel, on one thread.

use super::Plan;
use super::lines::{Set, camera, in_squares, light_of, lit, view_of};
use super::subject::{Builder, Subject};
use crate::diag::{SourceId, Span};
use crate::geometry::mesh::Mesh;
use crate::render::camera::View;
use crate::render::settings::ResolvedSettings;
use crate::render::tiles::{self, Picture, Watch};
use crate::render::{Tracer, tracer};
use crate::scene::assets::DiskLoader;
use crate::scene::{Light, LightSource, MeshSource, Node, Object, RenderSettings, Rgb, Shape, TracerKind};
use crate::world::{World, WorldOptions};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// A picture of a mesh by one tracer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FrameRow {
    /// "raycast" or "whitted".
    pub tracer: String,
    /// Rays of the picture.
    pub rays: u64,
    /// Seconds of its tiles, in the fastest round.
    pub seconds: f64,
    /// Seconds of the same rays alone, one by one.
    pub one_by_one: f64,
    /// The same with those of the camera sixteen at once, as the picture's are.
    pub together: f64,
}

const TRACERS: [TracerKind; 2] = [TracerKind::Raycast, TracerKind::Whitted];

/// The picture of a mesh by each tracer, all timed in turn.
pub fn frames(mesh: &Mesh, plan: &Plan) -> Vec<FrameRow> {
    let scene = Seen::new(mesh, plan.side);
    let subject = Subject::new(mesh, Builder::Bvh);
    let camera = Set::new("camera", camera(mesh, plan.side));
    let (together, lit) = (in_squares(&camera.lines, plan.side), lit(mesh, &subject, &camera.lines));
    let tracers = TRACERS.map(|kind| scene.tracer(kind));
    let mut rays = [[0; 2]; TRACERS.len()];
    let (mut alone, mut whole) = ([f64::INFINITY; 3], [f64::INFINITY; TRACERS.len()]);
    for _ in 0..plan.rounds.max(1) {
        for (set, best) in [&camera, &together, &lit].into_iter().zip(&mut alone) {
            *best = best.min(seconds(|| std::hint::black_box(set.met(&subject))).1);
        }
        for ((tracer, best), rays) in tracers.iter().zip(&mut whole).zip(&mut rays) {
            let (film, seconds) = seconds(|| scene.render(&**tracer));
            *best = best.min(seconds);
            *rays = [film.report.rays.total(), film.report.rays.shadow];
        }
    }
    let [camera, together, shadow] = alone;
    let row = |(i, kind): (usize, TracerKind)| {
        let [rays, shadows] = rays[i];
        let shadow = shadow * shadows as f64 / lit.lines.len().max(1) as f64;
        let (one_by_one, together) = (camera + shadow, together + shadow);
        FrameRow { tracer: kind.word().into(), rays, seconds: whole[i], one_by_one, together }
    };
    TRACERS.into_iter().enumerate().map(row).collect()
}

fn seconds<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let started = Instant::now();
    (work(), started.elapsed().as_secs_f64())
}

/// A mesh as pictures of it are made.
struct Seen {
    world: World,
    view: View,
    settings: ResolvedSettings,
}

impl Seen {
    fn new(mesh: &Mesh, side: usize) -> Seen {
        let span = Span::new(SourceId(0), 0, 0);
        let object = Object::new(Shape::Mesh(Arc::new(MeshSource::Inline(mesh.clone()))), span);
        let light = Light {
            source: LightSource::Point { position: light_of(mesh), intensity: Rgb::ONE },
            falloff: None,
            shadow: true,
            samples: 1,
            transform: None,
            span,
        };
        let nodes = vec![Node::Object(Arc::new(object)), Node::Light(Arc::new(light))];
        let (world, _) = World::new(nodes, &WorldOptions::default(), &DiskLoader);
        let asked = RenderSettings {
            size: Some([side as u32; 2]),
            samples: Some(1),
            depth: Some(2),
            ..RenderSettings::default()
        };
        let settings = ResolvedSettings::new(&asked, &RenderSettings::default());
        let settings = ResolvedSettings { threads: Some(1), ..settings };
        let view = View::new(&view_of(mesh), settings.size).expect("a mesh has a size");
        Seen { world, view, settings }
    }

    fn tracer(&self, kind: TracerKind) -> Box<dyn Tracer> {
        let watch = Watch { progress: &(), cancel: &AtomicBool::new(false) };
        tracer(kind, &self.world, &self.view, &self.settings, watch).expect("nobody calls it off")
    }

    fn render(&self, tracer: &dyn Tracer) -> crate::render::film::Film {
        let picture = Picture { world: &self.world, view: &self.view, tracer, settings: &self.settings };
        tiles::render(picture, &(), &AtomicBool::new(false))
    }
}

#[cfg(test)]
mod tests {
    use super::super::meshes::procedural;
    use super::*;

    #[test]
    fn the_sets_hold_the_rays_of_the_picture() {
        let plan = Plan { side: 48, rounds: 1, ..Plan::QUICK };
        for kind in ["ball", "hills"] {
            let mesh = procedural(kind, 3000).expect("a kind");
            let lines = camera(&mesh, plan.side);
            let lit = lit(&mesh, &Subject::new(&mesh, Builder::Bvh), &lines);
            let seen = Seen::new(&mesh, plan.side);
            for (i, line) in lines.iter().enumerate() {
                let place = glam::DVec2::new((i % plan.side) as f64 + 0.5, (i / plan.side) as f64 + 0.5);
                let ray = seen.view.ray(place, glam::DVec2::ZERO).expect("a perspective");
                let off = (ray.direction - line.direction).length() + (ray.origin - line.origin).length();
                assert!(off < 1e-12, "{kind}, ray {i}: {off}");
            }
            let rows = frames(&mesh, &plan);
            let n = lines.len() as u64;
            assert_eq!(rows.iter().map(|row| &*row.tracer).collect::<Vec<_>>(), ["raycast", "whitted"]);
            assert_eq!([rows[0].rays, rows[1].rays], [n, n + lit.lines.len() as u64], "{kind}");
            assert!(lit.lines.len() > 500, "{kind}: {}", lit.lines.len());
        }
    }
}
