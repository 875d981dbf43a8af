//! The report's case sets as tests: every default keeps its bar, and every variant that is known to fail does, so that the case sets
//! are as hard as they claim. Errors and counts alone; no time is asked for.

use crate::run::Folder;
use ogee::math::hex::parse_hex_list;
use ogee::report::page::render;
use ogee::report::row::{Machine, Row};
use ogee::report::tracers::TracerRow;
use ogee::report::trial::{Only, Plan};
use ogee::report::{measure, reproduce, store};
use std::sync::OnceLock;

/// All rows, measured once for all tests here.
fn rows() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| measure(&Plan::errors(), &[], |_| ()))
}

fn row(component: &str, case: &str, variant: &str) -> &'static Row {
    let found = rows().iter().find(|r| r.component == component && r.case == case && r.variant == variant);
    found.unwrap_or_else(|| panic!("no row {component}, {case}, {variant}"))
}

#[test]
fn every_default_keeps_its_bar_on_every_case_set() {
    let broken: Vec<String> = rows()
        .iter()
        .filter(|r| !r.within_bar())
        .map(|r| {
            let wrong = [r.missed, r.spurious, r.not_finite];
            format!(
                "{}, {}: {:e} over {:?}, wrong {wrong:?}: {} {}",
                r.component, r.case, r.error_max, r.bar, r.worst_input, r.failed_input
            )
        })
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn every_case_set_has_one_default_with_a_bar() {
    let mut cases: Vec<(&str, &str)> = rows().iter().map(|r| (&*r.component, &*r.case)).collect();
    cases.dedup();
    for (component, case) in cases {
        let own = rows().iter().filter(|r| r.component == component && r.case == case);
        let defaults: Vec<&Row> = own.filter(|r| r.default).collect();
        assert_eq!(defaults.len(), 1, "{component}, {case}");
        assert!(defaults[0].bar.is_some() && defaults[0].n > 0, "{component}, {case}");
    }
}

#[test]
fn case_sets_are_as_hard_as_they_claim() {
    // A variant's largest error on a case set is at least this.
    let errors = [
        ("cubic evaluation", "end points", "horner", 1.0),
        ("cubic evaluation", "near a triple root", "horner", 1e10),
        ("cubic evaluation", "near a triple root", "bernstein", 1e10),
        ("cubic evaluation", "tiny tail", "horner", 1e15),
        ("cubic evaluation", "large offset", "de casteljau", 1.0),
        ("cubic evaluation", "inside", "bernstein, f32", 1e8),
        ("bounds over a box", "tanglecube, boxes of 1/64", "intervals", 4.0),
        ("bounds over a box", "torus, boxes of 1/64", "intervals", 4.0),
        ("arc length", "cusp", "gauss 24", 1e-4),
        ("arc length", "near-cusp", "gauss 64", 1e-6),
        ("arc length", "backtrack", "gauss 64", 1e-5),
        ("quadratic roots", "roots of unlike size", "b²−4ac", 1e6),
        ("ray and sphere", "grazing", "b²−4ac", 1e5),
        ("ray and plane", "grazing", "plain", 1e5),
        ("reach", "out of reach", "plain pseudo-inverse", 0.1),
        ("reach", "stretched toward it", "plain pseudo-inverse", 0.1),
        ("reach", "stretched toward it", "damping 0.1", 0.1),
        ("reach", "at the end of its reach", "damping 0.1", 1e-6),
        ("skin", "twisted by up to half a turn", "matrices averaged", 0.9),
        ("skin", "radius of a half twist", "linear", 0.9),
        ("skin", "twisted by more than half a turn", "dual quaternions after stretch", 1.0),
        ("skin", "at rest, far from the origin", "matrices averaged", 1.0),
        ("skin", "by one bone that is stretched", "rigid dual quaternions", 0.5),
        ("skin", "normals by one bone that is stretched", "matrices averaged", 0.5),
        ("fresnel", "into 1.1", "schlick, one side", 0.2),
        ("fresnel", "out of glass", "schlick, one side", 0.8),
    ];
    for (component, case, variant, least) in errors {
        let own = row(component, case, variant);
        assert!(own.error_max >= least, "{component}, {case}, {variant}: {:e}", own.error_max);
    }
    // And so many of its answers are missing, made up or no numbers.
    let wrong = [
        ("parameter at a length", "backtrack", "newton, gauss 24", 1),
        ("quadratic roots", "known traps", "b²−4ac", 1),
        ("cubic roots", "tiny lead", "cardano", 10),
        ("cubic roots", "touching", "cardano", 10),
        ("quartic roots", "Orellana and De Michele", "ferrari", 3),
        ("ray and sphere", "from 10⁸ radii", "b²−4ac", 50),
        ("ray and closed mesh", "aimed at edges", "cramer", 10),
        ("ray and closed mesh", "aimed at edges", "möller trumbore", 10),
        ("ray and torus", "from 10⁵", "ferrari at the eye", 100),
        ("ray and patch", "first of three", "newton from one start", 10),
        ("implicit surface", "squared sphere", "steps of 0.01", 100),
        ("implicit surface", "thin shell", "steps of 0.01", 100),
    ];
    for (component, case, variant, least) in wrong {
        let own = row(component, case, variant);
        let n = own.missed + own.spurious + own.not_finite;
        assert!(n >= least, "{component}, {case}, {variant}: {n} wrong, error {:e}", own.error_max);
    }
}

#[test]
fn dual_quaternions_keep_the_radius_of_a_twist_and_linear_blending_is_exact_elsewhere() {
    for case in ["twisted by up to half a turn", "radius of a half twist"] {
        let own = row("skin", case, "dual quaternions after stretch");
        let most = if case.starts_with("radius") { 1e-12 } else { 0.5 };
        assert!(own.error_max <= most, "{case}: {:e}", own.error_max);
    }
    for case in ["at rest, far from the origin", "by one bone that is stretched"] {
        let own = row("skin", case, "dual quaternions after stretch");
        assert!(own.error_max <= 1e-13, "{case}: {:e}", own.error_max);
    }
}

#[test]
fn the_worst_inputs_give_their_errors_again() {
    for own in rows().iter().step_by(7).filter(|r| !r.worst_input.is_empty()) {
        let only = Only {
            component: own.component.clone(),
            case: own.case.clone(),
            variant: own.variant.clone(),
            input: parse_hex_list(&own.worst_input).expect("the report writes hexadecimal floats"),
        };
        let again = reproduce(only).expect("the report names what there is");
        assert_eq!(again.error_max, own.error_max, "{}, {}, {}", own.component, own.case, own.variant);
    }
    let nothing = Only { component: "x".into(), case: "y".into(), variant: "z".into(), input: vec![1.0] };
    assert!(reproduce(nothing).is_none());
}

#[test]
fn results_alone_render_the_same_report() {
    let machine = Machine { mode: "quick".into(), ..Machine::default() };
    let mut again = Vec::new();
    let mut files = store::write(&machine, rows(), |row| &row.component);
    files.reverse();
    for file in files {
        again.extend(store::read::<Row>(&file.text).expect("what was written can be read").1);
    }
    store::sort(&mut again);
    let text =
        |rows: &[Row]| render(&machine, rows, &[]).into_iter().map(|page| page.text).collect::<Vec<_>>();
    assert!(text(&again) == text(rows()));
    let linked = render(&machine, &again, &[("Trees".into(), "trees/index.md".into())]);
    assert!(linked[0].text.contains("\nOther reports: [Trees](trees/index.md).\n"));
}

const SMALL_ROOM: &str = "render { size 200, 100 }
camera { eye <0, 1, 5>  look_at <0, 0.6, 0> }
light { area rect { center <0, 3, 0>  edges <1, 0, 0>, <0, 0, 1> }  radiance 12 }
plane { normal y  material { diffuse 0.7 } }
sphere { center <0, 0.7, 0>  radius 0.7  material { diffuse <0.8, 0.3, 0.2> } }
";

#[test]
fn tracers_are_measured_on_a_scene_and_the_page_comes_again_from_the_results() {
    let folder = Folder::with(&[("room.scene", SMALL_ROOM)]);
    let ask = "bench tracers room.scene --size 12x6 --samples 16,4,4 --seeds 6 --variants path,path:independent,whitted --reference-samples 2048";
    let run = folder.ogee(ask).expect(0);
    assert!(run.stderr.ends_with("wrote report-tracers/index.md\n"), "{}", run.stderr);
    let text = |name: &str| String::from_utf8(folder.read(&format!("report-tracers/{name}"))).unwrap();
    let (_, rows) = store::read::<TracerRow>(&text("results/room.jsonl")).unwrap();
    let names: Vec<(String, u32)> = rows.iter().map(|row| (row.name(), row.samples)).collect();
    let all = ["path, sobol", "path, independent", "whitted, sobol"];
    let expected = [4, 16].into_iter().flat_map(|n| all.map(|name| (name.to_owned(), n)));
    assert_eq!(names, expected.collect::<Vec<_>>());
    let whitted_is_dark = rows.iter().filter(|row| row.tracer == "whitted").all(|row| row.mean_off < -0.01);
    assert!(whitted_is_dark, "what the floor sends the ball is not there: {rows:?}");
    let noise = |i: usize| rows[i].noise();
    assert!(noise(3) < noise(0) && noise(4) < noise(1) && noise(3) < noise(4), "{rows:?}");
    let page = text("index.md");
    std::fs::remove_file(folder.path().join("report-tracers/index.md")).unwrap();
    folder.ogee("bench report report-tracers").expect(0);
    assert!(text("index.md") == page && page.contains("12 × 6 pixels, 6 seeds"));
}

#[test]
fn what_cannot_be_measured_of_tracers_is_told() {
    let folder = Folder::with(&[("room.scene", SMALL_ROOM), ("no.scene", "sphere { radius }")]);
    for (line, exit, words) in [
        ("room.scene --variants paths", 2, "there is no tracer `paths`; there are raycast, whitted"),
        ("room.scene --variants path:even", 2, "there is no sampler `even`; there are sobol"),
        ("room.scene room.scene --reference a.exr", 2, "one `--reference` is of one scene"),
        ("room.scene --reference a.exr", 3, "cannot read a.exr"),
        ("no.scene", 1, "sphere"),
        ("other.scene", 3, "cannot read other.scene"),
        ("room.scene --seeds 1", 2, "1 is not in 2.."),
    ] {
        let run = folder.ogee(&format!("bench tracers {line}")).expect(exit);
        assert!(run.stderr.contains(words), "{line}: {}", run.stderr);
    }
    folder.ogee("render room.scene --size 8x4 --samples 1 -o r.exr").expect(0);
    let run = folder.ogee("bench tracers room.scene --reference r.exr").expect(1);
    assert!(run.stderr.contains("it has 8 × 4 pixels and the pictures 128 × 64"), "{}", run.stderr);
}

#[test]
fn tracers_are_measured_with_the_depth_that_the_scene_says() {
    let text = SMALL_ROOM.replace("size 200, 100", "size 200, 100  depth 1");
    // A lamp that is brighter than white has rays of its own about its edges.
    let text = text.replace("radiance 12", "radiance 1");
    let folder = Folder::with(&[("room.scene", &text)]);
    folder
        .ogee("bench tracers room.scene --size 12x6 --samples 4 --seeds 2 --variants path --reference-samples 2")
        .expect(0);
    let results = String::from_utf8(folder.read("report-tracers/results/room.jsonl")).unwrap();
    let (_, rows) = store::read::<TracerRow>(&results).unwrap();
    assert_eq!(rows[0].rays, f64::from(12 * 6 * 4), "a camera ray a sample and no other: {rows:?}");
}

#[test]
fn trees_are_measured_and_their_report_comes_again_from_results() {
    let folder = Folder::with(&[("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")]);
    folder.ogee("bench accelerators one.obj --quick --out trees").expect(0);
    let text = |name: &str| String::from_utf8(folder.read(&format!("trees/{name}"))).unwrap();
    let page = text("index.md");
    for part in ["## one", "## ball", "growing-hills.svg", "| 2 | 4096 | kdtree | ", "| 0 of "] {
        assert!(page.contains(part), "{part}: {page}");
    }
    let plot = text("growing-hills.svg");
    std::fs::remove_file(folder.path().join("trees/growing-hills.svg")).unwrap();
    folder.ogee("bench report trees").expect(0);
    assert_eq!(text("growing-hills.svg"), plot);
    assert_eq!(text("index.md"), page);
    let missing = folder.ogee("bench accelerators nothing.obj").expect(3);
    assert!(missing.stderr.contains("nothing.obj"), "{}", missing.stderr);
}

#[test]
fn the_renderer_asks_an_implicit_function_at_most_half_as_often_as_halving_by_intervals() {
    // A double zero takes as many: whether it is one must be decided too.
    for case in ["sphere", "thin shell", "tanglecube", "torus"] {
        let work = |variant| row("implicit surface", case, variant).work;
        let (ours, naive) = (work("cells, then forms"), work("intervals halved, x·x"));
        assert!(ours <= 0.5 * naive, "{case}: {ours} of {naive}");
    }
}
