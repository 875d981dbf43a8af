//! Models of glTF files.

use super::objects::existing_file;
use super::rigs::is_reserved;
use super::shapes::finish;
use super::skins::bones;
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::listed;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Reported, Role, Type};
use crate::lang::value::Value;
use crate::scene::assets::gltf::{Model, ModelError};
use crate::scene::{ModelSource, Moment, Pose, Rig, Shape, Stance};
use std::path::Path;
use std::sync::Arc;

/// A glTF model.
pub static MODEL: Kind = Kind {
    name: "model",
    doc: "A glTF 2.0 model with its hierarchy, materials, pictures and skins, as its file has it or at a moment of a clip; parts without a \
          material have the model's own. A file is read when a picture needs it, or a name in it is asked for.",
    example: "model { file \"man.glb\"  at 0.6 }",
    role: Role::Object,
    own: &[
        Property::new(
            "file",
            &[&[Type::Text]],
            "",
            "a .glb or .gltf file, relative to the file that writes it",
        )
        .required(),
        Property::new(
            "clip",
            &[&[Type::Text]],
            "",
            "the clip that it shows, by name; where only `at` is given, the first. Without both it stands as its file has it",
        ),
        Property::new(
            "at",
            &[&[Type::NUMBER]],
            "0",
            "the moment of the clip, in seconds; it stands still before its beginning and after its end. `at t % man.duration` goes round",
        ),
        Property::new(
            "pose",
            &[&[Type::Pose]],
            "",
            "a pose of its skeleton, that of a model with the same `file`, `clip` and `at`; it turns joints from where they stand so",
        ),
        Property::new(
            "show",
            &[&[Type::Word(&["bones"])]],
            "",
            "`bones`: draws the skeleton in place of the model",
        ),
    ],
    children: false,
    open: false,
    build: Some(model),
};

fn model(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let shape = shape(ctx, block, None)?;
    finish(ctx, block, shape)
}

/// The model that a block's properties say, or, for those that it does not give, another one. A new `file` replaces all of that.
pub fn shape(ctx: &mut dyn Context, block: &Block, from: Option<&ModelSource>) -> Outcome<Shape> {
    let from = from.filter(|_| !block.has("file"));
    let (path, span) = match from {
        Some(source) => (source.path.clone(), source.span),
        None => {
            let (written, span) = (block.text("file").unwrap_or_default(), block.place("file"));
            (existing_file(ctx, written, span)?, span)
        }
    };
    let moment = moment(ctx, block, (&path, span), from.and_then(|source| source.moment))?;
    let source = ModelSource { path, span, moment, pose: from.and_then(|source| source.pose.clone()) };
    if !block.has("pose") && !block.has("show") && source.pose.is_none() {
        return Ok(Shape::Model(Arc::new(source)));
    }
    let rig = rig(ctx, &source)?;
    let pose = pose(ctx, block, &rig, source.pose.as_ref())?;
    if block.has("show") {
        let stance = pose.map_or(Stance::Rest(rig), Stance::Posed);
        return Ok(bones::drawn(&stance, block.span));
    }
    Ok(Shape::Model(Arc::new(ModelSource { pose, ..source })))
}

/// The moment of a clip that a block gives, with what it does not say as it was before.
fn moment(
    ctx: &mut dyn Context,
    block: &Block,
    (path, file): (&Path, Span),
    before: Option<Moment>,
) -> Outcome<Option<Moment>> {
    let asked = ["clip", "at"].into_iter().find(|name| block.has(name));
    let Some(asked) = asked else { return Ok(before) };
    let clip = match block.text("clip") {
        None => before.map_or(0, |before| before.clip),
        Some(name) => clip(ctx, path, file, name, block.place("clip"))?,
    };
    let seconds = block.number("at").or(before.map(|before| before.seconds)).unwrap_or(0.0);
    Ok(Some(Moment { clip, seconds, span: block.place(asked) }))
}

/// The pose that a block gives, or that it has already; it must be one of the model's skeleton.
fn pose(
    ctx: &mut dyn Context,
    block: &Block,
    rig: &Rig,
    before: Option<&Arc<Pose>>,
) -> Outcome<Option<Arc<Pose>>> {
    let pose = match block.value("pose") {
        Some(Value::Pose(pose)) => pose,
        _ => match before {
            Some(pose) => pose,
            None => return Ok(None),
        },
    };
    if pose.rig.skeleton == rig.skeleton {
        return Ok(Some(pose.clone()));
    }
    let said = Diagnostic::new(
        Code::BadProperty,
        block.place("pose"),
        "this pose is of another skeleton than the model's",
    )
    .also(block.place("file"), "the model is here")
    .hint("make the pose `of` the `.skeleton` of a model with the same `file`, `clip` and `at`");
    Err(ctx.fail(said))
}

/// The skeleton of a model, at rest as the model stands without a pose.
pub fn rig(ctx: &mut dyn Context, source: &ModelSource) -> Outcome<Arc<Rig>> {
    let ModelSource { path, span, .. } = source;
    let model = read(ctx, path, *span)?;
    let places = match source.moment {
        Some(moment) if moment.clip < model.clips().len() => {
            let clip = model.clip(ctx.loader(), moment.clip);
            let clip = clip.map_err(|error| report(ctx, path, *span, &error))?;
            model.places(Some((&clip, moment.seconds)))
        }
        _ => model.places(None),
    };
    Ok(Arc::new(Rig::new(model.skeleton(&places, &is_reserved), None, *span)))
}

/// The number of a clip.
fn clip(ctx: &mut dyn Context, path: &Path, file: Span, name: &str, at: Span) -> Outcome<usize> {
    let clips = read(ctx, path, file)?.clips();
    if let Some(index) = clips.iter().position(|clip| clip == name) {
        return Ok(index);
    }
    let message = format!("the model has no clip `{name}`");
    let said = Diagnostic::new(Code::UnknownWord, at, message).also(file, "of this file");
    let said = said.did_you_mean(name, clips.iter().map(String::as_str));
    let names: Vec<String> = clips.iter().map(|clip| format!("`{clip}`")).collect();
    let said = match (said.hints.is_empty(), names.is_empty()) {
        (true, true) => said.hint("it has none: leave `clip` out"),
        (true, false) => said.hint(format!("it has {}", listed(&names, "and"))),
        (false, _) => said,
    };
    Err(ctx.fail(said))
}

/// A model that is asked for what stands in its file.
pub fn read(ctx: &mut dyn Context, path: &Path, file: Span) -> Outcome<Arc<Model>> {
    ctx.model(path).map_err(|error| report(ctx, path, file, &error))
}

/// Says why a model cannot be had.
pub fn report(ctx: &mut dyn Context, path: &Path, file: Span, error: &ModelError) -> Reported {
    let said = error.said(path, file);
    ctx.fail(said)
}
