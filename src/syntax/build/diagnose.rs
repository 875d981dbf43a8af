//! What is wrong with an item that cannot be read, in a person's words: what stands here, what was expected, one thing to
//! try; and how far the fault reaches, so that the next item is read again.

use super::items::{is_kind, is_reserved, near_kind};
use super::lexer::{Piece, Pieces, Sort};
use super::outline::{Event, Events};
use super::statements;
use super::{KEYWORDS, Origin};
use crate::diag::{Code, Diagnostic};

/// A fault, in bytes of the text that is being mended.
pub(super) struct Fault {
    /// What is struck out.
    pub start: usize,
    pub end: usize,
    /// The name that the struck-out item would have bound.
    pub defines: Option<(usize, usize)>,
    pub said: Said,
}

/// What is said of a fault.
pub(super) struct Said {
    pub code: Code,
    pub span: (usize, usize),
    pub message: String,
    pub label: String,
    pub also: Option<((usize, usize), String)>,
    pub hint: Option<String>,
}

impl Said {
    pub fn new(piece: &Piece<'_>, message: impl Into<String>) -> Said {
        Said::at((piece.start, piece.end), message)
    }

    pub fn at(span: (usize, usize), message: impl Into<String>) -> Said {
        Said {
            code: Code::Syntax,
            span,
            message: message.into(),
            label: String::new(),
            also: None,
            hint: None,
        }
    }

    pub fn hint(self, hint: impl Into<String>) -> Said {
        Said { hint: Some(hint.into()), ..self }
    }
}

impl Fault {
    pub fn diagnostic(&self, base: usize, origin: &Origin<'_>) -> Diagnostic {
        let said = &self.said;
        let span = |(start, end): (usize, usize)| origin.span(base + start, base + end);
        let mut found =
            Diagnostic::new(said.code, span(said.span), said.message.as_str()).label(said.label.as_str());
        if let Some((place, text)) = &said.also {
            found = found.also(span(*place), text.as_str());
        }
        found.hints.extend(said.hint.clone());
        found
    }
}

/// The fault of the item that begins at `item`, where reading stopped at `place`; `before` is the item before it, if that
/// is sound, and `end` the end of the region.
pub(super) fn item(
    text: &str,
    item: usize,
    place: usize,
    before: Option<(usize, usize)>,
    end: usize,
) -> Fault {
    let head = Pieces::new(text, item, end).next().unwrap_or(nothing(text, end));
    let around = Around::new(text, item, place, end);
    if let Some(fault) = statements::directive(text, &head, end) {
        return fault;
    }
    if let Some((said, defines)) = statements::statement(text, &head, &around, end) {
        let end = extent(text, &head, &around, end);
        return Fault { start: item, end, defines, said };
    }
    if around.at.is_some_and(|at| at.start == item)
        && let Some(fault) = between_items(text, &head, before, end)
    {
        return fault;
    }
    Fault {
        start: item,
        end: extent(text, &head, &around, end),
        defines: None,
        said: general(text, &head, &around),
    }
}

/// The fault of a text that should be one expression.
pub(super) fn expression(text: &str, place: usize) -> Fault {
    let first = Pieces::new(text, 0, text.len()).next().unwrap_or(nothing(text, text.len()));
    let around = Around::new(text, 0, place, text.len());
    let said = match around.at {
        _ if text.trim().is_empty() => Said::at((0, text.len()), "there is no expression here"),
        Some(at) if around.before.is_none() => {
            Said::new(&at, format!("an expression cannot begin with {}", name_of(&at)))
        }
        _ => general(text, &first, &around),
    };
    Fault { start: 0, end: text.len(), defines: None, said }
}

/// The empty piece at the end of a text.
fn nothing(text: &str, end: usize) -> Piece<'_> {
    Piece { sort: Sort::Closer, start: end, end, text: &text[end..end], first: false, apart: true }
}

