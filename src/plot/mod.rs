//! Figures: curves in a frame with numbered axes, as characters ([`braille`]), as SVG ([`svg`]) or as pixels ([`raster`]).
//!
//! A figure is plain data; `chart` lays it out once for all three, which only draw lines, dots and words (`Canvas`).
//! Knows nothing of what the curves are of.

pub mod braille;
mod chart;
pub mod raster;
pub mod svg;
mod ticks;

use glam::DVec2;

/// Curves in one plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// What it shows, in a line.
    pub title: String,
    /// What runs to the right.
    pub x_label: String,
    /// What runs upward.
    pub y_label: String,
    /// In the order they are drawn.
    pub strokes: Vec<Stroke>,
    /// A unit is as long on both axes.
    pub same_scale: bool,
    /// Heights outside are cut off; none shows all.
    pub cut: Option<(f64, f64)>,
}

/// A line through points; where a coordinate is not finite it is interrupted.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// In the figure's own units.
    pub points: Vec<DVec2>,
    /// How it looks.
    pub pen: Pen,
    /// Its points are marked.
    pub dotted: bool,
}

/// How something looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pen {
    /// What the figure is about.
    Curve,
    /// What belongs to it: a control polygon.
    Aid,
    /// What there is much of: a comb.
    Faint,
    /// What is to be seen first: a constructed point.
    Accent,
    /// The frame and its numbers.
    Frame,
}

impl Figure {
    /// The least and the most of all finite coordinates of points that are finite; none where there are none.
    pub fn bounds(&self) -> Option<(DVec2, DVec2)> {
        let points = self.strokes.iter().flat_map(|stroke| &stroke.points).filter(|p| p.is_finite());
        points.fold(None, |bounds, &p| {
            let (low, high) = bounds.unwrap_or((p, p));
            Some((low.min(p), high.max(p)))
        })
    }
}

/// Where a word stands on the point that it is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// It begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// What draws: x to the right, y down, in units of its own.
pub(crate) trait Canvas {
    /// Width and height.
    fn size(&self) -> DVec2;
    /// Width and height of a character.
    fn character(&self) -> DVec2;
    /// A line from a to b.
    fn line(&mut self, a: DVec2, b: DVec2, pen: Pen);
    /// A dot.
    fn dot(&mut self, at: DVec2, pen: Pen);
    /// A word in the middle of the height `at.y`.
    fn word(&mut self, at: DVec2, anchor: Anchor, word: &str, pen: Pen);
}
