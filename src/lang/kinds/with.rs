//! `e with { … }`: a copy of an object, light, material, pattern or camera with the items applied to it. Transforms come
//! after those that are there; everything else replaces what was there, and what is not named stays as it is.
//!
//! A copy with other properties of its kind is made by taking the value apart into the properties that would build it, and
//! building it again with the new ones, so that every check of a block holds for its copies too.

mod apart;
mod bending;

use super::{common, shapes};
use crate::diag::{Code, Diagnostic, Span};
use crate::lang::builtins::patterns;
use crate::lang::check;
use crate::lang::coerce;
use crate::lang::table::{Block, Context, Kind, Outcome, Role};
use crate::lang::value::{Given, Value};
use crate::scene::{Light, LightSource, MeshSource, Node, Object, Pattern, Shape, Sky};
use std::sync::Arc;

/// What a pattern takes: transforms alone. No block of the language, so it stands in no table.
static PATTERN: Kind = Kind {
    name: "pattern",
    doc: "A rule that gives a colour at each point.",
    example: "checker(white, black) with { scale 2 }",
    role: Role::Light,
    own: &[],
    children: false,
    open: false,
    build: None,
};

/// Applies items to a copy of a value. `children` are what the items placed (a group takes them); `span` is the whole
/// expression's.
pub fn apply(
    ctx: &mut dyn Context,
    base: Value,
    base_span: Span,
    given: Vec<Given>,
    children: Vec<Node>,
    span: Span,
) -> Outcome {
    let place = Place { base: base_span, whole: span };
    match &base {
        Value::Object(object) => to_object(ctx, object, place, given, children),
        _ if !children.is_empty() => {
            let message = format!("nothing can be placed inside {}", coerce::shown(&base));
            let said = Diagnostic::new(Code::NotPlaceable, base_span, message)
                .hint("place objects in a `group { … }`");
            Err(ctx.fail(said))
        }
        Value::Light(light) => to_light(ctx, light, place, given),
        Value::Material(material) => {
            rebuild(ctx, &super::materials::MATERIAL, apart::material(material), place, given)
        }
        Value::Camera(camera) => {
            let rebuilt = rebuild(ctx, &super::settings::CAMERA, apart::camera(camera), place, given)?;
            Ok(relabelled(rebuilt, camera.label.as_deref()))
        }
        Value::Pattern(pattern) => to_pattern(ctx, pattern, place, given),
        Value::Builtin(builtin) if patterns::of_builtin(builtin, None).is_some() => {
            let pattern = patterns::of_builtin(builtin, Some(base_span)).expect("just looked up");
            to_pattern(ctx, &pattern, place, given)
        }
        Value::Function(_) => {
            let mut value = base.clone();
            check::coerce_or_report(ctx, "", &[crate::lang::table::Type::Texture], &mut value, base_span)?;
            apply(ctx, value, base_span, given, children, span)
        }
        _ => Err(ctx.fail(cannot_change(&base, base_span))),
    }
}

fn cannot_change(base: &Value, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::TypeMismatch,
        span,
        format!(
            "`with` changes an object, light, material, pattern or camera, and this is {}",
            coerce::shown(base)
        ),
    )
    .hint(match base {
        Value::Skeleton(_) | Value::Pose(_) => {
            "pose it instead: `pose bent { of arm  elbow 40 }`, of a skeleton or of a pose"
        }
        _ => "for a list write `[e with { … } for e in list]`",
    })
}

/// Where a `with` stands: its base, and all of it.
#[derive(Clone, Copy)]
struct Place {
    base: Span,
    whole: Span,
}

/// A camera's copy keeps its label.
fn relabelled(value: Value, label: Option<&str>) -> Value {
    match value {
        Value::Camera(camera) => {
            let mut camera = (*camera).clone();
            camera.label = label.map(Into::into);
            Value::Camera(Arc::new(camera))
        }
        other => other,
    }
}

