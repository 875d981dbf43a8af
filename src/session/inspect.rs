//! A scene as it was evaluated, printed: stable text for snapshots and eyes, JSON for programs. Both come from one tree of
//! `Entry`s, so that they cannot disagree.

mod figures;

use crate::diag::{SourceMap, Span};
use crate::geometry::path::Path;
use crate::geometry::skin::Blend;
use crate::math::{Affine, Point};
use crate::scene::{
    Along, Camera, Fresnel, Layers, Light, LightSource, Lobe, Material, MeshSource, Node, Object,
    PatchMethod, PatchNet, PatchSource, PatternKind, Projection, Radius, RenderSettings, Rgb, SampleInput,
    Scene, Shape, Skin, SkinSurface, Sky, Surface, Texture, Weights,
};
use glam::DVec3;
use serde_json::{Map, Value as Json, json};
use std::fmt::Write as _;

/// A scene, an object, a light …: its kind, what is said of it, and what is inside.
struct Entry {
    kind: &'static str,
    span: Option<Span>,
    properties: Vec<(&'static str, Json)>,
    children: Vec<Entry>,
}

/// The evaluated hierarchy, an entry a line, children indented by two spaces. Numbers in shortest round-trip form.
pub fn text(scene: &Scene, sources: &SourceMap) -> String {
    let mut out = String::new();
    entries(scene).iter().for_each(|entry| push_text(&mut out, entry, 0, sources));
    out
}

/// The same as one JSON object a line: `{"kind", "at", …properties, "children"}`.
pub fn json(scene: &Scene, sources: &SourceMap) -> String {
    entries(scene).iter().fold(String::new(), |mut out, entry| {
        let _ = writeln!(out, "{}", entry_json(entry, sources));
        out
    })
}

fn push_text(out: &mut String, entry: &Entry, depth: usize, sources: &SourceMap) {
    let _ = write!(out, "{:1$}{2}", "", 2 * depth, entry.kind);
    for (name, value) in &entry.properties {
        let _ = write!(out, "  {name} {}", value_text(value));
    }
    if let Some(span) = entry.span {
        let at = sources.line_column(span.source, span.start);
        let _ = write!(out, "  # {}:{}", at.line, at.column);
    }
    out.push('\n');
    entry.children.iter().for_each(|child| push_text(out, child, depth + 1, sources));
}

/// Three numbers are a vector; a tree of properties stands in braces.
fn value_text(value: &Json) -> String {
    match value {
        Json::Array(list) if list.iter().all(Json::is_number) => {
            format!("<{}>", list.iter().map(value_text).collect::<Vec<_>>().join(", "))
        }
        Json::Array(list) => format!("[{}]", list.iter().map(value_text).collect::<Vec<_>>().join(", ")),
        Json::Object(map) => {
            let parts: Vec<String> = map.iter().map(|(k, v)| format!("{k} {}", value_text(v))).collect();
            format!("{{ {} }}", parts.join("  "))
        }
        Json::Number(number) => {
            let text = number.to_string();
            text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
        }
        Json::String(text) => text.clone(),
        Json::Bool(_) | Json::Null => value.to_string(),
    }
}

fn entry_json(entry: &Entry, sources: &SourceMap) -> Json {
    let mut map = Map::new();
    map.insert("kind".into(), json!(entry.kind));
    if let Some(span) = entry.span {
        map.insert("at".into(), json!(sources.place(span)));
    }
    map.extend(entry.properties.iter().map(|(name, value)| ((*name).to_owned(), value.clone())));
    if !entry.children.is_empty() {
        let children = entry.children.iter().map(|child| entry_json(child, sources));
        map.insert("children".into(), children.collect());
    }
    Json::Object(map)
}

fn entries(scene: &Scene) -> Vec<Entry> {
    let render = (scene.render != RenderSettings::default()).then(|| render(&scene.render));
    let mut left = MOST_INSIDE;
    let nodes = scene.nodes.iter().map(|top| node(top, &mut left));
    let figures = scene.figures.iter().map(figures::figure);
    scene.cameras.iter().map(camera).chain(render).chain(figures).chain(nodes).collect()
}

/// Entries inside groups that are printed at most: groups placed in groups in groups have no end that anybody reads.
const MOST_INSIDE: usize = 1 << 20;

/// The entries of what is inside, as long as any are left; then how many nodes are not told.
fn inside(nodes: &[Node], left: &mut usize) -> Vec<Entry> {
    let mut entries = Vec::new();
    for (i, child) in nodes.iter().enumerate() {
        let Some(fewer) = left.checked_sub(1) else {
            let properties = vec![("nodes", json!(nodes.len() - i))];
            entries.push(Entry { kind: "left-out", span: None, properties, children: vec![] });
            break;
        };
        *left = fewer;
        entries.push(node(child, left));
    }
    entries
}

fn camera(camera: &Camera) -> Entry {
    let mut properties = vec![];
    properties.extend(camera.label.as_ref().map(|label| ("label", json!(label))));
    properties.extend([
        ("eye", vector(camera.eye)),
        ("look_at", vector(camera.look_at)),
        ("up", vector(camera.up)),
        ("fov", json!(camera.fov)),
        ("projection", json!(projection(camera.projection))),
    ]);
    if camera.aperture != 0.0 {
        properties.push(("aperture", json!(camera.aperture)));
    }
    properties.extend(camera.focus.map(|focus| ("focus", json!(focus))));
    Entry { kind: "camera", span: Some(camera.span), properties, children: vec![] }
}

fn render(settings: &RenderSettings) -> Entry {
    let RenderSettings {
        size,
        tracer,
        samples,
        depth,
        seed,
        sampler,
        filter,
        clamp,
        accelerator,
        exposure,
        tonemap,
        background,
        frames,
        fps,
        span,
        size_span: _,
    } = settings;
    let given = [
        ("size", size.map(|s| json!(s))),
        ("tracer", tracer.map(|t| json!(t.word()))),
        ("samples", samples.map(|n| json!(n))),
        ("depth", depth.map(|n| json!(n))),
        ("seed", seed.map(|n| json!(n))),
        ("sampler", sampler.map(|s| json!(s.word()))),
        ("filter", filter.map(|f| json!(f.word()))),
        ("clamp", clamp.map(|x| json!(x))),
        ("accelerator", accelerator.map(|a| json!(a.word()))),
        ("exposure", exposure.map(|x| json!(x))),
        ("tonemap", tonemap.map(|t| json!(t.word()))),
        ("background", background.map(vector)),
        ("frames", frames.map(|n| json!(n))),
        ("fps", fps.map(|x| json!(x))),
    ];
    let properties = given.into_iter().filter_map(|(name, value)| Some((name, value?))).collect();
    Entry { kind: "render", span: *span, properties, children: vec![] }
}

fn node(node: &Node, left: &mut usize) -> Entry {
    match node {
        Node::Object(it) => object(it, left),
        Node::Light(it) => light(it, left),
    }
}

fn light(light: &Light, left: &mut usize) -> Entry {
    let mut children = vec![];
    let mut properties = match &light.source {
        LightSource::Point { position, intensity } => {
            vec![("point", vector(*position)), ("intensity", vector(*intensity))]
        }
        LightSource::Spot { position, direction, cone, intensity } => vec![
            ("spot", vector(*position)),
            ("toward", vector(*direction)),
            ("cone", json!(cone)),
            ("intensity", vector(*intensity)),
        ],
        LightSource::Sun { direction, irradiance } => {
            vec![("sun", vector(*direction)), ("irradiance", vector(*irradiance))]
        }
        LightSource::Area { object: surface, radiance } => {
            children.push(object(surface, left));
            vec![("area", json!(shape_word(&surface.shape))), ("radiance", vector(*radiance))]
        }
        LightSource::Sky(Sky::Uniform(radiance)) => vec![("sky", vector(*radiance))],
        LightSource::Sky(Sky::Image { path, factor, .. }) => {
            vec![("sky", quoted(&path.display().to_string())), ("radiance", vector(*factor))]
        }
    };
    properties.extend(light.falloff.map(|falloff| ("falloff", json!(falloff))));
    if !light.shadow {
        properties.push(("shadow", json!("off")));
    }
    properties.push(("samples", json!(light.samples)));
    push_transform(&mut properties, light.transform.as_deref());
    Entry { kind: "light", span: Some(light.span), properties, children }
}

fn object(object: &Object, left: &mut usize) -> Entry {
    let mut properties = vec![];
    properties.extend(object.name.as_ref().map(|name| ("name", quoted(name))));
    properties.extend(shape_properties(&object.shape));
    push_transform(&mut properties, object.transform.as_deref());
    properties.extend(object.material.as_ref().map(|m| ("material", material(m))));
    let hidden = [
        ("camera", object.hide.camera),
        ("shadow", object.hide.shadow),
        ("reflection", object.hide.reflection),
    ];
    if hidden.iter().any(|(_, is)| *is) {
        let words: Vec<&str> = hidden.iter().filter(|(_, is)| *is).map(|(word, _)| *word).collect();
        properties.push(("hide", json!(words)));
    }
    let children = inside(object.shape.children(), left);
    Entry { kind: shape_word(&object.shape), span: Some(object.span), properties, children }
}

fn shape_word(shape: &Shape) -> &'static str {
    match shape {
        Shape::Sphere { .. } => "sphere",
        Shape::Plane { .. } => "plane",
        Shape::Disc(_) => "disc",
        Shape::Rect(_) => "rect",
        Shape::Box(_) => "box",
        Shape::Cone(cone) if cone.radii[0] == cone.radii[1] => "cylinder",
        Shape::Cone(_) => "cone",
        Shape::Torus(_) => "torus",
        Shape::Triangle(_) => "triangle",
        Shape::Mesh(_) => "mesh",
        Shape::Surface(surface) => surface.word(),
        Shape::Skin(_) => "skin",
        Shape::Model(_) => "model",
        Shape::Group(_) => "group",
        Shape::Csg(csg) => csg.op.word(),
        Shape::Implicit(_) => "implicit",
    }
}

