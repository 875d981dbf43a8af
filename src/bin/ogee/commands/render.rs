//! `ogee render`: a scene to a picture.

use crate::args::Render;
use crate::place::Place;
use crate::speech::{Ended, Exit, Failure, show};
use std::path::{Path, PathBuf};

/// Renders to the file that is asked for. Whatever can be known to fail is said before the work begins.
pub fn run(args: &Render) -> Ended {
    refuse_unbuilt(args)?;
    let output = args.output.clone().unwrap_or_else(|| default_output(&args.file));
    super::try_to_read(&args.file)?;
    let place = Place::try_at(&output)?;
    let mut session = super::session(&args.evaluation);
    let evaluated = super::evaluate(&mut session, &args.file)?;
    show(&evaluated.diagnostics, &session.sources);
    if evaluated.has_errors() {
        return Ok(Exit::Scene);
    }
    let _ = place;
    Err(Failure::not_built("`ogee render`"))
}

fn refuse_unbuilt(args: &Render) -> Result<(), Failure> {
    let asked = [
        ("--frames", args.frames.is_some()),
        ("--layers", args.layers.is_some()),
        ("--budget", args.budget.is_some()),
        ("--error", args.error.is_some()),
        ("--denoise", args.denoise),
    ];
    match asked.iter().find(|(_, given)| *given) {
        Some((flag, _)) => Err(Failure::not_built(&format!("`{flag}`"))),
        None => Ok(()),
    }
}

/// The scene's name with `.png`, in the current folder.
fn default_output(file: &Path) -> PathBuf {
    match file.file_stem() {
        Some(stem) if file != Path::new("-") => PathBuf::from(stem).with_extension("png"),
        _ => PathBuf::from("scene.png"),
    }
}
