//! What can be wrong with a curve, as small values; the language words them and adds the place.

/// Why a curve could not be made, or not be asked that.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// Too few points, or a number of points that makes no whole number of pieces.
    #[error("{form} takes {expected} points, not {given}")]
    PointCount {
        /// Which form of spline.
        form: &'static str,
        /// What it takes, in words: "3n + 1".
        expected: &'static str,
        /// How many there were.
        given: usize,
    },
    /// A point, slope, knot or other number is NaN, infinite, or so large that products of it would be.
    #[error("{what} {index} is not a number below 1e290")]
    NotFinite {
        /// "point", "slope", "knot", "tension", "alpha".
        what: &'static str,
        /// Which, from 0.
        index: usize,
    },
    /// Not one slope for each point.
    #[error("{expected} points take {expected} slopes, not {given}")]
    SlopeCount {
        /// How many points.
        expected: usize,
        /// How many slopes.
        given: usize,
    },
    /// Not one knot more than pieces.
    #[error("{pieces} pieces take {} knots, not {given}", pieces + 1)]
    KnotCount {
        /// How many pieces the points make.
        pieces: usize,
        /// How many knots there were.
        given: usize,
    },
    /// Knots that do not strictly increase.
    #[error("knots must strictly increase: knot {index} is {after}, after {before}")]
    KnotOrder {
        /// The second of the pair, from 0.
        index: usize,
        /// The knot before it.
        before: f64,
        /// The knot itself.
        after: f64,
    },
    /// Two neighbours coincide where their distance is the length of an interval.
    #[error("points {} and {index} coincide, so that the interval between them would be empty", index - 1)]
    RepeatedPoint {
        /// The second of the pair, from 0.
        index: usize,
    },
    /// A stride of 0.
    #[error("a stride must be at least 1")]
    Stride,
    /// A parameter outside the domain.
    #[error("{t} is outside the curve's domain {start} to {end}")]
    OutsideDomain {
        /// What was asked for.
        t: f64,
        /// Start of the domain.
        start: f64,
        /// End of the domain.
        end: f64,
    },
    /// A length below 0 or beyond the end.
    #[error("{s} is outside the curve's length, 0 to {length}")]
    OutsideLength {
        /// What was asked for.
        s: f64,
        /// The whole length.
        length: f64,
    },
    /// No such piece.
    #[error("there is no piece {index}: the curve has {n_pieces}")]
    NoPiece {
        /// What was asked for.
        index: usize,
        /// How many there are.
        n_pieces: usize,
    },
    /// A split that would leave one half empty.
    #[error("{t} is an end of the curve: nothing to split off")]
    SplitAtEnd {
        /// What was asked for.
        t: f64,
    },
    /// The basis cannot be the target of a change.
    #[error("a curve cannot be changed to a basis given as a matrix")]
    NoInverse,
    /// A function gave NaN or an infinity.
    #[error("the curve's function has no finite value at {t}")]
    Undefined {
        /// Where.
        t: f64,
    },
}
