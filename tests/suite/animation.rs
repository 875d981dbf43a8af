//! Animations: which frames are made, what they are called, what of them is the same, and what is kept from one to the next.

use crate::run::Folder;
use ogee::scene::assets::Loader;
use ogee::session::animation::{Animation, Asked};
use ogee::session::picture::{self, Job};
use ogee::session::{Options, Session};
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, Mutex};

const MOVING: &str = "render { size 24, 16  frames 6  fps 12  samples 2 }
camera { eye <0, 0, 5>  look_at <0, 0, 0> }
light { point <2, 3, 4>  intensity 40 }
sphere { center <2 * time - 1, 0.1 * frame, 0>  radius 0.6  material { diffuse <0.9, 0.5, 0.2> } }
";

/// An arm whose target goes round it: from rest the elbow bends up for one half of the way, and down for the other.
const REACHING: &str = "render { size 24, 16  frames 24  samples 1 }
camera { eye <0, 0, 12>  look_at <0, 0, 0> }
light { sky 1 }
skeleton arm { joint shoulder { hinge z  joint elbow { offset <2, 0, 0>  hinge z  tip hand { offset <2, 0, 0> } } } }
pose touch { of arm  reach hand, <3 * cos(2 * pi * time), 3 * sin(2 * pi * time), 0> }
print(touch.shoulder.angle, touch.elbow.angle)
sphere { center touch.elbow.position  radius 0.6 }
sphere { center touch.hand  radius 0.3 }
";

fn moving() -> Folder {
    Folder::with(&[("a.scene", MOVING)])
}

#[test]
fn each_frame_has_a_file_of_its_own_and_the_end_of_a_range_is_not_in_it() {
    let folder = moving();
    folder.ogee("render a.scene -o {frame:03}.png --frames 1..4").expect(0);
    assert_eq!(folder.names(), ["001.png", "002.png", "003.png", "a.scene"]);
    folder.ogee("render a.scene -o b{frame}.png --frames 4..=5").expect(0);
    folder.ogee("render a.scene -o c.png --frames 2").expect(0);
    assert_eq!(folder.names()[3..], ["a.scene", "b4.png", "b5.png", "c.png"]);
    assert!(folder.read("c.png") == folder.read("002.png"), "one frame is that frame");
    folder.ogee("render a.scene -o d{frame}.png").expect(0);
    assert_eq!(folder.names().iter().filter(|name| name.starts_with('d')).count(), 6, "all frames");
    let distinct: std::collections::HashSet<Vec<u8>> =
        (0..6).map(|i| folder.read(&format!("d{i}.png"))).collect();
    assert_eq!(distinct.len(), 6);
}

#[test]
fn a_scene_that_does_not_say_how_many_frames_it_has_has_as_many_as_are_asked_for() {
    let text = MOVING.replace("frames 6  fps 12", "") + "print(frame, time)\n";
    let folder = Folder::with(&[("a.scene", &text)]);
    let run = folder.ogee("render a.scene -o {frame}.png --frames 1..4").expect(0);
    assert!(run.stderr.starts_with("1 0.25\n2 0.5\n3 0.75\n"), "{}", run.stderr);
    folder.ogee("render a.scene").expect(0);
    assert!(folder.names().contains(&"a.png".to_owned()), "and else it is one picture");
}

#[test]
fn a_frame_is_the_same_alone_in_the_run_resumed_and_on_any_threads() {
    let folder = Folder::with(&[("a.scene", REACHING)]);
    folder.ogee("render a.scene -o a{frame}.png --threads 2").expect(0);
    folder.ogee("render a.scene -o alone{frame}.png --frames 17 --threads 1").expect(0);
    assert!(folder.read("alone17.png") == folder.read("a17.png"), "alone and in the run");
    let before = [folder.read("a5.png"), folder.read("a17.png")];
    ["a5.png", "a17.png"].iter().for_each(|name| std::fs::remove_file(folder.path().join(name)).unwrap());
    std::fs::write(folder.path().join("a6.png"), "a file that is there").unwrap();
    let run = folder.ogee("render a.scene -o a{frame}.png --resume").expect(0);
    assert!(run.stderr.contains("2 frames") && run.stderr.contains("22 were there"), "{}", run.stderr);
    assert!([folder.read("a5.png"), folder.read("a17.png")] == before, "resumed");
    assert!(folder.read("a6.png") == b"a file that is there", "what is there is left");
    folder.ogee("render a.scene -o cold.png --time 0.70833333333333333").expect(0);
    assert!(folder.read("cold.png") != before[1], "a moment of its own reaches from rest: the test can fail");
}

