//! How much light: pictures whose numbers are known from closed forms.

use crate::stage::*;
use glam::DVec3;
use ogee::geometry::mesh::Mesh;
use ogee::math::elementary::{asin, sin_cos_degrees};
use ogee::scene::*;
use std::f64::consts::PI;

const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;

/// What is seen of the floor (or of whatever is) under a point just above it, from a little to the side.
fn from_above(world: &ogee::world::World, x: f64, z: f64) -> f64 {
    seen(world, DVec3::new(x + 1e-3, 0.5, z), DVec3::new(x, 0.0, z))
}

#[test]
fn a_plane_under_a_point_light_follows_the_inverse_square() {
    let world = world(vec![object(plane(Y, 0.0), &diffuse(0.7)), point(2.0 * Y, 10.0)]);
    for (r, exact) in [(0.0, 0.557042), (1.0, 0.398587), (2.0, 0.196944), (5.0, 0.028535)] {
        near(from_above(&world, r, 0.0), exact, 5e-7);
    }
}

#[test]
fn falloff_replaces_the_inverse_square_where_it_is_asked_for() {
    let falling = |falloff| {
        let source = LightSource::Point { position: 2.0 * Y, intensity: Rgb::splat(PI) };
        world(vec![object(plane(Y, 0.0), &diffuse(1.0)), light_with(source, |l| l.falloff = falloff)])
    };
    near(from_above(&falling(None), 0.0, 0.0), 0.25, 1e-12);
    near(from_above(&falling(Some([0.0, 0.0, 1.0])), 0.0, 0.0), 1.0, 1e-12);
    near(from_above(&falling(Some([1.0, 1.0, 2.0])), 0.0, 0.0), 0.125, 1e-12);
}

#[test]
fn a_sun_on_a_sphere_gives_lamberts_cosine() {
    let world = world(vec![object(sphere(DVec3::ZERO, 1.0), &diffuse(0.5)), sun(-Z, PI)]);
    for x in [0.0, 0.3, 0.7, 0.99] {
        let p = DVec3::new(x, 0.0, (1.0f64 - x * x).sqrt());
        near(seen(&world, p + Z, p), 0.5 * p.z, 1e-12);
    }
    let mut camera = camera(2.0 * Z, DVec3::ZERO, 0.0);
    (camera.projection, camera.fov) = (Projection::Orthographic, 2.0 * 26.565_051_177_077_99);
    let film = picture(&world, &camera, &settings([256, 256]));
    near(film.mean().x / (PI / 4.0), 1.0 / 3.0, 1e-3);
}

#[test]
fn silhouettes_cover_their_solid_angle() {
    let flat = world(vec![object(disc(DVec3::ZERO, Z, 1.0), &glowing(1.0))]);
    let mut from = camera(2.0 * Z, DVec3::ZERO, 2.0 * 26.565_051_177_077_99);
    from.projection = Projection::Orthographic;
    near(picture(&flat, &from, &settings([512, 512])).mean().x, PI / 4.0, 5e-4);
    let round = world(vec![object(sphere(DVec3::ZERO, 1.0), &glowing(1.0))]);
    let film = picture(&round, &camera(3.0 * Z, DVec3::ZERO, 90.0), &settings([512, 512]));
    near(film.mean().x * 4.0, PI / 8.0, 1e-3);
}

#[test]
fn area_lights_give_the_closed_forms_through_the_tracer() {
    for (h, a, exact) in [(1.0, 0.0, 0.5), (1.0, 1.0, 0.276393), (1.0, 2.0, 0.052786)] {
        let light = area(disc(DVec3::new(a, h, 0.0), -Y, 1.0), 1.0, 16384);
        near(from_above(&world(vec![object(plane(Y, 0.0), &diffuse(1.0)), light]), 0.0, 0.0), exact, 2e-4);
    }
    let square = rect(Y, 0.5 * X, 0.5 * Z);
    assert!(0.5 * X.cross(0.5 * Z).y < 0.0, "faces down");
    let lit = world(vec![object(plane(Y, 0.0), &diffuse(1.0)), area(square, 1.0, 16384)]);
    near(from_above(&lit, 0.0, 0.0), 0.239456, 2e-4);
    let ball = area(sphere(2.0 * Y, 1.0), 1.0, 1024);
    near(from_above(&world(vec![object(plane(Y, 0.0), &diffuse(1.0)), ball]), 0.0, 0.0), 0.25, 1e-5);
}

