//! The exact shapes: sphere, plane, disc, rect, box, cylinder, cone, torus, triangle.

use super::common;
use crate::diag::{Code, Diagnostic};
use crate::lang::coerce;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Role, Type};
use crate::lang::value::Value;
use crate::math::Affine;
use crate::scene::{Cone, Disc, Object, Rect, Shape, Torus, Triangle};
use glam::DVec3;
use std::sync::Arc;

const POINT: &[&[Type]] = &[&[Type::Vector3]];
const LENGTH: &[&[Type]] = &[&[Type::Positive]];
const AXIS: &[&[Type]] = &[&[Type::Direction]];

const fn solid(
    name: &'static str,
    doc: &'static str,
    example: &'static str,
    own: &'static [Property],
    build: crate::lang::table::Build,
) -> Kind {
    Kind { name, doc, example, role: Role::Object, own, children: false, open: false, build: Some(build) }
}

/// A ball.
pub static SPHERE: Kind = solid(
    "sphere",
    "A ball, solid. (u, v): u is the longitude about y, v the latitude from the south pole.",
    "sphere { center <0, 1, 0>  radius 1  material { diffuse <0.8, 0.4, 0.3> } }",
    &[
        Property::new("center", POINT, "<0, 0, 0>", "the centre, in scene units"),
        Property::new("radius", LENGTH, "1", "the radius, in scene units, above 0"),
    ],
    |ctx, block| {
        let center = block.vector("center").unwrap_or(DVec3::ZERO);
        finish(ctx, block, Shape::Sphere { center, radius: block.number("radius").unwrap_or(1.0) })
    },
);

/// An infinite plane.
pub static PLANE: Kind = solid(
    "plane",
    "An infinite plane, the points p with n·p = offset, solid on the side that its normal leaves.",
    "plane { normal y  offset -1  material { diffuse checker(white, 0.3) } }",
    &[
        Property::new(
            "normal",
            AXIS,
            "y",
            "the direction that leaves the solid side; its length is of no account",
        ),
        Property::new(
            "offset",
            &[&[Type::NUMBER]],
            "0",
            "the distance from the origin along the unit normal",
        ),
        Property::new("through", POINT, "", "a point of the plane, instead of `offset`"),
    ],
    plane,
);

/// A flat disc.
pub static DISC: Kind = solid(
    "disc",
    "A flat disc; no solid. (u, v) span its square: (0.5, 0.5) is the centre.",
    "disc { center <0, 2, 0>  normal <0, -1, 0>  radius 0.5 }",
    &[
        Property::new("center", POINT, "<0, 0, 0>", "the centre, in scene units"),
        Property::new("normal", AXIS, "y", "the direction it faces; as a light it shines to that side"),
        Property::new("radius", LENGTH, "1", "the radius, in scene units, above 0"),
    ],
    |ctx, block| {
        let disc = Disc {
            center: block.vector("center").unwrap_or(DVec3::ZERO),
            normal: block.vector("normal").unwrap_or(DVec3::Y),
            radius: block.number("radius").unwrap_or(1.0),
        };
        finish(ctx, block, Shape::Disc(Box::new(disc)))
    },
);

/// A parallelogram.
pub static RECT: Kind = solid(
    "rect",
    "A flat rectangle or parallelogram, the points center ± a ± b; no solid. It faces a × b. (u, v) run from 0 to 1 \
     along a and b.",
    "rect { center <0, 2, 0>  edges <1, 0, 0>, <0, 0, 1> }",
    &[
        Property::new("center", POINT, "<0, 0, 0>", "the middle, in scene units"),
        Property::new(
            "edges",
            &[&[Type::Vector3, Type::Vector3]],
            "",
            "`a, b`: from the middle to the middle of two neighbouring sides (half-edges); not parallel",
        )
        .required(),
    ],
    rect,
);

/// An axis-aligned box.
pub static BOX: Kind = solid(
    "box",
    "A box along the axes, solid.",
    "box { min <-1, 0, -1>  max <1, 2, 1>  rotate y*30 }",
    &[
        Property::new("min", POINT, "", "the corner of the least x, y and z").required(),
        Property::new("max", POINT, "", "the corner of the greatest x, y and z").required(),
    ],
    axis_box,
);

