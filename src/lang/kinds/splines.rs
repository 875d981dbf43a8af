//! The kind `spline`: curves from points. What is wrong with one is worded in `faults`; the kernels know no places.

mod faults;

use super::shapes::conflict;
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::any_curve::IntoCurve;
use crate::geometry::basis::Basis;
use crate::geometry::curve::{CatmullRom, Curve, CurveError, Ends};
use crate::lang::builtins::components;
use crate::lang::coerce;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Reported, Role, Type};
use crate::lang::value::Value;
use crate::math::Point;
use glam::{DVec2, DVec3};

const POINTS: &[&[Type]] = &[&[Type::Point]];
const FLAG: &[&[Type]] = &[&[], &[Type::Bool]];

/// Exactly one of these carries the points.
const FORMS: [&str; 7] = ["bezier", "bspline", "hermite", "catmull_rom", "natural", "monomial", "points"];

/// The properties that only some forms take, with those forms.
const BELONGING: [(&str, &[&str]); 6] = [
    ("slopes", &["hermite"]),
    ("tension", &["catmull_rom"]),
    ("alpha", &["catmull_rom"]),
    ("clamped", &["bspline"]),
    ("basis", &["points"]),
    ("stride", &["points"]),
];

/// A curve.
pub static SPLINE: Kind = Kind {
    name: "spline",
    doc: "A curve of numbers, 2-vectors, 3-vectors or colours, made of cubic pieces. Exactly one of the properties down to `points` \
          carries its points.",
    example: "spline path { catmull_rom <0, 0, 0>, <1, 1, 0>, <2, 0, 0>, <3, 1, 0> }",
    role: Role::Value,
    own: &[
        Property::new(
            "bezier",
            POINTS,
            "",
            "cubic pieces that share end points: 3n + 1 points, or 3n where it is closed",
        )
        .many(),
        Property::new(
            "bspline",
            POINTS,
            "",
            "uniform cubic B-spline, at least 4 points: C2, and near its points rather than through them",
        )
        .many(),
        Property::new("hermite", POINTS, "", "cubic Hermite: through the points, with `slopes`").many(),
        Property::new("catmull_rom", POINTS, "", "through the points, C1; see `tension` and `alpha`").many(),
        Property::new(
            "natural",
            POINTS,
            "",
            "through the points, C2, without curvature at its ends; closed, C2 all round",
        )
        .many(),
        Property::new("monomial", POINTS, "", "one piece: the coefficients of 1, t, t² and t³").many(),
        Property::new("points", POINTS, "", "one piece or a chain of fours in any `basis`").many(),
        Property::new(
            "slopes",
            POINTS,
            "",
            "of `hermite`: the derivative by the curve's own parameter at each point",
        )
        .many(),
        Property::new(
            "basis",
            &[
                &[Type::Word(&["bezier", "bspline", "hermite", "catmull_rom", "monomial"])],
                &[Type::Vector4, Type::Vector4, Type::Vector4, Type::Vector4],
            ],
            "",
            "of `points`: a name, or a matrix of four 4-vectors, a row for each control point: its weight as coefficients of 1, t, t² \
             and t³. The four of `hermite` are P₀, P₁, m₀, m₁",
        ),
        Property::new(
            "stride",
            &[&[Type::Integer { min: 1 }]],
            "",
            "of `points`: how far they move on from piece to piece; by default 3 for `bezier`, 2 for `hermite`, 1 else",
        ),
        Property::new(
            "tension",
            &[&[Type::NUMBER]],
            "0",
            "of `catmull_rom`: slopes are multiplied by 1 − tension; at 1 the curve is a polygon",
        ),
        Property::new(
            "alpha",
            &[&[Type::Number { min: 0.0, max: 1.0 }]],
            "0",
            "of `catmull_rom`: intervals are as the distances to this power: 0 uniform, 0.5 centripetal (no loops), 1 chordal",
        ),
        Property::new("clamped", FLAG, "off", "of `bspline`: end knots fourfold, so that it reaches its first and last point"),
        Property::new("closed", FLAG, "off", "the end runs on into the start"),
        Property::new(
            "knots",
            &[&[Type::NUMBER]],
            "",
            "the parameters at which pieces meet, strictly increasing, one more than the pieces; they enter the basis, so that \
             smoothness is kept. By default equal intervals over 0 … 1",
        )
        .many(),
    ],
    children: false,
    open: false,
    build: Some(build),
};

