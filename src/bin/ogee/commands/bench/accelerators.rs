//! `ogee bench accelerators`: trees against one another on meshes.

use super::{machine, make_results, write};
use crate::args::Accelerators;
use crate::commands;
use crate::speech::{Ended, Exit, Failure, tell};
use ogee::diag::{SourceId, Span};
use ogee::geometry::mesh::Mesh;
use ogee::report::accelerators::meshes::{KINDS, procedural};
use ogee::report::accelerators::{AcceleratorRow, Plan, measure, over_pixels, over_sizes, page};
use ogee::report::store;
use ogee::scene::assets::{AssetCache, DiskLoader};
use std::path::Path;

/// The kind of mesh that shows how cost grows.
const GROWS: &str = "hills";
/// Triangles of each kind, and of the picture that grows: of the first alone where a minute must do.
const TRIANGLES: usize = 20_000;

/// Measures all meshes, then writes results, page and plots.
pub fn run(args: &Accelerators) -> Ended {
    let plan = match (args.quick, args.full) {
        (true, _) => Plan::QUICK,
        (_, true) => Plan::FULL,
        _ => Plan::USUAL,
    };
    let files: Vec<(String, Mesh)> = args.meshes.iter().map(|path| read(path)).collect::<Result<_, _>>()?;
    make_results(&args.out)?;
    let machine = machine(super::ACCELERATORS);
    let mut rows = growing(&plan);
    let kinds = if args.quick { &KINDS[..1] } else { &KINDS[..] };
    for kind in kinds {
        rows.extend(procedural(kind, TRIANGLES).map(|mesh| one(kind, &mesh, &plan)).unwrap_or_default());
    }
    for (name, mesh) in &files {
        rows.extend(one(name, mesh, &plan));
    }
    write(&args.out, &store::write(&machine, &rows, |row| &row.mesh))?;
    write(&args.out, &page::render(&machine, &rows))?;
    tell(format!("wrote {}", args.out.join("index.md").display()));
    let wrong: usize = rows.iter().map(|row| row.wrong).sum();
    if wrong > 0 {
        tell(format!("{wrong} rays meet something else than by a test of every triangle"));
    }
    Ok(if wrong == 0 { Exit::Done } else { Exit::Scene })
}

fn one(name: &str, mesh: &Mesh, plan: &Plan) -> Vec<AcceleratorRow> {
    tell(format!("{name}: {} triangles", mesh.triangles.len()));
    measure(name, mesh, plan)
}

/// How cost grows with triangles, and with pixels.
fn growing(plan: &Plan) -> Vec<AcceleratorRow> {
    let name = format!("growing {GROWS}");
    let hear = |size| tell(format!("{name}: {size} triangles"));
    let mut rows = over_sizes(&name, plan, |size| procedural(GROWS, size), hear);
    if let Some(mesh) = procedural(GROWS, TRIANGLES) {
        tell(format!("{name}: pictures"));
        rows.extend(over_pixels(&name, &mesh, plan));
    }
    rows
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
