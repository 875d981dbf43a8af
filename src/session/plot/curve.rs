//! A curve with its comb, its polygon and its construction. The comb is κ·n, turned away from the centre of curvature.

use super::{Aids, Fault, Plane, SAMPLES, parameters, range, stroke, wrong};
use crate::geometry::any_curve::AnyCurve;
use crate::geometry::curve::{Curve, Piece, Side};
use crate::geometry::measured::Measured;
use crate::math::Point;
use crate::plot::{Figure, Pen, Stroke};
use crate::session::dialogue::Look;
use glam::DVec2;

/// Teeth of a comb.
const TEETH: usize = 64;
/// The longest tooth, as a share of the curve's extent.
const TOOTH: f64 = 0.25;

/// A figure of the curve over a range, or over all of its domain.
pub fn figure(
    look: &Look<'_, '_>,
    curve: &AnyCurve,
    asked: Option<(f64, f64)>,
    aids: &Aids,
) -> Result<Figure, Fault> {
    match curve {
        AnyCurve::Numbers(curve) => of(look, curve, asked, aids),
        AnyCurve::Plane(curve) => of(look, curve, asked, aids),
        AnyCurve::Space(curve) => of(look, curve, asked, aids),
    }
}

fn of<P: Point>(
    look: &Look<'_, '_>,
    curve: &Measured<P>,
    asked: Option<(f64, f64)>,
    aids: &Aids,
) -> Result<Figure, Fault> {
    let domain = curve.path().domain();
    let ends = range(look, asked.unwrap_or(domain))?;
    let inside = |t: f64| curve.parameter(t).map_err(|error| wrong(look, error.to_string()));
    inside(ends.0)?;
    inside(ends.1)?;
    let ts: Vec<f64> = parameters(ends, SAMPLES).collect();
    let points: Vec<Vec<f64>> = ts.iter().map(|t| numbers(curve.path().position(*t))).collect();
    let plane = Plane::of(&points);
    let mut figure = plane.figure("t");
    let seen: Vec<DVec2> = ts.iter().zip(&points).map(|(t, point)| plane.seen(*t, point)).collect();
    let spline = |what: &str| {
        let message = format!("`{what}` wants a curve of cubic pieces, and this one is a function");
        curve.spline().ok_or_else(|| wrong(look, message))
    };
    if aids.comb {
        if plane.dimension == 1 {
            return Err(wrong(
                look,
                "`comb` wants a curve in the plane or in space, and this one is of numbers",
            ));
        }
        figure.strokes.extend(comb(curve, &plane, ends, extent(&seen)));
    }
    if aids.polygon {
        figure.strokes.extend(polygon(spline("polygon")?, &plane));
    }
    figure.strokes.push(stroke(seen, Pen::Curve, false));
    if let Some(t) = aids.blossom {
        let t = inside(t)?;
        figure.strokes.extend(construction(spline("blossom")?, &plane, t));
    }
    Ok(figure)
}

fn numbers<P: Point>(point: P) -> Vec<f64> {
    (0..P::DIMENSION).map(|axis| point.coordinate(axis)).collect()
}

