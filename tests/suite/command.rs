//! The command line: what it reads and writes, how it ends, and that it keeps its manners.

use crate::run::Folder;
use std::process::Stdio;
use std::time::{Duration, Instant};

const BALL: &str = "camera { eye <0, 0, 5>  look_at <0, 0, 0> }\nlight { sky 0.8 }\nsphere { radius 1 }\n";

fn ball() -> Folder {
    Folder::with(&[("ball.scene", BALL)])
}

fn size_of(png: &[u8]) -> (u32, u32) {
    let image = image::load_from_memory(png).expect("a picture");
    (image.width(), image.height())
}

#[test]
fn the_words_of_the_command_line_are_answered_as_written() {
    trycmd::TestCases::new().case("tests/cmd/*.trycmd").run();
}

#[test]
fn a_picture_is_named_after_its_scene_and_stands_in_the_current_folder() {
    let folder = ball();
    std::fs::create_dir(folder.path().join("deep")).unwrap();
    std::fs::rename(folder.path().join("ball.scene"), folder.path().join("deep/ball.scene")).unwrap();
    let run = folder.ogee("render deep/ball.scene --size 32x24").expect(0);
    assert_eq!(folder.names(), ["ball.png", "deep"]);
    assert_eq!(size_of(&folder.read("ball.png")), (32, 24));
    assert!(run.stdout.is_empty());
    assert!(run.stderr.starts_with("ball.png  32×24  "), "{}", run.stderr);
}

#[test]
fn every_format_can_be_written_and_read_again() {
    let folder = ball();
    for name in ["a.png", "a.jpg", "a.hdr", "a.exr"] {
        folder.ogee(&format!("render ball.scene --size 16x12 -o {name}")).expect(0);
        let run = folder.ogee(&format!("compare {name} a.png --format json")).expect(0);
        let result: serde_json::Value = serde_json::from_str(run.out()).unwrap();
        assert!(result["rmse"].as_f64().unwrap() < 0.05, "{name}: {result}");
    }
    let run = folder.ogee("render ball.scene -o a.tiff").expect(2);
    assert!(run.stderr.contains("pictures are .png, .jpg, .hdr or .exr"), "{}", run.stderr);
}

#[test]
fn scenes_come_from_standard_input_and_pictures_go_to_standard_output() {
    let run = Folder::new().ogee_fed("render - -o - --size 16x12", BALL).expect(0);
    assert_eq!(size_of(&run.stdout), (16, 12));
}

/// A mesh of a surface, spheres along a spline, and light from an area: whatever has code for wider instructions.
const WIDE: &str = "
camera { eye <0, 3, 5>  look_at <0, 0.5, 0>  fov 50 }
light { area disc { center <2, 4, 1>  normal <0, -1, 0>  radius 0.7 }  radiance 8 }
plane { normal y  offset 0 }
patch { bspline <-1, 0, -1>, <0, 0, -1>, <1, 0, -1>, <2, 0, -1>, <-1, 0, 0>, <0, 3, 0>, <1, 0, 0>, <2, 0, 0>, <-1, 0, 1>, <0, 0, 1>, <1, 3, 1>, <2, 0, 1>, <-1, 0, 2>, <0, 0, 2>, <1, 0, 2>, <2, 0, 2> }
let way = spline { bezier <-2, 0, 1>, <-1, 2, 1>, <1, 0, 2>, <2, 1, 0> }
for i in 0..40 { sphere { center way(i / 40)  radius 0.1 } }
";

#[test]
fn a_processor_without_wide_instructions_makes_the_same_picture() {
    let folder = Folder::with(&[("wide.scene", WIDE)]);
    let render = "render wide.scene --size 40x30 --tracer path --samples 4 -o wide.exr --stats json";
    let mut made = Vec::new();
    for baseline in [false, true] {
        let mut command = folder.command(render);
        if baseline {
            command.env("OGEE_BASELINE", "1");
        }
        let run = command.output().unwrap();
        let stats: serde_json::Value = serde_json::from_slice(&run.stdout).expect("statistics");
        assert!(!baseline || stats["vectors"] == "baseline", "{stats}");
        made.push(folder.read("wide.exr"));
    }
    assert!(made[0] == made[1]);
}

#[test]
fn flags_come_before_what_the_scene_says() {
    let text = format!("{BALL}let unused = 1\nrender {{ size 64, 48  samples 2 }}\n");
    let folder = Folder::with(&[("a.scene", &text)]);
    folder.ogee("render a.scene").expect(0);
    assert_eq!(size_of(&folder.read("a.png")), (64, 48));
    let run = folder.ogee("render a.scene --size 8x6 --samples 3 --stats json").expect(0);
    let stats: serde_json::Value = serde_json::from_str(run.out()).unwrap();
    assert_eq!((&stats["samples"], &stats["size"]), (&3.into(), &serde_json::json!([8, 6])));
    assert_eq!(stats["rays"]["camera"], 8 * 6 * 3);
}

