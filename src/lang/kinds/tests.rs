//! The table itself: what it promises to its readers.

use super::*;

#[test]
fn the_table_has_the_words_of_the_grammar() {
    let names: Vec<&str> = ALL.iter().map(|kind| kind.name).collect();
    assert_eq!(names, crate::syntax::build::KINDS);
}

#[test]
fn properties_have_unique_names_and_say_what_they_are() {
    for kind in ALL {
        let names: Vec<&str> = kind.properties().map(|p| p.name).collect();
        for (i, property) in kind.properties().enumerate() {
            assert!(!names[..i].contains(&property.name), "{}: {} twice", kind.name, property.name);
            assert!(
                !property.doc.is_empty() && !property.takes.is_empty(),
                "{}.{}",
                kind.name,
                property.name
            );
            assert!(!property.many || matches!(property.takes, [[_]]), "{}.{}", kind.name, property.name);
        }
        assert!(!kind.doc.is_empty() && !kind.example.is_empty(), "{}", kind.name);
        assert!(kind.example.contains(kind.name), "{} does not stand in its example", kind.name);
    }
}

mod building {
    use super::super::{self as kinds, with};
    use crate::lang::mock::{Mock, block, given, n, span, v, w};
    use crate::lang::table::{Block, Outcome};
    use crate::lang::value::Value;
    use crate::scene::{Fresnel, LightSource, Object, Shape, Texture};
    use glam::DVec3;
    use std::sync::Arc;

    fn make(mock: &mut Mock, mut block: Block) -> Outcome {
        kinds::make(mock, &mut block)
    }

    fn object(outcome: Outcome) -> Arc<Object> {
        match outcome {
            Ok(Value::Object(object)) => object,
            other => panic!("no object: {other:?}"),
        }
    }

