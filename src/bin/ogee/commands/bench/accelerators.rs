//! `ogee bench accelerators`: trees against one another on meshes.

use super::{machine, make_results, write};
use crate::args::Accelerators;
use crate::commands;
use crate::speech::{Ended, Exit, Failure, tell};
use ogee::diag::{SourceId, Span};
use ogee::geometry::mesh::Mesh;
use ogee::report::accelerators::frames::frames;
use ogee::report::accelerators::meshes::{KINDS, procedural};
use ogee::report::accelerators::{AcceleratorRow, Plan, measure, over_pixels, page};
use ogee::report::row::Machine;
use ogee::report::store;
use ogee::scene::assets::{AssetCache, DiskLoader};
use std::path::Path;

/// The kind of mesh that shows how cost grows.
const GROWS: &str = "hills";
/// Triangles of each kind, and of the picture that grows: of the first alone where a minute must do.
const TRIANGLES: usize = 20_000;

/// Measures mesh after mesh. Results, page and plots are written whenever one is done, so that who has no time for the rest has those.
pub fn run(args: &Accelerators) -> Ended {
    let plan = match (args.quick, args.full) {
        (true, _) => Plan::QUICK,
        (_, true) => Plan::FULL,
        _ => Plan::USUAL,
    };
    let files: Vec<(String, Mesh)> = args.meshes.iter().map(|path| read(path)).collect::<Result<_, _>>()?;
    make_results(&args.out)?;
    let mut report = Report { out: &args.out, machine: machine(super::ACCELERATORS), rows: Vec::new() };
    let kinds = if args.quick { &KINDS[..1] } else { &KINDS[..] };
    for kind in kinds {
        if let Some(mesh) = procedural(kind, TRIANGLES) {
            report.add(framed(one(kind, &mesh, &plan), &mesh, &plan))?;
        }
    }
    for (name, mesh) in &files {
        report.add(framed(one(name, mesh, &plan), mesh, &plan))?;
    }
    growing(&plan, |rows| report.add(rows))?;
    tell(format!("wrote {}", args.out.join("index.md").display()));
    let wrong: usize = report.rows.iter().map(|row| row.wrong).sum();
    if wrong > 0 {
        tell(format!("{wrong} rays meet something else than by a test of every triangle"));
    }
    Ok(if wrong == 0 { Exit::Done } else { Exit::Scene })
}

/// A report under way.
struct Report<'a> {
    out: &'a Path,
    machine: Machine,
    rows: Vec<AcceleratorRow>,
}

impl Report<'_> {
    /// Adds rows and writes all that there are.
    fn add(&mut self, rows: Vec<AcceleratorRow>) -> Result<(), Failure> {
        self.rows.extend(rows);
        write(self.out, &store::write(&self.machine, &self.rows, |row| &row.mesh))?;
        write(self.out, &page::render(&self.machine, &self.rows))
    }
}

fn one(name: &str, mesh: &Mesh, plan: &Plan) -> Vec<AcceleratorRow> {
    tell(format!("{name}: {} triangles", mesh.triangles.len()));
    measure(name, mesh, plan)
}

/// With whole pictures of the mesh, which are told of the first tree, that of scenes.
fn framed(mut rows: Vec<AcceleratorRow>, mesh: &Mesh, plan: &Plan) -> Vec<AcceleratorRow> {
    rows[0].frames = frames(mesh, plan);
    rows
}

/// How cost grows with triangles, and with pixels.
fn growing(
    plan: &Plan,
    mut done: impl FnMut(Vec<AcceleratorRow>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let name = format!("growing {GROWS}");
    for mesh in plan.sizes.iter().filter_map(|size| procedural(GROWS, *size)) {
        let grown = |row| AcceleratorRow { grows: "triangles".into(), ..row };
        done(one(&name, &mesh, plan).into_iter().map(grown).collect())?;
    }
    if let Some(mesh) = procedural(GROWS, TRIANGLES) {
        let hear = |side| tell(format!("{name}: {side} × {side} pixels"));
        done(over_pixels(&name, &mesh, plan, hear))?;
    }
    Ok(())
}

/// A file's mesh, with its name.
pub fn read(path: &Path) -> Result<(String, Mesh), Failure> {
    commands::try_to_read(path)?;
    let loader = DiskLoader;
    let nowhere = Span::new(SourceId(0), 0, 0);
    let loaded = AssetCache::new(&loader)
        .mesh(path, None, nowhere)
        .map_err(|fault| Failure { exit: Exit::Scene, message: fault.message.to_string() })?;
    let name = path.file_stem().map_or_else(|| "mesh".into(), |stem| stem.to_string_lossy().into_owned());
    Ok((name, loaded.mesh.clone()))
}
