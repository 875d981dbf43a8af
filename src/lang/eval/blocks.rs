//! Blocks and `with`: items are collected and handed to the table of kinds.

use super::{Around, Evaluator, Produced};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::kinds;
use crate::lang::resolve::program::{self, BlockItem, Fate, With};
use crate::lang::table::{Block, Context, Kind, Outcome, Reported, Role};
use crate::lang::value::{Fragment, Given, Value};
use crate::scene::{Figure, Node, RenderSettings, Stance};
use smallvec::smallvec;
use std::rc::Rc;

/// Room for more properties than this is given back.
const ROOM: usize = 64;

impl<'p> Evaluator<'p> {
    pub(super) fn block_item(&mut self, item: &'p BlockItem, out: &mut Produced) -> Outcome<()> {
        let block = &item.block;
        self.top.attempts.setting |= block.kind.role == Role::Setting;
        let value = self.block(block);
        let (name, property) = match &item.fate {
            Fate::Given(name, property) => (name, property),
            Fate::Named => {
                self.name_figure(block, &value);
                return value.map(|_| ());
            }
            Fate::Placed => return self.place_block(value?, block, out),
        };
        match value {
            Ok(value) => out.given.push(Given {
                name: name.clone(),
                name_span: block.kind_span,
                property: *property,
                values: smallvec![(value, block.span)],
            }),
            Err(Reported) => {
                out.poisoned.push((name.clone(), block.kind_span));
                return Err(Reported);
            }
        }
        Ok(())
    }

    /// Keeps a skeleton or pose that is named at the top level, for who looks at the scene.
    fn name_figure(&mut self, block: &program::Block, value: &Outcome) {
        let stance = match value {
            Ok(Value::Skeleton(rig)) => Stance::Rest(rig.clone()),
            Ok(Value::Pose(pose)) => Stance::Posed(pose.clone()),
            _ => return,
        };
        if let (true, Some((name, ..))) = (self.calls.is_empty(), &block.label) {
            self.top.figures.push(Figure { name: name.to_string(), stance });
        }
    }

    fn place_block(&mut self, value: Value, block: &program::Block, out: &mut Produced) -> Outcome<()> {
        match value {
            Value::Object(object) => self.place_node(Node::Object(object), block.span, out),
            Value::Light(light) => self.place_node(Node::Light(light), block.span, out),
            Value::Camera(camera) => {
                self.top.cameras.push((*camera).clone());
                Ok(())
            }
            Value::Render(settings) => self.place_render(&settings, block.kind_span),
            _ => Ok(()),
        }
    }

    pub(super) fn place_render(&mut self, settings: &RenderSettings, span: Span) -> Outcome<()> {
        if let Some(before) = self.top.render.as_ref().and_then(|r| r.span) {
            return Err(self.fail(
                Diagnostic::new(Code::DuplicateProperty, span, "a scene has one `render` block")
                    .label("again here")
                    .also(before, "first here")
                    .hint("put the settings of both into one"),
            ));
        }
        self.top.render = Some(settings.clone());
        Ok(())
    }

    /// A block's value. Its label, if it has one, is bound whether it fails or not.
    pub(super) fn block(&mut self, block: &'p program::Block) -> Outcome {
        let value = self.block_value(block);
        if let Some((_, _, Some(access))) = &block.label {
            self.bind_value(*access, &value);
        }
        value
    }

    fn block_value(&mut self, block: &'p program::Block) -> Outcome {
        let mut out = Produced::new(Around::Braces);
        out.given = self.spare.pop().unwrap_or_default();
        self.items(&block.body, &mut out);
        if out.failed {
            excuse(block.kind, block.kind_span, &mut out);
        }
        let mut made = Block {
            kind: block.kind,
            span: block.span,
            kind_span: block.kind_span,
            label: block.label.as_ref().map(|(name, span, _)| ((**name).into(), *span)),
            given: out.given,
            children: out.nodes,
            poisoned: out.poisoned,
        };
        let value = self.make(&mut made);
        self.keep_room(made.given);
        value
    }

    /// Keeps the room that a block's properties took for those of the next one.
    fn keep_room(&mut self, mut given: Vec<Given>) {
        if given.capacity() <= ROOM {
            given.clear();
            self.spare.push(given);
        }
    }

    /// A block's value by its kind, and the guard on what it holds.
    fn make(&mut self, block: &mut Block) -> Outcome {
        let span = block.span;
        let nested = !block.children.is_empty();
        let value = kinds::make(self, block)?;
        match &value {
            Value::Skeleton(rig) => self.spend(rig.bytes() as u64, span)?,
            Value::Pose(pose) => self.spend(pose.bytes() as u64, span)?,
            _ => {}
        }
        if nested {
            self.check_nesting(&value, span)?;
        }
        Ok(value)
    }

    /// The value of a function's body without `return`: a group where it placed anything, else its properties.
    pub(super) fn body_value(&mut self, out: Produced, span: Span) -> Outcome {
        if out.failed {
            return Err(Reported);
        }
        if out.nodes.is_empty() {
            return Ok(Value::Fragment(Rc::new(Fragment { properties: out.given })));
        }
        self.group(out, span)
    }

    fn group(&mut self, out: Produced, span: Span) -> Outcome {
        self.make(&mut Block {
            kind: kinds::group(),
            span,
            kind_span: span,
            label: None,
            given: out.given,
            children: out.nodes,
            poisoned: Vec::new(),
        })
    }

    pub(super) fn with(&mut self, with: &'p With, span: Span) -> Outcome {
        let base = self.expr(&with.base);
        let mut out = Produced::new(Around::Braces);
        self.items(&with.body, &mut out);
        let base = base?;
        if out.failed {
            return Err(Reported);
        }
        match base {
            Value::Fragment(fragment) if fragment.properties.is_empty() => {
                out.nodes.clear();
                self.group(Produced::new(Around::Braces), span)
            }
            Value::Fragment(fragment) => {
                let mut properties = fragment.properties.clone();
                properties.append(&mut out.given);
                Ok(Value::Fragment(Rc::new(Fragment { properties })))
            }
            base => {
                let value = kinds::with::apply(self, base, with.base.span, out.given, out.nodes, span)?;
                self.check_nesting(&value, span)?;
                Ok(value)
            }
        }
    }
}

/// Where an item of a block failed, nothing of the block is missing: the failed item may have been it.
fn excuse(kind: &Kind, span: Span, out: &mut Produced) {
    let required = kind.own.iter().filter(|p| p.required).map(|p| p.name);
    out.poisoned.extend(required.chain([kind.name]).map(|name| (name.into(), span)));
}