/// What stands around the place where reading stopped.
pub(super) struct Around<'t> {
    /// The piece before the place, inside the innermost brackets that hold it.
    pub before: Option<Piece<'t>>,
    /// The piece at the place; none at the end of its brackets or of the region.
    pub at: Option<Piece<'t>>,
    /// The innermost brackets.
    pub inside: Option<Piece<'t>>,
    /// The `<` of a vector that is open at the place.
    pub vector: Option<Piece<'t>>,
    /// The `?` of a choice that has no `:` before the place.
    pub choice: Option<Piece<'t>>,
    /// How many pieces stand before the place, inside the innermost brackets.
    pub count: usize,
}

impl<'t> Around<'t> {
    fn new(text: &'t str, start: usize, place: usize, end: usize) -> Self {
        let mut around =
            Around { before: None, at: None, inside: None, vector: None, choice: None, count: 0 };
        around.read(text, start, place, end);
        around.step_back(text, start, end);
        around
    }

    fn read(&mut self, text: &'t str, start: usize, place: usize, end: usize) {
        let mut vectors: Vec<Piece<'t>> = Vec::new();
        let mut choices: Vec<Piece<'t>> = Vec::new();
        for piece in Pieces::new(text, start, end) {
            if piece.start < place && place < piece.end && piece.sort == Sort::Group {
                *self = Around {
                    before: None,
                    at: None,
                    inside: Some(piece),
                    vector: None,
                    choice: None,
                    count: 0,
                };
                return self.read(text, piece.start + 1, place, piece.end - 1);
            }
            if piece.start < place
                && place < piece.end
                && piece.sort == Sort::Text
                && let Some((open, close)) = hole(&piece, place)
            {
                let inside = Piece {
                    sort: Sort::Group,
                    start: open,
                    end: close + 1,
                    text: &text[open..=close],
                    ..piece
                };
                *self = Around {
                    before: None,
                    at: None,
                    inside: Some(inside),
                    vector: None,
                    choice: None,
                    count: 0,
                };
                return self.read(text, open + 1, place, close);
            }
            if piece.end > place {
                self.at = Some(piece);
                break;
            }
            match piece.text {
                "<" if self
                    .before
                    .is_none_or(|b| !b.ends_value() || self.count == 1 && b.end < piece.start) =>
                {
                    vectors.push(piece);
                }
                ">" => {
                    vectors.pop();
                }
                "?" => choices.push(piece),
                ":" => {
                    choices.pop();
                }
                _ => {}
            }
            self.before = Some(piece);
            self.count += 1;
        }
        self.vector = vectors.pop();
        self.choice = choices.pop();
    }

    /// Reading may have looked past a word that begins the next item; the fault is before that word.
    fn step_back(&mut self, text: &'t str, start: usize, end: usize) {
        let Some(word) = self.before.filter(|b| b.sort == Sort::Word && (b.first || is_kind(b.text))) else {
            return;
        };
        let from = self.inside.map_or(start, |group| group.start + 1);
        let mut earlier = None;
        for piece in Pieces::new(text, from, end).take_while(|p| p.start < word.start) {
            earlier = Some(piece);
        }
        let wants_value = earlier.is_some_and(|e| !e.ends_value() || self.count == 2 && is_kind(word.text));
        if wants_value {
            self.at = Some(word);
            self.before = earlier;
            self.count -= 1;
        }
    }
}

/// The braces of the interpolation that holds a place in a text.
fn hole(piece: &Piece<'_>, place: usize) -> Option<(usize, usize)> {
    let mut open = Vec::new();
    for event in Events::new(piece.text) {
        match event {
            Event::OpenHole { at } => open.push(piece.start + at),
            Event::CloseHole { at } => {
                let from = open.pop()?;
                if open.is_empty() && from < place && place <= piece.start + at {
                    return Some((from, piece.start + at));
                }
            }
            _ => {}
        }
    }
    None
}

