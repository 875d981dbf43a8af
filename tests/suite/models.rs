//! glTF files as people have them: good ones stand and move as an independent reading says, bad ones are refused with a sentence, none
//! panics.

use crate::run::Folder;
use glam::DVec3;
use ogee::diag::{SourceId, Span};
use ogee::geometry::mesh::Mesh;
use ogee::geometry::skin::deform;
use ogee::scene::assets::gltf::{Figure, Model, ModelError};
use ogee::scene::assets::image::Reading;
use ogee::scene::assets::{AssetCache, DiskLoader};
use ogee::scene::{MeshSource, Node, Object, PatternKind, Shape, SkinSurface, Texture, Weights};
use std::path::{Path, PathBuf};

const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };

/// The folder of glTF files; none, said aloud, where no data is given.
fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("OGEE_DATA").map(|data| PathBuf::from(data).join("gltf"));
    if folder.is_none() {
        println!("skipped: OGEE_DATA does not name the folder of test data");
    }
    folder
}

/// A model as its file has it, or at a moment of a clip.
fn figure(path: &Path, moment: Option<(usize, f64)>) -> Result<Figure, ModelError> {
    let model = Model::read(&DiskLoader, path)?;
    let clip = moment.map(|(clip, _)| model.clip(&DiskLoader, clip)).transpose()?;
    let places = model.places(clip.as_ref().zip(moment.map(|(_, seconds)| seconds)));
    model.figure(&AssetCache::new(&DiskLoader), &places, SPAN)
}

fn objects(figure: &Figure) -> impl Iterator<Item = &Object> {
    figure.parts.iter().map(|node| match node {
        Node::Object(object) => &**object,
        Node::Light(_) => panic!("a model has no lights"),
    })
}

/// The mesh of a part, in the space of the model.
fn moved(object: &Object) -> Mesh {
    let inline = |source: &MeshSource| match source {
        MeshSource::Inline(mesh) => mesh.clone(),
        MeshSource::File { .. } => panic!("a part has its triangles"),
    };
    match &object.shape {
        Shape::Mesh(source) => {
            let (mut mesh, place) = (inline(source), object.transform.as_ref().expect("a place"));
            mesh.positions.iter_mut().for_each(|p| *p = place.point(*p));
            mesh
        }
        Shape::Skin(skin) => {
            let SkinSurface::Mesh(source) = &skin.surface else { panic!("a mesh") };
            let Weights::Listed(rows, _) = &skin.weights else { panic!("listed weights") };
            let mut mesh = inline(source);
            deform(&mut mesh, rows, &skin.armature.motions, skin.blend);
            mesh
        }
        other => panic!("a part is a mesh or a skin, and not {other:?}"),
    }
}

/// What becomes of each file: parts and triangles, or a part of the sentence that refuses it.
type Fate = Result<(usize, usize), &'static str>;

const FILES: &[(&str, Fate)] = &[
    ("CesiumMan.glb", Ok((1, 4672))),
    ("Fox.glb", Ok((1, 576))),
    ("InterpolationTest/InterpolationTest.gltf", Ok((10, 110))),
    ("RiggedFigure.glb", Ok((1, 256))),
    ("RiggedSimple.glb", Ok((1, 188))),
    ("SimpleSkin.gltf", Ok((1, 8))),
    ("nasty/BoxBadNormals.glb", Ok((1, 12))),
    ("nasty/BoxWithInfinites.glb", Err("holds -inf in element 0")),
    ("nasty/IndexOutOfRange.gltf", Err("it refers to vertex")),
    ("nasty/NoScene.gltf", Err("it shows scene 0, but it has 0 scenes")),
    ("nasty/RecursiveNodes.gltf", Err("node 0 hangs in a circle of nodes")),
    ("nasty/quad_skin.glb", Ok((1, 2))),
    ("nasty/unassigned-skeleton.gltf", Err("inverse bind matrix 0 is not affine")),
];

