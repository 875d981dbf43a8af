//! Camera and render: what a scene has one of.

use crate::diag::{Code, Diagnostic};
use crate::lang::coerce;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Role, Type};
use crate::lang::value::Value;
use crate::scene::{
    Accelerator, Camera, PixelFilter, Projection, RenderSettings, SamplerKind, ToneMap, TracerKind,
};
use glam::DVec3;
use std::sync::Arc;

const POINT: &[&[Type]] = &[&[Type::Vector3]];
const COUNT: &[&[Type]] = &[&[Type::Integer { min: 1 }]];

/// The full vertical angle of view where none is given, in degrees.
const DEFAULT_FOV: f64 = 40.0;

/// A camera.
pub static CAMERA: Kind = Kind {
    name: "camera",
    doc: "From where the picture is taken. With several, the first is used, or the one named by `--camera LABEL`.",
    example: "camera { eye <0, 1.5, 5>  look_at <0, 1, 0>  fov 40 }",
    role: Role::Setting,
    own: &[
        Property::new("eye", POINT, "", "where it stands, in scene units").required(),
        Property::new("look_at", POINT, "<0, 0, 0>", "the point in the middle of the picture"),
        Property::new("up", &[&[Type::Direction]], "y", "the direction that is up in the picture"),
        Property::new(
            "fov",
            &[&[Type::Number { min: 1e-6, max: 360.0 }]],
            "40",
            "full vertical angle of view in degrees; below 180 for perspective and orthographic, up to 360 for fisheye; a \
             panorama has none. Orthographic pictures are 2·|look_at − eye|·tan(fov/2) high",
        ),
        Property::new(
            "projection",
            &[&[Type::Word(&["perspective", "orthographic", "fisheye", "panorama"])]],
            "perspective",
            "`perspective`: straight lines stay straight; `orthographic`: parallel rays; `fisheye`: equidistant, the angle \
             grows with the distance from the middle; `panorama`: all around, 360° × 180°",
        ),
        Property::new(
            "aperture",
            &[&[Type::NON_NEGATIVE]],
            "0",
            "diameter of the lens in scene units; 0 is a pinhole, sharp everywhere",
        ),
        Property::new(
            "focus",
            &[&[Type::Positive]],
            "",
            "distance from the eye that is sharp, in scene units; by default that of `look_at`",
        ),
    ],
    children: false,
    open: false,
    build: Some(camera),
};

fn camera(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let eye = block.vector("eye").expect("required");
    let look_at = block.vector("look_at").unwrap_or(DVec3::ZERO);
    let projection = projection(block);
    if eye == look_at {
        return Err(looks_at_itself(ctx, block));
    }
    let made = Camera {
        label: block.label.as_ref().map(|(name, _)| name.as_str().into()),
        eye,
        look_at,
        up: up(ctx, block, look_at - eye)?,
        fov: fov(ctx, block, projection)?,
        projection,
        aperture: block.number("aperture").unwrap_or(0.0),
        focus: block.number("focus"),
        span: block.span,
    };
    Ok(Value::Camera(Arc::new(made)))
}

fn projection(block: &Block) -> Projection {
    match block.word("projection") {
        Some("orthographic") => Projection::Orthographic,
        Some("fisheye") => Projection::Fisheye,
        Some("panorama") => Projection::Panorama,
        _ => Projection::Perspective,
    }
}

fn looks_at_itself(ctx: &mut dyn Context, block: &Block) -> crate::lang::table::Reported {
    let at = if block.has("look_at") { "look_at" } else { "eye" };
    let said = Diagnostic::new(
        Code::BadProperty,
        block.place(at),
        "this camera looks at the point where it stands: `eye` and `look_at` are equal",
    )
    .hint("move one of them; `look_at` is <0, 0, 0> where it is not given");
    ctx.fail(if at == "look_at" { said.also(block.place("eye"), "`eye` is here") } else { said })
}

