//! A figure as pixels: lines by their distance from each pixel's centre, words in a font of eight by eight.

use super::svg::look;
use super::{Anchor, Canvas, Figure, Pen};
use font8x8::UnicodeFonts;
use glam::DVec2;
use image::{Rgb, RgbImage};

/// The figure as a picture of so many pixels.
pub fn image(figure: &Figure, width: u32, height: u32) -> RgbImage {
    let mut page = Page(RgbImage::from_pixel(width, height, Rgb([255; 3])));
    super::chart::draw(figure, &mut page);
    page.0
}

struct Page(RgbImage);

impl Page {
    /// Covers a share of each pixel whose centre is near the line from a to b; `half` is half of the line's width.
    fn stroke(&mut self, a: DVec2, b: DVec2, half: f64, ink: [u8; 3]) {
        let reach = half + 1.0;
        let (low, high) = (a.min(b) - reach, a.max(b) + reach);
        let pixels = |low: f64, high: f64, n: u32| {
            let last = high.ceil().clamp(0.0, f64::from(n)) as u32;
            low.floor().clamp(0.0, f64::from(n)) as u32..last
        };
        for y in pixels(low.y, high.y, self.0.height()) {
            for x in pixels(low.x, high.x, self.0.width()) {
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                self.cover(x, y, half + 0.5 - distance(centre, a, b), ink);
            }
        }
    }

    fn cover(&mut self, x: u32, y: u32, share: f64, ink: [u8; 3]) {
        let share = share.clamp(0.0, 1.0);
        let pixel = self.0.get_pixel_mut(x, y);
        for (channel, ink) in pixel.0.iter_mut().zip(ink) {
            let was = f64::from(*channel);
            *channel = (was + (f64::from(ink) - was) * share).round() as u8;
        }
    }

    fn letter(&mut self, letter: char, left: i64, top: i64, ink: [u8; 3]) {
        let sets = [
            font8x8::BASIC_FONTS.get(letter),
            font8x8::LATIN_FONTS.get(letter),
            font8x8::GREEK_FONTS.get(letter),
        ];
        let rows = sets.into_iter().flatten().next().unwrap_or([0, 0x3c, 0x24, 0x24, 0x24, 0x24, 0x3c, 0]);
        for (y, row) in (top..).zip(rows) {
            for (x, bit) in (left..).zip(0..8) {
                let inside = x >= 0 && y >= 0 && x < self.0.width().into() && y < self.0.height().into();
                if inside && row >> bit & 1 == 1 {
                    self.cover(x as u32, y as u32, 1.0, ink);
                }
            }
        }
    }
}

/// From a point to the line between a and b.
fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length = along.length_squared();
    let t = if length > 0.0 { ((p - a).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (a + along * t).distance(p)
}

impl Canvas for Page {
    fn size(&self) -> DVec2 {
        DVec2::new(f64::from(self.0.width()), f64::from(self.0.height()))
    }

    fn character(&self) -> DVec2 {
        DVec2::new(8.0, 15.0)
    }

    fn line(&mut self, a: DVec2, b: DVec2, pen: Pen) {
        let (_, ink, width) = look(pen);
        self.stroke(a, b, 0.5 * width, ink);
    }

    fn dot(&mut self, at: DVec2, pen: Pen) {
        let (_, ink, width) = look(pen);
        self.stroke(at, at, 1.5 + width, ink);
    }

    fn word(&mut self, at: DVec2, anchor: Anchor, word: &str, pen: Pen) {
        let width = 8.0 * word.chars().count() as f64;
        let left = match anchor {
            Anchor::Start => at.x,
            Anchor::Middle => at.x - 0.5 * width,
            Anchor::End => at.x - width,
        };
        let top = (at.y - 4.0).round() as i64;
        for (i, letter) in word.chars().enumerate() {
            self.letter(letter, left.round() as i64 + 8 * i as i64, top, look(pen).1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Stroke;
    use super::*;

    #[test]
    fn a_line_is_inked_along_its_way_and_nowhere_else() {
        let mut page = Page(RgbImage::from_pixel(16, 16, Rgb([255; 3])));
        page.line(DVec2::new(2.0, 8.0), DVec2::new(14.0, 8.0), Pen::Curve);
        assert_eq!(page.0.get_pixel(8, 8).0, look(Pen::Curve).1);
        assert_eq!(page.0.get_pixel(8, 7).0, look(Pen::Curve).1);
        assert_eq!(page.0.get_pixel(8, 11).0, [255; 3]);
        page.line(DVec2::splat(-100.0), DVec2::splat(-90.0), Pen::Curve);
    }

    #[test]
    fn words_that_stand_out_of_the_picture_are_cut() {
        let strokes = vec![Stroke { points: vec![DVec2::ZERO], pen: Pen::Accent, dotted: true }];
        let title = "wide µ°π∞".repeat(20);
        let image = image(&Figure { title, strokes, ..Figure::default() }, 64, 48);
        assert!(image.pixels().any(|p| p.0 == look(Pen::Frame).1));
    }
}