#[test]
fn an_object_with_emit_lights_like_an_area_light() {
    let nodes = |shine: Node| vec![object(plane(Y, 0.0), &diffuse(1.0)), shine];
    let mut many = settings([1, 1]);
    many.samples = 256;
    let shape = || disc(Y, -Y, 1.0);
    for node in [object(shape(), &glowing(1.0)), area(shape(), 1.0, 16)] {
        let (l, _) = seen_by(&many, &world(nodes(node)), DVec3::new(1e-3, 0.5, 0.0), DVec3::ZERO);
        near(l.x, 0.5, 1e-3);
    }
}

#[test]
fn a_half_hidden_area_light_averages_the_product() {
    // The near half of the light hides behind a wall; averaging visibility alone would give 0.111.
    let light = area(rect(DVec3::new(2.0, 1.0, 0.0), 2.0 * X, 0.5 * Z), 1.0, 65536);
    let wall = rect(DVec3::new(0.0, 0.5, 0.0), X, 5.0 * Z);
    let world = world(vec![object(plane(Y, 0.0), &diffuse(1.0)), light, object(wall, &diffuse(0.0))]);
    let found = seen(&world, DVec3::new(1e-4, 1e-3, 0.0), DVec3::ZERO);
    near(found, 0.008399, 2e-4);
}

#[test]
fn penumbrae_have_their_closed_form() {
    for (x, exact) in
        [(-0.5, 0.0), (-0.25, 0.015898), (0.0, 0.036739), (0.25, 0.055656), (0.5, 0.066183), (1.0, 0.049522)]
    {
        let light = area(rect(2.0 * Y, 0.5 * X, 0.5 * Z), 1.0, 16384);
        let half_plane = rect(DVec3::new(-500.0, 1.0, 0.0), 500.0 * X, 500.0 * Z);
        let world =
            world(vec![object(plane(Y, 0.0), &diffuse(1.0)), light, object(half_plane, &diffuse(0.0))]);
        near(from_above(&world, x, 0.0), exact, 2e-4);
    }
}

#[test]
fn an_edge_cuts_off_its_part_of_a_far_disc() {
    // A disc of radius 1 a thousand away, cut half-way by an edge whose shadow lies at s.
    for (s, exact) in [(-0.9, 0.981307), (-0.5, 0.804499), (0.0, 0.5), (0.5, 0.195501), (0.9, 0.018693)] {
        let radiance = 1e6;
        let light = area(disc(1000.0 * Y, -Y, 1.0), radiance, 65536);
        let edge = rect(DVec3::new(s / 2.0 - 50.0, 500.0, 0.0), 50.0 * X, 50.0 * Z);
        let world = world(vec![object(plane(Y, 0.0), &diffuse(1.0)), light, object(edge, &diffuse(0.0))]);
        // (R/d)² of the whole disc, to a millionth.
        near(from_above(&world, 0.0, 0.0), exact, 1e-3);
    }
}

#[test]
fn a_wall_hides_its_half_of_the_sky() {
    for (d, exact) in [(0.1, 0.549752), (0.5, 0.723607), (1.0, 0.853553), (2.0, 0.947214)] {
        let wall = rect(DVec3::new(d, 0.5, 0.0), 0.5 * Y, 1e5 * Z);
        let world = world(vec![
            object(plane(Y, 0.0), &diffuse(1.0)),
            object(wall, &diffuse(0.0)),
            sky_samples(1.0, 16384),
        ]);
        let found = seen(&world, DVec3::new(-1e-3, 0.05, 0.0), DVec3::ZERO);
        near(found, exact, 1e-3);
    }
}

