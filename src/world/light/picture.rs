//! The sky of an equirectangular picture, as a light: its radiance in a direction, and directions chosen as often as they are
//! bright. Knows nothing of receivers; a direction below one is its own affair.
//!
//! The picture's middle lies toward −z of the light's own space, its upper edge toward +y, its right half toward +x: what a
//! panorama camera that looks along −z sees. Radiance is interpolated between the centres of texels. Directions are chosen by
//! cells of texels, each as often as the mean of what is interpolated in it says, so that none that shines is left out
//! (Pharr, Jakob & Humphreys, *Physically Based Rendering*, §12.5, with the interpolation taken into the cells).

use crate::math::Affine;
use crate::math::colour::mean;
use crate::math::elementary::{atan2, cos, hypot, sin_cos};
use crate::scene::Rgb;
use crate::scene::assets::image::{Image, Reading};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A sky from a picture.
#[derive(Debug)]
pub struct PictureSky {
    image: Arc<Image>,
    factor: Rgb,
    /// From the picture's axes (right, up, back) to the world's; orthonormal, perhaps mirrored.
    world_from_local: DMat3,
    cells: Cells,
}

/// The sphere cut into rows and columns, each cell with a weight: about its power.
#[derive(Debug)]
struct Cells {
    /// Texels along each side of a cell.
    side: u32,
    /// Where columns begin and end, in turns from the left edge.
    turns: Vec<f64>,
    /// Cosines of the angles from up at which rows begin and end.
    cosines: Vec<f64>,
    /// Sums of the weights of the rows up to each.
    row_sums: Vec<f64>,
    /// For each row, sums of the weights of its cells up to each.
    sums: Vec<f64>,
}

/// Cells at most; a larger picture has several texels in each.
const MOST_CELLS: usize = 1 << 21;

impl PictureSky {
    /// A picture turned as a transform turns it; lengths and shears of the transform do not count. None where it is black.
    pub fn new(image: Arc<Image>, factor: Rgb, place: &Affine) -> Option<PictureSky> {
        let cells = Cells::new(&image, factor);
        let shines = cells.total() > 0.0 && cells.total().is_finite();
        shines.then(|| PictureSky { image, factor, world_from_local: turn(place), cells })
    }

    /// Radiance from a unit direction.
    pub fn radiance(&self, direction: DVec3) -> Rgb {
        let at = self.place(direction);
        let (x, y) =
            (at.x * f64::from(self.image.width()) - 0.5, at.y * f64::from(self.image.height()) - 0.5);
        let (i, j) = (x.floor(), y.floor());
        let row = |j: f64| {
            let (left, right) = (self.texel(i, j), self.texel(i + 1.0, j));
            left + (right - left) * (x - i)
        };
        let (upper, lower) = (row(j), row(j + 1.0));
        (upper + (lower - upper) * (y - j)) * self.factor
    }

    /// A unit direction by u in (0, 1)², and its density per solid angle.
    pub fn choose(&self, u: DVec2) -> (DVec3, f64) {
        let Cells { turns, cosines, row_sums, .. } = &self.cells;
        let (row, down) = pick(row_sums, u.x);
        let (column, along) = pick(self.cells.row(row), u.y);
        let y = cosines[row] + (cosines[row + 1] - cosines[row]) * down;
        let turn = turns[column] + (turns[column + 1] - turns[column]) * along;
        let ((s, c), r) = (sin_cos(TAU * (turn - 0.5)), (1.0 - y * y).max(0.0).sqrt());
        (self.world_from_local * DVec3::new(r * s, y, -r * c), self.cells.density(row, column))
    }

    /// Density per solid angle with which [`PictureSky::choose`] comes to a unit direction.
    pub fn density(&self, direction: DVec3) -> f64 {
        let at = self.place(direction);
        let row = cell_of(at.y, self.image.height(), self.cells.side);
        let column = cell_of(at.x, self.image.width(), self.cells.side);
        self.cells.density(row, column)
    }

