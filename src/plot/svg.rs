//! A figure as an SVG file.

use super::{Anchor, Canvas, Figure, Pen};
use glam::DVec2;
use std::fmt::Write;

/// The figure as SVG of so many pixels.
pub fn text(figure: &Figure, width: f64, height: f64) -> String {
    let mut page = Page { size: DVec2::new(width, height), out: String::new(), path: None };
    super::chart::draw(figure, &mut page);
    page.end_path();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"{FONT}\" fill=\"none\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{}</svg>\n",
        page.out
    )
}

const FONT: f64 = 12.0;

/// Colour and width of a pen; red and blue are told apart by all (Tol, *Colour Schemes*, 2021).
pub(super) fn look(pen: Pen) -> (&'static str, [u8; 3], f64) {
    match pen {
        Pen::Curve => ("#4477aa", [0x44, 0x77, 0xaa], 2.0),
        Pen::Aid => ("#888888", [0x88, 0x88, 0x88], 1.0),
        Pen::Faint => ("#ccbb44", [0xcc, 0xbb, 0x44], 0.8),
        Pen::Accent => ("#cc3311", [0xcc, 0x33, 0x11], 1.4),
        Pen::Frame => ("#222222", [0x22, 0x22, 0x22], 1.0),
    }
}

struct Page {
    size: DVec2,
    out: String,
    /// A path that is being drawn: where it has come to, and with which pen.
    path: Option<(DVec2, Pen)>,
}

impl Page {
    fn end_path(&mut self) {
        if let Some((_, pen)) = self.path.take() {
            let (colour, _, width) = look(pen);
            let _ = writeln!(self.out, "\" stroke=\"{colour}\" stroke-width=\"{width}\"/>");
        }
    }
}

impl Canvas for Page {
    fn size(&self) -> DVec2 {
        self.size
    }

    fn character(&self) -> DVec2 {
        DVec2::new(0.6 * FONT, 1.25 * FONT)
    }

    fn line(&mut self, a: DVec2, b: DVec2, pen: Pen) {
        if self.path != Some((a, pen)) {
            self.end_path();
            let _ = write!(self.out, "<path d=\"M{:.2} {:.2}", a.x, a.y);
        }
        let _ = write!(self.out, "L{:.2} {:.2}", b.x, b.y);
        self.path = Some((b, pen));
    }

    fn dot(&mut self, at: DVec2, pen: Pen) {
        self.end_path();
        let (colour, _, width) = look(pen);
        let radius = 1.5 + width;
        let _ = writeln!(
            self.out,
            "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius}\" fill=\"{colour}\"/>",
            at.x, at.y
        );
    }

    fn word(&mut self, at: DVec2, anchor: Anchor, word: &str, pen: Pen) {
        if word.is_empty() {
            return;
        }
        self.end_path();
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let word = word.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let (x, y) = (at.x, at.y + 0.35 * FONT);
        let colour = look(pen).0;
        let _ = writeln!(
            self.out,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{word}</text>"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::super::Stroke;
    use super::*;

    #[test]
    fn a_stroke_is_one_path_and_words_are_escaped() {
        let points = (0..5).map(|i| DVec2::new(f64::from(i), f64::from(i * i))).collect();
        let strokes = vec![Stroke { points, pen: Pen::Curve, dotted: true }];
        let svg = text(&Figure { title: "a < b".into(), strokes, ..Figure::default() }, 320.0, 200.0);
        assert_eq!(svg.matches("stroke=\"#4477aa\"").count(), 1, "{svg}");
        assert_eq!(svg.matches("<circle").count(), 5);
        assert!(svg.contains("a &lt; b") && !svg.contains("NaN"));
    }

    #[test]
    fn a_hole_parts_the_path() {
        let points = [0.0, 1.0, f64::NAN, 3.0, 4.0].map(|x| DVec2::new(x, x)).to_vec();
        let strokes = vec![Stroke { points, pen: Pen::Curve, dotted: false }];
        let svg = text(&Figure { strokes, ..Figure::default() }, 320.0, 200.0);
        assert_eq!(svg.matches("stroke=\"#4477aa\"").count(), 2, "{svg}");
    }
}
