//! The kinds `tube`, `lathe` and `extrude`: surfaces along curves. Their faults are looked for here, where they can be pointed at; the kernels
//! are made when a picture needs them.

use crate::diag::{Code, Diagnostic};
use crate::geometry::any_curve::AnyCurve;
use crate::geometry::function::FunctionPath;
use crate::geometry::measured::Measured;
use crate::geometry::path::Path;
use crate::geometry::surface::cubic::of_measured;
use crate::geometry::surface::lathe::{Lathe, LatheError};
use crate::geometry::surface::outline::{Outline, OutlineError};
use crate::geometry::surface::sweep::{self, SweepError};
use crate::geometry::surface::tube::{Caps, Tube, TubeError};
use crate::lang::coerce::{number, shown};
use crate::lang::kinds::shapes::finish;
use crate::lang::table::{Block, Context, CurveOf, Kind, Outcome, Property, Role, Type};
use crate::lang::value::Value;
use crate::scene::{Along, ExtrudeSource, LatheSource, Radius, Shape, Surface, TubeSource};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A tube.
pub static TUBE: Kind = Kind {
    name: "tube",
    doc: "What a ball fills as it rolls along a curve, solid: round, without a flaw at bends however tight. (u, v): u goes round from the side of \
          the curve's frame, v along by length.",
    example: "tube { along spline { catmull_rom <0, 0, 0>, <1, 1, 0>, <2, 0, 0>, <3, 1, 0> }  radius 0.1 }",
    role: Role::Object,
    own: &[
        Property::new("along", &[&[Type::Curve(CurveOf::Space)]], "", "the curve of its centre").required(),
        Property::new(
            "radius",
            &[&[Type::Positive], &[Type::Curve(CurveOf::Numbers)], &[Type::Function]],
            "1",
            "the ball's radius, in scene units: a number, a curve of numbers that runs along with the centre's, or a function of the \
             centre's parameter; 0 at places, never below",
        ),
        Property::new(
            "caps",
            &[&[Type::Word(&["round", "flat", "open"])]],
            "round",
            "how it ends where its curve is not closed: by the ball, by the plane across the curve, or not at all (then it is no solid)",
        ),
    ],
    children: false,
    open: false,
    build: Some(tube),
};

/// A surface of revolution.
pub static LATHE: Kind = Kind {
    name: "lathe",
    doc: "A profile turned about the y axis. It is solid where the profile is closed, or begins and ends on the axis; any other profile makes a \
          surface with two sides, open where it ends. (u, v): u goes round from x toward −z, v along the profile by length.",
    example: "lathe { profile spline { bezier <0, 0>, <1, 0>, <1, 1>, <0.3, 1.2>, <0.2, 1.3>, <0.2, 1.8>, <0, 2> } }",
    role: Role::Object,
    own: &[
        Property::new(
            "profile",
            &[&[Type::Curve(CurveOf::Plane)]],
            "",
            "a curve of 2-vectors: distance from the y axis, never below 0, and height",
        )
        .required(),
        Property::new(
            "angle",
            &[&[Type::Number { min: 0.0, max: 360.0 }]],
            "360",
            "how far it goes round, in degrees above 0; a solid has flat faces at both ends",
        ),
    ],
    children: false,
    open: false,
    build: Some(lathe),
};

/// A prism along a vector or a path.
pub static EXTRUDE: Kind = Kind {
    name: "extrude",
    doc: "A closed outline moved along a vector or a path, solid, with flat faces at its ends. The outline stands across the way, its y nearest to \
          the y axis (along y itself: as seen from above, with x to the right); a path carries it by its own frame. What an outline goes \
          round twice is a hole. (u, v): u along the outline, v along the way; on flat faces the outline's own x and y.",
    example: "extrude { outline spline { bspline <1, 0>, <0, 1>, <-1, 0>, <0, -1>  closed }  along <0, 1, 0> }",
    role: Role::Object,
    own: &[
        Property::new("outline", &[&[Type::Curve(CurveOf::Plane)]], "", "a closed curve of 2-vectors").required(),
        Property::new(
            "along",
            &[&[Type::Vector3], &[Type::Curve(CurveOf::Space)]],
            "",
            "a vector from its start to its end, not 0, or a curve without corners; along a curve its sides are true to a millionth of its size",
        )
        .required(),
    ],
    children: false,
    open: false,
    build: Some(extrude),
};

/// The checked curve of 3-vectors.
fn space(block: &Block, name: &str) -> Option<Arc<Measured<DVec3>>> {
    match block.value(name)? {
        Value::Curve(AnyCurve::Space(curve)) => Some(Arc::clone(curve)),
        _ => None,
    }
}

/// The checked curve of 2-vectors.
fn plane(block: &Block, name: &str) -> Arc<Measured<DVec2>> {
    match block.curve(name) {
        Some(AnyCurve::Plane(curve)) => Arc::clone(curve),
        _ => unreachable!("checked to be a curve of 2-vectors"),
    }
}

