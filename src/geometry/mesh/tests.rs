use super::*;

fn cube() -> Mesh {
    let positions =
        (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1))).collect();
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh::from_faces(positions, faces, vec![], vec![]).unwrap()
}

fn ring(points: &[[f64; 2]]) -> Mesh {
    let positions: Vec<DVec3> = points.iter().map(|p| DVec3::new(p[0], p[1], 0.0)).collect();
    let face: Vec<u32> = (0..points.len() as u32).collect();
    Mesh::from_faces(positions, [face], vec![], vec![]).unwrap()
}

#[test]
fn a_cube_has_its_area_volume_and_corner_normals() {
    let mut mesh = cube();
    assert_eq!((mesh.triangles.len(), mesh.area(), mesh.volume()), (12, 6.0, 1.0));
    assert_eq!(mesh.bounds(), Aabb { min: DVec3::ZERO, max: DVec3::ONE });
    mesh.compute_normals();
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        let diagonal = (*p - 0.5).normalize();
        assert!((*n - diagonal).length() < 1e-15, "the diagonals of the faces tilt the normal at {p}: {n}");
    }
}

#[test]
fn a_concave_quad_is_cut_from_its_reflex_corner() {
    for turned in 0..4 {
        let mut points = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0]];
        points.rotate_left(turned);
        let mesh = ring(&points);
        assert!((mesh.area() - 1.5).abs() < 1e-15, "{turned}: {}", mesh.area());
        assert!((0..2).all(|t| doubled_area(mesh.corners(t)).z > 0.0));
    }
}

#[test]
fn a_concave_polygon_is_not_fanned() {
    let star: Vec<[f64; 2]> = (0..20)
        .map(|i| {
            let (s, c) = crate::math::elementary::sin_cos_degrees(18.0 * f64::from(i));
            let r = if i % 2 == 0 { 2.0 } else { 0.5 };
            [r * c, r * s]
        })
        .collect();
    let (s, _) = crate::math::elementary::sin_cos_degrees(18.0);
    let mesh = ring(&star);
    assert_eq!(mesh.triangles.len(), 18);
    assert!((mesh.area() - 20.0 * 0.5 * 2.0 * 0.5 * s).abs() < 1e-14);
    assert!((0..18).all(|t| doubled_area(mesh.corners(t)).z > 0.0));
}

#[test]
fn polygons_keep_their_turn_along_every_axis() {
    let outline = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [1.0, 1.0], [0.0, 3.0]];
    for axis in 0..3 {
        for reversed in [false, true] {
            let mut positions: Vec<DVec3> = outline
                .iter()
                .map(|p| DVec3::from(std::array::from_fn(|i| [p[0], p[1], 5.0][(i + axis) % 3])))
                .collect();
            if reversed {
                positions.reverse();
            }
            let mesh = Mesh::from_faces(positions.clone(), [[0u32, 1, 2, 3, 4]], vec![], vec![]).unwrap();
            let mean: DVec3 = (0..3).map(|t| doubled_area(mesh.corners(t))).sum();
            assert!((mean.length() / 2.0 - mesh.area()).abs() < 1e-14, "a triangle is turned over");
            assert_eq!(mesh.area(), 6.0);
            let fan: DVec3 =
                (2..5).map(|i| doubled_area([positions[0], positions[i - 1], positions[i]])).sum();
            assert!(mean.dot(fan) > 0.0);
        }
    }
}

#[test]
fn corners_in_the_middle_of_an_edge_stay_vertices() {
    let mesh = ring(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [0.0, 1.0]]);
    let mut used: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    assert_eq!(used, [0, 1, 2, 3, 4, 5, 6]);
    assert_eq!(mesh.area(), 9.0);
}

#[test]
fn faces_back_to_back_have_a_normal() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mut mesh = Mesh::from_faces(positions, [[0u32, 1, 2], [0, 2, 1]], vec![], vec![]).unwrap();
    mesh.compute_normals();
    assert_eq!(mesh.normals, [DVec3::Z; 3]);
}

#[test]
fn small_and_distant_meshes_have_the_normals_of_plain_ones() {
    let mut plain = cube();
    plain.compute_normals();
    for scale in [-600, -40, 40, 500] {
        let mut scaled = cube();
        scaled.positions.iter_mut().for_each(|p| *p *= crate::math::elementary::powi(2.0, scale));
        scaled.compute_normals();
        for (a, b) in plain.normals.iter().zip(&scaled.normals) {
            assert!((*a - *b).length() < 1e-15, "2^{scale}: {a} {b}");
        }
    }
}

#[test]
fn what_is_no_mesh_is_refused() {
    let positions = || vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let refused = |faces: Vec<Vec<u32>>, normals: Vec<DVec3>, uvs: Vec<DVec2>| {
        Mesh::from_faces(positions(), faces, normals, uvs).unwrap_err()
    };
    assert_eq!(refused(vec![vec![0, 1]], vec![], vec![]), MeshError::FewCorners { face: 0, corners: 2 });
    let outside = MeshError::IndexOutOfRange { face: 1, index: 3, count: 3 };
    assert_eq!(refused(vec![vec![0, 1, 2], vec![0, 1, 3]], vec![], vec![]), outside);
    assert_eq!(refused(vec![vec![0, 1, 1]], vec![], vec![]), MeshError::NoArea);
    assert_eq!(refused(vec![], vec![DVec3::ZERO; 3], vec![]), MeshError::ZeroNormal { index: 0 });
    assert!(matches!(refused(vec![], vec![DVec3::X], vec![]), MeshError::CountMismatch { given: 1, .. }));
    let not_finite = Mesh::from_faces(vec![DVec3::NAN], [[0u32; 3]], vec![], vec![]).unwrap_err();
    assert_eq!(not_finite, MeshError::NotFinite { what: "vertex", index: 0 });
}

#[test]
fn normals_given_are_made_unit_vectors() {
    let normals = vec![DVec3::Z * 1e-200, DVec3::Z * 7.0, DVec3::Z * 1e200];
    let mesh =
        Mesh::from_faces(vec![DVec3::ZERO, DVec3::X, DVec3::Y], [[0u32, 1, 2]], normals, vec![]).unwrap();
    assert_eq!(mesh.normals, [DVec3::Z; 3]);
}