/// A capped cylinder.
pub static CYLINDER: Kind = solid(
    "cylinder",
    "A cylinder with flat caps, solid.",
    "cylinder { from <0, 0, 0>  to <0, 2, 0>  radius 0.5 }",
    &[
        Property::new("from", POINT, "", "the centre of the first cap").required(),
        Property::new("to", POINT, "", "the centre of the second cap").required(),
        Property::new("radius", LENGTH, "1", "the radius, in scene units, above 0"),
    ],
    |ctx, block| {
        let r = block.number("radius").unwrap_or(1.0);
        frustum(ctx, block, [r, r])
    },
);

/// A capped cone.
pub static CONE: Kind = solid(
    "cone",
    "A cone or frustum with flat caps, solid.",
    "cone { from <0, 0, 0>  to <0, 2, 0>  radii 0.5, 0 }",
    &[
        Property::new("from", POINT, "", "the centre of the first cap").required(),
        Property::new("to", POINT, "", "the centre of the second cap, or the tip").required(),
        Property::new(
            "radii",
            &[&[Type::NON_NEGATIVE, Type::NON_NEGATIVE]],
            "",
            "the radii at `from` and at `to`, in scene units; one may be 0",
        )
        .required(),
    ],
    cone,
);

/// A torus.
pub static TORUS: Kind = solid(
    "torus",
    "A ring, solid.",
    "torus { radii 1, 0.25  translate <0, 0.25, 0> }",
    &[
        Property::new("center", POINT, "<0, 0, 0>", "the centre, in scene units"),
        Property::new("axis", AXIS, "y", "the axis of symmetry; the ring lies across it"),
        Property::new(
            "radii",
            &[&[Type::Positive, Type::Positive]],
            "",
            "the radius of the ring's centre line, and that of the tube, in scene units",
        )
        .required(),
    ],
    |ctx, block| {
        let radii = block.numbers("radii").expect("required");
        let torus = Torus {
            center: block.vector("center").unwrap_or(DVec3::ZERO),
            axis: block.vector("axis").unwrap_or(DVec3::Y),
            radii: [radii[0], radii[1]],
        };
        finish(ctx, block, Shape::Torus(Box::new(torus)))
    },
);

/// A triangle.
pub static TRIANGLE: Kind = solid(
    "triangle",
    "A single triangle; no solid. Counterclockwise seen from the side that it faces.",
    "triangle { vertices <-1, 0, 0>, <1, 0, 0>, <0, 1, 0> }",
    &[
        Property::new(
            "vertices",
            &[&[Type::Vector3; 3]],
            "",
            "the three corners, in scene units, not in one line",
        )
        .required(),
        Property::new("normals", &[&[Type::Direction; 3]], "", "a normal at each corner, for smooth shading"),
        Property::new("uvs", &[&[Type::Vector2; 3]], "", "texture coordinates at each corner"),
    ],
    triangle,
);

/// A transform after another, where there is one.
pub fn after(before: Option<&Affine>, next: Option<Affine>) -> Option<Box<Affine>> {
    match (before, next) {
        (Some(before), Some(next)) => Some(Box::new(before.then(&next))),
        (None, Some(next)) => Some(Box::new(next)),
        (before, None) => before.copied().map(Box::new),
    }
}

/// An object of a shape, with the common properties applied.
pub fn finish(ctx: &mut dyn Context, block: &Block, shape: Shape) -> Outcome {
    let mut object = Object::new(shape, block.span);
    common::apply_to_object(ctx, &mut object, &block.given)?;
    Ok(Value::Object(Arc::new(object)))
}

fn plane(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let normal = block.vector("normal").unwrap_or(DVec3::Y);
    let offset = match (block.number("offset"), block.vector("through")) {
        (Some(_), Some(_)) => return Err(conflict(ctx, block, "offset", "through")),
        (Some(offset), None) => offset,
        (None, Some(p)) => normal.dot(p),
        (None, None) => 0.0,
    };
    finish(ctx, block, Shape::Plane { normal, offset })
}

