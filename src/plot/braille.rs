//! A figure in characters of a terminal: two by four dots each (Unicode's Braille patterns), words between them.

use super::{Anchor, Canvas, Figure, Pen};
use glam::DVec2;

/// Dots of a character, across and down.
const DOTS: [usize; 2] = [2, 4];

/// The bit of a dot in its character, by column and row.
const BITS: [[u8; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// The figure as lines of text, `columns` by `rows` characters; at least 20 by 6.
pub fn text(figure: &Figure, columns: usize, rows: usize) -> String {
    let (columns, rows) = (columns.max(20), rows.max(6));
    let mut page = Page { columns, rows, dots: vec![0; columns * rows], words: vec![None; columns * rows] };
    super::chart::draw(figure, &mut page);
    page.text()
}

struct Page {
    columns: usize,
    rows: usize,
    dots: Vec<u8>,
    words: Vec<Option<char>>,
}

impl Page {
    fn text(&self) -> String {
        let cell = |i: usize| match (self.words[i], self.dots[i]) {
            (Some(letter), _) => letter,
            (None, 0) => ' ',
            (None, dots) => char::from_u32(0x2800 + u32::from(dots)).expect("256 patterns stand there"),
        };
        let row = |row: usize| -> String {
            let line: String = (row * self.columns..(row + 1) * self.columns).map(cell).collect();
            line.trim_end().to_owned() + "\n"
        };
        (0..self.rows).map(row).collect()
    }

    fn set(&mut self, x: i64, y: i64) {
        let (width, height) = ((self.columns * DOTS[0]) as i64, (self.rows * DOTS[1]) as i64);
        if (0..width).contains(&x) && (0..height).contains(&y) {
            let (x, y) = (x as usize, y as usize);
            let cell = y / DOTS[1] * self.columns + x / DOTS[0];
            self.dots[cell] |= BITS[x % DOTS[0]][y % DOTS[1]];
        }
    }
}

impl Canvas for Page {
    fn size(&self) -> DVec2 {
        DVec2::new((self.columns * DOTS[0]) as f64, (self.rows * DOTS[1]) as f64)
    }

    fn character(&self) -> DVec2 {
        DVec2::new(DOTS[0] as f64, DOTS[1] as f64)
    }

    fn line(&mut self, a: DVec2, b: DVec2, pen: Pen) {
        let steps = (b - a).abs().max_element().ceil().max(1.0);
        // What there is much of is thinned, so that the curve stands out.
        let every = if matches!(pen, Pen::Aid | Pen::Faint) { 3 } else { 1 };
        for i in (0..=steps as usize).step_by(every) {
            let p = a + (b - a) * (i as f64 / steps);
            self.set(p.x.floor() as i64, p.y.floor() as i64);
        }
    }

    fn dot(&mut self, at: DVec2, _: Pen) {
        let (x, y) = (at.x.floor() as i64, at.y.floor() as i64);
        for (dx, dy) in [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)] {
            self.set(x + dx, y + dy);
        }
    }

    fn word(&mut self, at: DVec2, anchor: Anchor, word: &str, _: Pen) {
        let letters: Vec<char> = word.chars().collect();
        let column = (at.x / DOTS[0] as f64).floor() as i64;
        let first = match anchor {
            Anchor::Start => column,
            Anchor::Middle => column - letters.len() as i64 / 2,
            Anchor::End => column - letters.len() as i64 + 1,
        };
        let first = first.min(self.columns as i64 - letters.len() as i64).max(0) as usize;
        let row = ((at.y / DOTS[1] as f64).floor().max(0.0) as usize).min(self.rows - 1);
        for (letter, column) in letters.into_iter().zip(first..self.columns) {
            self.words[row * self.columns + column] = Some(letter);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Stroke;
    use super::*;

    #[test]
    fn a_rising_line_rises_between_numbered_axes() {
        let points = vec![DVec2::ZERO, DVec2::ONE];
        let strokes = vec![Stroke { points, pen: Pen::Curve, dotted: false }];
        let figure = Figure { title: "t => t".into(), x_label: "t".into(), strokes, ..Figure::default() };
        let text = text(&figure, 40, 12);
        assert_eq!(text.lines().count(), 12);
        assert!(text.lines().all(|line| line.chars().count() <= 40), "{text}");
        assert!(text.contains("t => t") && text.contains("0.0") && text.contains("1.0"), "{text}");
        let inked = |line: &str| line.chars().filter(|c| ('\u{2801}'..='\u{28ff}').contains(c)).count();
        assert!(text.lines().skip(1).take(8).all(|line| inked(line) >= 2), "{text}");
    }

    #[test]
    fn a_figure_of_nothing_is_a_frame() {
        let nan = Stroke { points: vec![DVec2::NAN; 3], pen: Pen::Curve, dotted: true };
        for strokes in [vec![], vec![nan]] {
            assert_eq!(text(&Figure { strokes, ..Figure::default() }, 0, 0).lines().count(), 6);
        }
    }
}
