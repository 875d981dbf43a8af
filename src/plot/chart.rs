//! The layout of a figure: margins for the words, the frame, the numbers of the axes, the strokes clipped to the frame.

use super::ticks::ticks;
use super::{Anchor, Canvas, Figure, Pen, Stroke};
use glam::DVec2;

/// From the figure's units to the canvas's.
struct View {
    low: DVec2,
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
    let top = if figure.title.is_empty() && figure.y_label.is_empty() { 0.5 } else { 1.5 } * character.y;
    let bottom = if figure.x_label.is_empty() { 1.5 } else { 2.5 } * character.y;
    let height = (canvas.size().y - top - bottom).max(1.0);
    let rows = (height / (2.5 * character.y)) as usize;
    let y_ticks = ticks(low.y, high.y, rows.clamp(2, 9));
    let widest = y_ticks.iter().map(|(_, word)| word.chars().count()).max().unwrap_or(1) as f64;
    let left = (widest + 2.0) * character.x;
    let width = (canvas.size().x - left - 2.5 * character.x).max(1.0);
    let view = View::new(figure, (low, high), DVec2::new(left, top + height), DVec2::new(width, height));
    // The narrower the frame, the fewer numbers fit side by side.
    let columns = (view.room.x / (10.0 * character.x)) as usize;
    let x_ticks = ticks(view.low.x, view.low.x + view.room.x / view.scale.x, columns.clamp(2, 11));
    let y_ticks = if figure.same_scale {
        ticks(view.low.y, view.low.y + view.room.y / view.scale.y, rows.clamp(2, 9))
    } else {
        y_ticks
    };
    frame(canvas, &view, &x_ticks, &y_ticks);
    words(canvas, figure, &view);
    figure.strokes.iter().for_each(|stroke| draw_stroke(canvas, &view, stroke));
}

/// The part of the plane that is shown, with a little room around it, not empty.
fn shown(figure: &Figure) -> (DVec2, DVec2) {
    let (mut low, mut high) = figure.bounds().unwrap_or((DVec2::ZERO, DVec2::ONE));
    if let Some((least, most)) = figure.cut {
        (low.y, high.y) = (low.y.max(least), high.y.min(most));
    }
    for axis in 0..2 {
        let width = high[axis] - low[axis];
        // A constant is shown in the middle of a range of its own size.
        let around = if width > 0.0 { 0.0 } else { 0.5 * low[axis].abs().max(1.0) };
        low[axis] -= around;
        high[axis] += around;
    }
    let margin = 0.04 * (high - low) * if figure.same_scale { DVec2::ONE } else { DVec2::Y };
    (low - margin, high + margin)
}

impl View {
    fn new(figure: &Figure, (low, high): (DVec2, DVec2), origin: DVec2, room: DVec2) -> View {
        let size = high - low;
        if !figure.same_scale {
            return View { low, scale: room / size, origin, room };
        }
        // The frame keeps its size, and what is shown grows in one direction.
        let scale = (room / size).min_element();
        let low = low - 0.5 * (room / scale - size);
        View { low, scale: DVec2::splat(scale), origin, room }
    }

    fn at(&self, p: DVec2) -> DVec2 {
        let offset = (p - self.low) * self.scale;
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
        let at = DVec2::new(view.at(DVec2::new(*x, 0.0)).x, high.y);
        canvas.line(at, at + DVec2::new(0.0, tick), Pen::Frame);
        canvas.word(at + DVec2::new(0.0, character.y), Anchor::Middle, word, Pen::Frame);
    }
    for (y, word) in y_ticks {
        let at = DVec2::new(low.x, view.at(DVec2::new(0.0, *y)).y);
        canvas.line(at - DVec2::new(tick, 0.0), at, Pen::Frame);
        canvas.word(at - DVec2::new(character.x, 0.0), Anchor::End, word, Pen::Frame);
    }
}

/// The title at the top, the names of the axes at their ends.
fn words(canvas: &mut dyn Canvas, figure: &Figure, view: &View) {
    let character = canvas.character();
    let (low, high) = view.corners();
    let top = low.y - character.y;
    canvas.word(DVec2::new(low.x, top), Anchor::Start, &figure.y_label, Pen::Frame);
    let after = figure.y_label.chars().count() as f64 + 3.0;
    canvas.word(DVec2::new(low.x + after * character.x, top), Anchor::Start, &figure.title, Pen::Frame);
    canvas.word(DVec2::new(high.x, high.y + 2.0 * character.y), Anchor::End, &figure.x_label, Pen::Frame);
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
    fn lines_are_cut_at_the_frame() {
        let unit = (DVec2::ZERO, DVec2::ONE);
        let cut = clipped(DVec2::new(-1.0, 0.5), DVec2::new(3.0, 0.5), unit);
        assert_eq!(cut, Some((DVec2::new(0.0, 0.5), DVec2::new(1.0, 0.5))));
        assert_eq!(clipped(DVec2::new(-1.0, 2.0), DVec2::new(3.0, 2.0), unit), None);
        assert_eq!(clipped(DVec2::new(2.0, 0.0), DVec2::new(3.0, 1.0), unit), None);
        assert!(clipped(DVec2::splat(0.2), DVec2::splat(0.2), unit).is_some());
    }
}