    /// Radiance averaged over all directions and the colours.
    pub fn mean(&self) -> f64 {
        self.cells.total() / (4.0 * PI)
    }

    /// Where a direction lies on the picture: 0 … 1 from the left and from the top.
    fn place(&self, direction: DVec3) -> DVec2 {
        let local = self.world_from_local.transpose() * direction;
        let turn = atan2(local.x, -local.z) / TAU + 0.5;
        DVec2::new(turn, atan2(hypot(local.x, local.z), local.y) / PI)
    }

    /// The texel of column i, going round, and row j, staying inside.
    fn texel(&self, i: f64, j: f64) -> Rgb {
        let column = (i as i64).rem_euclid(i64::from(self.image.width())) as u32;
        let row = (j as i64).clamp(0, i64::from(self.image.height()) - 1) as u32;
        light_of(&self.image, column, row)
    }
}

/// The light of a texel; nothing shines negatively.
fn light_of(image: &Image, column: u32, row: u32) -> Rgb {
    let [r, g, b, _] = image.texel(column, row, Reading::Colour);
    Rgb::new(r, g, b).max(Rgb::ZERO)
}

/// The axes of a transform made orthonormal: up first, then what looks back.
fn turn(place: &Affine) -> DMat3 {
    let up = place.vector(DVec3::Y).normalize_or(DVec3::Y);
    let back = place.vector(DVec3::Z);
    let back = (back - up * up.dot(back)).normalize_or(super::frame(up).0);
    let right = up.cross(back);
    let side = if place.vector(DVec3::X).dot(right) < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(right * side, up, back)
}

/// How many texels a cell has along each side.
fn texels_per_cell(width: u32, height: u32) -> u32 {
    let cells = |k: u32| width.div_ceil(k) as usize * height.div_ceil(k) as usize;
    (1..).find(|k| cells(*k) <= MOST_CELLS).expect("one cell is few enough")
}

/// The cell of so many texels that a place of 0 … 1 along a side of n texels falls into.
fn cell_of(place: f64, n: u32, texels: u32) -> usize {
    let texel = ((place * f64::from(n)) as u32).min(n - 1);
    (texel / texels) as usize
}

impl Cells {
    fn new(image: &Image, factor: Rgb) -> Cells {
        let (width, height) = (image.width(), image.height());
        let k = texels_per_cell(width, height);
        let borders = |n: u32| (0..=n.div_ceil(k)).map(move |i| f64::from((i * k).min(n)) / f64::from(n));
        let (turns, cosines): (Vec<f64>, Vec<f64>) =
            (borders(width).collect(), borders(height).map(|v| cos(PI * v)).collect());
        let (columns, rows) = (turns.len() - 1, cosines.len() - 1);
        let mut weights = vec![0.0; columns * rows];
        let mut near = [0u32, 0, 1].map(|row| brightness(image, factor, row.min(height - 1)));
        for row in 0..height {
            let solid_angle = TAU / f64::from(width) * band(row, height);
            let cells = &mut weights[(row / k) as usize * columns..][..columns];
            for (column, mean) in smoothed(&near).enumerate() {
                cells[column / k as usize] += mean * solid_angle;
            }
            near.rotate_left(1);
            near[2] = brightness(image, factor, (row + 2).min(height - 1));
        }
        let mut row_sums = Vec::with_capacity(rows);
        let mut total = 0.0;
        for row in weights.chunks_exact_mut(columns) {
            total += running(row);
            row_sums.push(total);
        }
        Cells { side: k, turns, cosines, row_sums, sums: weights }
    }

    fn rows(&self) -> usize {
        self.row_sums.len()
    }

    fn columns(&self) -> usize {
        self.turns.len() - 1
    }

    /// The sums of a row.
    fn row(&self, row: usize) -> &[f64] {
        &self.sums[row * self.columns()..][..self.columns()]
    }

