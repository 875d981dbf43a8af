//! Lines from a terminal: editing, history, and completion with Tab.

use super::orders::{ORDERS, Order};
use super::{Lines, Next, Talk, garbled, goes_on};
use crate::speech::{Failure, tell};
use ogee::lang::complete::{Visible, complete};
use ogee::syntax::unfinished::End;
use rustyline::completion::{Completer, FilenameCompleter, Pair};
use rustyline::error::ReadlineError;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::history::DefaultHistory;
use rustyline::validate::{ValidationContext, ValidationResult, Validator};
use rustyline::{CompletionType, Config, Context, Helper};
use std::collections::BTreeSet;
use std::io::ErrorKind;
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
        if let Some(assistant) = self.editor.helper_mut() {
            assistant.visible = talk.dialogue.visible();
        }
        let prompt = format!("{}> ", talk.n_lines + 1);
        match self.editor.readline(&prompt) {
            Ok(text) => {
                self.remember(&text);
                Ok(Next::Text(text))
            }
            Err(ReadlineError::Interrupted) => Ok(Next::Cancelled),
            Err(ReadlineError::Eof) => Ok(Next::End),
            Err(ReadlineError::Io(error)) if error.kind() == ErrorKind::InvalidData => {
                let message = "what was typed is not UTF-8 text, and the line is given up";
                Ok(Next::Garbled(0, garbled(message.into())))
            }
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
struct Assistant {
    visible: Visible,
    files: FilenameCompleter,
}

impl Helper for Assistant {}

impl Validator for Assistant {
    fn validate(&self, context: &mut ValidationContext<'_>) -> rustyline::Result<ValidationResult> {
        let open = goes_on(context.input());
        Ok(if open { ValidationResult::Incomplete } else { ValidationResult::Valid(None) })
    }
}

impl Completer for Assistant {
    type Candidate = Pair;

    fn complete(
        &self,
        line: &str,
        at: usize,
        context: &Context<'_>,
    ) -> rustyline::Result<(usize, Vec<Pair>)> {
        let before = &line[..at];
        let order = before.strip_prefix(':').map(|order| order.split_once(' '));
        let (start, words) = match order {
            Some(None) => (1, starting(&before[1..], ORDERS.iter().map(with_blank))),
            Some(Some(("load", _))) => return self.files.complete(line, at, context),
            Some(Some(("help", name))) => (at - name.len(), starting(name, ogee::lang::reference::names())),
            Some(Some(_)) | None if End::of(before).in_text() => {
                return self.files.complete(line, at, context);
            }
            Some(Some(_)) | None => {
                let found = complete(before, &self.visible);
                (found.start, found.words)
            }
        };
        let pair = |word: String| Pair { display: word.clone(), replacement: word };
        Ok((start, words.into_iter().map(pair).collect()))
    }
}

/// The words that begin as typed, in alphabetical order.
fn starting(typed: &str, words: impl Iterator<Item = impl Into<String>>) -> Vec<String> {
    let words: BTreeSet<String> = words.map(Into::into).filter(|word| word.starts_with(typed)).collect();
    words.into_iter().collect()
}

/// An order's word, with a blank where more follows.
fn with_blank(order: &Order) -> String {
    order.name.to_owned() + if order.argument.is_empty() { "" } else { " " }
}

impl Hinter for Assistant {
    type Hint = String;
}

impl Highlighter for Assistant {}
