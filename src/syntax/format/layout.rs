//! Items and tokens to lines.

use super::WIDTH;
use super::tree::{Node, NodeSort, comments, keep_tight, nodes};
use crate::syntax::build::{ItemPlace, ItemSort, Places};

/// Blanks of a level of braces.
const INDENT: usize = 2;

/// A file in canonical layout; its items stand where `places` says.
pub(super) fn layout(text: &str, places: &Places) -> String {
    let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let mut out = Lines::default();
    Layout { text, places }.items(start, text.len(), &places.top, 0, &mut out);
    out.finish()
}

/// Lines that are being written.
#[derive(Default)]
struct Lines {
    text: String,
    /// Characters on the last line.
    column: usize,
    /// Whether anything stands on the last line but its indentation.
    begun: bool,
}

impl Lines {
    fn push(&mut self, piece: &str) {
        self.text.push_str(piece);
        self.column = match piece.rfind('\n') {
            Some(line) => piece[line + 1..].chars().count(),
            None => self.column + piece.chars().count(),
        };
        self.begun |= !piece.trim().is_empty();
    }

    /// Begins a line, unless the last one is still bare.
    fn new_line(&mut self, indent: usize) {
        let end = self.text.trim_end_matches([' ', '\t']).len();
        self.text.truncate(end);
        if self.begun {
            self.text.push('\n');
        }
        self.text.extend(std::iter::repeat_n(' ', indent));
        (self.column, self.begun) = (indent, false);
    }

    fn blank_line(&mut self) {
        let end = self.text.trim_end_matches([' ', '\t']).len();
        self.text.truncate(end);
        if self.begun {
            self.text.push('\n');
        }
        self.text.push('\n');
        (self.column, self.begun) = (0, false);
    }

    fn finish(self) -> String {
        let text = self.text.trim_end();
        if text.is_empty() { String::new() } else { format!("{text}\n") }
    }
}

/// An item, or a comment between items.
enum Entry<'t> {
    Item(ItemPlace),
    Comment(Node<'t>),
}

struct Layout<'t> {
    text: &'t str,
    places: &'t Places,
}