/// Builds again what was taken apart, with new properties in place of those of the same name.
fn rebuild(
    ctx: &mut dyn Context,
    kind: &'static Kind,
    parts: Vec<(&'static str, Vec<Value>)>,
    place: Place,
    given: Vec<Given>,
) -> Outcome {
    let old = parts.into_iter().filter(|(name, _)| !given.iter().any(|g| &*g.name == *name)).map(
        |(name, values)| Given {
            name: name.into(),
            name_span: place.base,
            property: kind.property(name),
            values: values.into_iter().map(|value| (value, place.base)).collect(),
        },
    );
    let mut block = Block {
        kind,
        span: place.whole,
        kind_span: place.base,
        label: None,
        given: old.collect::<Vec<_>>().into_iter().chain(given).collect(),
        children: Vec::new(),
        poisoned: Vec::new(),
    };
    super::make(ctx, &mut block)
}

fn to_object(
    ctx: &mut dyn Context,
    object: &Arc<Object>,
    place: Place,
    mut given: Vec<Given>,
    children: Vec<Node>,
) -> Outcome {
    let kind = apart::kind_of(&object.shape, |name| given.iter().any(|g| &*g.name == name));
    if !children.is_empty() && !kind.children {
        let message = format!("nothing can be placed inside a `{}`", kind.name);
        let said =
            Diagnostic::new(Code::NotPlaceable, place.base, message).hint("place both in a `group { … }`");
        return Err(ctx.fail(said));
    }
    let is_own = |g: &Given| kind.own.iter().any(|p| p.name == &*g.name);
    let mut copy = (**object).clone();
    copy.span = place.whole;
    if given.iter().any(is_own) {
        let (own, rest): (Vec<Given>, Vec<Given>) = given.into_iter().partition(is_own);
        given = rest;
        copy.shape = own_changed(ctx, kind, &object.shape, place, own, &mut given)?;
    } else {
        check::check_given(ctx, kind, &mut given)?;
    }
    if let Shape::Csg(_) = &copy.shape
        && !children.is_empty()
    {
        copy.shape = super::solids::with_more(ctx, &copy.shape, children)?;
    } else if let (false, Shape::Group(nodes)) = (children.is_empty(), &copy.shape) {
        copy.shape = Shape::Group(nodes.iter().cloned().chain(children).collect());
    }
    common::apply_to_object(ctx, &mut copy, &given)?;
    Ok(Value::Object(Arc::new(copy)))
}

/// The shape with some of its own properties changed. The others are checked too, so that all faults are said.
fn own_changed(
    ctx: &mut dyn Context,
    kind: &'static Kind,
    shape: &Shape,
    place: Place,
    own: Vec<Given>,
    rest: &mut [Given],
) -> Outcome<Shape> {
    let checked = check::check_given(ctx, kind, rest);
    if let Shape::Csg(_) = shape {
        let mut own = own;
        check::check_given(ctx, kind, &mut own)?;
        checked?;
        return Ok(own.iter().fold(shape.clone(), |shape, given| super::solids::with_inverse(&shape, given)));
    }
    if let Some(smoothed) = smoothed(ctx, kind, shape, &own) {
        checked?;
        return smoothed;
    }
    if let Some(bent) = bending::changed(ctx, kind, shape, place, &own) {
        checked?;
        return bent;
    }
    let Some(parts) = apart::shape(shape, &own) else {
        let said = Diagnostic::new(
            Code::BadProperty,
            own.first().map_or(place.base, |g| g.name_span),
            format!("the geometry of this `{}` cannot be changed by `with`", kind.name),
        )
        .hint("write a new block with the other geometry");
        return Err(ctx.fail(said));
    };
    let rebuilt = rebuild(ctx, kind, parts, place, own);
    checked?;
    match rebuilt? {
        Value::Object(object) => Ok(object.shape.clone()),
        _ => unreachable!("an object's kind builds objects"),
    }
}

/// A mesh of a file with nothing but `smooth` changed.
fn smoothed(
    ctx: &mut dyn Context,
    kind: &'static Kind,
    shape: &Shape,
    own: &[Given],
) -> Option<Outcome<Shape>> {
    let Shape::Mesh(source) = shape else { return None };
    let (MeshSource::File { path, span, .. }, [only]) = (&**source, own) else { return None };
    if &*only.name != "smooth" {
        return None;
    }
    let mut own = own.to_vec();
    if let Err(reported) = check::check_given(ctx, kind, &mut own) {
        return Some(Err(reported));
    }
    let smooth = !matches!(own[0].values.first(), Some((Value::Bool(false), _)));
    let source = MeshSource::File { path: path.clone(), smooth: Some(smooth), span: *span };
    Some(Ok(Shape::Mesh(Arc::new(source))))
}

fn to_light(ctx: &mut dyn Context, light: &Light, place: Place, mut given: Vec<Given>) -> Outcome {
    let has_own = given.iter().any(|g| !common::is_transform(&g.name));
    if has_own {
        let new_sky = given.iter().any(|g| &*g.name == "sky");
        let rebuilt = rebuild(ctx, &super::lights::LIGHT, apart::light(light, &given), place, given)?;
        let Value::Light(changed) = &rebuilt else { return Ok(rebuilt) };
        let mut changed = (**changed).clone();
        changed.transform = shapes::after(light.transform.as_deref(), changed.transform.map(|t| *t));
        if !new_sky {
            keep_picture(&mut changed.source, &light.source);
        }
        return Ok(Value::Light(Arc::new(changed)));
    }
    check::check_given(ctx, &super::lights::LIGHT, &mut given)?;
    let mut copy = light.clone();
    copy.span = place.whole;
    copy.transform = shapes::after(light.transform.as_deref(), common::transform_of(ctx, &given)?);
    Ok(Value::Light(Arc::new(copy)))
}

/// Puts the picture of a sky back where an even sky stands for it.
fn keep_picture(changed: &mut LightSource, before: &LightSource) {
    if let (LightSource::Sky(changed), LightSource::Sky(Sky::Image { path, span, picture, .. })) =
        (changed, before)
        && let Sky::Uniform(factor) = *changed
    {
        *changed = Sky::Image { path: path.clone(), factor, span: *span, picture: picture.clone() };
    }
}

fn to_pattern(ctx: &mut dyn Context, pattern: &Pattern, place: Place, mut given: Vec<Given>) -> Outcome {
    check::check_given(ctx, &PATTERN, &mut given)?;
    let mut copy = pattern.clone();
    copy.span = place.whole;
    copy.transform = shapes::after(pattern.transform.as_deref(), common::transform_of(ctx, &given)?);
    Ok(Value::Pattern(Arc::new(copy)))
}
