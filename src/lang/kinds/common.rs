//! The properties that every object has, and the transforms that objects, lights and patterns share.

use super::read;
use crate::diag::{Code, Diagnostic};
use crate::lang::table::{Context, Outcome, Property, Role, Type};
use crate::lang::value::{Given, Value};
use crate::math::Affine;
use crate::scene::Object;
use glam::{DMat3, DVec3};

/// The transforms, applied in the order written.
pub static TRANSFORMS: &[Property] = &[
    Property::new("translate", &[&[Type::Vector3]], "", "moves by this vector").repeats(),
    Property::new(
        "rotate",
        &[&[Type::Vector3], &[Type::Direction, Type::NUMBER]],
        "",
        "turns by degrees about x, then y, then z; or about an axis through the origin by degrees, counterclockwise \
         seen against the axis",
    )
    .repeats(),
    Property::new(
        "scale",
        &[&[Type::Factor], &[Type::Factors]],
        "",
        "multiplies lengths from the origin, by one factor or one for each axis; no factor may be 0",
    )
    .repeats(),
    Property::new(
        "shear",
        &[&[Type::Direction, Type::Direction, Type::NUMBER]],
        "",
        "`shear along, across, k`: moves each point along the first direction by k for each unit that it lies along \
         the second",
    )
    .repeats(),
    Property::new(
        "matrix",
        &[
            &[Type::Transform],
            &[Type::Vector3, Type::Vector3, Type::Vector3, Type::Vector3],
            &[Type::NUMBER; 12],
        ],
        "",
        "a transform; or the images of x, y and z, then the translation, as 4 vectors or 12 numbers",
    )
    .repeats(),
];

/// What every object takes beside transforms.
pub static OBJECT: &[Property] = &[
    Property::new(
        "material",
        &[&[Type::Material]],
        "",
        "what its surface is made of; without one it takes its group's, and white plaster in the end",
    ),
    Property::new("name", &[&[Type::Text]], "", "a name for `ogee inspect` and for messages"),
    Property::new(
        "hide",
        &[&[HIDE], &[HIDE, HIDE], &[HIDE, HIDE, HIDE]],
        "",
        "the rays that pass through it: those of the camera, of shadows, of reflection and refraction",
    ),
];

const HIDE: Type = Type::Word(&["camera", "shadow", "reflection"]);

/// The properties that a role adds to a kind's own.
pub fn of_role(role: Role) -> impl Iterator<Item = &'static Property> {
    let (transforms, object): (&'static [Property], &'static [Property]) = match role {
        Role::Object => (TRANSFORMS, OBJECT),
        Role::Light => (TRANSFORMS, &[]),
        Role::Value | Role::Setting | Role::Part => (&[], &[]),
    };
    transforms.iter().chain(object)
}

/// Applies the common properties to an object, in the order written: transforms after those that it has, the rest in place
/// of what it has.
pub fn apply_to_object(ctx: &mut dyn Context, object: &mut Object, given: &[Given]) -> Outcome<()> {
    if let Some(transform) = transform_of(ctx, given)? {
        object.transform_by(&transform);
    }
    for g in given {
        match &*g.name {
            "material" => object.material = Some(read::material_of(&g.values[0].0)),
            "name" => object.name = Some(read::text_of(&g.values[0].0).into()),
            "hide" => g.values.iter().for_each(|(word, _)| match read::word_of(word) {
                "camera" => object.hide.camera = true,
                "shadow" => object.hide.shadow = true,
                _ => object.hide.reflection = true,
            }),
            _ => {}
        }
    }
    Ok(())
}

/// The transforms among some properties as one map, the first applied first; none where there is none.
pub fn transform_of(ctx: &mut dyn Context, given: &[Given]) -> Outcome<Option<Affine>> {
    let mut whole: Option<Affine> = None;
    let mut outcome = Ok(());
    for g in given {
        match one_transform(ctx, g) {
            Ok(None) => {}
            Ok(Some(next)) => whole = Some(whole.map_or(next, |before| before.then(&next))),
            Err(reported) => outcome = Err(reported),
        }
    }
    outcome?;
    if whole.is_none() {
        return Ok(None);
    }
    let finite = |a: &Affine| {
        a.linear.is_finite()
            && a.translation.is_finite()
            && a.inverse_linear.is_finite()
            && a.inverse_translation.is_finite()
    };
    if let (Some(affine), Some(first)) = (&whole, given.iter().find(|g| is_transform(&g.name)))
        && !finite(affine)
    {
        let said = Diagnostic::new(
            Code::NotFinite,
            first.name_span,
            "these transforms together are beyond the range of numbers",
        )
        .hint("use factors nearer to 1; f64 ends near 1e308");
        return Err(ctx.fail(said));
    }
    Ok(whole)
}

/// Whether this is the name of a transform.
pub fn is_transform(name: &str) -> bool {
    TRANSFORMS.iter().any(|p| p.name == name)
}

fn one_transform(ctx: &mut dyn Context, g: &Given) -> Outcome<Option<Affine>> {
    let value = |i: usize| &g.values[i].0;
    let affine = match (&*g.name, g.values.len()) {
        ("translate", _) => Affine::translate(read::vector_of(value(0))),
        ("rotate", 1) => Affine::rotate_xyz(read::vector_of(value(0))),
        ("rotate", _) => Affine::rotate(read::vector_of(value(0)), read::number_of(value(1))),
        ("scale", _) => Affine::scale(factors(value(0))),
        ("shear", _) => return shear(ctx, g).map(Some),
        ("matrix", _) => return matrix(ctx, g).map(Some),
        _ => return Ok(None),
    };
    Ok(Some(affine))
}

fn factors(value: &Value) -> DVec3 {
    match value {
        Value::Number(s) => DVec3::splat(*s),
        other => read::vector_of(other),
    }
}

/// p ↦ p + k (p·across) along, with both directions of unit length. Singular where 1 + k along·across is 0.
fn shear(ctx: &mut dyn Context, g: &Given) -> Outcome<Affine> {
    let (along, across) = (read::vector_of(&g.values[0].0), read::vector_of(&g.values[1].0));
    let k = read::number_of(&g.values[2].0);
    let column = |e: DVec3| e + along * (k * across.dot(e));
    let linear = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
    Affine::from_columns(linear, DVec3::ZERO).ok_or_else(|| singular(ctx, g, "`shear` flattens all of space"))
}

fn matrix(ctx: &mut dyn Context, g: &Given) -> Outcome<Affine> {
    let rows: Vec<DVec3> = match g.values.len() {
        1 => return Ok(read::transform_of(&g.values[0].0)),
        4 => g.values.iter().map(|(v, _)| read::vector_of(v)).collect(),
        _ => {
            let numbers: Vec<f64> = g.values.iter().map(|(v, _)| read::number_of(v)).collect();
            numbers.chunks_exact(3).map(DVec3::from_slice).collect()
        }
    };
    Affine::from_columns(DMat3::from_cols(rows[0], rows[1], rows[2]), rows[3])
        .ok_or_else(|| singular(ctx, g, "`matrix` is singular: it flattens space"))
}

fn singular(ctx: &mut dyn Context, g: &Given, message: &str) -> crate::lang::table::Reported {
    let span = g.values.first().map_or(g.name_span, |(_, first)| first.to(g.span()));
    ctx.fail(
        Diagnostic::new(Code::BadProperty, span, message)
            .label("the images of x, y and z lie in one plane")
            .hint("each of the three images must leave the plane of the other two"),
    )
}