/// The elbow's angle in each frame.
fn elbows(each: impl FnMut(u32) -> String) -> Vec<f64> {
    let angle = |line: String| line.split_whitespace().last().unwrap().parse().unwrap();
    (0..24).map(each).map(angle).collect()
}

#[test]
fn a_reach_goes_on_from_the_frame_before_so_that_no_joint_jumps() {
    let folder = Folder::with(&[("a.scene", REACHING)]);
    let path = folder.path().join("a.scene");
    let warm = Session::default()
        .animate(&path, Asked::Whole, None, |a| elbows(|frame| a.frame(frame).printed.remove(0)));
    let largest = |angles: &[f64]| angles.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    assert!(largest(&warm) < 1e-6, "the elbow keeps its bend: {warm:?}");
    let cold = elbows(|frame| {
        let options = Options { time: f64::from(frame) / 24.0, ..Options::default() };
        let mut session = Session::new(options, Arc::new(ogee::scene::assets::DiskLoader));
        session.evaluate_file(&path).printed.remove(0)
    });
    assert!(largest(&cold) > 100.0, "from rest it would flip: {cold:?}");
}

#[test]
fn a_gif_has_all_frames_at_their_times_and_is_the_default() {
    let folder = moving();
    let run = folder.ogee("render a.scene").expect(0);
    assert_eq!(folder.names(), ["a.gif", "a.scene"]);
    assert!(run.stderr.starts_with("a.gif  6 frames  24×16  "), "{}", run.stderr);
    let bytes = folder.read("a.gif");
    let mut decoder = gif::DecodeOptions::new().read_info(&bytes[..]).unwrap();
    assert_eq!((decoder.width(), decoder.height()), (24, 16));
    let mut delays = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        delays.push(frame.delay);
    }
    assert_eq!(delays, [8, 9, 8, 8, 9, 8], "half a second in hundredths");
}

#[test]
fn a_frame_of_another_size_ends_the_file_of_all_and_keeps_those_before() {
    let folder = Folder::with(&[("a.scene", &MOVING.replace("24, 16", "frame < 2 ? 24 : 30, 16"))]);
    for file in ["a.gif", "a.apng"] {
        let run = folder.ogee(&format!("render a.scene -o {file}")).expect(1);
        assert!(run.stderr.contains("this frame is 30×16, and those before it are 24×16"), "{}", run.stderr);
        assert!(run.stderr.contains("[a.scene:1:15]"), "at `size`: {}", run.stderr);
        assert!(run.stderr.contains("-o 'a-{frame:04}.png'"), "{}", run.stderr);
        assert!(run.stderr.contains(&format!("{file}  2 frames of 6")), "{}", run.stderr);
        assert!(!folder.read(file).is_empty());
    }
    folder.ogee("render a.scene -o {frame}.png").expect(0);
}

#[test]
fn frames_before_a_crop_that_no_longer_fits_are_kept() {
    let folder = Folder::with(&[("a.scene", &MOVING.replace("24, 16", "frame < 2 ? 24 : 12, 16"))]);
    let run = folder.ogee("render a.scene --crop 4,0,20,16").expect(2);
    assert!(run.stderr.contains("a.gif  2 frames of 6"), "{}", run.stderr);
    assert!(!folder.read("a.gif").is_empty());
}

