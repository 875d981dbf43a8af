//! Bicubic surfaces: Bézier and B-spline patches, grids of them with shared seams, patches read from files. Knows nothing of scenes
//! or pictures.

mod bicubic;
pub mod bpt;
mod intersect;
pub mod tessellate;
#[cfg(test)]
mod tests;

pub use bicubic::{Bicubic, Curvature, Edge, Jet};
pub use intersect::{Hits, PatchHit, PatchTree};

use super::basis::Basis;
use crate::math::{Aabb, Dd};
use glam::DVec3;

/// Pieces of bicubic surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    pieces: Vec<Bicubic>,
    layout: Layout,
}

/// How the pieces lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// `rows` × `columns` pieces, row by row, that share seams: u runs through the rows from 0 to 1, v through the columns.
    Grid {
        /// Pieces along u.
        rows: usize,
        /// Pieces along v.
        columns: usize,
    },
    /// Pieces without order, as from a file: each has its own u and v.
    Loose,
}

impl Layout {
    /// (u, v) of the whole for a place in one of its pieces; of loose pieces the piece's own.
    pub fn global_uv(self, piece: usize, u: f64, v: f64) -> (f64, f64) {
        match self {
            Layout::Grid { rows, columns } => {
                let (r, c) = (piece / columns, piece % columns);
                ((r as f64 + u) / rows as f64, (c as f64 + v) / columns as f64)
            }
            Layout::Loose => (u, v),
        }
    }
}

/// Why a patch could not be made, or not be asked that.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatchError {
    /// Not 16 points, or not as many as the grid says.
    #[error("{expected} points expected, not {given}")]
    PointCount {
        /// How many would do, in words.
        expected: String,
        /// How many there were.
        given: usize,
    },
    /// A grid whose sides make no whole number of pieces.
    #[error("a {form} grid cannot be {rows} by {columns}: {needs}")]
    GridShape {
        /// "bezier" or "bspline".
        form: &'static str,
        /// Rows asked for.
        rows: usize,
        /// Columns asked for.
        columns: usize,
        /// What is needed, in words.
        needs: &'static str,
    },
    /// A point with a coordinate that is NaN, infinite or beyond 1e290.
    #[error("point {index} is not finite, or beyond 1e290")]
    NotFinite {
        /// Which, from 0.
        index: usize,
    },
    /// u or v outside [0, 1].
    #[error("({u}, {v}) is outside the patch: u and v run from 0 to 1")]
    OutsideDomain {
        /// u asked for.
        u: f64,
        /// v asked for.
        v: f64,
    },
    /// Loose pieces have no common u and v.
    #[error("the {n_pieces} patches of a file have no common u and v: ask one of them")]
    Loose {
        /// How many there are.
        n_pieces: usize,
    },
    /// No such piece.
    #[error("there is no piece {index}: the surface has {n_pieces}")]
    NoPiece {
        /// What was asked for.
        index: usize,
        /// How many there are.
        n_pieces: usize,
    },
    /// A split at an edge.
    #[error("{at} is an edge of the patch: nothing to split off")]
    SplitAtEdge {
        /// The parameter.
        at: f64,
    },
}

/// The bases of patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatchBasis {
    /// Pieces share the points of their edges: 3m + 1 by 3n + 1 points.
    Bezier,
    /// Uniform bicubic B-spline: pieces share three rows: m + 3 by n + 3 points.
    BSpline,
}

/// u or v beyond an edge by no more than this is on it: what adding up steps may have cost.
const SLACK: f64 = 16.0 * f64::EPSILON;
/// Coordinates beyond this could overflow when split for exact products.
const LARGEST: f64 = 1e290;

impl Patch {
    /// From points row by row: 16, or as many as `grid` (rows, columns) says, counted in points or in pieces, whichever fits.
    pub fn new(
        basis: PatchBasis,
        points: &[DVec3],
        grid: Option<(usize, usize)>,
    ) -> Result<Patch, PatchError> {
        let (rows, columns) = point_rows(basis, points.len(), grid)?;
        let beyond = |p: &DVec3| !p.abs().max_element().le(&LARGEST) || p.is_nan();
        if let Some(index) = points.iter().position(beyond) {
            return Err(PatchError::NotFinite { index });
        }
        let net: Vec<Vec<Dd<DVec3>>> =
            points.chunks(columns).map(|row| row.iter().copied().map(Dd::from).collect()).collect();
        let net = match basis {
            PatchBasis::Bezier => net,
            PatchBasis::BSpline => bspline_net(&net),
        };
        Ok(Patch::from_net(&net, pieces_along(basis, rows), pieces_along(basis, columns)))
    }

