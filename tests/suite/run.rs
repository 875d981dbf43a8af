//! Runs the command as a person would, in a folder of its own.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// A folder that goes away with the test, and the command in it.
pub struct Folder(tempfile::TempDir);

/// What a run of the command gave.
pub struct Run {
    /// The exit code; none where a signal ended it.
    pub code: Option<i32>,
    pub stdout: Vec<u8>,
    pub stderr: String,
}

impl Folder {
    pub fn new() -> Self {
        Folder(tempfile::tempdir().expect("a temporary folder"))
    }

    /// With files in it.
    pub fn with(files: &[(&str, &str)]) -> Self {
        let folder = Folder::new();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).expect("a file in a temporary folder");
        }
        folder
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// The command with its arguments, split at spaces.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ogee"));
        command.args(arguments.split_whitespace()).current_dir(self.path()).stdin(Stdio::null());
        command
    }

    pub fn ogee(&self, arguments: &str) -> Run {
        Run::of(self.command(arguments).output().expect("the command runs"))
    }

    /// With a text on standard input.
    pub fn ogee_fed(&self, arguments: &str, input: &str) -> Run {
        let mut command = self.command(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the command runs");
        let mut stdin = child.stdin.take().expect("a piped input");
        stdin.write_all(input.as_bytes()).expect("the command reads its input");
        drop(stdin);
        Run::of(child.wait_with_output().expect("the command ends"))
    }

    /// A line of shell; `$OGEE` is the command.
    pub fn sh(&self, line: &str) -> Run {
        let mut command = Command::new("sh");
        command.args(["-c", line]).env("OGEE", env!("CARGO_BIN_EXE_ogee")).current_dir(self.path());
        Run::of(command.output().expect("a shell"))
    }

    /// The names of the files, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.path()).expect("the folder is there").flatten();
        let mut names: Vec<String> =
            entries.map(|e| e.file_name().into_string().expect("names of this test")).collect();
        names.sort();
        names
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}

impl Run {
    fn of(output: Output) -> Run {
        Run {
            code: output.status.code(),
            stdout: output.stdout,
            stderr: String::from_utf8(output.stderr).expect("what is said is UTF-8"),
        }
    }

    pub fn out(&self) -> &str {
        std::str::from_utf8(&self.stdout).expect("this output is text")
    }

    /// Panics with all that was said where the exit code is another.
    #[track_caller]
    pub fn expect(self, code: i32) -> Run {
        assert_eq!(self.code, Some(code), "{}\n{}", self.stderr, String::from_utf8_lossy(&self.stdout));
        self
    }

    /// The codes of all diagnostics that were said, in order.
    pub fn codes(&self) -> Vec<String> {
        let said = self.stderr.split("error[").skip(1).chain(self.stderr.split("warning[").skip(1));
        said.filter_map(|rest| rest.split_once(']')).map(|(code, _)| code.to_owned()).collect()
    }
}
