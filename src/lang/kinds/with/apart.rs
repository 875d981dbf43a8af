//! Values taken apart into the properties that build them.

use crate::geometry::any_curve::AnyCurve;
use crate::geometry::surface::tube::Caps;
use crate::lang::kinds::{lights, models, objects, settings, shapes, skins, solids, surfaces};
use crate::lang::table::Kind;
use crate::lang::value::{self, Given, Value};
use crate::scene::{
    Along, Camera, Fresnel, Light, LightSource, Lobe, Material, MeshSource, Projection, Radius, Rgb, Shape,
    Sky, Surface, Texture,
};
use glam::DVec3;
use std::sync::Arc;

/// A property's name and values.
pub type Part = (&'static str, Vec<Value>);

fn vector(v: DVec3) -> Value {
    Value::Vector3(v)
}

fn one(name: &'static str, value: Value) -> Part {
    (name, vec![value])
}

/// The kind of a shape. A cone of equal radii is a cylinder, unless its `radii` are asked for.
pub fn kind_of(shape: &Shape, asked: impl Fn(&str) -> bool) -> &'static Kind {
    match shape {
        Shape::Sphere { .. } => &shapes::SPHERE,
        Shape::Plane { .. } => &shapes::PLANE,
        Shape::Disc(_) => &shapes::DISC,
        Shape::Rect(_) => &shapes::RECT,
        Shape::Box(_) => &shapes::BOX,
        Shape::Cone(cone) if cone.radii[0] == cone.radii[1] && !asked("radii") => &shapes::CYLINDER,
        Shape::Cone(_) => &shapes::CONE,
        Shape::Torus(_) => &shapes::TORUS,
        Shape::Triangle(_) => &shapes::TRIANGLE,
        Shape::Mesh(_) => &objects::MESH,
        Shape::Surface(surface) => match &**surface {
            Surface::Patch(_) => &surfaces::PATCH,
            Surface::Tube(_) => &surfaces::TUBE,
            Surface::Lathe(_) => &surfaces::LATHE,
            Surface::Extrude(_) => &surfaces::EXTRUDE,
        },
        Shape::Skin(_) => &skins::SKIN,
        Shape::Model(_) => &models::MODEL,
        Shape::Group(_) => &objects::GROUP,
        Shape::Csg(csg) => solids::kind_of(csg.op),
        Shape::Implicit(_) => &solids::IMPLICIT,
    }
}

/// The properties that build a shape, without those that the new ones replace under another name. None where its geometry is
/// not written in properties one by one.
pub fn shape(shape: &Shape, new: &[Given]) -> Option<Vec<Part>> {
    let asked = |name: &str| new.iter().any(|g| &*g.name == name);
    let number = Value::Number;
    Some(match shape {
        Shape::Sphere { center, radius } => {
            vec![one("center", vector(*center)), one("radius", number(*radius))]
        }
        Shape::Plane { normal, .. } if asked("through") => vec![one("normal", vector(*normal))],
        Shape::Plane { normal, offset } => {
            vec![one("normal", vector(*normal)), one("offset", number(*offset))]
        }
        Shape::Disc(d) => {
            vec![
                one("center", vector(d.center)),
                one("normal", vector(d.normal)),
                one("radius", number(d.radius)),
            ]
        }
        Shape::Rect(r) => vec![one("center", vector(r.center)), ("edges", vec![vector(r.a), vector(r.b)])],
        Shape::Box(b) => vec![one("min", vector(b.0)), one("max", vector(b.1))],
        Shape::Cone(c) => {
            let is_cylinder = std::ptr::eq(kind_of(shape, asked), &shapes::CYLINDER);
            let radii = match is_cylinder {
                true => one("radius", number(c.radii[0])),
                false => ("radii", c.radii.map(number).to_vec()),
            };
            vec![one("from", vector(c.from)), one("to", vector(c.to)), radii]
        }
        Shape::Torus(t) => vec![
            one("center", vector(t.center)),
            one("axis", vector(t.axis)),
            ("radii", t.radii.map(number).to_vec()),
        ],
        Shape::Triangle(t) => {
            let mut parts = vec![("vertices", t.vertices.map(vector).to_vec())];
            parts.extend(t.normals.map(|n| ("normals", n.map(vector).to_vec())));
            parts.extend(t.uvs.map(|uv| ("uvs", uv.map(Value::Vector2).to_vec())));
            parts
        }
        // A file's path is joined to its folder already, and must not be joined again: a new `file` replaces all of it.
        Shape::Mesh(source) => match &**source {
            MeshSource::File { smooth, .. } if asked("file") => {
                smooth.map(|smooth| one("smooth", Value::Bool(smooth))).into_iter().collect()
            }
            MeshSource::File { .. } | MeshSource::Inline(_) => return None,
        },
        Shape::Surface(surface) => return of_surface(surface),
        Shape::Skin(_) | Shape::Model(_) | Shape::Group(_) | Shape::Csg(_) | Shape::Implicit(_) => {
            return None;
        }
    })
}