/// An item cannot begin like this: something between two items is at fault, or the end of the one before.
fn between_items(text: &str, head: &Piece<'_>, before: Option<(usize, usize)>, end: usize) -> Option<Fault> {
    let previous = before.and_then(|(start, stop)| Pieces::new(text, start, stop).next());
    let said = match (head.text, head.sort) {
        (",", _) if previous.is_some_and(|p| p.text == "<" || p.sort == Sort::Number) => {
            let start = previous.map_or(head.start, |p| p.start);
            let around =
                Around { before: None, at: Some(*head), inside: None, vector: None, choice: None, count: 0 };
            let end = extent(text, head, &around, end);
            let said = Said::at(
                (start, trimmed(text, start, end)),
                "values stand here without the name of a property",
            )
            .hint("every value follows its property's name, as in `center <0, 0, 0>  radius 1`");
            return Some(Fault { start, end, defines: None, said });
        }
        (",", _) => Said::new(head, "a `,` stands between two items")
            .hint("items follow each other on white space; where an end must be marked, write `;`"),
        ("=", _) => return Some(assignment(text, head, before, end)),
        (_, Sort::Group) if head.text.starts_with('{') => {
            Said::new(&opening(head), "a block needs a kind before its `{`")
                .hint("write `group { … }` to put items together")
        }
        (_, Sort::Strange) => strange(head),
        (sign, Sort::Sign) if previous.is_some() => {
            return Some(after_value(text, sign, head, before, end));
        }
        (_, Sort::Sign) => Said::new(head, format!("an item cannot begin with `{}`", head.text)).hint(
            "an item is a property, a block, `let`, `fn`, `if`, `for`, `import` or the name of what to place",
        ),
        _ => return None,
    };
    let stop = if head.sort == Sort::Sign { head.end } else { extent_from(text, head, end) };
    Some(Fault { start: head.start, end: stop, defines: None, said })
}

/// `a b = 3`, `f(x) = 3`.
fn assignment(text: &str, equals: &Piece<'_>, before: Option<(usize, usize)>, end: usize) -> Fault {
    let start = before.map_or(equals.start, |(start, _)| start);
    let words: Vec<Piece<'_>> = Pieces::new(text, start, equals.start).collect();
    let said = Said::new(equals, "an assignment has one name before its `=`");
    let (said, defines) = match words.as_slice() {
        [.., name] if name.sort == Sort::Word => (
            said.hint(format!(
                "to define a name, write `let {} = …`; a property is followed by its value alone",
                name.text
            )),
            Some((name.start, name.end)),
        ),
        _ => (said.hint("to compare, write `==`; to define a function, write `fn name(a) = …`"), None),
    };
    Fault { start, end: extent_from(text, equals, end), defines, said }
}

/// An operator behind a sound item: what follows the operator is at fault, and the item with it.
fn after_value(
    text: &str,
    sign: &str,
    head: &Piece<'_>,
    before: Option<(usize, usize)>,
    end: usize,
) -> Fault {
    let start = before.map_or(head.start, |(start, _)| start);
    let next = Pieces::new(text, head.end, end).next();
    let said = match (sign, next) {
        ("<" | "-" | "+", _) if head.first => Said::new(head, format!("an item cannot begin with `{sign}`"))
            .hint("a value on the next line follows a `,` at the end of this one; an operator stands before or between blanks"),
        (":", _) => Said::new(head, "a `:` stands here without a `?` before it").hint("a choice is `condition ? a : b`"),
        ("&" | "|", _) => Said::new(head, format!("`{sign}` is no operator")).hint(format!("write `{sign}{sign}`")),
        (_, Some(next)) if !next.first => {
            Said::new(&opening(&next), format!("expected a value after `{sign}`, found {}", name_of(&next)))
        }
        _ => Said::new(head, format!("expected a value after `{sign}`")),
    };
    Fault { start, end: extent_from(text, head, end), defines: None, said }
}

