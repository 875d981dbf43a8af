//! Copies of models and skins that stand otherwise: another pose, another moment. What they are made of stays.

use super::Place;
use crate::diag::Code;
use crate::lang::check;
use crate::lang::kinds::{models, skins};
use crate::lang::table::{Block, Context, Kind, Outcome};
use crate::lang::value::Given;
use crate::scene::Shape;

/// The shape with some of its properties changed; None where this is no model or skin.
pub(super) fn changed(
    ctx: &mut dyn Context,
    kind: &'static Kind,
    shape: &Shape,
    place: Place,
    own: &[Given],
) -> Option<Outcome<Shape>> {
    if !matches!(shape, Shape::Model(_) | Shape::Skin(_)) {
        return None;
    }
    let mut block = Block {
        kind,
        span: place.whole,
        kind_span: place.base,
        label: None,
        given: own.to_vec(),
        children: Vec::new(),
        poisoned: Vec::new(),
    };
    if let Err(reported) = check::check_given(ctx, kind, &mut block.given) {
        return Some(Err(reported));
    }
    Some(match shape {
        Shape::Model(source) => models::shape(ctx, &block, Some(source)),
        Shape::Skin(skin) => match own.iter().find(|given| !skins::CHANGEABLE.contains(&&*given.name)) {
            None => skins::changed(ctx, &block, skin).map(Shape::Skin),
            Some(other) => {
                let message = format!("the `{}` of a skin cannot be changed by `with`", other.name);
                let hint = "write a new `skin`; `with` takes its `pose`, `blend` and `tolerance`";
                Err(block.fault(ctx, Code::BadProperty, &other.name, message, hint))
            }
        },
        _ => unreachable!("looked at before"),
    })
}