#[test]
fn a_ball_on_the_floor_shadows_the_sky_down_to_the_contact() {
    for (x, exact) in [(0.01, 0.000150), (0.1, 0.014815), (0.5, 0.284458), (1.0, 0.646447), (4.0, 0.985733)] {
        let world = world(vec![
            object(plane(Y, 0.0), &diffuse(1.0)),
            object(sphere(Y, 1.0), &diffuse(0.0)),
            sky_samples(1.0, 16384),
        ]);
        let p = DVec3::new(x, 0.0, 0.0);
        let found = seen(&world, p + DVec3::new(x * 0.1, x * x * 0.1, 0.0), p);
        near(found, exact, 1e-3);
    }
}

#[test]
fn glass_of_any_shape_in_a_uniform_sky_is_as_bright_as_the_sky() {
    let shapes = [
        sphere(DVec3::ZERO, 1.0),
        cuboid(-DVec3::ONE * 0.6, DVec3::ONE * 0.6),
        Shape::Torus(Box::new(Torus {
            center: DVec3::ZERO,
            axis: DVec3::new(0.0, 0.6, 0.8),
            radii: [0.7, 0.3],
        })),
        Shape::Cone(Box::new(Cone { from: -Y, to: Y, radii: [0.8, 0.3] })),
    ];
    for shape in shapes {
        for law in [Fresnel::Exact, Fresnel::Schlick] {
            let material = layered(0.0, |l| {
                (l.transmit, l.fresnel) = (Texture::number(1.0), law);
            });
            let world = world(vec![object(shape.clone(), &material), sky(1.0)]);
            let mut settings = settings([24, 24]);
            settings.depth = 400;
            let film = picture(&world, &camera(DVec3::new(0.4, 0.7, 3.0), DVec3::ZERO, 40.0), &settings);
            for (i, p) in film.pixels.iter().enumerate() {
                assert!((p.x - 1.0).abs() < 2e-3, "{shape:?} pixel {i}: {}", p.x);
            }
            near(film.mean().x, 1.0, 1e-4);
        }
    }
}

/// A slab of glass between z = 0 and z = 1, seen under an angle, in front of something.
fn through_slab(degrees: f64, behind: Vec<Node>) -> f64 {
    let slab = cuboid(DVec3::new(-1e4, -1.0, 0.0), DVec3::new(1e4, 1.0, 1.0));
    let mut nodes = behind;
    nodes.push(object(slab, &glass(1.5)));
    let (s, c) = sin_cos_degrees(degrees);
    seen(&world(nodes), DVec3::new(-s, 0.0, -c), DVec3::ZERO)
}

#[test]
fn a_slab_lets_through_what_all_its_bounces_sum_to() {
    for (degrees, exact) in
        [(0.0, 0.923077), (30.0, 0.920266), (45.0, 0.904327), (60.0, 0.836232), (75.0, 0.596092)]
    {
        let lamp = rect(DVec3::new(0.0, 0.0, 2.0), 1e6 * Y, 1e6 * X);
        near(through_slab(degrees, vec![object(lamp, &glowing(1.0))]), exact, 1e-6);
    }
}

#[test]
fn a_slab_shifts_what_is_behind_it_sideways() {
    for (degrees, shift) in
        [(15.0, 0.089615), (30.0, 0.193814), (45.0, 0.329142), (60.0, 0.512472), (80.0, 0.833664)]
    {
        let (s, c) = sin_cos_degrees(degrees);
        // The ray leaves parallel to itself, moved toward the normal, by `shift` across its direction.
        let along = DVec3::new(s, 0.0, c);
        let across = DVec3::new(-c, 0.0, s);
        let spot = |off: f64| object(disc(along * (1.5 / c) + across * off, -along, 1e-5), &glowing(1.0));
        assert!(through_slab(degrees, vec![spot(shift)]) > 0.1, "{degrees}°");
        assert_eq!(through_slab(degrees, vec![spot(-shift)]), 0.0, "bent to the wrong side");
    }
}

