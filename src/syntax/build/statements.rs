//! What is wrong with an item that begins with a word of the language, or with one of POV-Ray's.

use super::diagnose::{Around, Fault, Said, name_of, opening, spelled};
use super::items::is_reserved;
use super::lexer::{Piece, Pieces, Sort};

type Bytes = (usize, usize);

/// What is said of a faulty statement, and the name that it would have bound; nothing where it is sound up to its
/// expressions.
pub(super) fn statement<'t>(
    text: &'t str,
    head: &Piece<'t>,
    around: &Around<'t>,
    end: usize,
) -> Option<(Said, Option<Bytes>)> {
    let pieces: Vec<Piece<'t>> = Pieces::new(text, head.start, end).take(4).collect();
    let rest = pieces.get(1..).unwrap_or_default();
    let said = match head.text {
        "let" | "var" => return Some(binding(text, head, rest, around)),
        "fn" => return Some(function(text, head, rest, around)),
        "for" => for_loop(head, rest),
        "if" | "while" => None,
        "import" => Some(import(head, rest)),
        "else" => Some(
            Said::new(head, "this `else` follows no `if`")
                .hint("an `else` stands behind the `}` of its `if`"),
        ),
        "with" => Some(Said::new(head, "`with` follows no value").hint("write `value with { … }`")),
        "in" => Some(Said::new(head, "`in` stands outside a loop").hint("write `for i in 0..n { … }`")),
        _ => return None,
    };
    let needs_body = matches!(head.text, "for" | "if" | "while");
    let said = said.or_else(|| needs_body.then(|| header(text, head, around)).flatten())?;
    Some((said, None))
}

fn binding<'t>(
    text: &str,
    head: &Piece<'t>,
    rest: &[Piece<'t>],
    around: &Around<'t>,
) -> (Said, Option<Bytes>) {
    let Some(name) = rest.first().filter(|p| p.sort == Sort::Word && !p.text.starts_with('#')) else {
        return (no_name(head, rest.first()), None);
    };
    let defines = Some((name.start, name.end));
    match rest.get(1) {
        Some(equals) if equals.text == "=" => (super::diagnose::general(text, head, around), defines),
        Some(group) if group.text.starts_with('(') && !group.apart => {
            let said = Said::new(head, "a function is not defined with `let`");
            (said.hint(format!("write `fn {}{} = …`", name.text, group.text)), defines)
        }
        other => {
            let said = format!("expected `=` after `{} {}`", head.text, name.text);
            let said = match other.filter(|p| !p.first) {
                Some(found) => Said::new(&opening(found), format!("{said}, found {}", name_of(found))),
                None => Said::new(name, said),
            };
            (said.hint(format!("write `{} {} = value`", head.text, name.text)), defines)
        }
    }
}

fn no_name(head: &Piece<'_>, found: Option<&Piece<'_>>) -> Said {
    let said = format!("expected a name after `{}`", head.text);
    match found.filter(|p| !p.first) {
        Some(found) => Said::new(&opening(found), format!("{said}, found {}", name_of(found))),
        None => Said::new(head, said),
    }
}

fn function<'t>(
    text: &str,
    head: &Piece<'t>,
    rest: &[Piece<'t>],
    around: &Around<'t>,
) -> (Said, Option<Bytes>) {
    let Some(name) = rest.first().filter(|p| p.sort == Sort::Word && !p.text.starts_with('#')) else {
        return (no_name(head, rest.first()), None);
    };
    let defines = Some((name.start, name.end));
    let form = format!("write `fn {0}(a, b) = value` or `fn {0}(a, b) {{ … }}`", name.text);
    let Some(parameters) = rest.get(1).filter(|p| p.text.starts_with('(')) else {
        return (
            Said::new(name, format!("expected parameters after `fn {}`", name.text)).hint(form),
            defines,
        );
    };
    let in_parameters = around.inside.is_some_and(|group| group.start == parameters.start);
    let has_body = rest.get(2).is_some_and(|p| p.text == "=" || p.text.starts_with('{'));
    if in_parameters || has_body {
        return (super::diagnose::general(text, head, around), defines);
    }
    let said = "expected `=` or `{` after the parameters";
    let said = match rest.get(2).filter(|p| !p.first) {
        Some(found) => Said::new(&opening(found), format!("{said}, found {}", name_of(found))),
        None => Said::new(parameters, said),
    };
    (said.hint(form), defines)
}

fn for_loop(head: &Piece<'_>, rest: &[Piece<'_>]) -> Option<Said> {
    let form = "write `for i in 0..10 { … }`";
    let Some(variable) = rest.first().filter(|p| p.sort == Sort::Word) else {
        return Some(no_name(head, rest.first()).hint(form));
    };
    if rest.get(1).is_some_and(|p| p.text == "in") {
        return None;
    }
    let said = format!("expected `in` after `for {}`", variable.text);
    Some(match rest.get(1).filter(|p| !p.first) {
        Some(found) => Said::new(&opening(found), format!("{said}, found {}", name_of(found))).hint(form),
        None => Said::new(variable, said).hint(form),
    })
}

