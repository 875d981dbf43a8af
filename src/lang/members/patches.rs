//! The members of patches. The kernels of [`crate::geometry::patch`] compute; here are names, documentation and the wording of faults.
//! A patch is asked as it stands: after the transforms of its own block.

use super::{Ask, Family, Form, Member};
use crate::diag::{Code, Diagnostic};
use crate::geometry::patch::{Bicubic, Patch, PatchError, bpt};
use crate::lang::coerce::number;
use crate::lang::table::{Context, Outcome, Parameter, Reported};
use crate::lang::value::{Record, Value};
use crate::scene::{Object, PatchNet, PatchSource, Shape, Surface};
use glam::DVec3;
use std::borrow::Cow;
use std::rc::Rc;
use std::sync::Arc;

const UV: &[Parameter] = &[Parameter::new("u", "a number"), Parameter::new("v", "a number")];

/// Patches.
pub static FAMILY: Family = Family {
    name: "patch",
    doc: "A function of (u, v), both from 0 to 1, with what geometry knows of it; all as it stands after the transforms of its own block. Patches \
          of a file have a (u, v) each: ask one of its `pieces`.",
    holds: |value| source(value).is_some(),
    scene: "let s = patch { bezier [<floor(k / 4), k % 4, 0> for k in 0..16] }\n\
            let bowl = patch { bezier <-1, -1, 2>, <-1, -1/3, 2/3>, <-1, 1/3, 2/3>, <-1, 1, 2>, \
            <-1/3, -1, 2/3>, <-1/3, -1/3, -2/3>, <-1/3, 1/3, -2/3>, <-1/3, 1, 2/3>, \
            <1/3, -1, 2/3>, <1/3, -1/3, -2/3>, <1/3, 1/3, -2/3>, <1/3, 1, 2/3>, \
            <1, -1, 2>, <1, -1/3, 2/3>, <1, 1/3, 2/3>, <1, 1, 2> }",
    members: MEMBERS,
    named: None,
};

static MEMBERS: &[Member] = &[
    Member {
        name: "",
        form: Form::Call,
        parameters: UV,
        doc: "The point at (u, v). Exact to half a unit in the last place of the patch's own coordinates.",
        example: ("s(0.5, 0.25)", "<1.5, 0.75, 0>"),
        body: at,
        sampled: None,
    },
    Member::method(
        "du",
        UV,
        "The derivative by u at (u, v), in scene units.",
        ("s.du(0.5, 0.5)", "<3, 0, 0>"),
        du,
    ),
    Member::method(
        "dv",
        UV,
        "The derivative by v at (u, v), in scene units.",
        ("s.dv(0.5, 0.5)", "<0, 3, 0>"),
        dv,
    ),
    Member::method(
        "normal",
        UV,
        "The unit vector along `du` × `dv`; where these vanish, as at an edge that is one point, the limit from inside.",
        ("s.normal(0.5, 0.5)", "<0, 0, 1>"),
        normal,
    ),
    Member::method(
        "curvature",
        UV,
        "How it bends at (u, v), seen from the side of its normal: `.gaussian`, per square scene unit, `.mean`, and the two principal \
         curvatures `.most` and `.least`.",
        ("s.curvature(0.5, 0.5).gaussian", "0"),
        curvature,
    ),
    Member::method(
        "split",
        UV,
        "The four patches around (u, v) of a patch of 16 points: lower u and lower v, lower u and upper v, upper and lower, upper and upper.",
        ("s.split(0.5, 0.5)[3](0, 1)", "<1.5, 3, 0>"),
        split,
    ),
    Member::field(
        "points",
        "Its Bézier points, row by row; those of a file sixteen each.",
        ("s.points[5]", "<1, 1, 0>"),
        points,
    ),
    Member::field(
        "pieces",
        "The list of its bicubic pieces, each a patch of its own, row by row or in the order of the file.",
        ("len(s.pieces)", "1"),
        pieces,
    ),
];

/// A patch among objects.
fn source(value: &Value) -> Option<(&Object, &PatchSource)> {
    let Value::Object(object) = value else { return None };
    let Shape::Surface(surface) = &object.shape else { return None };
    match &**surface {
        Surface::Patch(patch) => Some((object, patch)),
        Surface::Tube(_) | Surface::Lathe(_) | Surface::Extrude(_) => None,
    }
}

/// The patch that is asked, in its own space, its file read.
fn own<'a>(ctx: &mut dyn Context, ask: &'a Ask<'_>) -> Outcome<Cow<'a, Patch>> {
    let (_, source) = source(ask.value).expect("of this family");
    let (path, span) = match &source.net {
        PatchNet::Inline(patch) => return Ok(Cow::Borrowed(patch)),
        PatchNet::File { path, span } => (path, *span),
    };
    let refused = |why: String| {
        let message = format!("the patch file `{}` cannot be used: {why}", path.display());
        Diagnostic::new(Code::BadPatch, span, message).also(ask.arguments.span, "it is asked here")
    };
    let read = ctx.loader().read(path);
    let text = read.map_err(|e| e.to_string()).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    match text.and_then(|text| bpt::parse(&text).map_err(|e| e.to_string())) {
        Ok(pieces) => Ok(Cow::Owned(Patch::loose(pieces))),
        Err(why) => Err(ctx.fail(refused(why))),
    }
}

