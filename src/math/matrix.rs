//! Small dense matrices of any shape, column by column, and their singular values. For systems of a few dozen unknowns; knows nothing
//! of what they are.

use super::error::UNIT_ROUNDOFF;
use std::ops::{Index, IndexMut};

/// rows × columns numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    data: Vec<f64>,
}

impl Matrix {
    /// The entry at each row and column.
    pub fn from_fn(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Matrix {
        let data =
            (0..columns).flat_map(|j| (0..rows).map(move |i| (i, j))).map(|(i, j)| entry(i, j)).collect();
        Matrix { rows, columns, data }
    }

    /// All 0.
    pub fn zeros(rows: usize, columns: usize) -> Matrix {
        Matrix { rows, columns, data: vec![0.0; rows * columns] }
    }

    /// How many rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// How many columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Column j.
    pub fn column(&self, j: usize) -> &[f64] {
        &self.data[j * self.rows..(j + 1) * self.rows]
    }

    /// Rows and columns swapped.
    #[must_use]
    pub fn transpose(&self) -> Matrix {
        Matrix::from_fn(self.columns, self.rows, |i, j| self[(j, i)])
    }

    /// A·x; x has an entry for each column.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let row = |i: usize| x.iter().enumerate().map(|(j, x)| self[(i, j)] * x).sum();
        (0..self.rows).map(row).collect()
    }

    /// Aᵀ·y; y has an entry for each row.
    pub fn transpose_times(&self, y: &[f64]) -> Vec<f64> {
        (0..self.columns).map(|j| dot(self.column(j), y)).collect()
    }

    fn rotate_columns(&mut self, p: usize, q: usize, (sine, cosine): (f64, f64)) {
        for i in 0..self.rows {
            let (a, b) = (self[(i, p)], self[(i, q)]);
            self[(i, p)] = cosine * a - sine * b;
            self[(i, q)] = sine * a + cosine * b;
        }
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.data[j * self.rows + i]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.data[j * self.rows + i]
    }
}

/// Σ aᵢbᵢ.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A = U·diag(values)·Vᵀ with k = min(rows, columns) values.
#[derive(Clone, Debug)]
pub struct Singular {
    /// rows × k, orthonormal columns; a column of zeros beside a value of 0.
    pub u: Matrix,
    /// Descending, at least 0.
    pub values: Vec<f64>,
    /// columns × k, orthonormal columns; zeros beside a value of 0 where A has more columns than rows.
    pub v: Matrix,
}

/// Rounds of rotations of all pairs of columns. Convergence is quadratic in the end; a dozen is seen at most.
const SWEEPS: usize = 60;

/// Singular values and vectors by one-sided Jacobi rotations (Hestenes 1958): even small values come out to a few ulp of themselves
/// where scaling of columns explains them (Demmel & Veselić 1992). Entries must be finite.
pub fn singular(a: &Matrix) -> Singular {
    if a.columns > a.rows {
        let Singular { u, values, v } = singular(&a.transpose());
        return Singular { u: v, values, v: u };
    }
    let n = a.columns;
    let mut turned = a.clone();
    let mut v = Matrix::from_fn(n, n, |i, j| f64::from(u8::from(i == j)));
    let lost = a.rows as f64 * UNIT_ROUNDOFF * dot(&a.data, &a.data).sqrt();
    for _ in 0..SWEEPS {
        let pairs = (0..n).flat_map(|q| (0..q).map(move |p| (p, q)));
        let turns = pairs.filter(|&(p, q)| orthogonalise(&mut turned, &mut v, (p, q), lost)).count();
        if turns == 0 {
            break;
        }
    }
    sorted(&turned, &v)
}

