//! The layout of a figure: margins for the words, the frame, the numbers of the axes, the strokes clipped to the frame.

use super::ticks::{Ticks, ticks};
use super::{Anchor, Canvas, Figure, Pen, Stroke};
use crate::math::elementary::powi;
use glam::DVec2;

/// From the figure's units to the canvas's.
struct View {
    low: DVec2,
    /// A power of two for each axis: times it, numbers of any size are as far apart as those about 1.
    unit: DVec2,
    /// Of the canvas's units for each of those.
    scale: DVec2,
    /// The frame: left, bottom.
    origin: DVec2,
    /// The frame's width and height.
    room: DVec2,
}

/// Draws a figure. One without a finite point is its title and an empty frame.
pub fn draw(figure: &Figure, canvas: &mut dyn Canvas) {
    let character = canvas.character();
    let (low, high) = shown(figure);
    // An axis whose numbers want an offset has a place for it, however many of them there will be.
    let [x_offset, y_offset] = [0, 1].map(|axis| ticks(low[axis], high[axis], MOST[axis]).offset.is_some());
    let above = !(figure.title.is_empty() && figure.y_label.is_empty()) || y_offset;
    let below = !figure.x_label.is_empty() || x_offset;
    let top = if above { 1.5 } else { 0.5 } * character.y;
    let bottom = if below { 2.5 } else { 1.5 } * character.y;
    let height = (canvas.size().y - top - bottom).max(1.0);
    let rows = (height / (2.5 * character.y)) as usize;
    let y_ticks = ticks(low.y, high.y, rows.clamp(2, MOST[1]));
    let left = (widest(&y_ticks) + 2.0) * character.x;
    let width = (canvas.size().x - left - 2.5 * character.x).max(1.0);
    let view = View::new(figure, (low, high), DVec2::new(left, top + height), DVec2::new(width, height));
    let end = view.end();
    let x_ticks = side_by_side(view.low.x, end.x, view.room.x / character.x);
    let y_ticks = if figure.same_scale { ticks(view.low.y, end.y, rows.clamp(2, MOST[1])) } else { y_ticks };
    frame(canvas, &view, &x_ticks.numbers, &y_ticks.numbers);
    words(canvas, figure, &view, [x_ticks.offset, y_ticks.offset].map(Option::unwrap_or_default));
    figure.strokes.iter().for_each(|stroke| draw_stroke(canvas, &view, stroke));
}

/// The most numbers that an axis has, to the right and upward.
const MOST: [usize; 2] = [11, 9];

/// Characters of the longest number of an axis.
fn widest(ticks: &Ticks) -> f64 {
    ticks.numbers.iter().map(|(_, word)| word.chars().count()).max().unwrap_or(1) as f64
}

/// The numbers that fit beside one another into so many characters: the narrower the frame, the fewer.
fn side_by_side(low: f64, high: f64, columns: f64) -> Ticks {
    let most = ((columns / 10.0) as usize).clamp(2, MOST[0]);
    let fits = |found: &Ticks| (widest(found) + 1.0) * found.numbers.len() as f64 <= columns;
    let fewer = (2..=most).rev().map(|most| ticks(low, high, most));
    fewer.into_iter().find(fits).unwrap_or_else(|| ticks(low, high, 2))
}

/// The part of the plane that is shown, with a little room around it, not empty; all of it is finite.
fn shown(figure: &Figure) -> (DVec2, DVec2) {
    let (mut low, mut high) = figure.bounds().unwrap_or((DVec2::ZERO, DVec2::ONE));
    if let Some((least, most)) = figure.cut {
        (low.y, high.y) = (low.y.max(least), high.y.min(most));
    }
    for axis in 0..2 {
        // A constant is shown in the middle of a range of its own size.
        let around = if high[axis] > low[axis] { 0.0 } else { 0.5 * low[axis].abs().max(1.0) };
        low[axis] -= around;
        high[axis] += around;
    }
    let margin = (0.04 * high - 0.04 * low) * if figure.same_scale { DVec2::ONE } else { DVec2::Y };
    (finite(low - margin), finite(high + margin))
}