/// The fault by what stands before and at the place.
pub(super) fn general(text: &str, head: &Piece<'_>, around: &Around<'_>) -> Said {
    if let Some(number) = [around.before, around.at]
        .into_iter()
        .flatten()
        .find(|p| p.sort == Sort::Number && p.text.ends_with('.'))
    {
        let digits = number.text.trim_end_matches('.');
        return Said {
            code: Code::BadNumber,
            ..Said::new(&number, format!("`{}` is not a number", number.text))
        }
        .hint(format!("write `{digits}.0` or `{digits}`"));
    }
    if let Some(vector) = around.vector {
        return in_vector(text, &vector, around);
    }
    if let Some(sign) = around.before.filter(|b| matches!(b.text, "&" | "|")) {
        return Said::new(&sign, format!("`{}` is no operator", sign.text))
            .hint(format!("write `{0}{0}`", sign.text));
    }
    if let Some(equals) =
        around.before.filter(|b| b.text == "=" && (around.inside.is_some() || around.count > 3))
    {
        return stray_equals(&equals);
    }
    if let Some(at) = around.at.filter(|at| at.sort == Sort::Strange && !at.first) {
        return strange(&at);
    }
    if let Some(choice) = around.choice.filter(|_| around.before.is_some_and(|b| b.ends_value())) {
        return Said::new(&choice, "this `?` has no `:` behind it").hint("a choice is `condition ? a : b`");
    }
    let closing = closing(around);
    match (around.before, around.at) {
        (None, Some(at)) => {
            Said::new(&opening(&at), format!("{} cannot stand here", capital_free(&name_of(&at))))
        }
        (None, None) => Said::new(head, "something is missing here"),
        (Some(before), at) if !before.ends_value() => wants_value(&before, at, &closing),
        (Some(before), at) if around.count == 1 && before.start == head.start && around.inside.is_none() => {
            property_wants_value(text, &before, at)
        }
        (Some(before), Some(at))
            if is_kind(before.text) && at.sort == Sort::Word && around.inside.is_none() =>
        {
            Said::new(&before, format!("`{} {}` cannot stand here", before.text, at.text)).hint(format!(
                "put it on a line of its own; a flag before it in its line is written `{} on`",
                head.text
            ))
        }
        (Some(before), Some(at)) => unexpected(&before, &at, around, &closing),
        (Some(before), None) => Said::new(&before, format!("expected more before {closing}")),
    }
}

fn stray_equals(at: &Piece<'_>) -> Said {
    Said::new(at, "a `=` cannot stand in an expression")
        .hint("to compare, write `==`; to name an argument, `name: value`")
}

/// After an operator, a comma and the like.
fn wants_value(before: &Piece<'_>, at: Option<Piece<'_>>, closing: &str) -> Said {
    let said = format!("expected a value after `{}`", before.text);
    if before.text == "." {
        return Said::new(before, "a `.` stands tight between a value and the name of its part")
            .hint("write `v.x`, `path.length`");
    }
    if before.text == "if" && !before.first {
        return Said::new(before, "an `if` is an item, and no value")
            .hint("a choice of values is `condition ? a : b`");
    }
    match at {
        Some(at) if !at.first => {
            let found = Said::new(&opening(&at), format!("{said}, found {}", name_of(&at)));
            if at.text == before.text && matches!(at.text, "+" | "*") || (before.text, at.text) == ("=", "=")
            {
                return found.hint(format!("`{}{}` is no operator", before.text, at.text));
            }
            found
        }
        Some(_) => Said::new(before, said),
        None => Said { label: format!("{closing} follows"), ..Said::new(before, said) },
    }
}

/// After a word that begins an item and could only be a property.
fn property_wants_value(text: &str, name: &Piece<'_>, at: Option<Piece<'_>>) -> Said {
    let said = format!("expected a value after `{}`", name.text);
    let Some(at) = at else { return Said::new(name, said) };
    let found = Said::new(&opening(&at), format!("{said}, found {}", name_of(&at)));
    if at.sort == Sort::Word && is_reserved(at.text) {
        let said = if at.text == "with" { "`with` is followed by braces" } else { "a flag ends its line" };
        return match at.text {
            "with" => Said::new(&at, said).hint(format!("write `{} with {{ … }}`", name.text)),
            _ => found.hint(format!("in the middle of a line, set a flag with `{} on`", name.text)),
        };
    }
    if at.text == "<" && !at.apart {
        return Said::new(&at, format!("`{}<` compares", name.text))
            .hint(format!("leave a blank for a vector: `{} <…>`", name.text));
    }
    if text[name.end..at.start].contains('\n') {
        return Said::new(name, said).hint("a property's first value begins on the property's line");
    }
    found
}