fn shape_properties(shape: &Shape) -> Vec<(&'static str, Json)> {
    match shape {
        Shape::Sphere { center, radius } => vec![("center", vector(*center)), ("radius", json!(radius))],
        Shape::Plane { normal, offset } => vec![("normal", vector(*normal)), ("offset", json!(offset))],
        Shape::Disc(disc) => vec![
            ("center", vector(disc.center)),
            ("normal", vector(disc.normal)),
            ("radius", json!(disc.radius)),
        ],
        Shape::Rect(rect) => {
            vec![("center", vector(rect.center)), ("edges", json!([vector(rect.a), vector(rect.b)]))]
        }
        Shape::Box(corners) => vec![("min", vector(corners.0)), ("max", vector(corners.1))],
        Shape::Cone(cone) => {
            vec![("from", vector(cone.from)), ("to", vector(cone.to)), ("radii", json!(cone.radii))]
        }
        Shape::Torus(torus) => vec![
            ("center", vector(torus.center)),
            ("axis", vector(torus.axis)),
            ("radii", json!(torus.radii)),
        ],
        Shape::Triangle(triangle) => {
            let mut properties = vec![("vertices", json!(triangle.vertices.map(vector)))];
            properties.extend(triangle.normals.map(|n| ("normals", json!(n.map(vector)))));
            properties.extend(triangle.uvs.map(|uv| ("uvs", json!(uv.map(|uv| uv.to_array())))));
            properties
        }
        Shape::Mesh(mesh) => mesh_properties(mesh),
        Shape::Surface(surface) => surface_properties(surface),
        Shape::Skin(skin) => skin_properties(skin),
        Shape::Model(model) => {
            let mut properties = vec![("file", quoted(&model.path.display().to_string()))];
            let moment =
                model.moment.iter().flat_map(|m| [("clip", json!(m.clip)), ("at", json!(m.seconds))]);
            properties.extend(moment);
            properties
        }
        Shape::Group(_) => vec![],
        Shape::Implicit(implicit) => {
            let (min, max) = implicit.within;
            let mut properties = vec![("within", json!([vector(min), vector(max)]))];
            properties.extend(implicit.gradient.map(|(bound, _)| ("gradient", json!(bound))));
            properties
        }
        Shape::Csg(csg) => csg.inverse.then(|| ("inverse", json!(true))).into_iter().collect(),
    }
}