fn model_files(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder of the data") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            all.extend(model_files(&path));
        } else if path.extension().is_some_and(|e| e == "glb" || e == "gltf") {
            all.push(path);
        }
    }
    all.sort();
    all
}

#[test]
fn every_file_loads_right_or_is_refused_in_words() {
    let Some(folder) = data() else { return };
    let mut faults = Vec::new();
    for path in model_files(&folder) {
        let name = path.strip_prefix(&folder).expect("a path below").to_string_lossy().into_owned();
        let expected = FILES.iter().find(|(n, _)| *n == name).map(|(_, e)| *e);
        let loaded = figure(&path, None);
        let seen = loaded.as_ref().map(|figure| {
            let meshes: Vec<Mesh> = objects(figure).map(moved).collect();
            meshes.iter().for_each(|mesh| check_sound(mesh, &name));
            (meshes.len(), meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>())
        });
        let as_expected = match (expected, &seen) {
            (Some(Ok(counts)), Ok(found)) => counts == *found,
            (Some(Err(part)), Err(error)) => error.to_string().contains(part),
            _ => false,
        };
        if !as_expected {
            faults.push(format!("{name}: {seen:?}, not {expected:?}"));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

fn check_sound(mesh: &Mesh, name: &str) {
    let n = mesh.positions.len();
    assert!(mesh.positions.iter().all(|p| p.is_finite()), "{name}");
    assert!(mesh.triangles.iter().flatten().all(|i| (*i as usize) < n), "{name}");
    assert!(mesh.normals.is_empty() || mesh.normals.len() == n, "{name}");
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == n, "{name}");
    assert!(mesh.normals.iter().all(|v| (v.length() - 1.0).abs() < 1e-14), "{name}");
}

#[test]
fn what_was_mended_or_is_not_drawn_is_said() {
    let Some(folder) = data() else { return };
    let mended = |name: &str| figure(&folder.join(name), None).unwrap().mended;
    let divided = "have weights that do not add up to 1: they were divided by their sums";
    assert_eq!(mended("CesiumMan.glb"), [format!("210 vertices {divided}")]);
    assert_eq!(mended("RiggedFigure.glb"), [format!("31 vertices {divided}")]);
    assert_eq!(mended("nasty/quad_skin.glb"), ["colours of vertices are not drawn"]);
    for silent in ["Fox.glb", "RiggedSimple.glb", "SimpleSkin.gltf", "nasty/BoxBadNormals.glb"] {
        assert!(mended(silent).is_empty(), "{silent}: {:?}", mended(silent));
    }
}

/// Vertices of skins: file, clip, seconds, size; number and place of vertices. By tests/oracle/skins.py.
type Moved = ((&'static str, usize, f64, f64), &'static [(usize, [f64; 3])]);

const SKINS: &[Moved] = &[
    (
        ("CesiumMan.glb", 0, 0.6, 1.750330),
        &[
            (0, [0.104119780, 0.949863810, -0.015271200]),
            (297, [0.218169903, 0.868291797, 0.153879692]),
            (594, [-0.097141804, 1.386730229, -0.000820976]),
            (892, [0.184931985, 1.424544760, 0.057622316]),
            (1189, [0.063761346, 1.469132396, -0.057712867]),
            (1487, [0.182593302, 1.418874148, 0.047196589]),
            (1784, [-0.082554233, 1.407202101, 0.064139570]),
            (2082, [0.185555814, 1.248693866, 0.061602710]),
            (2379, [-0.067380331, 1.034390427, -0.020292317]),
            (2677, [-0.082946059, 1.446780395, 0.052254784]),
            (2974, [0.179877422, 0.832659360, 0.175199433]),
            (3272, [-0.101652309, 1.412700856, -0.021323740]),
        ],
    ),
    (
        ("CesiumMan.glb", 0, 1.37, 1.628448),
        &[
            (0, [0.116009604, 0.987670918, -0.008933379]),
            (297, [0.054903114, 0.823750881, 0.156156810]),
            (594, [-0.035336765, 1.442804001, 0.058384235]),
            (892, [0.227509565, 1.423845581, 0.180609738]),
            (1189, [0.142912814, 1.507057532, 0.054484225]),
            (1487, [0.227031204, 1.420571930, 0.168980071]),
            (1784, [-0.034086853, 1.448814353, 0.127767839]),
            (2082, [0.206574404, 1.252349113, 0.147898763]),
            (2379, [-0.012087893, 1.044845980, -0.046536217]),
            (2677, [-0.027055152, 1.489413804, 0.124592408]),
            (2974, [-0.001206572, 0.807541174, 0.153627418]),
            (3272, [-0.031850939, 1.472381534, 0.043277923]),
        ],
    ),
    (
        ("Fox.glb", 0, 2.2, 175.151576),
        &[
            (0, [2.055215755, 34.045323522, -20.726174447]),
            (157, [-4.495537706, 26.251696946, 20.551522955]),
            (314, [-6.829306116, 33.705912818, -14.204831295]),
            (471, [10.699071664, 47.999232484, -35.595579672]),
            (628, [9.995222005, 57.123785228, -8.858124837]),
            (785, [-7.041915147, 41.604035774, -35.415012585]),
            (942, [-7.156153407, 36.517788288, -63.647363015]),
            (1099, [-11.299949811, 51.513695277, 10.863109145]),
            (1256, [7.787856749, 65.674221809, 34.741477307]),
            (1413, [5.666608734, 5.065491101, 20.760736040]),
            (1570, [-8.264457326, 17.049333994, 22.186961061]),
            (1727, [-0.000050107, 55.595237258, 68.789034530]),
        ],
    ),
    (
        ("Fox.glb", 1, 0.33, 179.869573),
        &[
            (0, [1.730258445, 33.870280551, -19.972521430]),
            (157, [-4.569832812, 28.058855095, 30.342115523]),
            (314, [-7.129011081, 32.894235852, -14.623919863]),
            (471, [10.546500381, 46.981086152, -35.562202787]),
            (628, [9.992112943, 56.379341818, -8.857881209]),
            (785, [-7.257822985, 41.376833023, -35.578938245]),
            (942, [-6.030617125, 38.719871148, -64.109144555]),
            (1099, [-11.404146722, 50.951919256, 10.839880211]),
            (1256, [7.688976193, 62.984057382, 37.000247365]),
            (1413, [5.656220377, 5.459977254, 5.308314979]),
            (1570, [-8.303592002, 22.198817899, 36.908322746]),
            (1727, [-0.168434711, 52.112344388, 69.993207653]),
        ],
    ),
    (
        ("Fox.glb", 2, 0.4, 178.690819),
        &[
            (0, [2.907300308, 31.313251087, -23.885842462]),
            (157, [-5.179403202, 30.385720220, 40.488297846]),
            (314, [-7.756785032, 28.991594973, -19.367734630]),
            (471, [10.494183761, 48.638375137, -33.539130278]),
            (628, [9.995226346, 53.376153008, -6.174696810]),
            (785, [-6.945141324, 43.555685097, -35.157832630]),
            (942, [-5.704140013, 67.765318240, -64.642851822]),
            (1099, [-11.299944111, 46.786416337, 13.005809584]),
            (1256, [7.787867187, 58.224910415, 40.200210211]),
            (1413, [6.774183505, 24.814018258, 59.758918608]),
            (1570, [-9.266378914, 22.293236738, 47.264448158]),
            (1727, [-0.000038215, 45.951804970, 72.435677982]),
        ],
    ),
];

#[test]
fn skinned_vertices_are_where_an_independent_reading_takes_them() {
    let Some(folder) = data() else { return };
    for ((name, clip, seconds, size), vertices) in SKINS {
        let figure = figure(&folder.join(name), Some((*clip, *seconds))).unwrap();
        let mesh = moved(objects(&figure).next().expect("a part"));
        for (vertex, expected) in *vertices {
            let off = (mesh.positions[*vertex] - DVec3::from(*expected)).length() / size;
            assert!(off < 1e-8, "{name} {clip} {seconds} vertex {vertex}: off by {off:e} of its size");
        }
    }
}

/// Where (1, 1, 1) of a node goes: clip, node, seconds, place. By tests/oracle/skins.py.
#[expect(clippy::approx_constant, reason = "a place, and not the constant")]
const INTERPOLATED: &[(&str, usize, f64, [f64; 3])] = &[
    ("Step Scale", 0, 0.7, [0.500000000, 0.500000000, 0.500000000]),
    ("Step Scale", 0, 1.2, [1.000000000, 1.000000000, 1.000000000]),
    ("Linear Scale", 3, 0.7, [-2.487238823, 0.809090913, 0.809155525]),
    ("Linear Scale", 3, 1.2, [-2.729663070, 0.566666667, 0.566731278]),
    ("CubicSpline Scale", 4, 0.7, [4.177105093, 0.836985731, 0.845930719]),
    ("CubicSpline Scale", 4, 1.2, [3.864415658, 0.524296296, 0.533241285]),
    ("Step Rotation", 5, 0.7, [1.414213562, 3.356412383, 1.000000000]),
    ("Step Rotation", 5, 1.2, [1.000000000, 2.356412411, 1.000000000]),
    ("Linear Rotation", 7, 0.7, [-2.060622259, 2.696445175, 1.000000000]),
    ("Linear Rotation", 7, 1.2, [-3.163573513, 1.949946157, 1.000000000]),
    ("CubicSpline Rotation", 6, 0.7, [4.531191173, 2.601909597, 1.000000000]),
    ("CubicSpline Rotation", 6, 1.2, [3.306055656, 1.942496344, 1.000000000]),
    ("Step Translation", 8, 0.7, [1.000000000, 11.000000000, 1.000000000]),
    ("Step Translation", 8, 1.2, [1.000000000, 7.000000000, 1.000000000]),
    ("Linear Translation", 10, 0.7, [-2.297580719, 8.279999840, 1.000000000]),
    ("Linear Translation", 10, 1.2, [-2.297580719, 10.520000023, 1.000000000]),
    ("CubicSpline Translation", 9, 0.7, [4.305179834, 7.966655791, 1.000000000]),
    ("CubicSpline Translation", 9, 1.2, [4.305179834, 10.841024015, 1.000000000]),
];

#[test]
fn every_interpolation_of_every_property_is_that_of_an_independent_reading() {
    let Some(folder) = data() else { return };
    let model = Model::read(&DiskLoader, &folder.join("InterpolationTest/InterpolationTest.gltf")).unwrap();
    for (name, node, seconds, expected) in INTERPOLATED {
        let index = model.clips().iter().position(|clip| clip == name).expect("a clip of the file");
        let clip = model.clip(&DiskLoader, index).unwrap();
        let place = model.places(Some((&clip, *seconds)))[*node];
        let off = (place.linear * DVec3::ONE + place.origin - DVec3::from(*expected)).length();
        assert!(off < 1e-8, "{name} at {seconds}: off by {off:e}");
    }
}

#[test]
fn the_simple_skin_bends_as_by_hand() {
    let Some(folder) = data() else { return };
    // At 1 s the upper joint at (0, 1, 0) is turned by a quarter about z; both joints were bound at (0.5, 1, 0).
    let figure = figure(&folder.join("SimpleSkin.gltf"), Some((0, 1.0))).unwrap();
    let mesh = moved(objects(&figure).next().expect("a part"));
    let by_hand = [(0, [-0.5, 0.0]), (1, [0.5, 0.0]), (4, [-0.25, 0.75]), (8, [-1.0, 0.5]), (9, [-1.0, 1.5])];
    for (vertex, [x, y]) in by_hand {
        let off = (mesh.positions[vertex] - DVec3::new(x, y, 0.0)).length();
        assert!(off < 1e-15, "vertex {vertex}: {}", mesh.positions[vertex]);
    }
}

/// The example's file, which is there without any data.
fn reed() -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/models/reed.gltf"))
        .expect("the example's model")
}

/// All that reads a file, of bytes in a folder of their own: how many parts it has in its clips.
fn read_all(bytes: &[u8]) -> Result<usize, ModelError> {
    let folder = Folder::new();
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, bytes).expect("a file for the test");
    let clips = Model::read(&DiskLoader, &path)?.clips().len();
    let mut figures = (0..clips).map(|clip| figure(&path, Some((clip, 0.7))));
    figures.try_fold(0, |n, figure| Ok(n + figure?.parts.len()))
}

/// A triangle of glass on its left half: the picture of transmission is red beside cyan.
const SHEER: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"extensionsUsed":["KHR_materials_transmission","KHR_materials_volume"],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,1,1],"metallicFactor":0},"extensions":{
"KHR_materials_transmission":{"transmissionFactor":0.75,"transmissionTexture":{"index":0}},
"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[1,0.5,0.25]}}}],
"textures":[{"source":0,"sampler":0}],"samplers":[{"magFilter":9728}],"images":[{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mP4z8DA8P8/AAj+Av4ISQbsAAAAAElFTkSuQmCC"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},{"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},{"buffer":0,"byteOffset":60,"byteLength":6}],
"buffers":[{"byteLength":66,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAABAAIA"}]}"#;

#[test]
fn a_picture_of_transmission_and_the_colour_of_a_volume_reach_the_material() {
    let folder = Folder::with(&[("sheer.gltf", SHEER)]);
    let figure = figure(&folder.path().join("sheer.gltf"), None).unwrap();
    let object = objects(&figure).next().expect("a part");
    let material = object.material.as_ref().expect("a material");
    let layers = material.layers.as_ref().expect("layers");
    let seen = |texture: &Texture, x: f64| {
        let Texture::Pattern(pattern) = texture else { panic!("a picture") };
        let PatternKind::Image(image) = &pattern.kind else { panic!("a picture") };
        let [r, g, b, _] = image.picture.get().expect("it is read").nearest(x, 0.5, Reading::Colour);
        DVec3::new(r, g, b)
    };
    let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-6, "{a} and not {b}");
    near(seen(&layers.transmit, 0.25), DVec3::new(0.75, 0.375, 0.75));
    near(seen(&layers.transmit, 0.75), DVec3::ZERO);
    near(seen(&material.diffuse, 0.25), DVec3::new(0.25, 0.125, 0.25));
    near(seen(&material.diffuse, 0.75), DVec3::new(1.0, 0.5, 1.0));
    let Texture::Constant(absorb) = &layers.absorb else { panic!("a colour") };
    near(DVec3::from(absorb.to_array()), DVec3::new(0.0, 0.5 * 2f64.ln(), 2f64.ln()));
}

#[test]
fn a_file_whose_numbers_are_others_never_panics_and_never_eats_the_machine() {
    let reed = String::from_utf8(reed()).expect("JSON");
    assert_eq!(read_all(reed.as_bytes()), Ok(2));
    let end = reed.find("\"buffers\"").expect("buffers come last");
    let is_digit = |at: usize| reed.as_bytes()[at].is_ascii_digit();
    let starts: Vec<usize> = (1..end).filter(|at| is_digit(*at) && !is_digit(at - 1)).collect();
    let others =
        ["0", "1", "2", "7", "250", "65535", "4294967295", "18446744073709551615", "5125", "1e39", "-1"];
    let (mut refused, mut read) = (0, 0);
    for (i, start) in starts.iter().enumerate() {
        let length = reed[*start..].bytes().take_while(u8::is_ascii_digit).count();
        let other = others[(i * 7 + i / 11) % others.len()];
        match read_all(format!("{}{other}{}", &reed[..*start], &reed[start + length..]).as_bytes()) {
            Ok(_) => read += 1,
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
    }
    assert!(refused > starts.len() / 4 && read > 0, "{refused} refused, {read} read");
}

#[test]
fn faults_are_refused_where_they_are() {
    let reed = String::from_utf8(reed()).expect("JSON");
    let cases = [
        (r#""version": "2.0""#, r#""version": "1.0""#, "only glTF 2 is read"),
        (r#""children": [2]"#, r#""children": [20]"#, "has a child 20, but there are 5 nodes"),
        (r#""children": [4]"#, r#""children": [1]"#, "node 1 hangs in a circle"),
        (r#""children": [4]"#, r#""children": [2]"#, "node 2 hangs on two nodes"),
        (r#""joints": [1, 2, 3]"#, r#""joints": [1, 2]"#, "follows joint 2, but its skin has 2"),
        (r#""joints": [1, 2, 3]"#, r#""joints": [1, 2, 9]"#, "joint 9 is no node"),
        (r#""NORMAL": 1"#, r#""NORMAL": 5"#, "normals for 200 vertices"),
        (r#""POSITION": 0"#, r#""POSITION": 4"#, "is of type Scalar, which cannot be used here"),
        (r#""input": 8"#, r#""input": 5"#, "is of type Vec3, which cannot be used here"),
        ("data:application/octet-stream;base64,", "https://example.org/", "nothing is fetched"),
        ("data:application/octet-stream;base64,", "gone", "cannot be read"),
        (
            r#""scenes""#,
            r#""extensionsRequired": ["KHR_draco_mesh_compression"], "scenes""#,
            "needs the extension",
        ),
    ];
    for (from, to, part) in cases {
        assert!(reed.contains(from), "{from}");
        let error = read_all(reed.replacen(from, to, 1).as_bytes()).expect_err(to).to_string();
        assert!(error.contains(part), "{to}: {error}");
    }
}

const AROUND: &str = "camera { eye <0, 2, 8>  look_at <0, 2, 0> } light { sky 1 }\n";

/// A folder with the example's model and a scene of it.
fn with_reed(scene: &str) -> Folder {
    let folder = Folder::with(&[("a.scene", &format!("{AROUND}{scene}"))]);
    std::fs::write(folder.path().join("reed.gltf"), reed()).expect("a file for the test");
    folder
}

#[test]
fn a_clip_that_does_not_exist_gets_the_nearest() {
    let run = with_reed(r#"model { file "reed.gltf"  clip "swey" }"#).ogee("check a.scene").expect(1);
    assert_eq!(run.codes(), ["E0309"]);
    assert!(run.stderr.contains("did you mean `sway`?"), "{}", run.stderr);
}

#[test]
fn a_moment_outside_a_clip_is_its_end() {
    let picture = |at: &str| {
        let folder = with_reed(&format!(r#"model {{ file "reed.gltf"  {at} }}"#));
        folder.ogee("render --size 24x32 --samples 1 --tracer raycast a.scene").expect(0);
        folder.read("a.png")
    };
    assert!(picture("at 2") == picture("at 77") && picture("at 0") == picture("at -3"));
    assert!(picture("at 0.5") != picture("at 1.5"));
    assert!(picture("") == picture(r#"clip "sway""#), "the clip begins as the file stands");
}

#[test]
fn a_model_that_is_not_placed_is_not_read() {
    let scene = format!(r#"{AROUND}let m = model {{ file "bad.gltf" }} sphere {{ }}"#);
    let placed = format!(r#"{AROUND}model {{ file "bad.gltf" }}"#);
    let folder = Folder::with(&[("a.scene", &scene), ("b.scene", &placed), ("bad.gltf", "no JSON")]);
    assert!(folder.ogee("render --size 8x8 a.scene").expect(0).codes().is_empty());
    assert_eq!(folder.ogee("render --size 8x8 b.scene").expect(1).codes(), ["E0510"]);
}

const STILL: &str = r#"let still = model { file "reed.gltf" }
"#;

#[test]
fn the_nodes_of_a_model_are_joints_that_are_posed_and_reach_by_name() {
    let scene = r#"
assert(still.skeleton.joints == ["stalk", "foot", "waist", "neck", "flower"], "{still.skeleton.joints}")
pose bent { of still.skeleton  waist <0, 0, 90> }
assert(distance(bent.neck.position, <-1, 1, 0>) < 1e-15, "{bent.neck.position}")
let posed = model { file "reed.gltf"  pose bent }
assert(len(trace(posed, <-2.2, 1, 5>, <0, 0, -1>)) > 0, "the flower is where the pose takes it")
assert(len(trace(still, <-2.2, 1, 5>, <0, 0, -1>)) == 0, "and was not there before")
pose low { of still.skeleton  reach neck_tip, <1, 1.2, 0.3> }
assert(low.converged && distance(low.neck.position, <1, 1.2, 0.3>) < 1e-8, "{low.residual}")
let swaying = model { file "reed.gltf"  at 0.5 }
pose as_is { of swaying.skeleton }
let same = model { file "reed.gltf"  at 0.5  pose as_is }
for i in 0..9 {
  let from = <-0.4 + i * 0.2, 2.2, 5>
  let hits = trace(swaying, from, <0, 0, -1>)
  assert(len(hits) == len(trace(same, from, <0, 0, -1>)), "a pose with all angles 0 changes nothing")
}
"#;
    with_reed(&format!("{STILL}{scene} posed")).ogee("check a.scene").expect(0);
}

#[test]
fn a_copy_of_a_model_takes_another_pose_or_moment_and_keeps_the_rest() {
    let scene = r#"
pose bent { of still.skeleton  waist <0, 0, 90> }
let posed = still with { translate x  pose bent }
assert(len(trace(posed, <-1.2, 1, 5>, <0, 0, -1>)) > 0, "in the pose, and moved")
assert(len(trace(posed with { translate -x }, <-2.2, 1, 5>, <0, 0, -1>)) > 0, "the pose stays")
let swaying = model { file "reed.gltf"  clip "sway"  at 0.5 }
let later = still with { clip "sway"  at 1.5 }
let again = later with { at 0.5 }
for i in 0..9 {
  let from = <-0.4 + i * 0.2, 2.2, 5>
  assert(len(trace(swaying, from, -z)) == len(trace(again, from, -z)), "the clip stays")
}
assert(trace(swaying, <0, 2.2, 5>, -z) == trace(again, <0, 2.2, 5>, -z))
assert(later.skeleton.neck.position != swaying.skeleton.neck.position)
"#;
    with_reed(&format!("{STILL}{scene} posed")).ogee("check a.scene").expect(0);
    let unfit =
        "pose bent { of still.skeleton  waist <0, 0, 90> } (still with { pose bent }) with { at 0.5 }";
    let run = with_reed(&format!("{STILL}{unfit}")).ogee("check a.scene").expect(1);
    assert!(run.stderr.contains("of another skeleton"), "{}", run.stderr);
    let clip = r#"pose p { of still.skeleton  clip "sway"  at 1 }"#;
    let run = with_reed(&format!("{STILL}{clip} still")).ogee("check a.scene").expect(1);
    assert!(run.stderr.contains("only motion capture moves a skeleton"), "{}", run.stderr);
}

#[test]
fn a_pose_of_another_skeleton_is_refused() {
    let scene =
        r#"pose p { of (model { file "reed.gltf"  at 0.5 }).skeleton } model { file "reed.gltf"  pose p }"#;
    let run = with_reed(scene).ogee("check a.scene").expect(1);
    assert_eq!(run.codes(), ["E0303"]);
    assert!(run.stderr.contains("of another skeleton"), "{}", run.stderr);
}

#[test]
fn bones_are_drawn_in_place_of_the_model() {
    let scene = r#"let bones = model { file "reed.gltf"  show bones }
assert(len(trace(bones, <0, 0.5, 5>, <0, 0, -1>)) > 0, "a bone")
assert(len(trace(bones, <0.3, 3.1, 5>, <0, 0, -1>)) == 0, "and no flower")
bones"#;
    with_reed(scene).ogee("check a.scene").expect(0);
}