/// Inside a vector.
fn in_vector(text: &str, vector: &Piece<'_>, around: &Around<'_>) -> Said {
    let open = ((vector.start, vector.end), "the vector begins here".to_owned());
    let ends_value = around.before.is_some_and(|b| b.ends_value());
    match around.at {
        Some(at) if !at.first && !ends_value => {
            let after = around.before.map_or("<", |b| b.text);
            let said = format!("expected a component after `{after}`, found {}", name_of(&at));
            Said { also: (after != "<").then_some(open), ..Said::new(&opening(&at), said) }
        }
        Some(at) if !at.first && closes_later(text, &at) => Said {
            also: Some(open),
            ..Said::new(&opening(&at), format!("expected `,` or `>` before {}", name_of(&at)))
        },
        _ => Said {
            code: Code::Unclosed,
            ..Said::new(vector, "this vector is not closed").hint("end it with `>`")
        },
    }
}

/// Whether a `>` follows on the line before another vector begins.
fn closes_later(text: &str, at: &Piece<'_>) -> bool {
    let line = text[at.start..].lines().next().unwrap_or_default();
    line.find(['<', '>']).is_some_and(|i| line.as_bytes()[i] == b'>')
}

/// A piece after a value that cannot go on there.
fn unexpected(before: &Piece<'_>, at: &Piece<'_>, around: &Around<'_>, closing: &str) -> Said {
    let found = name_of(at);
    match at.text {
        "and" | "or" | "not" => return spelled(at),
        "&" | "|" => {
            return Said::new(at, format!("`{}` is no operator", at.text))
                .hint(format!("write `{0}{0}`", at.text));
        }
        "=" => {
            return stray_equals(at);
        }
        _ => {}
    }
    let brackets = around.inside.map(|group| &group.text[..1]);
    match brackets {
        Some("(" | "[") => {
            let said = Said::new(&opening(at), format!("expected `,` or {closing} before {found}"));
            let same =
                before.sort == Sort::Word && at.sort == Sort::Group && at.text.starts_with('(') && at.apart;
            if same { said.hint(format!("a call is written tight: `{}(…)`", before.text)) } else { said }
        }
        _ if at.text.starts_with('{') => unknown_block(before, at),
        _ => Said::new(&opening(at), format!("{} cannot stand here", capital_free(&found)))
            .hint(format!("expected an operator, or the end of the item, after `{}`", shorten(before.text))),
    }
}

fn unknown_block(before: &Piece<'_>, at: &Piece<'_>) -> Said {
    if before.sort != Sort::Word {
        return Said::new(&opening(at), "a block needs a kind before its `{`");
    }
    let said = Said {
        code: Code::UnknownKind,
        ..Said::new(before, format!("no block is of the kind `{}`", before.text))
    };
    match near_kind(before.text) {
        Some(near) => said.hint(format!("did you mean `{near}`?")),
        None => said,
    }
}

/// `and`, `or`, `not`.
pub(super) fn spelled(at: &Piece<'_>) -> Said {
    let sign = match at.text {
        "and" => "&&",
        "or" => "||",
        _ => "!",
    };
    Said::new(at, format!("`{}` is no operator", at.text)).hint(format!("write `{sign}`"))
}

fn strange(at: &Piece<'_>) -> Said {
    let said = Said::new(at, format!("the character `{}` has no meaning here", at.text));
    match at.text {
        "“" | "”" | "„" | "‘" | "’" | "«" | "»" => {
            said.hint("texts stand between straight quotation marks, `\"…\"`")
        }
        "−" | "–" | "—" => said.hint("a minus is written `-`"),
        "×" | "·" => said.hint("a product is written `*`"),
        "⟨" | "⟩" => said.hint("a vector stands between `<` and `>`"),
        "\u{a0}" => Said { message: "a no-break space has no meaning here".into(), ..said }
            .hint("write a plain blank"),
        _ => said,
    }
}

/// The bracket that would close what is open, or the end of the item.
fn closing(around: &Around<'_>) -> String {
    match around.inside.map(|group| group.text.as_bytes()[0]) {
        Some(open) => format!("`{}`", super::outline::closer(open) as char),
        None => "the end of the item".to_owned(),
    }
}