#[test]
fn an_apng_has_the_pixels_of_the_files_of_each_frame() {
    use image::AnimationDecoder;
    let folder = moving();
    folder.ogee("render a.scene -o a.apng").expect(0);
    folder.ogee("render a.scene -o {frame}.png").expect(0);
    let decoder = image::codecs::png::PngDecoder::new(Cursor::new(folder.read("a.apng"))).unwrap();
    let frames = decoder.apng().unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 6);
    for (i, frame) in frames.iter().enumerate() {
        let alone = image::load_from_memory(&folder.read(&format!("{i}.png"))).unwrap().to_rgba8();
        assert!(*frame.buffer() == alone, "frame {i}");
        let (numerator, denominator) = frame.delay().numer_denom_ms();
        assert!((f64::from(numerator) / f64::from(denominator) - 1000.0 / 12.0).abs() < 1.0);
    }
}

#[test]
fn names_and_ranges_that_cannot_be_are_told_before_the_work_begins() {
    let folder = moving();
    for (line, words) in [
        ("-o {frame:xx}.png", "`{frame:xx}` is no place for a frame's number"),
        ("-o {fraem}.png", "`{fraem}` is no place for a frame's number"),
        ("-o a.png", "6 frames do not go into one a.png\nwrite `-o a-{frame:04}.png`"),
        ("-o a.exr --frames 2..4", "2 frames do not go into one a.exr"),
        ("-o -", "6 frames do not go into one -"),
        ("-o {frame}.gif", "a file for each frame is .png, .jpg, .hdr or .exr"),
        ("-o a.mp4", "animations .gif or .apng"),
        ("-o a.gif --resume", "`--resume` looks for a file for each frame"),
        ("--frames 3..3", "there is no frame in it"),
        ("--frames 4..2", "there is no frame in it"),
        ("--frames 0..7", "frame 6 is beyond the last: the scene says `frames 6`"),
        ("--frames two", "write it as 0..24"),
        ("--frames -1..3", "unexpected argument '-1'"),
        ("--frames 0..2 --time 0.5", "cannot be used with"),
    ] {
        let run = folder.ogee(&format!("render a.scene {line}")).expect(2);
        assert!(run.stderr.contains(words), "{line}: {}", run.stderr);
    }
    let run = folder.ogee("render a.scene -o no/{frame}.png").expect(3);
    assert!(run.stderr.contains("there is no folder no"), "{}", run.stderr);
    assert_eq!(folder.names(), ["a.scene"]);
}

#[test]
fn a_single_moment_is_a_still_picture() {
    let folder = moving();
    folder.ogee("render a.scene --time 0.5 -o half.png").expect(0);
    folder.ogee("render a.scene --time 0.25").expect(0);
    assert_eq!(folder.names(), ["a.png", "a.scene", "half.png"]);
    assert!(folder.read("a.png") != folder.read("half.png"));
}

#[test]
fn what_is_said_of_every_frame_is_said_once_and_an_error_with_its_frame() {
    let far = REACHING.replace("<3 * cos(2 * pi * time), 3 * sin(2 * pi * time), 0>", "<5, time, 0>");
    let folder = Folder::with(&[
        ("far.scene", &far),
        ("a.scene", &(MOVING.to_owned() + "sphere { radius 3 - frame }")),
    ]);
    let run = folder.ogee("render far.scene").expect(0);
    assert_eq!(run.stderr.matches("short of its target").count(), 1, "{}", run.stderr);
    assert!(run.stderr.contains("at frame 0, and perhaps later ones:"), "{}", run.stderr);
    let run = folder.ogee("render a.scene -o {frame}.png").expect(1);
    assert!(run.stderr.contains("at frame 3:") && !run.stderr.contains("at frame 4"), "{}", run.stderr);
    assert_eq!(folder.names(), ["0.png", "1.png", "2.png", "a.scene", "far.gif", "far.scene"]);
    let run = folder.ogee("render a.scene -o a.gif").expect(1);
    assert!(run.stderr.contains("a.gif  3 frames of 6"), "what was made is saved: {}", run.stderr);
}

#[test]
fn stats_are_an_object_a_frame() {
    let run = moving().ogee("render a.scene -o {frame}.png --frames 2..4 --stats json").expect(0);
    let lines: Vec<serde_json::Value> =
        run.out().lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!((&lines[1]["frame"], &lines[1]["output"]), (&3.into(), &"3.png".into()));
}

