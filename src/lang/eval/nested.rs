//! Guards on groups in groups: how deep they nest, and how many shapes they come to. Both are counted when a group is made, from
//! what is known of the groups inside, so that nothing is ever expanded to be counted.

use super::Evaluator;
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::limits::exceeded;
use crate::lang::table::{Context, Outcome};
use crate::lang::value::Value;
use crate::scene::{Node, Shape};

/// What a group, or solids put together, come to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nested {
    /// Levels of groups, its own included.
    depth: u32,
    /// Shapes, those of groups inside counted each time they are placed; saturates.
    placements: u64,
}

/// Groups inside groups, at most: later stages follow them by recursion, on stacks that are not sized for it.
const DEEPEST_GROUP: u32 = 1000;

/// What each shape of solids put together takes once they are made ready for rays, since groups are copied into them: 660 bytes were
/// measured of half a million balls with a transform each, here rounded up.
const PART_BYTES: u64 = 1 << 10;

impl Nested {
    const SHAPE: Nested = Nested { depth: 0, placements: 1 };

    fn around(self, inside: Nested) -> Nested {
        Nested {
            depth: self.depth.max(inside.depth + 1),
            placements: self.placements.saturating_add(inside.placements),
        }
    }
}

impl Evaluator<'_> {
    /// Refuses groups nested beyond what every later stage can follow. `span` is the block's.
    pub(super) fn check_nesting(&mut self, value: &Value, span: Span) -> Outcome<()> {
        let Value::Object(object) = value else { return Ok(()) };
        let children = match &object.shape {
            Shape::Group(children) => children,
            Shape::Csg(csg) => &csg.children,
            _ => return Ok(()),
        };
        let nothing = Nested { depth: 1, placements: 0 };
        let nested = children.iter().fold(nothing, |sum, node| sum.around(self.nested(node)));
        self.refuse_deep(nested.depth, span)?;
        self.refuse_many(nested.placements, span)?;
        if matches!(object.shape, Shape::Csg(_)) {
            self.spend(nested.placements.saturating_mul(PART_BYTES), span)?;
        }
        if nested.depth > 1 {
            self.standing.nested.insert(children.as_ptr(), nested);
        } else if !self.standing.nested.is_empty() {
            self.standing.nested.remove(&children.as_ptr());
        }
        Ok(())
    }

    fn nested(&self, node: &Node) -> Nested {
        let Node::Object(object) = node else { return Nested::SHAPE };
        match &object.shape {
            Shape::Group(_) | Shape::Csg(_) => {
                let children = object.shape.children();
                let flat = Nested { depth: 1, placements: children.len() as u64 };
                self.standing.nested.get(&children.as_ptr()).copied().unwrap_or(flat)
            }
            _ => Nested::SHAPE,
        }
    }

    fn refuse_deep(&mut self, depth: u32, span: Span) -> Outcome<()> {
        if depth <= DEEPEST_GROUP {
            return Ok(());
        }
        let message = format!("groups are nested {depth} deep");
        let said = Diagnostic::new(Code::TooDeep, span, message)
            .label(format!("at most {DEEPEST_GROUP} are followed"))
            .hint("place the objects beside one another instead of each inside the last");
        Err(self.fail(said))
    }

    fn refuse_many(&mut self, placements: u64, span: Span) -> Outcome<()> {
        let limit = self.run.limits.placements;
        if placements <= limit {
            return Ok(());
        }
        let message = format!("with the groups inside it, this stands for more than {limit} shapes");
        let said = exceeded(Code::PlacementLimit, span, message, "placements", limit)
            .label("each placement counts all that is inside")
            .hint(
                "nest fewer levels, or place less in each: a ray that meets them all would never come back",
            );
        Err(self.fail(said))
    }
}