    /// Loose pieces, as a file holds them.
    pub fn loose(pieces: Vec<Bicubic>) -> Patch {
        Patch { pieces, layout: Layout::Loose }
    }

    /// From a net of 3m + 1 by 3n + 1 Bézier points: seams are shared to the bit, since each point is there once.
    fn from_net(net: &[Vec<Dd<DVec3>>], rows: usize, columns: usize) -> Patch {
        let corner = |r: usize, c: usize| {
            let points = std::array::from_fn(|i| std::array::from_fn(|j| net[3 * r + i][3 * c + j].value()));
            Bicubic { points }
        };
        let pieces =
            (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))).map(|(r, c)| corner(r, c)).collect();
        Patch { pieces, layout: Layout::Grid { rows, columns } }
    }

    /// The same with each control point moved; by an affine map, the image of the surface.
    #[must_use]
    pub fn map(&self, f: impl Fn(DVec3) -> DVec3) -> Patch {
        let moved = |piece: &Bicubic| Bicubic { points: piece.points.map(|row| row.map(&f)) };
        Patch { pieces: self.pieces.iter().map(moved).collect(), layout: self.layout }
    }

    /// The pieces.
    pub fn pieces(&self) -> &[Bicubic] {
        &self.pieces
    }

    /// How they lie.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// One piece.
    pub fn piece(&self, index: usize) -> Result<&Bicubic, PatchError> {
        self.pieces.get(index).ok_or(PatchError::NoPiece { index, n_pieces: self.pieces.len() })
    }

    /// The piece under (u, v), that place in the piece's own [0, 1]², and how many pieces there are along u and v. Errors: outside [0, 1]²,
    /// or more than one loose piece.
    pub fn locate(&self, u: f64, v: f64) -> Result<(&Bicubic, f64, f64), PatchError> {
        let (rows, columns) = match self.layout {
            Layout::Grid { rows, columns } => (rows, columns),
            Layout::Loose if self.pieces.len() == 1 => (1, 1),
            Layout::Loose => return Err(PatchError::Loose { n_pieces: self.pieces.len() }),
        };
        let inside = |t: f64| (-SLACK..=1.0 + SLACK).contains(&t);
        if !(inside(u) && inside(v)) {
            return Err(PatchError::OutsideDomain { u, v });
        }
        let cell = |t: f64, n: usize| {
            let scaled = t.clamp(0.0, 1.0) * n as f64;
            let index = (scaled as usize).min(n - 1);
            (index, scaled - index as f64)
        };
        let ((r, local_u), (c, local_v)) = (cell(u, rows), cell(v, columns));
        Ok((&self.pieces[r * columns + c], local_u, local_v))
    }

    /// How much faster a piece's own u and v run than the patch's.
    fn speed(&self) -> (f64, f64) {
        match self.layout {
            Layout::Grid { rows, columns } => (rows as f64, columns as f64),
            Layout::Loose => (1.0, 1.0),
        }
    }

    /// (u, v) of the patch for a place in one of its pieces.
    pub fn global_uv(&self, piece: usize, u: f64, v: f64) -> (f64, f64) {
        self.layout.global_uv(piece, u, v)
    }

    /// The point at (u, v).
    pub fn at(&self, u: f64, v: f64) -> Result<DVec3, PatchError> {
        let (piece, u, v) = self.locate(u, v)?;
        Ok(piece.at(u, v))
    }

    /// Point and partial derivatives by the patch's own u and v.
    pub fn jet(&self, u: f64, v: f64) -> Result<Jet, PatchError> {
        let (piece, u, v) = self.locate(u, v)?;
        let (a, b) = self.speed();
        let jet = piece.jet(u, v);
        Ok(Jet {
            point: piece.at(u, v),
            du: jet.du * a,
            dv: jet.dv * b,
            duu: jet.duu * (a * a),
            duv: jet.duv * (a * b),
            dvv: jet.dvv * (b * b),
        })
    }

    /// Unit normal; see [`Bicubic::normal`].
    pub fn normal(&self, u: f64, v: f64) -> Result<Option<DVec3>, PatchError> {
        let (piece, u, v) = self.locate(u, v)?;
        Ok(piece.normal(u, v))
    }

    /// Gaussian and mean curvature; see [`Bicubic::curvature`].
    pub fn curvature(&self, u: f64, v: f64) -> Result<Option<Curvature>, PatchError> {
        let (piece, u, v) = self.locate(u, v)?;
        Ok(piece.curvature(u, v))
    }

    /// The four parts around (u, v) of a single piece: lower u and lower v first, then lower u and upper v. Errors: more than one
    /// piece, or a place on an edge.
    pub fn split(&self, u: f64, v: f64) -> Result<[Patch; 4], PatchError> {
        let [piece] = self.pieces.as_slice() else {
            return Err(PatchError::Loose { n_pieces: self.pieces.len() });
        };
        if let Some(at) = [u, v].into_iter().find(|t| !(*t > 0.0 && *t < 1.0)) {
            return Err(PatchError::SplitAtEdge { at });
        }
        let [low, high] = piece.split_u(u);
        let parts = [low.split_v(v), high.split_v(v)];
        let patch = |k: usize| Patch {
            pieces: vec![parts[k / 2][k % 2]],
            layout: Layout::Grid { rows: 1, columns: 1 },
        };
        Ok([patch(0), patch(1), patch(2), patch(3)])
    }

    /// The Bézier points: of a grid row by row, shared ones once; of loose pieces sixteen each.
    pub fn points(&self) -> Vec<DVec3> {
        match self.layout {
            Layout::Loose => self.pieces.iter().flat_map(|p| p.points.into_iter().flatten()).collect(),
            Layout::Grid { rows, columns } => {
                let at = |i: usize, j: usize| {
                    let (r, c) = ((i / 3).min(rows - 1), (j / 3).min(columns - 1));
                    self.pieces[r * columns + c].points[i - 3 * r][j - 3 * c]
                };
                (0..=3 * rows)
                    .flat_map(|i| (0..=3 * columns).map(move |j| (i, j)))
                    .map(|(i, j)| at(i, j))
                    .collect()
            }
        }
    }

    /// The box of all control points, which holds the surface; empty without pieces.
    pub fn bounds(&self) -> Aabb {
        self.pieces.iter().fold(Aabb::EMPTY, |sum, piece| sum.union(piece.bounds()))
    }
}

