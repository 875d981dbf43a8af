//! Sums over the seeds of one variant, value by value: a value is a channel of a pixel.

use super::{Made, TracerRow};
use crate::render::compare::RELATIVE_FLOOR;
use crate::report::measure::{median, quantile};
use crate::report::tracers::statistics::student;
use crate::scene::Rgb;

/// Pictures so far.
#[derive(Clone)]
pub struct Tally<'a> {
    reference: &'a [Rgb],
    /// Of what each picture is off by, so that large values cancel before they are squared.
    sum: Vec<Rgb>,
    squares: Vec<Rgb>,
    relative: f64,
    errors: Vec<f64>,
    /// Mean of each picture's differences.
    means: Vec<f64>,
    seconds: Vec<f64>,
    rays: u64,
}

impl<'a> Tally<'a> {
    pub fn new(reference: &'a [Rgb]) -> Tally<'a> {
        let none = vec![Rgb::ZERO; reference.len()];
        Tally {
            reference,
            sum: none.clone(),
            squares: none,
            relative: 0.0,
            errors: Vec::new(),
            means: Vec::new(),
            seconds: Vec::new(),
            rays: 0,
        }
    }

    /// Takes a picture of one seed.
    pub fn add(&mut self, made: &Made) {
        let mut total = Rgb::ZERO;
        for (i, (pixel, truth)) in made.pixels.iter().zip(self.reference).enumerate() {
            let off = *pixel - *truth;
            self.sum[i] += off;
            self.squares[i] += off * off;
            self.relative += (off * off / (*truth * *truth + Rgb::splat(RELATIVE_FLOOR))).element_sum();
            self.errors.extend(off.abs().to_array());
            total += off;
        }
        self.means.push(total.element_sum() / self.values());
        self.seconds.push(made.seconds);
        self.rays += made.rays;
    }

    fn values(&self) -> f64 {
        3.0 * self.reference.len().max(1) as f64
    }

    /// All figures, where the reference itself is off by `floor`.
    pub fn figures(&self, floor: f64) -> TracerRow {
        let (n, values) = (self.means.len() as f64, self.values());
        let total = |of: &dyn Fn(usize) -> Rgb| {
            (0..self.sum.len()).map(|i| of(i).element_sum()).sum::<f64>() / values
        };
        let mean_square = total(&|i| self.squares[i]) / n;
        let square_of_mean = total(&|i| self.sum[i] * self.sum[i]) / (n * n);
        let variance = (mean_square - square_of_mean) * n / (n - 1.0);
        let (mean_off, deviation) = mean_and_deviation(&self.means);
        let bright = self.reference.iter().map(|rgb| rgb.element_sum()).sum::<f64>() / values;
        let part = |off: f64| if bright > 0.0 { off / bright } else { 0.0 };
        TracerRow {
            seeds: self.means.len() as u32,
            seconds: median(&self.seconds),
            rays: self.rays as f64 / n,
            rmse: mean_square.sqrt(),
            relative_mse: self.relative / values / n,
            p999: quantile(&self.errors, 0.999),
            variance,
            bias2: square_of_mean - variance / n - floor * floor,
            mean_off: part(mean_off),
            mean_off_by: part(
                student(0.05, self.means.len() as u32 - 1)
                    * (deviation * deviation / n + floor * floor / values).sqrt(),
            ),
            ..TracerRow::default()
        }
    }
}

fn mean_and_deviation(numbers: &[f64]) -> (f64, f64) {
    let n = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / n;
    let squares = numbers.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    (mean, (squares / (n - 1.0)).sqrt())
}
