//! One file for each command, and what those that read scenes share.

pub mod ast;
pub mod bench;
pub mod check;
pub mod compare;
pub mod docs;
pub mod eval;
pub mod explain;
pub mod fmt;
pub mod inspect;
pub mod render;
pub mod shell;
pub mod stats;
pub mod test;

use crate::args::{Evaluation, LimitName};
use crate::speech::{Failure, reason, tell};
use ogee::diag::{Code, Diagnostic, SourceId, SourceMap};
use ogee::scene::assets::DiskLoader;
use ogee::session::{Evaluated, Limits, Options, Session};
use ogee::syntax::ast::File;
use ogee::syntax::build::{ParseLimits, parse_file};
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// A session with the options of the command line.
pub fn session(evaluation: &Evaluation) -> Session {
    let mut options = Options { set: evaluation.set.clone(), ..Options::default() };
    options.time = evaluation.time.unwrap_or(options.time);
    for &(name, value) in &evaluation.limit {
        let count = usize::try_from(value).unwrap_or(usize::MAX);
        match name {
            LimitName::Nesting => options.limits.nesting = count,
            LimitName::Calls => options.limits.calls = count,
            LimitName::Turns => options.limits.turns = value,
            LimitName::List => options.limits.list = count,
            LimitName::File => options.limits.file = value,
            LimitName::Memory => options.limits.memory = value,
            LimitName::Placements => options.limits.placements = value,
        }
    }
    Session::new(options, Arc::new(DiskLoader))
}

/// Evaluates a scene that the command line names, and says what it prints.
fn evaluate(session: &mut Session, file: &Path) -> Result<Evaluated, Failure> {
    try_to_read(file)?;
    let evaluated = session.evaluate_file(file);
    evaluated.printed.iter().for_each(tell);
    Ok(evaluated)
}

/// The bytes of a file that the command line names; `-` is standard input.
fn read(file: &Path) -> Result<Vec<u8>, Failure> {
    try_to_read(file)?;
    let mut bytes = Vec::new();
    let outcome = match file == Path::new("-") {
        true => std::io::stdin().lock().read_to_end(&mut bytes).map(drop),
        false => std::fs::read(file).map(|read| bytes = read),
    };
    outcome.map_err(|error| cannot_read(file, &error))?;
    Ok(bytes)
}

/// Tells at once where a file of the command line cannot be read: that is no fault of a scene.
pub fn try_to_read(file: &Path) -> Result<(), Failure> {
    if file == Path::new("-") {
        return Ok(());
    }
    if file.is_dir() {
        return Err(Failure::machine(format!("cannot read {}", file.display()), "it is a folder"));
    }
    std::fs::File::open(file).map(drop).map_err(|error| cannot_read(file, &error))
}

fn cannot_read(file: &Path, error: &std::io::Error) -> Failure {
    let mut failure = Failure::machine(format!("cannot read {}", file.display()), reason(error));
    if error.kind() == std::io::ErrorKind::NotFound
        && let Some(near) = nearest_file(file)
    {
        failure.message += &format!("\ndid you mean {}?", near.display());
    }
    failure
}

/// The file of the same folder whose name is nearest.
fn nearest_file(file: &Path) -> Option<std::path::PathBuf> {
    let folder = file.parent()?;
    let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(listed).ok()?.flatten().filter(|e| e.path().is_file());
    let names: Vec<String> = entries.filter_map(|e| e.file_name().into_string().ok()).collect();
    let wanted = file.file_name()?.to_str()?;
    let near = ogee::diag::nearest(wanted, names.iter().map(String::as_str))?;
    Some(folder.join(near))
}

/// A file as it was read: its tree, whole or in part, and the faults of its text.
struct Parsed {
    sources: SourceMap,
    id: SourceId,
    limits: ParseLimits,
    tree: File,
    diagnostics: Vec<Diagnostic>,
}

/// Reads the syntax tree of a file, imports left alone.
fn parsed(file: &Path, limits: Limits) -> Result<Parsed, Failure> {
    let mut sources = SourceMap::default();
    let name = if file == Path::new("-") { "<stdin>".into() } else { file.display().to_string() };
    let (text, mut diagnostics) = match String::from_utf8(read(file)?) {
        Ok(text) => (text, Vec::new()),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let message = format!("{name} is not UTF-8 text: byte {at} begins no character");
            (String::new(), vec![Diagnostic::new(Code::NotUtf8, None, message)])
        }
    };
    let id = sources.add(name, text.as_str());
    let limits = ParseLimits::nesting(limits.nesting);
    let (tree, found) = parse_file(id, &text, limits);
    diagnostics.extend(found);
    Ok(Parsed { sources, id, limits, tree, diagnostics })
}