fn finite(p: DVec2) -> DVec2 {
    p.clamp(DVec2::MIN, DVec2::MAX)
}

/// A power of two that brings a number near 1; of the smallest and the largest it is a little short.
fn unit_of(size: f64) -> f64 {
    let exponent = (size.to_bits() >> 52 & 0x7ff) as i32 - 1023;
    powi(2.0, (-exponent).clamp(-1000, 1000))
}

impl View {
    fn new(figure: &Figure, (low, high): (DVec2, DVec2), origin: DVec2, room: DVec2) -> View {
        let largest = low.abs().max(high.abs());
        let of_all = if figure.same_scale { DVec2::splat(largest.max_element()) } else { largest };
        let unit = DVec2::new(unit_of(of_all.x), unit_of(of_all.y));
        let size = high * unit - low * unit;
        if !figure.same_scale {
            return View { low, unit, scale: room / size, origin, room };
        }
        // The frame keeps its size, and what is shown grows in one direction.
        let scale = (room / size).min_element();
        let low = finite((low * unit - 0.5 * (room / scale - size)) / unit);
        View { low, unit, scale: DVec2::splat(scale), origin, room }
    }

    /// The figure's point at the right and the top of the frame.
    fn end(&self) -> DVec2 {
        finite((self.low * self.unit + self.room / self.scale) / self.unit)
    }

    /// Where a point is drawn; one that is far out of the frame, not so far that the numbers end.
    fn at(&self, p: DVec2) -> DVec2 {
        const FAR: f64 = 1e9;
        let offset = ((p * self.unit - self.low * self.unit) * self.scale)
            .clamp(DVec2::splat(-FAR), DVec2::splat(FAR));
        DVec2::new(self.origin.x + offset.x, self.origin.y - offset.y)
    }

    fn corners(&self) -> (DVec2, DVec2) {
        (DVec2::new(self.origin.x, self.origin.y - self.room.y), self.origin + DVec2::new(self.room.x, 0.0))
    }
}

fn frame(canvas: &mut dyn Canvas, view: &View, x_ticks: &[(f64, String)], y_ticks: &[(f64, String)]) {
    let character = canvas.character();
    let (low, high) = view.corners();
    let tick = 0.25 * character.y;
    canvas.line(DVec2::new(low.x, high.y), high, Pen::Frame);
    canvas.line(low, DVec2::new(low.x, high.y), Pen::Frame);
    for (x, word) in x_ticks {
        let at = DVec2::new(view.at(DVec2::new(*x, view.low.y)).x, high.y);
        canvas.line(at, at + DVec2::new(0.0, tick), Pen::Frame);
        canvas.word(at + DVec2::new(0.0, character.y), Anchor::Middle, word, Pen::Frame);
    }
    for (y, word) in y_ticks {
        let at = DVec2::new(low.x, view.at(DVec2::new(view.low.x, *y)).y);
        canvas.line(at - DVec2::new(tick, 0.0), at, Pen::Frame);
        canvas.word(at - DVec2::new(character.x, 0.0), Anchor::End, word, Pen::Frame);
    }
}

/// The title at the top, the names of the axes at their ends, each with what is to be added to its numbers.
fn words(canvas: &mut dyn Canvas, figure: &Figure, view: &View, [x_offset, y_offset]: [String; 2]) {
    let named = |label: &str, offset: String| match (label, &*offset) {
        (_, "") => label.to_owned(),
        ("", _) => offset,
        _ => format!("{label}  {offset}"),
    };
    let (x_label, y_label) = (named(&figure.x_label, x_offset), named(&figure.y_label, y_offset));
    let character = canvas.character();
    let (low, high) = view.corners();
    let top = low.y - character.y;
    canvas.word(DVec2::new(low.x, top), Anchor::Start, &y_label, Pen::Frame);
    let after = y_label.chars().count() as f64 + 3.0;
    canvas.word(DVec2::new(low.x + after * character.x, top), Anchor::Start, &figure.title, Pen::Frame);
    canvas.word(DVec2::new(high.x, high.y + 2.0 * character.y), Anchor::End, &x_label, Pen::Frame);
}