#[test]
fn a_ball_lens_crosses_its_axis_where_geometry_says() {
    for (h, at) in [(0.1, 1.495827), (0.3, 1.461978), (0.5, 1.391573), (0.7, 1.277787), (0.9, 1.104446)] {
        let lamp = object(disc(DVec3::new(0.0, 0.0, at), -Z, 1e-5), &glowing(1.0));
        let world = world(vec![object(sphere(DVec3::ZERO, 1.0), &glass(1.5)), lamp]);
        let from = DVec3::new(h, 0.0, -3.0);
        assert!(seen(&world, from, from + Z) > 0.5, "h = {h}");
    }
}

#[test]
fn light_inside_glass_beyond_the_critical_angle_stays_inside() {
    // From within, 45° on a face: everything is mirrored to a lamp inside; without total reflection it would escape.
    let tank = cuboid(-2.0 * DVec3::ONE, 2.0 * DVec3::ONE);
    let lamp = disc(DVec3::new(1.0, 1.0, 0.0), DVec3::new(-1.0, 1.0, 0.0), 0.1);
    let world = world(vec![object(tank, &glass(1.5)), object(lamp, &glowing(1.0))]);
    near(seen(&world, DVec3::new(-1.0, 1.0, 0.0), DVec3::new(0.0, 2.0, 0.0)), 1.0, 1e-12);
}

#[test]
fn glass_takes_light_by_beers_law() {
    let tinted = layered(0.0, |l| {
        (l.transmit, l.ior, l.fresnel) = (Texture::number(1.0), Texture::number(1.0), Fresnel::Exact);
        l.absorb = Texture::Constant(Rgb::new(0.0, 0.5, 2.0));
    });
    let lamp = rect(DVec3::new(0.0, 0.0, 9.0), 50.0 * Y, 50.0 * X);
    let world = world(vec![
        object(cuboid(DVec3::new(-5.0, -5.0, 0.0), DVec3::new(5.0, 5.0, 3.0)), &tinted),
        object(lamp, &glowing(1.0)),
    ]);
    for from in [-Z, DVec3::Z] {
        let (l, _) = seen_by(&settings([1, 1]), &world, from, 5.0 * Z);
        let thickness = 3.0 - from.z.max(0.0);
        near(l.x, 1.0, 1e-12);
        near(l.y, ogee::math::elementary::exp(-0.5 * thickness), 1e-12);
        near(l.z, ogee::math::elementary::exp(-2.0 * thickness), 1e-12);
    }
}

#[test]
fn light_that_passes_glass_is_not_shadowed_by_its_own_source() {
    for far in [0.0, 1e3, 1e6] {
        let by = DVec3::splat(far);
        let lit = |x: f64, between: Option<Node>| {
            let lamp = disc(by + DVec3::new(-1.0, 3.0, -1.0), DVec3::new(0.3, -1.0, 0.3).normalize(), 0.5);
            let mut nodes = vec![object(plane(Y, far), &diffuse(1.0)), area(lamp, 5.0, 64)];
            nodes.extend(between);
            seen(&world(nodes), by + DVec3::new(x, 0.25, x), by + DVec3::new(x, 0.0, x))
        };
        let clear = layered(0.0, |l| {
            (l.transmit, l.ior, l.fresnel) = (Texture::number(1.0), Texture::number(1.0), Fresnel::None);
        });
        for x in [-0.4, 0.0, 0.3, 0.7] {
            let ball = object(sphere(by + DVec3::new(0.0, 1.5, 0.0), 1.0), &clear);
            let (bare, through) = (lit(x, None), lit(x, Some(ball)));
            assert!(bare > 0.05 && (through - bare).abs() <= 1e-6 * bare, "{far} {x}: {bare} {through}");
        }
    }
}

#[test]
fn glass_casts_a_clear_shadow_and_a_wall_a_black_one() {
    let lit = |between: Option<Node>| {
        let mut nodes = vec![object(plane(Y, 0.0), &diffuse(1.0)), sun(-Y, PI)];
        nodes.extend(between);
        from_above(&world(nodes), 0.0, 0.0)
    };
    let pane = || cuboid(DVec3::new(-1.0, 1.0, -1.0), DVec3::new(1.0, 1.1, 1.0));
    near(lit(None), 1.0, 1e-12);
    near(lit(Some(object(pane(), &glass(1.5)))), 0.96 * 0.96, 1e-12);
    near(lit(Some(object(pane(), &diffuse(0.5)))), 0.0, 0.0);
    let half_there = layered(0.5, |l| l.opacity = Texture::number(0.25));
    near(lit(Some(object(rect(Y, X, Z), &half_there))), 0.75, 1e-12);
}