/// The larger of width and height.
fn extent(points: &[DVec2]) -> f64 {
    let (low, high) = points.iter().fold((DVec2::MAX, DVec2::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
    (high - low).max_element().max(0.0)
}

/// The curvature vector κ·n = (γ″ − (γ″·t)·t) / |γ′|²; zero where the curve stands still.
fn curvature<P: Point>(curve: &Measured<P>, t: f64) -> P {
    let [velocity, acceleration, _] = curve.path().derivatives_from(t, Side::After);
    let square = velocity.dot(velocity);
    if square <= 0.0 {
        return P::zero();
    }
    (acceleration - velocity * (acceleration.dot(velocity) / square)) / square
}

fn comb<P: Point>(curve: &Measured<P>, plane: &Plane, ends: (f64, f64), extent: f64) -> Vec<Stroke> {
    let ts: Vec<f64> = parameters(ends, TEETH + 1).collect();
    let bends: Vec<P> = ts.iter().map(|t| curvature(curve, *t)).collect();
    let largest = bends.iter().map(|k| k.length()).filter(|k| k.is_finite()).fold(0.0, f64::max);
    if largest == 0.0 {
        return Vec::new();
    }
    let scale = TOOTH * extent / largest;
    let foot = |t: f64| curve.path().position(t);
    let tip = |t: f64, bend: P| plane.seen(t, &numbers(foot(t) - bend * scale));
    let teeth = ts
        .iter()
        .zip(&bends)
        .map(|(&t, &bend)| stroke(vec![plane.seen(t, &numbers(foot(t))), tip(t, bend)], Pen::Faint, false));
    let tips = ts.iter().zip(&bends).map(|(&t, &bend)| tip(t, bend)).collect();
    teeth.chain([stroke(tips, Pen::Faint, false)]).collect()
}

/// The points that the curve was made from; of a curve of numbers, which has none in the plane of its graph, those of its
/// Bézier pieces.
fn polygon<P: Point>(curve: &Curve<P>, plane: &Plane) -> Vec<Stroke> {
    if plane.dimension == 1 {
        return curve.pieces().iter().map(|piece| stroke(corners(piece, plane), Pen::Aid, true)).collect();
    }
    let mut points: Vec<DVec2> = curve.points().iter().map(|p| plane.seen(0.0, &numbers(*p))).collect();
    points.extend(points.first().copied().filter(|_| curve.closed()));
    vec![stroke(points, Pen::Aid, true)]
}

/// The four points of a piece, those of numbers over the thirds of its interval.
fn corners<P: Point>(piece: &Piece<P>, plane: &Plane) -> Vec<DVec2> {
    let third = (piece.end() - piece.start()) / 3.0;
    let at = |(i, p): (usize, P)| plane.seen(piece.start() + third * i as f64, &numbers(p));
    piece.points().into_iter().enumerate().map(at).collect()
}

/// De Casteljau's construction: the polygon of the piece, the two and the one between, and the point of the curve.
fn construction<P: Point>(curve: &Curve<P>, plane: &Plane, t: f64) -> Vec<Stroke> {
    let holds = |piece: &&Piece<P>| t <= piece.end();
    let piece = curve.pieces().iter().find(holds).unwrap_or(&curve.pieces()[curve.pieces().len() - 1]);
    let share = (t - piece.start()) / (piece.end() - piece.start());
    let mut level = corners(piece, plane);
    let mut strokes = vec![stroke(level.clone(), Pen::Aid, true)];
    while level.len() > 1 {
        level = level.windows(2).map(|pair| pair[0].lerp(pair[1], share)).collect();
        strokes.push(stroke(level.clone(), Pen::Accent, true));
    }
    strokes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arch() -> Curve<DVec2> {
        let points = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(DVec2::from);
        Curve::bezier(&points, None, false).unwrap()
    }

    #[test]
    fn the_construction_ends_in_the_point_of_the_curve() {
        let plane = Plane { dimension: 2, axes: [0, 1] };
        for t in [0.0, 0.3, 1.0] {
            let strokes = construction(&arch(), &plane, t);
            assert_eq!(strokes.iter().map(|s| s.points.len()).collect::<Vec<_>>(), [4, 3, 2, 1]);
            assert!((strokes[3].points[0] - arch().at(t).unwrap()).length() < 1e-15);
        }
    }

    #[test]
    fn teeth_are_as_long_as_the_curve_is_bent() {
        let curve = Measured::from(arch());
        for t in [0.1, 0.5, 0.8] {
            let bend = curvature(&curve, t);
            assert!((bend.length() - arch().curvature(t).unwrap().abs()).abs() < 1e-12, "{t}");
            assert!(bend.dot(arch().velocity(t).unwrap()).abs() < 1e-12);
        }
        let teeth = comb(&curve, &Plane { dimension: 2, axes: [0, 1] }, (0.0, 1.0), 1.0);
        let longest =
            teeth[..TEETH + 1].iter().map(|s| s.points[0].distance(s.points[1])).fold(0.0, f64::max);
        assert!((longest - TOOTH).abs() < 1e-12);
    }
}