#[cfg(unix)]
#[test]
fn an_interrupted_animation_keeps_its_whole_frames_and_no_other() {
    let slow = MOVING
        .replace("size 24, 16  frames 6", "size 320, 240  frames 500")
        .replace("samples 2", "samples 40");
    let folder = Folder::with(&[("a.scene", &slow)]);
    for output in ["f{frame:03}.png", "a.gif"] {
        let mut child = folder.command(&format!("render a.scene -o {output}")).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(2500));
        let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
    }
    let names = folder.names();
    let frames: Vec<&String> = names.iter().filter(|name| name.starts_with('f')).collect();
    assert!(!frames.is_empty() && frames.len() < 500, "{names:?}");
    for name in frames {
        let picture = image::load_from_memory(&folder.read(name)).unwrap().to_rgb8();
        assert!(picture.pixels().any(|p| p.0 != [0; 3]), "{name}");
    }
    let bytes = folder.read("a.gif");
    let mut decoder = gif::DecodeOptions::new().read_info(&bytes[..]).unwrap();
    assert!(decoder.read_next_frame().unwrap().is_some(), "the frames so far are an animation");
    assert!(names.iter().all(|name| !name.contains(".part")), "{names:?}");
}

/// The second frame's records take sixteen million rays each.
#[cfg(unix)]
#[test]
fn frames_stay_where_the_next_is_interrupted_before_its_first_pixel() {
    let text = "camera { eye <0, 0, 5>  look_at <0, 0, 0> }\nlight { sky 0.8 }\nsphere { }\n\
                render { tracer irradiance  size 24, 16  frames 3  samples frame == 0 ? 1 : 1000000 }\n";
    let folder = Folder::with(&[("a.scene", text)]);
    for output in ["f{frame}.png", "a.gif"] {
        let mut child = folder.command(&format!("render a.scene -o {output}")).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(1500));
        let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
    }
    assert_eq!(folder.names(), ["a.gif", "a.scene", "f0.png"]);
}

/// Files in memory, and how often each was read.
struct Counting {
    files: BTreeMap<&'static str, Vec<u8>>,
    reads: Mutex<BTreeMap<String, usize>>,
}

impl Loader for Counting {
    fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        let name = path.display().to_string();
        *self.reads.lock().unwrap().entry(name.clone()).or_default() += 1;
        self.files.get(&*name).cloned().ok_or_else(|| std::io::ErrorKind::NotFound.into())
    }

    fn exists(&self, path: &Path) -> bool {
        self.files.contains_key(&*path.display().to_string())
    }
}