#[test]
fn ambient_stays_with_all_lights_off_and_near_a_light() {
    let clay = layered(0.5, |l| l.ambient = Texture::number(0.1));
    let dark = world(vec![object(plane(Y, 0.0), &clay)]);
    near(from_above(&dark, 0.0, 0.0), 0.1, 1e-15);
    // A light a thousandth above the floor, of an intensity that gives 1e-3 there.
    let close = world(vec![object(plane(Y, 0.0), &clay), point(1e-3 * Y, 1e-9 * PI)]);
    near(from_above(&close, 0.0, 0.0), 0.1 + 0.5e-3, 1e-9);
}

#[test]
fn a_ball_lit_from_behind_is_dark_not_negative() {
    for lobe in [Lobe::Phong, Lobe::Blinn] {
        for q in [2.0, 2.5, 40.0] {
            let shiny = layered(0.5, |l| {
                (l.specular, l.exponent, l.lobe) = (Texture::number(0.5), Texture::number(q), lobe);
                l.ambient = Texture::number(0.125);
            });
            let world = world(vec![object(sphere(DVec3::ZERO, 1.0), &shiny), point(-5.0 * Z, 100.0)]);
            let film = picture(&world, &camera(5.0 * Z, DVec3::ZERO, 20.0), &settings([32, 32]));
            assert_eq!(film.report.non_finite, 0);
            assert!(film.pixels.iter().all(|p| p.x == 0.0 || p.x == 0.125), "{lobe:?} {q}");
        }
    }
}

#[test]
fn phong_that_shares_all_its_light_returns_no_more_than_it_gets() {
    let shiny = layered(0.5, |l| {
        (l.specular, l.exponent, l.lobe) = (Texture::number(0.5), Texture::number(10.0), Lobe::Phong);
    });
    let world = world(vec![object(sphere(DVec3::ZERO, 1.0), &shiny), sky_samples(1.0, 4096)]);
    for x in [0.0, 0.5, 0.9, 0.99] {
        let p = DVec3::new(x, 0.0, (1.0f64 - x * x).sqrt());
        let found = seen(&world, p + Z, p);
        assert!(found <= 1.0 + 5e-3, "{found} at {x}");
    }
}

#[test]
fn mirror_and_base_share_as_the_material_says() {
    for (share, exact) in [(0.0, 0.2), (0.5, 0.55), (1.0, 0.9)] {
        let material = layered(0.2, |l| l.reflect = Texture::number(share));
        // The mirror shows a panel of radiance 0.9; the base, lit by a sun of irradiance π, is 0.2.
        let panel = rect(DVec3::new(0.0, 5.0, 0.0), 50.0 * X, 50.0 * Z);
        let sun =
            light_with(LightSource::Sun { direction: -Y, irradiance: Rgb::splat(PI) }, |l| l.shadow = false);
        let glow = layered(0.0, |l| l.ambient = Texture::number(0.9));
        let world = world(vec![object(plane(Y, 0.0), &material), object(panel, &glow), sun]);
        near(from_above(&world, 0.0, 0.0), exact, 1e-12);
    }
}

#[test]
fn a_mirror_takes_one_ray_a_hit_and_a_wall_none() {
    let world =
        world(vec![object(plane(Y, 0.0), &mirror(0.5)), object(plane(-Y, -4.0), &mirror(0.5)), sky(1.0)]);
    let mut settings = settings([1, 1]);
    settings.depth = 6;
    let (_, sampler) = seen_by(&settings, &world, 2.0 * Y, DVec3::new(1.0, 0.0, 0.0));
    assert_eq!((sampler.rays.reflected, sampler.rays.refracted, sampler.rays.shadow), (5, 0, 0));
}