#[test]
fn a_budget_tells_the_samples_that_make_the_same_picture() {
    let folder = ball();
    let run = folder
        .ogee("render ball.scene --size 32x24 --tracer path --budget 300ms -o a.exr --stats json")
        .expect(0);
    let stats: serde_json::Value = serde_json::from_str(run.out()).unwrap();
    let n = stats["samples"].as_u64().unwrap();
    assert!(n >= 2, "{n}");
    folder.ogee(&format!("render ball.scene --size 32x24 --tracer path --samples {n} -o b.exr")).expect(0);
    assert!(folder.read("a.exr") == folder.read("b.exr"), "{n} samples make the same file");
    let run = folder.ogee("render ball.scene --size 32x24 --budget 1h --samples 8 -o c.exr").expect(0);
    assert!(run.stderr.contains("8 samples a pixel"), "{}", run.stderr);
}

#[test]
fn budgets_errors_and_layers_that_cannot_be_are_told_before_the_work_begins() {
    let folder = ball();
    for (line, said) in [
        ("--budget 30", "30s"),
        ("--budget 1s --error 0.1", "cannot be used with"),
        ("--budget 1s --tracer photon", "--tracer path"),
        ("--budget 1s --sampler stratified", "--sampler sobol"),
        ("--budget 1s --samples 1", "2 samples"),
        ("--error 0", "above 0"),
        ("--layers depth", ".exr"),
        ("--layers deep -o a.exr", "depth"),
    ] {
        let run = folder.ogee(&format!("render ball.scene {line}")).expect(2);
        assert!(run.stderr.contains(said), "{line}: {}", run.stderr);
    }
    assert_eq!(folder.names(), ["ball.scene"]);
}

#[test]
fn an_error_tells_how_many_samples_it_took() {
    let folder = ball();
    let run = folder.ogee("render ball.scene --size 16x12 --error 0.005 --stats json").expect(0);
    let stats: serde_json::Value = serde_json::from_str(run.out()).unwrap();
    assert_eq!((&stats["samples"], &stats["error"]), (&4096.into(), &0.005.into()));
    let taken = &stats["samples_taken"];
    assert_eq!(taken["least"], 32);
    assert!(taken["mean"].as_f64().unwrap() < taken["most"].as_f64().unwrap(), "{taken}");
    assert!(run.stderr.contains("on average"), "{}", run.stderr);
}