/// Turns columns p and q of A until they are perpendicular, V along; false where they are, or where one is as short as `lost` and so has
/// no direction but that of rounding.
fn orthogonalise(a: &mut Matrix, v: &mut Matrix, (p, q): (usize, usize), lost: f64) -> bool {
    let (x, y) = (a.column(p), a.column(q));
    let (xx, yy, xy) = (dot(x, x), dot(y, y), dot(x, y));
    let perpendicular = xy.abs() <= a.rows as f64 * UNIT_ROUNDOFF * xx.sqrt() * yy.sqrt();
    if perpendicular || xx.sqrt() <= lost || yy.sqrt() <= lost {
        return false;
    }
    let half = 0.5 * (yy - xx) / xy;
    let tangent = half.signum() / (half.abs() + (half * half + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    a.rotate_columns(p, q, (tangent * cosine, cosine));
    v.rotate_columns(p, q, (tangent * cosine, cosine));
    true
}

fn sorted(turned: &Matrix, v: &Matrix) -> Singular {
    let lengths: Vec<f64> =
        (0..turned.columns).map(|j| dot(turned.column(j), turned.column(j)).sqrt()).collect();
    let mut order: Vec<usize> = (0..turned.columns).collect();
    order.sort_by(|&i, &j| lengths[j].total_cmp(&lengths[i]));
    let unit = |i: usize, j: usize| match lengths[order[j]] {
        0.0 => 0.0,
        length => turned[(i, order[j])] / length,
    };
    Singular {
        u: Matrix::from_fn(turned.rows, turned.columns, unit),
        values: order.iter().map(|&j| lengths[j]).collect(),
        v: Matrix::from_fn(v.rows, v.columns, |i, j| v[(i, order[j])]),
    }
}

/// The solution of A·x = b for a symmetric positive definite A, by Cholesky's factors; only the lower triangle is read. None where A is
/// not positive definite to working precision.
pub fn solve_positive(a: &Matrix, b: &[f64]) -> Option<Vec<f64>> {
    let factor = cholesky(a)?;
    let n = b.len();
    let mut x = b.to_vec();
    for i in 0..n {
        x[i] /= factor[(i, i)];
        for k in i + 1..n {
            x[k] -= factor[(k, i)] * x[i];
        }
    }
    for i in (0..n).rev() {
        let below: f64 = (i + 1..n).map(|k| factor[(k, i)] * x[k]).sum();
        x[i] = (x[i] - below) / factor[(i, i)];
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}

/// Lower triangular L with L·Lᵀ = A.
fn cholesky(a: &Matrix) -> Option<Matrix> {
    let mut factor = a.clone();
    for j in 0..a.columns {
        for k in 0..j {
            let scale = factor[(j, k)];
            for i in j..a.rows {
                let product = factor[(i, k)] * scale;
                factor[(i, j)] -= product;
            }
        }
        let pivot = factor[(j, j)];
        if !(pivot > 0.0) {
            return None;
        }
        let root = pivot.sqrt();
        for i in j..a.rows {
            factor[(i, j)] /= root;
        }
    }
    Some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    fn any(random: &mut Random, rows: usize, columns: usize) -> Matrix {
        let entries: Vec<f64> = (0..rows * columns).map(|_| random.between(-1.0, 1.0)).collect();
        Matrix::from_fn(rows, columns, |i, j| entries[j * rows + i])
    }

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        Matrix::from_fn(a.rows, b.columns, |i, j| (0..a.columns).map(|k| a[(i, k)] * b[(k, j)]).sum())
    }

    fn farthest(a: &Matrix, b: &Matrix) -> f64 {
        a.data.iter().zip(&b.data).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn singular_vectors_are_orthonormal_and_give_the_matrix_back() {
        let mut random = Random::new(71);
        for (rows, columns) in [(1, 1), (3, 3), (3, 20), (12, 5), (6, 6), (2, 7)] {
            let a = any(&mut random, rows, columns);
            let Singular { u, values, v } = singular(&a);
            let k = rows.min(columns);
            let scaled = Matrix::from_fn(rows, k, |i, j| u[(i, j)] * values[j]);
            assert!(farthest(&product(&scaled, &v.transpose()), &a) < 1e-14);
            let identity = Matrix::from_fn(k, k, |i, j| f64::from(u8::from(i == j)));
            assert!(farthest(&product(&u.transpose(), &u), &identity) < 1e-14);
            assert!(farthest(&product(&v.transpose(), &v), &identity) < 1e-14);
            assert!(values.windows(2).all(|w| w[0] >= w[1]));
        }
    }

    #[test]
    fn a_tiny_singular_value_keeps_its_digits_and_a_lost_rank_is_zero() {
        // Columns of very different lengths: an eigenvalue of AᵀA would lose 1e-20 beside 1.
        let a = Matrix::from_fn(2, 2, |i, j| [[1.0, 1e-10], [1.0, -1e-10]][i][j]);
        let values = singular(&a).values;
        assert!((values[1] / (2f64.sqrt() * 1e-10) - 1.0).abs() < 1e-15, "{values:?}");
        let flat = singular(&Matrix::from_fn(3, 3, |i, _| (i + 1) as f64));
        assert!(flat.values[1] < 1e-15 && flat.u.data.iter().all(|x| x.is_finite()), "{flat:?}");
        assert_eq!(singular(&Matrix::zeros(3, 2)).values, [0.0, 0.0]);
    }

    #[test]
    fn positive_systems_are_solved_and_others_refused() {
        let mut random = Random::new(72);
        for n in [1, 2, 9, 30] {
            let a = any(&mut random, n + 2, n);
            let gram = product(&a.transpose(), &a);
            let x: Vec<f64> = (0..n).map(|_| random.between(-1.0, 1.0)).collect();
            let found = solve_positive(&gram, &gram.times(&x)).unwrap();
            assert!(found.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-9), "{n}");
        }
        let saddle = Matrix::from_fn(2, 2, |i, j| [[1.0, 2.0], [2.0, 1.0]][i][j]);
        assert_eq!(solve_positive(&saddle, &[1.0, 1.0]), None);
        assert_eq!(solve_positive(&Matrix::zeros(1, 1), &[0.0]), None);
    }
}