fn import(head: &Piece<'_>, rest: &[Piece<'_>]) -> Said {
    let form = "write `import \"file.scene\"` or `import \"file.scene\" as name`";
    match (rest.first(), rest.get(1)) {
        (Some(path), Some(word)) if path.sort == Sort::Text && word.text == "as" => {
            Said::new(word, "expected a name after `as`").hint(form)
        }
        (Some(path), Some(found)) if path.sort == Sort::Text => {
            Said::new(&opening(found), format!("{} cannot follow an import's path", name_of(found)))
                .hint(form)
        }
        (Some(found), _) if !found.first => Said::new(
            &opening(found),
            format!("expected a path in quotation marks, found {}", name_of(found)),
        )
        .hint(form),
        _ => Said::new(head, "expected a path in quotation marks after `import`").hint(form),
    }
}

/// The condition or list of a loop or choice is read; its body is not where it should be.
fn header<'t>(text: &str, head: &Piece<'t>, around: &Around<'t>) -> Option<Said> {
    let what = if head.text == "for" { "list" } else { "condition" };
    let before = around.before?;
    if before.text == "=" && around.inside.is_none() {
        return Some(Said::new(&before, "a `=` cannot stand in a condition").hint("to compare, write `==`"));
    }
    if before.start == head.start || before.text == "in" {
        let said = format!("expected a {what} after `{}`", before.text);
        return Some(match around.at.filter(|at| !at.first) {
            Some(at) => Said::new(&opening(&at), format!("{said}, found {}", name_of(&at))),
            None => Said::new(&before, said),
        });
    }
    if around.inside.is_some() || around.vector.is_some() || !before.ends_value() {
        return Some(super::diagnose::general(text, head, around));
    }
    let said = format!("expected `{{` after the {what}");
    Some(match around.at {
        Some(at) if matches!(at.text, "and" | "or" | "not") => spelled(&at),
        Some(at) if at.text == "=" => {
            Said::new(&at, "a `=` cannot stand in a condition").hint("to compare, write `==`")
        }
        Some(at) if before.text == "else" => {
            Said::new(&opening(&at), format!("expected `{{` or `if` after `else`, found {}", name_of(&at)))
        }
        Some(at) if !at.first => Said::new(&opening(&at), format!("{said}, found {}", name_of(&at)))
            .hint(format!("write `{} … {{ … }}`", head.text)),
        _ => Said::new(&before, said).hint("the items of each turn or branch stand in braces"),
    })
}

/// POV-Ray's directives, which people bring along.
pub(super) fn directive(text: &str, head: &Piece<'_>, end: usize) -> Option<Fault> {
    let word = head.text.strip_prefix('#')?;
    let name =
        Pieces::new(text, head.end, end).next().filter(|p| p.sort == Sort::Word && !is_reserved(p.text));
    let called = name.map_or("name", |p| p.text);
    let (hint, defines, to_end) = match word {
        "declare" | "local" => (format!("write `let {called} = …`"), true, false),
        "macro" => (format!("write `fn {called}(a, b) = …` or `fn {called}(a, b) {{ … }}`"), true, true),
        "for" => ("write `for i in 0..n { … }`".to_owned(), false, true),
        "while" => ("write `while condition { … }`".to_owned(), false, true),
        "if" | "ifdef" | "ifndef" | "switch" => {
            ("write `if condition { … } else { … }`".to_owned(), false, true)
        }
        "else" | "elseif" | "end" | "case" | "range" | "break" => {
            ("what belongs together stands in braces, `{ … }`".to_owned(), false, false)
        }
        "include" => ("write `import \"file.scene\"`".to_owned(), false, false),
        "debug" | "warning" | "render" => ("write `print(…)`".to_owned(), false, false),
        "error" => ("write `error(…)`".to_owned(), false, false),
        "version" | "default" | "undef" | "read" | "write" | "fopen" | "fclose" => {
            ("leave it out; there is nothing of the kind here".to_owned(), false, false)
        }
        _ => return None,
    };
    let said = Said::new(head, format!("`#{word}` is POV-Ray's and not a word of this language")).hint(hint);
    let stop = if to_end { matching_end(text, head, end) } else { end_of_line(text, head, end) };
    let defines = name.filter(|_| defines).map(|p| (p.start, p.end));
    Some(Fault { start: head.start, end: stop, defines, said })
}

/// Past the `#end` of a directive; past its line, where there is none.
fn matching_end(text: &str, head: &Piece<'_>, end: usize) -> usize {
    let mut open = 0;
    for piece in Pieces::new(text, head.start, end) {
        match piece.text {
            "#macro" | "#for" | "#while" | "#if" | "#ifdef" | "#ifndef" | "#switch" => open += 1,
            "#end" => open -= 1,
            _ => {}
        }
        if open == 0 {
            return piece.end;
        }
    }
    end_of_line(text, head, end)
}

/// The end of a directive that has no `#end`: its `;`, or the line that nothing continues.
fn end_of_line(text: &str, head: &Piece<'_>, end: usize) -> usize {
    let mut last = *head;
    for piece in Pieces::new(text, head.end, end) {
        if piece.text == ";" || piece.sort == Sort::Struck || piece.first && last.ends_value() {
            break;
        }
        last = piece;
    }
    last.end
}
