//! What `:plot` shows, as a figure: graphs of functions, curves with their combs, polygons and constructions, and the lobes of
//! materials. Knows nothing of how a figure is drawn.

mod curve;
mod function;
mod lobe;
mod request;

pub use request::{Aids, Request};

use super::dialogue::{Dialogue, Look, Reply};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::coerce::shown;
use crate::lang::value::Value;
use crate::plot::{Figure, Pen, Stroke};
use glam::DVec2;

/// Samples along a curve: about one a pixel of the pictures.
const SAMPLES: usize = 720;

impl Dialogue<'_> {
    /// The figure that is asked for; none where the reply says why. Changes nothing.
    pub fn plot(&mut self, request: &Request, first_line: usize) -> (Option<Figure>, Reply) {
        let texts = (&*request.expression, &*request.line);
        let (figure, reply) = self.look(texts, first_line, |look| {
            // What was written, without the bracket around it.
            let Span { start, end, .. } = look.span;
            if request.expression[start as usize..].starts_with('[') {
                look.span = Span { start: start + 1, end: (end - 1).max(start + 1), ..look.span };
            }
            figure(look, request).map_err(|fault| look.sink.push(*fault)).ok()
        });
        (figure.filter(|_| !reply.failed), reply)
    }
}

/// Why there is no figure.
type Fault = Box<Diagnostic>;

fn figure(look: &mut Look<'_, '_>, request: &Request) -> Result<Figure, Fault> {
    let list = if let Value::List(list) = look.value { &list[..] } else { std::slice::from_ref(look.value) };
    let Some((value, further)) = list.split_first() else {
        return Err(wrong(look, "there is nothing to plot: write `:plot x => sin(x), 0, 6.28`"));
    };
    let numbers: Option<Vec<f64>> = further.iter().map(number).collect();
    let mut figure = match (value, numbers.as_deref()) {
        (Value::Material(material), Some([])) if request.lobe => lobe::figure(look, material, 45.0)?,
        (Value::Material(material), Some(&[angle])) if request.lobe => lobe::figure(look, material, angle)?,
        (_, _) if request.lobe => {
            return Err(wrong(look, "`brdf` wants a material, and an angle or nothing"));
        }
        (Value::Curve(shared), Some([])) => curve::figure(look, shared, None, &request.aids)?,
        (Value::Curve(shared), Some(&[a, b])) => curve::figure(look, shared, Some((a, b)), &request.aids)?,
        (Value::Function(_) | Value::Builtin(_), _) if request.aids != Aids::default() => {
            let said = wrong(look, "`comb`, `polygon` and `blossom` want a curve, and this is a function");
            return Err(Box::new(said.hint("make it one: `curve(t => …, 0, 1)`")));
        }
        (Value::Function(_) | Value::Builtin(_), Some([])) => function::figure(look, value, function::RANGE)?,
        (Value::Function(_) | Value::Builtin(_), Some(&[a, b])) => function::figure(look, value, (a, b))?,
        (Value::Function(_) | Value::Builtin(_) | Value::Curve(_), _) => {
            return Err(wrong(look, "a range is two numbers behind the function: `, 0, 1`"));
        }
        (other, _) => {
            let message = format!("a function or a curve can be plotted, and this is {}", shown(other));
            return Err(Box::new(wrong(look, message).hint("write `:plot x => …, from, to`")));
        }
    };
    figure.title.clone_from(&request.title);
    Ok(figure)
}

fn number(value: &Value) -> Option<f64> {
    if let Value::Number(x) = value { Some(*x) } else { None }
}

fn wrong(look: &Look<'_, '_>, message: impl Into<String>) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(Code::TypeMismatch, look.span, message))
}

/// The range of a plot, or why it is none.
fn range(look: &Look<'_, '_>, (from, to): (f64, f64)) -> Result<(f64, f64), Fault> {
    if from < to && from.is_finite() && to.is_finite() {
        return Ok((from, to));
    }
    let wanted = if from < to { "between finite numbers" } else { "from a smaller to a larger number" };
    Err(wrong(look, format!("a range runs {wanted}, and this one from {from:?} to {to:?}")))
}

/// So many parameters of a range, both ends among them.
fn parameters((from, to): (f64, f64), n: usize) -> impl Iterator<Item = f64> {
    let at = move |share: f64| match to - from {
        _ if share == 1.0 => to,
        width if width.is_finite() => from + width * share,
        _ => from * (1.0 - share) + to * share,
    };
    (0..n).map(move |i| at(i as f64 / (n - 1) as f64))
}

/// Points of one to three numbers, seen in a plane.
struct Plane {
    dimension: usize,
    /// The coordinates that run right and up.
    axes: [usize; 2],
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl Plane {
    /// The plane in which these points are widest; a view of points in space is along an axis, toward its negative side.
    fn of(points: &[Vec<f64>]) -> Plane {
        let dimension = points.iter().map(Vec::len).max().unwrap_or(1);
        let extent = |axis: usize| {
            let along = points.iter().filter_map(|p| p.get(axis)).filter(|x| x.is_finite());
            let (low, high) =
                along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
            high - low
        };
        // Of equal ones the last is looked along: drawings in the plane of x and y are seen as they are.
        let along = (0..3).rev().min_by(|a, b| extent(*a).total_cmp(&extent(*b))).unwrap_or(2);
        let axes = if dimension < 3 { [0, 1] } else { [(along + 1) % 3, (along + 2) % 3] };
        Plane { dimension, axes }
    }

    /// Where a point of parameter t is seen: numbers over their parameter.
    fn seen(&self, t: f64, point: &[f64]) -> DVec2 {
        match self.dimension {
            1 => DVec2::new(t, point[0]),
            _ => DVec2::new(point[self.axes[0]], point[self.axes[1]]),
        }
    }

    /// An empty figure of it.
    fn figure(&self, parameter: &str) -> Figure {
        let [x, y] = self.axes.map(|axis| AXES[axis]);
        match self.dimension {
            1 => Figure { x_label: parameter.into(), ..Figure::default() },
            2 => Figure { x_label: x.into(), y_label: y.into(), same_scale: true, ..Figure::default() },
            _ => {
                let along = AXES[3 - self.axes[0] - self.axes[1]];
                let x_label = format!("{x}, seen along -{along}");
                Figure { x_label, y_label: y.into(), same_scale: true, ..Figure::default() }
            }
        }
    }
}

fn stroke(points: Vec<DVec2>, pen: Pen, dotted: bool) -> Stroke {
    Stroke { points, pen, dotted }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_space_are_seen_along_their_least_extent_with_a_right_handed_view() {
        let axes = |points: [[f64; 3]; 2]| Plane::of(&points.map(|p| p.to_vec())).axes;
        assert_eq!(axes([[0.0, 0.0, 0.0], [3.0, 2.0, 1.0]]), [0, 1]);
        assert_eq!(axes([[0.0, 0.0, 0.0], [3.0, 1.0, 2.0]]), [2, 0]);
        assert_eq!(axes([[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]), [1, 2]);
        assert_eq!(axes([[0.0; 3], [0.0; 3]]), [0, 1]);
    }
}