/// Control points are not written back one by one; curves are values.
fn of_surface(surface: &Surface) -> Option<Vec<Part>> {
    let space = |curve: &Arc<_>| Value::Curve(AnyCurve::Space(Arc::clone(curve)));
    let plane = |curve: &Arc<_>| Value::Curve(AnyCurve::Plane(Arc::clone(curve)));
    Some(match surface {
        Surface::Patch(_) => return None,
        Surface::Tube(tube) => {
            let radius = match &tube.radius {
                Radius::Constant(radius) => Value::Number(*radius),
                Radius::Along(curve) => Value::Curve(AnyCurve::Numbers(Arc::clone(curve))),
            };
            let caps = match tube.caps {
                Caps::Round => "round",
                Caps::Flat => "flat",
                Caps::Open => "open",
            };
            vec![
                one("along", space(&tube.along)),
                one("radius", radius),
                one("caps", Value::Word(caps.into())),
            ]
        }
        Surface::Lathe(lathe) => {
            vec![one("profile", plane(&lathe.profile)), one("angle", Value::Number(lathe.angle))]
        }
        Surface::Extrude(extrude) => {
            let along = match &extrude.along {
                Along::Vector(v) => vector(*v),
                Along::Path(path) => space(path),
            };
            vec![one("outline", plane(&extrude.outline)), one("along", along)]
        }
    })
}

/// The properties that build a light, its transform aside. A new source takes the place of the old, with its strength.
pub fn light(light: &Light, new: &[Given]) -> Vec<Part> {
    let source = match &light.source {
        LightSource::Point { position, intensity } => {
            vec![one("point", vector(*position)), one("intensity", vector(*intensity))]
        }
        LightSource::Spot { position, direction, cone, intensity } => vec![
            one("spot", vector(*position)),
            one("toward", vector(*direction)),
            ("cone", cone.map(Value::Number).to_vec()),
            one("intensity", vector(*intensity)),
        ],
        LightSource::Sun { direction, irradiance } => {
            vec![one("sun", vector(*direction)), one("irradiance", vector(*irradiance))]
        }
        LightSource::Area { object, radiance } => {
            vec![one("area", Value::Object(object.clone())), one("radiance", vector(*radiance))]
        }
        LightSource::Sky(Sky::Uniform(colour)) => vec![one("sky", vector(*colour))],
        // A path is joined to its folder already, and must not be joined again: an even sky stands for the picture meanwhile.
        LightSource::Sky(Sky::Image { factor, .. }) => {
            vec![one("sky", vector(Rgb::ONE)), one("radiance", vector(*factor))]
        }
    };
    let old_source = source[0].0;
    let replaced = new.iter().any(|g| lights::SOURCES.contains(&&*g.name) && &*g.name != old_source);
    let mut parts = if replaced { Vec::new() } else { source };
    if let (Some(falloff), false) = (light.falloff, replaced) {
        parts.push(("falloff", falloff.map(Value::Number).to_vec()));
    }
    parts.push(one("shadow", Value::Bool(light.shadow)));
    parts.push(one("samples", Value::Number(f64::from(light.samples))));
    parts
}

/// The properties that build a camera, its label aside.
pub fn camera(camera: &Camera) -> Vec<Part> {
    let projection = match camera.projection {
        Projection::Perspective => "perspective",
        Projection::Orthographic => "orthographic",
        Projection::Fisheye => "fisheye",
        Projection::Panorama => "panorama",
    };
    let mut parts = vec![
        one("eye", vector(camera.eye)),
        one("look_at", vector(camera.look_at)),
        one("fov", Value::Number(camera.fov)),
        one("projection", Value::Word(projection.into())),
        one("aperture", Value::Number(camera.aperture)),
    ];
    // Up stays only where it was chosen: the default follows the view.
    if settings::default_up(camera.look_at - camera.eye) != camera.up {
        parts.push(one("up", vector(camera.up)));
    }
    parts.extend(camera.focus.map(|focus| one("focus", Value::Number(focus))));
    parts
}

/// The properties that build a material. Layers that are as by default are left out, so that defaults that follow others
/// still do.
pub fn material(material: &Material) -> Vec<Part> {
    let mut parts = vec![one("diffuse", colour(&material.diffuse))];
    let Some(layers) = material.layers.as_deref() else { return parts };
    let colours = [
        ("ambient", &layers.ambient),
        ("specular", &layers.specular),
        ("reflect", &layers.reflect),
        ("transmit", &layers.transmit),
        ("absorb", &layers.absorb),
        ("metal", &layers.metal),
        ("emit", &layers.emit),
    ];
    parts.extend(colours.into_iter().filter(|(_, t)| !is(t, 0.0)).map(|(name, t)| one(name, colour(t))));
    let numbers = [
        ("exponent", &layers.exponent, 0.0),
        ("ior", &layers.ior, 1.5),
        ("roughness", &layers.roughness, 0.0),
        ("opacity", &layers.opacity, 1.0),
    ];
    parts.extend(numbers.into_iter().filter(|(_, t, d)| !is(t, *d)).map(|(name, t, _)| one(name, number(t))));
    if layers.lobe == Lobe::Phong {
        parts.push(one("lobe", Value::Word("phong".into())));
    }
    let follows = if is(&layers.transmit, 0.0) { Fresnel::None } else { Fresnel::Exact };
    if layers.fresnel != follows {
        let word = match layers.fresnel {
            Fresnel::None => "none",
            Fresnel::Schlick => "schlick",
            Fresnel::Exact => "exact",
        };
        parts.push(one("fresnel", Value::Word(word.into())));
    }
    parts.extend(layers.normal_map.as_ref().map(|t| one("normal_map", colour(t))));
    parts.extend(layers.bump.as_ref().map(|t| one("bump", number(t))));
    parts
}

fn is(texture: &Texture, number: f64) -> bool {
    texture.is(DVec3::splat(number))
}

fn colour(texture: &Texture) -> Value {
    match texture {
        Texture::Constant(c) => value::vector(&c.to_array()),
        Texture::Pattern(pattern) => Value::Pattern(pattern.clone()),
    }
}

fn number(texture: &Texture) -> Value {
    match texture {
        Texture::Constant(c) => Value::Number(c.x),
        Texture::Pattern(pattern) => Value::Pattern(pattern.clone()),
    }
}
