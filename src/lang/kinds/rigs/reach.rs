//! What a pose reaches for, and what is said where it does not get there.

use super::poses::unknown_tip;
use super::range;
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::ik::{self, Goal, Method, Settings, Solution};
use crate::geometry::skeleton::{Placement, Skeleton, Turning};
use crate::lang::coerce::listed;
use crate::lang::display::number_to;
use crate::lang::kinds::read::{number_of, vector_of, word_of};
use crate::lang::table::{Block, Context, Outcome};
use crate::lang::value::Given;
use crate::math::elementary::atan2;
use crate::scene::Reach;

/// Goals with their places, and how to get there.
pub(super) struct Asked {
    goals: Vec<(Goal, Span)>,
    settings: Settings,
}

/// The goals of a pose; none where it reaches for nothing.
pub(super) fn asked(ctx: &mut dyn Context, block: &Block, skeleton: &Skeleton) -> Outcome<Option<Asked>> {
    let mut goals: Vec<(Goal, Span)> = Vec::new();
    let mut outcome = Ok(());
    let mut refined: Vec<&str> = Vec::new();
    for given in &block.given {
        let name = &*given.name;
        match (name, goals.last_mut()) {
            ("reach", _) => {
                refined.clear();
                match goal(ctx, given, skeleton) {
                    Ok(goal) => goals.push((goal, given.span())),
                    Err(reported) => outcome = Err(reported),
                }
            }
            ("weight" | "toward", _) if refined.contains(&name) => {
                let message = format!("`{name}` is given twice for one `reach`");
                let said = Diagnostic::new(Code::DuplicateProperty, given.name_span, message);
                outcome = Err(ctx.fail(said.hint("it counts for the `reach` before it")));
            }
            ("weight", Some((goal, _))) => goal.weight = number_of(&given.values[0].0),
            ("toward", Some((goal, _))) => goal.toward = Some(vector_of(&given.values[0].0)),
            ("weight" | "toward" | "method" | "iterations" | "tolerance", None)
                if !block.has("reach") || matches!(name, "weight" | "toward") =>
            {
                let message = format!("`{name}` is about a `reach`, and none is before it");
                let said = Diagnostic::new(Code::MissingProperty, given.name_span, message);
                outcome = Err(ctx.fail(said.hint("say first what is reached for: `reach hand, <6, 3, 0>`")));
            }
            _ => continue,
        }
        refined.extend(["weight", "toward"].into_iter().filter(|refining| *refining == name));
    }
    outcome?;
    Ok((!goals.is_empty()).then(|| Asked { goals, settings: settings(block) }))
}

fn goal(ctx: &mut dyn Context, given: &Given, skeleton: &Skeleton) -> Outcome<Goal> {
    let [(tip, tip_span), (point, _)] = &given.values[..] else { unreachable!("checked to be two values") };
    let name = word_of(tip);
    match skeleton.tip(name) {
        Some(tip) => Ok(Goal { tip, point: vector_of(point), weight: 1.0, toward: None }),
        None => Err(ctx.fail(unknown_tip(skeleton, name, *tip_span))),
    }
}

/// More steps than this are not made: what has not arrived by then stands still as far as anybody sees.
const MOST_STEPS: u64 = 100_000;

fn settings(block: &Block) -> Settings {
    let method = match block.word("method") {
        Some("jacobian_transpose") => Method::Transpose,
        Some("pseudo_inverse") => Method::PseudoInverse,
        Some("ccd") => Method::CyclicDescent,
        _ => Method::DampedLeastSquares,
    };
    let default = Settings::default();
    Settings {
        method,
        iterations: block.integer("iterations").map_or(default.iterations, |n| n.min(MOST_STEPS) as usize),
        tolerance: block.number("tolerance").unwrap_or(default.tolerance),
    }
}

