//! Cubics in single precision, as a renderer that keeps all of its numbers so would evaluate them: what is given is rounded first.

/// Monomial coefficients, nested.
pub fn horner(p: &[f64; 4], t: f64) -> f64 {
    let ([a, b, c, d], t) = (p.map(single), single(t));
    let (e, f, g) = (b - a, c - b, d - c);
    let (h, i) = (f - e, g - f);
    f64::from((((i - h) * t + 3.0 * h) * t + 3.0 * e) * t + a)
}

/// Σ Pᵢ Bᵢ(t).
pub fn bernstein(p: &[f64; 4], t: f64) -> f64 {
    let ([a, b, c, d], t) = (p.map(single), single(t));
    let r = 1.0 - t;
    let (rr, tt) = (r * r, t * t);
    f64::from((a * (rr * r) + b * (3.0 * (rr * t))) + (c * (3.0 * (tt * r)) + d * (tt * t)))
}

/// Repeated (1−t)a + tb.
pub fn de_casteljau(p: &[f64; 4], t: f64) -> f64 {
    let ([a, b, c, d], t) = (p.map(single), single(t));
    let r = 1.0 - t;
    let lerp = |a: f32, b: f32| a * r + b * t;
    let (e, f, g) = (lerp(a, b), lerp(b, c), lerp(c, d));
    f64::from(lerp(lerp(e, f), lerp(f, g)))
}

fn single(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::Method;

    #[test]
    fn single_precision_is_near_and_only_near() {
        let (p, t) = ([0.1, 1.0, -1.0, 2.0], 0.3);
        let exact = Method::DEFAULT.evaluate(&p, t);
        for value in [horner(&p, t), bernstein(&p, t), de_casteljau(&p, t)] {
            assert!(
                value != exact && (value - exact).abs() < 8.0 * f64::from(f32::EPSILON),
                "{value} {exact}"
            );
        }
    }
}