    /// What a block with these properties is told.
    fn codes(kind: &str, properties: &[(&str, &[Value])]) -> Vec<&'static str> {
        let mut ctx = Mock::default();
        let outcome = make(&mut ctx, block(kind, properties));
        assert!(outcome.is_err() || ctx.codes().iter().all(|c| c.starts_with('W')), "{:?}", ctx.said);
        assert!(outcome.is_ok() || !ctx.said.is_empty());
        ctx.codes()
    }

    #[test]
    fn defaults_are_those_of_the_table() {
        let sphere = object(make(&mut Mock::default(), block("sphere", &[])));
        assert!(matches!(sphere.shape, Shape::Sphere { center: DVec3::ZERO, radius: 1.0 }));
        assert!(sphere.transform.is_none() && sphere.material.is_none());
    }

    #[test]
    fn every_default_reads_as_a_value_of_its_property() {
        for kind in super::super::ALL {
            for p in kind.properties().filter(|p| !p.default.is_empty() && !p.many) {
                let values: Vec<Value> = written(p.default);
                let fit = p.takes.iter().any(|row| {
                    row.len() == values.len()
                        && row
                            .iter()
                            .zip(&values)
                            .all(|(t, value)| crate::lang::coerce::fits(&Mock::default(), *t, value))
                });
                assert!(fit, "{}: {} {}", kind.name, p.name, p.default);
            }
        }
    }

    /// Numbers, vectors of numbers, axes and words, as the table writes defaults.
    fn written(text: &str) -> Vec<Value> {
        if let Some(inner) = text.strip_prefix('<').and_then(|t| t.strip_suffix('>')) {
            let components: Vec<f64> = inner.split(',').map(|x| x.trim().parse().unwrap()).collect();
            return vec![crate::lang::value::vector(&components)];
        }
        let one =
            |part: &str| crate::lang::builtins::default_value(part.trim()).unwrap_or_else(|| w(part.trim()));
        text.split(',').map(one).collect()
    }

    #[test]
    fn transforms_are_composed_in_the_order_written() {
        let ball = object(make(
            &mut Mock::default(),
            block(
                "sphere",
                &[
                    ("translate", &[v(1.0, 0.0, 0.0)]),
                    ("rotate", &[v(0.0, 0.0, 1.0), n(90.0)]),
                    ("scale", &[n(2.0)]),
                ],
            ),
        ));
        let p = ball.transform.as_ref().unwrap().point(DVec3::ZERO);
        assert_eq!(p, DVec3::new(0.0, 2.0, 0.0));
    }

    #[test]
    fn matrix_takes_the_images_of_the_axes_and_then_the_translation() {
        let numbers: Vec<Value> =
            [0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 7.0, 8.0, 9.0].map(n).to_vec();
        for values in [numbers.clone(), vec![Value::list(numbers)]] {
            let ball = object(make(&mut Mock::default(), block("sphere", &[("matrix", &values)])));
            let map = ball.transform.as_ref().unwrap();
            assert_eq!(map.point(DVec3::X), DVec3::new(7.0, 9.0, 9.0));
        }
        let flat: Vec<Value> = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0].map(n).to_vec();
        assert_eq!(codes("sphere", &[("matrix", &flat)]), ["E0303"]);
    }

    #[test]
    fn shear_moves_along_by_the_distance_across() {
        let shear = [v(2.0, 0.0, 0.0), v(0.0, 3.0, 0.0), n(0.5)];
        let ball = object(make(&mut Mock::default(), block("sphere", &[("shear", &shear)])));
        assert_eq!(ball.transform.as_ref().unwrap().point(DVec3::Y * 4.0), DVec3::new(2.0, 4.0, 0.0));
    }

    #[test]
    fn what_other_renderers_pass_in_silence_is_refused() {
        let up = v(0.0, 1.0, 0.0);
        let zero = || v(0.0, 0.0, 0.0);
        assert_eq!(codes("sphere", &[("radius", &[n(-1.0)])]), ["E0303"]);
        assert_eq!(codes("sphere", &[("radius", &[n(0.0)])]), ["E0303"]);
        assert_eq!(codes("sphere", &[("scale", &[n(0.0)])]), ["E0303"]);
        assert_eq!(codes("sphere", &[("scale", &[v(1.0, 0.0, 1.0)])]), ["E0303"]);
        assert_eq!(codes("sphere", &[("radius", &[n(f64::NAN)])]), ["E0206"]);
        assert_eq!(codes("sphere", &[("center", &[v(0.0, f64::INFINITY, 0.0)])]), ["E0206"]);
        assert_eq!(codes("plane", &[("normal", &[zero()])]), ["E0303"]);
        assert_eq!(codes("plane", &[("offset", &[n(1.0)]), ("through", &[zero()])]), ["E0305"]);
        assert_eq!(codes("box", &[("min", &[v(1.0, 0.0, 0.0)]), ("max", &[v(0.0, 1.0, 1.0)])]), ["E0604"]);
        assert_eq!(
            codes("cylinder", &[("from", std::slice::from_ref(&up)), ("to", std::slice::from_ref(&up))]),
            ["E0604"]
        );
        assert_eq!(
            codes("cone", &[("from", &[zero()]), ("to", &[up]), ("radii", &[n(0.0), n(0.0)])]),
            ["E0604"]
        );
        assert_eq!(codes("rect", &[("edges", &[v(0.1, 0.2, 0.3), v(0.3, 0.6, 0.9)])]), ["E0604"]);
        let line = [zero(), v(1.0, 1.0, 1.0), v(3.0, 3.0, 3.0)];
        assert_eq!(codes("triangle", &[("vertices", &line)]), ["E0604"]);
        assert_eq!(codes("camera", &[("eye", &[zero()])]), ["E0303"]);
        assert_eq!(codes("mesh", &[("file", &[Value::text("missing.obj")])]), ["E0501"]);
    }

    #[test]
    fn a_million_radius_is_fine_and_so_is_a_tiny_one() {
        assert!(codes("sphere", &[("radius", &[n(1e-12)]), ("scale", &[n(1e-9)])]).is_empty());
        assert!(codes("box", &[("min", &[v(0.0, 0.0, 0.0)]), ("max", &[v(1e-9, 1e9, 1.0)])]).is_empty());
    }

    #[test]
    fn all_faults_of_a_block_are_said() {
        let faults = codes(
            "sphere",
            &[("radus", &[n(1.0)]), ("center", &[n(2.0)]), ("radius", &[n(-1.0)]), ("hide", &[w("shadows")])],
        );
        assert_eq!(faults, ["E0301", "E0201", "E0303", "E0309"]);
        assert_eq!(codes("cylinder", &[("radius", &[n(1.0), n(2.0)])]), ["E0303", "E0302"]);
    }

    #[test]
    fn the_nearest_name_is_offered_and_is_not_missing_as_well() {
        let mut ctx = Mock::default();
        assert!(make(&mut ctx, block("camera", &[("eyes", &[v(0.0, 1.0, 2.0)])])).is_err());
        assert_eq!(ctx.codes(), ["E0301"]);
        assert_eq!(ctx.said[0].hints, ["did you mean `eye`?"]);
    }

    #[test]
    fn a_number_for_a_vector_is_answered_with_the_vector() {
        let mut ctx = Mock::default();
        assert!(make(&mut ctx, block("sphere", &[("center", &[n(2.0)])])).is_err());
        assert_eq!(ctx.said[0].hints, ["write `center <2, 2, 2>`"]);
        let mut ctx = Mock::default();
        assert!(make(&mut ctx, block("sphere", &[("center", &[n(1.0), n(2.0), n(3.0)])])).is_err());
        assert_eq!(ctx.said[0].hints, ["write the vector in angle brackets: `center <1, 2, 3>`"]);
    }

    #[test]
    fn doubles_are_said_at_the_second_with_the_first_beside_it() {
        let mut ctx = Mock::default();
        assert!(make(&mut ctx, block("sphere", &[("radius", &[n(1.0)]), ("radius", &[n(2.0)])])).is_err());
        assert_eq!((ctx.codes(), ctx.said[0].span), (vec!["E0304"], Some(span(200))));
        assert_eq!(ctx.said[0].labels[0].span, span(100));
        assert!(
            codes("sphere", &[("translate", &[v(1.0, 0.0, 0.0)]), ("translate", &[v(1.0, 0.0, 0.0)])])
                .is_empty()
        );
    }

    #[test]
    fn a_poisoned_property_is_not_missing() {
        let mut ctx = Mock::default();
        let mut cylinder = block("cylinder", &[("from", &[v(0.0, 0.0, 0.0)])]);
        cylinder.poisoned.push(("to".into(), span(300)));
        assert!(make(&mut ctx, cylinder).is_err());
        assert!(ctx.said.is_empty(), "{:?}", ctx.said);
    }

    fn material(properties: &[(&str, &[Value])]) -> (Arc<crate::scene::Material>, Mock) {
        let mut ctx = Mock::default();
        match make(&mut ctx, block("material", properties)) {
            Ok(Value::Material(material)) => (material, ctx),
            other => panic!("{other:?}"),
        }
    }

    fn constant(texture: &Texture) -> DVec3 {
        match texture {
            Texture::Constant(c) => *c,
            Texture::Pattern(_) => panic!("a pattern"),
        }
    }

    #[test]
    fn diffuse_and_fresnel_follow_what_else_is_given() {
        let plain = material(&[]).0;
        assert_eq!(constant(&plain.diffuse), DVec3::splat(0.8));
        assert!(plain.layers.is_none());
        let glass = material(&[("transmit", &[n(1.0)])]).0;
        assert_eq!((constant(&glass.diffuse), glass.layers().fresnel), (DVec3::ZERO, Fresnel::Exact));
        let metal = material(&[("metal", &[n(0.9)])]).0;
        assert_eq!((constant(&metal.diffuse), metal.layers().fresnel), (DVec3::ZERO, Fresnel::None));
        let lacquer = material(&[("reflect", &[n(0.1)]), ("fresnel", &[w("schlick")])]).0;
        assert_eq!(
            (constant(&lacquer.diffuse), lacquer.layers().fresnel),
            (DVec3::splat(0.8), Fresnel::Schlick)
        );
    }

    #[test]
    fn a_material_that_gains_light_is_warned_of_with_the_amount() {
        let warned = |properties: &[(&str, &[Value])]| {
            let (_, ctx) = material(properties);
            ctx.said.first().map(|d| d.message.clone())
        };
        let of = |message: &str| Some(format!("this material returns {message} too much"));
        assert_eq!(warned(&[("diffuse", &[n(1.0)])]), None);
        assert_eq!(warned(&[("diffuse", &[n(1.2)])]), of("1.20 times the light it gets: 20 %"));
        assert_eq!(
            warned(&[
                ("diffuse", &[v(0.5, 0.9, 0.5)]),
                ("specular", &[n(0.5)]),
                ("lobe", &[w("phong")]),
                ("exponent", &[n(20.0)])
            ]),
            of("1.40 times the light it gets of green: 40 %")
        );
        // The clay of the first example is as bright as it can be.
        let clay = [("diffuse", &[v(0.8, 0.4, 0.3)][..]), ("specular", &[n(0.2)]), ("exponent", &[n(40.0)])];
        assert_eq!(warned(&clay), None);
        assert_eq!(warned(&[("diffuse", &[n(0.8)]), ("reflect", &[n(1.0)])]), None);
        assert_eq!(
            warned(&[("diffuse", &[n(0.0)]), ("reflect", &[n(1.5)])]),
            of("1.50 times the light it gets: 50 %")
        );
        assert_eq!(warned(&[("transmit", &[n(1.0)]), ("ior", &[n(1.5)])]), None);
        assert_eq!(
            warned(&[("transmit", &[n(1.0)]), ("diffuse", &[n(0.5)])]),
            of("1.48 times the light it gets: 48 %")
        );
        assert_eq!(warned(&[("metal", &[v(1.0, 0.78, 0.34)])]), None);
    }

    #[test]
    fn a_light_has_one_source_and_the_strength_that_belongs_to_it() {
        let p = || v(0.0, 5.0, 0.0);
        assert_eq!(codes("light", &[("intensity", &[n(1.0)])]), ["E0302"]);
        assert_eq!(codes("light", &[("point", &[p()]), ("sun", &[p()])]), ["E0305"]);
        assert_eq!(codes("light", &[("sun", &[p()]), ("intensity", &[n(3.0)])]), ["E0305"]);
        assert_eq!(codes("light", &[("spot", &[p()])]), ["E0302"]);
        assert_eq!(
            codes("light", &[("spot", &[p()]), ("toward", &[p()]), ("cone", &[n(40.0), n(20.0)])]),
            ["E0303"]
        );
        assert_eq!(codes("light", &[("point", &[p()]), ("falloff", &[n(0.0), n(0.0), n(0.0)])]), ["E0303"]);
        assert!(codes("light", &[("sky", &[Value::text("a.hdr")])]).is_empty());
        assert!(codes("light", &[("sky", &[n(0.25)]), ("shadow", &[w("off")])]).is_empty());
    }

    #[test]
    fn with_changes_own_properties_and_adds_transforms() {
        let mut ctx = Mock::default();
        let ball = make(
            &mut ctx,
            block("sphere", &[("center", &[v(1.0, 0.0, 0.0)]), ("translate", &[v(1.0, 0.0, 0.0)])]),
        )
        .unwrap();
        let changes = given(&[("radius", &[n(3.0)]), ("scale", &[n(2.0)])]);
        let copy = object(with::apply(&mut ctx, ball, span(0), changes, Vec::new(), span(0)));
        assert!(matches!(copy.shape, Shape::Sphere { center: DVec3::X, radius: 3.0 }));
        assert_eq!(copy.transform.as_ref().unwrap().point(DVec3::ZERO), DVec3::X * 2.0);
        let rod =
            make(&mut ctx, block("cylinder", &[("from", &[v(0.0, 0.0, 0.0)]), ("to", &[v(0.0, 1.0, 0.0)])]))
                .unwrap();
        let taper = given(&[("radii", &[n(1.0), n(0.0)])]);
        let tapered = object(with::apply(&mut ctx, rod.clone(), span(0), taper, Vec::new(), span(0)));
        assert!(matches!(&tapered.shape, Shape::Cone(c) if c.radii == [1.0, 0.0]));
        let wrong = given(&[("radius", &[n(-1.0)]), ("scale", &[n(0.0)]), ("centre", &[n(0.0)])]);
        assert!(with::apply(&mut ctx, rod, span(0), wrong, Vec::new(), span(0)).is_err());
        assert_eq!(ctx.codes(), ["E0303", "E0301", "E0303"]);
    }

    #[test]
    fn with_keeps_what_it_does_not_name() {
        let mut ctx = Mock::default();
        let spot = make(
            &mut ctx,
            block(
                "light",
                &[
                    ("spot", &[v(0.0, 5.0, 0.0)]),
                    ("toward", &[v(0.0, -2.0, 0.0)]),
                    ("intensity", &[n(7.0)]),
                    ("shadow", &[w("off")]),
                ],
            ),
        )
        .unwrap();
        let changes = given(&[("cone", &[n(5.0), n(6.0)]), ("translate", &[v(1.0, 0.0, 0.0)])]);
        let Ok(Value::Light(light)) =
            with::apply(&mut ctx, spot.clone(), span(0), changes, Vec::new(), span(0))
        else {
            panic!()
        };
        assert!(!light.shadow && light.transform.is_some());
        assert!(
            matches!(light.source, LightSource::Spot { cone: [5.0, 6.0], intensity, .. } if intensity == DVec3::splat(7.0))
        );
        let to_sun = given(&[("sun", &[v(0.0, -1.0, 0.0)])]);
        let Ok(Value::Light(sun)) = with::apply(&mut ctx, spot, span(0), to_sun, Vec::new(), span(0)) else {
            panic!()
        };
        assert!(matches!(sun.source, LightSource::Sun { .. }) && !sun.shadow);
        let glass = Value::Material(material(&[("transmit", &[n(0.9)]), ("roughness", &[n(0.2)])]).0);
        let tinted = given(&[("absorb", &[v(1.0, 0.0, 0.0)])]);
        let Ok(Value::Material(tinted)) = with::apply(&mut ctx, glass, span(0), tinted, Vec::new(), span(0))
        else {
            panic!()
        };
        assert_eq!((tinted.layers().fresnel, constant(&tinted.diffuse)), (Fresnel::Exact, DVec3::ZERO));
        assert_eq!(constant(&tinted.layers().roughness), DVec3::splat(0.2));
        assert!(ctx.said.is_empty(), "{:?}", ctx.said);
    }

    #[test]
    fn a_camera_that_looks_down_has_a_side_that_is_up() {
        let mut ctx = Mock::default();
        let Ok(Value::Camera(camera)) = make(&mut ctx, block("camera", &[("eye", &[v(0.0, 9.0, 0.0)])]))
        else {
            panic!()
        };
        assert_eq!(camera.up, DVec3::NEG_Z);
        assert_eq!(codes("camera", &[("eye", &[v(0.0, 9.0, 0.0)]), ("up", &[v(0.0, 1.0, 0.0)])]), ["E0303"]);
    }

    #[test]
    fn faces_of_a_mesh_are_checked_one_by_one() {
        let corners = [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(1.0, 1.0, 0.0), v(0.0, 1.0, 0.0)];
        let quad = Value::Vector4(std::rc::Rc::new(glam::DVec4::new(0.0, 1.0, 2.0, 3.0)));
        let ok = object(make(
            &mut Mock::default(),
            block("mesh", &[("vertices", &corners), ("faces", &[Value::list(vec![quad])])]),
        ));
        let Shape::Mesh(source) = &ok.shape else { panic!() };
        assert!(matches!(&**source, crate::scene::MeshSource::Inline(mesh) if mesh.triangles.len() == 2));
        let faces = [v(0.0, 1.0, 4.0), v(0.0, 1.5, 2.0), n(3.0)];
        assert_eq!(codes("mesh", &[("vertices", &corners), ("faces", &faces)]), ["E0303", "E0303", "E0201"]);
        assert_eq!(codes("mesh", &[("vertices", &corners)]), ["E0302"]);
        assert_eq!(codes("mesh", &[]), ["E0302"]);
    }
}
