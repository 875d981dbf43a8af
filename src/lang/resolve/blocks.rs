//! Blocks: what becomes of them where they stand, and what stands between their braces.

use super::program::{Block, BlockItem, Fate};
use super::scope::Declared;
use super::{Place, Resolver};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::kinds;
use crate::lang::table::{Kind, Role};
use crate::syntax::ast;

/// A block, or nothing where it was refused.
pub(super) enum BlockOrPoison {
    Block(Box<BlockItem>),
    Poison,
}

impl<'a> Resolver<'a> {
    pub(super) fn block_item(&mut self, block: &'a ast::Block, span: Span, place: Place) -> BlockOrPoison {
        let Some(kind) = kinds::find(&block.kind.name) else {
            self.report_unknown_kind(&block.kind);
            return BlockOrPoison::Poison;
        };
        let fate = self.fate(kind, block, place);
        let resolved = self.block(kind, block, span);
        match fate {
            Some(fate) => BlockOrPoison::Block(Box::new(BlockItem { block: resolved, fate })),
            None => BlockOrPoison::Poison,
        }
    }

    /// A block with its items; its label is declared in the scope around it.
    pub(super) fn block(&mut self, kind: &'static Kind, block: &'a ast::Block, span: Span) -> Block {
        let returns = self.scopes.set_returns(false);
        let body = self.body(&block.items, Place::Block(kind));
        self.scopes.set_returns(returns);
        let label = block.label.as_ref().map(|label| {
            let access = (kind.role != Role::Part).then(|| self.declare(label, Declared::Value));
            (self.word(&label.name), label.span, access)
        });
        Block { kind, kind_span: block.kind.span, label, body, span }
    }

    pub(super) fn report_unknown_kind(&mut self, kind: &ast::Ident) {
        let message = format!("no block is of the kind `{}`", kind.name);
        let names = kinds::ALL.iter().map(|k| k.name);
        self.report(Diagnostic::new(Code::UnknownKind, kind.span, message).did_you_mean(&kind.name, names));
    }

    /// What becomes of a block that stands as an item; none where it may not stand there, which is reported.
    fn fate(&mut self, kind: &'static Kind, block: &'a ast::Block, place: Place) -> Option<Fate> {
        match (kind.role, place) {
            (Role::Object | Role::Light, _) => Some(Fate::Placed),
            (Role::Value, _) => self.fate_of_value(kind, block, place),
            (Role::Setting, Place::Top) => Some(Fate::Placed),
            (Role::Setting, Place::Block(_) | Place::Loose) => {
                self.refuse(
                    block,
                    format!("`{}` stands at the top level of a file, not inside braces", kind.name),
                    "move it out",
                );
                None
            }
            (Role::Part, Place::Block(around)) if around.property(kind.name).is_some() => {
                Some(Fate::Given(self.word(kind.name), around.property(kind.name)))
            }
            (Role::Part, Place::Loose) => Some(Fate::Given(self.word(kind.name), None)),
            (Role::Part, Place::Block(_) | Place::Top) => {
                let hint = match kind.name {
                    "tip" => "put it inside the braces of a joint",
                    _ => "put it inside the braces of a `skeleton` or of another joint",
                };
                self.refuse(block, format!("`{}` is a part of a skeleton", kind.name), hint);
                None
            }
        }
    }

    fn fate_of_value(&mut self, kind: &'static Kind, block: &'a ast::Block, place: Place) -> Option<Fate> {
        let property_of = |around: &Kind| around.property(kind.name).is_some();
        match (&block.label, place) {
            (Some(label), Place::Block(around)) if property_of(around) => {
                self.report(
                    Diagnostic::new(
                        Code::LabelInsideObject,
                        block.kind.span.to(label.span),
                        format!("`{} {} {{ … }}` would define a name inside `{}`", kind.name, label.name, around.name),
                    )
                    .label("a labelled block only names its value")
                    .hint(format!(
                        "to change a copy of `{0}`, write `{1} {0} with {{ … }}`; to use this one, leave out the label",
                        label.name, kind.name
                    )),
                );
                None
            }
            (Some(_), _) => Some(Fate::Named),
            (None, Place::Block(around)) if property_of(around) => {
                Some(Fate::Given(self.word(&block.kind.name), around.property(kind.name)))
            }
            (None, Place::Loose) => Some(Fate::Given(self.word(&block.kind.name), None)),
            (None, Place::Block(around)) => {
                self.report(crate::lang::check::unknown_property(around, kind.name, block.kind.span));
                None
            }
            (None, Place::Top) => {
                self.refuse(
                    block,
                    format!("a `{}` without a name does nothing here", kind.name),
                    &format!(
                        "name it, `{0} my_{0} {{ … }}`, or put it inside the object that it is for",
                        kind.name
                    ),
                );
                None
            }
        }
    }

    fn refuse(&mut self, block: &ast::Block, message: String, hint: &str) {
        self.report(Diagnostic::new(Code::NotPlaceable, block.kind.span, message).hint(hint));
    }
}