#[test]
fn segments_end_at_the_depth_and_the_last_may_end_on_a_light() {
    let lamp = || object(rect(3.0 * Y, 2.0 * X, 2.0 * Z), &glowing(1.0));
    let seen_at = |depth, floor: std::sync::Arc<Material>| {
        let mut settings = settings([1, 1]);
        settings.depth = depth;
        let world = world(vec![object(plane(Y, 0.0), &floor), lamp()]);
        seen_by(&settings, &world, DVec3::new(0.1, 1.0, 0.0), DVec3::ZERO).0.x
    };
    assert_eq!(seen_at(1, diffuse(0.5)), 0.0);
    assert!(seen_at(2, diffuse(0.5)) > 0.0);
    assert_eq!((seen_at(1, mirror(1.0)), seen_at(2, mirror(1.0))), (0.0, 1.0));
}

#[test]
fn a_background_is_seen_and_lights_nothing() {
    let world = world(vec![object(plane(Y, 0.0), &diffuse(0.5))]);
    let mut settings = settings([1, 1]);
    settings.background = Some(Rgb::new(0.1, 0.2, 0.3));
    assert_eq!(seen_by(&settings, &world, Y, 2.0 * Y).0, Rgb::new(0.1, 0.2, 0.3));
    assert_eq!(seen_by(&settings, &world, Y, DVec3::ZERO).0, Rgb::ZERO);
}

#[test]
fn raycast_casts_no_second_ray() {
    let roof = rect(2.0 * Y, X, Z);
    let world = world(vec![
        object(plane(Y, 0.0), &layered(0.5, |l| l.reflect = Texture::number(0.5))),
        object(roof, &diffuse(0.5)),
        sun(-Y, PI),
        sky(0.0),
    ]);
    let mut settings = settings([1, 1]);
    settings.tracer = TracerKind::Raycast;
    let (l, sampler) = seen_by(&settings, &world, DVec3::new(1e-3, 1.0, 0.0), DVec3::ZERO);
    assert_eq!((sampler.rays.total(), sampler.rays.camera), (1, 1));
    near(l.x, 0.25, 1e-12);
}

/// A ball of twenty triangles with the normals of a sphere.
fn icosphere() -> Mesh {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let positions: Vec<DVec3> = [
        (-1.0, g, 0.0),
        (1.0, g, 0.0),
        (-1.0, -g, 0.0),
        (1.0, -g, 0.0),
        (0.0, -1.0, g),
        (0.0, 1.0, g),
        (0.0, -1.0, -g),
        (0.0, 1.0, -g),
        (g, 0.0, -1.0),
        (g, 0.0, 1.0),
        (-g, 0.0, -1.0),
        (-g, 0.0, 1.0),
    ]
    .map(|(x, y, z)| DVec3::new(x, y, z).normalize())
    .to_vec();
    let triangles = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    Mesh { normals: positions.clone(), positions, triangles: triangles.to_vec(), ..Mesh::default() }
}

#[test]
fn a_smooth_ball_of_few_triangles_has_no_edge_in_its_shadow_line() {
    let (s, c) = sin_cos_degrees(75.0);
    let toward = DVec3::new(s, 0.0, c);
    let world = world(vec![object(mesh(icosphere()), &diffuse(1.0)), sun(-toward, PI)]);
    let mut camera = camera(3.0 * Z, DVec3::ZERO, 0.0);
    (camera.projection, camera.fov) = (Projection::Orthographic, 2.0 * asin(0.36).to_degrees());
    let film = picture(&world, &camera, &settings([512, 512]));
    let tracer_sees = |x: u32, y: u32| film.pixel(x, y).x;
    let view = ogee::render::camera::View::new(&camera, [512, 512]).unwrap();
    let mut steps = 0;
    for y in (0..512).step_by(7) {
        for x in 1..512 {
            let hit_at = |x: u32| {
                let ray =
                    view.ray(glam::DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), glam::DVec2::ZERO)?;
                world.closest(&ray).map(|h| h.geometric_normal)
            };
            let (Some(left), Some(here)) = (hit_at(x - 1), hit_at(x)) else { continue };
            let lit = tracer_sees(x, y);
            assert!(here.dot(toward) > 0.0 || lit == 0.0, "lit from behind at {x}, {y}");
            if left == here {
                let step = (lit - tracer_sees(x - 1, y)).abs();
                assert!(step < 0.05, "a step of {step} at {x}, {y}");
                steps += 1;
            }
        }
    }
    assert!(steps > 1000, "the ball fills the picture");
}

