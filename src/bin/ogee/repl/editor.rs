//! Lines from a terminal: editing, history, and completion with Tab.

use super::{Lines, Next, Talk, goes_on};
use crate::speech::{Failure, tell};
use rustyline::completion::Completer;
use rustyline::error::ReadlineError;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::history::DefaultHistory;
use rustyline::validate::{ValidationContext, ValidationResult, Validator};
use rustyline::{CompletionType, Config, Helper};
use std::path::PathBuf;

/// So many lines of history are kept.
const HISTORY: usize = 1000;

/// A line editor with its history.
pub struct Editor {
    editor: rustyline::Editor<Assistant, DefaultHistory>,
    history: Option<PathBuf>,
}

impl Editor {
    /// Takes hold of the terminal. A history that cannot be read or written is done without.
    pub fn open() -> Result<Self, Failure> {
        let failure = |error: ReadlineError| Failure::machine("cannot use the terminal", error);
        let config = Config::builder()
            .max_history_size(HISTORY)
            .and_then(|builder| builder.history_ignore_dups(true))
            .map_err(failure)?
            .history_ignore_space(true)
            .completion_type(CompletionType::List)
            .build();
        let mut editor = rustyline::Editor::with_config(config).map_err(failure)?;
        editor.set_helper(Some(Assistant::default()));
        let history = data_folder().map(|folder| folder.join("history"));
        if let Some(path) = &history {
            let _ = path.parent().map(std::fs::create_dir_all);
            let _ = editor.load_history(path);
        }
        tell(format!(
            "Ogee {}: an expression is answered with its value; `:help` tells more, Ctrl-D leaves",
            env!("CARGO_PKG_VERSION")
        ));
        Ok(Editor { editor, history })
    }

    fn remember(&mut self, text: &str) {
        if matches!(self.editor.add_history_entry(text.trim_end()), Ok(true))
            && let Some(path) = &self.history
        {
            let _ = self.editor.append_history(path);
        }
    }
}

impl Lines for Editor {
    fn next(&mut self, talk: &Talk<'_, '_>) -> Result<Next, Failure> {
        let prompt = format!("{}> ", talk.n_lines + 1);
        match self.editor.readline(&prompt) {
            Ok(text) => {
                self.remember(&text);
                Ok(Next::Text(text))
            }
            Err(ReadlineError::Interrupted) => Ok(Next::Cancelled),
            Err(ReadlineError::Eof) => Ok(Next::End),
            Err(error) => Err(Failure::machine("cannot read the terminal", error)),
        }
    }
}

/// The folder where a person's programs keep what is of use to them next time; none where the system names none.
fn data_folder() -> Option<PathBuf> {
    let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = match std::env::consts::OS {
        "windows" => variable("APPDATA"),
        "macos" => variable("HOME").map(|home| home.join("Library/Application Support")),
        _ => variable("XDG_DATA_HOME").or_else(|| Some(variable("HOME")?.join(".local/share"))),
    };
    Some(folder?.join("ogee"))
}

/// What the editor asks while a line is typed.
#[derive(Default)]
struct Assistant {}

impl Helper for Assistant {}

impl Validator for Assistant {
    fn validate(&self, context: &mut ValidationContext<'_>) -> rustyline::Result<ValidationResult> {
        let open = goes_on(context.input());
        Ok(if open { ValidationResult::Incomplete } else { ValidationResult::Valid(None) })
    }
}

impl Completer for Assistant {
    type Candidate = String;
}

impl Hinter for Assistant {
    type Hint = String;
}

impl Highlighter for Assistant {}
