//! Models: read, put as they stand, and then groups like others, each with an aggregate of its own.

use super::{Lowering, Source};
use crate::diag::{Code, Diagnostic, Span};
use crate::scene::assets::gltf::{Figure, Model, ModelError};
use crate::scene::{ModelSource, Moment};
use crate::world::aggregate::Aggregate;
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::sync::Arc;

/// Models by address; none where one cannot be used, which is said once.
#[derive(Default)]
pub(super) struct Models {
    by_source: HashMap<*const ModelSource, (Option<u32>, Arc<ModelSource>)>,
    /// Files of which was said what was mended in them.
    said: HashSet<PathBuf>,
}

impl Lowering<'_> {
    /// The aggregate of a model.
    pub(super) fn model(&mut self, source: &Arc<ModelSource>, span: Span, depth: usize) -> Option<u32> {
        if let Some((known, _)) = self.models.by_source.get(&Arc::as_ptr(source)) {
            return *known;
        }
        let index = self.may_nest(depth + 1, span).then(|| self.built(source, depth)).flatten();
        self.models.by_source.insert(Arc::as_ptr(source), (index, Arc::clone(source)));
        index
    }

    fn built(&mut self, source: &ModelSource, depth: usize) -> Option<u32> {
        let figure = self.figure(source).map_err(|fault| self.sink.push(*fault)).ok()?;
        self.warn(source, &figure);
        let group = self.group(Source::Owned(figure.parts.into_iter()), depth + 1);
        Some(self.keep(Aggregate::Group(group)))
    }

    fn figure(&self, source: &ModelSource) -> Result<Figure, Box<Diagnostic>> {
        let said = |error: ModelError| Box::new(error.said(&source.path, source.span));
        let model = self.assets.model(&source.path).map_err(said)?;
        let places = match source.moment {
            None => model.places(None),
            Some(Moment { clip, seconds, .. }) if clip < model.clips().len() => {
                let clip = model.clip(self.assets.loader(), clip).map_err(said)?;
                model.places(Some((&clip, seconds)))
            }
            Some(moment) => return Err(Box::new(no_clip(&model, source, moment.span))),
        };
        let places = match &source.pose {
            None => places,
            Some(pose) => model
                .posed(&places, &pose.rig.skeleton, &pose.coordinates)
                .ok_or_else(|| said(ModelError::Bad("its nodes are not those of its pose".into())))?,
        };
        model.figure(self.assets, &places, source.span).map_err(said)
    }

    /// Once for each file.
    fn warn(&mut self, source: &ModelSource, figure: &Figure) {
        if !self.models.said.insert(source.path.clone()) {
            return;
        }
        let mut warn = |code, what: &str, list: &[String], hint: &str| {
            if !list.is_empty() {
                let message = format!("{what} the model `{}`: {}", source.path.display(), list.join("; "));
                self.sink.push(Diagnostic::new(code, source.span, message).hint(hint));
            }
        };
        let hint = "what can be drawn of it is drawn";
        warn(Code::ModelRepaired, "something was mended in, or left out of,", &figure.mended, hint);
        let hint = "the colour or number that the picture varies is used without it";
        warn(Code::MissingMaterialFile, "pictures are missing of", &figure.missing, hint);
    }
}

fn no_clip(model: &Model, source: &ModelSource, span: Span) -> Diagnostic {
    let (name, n) = (source.path.display(), model.clips().len());
    Diagnostic::new(Code::UnknownWord, span, format!("the model `{name}` has {n} clips: it has no moments"))
        .hint("leave `at` out: it then stands as its file has it")
}
