//! Lights: a source, its strength in the unit that fits it, and how it falls off.

use super::{common, existing_file, shapes::conflict};
use crate::diag::{Code, Diagnostic};
use crate::lang::coerce;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Reported, Role, Type};
use crate::lang::value::Value;
use crate::scene::assets::image::Picture;
use crate::scene::{Light, LightSource, Object, Rgb, Shape, Sky};
use std::sync::Arc;

/// A light.
pub static LIGHT: Kind = Kind {
    name: "light",
    doc: "A source of light: exactly one of `point`, `spot`, `sun`, `area` and `sky`, with the strength that belongs to it. \
          Takes transforms.",
    example: "light { point <4, 6, 3>  intensity 60 }",
    role: Role::Light,
    own: &[
        Property::new(
            "point",
            &[&[Type::Vector3]],
            "",
            "shines from this point to all sides; strength: `intensity`",
        ),
        Property::new(
            "spot",
            &[&[Type::Vector3]],
            "",
            "shines from this point into a cone about `toward`; strength: `intensity`",
        ),
        Property::new(
            "sun",
            &[&[Type::Direction]],
            "",
            "parallel light that travels along this direction; strength: `irradiance`",
        ),
        Property::new(
            "area",
            &[&[Type::Object]],
            "",
            "shines from the surface of a `rect`, `disc`, `sphere`, `triangle` or `mesh` to the side of its normal, and \
             is seen; strength: `radiance`",
        ),
        Property::new(
            "sky",
            &[&[Type::Colour], &[Type::Text]],
            "",
            "shines from everywhere behind all else, with this radiance or that of an equirectangular picture (HDR, EXR), whose middle lies toward −z; `radiance` multiplies it",
        ),
        Property::new(
            "intensity",
            &[&[Type::Colour]],
            "1",
            "of a point or spot, in W/sr; a spot's on its axis",
        ),
        Property::new("irradiance", &[&[Type::Colour]], "1", "of a sun, in W/m² on a surface that faces it"),
        Property::new("radiance", &[&[Type::Colour]], "1", "of an area, in W/(m² sr); for a sky a factor"),
        Property::new(
            "toward",
            &[&[Type::Direction]],
            "",
            "the direction in which a spot shines (from the light away, not a point)",
        ),
        Property::new(
            "cone",
            &[&[ANGLE, ANGLE]],
            "30, 45",
            "a spot's half-angles in degrees from its axis: full light inside the first, none outside the second",
        ),
        Property::new(
            "falloff",
            &[&[Type::NON_NEGATIVE, Type::NON_NEGATIVE, Type::NON_NEGATIVE]],
            "1, 0, 0",
            "`a, b, c`: a point or spot falls off as 1/(a r² + b r + c) with the distance r; physics is 1, 0, 0",
        ),
        Property::new("shadow", &[&[], &[Type::Bool]], "on", "whether things cast shadows in its light"),
        Property::new(
            "samples",
            &[&[Type::Integer { min: 1 }]],
            "16",
            "stratified samples that whitted takes of an area or sky at the first hit; one after that",
        ),
    ],
    children: false,
    open: false,
    build: Some(light),
};

const ANGLE: Type = Type::Number { min: 0.0, max: 180.0 };

/// Samples of an area or sky light where none are given.
const DEFAULT_SAMPLES: u64 = 16;

/// The properties of which a light has exactly one.
pub const SOURCES: [&str; 5] = ["point", "spot", "sun", "area", "sky"];

/// The property of a source's strength, and the sources to which it belongs.
const STRENGTHS: [(&str, &[&str]); 3] =
    [("intensity", &["point", "spot"]), ("irradiance", &["sun"]), ("radiance", &["area", "sky"])];

fn light(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let source = the_source(ctx, block)?;
    check_belonging(ctx, block, source)?;
    let made = Light {
        source: make_source(ctx, block, source)?,
        falloff: falloff(ctx, block)?,
        shadow: block.flag("shadow").unwrap_or(true),
        samples: block.integer("samples").unwrap_or(DEFAULT_SAMPLES).min(u64::from(u32::MAX)) as u32,
        transform: common::transform_of(ctx, &block.given)?.map(Box::new),
        span: block.span,
    };
    Ok(Value::Light(Arc::new(made)))
}

fn the_source(ctx: &mut dyn Context, block: &Block) -> Outcome<&'static str> {
    let given: Vec<&'static str> = SOURCES.into_iter().filter(|name| block.has(name)).collect();
    match given[..] {
        [one] => Ok(one),
        [] => {
            let said = Diagnostic::new(
                Code::MissingProperty,
                block.kind_span,
                "`light` needs one of `point`, `spot`, `sun`, `area` or `sky`",
            )
            .hint("write for example `light { point <4, 6, 3>  intensity 60 }`");
            Err(ctx.fail(said))
        }
        [first, ..] => {
            let in_order = block.given.iter().filter(|g| SOURCES.contains(&&*g.name));
            let second = in_order.map(|g| &*g.name).nth(1).unwrap_or(first);
            let first = block.given.iter().map(|g| &*g.name).find(|n| SOURCES.contains(n)).unwrap_or(first);
            Err(conflict(ctx, block, first, second))
        }
    }
}