#[test]
fn the_layer_of_objects_tells_their_lines_and_no_folders() {
    let folder = ball();
    folder.ogee("render ball.scene --size 8x6 -o a.exr --layers source,depth").expect(0);
    let bytes = folder.read("a.exr");
    let text = String::from_utf8_lossy(&bytes);
    assert!(
        text.contains(r#""sources":[{"number":1,"file":"ball.scene","line":"#),
        "the table is in the metadata"
    );
}

#[test]
fn a_crop_is_that_part_of_the_picture() {
    let folder = ball();
    folder.ogee("render ball.scene --size 32x24 -o whole.png").expect(0);
    folder.ogee("render ball.scene --size 32x24 --crop 10,8,12,6 -o part.png").expect(0);
    let whole = image::load_from_memory(&folder.read("whole.png")).unwrap().to_rgb8();
    let part = image::load_from_memory(&folder.read("part.png")).unwrap().to_rgb8();
    let same = image::imageops::crop_imm(&whole, 10, 8, 12, 6).to_image();
    assert!(part == same, "the pixels of a crop are those of the whole picture");
    folder.ogee("render ball.scene --size 32x24 --crop 30,0,12,6").expect(2);
}

#[test]
fn faults_of_the_scene_exit_1_of_the_line_2_of_the_machine_3() {
    let folder = Folder::with(&[("ball.scene", BALL), ("broken.scene", "sphere { radius nope }\n")]);
    folder.ogee("render broken.scene").expect(1);
    folder.ogee("check broken.scene").expect(1);
    folder.ogee("render ball.scene --size big").expect(2);
    folder.ogee("render ball.scene --tracer magic").expect(2);
    let run = folder.ogee("render bal.scene").expect(3);
    assert!(run.stderr.contains("did you mean ball.scene?"), "{}", run.stderr);
    folder.ogee("render ball.scene -o no/such/folder/a.png").expect(3);
    assert_eq!(folder.names(), ["ball.scene", "broken.scene"], "no file of a run that failed");
}

#[test]
fn a_place_that_cannot_be_written_is_told_before_the_work_begins() {
    let folder = ball();
    let start = Instant::now();
    let run = folder.ogee("render ball.scene --size 4000x4000 --samples 10000 -o no/a.png").expect(3);
    assert!(run.stderr.contains("there is no folder no"), "{}", run.stderr);
    assert!(start.elapsed() < Duration::from_secs(5));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_picture_and_no_torn_one() {
    let folder = ball();
    folder.ogee("render ball.scene --size 8x6").expect(0);
    let before = folder.read("ball.png");
    // A limit on the size of files stands for a disk that is full: the write fails half way.
    let line = "trap '' XFSZ; ulimit -f 1; $OGEE render ball.scene --size 640x480 -o ball.hdr";
    folder.sh(line).expect(3);
    let line = "trap '' XFSZ; ulimit -f 1; $OGEE render ball.scene --size 1280x960";
    folder.sh(line).expect(3);
    assert_eq!(folder.names(), ["ball.png", "ball.scene"]);
    assert!(folder.read("ball.png") == before, "the old picture is whole");
    folder.sh("$OGEE explain > /dev/full").expect(3);
    folder.sh("$OGEE render ball.scene --size 8x6 -o - > /dev/full").expect(3);
}

#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let folder = ball();
    for line in ["ast ball.scene", "explain", "docs", "man", "render ball.scene --size 320x240 -o -"] {
        let run = folder.sh(&format!("{{ sleep 0.1; $OGEE {line}; echo $? >code; }} | true"));
        assert!(!run.stderr.contains("panic") && !run.stderr.contains("fault"), "{line}: {}", run.stderr);
        assert_eq!(folder.read("code"), b"0\n", "{line}");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_picture_is_saved_as_far_as_it_is() {
    let folder = ball();
    let mut command = folder.command("render ball.scene --size 2000x1500 --samples 100000");
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(700));
    let kill = |pid: u32| std::process::Command::new("kill").args(["-INT", &pid.to_string()]).status();
    assert!(kill(child.id()).unwrap().success());
    let start = Instant::now();
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(130));
    assert!(start.elapsed() < Duration::from_secs(20), "it ends soon");
    assert_eq!(size_of(&folder.read("ball.png")), (2000, 1500));
    assert_eq!(folder.names(), ["ball.png", "ball.scene"]);
}

/// A picture of which a single record takes sixteen million rays.
#[cfg(unix)]
#[test]
fn an_interruption_before_the_first_pixel_leaves_what_was_there() {
    let text = "camera { eye <0, 0, 5>  look_at <0, 0, 0> }\nlight { sky 0.8 }\nsphere { }\nplane { normal y  offset -1 }\n";
    let folder = Folder::with(&[("a.scene", text), ("a.png", "old")]);
    let line = "render a.scene --tracer irradiance --samples 1000000 --size 64x48";
    let child = folder.command(line).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(700));
    let pid = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let run = child.wait_with_output().unwrap();
    assert_eq!(run.status.code(), Some(130));
    let said = String::from_utf8(run.stderr).unwrap();
    assert!(said.contains("a.png  not written: interrupted before its first pixel"), "{said}");
    assert_eq!(folder.read("a.png"), b"old");
    assert_eq!(folder.names(), ["a.png", "a.scene"]);
}

/// Each ray of this meets 3²⁵ spheres: none ever comes back.
#[cfg(unix)]
#[test]
fn rays_without_end_are_interrupted_soon_and_leave_a_whole_picture() {
    let text = "camera { eye <0, 0, 5>  look_at <0, 0, 0> }\nlight { sky 0.8 }\nvar g = sphere { }\n\
                for i in 0..25 {\n  let h = g\n  \
                g = group { h; h with { translate x / 1000 }; h with { translate y / 1000 } }\n}\ng\n";
    for signal in ["-INT", "-TERM"] {
        let folder = Folder::with(&[("endless.scene", text)]);
        let mut child =
            folder.command("render endless.scene --size 64x48").stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(700));
        let pid = child.id().to_string();
        assert!(std::process::Command::new("kill").args([signal, &pid]).status().unwrap().success());
        let start = Instant::now();
        let status = child.wait().unwrap();
        assert!(start.elapsed() < Duration::from_secs(5), "{signal}: {:?}", start.elapsed());
        assert_eq!(status.code(), Some(130), "{signal}");
        assert_eq!(size_of(&folder.read("endless.png")), (64, 48));
        assert_eq!(folder.names(), ["endless.png", "endless.scene"], "{signal}");
    }
}