fn mesh_properties(mesh: &MeshSource) -> Vec<(&'static str, Json)> {
    match mesh {
        MeshSource::File { path, smooth, .. } => {
            let mut properties = vec![("file", quoted(&path.display().to_string()))];
            properties.extend(smooth.map(|smooth| ("smooth", json!(smooth))));
            properties
        }
        MeshSource::Inline(mesh) => {
            vec![("vertices", json!(mesh.positions.len())), ("triangles", json!(mesh.triangles.len()))]
        }
    }
}

fn surface_properties(surface: &Surface) -> Vec<(&'static str, Json)> {
    match surface {
        Surface::Patch(patch) => patch_properties(patch),
        Surface::Tube(tube) => {
            let radius = match &tube.radius {
                Radius::Constant(radius) => json!(radius),
                Radius::Along(curve) => path(&**curve),
            };
            let caps = format!("{:?}", tube.caps).to_lowercase();
            vec![("along", path(&*tube.along)), ("radius", radius), ("caps", json!(caps))]
        }
        Surface::Lathe(lathe) => vec![("profile", path(&*lathe.profile)), ("angle", json!(lathe.angle))],
        Surface::Extrude(extrude) => {
            let along = match &extrude.along {
                Along::Vector(v) => vector(*v),
                Along::Path(curve) => path(&**curve),
            };
            vec![("outline", path(&*extrude.outline)), ("along", along)]
        }
    }
}

