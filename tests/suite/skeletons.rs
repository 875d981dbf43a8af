//! Skeletons as a whole: how they are shown, motion capture as it comes, and what hostile input does.

use crate::run::Folder;
use ogee::session::Session;

/// The scene of a test on real data, "DATA" standing for its folder; none, said aloud, where it is not given.
fn on_data(text: &str) -> Option<String> {
    let Some(data) = std::env::var_os("OGEE_DATA") else {
        println!("skipped: OGEE_DATA does not name the folder of test data");
        return None;
    };
    Some(text.replace("DATA", &data.to_string_lossy()))
}

/// What is wrong with a scene, in one text.
fn said(text: &str) -> String {
    let evaluated = Session::default().evaluate_text("a.scene", text);
    evaluated.diagnostics.iter().map(|d| format!("{} {}\n", d.code.text(), d.message)).collect()
}

#[test]
fn inspect_shows_the_tree_with_angles_limits_and_places() {
    let text = "skeleton arm { joint shoulder { offset y*6  hinge z  angle -90  limits -120, 120\n\
                joint wrist { offset x*5  ball on  tip hand { offset x } } } }\n\
                pose up { of arm  shoulder 90 }\nsphere {}\n";
    let folder = Folder::with(&[("a.scene", text)]);
    let shown = folder.ogee("inspect a.scene").expect(0);
    let lines: Vec<String> = shown.out().lines().take(8).map(str::to_owned).collect();
    let expected = [
        "skeleton  label arm  # 1:1",
        "  joint  label shoulder  freedom hinge  angles -90  limits <-120, 120>  position <0, 6, 0>",
        "    joint  label wrist  freedom ball  angles <0, 0, 0>  position <0, 1, 0>",
        "      tip  label hand  position <0, 0, 0>",
        "pose  label up  # 3:1",
        "  joint  label shoulder  freedom hinge  angles 90  limits <-120, 120>  position <0, 6, 0>",
        "    joint  label wrist  freedom ball  angles <0, 0, 0>  position <0, 11, 0>",
        "      tip  label hand  position <0, 12, 0>",
    ];
    assert_eq!(lines, expected);
    let json = folder.ogee("inspect --format json a.scene").expect(0);
    let first: serde_json::Value = serde_json::from_str(json.out().lines().next().unwrap()).unwrap();
    assert_eq!(first["children"][0]["children"][0]["label"], "wrist");
}

/// The places are from 60 lines of numpy that read the same file.
#[test]
fn captured_motion_is_where_another_reader_puts_it() {
    let scene = on_data(
        "skeleton man { file \"DATA/motion/walk.bvh\" }\n\
         fn at(frame) { pose p { of man  at frame * 0.0083333 }\n return p }\n\
         let near = (a, b) => distance(a, b) < 1e-8\n\
         assert(abs(man.duration - 2.8583219) < 1e-12 && len(man.joints) == 31)\n\
         assert(near(at(0).Head_end, <10.503690000, 25.511652508, -30.154917298>))\n\
         assert(near(at(0).LThumb_end, <22.667870083, 20.508603382, -29.933070000>))\n\
         assert(near(at(100).LeftToeBase_end, <11.094437615, 1.039416017, -16.090137855>))\n\
         assert(near(at(100).RightHandIndex1_end, <5.593593274, 12.403522748, -13.038100927>))\n\
         assert(near(at(343).Head_end, <11.094005627, 26.319896701, 28.725082480>))\n\
         assert(near(at(343).LThumb_end, <14.820733052, 15.962888484, 32.474527985>))\n",
    );
    assert_eq!(scene.map_or(String::new(), |scene| said(&scene)), "");
}

#[test]
fn a_captured_figure_is_posed_and_reaches_by_name() {
    let scene = on_data(
        "skeleton man { file \"DATA/motion/walk.bvh\" }\n\
         pose walk { of man  at 0.7 }\n\
         let target = walk.RightHandIndex1_end + <2, 3, 1>\n\
         pose grasp { of walk  reach RightHandIndex1_end, target  reach LeftToeBase_end, walk.LeftToeBase_end }\n\
         assert(distance(grasp.RightHandIndex1_end, target) <= 1e-9)\n\
         assert(distance(grasp.LeftToeBase_end, walk.LeftToeBase_end) <= 1e-9)\n\
         pose nod { of walk  Head <20, 0, 0> }\n\
         assert(nod.Head.angles == <20, 0, 0> && nod.Hips.shift == walk.Hips.shift)\n",
    );
    assert_eq!(scene.map_or(String::new(), |scene| said(&scene)), "");
}

#[test]
fn targets_without_end_are_answered_and_functions_without_end_are_stopped() {
    let arm = "skeleton arm { joint a { hinge z  joint b { offset x  ball on  tip hand { offset x } } } }\n";
    for target in ["<1e300, 1e300, 0>", "<1e-300, 0, 0>", "<1e160, -1e160, 1e160>", "<0, 0, 0>"] {
        for method in ["dls", "ccd", "pseudo_inverse", "jacobian_transpose"] {
            let said = said(&format!("{arm}pose p {{ of arm  reach hand, {target}  method {method} }}"));
            assert!(!said.contains('E'), "{target} by {method}: {said}");
        }
    }
    let endless = "fn f(n) { joint a { hinge z  if n > 0 { f(n - 1) } } }\n";
    assert!(said(&format!("{endless}skeleton s {{ f(3) }}")).starts_with("E0102"));
    assert!(said(&format!("{endless}skeleton s {{ f(700) }}")).starts_with("E0003"));
    assert!(said(&format!("{endless}skeleton s {{ f(1e9) }}")).starts_with("E0403"));
}

#[test]
fn a_sampled_function_may_use_a_pose() {
    let text = "skeleton arm { joint a { hinge z  angle 90  tip hand { offset x*2 } } }\n\
                sphere { material { diffuse p => arm.a.frame(x).y + distance(p, arm.hand) } }";
    assert_eq!(said(text), "");
}
