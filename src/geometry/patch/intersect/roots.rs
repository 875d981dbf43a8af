//! The common roots of two bicubics over the unit square, isolated by halving boxes. Knows nothing of rays.

/// Control values of the two, row by row.
#[derive(Clone, Copy)]
pub struct Net {
    /// Of the first.
    pub x: [f64; 16],
    /// Of the second.
    pub y: [f64; 16],
}

/// A box of (u, v) within a part, both from 0 to 1, with its net.
#[derive(Clone, Copy)]
struct Cell {
    net: Net,
    u: (f64, f64),
    v: (f64, f64),
}

/// Most boxes looked at in one part. A tangent to the last bit takes some 400; a whole curve of them would take all there are.
const MOST_CELLS: usize = 3000;
/// A box this narrow in u and v is not halved further: 2⁻⁴⁴ of a part.
const NARROWEST: f64 = 5.7e-14;
/// Boxes are given up as seen edge-on only after this many, since the test costs as much as several.
const EDGE_ON_CHECK: usize = 48;

/// Calls `found` with each root of the two and how far it may be off, in u and v from 0 to 1. `rounding` bounds what the values are off
/// by. False where the work allowed was not enough.
pub fn isolate(net: &Net, rounding: f64, mut found: impl FnMut(f64, f64, f64)) -> bool {
    let whole = Cell { net: *net, u: (0.0, 1.0), v: (0.0, 1.0) };
    if whole.net.excludes_zero(rounding) {
        return true;
    }
    let mut waiting = vec![whole];
    let mut looked = 0;
    while let Some(cell) = waiting.pop() {
        looked += 1;
        if looked == EDGE_ON_CHECK && net.edge_on(rounding) {
            return true;
        }
        if looked > MOST_CELLS {
            return false;
        }
        match cell.look(rounding) {
            Look::Empty => {}
            Look::One { u, v, uncertainty } => found(u, v, uncertainty),
            Look::Unclear if cell.narrow() => {
                if let Some(blur) = cell.touches(rounding) {
                    found(0.5 * (cell.u.0 + cell.u.1), 0.5 * (cell.v.0 + cell.v.1), blur);
                }
            }
            Look::Unclear => waiting.extend(cell.halves()),
        }
    }
    true
}

/// What one look at a box says.
enum Look {
    /// No root.
    Empty,
    /// One root, here.
    One { u: f64, v: f64, uncertainty: f64 },
    /// Perhaps several.
    Unclear,
}

/// A 2 × 2 matrix, row by row.
#[derive(Clone, Copy)]
pub struct Matrix2 {
    /// First row.
    pub a: f64,
    /// First row.
    pub b: f64,
    /// Second row.
    pub c: f64,
    /// Second row.
    pub d: f64,
}

impl Net {
    fn excludes_zero(&self, slack: f64) -> bool {
        one_sided(&self.x, slack) || one_sided(&self.y, slack)
    }

    /// True where the two distances are dependent all over: the part is seen as a line.
    fn edge_on(&self, rounding: f64) -> bool {
        let step_u = |f: &[f64; 16], k: usize| f[k + 4] - f[k];
        let step_v = |f: &[f64; 16], k: usize| f[k / 3 * 4 + k % 3 + 1] - f[k / 3 * 4 + k % 3];
        let size = self.x.iter().chain(&self.y).fold(0.0, |m: f64, x| m.max(x.abs()));
        let determinant = |i: usize, j: usize| {
            step_u(&self.x, i) * step_v(&self.y, j) - step_u(&self.y, i) * step_v(&self.x, j)
        };
        (0..12).all(|i| (0..12).all(|j| determinant(i, j).abs() <= 8.0 * rounding * size))
    }

    /// Mean Jacobian over the box, per its own width.
    fn mean_jacobian(&self) -> Matrix2 {
        let rise_u = |f: &[f64; 16]| (0..4).map(|j| f[12 + j] - f[j]).sum::<f64>() / 4.0;
        let rise_v = |f: &[f64; 16]| (0..4).map(|i| f[4 * i + 3] - f[4 * i]).sum::<f64>() / 4.0;
        Matrix2 { a: rise_u(&self.x), b: rise_v(&self.x), c: rise_u(&self.y), d: rise_v(&self.y) }
    }

    /// The net of m · f.
    fn transformed(&self, m: &Matrix2) -> Net {
        let mut out = Net { x: [0.0; 16], y: [0.0; 16] };
        for k in 0..16 {
            out.x[k] = m.a * self.x[k] + m.b * self.y[k];
            out.y[k] = m.c * self.x[k] + m.d * self.y[k];
        }
        out
    }

