//! Mesh files as people have them: good ones load whole, bad ones are refused with a sentence, none panics.

use ogee::diag::{Diagnostic, SourceId, Span};
use ogee::scene::assets::obj::{LoadedMesh, load_obj};
use ogee::scene::assets::{AssetCache, DiskLoader};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };

/// The folder of test data; none, said aloud, where it is not given.
#[expect(clippy::print_stdout, reason = "a skipped test says so")]
fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("OGEE_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: OGEE_DATA does not name the folder of test data");
    }
    folder
}

fn load(path: &Path, smooth: Option<bool>) -> Result<LoadedMesh, Box<Diagnostic>> {
    load_obj(&AssetCache::new(&DiskLoader), path, smooth, SPAN)
}

fn load_text(text: &str) -> Result<LoadedMesh, Box<Diagnostic>> {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("a.obj");
    std::fs::write(&path, text).expect("a file for the test");
    load(&path, None)
}

fn refusal(text: &str) -> String {
    load_text(text).expect_err("a refusal").message
}

/// What becomes of each file of the collection: triangles, or a part of the sentence that refuses it.
const NASTY: &[(&str, Result<usize, &str>)] = &[
    ("assimp/box_UTF16BE.obj", Ok(12)),
    ("assimp/box_longline.obj", Ok(12)),
    ("assimp/box_mat_with_spaces.obj", Ok(12)),
    ("assimp/box_without_lineending.obj", Ok(12)),
    ("assimp/concave_polygon.obj", Ok(64)),
    ("assimp/cube_mtllib_after_g.obj", Ok(12)),
    ("assimp/cube_with_vertexcolors.obj", Ok(12)),
    ("assimp/malformed.obj", Err("line 23, column 5: a face refers to vertex 12, but the file has 8")),
    ("assimp/malformed2.obj", Ok(10)),
    ("assimp/mtl_different_folder.obj", Ok(12)),
    ("assimp/multiple_spaces.obj", Ok(1)),
    ("assimp/number_formats.obj", Err("line 11, column 14: `3.1+e2` is not a number")),
    ("assimp/only_a_part_of_vertexcolors.obj", Ok(3)),
    ("assimp/point_cloud.obj", Err("no faces")),
    ("assimp/regr01.obj", Ok(2706)),
    ("assimp/regr_3429812.obj", Ok(4)),
    ("assimp/space_in_material_name.obj", Ok(64)),
    ("assimp/testline.obj", Err("no faces")),
    ("assimp/testmixed.obj", Ok(12)),
    ("draco/deg_faces.obj", Ok(3)),
    ("draco/degenerate_mesh.obj", Err("area")),
    ("draco/empty_name.obj", Ok(1)),
    ("draco/eof_test.obj", Ok(1)),
    ("draco/extra_vertex.obj", Ok(3)),
    ("draco/inf_nan.obj", Err("line 1, column 3: `inf` is not a finite number")),
    ("draco/non_manifold_wrap.obj", Ok(12)),
    ("draco/octagon.obj", Ok(6)),
    ("tinyobjloader/cornell_box_multimaterial.obj", Ok(36)),
    ("tinyobjloader/cube-vertex-w-component.obj", Ok(12)),
    ("tinyobjloader/invalid-face-definition.obj", Err("three corners")),
    ("tinyobjloader/invalid-relative-texture-index.obj", Err("refers to vertex 1, but the file has 0")),
    ("tinyobjloader/invalid-relative-vertex-index.obj", Err("before the first")),
    ("tinyobjloader/issue-140-zero-face-idx.obj", Err("index 0")),
    ("tinyobjloader/issue-161-inconsistent-f.obj", Ok(12)),
    ("tinyobjloader/issue-295-trianguation-failure.obj", Ok(28)),
    ("tinyobjloader/issue-356-leading-spaces-newmtl.obj", Err("no faces")),
    ("tinyobjloader/leading-decimal-dot-issue-201.obj", Ok(1)),
    ("tinyobjloader/missing_material_file.obj", Ok(36)),
    ("tinyobjloader/mtl filename with whitespace issue46.obj", Ok(12)),
    ("tinyobjloader/mtllib-multiple-files-issue-112.obj", Ok(1)),
    ("tinyobjloader/norm-texopt.obj", Ok(1)),
    ("tinyobjloader/pbr-mat-ext.obj", Ok(2)),
    ("tinyobjloader/skin-weight.obj", Ok(12)),
    ("tinyobjloader/smoothing-group-two-squares.obj", Ok(3)),
    ("tinyobjloader/smoothing-normal.obj", Ok(6)),
    ("tinyobjloader/test-nan.obj", Err("is not a")),
    ("tinyobjloader/texture-filename-with-whitespace.obj", Ok(12)),
    ("tinyobjloader/texture-options-issue-85.obj", Ok(1)),
    ("tinyobjloader/tr-and-d-issue-43.obj", Ok(400)),
    ("tinyobjloader/usemtl-issue-104.obj", Ok(6)),
    ("tobj/empty_name_triangle.obj", Ok(1)),
    ("tobj/invalid_index.obj", Err("refers to vertex 7, but the file has 6")),
    ("tobj/lines.obj", Err("no faces")),
    ("tobj/quad_colored_merge.obj", Ok(2)),
    ("trimesh/empty.obj", Err("no faces")),
    ("trimesh/emptyIO/obj_points.obj", Err("no faces")),
    ("trimesh/emptyIO/obj_wireframe.obj", Err("no faces")),
    ("trimesh/face_in_group_name.obj", Err("no faces")),
    ("trimesh/face_in_group_name_mid_file.obj", Ok(2)),
    ("trimesh/jacked.obj", Ok(12)),
    ("trimesh/joined_tetrahedra.obj", Ok(8)),
    ("trimesh/nancolor.obj", Ok(12)),
    ("trimesh/negative_indices.obj", Ok(12)),
    ("trimesh/notenoughindices.obj", Ok(1)),
    ("trimesh/obj_with_no_face_in_chunk.obj", Ok(1)),
    ("trimesh/polygonfaces.obj", Ok(3)),
    ("trimesh/singlevn.obj", Ok(2)),
    ("trimesh/two_objects.obj", Ok(16)),
];

