//! The orders of the REPL: words that begin with `:`.

use super::{Flow, Talk};
use crate::speech::{Failure, data, tell, tell_failure};
use std::path::Path;
use std::time::Instant;

/// An order.
pub struct Order {
    /// Its word, without the colon.
    pub name: &'static str,
    /// What stands behind it.
    pub argument: &'static str,
    /// What it does, in a line.
    doc: &'static str,
    obey: fn(&mut Talk<'_, '_>, &Given<'_>) -> Result<Flow, Failure>,
}

/// What stands behind an order.
struct Given<'g> {
    /// The whole line.
    line: &'g str,
    /// Where in it the argument begins.
    at: usize,
    /// The argument, without blanks around it.
    argument: &'g str,
    /// Lines before this one.
    first_line: usize,
}

impl Given<'_> {
    /// The argument with blanks before it, so that its columns are those of the line.
    fn in_place(&self) -> String {
        " ".repeat(self.line[..self.at].chars().count()) + self.argument
    }
}

/// All of them.
pub const ORDERS: &[Order] = &[
    Order {
        name: "help",
        argument: "[NAME]",
        doc: "this list; the page of a block, function or constant",
        obey: help,
    },
    Order { name: "load", argument: "FILE", doc: "evaluate a file as if its items stood here", obey: load },
    Order { name: "names", argument: "", doc: "the names in scope", obey: names },
    Order {
        name: "plot",
        argument: "EXPR[, FROM, TO] [comb] [polygon] [blossom T] [--to FILE]",
        doc: "draw a function or curve",
        obey: plot,
    },
    Order { name: "quit", argument: "", doc: "leave, as Ctrl-D does", obey: |_, _| Ok(Flow::Quit) },
    Order {
        name: "reload",
        argument: "",
        doc: "read all loaded files again, into an empty scope",
        obey: reload,
    },
    Order {
        name: "scene",
        argument: "",
        doc: "what was placed so far, as `ogee inspect` shows it",
        obey: scene,
    },
    Order { name: "time", argument: "EXPR", doc: "evaluate, and tell how long it took", obey: time },
    Order { name: "type", argument: "EXPR", doc: "the sort of a value; changes nothing", obey: sort },
];

/// Does what an order says.
pub fn obey(talk: &mut Talk<'_, '_>, line: &str, first_line: usize) -> Result<Flow, Failure> {
    let order = line.trim_start().strip_prefix(':').unwrap_or(line);
    let (word, rest) = order.split_once(char::is_whitespace).unwrap_or((order.trim_end(), ""));
    let argument = rest.trim();
    let at = line.len() - rest.trim_start().len();
    let given = Given { line, at, argument, first_line };
    match ORDERS.iter().find(|order| order.name == word) {
        Some(order) if order.argument.is_empty() && !argument.is_empty() => {
            Ok(refuse(talk, &format!("`:{word}` stands alone")))
        }
        Some(order) if needs_argument(order) && argument.is_empty() => {
            Ok(refuse(talk, &format!("write `:{word} {}`", order.argument)))
        }
        Some(order) => (order.obey)(talk, &given),
        None => {
            let near = ogee::diag::nearest(word, ORDERS.iter().map(|order| order.name));
            let hint =
                near.map_or("`:help` lists the orders".into(), |near| format!("did you mean `:{near}`?"));
            Ok(refuse(talk, &format!("there is no order `:{word}`\n{hint}")))
        }
    }
}

fn needs_argument(order: &Order) -> bool {
    !order.argument.is_empty() && !order.argument.starts_with('[')
}

pub(super) fn refuse(talk: &mut Talk<'_, '_>, message: &str) -> Flow {
    tell_failure(&Failure::usage(message));
    talk.failed = true;
    Flow::On
}

/// The order that a person means who forgets the colon.
pub fn meant(line: &str) -> Option<&'static str> {
    match line {
        "help" | "?" => Some("help"),
        "quit" | "exit" | "q" => Some("quit"),
        _ => None,
    }
}

fn help(talk: &mut Talk<'_, '_>, given: &Given<'_>) -> Result<Flow, Failure> {
    let name = given.argument;
    if name.is_empty() {
        data(listed())?;
        return Ok(Flow::On);
    }
    match crate::commands::docs::page(name) {
        Ok(page) => data(page)?,
        Err(failure) => return Ok(refuse(talk, &failure.message)),
    }
    Ok(Flow::On)
}

fn listed() -> String {
    let form = |order: &Order| format!(":{} {}", order.name, order.argument);
    let width = ORDERS.iter().map(|order| form(order).len()).max().unwrap_or(0);
    let mut text: String =
        ORDERS.iter().map(|order| format!("{:width$}  {}\n", form(order), order.doc)).collect();
    text.push_str(
        "\nAny item of a scene may be typed; what is open at the end of a line goes on in the next.\n\
         A line that fails changes nothing. Ctrl-C gives up a line or what is running.\n",
    );
    text
}

fn load(talk: &mut Talk<'_, '_>, given: &Given<'_>) -> Result<Flow, Failure> {
    let path = unquoted(given.argument);
    if let Err(failure) = crate::commands::try_to_read(Path::new(path)) {
        return Ok(refuse(talk, &failure.message));
    }
    talk.answer(|dialogue| dialogue.file(Path::new(path)))?;
    Ok(Flow::On)
}

fn reload(talk: &mut Talk<'_, '_>, _: &Given<'_>) -> Result<Flow, Failure> {
    talk.answer(|dialogue| dialogue.reload())?;
    Ok(Flow::On)
}

fn names(talk: &mut Talk<'_, '_>, _: &Given<'_>) -> Result<Flow, Failure> {
    data(talk.dialogue.names().iter().map(|name| format!("{name}\n")).collect::<String>())?;
    Ok(Flow::On)
}

fn scene(talk: &mut Talk<'_, '_>, _: &Given<'_>) -> Result<Flow, Failure> {
    data(ogee::session::inspect::text(talk.dialogue.scene(), talk.dialogue.sources()))?;
    Ok(Flow::On)
}

fn time(talk: &mut Talk<'_, '_>, given: &Given<'_>) -> Result<Flow, Failure> {
    let start = Instant::now();
    let mut seconds = 0.0;
    talk.answer(|dialogue| {
        let reply = dialogue.line(&given.in_place(), given.first_line);
        seconds = start.elapsed().as_secs_f64();
        reply
    })?;
    tell(format!("{seconds:.6} s"));
    Ok(Flow::On)
}

fn sort(talk: &mut Talk<'_, '_>, given: &Given<'_>) -> Result<Flow, Failure> {
    let mut sort = None;
    talk.answer(|dialogue| {
        let (found, reply) = dialogue.sort_of(&given.in_place(), given.first_line);
        sort = found;
        reply
    })?;
    if let Some(sort) = sort {
        data(format!("{sort}\n"))?;
    }
    Ok(Flow::On)
}

fn plot(talk: &mut Talk<'_, '_>, given: &Given<'_>) -> Result<Flow, Failure> {
    super::plot::plot(talk, given.line, given.at, given.first_line)
}

/// A file's name, which may stand in quotes.
pub(super) fn unquoted(name: &str) -> &str {
    name.strip_prefix('"').and_then(|name| name.strip_suffix('"')).unwrap_or(name)
}