fn build(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let form = the_form(ctx, block)?;
    check_belonging(ctx, block, form)?;
    match check_dimensions(ctx, block, form)? {
        1 => spline::<f64>(ctx, block, form),
        2 => spline::<DVec2>(ctx, block, form),
        _ => spline::<DVec3>(ctx, block, form),
    }
}

/// The one property that carries the points.
fn the_form(ctx: &mut dyn Context, block: &Block) -> Outcome<&'static str> {
    let mut given = block.given.iter().filter_map(|g| FORMS.into_iter().find(|form| **form == *g.name));
    match (given.next(), given.next()) {
        (Some(one), None) => Ok(one),
        (Some(first), Some(second)) => Err(conflict(ctx, block, first, second)),
        (None, _) => {
            let said = Diagnostic::new(Code::MissingProperty, block.kind_span, "`spline` lacks its points")
                .label("needs one of the forms of a curve")
                .hint(format!("write for example `spline {{ natural <0, 0, 0>, <1, 2, 0>, <3, 1, 0> }}`; the forms are {}", forms()));
            Err(ctx.fail(said))
        }
    }
}

fn forms() -> String {
    coerce::listed(&FORMS.map(|form| format!("`{form}`")), "and")
}

fn name_place(block: &Block, name: &str) -> Span {
    block.get(name).map_or(block.kind_span, |g| g.name_span)
}

/// Says every property that belongs to another form, and what the form cannot be without.
fn check_belonging(ctx: &mut dyn Context, block: &Block, form: &'static str) -> Outcome<()> {
    let mut outcome = Ok(());
    for (name, owners) in BELONGING {
        if block.has(name) && !owners.contains(&form) {
            let message = format!("`{name}` belongs to `{}`, and this is a `{form}` spline", owners[0]);
            let said = Diagnostic::new(Code::ConflictingProperties, name_place(block, name), message)
                .also(name_place(block, form), "the form is here")
                .hint(format!("leave `{name}` out"));
            outcome = Err(ctx.fail(said));
        }
    }
    let closed = block.flag("closed") == Some(true);
    for (excluded, first, second) in [
        (closed && block.flag("clamped") == Some(true), "clamped", "closed"),
        (closed && form == "monomial", "monomial", "closed"),
        (block.has("alpha") && block.has("knots"), "alpha", "knots"),
    ] {
        if excluded {
            outcome = Err(conflict(ctx, block, first, second));
        }
    }
    for (form_with, needed, hint) in [
        ("hermite", "slopes", "add a slope for each point: `slopes <1, 0, 0>, …`"),
        ("points", "basis", "add `basis bezier`, another name, or four 4-vectors"),
    ] {
        if form == form_with && !block.has(needed) {
            let message = format!("a spline of `{form}` lacks `{needed}`");
            let said = Diagnostic::new(Code::MissingProperty, name_place(block, form), message).hint(hint);
            outcome = Err(ctx.fail(said));
        }
    }
    outcome
}

