//! Looking up a picture by (u, v). (0, 0) is the bottom left corner, texel centres lie at half-integers.

use crate::scene::assets::image::{Image, Reading};
use crate::scene::{Filter, ImagePattern, Wrap};
use glam::DVec2;

/// RGB and alpha at (u, v).
pub(super) fn sample(image: &Image, pattern: &ImagePattern, uv: DVec2, reading: Reading) -> [f64; 4] {
    let x = inside(uv.x, pattern.wrap) * f64::from(image.width());
    let y = inside(uv.y, pattern.wrap) * f64::from(image.height());
    let texel = |i: f64, j: f64| {
        let column = index(i, image.width(), pattern.wrap);
        let row = index(j, image.height(), pattern.wrap);
        image.texel(column, image.height() - 1 - row, reading)
    };
    match pattern.filter {
        Filter::Nearest => texel(x.floor(), y.floor()),
        Filter::Bilinear => {
            let (x, y) = (x - 0.5, y - 0.5);
            let (i, j) = (x.floor(), y.floor());
            let (fx, fy) = (x - i, y - j);
            let bottom = lerp(texel(i, j), texel(i + 1.0, j), fx);
            let top = lerp(texel(i, j + 1.0), texel(i + 1.0, j + 1.0), fx);
            lerp(bottom, top, fy)
        }
    }
}

/// A coordinate brought into 0 … 1.
fn inside(u: f64, wrap: Wrap) -> f64 {
    match wrap {
        Wrap::Repeat => u - u.floor(),
        Wrap::Clamp => u.clamp(0.0, 1.0),
        Wrap::Mirror => 1.0 - (u.rem_euclid(2.0) - 1.0).abs(),
    }
}

/// The texel at −1 … n: neighbours of the edge are those beyond it.
fn index(i: f64, n: u32, wrap: Wrap) -> u32 {
    let (i, last) = (i as i64, i64::from(n) - 1);
    (match wrap {
        Wrap::Repeat => i.rem_euclid(last + 1),
        Wrap::Clamp | Wrap::Mirror => i.clamp(0, last),
    }) as u32
}

fn lerp(a: [f64; 4], b: [f64; 4], t: f64) -> [f64; 4] {
    std::array::from_fn(|c| a[c] * (1.0 - t) + b[c] * t)
}