fn obj_files(folder: &Path, under: &Path, into: &mut BTreeMap<String, PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the data") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            obj_files(&path, under, into);
        } else if path.extension().is_some_and(|e| e == "obj") {
            let name = path.strip_prefix(under).expect("a path below").to_string_lossy().into_owned();
            into.insert(name, path);
        }
    }
}

#[test]
fn every_nasty_file_loads_right_or_is_refused_in_words() {
    let Some(folder) = data().map(|d| d.join("meshes/nasty")) else { return };
    let mut files = BTreeMap::new();
    obj_files(&folder, &folder, &mut files);
    let mut faults = Vec::new();
    for (name, path) in files {
        let expected = NASTY.iter().find(|(n, _)| *n == name).map(|(_, e)| *e);
        let loaded = load(&path, None);
        let seen = loaded.as_ref().map(|m| m.mesh.triangles.len()).map_err(|d| d.message.as_str());
        if let Ok(mesh) = &loaded {
            check_sound(&mesh.mesh, &name);
        }
        let as_expected = match (expected, &seen) {
            (Some(Ok(n)), Ok(m)) => n == *m,
            (Some(Err(part)), Err(message)) => message.contains(part),
            _ => false,
        };
        if !as_expected {
            let warnings: Vec<_> = loaded.iter().flat_map(|m| &m.warnings).map(|w| &w.message).collect();
            faults.push(format!("{name}: {seen:?}, not {expected:?} {warnings:?}"));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

fn check_sound(mesh: &ogee::geometry::mesh::Mesh, name: &str) {
    let n = mesh.positions.len();
    assert!(mesh.triangles.iter().flatten().all(|i| (*i as usize) < n), "{name}");
    assert!(mesh.normals.is_empty() || mesh.normals.len() == n, "{name}");
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == n, "{name}");
    assert!(mesh.normals.iter().all(|v| (v.length() - 1.0).abs() < 1e-14), "{name}");
    assert!(mesh.uvs.iter().all(|v| v.is_finite()), "{name}");
    let materials = mesh.material_of_triangle.len();
    assert!(materials == 0 || materials == mesh.triangles.len(), "{name}");
}

#[test]
fn the_concave_polygon_covers_what_is_inside_it() {
    let Some(folder) = data() else { return };
    let loaded = load(&folder.join("meshes/nasty/assimp/concave_polygon.obj"), None).unwrap();
    assert!((loaded.mesh.area() - 0.2455).abs() < 5e-5, "{}", loaded.mesh.area());
    assert_eq!(loaded.mesh.triangles.len(), 64);
}

#[test]
fn the_cornell_box_has_its_numbers() {
    let Some(folder) = data() else { return };
    let loaded = load(&folder.join("meshes/cornell/CornellBox-Original.obj"), None).unwrap();
    assert_eq!((loaded.mesh.triangles.len(), loaded.materials.len()), (36, 8));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let emitters: Vec<_> = loaded
        .materials
        .iter()
        .filter_map(|m| match m.layers().emit {
            ogee::scene::Texture::Constant(ke) if ke != ogee::scene::Rgb::ZERO => Some(ke.to_array()),
            _ => None,
        })
        .collect();
    assert_eq!(emitters, [[17.0, 12.0, 4.0]]);
    assert!(loaded.mesh.normals.is_empty(), "a file without normals and smoothing groups is flat");
}

#[test]
fn corners_that_differ_in_anything_are_vertices_of_their_own() {
    let Some(folder) = data() else { return };
    let loaded = load(&folder.join("meshes/cornell/CornellBox-Sphere.obj"), None).unwrap();
    assert_eq!(loaded.mesh.triangles.len(), 2188);
    assert_eq!(loaded.mesh.normals.len(), loaded.mesh.positions.len());
    let tetrahedra = load(&folder.join("meshes/nasty/trimesh/joined_tetrahedra.obj"), None).unwrap();
    assert_eq!(tetrahedra.mesh.positions.len(), 15);
    let spot = load(&folder.join("meshes/spot/spot_triangulated.obj"), None).unwrap();
    assert_eq!((spot.mesh.triangles.len(), spot.mesh.positions.len()), (5856, 3225));
}

#[test]
fn quads_and_triangles_of_one_surface_enclose_one_volume() {
    let Some(folder) = data() else { return };
    let of = |name: &str| load(&folder.join("meshes/spot").join(name), None).unwrap().mesh;
    let (triangles, quads) = (of("spot_triangulated.obj"), of("spot_quadrangulated.obj"));
    assert_eq!(triangles.triangles.len(), quads.triangles.len());
    assert!((triangles.volume() / quads.volume() - 1.0).abs() < 1e-3);
}

#[test]
fn a_large_scan_loads_whole_and_smooth_on_gives_it_normals() {
    let Some(folder) = data() else { return };
    let bunny = folder.join("meshes/bunny/stanford-bunny.obj");
    let flat = load(&bunny, None).unwrap();
    assert_eq!((flat.mesh.triangles.len(), flat.mesh.positions.len()), (69_451, 34_834));
    assert!(flat.mesh.normals.is_empty());
    let smooth = load(&bunny, Some(true)).unwrap();
    check_sound(&smooth.mesh, "bunny");
    assert_eq!(smooth.mesh.normals.len(), 34_834);
    let bounds = flat.mesh.bounds();
    assert!((bounds.min.x + 0.0947).abs() < 1e-4 && (bounds.max.y - 0.1873).abs() < 1e-4, "{bounds:?}");
}

#[test]
fn one_bit_palettes_and_alpha_of_leaves_are_read() {
    let Some(folder) = data() else { return };
    let teapot = load(&folder.join("meshes/teapot-mcguire/teapot.obj"), None).unwrap();
    assert_eq!(teapot.mesh.triangles.len(), 15_704);
    assert!(teapot.warnings.is_empty(), "{:?}", teapot.warnings);
    let pine = load(&folder.join("meshes/scrub-pine/scrubPine.obj"), None).unwrap();
    assert_eq!(pine.mesh.triangles.len(), 527);
    let cut_out = |m: &ogee::scene::Material| matches!(m.layers().opacity, ogee::scene::Texture::Pattern(_));
    assert_eq!(pine.materials.iter().map(|m| cut_out(m)).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn smoothing_groups_keep_the_edge_between_them() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\n";
    let normals_at_edge = |groups: [&str; 2]| {
        let text = format!("{square}s {}\nf 1 2 3 4\ns {}\nf 2 5 6 3\n", groups[0], groups[1]);
        let mesh = load_text(&text).unwrap().mesh;
        let at_edge = mesh.positions.iter().zip(&mesh.normals).filter(|(p, _)| p.x == 1.0 && p.z == 0.0);
        at_edge.map(|(_, n)| n.to_array()).collect::<Vec<_>>()
    };
    let half = 0.5f64.sqrt();
    assert_eq!(normals_at_edge(["1", "1"]).len(), 2);
    assert!((normals_at_edge(["1", "1"])[0][0] - half).abs() < 1e-15);
    for apart in [["1", "2"], ["1", "off"], ["off", "3"]] {
        let normals = normals_at_edge(apart);
        assert_eq!(normals.len(), 4, "{apart:?}");
        assert!(normals.iter().all(|n| n[0] == 1.0 || n[2] == 1.0), "{apart:?} {normals:?}");
    }
    assert!(normals_at_edge(["off", "off"]).is_empty());
}

#[test]
fn normals_of_no_length_are_computed_and_others_made_units() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 9\nvn 0 0 0\nvn nan 0 1\nf 1//1 2//2 3//3\n";
    assert_eq!(load_text(text).unwrap().mesh.normals, [glam::DVec3::Z; 3]);
}

#[test]
fn what_people_write_beside_the_format_is_understood() {
    let comments = "v 0 0 0 # origin\nv 1 0 0 0.5 0.5 0.5\n  v 0 1 0\nf 1 2 \\\n 3 # done\n";
    assert_eq!(load_text(comments).unwrap().mesh.triangles, [[0, 1, 2]]);
    let one_texture_number = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25\nf 1/1 2/1 3/1\n";
    assert_eq!(load_text(one_texture_number).unwrap().mesh.uvs, [glam::DVec2::new(0.25, 0.0); 3]);
    let forward = "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    assert_eq!(load_text(forward).unwrap().mesh.triangles.len(), 1);
}

#[test]
fn refusals_name_the_line_and_the_column() {
    let cases = [
        ("v 0 0\n", "line 1, column 1: a vertex needs three numbers"),
        ("v 0 0 0\nv 1 1e999 0\nv 0 1 0\nf 1 2 3\n", "line 2, column 5: `1e999` is not a finite number"),
        ("v 0 0 0\nf 1 1 x\n", "line 2, column 7: `x` is no corner"),
        ("v 0 0 0\nf 1 1 -2\n", "line 2, column 7: index -2 refers to a vertex before the first"),
        ("v 0 0 0\nf 1/1/1/1 1 1\n", "line 2, column 3: `1/1/1/1` is no corner"),
        ("v 0 0 0\nf 99999999999999999999 1 1\n", "is no index"),
        ("v 0 0 0\nvt 0 0\nf 1/2 1/1 1/1\n", "a face refers to texture coordinate 2, but the file has 1"),
    ];
    for (text, part) in cases {
        let message = refusal(text);
        assert!(message.contains(part), "{text:?}: {message}");
    }
}