/// Pieces that a side of so many points makes.
fn pieces_along(basis: PatchBasis, points: usize) -> usize {
    match basis {
        PatchBasis::Bezier => (points - 1) / 3,
        PatchBasis::BSpline => points - 3,
    }
}

/// Rows and columns of points.
fn point_rows(
    basis: PatchBasis,
    n: usize,
    grid: Option<(usize, usize)>,
) -> Result<(usize, usize), PatchError> {
    let Some((rows, columns)) = grid else {
        return if n == 16 {
            Ok((4, 4))
        } else {
            Err(PatchError::PointCount { expected: "16".into(), given: n })
        };
    };
    let (form, needs, fits): (_, _, fn(usize) -> bool) = match basis {
        PatchBasis::Bezier => ("bezier", "each side takes 3n + 1 points", |k| k >= 4 && k % 3 == 1),
        PatchBasis::BSpline => ("bspline", "each side takes at least 4 points", |k| k >= 4),
    };
    let side = |pieces: usize| match basis {
        PatchBasis::Bezier => pieces.saturating_mul(3).saturating_add(1),
        PatchBasis::BSpline => pieces.saturating_add(3),
    };
    let (by_points, by_pieces) = (rows.saturating_mul(columns), side(rows).saturating_mul(side(columns)));
    if n == by_points && fits(rows) && fits(columns) {
        return Ok((rows, columns));
    }
    if n == by_pieces && rows > 0 && columns > 0 {
        return Ok((side(rows), side(columns)));
    }
    if n == by_points {
        return Err(PatchError::GridShape { form, rows, columns, needs });
    }
    let expected = if fits(rows) && fits(columns) { by_points } else { by_pieces };
    Err(PatchError::PointCount { expected: expected.to_string(), given: n })
}

/// Bézier points of a net of B-spline points: along each row, then along each column of the result.
fn bspline_net(net: &[Vec<Dd<DVec3>>]) -> Vec<Vec<Dd<DVec3>>> {
    let rows: Vec<_> = net.iter().map(|row| bspline_chain(row)).collect();
    let columns: Vec<_> = (0..rows[0].len())
        .map(|j| bspline_chain(&rows.iter().map(|row| row[j]).collect::<Vec<_>>()))
        .collect();
    (0..columns[0].len()).map(|i| columns.iter().map(|column| column[i]).collect()).collect()
}

/// 3(n − 3) + 1 Bézier points of n uniform B-spline points.
fn bspline_chain(p: &[Dd<DVec3>]) -> Vec<Dd<DVec3>> {
    let fours = p.windows(4).map(|w| Basis::BSpline.to_bezier(&[w[0], w[1], w[2], w[3]]));
    let mut chain: Vec<Dd<DVec3>> = Vec::with_capacity(3 * p.len());
    for four in fours {
        chain.pop();
        chain.extend(four);
    }
    chain
}