fn skin_properties(skin: &Skin) -> Vec<(&'static str, Json)> {
    let (word, mut properties) = match &skin.surface {
        SkinSurface::Mesh(mesh) => ("mesh", mesh_properties(mesh)),
        SkinSurface::Curved(surface) => (surface.word(), surface_properties(surface)),
    };
    let weights = match &skin.weights {
        Weights::Rigid => "rigid",
        Weights::Smooth(_) => "smooth",
        Weights::Listed(..) => "listed",
        Weights::Function(..) => "function",
    };
    let blend = match skin.blend {
        Blend::Linear => "linear",
        Blend::DualQuaternion => "dual_quaternion",
    };
    properties.splice(0..0, [("surface", json!(word))]);
    properties.extend([
        ("joints", json!(skin.armature.names)),
        ("weights", json!(weights)),
        ("blend", json!(blend)),
    ]);
    properties
}

/// A curve by where it begins and ends.
fn path<P: Point>(path: &dyn Path<P>) -> Json {
    let (start, end) = path.domain();
    let at = |t: f64| {
        let p = path.position(t);
        (0..P::DIMENSION).map(|axis| json!(p.coordinate(axis))).collect::<Vec<_>>()
    };
    json!({ "from": at(start), "to": at(end), "closed": path.closed() })
}

fn patch_properties(patch: &PatchSource) -> Vec<(&'static str, Json)> {
    let mut properties = vec![match &patch.net {
        PatchNet::File { path, .. } => ("file", quoted(&path.display().to_string())),
        PatchNet::Inline(patch) => ("pieces", json!(patch.pieces().len())),
    }];
    properties.extend(patch.method.map(|method| {
        let word = match method {
            PatchMethod::Tessellated => "tessellated",
            PatchMethod::Direct => "direct",
        };
        ("method", json!(word))
    }));
    properties.extend(patch.tolerance.map(|tolerance| ("tolerance", json!(tolerance))));
    properties
}