const WITH_FILES: &str = "render { size 8, 6  frames 4 }
camera { eye <0, 0, 5>  look_at <0, 0, 0> }
light { point <2, 3, 4>  intensity 40 }
mesh { file \"t.obj\"  translate <time, 0, 0>  material { diffuse image(\"p.png\") } }
mesh { file \"t.obj\"  translate <0, time, 0> }
";

fn png() -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image::RgbImage::from_pixel(2, 2, image::Rgb([200, 90, 40]))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

fn prepared(animation: &mut Animation<'_>, frame: u32) -> picture::Prepared {
    let evaluated = animation.frame(frame);
    assert!(evaluated.diagnostics.is_empty(), "{:?}", evaluated.diagnostics);
    let job = Job::default();
    let settings = picture::settings(&evaluated.scene, &job).unwrap();
    let (prepared, found) = animation.prepare(evaluated.scene, &job, settings);
    assert!(found.is_empty(), "{found:?}");
    prepared.unwrap()
}

#[test]
fn files_are_read_once_for_all_frames() {
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n".to_vec();
    let files =
        BTreeMap::from([("a.scene", WITH_FILES.as_bytes().to_vec()), ("t.obj", obj), ("p.png", png())]);
    let loader = Arc::new(Counting { files, reads: Mutex::default() });
    let mut session = Session::new(Options::default(), loader.clone());
    session.animate(Path::new("a.scene"), Asked::Whole, None, |animation| {
        assert_eq!(animation.frames(), Ok(0..4));
        let films: Vec<_> = (0..4)
            .map(|frame| prepared(animation, frame))
            .map(|p| {
                assert_eq!(p.world.stats().triangles, 1);
                p.render(&(), &false.into()).pixels
            })
            .collect();
        assert!(films.windows(2).all(|pair| pair[0] != pair[1]), "and still the meshes move");
    });
    let reads = loader.reads.lock().unwrap();
    assert!(reads.len() == 3 && reads.values().all(|n| *n == 1), "{reads:?}");
}

/// A mesh, a patch, a tube, an implicit surface and a skin that stand still, and a skin whose rest does.
const MADE: &str = "render { size 12, 8  frames 4  samples 1 }
camera { eye <0, 0, 9>  look_at <0, 0, 0> }
light { point <2, 3, 8>  intensity 200 }
let sheet = mesh { vertices [<0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0>]  faces [[0, 1, 2], [1, 3, 2]] }
skeleton arm { joint a { hinge z  joint b { offset <1, 0, 0>  hinge z  tip end { offset <1, 0, 0> } } } }
mesh { vertices [<-3, -2, 0>, <-2, -2, 0>, <-3, -1, 0>]  faces [[0, 1, 2]] }
patch { bezier [<floor(k / 4) - 3, k % 4, k % 3> for k in 0..16] }
tube { along curve(t => <t, -t * t, 0>, -1, 1)  radius 0.2 }
implicit { f p => dot(p, p) - 0.5  within <-1, -1, -1>, <1, 1, 1>  translate <2, 0, 0> }
pose still { of arm  a 20 }
pose turning { of arm  a 90 * time }
skin { surface sheet  skeleton arm  pose still  translate <0, 2, 0> }
skin { surface sheet  skeleton arm  pose turning  translate <2, 2, 0> }
";

/// How much each frame takes over from the one before, and its picture.
fn taken_over(text: &str) -> Vec<(u64, Vec<[f64; 3]>)> {
    let files = BTreeMap::from([("a.scene", text.as_bytes().to_vec())]);
    let loader = Arc::new(Counting { files, reads: Mutex::default() });
    let mut session = Session::new(Options::default(), loader);
    session.animate(Path::new("a.scene"), Asked::Whole, None, |animation| {
        let frames = animation.frames().unwrap();
        let made = frames.map(|frame| prepared(animation, frame));
        made.map(|p| {
            let pixels = p.render(&(), &false.into()).pixels;
            (p.world.stats().reused, pixels.iter().map(|rgb| rgb.to_array()).collect())
        })
        .collect()
    })
}

#[test]
fn what_does_not_change_is_made_once_and_what_changes_is_made_anew() {
    let frames = taken_over(MADE);
    let reused: Vec<u64> = frames.iter().map(|(reused, _)| *reused).collect();
    // Of the still ones all five, and of the moving skin its weights.
    assert_eq!(reused[1..], [6; 3], "{reused:?}");
    let folder = Folder::with(&[("a.scene", MADE)]);
    folder.ogee("render a.scene -o {frame}.exr").expect(0);
    folder.ogee("render a.scene -o alone.exr --frames 3").expect(0);
    assert!(folder.read("alone.exr") == folder.read("3.exr"), "and it is the same alone");
    for (still, moving, fewer) in [
        ("<-3, -2, 0>,", "<-3, -2, time>,", 1),
        ("k % 3>", "k % 3 + time>", 1),
        ("radius 0.2", "radius 0.2 + 0.1 * time", 1),
        ("- 0.5", "- 0.5 - 0.1 * time", 1),
        // The skin is moved anew, by the weights that it had.
        ("a 20", "a 20 + time", 0),
        ("<0, 0, 9>", "<0, time, 9>", 1),
    ] {
        assert!(MADE.contains(still));
        let frames = taken_over(&MADE.replace(still, moving));
        assert_eq!(frames[2].0 as i64, 6 - fewer, "{moving}");
        assert!(frames[1].1 != frames[2].1, "{moving}: it moves");
    }
}