/// How many numbers each point has. Says every point and slope that has another number of them than the first.
fn check_dimensions(ctx: &mut dyn Context, block: &Block, form: &str) -> Outcome<usize> {
    let values = |name: &str| block.get(name).into_iter().flat_map(|g| g.values.iter());
    let dimension = |value: &Value| components(value).map_or(1, |(_, n)| n);
    let Some((first, first_span)) = values(form).next() else { return Err(Reported) };
    let n = dimension(first);
    let odd = values(form).chain(values("slopes")).find(|(value, _)| dimension(value) != n);
    match odd {
        None => Ok(n),
        Some((value, span)) => {
            let message =
                format!("this curve runs through {}, and this is {}", points_of(n), coerce::shown(value));
            let said = Diagnostic::new(Code::TypeMismatch, *span, message)
                .also(*first_span, "its first point is here")
                .hint("write all points, and slopes, with as many components");
            Err(ctx.fail(said))
        }
    }
}

fn points_of(n: usize) -> &'static str {
    match n {
        1 => "numbers",
        2 => "2-vectors",
        _ => "3-vectors",
    }
}

fn spline<P: Point>(ctx: &mut dyn Context, block: &Block, form: &'static str) -> Outcome
where
    Curve<P>: IntoCurve<P>,
{
    match make::<P>(block, form) {
        Ok(curve) => Ok(Value::Curve(curve.into_curve())),
        Err(error) => Err(ctx.fail(faults::worded(block, form, &error))),
    }
}

fn make<P: Point>(block: &Block, form: &str) -> Result<Curve<P>, CurveError> {
    let points = points::<P>(block, form);
    let knots = block.numbers("knots");
    let knots = knots.as_deref();
    let closed = block.flag("closed").unwrap_or(false);
    match form {
        "bezier" => Curve::bezier(&points, knots, closed),
        "bspline" => Curve::bspline(&points, ends(block, closed), knots),
        "hermite" => Curve::hermite(&points, &self::points::<P>(block, "slopes"), knots, closed),
        "catmull_rom" => Curve::catmull_rom(&points, catmull_rom(block), knots, closed),
        "natural" => Curve::natural(&points, knots, closed),
        "monomial" => Curve::monomial(&points, knots),
        _ => {
            let stride = block.integer("stride").map(|n| usize::try_from(n).unwrap_or(usize::MAX));
            Curve::chain(&points, basis(block), stride, knots, closed)
        }
    }
}

/// The points of a property, all of one dimension.
fn points<P: Point>(block: &Block, name: &str) -> Vec<P> {
    let of = |value: &Value| {
        let (c, _) = components(value).unwrap_or_default();
        P::from_coordinates(|i| c[i])
    };
    block.get(name).map(|g| g.values.iter().map(|(value, _)| of(value)).collect()).unwrap_or_default()
}

fn ends(block: &Block, closed: bool) -> Ends {
    match (closed, block.flag("clamped")) {
        (true, _) => Ends::Closed,
        (false, Some(true)) => Ends::Clamped,
        (false, _) => Ends::Open,
    }
}

fn catmull_rom(block: &Block) -> CatmullRom {
    let number = |name: &str| block.number(name).unwrap_or(0.0);
    CatmullRom { tension: number("tension"), alpha: number("alpha") }
}

fn basis(block: &Block) -> Basis {
    match block.value("basis") {
        Some(Value::Word(word)) => named_basis(word).expect("the table's words are bases"),
        _ => {
            let row = |i: usize| match block.get("basis").and_then(|g| g.values.get(i)) {
                Some((Value::Vector4(row), _)) => row.to_array(),
                _ => unreachable!("checked to be four 4-vectors"),
            };
            Basis::Matrix(std::array::from_fn(row))
        }
    }
}

/// The bases with a name.
pub const BASES: [(&str, Basis); 5] = [
    ("bezier", Basis::Bezier),
    ("bspline", Basis::BSpline),
    ("hermite", Basis::Hermite),
    ("catmull_rom", Basis::CatmullRom),
    ("monomial", Basis::Monomial),
];

/// The basis of a name.
pub fn named_basis(name: &str) -> Option<Basis> {
    BASES.iter().find(|(n, _)| *n == name).map(|(_, basis)| *basis)
}