fn push_transform(properties: &mut Vec<(&'static str, Json)>, transform: Option<&Affine>) {
    if let Some(affine) = transform {
        let columns = affine.linear.to_cols_array().into_iter().chain(affine.translation.to_array());
        properties.push(("matrix", columns.map(|x| json!(x)).collect()));
    }
}

/// What of a material differs from the default.
fn material(material: &Material) -> Json {
    let mut map = Map::new();
    map.insert("diffuse".into(), texture(&material.diffuse));
    if let Some(layers) = &material.layers {
        map.extend(layer_properties(layers).into_iter().map(|(name, value)| (name.to_owned(), value)));
    }
    Json::Object(map)
}

fn layer_properties(layers: &Layers) -> Vec<(&'static str, Json)> {
    let standard = Layers::DEFAULT;
    let textures = [
        ("ambient", &layers.ambient, &standard.ambient),
        ("specular", &layers.specular, &standard.specular),
        ("exponent", &layers.exponent, &standard.exponent),
        ("reflect", &layers.reflect, &standard.reflect),
        ("transmit", &layers.transmit, &standard.transmit),
        ("ior", &layers.ior, &standard.ior),
        ("absorb", &layers.absorb, &standard.absorb),
        ("roughness", &layers.roughness, &standard.roughness),
        ("metal", &layers.metal, &standard.metal),
        ("emit", &layers.emit, &standard.emit),
        ("opacity", &layers.opacity, &standard.opacity),
    ];
    let given = textures.into_iter().map(|(name, is, was)| (name, texture(is), texture(was)));
    let mut properties: Vec<_> =
        given.filter(|(_, is, was)| is != was).map(|(name, is, _)| (name, is)).collect();
    if layers.lobe == Lobe::Phong {
        properties.push(("lobe", json!("phong")));
    }
    match layers.fresnel {
        Fresnel::None => {}
        Fresnel::Schlick => properties.push(("fresnel", json!("schlick"))),
        Fresnel::Exact => properties.push(("fresnel", json!("exact"))),
    }
    properties.extend(layers.normal_map.as_ref().map(|t| ("normal_map", texture(t))));
    properties.extend(layers.bump.as_ref().map(|t| ("bump", texture(t))));
    properties
}

/// A grey as a number, a colour as a vector, a pattern by its word and what it is made of.
fn texture(texture: &Texture) -> Json {
    match texture {
        Texture::Constant(c) if c.x == c.y && c.y == c.z => json!(c.x),
        Texture::Constant(c) => vector(*c),
        Texture::Pattern(it) => {
            let (word, parts) = pattern(&it.kind);
            let mut map = Map::new();
            map.insert(word.into(), parts);
            if let Some(affine) = &it.transform {
                let mut moved = vec![];
                push_transform(&mut moved, Some(affine));
                map.extend(moved.into_iter().map(|(name, value)| (name.to_owned(), value)));
            }
            Json::Object(map)
        }
    }
}

fn pattern(kind: &PatternKind) -> (&'static str, Json) {
    let pair = |a: &Texture, b: &Texture| json!([texture(a), texture(b)]);
    match kind {
        PatternKind::Checker(a, b) => ("checker", pair(a, b)),
        PatternKind::Stripes(list) => ("stripes", list.iter().map(texture).collect()),
        PatternKind::Gradient(a, b) => ("gradient", pair(a, b)),
        PatternKind::Ramp(by, stops) => {
            let stops = stops.iter().map(|(at, t)| json!([at, texture(t)]));
            ("ramp", json!([texture(by), stops.collect::<Vec<_>>()]))
        }
        PatternKind::Image(image) => ("image", quoted(&image.path.display().to_string())),
        PatternKind::Weight(joint) => ("weights_of", json!(joint)),
        PatternKind::Marble(a, b) => ("marble", pair(a, b)),
        PatternKind::Wood(a, b) => ("wood", pair(a, b)),
        PatternKind::Noise(a, b) => ("noise", pair(a, b)),
        PatternKind::Function(function) => (
            "function",
            json!(match function.input {
                SampleInput::Point => "of the point",
                SampleInput::Uv => "of (u, v)",
                SampleInput::Hit => "of the hit",
            }),
        ),
    }
}

fn vector(v: DVec3) -> Json {
    let Rgb { x, y, z } = v;
    json!([x, y, z])
}

fn quoted(text: &str) -> Json {
    json!(format!("{text:?}"))
}

fn projection(projection: Projection) -> &'static str {
    match projection {
        Projection::Perspective => "perspective",
        Projection::Orthographic => "orthographic",
        Projection::Fisheye => "fisheye",
        Projection::Panorama => "panorama",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::SourceId;
    use std::sync::Arc;

    fn count(entries: &[Entry]) -> usize {
        entries.iter().map(|entry| 1 + count(&entry.children)).sum()
    }

    #[test]
    fn what_is_placed_without_end_is_told_in_part() {
        let span = Span::new(SourceId(0), 0, 0);
        let placed = |shape| Node::Object(Arc::new(Object::new(shape, span)));
        let mut all = placed(Shape::Sphere { center: DVec3::ZERO, radius: 1.0 });
        for _ in 0..60 {
            all = placed(Shape::Group(Arc::new([all.clone(), all])));
        }
        let told = inside(&[all], &mut 1000);
        let left_out = count(&told) - 1000;
        assert!((1..=60).contains(&left_out), "a line a level tells what is left out: {left_out}");
    }
}