/// A piece in words: its text, or its sort where that is long.
pub(super) fn name_of(piece: &Piece<'_>) -> String {
    match piece.sort {
        Sort::Group => format!("`{}`", &piece.text[..1]),
        Sort::Struck => "text that cannot be read".to_owned(),
        Sort::Word | Sort::Number | Sort::Text | Sort::Closer | Sort::Sign | Sort::Strange => {
            format!("`{}`", shorten(piece.text))
        }
    }
}

fn capital_free(text: &str) -> String {
    text.to_owned()
}

fn shorten(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default();
    if line.chars().count() <= 24 && line.len() == text.len() {
        return text.to_owned();
    }
    line.chars().take(20).chain(['…']).collect()
}

/// A piece, or just its bracket where it is a group.
pub(super) fn opening<'t>(piece: &Piece<'t>) -> Piece<'t> {
    match piece.sort {
        Sort::Group => Piece { end: piece.start + 1, text: &piece.text[..1], ..*piece },
        _ => *piece,
    }
}

/// The end of `start..end` without the blanks before it. Blanks are the grammar's: a blank of another writing is a fault.
fn trimmed(text: &str, start: usize, end: usize) -> usize {
    start + text[start..end].trim_end_matches([' ', '\t', '\r', '\n']).len()
}

/// How far the fault at a place reaches: to the next thing that is plainly an item.
fn extent(text: &str, head: &Piece<'_>, around: &Around<'_>, end: usize) -> usize {
    let place = around.at.map_or(around.inside.map_or(end, |group| group.end), |at| at.start);
    let needs_body = matches!(head.text, "for" | "while" | "if" | "else")
        || head.text == "fn" && !Pieces::new(text, head.start, end).take(4).any(|p| p.text == "=");
    reach(text, head.start, place, needs_body, end)
}

/// The same, of a fault at a piece that begins the item.
fn extent_from(text: &str, head: &Piece<'_>, end: usize) -> usize {
    reach(text, head.start, head.start, false, end)
}

fn reach(text: &str, start: usize, place: usize, needs_body: bool, end: usize) -> usize {
    let mut before: Option<Piece<'_>> = None;
    let mut body = !needs_body;
    let in_choice = text[start..].starts_with("if");
    let mut pieces = Pieces::new(text, start, end).peekable();
    while let Some(piece) = pieces.next() {
        let stop = match before {
            None => false,
            Some(_) if piece.sort == Sort::Struck => true,
            Some(before) => {
                piece.start >= place
                    && (piece.text == ";"
                        || begins_item(&piece, &before, place, in_choice, pieces.peek())
                            && (body || piece.first))
            }
        };
        if stop {
            return trimmed(text, start, piece.start);
        }
        body |= piece.text.starts_with('{');
        before = Some(piece);
    }
    trimmed(text, start, end).max(start + 1)
}

/// Whether a piece after the fault begins another item.
fn begins_item(
    piece: &Piece<'_>,
    before: &Piece<'_>,
    place: usize,
    in_choice: bool,
    next: Option<&Piece<'_>>,
) -> bool {
    if piece.first && piece.sort == Sort::Strange {
        return true;
    }
    let goes_on = matches!(piece.text, "with" | "step" | "in" | "as" | "and" | "or")
        || piece.text == "else" && in_choice && before.text.starts_with('{');
    if piece.sort != Sort::Word || goes_on || !piece.apart {
        return false;
    }
    let statement = KEYWORDS.contains(&piece.text) && !matches!(piece.text, "true" | "false");
    if piece.start == place {
        return piece.first || statement || is_kind(piece.text);
    }
    if piece.first && (statement || is_kind(piece.text)) {
        return true;
    }
    let opens_unknown = next.is_some_and(|n| n.text.starts_with('{')) && !is_kind(piece.text);
    let has_value =
        next.is_some_and(|n| !n.first && matches!(n.sort, Sort::Number | Sort::Text | Sort::Word));
    if before.start == place && before.sort == Sort::Sign && has_value {
        return true;
    }
    before.ends_value() && (piece.first || !opens_unknown)
}
