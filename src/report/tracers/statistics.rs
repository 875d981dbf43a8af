//! What chance allows: Student's t, many tests at once, and slopes through points.

use crate::math::elementary::{ln, powf};

/// What Student's t of so many degrees of freedom passes on either side with this probability in all. From the normal quantile by the
/// expansion of Abramowitz & Stegun, *Handbook of Mathematical Functions*, 26.7.5; within 1 % from 4 degrees on.
pub fn student(level: f64, freedom: u32) -> f64 {
    if freedom == 0 {
        return f64::INFINITY;
    }
    let (z, n) = (normal(level / 2.0), f64::from(freedom));
    let z2 = z * z;
    let terms = [
        z * (z2 + 1.0) / 4.0,
        z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0,
        z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0,
    ];
    z + terms[0] / n + terms[1] / (n * n) + terms[2] / (n * n * n)
}

/// What a normal number passes above with this probability, below a half. Handbook, 26.2.23; within 4.5e-4.
fn normal(above: f64) -> f64 {
    let t = (-2.0 * ln(above)).sqrt();
    let over = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let under = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    t - over / under
}

/// The level of each of so many tests, so that any of them fails by chance with the level of all.
pub fn sidak(level: f64, tests: usize) -> f64 {
    1.0 - powf(1.0 - level, 1.0 / tests.max(1) as f64)
}

/// The slope of the least-squares line through points, and half of its 95 % interval (infinite through two). None of fewer than two.
pub fn slope(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x0, y0) = (mean(&|p| p.0), mean(&|p| p.1));
    let sum = |f: &dyn Fn(f64, f64) -> f64| points.iter().map(|(x, y)| f(x - x0, y - y0)).sum::<f64>();
    let spread = sum(&|x, _| x * x);
    if points.len() < 2 || spread == 0.0 {
        return None;
    }
    let slope = sum(&|x, y| x * y) / spread;
    let freedom = points.len() as u32 - 2;
    let left = sum(&|x, y| (y - slope * x) * (y - slope * x));
    let by = if freedom == 0 { f64::INFINITY } else { (left / f64::from(freedom) / spread).sqrt() };
    Some((slope, by * student(0.05, freedom)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn student_is_that_of_the_tables() {
        for (level, freedom, t) in [
            (0.05, 15, 2.1314),
            (0.05, 4, 2.7764),
            (0.01, 15, 2.9467),
            (0.001, 15, 4.0728),
            (0.05, 1000, 1.9623),
        ] {
            assert!(
                (student(level, freedom) / t - 1.0).abs() < 0.01,
                "{level} {freedom}: {}",
                student(level, freedom)
            );
        }
        assert!((sidak(0.05, 10) - 0.005_116).abs() < 1e-6);
    }

    #[test]
    fn a_slope_is_that_of_its_line_and_its_interval_that_of_the_scatter() {
        let exact: Vec<(f64, f64)> = (0..5).map(|i| (f64::from(i), 3.0 - 0.5 * f64::from(i))).collect();
        let (s, by) = slope(&exact).unwrap();
        assert!((s + 0.5).abs() < 1e-14 && by < 1e-12);
        // x 0 … 4, y 0 1 0 1 0: slope 0, residual 1.2, by sqrt(1.2 / 3 / 10) t₃.
        let zigzag: Vec<(f64, f64)> = (0..5).map(|i| (f64::from(i), f64::from(i % 2))).collect();
        let (s, by) = slope(&zigzag).unwrap();
        assert!(s.abs() < 1e-15 && (by / (0.2 * 3.1824) - 1.0).abs() < 0.02, "{s} {by}");
        assert_eq!(slope(&exact[..1]), None);
    }
}