#[test]
fn pictures_are_compared_against_a_threshold() {
    let folder = ball();
    folder.ogee("render ball.scene --size 32x24 -o a.png").expect(0);
    folder.ogee("render ball.scene --size 32x24 --exposure 1 -o b.png").expect(0);
    folder.ogee("render ball.scene --size 16x12 -o c.png").expect(0);
    folder.ogee("compare a.png a.png --max-rmse 0").expect(0);
    let run = folder.ogee("compare a.png b.png --max-rmse 0.01").expect(1);
    assert!(run.out().starts_with("rmse "), "{}", run.out());
    let run = folder.ogee("compare a.png c.png").expect(1);
    assert!(run.stderr.contains("their sizes differ: 32×24 and 16×12"), "{}", run.stderr);
    folder.ogee("compare a.png ball.scene").expect(1);
    folder.ogee("compare a.png none.png").expect(3);
}

#[test]
fn values_are_printed_so_that_they_come_back_the_same() {
    let folder = Folder::with(&[("a.scene", "let side = 3\nfn twice(x) = 2 * x\n")]);
    for (expression, printed) in [
        ("0.1+0.2", "0.30000000000000004"),
        ("<1,2,3>/2", "<0.5, 1, 1.5>"),
        ("[1,2..4]", "[1, 2..4]"),
        ("1e300", "1e300"),
    ] {
        assert_eq!(folder.ogee(&format!("eval {expression}")).expect(0).out().trim_end(), printed);
    }
    assert_eq!(folder.ogee("eval -1").expect(0).out(), "-1\n");
    assert_eq!(folder.ogee("eval twice(side) --in a.scene").expect(0).out(), "6\n");
    assert_eq!(folder.ogee("eval pi --digits 3").expect(0).out(), "3.14\n");
    folder.ogee("eval 1/0").expect(1);
}

#[test]
fn formatting_changes_the_layout_alone_and_only_once() {
    let folder = Folder::with(&[("a.scene", "sphere{radius   1}  // a ball\n")]);
    let run = folder.ogee("fmt --check a.scene").expect(1);
    assert!(run.stderr.contains("a.scene"), "{}", run.stderr);
    let before = folder.ogee("ast a.scene").expect(0).stdout;
    folder.ogee("fmt a.scene").expect(0);
    folder.ogee("fmt --check a.scene").expect(0);
    assert!(folder.ogee("ast a.scene").expect(0).stdout == before);
    assert!(String::from_utf8(folder.read("a.scene")).unwrap().contains("// a ball"));
    let run = folder.ogee_fed("fmt -", "sphere{radius   1}").expect(0);
    assert!(run.out().starts_with("sphere { radius 1 }"), "{}", run.out());
    let broken = Folder::with(&[("b.scene", "sphere { radius \n")]);
    broken.ogee("fmt b.scene").expect(1);
    assert_eq!(broken.read("b.scene"), b"sphere { radius \n", "a broken scene is left alone");
}

#[test]
fn scenes_are_tested_against_the_snapshots_beside_them() {
    let text = format!("{BALL}render {{ size 24, 18 }}\nassert(1 + 1 == 2, \"sums\")\n");
    let folder = Folder::with(&[("a.scene", &text)]);
    let run = folder.ogee("test .").expect(1);
    assert!(run.stderr.contains("0 passed, 1 failed"), "{}", run.stderr);
    folder.ogee("test . --bless").expect(0);
    assert_eq!(folder.names(), ["a.ast.txt", "a.png", "a.scene"]);
    let run = folder.ogee("test a.scene").expect(0);
    assert!(run.stderr.contains("1 passed, 0 failed"), "{}", run.stderr);
    std::fs::write(folder.path().join("a.scene"), text.replace("radius 1", "radius 1.5")).unwrap();
    let run = folder.ogee("test .").expect(1);
    assert_eq!(folder.names(), ["a.ast.txt", "a.diff.png", "a.png", "a.scene"]);
    assert_eq!(size_of(&folder.read("a.diff.png")), (72, 18));
    assert!(run.stderr.contains("a.diff.png"), "{}", run.stderr);
    folder.ogee("test . --bless").expect(0);
    assert_eq!(folder.names(), ["a.ast.txt", "a.png", "a.scene"], "what differs no more is not shown apart");
}

#[test]
fn a_man_page_is_written_for_each_command() {
    let folder = Folder::new();
    folder.ogee("man pages").expect(0);
    let pages = std::fs::read_dir(folder.path().join("pages")).unwrap().count();
    assert!(pages > 12, "{pages} pages");
}