/// The patch that is asked, where it stands.
fn placed<'a>(ctx: &mut dyn Context, ask: &'a Ask<'_>) -> Outcome<Cow<'a, Patch>> {
    let patch = own(ctx, ask)?;
    let (object, _) = source(ask.value).expect("of this family");
    Ok(match &object.transform {
        None => patch,
        Some(transform) => Cow::Owned(patch.map(|p| transform.point(p))),
    })
}

/// What the kernel says at (u, v), or its fault.
fn asked<T>(
    ctx: &mut dyn Context,
    ask: &Ask<'_>,
    kernel: impl Fn(&Patch, f64, f64) -> Result<T, PatchError>,
) -> Outcome<T> {
    let (u, v) = (ask.number(ctx, 0)?, ask.number(ctx, 1)?);
    let patch = placed(ctx, ask)?;
    kernel(&patch, u, v).map_err(|error| report(ctx, ask, &error))
}

#[cold]
fn report(ctx: &mut dyn Context, ask: &Ask<'_>, error: &PatchError) -> Reported {
    let said = match error {
        PatchError::OutsideDomain { u, v } => {
            let inside = |x: &f64| (0.0..=1.0).contains(x);
            let place = ask.place(usize::from(inside(u)));
            let message =
                format!("<{}, {}> is outside the patch: u and v run from 0 to 1", number(*u), number(*v));
            Diagnostic::new(Code::Undefined, place, message).hint("cut it: `clamp(u, 0, 1)`")
        }
        PatchError::Loose { n_pieces } => {
            let message = format!("{} is of one patch, and this has {n_pieces} pieces", ask.name());
            Diagnostic::new(Code::Undefined, ask.arguments.span, message)
                .hint("ask one of them, as `….pieces[0]`")
        }
        other => Diagnostic::new(Code::Undefined, ask.arguments.span, other.to_string()),
    };
    ctx.fail(said)
}

/// Reports that a direction or curvature does not exist.
#[cold]
fn undefined(ctx: &mut dyn Context, ask: &Ask<'_>) -> Reported {
    let message = format!("{} does not exist there: the patch has no area around that point", ask.name());
    ctx.fail(Diagnostic::new(Code::Undefined, ask.arguments.span, message))
}

fn at(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    // The point first and then the transform, as rays see it.
    let (u, v) = (ask.number(ctx, 0)?, ask.number(ctx, 1)?);
    let (object, _) = source(ask.value).expect("of this family");
    match own(ctx, ask)?.at(u, v) {
        Ok(point) => Ok(Value::Vector3(object.transform.as_deref().map_or(point, |t| t.point(point)))),
        Err(error) => Err(report(ctx, ask, &error)),
    }
}

fn du(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    Ok(Value::Vector3(asked(ctx, ask, Patch::jet)?.du))
}

fn dv(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    Ok(Value::Vector3(asked(ctx, ask, Patch::jet)?.dv))
}

fn normal(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    asked(ctx, ask, Patch::normal)?.map(Value::Vector3).ok_or_else(|| undefined(ctx, ask))
}

fn curvature(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let Some(found) = asked(ctx, ask, Patch::curvature)? else { return Err(undefined(ctx, ask)) };
    let [most, least] = found.principal();
    let numbers = [("gaussian", found.gaussian), ("mean", found.mean), ("most", most), ("least", least)];
    let parts = numbers.into_iter().map(|(name, x)| (name, Value::Number(x))).collect();
    Ok(Value::Record(Rc::new(Record { name: "a patch's curvature", parts })))
}

/// A patch of the same make with other control points, which are where they stand.
fn shared(ask: &Ask<'_>, patch: Patch) -> Value {
    let (object, source) = source(ask.value).expect("of this family");
    let mut part = object.clone();
    part.transform = None;
    let source = PatchSource { net: PatchNet::Inline(patch), ..source.clone() };
    part.shape = Shape::Surface(Arc::new(Surface::Patch(source)));
    Value::Object(Arc::new(part))
}

fn split(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let parts = asked(ctx, ask, Patch::split)?;
    Ok(Value::list(parts.into_iter().map(|part| shared(ask, part)).collect()))
}

fn points(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let points: Vec<DVec3> = placed(ctx, ask)?.points();
    ctx.reserve(points.len(), ask.arguments.span)?;
    Ok(Value::list(points.into_iter().map(Value::Vector3).collect()))
}

fn pieces(ctx: &mut dyn Context, ask: &Ask<'_>) -> Outcome {
    let pieces: Vec<Bicubic> = placed(ctx, ask)?.pieces().to_vec();
    ctx.reserve(pieces.len(), ask.arguments.span)?;
    let part = |piece| shared(ask, Patch::loose(vec![piece]));
    Ok(Value::list(pieces.into_iter().map(part).collect()))
}
