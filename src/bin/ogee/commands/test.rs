//! `ogee test`: the asserts of scenes, and their parse and picture against the snapshots beside them.
//!
//! Beside `arm.scene` stand `arm.ast.txt`, its syntax tree, and `arm.png`, its picture. A scene without a camera is a
//! library for others and has no picture. Pictures must agree in every pixel: the same scene gives the same bits.

use super::parsed;
use crate::args::Test;
use crate::place::Place;
use crate::speech::{Ended, Exit, Failure, reason, show, tell};
use ogee::render::compare::{Picture, compare, side_by_side};
use ogee::render::output::{self, Development, Format, Metadata};
use ogee::session::picture::{self, Job};
use ogee::syntax::print::print;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Tests each scene of the paths.
pub fn run(args: &Test) -> Ended {
    let mut scenes = Vec::new();
    for path in &args.paths {
        collect(path, &mut scenes)?;
    }
    if scenes.is_empty() {
        return Err(Failure::usage("there is no .scene file to test"));
    }
    let mut failed = 0;
    for scene in &scenes {
        let complaints = test(scene, args)?;
        failed += usize::from(!complaints.is_empty());
        match complaints.as_slice() {
            [] => tell(format!("ok      {}", scene.display())),
            some => tell(format!("FAILED  {}: {}", scene.display(), some.join("\n        "))),
        }
    }
    tell(format!("{} passed, {failed} failed", scenes.len() - failed));
    Ok(if failed > 0 { Exit::Scene } else { Exit::Done })
}

/// The scene of a path, or all that stand in a folder and its folders, in alphabetical order.
fn collect(path: &Path, scenes: &mut Vec<PathBuf>) -> Result<(), Failure> {
    if !path.is_dir() {
        super::try_to_read(path)?;
        scenes.push(path.to_owned());
        return Ok(());
    }
    let entries = std::fs::read_dir(path)
        .map_err(|error| Failure::machine(format!("cannot read {}", path.display()), reason(&error)))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for inner in paths {
        let is_hidden = inner.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if inner.is_dir() && !inner.is_symlink() && !is_hidden {
            collect(&inner, scenes)?;
        } else if inner.extension().is_some_and(|extension| extension == "scene") {
            scenes.push(inner);
        }
    }
    Ok(())
}

/// What is wrong with a scene, each in a sentence; with `--bless`, the snapshots are written instead.
fn test(scene: &Path, args: &Test) -> Result<Vec<String>, Failure> {
    let mut session = super::session(&args.evaluation);
    let evaluated = super::evaluate(&mut session, scene)?;
    if evaluated.has_errors() {
        show(&evaluated.diagnostics, &session.sources);
        return Ok(vec!["it has errors".to_owned()]);
    }
    let mut complaints = Vec::new();
    let tree = print(&parsed(scene, session.options.limits)?.tree);
    complaints.extend(check_tree(&scene.with_extension("ast.txt"), &tree, args.bless)?);
    if evaluated.scene.cameras.is_empty() {
        return Ok(complaints);
    }
    let job = Job::default();
    let settings = picture::settings(&evaluated.scene, &job).map_err(Failure::usage)?;
    let loader = session.loader().clone();
    let (prepared, found) = picture::prepare(evaluated.scene, &job, settings, &*loader);
    let Some(prepared) = prepared else {
        show(&found, &session.sources);
        complaints.push("it cannot be rendered".to_owned());
        return Ok(complaints);
    };
    let film = prepared.render(&(), &AtomicBool::new(false));
    let faults = picture::faults(&film);
    if !faults.is_empty() {
        show(&faults, &session.sources);
        complaints.push("its picture has undefined samples".to_owned());
    }
    let develop = Development { exposure: settings.exposure, tonemap: settings.tonemap };
    let png = output::encode(&film, Format::Png, &develop, &Metadata::default())
        .map_err(|error| Failure::machine("cannot encode a picture", error))?;
    complaints.extend(check_picture(&scene.with_extension("png"), &png, args.bless)?);
    Ok(complaints)
}

fn check_tree(file: &Path, tree: &str, bless: bool) -> Result<Option<String>, Failure> {
    match std::fs::read_to_string(file) {
        Ok(expected) if expected == tree => Ok(None),
        _ if bless => Place::try_at(file)?.write(tree.as_bytes()).map(|()| None),
        Ok(expected) => {
            let same = expected.lines().zip(tree.lines()).take_while(|(a, b)| a == b).count();
            Ok(Some(format!("its parse differs from {} from line {} on", file.display(), same + 1)))
        }
        Err(_) => Ok(Some(missing(file))),
    }
}

fn check_picture(file: &Path, png: &[u8], bless: bool) -> Result<Option<String>, Failure> {
    let apart = file.with_extension("diff.png");
    let complaint = match std::fs::read(file) {
        Err(_) if bless => Place::try_at(file)?.write(png).map(|()| None)?,
        Err(_) => Some(missing(file)),
        Ok(expected) => match differ(&expected, png)? {
            None => None,
            Some(_) if bless => Place::try_at(file)?.write(png).map(|()| None)?,
            Some((how, sheet)) => {
                Place::try_at(&apart)?.write(&sheet)?;
                return Ok(Some(format!(
                    "its picture differs from {}: {how}\n        expected | difference | actual: {}",
                    file.display(),
                    apart.display()
                )));
            }
        },
    };
    // A difference of an earlier run that is one no more would mislead; that it is not there is as well.
    let _ = std::fs::remove_file(apart);
    Ok(complaint)
}

fn missing(file: &Path) -> String {
    format!("there is no {} yet; `--bless` writes it", file.display())
}

/// How two pictures differ, and the sheet that shows it; none where they agree.
fn differ(expected: &[u8], actual: &[u8]) -> Result<Option<(String, Vec<u8>)>, Failure> {
    let decode = |bytes| Picture::decode(bytes);
    let actual = decode(actual).map_err(|fault| Failure::machine("cannot read our own picture", fault))?;
    let expected = match decode(expected) {
        Ok(expected) => expected,
        Err(fault) => return Ok(Some((fault.to_string(), sheet(&actual, &actual)?))),
    };
    let how = match compare(&actual, &expected) {
        Ok(difference) if difference.is_within(0.0) => return Ok(None),
        Ok(difference) => format!("RMSE {:.3e}, SSIM {:.4}", difference.rmse, difference.ssim),
        Err(fault) => fault.to_string(),
    };
    Ok(Some((how, sheet(&expected, &actual)?)))
}

fn sheet(expected: &Picture, actual: &Picture) -> Result<Vec<u8>, Failure> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let written = side_by_side(expected, actual).write_to(&mut bytes, image::ImageFormat::Png);
    written.map_err(|error| Failure::machine("cannot encode a picture", error))?;
    Ok(bytes.into_inner())
}