/// Says every property that belongs to another source.
fn check_belonging(ctx: &mut dyn Context, block: &Block, source: &str) -> Outcome<()> {
    const POINTS: &[&str] = &["point", "spot"];
    let others: [(&str, &[&str]); 3] = [("toward", &["spot"]), ("cone", &["spot"]), ("falloff", POINTS)];
    let mut outcome = Ok(());
    for (name, owners) in STRENGTHS.into_iter().chain(others) {
        if block.has(name) && !owners.contains(&source) {
            outcome = Err(misplaced(ctx, block, name, owners, source));
        }
    }
    outcome
}

fn misplaced(ctx: &mut dyn Context, block: &Block, name: &str, owners: &[&str], source: &str) -> Reported {
    let place = |name: &str| block.get(name).map_or(block.kind_span, |g| g.name_span);
    let owners: Vec<String> = owners.iter().map(|o| format!("`{o}`")).collect();
    let strength = STRENGTHS.iter().find(|(_, sources)| sources.contains(&source)).map_or("", |(n, _)| n);
    let said = Diagnostic::new(
        Code::ConflictingProperties,
        place(name),
        format!("`{name}` belongs to {} lights, and this is a `{source}`", coerce::listed(&owners, "and")),
    )
    .also(place(source), "the source is here");
    let is_strength = STRENGTHS.iter().any(|(n, _)| *n == name);
    ctx.fail(if is_strength {
        said.hint(format!("the strength of a `{source}` is its `{strength}`"))
    } else {
        said.hint(format!("leave `{name}` out"))
    })
}

fn make_source(ctx: &mut dyn Context, block: &Block, source: &str) -> Outcome<LightSource> {
    let strength = |name: &str| block.colour(name).unwrap_or(Rgb::ONE);
    let vector = |name: &str| block.vector(name).expect("the source that is given");
    Ok(match source {
        "point" => LightSource::Point { position: vector("point"), intensity: strength("intensity") },
        "spot" => LightSource::Spot {
            position: vector("spot"),
            direction: toward(ctx, block)?,
            cone: cone(ctx, block)?,
            intensity: strength("intensity"),
        },
        "sun" => LightSource::Sun { direction: vector("sun"), irradiance: strength("irradiance") },
        "area" => LightSource::Area { object: emitter(ctx, block)?, radiance: strength("radiance") },
        _ => LightSource::Sky(sky(ctx, block)?),
    })
}

fn toward(ctx: &mut dyn Context, block: &Block) -> Outcome<glam::DVec3> {
    block.vector("toward").ok_or_else(|| {
        let said = Diagnostic::new(Code::MissingProperty, block.kind_span, "a `spot` light lacks `toward`")
            .also(block.place("spot"), "the spot is here")
            .hint("add the direction in which it shines, for example `toward <0, -1, 0>`");
        ctx.fail(said)
    })
}

fn cone(ctx: &mut dyn Context, block: &Block) -> Outcome<[f64; 2]> {
    let Some(angles) = block.numbers("cone") else { return Ok([30.0, 45.0]) };
    if angles[0] <= angles[1] {
        return Ok([angles[0], angles[1]]);
    }
    let message = format!(
        "`cone` takes the inner angle first, and {} is above {}",
        coerce::number(angles[0]),
        coerce::number(angles[1])
    );
    let hint = format!("write `cone {}, {}`", coerce::number(angles[1]), coerce::number(angles[0]));
    Err(block.fault(ctx, Code::BadProperty, "cone", message, hint))
}

fn falloff(ctx: &mut dyn Context, block: &Block) -> Outcome<Option<[f64; 3]>> {
    let Some(c) = block.numbers("falloff") else { return Ok(None) };
    if c.iter().any(|x| *x > 0.0) {
        return Ok(Some([c[0], c[1], c[2]]));
    }
    let hint = "write `falloff 1, 0, 0` for the law of physics, `falloff 0, 0, 1` for none";
    Err(block.fault(ctx, Code::BadProperty, "falloff", "`falloff` of three zeros divides by 0", hint))
}

fn emitter(ctx: &mut dyn Context, block: &Block) -> Outcome<Arc<Object>> {
    let object = block.object("area").expect("the source that is given");
    match &object.shape {
        Shape::Sphere { .. } | Shape::Disc(_) | Shape::Rect(_) | Shape::Triangle(_) | Shape::Mesh(_) => {
            Ok(object)
        }
        // What is not built yet stands in for itself as an empty group; it was said where it stands.
        Shape::Group(nodes) if nodes.is_empty() => Err(Reported),
        Shape::Plane { .. }
        | Shape::Box(_)
        | Shape::Cone(_)
        | Shape::Torus(_)
        | Shape::Surface(_)
        | Shape::Skin(_)
        | Shape::Model(_)
        | Shape::Group(_)
        | Shape::Csg(_)
        | Shape::Implicit(_) => {
            let message = "an area light is a `rect`, `disc`, `sphere`, `triangle` or `mesh`";
            let hint = "any other object shines with `material { emit … }`";
            Err(block.fault(ctx, Code::BadProperty, "area", message, hint))
        }
    }
}

fn sky(ctx: &mut dyn Context, block: &Block) -> Outcome<Sky> {
    let factor = block.colour("radiance").unwrap_or(Rgb::ONE);
    if let Some(Value::Vector3(colour)) = block.value("sky") {
        return Ok(Sky::Uniform(*colour * factor));
    }
    let (written, span) = (block.text("sky").unwrap_or_default(), block.place("sky"));
    let path = existing_file(ctx, written, span)?;
    Ok(Sky::Image { path, factor, span, picture: Picture::default() })
}