    fn total(&self) -> f64 {
        self.row_sums[self.rows() - 1]
    }

    fn density(&self, row: usize, column: usize) -> f64 {
        let sums = self.row(row);
        let weight = sums[column] - if column == 0 { 0.0 } else { sums[column - 1] };
        let turn = self.turns[column + 1] - self.turns[column];
        let solid_angle = TAU * turn * (self.cosines[row] - self.cosines[row + 1]);
        weight / (self.total() * solid_angle)
    }
}

/// The difference of the cosines at the upper and lower edge of a row.
fn band(row: u32, height: u32) -> f64 {
    let at = |row: u32| cos(PI * f64::from(row) / f64::from(height));
    at(row) - at(row + 1)
}

/// How bright each texel of a row is.
fn brightness(image: &Image, factor: Rgb, row: u32) -> Vec<f64> {
    let of = |column| mean(light_of(image, column, row) * factor);
    (0..image.width()).map(of).collect()
}

/// The mean over each texel's square of what is interpolated between centres, from its row and its neighbours: 1/8, 3/4, 1/8
/// along each side.
fn smoothed(near: &[Vec<f64>; 3]) -> impl Iterator<Item = f64> {
    let n = near[1].len();
    let mean = |a: f64, b: f64, c: f64| (a + c) / 8.0 + b * 0.75;
    let down = move |i: usize| mean(near[0][i], near[1][i], near[2][i]);
    (0..n).map(move |i| mean(down((i + n - 1) % n), down(i), down((i + 1) % n)))
}

/// Turns weights into their sums up to each. The total.
fn running(weights: &mut [f64]) -> f64 {
    let mut sum = 0.0;
    for weight in weights {
        sum += *weight;
        *weight = sum;
    }
    sum
}