/// Solves from these coordinates on, or in an animation from where the frame before ended, and warns where a target is not reached. A
/// moment of motion capture is a better start than the frame before: it does not drift.
pub(super) fn reach(
    ctx: &mut dyn Context,
    asked: &Asked,
    block: &Block,
    skeleton: &Skeleton,
    coordinates: &mut Vec<f64>,
) -> Outcome<Reach> {
    let goals: Vec<Goal> = asked.goals.iter().map(|(goal, _)| *goal).collect();
    let carried = if block.has("at") { None } else { ctx.start_of_reach(block.span, coordinates) };
    let found = ik::solve(skeleton, &goals, carried.as_deref().unwrap_or(coordinates), &asked.settings);
    ctx.reached(block.span, coordinates, &found.coordinates);
    if !found.converged {
        for said in short_of(asked, skeleton, &found) {
            ctx.report(said);
        }
    }
    let reach = Reach { residual: found.residual, iterations: found.iterations, converged: found.converged };
    *coordinates = found.coordinates;
    Ok(reach)
}

/// A warning for each target that is not reached.
fn short_of(asked: &Asked, skeleton: &Skeleton, found: &Solution) -> Vec<Diagnostic> {
    let placement = Placement::new(skeleton, &found.coordinates);
    let tolerance = asked.settings.tolerance;
    let why = why(asked, skeleton, found);
    let one = |(goal, span): &(Goal, Span)| {
        let (distance, turn) = distances(skeleton, &placement, goal);
        let name = &skeleton.tips()[goal.tip].name;
        let stops = (distance > tolerance).then(|| match distance.is_finite() {
            true => format!("stops {} short of its target", number_to(distance, 4)),
            false => "stops short of its target, further than numbers go".into(),
        });
        let points = (turn > tolerance).then(|| format!("points {}° off", number_to(turn.to_degrees(), 4)));
        let parts: Vec<String> = stops.into_iter().chain(points).collect();
        let message = format!("`{name}` {}", listed(&parts, "and"));
        (goal.weight > 0.0 && !parts.is_empty())
            .then(|| Diagnostic::new(Code::NotReached, *span, message).hint(why.clone()))
    };
    asked.goals.iter().filter_map(one).collect()
}

/// How far a tip is from its target, in scene units, and from its direction, in radians.
fn distances(skeleton: &Skeleton, placement: &Placement, goal: &Goal) -> (f64, f64) {
    let distance = (placement.tip(skeleton, goal.tip) - goal.point).length();
    let turn = goal.toward.map_or(0.0, |toward| {
        let points = placement.frames[skeleton.tips()[goal.tip].joint].turn * skeleton.pointing(goal.tip);
        atan2(points.cross(toward).length(), points.dot(toward))
    });
    (distance, turn)
}

/// What is in the way.
fn why(asked: &Asked, skeleton: &Skeleton, found: &Solution) -> String {
    if !found.binding.is_empty() {
        let held: Vec<String> = found.binding.iter().map(|&place| held(skeleton, place)).collect();
        return format!("it is held by the limits of {}", listed(&held, "and"));
    }
    if found.iterations >= asked.settings.iterations && found.slope > SETTLED {
        let n = found.iterations;
        return format!(
            "it was still on its way after {n} steps: give it more `iterations`, or `method dls`"
        );
    }
    if asked.goals.len() > 1 || asked.goals[0].0.toward.is_some() {
        return "not all of this can be had at once: move a target, or say by `weight` what matters more"
            .into();
    }
    "no limit is in the way: the target is out of reach".into()
}

/// A slope below which nothing more is gained.
const SETTLED: f64 = 1e-6;

/// "`elbow` (0 to 150°)".
fn held(skeleton: &Skeleton, place: usize) -> String {
    let motion = skeleton.motions().iter().find(|motion| motion.coordinate == place);
    let motion = motion.expect("every coordinate drives a motion");
    let limits = skeleton.limits()[place];
    let is_angle = motion.turning == Turning::Turn;
    format!("`{}` ({})", skeleton.joints()[motion.joint].name, range(limits.low, limits.high, is_angle))
}