    /// How far the Jacobian strays from the identity anywhere in the box: the greater row sum of |I − J|, J bounded by its control values.
    fn stray(&self) -> f64 {
        let mut rows = [0.0f64; 2];
        for (row, f) in rows.iter_mut().zip([&self.x, &self.y]) {
            let own = |wanted: f64, found: f64| (3.0 * found - wanted).abs();
            let first = f64::from(u8::from(std::ptr::eq(f, &self.x)));
            let (mut u, mut v) = (0.0, 0.0);
            for k in 0..12 {
                let du = own(first, f[k + 4] - f[k]);
                if du > u {
                    u = du;
                }
            }
            for i in 0..4 {
                for j in 0..3 {
                    let dv = own(1.0 - first, f[4 * i + j + 1] - f[4 * i + j]);
                    if dv > v {
                        v = dv;
                    }
                }
            }
            *row = u + v;
        }
        rows[0].max(rows[1])
    }

    /// f and its Jacobian at a place in the box.
    fn at(&self, u: f64, v: f64) -> ([f64; 2], Matrix2) {
        let (bu, bv) = (crate::geometry::basis::bernstein(u), crate::geometry::basis::bernstein(v));
        let slopes = |t: f64| {
            let r = 1.0 - t;
            let (a, b, c) = (3.0 * r * r, 6.0 * r * t, 3.0 * t * t);
            [-a, a - b, b - c, c]
        };
        let (su, sv) = (slopes(u), slopes(v));
        let sum = |f: &[f64; 16], wu: &[f64; 4], wv: &[f64; 4]| {
            (0..4).map(|i| wu[i] * (0..4).map(|j| wv[j] * f[4 * i + j]).sum::<f64>()).sum::<f64>()
        };
        let jacobian = Matrix2 {
            a: sum(&self.x, &su, &bv),
            b: sum(&self.x, &bu, &sv),
            c: sum(&self.y, &su, &bv),
            d: sum(&self.y, &bu, &sv),
        };
        ([sum(&self.x, &bu, &bv), sum(&self.y, &bu, &bv)], jacobian)
    }

    fn halves_u(&self) -> [Net; 2] {
        let mut out = [*self, *self];
        for j in 0..4 {
            for (axis, f) in [&self.x, &self.y].into_iter().enumerate() {
                let [low, high] = halve([f[j], f[4 + j], f[8 + j], f[12 + j]]);
                for i in 0..4 {
                    *out[0].value(axis, 4 * i + j) = low[i];
                    *out[1].value(axis, 4 * i + j) = high[i];
                }
            }
        }
        out
    }

    fn halves_v(&self) -> [Net; 2] {
        let mut out = [*self, *self];
        for i in 0..4 {
            for (axis, f) in [&self.x, &self.y].into_iter().enumerate() {
                let [low, high] = halve([f[4 * i], f[4 * i + 1], f[4 * i + 2], f[4 * i + 3]]);
                for j in 0..4 {
                    *out[0].value(axis, 4 * i + j) = low[j];
                    *out[1].value(axis, 4 * i + j) = high[j];
                }
            }
        }
        out
    }

    fn value(&mut self, axis: usize, k: usize) -> &mut f64 {
        if axis == 0 { &mut self.x[k] } else { &mut self.y[k] }
    }
}

/// De Casteljau's halves of one row.
fn halve([a, b, c, d]: [f64; 4]) -> [[f64; 4]; 2] {
    let (e, f, g) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
    let (h, i) = (0.5 * (e + f), 0.5 * (f + g));
    let m = 0.5 * (h + i);
    [[a, e, h, m], [m, i, g, d]]
}

/// All beyond `slack` on one side of 0.
fn one_sided(f: &[f64; 16], slack: f64) -> bool {
    let (mut low, mut high) = (f[0], f[0]);
    for x in f {
        if *x < low {
            low = *x;
        }
        if *x > high {
            high = *x;
        }
    }
    low > slack || high < -slack
}

impl Matrix2 {
    /// The inverse, and by how much it can enlarge. None for a singular or badly unbalanced matrix, which preconditions nothing.
    #[inline]
    pub fn inverse(&self) -> Option<Matrix2> {
        let det = self.a * self.d - self.b * self.c;
        let size = (self.a.abs() + self.b.abs()) * (self.c.abs() + self.d.abs());
        let m = Matrix2 { a: self.d / det, b: -self.b / det, c: -self.c / det, d: self.a / det };
        (det.abs() > 16.0 * f64::EPSILON * size && (m.a + m.b + m.c + m.d).is_finite()).then_some(m)
    }

    /// Largest row sum of magnitudes.
    fn norm(&self) -> f64 {
        (self.a.abs() + self.b.abs()).max(self.c.abs() + self.d.abs())
    }
}

