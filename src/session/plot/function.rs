//! The graph of a function of the language. Where it has no value the line is interrupted.

use super::{Fault, Plane, SAMPLES, parameters, range, stroke, wrong};
use crate::diag::{Code, Sink};
use crate::lang::builtins::components;
use crate::lang::coerce::shown;
use crate::lang::eval;
use crate::lang::value::Value;
use crate::plot::{Figure, Pen};
use crate::session::dialogue::Look;
use glam::DVec2;

/// What is shown where no range is given.
pub const RANGE: (f64, f64) = (-5.0, 5.0);

/// A figure of the function over a range.
pub fn figure(look: &mut Look<'_, '_>, function: &Value, asked: (f64, f64)) -> Result<Figure, Fault> {
    let ts: Vec<f64> = parameters(range(look, asked)?, SAMPLES).collect();
    let mut points = Vec::with_capacity(ts.len());
    let mut first_fault = None;
    for &t in &ts {
        match point(look, function, t) {
            Ok(point) => points.push(point),
            // What takes too long at one place may do so at all.
            Err(fault) if fault.code == Code::LoopLimit || look.means.is_cancelled() => return Err(fault),
            Err(fault) => {
                first_fault.get_or_insert(fault);
                points.push(Vec::new());
            }
        }
    }
    if let (Some(fault), true) = (first_fault, points.iter().all(Vec::is_empty)) {
        return Err(fault);
    }
    let is_finite = |point: &Vec<f64>| !point.is_empty() && point.iter().all(|x| x.is_finite());
    if !points.iter().any(is_finite) {
        return Err(wrong(look, "none of its values here is finite, and only finite ones can be drawn"));
    }
    let plane = Plane::of(&points);
    let seen = ts.iter().zip(&points).map(|(t, point)| match point.len() {
        n if n == plane.dimension => plane.seen(*t, point),
        _ => DVec2::NAN,
    });
    let mut seen: Vec<_> = seen.collect();
    let mut figure = plane.figure("");
    figure.cut = (plane.dimension == 1).then(|| cut(seen.iter().map(|p| p.y))).flatten();
    if let Some(heights) = figure.cut {
        part_at_poles(&mut seen, heights);
    }
    figure.strokes.push(stroke(seen, Pen::Curve, false));
    Ok(figure)
}

/// The function's value at t, one to three numbers.
fn point(look: &mut Look<'_, '_>, function: &Value, t: f64) -> Result<Vec<f64>, Fault> {
    let mut sink = Sink::default();
    let crate::session::run::State { known, files, standing } = &mut *look.state;
    let run = look.means.run(known, files);
    let value = eval::call(&run, standing, function, &[Value::Number(t)], look.span, &mut sink);
    match value {
        Ok(value) => match components(&value) {
            Some((numbers, n @ 1..=3)) => Ok(numbers[..n].to_vec()),
            _ => Err(wrong(
                look,
                format!("its values are numbers or vectors of 2 or 3, and this is {}", shown(&value)),
            )),
        },
        Err(_) => {
            let fault = sink.into_sorted().into_iter().next();
            Err(fault.map_or_else(|| wrong(look, "it has no value"), Box::new))
        }
    }
}

/// Where a graph runs far off (a pole), the heights between which most of it lies, and as much again on either side.
fn cut(heights: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    /// Most of it: all but a twentieth at either end.
    const REST: usize = 20;
    /// So many times as high as most of it is far off.
    const FAR: f64 = 12.0;
    let mut heights: Vec<f64> = heights.filter(|y| y.is_finite()).collect();
    heights.sort_by(f64::total_cmp);
    let (least, most) = (heights.first()?, heights.last()?);
    let rest = heights.len() / REST;
    let (low, high) = (heights[rest], heights[heights.len() - 1 - rest]);
    let spread = high - low;
    (spread > 0.0 && most - least > FAR * spread).then_some((low - spread, high + spread))
}

/// Interrupts a graph where it leaves the heights that are shown at one side and comes back at the other.
fn part_at_poles(points: &mut [DVec2], (low, high): (f64, f64)) {
    let side = |p: DVec2| if p.y < low { -1 } else { i32::from(p.y > high) };
    for i in 1..points.len() {
        if side(points[i - 1]) * side(points[i]) < 0 {
            points[i - 1] = DVec2::NAN;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pole_is_cut_and_a_parabola_is_not() {
        let over = |f: fn(f64) -> f64| cut((0..1001).map(|i| f(f64::from(i) * 0.01 - 5.003)));
        let (low, high) = over(|x| 1.0 / x).unwrap();
        assert!(low < -1.0 && low > -50.0 && high > 1.0 && high < 50.0);
        assert_eq!(over(|x| x * x), None);
        assert_eq!(over(|_| 1.0), None);
        let mut points = [9.0, 90.0, -90.0, -9.0].map(DVec2::splat);
        part_at_poles(&mut points, (-50.0, 50.0));
        assert!(points[1].is_nan() && points.iter().filter(|p| p.is_nan()).count() == 1);
        assert_eq!(cut([f64::NAN].into_iter()), None);
    }
}