#[test]
fn a_rough_mirror_blurs_and_keeps_its_light() {
    let rough = layered(0.0, |l| {
        (l.reflect, l.roughness) = (Texture::number(1.0), Texture::number(0.2));
    });
    let mut many = settings([1, 1]);
    many.samples = 1024;
    let furnace = world(vec![object(plane(Y, 0.0), &rough), sky(1.0)]);
    let (l, sampler) = seen_by(&many, &furnace, DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO);
    assert!((l.x - 1.0).abs() < 0.005, "{}", l.x);
    assert_eq!(sampler.rays.reflected, 1, "one ray a camera sample");
    // A point light, which no ray can meet, still shows its highlight.
    let lit = world(vec![object(plane(Y, 0.0), &rough), point(DVec3::new(-1.0, 1.0, 0.0), 1.0)]);
    let (on, off) = (
        seen_by(&many, &lit, DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO).0.x,
        seen_by(&many, &lit, DVec3::new(1.0, 1.0, 3.0), DVec3::ZERO).0.x,
    );
    assert!(on > 10.0 * off && on > 0.1, "{on} {off}");
}

/// A texture that is a function of the point, given by its tape.
fn grooves(depth: f64, across: f64) -> Texture {
    let slabs = PatternKind::Gradient(Texture::number(0.0), Texture::number(depth));
    let along_y = ogee::math::Affine::scale(DVec3::new(1.0, across, 1.0));
    Texture::Pattern(std::sync::Arc::new(Pattern {
        kind: slabs,
        transform: Some(Box::new(along_y)),
        span: SPAN,
    }))
}

#[test]
fn a_bump_tilts_the_normal_by_the_slope_of_its_height() {
    // The height rises by 0.5 over 2 units of y on a wall that faces z: the normal is (0, −1/4, 1), normalised.
    let bumpy = layered(1.0, |l| l.bump = Some(grooves(0.5, 2.0)));
    let toward = DVec3::new(0.0, 0.6, 0.8);
    let world = world(vec![object(rect(Y, X, Y), &bumpy), sun(-toward, PI)]);
    let exact = DVec3::new(0.0, -0.25, 1.0).normalize().dot(toward);
    for (x, y) in [(0.0, 1.0), (0.7, 0.3), (0.999, 1.3)] {
        let p = DVec3::new(x, y, 0.0);
        near(seen(&world, p + Z, p), exact, 1e-9);
    }
}

#[test]
fn textured_lights_shine_as_they_look() {
    let halves = Pattern {
        kind: PatternKind::Checker(Texture::number(2.0), Texture::number(0.0)),
        transform: Some(Box::new(
            ogee::math::Affine::scale(100.0 * DVec3::ONE).then(&ogee::math::Affine::translate(50.0 * X)),
        )),
        span: SPAN,
    };
    let material = layered(0.0, |l| l.emit = Texture::Pattern(std::sync::Arc::new(halves)));
    let world =
        world(vec![object(plane(Y, 0.0), &diffuse(1.0)), object(rect(Y, 0.5 * X, 0.5 * Z), &material)]);
    // Half of the unit square over the middle, at twice the radiance.
    let mut many = settings([1, 1]);
    many.samples = 1024;
    near(seen_by(&many, &world, DVec3::new(1e-3, 0.5, 0.0), DVec3::ZERO).0.x, 0.239456, 2e-3);
    near(seen(&world, DVec3::new(0.25, 0.5, 0.0), DVec3::new(0.25, 1.0, 0.0)), 2.0, 0.0);
    near(seen(&world, DVec3::new(-0.25, 0.5, 0.0), DVec3::new(-0.25, 1.0, 0.0)), 0.0, 0.0);
}
