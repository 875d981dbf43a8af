//! The weights of a skin as a scene gives them.

use crate::diag::Code;
use crate::geometry::skin::Influences;
use crate::geometry::skin::weights::{SUM_SLACK, WeightError};
use crate::lang::builtins::components;
use crate::lang::coerce::shown;
use crate::lang::table::{Block, Context, Gives, Outcome};
use crate::lang::value::Value;
use crate::scene::{MeshSource, Object, SampleInput, Shape, Weights, divided_weights, unusable_weights};
use std::sync::Arc;

/// Joints that move a point unless `influences` says otherwise.
const INFLUENCES: u64 = 4;

/// The weights that a block asks for.
pub(super) fn of(
    ctx: &mut dyn Context,
    block: &Block,
    n_joints: usize,
    surface: &Object,
) -> Outcome<Weights> {
    let most = block.integer("influences").unwrap_or(INFLUENCES) as usize;
    let place = block.place("weights");
    match block.value("weights").cloned() {
        None => Ok(Weights::Smooth(most)),
        Some(Value::Word(word)) if &*word == "rigid" => Ok(Weights::Rigid),
        Some(Value::Word(_)) => Ok(Weights::Smooth(most)),
        Some(Value::List(rows)) => {
            check_surface(ctx, block, surface, rows.len())?;
            Ok(Weights::Listed(Arc::new(listed(ctx, block, &rows, n_joints)?), place))
        }
        Some(Value::Range(_)) => {
            let message = "a range is no list of rows of weights";
            Err(block.fault(ctx, Code::BadWeights, "weights", message, "give a row for each vertex"))
        }
        Some(function) => {
            let function = ctx.sampled(&function, SampleInput::Point, Gives::List(n_joints), place)?;
            Ok(Weights::Function(function, place))
        }
    }
}

/// A list needs vertices to belong to, as many as rows where that is known.
fn check_surface(ctx: &mut dyn Context, block: &Block, surface: &Object, rows: usize) -> Outcome<()> {
    let message = match &surface.shape {
        Shape::Mesh(mesh) => match &**mesh {
            MeshSource::Inline(mesh) if mesh.positions.len() != rows => {
                format!("`weights` has {rows} rows for the {} vertices of its mesh", mesh.positions.len())
            }
            MeshSource::Inline(_) | MeshSource::File { .. } => return Ok(()),
        },
        _ => "a list of weights needs a mesh: this surface has no vertices of its own".into(),
    };
    let hint = "weights by the point work for every surface: `weights p => [1 - p.x, p.x]`";
    Err(block.fault(ctx, Code::BadWeights, "weights", message, hint))
}

/// All rows; every one that cannot be used is said, and the first whose sum is not 1.
fn listed(ctx: &mut dyn Context, block: &Block, rows: &[Value], n_joints: usize) -> Outcome<Influences> {
    ctx.reserve(rows.len(), block.place("weights"))?;
    let place = Some(block.place("weights"));
    let (mut all, mut outcome, mut off) = (Influences::default(), Ok(()), None);
    for (vertex, row) in rows.iter().enumerate() {
        let sum = match numbers(row) {
            Some(weights) if weights.len() > n_joints => {
                Err(WeightError::TooMany { given: weights.len(), joints: n_joints }.to_string())
            }
            Some(weights) => {
                let row = weights.into_iter().enumerate().map(|(joint, w)| (joint as u16, w));
                all.push(row).map_err(|error| error.to_string())
            }
            None => Err(format!("it is {}, and not a list of numbers", shown(row))),
        };
        match sum {
            Ok(sum) if (sum - 1.0).abs() > SUM_SLACK => {
                off.get_or_insert((vertex, sum));
            }
            Ok(_) => {}
            Err(why) => {
                outcome = Err(ctx.fail(unusable_weights(place, &format!("of vertex {vertex}"), &why)));
            }
        }
    }
    if let Some((vertex, sum)) = off {
        ctx.report(divided_weights(place, &format!("of vertex {vertex}"), sum));
    }
    outcome.map(|()| all)
}

/// A row: a list of numbers, a vector, or one number.
fn numbers(row: &Value) -> Option<Vec<f64>> {
    if let Value::List(list) = row {
        return list.iter().map(|w| if let Value::Number(w) = w { Some(*w) } else { None }).collect();
    }
    let (row, n) = components(row)?;
    Some(row[..n].to_vec())
}
