//! What a frame of an animation hands to the next one: where its reaches ended, so that an arm moves on from there, and the models and
//! motion capture that were read. Everything else is made anew. Knows nothing of files to write, nor of which frames are wanted.

use super::{Evaluator, Standing};
use crate::diag::Span;
use crate::scene::Rig;
use crate::scene::assets::gltf::{Model, ModelError};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Models by path, or why one cannot be had.
pub(super) type Models = HashMap<PathBuf, Result<Arc<Model>, ModelError>>;

/// What is handed on. A `pose` may be evaluated many times in a frame (in a loop, in a function): the first of this frame goes on from
/// the first of the frame before, and so forth.
#[derive(Default)]
pub(super) struct Carried {
    models: Models,
    /// Of motion capture, by its file and the place of its block.
    skeletons: HashMap<(PathBuf, Span), Arc<Rig>>,
    before: HashMap<Span, Vec<Reached>>,
    now: HashMap<Span, Vec<Reached>>,
}

impl Carried {
    pub(super) fn skeleton(&self, path: &Path, block: Span) -> Option<Arc<Rig>> {
        self.skeletons.get(&(path.to_owned(), block)).cloned()
    }

    pub(super) fn keep_skeleton(&mut self, path: &Path, rig: &Arc<Rig>) {
        self.skeletons.insert((path.to_owned(), rig.span), Arc::clone(rig));
    }
}

/// A reach: the coordinates that the scene gave, and those that were found.
struct Reached {
    given: Vec<f64>,
    found: Vec<f64>,
}

impl Reached {
    /// Where the next reach starts that is given these coordinates: where this one ended, except for what is given otherwise now.
    fn start(&self, given: &[f64]) -> Option<Vec<f64>> {
        let places = given.iter().zip(&self.given).zip(&self.found);
        let start = places.map(|((now, before), found)| if now == before { *found } else { *now });
        (given.len() == self.given.len()).then(|| start.collect())
    }
}

impl Standing {
    /// For the first frame of an animation.
    pub fn animated() -> Standing {
        Standing { carried: Some(Box::default()), ..Standing::default() }
    }

    /// For the frame after this one.
    pub fn next_frame(self) -> Standing {
        let hand_on = |mut carried: Box<Carried>| {
            carried.before = std::mem::take(&mut carried.now);
            carried
        };
        Standing { carried: self.carried.map(hand_on), ..Standing::default() }
    }

    /// The models that were read in frames before.
    pub(super) fn take_models(&mut self) -> Models {
        self.carried.as_mut().map(|carried| std::mem::take(&mut carried.models)).unwrap_or_default()
    }

    /// Keeps models for frames to come, where there are any.
    pub(super) fn keep_models(&mut self, models: Models) {
        if let Some(carried) = &mut self.carried {
            carried.models = models;
        }
    }
}

impl Evaluator<'_> {
    /// Where a reach of the pose at this place starts that is given these coordinates.
    pub(super) fn carried_start(&self, pose: Span, given: &[f64]) -> Option<Vec<f64>> {
        let carried = self.standing.carried.as_ref()?;
        let turn = carried.now.get(&pose).map_or(0, Vec::len);
        carried.before.get(&pose)?.get(turn)?.start(given)
    }

    /// Keeps the end of a reach for the next frame, where there is one.
    pub(super) fn carry_reach(&mut self, pose: Span, given: &[f64], found: &[f64]) {
        if let Some(carried) = &mut self.standing.carried {
            let reached = Reached { given: given.to_vec(), found: found.to_vec() };
            carried.now.entry(pose).or_default().push(reached);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reach_goes_on_from_its_end_but_for_what_is_given_otherwise() {
        let reached = Reached { given: vec![0.0, 30.0, 0.0], found: vec![12.0, 41.0, -7.0] };
        assert_eq!(reached.start(&[0.0, 30.0, 0.0]), Some(vec![12.0, 41.0, -7.0]));
        assert_eq!(reached.start(&[0.0, 35.0, 0.0]), Some(vec![12.0, 35.0, -7.0]));
        assert_eq!(reached.start(&[0.0, 35.0]), None, "another skeleton");
    }
}
