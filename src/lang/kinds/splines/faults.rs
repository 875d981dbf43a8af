//! What keeps points from making a curve, in words, each at its smallest place.

use super::name_place;
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::basis::Basis;
use crate::geometry::curve::CurveError;
use crate::lang::table::Block;

/// A fault of the kernel, with its place and a thing to try.
pub fn worded(block: &Block, form: &str, error: &CurveError) -> Diagnostic {
    let said = |place: Span| Diagnostic::new(Code::BadProperty, place, sentence(error));
    match error {
        CurveError::PointCount { given, .. } => {
            let said = Diagnostic::new(
                Code::BadProperty,
                name_place(block, form),
                count_sentence(block, form, error),
            );
            said.label(format!("{given} points")).hint(counts(block, form, *given))
        }
        CurveError::SlopeCount { expected, .. } => said(name_place(block, "slopes"))
            .also(name_place(block, form), format!("{expected} points here"))
            .hint("give one slope for each point"),
        CurveError::KnotCount { pieces, given } => said(name_place(block, "knots"))
            .label(format!("{given} knots"))
            .also(name_place(block, form), format!("{pieces} pieces from these points"))
            .hint("a knot is the parameter at which two pieces meet; the ends count too"),
        CurveError::KnotOrder { index, .. } => said(block.place_of("knots", *index))
            .hint("a piece of no length is none: leave the repeated knot out, or use `bezier` for a corner"),
        CurveError::RepeatedPoint { index } => {
            let n = block.get(form).map_or(1, |g| g.values.len());
            said(block.place_of(form, index % n)).hint("leave one of the two out, or use `alpha 0`")
        }
        CurveError::NotFinite { what, index } => {
            let name = match *what {
                "slope" => "slopes",
                "knot" => "knots",
                "basis row" => "basis",
                "tension" | "alpha" => what,
                _ => form,
            };
            said(block.place_of(name, *index))
                .hint("numbers so large cannot be told from infinity once multiplied")
        }
        CurveError::Stride
        | CurveError::OutsideDomain { .. }
        | CurveError::OutsideLength { .. }
        | CurveError::NoPiece { .. }
        | CurveError::SplitAtEnd { .. }
        | CurveError::NoInverse
        | CurveError::Undefined { .. } => said(block.kind_span),
    }
}

fn sentence(error: &CurveError) -> String {
    match error {
        CurveError::SlopeCount { expected, given } => {
            format!("{expected} points take {expected} slopes, and there {}", are(*given))
        }
        CurveError::KnotCount { pieces, given } => {
            format!("{pieces} pieces take {} knots, and there {}", pieces + 1, are(*given))
        }
        other => other.to_string(),
    }
}

fn are(n: usize) -> String {
    if n == 1 { "is 1".into() } else { format!("are {n}") }
}

/// What is wrong with the number of points; a chain of fours says how it goes on.
fn count_sentence(block: &Block, form: &str, error: &CurveError) -> String {
    match error {
        CurveError::PointCount { given, .. } if form == "points" => {
            let stride = stride(block);
            let counts = match block.flag("closed") {
                Some(true) => {
                    format!("a closed chain that moves on by {stride} takes a multiple of {stride}")
                }
                _ => format!(
                    "a chain of fours that moves on by {stride} takes {}, {}, {}, …",
                    4,
                    4 + stride,
                    4 + 2 * stride
                ),
            };
            format!("{counts} points, not {given}")
        }
        other => sentence(other),
    }
}

/// How far a chain moves on.
fn stride(block: &Block) -> usize {
    block.integer("stride").map_or_else(|| super::basis(block).stride(), |n| n as usize)
}

/// The numbers of points that would do.
fn counts(block: &Block, form: &str, given: usize) -> String {
    let closed = block.flag("closed") == Some(true);
    let (stride, least) = match form {
        "bezier" => (3, if closed { 3 } else { 4 }),
        "points" => {
            let stride = stride(block);
            (stride, if closed { stride } else { 4 })
        }
        "monomial" => return "give the coefficients of 1, t, t² and t³; 0 for those that are missing".into(),
        _ => return "add points, or use another form".into(),
    };
    let fewer = given.checked_sub(least).map(|more| least + more / stride * stride);
    let more = fewer.map_or(least, |n| n + stride);
    let hermite = form == "points" && matches!(super::basis(block), Basis::Hermite);
    let note = if hermite { "; each piece is P₀, P₁, m₀, m₁" } else { "" };
    match fewer {
        Some(fewer) => format!("{fewer} would do, or {more}{note}"),
        None => format!("{more} would do{note}"),
    }
}