/// The interval of some sums that u in (0, 1) falls into, and where in it.
fn pick(sums: &[f64], u: f64) -> (usize, f64) {
    let last = sums.len() - 1;
    let at = u * sums[last];
    let i = sums.partition_point(|sum| *sum <= at).min(last);
    let before = if i == 0 { 0.0 } else { sums[i - 1] };
    let weight = sums[i] - before;
    (i, if weight > 0.0 { ((at - before) / weight).clamp(0.0, 1.0) } else { 0.5 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::even::{grid, over_all_directions};

    fn sky(width: u32, height: u32, colour: impl Fn(f64, f64) -> [f64; 3]) -> PictureSky {
        let image = Arc::new(Image::from_texels(width, height, colour));
        PictureSky::new(image, Rgb::ONE, &Affine::IDENTITY).unwrap()
    }

    /// A small sun in a dim sky with a black part.
    fn sunny() -> PictureSky {
        sky(64, 32, |x, y| match () {
            () if (x - 0.7).abs() < 0.02 && (y - 0.3).abs() < 0.04 => [300.0, 250.0, 200.0],
            () if x < 0.25 => [0.0; 3],
            () => [0.2, 0.3 * y, 0.5 * x],
        })
    }

    #[test]
    fn the_middle_lies_ahead_the_upper_edge_above_and_the_right_half_to_the_right() {
        let sky = sky(8, 4, |x, y| [x, y, 0.0]);
        let seen = |d: DVec3| sky.radiance(d);
        assert!((seen(-DVec3::Z).x - 0.5).abs() < 1e-7 && (seen(-DVec3::Z).y - 0.5).abs() < 1e-7);
        assert!((seen(DVec3::X).x - 0.75).abs() < 1e-7 && (seen(-DVec3::X).x - 0.25).abs() < 1e-7);
        assert!((seen(DVec3::Y).y - 0.125).abs() < 1e-7 && (seen(-DVec3::Y).y - 0.875).abs() < 1e-7);
    }

    #[test]
    fn a_transform_turns_and_mirrors_but_does_not_stretch() {
        let image = Arc::new(Image::from_texels(8, 4, |x, _| [x, 0.0, 0.0]));
        let placed = |place: &Affine| PictureSky::new(Arc::clone(&image), Rgb::ONE, place).unwrap();
        let mirrored = placed(&Affine::scale(DVec3::new(-3.0, 1.0, 1.0)));
        assert!((mirrored.radiance(DVec3::X).x - 0.25).abs() < 1e-7);
        let quarter = placed(&Affine::rotate(DVec3::Y, -90.0));
        assert!((quarter.radiance(DVec3::X).x - 0.5).abs() < 1e-7, "ahead is now to the right");
    }

    #[test]
    fn the_chance_of_a_direction_is_the_density_said() {
        let sky = sunny();
        let whole = over_all_directions(2000, |d| sky.density(d));
        assert!((whole - 1.0).abs() < 1e-2, "{whole}");
        let probe = |d: DVec3| 1.0 + d.x + d.y * d.z + d.z * d.z;
        let by_density = over_all_directions(2000, |d| sky.density(d) * probe(d));
        let by_choice = grid(400).map(|u| probe(sky.choose(u).0)).sum::<f64>() / 160_000.0;
        assert!((by_density - by_choice).abs() < 1e-2, "{by_density} and {by_choice}");
        for u in grid(50) {
            let (direction, density) = sky.choose(u);
            assert!((direction.length() - 1.0).abs() < 1e-12);
            assert!((sky.density(direction) - density).abs() <= 1e-9 * density, "{u}");
        }
    }

    #[test]
    fn what_is_chosen_brings_the_light_of_the_whole_sky_and_hardly_varies() {
        let sky = sunny();
        let whole = over_all_directions(4000, |d| sky.radiance(d).x);
        let carried: Vec<f64> =
            grid(1000).map(|u| sky.choose(u)).map(|(d, p)| sky.radiance(d).x / p).collect();
        let mean = carried.iter().sum::<f64>() / carried.len() as f64;
        assert!((mean / whole - 1.0).abs() < 2e-3, "{mean} of {whole}");
        // In the corner of a texel beside the sun shines a quarter of it, where the mean of the texel is 1/64 of it.
        assert!(
            carried.iter().all(|c| *c < 18.0 * whole),
            "no direction stands for much more than its share"
        );
    }

    #[test]
    fn wherever_it_shines_chance_may_look() {
        // Between a lit texel and its black neighbour light is interpolated.
        let sky = sky(16, 8, |x, y| if x > 0.5 && y > 0.5 && x < 0.6 { [1.0; 3] } else { [0.0; 3] });
        for d in grid(100).map(|u| {
            let ((s, c), y) = (sin_cos(TAU * u.x), 2.0 * u.y - 1.0);
            DVec3::new((1.0 - y * y).sqrt() * s, y, (1.0 - y * y).sqrt() * c)
        }) {
            assert!(sky.radiance(d).x == 0.0 || sky.density(d) > 0.0, "{d}");
        }
    }

    #[test]
    fn several_texels_share_a_cell_in_large_pictures() {
        assert_eq!(texels_per_cell(2048, 1024), 1);
        assert_eq!(texels_per_cell(4096, 2048), 2);
        assert_eq!((cell_of(0.0, 5, 2), cell_of(0.5, 5, 2), cell_of(1.0, 5, 2)), (0, 1, 2));
        // Nine texels are two cells of four and one of one, not three of three.
        let cells = (0..9).map(|texel| cell_of((f64::from(texel) + 0.5) / 9.0, 9, 4));
        assert_eq!(cells.collect::<Vec<_>>(), [0, 0, 0, 0, 1, 1, 1, 1, 2]);
    }

    #[test]
    fn a_black_picture_is_no_light() {
        let image = Arc::new(Image::from_texels(4, 2, |_, _| [0.0; 3]));
        assert!(PictureSky::new(image, Rgb::ONE, &Affine::IDENTITY).is_none());
    }
}