fn tube(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let along = space(block, "along").expect("checked to be a curve of 3-vectors");
    let radius = radius(ctx, block, along.domain())?;
    let caps = match block.word("caps") {
        Some("flat") => Caps::Flat,
        Some("open") => Caps::Open,
        _ => Caps::Round,
    };
    if let Err(error) = Tube::check(&of_measured(&along), &radius.pieces()) {
        let hint = match error {
            TubeError::Negative { .. } => {
                "keep it at 0 or above: `max(…, 0)` in a function, or other points of the curve"
            }
            TubeError::Thin => "give it a radius above 0 somewhere",
            TubeError::NotFinite => "keep coordinates and radii below 1e150",
        };
        return Err(block.fault(
            ctx,
            Code::BadGeometry,
            "radius",
            format!("this tube cannot be made: {error}"),
            hint,
        ));
    }
    finish(ctx, block, Shape::Surface(Arc::new(Surface::Tube(TubeSource { along, radius, caps }))))
}

fn radius(ctx: &mut dyn Context, block: &Block, (start, end): (f64, f64)) -> Outcome<Radius> {
    match block.value("radius") {
        None => Ok(Radius::Constant(1.0)),
        Some(Value::Number(radius)) => Ok(Radius::Constant(*radius)),
        Some(Value::Curve(AnyCurve::Numbers(curve))) => Ok(Radius::Along(Arc::clone(curve))),
        Some(function) => {
            let (function, span) = (function.clone(), block.place("radius"));
            let fit =
                FunctionPath::fit(start, end, |t| match ctx.call(&function, &[Value::Number(t)], span)? {
                    Value::Number(x) if x.is_finite() => Ok(x),
                    other => {
                        let message = format!(
                            "a tube's radius is a number, and at {} this is {}",
                            number(t),
                            shown(&other)
                        );
                        Err(ctx.fail(Diagnostic::new(Code::TypeMismatch, span, message)))
                    }
                });
            Ok(Radius::Along(Arc::new(fit?.into())))
        }
    }
}

fn lathe(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let (profile, angle) = (plane(block, "profile"), block.number("angle").unwrap_or(360.0));
    if angle == 0.0 {
        let hint = "leave `angle` away to go all the way round";
        return Err(block.fault(
            ctx,
            Code::BadGeometry,
            "angle",
            "a lathe that turns by 0 degrees has no surface",
            hint,
        ));
    }
    if let Err(error) = Lathe::check(&of_measured(&profile)) {
        let hint = match error {
            LatheError::Negative { .. } => {
                "x is the distance from the axis: keep the curve, not only its points, at x of 0 or above"
            }
            LatheError::Thin => "move it away from the axis",
            LatheError::NotFinite => "keep coordinates below 1e150",
        };
        let message = format!("this lathe cannot be made: {error}");
        return Err(block.fault(ctx, Code::BadGeometry, "profile", message, hint));
    }
    finish(ctx, block, Shape::Surface(Arc::new(Surface::Lathe(LatheSource { profile, angle }))))
}

fn extrude(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let outline = plane(block, "outline");
    if let Err(error) = Outline::new(of_measured(&outline)) {
        let hint = match error {
            OutlineError::Open { .. } => "add `closed` to the spline, or end it where it starts",
            OutlineError::Flat => "its points lie in one line: move some of them aside",
            OutlineError::NotFinite => "keep coordinates below 1e150",
        };
        let message = format!("this extrude cannot be made: {error}");
        return Err(block.fault(ctx, Code::BadGeometry, "outline", message, hint));
    }
    let along = match space(block, "along") {
        Some(path) => way(ctx, block, path)?,
        None => Along::Vector(block.vector("along").expect("required")),
    };
    if let Along::Vector(DVec3::ZERO) = along {
        let hint = "write where it goes, as in `along <0, 1, 0>`";
        return Err(block.fault(
            ctx,
            Code::BadGeometry,
            "along",
            "an extrude along the zero vector has no height",
            hint,
        ));
    }
    finish(ctx, block, Shape::Surface(Arc::new(Surface::Extrude(ExtrudeSource { outline, along }))))
}

fn way(ctx: &mut dyn Context, block: &Block, path: Arc<Measured<DVec3>>) -> Outcome<Along> {
    let Err(error) = sweep::check(path.path()) else { return Ok(Along::Path(path)) };
    let hint = match error {
        SweepError::Corner { .. } => {
            "round it, as a `bspline` or `catmull_rom` does, or extrude each side by itself"
        }
        SweepError::Still => "its points are all the same: move some of them",
    };
    Err(block.fault(ctx, Code::BadGeometry, "along", format!("this extrude cannot be made: {error}"), hint))
}
