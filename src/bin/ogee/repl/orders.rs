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
    obey: fn(&mut Talk<'_, '_>, &str, usize) -> Result<Flow, Failure>,
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
    Order { name: "quit", argument: "", doc: "leave, as Ctrl-D does", obey: |_, _, _| Ok(Flow::Quit) },
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

/// Does what an order says; `line` is it without its colon.
pub fn obey(talk: &mut Talk<'_, '_>, line: &str, first_line: usize) -> Result<Flow, Failure> {
    let (word, argument) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let argument = argument.trim();
    match ORDERS.iter().find(|order| order.name == word) {
        Some(order) if order.argument.is_empty() && !argument.is_empty() => {
            Ok(refuse(talk, &format!("`:{word}` stands alone")))
        }
        Some(order) if needs_argument(order) && argument.is_empty() => {
            Ok(refuse(talk, &format!("write `:{word} {}`", order.argument)))
        }
        Some(order) => (order.obey)(talk, argument, first_line),
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

fn refuse(talk: &mut Talk<'_, '_>, message: &str) -> Flow {
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

fn help(talk: &mut Talk<'_, '_>, name: &str, _: usize) -> Result<Flow, Failure> {
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

fn load(talk: &mut Talk<'_, '_>, file: &str, _: usize) -> Result<Flow, Failure> {
    let path = file.strip_prefix('"').and_then(|file| file.strip_suffix('"')).unwrap_or(file);
    if let Err(failure) = crate::commands::try_to_read(Path::new(path)) {
        return Ok(refuse(talk, &failure.message));
    }
    talk.answer(|dialogue| dialogue.file(Path::new(path)))?;
    Ok(Flow::On)
}

fn reload(talk: &mut Talk<'_, '_>, _: &str, _: usize) -> Result<Flow, Failure> {
    talk.answer(|dialogue| dialogue.reload())?;
    Ok(Flow::On)
}

fn names(talk: &mut Talk<'_, '_>, _: &str, _: usize) -> Result<Flow, Failure> {
    data(talk.dialogue.names().iter().map(|name| format!("{name}\n")).collect::<String>())?;
    Ok(Flow::On)
}

fn scene(talk: &mut Talk<'_, '_>, _: &str, _: usize) -> Result<Flow, Failure> {
    data(ogee::session::inspect::text(talk.dialogue.scene(), talk.dialogue.sources()))?;
    Ok(Flow::On)
}

fn time(talk: &mut Talk<'_, '_>, text: &str, first_line: usize) -> Result<Flow, Failure> {
    let start = Instant::now();
    let mut seconds = 0.0;
    talk.answer(|dialogue| {
        let reply = dialogue.line(text, first_line);
        seconds = start.elapsed().as_secs_f64();
        reply
    })?;
    tell(format!("{seconds:.6} s"));
    Ok(Flow::On)
}

fn sort(talk: &mut Talk<'_, '_>, text: &str, first_line: usize) -> Result<Flow, Failure> {
    let mut sort = None;
    talk.answer(|dialogue| {
        let (found, reply) = dialogue.sort_of(text, first_line);
        sort = found;
        reply
    })?;
    if let Some(sort) = sort {
        data(format!("{sort}\n"))?;
    }
    Ok(Flow::On)
}
