//! A ray against a bicubic patch that is exactly a paraboloid z = x² + y² or a monkey saddle z = x³ − 3xy², over [−1, 1]². Input: origin,
//! direction, and the distance of the first hit, NaN for none. Truth: closed forms.

use super::SEED;
use super::spheres::{line, square_root};
use crate::geometry::patch::{Bicubic, PatchTree};
use crate::math::Dd;
use crate::math::elementary::exp2;
use crate::math::random::Random;
use crate::math::solve::roots_between;
use crate::report::naive::patches as naive;
use crate::report::row::Row;
use crate::report::trial::{Plan, Subject, Trial, Verdict, default, variant};
use glam::DVec3;

type Input = [f64; 7];

/// Two first hits farther apart than this are different hits, not one found badly: coarse triangles of these patches are off by less.
const ANOTHER: f64 = 0.2;

/// Trials of ray and patch.
pub fn rows(plan: &Plan) -> Vec<Row> {
    let trials = [
        trial(plan, "transversal", "absolute", 1e-12, paraboloid(), slanted),
        trial(plan, "first of three", "absolute", 1e-12, monkey_saddle(), first_of_three),
        trial(plan, "grazing", "absolute, times √δ", 2e-15, paraboloid(), grazing),
        trial(plan, "just missing", "absolute", 0.0, paraboloid(), missing),
    ];
    trials.into_iter().flatten().collect()
}

fn trial(
    plan: &Plan,
    case: &'static str,
    unit: &'static str,
    bar: f64,
    piece: Bicubic,
    draw: fn(&mut Random) -> Input,
) -> Vec<Row> {
    let mut random = Random::new(SEED);
    let inputs = (0..plan.inputs.min(4000)).map(|_| draw(&mut random)).collect();
    let subject = Subject { component: "ray and patch", case, unit, work: "", bar: Some(bar) };
    let scale = if case == "grazing" { |i: &Input| i[2].sqrt() } else { |_: &Input| 1.0 };
    let mut trial =
        Trial::new(plan, subject, inputs, move |i: &Input, t: &Option<f64>| judge(*t, i[6], scale(i)))
            .in_chains(|t| t.unwrap_or(0.0));
    for (name, n) in [("16 × 16 triangles", 16), ("64 × 64 triangles", 64)] {
        let diced = std::rc::Rc::new(naive::Diced::new(&piece, n));
        trial.run(variant(name), move |i| diced.meet(&line(i)));
    }
    trial.run(variant("newton from one start"), move |i| naive::newton(&piece, &line(i)));
    let tree = std::rc::Rc::new(PatchTree::new(&[piece]));
    trial.run(
        default("isolated roots").note("Newton finds a hit, not the first; triangles are flat"),
        move |i| {
            let line = line(i);
            tree.first_hit(line.origin, line.direction, 0.0, f64::INFINITY).map(|hit| hit.t)
        },
    );
    trial.finish()
}

fn judge(found: Option<f64>, truth: f64, scale: f64) -> Verdict {
    match found {
        None => Verdict { missed: usize::from(!truth.is_nan()), ..Verdict::default() },
        Some(_) if truth.is_nan() => Verdict { spurious: 1, ..Verdict::default() },
        // A hit that is not the first.
        Some(t) if (t - truth).abs() > ANOTHER => Verdict { spurious: 1, ..Verdict::default() },
        Some(t) => Verdict::error((t - truth).abs() * scale),
    }
}

const X: [f64; 4] = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
const SQUARE: [f64; 4] = [1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0];
const CUBE: [f64; 4] = [-1.0, 1.0, -1.0, 1.0];

fn graph(z: impl Fn(usize, usize) -> f64) -> Bicubic {
    Bicubic { points: std::array::from_fn(|i| std::array::from_fn(|j| DVec3::new(X[i], X[j], z(i, j)))) }
}

fn paraboloid() -> Bicubic {
    graph(|i, j| SQUARE[i] + SQUARE[j])
}

fn monkey_saddle() -> Bicubic {
    graph(|i, j| CUBE[i] - 3.0 * X[i] * SQUARE[j])
}

fn input(o: DVec3, d: DVec3, t: f64) -> Input {
    [o.x, o.y, o.z, d.x, d.y, d.z, t]
}

/// From above, steep enough to meet the bowl once, toward a point well inside its border.
fn slanted(r: &mut Random) -> Input {
    let (x, y) = (r.between(-0.8, 0.8), r.between(-0.8, 0.8));
    let target = DVec3::new(x, y, x * x + y * y);
    let d = DVec3::new(r.between(-0.3, 0.3), r.between(-0.3, 0.3), -1.0);
    let o = target - d * r.between(3.0, 6.0);
    // z − x² − y² along the ray: c + bt + at², first root.
    let [ox, oy, dx, dy] = [o.x, o.y, d.x, d.y].map(Dd::from);
    let a = -(dx.times(dx) + dy.times(dy));
    let b = Dd::from(d.z) - (ox.times(dx) + oy.times(dy)).scaled(2.0);
    let c = Dd::from(o.z) - ox.times(ox) - oy.times(oy);
    let root = square_root(b.times(b) - a.times(c).scaled(4.0));
    // The root with the lesser t, without cancellation: 2c / (−b + √).
    let t = c.scaled(2.0).over(root - b).value();
    input(o, d, t)
}

/// Along x, low over the saddle: x³ − 3y²x = z has three roots within the border.
fn first_of_three(r: &mut Random) -> Input {
    let y = r.sign() * r.between(0.2, 0.5);
    // The turns of x³ − 3y²x are at ±y, with values ∓2|y|³.
    let z = r.between(-1.8, 1.8) * y.abs() * y * y;
    let roots = roots_between(&[-z, -3.0 * y * y, 0.0, 1.0], -1.0, 1.0);
    input(DVec3::new(-5.0, y, z), DVec3::X, 5.0 + roots.first().copied().unwrap_or(f64::NAN))
}

/// Along x through (0, 0, δ): hits at 5 ∓ √δ.
fn grazing(r: &mut Random) -> Input {
    let delta = exp2(r.between(-40.0, -13.0));
    input(DVec3::new(-5.0, 0.0, delta), DVec3::X, 5.0 - delta.sqrt())
}

/// The same from below.
fn missing(r: &mut Random) -> Input {
    let delta = exp2(r.between(-40.0, -13.0));
    input(DVec3::new(-5.0, 0.0, -delta), DVec3::X, f64::NAN)
}