/// Contraction of the preconditioned map below which a box is left to Newton. Below 1 there is one root at most; a margin makes the
/// steps quick.
const CONTRACTION: f64 = 0.75;
/// Steps of Newton in a box with one root at most: each squares the error once it is below a half.
const STEPS: usize = 60;

impl Cell {
    fn look(&self, rounding: f64) -> Look {
        if self.net.excludes_zero(rounding) {
            return Look::Empty;
        }
        let Some(inverse) = self.net.mean_jacobian().inverse() else { return Look::Unclear };
        let g = self.net.transformed(&inverse);
        let slack = rounding * inverse.norm();
        if g.excludes_zero(slack) {
            return Look::Empty;
        }
        if g.stray() > CONTRACTION {
            return Look::Unclear;
        }
        self.only_root(&g, slack)
    }

    /// The root of a preconditioned net whose Jacobian is near the identity. Iterates stay in the box, where the map contracts; an iterate
    /// that rests at the border without being a root shows that there is none inside.
    fn only_root(&self, g: &Net, slack: f64) -> Look {
        let (mut x, mut y) = (0.5, 0.5);
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let ([fx, fy], j) = g.at(x, y);
            let Some(inverse) = j.inverse() else { return Look::Unclear };
            let (dx, dy) = (inverse.a * fx + inverse.b * fy, inverse.c * fx + inverse.d * fy);
            let (nx, ny) = ((x - dx).clamp(0.0, 1.0), (y - dy).clamp(0.0, 1.0));
            let moved = (nx - x).abs().max((ny - y).abs());
            (x, y) = (nx, ny);
            if moved <= 4.0 * f64::EPSILON || moved >= last && moved <= slack {
                break;
            }
            last = moved;
        }
        let ([fx, fy], j) = g.at(x, y);
        // How far the root is outside at most: |g| over the least stretch of a map within CONTRACTION of the identity.
        let beyond = fx.abs().max(fy.abs()) / (1.0 - CONTRACTION);
        let blur = (2.0 * slack + 8.0 * f64::EPSILON) * j.inverse().map_or(1.0, |m| m.norm().max(1.0));
        if beyond > 2.0 * blur / (1.0 - CONTRACTION) {
            return Look::Empty;
        }
        let (wu, wv) = (self.u.1 - self.u.0, self.v.1 - self.v.0);
        Look::One {
            u: self.u.0 + x * wu,
            v: self.v.0 + y * wv,
            uncertainty: blur * wu.max(wv) + 4.0 * f64::EPSILON,
        }
    }

    fn narrow(&self) -> bool {
        self.u.1 - self.u.0 <= NARROWEST && self.v.1 - self.v.0 <= NARROWEST
    }

    /// Of a box too narrow to halve: the uncertainty of a root in it, if f is 0 there to rounding.
    fn touches(&self, rounding: f64) -> Option<f64> {
        let ([x, y], j) = self.net.at(0.5, 0.5);
        let steepest = j.norm();
        // Over the box f changes by its Jacobian; a second derivative of the part's own size changes it by less than rounding.
        (x.abs().max(y.abs()) <= 2.0 * rounding + steepest).then(|| rounding.sqrt().max(NARROWEST))
    }

    /// Halved across the direction in which f changes most.
    fn halves(&self) -> [Cell; 2] {
        let reach = |d: (f64, f64)| d.0.abs().max(d.1.abs());
        let steps = |far: usize, near: usize, stride: usize| {
            (0..4)
                .map(|k| {
                    reach((
                        self.net.x[far + k * stride] - self.net.x[near + k * stride],
                        self.net.y[far + k * stride] - self.net.y[near + k * stride],
                    ))
                })
                .fold(0.0, f64::max)
        };
        let along_u = steps(4, 0, 1).max(steps(8, 4, 1)).max(steps(12, 8, 1));
        let along_v = steps(1, 0, 4).max(steps(2, 1, 4)).max(steps(3, 2, 4));
        let (wu, wv) = (self.u.1 - self.u.0, self.v.1 - self.v.0);
        // Neither side may fall far behind: what is hidden in a long box is seen only when it is halved.
        let by_u = if wu > 64.0 * wv {
            true
        } else if wv > 64.0 * wu {
            false
        } else {
            along_u >= along_v
        };
        if by_u {
            let m = 0.5 * (self.u.0 + self.u.1);
            let [low, high] = self.net.halves_u();
            [Cell { net: high, u: (m, self.u.1), v: self.v }, Cell { net: low, u: (self.u.0, m), v: self.v }]
        } else {
            let m = 0.5 * (self.v.0 + self.v.1);
            let [low, high] = self.net.halves_v();
            [Cell { net: high, u: self.u, v: (m, self.v.1) }, Cell { net: low, u: self.u, v: (self.v.0, m) }]
        }
    }
}