/// Two properties that say the same thing.
pub fn conflict(
    ctx: &mut dyn Context,
    block: &Block,
    first: &str,
    second: &str,
) -> crate::lang::table::Reported {
    let place = |name: &str| block.get(name).map_or(block.kind_span, |g| g.name_span);
    ctx.fail(
        Diagnostic::new(
            Code::ConflictingProperties,
            place(second),
            format!("`{first}` and `{second}` exclude each other"),
        )
        .also(place(first), "the other is here")
        .hint(format!("keep either `{first}` or `{second}`")),
    )
}

fn rect(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let edges = block.vectors("edges").expect("required");
    let (a, b) = (edges[0], edges[1]);
    if parallel(a, b) {
        let hint = "give two half-edges in different directions, as in `edges <1, 0, 0>, <0, 0, 1>`";
        return Err(block.fault(
            ctx,
            Code::BadGeometry,
            "edges",
            "these edges span no rectangle: they are parallel",
            hint,
        ));
    }
    let center = block.vector("center").unwrap_or(DVec3::ZERO);
    finish(ctx, block, Shape::Rect(Box::new(Rect { center, a, b })))
}

/// True where the vectors span no area, up to the rounding of their cross product at the scale of their lengths.
fn parallel(a: DVec3, b: DVec3) -> bool {
    match (coerce::unit(a), coerce::unit(b)) {
        (Some(a), Some(b)) => a.cross(b).length() <= 4.0 * crate::math::error::UNIT_ROUNDOFF,
        _ => true,
    }
}

fn axis_box(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let (min, max) = (block.vector("min").expect("required"), block.vector("max").expect("required"));
    let bad: Vec<usize> = (0..3).filter(|i| min[*i] >= max[*i]).collect();
    if let Some(first) = bad.first() {
        let flat = min[*first] == max[*first];
        let each = |i: &usize| {
            let axis = ["x", "y", "z"][*i];
            format!("{} and {} in {axis}", coerce::number(min[*i]), coerce::number(max[*i]))
        };
        let found: Vec<String> = bad.iter().map(each).collect();
        let message = format!(
            "a box needs `min` below `max` on each axis, and they are {}",
            coerce::listed(&found, "and")
        );
        let hint = if flat {
            "for a flat rectangle write `rect { center …  edges a, b }`".to_string()
        } else {
            format!(
                "swap them: `min {}  max {}`",
                coerce::vector(&min.min(max).to_array()),
                coerce::vector(&min.max(max).to_array())
            )
        };
        let said = Diagnostic::new(Code::BadGeometry, block.place("max"), message)
            .also(block.place("min"), "`min` is here")
            .hint(hint);
        return Err(ctx.fail(said));
    }
    finish(ctx, block, Shape::Box(Box::new((min, max))))
}

fn cone(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let radii = block.numbers("radii").expect("required");
    if radii[0] == 0.0 && radii[1] == 0.0 {
        let hint = "at least one radius must be above 0, as in `radii 0.5, 0`";
        return Err(block.fault(ctx, Code::BadGeometry, "radii", "both radii of this cone are 0", hint));
    }
    frustum(ctx, block, [radii[0], radii[1]])
}

fn frustum(ctx: &mut dyn Context, block: &Block, radii: [f64; 2]) -> Outcome {
    let (from, to) = (block.vector("from").expect("required"), block.vector("to").expect("required"));
    if from == to {
        let said = Diagnostic::new(
            Code::BadGeometry,
            block.place("to"),
            format!("this `{}` has no length: `from` and `to` are the same point", block.kind.name),
        )
        .also(block.place("from"), "`from` is here")
        .hint("move one of them; for a flat one use `disc`");
        return Err(ctx.fail(said));
    }
    finish(ctx, block, Shape::Cone(Box::new(Cone { from, to, radii })))
}

fn triangle(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let v = block.vectors("vertices").expect("required");
    if parallel(v[1] - v[0], v[2] - v[0]) {
        let hint = "move a corner off the line through the other two";
        let message = "this triangle has no area: its corners lie in one line";
        return Err(block.fault(ctx, Code::BadGeometry, "vertices", message, hint));
    }
    let triangle = Triangle {
        vertices: [v[0], v[1], v[2]],
        normals: block.vectors("normals").map(|n| [n[0], n[1], n[2]]),
        uvs: block.vectors2("uvs").map(|t| [t[0], t[1], t[2]]),
    };
    finish(ctx, block, Shape::Triangle(Box::new(triangle)))
}