impl<'t> Layout<'t> {
    /// The items of `start..end` and the comments between them, in order.
    fn entries(&self, start: usize, end: usize, items: &[ItemPlace]) -> Vec<Entry<'t>> {
        let mut entries = Vec::new();
        let mut at = start;
        let gap = |from: usize, to: usize, entries: &mut Vec<Entry<'t>>| {
            let mut found = Vec::new();
            comments(self.text, from, to, &mut found);
            entries.extend(found.into_iter().map(Entry::Comment));
        };
        for item in items {
            gap(at, item.start, &mut entries);
            entries.push(Entry::Item(*item));
            at = item.end;
        }
        gap(at, end, &mut entries);
        entries
    }

    /// Items on lines of their own; those that shared a line go on sharing it where they fit.
    fn items(&self, start: usize, end: usize, items: &[ItemPlace], indent: usize, out: &mut Lines) {
        let mut at = start;
        let mut first = true;
        let mut ends_line = false;
        for entry in self.entries(start, end, items) {
            let (from, to) = match &entry {
                Entry::Item(item) => (item.start, item.end),
                Entry::Comment(node) => (node.start, node.end),
            };
            let gap = &self.text[at..from];
            let breaks = gap.matches('\n').count();
            let shares = !first && breaks == 0 && !gap.contains(';') && !ends_line;
            if breaks > 1 && !first {
                out.blank_line();
            }
            let written = out.text.len();
            match &entry {
                Entry::Comment(node) => self.comment_entry(node, !first && breaks == 0, indent, out),
                Entry::Item(item) => self.item_entry(item, shares, indent, out),
            }
            let broken = out.text[written..].trim_start().contains('\n');
            ends_line = broken || matches!(&entry, Entry::Comment(node) if node.is_line_comment());
            at = to;
            first = false;
        }
    }

    fn comment_entry(&self, node: &Node<'t>, shares: bool, indent: usize, out: &mut Lines) {
        if shares && out.begun {
            out.push("  ");
        } else {
            out.new_line(indent);
        }
        out.push(&self.text[node.start..node.end]);
    }

    fn item_entry(&self, item: &ItemPlace, shares: bool, indent: usize, out: &mut Lines) {
        let flat = self.flat_item(item);
        let width = flat.as_ref().map(|flat| flat.chars().count());
        if shares && out.begun && width.is_none_or(|width| out.column + 2 + width <= WIDTH) {
            out.push("  ");
        } else {
            out.new_line(indent);
        }
        match flat.filter(|_| width.is_some_and(|width| out.column + width <= WIDTH)) {
            Some(flat) => out.push(&flat),
            None => self.broken_item(item, indent, out),
        }
    }

    fn item_nodes(&self, item: &ItemPlace) -> Vec<Node<'t>> {
        let mut nodes = nodes(self.text, item.start, item.end, item.sort == ItemSort::Entry);
        if item.sort == ItemSort::Placement {
            keep_tight(&mut nodes);
        }
        nodes
    }

    /// An item on one line, if it was on one.
    fn flat_item(&self, item: &ItemPlace) -> Option<String> {
        if self.text[item.start..item.end].contains('\n') {
            return self.joined_item(item);
        }
        self.flat(&self.item_nodes(item), item.sort)
    }

    /// An item whose only line breaks stand before its braces or behind its `=`: these are never kept.
    fn joined_item(&self, item: &ItemPlace) -> Option<String> {
        let nodes = self.item_nodes(item);
        let keeps = nodes.iter().enumerate().any(|(i, node)| {
            self.text[node.start..node.end].contains('\n') || node.new_line && !joins(&nodes, i)
        });
        if keeps { None } else { self.flat(&nodes, item.sort) }
    }

    /// Nodes on one line; nothing where a line comment or a block of several lines is among them.
    fn flat(&self, nodes: &[Node<'t>], sort: ItemSort) -> Option<String> {
        let mut line = String::new();
        let mut state = Spacing::new(sort);
        for (i, node) in nodes.iter().enumerate() {
            line.push_str(state.before(nodes, i));
            match &node.sort {
                NodeSort::Token(text, _) => line.push_str(text),
                NodeSort::Comment(text) if node.is_line_comment() || text.contains('\n') => return None,
                NodeSort::Comment(text) => line.push_str(text),
                NodeSort::Brackets { open, close, inner } => {
                    line.push_str(open);
                    line.push_str(&self.flat(inner, ItemSort::Placement)?);
                    line.push_str(close);
                }
                NodeSort::Body => line.push_str(&self.flat_body(node)?),
            }
        }
        Some(line)
    }

    /// `{ a  b }`, if the block was on one line.
    fn flat_body(&self, body: &Node<'t>) -> Option<String> {
        if self.text[body.start..body.end].contains('\n') {
            return None;
        }
        let items = self.places.within.get(&body.start)?;
        let mut line = String::from("{");
        let mut at = body.start + 1;
        for entry in self.entries(body.start + 1, body.end - 1, items) {
            let (piece, from, to) = match entry {
                Entry::Item(item) => (self.flat_item(&item)?, item.start, item.end),
                Entry::Comment(node) => (self.text[node.start..node.end].to_owned(), node.start, node.end),
            };
            let marked = at > body.start + 1 && self.text[at..from].contains(';');
            line.push_str(match (at == body.start + 1, marked) {
                (true, _) => " ",
                (false, true) => ";  ",
                (false, false) => "  ",
            });
            line.push_str(&piece);
            at = to;
        }
        line.push_str(" }");
        Some(line)
    }

    /// An item on several lines.
    fn broken_item(&self, item: &ItemPlace, indent: usize, out: &mut Lines) {
        let nodes = self.item_nodes(item);
        let hanging = hanging_column(&nodes, item.sort, out.column);
        self.broken(&nodes, item.sort, indent, hanging.unwrap_or(indent + INDENT), out);
    }

    /// Nodes with the line breaks they had between elements, and more where they are too long. Braces and brackets close
    /// at `indent`; what goes on without them stands at `hanging`.
    fn broken(&self, nodes: &[Node<'t>], sort: ItemSort, indent: usize, hanging: usize, out: &mut Lines) {
        let mut state = Spacing::new(sort);
        for (i, node) in nodes.iter().enumerate() {
            let space = state.before(nodes, i);
            let after_line_comment = i > 0 && nodes[i - 1].is_line_comment();
            let kept = node.new_line && !joins(nodes, i) && may_break(nodes, i);
            if i > 0 && (after_line_comment || kept || self.too_wide(nodes, i, sort, out)) {
                out.new_line(hanging);
            } else if node.is_comment() && i > 0 {
                out.push(if node.is_line_comment() { "  " } else { " " });
            } else {
                out.push(space);
            }
            match &node.sort {
                NodeSort::Token(text, _) | NodeSort::Comment(text) => out.push(text),
                NodeSort::Brackets { open, close, inner } => {
                    self.brackets((open, close), node, inner, indent, out)
                }
                NodeSort::Body => self.body(node, indent, out),
            }
        }
    }

    /// Whether the element behind a comma reaches past the width of a line.
    fn too_wide(&self, nodes: &[Node<'t>], i: usize, sort: ItemSort, out: &Lines) -> bool {
        if nodes[i - 1].token() != "," {
            return false;
        }
        let end = nodes[i..].iter().position(|n| n.token() == ",").map_or(nodes.len(), |n| i + n);
        // A comma or a closing bracket stands behind it.
        let last = usize::from(end < nodes.len() || sort == ItemSort::Placement);
        let width = self.flat(&nodes[i..end], sort).map_or(0, |line| line.chars().count());
        out.column + 1 + width + last > WIDTH
    }

    fn brackets(
        &self,
        (open, close): (&str, &str),
        node: &Node<'t>,
        inner: &[Node<'t>],
        indent: usize,
        out: &mut Lines,
    ) {
        let one_line = !self.text[node.start..node.end].contains('\n');
        let flat = if one_line { self.flat(inner, ItemSort::Placement) } else { None };
        if let Some(flat) =
            flat.filter(|flat| out.column + flat.chars().count() + 2 <= WIDTH || inner.is_empty())
        {
            out.push(open);
            out.push(&flat);
            out.push(close);
            return;
        }
        out.push(open);
        let on_own_lines = inner.first().is_some_and(|n| self.text[node.start..n.start].contains('\n'));
        if on_own_lines {
            out.new_line(indent + INDENT);
            self.broken(inner, ItemSort::Placement, indent + INDENT, indent + INDENT, out);
            out.new_line(indent);
        } else {
            let column = out.column;
            self.broken(inner, ItemSort::Placement, indent, column.min(indent + FARTHEST_HANG), out);
            if inner.last().is_some_and(Node::is_line_comment) {
                out.new_line(indent);
            }
        }
        out.push(close);
    }

    fn body(&self, body: &Node<'t>, indent: usize, out: &mut Lines) {
        if let Some(flat) = self.flat_body(body)
            && out.column + flat.chars().count() <= WIDTH
        {
            out.push(&flat);
            return;
        }
        let Some(items) = self.places.within.get(&body.start) else { return };
        out.push("{");
        let trailing = self.trailing_comment(body, items, out);
        out.new_line(indent + INDENT);
        self.items(trailing, body.end - 1, items, indent + INDENT, out);
        out.new_line(indent);
        out.push("}");
    }

    /// A comment on the line of the opening brace stays there; returns where the items begin.
    fn trailing_comment(&self, body: &Node<'t>, items: &[ItemPlace], out: &mut Lines) -> usize {
        let start = body.start + 1;
        let end = items.first().map_or(body.end - 1, |item| item.start);
        let mut found = Vec::new();
        comments(self.text, start, end, &mut found);
        match found.first().filter(|node| node.is_line_comment() && !node.new_line) {
            Some(node) => {
                out.push("  ");
                out.push(&self.text[node.start..node.end]);
                node.end
            }
            None => start,
        }
    }
}

/// The farthest that elements hang under the first, in characters from the item's indentation.
const FARTHEST_HANG: usize = 24;

/// The column of a property's first value, under which the others hang.
fn hanging_column(nodes: &[Node<'_>], sort: ItemSort, column: usize) -> Option<usize> {
    let name = nodes.first().filter(|_| sort == ItemSort::Entry)?;
    let is_list = nodes.iter().any(|n| n.token() == ",");
    let width = name.token().chars().count() + 1;
    (is_list && width <= FARTHEST_HANG).then_some(column + width)
}

/// Whether a line break before a node is never kept: before braces, `else` and `with`, and behind what wants a value.
fn joins(nodes: &[Node<'_>], i: usize) -> bool {
    let Some(before) = i.checked_sub(1).map(|j| &nodes[j]) else { return true };
    if nodes[i].is_comment() || before.is_comment() {
        return false;
    }
    matches!(nodes[i].sort, NodeSort::Body)
        || matches!(nodes[i].token(), "else" | "with" | "in" | "," | "=" | "as")
        || matches!(
            before.token(),
            "=" | "=>" | "let" | "var" | "fn" | "if" | "while" | "for" | "in" | "else" | "import" | "as"
        )
        || matches!(before.sort, NodeSort::Brackets { open: "(", .. }) && nodes[i].token() == "="
}

/// Whether the grammar allows a line to end before a node of an expression: behind a comma or an operator, and before
/// an operator that can only be one.
fn may_break(nodes: &[Node<'_>], i: usize) -> bool {
    let operator = |text: &str| {
        matches!(
            text,
            "+" | "-" | "*" | "/" | "%" | "^" | "==" | "!=" | "<=" | ">=" | ">" | "&&" | "||" | "?" | ":"
        )
    };
    let before = nodes[i - 1].token();
    before == ","
        || operator(before)
        || before == "<"
        || operator(nodes[i].token())
        || nodes[i].is_comment()
        || nodes[i].token() == "for"
        || nodes[i].token() == "if"
}

/// The blanks between tokens.
struct Spacing {
    sort: ItemSort,
    /// Choices that wait for their `:`.
    choices: usize,
    /// Whether the node before is an operator before its operand.
    prefix: bool,
    /// Whether a range has begun, so that `step` is no name.
    range: bool,
}

impl Spacing {
    fn new(sort: ItemSort) -> Self {
        Self { sort, choices: 0, prefix: false, range: false }
    }

    /// What stands before node `i`; called for each node in turn.
    fn before(&mut self, nodes: &[Node<'_>], i: usize) -> &'static str {
        let node = &nodes[i];
        let before = i.checked_sub(1).map(|j| &nodes[j]);
        let behind_prefix = std::mem::take(&mut self.prefix);
        let is_head = i == 1 && self.sort == ItemSort::Entry;
        let token = node.token();
        let ends_value = |b: &Node<'_>| b.ends_value() && !(self.range && b.token() == "step");
        self.prefix = matches!(token, "-" | "!") && (is_head || before.is_none_or(|b| !ends_value(b)));
        self.range |= matches!(token, ".." | "..=");
        let Some(before) = before else { return "" };
        if node.tight || behind_prefix || before.token() == "." && !is_number(before) {
            return "";
        }
        match token {
            "," => "",
            "." | ".." | "..=" => "",
            "?" => {
                self.choices += 1;
                " "
            }
            ":" if self.choices > 0 => {
                self.choices -= 1;
                " "
            }
            ":" => "",
            _ if matches!(before.token(), ".." | "..=") => {
                if token.starts_with('.') {
                    " "
                } else {
                    ""
                }
            }
            _ => match node.sort {
                NodeSort::Brackets { open: "(" | "[", .. } if !node.apart && before.ends_value() => "",
                NodeSort::Brackets { open: "(", .. } if i == 2 && nodes[0].token() == "fn" => "",
                _ => " ",
            },
        }
    }
}

fn is_number(node: &Node<'_>) -> bool {
    matches!(node.sort, NodeSort::Token(_, crate::syntax::build::Sort::Number))
}
