//! The tokens of an item with their brackets matched and the comments between them.

use crate::syntax::build::{Piece, Pieces, Sort};

/// A token, a comment, or a bracket with what it encloses.
#[derive(Clone, Debug)]
pub(super) struct Node<'t> {
    pub sort: NodeSort<'t>,
    /// The first byte.
    pub start: usize,
    /// Past the last byte.
    pub end: usize,
    /// Whether blanks or comments stand before it.
    pub apart: bool,
    /// Whether a line ends between the node before and this one.
    pub new_line: bool,
    /// Whether it has to stay tight to the node before; see [`keep_tight`].
    pub tight: bool,
}

#[derive(Clone, Debug)]
pub(super) enum NodeSort<'t> {
    /// A word, number, text or sign.
    Token(&'t str, Sort),
    /// `//` to the end of the line, or a block comment.
    Comment(&'t str),
    /// `(…)`, `[…]` or a vector `<…>`.
    Brackets { open: &'t str, close: &'t str, inner: Vec<Node<'t>> },
    /// `{…}` of items; the layout reads what is in it.
    Body,
}

impl<'t> Node<'t> {
    pub fn token(&self) -> &'t str {
        match self.sort {
            NodeSort::Token(text, _) => text,
            _ => "",
        }
    }

    pub fn is_comment(&self) -> bool {
        matches!(self.sort, NodeSort::Comment(_))
    }

    /// A comment that ends its line.
    pub fn is_line_comment(&self) -> bool {
        matches!(self.sort, NodeSort::Comment(text) if text.starts_with("//"))
    }

    /// Whether a value can end with this node, so that a sign behind it stands between operands.
    pub fn ends_value(&self) -> bool {
        match self.sort {
            NodeSort::Token(text, Sort::Word) => {
                !matches!(text, "return" | "in" | "if" | "else" | "while" | "for")
            }
            NodeSort::Token(_, Sort::Number | Sort::Text) => true,
            NodeSort::Token(..) | NodeSort::Comment(_) => false,
            NodeSort::Brackets { .. } | NodeSort::Body => true,
        }
    }
}

/// The nodes of `start..end`. `head` says that the first word is no operand, so that `-` or `<` behind it begins a value.
pub(super) fn nodes(text: &str, start: usize, end: usize, head: bool) -> Vec<Node<'_>> {
    let mut flat = Vec::new();
    let mut at = start;
    for piece in Pieces::new(text, start, end) {
        comments(text, at, piece.start, &mut flat);
        flat.push(node(text, &piece, flat.is_empty()));
        at = piece.end;
    }
    comments(text, at, end, &mut flat);
    vectors(flat, head)
}

fn node<'t>(text: &'t str, piece: &Piece<'t>, first: bool) -> Node<'t> {
    let sort = match (piece.sort, piece.text.as_bytes().first()) {
        (Sort::Group, Some(b'{')) => NodeSort::Body,
        (Sort::Group, _) => {
            let inner = nodes(text, piece.start + 1, piece.end - 1, false);
            NodeSort::Brackets { open: &piece.text[..1], close: &piece.text[piece.text.len() - 1..], inner }
        }
        (sort, _) => NodeSort::Token(piece.text, sort),
    };
    let new_line = piece.first && !first;
    Node { sort, start: piece.start, end: piece.end, apart: piece.apart, new_line, tight: false }
}

/// Of an item that is placed: `a<b ? c : d` or `a-b ? c : d` would begin a property `a` if its sign were set apart.
pub(super) fn keep_tight(nodes: &mut [Node<'_>]) {
    if let [head, sign, rest @ ..] = nodes
        && matches!(head.sort, NodeSort::Token(_, Sort::Word))
        && matches!(sign.token(), "<" | "-")
        && !sign.apart
    {
        sign.tight = true;
        rest.iter_mut().take(1).for_each(|operand| operand.tight = !operand.apart);
    }
}

/// The comments of a gap between tokens.
pub(super) fn comments<'t>(text: &'t str, start: usize, end: usize, out: &mut Vec<Node<'t>>) {
    let mut at = start;
    while let Some(found) = text[at..end].find("//").into_iter().chain(text[at..end].find("/*")).min() {
        let from = at + found;
        let len = if text[from..].starts_with("//") {
            text[from..end].find('\n').unwrap_or(end - from)
        } else {
            block_comment(&text[from..end])
        };
        let new_line = text[at..from].contains('\n');
        let comment = text[from..from + len].trim_end();
        out.push(Node {
            sort: NodeSort::Comment(comment),
            start: from,
            end: from + comment.len(),
            apart: true,
            new_line,
            tight: false,
        });
        at = from + len;
    }
}

fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    loop {
        match text.as_bytes().get(at..at + 2) {
            Some(b"/*") => (depth, at) = (depth + 1, at + 2),
            Some(b"*/") => (depth, at) = (depth - 1, at + 2),
            Some(_) => at += 1,
            None => return text.len(),
        }
        if depth == 0 {
            return at;
        }
    }
}

/// Puts `<` … `>` together where they make a vector.
fn vectors(flat: Vec<Node<'_>>, head: bool) -> Vec<Node<'_>> {
    let mut levels: Vec<(Option<Node<'_>>, Vec<Node<'_>>)> = vec![(None, Vec::new())];
    for (i, node) in flat.into_iter().enumerate() {
        let nested = levels.len() > 1;
        let before = levels.last().and_then(|(_, nodes)| nodes.iter().rev().find(|n| !n.is_comment()));
        let is_head = head && i == 1 && !nested;
        let begins = node.token() == "<" && (is_head || !before.is_some_and(Node::ends_value));
        if begins {
            levels.push((Some(node), Vec::new()));
            continue;
        }
        match levels.pop() {
            Some((Some(open), inner)) if node.token() == ">" => {
                let sort = NodeSort::Brackets { open: "<", close: ">", inner };
                let vector = Node { sort, end: node.end, ..open };
                levels.last_mut().map(|(_, nodes)| nodes.push(vector)).unwrap_or_default();
            }
            Some((open, mut inner)) => {
                inner.push(node);
                levels.push((open, inner));
            }
            None => {}
        }
    }
    levels.pop().map(|(_, nodes)| nodes).unwrap_or_default()
}
