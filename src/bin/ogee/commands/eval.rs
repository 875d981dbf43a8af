//! `ogee eval`: the value of an expression; one line of a dialogue, and that is all.

use crate::args::Eval;
use crate::reply::{Count, show_reply};
use crate::speech::{Ended, Exit};
use ogee::session::dialogue::Reply;

/// Prints the value, or says why there is none.
pub fn run(args: &Eval) -> Ended {
    if let Some(file) = &args.file {
        super::try_to_read(file)?;
    }
    let mut session = super::session(&args.evaluation);
    let reply = session.dialogue(None, |dialogue| {
        let file = args.file.as_ref().map(|file| dialogue.part_of_file(file));
        joined(file.into_iter().chain([dialogue.expression(&args.expression)]))
    });
    show_reply(&reply, &session.sources, args.digits.map(usize::from), Count::Always)?;
    Ok(if reply.failed { Exit::Scene } else { Exit::Done })
}

/// Several replies as one.
fn joined(replies: impl Iterator<Item = Reply>) -> Reply {
    let mut whole = Reply::default();
    replies.for_each(|reply| whole.join(reply));
    whole
}