/// Up where none is given: y; where the camera looks straight up or down, the side of −z or z, as on a map.
pub fn default_up(view: DVec3) -> DVec3 {
    if along(view, DVec3::Y) { DVec3::Z * view.y.signum() } else { DVec3::Y }
}

/// True for parallel directions, up to the rounding of their cross product.
fn along(view: DVec3, up: DVec3) -> bool {
    let view = coerce::unit(view).unwrap_or(DVec3::NEG_Z);
    view.cross(up).length() <= 4.0 * crate::math::error::UNIT_ROUNDOFF
}

fn up(ctx: &mut dyn Context, block: &Block, view: DVec3) -> Outcome<DVec3> {
    match block.vector("up") {
        None => Ok(default_up(view)),
        Some(up) if along(view, up) => {
            let try_this = if view.z.abs() < 0.5 * view.length() { "z" } else { "y" };
            let message = "`up` points along the view, so that no side of the picture is up";
            let hint = format!("write `up {try_this}`, or leave it out");
            Err(block.fault(ctx, Code::BadProperty, "up", message, hint))
        }
        Some(up) => Ok(up),
    }
}

fn fov(ctx: &mut dyn Context, block: &Block, projection: Projection) -> Outcome<f64> {
    let fov = block.number("fov").unwrap_or(DEFAULT_FOV);
    let flat = matches!(projection, Projection::Perspective | Projection::Orthographic);
    if flat && fov >= 180.0 {
        let message = format!("`fov` must be below 180 here, and this is {}", coerce::number(fov));
        let hint = "for wider views write `projection fisheye` or `projection panorama`";
        return Err(block.fault(ctx, Code::BadProperty, "fov", message, hint));
    }
    Ok(fov)
}

/// The render block.
pub static RENDER: Kind = Kind {
    name: "render",
    doc: "How the picture is made. The command line overrides each of these.",
    example: "render { size 800, 500  tracer whitted  samples 16 }",
    role: Role::Setting,
    own: &[
        Property::new(
            "size",
            &[&[Type::Integer { min: 1 }, Type::Integer { min: 1 }]],
            "640, 480",
            "width and height in pixels",
        ),
        Property::new(
            "tracer",
            &[&[Type::Word(&["raycast", "whitted", "montecarlo", "path", "irradiance", "photon"])]],
            "whitted",
            "`raycast`: what is seen, without shadows; `whitted`: shadows, mirrors and glass; the others follow indirect \
             light",
        ),
        Property::new(
            "samples",
            COUNT,
            "4",
            "samples a pixel; 1 is the ray through its centre. 64 by default for tracers that follow indirect light",
        ),
        Property::new(
            "depth",
            COUNT,
            "8",
            "most segments from the camera, the last of which may end on a light; tracers that follow indirect light have \
             no end by default",
        ),
        Property::new("seed", &[&[Type::Integer { min: 0 }]], "0", "of every random number of the picture"),
        Property::new(
            "sampler",
            &[&[Type::Word(&["sobol", "stratified", "independent"])]],
            "sobol",
            "how even the random numbers of a pixel are: scrambled Sobol points, one in each cell of a grid, or each by itself",
        ),
        Property::new(
            "filter",
            &[&[Type::Word(&["box", "tent", "gaussian"])]],
            "box",
            "how a pixel weighs what lies around its centre: evenly over its square, falling off to the centres of its neighbours, or by a bell of half a pixel's deviation",
        ),
        Property::new(
            "clamp",
            &[&[Type::Positive]],
            "",
            "most radiance of a camera sample in any colour: brighter ones are dimmed to it, and how much light that took is told. None is dimmed where it is not said",
        ),
        Property::new(
            "accelerator",
            &[&[Type::Word(&["bvh", "kdtree", "none"])]],
            "bvh",
            "the tree that rays search: boxes in boxes, or cells of space, which suit long shapes that overlap; `none` tries every shape. The picture is the same",
        ),
        Property::new(
            "exposure",
            &[&[Type::NUMBER]],
            "0",
            "in stops: the picture is multiplied by 2^exposure",
        ),
        Property::new(
            "tonemap",
            &[&[Type::Word(&["none", "reinhard", "aces"])]],
            "none",
            "from radiance to the 0 … 1 of 8-bit pictures; HDR and EXR files keep the radiance",
        ),
        Property::new("background", &[&[Type::Colour]], "0", "seen where nothing else is; it lights nothing"),
        Property::new(
            "frames",
            COUNT,
            "1",
            "frames of an animation, of which `ogee render` makes all; `time` is frame / frames",
        ),
        Property::new("fps", &[&[Type::Positive]], "24", "frames per second"),
    ],
    children: false,
    open: false,
    build: Some(render),
};