fn draw_stroke(canvas: &mut dyn Canvas, view: &View, stroke: &Stroke) {
    let corners = view.corners();
    let finite = |p: &DVec2| p.is_finite();
    for pair in stroke.points.windows(2).filter(|pair| pair.iter().all(finite)) {
        if let Some((a, b)) = clipped(view.at(pair[0]), view.at(pair[1]), corners) {
            canvas.line(a, b, stroke.pen);
        }
    }
    if stroke.dotted || stroke.points.len() == 1 {
        let at = stroke.points.iter().filter(|p| p.is_finite()).map(|p| view.at(*p));
        at.filter(|p| p.cmpge(corners.0).all() && p.cmple(corners.1).all())
            .for_each(|p| canvas.dot(p, stroke.pen));
    }
}

/// The part of a line in a box (Liang & Barsky 1984); none where it misses it.
fn clipped(a: DVec2, b: DVec2, (low, high): (DVec2, DVec2)) -> Option<(DVec2, DVec2)> {
    let along = b - a;
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let (d, to_low, to_high) = (along[axis], low[axis] - a[axis], high[axis] - a[axis]);
        if d == 0.0 {
            if to_low > 0.0 || to_high < 0.0 {
                return None;
            }
            continue;
        }
        let (enters, leaves) = if d > 0.0 { (to_low / d, to_high / d) } else { (to_high / d, to_low / d) };
        (from, to) = (from.max(enters), to.min(leaves));
    }
    (from <= to).then(|| (a + along * from, a + along * to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_any_size_fill_the_frame() {
        let (origin, room) = (DVec2::new(10.0, 90.0), DVec2::new(80.0, 80.0));
        for (low, high) in
            [(0.0, 5e-324), (-1e308, 1e308), (f64::MIN, f64::MAX), (1e15, 1e15 + 1.0), (-1e-310, 3e-312)]
        {
            for same_scale in [false, true] {
                let stroke = Stroke {
                    points: vec![DVec2::splat(low), DVec2::splat(high)],
                    pen: Pen::Curve,
                    dotted: false,
                };
                let figure = Figure { strokes: vec![stroke], same_scale, ..Figure::default() };
                let view = View::new(&figure, (DVec2::splat(low), DVec2::splat(high)), origin, room);
                assert!(view.at(DVec2::splat(low)).distance(origin) < 1e-6, "{low:e}");
                assert!(view.at(DVec2::splat(high)).distance(DVec2::new(90.0, 10.0)) < 1e-6, "{high:e}");
                let (below, above) = shown(&figure);
                assert!(below.is_finite() && above.is_finite() && below.cmplt(above).all(), "{low:e}");
            }
        }
    }

    #[test]
    fn lines_are_cut_at_the_frame() {
        let unit = (DVec2::ZERO, DVec2::ONE);
        let cut = clipped(DVec2::new(-1.0, 0.5), DVec2::new(3.0, 0.5), unit);
        assert_eq!(cut, Some((DVec2::new(0.0, 0.5), DVec2::new(1.0, 0.5))));
        assert_eq!(clipped(DVec2::new(-1.0, 2.0), DVec2::new(3.0, 2.0), unit), None);
        assert_eq!(clipped(DVec2::new(2.0, 0.0), DVec2::new(3.0, 1.0), unit), None);
        assert!(clipped(DVec2::splat(0.2), DVec2::splat(0.2), unit).is_some());
    }
}
