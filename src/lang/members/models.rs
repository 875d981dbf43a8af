//! The members of models: what stands in their files.

use super::{Ask, Family, Member};
use crate::lang::kinds::models::{read, report, rig};
use crate::lang::table::{Context, Outcome};
use crate::lang::value::Value;
use crate::scene::{ModelSource, Shape};

/// Models.
pub static FAMILY: Family = Family {
    name: "model",
    doc: "What stands in the file of a model. Asked for, the file is read.",
    holds: |value| source(value).is_some(),
    scene: "model reed { file \"reed.gltf\"  clip \"sway\" }",
    named: None,
    members: &[
        Member::field(
            "skeleton",
            "Its nodes as a skeleton, in the model's own space: as the model stands all angles are 0, and turn about the model's axes. The joints of \
             skins are balls (in a file without skins all nodes are), and every node has a tip to reach with: `hand_tip` of `hand`. For `pose`, and \
             then for the model's own `pose`.",
            ("reed.skeleton.neck.position", "<0, 2, 0>"),
            |ctx, ask| Ok(Value::Skeleton(rig(ctx, own(ask))?)),
        ),
        Member::field(
            "clips",
            "The names of its clips, in the order of the file; \"clip 0\" and so on where one has no name.",
            ("reed.clips", "[\"sway\"]"),
            clips,
        ),
        Member::field(
            "duration",
            "When the last key of its clip is, in seconds: of the clip that it shows, else of the first; 0 where it has none.",
            ("reed.duration", "2"),
            duration,
        ),
    ],
};

/// A model among objects.
fn source(value: &Value) -> Option<&ModelSource> {
    let Value::Object(object) = value else { return None };
    match &object.shape {
        Shape::Model(model) => Some(model),
        _ => None,
    }
}

fn own<'a>(ask: &'a Ask<'_>) -> &'a ModelSource {
    source(ask.value).expect("of this family")
}

fn clips(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let ModelSource { path, span, .. } = own(ask);
    let names = read(ctx, path, *span)?.clips();
    Ok(Value::list(names.iter().map(|name| Value::text(name)).collect()))
}

fn duration(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let ModelSource { path, span, moment, .. } = own(ask);
    let model = read(ctx, path, *span)?;
    let clip = moment.map_or(0, |moment| moment.clip);
    if clip >= model.clips().len() {
        return Ok(Value::Number(0.0));
    }
    let read = model.clip(ctx.loader(), clip);
    read.map(|clip| Value::Number(clip.duration)).map_err(|error| report(ctx, path, *span, &error))
}