/// Most pixels on a side: what picture formats hold.
const LARGEST_SIDE: f64 = 65_535.0;

fn render(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let settings = RenderSettings {
        size: size(ctx, block)?,
        tracer: block.word("tracer").map(tracer),
        samples: count(ctx, block, "samples")?,
        // More segments than can be counted are without end.
        depth: block.integer("depth").map(|n| n.min(u64::from(u32::MAX)) as u32),
        seed: block.integer("seed"),
        sampler: block.word("sampler").map(sampler),
        filter: block.word("filter").map(filter),
        clamp: block.number("clamp"),
        accelerator: block.word("accelerator").map(accelerator),
        exposure: block.number("exposure"),
        tonemap: block.word("tonemap").map(tonemap),
        background: block.colour("background"),
        frames: count(ctx, block, "frames")?,
        fps: block.number("fps"),
        span: Some(block.span),
        size_span: block.has("size").then(|| block.place("size")),
    };
    Ok(Value::Render(Arc::new(settings)))
}

fn count(ctx: &mut dyn Context, block: &Block, name: &str) -> Outcome<Option<u32>> {
    let Some(n) = block.integer(name) else { return Ok(None) };
    u32::try_from(n).map(Some).map_err(|_| {
        let message = format!("{n} {name} are too many to be counted");
        block.fault(ctx, Code::BadProperty, name, message, format!("at most {} are", u32::MAX))
    })
}

fn size(ctx: &mut dyn Context, block: &Block) -> Outcome<Option<[u32; 2]>> {
    let Some(size) = block.numbers("size") else { return Ok(None) };
    if size.iter().any(|n| *n > LARGEST_SIDE) {
        let message = format!("a picture of {} × {} pixels is too large", size[0], size[1]);
        return Err(block.fault(ctx, Code::BadProperty, "size", message, "a side has at most 65535 pixels"));
    }
    Ok(Some([size[0] as u32, size[1] as u32]))
}

fn tracer(word: &str) -> TracerKind {
    match word {
        "raycast" => TracerKind::Raycast,
        "whitted" => TracerKind::Whitted,
        "montecarlo" => TracerKind::MonteCarlo,
        "path" => TracerKind::Path,
        "irradiance" => TracerKind::Irradiance,
        _ => TracerKind::Photon,
    }
}

fn sampler(word: &str) -> SamplerKind {
    match word {
        "stratified" => SamplerKind::Stratified,
        "independent" => SamplerKind::Independent,
        _ => SamplerKind::Sobol,
    }
}

fn filter(word: &str) -> PixelFilter {
    match word {
        "tent" => PixelFilter::Tent,
        "gaussian" => PixelFilter::Gaussian,
        _ => PixelFilter::Box,
    }
}

fn accelerator(word: &str) -> Accelerator {
    match word {
        "bvh" => Accelerator::Bvh,
        "kdtree" => Accelerator::KdTree,
        _ => Accelerator::None,
    }
}

fn tonemap(word: &str) -> ToneMap {
    match word {
        "reinhard" => ToneMap::Reinhard,
        "aces" => ToneMap::Aces,
        _ => ToneMap::None,
    }
}
