//! Files that the command writes: their place is tried before the work begins, and no torn file is ever left there.

use crate::speech::{Failure, reason};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// The temporary file that is being written, for a command that has to end in the midst of it.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Removes the temporary file that is being written, where there is one.
pub fn forget_unfinished() {
    if let Ok(Some(path)) = UNFINISHED.lock().map(|mut path| path.take()) {
        // The command ends; nobody is left to hear that a file could not be removed.
        let _ = std::fs::remove_file(path);
    }
}

/// Where a file will be written.
pub enum Place {
    /// Standard output.
    Stdout,
    /// A file, by way of a temporary one beside it and a rename.
    File(PathBuf),
    /// Something that is there and is no file (a pipe, `/dev/null`), written to as it is.
    Device(PathBuf),
}

impl Place {
    /// Tries whether a file can be written there, and leaves nothing behind. `-` is standard output.
    pub fn try_at(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            return Ok(Place::Stdout);
        }
        // A link is followed, so that it stays a link; of one that leads nowhere the link itself is replaced.
        let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        match std::fs::metadata(&real) {
            Ok(meta) if meta.is_dir() => {
                return Err(Failure::machine(format!("cannot write {}", path.display()), "it is a folder"));
            }
            Ok(meta) if !meta.is_file() => return Ok(Place::Device(real)),
            Ok(_) | Err(_) => {}
        }
        if path.file_name().is_none() {
            return Err(Failure::usage(format!("`{}` names no file", path.display())));
        }
        temporary(&real).map_err(|error| cannot_write(path, &error))?;
        Ok(Place::File(real))
    }

    /// Writes all of the file, or nothing of it.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Place::Stdout => crate::speech::data(bytes),
            Place::File(path) => write_whole(path, bytes).map_err(|error| cannot_write(path, &error)),
            Place::Device(path) => write_device(path, bytes).map_err(|error| cannot_write(path, &error)),
        }
    }
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    let folder = folder_of(path);
    let why = match error.kind() {
        ErrorKind::NotFound if folder.is_dir() => format!("no file can be made in {}", folder.display()),
        ErrorKind::NotFound => format!("there is no folder {}", folder.display()),
        _ => reason(error),
    };
    Failure::machine(format!("cannot write {}", path.display()), why)
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A file beside `path`, with the permissions that a new file gets.
fn temporary(path: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".ogee-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    // The path that `tempfile` adds to its errors is of no use to a person: the caller names the real one.
    builder.tempfile_in(folder_of(path)).map_err(|error| match error.raw_os_error() {
        Some(code) => std::io::Error::from_raw_os_error(code),
        None => error.kind().into(),
    })
}

fn write_whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = temporary(path)?;
    note_unfinished(Some(file.path()));
    let written = file.write_all(bytes).and_then(|()| {
        if let Ok(meta) = std::fs::metadata(path) {
            file.as_file().set_permissions(meta.permissions())?;
        }
        Ok(())
    });
    let placed = written.and_then(|()| file.persist(path).map(drop).map_err(|error| error.error));
    note_unfinished(None);
    placed
}

fn note_unfinished(path: Option<&Path>) {
    if let Ok(mut unfinished) = UNFINISHED.lock() {
        *unfinished = path.map(Path::to_owned);
    }
}

fn write_device(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    std::fs::OpenOptions::new().write(true).open(path)?.write_all(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_that_was_tried_is_left_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let place = Place::try_at(&folder.path().join("a.png")).ok().unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        place.write(b"whole").ok().unwrap();
        assert_eq!(std::fs::read(folder.path().join("a.png")).unwrap(), b"whole");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_that_is_not_there_is_named_before_the_work_begins() {
        let failure = Place::try_at(Path::new("/no/such/folder/a.png")).err().unwrap();
        assert_eq!(failure.exit, crate::speech::Exit::Machine);
        assert!(failure.message.contains("there is no folder /no/such/folder"), "{}", failure.message);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_folder_that_takes_no_files_is_not_said_to_be_missing() {
        let failure = Place::try_at(Path::new("/proc/a.png")).err().unwrap();
        assert!(failure.message.ends_with("no file can be made in /proc"), "{}", failure.message);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_to_and_never_replaced() {
        let place = Place::try_at(Path::new("/dev/null")).ok().unwrap();
        place.write(b"gone").ok().unwrap();
        assert!(!std::fs::metadata("/dev/null").unwrap().is_file());
    }
}
